//! A ray and the faces of a shell in double-double, for places where f64 cannot decide between
//! crossing and miss.

use super::cell::Cell;
use super::net::{FaceNet, Homogeneous, half, relative};
use crate::CentredRay;
use crate::degree::Domain;
use core::cell::OnceCell;
use durer_math::{Dd, EFloat};

/// A ray, computed in double-double at first use.
pub(super) struct Exact<'a> {
    at: &'a CentredRay<'a>,
    faces: &'a [FaceNet],
    /// Origin and direction, axes in the order in which the line is sheared.
    ray: OnceCell<Option<[[EFloat<Dd>; 3]; 2]>>,
    axes: [usize; 3],
}

impl<'a> Exact<'a> {
    pub(super) fn new(at: &'a CentredRay<'a>, faces: &'a [FaceNet], axes: [usize; 3]) -> Self {
        Self { at, faces, ray: OnceCell::new(), axes }
    }

    /// The numbers of control points of a face over a box, along its parameters.
    pub(super) fn size(&self, face: u32) -> Option<[usize; 2]> {
        Some(match self.faces.get(face as usize)? {
            FaceNet::Square(net) => net.size,
            FaceNet::Triangle(net) => [net.side; 2],
        })
    }

    /// Whether a box reaches beyond the third side of a face that is a triangle.
    pub(super) fn is_cut(&self, face: u32, around: &Domain) -> bool {
        self.faces.get(face as usize).is_some_and(FaceNet::is_triangle) && around[0][1] + around[1][1] > 1.0
    }

    /// The control points of the half of a cell that is in the triangle, relative to the cell's base.
    pub(super) fn half(&self, cell: &Cell) -> Option<Vec<Homogeneous<f64>>> {
        let FaceNet::Triangle(net) = self.faces.get(cell.face as usize)? else { return None };
        let to = [0, 1].map(|k| cell.from[k] + cell.width[k]);
        Some(relative(&net.part(half(cell.from, to)).points, cell.base))
    }

    /// The control points of a part of a cell, relative to the cell's base.
    pub(super) fn part(&self, cell: &Cell, from: [f64; 2], width: [f64; 2]) -> Option<Vec<Homogeneous<f64>>> {
        let in_patch = |k: usize, x: f64| x.mul_add(cell.width[k], cell.from[k]);
        let low = [0, 1].map(|k| in_patch(k, from[k]));
        let high = [0, 1].map(|k| in_patch(k, from[k] + width[k]));
        Some(self.faces.get(cell.face as usize)?.part(low, high).relative(cell.base))
    }

    /// The control values over a box of parameters of both functions that vanish at a crossing, times
    /// the third component of the direction, and bounds on their errors.
    pub(super) fn net(&self, face: u32, low: [f64; 2], high: [f64; 2]) -> Option<(Vec<[Dd; 2]>, [f64; 2])> {
        let ray = self.ray.get_or_init(|| {
            let ray = self.at.in_double()?;
            let [o, d] = [ray.o, ray.d].map(|v| self.axes.map(|axis| v[axis] / ray.w));
            Some([o, d])
        });
        let [o, d] = ray.as_ref()?;
        let face = self.faces.get(face as usize)?;
        let net = face.part(low, high);
        // The net is off by this much of its size, as cells assume.
        let lost = face.lost();
        let number = |x: Dd| EFloat::with_error(x, lost);
        let (mut out, mut e) = (Vec::with_capacity(net.points.len()), [0.0_f64; 2]);
        for p in &net.points {
            let w = number(p[3]);
            let about = |k: usize| number(p[self.axes[k]]) - o[k] * w;
            let z = about(2);
            let f = [0, 1].map(|k| about(k) * d[2] - z * d[k]);
            for k in 0..2 {
                e[k] = e[k].max(f[k].e);
            }
            out.push(f.map(|f| f.v));
        }
        e.iter().all(|e| e.is_finite()).then_some((out, e))
    }
}
