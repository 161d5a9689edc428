//! The command as a shell sees it: what it exits with, and what it leaves behind.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn durer(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_durer"));
    command.args(arguments).current_dir(folder);
    command.output().unwrap_or_else(|e| panic!("durer: {e}"))
}

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap_or_else(|e| panic!("{name}: {e}"));
}

const BALL: &str =
    "camera { location -3*z look_at 0 } light_source { -9*z, 1 } sphere { 0, 1 pigment { rgb 1 } }";

#[test]
fn a_scene_becomes_a_picture_in_the_current_folder() {
    let folder = folder("picture");
    write(&folder, "ball.pov", BALL);
    let output = durer(&["render", "ball.pov", "--width", "8"], &folder);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let picture = std::fs::read(folder.join("ball.png")).unwrap_or_default();
    assert!(picture.starts_with(b"\x89PNG"));
}

#[test]
fn wrong_input_has_a_place_and_leaves_nothing() {
    let folder = folder("input");
    write(&folder, "bad.pov", "sphere { 0, 1 }\nspere { 0, 1 }\n");
    let output = durer(&["render", "bad.pov"], &folder);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("bad.pov:2:1") && said.contains("spere"), "{said}");
    assert!(!folder.join("bad.png").exists());
}

#[test]
fn wrong_usage_is_told_from_wrong_input() {
    let folder = folder("usage");
    write(&folder, "ball.pov", BALL);
    for arguments in [&["rendr", "ball.pov"][..], &["render", "ball.pov", "-o", "ball.xyz"], &["render"]] {
        let output = durer(arguments, &folder);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    }
    let output = durer(&["render", "nothing.pov"], &folder);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
}
