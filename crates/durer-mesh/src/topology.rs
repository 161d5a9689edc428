//! The topology of triangle meshes: whether they are closed.

use durer_scene::Mesh;
use durer_surfaces::MeshData;
use std::collections::HashMap;

/// How the triangles of a mesh are connected. Vertices with the same coordinates count as one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// The number of triangles without area or with a coordinate that is not finite. No ray meets
    /// them, and they do not count below.
    pub degenerate: usize,
    /// The number of triangles with the same three vertices as an earlier one.
    pub duplicates: usize,
    /// The number of edges that belong to one triangle only.
    pub open_edges: usize,
    /// The number of edges that two triangles use in the same direction: one of them faces the
    /// wrong way.
    pub turned_edges: usize,
    /// The number of edges that belong to more than two triangles.
    pub shared_edges: usize,
    /// Whether each edge is used as often in one direction as in the other.
    pub is_closed: bool,
}

impl Topology {
    /// Analyses a mesh, whose indices must be in range.
    pub fn of(mesh: &Mesh) -> Self {
        let faces: Vec<[u32; 3]> = mesh.faces.iter().map(|f| f.vertices).collect();
        let data = MeshData { vertices: mesh.vertices.clone(), faces, ..MeshData::default() };
        let Ok(built) = durer_surfaces::Mesh::new(data) else { return Self::default() };
        let mut known = HashMap::with_capacity(mesh.vertices.len());
        let welded: Vec<u32> = mesh
            .vertices
            .iter()
            .enumerate()
            // Adding zero turns -0 into +0.
            .map(|(i, v)| *known.entry(v.to_array().map(|x| (x + 0.0).to_bits())).or_insert(i as u32))
            .collect();
        let mut topology = Self { degenerate: built.dropped().len(), is_closed: true, ..Self::default() };
        let mut dropped = built.dropped().iter().peekable();
        let mut edges = Vec::with_capacity(3 * mesh.faces.len());
        let mut corners = Vec::with_capacity(mesh.faces.len());
        for (number, face) in mesh.faces.iter().enumerate() {
            if dropped.next_if(|d| **d as usize == number).is_some() {
                continue;
            }
            let [a, b, c] = face.vertices.map(|v| welded[v as usize]);
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), a < b)));
            let mut sorted = [a, b, c];
            sorted.sort_unstable();
            corners.push(sorted);
        }
        corners.sort_unstable();
        topology.duplicates = corners.windows(2).filter(|w| w[0] == w[1]).count();
        edges.sort_unstable();
        for edge in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let forward = edge.iter().filter(|e| e.2).count();
            topology.is_closed &= 2 * forward == edge.len();
            match edge.len() {
                1 => topology.open_edges += 1,
                2 => topology.turned_edges += usize::from(forward != 1),
                _ => topology.shared_edges += 1,
            }
        }
        topology
    }
}
