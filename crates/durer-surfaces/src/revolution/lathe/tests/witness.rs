//! The oracle: exact crossings of a lathe, by polynomials of its own.

use super::super::LatheSpline;
use crate::laws::exact_polynomial::{Poly, scaled, sum, times, value, zero};
use crate::laws::{self, Exact, ExactLine, LineCache, Oracle, exact3, real_roots};
use core::cmp::Ordering;
use durer_math::Vec3;

fn is_zero(p: &[Exact]) -> bool {
    p.iter().all(|c| c.sign().is_eq())
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Walls that are nearer to a point than this are not distinguished.
const NEAR: f64 = 1e-5;
/// The precision, in bits, of numbers that are compared.
const BITS: i64 = 1200;

/// A lathe, by the pieces of its profile: the powers of `u` in r and y.
pub(super) struct Turned {
    pub(super) pieces: Vec<[Poly; 2]>,
    pub(super) is_solid: bool,
    known: LineCache<Option<Vec<laws::Crossing>>>,
}

impl Turned {
    pub(super) fn new(spline: LatheSpline, points: &[[f64; 2]]) -> Self {
        let quarter = |x: f64| Exact::from(x).shifted(-2);
        let piece = |p: &[[f64; 2]]| {
            [0, 1].map(|k| {
                // Four times the coefficients, from a row of factors for each power.
                let rows: &[&[f64]] = match spline {
                    LatheSpline::Linear => &[&[4.0, 0.0], &[-4.0, 4.0]],
                    LatheSpline::Quadratic => &[&[0.0, 4.0, 0.0], &[-2.0, 0.0, 2.0], &[2.0, -4.0, 2.0]],
                    LatheSpline::Cubic => &[
                        &[0.0, 4.0, 0.0, 0.0],
                        &[-2.0, 0.0, 2.0, 0.0],
                        &[4.0, -10.0, 8.0, -2.0],
                        &[-2.0, 6.0, -6.0, 2.0],
                    ],
                    LatheSpline::Bezier => &[
                        &[4.0, 0.0, 0.0, 0.0],
                        &[-12.0, 12.0, 0.0, 0.0],
                        &[12.0, -24.0, 12.0, 0.0],
                        &[-4.0, 12.0, -12.0, 4.0],
                    ],
                };
                let row = |row: &&[f64]| {
                    row.iter().zip(p).fold(zero(), |s, (f, p)| &s + &(&quarter(*f) * &Exact::from(p[k])))
                };
                rows.iter().map(row).collect::<Poly>()
            })
        };
        let pieces: Vec<_> = match spline {
            LatheSpline::Linear => points.windows(2).map(piece).collect(),
            LatheSpline::Quadratic => points.windows(3).map(piece).collect(),
            LatheSpline::Cubic => points.windows(4).map(piece).collect(),
            LatheSpline::Bezier => points.chunks(4).map(piece).collect(),
        };
        let one = Exact::from(1.0);
        let end = |piece: &[Poly; 2], u: &Exact| [0, 1].map(|k: usize| value(&piece[k], u));
        // Each end is as often a first as a last one, but for those on the axis.
        let mut ends: Vec<[Exact; 2]> = vec![];
        for piece in &pieces {
            for u in [zero(), one.clone()] {
                let p = end(piece, &u);
                match ends.iter().position(|q| (0..2).all(|k| (&p[k] - &q[k]).sign().is_eq())) {
                    Some(at) => drop(ends.swap_remove(at)),
                    None if p[0].sign().is_eq() => {}
                    None => ends.push(p),
                }
            }
        }
        Self { pieces, is_solid: ends.is_empty(), known: LineCache::default() }
    }

    /// Whether a point is inside, by the walls beyond it at its height; `None` on a wall.
    fn is_within(&self, p: &[Exact; 3]) -> Option<bool> {
        let square = &p[0].squared() + &p[2].squared();
        let mut odd = false;
        for [r, y] in &self.pieces {
            let level = sum(y, &[-p[1].clone()]);
            let beyond = sum(&times(r, r), &[-square.clone()]);
            if is_zero(&level) {
                let mut roots = real_roots(&beyond).into_iter();
                let held = roots
                    .any(|root| root.cmp_exact(&zero()).is_ge() && root.cmp_exact(&Exact::from(1.0)).is_le());
                if held || is_zero(&beyond) {
                    return None;
                }
                continue;
            }
            for root in real_roots(&level) {
                let (first, last) = (root.cmp_exact(&zero()), root.cmp_exact(&Exact::from(1.0)));
                if first.is_lt() || last.is_gt() {
                    continue;
                }
                let side = root.sign_of(&beyond);
                if side.is_eq() {
                    return None;
                }
                // At an end of the piece it crosses if it is below just inside.
                let crosses = if first.is_eq() {
                    root.after.is_lt()
                } else if last.is_eq() {
                    root.before.is_lt()
                } else {
                    root.before != root.after
                };
                odd ^= crosses && side.is_gt();
            }
        }
        Some(odd)
    }

    /// All crossings, ascending; `None` if the line meets a joint, or runs within a wall, or two
    /// crossings coincide.
    pub(super) fn met(&self, line: &ExactLine) -> Option<Vec<laws::Crossing>> {
        self.known.get(line, || self.find(line))
    }

    fn find(&self, line: &ExactLine) -> Option<Vec<laws::Crossing>> {
        let ([ox, oy, oz], [dx, dy, dz]) = (&line.o, &line.d);
        let one = Exact::from(1.0);
        let mut found = vec![];
        for [r, y] in &self.pieces {
            let point = is_zero(&r[1..]) && is_zero(&y[1..]);
            if is_zero(r) || point {
                continue;
            }
            let above = sum(y, &[-oy.clone()]);
            let level = dy.sign().is_eq();
            let g = if level {
                above.clone()
            } else {
                let place = |o: &Exact, d: &Exact| sum(&scaled(&above, d), &[dy * o]);
                let (x, z) = (place(ox, dx), place(oz, dz));
                let wall = scaled(&times(r, r), &-dy.squared());
                sum(&sum(&times(&x, &x), &times(&z, &z)), &wall)
            };
            if is_zero(&g) || [zero(), one.clone()].iter().any(|u| value(&g, u).sign().is_eq()) {
                return None;
            }
            // Squares of the smallest numbers are 2^-2148. The ray's parameter is a height divided by
            // `dy`: a small one takes digits away.
            let lost = if level { 0 } else { -i64::from(durer_math::scale::exponent(dy.to_f64())) };
            let digits = 2400 + lost.max(0);
            for root in real_roots(&g) {
                if root.cmp_exact(&zero()).is_lt() || root.cmp_exact(&one).is_gt() {
                    continue;
                }
                let grazing = root.before == root.after;
                // A root that is an f64 is taken exactly, so that a crossing may be exactly at an end
                // of the ray's range.
                let near = Exact::from(root.about(digits).to_f64());
                let u = if value(&g, &near).sign().is_eq() { near } else { root.about(digits) };
                if !level {
                    let (n, d) = (value(&above, &u), dy.clone());
                    let t = real_roots(&[-n, d]).pop()?;
                    found.push((t.about(BITS), t, grazing));
                    continue;
                }
                // (o + t d)² = r².
                let a = &dx.squared() + &dz.squared();
                let b = (&(ox * dx) + &(oz * dz)).shifted(1);
                let c = &ox.squared() + &oz.squared();
                // 4 a c - b² is four times the square of the distance, times a.
                let apart = sum(
                    &scaled(&times(r, r), &a.clone().shifted(2)),
                    &[&b.squared() - &(&a * &c).shifted(2)],
                );
                match root.sign_of(&apart) {
                    Ordering::Less => continue,
                    Ordering::Equal => return None,
                    Ordering::Greater => {}
                }
                let radius = value(r, &u);
                for t in real_roots(&[&c - &radius.squared(), b, a]) {
                    found.push((t.about(BITS), t, grazing));
                }
            }
        }
        found.sort_by(|a, b| (&a.0 - &b.0).sign());
        if found.windows(2).any(|w| (&w[1].0 - &w[0].0).shifted(BITS - 200).to_f64() <= 1.0) {
            return None;
        }
        let mut inside = false;
        let crossings: Vec<_> = found
            .into_iter()
            .map(|(_, t, grazing)| {
                inside ^= !grazing;
                let sign = if grazing { 0 } else { 1 - 2 * i8::from(inside) };
                laws::Crossing { t: t.into(), sign, grazing }
            })
            .collect();
        assert!(!inside || !self.is_solid, "the witness itself leaks");
        Some(crossings)
    }

    /// The normal in space at the nearest place of the nearest piece, the distance, the parameter
    /// there, and how many pieces are near.
    fn nearest(&self, point: &[Exact; 3]) -> (Vec3, f64, f64, usize) {
        let [x, y, z] = point.clone().map(|x| x.to_f64());
        let rho = length(x, z);
        let (mut best, mut near) = ((Vec3::Y, f64::INFINITY, 0.0), 0);
        for piece in &self.pieces {
            let [r, h] = [0, 1].map(|k: usize| piece[k].iter().map(Exact::to_f64).collect::<Vec<_>>());
            let at = |p: &[f64], u: f64| p.iter().rev().fold(0.0, |s, a| s * u + a);
            let slope = |p: &[f64], u: f64| (1..p.len()).rev().fold(0.0, |s, k| s * u + k as f64 * p[k]);
            for lobe in [-1.0, 1.0] {
                let distance = |u: f64| length(lobe * at(&r, u) - rho, at(&h, u) - y);
                let mut u = (0..=256)
                    .map(|i| f64::from(i) / 256.0)
                    .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
                    .unwrap();
                for _ in 0..60 {
                    let (r1, y1) = (lobe * slope(&r, u), slope(&h, u));
                    let step = ((lobe * at(&r, u) - rho) * r1 + (at(&h, u) - y) * y1) / (r1 * r1 + y1 * y1);
                    if step.is_finite() {
                        u = (u - step).clamp(0.0, 1.0);
                    }
                }
                near += usize::from(distance(u) < NEAR);
                if distance(u) < best.1 {
                    let (r1, y1) = (lobe * slope(&r, u), slope(&h, u));
                    best = (Vec3::new(y1 * x / rho, -r1, y1 * z / rho), distance(u), u);
                }
            }
        }
        (best.0, best.1, best.2, near)
    }

    /// Whether all crossings are far from joints, tangents, the axis and other walls.
    pub(super) fn is_clear(&self, line: &ExactLine) -> bool {
        self.met(line).unwrap_or_default().iter().all(|c| {
            let p = line.at(&c.t.about(BITS));
            let (_, distance, u, near) = self.nearest(&p);
            let joint = distance < NEAR && !(1e-4..=1.0 - 1e-4).contains(&u);
            let on_axis = length(p[0].to_f64(), p[2].to_f64()) < 1e-3;
            !c.grazing && !joint && near == 1 && !on_axis
        })
    }

    /// Whether f64 tells the parameters apart.
    pub(super) fn is_spread(&self, line: &ExactLine) -> bool {
        let t: Vec<f64> = self.crossings(line).iter().map(|c| c.t.about(BITS).to_f64()).collect();
        t.windows(2).all(|t| t[1] - t[0] > 1e-12 * t[0].abs().max(t[1].abs()))
    }
}

impl Oracle for Turned {
    fn crossings(&self, line: &ExactLine) -> Vec<laws::Crossing> {
        self.met(line).unwrap_or_default()
    }

    fn knows(&self, line: &ExactLine) -> bool {
        self.met(line).is_some()
    }

    fn face_side(&self, _: u32, point: &[Exact; 3]) -> Ordering {
        match self.is_within(point) {
            None => Ordering::Equal,
            Some(true) => Ordering::Less,
            Some(false) => Ordering::Greater,
        }
    }

    fn face_normal(&self, _: u32, point: &[Exact; 3]) -> Vec3 {
        let n = self.nearest(point).0;
        let step = exact3((n * (0.1 * NEAR / n.length())).to_array());
        let beside = [0, 1, 2].map(|i| &point[i] + &step[i]);
        if self.face_side(0, &beside).is_lt() { -n } else { n }
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        self.is_solid.then(|| self.face_side(0, point))
    }

    fn size(&self) -> f64 {
        4.0
    }

    fn is_convex(&self) -> bool {
        false
    }
}
