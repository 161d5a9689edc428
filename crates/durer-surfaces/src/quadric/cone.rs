//! The cone with its tip at the origin: both halves, unless it is clipped.
//!
//! ```text
//!   x²/a² + y²/b² - z²/c² <= 0      semi-axes a and b at the height c
//! ```
//!
//! The usual cone between two discs is [`Frustum`](crate::Frustum).

use crate::faces::chart::Chart;
use crate::faces::form::Form;
use crate::quadric::axial::{Axial, AxialError, Wall, around, positive, widest};
use crate::quadric::ellipsoid::products;
use durer_math::{Ring, Vec3};

/// An elliptic cone about the z axis.
pub type Cone = Axial<ConeWall>;

/// The semi-axes of a [`Cone`], all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeWall {
    /// The semi-axes of the ellipse, and the height at which it has them.
    pub axes: [f64; 3],
}

impl Cone {
    /// The cone with semi-axes `a` and `b` at the height `c`.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("cone", [("semi-axis a", a), ("semi-axis b", b), ("height c", c)])?;
        Ok(Self::whole(ConeWall { axes: [a, b, c] }))
    }

    /// The circular cone with `radius` at `height`.
    pub fn circular(radius: f64, height: f64) -> Result<Self, AxialError> {
        positive("circular cone", [("radius", radius), ("height", height)])?;
        Ok(Self::whole(ConeWall { axes: [radius, radius, height] }))
    }
}

impl Wall for ConeWall {
    const NAME: &'static str = "elliptic cone";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let ([x, y, z], _) = products::<T>(self.axes, k);
        Form::diagonal([x, y, -z], T::exact(0.0))
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, z: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.axes;
        widest([a, b], z, c, |r| r)
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }

    fn has_tip(&self) -> bool {
        true
    }
}
