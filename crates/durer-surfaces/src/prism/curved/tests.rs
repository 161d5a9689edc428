//! The laws, against crossings in exact numbers that share nothing with the kernel; and what must hold of rays through joints and rims.

use super::*;
use crate::Kind;
use crate::laws::{
    self, Dice, Exact, Feature, Line as ExactLine, Oracle, RealRoot, Surd, aim, all_roots, check, exact3,
    real_roots, roots_are_the_exact_crossings,
};
use crate::prism::outline::Point;
use durer_math::{Ray, RaySide};

type Poly = Vec<Exact>;

fn zero() -> Exact {
    Exact::zero()
}

fn sum(a: &[Exact], b: &[Exact]) -> Poly {
    let at = |p: &[Exact], i: usize| p.get(i).cloned().unwrap_or_else(zero);
    (0..a.len().max(b.len())).map(|i| &at(a, i) + &at(b, i)).collect()
}

fn times(a: &[Exact], b: &[Exact]) -> Poly {
    let mut out = vec![zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    out
}

fn scaled(a: &[Exact], by: &Exact) -> Poly {
    a.iter().map(|x| x * by).collect()
}

fn value(p: &[Exact], x: &Exact) -> Exact {
    p.iter().rev().fold(zero(), |sum, a| &(&sum * x) + a)
}

/// The powers of `u` of a piece in x and z.
fn powers(b: &Bezier) -> [Poly; 2] {
    [0, 1].map(|k| {
        let [p, q, r, s] = b.map(|p| Exact::from(p[k]));
        let three = Exact::from(3.0);
        let (way, step) = (&q - &p, &r - &q);
        vec![p.clone(), &three * &way, &three * &(&step - &way), &(&s - &p) - &(&three * &step)]
    })
}

/// The points `p` whose projection `(x, z) / w` lies within the outlines, `w` being 1 or `y`, between two heights.
struct Swept {
    outlines: Vec<Vec<Bezier>>,
    low: f64,
    high: f64,
    sweep: Sweep,
}

/// Faces that are nearer to a point than this are not told apart.
const NEAR: f64 = 1e-5;
/// Digits, in bits, of numbers that are compared.
const BITS: i64 = 1200;

impl Swept {
    fn pieces(&self) -> impl Iterator<Item = &Bezier> {
        self.outlines.iter().flatten()
    }

    /// Whether the outlines go an odd number of times round the point `(x, z) / w`, `w` above zero; `None` on them.
    fn is_within(&self, x: &Exact, z: &Exact, w: &Exact) -> Option<bool> {
        let half = Exact::from(0.5);
        let mut odd = false;
        for b in self.pieces() {
            let [px, pz] = powers(b);
            // A level that no end of a piece is at would do; ends are counted as above it.
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

    /// The same of a point of space; on the plane of the apex all but the apex is outside.
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
                // y of the ray's point is t dy + oy, and x(u) times that its x: of the two equations the one with the other's rows.
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

    /// All crossings, ascending, with their faces; `None` if the line meets a joint or a rim, or runs within a face, or two crossings are one.
    fn met(&self, line: &ExactLine) -> Option<Vec<(laws::Crossing, u32)>> {
        let mut found: Vec<(Exact, Surd, bool, u32)> = vec![];
        for b in self.pieces() {
            let [g, num, den] = self.along(line, b);
            if g.iter().all(|c| c.sign().is_eq()) {
                // Seen as a point: caps only, or a tip.
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
                    // It meets the ruling far beyond all numbers.
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

    /// Of the piece that is nearest to a point of space: the normal in space at the nearest place, the distance, and the place on the piece.
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

    /// Whether each crossing is near one face only, and not near a joint.
    fn is_clear(&self, line: &ExactLine) -> bool {
        self.crossings(line).iter().all(|c| {
            let p = line.at(&c.t.about(BITS));
            let caps = [self.low, self.high].iter().filter(|y| (p[1].to_f64() - **y).abs() < NEAR).count();
            let (_, distance, u, near) = self.nearest(&p);
            let joint = distance < NEAR && !(1e-4..=1.0 - 1e-4).contains(&u);
            !joint && caps + near == 1 && p[1].to_f64().abs() > NEAR
        })
    }

    /// Whether all crossings are so far apart that t in f64 tells their order.
    fn is_spread(&self, line: &ExactLine) -> bool {
        let t: Vec<f64> = self.crossings(line).iter().map(|c| c.t.about(BITS).to_f64()).collect();
        t.windows(2).all(|t| t[1] - t[0] > 1e-12 * t[0].abs().max(t[1].abs()))
    }
}

/// `t = num / den` at a root of `g`: as the root of a polynomial in `t`, Bezout's resultant of `g` and `num - t den`, and a number near it.
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
    // num(u) / den(u), to many digits: the quotient of whole numbers.
    let u = root.about(2000);
    let (n, d) = (value(num, &u), value(den, &u));
    let t = real_roots(&[-n, d]).pop()?.about(1400);
    let gap = |r: &RealRoot| (&r.about(1400) - &t).abs();
    let found = real_roots(&resultant).into_iter().min_by(|a, b| (&gap(a) - &gap(b)).sign())?;
    let relative = gap(&found).to_f64() / t.clone().abs().to_f64().max(1e-250);
    assert!(relative < 1e-60, "the witness does not agree with itself");
    let about = found.about(BITS);
    Some((found, about))
}

impl Oracle for Swept {
    fn crossings(&self, line: &ExactLine) -> Vec<laws::Crossing> {
        self.met(line).unwrap_or_default().into_iter().map(|(c, _)| c).collect()
    }

    /// Of points near one face only, see [`Swept::is_clear`].
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

/// A round outline of four pieces.
fn round(at: Point, r: f64, k: f64) -> Vec<Bezier> {
    let p = |x: f64, z: f64| [at[0] + r * x, at[1] + r * z];
    vec![
        [p(1.0, 0.0), p(1.0, k), p(k, 1.0), p(0.0, 1.0)],
        [p(0.0, 1.0), p(-k, 1.0), p(-1.0, k), p(-1.0, 0.0)],
        [p(-1.0, 0.0), p(-1.0, -k), p(-k, -1.0), p(0.0, -1.0)],
        [p(0.0, -1.0), p(k, -1.0), p(1.0, -k), p(1.0, 0.0)],
    ]
}

/// Half a disc: straight edges and curves with corners between them.
fn half() -> Vec<Bezier> {
    vec![
        [[-2.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
        [[2.0, 0.0], [2.0, 3.0], [-2.0, 3.0], [-2.0, 0.0]],
    ]
}

fn sets() -> Vec<(Vec<Vec<Bezier>>, bool)> {
    let wave = [
        [0.0, -4.0],
        [-3.0, -2.0],
        [0.0, -1.0],
        [3.0, -2.0],
        [2.0, 2.0],
        [0.0, 1.0],
        [-2.0, 3.0],
        [-3.0, -2.0],
        [1.0, 1.0],
    ];
    let eight = [[2.0, -2.0], [-2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [2.0, -2.0], [-2.0, -2.0], [1.0, 0.0]];
    let arcs = [[-1.0, 3.0], [-2.0, -2.0], [3.0, -1.0], [2.0, 2.0], [-1.0, 3.0], [-2.0, -2.0]];
    vec![
        (vec![round([0.0; 2], 3.0, 0.5625)], false),
        (vec![round([0.0; 2], 3.0, 0.5625), round([0.5, -0.25], 1.0, 0.5)], false),
        (vec![half()], false),
        (vec![Spline::Cubic.pieces(&wave)], false),
        (vec![Spline::Quadratic.pieces(&arcs)], false),
        (vec![Spline::Cubic.pieces(&eight)], true),
        (vec![round([0.0; 2], 2.0, 0.75), round([1.0, 0.5], 2.0, 0.5)], true),
    ]
}

fn cases() -> Vec<(CurvedPrism, Swept)> {
    let mut out = vec![];
    for (outlines, tangled) in sets() {
        for (sweep, low, high) in [
            (Sweep::Linear, -1.0, 2.0),
            (Sweep::Linear, 0.25, 0.375),
            (Sweep::Conic, 0.5, 1.0),
            (Sweep::Conic, 0.0, 1.0),
            (Sweep::Conic, -1.0, 0.5),
        ] {
            // The heights in the other order make no difference.
            let prism = CurvedPrism::new(&outlines, high, low, sweep).unwrap();
            assert_eq!(prism.inside_is_left.is_none(), tangled, "{outlines:?}");
            out.push((prism, Swept { outlines: outlines.clone(), low, high, sweep }));
        }
    }
    out
}

/// Points of the walls, with tangents and rulings; at few-bit places of curves with few-bit control points all of this is exact.
fn features(oracle: &Swept) -> Vec<Feature> {
    let mut out = vec![];
    let heights = [oracle.low, oracle.high, 0.5 * oracle.low + 0.5 * oracle.high];
    for b in oracle.pieces() {
        for u in [0.0, 0.25, 0.5, 0.625, 1.0] {
            let v = 1.0 - u;
            let [x, z] = [0, 1].map(|k| {
                v * v * v * b[0][k] + 3.0 * u * v * (v * b[1][k] + u * b[2][k]) + u * u * u * b[3][k]
            });
            let d = |i: usize, k: usize| b[i + 1][k] - b[i][k];
            let [sx, sz] = [0, 1].map(|k| v * v * d(0, k) + 2.0 * u * v * d(1, k) + u * u * d(2, k));
            for y in heights {
                let w = if oracle.sweep == Sweep::Linear { 1.0 } else { y };
                let ruling = if oracle.sweep == Sweep::Linear { Vec3::Y } else { Vec3::new(x, 1.0, z) };
                let point = Point3::new(x * w, y, z * w);
                for direction in [
                    Vec3::new(sx, 0.0, sz),
                    Vec3::new(sx, 0.5, sz) + ruling * 0.25,
                    ruling,
                    Vec3::new(sz, 0.25, -sx),
                ] {
                    out.push(Feature { point, direction });
                }
            }
        }
    }
    out
}

/// Whether the rays that start along the normals, from where a ray meets the prism, meet no joint.
fn leaves_clearly(prism: &CurvedPrism, oracle: &Swept, ray: &Ray) -> bool {
    all_roots(prism, ray).iter().all(|root| {
        let point = prism.resolve(&LocalRay::new(ray), root, Need::POINT);
        let n = point.ng.to_vec();
        [(RaySide::Front, n), (RaySide::Back, -n)].iter().all(|&(side, d)| {
            let line = ExactLine::new(&point.spawn_from(side, d));
            oracle.met(&line).is_some() && oracle.is_spread(&line)
        })
    })
}

#[test]
fn curved_prisms_obey_the_laws_off_their_joints() {
    let (mut rays, mut roots, mut clear) = (0, 0, 0);
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let features = features(oracle);
        let mut dice = Dice::new(seed as u64);
        for i in 0..4 {
            let ray = aim(&mut dice, &features, oracle.size());
            // Rays that meet a joint exactly are the business of the next test.
            let line = ExactLine::new(&ray);
            if ray.is_valid() && oracle.met(&line).is_some() {
                let met = if oracle.crossings(&line).iter().all(|c| !c.grazing)
                    && oracle.is_clear(&line)
                    && oracle.is_spread(&line)
                    && leaves_clearly(prism, oracle, &ray)
                {
                    clear += 1;
                    check(prism, oracle, &ray)
                } else if oracle.is_spread(&line) {
                    roots_are_the_exact_crossings(prism, oracle, &ray, None)
                } else {
                    // The order of crossings of different faces that t cannot tell apart is not claimed.
                    let whole = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
                    let roots = all_roots(prism, &whole);
                    assert_eq!(roots.len(), oracle.crossings(&line).len(), "{ray:?} {prism:?}");
                    Ok(roots)
                };
                roots += met.unwrap_or_else(|e| panic!("{e}\n{seed} {i} {ray:?}\n{prism:?}")).len();
                rays += 1;
            }
        }
    }
    assert!(rays > 60 && roots > 60 && clear > 30, "{rays} {roots} {clear}");
}

#[test]
fn rays_through_joints_and_rims_go_in_as_often_as_out() {
    let mut through = 0;
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let features = features(oracle);
        let mut dice = Dice::new(100 + seed as u64);
        for _ in 0..300 {
            let f = dice.pick(&features);
            let target = if dice.once_in(4) { dice.lattice(6).to_point() } else { f.point };
            let direction = match dice.below(3) {
                0 => f.direction,
                1 => dice.pick(&features).point - target,
                _ => dice.lattice(4),
            };
            if direction == Vec3::ZERO {
                continue;
            }
            let back = dice.pick(&[4.0, 1024.0, 1048576.0]);
            let ray =
                Ray::new(target - direction * back, direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(prism, &ray);
            let (ins, outs) =
                (roots.iter().filter(|r| r.sign < 0).count(), roots.iter().filter(|r| r.sign > 0).count());
            assert!(
                ins == outs && roots.iter().all(|r| (r.sign == 0) == (r.kind == Kind::Grazing)),
                "{roots:?} for {ray:?} and {prism:?}"
            );
            through += usize::from(ins > 0);
            // From within, out.
            let from = (dice.lattice(12) * 0.5).to_point();
            let at = exact3(from.to_array());
            if oracle.side(&at) != Some(Ordering::Equal) {
                let outward = Ray::new(from, f.point - from);
                if outward.is_valid() {
                    let inside = oracle.side(&at) == Some(Ordering::Less);
                    let met = all_roots(prism, &outward).iter().filter(|r| r.sign != 0).count();
                    assert_eq!(
                        met % 2 == 1,
                        inside,
                        "{met} from {from:?} along {:?}: {prism:?}",
                        outward.direction
                    );
                }
            }
        }
    }
    assert!(through > 1000, "{through}");
}

#[test]
fn sides_are_exact() {
    let mut told = [0; 3];
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let mut dice = Dice::new(200 + seed as u64);
        let features = features(oracle);
        for _ in 0..150 {
            let p = match dice.below(3) {
                0 => dice.pick(&features).point,
                1 => {
                    dice.pick(&features).point
                        + (dice.pick(&features).point - dice.pick(&features).point) * 0.25
                }
                _ => prism.bounds.centre() + dice.lattice(16) * (prism.bounds.widths().y / 32.0),
            };
            let p =
                if dice.once_in(3) { Point3::new(dice.nudge(p.x, 1), dice.nudge(p.y, 1), p.z) } else { p };
            let expected = oracle.side(&exact3(p.to_array())).unwrap();
            let found = prism.side(&LocalPoint::new(p));
            let expected = [Side::In, Side::On, Side::Out][(expected as i8 + 1) as usize];
            assert_eq!(found, expected, "{p:?} of {prism:?}");
            told[expected as usize] += 1;
        }
    }
    assert!(told.iter().all(|&n| n > 150), "{told:?}");
}

#[test]
fn parts_together_are_the_whole() {
    let (mut parts, mut met) = (0, 0);
    for (seed, (prism, oracle)) in cases().into_iter().enumerate() {
        let mut dice = Dice::new(300 + seed as u64);
        let prism = if dice.once_in(3) { prism.without_caps() } else { prism };
        let features = features(&oracle);
        for _ in 0..100 {
            let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
            let ray = if dice.once_in(2) {
                Ray::new(ray.origin, dice.pick(&features).point - ray.origin)
            } else {
                ray
            };
            let (asked, roots) = laws::parts_are_the_whole(&prism, &ray).unwrap_or_else(|e| panic!("{e}"));
            (parts, met) = (parts + asked, met + roots);
        }
    }
    assert!(parts > 10_000 && met > 1000, "{parts} {met}");
}

#[test]
fn straight_pieces_make_the_straight_prism() {
    let corners = [[-3.0, -3.0], [3.0, -2.0], [2.0, 3.0], [-3.0, 3.0]];
    let edge = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        [a, a, b, b]
    };
    let pieces = vec![(0..4).map(edge).collect::<Vec<Bezier>>()];
    let mut dice = Dice::new(7);
    let mut met = 0;
    for (curved, straight) in [
        (CurvedPrism::linear(&pieces, -1.0, 2.0), crate::Prism::linear(&[corners], -1.0, 2.0)),
        (CurvedPrism::conic(&pieces, -1.0, 2.0), crate::Prism::conic(&[corners], -1.0, 2.0)),
    ] {
        let (curved, straight) = (curved.unwrap(), straight.unwrap());
        assert!(curved.inside_is_left.is_some());
        assert_eq!(curved.bounds(), straight.bounds());
        for _ in 0..1000 {
            let from = (dice.vector() * 9.0).to_point();
            let ray = Ray::new(from, (dice.vector() * 3.0).to_point() - from);
            let (a, b) = (all_roots(&curved, &ray), all_roots(&straight, &ray));
            assert_eq!(a.len(), b.len(), "{ray:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!(a.sign == b.sign && a.face == b.face && a.lo <= b.hi && b.lo <= a.hi, "{a:?} {b:?}");
            }
            met += a.len();
        }
    }
    assert!(met > 500, "{met}");
}

#[test]
fn without_caps_the_walls_stay() {
    for (outlines, _) in sets() {
        let prism = CurvedPrism::linear(&outlines, 0.0, 1.0).unwrap();
        let open = prism.clone().without_caps();
        assert_eq!(open.solidity(), Solidity::Open);
        let mut dice = Dice::new(8);
        for _ in 0..100 {
            let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
            let mut closed = all_roots(&prism, &ray);
            closed.retain(|r| r.face == 0);
            assert_eq!(all_roots(&open, &ray), closed);
        }
    }
}

#[test]
fn bad_curved_prisms_are_named() {
    let ring = round([0.0; 2], 1.0, 0.5);
    assert_eq!(CurvedPrism::linear(&[] as &[Vec<Bezier>], 0.0, 1.0), Err(PrismError::Empty));
    assert_eq!(CurvedPrism::linear(&[&ring], 1.0, 1.0), Err(PrismError::Heights(1.0, 1.0)));
    assert_eq!(CurvedPrism::conic(&[&ring], 1.0, 1e308), Err(PrismError::TooLarge(1e308)));
    assert_eq!(
        CurvedPrism::linear(&[&ring, &ring[1..].to_vec()], 0.0, 1.0),
        Err(PrismError::Gap { outline: 1, piece: 2 })
    );
    assert_eq!(
        CurvedPrism::linear(&[[[[1.0, 1.0]; 4]]], 0.0, 1.0),
        Err(PrismError::TooShort { outline: 0, len: 1 })
    );
    let mut far = ring.clone();
    far[1][1] = [f64::NAN, 0.0];
    assert!(matches!(CurvedPrism::linear(&[far], 0.0, 1.0), Err(PrismError::Point { .. })));
}
