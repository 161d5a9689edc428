//! The laws, tested against exact crossings that share no code with the kernel; and the laws of
//! rays through edges and corners.

use super::*;
use crate::AxisBox;
use crate::laws::{
    self, Broken, Crossing, Exact, ExactLine, Feature, LineCache, Oracle, Surd, TestRng, TestSurface, aim,
    all_roots, check, exact3, roots_are_the_exact_crossings,
};
use durer_math::{Ray, RaySide};

/// The points `p` whose projection `(x, z) / w` lies within the outlines, `w` being 1 or `y`,
/// between two heights.
struct Swept {
    outlines: Vec<Vec<Point>>,
    low: f64,
    high: f64,
    sweep: Sweep,
    known: LineCache<Option<Vec<Met>>>,
}

/// The precision, in bits, of the parameters of crossings: directions are `2^-330` to `2^330` long.
const BITS: i64 = 700;

/// A crossing and its face.
type Met = (Crossing, u32);

/// A point times a positive weight.
struct Weighted {
    x: Exact,
    y: Exact,
    z: Exact,
    w: Exact,
}

impl Swept {
    fn edges(&self) -> impl Iterator<Item = [Point; 2]> + '_ {
        self.outlines.iter().flat_map(|o| (0..o.len()).map(move |i| [o[i], o[(i + 1) % o.len()]]))
    }

    /// The plane of an edge's wall: its normal, and its value at a weighted origin.
    fn plane(&self, [a, b]: [Point; 2]) -> ([Exact; 3], Exact) {
        let [ax, az, bx, bz] = [a[0], a[1], b[0], b[1]].map(Exact::from);
        let (ex, ez) = (&bx - &ax, &bz - &az);
        // ex (z - w az) - ez (x - w ax)
        let at_origin = &(&ez * &ax) - &(&ex * &az);
        match self.sweep {
            Sweep::Linear => ([-ez, Exact::from(0.0), ex], at_origin),
            Sweep::Conic => ([-ez, at_origin, ex], Exact::from(0.0)),
        }
    }

    fn at(&self, line: &ExactLine, n: &Exact, d: &Exact) -> Weighted {
        let flip = d.sign().is_lt();
        let p = |i: usize| {
            let x = &(&line.o[i] * d) + &(&line.d[i] * n);
            if flip { -x } else { x }
        };
        Weighted { x: p(0), y: p(1), z: p(2), w: d.clone().abs() }
    }

    /// The projected x, z and their weight, which is positive; `None` at an apex.
    fn projected(&self, p: &Weighted) -> Option<[Exact; 3]> {
        let w = if self.sweep == Sweep::Linear { p.w.clone() } else { p.y.clone() };
        match w.sign() {
            Ordering::Equal => None,
            Ordering::Less => Some([-p.x.clone(), -p.z.clone(), -w]),
            Ordering::Greater => Some([p.x.clone(), p.z.clone(), w]),
        }
    }

    fn height(&self, p: &Weighted) -> Ordering {
        let from = |level: f64| (&p.y - &(&Exact::from(level) * &p.w)).sign();
        match (from(self.low), from(self.high)) {
            (Ordering::Greater, Ordering::Less) => Ordering::Less,
            (Ordering::Less, _) | (_, Ordering::Greater) => Ordering::Greater,
            _ => Ordering::Equal,
        }
    }

    /// Whether the point is inside the outlines, on them, or outside.
    fn across(&self, p: &Weighted) -> Ordering {
        let Some([x, z, w]) = self.projected(p) else {
            let on_axis = p.x.sign().is_eq() && p.z.sign().is_eq();
            return if on_axis { Ordering::Equal } else { Ordering::Greater };
        };
        let mut odd = false;
        for [a, b] in self.edges() {
            let seen = |v: f64, at: &Exact| &(&Exact::from(v) * &w) - at;
            let (px, pz, qx, qz) = (seen(a[0], &x), seen(a[1], &z), seen(b[0], &x), seen(b[1], &z));
            let cross = (&(&px * &qz) - &(&pz * &qx)).sign();
            let inner = (&(&px * &qx) + &(&pz * &qz)).sign();
            if cross.is_eq() && inner.is_le() {
                return Ordering::Equal;
            }
            let (up, down) = (pz.sign().is_le() && qz.sign().is_gt(), pz.sign().is_gt() && qz.sign().is_le());
            odd ^= up && cross.is_gt() || down && cross.is_lt();
        }
        if odd { Ordering::Less } else { Ordering::Greater }
    }

    fn whole(&self, p: &Weighted) -> Ordering {
        self.height(p).max(self.across(p))
    }

    /// All crossings, ascending, with their faces; `None` if the line meets an edge or a corner, or
    /// runs within a face.
    fn met(&self, line: &ExactLine) -> Option<Vec<Met>> {
        self.known.get(line, || self.find(line))
    }

    fn find(&self, line: &ExactLine) -> Option<Vec<Met>> {
        // Numerators, positive denominators, faces.
        let mut found: Vec<(Exact, Exact, u32)> = vec![];
        let ratio = |n: Exact, d: Exact| if d.sign().is_lt() { (-n, -d) } else { (n, d) };
        for edge in self.edges() {
            let (n, at_origin) = self.plane(edge);
            let dot = |v: &[Exact; 3]| &(&(&n[0] * &v[0]) + &(&n[1] * &v[1])) + &(&n[2] * &v[2]);
            let (height, slope) = (&dot(&line.o) + &at_origin, dot(&line.d));
            if slope.sign().is_eq() {
                if height.sign().is_eq() {
                    // Along y it meets the wall or misses it; in other cases the oracle gives no
                    // answer.
                    let along_y =
                        self.sweep == Sweep::Linear && [0, 2].iter().all(|&i| line.d[i].sign().is_eq());
                    if !along_y || self.across(&self.at(line, &0.0.into(), &1.0.into())).is_eq() {
                        return None;
                    }
                }
                continue;
            }
            let p = self.at(line, &-height.clone(), &slope);
            let Some([x, z, w]) = self.projected(&p) else {
                if self.height(&p).is_le() && self.across(&p).is_le() {
                    return None;
                }
                continue;
            };
            let [a, b] = edge.map(|v| v.map(Exact::from));
            let along = |from: &[Exact; 2], to: &[Exact; 2]| {
                let d = [&to[0] - &from[0], &to[1] - &from[1]];
                let p = [&x - &(&from[0] * &w), &z - &(&from[1] * &w)];
                (&(&d[0] * &p[0]) + &(&d[1] * &p[1])).sign()
            };
            // Strictly within the wall; on its rim the oracle gives no answer.
            match (along(&a, &b).min(along(&b, &a)), self.height(&p)) {
                (Ordering::Less, _) | (_, Ordering::Greater) => {}
                (Ordering::Greater, Ordering::Less) => {
                    let (n, d) = ratio(-height, slope);
                    found.push((n, d, 0));
                }
                _ => return None,
            }
        }
        for (level, face) in [(self.low, 1), (self.high, 2)] {
            let height = &line.o[1] - &Exact::from(level);
            if line.d[1].sign().is_eq() {
                if height.sign().is_eq() {
                    return None;
                }
                continue;
            }
            let p = self.at(line, &-height.clone(), &line.d[1]);
            match self.across(&p) {
                Ordering::Less => {
                    let (n, d) = ratio(-height, line.d[1].clone());
                    found.push((n, d, face));
                }
                Ordering::Equal => return None,
                Ordering::Greater => {}
            }
        }
        type Found = (Exact, Exact, u32);
        let order = |a: &Found, b: &Found| (&(&a.0 * &b.1) - &(&b.0 * &a.1)).sign();
        found.sort_by(order);
        if found.windows(2).any(|w| order(&w[0], &w[1]).is_eq()) {
            return None;
        }
        assert!(found.len().is_multiple_of(2), "the witness itself leaks");
        let crossing = |(i, (n, d, face)): (usize, Found)| {
            let sign = if i % 2 == 0 { -1 } else { 1 };
            (Crossing { t: Surd::ratio(n, d), sign, grazing: false }, face)
        };
        Some(found.into_iter().enumerate().map(crossing).collect())
    }
}

