//! Solids whose faces are quadrics or planes: `{ x : f_i(x) <= 0 for all i }`, a closed set.
//!
//! Along a ray each face is a quadratic `p_i(s)`, and the solid is where all of them are `<= 0`: a
//! union of closed intervals, whose ends are the crossings (S. D. Roth, "Ray casting for modeling
//! solids", *Computer Graphics and Image Processing* 18, 1982). A crossing is a root of one face at
//! which no other face is positive. f64 with a running error decides this where that suffices, and
//! exact arithmetic otherwise; so rims cannot leak:
//!
//! - a root at which another face is exactly zero (a rim) is reported by one of the two faces,
//!   once;
//! - the kind of the crossing (entering, leaving, touching) follows from the signs of the slopes of
//!   all faces that are zero there;
//! - a line that lies in a face is inside that face, so other faces end the interval.

use crate::faces::chart::{Chart, Frame, Tip};
use crate::faces::form::{Form, Rounded};
use crate::ray::PREVIEW_WIDTH;
use crate::{CentredRay, End, LocalPoint, RingRay, Root, RootKind, Side, Sink};
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use core::cmp::Ordering::{Equal, Greater, Less};
use core::ops::ControlFlow;
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Isa, RaySide, Ring, U, Vec3};
use durer_roots::quadratic::{
    Crossing, Limits, LineRoots, NARROW, Quadratic, SignedEnclosure, admit, compare_roots, exact_sign,
    locate, locate_exact, sign_at_root, slope_at_root, solve,
};

/// The most faces a shape can have.
pub const MAX_FACES: usize = 6;

/// A solid with quadric faces: the methods that its author writes. Everything else follows.
pub trait QuadricFaces: Send + Sync {
    /// See [`Accelerate::name`](crate::Accelerate::name).
    fn name(&self) -> &'static str {
        "quadric"
    }

    /// Centre, unit of length and reach.
    fn frame(&self) -> Frame;

    /// How many faces bound the shape, at most [`MAX_FACES`].
    fn faces(&self) -> usize;

    /// The number of faces that are part of the surface; these come first. If not all are, the
    /// shape is a sheet that the other faces clip.
    fn walls(&self) -> usize {
        self.faces()
    }

    /// The face's polynomial in the frame's coordinates `y`, negative inside; exact in an exact
    /// ring. It may have any positive factor.
    fn form<T: Ring>(&self, face: usize) -> Form<T>;

    /// A box that provably holds the shape.
    fn bounds(&self) -> Aabb;

    /// A box that provably holds the part of the shape inside a box, which may be unbounded on some
    /// sides.
    fn bounds_within(&self, _slab: &Aabb) -> Aabb {
        self.bounds()
    }

    /// A box that provably holds the shape after `map` has moved it.
    fn bounds_through(&self, map: &Affine) -> Aabb {
        map.bounds(&self.bounds())
    }

    /// Surface coordinates on a face, at `y` (close to the face), where the unit normal is `n`.
    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart;

    /// The tip of a face, if it has one.
    fn tip(&self, _face: usize) -> Option<Tip> {
        None
    }
}

/// [`QuadricFaces`] as a trait object, for kernels that run when f64 has left a doubt. They are
/// compiled once and not for each shape.
pub(crate) trait Faces: Send + Sync {
    /// The face's polynomial, exactly.
    fn exact(&self, face: usize) -> Form<Dyadic>;
    /// The face's polynomial in double-double.
    fn double(&self, face: usize) -> Form<EFloat<Dd>>;
    /// See [`QuadricFaces::chart`].
    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart;
    /// See [`QuadricFaces::tip`].
    fn tip(&self, face: usize) -> Option<Tip>;
}

impl<S: QuadricFaces> Faces for S {
    fn exact(&self, face: usize) -> Form<Dyadic> {
        self.form(face)
    }

    fn double(&self, face: usize) -> Form<EFloat<Dd>> {
        Isa::detect().run(
            #[inline(always)]
            || self.form(face),
        )
    }

    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart {
        QuadricFaces::chart(self, face, y, n)
    }

    fn tip(&self, face: usize) -> Option<Tip> {
        QuadricFaces::tip(self, face)
    }
}

/// A shape together with the data that is computed from it once.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) shape: &'a dyn Faces,
    pub(crate) forms: &'a [Rounded],
    pub(crate) frame: Frame,
    pub(crate) walls: usize,
}

