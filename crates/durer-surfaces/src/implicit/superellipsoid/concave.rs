//! Packet kernel of superellipsoids with dents between all axes: between two coordinate planes a
//! ray that starts outside meets one at most once.
//!
//! ```text
//!   N(x, y) = (|x|^p + |y|^p)^(1/p),   G(x, y, z) = (N^q + |z|^q)^(1/q),   1/4 <= p = 2/e <= 1,  1/4 <= q = 2/n <= 1
//!
//!   { G <= 1 } is the superellipsoid, within |x| + |y| + |z| <= 1
//! ```
//!
//! For `p <= 1` the power sum `N` of non-negative numbers is concave (H. Minkowski's reversed
//! inequality: G. H. Hardy, J. E. Littlewood, G. Pólya, *Inequalities*, 1934, 2.11). `G` is such a
//! sum of `N` and `|z|`, and rises with both. So `g(s) = G(o + s d)` is concave as long as no
//! coordinate changes its sign. There:
//!
//! - Where `g > 1` at both ends of a stretch, `g > 1` on all of it.
//! - Where `g > 1` at one end and `g < 1` at the other, there is exactly one crossing.
//!
//! So it suffices to know the signs where a ray crosses the three planes `x = 0`, `y = 0`, `z = 0`.
//! The slope of `G` is unbounded there, but `G` rises with the size of each coordinate: in a box of
//! points it is least at the corner nearest to the origin, and greatest at the farthest. The box of
//! a point next to a plane holds all points up to the exact ray's crossing with the plane, so the
//! side of the point does not matter.
//!
//! Rays inside the solid are classified by the formula.
//!
//! **The value.** As in `convex/gauge.rs`, with relative errors of `8 u` in logarithms and `4 u` in
//! powers. The larger of two numbers is at least `2^(-1/p) N`, or `2^(-1/q) G`. So the error of
//! `log N` is at most `(16 |a| + 20 / p + |log N|) u`, that of `log G` at most
//! `(36 / p + 41 / q + 22 |log G|) u`, and the relative error of `G` from 1/4 to 4 at most
//! `(25 / p + 29 / q + 36) u`. Outside this range the error is far below the difference from 1.

use super::convex::{Gauge, Sample};
use crate::implicit::Isosurface;
use crate::packet::{ImplicitKernel, Line8, LineExtent8, Segment8, Skin, Slant, Value8};
use durer_math::{F8, Isa, M8, U, Vec3};

/// An octahedron enlarged by this holds the solid with a margin for all rounding, for a line whose
/// error is small enough.
const ROOM: f64 = 1.0 / 64.0;
/// A point within this many times its error of a plane between octants counts as on it. Two would
/// suffice for rounded crossings of lines with these planes.
const NEAR: f64 = 8.0;
/// Points with a coordinate of this size are outside.
const FAR_OUT: f64 = 4.0;
const NEVER: F8 = F8::splat(f64::INFINITY);

/// The solid.
#[derive(Clone, Debug)]
pub(in crate::implicit) struct Star {
    gauge: Gauge,
    /// Bound on the error of the gauge, relative to it.
    error: f64,
    /// The solid's formula.
    formula: Isosurface,
}

/// Lower and upper bounds on the magnitude of each coordinate of eight points.
struct Sizes {
    least: Vec3<F8>,
    most: Vec3<F8>,
}

impl Star {
    pub(in crate::implicit) fn new(gauge: &Gauge, formula: &Isosurface) -> Self {
        let (over_p, over_q) = gauge.over_exponents();
        let error = (25.0 * over_p + 29.0 * over_q + 36.0) * (1.0 + 1.0 / 512.0) * U;
        Self { gauge: gauge.clone(), error, formula: formula.clone() }
    }

