//! On which side of the set a point is.
//!
//! A point inside a copy is inside. A point on copies' boundaries only is inside if the copies cover
//! all of a neighbourhood: polytopes, if their cones of directions cover all directions; balls, if no
//! direction leads out of all of them, since a ball bends away from its tangent plane.

use super::System;
use super::frame::CellRay;
use super::leaf::{Leaf, slabs};
use crate::planar::{cross, dot};
use crate::{LocalPoint, RingRay, Side};
use core::cmp::Ordering::{Equal, Greater, Less};
use durer_math::{Dd, Dyadic, EFloat, Ring};

type Vector = [Dyadic; 3];

impl System {
    pub(super) fn side_of(&self, point: &LocalPoint<'_>) -> Side {
        let (p, e) = point.relative_to(self.centre, self.scale);
        let cell = CellRay { o: p.to_array(), d: [0.0; 3], o_err: e.to_array(), d_err: [0.0; 3] };
        // For each copy on whose boundary the point is, the outward normals there.
        let mut cones: Vec<Vec<Vector>> = vec![];
        let mut letters = vec![];
        match self.search(point, &cell, &mut letters, &mut cones) {
            Some(side) => side,
            None if cones.is_empty() => Side::Out,
            None if covers(&cones, matches!(self.leaf, Leaf::Ball(_))) => Side::In,
            None => Side::On,
        }
    }

    /// Returns the side if it is certain; else collects the copies whose boundary holds the point.
    fn search(
        &self,
        point: &LocalPoint<'_>,
        cell: &CellRay,
        letters: &mut Vec<usize>,
        cones: &mut Vec<Vec<Vector>>,
    ) -> Option<Side> {
        let left = self.depth as usize - letters.len();
        slabs(&self.boxes[left], cell)?;
        if self.leaf_holds_all {
            self.leaf.reach(cell)?;
        }
        if left > 0 {
            for letter in 0..self.frames.len() {
                letters.push(letter);
                let below = self.frames.descend(letter, cell);
                let side = self.search(point, &below, letters, cones);
                letters.pop();
                if side.is_some() {
                    return side;
                }
            }
            return None;
        }
        let zero = || EFloat::<Dd>::zero();
        let double = self.point_in_ring::<EFloat<Dd>>(point, letters, [zero(), zero(), zero()]);
        match double.and_then(|at| inside(&self.leaf, &at)) {
            Some(Greater) => return None,
            Some(Less) => return Some(Side::In),
            _ => {}
        }
        let zero = || Dyadic::ZERO;
        let Some(at) = self.point_in_ring::<Dyadic>(point, letters, [zero(), zero(), zero()]) else {
            // This happens only for a point that is not exactly known: it may be on the boundary.
            return Some(Side::On);
        };
        match inside(&self.leaf, &at) {
            Some(Greater) => None,
            Some(Less) => Some(Side::In),
            _ => {
                cones.push(self.normals(point, &at, letters));
                None
            }
        }
    }

    /// The point, and a direction of the set's own frame, in the frame of a copy.
    fn point_in_ring<T: Ring>(
        &self,
        point: &LocalPoint<'_>,
        letters: &[usize],
        d: [T; 3],
    ) -> Option<RingRay<T>> {
        let (p, w) = point.in_ring::<T>()?;
        let c = self.centre.to_array();
        let mut i = 0;
        let o = p.map(|x| {
            let x = (x - T::exact(c[i]) * w.clone()).scale2(-self.scale);
            i += 1;
            x
        });
        Some(self.frames.descend_all(letters, RingRay { o, d, w }))
    }

