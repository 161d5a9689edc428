//! Tests of mesh files: what is read is what was written, and damage is reported with its place.

use durer_math::{Point3, Ray, Vec3};
use durer_mesh::{ErrorKind, Format, Location, Model, Topology, Warning, read_bytes};

type Read = Result<Model, ErrorKind>;

fn obj(text: &str) -> Read {
    read_bytes(text.as_bytes(), Format::Obj)
}

/// A tetrahedron whose coordinates are exact only in f64.
const CORNERS: [[f64; 3]; 4] =
    [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [0.1, 1.2, 0.3], [0.1, 0.2, 1.0 / 3.0 + 1.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// The message of a file that is refused.
fn message(read: Read) -> String {
    read.err().map_or_else(|| "it was read".into(), |error| error.to_string())
}

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
    // Binary files may begin with the first word of text files.
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
    // A corner without a normal makes the face flat; a quadrilateral is two triangles; a face of
    // two corners is a line.
    assert_eq!(second.mesh.faces.len(), 3);
    assert!(second.mesh.faces.iter().all(|f| f.normals.is_none()));
    let corners = second.mesh.faces[0].vertices.map(|v| second.mesh.vertices[v as usize]);
    assert_eq!(corners, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from));
    Ok(())
}

/// Hits have the texture coordinates of OBJ and PLY files. Faces without any get those that faces
/// have in files without texture coordinates.
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
            Some((hit.primitive.0, lowered.geometry.resolve(&ray, &hit).uv))
        };
        // A quarter of the way to the second corner, and half of the way from there to the third:
        // all small dyadic numbers.
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
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (tail, said) in [
        ("f 1 2 4", "line 4: there is no vertex 4, there are 3 so far"),
        ("vt x", "line 4: expected texture coordinates, found 'x'"),
        ("f 1 2 0", "line 4: there is no vertex 0, there are 3 so far"),
        ("f 1 2 -4", "line 4: there is no vertex -4, there are 3 so far"),
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
    assert!(ply("property double x", "property double a").contains("x, y and z"));
    let stl =
        |from: &str, to: &str| message(read_bytes(stl_text().replacen(from, to, 1).as_bytes(), Format::Stl));
    assert_eq!(stl("endloop", "vertex 1 2 3"), "line 7: expected 'endloop', found 'vertex 1 2 3'");
    assert_eq!(stl("outer loop", "vertex"), "line 3: expected 'outer loop', found 'vertex'");
    assert!(stl("0.2", "x").starts_with("line 4: expected three coordinates"));
    assert!(stl("endsolid a b", "").ends_with("the file ends where 'endsolid' should follow"));
    let mut lying = stl_binary("x");
    lying[83] = 0x80;
    assert_eq!(message(read_bytes(&lying, Format::Stl)), "the file ends before triangle 5 of 2147483652");
}

/// Some programs begin text with the byte-order mark of UTF-8.
#[test]
fn a_byte_order_mark_is_passed_over() -> Result<(), ErrorKind> {
    let marked = |text: &[u8]| [b"\xef\xbb\xbf", text].concat();
    for (bytes, format) in [
        (obj_text().into_bytes(), Format::Obj),
        (ply_text().into_bytes(), Format::Ply),
        (ply_binary(true), Format::Ply),
        (stl_text().into_bytes(), Format::Stl),
        (b" \n".iter().copied().chain(stl_text().into_bytes()).collect(), Format::Stl),
    ] {
        let model = read_bytes(&marked(&bytes), format)?;
        assert_eq!(model, read_bytes(&bytes, format)?);
        assert_eq!(model.warnings, []);
    }
    // In the header of a binary file these bytes have no special meaning.
    assert_eq!(triangles(&read_bytes(&stl_binary("\u{feff}solid"), Format::Stl)?), expected(single));
    assert_eq!(message(obj("\u{feff}\u{feff}v 0 0 0")), "line 1: expected a statement, found '\u{feff}v'");
    Ok(())
}

