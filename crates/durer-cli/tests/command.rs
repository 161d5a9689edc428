//! Tests of the command as a shell sees it: its exit codes and its output files.

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

/// A tetrahedron and a copy of it, 2 to the right along `x`: as OBJ, as glTF that shows one mesh
/// twice, and as glTF with two meshes.
fn tetrahedra() -> [String; 3] {
    let obj = |dx: f64| format!("v {dx} 0 0\nv {} 0 0\nv {dx} 1 0\nv {dx} 0 1\n", dx + 1.0);
    let faces = |n: i32| {
        let face = |[a, b, c]: [i32; 3]| format!("f {} {} {}\n", n + a, n + b, n + c);
        [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]].map(face).concat()
    };
    let numbers: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]);
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    // 60 bytes become 80 characters.
    let letters = bytes.chunks(3).flat_map(|three| {
        let bits = three.iter().fold(0_usize, |bits, &b| bits << 8 | usize::from(b));
        [18, 12, 6, 0].map(|shift| char::from(LETTERS[bits >> shift & 63]))
    });
    let letters: String = letters.collect();
    let gltf = |meshes: usize| {
        let mesh = r#"{ "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 1 } ] }"#;
        format!(
            r#"{{ "asset": {{ "version": "2.0" }}, "meshes": [ {} ],
                  "nodes": [ {{ "mesh": 0 }}, {{ "mesh": {}, "translation": [2, 0, 0] }} ],
                  "accessors": [ {{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" }},
                                 {{ "bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR" }} ],
                  "bufferViews": [ {{ "buffer": 0, "byteLength": 48 }}, {{ "buffer": 0, "byteOffset": 48, "byteLength": 12 }} ],
                  "buffers": [ {{ "byteLength": 60, "uri": "data:;base64,{letters}" }} ] }}"#,
            vec![mesh; meshes].join(","),
            meshes - 1
        )
    };
    [format!("o a\n{}{}o b\n{}{}", obj(0.0), faces(0), obj(2.0), faces(4)), gltf(1), gltf(2)]
}

/// A warning names the file and the place of what is left out; the rest is read.
#[test]
fn warnings_of_a_mesh_file_name_the_file() {
    let folder = folder("mesh-warnings");
    write(&folder, "dangling.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1/1/1 2/2/2 3/3/3\n");
    let output = durer(&["check", "dangling.obj"], &folder);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "warning: dangling.obj: line 4: there is no texture coordinate 1, there are 0 so far; \
         3 indices of texture coordinates and 3 indices of normals that are not there are left out\n"
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("primitives  1\n"), "{output:?}");
}

/// The same triangles make the same picture, whatever the file's format and however often a mesh is
/// stored.
#[test]
fn a_mesh_shown_twice_looks_like_two_meshes() {
    let folder = folder("meshes");
    let names = ["two.obj", "one.gltf", "two.gltf"];
    for (name, text) in names.iter().zip(tetrahedra()) {
        write(&folder, name, &text);
    }
    let pictures = names.map(|name| {
        let png = format!("{name}.png");
        let output = durer(&["render", name, "-o", &png, "--width", "64", "--height", "48"], &folder);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        std::fs::read(folder.join(&png)).unwrap_or_default()
    });
    assert!(pictures[0].len() > 200 && pictures[0] == pictures[1] && pictures[1] == pictures[2]);
    let said = names.map(|name| {
        let output = durer(&["check", name], &folder);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    });
    let closed = said.each_ref().map(|s| s.matches("4 faces, closed: a solid").count());
    assert_eq!(closed, [2, 1, 2], "{said:?}");
    assert!(said.iter().all(|s| s.contains("objects     2")), "{said:?}");
    let held = said.each_ref().map(|s| (s.contains("primitives  4\n"), s.contains("primitives  8\n")));
    assert_eq!(held, [(false, true), (true, false), (false, true)], "{said:?}");
    assert!(said[1].contains("instances   2: with them there are 8 primitives"), "{said:?}");
}
