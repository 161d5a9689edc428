//! The packet kernel of the walls and caps of swept solids: a cubic curve in the xz plane, swept
//! along y or towards the origin.
//!
//! ```text
//!   linear   the trace of a ray o + t d in the plane is
//!              dz x - dx z + (dx oz - dz ox) = 0,       t = (x - ox) / dx
//!   conic    the trace of the plane through the origin and the ray is
//!              (o × d)·(x, 1, z) = 0,                   t = (x oy - ox) / (dx - x dy)
//! ```
//!
//! and the same with z for x; the larger divisor is used. Along a curve `c(u) = (x, z)` the trace
//! is a cubic `g(u)` (`polynomial_roots.rs`) whose Bernstein coefficients are its values at the
//! control points. Usually they have one sign, and the ray misses. If the sign changes, the root in
//! `u` gives the point of the wall, and that gives the parameter on the ray. A point is inside a
//! cap if a line from the point along x crosses the curves an odd number of times. `prism/curved/`
//! does the same in exact numbers.
//!
//! **Errors.** The values of `g` are weighted means of the values at the control points, so a
//! common error bound of these is an error bound of `g` everywhere. In powers of `u` the sum of the
//! magnitudes of the coefficients is at most `12 Σ |g_i|`; the bound includes 64 roundings of that
//! size for `polynomial_roots.rs`.

mod caps;
mod walls;
mod whole;

use self::caps::{conclude, count, reach};
use self::walls::{Form8, Named, cubic_of, enclose, wall};
use crate::packet::PacketFilter;
use crate::packet::closest::PacketQuery;
use crate::packet::crossings::Crossings;
use crate::packet::kernel::{FacePoints, KernelRays, KernelScratch, PacketKernel};
use crate::packet::local_frame::Own;
use crate::packet::polynomial_roots::{Part8, Poly8, Root8};
use crate::packet::quadric::Start;
use crate::packet::rays::{NEVER, Nearest, RayLanes, SLACK};
use crate::packet::skin::{Skin, Slant};
use durer_math::Isa;
use durer_math::{F8, M8, U, Vec3};

/// A cubic curve by its control points, all x and then all z, each within `slack` of the exact one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProfileCurve8 {
    points: [[f64; 4]; 2],
    slack: f64,
    /// An upper bound of the magnitudes of all its coordinates.
    reach: f64,
    /// The bounding box: least and greatest x, least and greatest z, widened by `slack` and by the
    /// rounding of numbers of this size.
    around: [f64; 4],
}

/// The kind of sweep, and its two heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep8 {
    pub(crate) conic: bool,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// One part of a swept solid.
#[derive(Clone, Debug)]
pub(crate) enum Swept {
    /// The wall of one curve; whether the inside is to its left, with x to the right and z up.
    Wall { curve: ProfileCurve8, sweep: Sweep8, left: bool },
    /// The cap at the bottom, or at the top, between all curves.
    Cap { curves: Box<[ProfileCurve8]>, sweep: Sweep8, top: bool },
    /// A whole closed solid, and for each curve whether the inside is to its left; `None` if curves
    /// may cross.
    Whole { curves: Box<[ProfileCurve8]>, sweep: Sweep8, left: Option<Box<[bool]>> },
}

/// Working memory for eight rays and one part.
#[derive(Debug, Default)]
struct PrismScratch {
    o: [F8; 3],
    d: [F8; 3],
    e_o: F8,
    e_d: F8,
    /// A bound on every `t` at which the surface can be met.
    far: F8,
    /// The rays between the two heights, and their traces there: the least and the greatest x, and
    /// z.
    between: M8,
    traces: [F8; 4],
    form: Form8,
    /// A box around the traces of all rays.
    around: [f64; 4],
    poly: Poly8<4>,
    part: Part8,
    root: Root8,
    /// For a cap: the crossing with its plane, the point there, and whether that is inside so far.
    t: F8,
    e: F8,
    place: [F8; 2],
    e_place: F8,
    open: M8,
    odd: M8,
    unsure: M8,
}

impl Sweep8 {
    /// Whether the sweep ends at the top, or at the bottom, in its apex instead of a cap.
    fn has_tip(&self, top: bool) -> bool {
        self.conic && (if top { self.high } else { self.low }) == 0.0
    }
}

