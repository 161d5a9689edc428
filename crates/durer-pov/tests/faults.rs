//! Any faulty input gives one message with its place, soon, and no panic.

mod support;

use std::time::{Duration, Instant};

use durer_pov::{ErrorKind, Limits, ReadOptions};
use support::{Folder, fault, notices, read, scene};

/// The limits of these tests: a tenth of the real ones, so that they are reached quickly.
fn small() -> ReadOptions {
    let limits = Limits { steps: 5_000_000, memory: 64 << 20, ..Limits::default() };
    ReadOptions { limits, ..ReadOptions::default() }
}

fn limit(text: &str, name: &str) {
    let folder = Folder::new();
    let path = folder.write("scene.pov", text);
    let begin = Instant::now();
    let error = durer_pov::read(&path, &small()).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Limit, "{error}");
    assert!(error.text.contains(&format!("`{name}`")), "{error}");
    assert!(error.at.is_some() && error.to_string().lines().count() >= 4, "{error}");
    assert!(begin.elapsed() < Duration::from_secs(20), "{text}");
}

#[test]
fn endless_scenes_end() {
    limit("#while (1) #end", "steps");
    limit("#declare i=0; #while (1) #declare i=sin(i)+1; #end", "steps");
    limit("#for (I,0,1,1e-12) #end", "steps");
    limit("#while (1) #debug \"hello\\n\" #end", "steps");
    limit("#declare A=array[100000]; #while (1) #declare B=A; #declare B[0]=1; #end", "steps");
    limit("#declare S=\"\"; #while (1) #declare S=concat(S,\"abcdefghij\"); #end", "steps");
}

#[test]
fn endless_depth_ends() {
    limit("#macro M() M() #end M()", "macro_depth");
    limit("#macro M() (1+M()) #end #declare A=M();", "nesting");
    limit("#include \"scene.pov\"", "include_depth");
    limit(&format!("#declare A={}1;", "(".repeat(100_000)), "nesting");
    limit(&format!("#declare A={}1;", "-".repeat(100_000)), "nesting");
    limit(&"union{".repeat(100_000), "nesting");
    limit("#declare U=sphere{0,1} #while(1) #declare U=union{object{U} object{U}} #end", "nesting");
    limit("#declare A=array[1]; #declare A[0]=1; #while(1) #declare A[0]=A; #end", "nesting");
}

#[test]
fn endless_data_end() {
    limit("#declare A=array[1000000000];", "memory");
    limit("#declare S=\"0123456789\"; #while(1) #declare S=concat(S,S); #end", "memory");
    limit("#while(1) sphere{0,1} #end", "memory");
    limit("#declare i=0; #while(1) sphere{0,1 pigment{rgb i}} #declare i=i+1; #end", "memory");
    limit(
        "#declare U=sphere{0,1} #for(I,1,60) #declare U=union{object{U} object{U}} #end object{U}",
        "memory",
    );
    limit("#declare L=light_source{0 rgb 1} #while(1) light_source{L} #end", "memory");
    limit("#declare A=array[500000]; #for(I,0,499999) #declare A[I]=texture{pigment{rgb I}} #end", "memory");
}

/// Lists that objects share count once, and no longer when the last object is gone.
#[test]
fn shared_lists_count_once() {
    let limits = Limits { memory: 8 << 20, ..Limits::default() };
    let options = ReadOptions { limits, ..ReadOptions::default() };
    let folder = Folder::new();
    let field = "height_field { function 300, 300 { 0.5 } }";
    let turned = "sor { 20002, #for(J,0,20001) <1,J>, #end }";
    for (text, fits) in [
        (format!("#for(I,1,20) #declare F={field}; #end object {{ F }}"), true),
        (format!("#for(I,1,20) {field} #end"), false),
        (format!("#declare S={turned} #for(I,1,30) object {{ S translate I }} #end #undef S"), true),
        (format!("#for(I,1,30) {turned} #end"), false),
        (format!("#for(I,1,30) #declare E=min_extent({turned}); #end"), true),
    ] {
        let path = folder.write("scene.pov", &text);
        assert_eq!(durer_pov::read(&path, &options).is_ok(), fits, "{text}");
    }
}