/// A crossing that certainly lies on the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub(crate) face: usize,
    pub(crate) crossing: Crossing,
    pub(crate) kind: RootKind,
    pub(crate) sign: i8,
    pub(crate) s: f64,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// It certainly lies ahead of the ray's start, which is also the start of the range.
    pub(crate) ahead: bool,
}

/// All events of one ray.
pub(crate) type Events = ArrayVec<Event, { 2 * MAX_FACES }>;
type Lines = ArrayVec<Quadratic<EFloat>, MAX_FACES>;
pub(crate) type ExactLines = ArrayVec<Quadratic<Dyadic>, MAX_FACES>;

/// Rounds all faces of a shape.
pub(crate) fn rounded<S: QuadricFaces>(shape: &S) -> Box<[Rounded]> {
    (0..shape.faces())
        .map(|i| Rounded::new(&shape.form::<EFloat<Dd>>(i), || shape.form::<Dyadic>(i)))
        .collect()
}

/// The exact ray and `true`; if it is not exactly known, the ray with the rounded numbers, and
/// `false`.
fn exact_ray(ray: &CentredRay<'_>) -> (RingRay<Dyadic>, bool) {
    match ray.in_ring::<Dyadic>() {
        Some(exact) => (exact, true),
        None => {
            let exact = |v: Vec3| v.to_array().map(Dyadic::from);
            (RingRay { o: exact(ray.o), d: exact(ray.d), w: Dyadic::from(1.0) }, false)
        }
    }
}