/// The tag of a point on a wall: `u` along its curve, and, as the sign, whether the inside is to
/// the left.
#[inline(always)]
fn tag_of(u: F8, left: M8) -> F8 {
    u.copysign(left.select(F8::ONE, F8::splat(-1.0)))
}

/// The `u` and the side in a tag.
#[inline(always)]
fn side_of(tag: F8) -> (F8, M8) {
    (tag.abs(), F8::ONE.copysign(tag).gt(F8::ZERO))
}

/// The least number in some lanes: infinite if there are no lanes, NaN if one of the numbers is
/// NaN.
#[inline(always)]
fn lowest(lanes: M8, v: F8) -> f64 {
    let mut least = f64::INFINITY;
    for x in lanes.select(v, F8::splat(f64::INFINITY)).0 {
        least = if least <= x {
            least
        } else if x <= least {
            x
        } else {
            f64::NAN
        };
    }
    least
}

impl ProfileCurve8 {
    /// The curve with these control points, each within `slack`; no coordinate is larger than
    /// `reach`.
    pub(crate) fn new(points: [[f64; 4]; 2], slack: f64, reach: f64) -> Self {
        let room = slack + reach * (8.0 * U);
        let [(x0, x1), (z0, z1)] = points.each_ref().map(caps::range);
        Self { points, slack, reach, around: [x0 - room, x1 + room, z0 - room, z1 + room] }
    }

    /// Whether the curve is certainly outside a box in the same format as `around`.
    #[inline(always)]
    fn is_beside(&self, [x0, x1, z0, z1]: &[f64; 4]) -> bool {
        let [a, b, c, d] = &self.around;
        x1 < a || x0 > b || z1 < c || z0 > d
    }

    /// A point and its derivative by `u`, for `u` in `[0, 1]`, by P. de Casteljau's scheme.
    #[inline(always)]
    fn at(&self, u: F8) -> ([F8; 2], [F8; 2]) {
        let w = F8::ONE - u;
        let mut at = [F8::ZERO; 2];
        let mut slope = [F8::ZERO; 2];
        for k in 0..2 {
            let [a, b, c, d] = F8::splats(self.points[k]);
            let (ab, bc, cd) = (w.mul_add(a, u * b), w.mul_add(b, u * c), w.mul_add(c, u * d));
            let (abc, bcd) = (w.mul_add(ab, u * bc), w.mul_add(bc, u * cd));
            at[k] = w.mul_add(abc, u * bcd);
            slope[k] = (bcd - abc) * 3.0;
        }
        (at, slope)
    }

    /// A bound on the error of a point, for exact `u`.
    fn rounding(&self) -> f64 {
        self.slack + self.reach * (16.0 * U)
    }

    /// Upper bounds of the magnitudes of the first and the second derivative by `u`.
    fn speed(&self) -> (f64, f64) {
        (self.reach * 8.5, self.reach * 34.0)
    }
}

/// The cubic with these Bernstein coefficients, all within `e`.
#[inline(always)]
fn cubic(g: [F8; 4], e: F8) -> Poly8<4> {
    let [a, b, c, d] = g;
    let sum = a.abs() + b.abs() + c.abs() + d.abs();
    let e = (e + sum * (12.0 * 64.0 * U)) * SLACK;
    let (first, second) = (b - a, c - b);
    let k = [a, first * 3.0, (second - first) * 3.0, (d - c) - second * 2.0 + first];
    Poly8 { c: k, e, e_first: e, e_last: e }
}

impl PacketKernel for Swept {
    fn face_of(&self, number: u32) -> u32 {
        match self {
            Self::Whole { curves, .. } => (number + 1).saturating_sub(curves.len() as u32).min(2),
            Self::Wall { .. } => 0,
            Self::Cap { top, .. } => 1 + u32::from(*top),
        }
    }

    /// Whether this is a whole solid with few enough faces to number.
    fn is_operand(&self) -> bool {
        matches!(self, Self::Whole { curves, .. } if curves.len() + 2 <= PacketFilter::FACES)
    }

