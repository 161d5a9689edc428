//! The include files that stand in for POV-Ray's declare what POV-Ray's do. Where POV-Ray is not
//! installed, both are the same files.

mod support;

use durer_pov::MessageKind;
use support::Folder;

/// The `#debug` messages of a scene.
fn printed(folder: &Folder, text: &str) -> Vec<String> {
    folder.write("scene.pov", text);
    let read = folder.read("scene.pov").unwrap_or_else(|why| panic!("{why}\n{text}"));
    let debug = read.messages.iter().filter(|message| matches!(message.kind, MessageKind::Debug));
    debug.map(|message| message.text.clone()).collect()
}

/// Checks that the statements of `body` print the same with `own`, written as another file, and with
/// the installed file `name`.
fn same(name: &str, own: &str, body: &str) {
    let folder = Folder::new();
    folder.write("own.inc", own);
    let [ours, theirs] = ["own.inc", name]
        .map(|file| printed(&folder, &format!("#version 3.7;\n#include \"{file}\"\n{body}")));
    assert!(!ours.is_empty());
    for (ours, theirs) in ours.iter().zip(&theirs) {
        assert_eq!(ours, theirs);
    }
    assert_eq!(ours.len(), theirs.len());
}

#[test]
fn colours_are_those_of_the_standard_file() {
    let own = include_str!("../include/colors.inc");
    let names = own.lines().filter_map(|line| line.strip_prefix("#declare ")?.split(' ').next());
    let names: Vec<&str> = names.filter(|&name| name != "Colors_Inc").collect();
    assert!(names.len() > 120);
    let mut body = String::from(
        "#macro Say(C) #local K = color C; #debug concat(vstr(3, <K.red, K.green, K.blue>, \" \", 0, 6), \" \",
            str(K.filter, 0, 6), \" \", str(K.transmit, 0, 6), \"\\n\") #end\n",
    );
    for name in names {
        body += &format!("Say({name})\n");
    }
    for hue in [0, 30, 60, 119, 120, 180, 240, 300, 359] {
        body += &format!("Say(CH2RGB({hue}))\n");
    }
    for [h, s, l] in [[20.0, 0.4, 0.3], [200.0, 0.9, 0.7], [310.0, 0.1, 0.5], [90.0, 1.0, 0.1]] {
        body +=
            &format!("Say(CHSL2RGB(<{h}, {s}, {l}, 0.1, 0.2>))\nSay(CHSV2RGB(<{h}, {s}, {l}, 0.1, 0.2>))\n");
    }
    for rgb in
        ["<0.2, 0.5, 0.9>", "<0.7, 0.5, 0.1>", "<0.3, 0.8, 0.4>", "<0.5, 0.1, 0.2>", "<0.25, 0.25, 0.25>"]
    {
        body += &format!("Say(CRGB2HSL({rgb}))\nSay(CRGB2HSV({rgb}))\n");
    }
    same("colors.inc", own, &body);
}

#[test]
fn shapes_are_those_of_the_standard_file() {
    let own = include_str!("../include/shapes.inc");
    let mut shapes: Vec<String> = own
        .lines()
        .filter_map(|line| line.strip_prefix("#declare ")?.split(' ').next())
        .filter(|&name| name != "Shapes_Inc")
        .map(|name| format!("object {{ {name} }}"))
        .collect();
    assert_eq!(shapes.len(), 24);
    for call in [
        "Spheroid(<1, 0, 0.5>, <0.5, 1, 2>)",
        "Connect_Spheres(<-1, 0, 0>, 0.5, <1.1, 0.3, 0.2>, 0.8)",
        "Connect_Spheres(<-1, 0, 0>, 0.9, <1.1, 0.3, 0.2>, 0.2)",
        "Wire_Box(<1, -1, -1>, <-1.2, 1, 1.5>, 0.2, true)",
        "Round_Box(<1, -1, -1>, <-1.2, 1, 1.5>, 0.2, true)",
        "Round_Box_Union(<-1, -1, -1>, <1, 1, 1>, 0.3)",
        "Round_Cylinder(<-1, -0.5, 0>, <1, 0.5, 0.3>, 0.9, 0.2, true)",
        "object { Wedge(50) }",
        "object { Wedge(180) }",
        "object { Wedge(230) }",
        "Center_Object(sphere { <1, 2, 3>, 1 }, <1, 1, 0>)",
        "Align_Object(sphere { <1, 2, 3>, 0.5 }, <1, -1, 0>, <0.5, 0.2, 9>)",
        "union { Quad(<-1, -1, 0>, <1, -1, 0.2>, <1, 1, 0>, <-1, 1, 0.1>) }",
    ] {
        shapes.push(call.to_owned());
    }
    let mut body = String::from(
        "#macro Say(O, P, D) #local N = <0, 0, 0>; #local Q = trace(O, P, D, N);
            #debug concat(Shape, \" \", vstr(3, Q, \" \", 0, 6), \"\\n\") #end\n",
    );
    let origins = ["<0.3, 0.2, -5>", "<4, 0.35, 0.1>", "<-0.7, 5, 0.4>", "<3, 4, -5>", "<0.1, 0.15, 0.22>"];
    let ways =
        ["<0.02, 0.03, 1>", "<-1, 0.04, 0.05>", "<0.06, -1, -0.02>", "<-0.6, -0.8, 1>", "<0.3, -0.4, 0.5>"];
    for shape in &shapes {
        body += &format!("#declare Shape = \"{shape}\"; #declare S = {shape};\n");
        for (origin, way) in origins.iter().zip(ways) {
            body += &format!("Say(S, {origin}, {way})\n");
        }
    }
    body += "#declare P = 0; #debug str(Isect(-5*z, z, Sphere, P), 0, 0) #debug vstr(3, P, \" \", 0, 6)\n";
    body += "#declare A = 0; #declare B = 0; Extents(Cube, A, B) #debug vstr(3, A + 2 * B, \" \", 0, 6)\n";
    same("shapes.inc", own, &body);
}

#[test]
fn finishes_are_those_of_the_standard_file() {
    let own = include_str!("../include/finish.inc");
    let folder = Folder::new();
    folder.write("own.inc", own);
    let finishes = |file: &str| {
        let names = own.lines().filter_map(|line| line.strip_prefix("#declare ")?.split(' ').next());
        let names: Vec<&str> = names.filter(|&name| name != "Finish_Inc").collect();
        assert_eq!(names.len(), 8);
        let spheres = names.iter().map(|name| format!("sphere {{ 0, 1 finish {{ {name} }} }}\n"));
        let text = format!("#version 3.7;\n#include \"{file}\"\n{}", spheres.collect::<String>());
        folder.write("scene.pov", text);
        let read = folder.read("scene.pov").unwrap();
        read.scene.objects.iter().map(|object| format!("{:?}", object.texture)).collect::<Vec<_>>()
    };
    assert_eq!(finishes("own.inc"), finishes("finish.inc"));
}
