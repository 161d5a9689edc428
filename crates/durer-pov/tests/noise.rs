//! Random texts: the reader always ends, with a scene or with one message.

mod support;

use durer_pov::{Limits, ReadOptions};
use proptest::prelude::*;
use support::Folder;

/// Pieces of real scenes, so that random texts get past the first error.
const PIECES: &[&str] = &[
    "sphere",
    "box",
    "union",
    "object",
    "plane",
    "mesh",
    "triangle",
    "polygon",
    "cone",
    "hyperboloid",
    "ellipsoid",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "<",
    ">",
    ",",
    ";",
    "+",
    "-",
    "*",
    "/",
    "=",
    "?",
    ":",
    ".",
    "!",
    "&",
    "|",
    "0",
    "1",
    "2",
    "0.5",
    "1e3",
    "x",
    "y",
    "A",
    "B",
    "F",
    "\"s\"",
    "#declare",
    "#local",
    "#macro",
    "#end",
    "#if",
    "#else",
    "#elseif",
    "#while",
    "#for",
    "#switch",
    "#case",
    "#break",
    "#undef",
    "#ifdef",
    "#include",
    "#default",
    "#version",
    "#debug",
    "array",
    "texture",
    "pigment",
    "finish",
    "rgb",
    "color_map",
    "gradient",
    "checker",
    "texture_map",
    "transform",
    "translate",
    "rotate",
    "scale",
    "matrix",
    "interior",
    "material",
    "camera",
    "light_source",
    "clipped_by",
    "torus",
    "function",
    "rand(",
    "concat(",
    "str(",
    "vrotate(",
    "defined(",
    "F(",
    "A[",
    "from",
    "to",
    "sheets",
    "global_settings",
    "background",
    "look_at",
    "angle",
    "0>",
    "0,",
    "=1;",
    "(1)",
    "{0,1}",
];

/// A scene that uses most of the language, to be cut and shuffled.
const WHOLE: &str = include_str!("scenes/whole.pov");

fn ends(text: &str) -> Result<(), TestCaseError> {
    let folder = Folder::new();
    let path = folder.write("scene.pov", text);
    let limits = Limits { steps: 200_000, memory: 16 << 20, ..Limits::default() };
    let begin = std::time::Instant::now();
    let result = durer_pov::read(&path, &ReadOptions { limits, ..ReadOptions::default() });
    prop_assert!(begin.elapsed().as_secs() < 10);
    if let Err(error) = result {
        prop_assert!(!error.text.is_empty());
        prop_assert!(error.to_string().lines().count() < 40);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pieces_in_any_order_end(pieces in prop::collection::vec(prop::sample::select(PIECES), 0..120)) {
        ends(&pieces.join(" "))?;
    }

    #[test]
    fn any_characters_end(text in "\\PC{0,200}") {
        ends(&text)?;
    }

    #[test]
    fn a_cut_scene_ends(at in 0..WHOLE.len()) {
        ends(&WHOLE[..WHOLE.floor_char_boundary(at)])?;
    }

    #[test]
    fn a_scene_with_a_hole_ends(from in 0..WHOLE.len(), length in 1..60_usize) {
        let from = WHOLE.floor_char_boundary(from);
        let to = WHOLE.floor_char_boundary((from + length).min(WHOLE.len()));
        ends(&format!("{}{}", &WHOLE[..from], &WHOLE[to..]))?;
    }

    #[test]
    fn a_scene_with_something_else_in_it_ends(at in 0..WHOLE.len(), piece in prop::sample::select(PIECES)) {
        let at = WHOLE.floor_char_boundary(at);
        ends(&format!("{} {piece} {}", &WHOLE[..at], &WHOLE[at..]))?;
    }
}

#[test]
fn the_whole_scene_is_read() {
    let folder = Folder::new();
    folder.write("scene.pov", WHOLE);
    let read = folder.read("scene.pov").unwrap_or_else(|error| panic!("{error}"));
    assert!(read.scene.objects.len() > 20);
}
