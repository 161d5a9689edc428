//! Which faces meet at each vertex of a mesh.
//!
//! Vertices with the same coordinates count as one, whatever their numbers. Faces of zero area are
//! included, as they join the edges of their neighbours; faces with a vertex that is not finite, or
//! with two equal vertices, are not.

use super::MeshData;
use std::collections::HashMap;
use std::sync::OnceLock;

/// The faces around each vertex, and the edges where a mesh ends.
#[derive(Clone, Debug)]
pub(super) struct Fans {
    /// For each vertex the first one at the same place.
    first: Vec<u32>,
    /// The faces at a first vertex `v` are `faces[offsets[v]..offsets[v + 1]]`, ascending.
    offsets: Vec<usize>,
    faces: Vec<u32>,
    /// Edges of an odd number of faces, by their first vertices, ascending.
    borders: Vec<[u32; 2]>,
    /// The ends of these edges, ascending.
    ends: Vec<u32>,
}

impl Fans {
    fn of(data: &MeshData) -> Self {
        let mut known = HashMap::with_capacity(data.vertices.len());
        // Adding zero turns -0 into +0.
        let key = |i: usize| data.vertices[i].to_array().map(|x| (x + 0.0).to_bits());
        let first: Vec<u32> =
            (0..data.vertices.len()).map(|i| *known.entry(key(i)).or_insert(i as u32)).collect();
        drop(known);
        let mut fans =
            Self { first, offsets: Vec::new(), faces: Vec::new(), borders: Vec::new(), ends: Vec::new() };
        let corners = |face: usize| -> Option<[u32; 3]> {
            let finite = data.faces[face].iter().all(|&v| data.vertices[v as usize].is_finite());
            let [a, b, c] = fans.corners(data, face as u32);
            (finite && a != b && b != c && c != a).then_some([a, b, c])
        };
        let mut offsets = vec![0_usize; data.vertices.len() + 1];
        for v in (0..data.faces.len()).filter_map(corners).flatten() {
            offsets[v as usize + 1] += 1;
        }
        for v in 0..data.vertices.len() {
            offsets[v + 1] += offsets[v];
        }
        let mut next = offsets.clone();
        let mut faces = vec![0_u32; offsets[data.vertices.len()]];
        for (face, at) in (0..data.faces.len()).filter_map(|face| Some((face, corners(face)?))) {
            for v in at {
                faces[next[v as usize]] = face as u32;
                next[v as usize] += 1;
            }
        }
        (fans.offsets, fans.faces) = (offsets, faces);
        let mut beyond = Vec::new();
        for v in 0..data.vertices.len() as u32 {
            beyond.clear();
            for &face in fans.around(v) {
                beyond.extend(fans.corners(data, face).into_iter().filter(|&w| w > v));
            }
            beyond.sort_unstable();
            let odd = beyond.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1);
            fans.borders.extend(odd.map(|same| [v, same[0]]));
        }
        fans.ends = fans.borders.iter().flatten().copied().collect();
        fans.ends.sort_unstable();
        fans.ends.dedup();
        fans
    }

    /// The corners of a face as first vertices.
    pub(super) fn corners(&self, data: &MeshData, face: u32) -> [u32; 3] {
        data.faces[face as usize].map(|v| self.first[v as usize])
    }

    /// The faces at a first vertex.
    pub(super) fn around(&self, v: u32) -> &[u32] {
        &self.faces[self.offsets[v as usize]..self.offsets[v as usize + 1]]
    }

    /// The edges where the mesh ends.
    pub(super) fn borders(&self) -> &[[u32; 2]] {
        &self.borders
    }

    /// Whether the mesh ends at this vertex.
    pub(super) fn ends_at(&self, v: u32) -> bool {
        self.ends.binary_search(&v).is_ok()
    }

    /// Whether the mesh ends at the edge of these first vertices, the lesser number first.
    pub(super) fn ends_along(&self, edge: [u32; 2]) -> bool {
        self.borders.binary_search(&edge).is_ok()
    }
}

/// The fans of a mesh, found when a ray first meets an edge exactly. They follow from the mesh's
/// lists, so they make no difference between two meshes.
#[derive(Clone, Debug, Default)]
pub(super) struct LazyFans(OnceLock<Box<Fans>>);

impl LazyFans {
    pub(super) fn of(&self, data: &MeshData) -> &Fans {
        self.0.get_or_init(|| Box::new(Fans::of(data)))
    }
}

impl PartialEq for LazyFans {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