#[test]
fn files_that_are_no_scenes_are_named() {
    let folder = Folder::new();
    std::fs::create_dir(folder.0.join("dir.pov")).unwrap();
    folder.write("noise.pov", (0..5000_u32).map(|i| (i * 7919 % 251) as u8).collect::<Vec<_>>());
    folder.write("includes.pov", "#include \"dir.pov\"");
    folder.write("missing.pov", "#include \"nosuch.inc\"");
    folder.write("fine.pov", "#include \"noise.pov\"");
    let text = |name: &str| folder.read(name).unwrap_err().to_string();
    assert!(text("dir.pov").ends_with("dir.pov: is a directory, not a scene file"));
    assert!(
        text("nothing.pov").contains("nothing.pov: cannot be read: no such file"),
        "{}",
        text("nothing.pov")
    );
    assert!(text("noise.pov").contains("does not look like a scene file"));
    assert!(
        text("includes.pov").contains("includes.pov:1:10:") && text("includes.pov").contains("directory")
    );
    assert!(text("missing.pov").contains("missing.pov:1:10: there is no include file \"nosuch.inc\""));
    assert!(text("fine.pov").contains("noise.pov:1:"));
}

#[test]
fn what_cannot_be_done_in_an_included_texture_is_named_there() {
    let folder = Folder::new();
    folder.write("stones.inc", "#declare T = texture { pigment {\n spacing } }");
    folder.write("scene.pov", "#include \"stones.inc\"\nplane { y, 0 }\nsphere { 0, 1 texture { T } }");
    let said = folder.read("scene.pov").unwrap_err().to_string();
    assert!(said.contains("stones.inc:2:2: not supported yet: spacing"), "{said}");
    let (_, used) = said.split_once("= in a value used at ").unwrap();
    assert!(used.trim_end().ends_with("scene.pov:3:25"), "{said}");
}

#[test]
fn cut_files_are_named_at_their_end() {
    assert!(fault("sphere { <0,0,0>, 1 pigment { rgb 1").2.contains("the end of the scene"));
    assert!(fault("sphere { <0,").2.contains("the end of the scene"));
    assert_eq!(fault("/* never").2, "this comment is never closed");
    assert_eq!(fault("#if (1)\nsphere { 0, 1 }"), (1, 1, "this #if has no #end".into()));
    assert_eq!(fault("#declare S = \"abc").2, "this string is never closed");
}

#[test]
fn impossible_shapes_are_named() {
    for (text, part) in [
        ("cylinder { 0, 0, 1 }", "same point"),
        ("plane { 0, 1 }", "no length"),
        ("sphere { 0, 1 matrix <1,1,0,1,1,0,0,0,1,0,0,0> }", "singular"),
        ("polygon { 3, 0, x }", "found `}`"),
        ("camera { location 0 look_at 0 }", "own location"),
        ("camera { right x direction x }", "span space"),
        ("camera { angle 200 }", "between 0 and 180"),
        ("mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0,1,3> } }", "no vertex number 3"),
        ("sphere { 0, 1 finish { roughness 0 } }", "must be positive"),
        ("sphere { 0, 1 interior { ior -0.5 } }", "is not negative, as -0.5 is"),
    ] {
        let (_, _, message) = fault(text);
        assert!(message.contains(part), "{text}: {message}");
    }
}

#[test]
fn the_place_is_underlined_and_the_way_there_told() {
    let error = read("#macro Bad(R)\n  sphere { 0, R spacing }\n#end\n\nBad(1)").unwrap_err().to_string();
    let lines: Vec<_> = error.lines().collect();
    assert!(lines[0].ends_with("scene.pov:3:17: not supported yet: spacing"), "{error}");
    assert_eq!(lines[2], "3 |   sphere { 0, R spacing }");
    assert_eq!(lines[3], "  |                 ^^^^^^^");
    assert!(lines[4].contains("in macro Bad, called at") && lines[4].ends_with("scene.pov:6:1"), "{error}");
}

#[test]
fn a_misspelling_is_recognised() {
    assert!(fault("#declare Radius = 1; sphere { 0, Raduis }").2.contains("did you mean `Radius`?"));
    assert!(fault("spehre { 0, 1 }").2.contains("did you mean `sphere`?"));
}

