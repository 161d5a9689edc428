//! `trace`, `inside`, `min_extent` and `max_extent`: the values that POV-Ray 3.7 prints.

mod support;

use support::{debug, fault};

const PRINT: &str =
    "#macro P(V) #debug concat(\"<\", str(V.x,0,6), \", \", str(V.y,0,6), \", \", str(V.z,0,6), \">\") #end ";

/// The point and the normal that `trace` gives.
fn trace(object: &str, ray: &str) -> String {
    debug(&format!(
        "{PRINT} #declare N = <7, 7, 7>; #declare S = {object} #declare Q = trace(S, {ray}, N); P(Q) P(N)"
    ))
}

/// The corners of the bounding box.
fn extent(object: &str) -> String {
    debug(&format!("{PRINT} #declare S = {object} P(min_extent(S)) P(max_extent(S))"))
}

const MISSED: &str = "<0.000000, 0.000000, 0.000000><0.000000, 0.000000, 0.000000>";

#[test]
fn trace_gives_the_first_point_and_the_outward_normal() {
    let sphere = "sphere { 0, 1 }";
    assert_eq!(
        trace(sphere, "<0.6, 5, 0>, -y"),
        "<0.600000, 0.800000, 0.000000><0.600000, 0.800000, 0.000000>"
    );
    assert_eq!(
        trace(sphere, "<0.6, 0, 0>, -9*y"),
        "<0.600000, -0.800000, 0.000000><0.600000, -0.800000, 0.000000>"
    );
    assert_eq!(trace(sphere, "<3, 5, 0>, -y"), MISSED);
    assert_eq!(trace(sphere, "<0, 5, 0>, y"), MISSED);
    assert_eq!(trace(sphere, "<0, 5, 0>, 0"), MISSED);
    let inverse = "sphere { 0, 1 inverse }";
    assert_eq!(
        trace(inverse, "<0.6, 5, 0>, -y"),
        "<0.600000, 0.800000, 0.000000><-0.600000, -0.800000, -0.000000>"
    );
    let plane = "plane { y, 0 }";
    assert_eq!(trace(plane, "<0, -5, 0>, y"), "<0.000000, 0.000000, 0.000000><0.000000, 1.000000, 0.000000>");
    let union = "union { sphere { 0, 1 } sphere { y*0.5, 1 } }";
    assert_eq!(trace(union, "<0, 0, 0>, y"), "<0.000000, 1.000000, 0.000000><0.000000, 1.000000, 0.000000>");
    let difference = "difference { sphere { 0, 1 } box { <0, 0, -2>, 2 } }";
    assert_eq!(
        trace(difference, "<0.3, 0.5, 0>, -x"),
        "<0.000000, 0.500000, 0.000000><1.000000, 0.000000, 0.000000>"
    );
}

#[test]
fn a_surface_through_the_origin_of_the_ray_is_not_met_there() {
    let sphere = "sphere { 0, 1 }";
    assert_eq!(trace(sphere, "y, y"), MISSED);
    assert_eq!(trace(sphere, "y, -y"), "<0.000000, -1.000000, 0.000000><0.000000, -1.000000, 0.000000>");
    // Computed points are beside the surface by a rounding.
    for i in 0..40 {
        let turned = format!("vrotate(x, <0, {}, {}>)", 9 * i + 1, 7 * i + 2);
        let text = format!(
            "#declare S = sphere {{ 0, 1 }} #declare O = {turned}; \
             #debug str((vlength(trace(S, O, -O) + O) < 1e-12), 0, 0) #debug str(vlength(trace(S, O, O)), 0, 0)"
        );
        assert_eq!(debug(&text), "10", "{turned}");
    }
}

#[test]
fn normals_of_triangles_are_left_handed_and_those_of_smooth_ones_as_given() {
    let up = "<0.000000, 0.000000, 0.000000><0.000000, 1.000000, 0.000000>";
    let down = "<0.000000, 0.000000, 0.000000><0.000000, -1.000000, 0.000000>";
    let zeros = |text: String| text.replace("-0.000000", "0.000000");
    for ray in ["<0, 5, 0>, -y", "<0, -5, 0>, y"] {
        for object in [
            "mesh { triangle { <-1, 0, -1>, <1, 0, -1>, <0, 0, 1> } }",
            "triangle { <-1, 0, -1>, <1, 0, -1>, <0, 0, 1> }",
            "mesh2 { vertex_vectors { 3, <-1, 0, -1>, <1, 0, -1>, <0, 0, 1> } face_indices { 1, <0, 1, 2> } }",
            "union { sphere { 9*x, 1 } mesh { triangle { <-1, 0, -1>, <1, 0, -1>, <0, 0, 1> } } }",
        ] {
            assert_eq!(zeros(trace(object, ray)), up, "{object} {ray}");
        }
        assert_eq!(zeros(trace("triangle { <-1, 0, -1>, <0, 0, 1>, <1, 0, -1> }", ray)), down);
        let smooth = "<0.000000, 0.000000, 0.000000><0.000000, 0.894427, 0.447214>";
        for object in [
            "mesh { smooth_triangle { <-1,0,-1>, <-1,1,0>, <1,0,-1>, <1,1,0>, <0,0,1>, <0,1,1> } }",
            "mesh { smooth_triangle { <-1,0,-1>, <-1,1,0>, <0,0,1>, <0,1,1>, <1,0,-1>, <1,1,0> } }",
        ] {
            assert_eq!(zeros(trace(object, ray)), smooth, "{object} {ray}");
        }
        let given =
            "mesh { smooth_triangle { <-1,0,-1>, <1,-1,0>, <0,0,1>, <0,-1,-1>, <1,0,-1>, <-1,-1,0> } }";
        assert_eq!(
            zeros(trace(given, ray)),
            "<0.000000, 0.000000, 0.000000><0.000000, -0.894427, -0.447214>"
        );
    }
}