/// Faces that are nearer to a point than this are not distinguished.
const NEAR: f64 = 1e-5;

impl Swept {
    fn value(&self, edge: [Point; 2], point: &[Exact; 3]) -> Exact {
        let (n, at_origin) = self.plane(edge);
        (0..3).fold(at_origin, |sum, i| &sum + &(&n[i] * &point[i]))
    }

    /// The edge whose wall is nearest, and how many walls are near.
    fn nearest(&self, point: &[Exact; 3]) -> ([Point; 2], usize) {
        let p = Vec3::from(point.clone().map(|x| x.to_f64()));
        let w = if self.sweep == Sweep::Linear { 1.0 } else { p.y };
        let (mut best, mut near) = ((f64::INFINITY, [[0.0; 2]; 2]), 0);
        for [a, b] in self.edges() {
            let (ex, ez) = (b[0] - a[0], b[1] - a[1]);
            let along = ((p.x - w * a[0]) * ex + (p.z - w * a[1]) * ez) / (w * (ex * ex + ez * ez));
            let normal = Vec3::from(self.plane([a, b]).0.map(|x| x.to_f64()));
            let distance = self.value([a, b], point).to_f64().abs() / normal.length();
            if (-NEAR..=1.0 + NEAR).contains(&along) {
                near += usize::from(distance < NEAR);
                if distance < best.0 {
                    best = (distance, [a, b]);
                }
            }
        }
        (best.1, near)
    }

