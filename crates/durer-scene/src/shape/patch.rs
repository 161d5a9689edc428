//! Bezier patches.

/// The control net of a Bezier patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The number of points in a row, and the number of rows.
    pub size: [usize; 2],
    /// The points row by row, and their weights: `[x, y, z, w]`. The parameter u runs along a row.
    pub points: Vec<[f64; 4]>,
    /// Texture coordinates at (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1).
    pub uv: [[f64; 2]; 4],
}

/// The control net of a Bezier patch over a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangularPatch {
    /// The number of points of a side: the degree plus one.
    pub side: usize,
    /// The points row by row, each row one point shorter, and their weights: `[x, y, z, w]`. The
    /// parameter u runs along a row.
    pub points: Vec<[f64; 4]>,
    /// Texture coordinates at (u, v) = (0, 0), (1, 0) and (0, 1).
    pub uv: [[f64; 2]; 3],
}
