//! The faces of a mesh by their texture coordinates: a grid over the unit square.

use durer_scene::Mesh;

/// A grid over the unit square. Each cell lists the faces whose texture coordinates may lie in it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UvGrid {
    /// The number of cells along each side.
    side: usize,
    /// Where the list of each cell begins in `faces`, and where the last one ends.
    starts: Vec<usize>,
    /// The faces of all cells, those of a cell in ascending order.
    faces: Vec<u32>,
}

/// The most cells along a side.
const MOST: usize = 1024;

impl UvGrid {
    /// Sorts the faces of a mesh.
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut side = ((mesh.faces.len() as f64).sqrt() as usize).clamp(1, MOST);
        loop {
            let mut starts = vec![0; side * side + 1];
            each_cell(mesh, side, |cell, _| starts[cell + 1] += 1);
            let entries: usize = starts.iter().sum();
            // Where large faces fill many cells, larger cells do.
            if side > 1 && entries > 8 * mesh.faces.len() + MOST {
                side /= 2;
                continue;
            }
            for cell in 0..side * side {
                starts[cell + 1] += starts[cell];
            }
            let (mut ends, mut faces) = (starts.clone(), vec![0; entries]);
            each_cell(mesh, side, |cell, face| {
                faces[ends[cell]] = face;
                ends[cell] += 1;
            });
            return Self { side, starts, faces };
        }
    }

    /// The first face at a point, with the weights of its corners.
    pub(super) fn find(&self, mesh: &Mesh, u: f64, v: f64) -> Option<(usize, [f64; 3])> {
        let cell = cell_of(v, self.side) * self.side + cell_of(u, self.side);
        let faces = self.faces.get(self.starts[cell]..self.starts[cell + 1])?;
        faces.iter().find_map(|&face| {
            let weights = weights(uv_of(mesh, face as usize)?, u, v)?;
            Some((face as usize, weights))
        })
    }
}

/// The column or row of a coordinate.
fn cell_of(at: f64, side: usize) -> usize {
    // The conversion ends at 0 and takes NaN to 0.
    ((at * side as f64) as usize).min(side - 1)
}

/// Calls `take` with each cell that a face may cover, and with the face.
fn each_cell(mesh: &Mesh, side: usize, mut take: impl FnMut(usize, u32)) {
    for face in 0..mesh.faces.len() {
        let Some(corners) = uv_of(mesh, face) else { continue };
        let range = |axis: usize| {
            let all = corners.map(|corner| corner[axis]);
            let (low, high) = (all[0].min(all[1]).min(all[2]), all[0].max(all[1]).max(all[2]));
            (high >= 0.0 && low <= 1.0).then(|| cell_of(low, side)..=cell_of(high, side))
        };
        let (Some(columns), Some(rows)) = (range(0), range(1)) else { continue };
        for row in rows {
            for column in columns.clone() {
                take(row * side + column, face as u32);
            }
        }
    }
}

/// The texture coordinates of a face's corners.
fn uv_of(mesh: &Mesh, face: usize) -> Option<[[f64; 2]; 3]> {
    let at = mesh.uv_faces.get(face).copied().flatten()?;
    let corner = |i: u32| mesh.uv.get(i as usize).copied();
    Some([corner(at[0])?, corner(at[1])?, corner(at[2])?])
}

/// The weights of a triangle's corners at a point of it; `None` outside.
fn weights([a, b, c]: [[f64; 2]; 3], u: f64, v: f64) -> Option<[f64; 3]> {
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let from_a = |p: [f64; 2]| [p[0] - a[0], p[1] - a[1]];
    let (e, f, p) = (from_a(b), from_a(c), from_a([u, v]));
    let area = cross(e, f);
    let (s, t) = (cross(p, f) / area, cross(e, p) / area);
    // Comparisons with NaN are false.
    (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then_some([1.0 - s - t, s, t])
}
