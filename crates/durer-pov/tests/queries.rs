//! `trace`, `inside`, `min_extent` and `max_extent`: the values are those of POV-Ray 3.7 unless
//! noted otherwise.

mod support;

use support::{debug, fault, float, scene, vector};

/// The point and the normal that `trace` returns, with four digits.
fn traced(object: &str, origin: &str, direction: &str) -> String {
    debug(&format!(
        "#declare N = <9, 9, 9>; #declare P = trace({object}, {origin}, {direction}, N);
        #debug concat(vstr(3, P, \",\", 0, 4), \" \", vstr(3, N, \",\", 0, 4))"
    ))
}

#[test]
fn trace_gives_the_first_point_and_the_normal_out_of_the_solid() {
    assert_eq!(traced("sphere { 0, 1 }", "-5*z", "z"), "0.0000,0.0000,-1.0000 0.0000,0.0000,-1.0000");
    assert_eq!(traced("sphere { 0, 1 }", "-5*z", "0.001*z"), "0.0000,0.0000,-1.0000 0.0000,0.0000,-1.0000");
    assert_eq!(traced("sphere { 0, 1 }", "0", "z"), "0.0000,0.0000,1.0000 0.0000,0.0000,1.0000");
    assert_eq!(
        traced("difference { box { -1, 1 } sphere { 0, 0.9 } }", "0", "z"),
        "0.0000,0.0000,0.9000 0.0000,0.0000,-1.0000"
    );
    assert_eq!(traced("sphere { 0, 1 inverse }", "-5*z", "z"), "0.0000,0.0000,-1.0000 0.0000,0.0000,1.0000");
    assert_eq!(traced("plane { y, 0 }", "-y", "y"), "0.0000,0.0000,0.0000 0.0000,1.0000,0.0000");
    assert_eq!(
        traced("sphere { 0, 1 scale <1, 2, 3> }", "<0.3, 0.2, -5>", "z"),
        "0.3000,0.2000,-2.8460 0.6838,0.1140,-0.7207"
    );
}

#[test]
fn a_miss_gives_zeros() {
    let nothing = "0.0000,0.0000,0.0000 0.0000,0.0000,0.0000";
    assert_eq!(traced("sphere { 0, 1 }", "-5*z", "-z"), nothing);
    assert_eq!(traced("sphere { 0, 1 clipped_by { plane { z, 0 } } }", "-0.5*z", "z"), nothing);
    assert_eq!(traced("sphere { 0, 0 }", "-5*z", "z"), nothing);
    assert_eq!(traced("sphere { 0, 1 }", "-5*z", "0"), nothing);
}

#[test]
fn a_surface_on_which_the_ray_starts_is_left_out() {
    assert_eq!(traced("sphere { 0, 1 }", "-z", "z"), "0.0000,0.0000,1.0000 0.0000,0.0000,1.0000");
    assert_eq!(traced("sphere { 0, 1 }", "-z", "-z"), "0.0000,0.0000,0.0000 0.0000,0.0000,0.0000");
    // From crossing to crossing: each is found once. Four solids, eight crossings, from a start
    // without round coordinates.
    let chain = "#declare S = union { #for (I, 1, 4) sphere { I*<3, 2, 1>/7, 0.1 } #end }
        #declare P = <-1, -2, -1>/3; #declare D = 2*<3, 2, 1>/7 - P; #declare N = y; #declare Count = 0;
        #while (vlength(N) > 0) #declare P = trace(S, P, D, N);
          #if (vlength(N) > 0) #declare Count = Count + 1; #end #end #debug str(Count, 0, 0)";
    assert_eq!(debug(chain), "2");
    let row = chain.replace("<-1, -2, -1>/3", "-<3, 2, 1>/3");
    assert_eq!(debug(&row), "8");
    // POV-Ray also leaves out crossings nearer than about 1e-4, depending on the shape. durer
    // leaves out only the surface on which the ray starts.
    assert_eq!(
        traced("sphere { 0, 1 }", "-(1 + 1e-9)*z", "z"),
        "0.0000,0.0000,-1.0000 0.0000,0.0000,-1.0000"
    );
}