    fn plane_points_out(&self, edge: [Point; 2], point: &[Exact; 3]) -> bool {
        let normal = Vec3::from(self.plane(edge).0.map(|x| x.to_f64()));
        let step = exact3((normal * (0.1 * NEAR / normal.length())).to_array());
        let beside = [0, 1, 2].map(|i| &point[i] + &step[i]);
        self.side(&beside) != Some(Ordering::Less)
    }
}

impl Oracle for Swept {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        self.met(line).unwrap_or_default().into_iter().map(|(c, _)| c).collect()
    }

    /// Valid for points near one face only, see [`Swept::is_clear`].
    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        match face {
            1 => (&Exact::from(self.low) - &point[1]).sign(),
            2 => (&point[1] - &Exact::from(self.high)).sign(),
            _ => {
                let (edge, _) = self.nearest(point);
                let side = self.value(edge, point).sign();
                if self.plane_points_out(edge, point) { side } else { side.reverse() }
            }
        }
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        match face {
            1 => -Vec3::Y,
            2 => Vec3::Y,
            _ => {
                let (edge, _) = self.nearest(point);
                let n = Vec3::from(self.plane(edge).0.map(|x| x.to_f64()));
                if self.plane_points_out(edge, point) { n } else { -n }
            }
        }
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        let [x, y, z] = point.clone();
        Some(self.whole(&Weighted { x, y, z, w: Exact::from(1.0) }))
    }

    fn size(&self) -> f64 {
        8.0
    }

    fn is_convex(&self) -> bool {
        false
    }
}

const SQUARE: [Point; 4] = [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]];
const HOLE: [Point; 4] = [[-1.0, -1.0], [-1.0, 2.0], [2.0, 2.0], [2.0, -1.0]];
const STAR: [Point; 5] = [[0.0, 0.0], [4.0, 3.0], [-1.0, 3.0], [3.0, 0.0], [1.0, 5.0]];
const COMB: [Point; 8] =
    [[0.0, 0.0], [6.0, 0.0], [6.0, 3.0], [4.0, 1.0], [3.0, 3.0], [2.0, 1.0], [1.0, 3.0], [0.0, 1.0]];