#[test]
fn what_is_not_there_yet_is_called_by_its_name() {
    assert_eq!(fault("sphere { 0, 1 pigment { spacing } }").2, "not supported yet: spacing");
}

#[test]
fn parametric_surfaces_say_what_is_wrong_with_them() {
    let two = "function { u } function { v }";
    for (text, wanted) in [
        (
            format!("parametric {{ {two} <0, 0>, <1, 1> }}"),
            "a parametric has three functions, this one has 2",
        ),
        (format!("parametric {{ {two} function {{ z }} <0, 0>, <1, 1> }}"), "this one uses z"),
        (format!("parametric {{ {two} function(a) {{ a }} <0, 0>, <1, 1> }}"), "this one has 1"),
        (
            format!("parametric {{ {two} function {{ u }} <0, 2>, <1, 1> }}"),
            "v of this parametric goes from 2 to 1; it must ascend",
        ),
        (format!("parametric {{ {two} function {{ floor(u*4) }} <0, 0>, <1, 1> }}"), "its functions jump"),
        (format!("parametric {{ {two} function {{ u }} }}"), "expected"),
    ] {
        let said =
            read(&text).map(|read| read.scene.lower().map(|_| ()).map_err(|error| error.kind.to_string()));
        let said = match said {
            Ok(lowered) => lowered.unwrap_err(),
            Err(error) => error.text.clone(),
        };
        assert!(said.contains(wanted), "{text}: {said}");
    }
}

#[test]
fn patches_say_what_is_wrong_with_them() {
    let points = "0, x, x*2, x*3, y, y+x, y+x*2, y+x*3, y*2, y*2+x, y*2+x*2, y*2+x*3, z, z+x, z+x*2, z+x*3";
    for (text, wanted) in [
        ("bicubic_patch { type 2 POINTS }", "the type of a bicubic_patch is 0 or 1, not 2"),
        ("bicubic_patch { u_steps -1 type 1 POINTS }", "u_steps must not be negative: -1"),
        ("bicubic_patch { POINTS }", "this bicubic_patch has no type: it needs `type 0` or `type 1`"),
        ("bicubic_patch { type 1 0, x }", "expected a number, vector or colour, found `}`"),
        (
            "patch { 3, 17, POINTS }",
            "the points along a parameter of a bezier_spline patch must be a whole number from 2 to 16, not 17",
        ),
        (
            "patch { cubic_spline 3, 4, POINTS }",
            "the points along a parameter of a cubic_spline patch must be a whole number from 4 to 1048576, not 3",
        ),
        (
            "patch { 2, 2, 0, <1, 0, 0, -1>, y, x + y }",
            "the weight of point 2 of row 1 must be positive, not -1",
        ),
        ("nurbs { points 2, 2, 0, x, y, x + y }", "this nurbs lacks `degree DU, DV`"),
        ("nurbs { degree 40, 1 }", "a degree of a nurbs must be a whole number from 1 to 9, not 40"),
        (
            "nurbs { degree 1, 1 points 2, 2, 0, x, y, x + y u_knots 3, 0, 0, 1 }",
            "nurbs: 4 knots are needed along u, got 3",
        ),
        (
            "nurbs { degree 1, 1 points 2, 2, 0, x, y, x + y u_knots 4, 0, 0, 2, 1 }",
            "knots must not decrease: knot 4 is 1 after 2",
        ),
        ("subdivision { }", "this subdivision has no face_indices"),
        ("subdivision { scheme loop }", "this subdivision has no face_indices"),
        (
            "subdivision { vertex_vectors { 4, 0, x, x + y, y } face_indices { 1, <0, 1, 2, 3> } scheme loop }",
            "subdivision: face 0 has 4 vertices, Loop's rules are for triangles",
        ),
        ("subdivision { scheme square }", "a scheme is catmull_clark or loop"),
        ("subdivision { uv_interpolation cubic }", "uv_interpolation is linear or smooth"),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> } uv_interpolation smooth }",
            "subdivision: smooth texture coordinates are asked for, but there are none",
        ),
        ("subdivision { displace 0.1 }", "durer does not displace subdivision surfaces"),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 3> } }",
            "subdivision: face 0 names vertex 3, there are 3 (0 to 2)",
        ),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 2, <0, 1, 2>, <0, 1, 2> } }",
            "subdivision: faces 0 and 1 both go from vertex 0 to 1; one of them must be turned round",
        ),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 1, { 3, 0, 1.5, 2 } } }",
            "a face has whole numbers from 0 on, not 1.5",
        ),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1> } }",
            "a face has 3 numbers at least, here are 2",
        ),
        (
            "subdivision { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> } creases { 1, <0, 1, 0> } }",
            "subdivision: the sharpness of crease 0 must be positive, got 0",
        ),
        (
            "nurbs { degree 1, 1 points 2, 2, 0, x, y, x + y trim { } }",
            "a trim is a linear_spline, a bezier_spline or a nurbs_curve",
        ),
        (
            "nurbs { degree 1, 1 points 2, 2, 0, x, y, x + y trim { linear_spline 3, 0, x, 2 * y } }",
            "nurbs: trim 1: it leaves the surface at <0, 2>",
        ),
        (
            "nurbs { degree 1, 1 points 2, 2, 0, x, y, x + y
             trim { nurbs_curve degree 2, 3, <0, 0>, <1, 0>, <1, 1> knots 6, 0, 0, 0, 1, 1, 1 } }",
            "nurbs: trim 1: it is open: a curve ends at <1, 1> and the next begins at <0, 0>",
        ),
        (
            "patch { triangular 10, 0, x, y }",
            "the points along a side of a triangular patch must be a whole number from 2 to 9, not 10",
        ),
    ] {
        assert_eq!(fault(&text.replace("POINTS", points)).2, wanted, "{text}");
    }
}

