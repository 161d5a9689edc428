//! The hyperboloids.
//!
//! ```text
//!   one sheet    x²/a² + y²/b² - z²/c² <= 1       a cooling tower; the inside holds the axis
//!   two sheets   x²/a² + y²/b² - z²/c² <= -1      two bowls with vertices at z = ±c;
//!                                                 the inside is within the bowls
//! ```

use crate::faces::chart::Chart;
use crate::faces::form::Form;
use crate::quadric::axial::{Axial, AxialError, Wall, around, positive, widest};
use crate::quadric::ellipsoid::products;
use durer_math::{EFloat, Ring, Vec3};

/// A hyperboloid of one sheet about the z axis.
pub type HyperboloidOfOneSheet = Axial<OneSheet>;
/// A hyperboloid of two sheets along the z axis.
pub type HyperboloidOfTwoSheets = Axial<TwoSheets>;

/// The semi-axes of a [`HyperboloidOfOneSheet`], all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneSheet {
    /// The semi-axes along x, y and z.
    pub axes: [f64; 3],
}

/// The semi-axes of a [`HyperboloidOfTwoSheets`], all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoSheets {
    /// The semi-axes along x, y and z.
    pub axes: [f64; 3],
}

const NAMES: [&str; 3] = ["semi-axis a", "semi-axis b", "semi-axis c"];

impl HyperboloidOfOneSheet {
    /// The hyperboloid of one sheet: its waist at z = 0 has the semi-axes `a` and `b`.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("hyperboloid of one sheet", [(NAMES[0], a), (NAMES[1], b), (NAMES[2], c)])?;
        Ok(Self::whole(OneSheet { axes: [a, b, c] }))
    }
}

impl HyperboloidOfTwoSheets {
    /// The hyperboloid of two sheets with vertices at z = ±c.
    pub fn new(a: f64, b: f64, c: f64) -> Result<Self, AxialError> {
        positive("hyperboloid of two sheets", [(NAMES[0], a), (NAMES[1], b), (NAMES[2], c)])?;
        Ok(Self::whole(TwoSheets { axes: [a, b, c] }))
    }
}

impl Wall for OneSheet {
    const NAME: &'static str = "hyperboloid of one sheet";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let ([x, y, z], c) = products::<T>(self.axes, k);
        Form::diagonal([x, y, -z], -c)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, z: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.axes;
        widest([a, b], z, c, |r| r + EFloat::exact(1.0))
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }
}

impl Wall for TwoSheets {
    const NAME: &'static str = "hyperboloid of two sheets";

    fn form<T: Ring>(&self, k: i32) -> Form<T> {
        let ([x, y, z], c) = products::<T>(self.axes, k);
        Form::diagonal([x, y, -z], c)
    }

    fn size(&self) -> f64 {
        self.axes[0].max(self.axes[1]).max(self.axes[2])
    }

    fn half_widths(&self, z: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.axes;
        widest([a, b], z, c, |r| {
            let inside = r - EFloat::exact(1.0);
            if inside.hi() < 0.0 { EFloat::zero() } else { inside }
        })
    }

    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart {
        around(x, n, self.axes[0], self.axes[1], ends)
    }
}