    /// Bounds of the point at `s` of each line. If the point is next to a plane, they hold all
    /// points up to the line's crossing with it.
    #[inline(always)]
    fn sizes(line: &Line8, s: F8) -> Sizes {
        let (p, e) = (line.point(s).map(F8::abs), line.error(s.abs()));
        let d = line.d.map(F8::abs);
        let slip = |p: F8, d: F8| {
            let certain = d - line.e_d * 2.0;
            let slip = certain.gt(F8::ZERO).select(e * (2.0 * NEAR) / certain, NEVER);
            p.le(e * NEAR).select(slip, F8::ZERO)
        };
        let slip = slip(p.x, d.x).max(slip(p.y, d.y)).max(slip(p.z, d.z));
        let off = |p: F8, d: F8| slip * (d + line.e_d) * (1.0 + 16.0 * U) + e + p * (4.0 * U);
        let off = Vec3::new(off(p.x, d.x), off(p.y, d.y), off(p.z, d.z));
        // A bound that is NaN or infinite excludes nothing.
        let least = |p: F8, off: F8| (p - off).max(F8::ZERO);
        let most = |p: F8, off: F8| (p + off).min(F8::splat(FAR_OUT));
        Sizes {
            least: Vec3::new(least(p.x, off.x), least(p.y, off.y), least(p.z, off.z)),
            most: Vec3::new(most(p.x, off.x), most(p.y, off.y), most(p.z, off.z)),
        }
    }
}

impl ImplicitKernel for Star {
    fn reach(&self) -> f64 {
        1.0 + ROOM
    }

    fn part(&self, line: &Line8, part: &mut LineExtent8) {
        self.formula.part(line, part);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let (o, d) = (&line.o, &line.d);
                let (mut from, mut to) = (-NEVER, NEVER);
                for (y, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    let (o, d) = (o.x + o.y * y + o.z * z, d.x + d.y * y + d.z * z);
                    let (a, b) = ((-o - (1.0 + ROOM)) / d, (-o + (1.0 + ROOM)) / d);
                    (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
                }
                // A line with a large error is uncertain from in front of the solid to behind it.
                let far = F8::splat(2.0 * (1.0 + ROOM));
                (part.from, part.to) = (part.unsure.select(-far, from), part.unsure.select(far, to));
            },
        );
    }

    fn classify(&self, line: &Line8, told: &mut Segment8) {
        let mut within = M8::NONE;
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                let Vec3 { x, y, z } = line.point(told.a).map(F8::abs);
                let near = x.min(y).min(z).le(line.error(told.a.abs()) * NEAR);
                within = told.lanes & told.sign.lt(F8::ZERO);
                told.seen = told.lanes & !within;
                // A ray that starts next to a plane is not proven outside up to it: fall back.
                told.falls = told.seen & !(near & told.hint.equals(NEVER));
                let mut end = told.last;
                for (o, d) in [(line.o.x, line.d.x), (line.o.y, line.d.y), (line.o.z, line.d.z)] {
                    let s = -o / d;
                    end = s.gt(told.a).select(s.min(end), end);
                }
                told.b.set_where(told.seen, end);
                told.next.set_where(told.seen, F8::ZERO);
            },
        );
        if within.any() {
            let mut inside = Segment8 { lanes: within, seen: M8::NONE, ..*told };
            self.formula.classify(line, &mut inside);
            line.isa.run_in_lanes(
                #[inline(always)]
                || {
                    told.seen |= inside.seen;
                    told.out |= inside.out & within;
                    told.within |= inside.within & within;
                    told.rises |= inside.rises & within;
                    told.falls |= inside.falls & within;
                    told.a.set_where(within, inside.a);
                    told.b.set_where(within, inside.b);
                    told.hint.set_where(within, inside.hint);
                    told.next.set_where(within, inside.next);
                },
            );
        }
    }

    fn values(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8) {
        let zero = Vec3::splat(Vec3::ZERO);
        let mut sizes = Sizes { least: zero, most: zero };
        line.isa.run_in_lanes(
            #[inline(always)]
            || sizes = Self::sizes(line, *s),
        );
        let mut g = F8::ZERO;
        self.gauge.values(line.isa, &sizes.least, &mut g);
        let (one, noise) = (F8::ONE, self.error * 2.0);
        let rest = line.isa.run_in_lanes(
            #[inline(always)]
            || {
                value.g = g - one;
                value.above = value.g.gt(g * noise);
                value.below = M8::NONE;
                lanes & !value.above
            },
        );
        if !rest.any() {
            return;
        }
        self.gauge.values(line.isa, &sizes.most, &mut g);
        line.isa.run_in_lanes(
            #[inline(always)]
            || {
                value.below = rest & (one - g).gt(F8::splat(noise));
                value.g.set_where(value.below, g - one);
            },
        );
    }

    fn about(&self, line: &Line8, s: &F8, _lanes: M8, g: &mut F8) {
        let mut p = Vec3::splat(Vec3::ZERO);
        line.isa.run_in_lanes(
            #[inline(always)]
            || p = line.point(*s),
        );
        self.gauge.values(line.isa, &p, g);
        line.isa.run_in_lanes(
            #[inline(always)]
            || *g = *g - F8::ONE,
        );
    }

    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        let mut sample = Sample::new();
        self.gauge.sample(isa, y, &mut sample);
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let g = &sample.gradient;
                *slant = Slant { f: sample.value - 1.0, half: Vec3::new(g.x * 0.5, g.y * 0.5, g.z * 0.5) };
            },
        );
    }

    fn skin(&self, isa: Isa, at: (&Vec3<F8>, &F8), skin: &mut Skin) {
        self.formula.skin(isa, at, skin);
    }
}