#[test]
fn normals_of_triangles_are_those_of_the_language() {
    let corners = "<-1, -1, -1>, <1, -1, 0>, <0, 1, 0>";
    let seen = "0.0000,0.0000,-0.2500 0.4364,0.2182,-0.8729";
    assert_eq!(traced(&format!("triangle {{ {corners} }}"), "-5*z", "z"), seen);
    assert_eq!(traced(&format!("triangle {{ {corners} }}"), "5*z", "-z"), seen);
    assert_eq!(traced(&format!("mesh {{ triangle {{ {corners} }} }}"), "-5*z", "z"), seen);
    let smooth =
        "smooth_triangle { <-1, -1, 0>, <-1, -1, -1>, <1, -1, 0>, <1, -1, -1>, <0, 1, 0>, <0, 1, -1> }";
    assert_eq!(traced(smooth, "<0.3, 0, -5>", "z"), "0.3000,0.0000,0.0000 0.2592,0.0971,-0.9609");
    assert_eq!(
        traced(&format!("mesh {{ {smooth} }}"), "<0.3, 0, -5>", "z"),
        "0.3000,0.0000,0.0000 0.2592,0.0971,-0.9609"
    );
}

#[test]
fn the_normals_variable_is_a_name() {
    let (_, _, text) = fault("#declare P = trace(sphere { 0, 1 }, -5*z, z, <0, 0, 0>);");
    assert!(text.contains("the name of a declared vector"), "{text}");
    let element = "#declare A = array[2] { x, x } #declare P = trace(sphere { 0, 1 }, -5*z, z, A[1]); #debug vstr(3, A[1], \",\", 0, 1)";
    assert_eq!(debug(element), "0.0,0.0,-1.0");
    let through_a_macro = "#macro Ask(V) #local P = trace(sphere { 0, 1 }, -5*z, z, V); #end
        #declare N = x; Ask(N) #debug vstr(3, N, \",\", 0, 1)";
    assert_eq!(debug(through_a_macro), "0.0,0.0,-1.0");
}

#[test]
fn inside_is_exact_and_closed() {
    let inside = |object: &str, point: &str| float(&format!("inside({object}, {point})"), 0);
    assert_eq!(inside("sphere { 0, 1 }", "<0.5, 0.5, 0.5>"), "1");
    assert_eq!(inside("sphere { 0, 1 }", "<0.6, 0.6, 0.6>"), "0");
    assert_eq!(inside("box { 0, 1 }", "<1, 0.5, 0.5>"), "1");
    assert_eq!(inside("plane { y, 0 }", "<3, -1e-300, 2>"), "1");
    assert_eq!(inside("plane { y, 0 }", "<3, 1e-300, 2>"), "0");
    assert_eq!(inside("sphere { 0, 1 clipped_by { plane { z, 0 } } }", "0.5*z"), "0");
    assert_eq!(inside("sphere { 0, 1 clipped_by { plane { z, 0 } } }", "-0.5*z"), "1");
    assert_eq!(inside("cylinder { 0, y, 1 open }", "0.5*y"), "1");
    assert_eq!(inside("union { sphere { 0, 1 } sphere { 5, 1 } }", "5"), "1");
    assert_eq!(inside("intersection { sphere { 0, 1 } sphere { x, 1 } }", "0.5*x"), "1");
    assert_eq!(inside("difference { sphere { 0, 1 } sphere { x, 1 } }", "0.5*x"), "0");
    assert_eq!(inside("merge { sphere { 0, 1 } box { 2, 3 } }", "2.5"), "1");
    assert_eq!(inside("sphere { 0, 1 inverse }", "0"), "0");
    // Flat and empty parts contain no points.
    assert_eq!(inside("box { <0, 0, 0>, <1, 0, 1> }", "<0.5, 0, 0.5>"), "0");
    assert_eq!(inside("difference { sphere { 0, 1 } sphere { 0, 0 } translate x }", "x"), "1");
    assert_eq!(inside("union { box { <0, 0, 0>, <1, 0, 1> } sphere { 3, 1 } }", "3"), "1");
}

/// Both corners of the extent.
fn extent(object: &str) -> String {
    format!("{} {}", vector(3, &format!("min_extent({object})")), vector(3, &format!("max_extent({object})")))
}