#[test]
fn prisms_say_what_is_wrong_with_them() {
    assert!(fault("prism { 0, 1, 2, <0, 0>, <1, 0> }").2.contains("at least 3 points, not 2"));
    assert!(
        fault("prism { 0, 1, 6, <0, 0>, <1, 0>, <0, 0>, <5, 5>, <6, 6>, <5, 5> }")
            .2
            .contains("outline 1 of this prism has 2")
    );
}

#[test]
fn sweeps_say_what_is_wrong_with_them() {
    let says = |text: &str, message: &str| {
        let told = fault(text).2;
        assert!(told.contains(message), "{text}: {told}");
    };
    let profile = "profile linear_spline 4, <-1, -1>, <1, -1>, <0, 1>, <-1, -1>";
    let sweep = |rest: &str| format!("sweep {{ {profile} {rest} }}");
    says("sweep { path linear_spline 2, x, y }", "this sweep has no `profile`");
    says(&sweep(""), "this sweep has no `path`");
    says(&sweep("path linear_spline 1, x"), "at least 2 points, not 1");
    says(&sweep("path linear_spline 3, 0, y, 0"), "turns by 180 degrees at knot 1");
    says(&sweep("path linear_spline 3, 0, y, y"), "no tangent at knot 1");
    says(&sweep("path cubic_spline 3, x, y, z"), "at least 4 points, not 3");
    says(&sweep("path bezier_spline 5, 0, x, y, z, 0"), "5 is not a multiple of 4");
    says(&sweep("path bezier_spline 8, 0, x, y, z, x, y, 0, z"), "broken at knot 1");
    says(&sweep("path bezier_spline 8, 0, x, y, z, z, x, y, 0"), "has a corner at knot 1");
    says(&sweep("path linear_spline 3, 0, y, x size 3, 1, 0, 1"), "a size must be positive, got 0");
    says(&sweep("path linear_spline 2, x, x"), "both ends of the path are <1, 0, 0>");
    says(&sweep("path linear_spline 2, 0, y up 2*y"), "up, <0, 2, 0>, must not be parallel to the path");
    says(
        &sweep("path linear_spline 2, 0, y size 3, 1, 2, 3"),
        "`size` has one number for each of the 2 points",
    );
    says(&sweep("path linear_spline 2, 0, y size 2, 1, 0"), "a size must be positive and finite, got 0");
    says(
        "sweep { profile linear_spline 2, <0, 0>, <1, 1> path linear_spline 2, 0, y }",
        "at least 3 points, not 2",
    );
}