fn cases() -> Vec<(Prism, Swept)> {
    let mut out = vec![];
    let sets: [&[&[Point]]; 5] = [&[&SQUARE], &[&SQUARE, &HOLE], &[&STAR], &[&COMB], &[&SQUARE, &STAR]];
    for set in sets {
        let outlines: Vec<Vec<Point>> = set.iter().map(|o| o.to_vec()).collect();
        for (sweep, low, high) in [
            (Sweep::Linear, -1.0, 2.0),
            (Sweep::Linear, 0.25, 0.375),
            (Sweep::Conic, 0.5, 1.0),
            (Sweep::Conic, 0.0, 1.0),
            (Sweep::Conic, -1.0, 0.5),
        ] {
            // The heights in the other order make no difference.
            let prism = Prism::new(&outlines, high, low, sweep).unwrap();
            let tangled = set.iter().any(|o| o.len() == 5);
            assert_eq!(prism.tangled, tangled);
            let known = LineCache::default();
            out.push((prism, Swept { outlines: outlines.clone(), low, high, sweep, known }));
        }
    }
    out
}

/// The exact description of a prism, in addition to its crossings.
pub(super) trait Known: Oracle {
    /// Whether a line misses all edges, so that each crossing belongs to one face.
    fn is_plain(&self, line: &ExactLine) -> bool;
    /// Whether each crossing is so far from the other faces that its point identifies its face.
    fn is_clear(&self, line: &ExactLine) -> bool;
    /// Whether the crossings are so far apart that `t` determines their order.
    fn is_spread(&self, line: &ExactLine) -> bool;
}

impl Known for Swept {
    fn is_plain(&self, line: &ExactLine) -> bool {
        self.met(line).is_some()
    }

    fn is_spread(&self, line: &ExactLine) -> bool {
        let t: Vec<f64> = self.crossings(line).iter().map(|c| c.t.about(BITS).to_f64()).collect();
        t.windows(2).all(|t| t[1] - t[0] > 1e-12 * t[0].abs().max(t[1].abs()))
    }

    fn is_clear(&self, line: &ExactLine) -> bool {
        self.crossings(line).iter().all(|c| {
            let p = line.at(&c.t.about(BITS));
            let caps = [self.low, self.high].iter().filter(|y| (p[1].to_f64() - **y).abs() < NEAR).count();
            caps + self.nearest(&p).1 == 1
        })
    }
}

/// Whether rays that start along the normals at all crossings of a ray with the prism meet no edge.
fn leaves_clearly(prism: &dyn TestSurface, oracle: &impl Known, ray: &Ray) -> bool {
    all_roots(prism, ray).iter().all(|root| {
        let point = prism.resolve(&LocalRay::new(ray), root, Need::POINT);
        let n = point.ng.to_vec();
        [(RaySide::Front, n), (RaySide::Back, -n)].iter().all(|&(side, d)| {
            let line = ExactLine::new(&point.spawn_from(side, d));
            oracle.is_plain(&line) && oracle.is_spread(&line)
        })
    })
}

/// How many rays have obeyed the laws, how many roots they had, and how many rays were clear of
/// everything, so that all laws were tested.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Obeyed {
    pub(super) rays: u64,
    pub(super) roots: usize,
    pub(super) clear: usize,
}

impl Obeyed {
    /// Counts a ray that meets no edge, after testing all laws that apply to it.
    pub(super) fn count(
        &mut self,
        prism: &dyn TestSurface,
        oracle: &impl Known,
        ray: &Ray,
    ) -> Result<(), Broken> {
        let line = ExactLine::new(ray);
        if !ray.is_valid() || !oracle.is_plain(&line) {
            return Ok(());
        }
        let is_spread = oracle.is_spread(&line);
        let roots = if is_spread && oracle.is_clear(&line) && leaves_clearly(prism, oracle, ray) {
            self.clear += 1;
            check(prism, oracle, ray)?.len()
        } else if is_spread {
            roots_are_the_exact_crossings(prism, oracle, ray, None)?.len()
        } else {
            // The order of crossings of different faces that t does not separate is not tested.
            let roots = all_roots(prism, &ray.with_range(f64::NEG_INFINITY, f64::INFINITY)).len();
            let exact = oracle.crossings(&line).len();
            if roots != exact {
                return Err(format!("{roots} roots, and exactly {exact}"));
            }
            roots
        };
        self.rays += 1;
        self.roots += roots;
        Ok(())
    }
}