#[cfg(test)]
mod tests {
    use super::super::convex::tests::{Exact, P, RM, big, coordinate, number};
    use super::*;
    use crate::implicit::superellipsoid;
    use crate::laws::TestRng;
    use astro_float::BigFloat;
    use durer_math::lanes::LANES;

    /// Exponents: ordinary ones, and those at both ends.
    const SHAPES: [(f64, f64); 7] =
        [(3.2, 2.5), (2.0, 2.5), (2.5, 2.0), (4.0, 4.0), (8.0, 8.0), (8.0, 2.0), (2.0, 8.0)];

    fn star((e, n): (f64, f64)) -> Star {
        let surface = superellipsoid(e, n).unwrap();
        Star::new(surface.dented.as_ref().unwrap(), &surface)
    }

    /// A point in a direction from the origin, as far as its gauge says.
    fn of_gauge(star: &Star, x: Vec3, gauge: f64) -> Vec3 {
        let x = if x == Vec3::ZERO { Vec3::X } else { x };
        let mut g = F8::ZERO;
        star.gauge.values(Isa::detect(), &Vec3::splat(x), &mut g);
        x * (gauge / g.0[0])
    }

    /// Coordinates of any size.
    fn wild(dice: &mut TestRng) -> Vec3 {
        Vec3::new(coordinate(dice), coordinate(dice), coordinate(dice))
    }

    #[test]
    fn the_value_keeps_its_bound() {
        let (mut exact, mut dice) = (Exact::new(), TestRng::new(1));
        let mut worst = 0.0_f64;
        for shape in SHAPES {
            let star = star(shape);
            for round in 0..60 {
                let far = [0.0, 1e-3, 0.7][round % 3] * dice.between(-1.0, 1.0);
                let x = of_gauge(&star, wild(&mut dice), 1.0 + far);
                let mut g = F8::ZERO;
                star.gauge.values(Isa::detect(), &Vec3::splat(x), &mut g);
                let (value, _) = exact.gauge(shape, &x.to_array().map(big));
                let error = number(&big(g.0[0]).sub(&value, P, RM).div(&value, P, RM).abs());
                assert!(error <= star.error, "{shape:?} {x:?}: {} u", error / U);
                worst = worst.max(error / star.error);
            }
        }
        assert!(worst > 1.0 / 64.0, "{worst}");
    }