impl View<'_> {
    /// All faces along the ray, exactly; and whether the ray is exactly known.
    fn exact_lines(&self, ray: &CentredRay<'_>) -> (ExactLines, bool) {
        let (exact, known) = exact_ray(ray);
        ((0..self.forms.len()).map(|i| self.shape.exact(i).along(&exact)).collect(), known)
    }

    /// The bounds of `s` outside which no root matters; `None` if the interval is empty.
    #[inline(always)]
    fn limits(&self, ray: &CentredRay<'_>, range: (f64, f64)) -> Option<Limits> {
        let local = ray.local();
        let (mut lo, mut hi) = ray.window((local.t_min.max(range.0), local.t_max.min(range.1)));
        if self.frame.reach < f64::INFINITY {
            // |s d| <= |o| + reach; the largest |d_i| is at least 1, up to its error.
            let derr = ray.d_err.x + ray.d_err.y + ray.d_err.z;
            let o = ray.o.abs() + ray.o_err;
            let far = (o.x + o.y + o.z + self.frame.reach) * (1.0 + 8.0 * U);
            if derr < 0.5 {
                let far = if derr == 0.0 { far } else { far / (1.0 - derr) * (1.0 + 4.0 * U) };
                (lo, hi) = (lo.max(-far), hi.min(far));
            }
        }
        (lo <= hi).then(|| Limits {
            lo,
            hi,
            origin: ray.shift(),
            width: if local.rough { PREVIEW_WIDTH } else { NARROW },
        })
    }

    /// The roots of one face within the limits.
    #[inline(always)]
    fn face_roots(
        &self,
        face: usize,
        line: &Quadratic<EFloat>,
        ray: &CentredRay<'_>,
        limits: &Limits,
    ) -> (LineRoots, bool) {
        let found = if self.forms[face].is_linear() {
            solve_linear(line, limits)
        } else {
            self.double(face, line, ray, limits)
        };
        match found {
            Some(roots) => (roots, true),
            None => self.climb(face, ray, limits),
        }
    }

    /// The roots, as far as f64 can decide.
    #[inline(always)]
    fn double(
        &self,
        face: usize,
        line: &Quadratic<EFloat>,
        ray: &CentredRay<'_>,
        limits: &Limits,
    ) -> Option<LineRoots> {
        let (a, b, c) = (line.a, line.b, line.c);
        // Where B² and AC cancel, the parameter is first moved to the vertex: there B vanishes and
        // nothing cancels.
        if a.v * c.v > 0.5 * b.v * b.v && a.v.abs() > 4.0 * a.e && b.v != 0.0 {
            let step = -b.v / a.v;
            let o = Vec3::new(
                step.mul_add(ray.d.x, ray.o.x),
                step.mul_add(ray.d.y, ray.o.y),
                step.mul_add(ray.d.z, ray.o.z),
            );
            let eo = (ray.o_err + ray.d_err * step.abs() + o.abs() * U) * (1.0 + 8.0 * U);
            let moved = self.forms[face].along(o, ray.d, eo, ray.d_err);
            let disc = moved.kahan_discriminant();
            return solve(moved.a.into(), moved.b.into(), moved.c.into(), disc.into(), step, limits);
        }
        solve(a.into(), b.into(), c.into(), line.kahan_discriminant().into(), 0.0, limits)
    }

    /// The roots in double-double and, if that leaves a doubt, exactly. The flag is false if the
    /// ray itself is not exactly known and that matters.
    #[cold]
    #[inline(never)]
    fn climb(&self, face: usize, ray: &CentredRay<'_>, limits: &Limits) -> (LineRoots, bool) {
        let none = LineRoots { roots: [None; 2], outside: false };
        let Some(in_dd) = ray.in_double() else { return (none, true) };
        // Coefficients are homogeneous: the positive factor w² cancels in roots and signs.
        let form = self.shape.double(face);
        let (known, found) = Isa::detect().run(
            #[inline(always)]
            || {
                let p = form.along(&in_dd);
                let disc = p.discriminant();
                let known = [SignedEnclosure::from(&p.a), (&p.b).into(), (&p.c).into(), (&disc).into()];
                let [a, b, c, d] = known;
                (known, solve(a, b, c, d, 0.0, limits))
            },
        );
        if let Some(roots) = found {
            return (roots, true);
        }
        let limits = Limits { width: f64::INFINITY, ..*limits };
        let (exact, certain) = exact_ray(ray);
        let p = self.shape.exact(face).along(&exact).at_unit_size();
        let disc = p.discriminant();
        let exact = [
            SignedEnclosure::of_any_size(&p.a),
            (&p.b).into(),
            SignedEnclosure::of_any_size(&p.c),
            (&disc).into(),
        ];
        let [a, b, c, d] = if certain {
            exact
        } else {
            // Signs come from the rounded ray, enclosures from all rays that it may represent.
            [0, 1, 2, 3].map(|i| SignedEnclosure { sign: exact[i].sign, ..known[i] })
        };
        (solve(a, b, c, d, 0.0, &limits).unwrap_or(none), certain)
    }

    /// All crossings of the line within the sink's and the ray's range (as far as f64 can decide),
    /// in order.
    #[inline(always)]
    pub(crate) fn events(&self, ray: &CentredRay<'_>, range: (f64, f64)) -> Events {
        let mut events = Events::new();
        let Some(limits) = self.limits(ray, range) else { return events };
        let [first, rest @ ..] = self.forms else { return events };
        let mut lines = Lines::new();
        lines.push(first.along(ray.o, ray.d, ray.o_err, ray.d_err));
        // Usually the first face shows that the line misses.
        let mut known = Some(self.face_roots(0, &lines[0], ray, &limits));
        if known.as_ref().is_some_and(|(found, _)| found.outside) {
            return events;
        }
        for form in rest {
            lines.push(form.along(ray.o, ray.d, ray.o_err, ray.d_err));
        }
        for face in 0..self.walls {
            let (found, certain) =
                known.take().unwrap_or_else(|| self.face_roots(face, &lines[face], ray, &limits));
            if found.outside {
                events.clear();
                return events;
            }
            let start = start(ray, face, &lines[face]);
            for root in found.roots.into_iter().flatten() {
                // For a spawned ray, side and slope at the start decide which roots are behind it:
                // no exact arithmetic is needed.
                let ahead = match start.and_then(|start| start.against(root.crossing)) {
                    Some(Greater) => continue,
                    known => known.is_some(),
                };
                let simple = (RootKind::Simple, sign_of(root.crossing));
                let simple = if simple.1 == 0 { (RootKind::Grazing, 0) } else { simple };
                let at = EFloat::with_error(root.s, (root.hi - root.s).max(root.s - root.lo));
                let membership = match within(&lines, face, at) {
                    Some(false) => None,
                    Some(true) => Some(simple),
                    None => self.examine(face, root.crossing, ray, simple),
                };
                if let Some((kind, sign)) = membership {
                    let kind = if certain { kind } else { RootKind::Cluster };
                    let (s, lo, hi) = (root.s, root.lo, root.hi);
                    events.push(Event { face, crossing: root.crossing, kind, sign, s, lo, hi, ahead });
                }
            }
        }
        if events.len() > 1 {
            self.sort(&mut events, ray);
        }
        events
    }

    /// Decides exactly whether a root of `face` belongs to the closed solid. If so, returns the
    /// kind and the sign of the crossing.
    #[cold]
    #[inline(never)]
    fn examine(
        &self,
        face: usize,
        crossing: Crossing,
        ray: &CentredRay<'_>,
        simple: (RootKind, i8),
    ) -> Option<(RootKind, i8)> {
        let (lines, certain) = self.exact_lines(ray);
        let mut inside = (
            matches!(crossing, Crossing::Out | Crossing::TouchInside),
            matches!(crossing, Crossing::In | Crossing::TouchInside),
        );
        let mut alone = true;
        for (j, q) in lines.iter().enumerate().filter(|&(j, _)| j != face) {
            match sign_at_root(&lines[face], crossing, q) {
                Greater => return None,
                Less => continue,
                Equal => {}
            }
            if j >= self.walls {
                continue;
            }
            let beside = match (slope_at_root(&lines[face], crossing, q), exact_sign(&q.a)) {
                (Greater, _) => (true, false),
                (Less, _) => (false, true),
                (Equal, Greater) => (false, false),
                (Equal, Less) => (true, true),
                // Zero all along: the line lies in that face.
                (Equal, Equal) => continue,
            };
            if j < face {
                return None; // a root of that face too, which reports it
            }
            alone = false;
            inside = (inside.0 && beside.0, inside.1 && beside.1);
        }
        if !certain {
            return Some((RootKind::Cluster, simple.1));
        }
        Some(match inside {
            _ if alone => simple,
            (true, false) => (RootKind::Simple, 1),
            (false, true) => (RootKind::Simple, -1),
            _ => (RootKind::Grazing, 0),
        })
    }

    /// Sorts by the exact order of the roots, and makes the brackets consistent with it.
    #[inline(always)]
    fn sort(&self, events: &mut Events, ray: &CentredRay<'_>) {
        events.sort_unstable_by(|x, y| x.s.total_cmp(&y.s));
        if events.windows(2).any(|w| w[1].lo <= w[0].hi) {
            self.sort_exactly(events, ray);
        }
    }

    #[cold]
    #[inline(never)]
    fn sort_exactly(&self, events: &mut Events, ray: &CentredRay<'_>) {
        let (lines, _) = self.exact_lines(ray);
        events.sort_by(|x, y| {
            if x.hi < y.lo {
                Less
            } else if y.hi < x.lo {
                Greater
            } else {
                compare_roots((&lines[x.face], x.crossing), (&lines[y.face], y.crossing))
            }
        });
        for i in 1..events.len() {
            let (before, after) = events.split_at_mut(i);
            let (x, y) = (&mut before[i - 1], &mut after[0]);
            // r_x <= r_y.
            (y.lo, x.hi) = (y.lo.max(x.lo), x.hi.min(y.hi));
            x.s = x.s.max(x.lo).min(x.hi);
            y.s = y.s.max(y.lo).min(y.hi).max(x.s);
        }
    }

    /// Pushes events that are in the ray's closed range.
    #[inline(always)]
    pub(crate) fn push<K: Sink + ?Sized>(
        &self,
        events: &Events,
        ray: &CentredRay<'_>,
        sink: &mut K,
    ) -> ControlFlow<()> {
        let mut least = f64::NEG_INFINITY;
        for event in events {
            let (lo, hi) = ray.bracket(event.lo, event.hi);
            let lo = if event.ahead { lo.max(ray.end(End::Min)) } else { lo };
            let hi = hi.max(lo);
            let admitted = match ray.admits(lo, hi) {
                Some(admitted) => admitted,
                None => self.in_range(event, ray),
            };
            if !admitted {
                continue;
            }
            let (least_t, most_t) = sink.range();
            if hi < least_t || lo > most_t {
                continue;
            }
            let t = ray.t(event.s).max(lo).min(hi).max(least);
            least = t;
            let root = Root {
                t,
                lo,
                hi,
                s: event.s,
                // At a rim that is only touched: how the face itself is crossed, for clips.
                tag: [if event.sign == 0 { f64::from(sign_of(event.crossing)) } else { 0.0 }, 0.0],
                face: event.face as u32,
                sign: event.sign,
                kind: event.kind,
            };
            sink.push(root)?;
        }
        ControlFlow::Continue(())
    }

    /// Whether a crossing whose bracket straddles an end of the range is in the range.
    #[cold]
    #[inline(never)]
    fn in_range(&self, event: &Event, ray: &CentredRay<'_>) -> bool {
        let (lo, hi) = ray.bracket(event.lo, event.hi);
        let low = event.ahead
            || !ray.end(End::Min).is_finite()
            || lo >= ray.end(End::Min)
            || self.end_against_root(End::Min, event, ray) != Greater;
        let high = !ray.end(End::Max).is_finite()
            || hi <= ray.end(End::Max)
            || self.end_against_root(End::Max, event, ray) != Less;
        low && high
    }

    /// The order of an end of the range and a crossing.
    #[inline(always)]
    fn end_against_root(&self, end: End, event: &Event, ray: &CentredRay<'_>) -> Ordering {
        // The polynomial at the end's own point, which does not have the rounding of the closest
        // approach. Rays that were spawned on this surface start where its sign is certain.
        let (p, ep) = ray.point_at_end(end);
        let at = self.forms[event.face].along(p, ray.d, ep, ray.d_err);
        let value = match (ray.source(), end) {
            (Some(side), End::Min) if self.forms.len() == 1 && ray.end(end) == 0.0 => {
                Some(if side == RaySide::Front { Greater } else { Less })
            }
            _ => at.c.sign(),
        };
        if let Some(order) = value.and_then(|v| locate(event.crossing, at.a.sign(), Some(v), at.b.sign())) {
            return order;
        }
        let (exact, _) = exact_ray(ray);
        let p = self.shape.exact(event.face).along(&exact);
        locate_exact(&p, event.crossing, &ray.end_in_ring::<Dyadic>(end))
    }

    /// On which side of the closed solid a point lies.
    #[inline(always)]
    pub(crate) fn side(&self, point: &LocalPoint<'_>) -> Side {
        let mut side = Side::In;
        let mut exact = None;
        let (p, ep) = point.relative_to(self.frame.centre, self.frame.scale);
        for (i, form) in self.forms.iter().enumerate() {
            let sign = form.at(p, ep).0.sign().or_else(|| {
                let (q, w) = exact.get_or_insert_with(|| point.in_ring::<Dyadic>()).as_ref()?;
                let c = self.frame.centre.to_array().map(Dyadic::from);
                let relative = [0, 1, 2].map(|k| (&q[k] - &(&c[k] * w)).scale2(-self.frame.scale));
                self.shape.exact(i).at(&relative, w).sign()
            });
            match sign {
                Some(Greater) => return Side::Out,
                Some(Less) => {}
                Some(Equal) | None => side = Side::On,
            }
        }
        side
    }
}

