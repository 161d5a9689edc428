//! The ellipsoid, and the spheroid: an ellipsoid of revolution.
//!
//! ```text
//!   x²/a² + y²/b² + z²/c² <= 1
//! ```

use crate::faces::chart::Chart;
use crate::faces::chart::sphere_chart;
use crate::faces::form::Form;
use crate::quadric::axial::{Axial, AxialError, Wall, positive};
use durer_math::{Ring, Vec3};

/// An ellipsoid about the origin.
pub type Ellipsoid = Axial<EllipsoidWall>;

/// The semi-axes of an [`Ellipsoid`], all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidWall {
    /// The semi-axes along x, y and z.
    pub axes: [f64; 3],
}

impl Ellipsoid {
    /// The ellipsoid with semi-axes `a`, `b`, `c` along x, y and z.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("ellipsoid", [("semi-axis a", a), ("semi-axis b", b), ("semi-axis c", c)])?;
        Ok(Self::whole(EllipsoidWall { axes: [a, b, c] }))
    }

    /// The spheroid with the radius `equator` across z and the semi-axis `pole` along it: flattened
    /// if `pole` is the smaller.
    pub fn spheroid(equator: f64, pole: f64) -> Result<Self, AxialError> {
        positive("spheroid", [("equatorial radius", equator), ("polar radius", pole)])?;
        Ok(Self::whole(EllipsoidWall { axes: [equator, equator, pole] }))
    }
}

/// `b²c² , a²c² , a²b²` and `a²b²c²`, in units of `2^k`.
pub(crate) fn products<T: Ring>(axes: [f64; 3], k: i32) -> ([T; 3], T) {
    let [a, b, c] = axes.map(|x| T::exact(x).scale2(-k).square());
    let (ab, ac, bc) = (a.clone() * b.clone(), a.clone() * c.clone(), b * c);
    let abc = a * bc.clone();
    ([bc, ac, ab], abc)
}

impl Wall for EllipsoidWall {
    const NAME: &'static str = "ellipsoid";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let (q, c) = products::<T>(self.axes, k);
        Form::diagonal(q, -c)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, _: [f64; 2]) -> [f64; 2] {
        [self.axes[0], self.axes[1]]
    }

    fn heights(&self) -> [f64; 2] {
        [-self.axes[2], self.axes[2]]
    }

    /// The surface coordinates of the sphere, scaled.
    fn chart(&self, x: Vec3, _: Vec3, _: Option<[f64; 2]>) -> Chart {
        let [a, b, c] = self.axes;
        let on_sphere = sphere_chart(Vec3::new(x.x / a, x.y / b, x.z / c));
        let stretched = |v: Vec3| Vec3::new(v.x * a, v.y * b, v.z * c);
        Chart { dpdu: stretched(on_sphere.dpdu), dpdv: stretched(on_sphere.dpdv), ..on_sphere }
    }
}