    fn first(
        &self,
        seen: &KernelRays<'_>,
        query: &PacketQuery<'_>,
        nearest: &mut Nearest,
        scratch: &mut KernelScratch,
    ) {
        let &KernelRays { own, rays, leaving, start, .. } = seen;
        let memory: &mut PrismScratch = scratch.of();
        let mut to = query.first(nearest);
        let from = leaving.map(|(from, turned)| from.by_own_normals(turned));
        match self {
            Self::Wall { curve, sweep, left } => {
                rays.isa.run_in_lanes(
                    #[inline(always)]
                    || see(own, rays, start, memory),
                );
                if enclose(rays, sweep, &to, memory, true) && cubic_of(rays, curve, &mut to, memory) {
                    let named = Named { face: 0.0, left: *left };
                    wall((rays, from.as_ref()), (curve, sweep, named), &mut to, memory);
                }
            }
            Self::Cap { curves, sweep, top } => {
                rays.isa.run_in_lanes(
                    #[inline(always)]
                    || see(own, rays, start, memory),
                );
                if reach((rays, from.as_ref()), (sweep, *top), &to, memory, true) {
                    count(rays.isa, curves, memory);
                    conclude(rays, 0.0, &mut to, memory);
                }
            }
            Self::Whole { curves, sweep, .. } => {
                whole::meet(own, query, start, (curves, sweep), nearest, memory);
            }
        }
    }

    fn crossings(&self, seen: &KernelRays<'_>, to: &mut Crossings, scratch: &mut KernelScratch) {
        if let Self::Whole { curves, sweep, left } = self {
            let &KernelRays { own, rays, leaving, start, .. } = seen;
            let solid = (&**curves, sweep, left.as_deref());
            whole::crossings(own, (rays, leaving), start, solid, to, scratch.of());
        }
    }

    fn holds(
        &self,
        &KernelRays { own, rays, start, .. }: &KernelRays<'_>,
        at: (F8, F8),
        asked: u8,
        scratch: &mut KernelScratch,
    ) -> (u8, u8) {
        match self {
            Self::Whole { curves, sweep, .. } => {
                whole::holds(own, rays, start, (at, asked), (curves, sweep), scratch.of())
            }
            Self::Wall { .. } | Self::Cap { .. } => (0, 0),
        }
    }

    fn skin(&self, isa: Isa, own: &Own, &FacePoints { face, tag, h, h1 }: &FacePoints, to: &mut Skin) {
        isa.run_in_lanes(
            #[inline(always)]
            || *to = self.points(own, (face, tag), h, h1),
        );
    }

    fn slant(&self, isa: Isa, own: &Own, &FacePoints { face, tag, h, h1 }: &FacePoints, to: &mut Slant) {
        isa.run_in_lanes(
            #[inline(always)]
            || *to = Slant::of(&self.points(own, (face, tag), h, h1)),
        );
    }
}

impl Swept {
    /// The data at points `h` of this part, with `|h|₁`; `u` is the tag of a wall's point.
    #[inline(always)]
    fn points(&self, own: &Own, (face, u): (usize, F8), h: Vec3<F8>, h1: F8) -> Skin {
        let (y, e) = (own.point(h), own.point_error(h1));
        match self {
            Self::Whole { curves, sweep, left: sides } => match curves.get(face) {
                Some(curve) => {
                    let (u, left) = side_of(u);
                    let outward = left.select(F8::ONE, F8::splat(-1.0));
                    let skin = wall_skin(own, (curve, sweep), (u, outward), y, e);
                    if sides.is_some() {
                        return skin;
                    }
                    // Moves starts so far off the wall that the crossing they leave is certainly
                    // behind them: `cubic`'s bound along a ray, which includes 12 U for 64 terms of
                    // eight times the size, times the factors of Newton's method and of quotients.
                    let stretch = if sweep.conic { 1.0 + sweep.low.abs().max(sweep.high.abs()) } else { 1.0 };
                    Skin { e_f: skin.e_f + curve.reach * (32768.0 * U) * stretch, ..skin }
                }
                None => cap_skin(own, sweep, face > curves.len(), y, e),
            },
            Self::Cap { sweep, top, .. } => cap_skin(own, sweep, *top, y, e),
            Self::Wall { curve, sweep, left } => {
                let outward = F8::splat(if *left { 1.0 } else { -1.0 });
                wall_skin(own, (curve, sweep), (side_of(u).0, outward), y, e)
            }
        }
    }
}