#[test]
fn curved_prisms_say_what_is_wrong_with_them() {
    let says = |text: &str, message: &str| {
        let told = fault(text).2;
        assert!(told.contains(message), "{text}: {told}");
    };
    says("prism { quadratic_spline 0, 1, 4, <0, 0>, <1, 0>, <1, 1>, <1, 0> }", "at least 5 points, not 4");
    says(
        "prism { cubic_spline 0, 1, 5, <0, 0>, <1, 0>, <1, 1>, <1, 0>, <2, 2> }",
        "at least 6 points, not 5",
    );
    says(
        "prism { bezier_spline 0, 1, 6, <0, 0>, <1, 0>, <1, 1>, <0, 0>, <0, 0>, <0, 0> }",
        "not a multiple of 4",
    );
    says(
        "prism { quadratic_spline 0, 1, 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> }",
        "is not closed: it must return to <1, 0>",
    );
    says(
        "prism { cubic_spline 0, 1, 6, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <2, 2>, <1, 0> }",
        "must return to <1, 0>, followed by one more point",
    );
    says("prism { bezier_spline 0, 1, 4, <0, 0>, <1, 0>, <1, 1>, <0, 1> }", "must return to <0, 0>");
    says(
        "prism { bezier_spline 0, 1, 8, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 2>, <1, 0>, <1, 1>, <0, 0> }",
        "ends at <0, 1>, the next begins at <0, 2>",
    );
    says(
        "prism { quadratic_spline 0, 1, 8, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <1, 0>, <5, 5>, <6, 6>, <6, 6> }",
        "outline 2 of this prism has 3 points, it needs 5",
    );
}

#[test]
fn sheets_say_what_is_wrong_with_them() {
    let says = |text: &str, message: &str| {
        let told = fault(text).2;
        assert!(told.contains(message), "{text}: {told}");
    };
    says("height_field { png \"nowhere.png\" }", "there is no picture \"nowhere.png\"");
    says("height_field { \"heights\" }", "does not tell what it is");
    says("height_field { tiff \"a.tiff\" }", "not supported yet: a picture of type tiff");
    says("height_field { }", "the file's name");
    says("height_field { function 1, 4 { x } }", "from 2 to 65536 samples a side, not 1");
    says("height_field { function 65536, 65536 { x } }", "2^30 in all");
    says("terrain { seed 4 }", "say how often the edges");
    says("terrain { levels 16 }", "a whole number from 0 to 15, not 16");
    says("terrain { levels 0 }", "levels must be a whole number from 1 to 15, got 0");
    says("terrain { levels 3 roughness 0 }", "the roughness must be above 0 and at most 1, got 0");
    says("terrain { levels 3 amplitude -1 }", "the amplitude must be finite, not negative");
    says("deform { terrain { levels 3 } twist { y, 90, from 0 to 1 } }", "a terrain has no formula here");
}

#[test]
fn turned_solids_say_what_is_wrong_with_them() {
    assert!(fault("sor { 3, <1, 0>, <1, 1>, <1, 2> }").2.contains("at least 4 points, not 3"));
    assert!(fault("sor { 4, <1, 0>, <1, 2>, <1, 1>, <1, 3> }").2.contains("1 comes after 2"));
    assert!(fault("sor { 4, <1, 0>, <-1, 1>, <1, 2>, <1, 3> }").2.contains("negative: -1"));
    assert!(fault("lemon { 0, 0, 0, 0, 1 }").2.contains("same point"));
    assert!(fault("lemon { 0, -1, y, 0, 1 }").2.contains("negative: -1"));
}

