//! Laws that hold for any bytes that are read as a mesh file.

use durer_mesh::{Format, Model, Topology, read_bytes};
use durer_scene::FaceTexture;

/// Reads the bytes. A refused file gives one short line of message. An accepted one has all indices
/// in range and can be made into a scene.
///
/// # Panics
///
/// If something does not hold.
pub(crate) fn check(bytes: &[u8], format: Format) {
    match read_bytes(bytes, format) {
        Ok(model) => sound(model),
        Err(why) => {
            let said = why.to_string();
            assert!(!said.is_empty() && said.len() < 1000 && !said.contains('\n'), "{said}");
        }
    }
}

fn sound(model: Model) {
    assert!(!model.groups.is_empty());
    for group in &model.groups {
        let mesh = &group.mesh;
        assert!(!mesh.faces.is_empty());
        for face in &mesh.faces {
            assert!(face.vertices.iter().all(|v| (*v as usize) < mesh.vertices.len()));
            assert!(face.normals.iter().flatten().all(|n| (*n as usize) < mesh.normals.len()));
            let known =
                |t: &FaceTexture| matches!(t, FaceTexture::One(t) if (*t as usize) < mesh.textures.len());
            assert!(face.texture.iter().all(known));
        }
        assert!(mesh.uv_faces.is_empty() || mesh.uv_faces.len() == mesh.faces.len());
        assert!(mesh.uv_faces.iter().flatten().flatten().all(|n| (*n as usize) < mesh.uv.len()));
        let topology = Topology::of(mesh);
        assert!(topology.degenerate <= mesh.faces.len());
        assert!(!topology.is_closed || topology.open_edges + topology.turned_edges == 0);
    }
    assert!(!model.instances.is_empty() && model.instances.iter().all(|i| i.group < model.groups.len()));
    let scene = model.into_scene(4, 3);
    assert!(!scene.objects.is_empty() && scene.camera.is_some());
}