/// The data at points of a cap.
#[inline(always)]
fn cap_skin(own: &Own, sweep: &Sweep8, top: bool, y: Vec3<F8>, e: F8) -> Skin {
    let (height, up) = if top { (sweep.high, 1.0) } else { (sweep.low, -1.0) };
    let half = own.covector(Vec3::new(F8::ZERO, F8::splat(0.5 * up), F8::ZERO));
    let e_f = (e + height.abs() * (4.0 * U)) * 2.0;
    Skin {
        f: (y.y - height) * up,
        half,
        e_f,
        e_half: F8::splat(own.norm * (4.0 * U)),
        bend: F8::ZERO,
        room: NEVER,
    }
}

/// The data at points of a wall, at `u` along the curve; `outward` is 1 if the inside is to the
/// left, else -1.
#[inline(always)]
fn wall_skin(
    own: &Own,
    (curve, sweep): (&ProfileCurve8, &Sweep8),
    (u, outward): (F8, F8),
    y: Vec3<F8>,
    e: F8,
) -> Skin {
    // A step along the curve to the foot of the point, which corrects the errors of `u` and of the
    // place on the ray.
    let ([cx, cz], [x1, z1]) = curve.at(u);
    let height = if sweep.conic { y.y } else { F8::ONE };
    let step = (y.x - cx * height).mul_add(x1, (y.z - cz * height) * z1);
    let u = (step / (x1.mul_add(x1, z1 * z1) * height) + u).max(F8::ZERO).min(F8::ONE);
    let ([cx, cz], [x1, z1]) = curve.at(u);
    // The normal to the right of the curve; for a conic sweep, the normal of the plane through the
    // origin and the tangent.
    let slow = x1.abs().max(z1.abs());
    let scale = outward / slow;
    let (x, z) = (z1 * scale, -(x1 * scale));
    let far = sweep.low.abs().max(sweep.high.abs());
    let (n, (px, pz), side) = if sweep.conic {
        // Above the origin the right side of the curve is the right side of the wall.
        let n = Vec3::new(x, -(x.mul_add(cx, z * cz)), z);
        (n, (cx * y.y, cz * y.y), F8::ONE.copysign(y.y))
    } else {
        (Vec3::new(x, F8::ZERO, z), (cx, cz), F8::ONE)
    };
    let (sizes, stretch) = if sweep.conic { (2.0 + 4.0 * curve.reach, 1.0 + far) } else { (2.0, 1.0) };
    let (along, across) = (y.x - px, y.z - pz);
    let f = along.mul_add(x, across * z) * side;
    let half = side * 0.5;
    let half = own.covector(Vec3::new(n.x * half, n.y * half, n.z * half));
    let (speed, turn) = curve.speed();
    // The curve leaves its tangent by at most |c''| / |c'|² times the square of the distance along
    // it.
    let bend = F8::splat(2.0 * turn) / (slow * slow);
    let bend = if sweep.conic { bend * (1.0 + curve.reach) / y.y.abs() } else { bend };
    let way = along.abs() + across.abs();
    let round = (curve.rounding() * 2.0 + curve.reach * (8.0 * U)) * stretch;
    let e_f = (e * sizes + round + bend * way * way) * 4.0;
    let lost = F8::splat(speed * (16.0 * U)) / slow + 16.0 * U;
    let e_half = lost * (own.norm * sizes);
    let bend = bend * (own.norm * own.norm * sizes * sizes);
    Skin { f, half, e_f, e_half, bend, room: NEVER }
}

/// Computes the rays in the sweep's own coordinates.
#[inline(always)]
fn see(own: &Own, rays: &RayLanes<'_>, start: &Start, memory: &mut PrismScratch) {
    let (o, d) = (own.point(start.h), own.vector(*rays.direction));
    (memory.o, memory.d) = ([o.x, o.y, o.z], [d.x, d.y, d.z]);
    (memory.e_o, memory.e_d) = (own.point_error(start.h1), own.vector_error(rays.d1));
    memory.far = start.far;
}
