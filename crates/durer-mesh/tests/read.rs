//! Mesh files: what is read is what was written, and what is damaged is told with its place.

use durer_math::{Point3, Ray, Vec3};
use durer_mesh::{ErrorKind, Format, Location, Model, Topology, read_bytes};

type Read = Result<Model, ErrorKind>;

fn obj(text: &str) -> Read {
    read_bytes(text.as_bytes(), Format::Obj)
}

/// A tetrahedron, with coordinates that only f64 holds.
const CORNERS: [[f64; 3]; 4] =
    [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [0.1, 1.2, 0.3], [0.1, 0.2, 1.0 / 3.0 + 1.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// The triangles of a model by their corners.
fn triangles(model: &Model) -> Vec<[[f64; 3]; 3]> {
    let of = |g: &durer_mesh::Group| {
        let mesh = g.mesh.clone();
        mesh.faces
            .iter()
            .map(|f| f.vertices.map(|v| mesh.vertices[v as usize].to_array()))
            .collect::<Vec<_>>()
    };
    model.groups.iter().flat_map(of).collect()
}

fn expected(round: impl Fn(f64) -> f64) -> Vec<[[f64; 3]; 3]> {
    FACES.map(|f| f.map(|v| CORNERS[v as usize].map(&round))).to_vec()
}

fn exact(x: f64) -> f64 {
    x
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

fn obj_text() -> String {
    let vertices = CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    vertices + &FACES.map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).concat()
}

fn ply_header(format: &str, number: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty uchar red\n\
         property {number} z\nproperty {number} x\nproperty {number} y\nelement edge 1\nproperty int a\n\
         element face 4\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n"
    )
}

fn ply_text() -> String {
    let vertices = CORNERS.map(|[x, y, z]| format!("200 {z} {x} {y}\n")).concat();
    let faces = FACES.map(|[a, b, c]| format!("3 {a} {b} {c} 0.5\n")).concat();
    ply_header("ascii", "double") + &vertices + "7\n" + &faces
}

fn ply_binary(big: bool) -> Vec<u8> {
    let mut out =
        ply_header(if big { "binary_big_endian" } else { "binary_little_endian" }, "double").into_bytes();
    let mut put = |bytes: &[u8]| {
        // All numbers are written as little-endian bytes.
        let mut bytes = bytes.to_vec();
        if big {
            bytes.reverse();
        }
        out.extend(bytes);
    };
    for [x, y, z] in CORNERS {
        put(&[200]);
        [z, x, y].iter().for_each(|v| put(&v.to_le_bytes()));
    }
    put(&7_i32.to_le_bytes());
    for face in FACES {
        put(&[3]);
        face.iter().for_each(|v| put(&v.to_le_bytes()));
        put(&0.5_f32.to_le_bytes());
    }
    out
}

fn stl_text() -> String {
    let vertex = |v: u32| {
        let [x, y, z] = CORNERS[v as usize];
        format!("   vertex {x} {y} {z:e}\n")
    };
    let facet = |f: [u32; 3]| {
        format!(" facet normal 0 0 0\n  outer loop\n{}  endloop\n endfacet\n", f.map(vertex).concat())
    };
    format!("solid a b\n{}endsolid a b\n", FACES.map(facet).concat())
}

fn stl_binary(title: &str) -> Vec<u8> {
    let mut out = vec![b' '; 80];
    out[..title.len()].copy_from_slice(title.as_bytes());
    out.extend(4_u32.to_le_bytes());
    for face in FACES {
        out.extend([0; 12]);
        for v in face {
            CORNERS[v as usize].iter().for_each(|x| out.extend((*x as f32).to_le_bytes()));
        }
        out.extend([0; 2]);
    }
    out
}

#[test]
fn every_format_gives_the_triangles_that_were_written() -> Result<(), ErrorKind> {
    assert_eq!(triangles(&obj(&obj_text())?), expected(exact));
    for ply in [ply_text().into_bytes(), ply_binary(true), ply_binary(false)] {
        assert_eq!(triangles(&read_bytes(&ply, Format::Ply)?), expected(exact));
    }
    let floats = ply_text().replace("double", "float");
    assert_eq!(triangles(&read_bytes(floats.as_bytes(), Format::Ply)?), expected(single));
    assert_eq!(triangles(&read_bytes(stl_text().as_bytes(), Format::Stl)?), expected(exact));
    // Binary files may begin with the word of text files.
    for title in ["made by hand", "solid a"] {
        let model = read_bytes(&stl_binary(title), Format::Stl)?;
        assert_eq!(triangles(&model), expected(single));
        assert_eq!(model.groups[0].mesh.vertices.len(), 4);
    }
    Ok(())
}

#[test]
fn obj_statements_mean_what_they_say() -> Result<(), ErrorKind> {
    let model = obj(
        "# a comment\r\nv 0 0 0\r\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0 # and another\nvt 0 0\nvn 0 0 1\nvn 0 1 0\n\
         g  first one \ns off\nusemtl red\nf 1//1 2//2 \\\n 3//1\ng empty\no second\nf -4/1/-2 -3/1/-1 -1\nl 1 2\nf 1 2\nf 1/1 2/1 3/1 4/1\n",
    )?;
    let [first, second] = &model.groups[..] else { panic!("{model:?}") };
    assert_eq!((first.name.as_str(), second.name.as_str()), ("first one", "second"));
    assert_eq!(first.mesh.faces.len(), 1);
    let face = &first.mesh.faces[0];
    assert_eq!(
        face.normals.map(|n| n.map(|n| first.mesh.normals[n as usize])),
        Some([Vec3::Z, Vec3::Y, Vec3::Z])
    );
    // A corner without a normal makes the face flat; a quadrilateral is two triangles; a face of two corners is a line.
    assert_eq!(second.mesh.faces.len(), 3);
    assert!(second.mesh.faces.iter().all(|f| f.normals.is_none()));
    let corners = second.mesh.faces[0].vertices.map(|v| second.mesh.vertices[v as usize]);
    assert_eq!(corners, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from));
    Ok(())
}

