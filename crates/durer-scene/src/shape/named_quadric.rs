//! Quadrics by their names.

/// A quadric in its principal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedQuadric {
    /// Its name.
    pub kind: QuadricKind,
    /// Its semi-axes along x, y and z; see [`QuadricKind`] for what each means. Unused ones are
    /// ignored.
    pub semi_axes: [f64; 3],
    /// The part between two planes `z = from` and `z = to`, closed by flat caps unless the object
    /// is open; all of it if absent.
    pub extent: Option<[f64; 2]>,
}

/// The quadrics that have names, with semi-axes a, b, c.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuadricKind {
    /// `x^2/a^2 + y^2/b^2 + z^2/c^2 = 1`; a spheroid if two of them are equal.
    Ellipsoid,
    /// `x^2/a^2 + y^2/b^2 = z/c`; circular if `a = b`.
    EllipticParaboloid,
    /// `x^2/a^2 - y^2/b^2 = z/c`.
    HyperbolicParaboloid,
    /// `x^2/a^2 + y^2/b^2 - z^2/c^2 = 1`.
    HyperboloidOneSheet,
    /// `z^2/c^2 - x^2/a^2 - y^2/b^2 = 1`.
    HyperboloidTwoSheets,
    /// `x^2/a^2 + y^2/b^2 = z^2/c^2`: a double cone; circular if `a = b`.
    EllipticCone,
    /// `x^2/a^2 + y^2/b^2 = 1`; circular if `a = b`.
    EllipticCylinder,
    /// `x^2/a^2 - y^2/b^2 = 1`.
    HyperbolicCylinder,
    /// `x^2/a^2 = y/b`.
    ParabolicCylinder,
}