#[test]
fn iterated_function_systems_say_what_is_wrong_with_them() {
    assert!(fault("ifs { box { -1, 1 } depth 3 }").2.contains("has no map"));
    let wide = "ifs { box { -1, 1 } map { scale 0.5 } map { rotate y*20 scale <0.5, 1.25, 0.5> } depth 3 }";
    let (line, column, text) = fault(wide);
    assert!(
        line == 1 && column == 39 && text.contains("map 2") && text.contains("it is 1.25"),
        "{column} {text}"
    );
    assert!(fault("ifs { menger 40 }").2.contains("from 0 to 20, not 40"));
    assert!(fault("ifs { sierpinski 2.5 }").2.contains("from 0 to 20, not 2.5"));
    assert!(fault("ifs { box { -1, <1, -1, 1> } map { scale 0.5 } depth 2 }").2.contains("both have y = -1"));
    assert!(fault("ifs { sphere { 0, 0 } map { scale 0.5 } depth 2 }").2.contains("positive, got 0"));
    assert!(
        fault("ifs { tetrahedron { 0, x, y, x + y } map { scale 0.5 } depth 2 }").2.contains("one plane")
    );
    assert!(
        fault("ifs { cone { 0, 1, y, 0 } map { scale 0.5 } depth 2 }")
            .2
            .contains("box, sphere or tetrahedron")
    );
    assert!(fault("ifs { box { -1, 1 } map { scale 0.5 } }").2.contains("`depth 0` to `depth 20`"));
    assert!(
        fault("deform { ifs { menger 2 } twist { y, 90, from 0 to 1 } }").2.contains("an ifs has no formula")
    );
}

#[test]
fn polynomials_say_what_is_wrong_with_their_numbers() {
    assert!(fault("poly { 40, <1, 2> }").2.contains("from 2 to 16, not 40"));
    assert!(fault("poly { 2.5, <1, 2> }").2.contains("from 2 to 16"));
    assert!(fault("quartic { <1, 2, 3> }").2.contains("35 coefficients, and here are 3"));
    assert!(fault("poly { 2, <1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1> }").2.contains("10 coefficients"));
    assert!(fault("polynomial { 4, xyz(3, 2, 0): 1 }").2.contains("add up to 4 at most"));
}

#[test]
fn blobs_and_superellipsoids_say_what_is_wrong_with_their_numbers() {
    assert!(fault("superellipsoid { <0, 1> }").2.contains("between 1e-9 and 1e9, not 0"));
    assert!(fault("superellipsoid { <1, -2> }").2.contains("not -2"));
    assert!(fault("blob { threshold 0.5 }").2.contains("no components"));
    assert!(fault("blob { }").2.contains("no components"));
    assert!(fault("blob { threshold 0 sphere { 0, 1, 1 } }").2.contains("greater than 0, not 0"));
    assert!(fault("blob { cylinder { x, x, 1, 1 } }").2.contains("same point"));
    assert!(
        fault("blob { sphere { 0, 1, 1 scale 2 box { 0, 1 } } }").2.contains("a transform or the texture")
    );
    let deformed =
        fault("deform { blob { sphere { 0, 1, 2 pigment { rgb 1 } } } twist { y, 90, from 0 to 1 } }").2;
    assert!(deformed.contains("a blob whose components have textures cannot be deformed"), "{deformed}");
    assert!(fault("blob { sphere { 0, 1, 2 texture { gradient x } } }").2.contains("has no textures"));
}

#[test]
fn julia_sets_say_what_is_wrong_with_their_numbers() {
    assert!(fault("julia_fractal { <0, 0, 0, 0> slice <1, 0, 0, 0>, 0 }").2.contains("fourth component"));
    assert!(fault("julia_fractal { <0, 0, 0, 0> max_iteration -1 }").2.contains("0 to 1000, not -1"));
    assert!(fault("julia_fractal { <0, 0, 0, 0, 0> }").2.contains("vector of four"));
    assert_eq!(fault("julia_fractal { 0 hypercomplex exp }").2, "not supported yet: exp in julia_fractal");
    assert_eq!(fault("julia_fractal { 0 hypercomplex pwr(1, 2) }").2, "not supported yet: pwr");
}

/// POV-Ray draws such scenes without the shapes that have no extent.
#[test]
fn shapes_without_extent_are_left_out_with_a_warning() {
    for text in [
        "sphere { 0, 0 }",
        "cylinder { 0, y, 0 }",
        "cone { 0, 0, y, 0 }",
        "disc { 0, y, 0 }",
        "ovus { 0, 0 }",
        "torus { 1, 0 }",
        "cubic { <0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7> }",
    ] {
        let said = notices(text);
        assert!(said.iter().any(|said| said.contains("the object is not visible")), "{text}: {said:?}");
    }
    assert_eq!(scene("box { 0, <1, 0, 1> }").objects.len(), 1);
}