/// Texture coordinates of OBJ and PLY files are those of the hits; faces without any have those that faces have where there are none at all.
#[test]
fn texture_coordinates_reach_the_hits() -> Result<(), Box<dyn std::error::Error>> {
    let obj = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 9 0 0\nvt 0.5 8 7\nvt 2.5\nvt 0.5 16\nf 2 4 3\nf 1/1 2/2 3/3\nf 1/1 2/2 3\n";
    let ply = |u: &str, v: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
             property float {u}\nproperty float {v}\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
             0 0 0 0.5 8\n4 0 0 2.5 0\n0 4 0 0.5 16\n3 0 1 2\n"
        )
    };
    let files = [
        (obj.to_string(), Format::Obj),
        (ply("u", "v"), Format::Ply),
        (ply("s", "t"), Format::Ply),
        (ply("texture_u", "texture_v"), Format::Ply),
    ];
    for (text, format) in files {
        let lowered = read_bytes(text.as_bytes(), format)?.into_scene(4, 3).lower()?;
        let uv = |x: f64, y: f64| {
            let ray = Ray::new(Point3::new(x, y, 5.0), -Vec3::Z);
            let hit = lowered.geometry.closest(&ray)?;
            Some((hit.primitive, lowered.geometry.resolve(&ray, &hit).uv))
        };
        // A quarter of the way to the second corner, and half of that to the third: all in small dyadic numbers.
        let face = u32::from(format == Format::Obj);
        assert_eq!(uv(1.0, 2.0), Some((face, [1.0, 10.0])), "{format:?}");
        if format == Format::Obj {
            assert_eq!(uv(4.0, 2.0).map(|hit| hit.0), Some(0));
            assert!(uv(4.0, 2.0).is_some_and(|hit| hit.1.iter().all(|x| (0.0..=1.0).contains(x))));
        }
    }
    let stl = read_bytes(stl_text().as_bytes(), Format::Stl)?;
    assert!(stl.groups[0].mesh.uv_faces.is_empty());
    Ok(())
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_value() {
    let message = |read: Read| read.map(|_| String::new()).unwrap_or_else(|e| e.to_string());
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (tail, said) in [
        ("f 1 2 4", "line 4: there is no vertex 4, there are 3 so far"),
        ("vt x", "line 4: expected texture coordinates, found 'x'"),
        ("vt 1\nf 1/2 2 3", "line 5: there is no texture coordinate 2, there are 1 so far"),
        ("f 1 2 0", "line 4: there is no vertex 0, there are 3 so far"),
        ("f 1 2 -4", "line 4: there is no vertex -4, there are 3 so far"),
        ("f 1//2 2 3", "line 4: there is no normal 2, there are 0 so far"),
        ("f 1 2 9999999999999999999", "line 4: expected a corner's indices, found '9999999999999999999'"),
        ("f 1 2 /3", "line 4: expected a corner's indices, found '/3'"),
        ("f 1///4 2 3", "line 4: expected a corner's indices, found '1///4'"),
        ("f", "line 4: the file ends where a face's corners should follow"),
        ("v 1 2", "line 4: the file ends where three coordinates should follow"),
        ("v 1 2 three", "line 4: expected three coordinates, found 'three'"),
        ("surf 0 1 0 1", "line 4: not supported yet: surf"),
        ("\u{1}\u{2}rubbish", "line 4: expected a statement, found '\u{fffd}\u{fffd}rubbish'"),
        ("", "there are no faces in it"),
    ] {
        assert_eq!(message(obj(&(three.to_string() + tail))), said);
    }
    let ply =
        |from: &str, to: &str| message(read_bytes(ply_text().replace(from, to).as_bytes(), Format::Ply));
    assert_eq!(ply("3 0 2 1", "3 0 2 4"), "face 0: there is no vertex 4, there are 4 so far");
    assert_eq!(ply("3 0 2 1", "3 0 2 -1"), "face 0: there is no vertex -1, there are 4 so far");
    assert_eq!(
        ply("face 4", "face 2147483648"),
        "the header promises 2147483648 elements 'face', but the file has room for 12"
    );
    assert!(ply("200 0.3 0.1 0.2", "200 0.3 here 0.2").starts_with("vertex 0: "));
    assert!(ply("element face", "element tristrips").contains("triangle strips"));
    assert!(ply("property double x", "property double a").contains("x, y and z"));
    let stl =
        |from: &str, to: &str| message(read_bytes(stl_text().replacen(from, to, 1).as_bytes(), Format::Stl));
    assert_eq!(stl("endloop", "vertex 1 2 3"), "line 7: expected 'endloop', found 'vertex 1 2 3'");
    assert_eq!(stl("outer loop", "vertex"), "line 3: expected 'outer loop', found 'vertex'");
    assert!(stl("0.2", "x").starts_with("line 4: expected three coordinates"));
    assert!(stl("endsolid a b", "").ends_with("the file ends where 'endsolid' should follow"));
    let mut lying = stl_binary("x");
    lying[83] = 0x80;
    assert_eq!(
        message(read_bytes(&lying, Format::Stl)),
        "the header promises 2147483652 triangles, but the file has room for 4"
    );
}