    /// The outward normals, in the set's own frame, of the faces of a copy that hold a point.
    fn normals(&self, point: &LocalPoint<'_>, at: &RingRay<Dyadic>, letters: &[usize]) -> Vec<Vector> {
        let local: Vec<Vector> = match &self.leaf {
            Leaf::Polytope(faces) => faces
                .iter()
                .filter(|face| face.plane.along(at).0.is_zero())
                .map(|face| face.plane.form::<Dyadic>().0)
                .collect(),
            Leaf::Ball(ball) => vec![ball.gradient(at)],
        };
        // The images of the axes are the columns of the inverse map, times a positive number.
        let columns = [0, 1, 2].map(|j| {
            let d = [0, 1, 2].map(|i| if i == j { Dyadic::from(1.0) } else { Dyadic::ZERO });
            self.point_in_ring::<Dyadic>(point, letters, d).map_or([Dyadic::ZERO; 3].clone(), |ray| ray.d)
        });
        local.iter().map(|n| [0, 1, 2].map(|j| dot(n, &columns[j]))).collect()
    }
}

/// The side of the leaf on which a point is: `Less` inside.
fn inside<T: Ring>(leaf: &Leaf, at: &RingRay<T>) -> Option<core::cmp::Ordering> {
    match leaf {
        Leaf::Polytope(faces) => {
            let mut side = Some(Less);
            for face in faces {
                match face.plane.along(at).0.sign() {
                    Some(Greater) => return Some(Greater),
                    Some(Less) => {}
                    Some(Equal) => side = side.and(Some(Equal)),
                    None => side = None,
                }
            }
            side
        }
        Leaf::Ball(ball) => ball.along(at)[2].sign(),
    }
}

/// Whether cones cover all directions. A cone holds the directions `v` with `n.v <= 0` for all of
/// its normals; of balls (`strictly`) those with `n.v < 0`.
fn covers(cones: &[Vec<Vector>], strictly: bool) -> bool {
    if cones.len() < 2 {
        return false;
    }
    let normals: Vec<&Vector> = cones.iter().flatten().collect();
    let negative = |v: &Vector| v.clone().map(|x| -x);
    let is_zero = |v: &Vector| v.iter().all(Dyadic::is_zero);
    if strictly {
        // The directions that lead out of all balls form a cone; if it holds any, it holds the
        // intersection of two of its planes, or else all normals lie in one plane.
        let mut is_solid = false;
        for (i, a) in normals.iter().enumerate() {
            for b in &normals[..i] {
                let v = cross(a, b);
                if is_zero(&v) {
                    continue;
                }
                for v in [negative(&v), v] {
                    let signs: Vec<_> = normals.iter().map(|n| dot(n, &v).exact_sign()).collect();
                    if !signs.iter().any(|s| s.is_lt()) {
                        return false;
                    }
                    is_solid |= signs.iter().any(|s| s.is_ne());
                }
            }
        }
        return is_solid;
    }
    // All planes together cut space into cells. Each cell has an edge `v` (two planes' common
    // line, or zero if all are parallel), and from there a face in one of the planes that hold it,
    // so `v`, a little of `a` in this plane and less of its normal `b` lead into it.
    let is_in = |flag: &[&Vector; 3]| {
        cones.iter().any(|cone| {
            cone.iter().all(|n| {
                let sign = flag.iter().map(|v| dot(n, v).exact_sign()).find(|s| s.is_ne());
                sign.is_none_or(core::cmp::Ordering::is_lt)
            })
        })
    };
    let zero = [Dyadic::ZERO, Dyadic::ZERO, Dyadic::ZERO];
    for (i, n) in normals.iter().enumerate() {
        let mut edges: Vec<Vector> = vec![];
        for (j, m) in normals.iter().enumerate() {
            let v = cross(n, m);
            if i != j && !is_zero(&v) {
                edges.push(negative(&v));
                edges.push(v);
            }
        }
        if edges.is_empty() {
            edges.push(zero.clone());
        }
        for v in &edges {
            let a = cross(n, v);
            let b: Vector = (*n).clone();
            for a in [negative(&a), a] {
                for b in [negative(&b), b.clone()] {
                    if !is_in(&[v, &a, &b]) {
                        return false;
                    }
                }
            }
        }
    }
    true
}