/// The start of a ray that was spawned on a face: the signs of `A`, of the polynomial and of its
/// slope there.
#[derive(Clone, Copy)]
struct Start {
    a: Option<Ordering>,
    value: Ordering,
    slope: Option<Ordering>,
}

impl Start {
    /// The order of the start and a root of the face; `None` if it is unknown.
    #[inline(always)]
    fn against(self, crossing: Crossing) -> Option<Ordering> {
        locate(crossing, self.a, Some(self.value), self.slope)
    }
}

#[inline(always)]
fn start(ray: &CentredRay<'_>, face: usize, line: &Quadratic<EFloat>) -> Option<Start> {
    let (side, source_face, s) = ray.spawned()?;
    if source_face as usize != face {
        return None;
    }
    let value = if side == RaySide::Front { Greater } else { Less };
    Some(Start { a: line.a.sign(), value, slope: (line.a * s + line.b).sign() })
}

/// The root of a half-space's face, as far as f64 can decide.
#[inline(always)]
fn solve_linear(line: &Quadratic<EFloat>, limits: &Limits) -> Option<LineRoots> {
    let crossing = match line.b.sign()? {
        Equal => return Some(LineRoots { roots: [None; 2], outside: line.c.sign()? == Greater }),
        Greater => Crossing::Out,
        Less => Crossing::In,
    };
    let root = admit(-line.c / EFloat::with_error(2.0 * line.b.v, 2.0 * line.b.e), 0.0, crossing, limits)?;
    Some(LineRoots { roots: [root, None], outside: false })
}

/// Whether the line is inside all faces but one, over an enclosure of `s`; `None` if that is
/// uncertain.
#[inline(always)]
fn within(lines: &Lines, face: usize, at: EFloat) -> Option<bool> {
    let mut all = Some(true);
    for (j, line) in lines.iter().enumerate() {
        if j != face {
            match line.at(at).sign() {
                Some(Greater) => return Some(false),
                Some(Less) => {}
                Some(Equal) | None => all = None,
            }
        }
    }
    all
}

#[inline(always)]
fn sign_of(crossing: Crossing) -> i8 {
    match crossing {
        Crossing::In => -1,
        Crossing::Out => 1,
        Crossing::TouchInside | Crossing::TouchOutside => 0,
    }
}
