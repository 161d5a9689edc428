//! Typical mistakes and the messages about them.

mod support;

use support::fault;

/// The mistake, and the message about it.
const MISTAKES: &[(&str, &str)] = &[
    ("sphere { 0 pigment { rgb 1 } }", "a sphere needs a radius after its centre, found `pigment`"),
    ("sphere { pigment { rgb 1 } }", "a sphere needs its centre after `{`, found `pigment`"),
    ("sphere { 0, Raduis }", "a sphere needs a radius after its centre, found the undeclared `Raduis`"),
    ("box { -1 pigment { rgb 1 } }", "a box needs its second corner after the first, found `pigment`"),
    ("box { }", "a box needs two opposite corners, found `}`"),
    ("cylinder { 0, y }", "a cylinder needs a radius after the centres of its ends, found `}`"),
    ("cylinder { 0 }", "a cylinder needs the centre of its second end after the first, found `}`"),
    ("cone { 0, 1, y }", "a cone needs a radius after the centre of its second end, found `}`"),
    ("cone { 0 }", "a cone needs a radius after the centre of its first end, found `}`"),
    ("plane { y }", "a plane needs its distance from the origin after the normal, found `}`"),
    ("disc { 0, y }", "a disc needs a radius after its normal, found `}`"),
    ("triangle { 0, x }", "a triangle needs three corners: the third is missing, found `}`"),
    ("sphere { 0, MyRadius }", "a sphere needs a radius after its centre, found the undeclared `MyRadius`"),
    (
        "#declare MyRadius = 1; sphere { 0, MyRadios }",
        "a sphere needs a radius after its centre, found the undeclared `MyRadios` (did you mean `MyRadius`?)",
    ),
    ("Sphere { 0, 1 }", "expected an object, found the undeclared `Sphere` (did you mean `sphere`?)"),
    ("SPHERE { 0, 1 }", "expected an object, found the undeclared `SPHERE` (did you mean `sphere`?)"),
    ("spehre { 0, 1 }", "expected an object, found the undeclared `spehre` (did you mean `sphere`?)"),
    (
        "sphere { 0, 1 pigment { marbel } }",
        "expected a colour or pattern, found the undeclared `marbel` (did you mean `marble`?)",
    ),
    (
        "sphere { 0, 1 pigmnet { rgb 1 } }",
        "expected a modifier of the object, or `}`, found the undeclared `pigmnet` (did you mean `pigment`?)",
    ),
    (
        "sphere { 0, 1\nplane { y, 0 }",
        "expected a modifier of the object, or `}`, found `plane`: `sphere {` opened at 2:1 is not closed",
    ),
    (
        "union { sphere { 0, 1 } box { 0, 1 }",
        "expected a modifier of the object, or `}`, found the end of the scene: `union {` opened at 2:1 is not closed",
    ),
    (
        "sphere { 0, 1 pigment { rgb 1 }\ncamera { }",
        "expected a modifier of the object, or `}`, found `camera`: `sphere {` opened at 2:1 is not closed",
    ),
    (
        "sphere { <0, 0, 0, 1 pigment { rgb 1 } }",
        "expected `>`, found `pigment`: the `<` at 2:10 is not closed",
    ),
    ("sphere { 0, (1 + 2 }", "expected `)`, found `}`: the `(` at 2:13 is not closed"),
    ("#declare A = 1; #if (A == 1) #end", "`=` compares; there is no `==`"),
    ("#declare A = 1\nsphere { 0, A }", "a declaration of a float, vector or colour ends with `;`"),
    ("#macro M(A, B) A + B #end #declare C = M(1);", "1 is given, M needs 2 arguments: B is missing"),
    ("#macro M(A, B) A + B #end #declare C = M();", "none is given, M needs 2 arguments: A, B are missing"),
    ("#macro M(A, B) A + B #end #declare C = M;", "M is a macro: its arguments in parentheses are missing"),
    ("#declare sphere = 1;", "`sphere` is a word of the language and cannot be declared"),
    ("#declare A = 1/0; sphere { 0, A }", "this expression is not a finite number (inf)"),
    ("#declare A = sqrt(-1);", "the square root of a negative number (-1)"),
    ("#declare A = <1, 2, 3>.q;", "expected a part such as x, y, z or red after the dot"),
    ("#decalre A = 1;", "there is no directive `#decalre` (did you mean `#declare`?)"),
    ("#end", "#end stands in no block it belongs to"),
    ("#declare A = sum(i, 1, 2, i);", "not supported yet: sum"),
    ("#fopen F \"../x\" write", "\"../x\" must be a relative path without `..`"),
    ("#read (F, A)", "`F` is no open file"),
    ("bicubic_patch { flatness 0 }", "this bicubic_patch has no type: it needs `type 0` or `type 1`"),
    ("#declare P = trace(1, 0, y);", "expected an object, found a number"),
    ("cylinder { 0, 0, 1 }", "this cylinder's ends are the same point"),
    ("sphere { 0, \"one\" }", "a sphere needs a radius after its centre, found a string"),
];

#[test]
fn a_mistake_gets_the_message_that_one_would_want() {
    let mut wrong = Vec::new();
    for (text, wanted) in MISTAKES {
        let (_, _, said) = fault(text);
        if !said.starts_with(wanted) {
            wrong.push(format!("{text}\n  said:   {said}\n  wanted: {wanted}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn names_of_standard_files_are_known() {
    // Only if the files are installed.
    for (text, file) in [
        ("sphere { 0, 1 pigment { Red } }", "colors.inc"),
        ("sphere { 0, 1 texture { T_Gold_1A } }", "golds.inc"),
    ] {
        let (_, _, said) = fault(text);
        let known = std::path::Path::new("/usr/share/povray-3.7/include").join(file).exists();
        assert!(!known || said.contains(&format!("#include \"{file}\" declares it")), "{said}");
    }
}