fn corners(prism: &Prism) -> Vec<Point3> {
    prism.walls.iter().flat_map(|w| w.facet).collect()
}

#[test]
fn prisms_obey_the_laws_off_their_edges() {
    let mut obeyed = Obeyed::default();
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let mut features = vec![];
        for v in corners(prism).into_iter().step_by(3) {
            for off in [[0.25, 0.5, -0.125], [-0.5, 0.25, 0.0625], [1.0 / 1024.0, -1.0 / 4096.0, 1.0 / 512.0]]
            {
                let point = v + Vec3::from(off);
                features.push(Feature { point, direction: Vec3::new(1.0, 2.0, -3.0) });
                features.push(Feature { point, direction: Vec3::Y });
                features.push(Feature { point, direction: v.to_vec() - prism.bounds.centre().to_vec() });
            }
        }
        for i in laws::drawn(150) {
            let ray = aim(&mut laws::dice(seed as u64, i), &features, oracle.size());
            // The next test covers rays that meet an edge exactly.
            let broken = |e| panic!("{e}\n{seed} {i} {ray:?}\n{prism:?}");
            obeyed.count(prism, oracle, &ray).unwrap_or_else(broken);
        }
    }
    let Obeyed { rays, roots, clear } = obeyed;
    laws::report(rays);
    assert!(rays > 2500 && roots > 2000 && clear > 2000, "{rays} {roots} {clear}");
}

