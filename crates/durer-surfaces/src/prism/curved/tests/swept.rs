//! The oracle: exact crossings of a curved prism, by polynomials of its own.

use super::super::*;
use crate::laws::exact_polynomial::{Poly, scaled, sum, times, value, zero};
use crate::laws::{self, Exact, ExactLine, LineCache, Oracle, RealRoot, Surd, exact3, real_roots};
use crate::prism::tests::Known;

/// The powers of `u` of a piece in x and z.
fn powers(b: &Bezier) -> [Poly; 2] {
    [0, 1].map(|k| {
        let [p, q, r, s] = b.map(|p| Exact::from(p[k]));
        let three = Exact::from(3.0);
        let (way, step) = (&q - &p, &r - &q);
        vec![p.clone(), &three * &way, &three * &(&step - &way), &(&s - &p) - &(&three * &step)]
    })
}

/// The points `p` whose projection `(x, z) / w` lies within the outlines, `w` being 1 or `y`,
/// between two heights.
pub(super) struct Swept {
    pub(super) outlines: Vec<Vec<Bezier>>,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) sweep: Sweep,
    known: LineCache<Option<Vec<Met>>>,
}

/// A crossing and its face.
type Met = (laws::Crossing, u32);

/// Faces that are nearer to a point than this are not distinguished.
const NEAR: f64 = 1e-5;
/// The precision, in bits, of numbers that are compared.
const BITS: i64 = 1200;

impl Swept {
    pub(super) fn new(outlines: Vec<Vec<Bezier>>, low: f64, high: f64, sweep: Sweep) -> Self {
        Self { outlines, low, high, sweep, known: LineCache::default() }
    }

    pub(super) fn pieces(&self) -> impl Iterator<Item = &Bezier> {
        self.outlines.iter().flatten()
    }

    /// Whether the outlines go round the point `(x, z) / w`, `w` positive, an odd number of times;
    /// `None` on them.
    fn is_within(&self, x: &Exact, z: &Exact, w: &Exact) -> Option<bool> {
        let half = Exact::from(0.5);
        let mut odd = false;
        for b in self.pieces() {
            let [px, pz] = powers(b);
            // Ends of pieces exactly at the level count as above it.
            let level = sum(&scaled(&pz, w), &[-z.clone()]);
            let beside = sum(&scaled(&px, w), &[-x.clone()]);
            if level.iter().all(|c| c.sign().is_eq()) {
                let (a, b) = (value(&beside, &zero()).sign(), value(&beside, &Exact::from(1.0)).sign());
                if a != b || a.is_eq() {
                    return None;
                }
                continue;
            }
            let above = |u: f64| value(&level, &u.into()).sign().is_ge();
            let mut crossings = 0;
            for root in real_roots(&level) {
                let (first, last) = (root.cmp_exact(&zero()), root.cmp_exact(&Exact::from(1.0)));
                if first.is_lt() || last.is_gt() {
                    continue;
                }
                let side = root.sign_of(&beside);
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
                crossings += usize::from(crosses);
                odd ^= crosses && side.is_lt();
            }
            assert_eq!(crossings % 2 == 1, above(0.0) != above(1.0), "the witness itself leaks {half:?}");
        }
        Some(odd)
    }

    /// Whether a point in space is inside the outlines, on them, or outside. In the plane of the
    /// apex everything but the apex is outside.
    fn across(&self, p: &[Exact; 3]) -> Ordering {
        let [x, y, z] = p;
        let within = match (self.sweep, y.sign()) {
            (Sweep::Linear, _) => self.is_within(x, z, &Exact::from(1.0)),
            (Sweep::Conic, Ordering::Greater) => self.is_within(x, z, y),
            (Sweep::Conic, Ordering::Less) => self.is_within(&-x.clone(), &-z.clone(), &-y.clone()),
            (Sweep::Conic, Ordering::Equal) => {
                return if x.sign().is_eq() && z.sign().is_eq() {
                    Ordering::Equal
                } else {
                    Ordering::Greater
                };
            }
        };
        match within {
            None => Ordering::Equal,
            Some(true) => Ordering::Less,
            Some(false) => Ordering::Greater,
        }
    }

    fn height(&self, y: &Exact) -> Ordering {
        let from = |level: f64| (y - &Exact::from(level)).sign();
        match (from(self.low), from(self.high)) {
            (Ordering::Greater, Ordering::Less) => Ordering::Less,
            (Ordering::Less, _) | (_, Ordering::Greater) => Ordering::Greater,
            _ => Ordering::Equal,
        }
    }