    /// Through where, and in which direction: along a ridge at a small angle and beside it by some
    /// times `e`, beside a tangent, or anywhere.
    fn aim(dice: &mut TestRng, star: &Star, e: f64) -> (Vec3, Vec3) {
        let (mut x, mut d) = (wild(dice), wild(dice));
        let axis = dice.below(3) as usize;
        match dice.below(4) {
            0 | 1 => {
                x = Vec3::from([0, 1, 2].map(|k| if k == axis { 0.0 } else { dice.between(-1.0, 1.0) }));
                d = Vec3::from(
                    [0, 1, 2].map(|k| if k == axis { dice.scale(-9, -4) } else { dice.between(-1.0, 1.0) }),
                );
                (of_gauge(star, x, 1.0 + e * dice.between(0.0, 32.0)), d)
            }
            2 => {
                x = of_gauge(star, x, 1.0 + dice.pick(&[0.0, 1e-12, 1e-6, 1e-3, 0.5]));
                let mut sample = Sample::new();
                star.gauge.sample(Isa::detect(), &Vec3::splat(x), &mut sample);
                let n = sample.gradient.lane(0);
                (x, n.cross(d) * (1.0 / n.max_abs()))
            }
            _ => (of_gauge(star, x, dice.between(0.75, 2.0)), d),
        }
    }

    /// A line known within `e`, and where it truly begins.
    fn line_at(dice: &mut TestRng, star: &Star, e: f64, line: &mut Line8, i: usize) -> [BigFloat; 3] {
        let (through, d) = aim(dice, star, e);
        let d = if d.max_abs() > 1e-100 { d * (1.0 / d.max_abs()) } else { Vec3::new(0.3, -0.2, 0.9) };
        let d = d * (1.0 / d.length());
        let o = through - d * through.dot(d);
        line.o.set_lane(i, o);
        line.d.set_lane(i, d);
        (line.e_o.0[i], line.e_d.0[i]) = (e, 4.0 * U);
        let off = [0, 1, 2].map(|_| dice.pick(&[-e, 0.0, e]));
        [0, 1, 2].map(|k| big(o[k]).add(&big(off[k]), 2000, RM))
    }

    /// Lines go on from stretch to stretch as those of pictures do: what is said to be outside is,
    /// and where a line is said to go in once it goes in once.
    #[test]
    fn what_is_told_of_stretches_is_so() {
        let (mut exact, mut dice) = (Exact::new(), TestRng::new(2));
        let (mut passed, mut met, mut open) = (0, 0, 0);
        for round in 0..70 {
            let shape = SHAPES[round % SHAPES.len()];
            let star = star(shape);
            let e = dice.pick(&[4.0 * U, 1e-13, 1e-9, 1e-7]);
            let zero = Vec3::splat(Vec3::ZERO);
            let mut line = Line8 { isa: Isa::detect(), o: zero, d: zero, e_o: F8::ZERO, e_d: F8::ZERO };
            let origins: [_; LANES] = core::array::from_fn(|i| line_at(&mut dice, &star, e, &mut line, i));
            let mut side = |origin: &[BigFloat; 3], d: Vec3, s: f64| {
                let x = [0, 1, 2].map(|k| origin[k].add(&big(s).mul(&big(d[k]), 2000, RM), 2000, RM));
                exact.gauge(shape, &x).0.cmp(&big(1.0)).map_or(0, |o| o.signum() as i32)
            };
            let (none, never) = (M8::NONE, NEVER);
            let mut part = LineExtent8 { from: F8::ZERO, to: F8::ZERO, unsure: none };
            star.part(&line, &mut part);
            for (i, origin) in origins.iter().enumerate() {
                let d = line.d.lane(i);
                let (mut a, last, mut hint) = (part.from.0[i], part.to.0[i], f64::INFINITY);
                while a < last && !part.unsure.lane(i) {
                    let mut lanes = none;
                    lanes.set_lane(i, true);
                    let (a8, last8) = (F8::splat(a), F8::splat(last));
                    let mut told = Segment8 {
                        lanes,
                        seen: none,
                        a: a8,
                        b: a8,
                        last: last8,
                        out: none,
                        within: none,
                        rises: none,
                        falls: none,
                        sign: F8::ONE,
                        hint: F8::splat(hint),
                        next: never,
                    };
                    star.classify(&line, &mut told);
                    assert!(told.seen.lane(i) && !told.out.lane(i) && !told.rises.lane(i));
                    let (from, b) = (told.a.0[i], told.b.0[i]);
                    assert!(from == a && a < b && b <= last, "{shape:?} {line:?} {i}: {a} {b}");
                    let mut value = Value8 { g: F8::ZERO, above: none, below: none };
                    star.values(&line, &told.b, lanes, &mut value);
                    let (above, below) = (value.above.lane(i), value.below.lane(i));
                    if !told.falls.lane(i) || !(above | below) {
                        open += 1;
                        break;
                    }
                    let mut places =
                        [0.0, 1e-15, 1e-9, 0.1, 0.3, 0.5, 0.7, 0.9].map(|k| a + (b - a) * k).to_vec();
                    places.push(b);
                    // Where the exact line goes through planes it is nearest to the solid, by far:
                    // there are ridges.
                    let planes = [0, 1, 2].map(|k| -number(&origin[k]) / d[k]);
                    places.extend(planes.into_iter().filter(|s| (a..=b).contains(s)));
                    places.sort_by(f64::total_cmp);
                    let sides: Vec<_> = places.iter().map(|&s| side(origin, d, s.min(b))).collect();
                    if above {
                        assert!(
                            sides.iter().all(|&side| side == 1),
                            "{shape:?} {line:?} {i}: {a} {b} {sides:?}"
                        );
                        passed += 1;
                        (a, hint) = (b, told.next.0[i]);
                    } else {
                        let in_order =
                            sides.is_sorted_by(|a, b| a >= b) && sides[0] == 1 && sides.last() == Some(&-1);
                        assert!(in_order, "{shape:?} {line:?} {i}: {a} {b} {sides:?}");
                        met += 1;
                        break;
                    }
                }
            }
        }
        assert!(passed > 50 && met > 100 && open < passed + met, "{passed} {met} {open}");
    }

