//! Tests of glTF files: what is read is what was written, and damage is reported with its place.

mod made;

use durer_math::{Affine, Point3};
use durer_mesh::{ErrorKind, Format, Location, Model, Topology, Warning, read, read_bytes};
use durer_scene::{Colour, PigmentBody, Rgb, Shape, TextureBody};
use made::{File, floats, shorts};

type Read = Result<Model, ErrorKind>;

/// A tetrahedron whose coordinates are exact in f32.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.25, 0.0], [0.0, 0.0, 3.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn corners() -> Vec<u8> {
    floats(CORNERS.as_flattened())
}

/// A file with one mesh and one node. `members` are those of the primitive beside its positions,
/// with their accessors.
fn one(members: &str, count: usize, accessors: &[(&str, &[u8])]) -> File {
    let mut file = File::default();
    let positions =
        file.accessor(&format!(r#""componentType": 5126, "count": {count}, "type": "VEC3""#), &corners());
    assert_eq!(positions, 0);
    for (about, bytes) in accessors {
        file.accessor(about, bytes);
    }
    file.list(
        "meshes",
        &format!(
            r#"{{ "name": "solid", "primitives": [ {{ "attributes": {{ "POSITION": 0 }} {members} }} ] }}"#
        ),
    );
    file.list("nodes", r#"{ "mesh": 0 }"#);
    file.list("scenes", r#"{ "nodes": [0] }"#);
    file
}

fn tetrahedron() -> File {
    let indices = FACES.as_flattened().iter().map(|&i| i as u16).collect::<Vec<_>>();
    one(
        r#", "indices": 1"#,
        4,
        &[(r#""componentType": 5123, "count": 12, "type": "SCALAR""#, &shorts(&indices))],
    )
}

fn placed(model: &Model) -> Vec<[[f64; 3]; 3]> {
    let of = |instance: &durer_mesh::Instance| {
        let mesh = &model.groups[instance.group].mesh;
        let corner = |v: u32| instance.placement.point(mesh.vertices[v as usize]).to_array();
        mesh.faces.iter().map(|f| f.vertices.map(corner)).collect::<Vec<_>>()
    };
    model.instances.iter().flat_map(of).collect()
}

fn expected(faces: &[[u32; 3]]) -> Vec<[[f64; 3]; 3]> {
    faces.iter().map(|f| f.map(|v| CORNERS[v as usize].map(f64::from))).collect()
}

fn gltf(bytes: &[u8]) -> Read {
    read_bytes(bytes, Format::Gltf)
}

fn message(read: Read) -> String {
    read.map(|model| format!("{model:?}")).unwrap_or_else(|e| e.to_string())
}

#[test]
fn text_and_binary_files_give_the_triangles_that_were_written() -> Result<(), Box<dyn std::error::Error>> {
    let file = tetrahedron();
    let folder = std::env::temp_dir().join(format!("durer-gltf-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("its buffer.bin"), [&file.bytes[..], b"more"].concat())?;
    std::fs::write(folder.join("beside.gltf"), file.text(r#", "uri": "its%20buffer.bin""#))?;
    std::fs::write(folder.join("whole.GLB"), file.glb())?;
    let models = [
        gltf(file.data().as_bytes())?,
        gltf(&file.glb())?,
        read(&folder.join("beside.gltf"))?,
        read(&folder.join("whole.GLB"))?,
    ];
    for model in &models {
        assert_eq!(placed(model), expected(&FACES));
        assert_eq!((model.groups.len(), model.groups[0].name.as_str()), (1, "solid"));
        assert_eq!(Topology::of(&model.groups[0].mesh), Topology { is_closed: true, ..Topology::default() });
    }
    for (uri, said) in [
        ("nowhere.bin", "buffer 0: 'nowhere.bin' cannot be read"),
        ("", "buffer 0: '' is no file"),
        ("/etc/passwd", "buffer 0: '/etc/passwd' is not a file beside this one"),
        ("https://x.org/b.bin", "is not a file beside this one"),
        ("data:text/plain,abc", "buffer 0: its uri has data that are not base64"),
        ("data:;base64,AAA*", "buffer 0: expected base64, found '*'"),
        ("data:;base64,AAAAA", "buffer 0: the file ends where another letter of base64 should follow"),
        ("data:;base64,AAAA", "buffer 0: it promises 72 bytes, but there is room for 3"),
    ] {
        std::fs::write(folder.join("wrong.gltf"), file.text(&format!(r#", "uri": "{uri}""#)))?;
        let said_instead =
            read(&folder.join("wrong.gltf")).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(said_instead.contains(said), "{uri}: {said_instead}");
    }
    std::fs::write(folder.join("its buffer.bin"), &file.bytes[..71])?;
    let short = read(&folder.join("beside.gltf")).map_err(|e| e.kind.to_string());
    assert_eq!(short, Err("buffer 0: it promises 72 bytes, but there is room for 71".into()));
    // A file in memory has no separate files.
    assert!(message(gltf(file.text(r#", "uri": "b.bin""#).as_bytes())).contains("another file"));
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

#[test]
fn chunks_of_other_kinds_are_passed_over() -> Result<(), ErrorKind> {
    let mut glb = tetrahedron().glb();
    glb.extend([4, 0, 0, 0]);
    glb.extend(b"WHATlast");
    let length = glb.len() as u32;
    glb[8..12].copy_from_slice(&length.to_le_bytes());
    assert_eq!(placed(&gltf(&glb)?), expected(&FACES));
    // Bytes after the declared length do not belong to the file.
    glb.extend(b"rubbish");
    assert_eq!(placed(&gltf(&glb)?), expected(&FACES));
    Ok(())
}

#[test]
fn indices_of_all_types_modes_and_none_at_all() -> Result<(), ErrorKind> {
    let order = [0_u8, 2, 1, 3];
    let fan = [[2, 1, 0], [1, 3, 0]];
    let strip = [[0, 2, 1], [2, 3, 1]];
    for (kind, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let bytes: Vec<u8> =
            order.iter().flat_map(|&i| u32::from(i).to_le_bytes()[..size].to_vec()).collect();
        let about = format!(r#""componentType": {kind}, "count": 4, "type": "SCALAR""#);
        for (mode, faces) in [(5, strip), (6, fan)] {
            let file = one(&format!(r#", "indices": 1, "mode": {mode}"#), 4, &[(&about, &bytes)]);
            assert_eq!(placed(&gltf(&file.glb())?), expected(&faces), "mode {mode}, type {kind}");
        }
    }
    assert_eq!(placed(&gltf(&one("", 3, &[]).glb())?), expected(&[[0, 1, 2]]));
    assert_eq!(placed(&gltf(&one(r#", "mode": 5"#, 4, &[]).glb())?), expected(&[[0, 1, 2], [1, 3, 2]]));
    assert_eq!(placed(&gltf(&one(r#", "mode": 6"#, 4, &[]).glb())?), expected(&[[1, 2, 0], [2, 3, 0]]));
    // Points and lines have no faces, and neither do primitives with too few corners.
    for mode in 0..4 {
        assert_eq!(gltf(&one(&format!(r#", "mode": {mode}"#), 4, &[]).glb()), Err(ErrorKind::Empty));
    }
    assert_eq!(gltf(&one(r#", "mode": 5"#, 2, &[]).glb()), Err(ErrorKind::Empty));
    Ok(())
}

/// Positions as small integers, normalised or not, with a stride, an offset, and some elements
/// replaced.
#[test]
fn components_of_all_types_strides_and_sparse_lists() -> Result<(), ErrorKind> {
    let positions = |model: &Model| model.groups[0].mesh.vertices.clone();
    let read = |about: &str, bytes: &[u8], stride: usize, offset: usize| {
        let mut file = File::default();
        file.view(bytes, Some(stride));
        file.list(
            "accessors",
            &format!(r#"{{ "bufferView": 0, "byteOffset": {offset}, "count": 3, "type": "VEC3", {about} }}"#),
        );
        file.list("meshes", r#"{ "primitives": [ { "attributes": { "POSITION": 0 } } ] }"#);
        gltf(&file.glb()).map(|m| positions(&m))
    };
    let of = |list: [[f64; 3]; 3]| list.map(Point3::from).to_vec();
    let bytes = [9, 0, 128, 127, 9, 1, 2, 3, 9, 129, 254, 255];
    assert_eq!(
        read(r#""componentType": 5120"#, &bytes, 4, 1)?,
        of([[0.0, -128.0, 127.0], [1.0, 2.0, 3.0], [-127.0, -2.0, -1.0]])
    );
    let seventh = |x: f64| x / 127.0;
    let normalized = [[0.0, -1.0, 1.0], [1.0, 2.0, 3.0].map(seventh), [-127.0, -2.0, -1.0].map(seventh)];
    assert_eq!(read(r#""componentType": 5120, "normalized": true"#, &bytes, 4, 1)?, of(normalized));
    let part = |x: u8| f64::from(x) / 255.0;
    let normalized = [[0, 128, 127].map(part), [1, 2, 3].map(part), [129, 254, 255].map(part)];
    assert_eq!(read(r#""componentType": 5121, "normalized": true"#, &bytes, 4, 1)?, of(normalized));
    let wide = shorts(&[0, 0x8000, 0x7fff, 7, 1, 2, 0xffff, 7, 5, 6, 7]);
    assert_eq!(
        read(r#""componentType": 5122"#, &wide, 8, 0)?,
        of([[0.0, -32768.0, 32767.0], [1.0, 2.0, -1.0], [5.0, 6.0, 7.0]])
    );
    assert_eq!(
        read(r#""componentType": 5123"#, &wide, 8, 0)?,
        of([[0.0, 32768.0, 32767.0], [1.0, 2.0, 65535.0], [5.0, 6.0, 7.0]])
    );
    // The last element ends where the view does. With one byte less there are two elements.
    assert_eq!(
        read(r#""componentType": 5123"#, &wide[..21], 8, 0),
        Err(ErrorKind::Room {
            spot: Location::Element("accessor", 0),
            what: "elements from byte 0 of bufferView 0".into(),
            promised: 3,
            room: 2
        })
    );
    assert!(
        message(gltf(&{
            let mut file = File::default();
            file.view(&wide, Some(5));
            file.list(
                "accessors",
                r#"{ "bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5123 }"#,
            );
            file.list("meshes", r#"{ "primitives": [ { "attributes": { "POSITION": 0 } } ] }"#);
            file.glb()
        }))
        .contains("bufferView 0: its byteStride of 5 is less than an element's 6 bytes")
    );

    for base in [r#""bufferView": 0, "#, ""] {
        let sparse = |indices: &[u8]| {
            let mut file = File::default();
            file.view(&corners(), None);
            file.view(indices, None);
            file.view(&floats(&[7.0, 8.0, 9.0, -1.0, -2.0, -3.0]), None);
            let places = r#"{ "bufferView": 1, "componentType": 5121 }"#;
            file.list("accessors", &format!(r#"{{ {base} "count": 3, "type": "VEC3", "componentType": 5126, "sparse": {{ "count": 2, "indices": {places}, "values": {{ "bufferView": 2 }} }} }}"#));
            file.list("meshes", r#"{ "primitives": [ { "attributes": { "POSITION": 0 } } ] }"#);
            gltf(&file.glb())
        };
        let rest = if base.is_empty() { [0.0; 3] } else { CORNERS[1].map(f64::from) };
        assert_eq!(positions(&sparse(&[0, 2])?), of([[7.0, 8.0, 9.0], rest, [-1.0, -2.0, -3.0]]));
        assert_eq!(message(sparse(&[0, 3])), "accessor 0: there is no element 3, there are 3 so far");
    }
    Ok(())
}

#[test]
fn normals_and_texture_coordinates_come_along() -> Result<(), ErrorKind> {
    let normals = floats(&[0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
    let uv = [0_u8, 255, 51, 0, 0, 102];
    let mut file = File::default();
    file.accessor(r#""componentType": 5126, "count": 3, "type": "VEC3""#, &corners());
    file.accessor(r#""componentType": 5126, "count": 3, "type": "VEC3""#, &normals);
    file.accessor(r#""componentType": 5121, "normalized": true, "count": 3, "type": "VEC2""#, &uv);
    // The second primitive has no texture coordinates, and the same corners as the first.
    file.list(
        "meshes",
        r#"{ "primitives": [ { "attributes": { "POSITION": 0 } },
                             { "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 } } ] }"#,
    );
    let model = gltf(&file.glb())?;
    let mesh = &model.groups[0].mesh;
    assert_eq!((mesh.vertices.len(), mesh.faces.len()), (3, 2));
    assert_eq!((mesh.faces[0].normals, mesh.faces[1].normals), (None, Some([0, 1, 2])));
    assert_eq!(mesh.normals[1].to_array(), [0.0, 1.0, 0.0]);
    assert_eq!(mesh.uv_faces, [None, Some([0, 1, 2])]);
    assert_eq!(mesh.uv, [[0.0, 1.0], [0.2, 0.0], [0.0, 0.4]]);
    Ok(())
}

#[test]
fn nodes_place_meshes_and_share_them() -> Result<(), ErrorKind> {
    let mut file = tetrahedron();
    file.lists.retain(|(name, _)| name != "nodes" && name != "scenes");
    // Rotated by 90 degrees about z, then translated; the child is scaled first.
    let half = 0.5_f32.sqrt();
    file.list(
        "nodes",
        &format!(
            r#"{{ "children": [2, 1], "rotation": [0, 0, {half}, {half}], "translation": [10, 0, 0] }}"#
        ),
    );
    file.list("nodes", r#"{ "mesh": 0, "scale": [2, 3, 4] }"#);
    file.list("nodes", r#"{ "mesh": 0, "matrix": [0,0,1,0, 1,0,0,0, 0,1,0,0, 5,6,7,1] }"#);
    file.list("nodes", r#"{ "mesh": 0, "translation": [99, 99, 99] }"#);
    file.list("scenes", r#"{ "nodes": [3] }"#);
    file.list("scenes", r#"{ "nodes": [0] }"#);
    file.list("scene", "1");
    let model = gltf(&file.glb())?;
    assert_eq!((model.groups.len(), model.instances.len()), (1, 2));
    let at = |i: usize, p: [f64; 3]| model.instances[i].placement.point(Point3::from(p));
    let near = |a: Point3, b: [f64; 3]| (a - Point3::from(b)).length() < 1e-14;
    // First the matrix, whose columns are the images of the axes: x to z, y to x, z to y.
    assert!(near(at(0, [1.0, 0.0, 0.0]), [10.0 - 6.0, 5.0, 8.0]), "{:?}", at(0, [1.0, 0.0, 0.0]));
    assert!(near(at(1, [1.0, 0.0, 0.0]), [10.0, 2.0, 0.0]), "{:?}", at(1, [1.0, 0.0, 0.0]));
    assert!(near(at(1, [0.0, 1.0, 1.0]), [7.0, 0.0, 4.0]), "{:?}", at(1, [0.0, 1.0, 1.0]));
    let bounds = model.bounds();
    assert!(
        placed(&model)
            .as_flattened()
            .iter()
            .all(|p| bounds.expanded(durer_math::Vec3::new(1e-9, 1e-9, 1e-9)).contains(Point3::from(*p)))
    );
    // One mesh, two objects.
    let objects = model.into_objects();
    let [Shape::Mesh(a), Shape::Mesh(b)] = [&objects[0].shape, &objects[1].shape] else {
        panic!("{objects:?}")
    };
    assert!(std::sync::Arc::ptr_eq(a, b) && a.inside_vector.is_some());

    // Without a default scene the first one is used; without scenes, all nodes that are nobody's
    // children; without nodes, the meshes.
    file.lists.retain(|(name, _)| name != "scene");
    let first = gltf(&file.glb())?;
    assert_eq!(first.instances.len(), 1);
    assert_eq!(first.instances[0].placement.as_translation(), Some(durer_math::Vec3::new(99.0, 99.0, 99.0)));
    file.lists.retain(|(name, _)| name != "scenes");
    assert_eq!(gltf(&file.glb())?.instances.len(), 3);
    file.lists.retain(|(name, _)| name != "nodes");
    let plain = gltf(&file.glb())?;
    assert_eq!((plain.instances.len(), plain.instances[0].placement), (1, Affine::IDENTITY));
    Ok(())
}

/// Rays have the same hits, with the same numbers and looks, whether a mesh is stored once or for
/// each node.
#[test]
fn a_mesh_that_is_shown_often_is_built_once() -> Result<(), Box<dyn std::error::Error>> {
    let shown = |meshes: usize, count: usize| {
        let mut file = tetrahedron();
        file.lists.retain(|(name, _)| name != "nodes" && name != "scenes" && name != "meshes");
        let mesh = r#"{ "primitives": [ { "attributes": { "POSITION": 0, "NORMAL": 0 }, "indices": 1, "material": 1 },
                                        { "attributes": { "POSITION": 0 }, "mode": 5, "material": 0 } ] }"#;
        (0..meshes).for_each(|_| file.list("meshes", mesh));
        file.list("materials", r#"{ "name": "white" }"#);
        file.list("materials", r#"{ "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1] } }"#);
        for i in 0..count {
            let place = format!(r#""translation": [{}, 0.5, 0], "scale": [1, -2, 0.5]"#, 4 * i);
            file.list("nodes", &format!(r#"{{ "mesh": {}, {place} }}"#, i % meshes));
        }
        gltf(&file.glb()).map(|model| model.into_scene(64, 48))
    };
    let (scene, other) = (shown(1, 2)?, shown(2, 2)?);
    let (once, twice) = (scene.lower()?, other.lower()?);
    let mut hits = 0;
    for i in 0..4000_u32 {
        let at = |k: u32, width: f64| (f64::from(i.wrapping_mul(k) % 1021) / 1021.0 - 0.25) * width;
        let (from, to) =
            (Point3::new(at(7, 8.0), at(401, 5.0), 9.0), Point3::new(at(77, 8.0), at(911, 5.0), -3.0));
        let ray = durer_math::Ray::new(from, to - from);
        let (a, b) = (once.geometry.closest(&ray), twice.geometry.closest(&ray));
        let a_told = a.as_ref().map(|hit| (hit.object, hit.primitive, hit.t.to_bits()));
        let b_told = b.as_ref().map(|hit| (hit.object, hit.primitive, hit.t.to_bits()));
        assert_eq!(a_told, b_told, "{ray:?}");
        if let Some(hit) = a {
            hits += 1;
            let look = |of: &durer_scene::Lowered| {
                let look = of.look_of(hit.object.0, hit.primitive.0).map(|l| of.looks[l.0 as usize].clone());
                look.map(|l| (l.texture, l.medium, l.is_clear))
            };
            assert!(look(&once) == look(&twice) && look(&once).is_some());
        }
    }
    assert!(hits > 200, "{hits}");
    assert_eq!((once.primitives(0), once.primitives(1), once.primitives(2)), (6, 6, 0));
    // A thousand instances need little more memory than one: a box and a placement each.
    let bytes = |count: usize| shown(1, count).map(|scene| scene.lower().map(|l| l.geometry.stats().bytes));
    let (few, many) = (bytes(2)??, bytes(1002)??);
    assert!(many - few < 1000 * 1200, "{few} {many}");
    Ok(())
}

#[test]
fn trees_of_nodes_that_are_none_are_refused() {
    let with = |nodes: &[&str], scene: &str| message(gltf(&with_nodes(nodes, scene).glb()));
    for (nodes, scene, said) in [
        (
            &[r#"{ "children": [1] }"#, r#"{ "children": [0] }"#][..],
            "0",
            "node 0: it is among its own descendants",
        ),
        (&[r#"{ "children": [0], "mesh": 0 }"#], "0", "node 0: it is among its own descendants"),
        (&[r#"{ "children": [1, 1] }"#, r#"{ "mesh": 0 }"#], "0", "node 1: it is in the tree twice"),
        (&[r#"{ "mesh": 0 }"#], "0, 0", "node 0: it is in the tree twice"),
        (&[r#"{ "mesh": 0 }"#], "1", "scene 0: there is no node 1, there are 1 so far"),
        (&[r#"{ "children": [5] }"#], "0", "node 0: there is no node 5, there are 1 so far"),
        (&[r#"{ "mesh": 7 }"#], "0", "node 0: there is no mesh 7, there are 1 so far"),
        (
            &[r#"{ "mesh": 0, "scale": [1, 0, 1] }"#],
            "0",
            "node 0: a scale of 0 in y flattens it, so its faces have no area, and there are no others",
        ),
        (
            &[r#"{ "mesh": 0, "matrix": [1,2,3,0, 2,4,6,0, 0,0,1,0, 0,0,0,1] }"#],
            "0",
            "node 0: a matrix with the determinant 0 flattens it",
        ),
        // Nodes below a flat node are checked too.
        (
            &[r#"{ "scale": [0, 0, 0], "children": [1] }"#, r#"{ "mesh": 7 }"#],
            "0",
            "node 1: there is no mesh 7, there are 1 so far",
        ),
        (
            &[r#"{ "mesh": 0, "matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1] }"#],
            "0",
            "node 0: the last row of its matrix must be 0 0 0 1",
        ),
        (
            &[r#"{ "mesh": 0, "rotation": [0, 0, 0, 0] }"#],
            "0",
            "node 0: its rotation must be finite and not zero",
        ),
        (&[r#"{ "mesh": 0, "scale": [1e-30, 1e-30, 1e-30], "children": [] }"#], "0", ""),
        (&[r#"{ "mesh": 0, "translation": [1e39, 0, 0] }"#], "0", ""),
    ] {
        assert!(with(nodes, scene).starts_with(said), "{nodes:?}: {}", with(nodes, scene));
    }
    // An infinite scale is never a valid transform.
    let infinite = r#"{ "mesh": 0, "scale": [0, 1e39, 1] }"#;
    assert!(gltf(with_nodes(&[infinite], "0").glb().as_slice()).is_err());
    // Deep, but still a tree.
    let mut file = tetrahedron();
    file.lists.retain(|(name, _)| name != "nodes");
    (0..20_000).for_each(|i| file.list("nodes", &format!(r#"{{ "children": [{}] }}"#, i + 1)));
    file.list("nodes", r#"{ "mesh": 0 }"#);
    assert_eq!(gltf(&file.glb()).map(|m| m.instances.len()), Ok(1));
}

fn with_nodes(nodes: &[&str], scene: &str) -> File {
    let mut file = tetrahedron();
    file.lists.retain(|(name, _)| name != "nodes" && name != "scenes");
    nodes.iter().for_each(|n| file.list("nodes", n));
    file.list("scenes", &format!(r#"{{ "nodes": [{scene}] }}"#));
    file
}

/// Animations hide nodes by a scale of 0.
#[test]
fn flat_nodes_are_left_out() -> Result<(), ErrorKind> {
    let plain = r#"{ "mesh": 0 }"#;
    for (nodes, scene, warnings) in [
        (&[r#"{ "mesh": 0, "scale": [0, 1, 1] }"#, plain][..], "0, 1", &[(0, "a scale of 0 in x")][..]),
        (&[plain, r#"{ "mesh": 0, "scale": [0, 3, -0.0] }"#], "0, 1", &[(1, "a scale of 0 in x and z")]),
        (&[plain, r#"{ "mesh": 0, "scale": [0, 0, 0] }"#], "1, 0", &[(1, "a scale of 0")]),
        (
            &[plain, r#"{ "mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1] }"#],
            "0, 1",
            &[(1, "a matrix with the determinant 0")],
        ),
        // Each flat node is reported once, with all nodes below it. One that shows nothing is not
        // reported.
        (
            &[
                plain,
                r#"{ "scale": [1, 0, 1], "children": [2, 3], "mesh": 0 }"#,
                r#"{ "mesh": 0, "scale": [0, 0, 1] }"#,
                r#"{ "children": [4] }"#,
                r#"{ "mesh": 0, "translation": [1, 2, 3] }"#,
                r#"{ "scale": [0, 1, 1], "children": [6] }"#,
                r#"{ "translation": [1, 2, 3] }"#,
            ],
            "0, 1, 5",
            &[(1, "a scale of 0 in y")],
        ),
    ] {
        let model = gltf(&with_nodes(nodes, scene).glb())?;
        assert_eq!(placed(&model), expected(&FACES), "{nodes:?}");
        let told: Vec<_> =
            warnings.iter().map(|&(node, how)| Warning::Flat { node, how: how.to_string() }).collect();
        assert_eq!(model.warnings, told, "{nodes:?}");
    }
    // Scales whose product underflows.
    let nested = |n: usize| format!(r#"{{ "scale": [1e-40, 1e-40, 1e-40], "children": [{n}] }}"#);
    let mut nodes: Vec<String> = (2..10).map(nested).collect();
    nodes.insert(0, r#"{ "mesh": 0 }"#.into());
    nodes.push(r#"{ "mesh": 0 }"#.into());
    let nodes: Vec<&str> = nodes.iter().map(String::as_str).collect();
    let model = gltf(&with_nodes(&nodes, "0, 1").glb())?;
    assert_eq!(placed(&model), expected(&FACES));
    assert_eq!(model.warnings, [Warning::Flat { node: 8, how: "a transform too small for a number".into() }]);
    Ok(())
}

#[test]
fn a_byte_order_mark_is_passed_over() -> Result<(), ErrorKind> {
    let text = tetrahedron().data();
    assert_eq!(gltf(format!("\u{feff}{text}").as_bytes())?, gltf(text.as_bytes())?);
    Ok(())
}

#[test]
fn materials_have_their_base_colours() -> Result<(), ErrorKind> {
    let mut file = File::default();
    file.accessor(r#""componentType": 5126, "count": 3, "type": "VEC3""#, &corners());
    let primitive = |material: &str| format!(r#"{{ "attributes": {{ "POSITION": 0 }} {material} }}"#);
    let list = [
        ", \"material\": 1",
        ", \"material\": 0",
        "",
        ", \"material\": 1",
        ", \"material\": 2",
        ", \"material\": 3",
    ];
    file.list("meshes", &format!(r#"{{ "primitives": [ {} ] }}"#, list.map(primitive).join(", ")));
    let factor = |f: &str, rest: &str| {
        format!(r#"{{ "pbrMetallicRoughness": {{ "baseColorFactor": {f}, "metallicFactor": 0.5 }} {rest} }}"#)
    };
    file.list("materials", &factor("[1, 0.5, 0.25, 0.5]", ""));
    file.list("materials", &factor("[0, 0, 1, 0.75]", r#", "alphaMode": "BLEND""#));
    file.list("materials", &factor("[0, 1, 0, 0.25]", r#", "alphaMode": "MASK""#));
    file.list("materials", r#"{ "name": "plain" }"#);
    let model = gltf(&file.glb())?;
    let mesh = &model.groups[0].mesh;
    assert_eq!(
        mesh.faces.iter().map(|f| f.texture).collect::<Vec<_>>(),
        [Some(0), Some(1), None, Some(0), Some(2), Some(3)].map(|t| t.map(durer_scene::FaceTexture::One))
    );
    let colour = |i: usize| match &mesh.textures[i].body {
        TextureBody::Layers(layers) => match layers[0].pigment.body {
            PigmentBody::Solid(colour) => colour,
            _ => panic!("{mesh:?}"),
        },
        TextureBody::Pattern(_) | TextureBody::Fields(_) => panic!("{mesh:?}"),
    };
    assert_eq!(colour(0), Colour { transmit: 0.25, ..Colour::opaque(Rgb::new(0.0, 0.0, 1.0)) });
    assert_eq!(colour(1), Colour::opaque(Rgb::new(1.0, 0.5, 0.25)));
    assert_eq!(colour(2), Colour { transmit: 1.0, ..Colour::opaque(Rgb::new(0.0, 1.0, 0.0)) });
    assert_eq!(colour(3), Colour::opaque(Rgb::WHITE));
    Ok(())
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_value() {
    let whole = tetrahedron().data();
    for (from, to, said) in [
        (r#""version": "2.0""#, r#""version": "1.0""#, "asset 0: not supported yet: version 1.0 of glTF"),
        (r#""asset""#, r#""asser""#, "JSON, line"),
        ("[", "(", "JSON, line"),
        (
            r#""scenes""#,
            r#""extensionsRequired": ["KHR_draco_mesh_compression"], "scenes""#,
            "extensionsRequired 0: not supported yet: KHR_draco_mesh_compression",
        ),
        (
            r#""POSITION": 0"#,
            r#""POSITION": 9"#,
            "mesh 0, primitive 0: there is no accessor 9, there are 2 so far",
        ),
        (r#""POSITION""#, r#""POSITIONS""#, "mesh 0, primitive 0: it has no POSITION"),
        (
            r#""POSITION": 0"#,
            r#""POSITION": 0, "NORMAL": 1"#,
            "accessor 1: the primitive has 4 positions, but 12 of these",
        ),
        (r#""POSITION": 0"#, r#""POSITION": 1"#, "accessor 1: its type should be of 3 components"),
        (r#""indices": 1"#, r#""indices": 0"#, "accessor 0: indices must be whole numbers without a sign"),
        (r#""indices": 1"#, r#""indices": 1, "mode": 9"#, "mesh 0, primitive 0: its mode is unknown"),
        (
            r#""indices": 1"#,
            r#""indices": 1, "material": 0"#,
            "mesh 0, primitive 0: there is no material 0, there are 0 so far",
        ),
        (r#""componentType": 5123"#, r#""componentType": 5130"#, "accessor 1: its componentType is unknown"),
        (
            r#""count": 12"#,
            r#""count": 11"#,
            "mesh 0, primitive 0: 11 corners are not those of whole triangles",
        ),
        (
            r#""count": 12"#,
            r#""count": 13"#,
            "accessor 1: it promises 13 elements from byte 0 of bufferView 1, but there is room for 12",
        ),
        (
            r#""count": 12"#,
            r#""count": 2147483648"#,
            "accessor 1: it promises 2147483648 elements from byte 0 of bufferView 1, but there is room for 12",
        ),
        (r#""count": 4,"#, r#""count": 3,"#, "accessor 1: there is no vertex 3, there are 3 so far"),
        (r#""count": 4,"#, r#""count": -4,"#, "JSON, line"),
        (
            r#""bufferView": 0"#,
            r#""bufferView": 2"#,
            "accessor 0: there is no bufferView 2, there are 2 so far",
        ),
        (
            r#""bufferView": 0"#,
            r#""bufferView": 0, "byteOffset": 18446744073709551615"#,
            "accessor 0: it promises 4 elements from byte 18446744073709551615 of bufferView 0, but there is room for 0",
        ),
        (
            r#""byteLength": 48"#,
            r#""byteLength": 73"#,
            "bufferView 0: it promises 73 bytes from byte 0 of buffer 0, but there is room for 72",
        ),
        (
            r#""byteOffset": 48"#,
            r#""byteOffset": 18446744073709551615"#,
            "bufferView 1: it promises 24 bytes from byte 18446744073709551615 of buffer 0, but there is room for 0",
        ),
        (
            r#""byteLength": 72"#,
            r#""byteLength": 2147483648"#,
            "buffer 0: it promises 2147483648 bytes, but there is room for 72",
        ),
        (r#""buffer": 0"#, r#""buffer": 1"#, "bufferView 0: there is no buffer 1, there are 1 so far"),
    ] {
        assert!(whole.contains(from), "{from}");
        let said_instead = message(gltf(whole.replacen(from, to, 1).as_bytes()));
        assert!(said_instead.starts_with(said), "{to}: {said_instead}");
    }
    let list = |material: &str| {
        let mut file = one(r#", "material": 0"#, 3, &[]);
        file.list("materials", material);
        message(gltf(&file.glb()))
    };
    assert_eq!(
        list(r#"{ "pbrMetallicRoughness": { "baseColorFactor": [0, 2, 0, 1] } }"#),
        "material 0: its baseColorFactor must be from 0 to 1, got 2"
    );
    assert_eq!(list(r#"{ "alphaMode": "GLASS" }"#), "material 0: its alphaMode is unknown");
    let glb = tetrahedron().glb();
    let with = |at: usize, word: u32| {
        let mut bytes = glb.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        message(gltf(&bytes))
    };
    let (length, text) = (glb.len(), glb.len() - 12 - 8 - 8 - 72);
    assert_eq!(with(4, 1), "byte 4: not supported yet: version 1 of glTF");
    assert_eq!(
        with(8, 0x8000_0000),
        format!("the header promises 2147483648 bytes, but the file has room for {length}")
    );
    assert_eq!(with(8, 3), format!("byte {length}: the file ends where the chunk JSON should follow"));
    assert_eq!(
        with(12, u32::MAX),
        format!(
            "the header promises 4294967295 bytes in its chunk JSON, but the file has room for {}",
            length - 20
        )
    );
    assert_eq!(with(16, 0), "byte 16: expected the chunk JSON, found '\u{fffd}\u{fffd}\u{fffd}\u{fffd}'");
    assert_eq!(
        with(20 + text, 73),
        "the header promises 73 bytes in its chunk BIN, but the file has room for 72"
    );
    assert_eq!(with(24 + text, 0), "buffer 0: it has no uri, and the file has no chunk BIN for it");
    assert!(message(gltf(b"")).starts_with("JSON, line 1"));
}

/// A small file that refers to the same lists again and again could fill any memory.
#[test]
fn lists_that_are_used_over_and_over_are_refused() {
    let mut file = File::default();
    let count = 3000;
    file.accessor(
        &format!(r#""componentType": 5126, "count": {count}, "type": "VEC3""#),
        &floats(&vec![1.0; 3 * count]),
    );
    let primitives = vec![r#"{ "attributes": { "POSITION": 0 } }"#; 3000].join(",");
    file.list("meshes", &format!(r#"{{ "primitives": [{primitives}] }}"#));
    let bytes = file.glb();
    let most = 16 * bytes.len() as u64;
    assert!(
        matches!(gltf(&bytes), Err(ErrorKind::Repeated { made, most: m }) if m == most && made > most && made < most + 2000)
    );
    // Clear faces count once for each node that shows them.
    let glass = |mode: &str| {
        let mut file = File::default();
        let about = r#""componentType": 5126, "count": 3000, "type": "VEC3""#;
        file.accessor(about, &floats(&vec![1.0; 9000]));
        file.list(
            "meshes",
            r#"{ "primitives": [ { "attributes": { "POSITION": 0 }, "mode": 5, "material": 0 } ] }"#,
        );
        file.list("materials", &format!(r#"{{ "pbrMetallicRoughness": {{ "baseColorFactor": [1, 1, 1, 0.5] }}, "alphaMode": "{mode}" }}"#));
        (0..22_400).for_each(|_| file.list("nodes", r#"{ "mesh": 0 }"#));
        gltf(&file.glb()).map(|model| model.instances.len())
    };
    assert_eq!(glass("OPAQUE"), Ok(22_400));
    let said = glass("BLEND").map_err(|e| e.to_string());
    assert_eq!(
        said,
        Err("mesh 0: not supported yet: 67110230 clear faces, counted as often as they are shown".into())
    );
    // Zeros that are not stored in the file.
    let none = |count: &str| {
        let mut file = File::default();
        file.list("accessors", &format!(r#"{{ "componentType": 5126, "count": {count}, "type": "VEC3" }}"#));
        file.list("meshes", r#"{ "primitives": [ { "attributes": { "POSITION": 0 } } ] }"#);
        message(gltf(&file.glb()))
    };
    assert!(
        none("4000000000").starts_with("accessor 0: it promises 4000000000 elements without a bufferView")
    );
    assert!(
        none("18446744073709551615")
            .starts_with("accessor 0: it promises 18446744073709551615 elements without")
    );
}

/// A file that uses every feature.
fn rich() -> File {
    let mut file = tetrahedron();
    file.accessor(r#""componentType": 5126, "count": 4, "type": "VEC3""#, &corners());
    file.accessor(
        r#""componentType": 5121, "normalized": true, "count": 4, "type": "VEC2""#,
        &[1, 2, 3, 4, 5, 6, 7, 8],
    );
    file.view(&[1, 3], None);
    file.view(&corners()[..24], None);
    file.list("accessors", r#"{ "bufferView": 0, "count": 4, "type": "VEC3", "componentType": 5126, "sparse": { "count": 2, "indices": { "bufferView": 4, "componentType": 5121 }, "values": { "bufferView": 5 } } }"#);
    file.list("meshes", r#"{ "primitives": [ { "attributes": { "POSITION": 4, "NORMAL": 2, "TEXCOORD_0": 3 }, "mode": 5, "material": 0 } ] }"#);
    file.list(
        "materials",
        r#"{ "pbrMetallicRoughness": { "baseColorFactor": [1, 0.5, 0, 0.5] }, "alphaMode": "BLEND" }"#,
    );
    file.lists.retain(|(name, _)| name != "nodes");
    file.list("nodes", r#"{ "mesh": 0, "children": [1, 2] }"#);
    file.list("nodes", r#"{ "mesh": 1, "rotation": [0, 0, 0, 1], "scale": [1, 2, 1] }"#);
    file.list("nodes", r#"{ "mesh": 1, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1] }"#);
    file
}

#[path = "corpus/case.rs"]
mod case;

/// A file that is cut anywhere, has any bit changed, or any number replaced by an extreme one, is
/// read or refused.
#[test]
fn damaged_files_are_read_or_refused() {
    let file = rich();
    assert_eq!(gltf(&file.glb()).map(|m| (m.groups.len(), m.instances.len())), Ok((2, 3)));
    for whole in [file.glb(), file.data().into_bytes()] {
        for cut in 0..whole.len() {
            case::check(&whole[..cut], Format::Gltf);
            assert!(gltf(&whole[..cut]).is_err(), "cut at {cut}");
            for flip in [1, 4, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[cut] ^= flip;
                case::check(&changed, Format::Gltf);
            }
        }
    }
    let text = file.text("");
    let numbers = made::numbers(&text);
    assert!(numbers.len() > 60, "{}", numbers.len());
    let mut refused = 0;
    for place in numbers {
        for wild in [
            "0",
            "1",
            "-1",
            "3",
            "255",
            "2147483648",
            "4294967295",
            "4294967296",
            "18446744073709551615",
            "1e400",
            "1e-300",
            "-0.0",
            "1.5",
            "null",
            "\"x\"",
            "[]",
            "{}",
        ] {
            let mut changed = text.clone();
            changed.replace_range(place.clone(), wild);
            let glb = made::glb(&changed, &file.bytes);
            refused += usize::from(gltf(&glb).is_err());
            case::check(&glb, Format::Gltf);
        }
    }
    assert!(refused > 900, "{refused}");
}