    /// `g(u)`, and numerator and denominator of `t`, in powers of `u`.
    fn along(&self, line: &ExactLine, b: &Bezier) -> [Poly; 3] {
        let [x, z] = powers(b);
        let one = vec![Exact::from(1.0)];
        let ([ox, oy, oz], [dx, dy, dz]) = (&line.o, &line.d);
        let form = |f: [Exact; 3]| sum(&sum(&scaled(&x, &f[0]), &scaled(&one, &f[1])), &scaled(&z, &f[2]));
        match self.sweep {
            Sweep::Linear => {
                let n = [dz.clone(), &(dx * oz) - &(dz * ox), -dx.clone()];
                let back = -(&(dx * ox) + &(dz * oz));
                let square = &dx.squared() + &dz.squared();
                [form(n), form([dx.clone(), back, dz.clone()]), vec![square]]
            }
            Sweep::Conic => {
                // y of the ray's point is t dy + oy, and x(u) times that its x: of the two
                // equations the one with the other's rows.
                let minor = |a: &Exact, b: &Exact, c: &Exact, d: &Exact| &(a * d) - &(b * c);
                let n = [minor(oy, oz, dy, dz), minor(oz, ox, dz, dx), minor(ox, oy, dx, dy)];
                // (o + t d) x C = 0, times n.
                let turned = |v: [&Exact; 3]| {
                    let [a, b, c] = v;
                    [minor(&n[1], &n[2], b, c), minor(&n[2], &n[0], c, a), minor(&n[0], &n[1], a, b)]
                };
                let (num, den) = (turned([ox, oy, oz]), turned([dx, dy, dz]));
                [form(n.clone()), scaled(&form(num), &Exact::from(-1.0)), form(den)]
            }
        }
    }

    /// All crossings, ascending, with their faces; `None` if the line meets a joint or a rim, or
    /// runs within a face, or two crossings coincide.
    pub(super) fn met(&self, line: &ExactLine) -> Option<Vec<Met>> {
        self.known.get(line, || self.find(line))
    }

    fn find(&self, line: &ExactLine) -> Option<Vec<Met>> {
        let mut found: Vec<(Exact, Surd, bool, u32)> = vec![];
        for b in self.pieces() {
            let [g, num, den] = self.along(line, b);
            if g.iter().all(|c| c.sign().is_eq()) {
                // The trace is a point: caps only, or a tip.
                if self.sweep == Sweep::Conic && (self.low == 0.0 || self.high == 0.0) {
                    return None;
                }
                continue;
            }
            if [0.0, 1.0].iter().any(|&u| value(&g, &u.into()).sign().is_eq()) {
                return None;
            }
            for root in real_roots(&g) {
                if root.cmp_exact(&zero()).is_lt() || root.cmp_exact(&Exact::from(1.0)).is_gt() {
                    continue;
                }
                if root.sign_of(&den).is_eq() {
                    // It meets the ruling at infinity.
                    continue;
                }
                let (t, about) = parameter(&g, &num, &den, &root)?;
                // The ray's height at t.
                let height = |level: f64| {
                    let y = &line.o[1] - &Exact::from(level);
                    t.sign_of(&[y, line.d[1].clone()])
                };
                match (height(self.low), height(self.high)) {
                    (Ordering::Greater, Ordering::Less) => {}
                    (Ordering::Less, _) | (_, Ordering::Greater) => continue,
                    _ => return None,
                }
                found.push((about, t.into(), root.before == root.after, 0));
            }
        }
        for (level, face) in [(self.low, 1), (self.high, 2)] {
            let height = &Exact::from(level) - &line.o[1];
            if line.d[1].sign().is_eq() {
                if height.sign().is_eq() {
                    return None;
                }
                continue;
            }
            if self.sweep == Sweep::Conic && level == 0.0 {
                continue;
            }
            // The point o + height / dy d, times |dy|.
            let dy = line.d[1].clone();
            let p = [0, 1, 2].map(|i: usize| &(&line.o[i] * &dy) + &(&height * &line.d[i]));
            let (p, w) = if dy.sign().is_lt() { (p.map(|x| -x), -dy.clone()) } else { (p, dy.clone()) };
            let within = match self.sweep {
                Sweep::Linear => self.is_within(&p[0], &p[2], &w),
                Sweep::Conic if p[1].sign().is_lt() => {
                    let [x, y, z] = p.map(|x| -x);
                    self.is_within(&x, &z, &y)
                }
                Sweep::Conic => self.is_within(&p[0], &p[2], &p[1]),
            };
            if within? {
                let (n, d) = if dy.sign().is_lt() { (-height, -dy) } else { (height, dy) };
                let t = real_roots(&[-n, d]).pop()?;
                found.push((t.about(BITS), t.into(), false, face));
            }
        }
        found.sort_by(|a, b| (&a.0 - &b.0).sign());
        if found.windows(2).any(|w| (&w[1].0 - &w[0].0).shifted(BITS - 200).to_f64() <= 1.0) {
            return None;
        }
        let mut inside = false;
        let crossings = found.into_iter().map(|(_, t, grazing, face)| {
            inside ^= !grazing;
            let sign = if grazing {
                0
            } else if inside {
                -1
            } else {
                1
            };
            (laws::Crossing { t, sign, grazing }, face)
        });
        let crossings: Vec<_> = crossings.collect();
        assert!(!inside, "the witness itself leaks");
        Some(crossings)
    }