    /// Along a plane between octants, or with numbers that are none, neither side is certain.
    #[test]
    fn nothing_is_said_where_nothing_is_known() {
        let star = star((3.0, 3.0));
        let (zero, lanes) = (Vec3::splat(Vec3::ZERO), M8::ALL);
        for (o, d, e_d) in [
            (Vec3::ZERO, Vec3::X, 4.0 * U),
            (Vec3::ZERO, Vec3::X, 0.0),
            (Vec3::new(0.25, 0.25, 0.0), Vec3::X, 4.0 * U),
            (Vec3::new(f64::NAN, 0.0, 0.0), Vec3::Y, 4.0 * U),
            (Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY), Vec3::Y, 4.0 * U),
        ] {
            let mut line =
                Line8 { isa: Isa::detect(), o: zero, d: zero, e_o: F8::splat(U), e_d: F8::splat(e_d) };
            (line.o, line.d) = (Vec3::splat(o), Vec3::splat(d));
            let mut value = Value8 { g: F8::ZERO, above: lanes, below: lanes };
            star.values(&line, &F8::splat(0.125), lanes, &mut value);
            assert!(!value.above.any() && !value.below.any(), "{o:?} {d:?}");
        }
    }

    /// Of a line that is known so badly that it may meet the solid where its rounded numbers pass
    /// by, there is a part to doubt.
    #[test]
    fn lines_that_are_hardly_known_are_doubted() {
        let (x, zero) = (Vec3::splat(Vec3::X), Vec3::splat(Vec3::ZERO));
        let mut line = Line8 { isa: Isa::detect(), o: zero, d: x, e_o: F8::splat(0.5), e_d: F8::ZERO };
        line.o.y = F8::splat(1.25);
        let ball = superellipsoid(1.0, 1.0).unwrap().gauge.unwrap();
        let levels: [&dyn ImplicitKernel; 2] = [&ball, &star((3.0, 3.0))];
        for level in levels {
            let mut part = LineExtent8 { from: F8::ZERO, to: F8::ZERO, unsure: M8::NONE };
            level.part(&line, &mut part);
            assert!(part.unsure.all() && part.from.le(F8::splat(-1.0)).all() && part.to.ge(F8::ONE).all());
        }
    }
}