#[test]
fn extents_are_boxes() {
    let rows = [
        ("sphere { <1, 2, 3>, 0.1 }", "0.9000,1.9000,2.9000 1.1000,2.1000,3.1000"),
        ("sphere { <1, 2, 3>, 0.1 rotate <10, 20, 30> }", "0.9674,2.1891,2.6606 1.1674,2.3891,2.8606"),
        ("sphere { 0, 1 scale <1, 2, 1> rotate 45*z }", "-2.1213,-2.1213,-1.0000 2.1213,2.1213,1.0000"),
        ("box { -1, <1, 2, 3> }", "-1.0000,-1.0000,-1.0000 1.0000,2.0000,3.0000"),
        ("box { -1, <1, 2, 3> rotate 45*y }", "-1.4142,-1.0000,-1.4142 2.8284,2.0000,2.8284"),
        ("cylinder { 0, y, 1 }", "-1.0000,0.0000,-1.0000 1.0000,1.0000,1.0000"),
        ("torus { 1, 0.25 rotate 30*x }", "-1.2500,-0.8415,-1.2075 1.2500,0.8415,1.2075"),
        ("triangle { 0, x, y }", "0.0000,0.0000,0.0000 1.0000,1.0000,0.0000"),
        ("union { sphere { 0, 1 } box { 1, 2 } }", "-1.0000,-1.0000,-1.0000 2.0000,2.0000,2.0000"),
        (
            "union { sphere { 0, 1 } box { 1, 2 } rotate 45*y }",
            "-1.4142,-1.0000,-2.1213 2.8284,2.0000,2.1213",
        ),
        ("intersection { sphere { 0, 1 } box { 0, 2 } }", "0.0000,0.0000,0.0000 1.0000,1.0000,1.0000"),
        (
            "intersection { plane { y, 1 } box { -2, 2 } rotate 30*z }",
            "-2.2321,-2.7321,-2.0000 2.7321,1.8660,2.0000",
        ),
        ("difference { sphere { 0, 1 } box { 0, 2 } }", "-1.0000,-1.0000,-1.0000 1.0000,1.0000,1.0000"),
        ("difference { box { -1, 1 } plane { y, 0 } }", "-1.0000,0.0000,-1.0000 1.0000,1.0000,1.0000"),
        ("sphere { 0, 1 clipped_by { box { 0, 1.5 } } }", "0.0000,0.0000,0.0000 1.5000,1.5000,1.5000"),
        ("sphere { 0, 1 clipped_by { box { 0, 3 } } }", "-1.0000,-1.0000,-1.0000 1.0000,1.0000,1.0000"),
        ("plane { y, 0 clipped_by { box { -1, 1 } } }", "-1.0000,-1.0000,-1.0000 1.0000,1.0000,1.0000"),
        (
            "isosurface { function { x*x + y*y + z*z - 1 } contained_by { box { -2, 2 } } }",
            "-2.0000,-2.0000,-2.0000 2.0000,2.0000,2.0000",
        ),
        (
            "intersection { quadric { <1, 0, 1>, 0, 0, -1 } plane { y, 1 } plane { -y, 1 } }",
            "-1.0000,-1.0000,-1.0000 1.0000,1.0000,1.0000",
        ),
        ("sphere { 0, 0 }", "0.0000,0.0000,0.0000 0.0000,0.0000,0.0000"),
    ];
    for (object, wanted) in rows {
        assert_eq!(extent(object), wanted, "{object}");
    }
    assert_eq!(float("max_extent(plane { y, 0 }).x/1e10", 4), "1.0000");
}

#[test]
fn what_cannot_be_computed_is_a_fault_where_it_stands() {
    let (line, column, text) = fault("sphere { 0, 1 }\n#declare N = sum(i, 1, 2, i);");
    assert_eq!((line, column, text.as_str()), (2, 14, "not supported yet: sum"));
    // Also in the middle of a value, and in a name that is not used.
    let (line, column, _) = fault("#declare A = array[1] { sum(i, 1, 2, i) }");
    assert_eq!((line, column), (1, 25));
    // A random number is not skipped with its texture, because all later ones would change.
    let text = "#declare R = seed(1); #declare T = texture { pigment { rgb 1 } normal { spacing bump_size rand(R) } }";
    assert!(fault(text).2.starts_with("not supported yet"), "{text}");
    // A definition without random numbers may be skipped.
    scene("#declare T = texture { pigment { rgb 1 } normal { spacing } } sphere { 0, 1 }");
}

/// A loop over many objects neither fills the memory nor takes long.
#[test]
fn questions_in_loops_end() {
    let text = "#declare Hits = 0; #for (I, 1, 3000) #declare N = x;
        #declare P = trace(sphere { I*x, 1 }, <I, 5, 0>, -y, N); #declare Hits = Hits + N.y; #end
        #debug str(Hits, 0, 0)";
    assert_eq!(debug(text), "3000");
}
