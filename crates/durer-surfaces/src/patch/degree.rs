//! How often `F` turns around zero along the border of a box of parameters (`crate::degree`), in
//! double-double: the border's four curves are Bezier curves in the plane of `F`.
//!
//! A curve is halved until its control values, and so the curve, are in a half plane: towards the
//! control value farthest from zero, away from it, or on one side of the line through it. The half
//! planes of neighbours have a point in common.

use super::exact::Exact;
use crate::degree::{Domain, eighth, turns};
use core::cmp::Ordering;
use durer_math::{Dd, U};
use durer_roots::two_unknowns::ROUNDED;

/// The most stretches of the border, and how often one is halved.
const MOST: usize = 128;
const HALVINGS: u32 = 16;
/// A bound on the relative error of a sum or a product.
const UNIT: f64 = 4.0 * U * U;

/// A stretch of the border: its control values.
type Stretch = Vec<[Dd; 2]>;

/// How many times `F` turns around zero along the border of a box in a face, by the orientation of the
/// parameters; `None` if it may be zero there.
pub(super) fn turns_around(exact: &Exact<'_>, face: u32, around: &Domain) -> Option<i32> {
    let [low, high] = [0, 1].map(|end| around.map(|ends| ends[end]));
    let (f, e) = exact.net(face, low, high)?;
    let nu = exact.size(face)?[0];
    let last = f.len() - nu;
    let mut columns = [0, nu - 1].map(|u| f.iter().copied().skip(u).step_by(nu).collect::<Stretch>());
    columns[0].reverse();
    let [left, right] = columns;
    let (bottom, top) = (f[..nu].to_vec(), f[last..].iter().rev().copied().collect());
    let border = [bottom, right, top, left];
    let size = |p: &[Dd; 2]| p[0].to_f64().abs().max(p[1].to_f64().abs());
    let most = border.iter().flatten().map(size).fold(0.0, f64::max);
    let far = *border.iter().flatten().find(|p| size(p) == most)?;
    // Each halving rounds as often as a curve has points.
    let rounding = f64::from(HALVINGS) * nu.max(f.len() / nu) as f64 * UNIT * most;
    let far_size = far.map(|x| x.to_f64().abs());
    let along_err = far_size[0].mul_add(e[0] + rounding, far_size[1] * (e[1] + rounding));
    let across_err = far_size[0].mul_add(e[1] + rounding, far_size[1] * (e[0] + rounding));
    // The combinations round, too.
    let rounds = 3.0 * UNIT * (far_size[0] + far_size[1]) * most;
    let place = |stretch: &[[Dd; 2]]| {
        let sign = |value: &dyn Fn(&[Dd; 2]) -> Dd, err: f64| {
            let room = (err + rounds) * ROUNDED;
            let of = |p: &[Dd; 2]| match value(p).to_f64() {
                x if x > room => Ordering::Greater,
                x if x < -room => Ordering::Less,
                _ => Ordering::Equal,
            };
            let first = of(&stretch[0]);
            if stretch.iter().all(|p| of(p) == first) { first as i8 } else { 0 }
        };
        let along = sign(&|p| far[0] * p[0] + far[1] * p[1], along_err);
        let across = sign(&|p| far[0] * p[1] - far[1] * p[0], across_err);
        eighth((along, across))
    };
    let mut open: Vec<(Stretch, u32)> = border.into_iter().rev().map(|curve| (curve, 0)).collect();
    let mut eighths = Vec::new();
    while let Some((stretch, halved)) = open.pop() {
        match place(&stretch) {
            Some(eighth) => eighths.push(eighth),
            None if halved == HALVINGS || eighths.len() + open.len() > MOST => return None,
            None => {
                let [first, second] = halves(stretch);
                open.push((second, halved + 1));
                open.push((first, halved + 1));
            }
        }
    }
    turns(eighths.into_iter())
}

/// Both halves of a curve, by de Casteljau's algorithm.
fn halves(mut curve: Stretch) -> [Stretch; 2] {
    let mut first = Vec::with_capacity(curve.len());
    for level in (0..curve.len()).rev() {
        first.push(curve[0]);
        for k in 0..level {
            curve[k] = [0, 1].map(|c| (curve[k][c] + curve[k + 1][c]) * 0.5);
        }
    }
    [first, curve]
}
