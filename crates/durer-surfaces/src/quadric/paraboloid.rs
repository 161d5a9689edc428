//! The paraboloids with their vertex at the origin.
//!
//! ```text
//!   elliptic     x²/a² + y²/b² - z/c <= 0      a bowl that opens towards +z
//!   hyperbolic   x²/a² - y²/b² - z/c <= 0      a saddle; the inside is above it
//! ```

use crate::faces::chart::{Chart, sheared};
use crate::faces::form::Form;
use crate::quadric::axial::{Axial, AxialError, Wall, around, positive};
use durer_math::eft::exponent;
use durer_math::{EFloat, Ring, Vec3};

/// An elliptic paraboloid.
pub type EllipticParaboloid = Axial<Bowl>;
/// A hyperbolic paraboloid.
pub type HyperbolicParaboloid = Axial<Saddle>;

/// The semi-axes of an [`EllipticParaboloid`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bowl {
    /// The semi-axes of the ellipse, and the height at which it has them.
    pub axes: [f64; 3],
}

/// The semi-axes of a [`HyperbolicParaboloid`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saddle {
    /// The semi-axes along x (at z = c) and y (at z = -c), and the height c.
    pub axes: [f64; 3],
}

impl EllipticParaboloid {
    /// The paraboloid with semi-axes `a` and `b` at the height `c`.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("elliptic paraboloid", [("semi-axis a", a), ("semi-axis b", b), ("height c", c)])?;
        Ok(Self::whole(Bowl { axes: [a, b, c] }))
    }

    /// The paraboloid of revolution with `radius` at `height`.
    pub fn circular(radius: f64, height: f64) -> Result<Self, AxialError> {
        positive("circular paraboloid", [("radius", radius), ("height", height)])?;
        Ok(Self::whole(Bowl { axes: [radius, radius, height] }))
    }
}

impl HyperbolicParaboloid {
    /// The saddle with semi-axes `a` at the height `c` and `b` at the height `-c`.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("hyperbolic paraboloid", [("semi-axis a", a), ("semi-axis b", b), ("height c", c)])?;
        Ok(Self::whole(Saddle { axes: [a, b, c] }))
    }
}

/// `b²c X² ± a²c Y² - a²b² Z` in units of `2^k`: the surface's `a²b²c f`, times the power of two
/// that makes its largest coefficient about one.
fn graph<T: Ring>(axes: [f64; 3], k: i32, saddle: bool) -> Form<T> {
    let [e, f, g] = axes.map(|x| exponent(x) - k);
    // Each number is first scaled by its own power of two, so that no product leaves the range.
    let [a, b, c] = axes.map(|x| T::exact(x).scale2(-exponent(x)));
    let (x, y, z) = (2 * f + g, 2 * e + g, 2 * e + 2 * f - 1);
    let gain = -x.max(y).max(z);
    let (a, b) = (a.square(), b.square());
    let along = (a.clone() * b.clone()).scale2(z + gain);
    let (x, y) = ((b * c.clone()).scale2(x + gain), (a * c).scale2(y + gain));
    let zero = || T::exact(0.0);
    let q = [x, if saddle { -y } else { y }, zero(), zero(), zero(), zero()];
    Form { q, b: [zero(), zero(), -along], c: zero() }
}

impl Wall for Bowl {
    const NAME: &'static str = "elliptic paraboloid";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        graph(self.axes, k, false)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, z: [f64; 2]) -> [f64; 2] {
        if z[1] == f64::INFINITY {
            return [f64::INFINITY; 2];
        }
        let [a, b, c] = self.axes;
        let root = (EFloat::<f64>::exact(z[1].max(0.0)) / EFloat::exact(c)).sqrt();
        [a, b].map(|a| (EFloat::exact(a) * root).hi())
    }

    fn heights(&self) -> [f64; 2] {
        [0.0, f64::INFINITY]
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }
}

impl Wall for Saddle {
    const NAME: &'static str = "hyperbolic paraboloid";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        graph(self.axes, k, true)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    /// `u` along x, `v` along y.
    fn chart(&self, x: Vec3, n: Vec3, _: Option<[f64; 2]>) -> Chart {
        Chart { uv: [x.x, x.y], dpdu: sheared(Vec3::X, Vec3::Z, n), dpdv: sheared(Vec3::Y, Vec3::Z, n) }
    }
}