    /// The normal in space at the nearest place of the nearest piece, the distance, the parameter
    /// there, and how many pieces are near.
    fn nearest(&self, point: &[Exact; 3]) -> (Vec3, f64, f64, usize) {
        let [x, y, z] = point.clone().map(|x| x.to_f64());
        let w = if self.sweep == Sweep::Linear { 1.0 } else { y };
        let (px, pz) = (x / w, z / w);
        let (mut best, mut near) = ((Vec3::Y, f64::INFINITY, 0.0), 0);
        for b in self.pieces() {
            let at = |u: f64| {
                let v = 1.0 - u;
                [0, 1].map(|k| {
                    v * v * v * b[0][k] + 3.0 * u * v * (v * b[1][k] + u * b[2][k]) + u * u * u * b[3][k]
                })
            };
            let slope = |u: f64| {
                let v = 1.0 - u;
                let d = |i: usize, k: usize| b[i + 1][k] - b[i][k];
                [0, 1].map(|k| 3.0 * (v * v * d(0, k) + 2.0 * u * v * d(1, k) + u * u * d(2, k)))
            };
            let distance = |u: f64| {
                let [cx, cz] = at(u);
                ((cx - px) * (cx - px) + (cz - pz) * (cz - pz)).sqrt()
            };
            let mut u = (0..=256)
                .map(|i| f64::from(i) / 256.0)
                .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
                .unwrap();
            for _ in 0..60 {
                let ([cx, cz], [sx, sz]) = (at(u), slope(u));
                let step = ((cx - px) * sx + (cz - pz) * sz) / (sx * sx + sz * sz);
                if step.is_finite() {
                    u = (u - step).clamp(0.0, 1.0);
                }
            }
            near += usize::from(distance(u) < NEAR);
            if distance(u) < best.1 {
                let ([cx, cz], [sx, sz]) = (at(u), slope(u));
                let normal = match self.sweep {
                    Sweep::Linear => Vec3::new(sz, 0.0, -sx),
                    Sweep::Conic => Vec3::new(sz, sx * cz - sz * cx, -sx),
                };
                best = (normal, distance(u), u);
            }
        }
        (best.0, best.1, best.2, near)
    }
}