/// Cut anywhere, or with any byte changed, a file is read or refused.
#[test]
fn damaged_files_are_read_or_refused() {
    let files = [
        (obj_text().into_bytes(), Format::Obj),
        (ply_text().into_bytes(), Format::Ply),
        (ply_binary(true), Format::Ply),
        (ply_binary(false), Format::Ply),
        (stl_text().into_bytes(), Format::Stl),
        (stl_binary("made by hand"), Format::Stl),
    ];
    let mut refused = 0;
    for (bytes, format) in files {
        for cut in 0..bytes.len() {
            refused += usize::from(read_bytes(&bytes[..cut], format).is_err());
            for flip in [1, 0x80, 0xff] {
                let mut changed = bytes.clone();
                changed[cut] ^= flip;
                if let Ok(model) = read_bytes(&changed, format) {
                    check_indices(&model);
                    model.into_scene(4, 3);
                }
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

fn check_indices(model: &Model) {
    for group in &model.groups {
        let (vertices, normals) = (group.mesh.vertices.len(), group.mesh.normals.len());
        for face in &group.mesh.faces {
            assert!(face.vertices.iter().all(|v| (*v as usize) < vertices));
            assert!(face.normals.iter().flatten().all(|n| (*n as usize) < normals));
        }
    }
}

proptest::proptest! {
    #[test]
    fn noise_is_refused(bytes in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..400), head in 0..4_usize) {
        let heads: [&[u8]; 4] = [b"", b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n", b"solid ", b"v 1 2 3\nf "];
        let bytes = [heads[head], &bytes].concat();
        for format in [Format::Obj, Format::Ply, Format::Stl] {
            if let Ok(model) = read_bytes(&bytes, format) {
                check_indices(&model);
            }
        }
    }
}

#[test]
fn topology_counts_what_does_not_close() -> Result<(), ErrorKind> {
    let of = |text: &str| obj(text).map(|m| Topology::of(&m.groups[0].mesh));
    let whole = obj_text();
    let closed = Topology { is_closed: true, ..Topology::default() };
    assert_eq!(of(&whole)?, closed);
    // Corners written again for each face are the same corners.
    assert_eq!(Topology::of(&read_bytes(stl_text().as_bytes(), Format::Stl)?.groups[0].mesh), closed);
    let open = whole.replace("f 1 3 2\n", "");
    assert_eq!(of(&open)?, Topology { open_edges: 3, ..Topology::default() });
    let turned = whole.replace("f 1 3 2", "f 1 2 3");
    assert_eq!(of(&turned)?, Topology { turned_edges: 3, ..Topology::default() });
    let doubled = whole.clone() + "f 1 3 2\n";
    assert_eq!(of(&doubled)?, Topology { duplicates: 1, shared_edges: 3, ..Topology::default() });
    let degenerate = whole + "f 1 1 2\nv nan 0 0\nf 1 2 5\n";
    assert_eq!(of(&degenerate)?, Topology { degenerate: 2, ..closed });
    Ok(())
}

#[test]
fn a_scene_is_framed_and_right_handed() -> Result<(), ErrorKind> {
    for (text, format) in [(obj_text(), Format::Obj), (stl_text(), Format::Stl)] {
        let model = read_bytes(text.as_bytes(), format)?;
        let bounds = model.bounds();
        let scene = model.into_scene(640, 480);
        let camera = scene.camera.expect("a mesh file's scene has a camera");
        assert!(camera.right.cross(camera.up).dot(camera.direction) < 0.0);
        for corner in bounds.corners() {
            let to = corner - camera.location;
            let depth = to.dot(camera.direction);
            let (x, y) = (to.dot(camera.right) / depth, to.dot(camera.up) / depth);
            // Within the picture, which is `right` wide and `up` high.
            let (w, h) = (camera.right.length_squared(), camera.up.length_squared());
            assert!(depth > 0.0 && x.abs() < 0.5 * w && y.abs() < 0.5 * h, "{format:?} {corner:?}");
        }
        assert_eq!(scene.lights.len(), 1);
    }
    Ok(())
}

#[test]
fn the_place_of_an_error_prints() {
    assert_eq!(Location::Byte(3).to_string(), "byte 3");
    assert_eq!(Location::Element("face", 7).to_string(), "face 7");
}
