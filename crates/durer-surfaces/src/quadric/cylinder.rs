//! The cylinders along z.
//!
//! ```text
//!   elliptic     x²/a² + y²/b² <= 1
//!   hyperbolic   x²/a² - y²/b² <= 1      the inside is between the two sheets
//!   parabolic    x²/a² - y/b   <= 0      a trough that opens towards +y
//! ```
//!
//! The cylinder between two arbitrary points is [`CappedCylinder`](crate::CappedCylinder).

use crate::faces::chart::{Chart, sheared};
use crate::faces::form::Form;
use crate::quadric::axial::{Axial, AxialError, Wall, around, positive};
use durer_math::eft::exponent;
use durer_math::{Ring, Vec3};

/// An elliptic cylinder.
pub type EllipticCylinder = Axial<EllipticWall>;
/// A hyperbolic cylinder.
pub type HyperbolicCylinder = Axial<HyperbolicWall>;
/// A parabolic cylinder.
pub type ParabolicCylinder = Axial<ParabolicWall>;

/// The semi-axes of an [`EllipticCylinder`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticWall {
    /// The semi-axes along x and y.
    pub axes: [f64; 2],
}

/// The semi-axes of a [`HyperbolicCylinder`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HyperbolicWall {
    /// The semi-axes along x and y.
    pub axes: [f64; 2],
}

/// The semi-axes of a [`ParabolicCylinder`], positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParabolicWall {
    /// Half the width, and the y at which it is reached.
    pub axes: [f64; 2],
}

impl EllipticCylinder {
    /// The cylinder over the ellipse with semi-axes `a` and `b`.
    pub fn new(a: f64, b: f64) -> Result<Self, AxialError> {
        positive("elliptic cylinder", [("semi-axis a", a), ("semi-axis b", b)])?;
        Ok(Self::whole(EllipticWall { axes: [a, b] }))
    }

    /// The cylinder over the circle with `radius`.
    pub fn circular(radius: f64) -> Result<Self, AxialError> {
        positive("circular cylinder", [("radius", radius)])?;
        Ok(Self::whole(EllipticWall { axes: [radius, radius] }))
    }
}

impl HyperbolicCylinder {
    /// The cylinder over the hyperbola with vertices at x = ±a and asymptotes y = ±b x / a.
    pub fn new(a: f64, b: f64) -> Result<Self, AxialError> {
        positive("hyperbolic cylinder", [("semi-axis a", a), ("semi-axis b", b)])?;
        Ok(Self::whole(HyperbolicWall { axes: [a, b] }))
    }
}

impl ParabolicCylinder {
    /// The cylinder over the parabola y/b = x²/a²: `a` is half its width at y = b.
    pub fn new(a: f64, b: f64) -> Result<Self, AxialError> {
        positive("parabolic cylinder", [("semi-axis a", a), ("semi-axis b", b)])?;
        Ok(Self::whole(ParabolicWall { axes: [a, b] }))
    }
}

fn squares<T: Ring>(axes: [f64; 2], k: i32) -> [T; 2] {
    axes.map(|x| T::exact(x).scale2(-k).square())
}

impl Wall for EllipticWall {
    const NAME: &'static str = "elliptic cylinder";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let [a, b] = squares::<T>(self.axes, k);
        Form::diagonal([b.clone(), a.clone(), T::exact(0.0)], -(a * b))
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        self.axes
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }
}

impl Wall for HyperbolicWall {
    const NAME: &'static str = "hyperbolic cylinder";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let [a, b] = squares::<T>(self.axes, k);
        Form::diagonal([b.clone(), -a.clone(), T::exact(0.0)], -(a * b))
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    /// `u` along y, `v` along z.
    fn chart(&self, x: Vec3, n: Vec3, _: Option<[f64; 2]>) -> Chart {
        Chart { uv: [x.y, x.z], dpdu: sheared(Vec3::Y, Vec3::X, n), dpdv: Vec3::Z }
    }
}

impl Wall for ParabolicWall {
    const NAME: &'static str = "parabolic cylinder";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        // b X² - a² Y in units of 2^k: a²b f, times the power of two that makes its larger
        // coefficient about one.
        let [e, f] = self.axes.map(|x| exponent(x) - k);
        let [a, b] = self.axes.map(|x| T::exact(x).scale2(-exponent(x)));
        let (x, y) = (f, 2 * e - 1);
        let gain = -x.max(y);
        let zero = || T::exact(0.0);
        Form {
            q: [b.scale2(x + gain), zero(), zero(), zero(), zero(), zero()],
            b: [zero(), -a.square().scale2(y + gain), zero()],
            c: zero(),
        }
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    /// `u` along x, `v` along z.
    fn chart(&self, x: Vec3, n: Vec3, _: Option<[f64; 2]>) -> Chart {
        Chart { uv: [x.x, x.z], dpdu: sheared(Vec3::X, Vec3::Y, n), dpdv: Vec3::Z }
    }
}
