//! Random rays, and all roots that they have.

use durer_math::{Ray, Vec3};
use durer_surfaces::{All, LocalRay, Root, RootKind, Surface};
use durer_testkit::TestRng;

/// Draws that only these tests need.
pub(crate) trait Draws {
    /// A ray through the cube around the origin, from near and far; often along an axis, in a plane
    /// between octants, or through the origin.
    fn ray(&mut self) -> Ray;
}

impl Draws for TestRng {
    fn ray(&mut self) -> Ray {
        let mut through = self.vector();
        let mut direction = self.vector();
        match self.below(6) {
            0 => through[self.below(3) as usize] = 0.0,
            1 => {
                let axis = self.below(3) as usize;
                (through[axis], direction[axis]) = (0.0, 0.0);
            }
            2 => direction[self.below(3) as usize] = 0.0,
            3 => through = Vec3::ZERO,
            _ => {}
        }
        let back = [4.0, 5.0, 1e2, 1e6][self.below(4) as usize] / direction.length();
        Ray::new(through.to_point() - direction * back, direction)
    }
}

pub(crate) fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

/// Counts of roots, to check that the tests hit something.
#[derive(Default)]
pub(crate) struct Met {
    pub(crate) simple: usize,
    pub(crate) clusters: usize,
    pub(crate) widths: Vec<f64>,
}

impl Met {
    pub(crate) fn add(&mut self, roots: &[Root]) {
        for root in roots {
            self.simple += usize::from(root.kind == RootKind::Simple);
            self.clusters += usize::from(root.kind != RootKind::Simple);
            self.widths.push((root.hi - root.lo) / (root.t.abs() * f64::EPSILON));
        }
    }

    pub(crate) fn median(&self) -> f64 {
        let mut widths = self.widths.clone();
        widths.sort_by(f64::total_cmp);
        widths[widths.len() / 2]
    }
}
