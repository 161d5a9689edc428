//! The paraboloids with their vertex at the origin.
//!
//! ```text
//!   elliptic     x²/a² + y²/b² - z <= 0      a bowl that opens towards +z
//!   hyperbolic   x²/a² - y²/b² - z <= 0      a saddle; the inside is above it
//! ```

use crate::quadric::axial::{Axial, AxialError, Wall, around, positive};
use crate::quadric::body::{Chart, sheared};
use crate::quadric::form::Form;
use durer_math::{Ring, Run, Vec3};

/// An elliptic paraboloid.
pub type EllipticParaboloid = Axial<Bowl>;
/// A hyperbolic paraboloid.
pub type HyperbolicParaboloid = Axial<Saddle>;

/// The semi-axes of an [`EllipticParaboloid`] at z = 1, positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bowl {
    /// The semi-axes along x and y at z = 1.
    pub axes: [f64; 2],
}

/// The semi-axes of a [`HyperbolicParaboloid`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saddle {
    /// The semi-axes along x (at z = 1) and y (at z = -1).
    pub axes: [f64; 2],
}

impl EllipticParaboloid {
    /// The paraboloid with semi-axes `a` and `b` at z = 1.
    pub fn new(a: f64, b: f64) -> Result<Self, AxialError> {
        positive("elliptic paraboloid", [("semi-axis a", a), ("semi-axis b", b)])?;
        Ok(Self::whole(Bowl { axes: [a, b] }))
    }

    /// The paraboloid of revolution with `radius` at z = 1.
    pub fn circular(radius: f64) -> Result<Self, AxialError> {
        positive("circular paraboloid", [("radius", radius)])?;
        Ok(Self::whole(Bowl { axes: [radius, radius] }))
    }
}

impl HyperbolicParaboloid {
    /// The saddle with semi-axes `a` and `b`.
    pub fn new(a: f64, b: f64) -> Result<Self, AxialError> {
        positive("hyperbolic paraboloid", [("semi-axis a", a), ("semi-axis b", b)])?;
        Ok(Self::whole(Saddle { axes: [a, b] }))
    }
}

/// `b² X² ± a² Y² - a²b² 2^-k Z`, which is the surface's `4^-k a²b² f`: x = 2^k X.
fn graph<T: Ring>(axes: [f64; 2], k: i32, saddle: bool) -> Form<T> {
    let [a, b] = axes.map(|x| T::exact(x).scale2(-k).square());
    let zero = || T::exact(0.0);
    let along = (a.clone() * b.clone()).scale2(k - 1);
    let y = if saddle { -a } else { a };
    Form { q: [b, y, zero(), zero(), zero(), zero()], b: [zero(), zero(), -along], c: zero() }
}

impl Wall for Bowl {
    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        graph(self.axes, k, false)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1])
    }

    fn half_widths(&self, z: [f64; 2]) -> [f64; 2] {
        if z[1] == f64::INFINITY {
            return [f64::INFINITY; 2];
        }
        let root = Run::<f64>::exact(z[1].max(0.0)).sqrt();
        self.axes.map(|a| (Run::exact(a) * root).hi())
    }

    fn heights(&self) -> [f64; 2] {
        [0.0, f64::INFINITY]
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }
}

impl Wall for Saddle {
    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        graph(self.axes, k, true)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    /// `u` along x, `v` along y.
    fn chart(&self, x: Vec3, n: Vec3, _: Option<[f64; 2]>) -> Chart {
        Chart { uv: [x.x, x.y], dpdu: sheared(Vec3::X, Vec3::Z, n), dpdv: sheared(Vec3::Y, Vec3::Z, n) }
    }
}