#[test]
fn what_is_not_there_for_a_corner_is_left_out() -> Result<(), ErrorKind> {
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let dangling = |index, what, count, uv, normals| Warning::Dangling {
        spot: Location::Line(4),
        what,
        index,
        count,
        uv,
        normals,
    };
    let (uv, normal) = ("texture coordinate", "normal");
    for (face, warning) in [
        ("f 1/1/1 2/2/2 3/3/3", dangling(1, uv, 0, 3, 3)),
        ("f 1//1 2//2 3//3", dangling(1, normal, 0, 0, 3)),
        ("f 1/0 2/0 3/0", dangling(0, uv, 0, 3, 0)),
        ("f -3/-3/-3 -2/-2/-2 -1/-1/-1", dangling(-3, uv, 0, 3, 3)),
        ("f 1 2//-9223372036854775808 3", dangling(i64::MIN, normal, 0, 0, 1)),
    ] {
        let model = obj(&format!("{three}{face}\nf 1 2 3\n"))?;
        let mesh = &model.groups[0].mesh;
        assert_eq!((mesh.faces.len(), mesh.uv_faces.len(), mesh.normals.len()), (2, 0, 0), "{face}");
        assert_eq!(model.warnings, [warning], "{face}");
    }
    // One warning for each file. A face keeps the items that all of its corners have.
    let model =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/2/1\nf 1/1/1 2/1/-2 3/1/1\n")?;
    let mesh = &model.groups[0].mesh;
    let has = |face: usize| (mesh.uv_faces[face].is_some(), mesh.faces[face].normals.is_some());
    assert_eq!([has(0), has(1)], [(false, true), (true, false)]);
    assert_eq!(
        model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["line 6: there is no texture coordinate 2, there are 1 so far; \
          1 index of texture coordinates and 1 index of normals that are not there are left out"]
    );
    Ok(())
}

#[test]
fn bytes_after_the_last_triangle_are_ignored() -> Result<(), ErrorKind> {
    for title in ["made by hand", "solid a"] {
        for more in [1, 49, 50, 117] {
            let mut bytes = stl_binary(title);
            bytes.resize(bytes.len() + more, b'x');
            let model = read_bytes(&bytes, Format::Stl)?;
            assert_eq!(triangles(&model), expected(single));
            assert_eq!(model.warnings, [Warning::Trailing { at: 284, triangles: 4, count: more }]);
        }
    }
    Ok(())
}

#[test]
fn a_binary_file_that_ends_early_says_in_which_triangle() {
    let cut = |title: &str, length: usize| message(read_bytes(&stl_binary(title)[..length], Format::Stl));
    for title in ["made by hand", "solid a"] {
        assert_eq!(cut(title, 283), "the file ends in triangle 4 of 4");
        assert_eq!(cut(title, 235), "the file ends in triangle 4 of 4");
        assert_eq!(cut(title, 234), "the file ends before triangle 4 of 4");
        assert_eq!(cut(title, 84), "the file ends before triangle 1 of 4");
        // A count of zero, whatever follows.
        let mut empty = stl_binary(title);
        empty[80] = 0;
        assert_eq!(message(read_bytes(&empty, Format::Stl)), "there are no faces in it");
        assert_eq!(message(read_bytes(&empty[..84], Format::Stl)), "there are no faces in it");
    }
    assert_eq!(
        cut("solid\0", 83),
        "byte 83: the file ends where the rest of a binary header of 84 bytes should follow"
    );
    // A text that is long enough to have a count is still a text.
    let text = stl_text();
    assert!(message(read_bytes(&text.as_bytes()[..200], Format::Stl)).starts_with("line "));
}