#[test]
fn the_normal_goes_to_any_variable() {
    let sphere = "#declare S = sphere { 0, 1 }";
    let element = format!(
        "{PRINT} {sphere} #declare A = array[2] {{ x, x }} P(trace(S, 5*y, -y, A[1])) P(A[0]) P(A[1])"
    );
    assert_eq!(
        debug(&element),
        "<0.000000, 1.000000, 0.000000><1.000000, 0.000000, 0.000000><0.000000, 1.000000, 0.000000>"
    );
    let through_a_macro =
        format!("{PRINT} {sphere} #macro M(N) trace(S, 5*y, -y, N) #end #declare K = 0*x; P(M(K)) P(K)");
    assert_eq!(debug(&through_a_macro), "<0.000000, 1.000000, 0.000000><0.000000, 1.000000, 0.000000>");
    let unknown = fault(&format!("{sphere} #declare P = trace(S, 5*y, -y, Nothing);"));
    assert!(unknown.2.contains("a declared variable for the normal"), "{unknown:?}");
    let no_object = fault("#declare P = trace(3, 5*y, -y);");
    assert!(no_object.2.contains("a declared object"), "{no_object:?}");
}

#[test]
fn inside_is_inside_or_on() {
    let inside =
        |object: &str, p: &str| debug(&format!("#declare S = {object} #debug str(inside(S, {p}), 0, 0)"));
    assert_eq!(inside("sphere { 0, 1 }", "x/2"), "1");
    assert_eq!(inside("sphere { 0, 1 }", "1.5*x"), "0");
    assert_eq!(inside("sphere { 0, 1 inverse }", "0"), "0");
    assert_eq!(inside("plane { y, 0 }", "0"), "1");
    assert_eq!(inside("plane { y, 0 }", "-y"), "1");
    assert_eq!(inside("box { -1, 1 }", "x"), "1");
    assert_eq!(inside("union { sphere { 0, 1 } sphere { y, 1 } }", "1.5*y"), "1");
    assert_eq!(inside("intersection { sphere { 0, 1 } plane { y, 0 } }", "y/2"), "0");
    assert_eq!(inside("light_source { 0, 1 }", "0"), "0");
}

#[test]
fn extents_are_those_of_boxes() {
    let ball = "<-1.000000, -1.000000, -1.000000><1.000000, 1.000000, 1.000000>";
    let rows = [
        ("sphere { 0, 1 }", ball),
        ("sphere { 0, 1 rotate 45*x }", ball),
        ("sphere { 0, 1 clipped_by { plane { y, 0 } } }", ball),
        ("sphere { 0, 1 bounded_by { box { -3, 3 } } }", ball),
        ("sphere { 0, 1 inverse }", ball),
        ("difference { sphere { 0, 1 } box { <0, 0, -2>, 2 } }", ball),
        ("quadric { <1, 1, 1>, 0, 0, -1 }", ball),
        (
            "union { sphere { 0, 1 } sphere { y*0.5, 1 } }",
            "<-1.000000, -1.000000, -1.000000><1.000000, 1.500000, 1.000000>",
        ),
        (
            "sphere { 0, 1 scale <1, 2, 1> rotate 30*z translate x }",
            "<-0.866025, -2.232051, -1.000000><2.866025, 2.232051, 1.000000>",
        ),
        ("cylinder { 0, y, 0.5 }", "<-0.500000, 0.000000, -0.500000><0.500000, 1.000000, 0.500000>"),
        ("cone { 0, 1, y, 0 }", "<-1.000000, 0.000000, -1.000000><1.000000, 1.000000, 1.000000>"),
        ("torus { 1, 0.25 }", "<-1.250000, -0.250000, -1.250000><1.250000, 0.250000, 1.250000>"),
        ("torus { 1, 0.25 rotate 45*x }", "<-1.250000, -1.060660, -1.060660><1.250000, 1.060660, 1.060660>"),
        ("box { -1, 1 rotate 45*x }", "<-1.000000, -1.414214, -1.414214><1.000000, 1.414214, 1.414214>"),
        (
            "intersection { sphere { 0, 1 } box { <0, 0, -2>, 2 } }",
            "<0.000000, 0.000000, -1.000000><1.000000, 1.000000, 1.000000>",
        ),
        (
            "intersection { sphere { 0, 1 } plane { y, 0 } }",
            "<-1.000000, -1.000000, -1.000000><1.000000, 0.000000, 1.000000>",
        ),
        ("mesh { triangle { 0, x, y } }", "<0.000000, 0.000000, 0.000000><1.000000, 1.000000, 0.000000>"),
        (
            "plane { y, 0 }",
            "<-10000000000.000000, -10000000000.000000, -10000000000.000000><10000000000.000000, 10000000000.000000, 10000000000.000000>",
        ),
    ];
    for (object, wanted) in rows {
        assert_eq!(extent(object).replace("-0.000000", "0.000000"), wanted, "{object}");
    }
}