/// `t = num / den` at a root of `g`: as the root of a polynomial in `t`, Bezout's resultant of `g`
/// and `num - t den`, and a number near it.
fn parameter(g: &Poly, num: &Poly, den: &Poly, root: &RealRoot) -> Option<(RealRoot, Exact)> {
    let at = |p: &Poly, i: usize| p.get(i).cloned().unwrap_or_else(zero);
    let b: Vec<Poly> = (0..4).map(|i| vec![at(num, i), -at(den, i)]).collect();
    let a: Vec<Poly> = (0..4).map(|i| vec![at(g, i)]).collect();
    let is_zero = |p: &Poly| p.iter().all(|c| c.sign().is_eq());
    let degree = (1..4).rev().find(|&i| !is_zero(&a[i]) || !is_zero(&b[i]))?;
    let bracket = |i: usize, j: usize| {
        let minus = scaled(&times(&a[j], &b[i]), &Exact::from(-1.0));
        sum(&times(&a[i], &b[j]), &minus)
    };
    let entry = |i: usize, j: usize| {
        // B_ij = Σ_k [a_(i+j-k+1) b_k], k up to min(i, j).
        let (i, j) = (i.min(j), i.max(j));
        (0..=i)
            .filter(|&k| i + j + 1 - k <= degree)
            .fold(vec![zero()], |s, k| sum(&s, &bracket(i + j + 1 - k, k)))
    };
    let e = |i: usize, j: usize| entry(i, j);
    let minor = |i: usize, j: usize, k: usize, l: usize| {
        sum(&times(&e(i, k), &e(j, l)), &scaled(&times(&e(i, l), &e(j, k)), &Exact::from(-1.0)))
    };
    let resultant = match degree {
        1 => e(0, 0),
        2 => minor(0, 1, 0, 1),
        _ => {
            let first = times(&e(0, 0), &minor(1, 2, 1, 2));
            let second = scaled(&times(&e(0, 1), &minor(1, 2, 0, 2)), &Exact::from(-1.0));
            sum(&sum(&first, &second), &times(&e(0, 2), &minor(1, 2, 0, 1)))
        }
    };
    // num(u) / den(u), a quotient of integers, with ever more digits of u until one of the resultant's
    // roots is that near: a small den(u) magnifies the error of u.
    let candidates = real_roots(&resultant);
    let found = [2000, 4000, 8000, 16000].into_iter().find_map(|digits| {
        let u = root.about(digits);
        let (n, d) = (value(num, &u), value(den, &u));
        let t = real_roots(&[-n, d]).pop()?.about(1400);
        let gap = |r: &RealRoot| (&r.about(1400) - &t).abs();
        let nearest = candidates.iter().min_by(|a, b| (&gap(a) - &gap(b)).sign())?;
        let relative = gap(nearest).to_f64() / t.clone().abs().to_f64().max(1e-250);
        (relative < 1e-60).then(|| nearest.clone())
    });
    let found = found.expect("the witness does not agree with itself");
    let about = found.about(BITS);
    Some((found, about))
}

impl Oracle for Swept {
    fn crossings(&self, line: &ExactLine) -> Vec<laws::Crossing> {
        self.met(line).unwrap_or_default().into_iter().map(|(c, _)| c).collect()
    }

    fn knows(&self, line: &ExactLine) -> bool {
        self.met(line).is_some()
    }

    /// Valid for points near one face only, see [`Swept::is_clear`].
    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        match face {
            1 => (&Exact::from(self.low) - &point[1]).sign(),
            2 => (&point[1] - &Exact::from(self.high)).sign(),
            _ => self.across(point),
        }
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        match face {
            1 => -Vec3::Y,
            2 => Vec3::Y,
            _ => {
                let n = self.nearest(point).0;
                let step = exact3((n * (0.1 * NEAR / n.length())).to_array());
                let beside = [0, 1, 2].map(|i| &point[i] + &step[i]);
                if self.across(&beside).is_lt() { -n } else { n }
            }
        }
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        let height = self.height(&point[1]);
        Some(if height.is_gt() { height } else { height.max(self.across(point)) })
    }

    fn size(&self) -> f64 {
        8.0
    }

    fn is_convex(&self) -> bool {
        false
    }
}

impl Known for Swept {
    fn is_plain(&self, line: &ExactLine) -> bool {
        self.knows(line)
    }

    // Also not near a joint or a tangent.
    fn is_clear(&self, line: &ExactLine) -> bool {
        self.crossings(line).iter().all(|c| {
            let p = line.at(&c.t.about(BITS));
            let caps = [self.low, self.high].iter().filter(|y| (p[1].to_f64() - **y).abs() < NEAR).count();
            let (_, distance, u, near) = self.nearest(&p);
            let joint = distance < NEAR && !(1e-4..=1.0 - 1e-4).contains(&u);
            !c.grazing && !joint && caps + near == 1 && p[1].to_f64().abs() > NEAR
        })
    }

    fn is_spread(&self, line: &ExactLine) -> bool {
        let t: Vec<f64> = self.crossings(line).iter().map(|c| c.t.about(BITS).to_f64()).collect();
        t.windows(2).all(|t| t[1] - t[0] > 1e-12 * t[0].abs().max(t[1].abs()))
    }
}