/// The faces of two strips on a grid of points: two rows of four, then the first of them alone.
fn strips(list: &str, encoding: &str, indices: &[i64]) -> Read {
    let mut file = format!(
        "ply\nformat {encoding} 1.0\nelement tristrips 1\nproperty list int {list} vertex_indices\n\
         element vertex 8\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    )
    .into_bytes();
    let vertices = (0..8).map(|i| [(i / 2) as f32, (i % 2) as f32, 0.0]);
    if encoding == "ascii" {
        let words: Vec<String> = indices.iter().map(ToString::to_string).collect();
        file.extend(format!("{} {}\n", indices.len(), words.join(" ")).into_bytes());
        vertices.for_each(|[x, y, z]| file.extend(format!("{x} {y} {z}\n").into_bytes()));
    } else {
        file.extend((indices.len() as i32).to_le_bytes());
        indices.iter().for_each(|&i| file.extend((i as i32).to_le_bytes()));
        vertices.flatten().for_each(|x| file.extend(x.to_le_bytes()));
    }
    read_bytes(&file, Format::Ply)
}

#[test]
fn strips_of_triangles_are_read() -> Result<(), ErrorKind> {
    // The second strip starts anew. The indices 6 6 make triangles without area, which count for
    // the alternation.
    for (indices, faces) in [
        (&[0, 2, 1, 3][..], &[[0, 2, 1], [1, 2, 3]][..]),
        (&[0, 2, 1, -1, 2, 4, 3, 5, -1], &[[0, 2, 1], [2, 4, 3], [3, 4, 5]]),
        (&[-1, -1, 0, 2, -1, 0, 2, 1], &[[0, 2, 1]]),
        (&[0, 2, 1, 1, 4, 4, 6, 5, 7], &[[0, 2, 1], [6, 4, 5], [6, 5, 7]]),
        (&[0, 2, 1, 1, 1, 4, 4, 6, 5], &[[0, 2, 1], [4, 6, 5]]),
    ] {
        for (list, encoding) in
            [("int", "ascii"), ("int", "binary_little_endian"), ("uint", "binary_little_endian")]
        {
            let model = strips(list, encoding, indices)?;
            let corner = |v: u32| [f64::from(v / 2), f64::from(v % 2), 0.0];
            let wanted: Vec<_> = faces.iter().map(|f: &[u32; 3]| f.map(corner)).collect();
            // The same triangles with the same orientation; any of the three corners may be first.
            let least_first = |mut t: [[f64; 3]; 3]| {
                let first = (0..3).min_by(|&a, &b| t[a].partial_cmp(&t[b]).unwrap()).unwrap();
                t.rotate_left(first);
                t
            };
            assert_eq!(
                triangles(&model).into_iter().map(least_first).collect::<Vec<_>>(),
                wanted.into_iter().map(least_first).collect::<Vec<_>>(),
                "{indices:?} {list} {encoding}"
            );
        }
    }
    // All triangles of a flat strip show the same side.
    let model = strips("int", "ascii", &[0, 2, 1, 3, 5, 4, 7, 6][..4])?;
    for [a, b, c] in triangles(&model) {
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        assert!(p[0] * q[1] - p[1] * q[0] > 0.0);
    }
    assert_eq!(
        message(strips("int", "ascii", &[0, 2, 9])),
        "strip 0: there is no vertex 9, there are 8 so far"
    );
    assert_eq!(
        message(strips("int", "ascii", &[0, 2, -2])),
        "strip 0: there is no vertex -2, there are 8 so far"
    );
    assert_eq!(message(strips("int", "ascii", &[0, 2, -1, 1, 3])), "there are no faces in it");
    Ok(())
}

/// A file that is cut anywhere, or has any byte changed, is read or refused.
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
    // Corners that are repeated for each face are the same corners.
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

#[test]
fn polygons_are_read_as_a_control_mesh() {
    let text = b"o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nv 2 0 0\nf 2/1 5/1 3/1\n";
    let (data, warnings) = durer_mesh::control_mesh(text).unwrap();
    assert_eq!(data.faces, [vec![0, 1, 2, 3], vec![1, 4, 2]]);
    assert_eq!((data.vertices.len(), data.uv_faces.len(), warnings.len()), (5, 2, 0));
    assert!(data.check().is_ok());
    // Texture coordinates are kept if all corners have some.
    let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3\n";
    assert!(durer_mesh::control_mesh(text).unwrap().0.uv_faces.is_empty());
    assert_eq!(durer_mesh::control_mesh(b"v 0 0 0\n"), Err(ErrorKind::Empty));
    let other = durer_mesh::read_control_mesh(std::path::Path::new("a.ply")).unwrap_err();
    assert_eq!(other.kind, ErrorKind::Polygons);
}