#[test]
fn rays_through_edges_and_corners_go_in_as_often_as_out() {
    let mut through = 0;
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let all = corners(prism);
        let mut dice = TestRng::new(100 + seed as u64);
        for _ in 0..400 {
            let target = if dice.once_in(3) { dice.lattice(6).to_point() } else { dice.pick(&all) };
            let direction = if dice.once_in(3) { dice.pick(&all) - dice.pick(&all) } else { dice.lattice(4) };
            if direction == Vec3::ZERO {
                continue;
            }
            let back = dice.pick(&[7.0, 1000.0, 1048577.0]);
            let ray = Ray::new(target - direction * back, direction);
            let roots = all_roots(prism, &ray);
            assert!(roots.len().is_multiple_of(2), "{roots:?} for {ray:?} and {prism:?}");
            assert_eq!(
                roots.iter().map(|r| i32::from(r.sign)).sum::<i32>(),
                0,
                "{roots:?} for {ray:?} and {prism:?}"
            );
            through += usize::from(!roots.is_empty());
            // From the inside outward.
            let from = (dice.lattice(12) * 0.5).to_point();
            let at = exact3(from.to_array());
            if oracle.side(&at) != Some(Ordering::Equal) {
                let outward = Ray::new(from, dice.pick(&all) - from);
                if outward.is_valid() {
                    let inside = oracle.side(&at) == Some(Ordering::Less);
                    let met = all_roots(prism, &outward).len();
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
    assert!(through > 3000, "{through}");
}

/// Edges z = x and z = -x cross at the origin, x to the right and z up. A line that passes above
/// the crossing of the edges leaves its left half by the one that falls, and enters the other by
/// the one that rises.
#[test]
fn beside_a_crossing_of_the_outline_walls_are_met_in_their_order() {
    let bow = [[-2.0, -2.0], [2.0, 2.0], [2.0, -2.0], [-2.0, 2.0]];
    let prism = Prism::linear(&[bow], -1.0, 1.0).unwrap();
    assert!(prism.tangled);
    let (mut dice, mut close) = (TestRng::new(11), 0);
    for _ in 0..4000 {
        let d = Vec3::new(1.0, dice.between(-0.25, 0.25), dice.between(-0.875, 0.875));
        let o = (d * -dice.between(0.5, 3.0)).to_point();
        let o = Point3::new(dice.nudge(o.x, 2), o.y, dice.nudge(o.z, 2));
        // The height over the crossing.
        let exact = |a: f64, b: f64| &Exact::from(a) * &Exact::from(b);
        let above = (&exact(o.z, d.x) - &exact(o.x, d.z)).sign();
        if above.is_eq() {
            continue;
        }
        let ray = Ray::new(o, d).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let t = -o.x;
        let roots = all_roots(&prism, &ray);
        let middle: Vec<&Root> = roots.iter().filter(|r| (r.t - t).abs() < 1e-3).collect();
        assert_eq!(middle.len(), 2, "{roots:?}");
        close += usize::from(middle[0].hi >= middle[1].lo);
        for root in middle {
            let n = prism.resolve(&LocalRay::new(&ray), root, Need::ALL).ng;
            let falling = n.x * n.z > 0.0;
            assert_eq!(falling == above.is_gt(), root.sign > 0, "{root:?} of {ray:?}: {n:?}");
        }
    }
    assert!(close > 1000, "{close}");
}

#[test]
fn sides_are_exact() {
    let mut told = [0; 3];
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let mut dice = TestRng::new(200 + seed as u64);
        let all = corners(prism);
        for _ in 0..200 {
            let p = match dice.below(3) {
                0 => dice.pick(&all) + (dice.pick(&all) - dice.pick(&all)) * dice.pick(&[0.0, 0.25, 0.5]),
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
fn a_rectangular_prism_is_a_box() {
    let (min, max) = (Point3::new(-3.0, -1.0, -3.0), Point3::new(3.0, 2.0, 3.0));
    let (solid, prism) = (AxisBox::new(min, max).unwrap(), Prism::linear(&[SQUARE], -1.0, 2.0).unwrap());
    assert_eq!(solid.bounds(), prism.bounds());
    let mut dice = TestRng::new(7);
    let mut met = 0;
    for _ in 0..2000 {
        let from = (dice.vector() * 9.0).to_point();
        let ray = Ray::new(from, (dice.vector() * 3.0).to_point() - from);
        let (a, b) = (all_roots(&solid, &ray), all_roots(&prism, &ray));
        assert_eq!(a.len(), b.len(), "{ray:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!(a.sign == b.sign && a.lo <= b.hi && b.lo <= a.hi, "{a:?} {b:?}");
        }
        met += a.len();
    }
    assert!(met > 500, "{met}");
}

#[test]
fn without_caps_the_walls_stay() {
    let prism = Prism::linear(&[SQUARE, HOLE], 0.0, 1.0).unwrap();
    let open = prism.clone().without_caps();
    assert_eq!(open.solidity(), Solidity::Open);
    let mut dice = TestRng::new(8);
    for _ in 0..500 {
        let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
        let mut closed = all_roots(&prism, &ray);
        closed.retain(|r| r.face == 0);
        assert_eq!(all_roots(&open, &ray), closed);
    }
}

#[test]
fn parts_together_are_the_whole() {
    let (mut parts, mut met) = (0, 0);
    for (seed, (prism, _)) in cases().into_iter().enumerate() {
        let mut dice = TestRng::new(300 + seed as u64);
        let prism = if dice.once_in(3) { prism.without_caps() } else { prism };
        let all = corners(&prism);
        for _ in 0..100 {
            let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
            let ray = if dice.once_in(2) { Ray::new(ray.origin, dice.pick(&all) - ray.origin) } else { ray };
            let (asked, roots) = laws::parts_are_the_whole(&prism, &ray).unwrap_or_else(|e| panic!("{e}"));
            (parts, met) = (parts + asked, met + roots);
        }
    }
    assert!(parts > 10_000 && met > 1000, "{parts} {met}");
}

#[test]
fn bad_prisms_are_named() {
    let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
    assert_eq!(Prism::linear(&[line], 0.0, 1.0), Err(PrismError::Flat));
    assert_eq!(Prism::linear(&[SQUARE], 1.0, 1.0), Err(PrismError::Heights(1.0, 1.0)));
    assert!(matches!(Prism::linear(&[SQUARE], 0.0, f64::NAN), Err(PrismError::Heights(..))));
    assert_eq!(Prism::conic(&[SQUARE], 1.0, 1e308), Err(PrismError::TooLarge(1e308)));
}
