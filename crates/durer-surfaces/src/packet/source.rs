//! From a surface's own numbers to a packet filter.

use super::implicit::Segments;
use super::kernel::{DetailSketch, PacketKernel};
use super::loops::{Edge, Loops, Off};
use super::{PacketFilter, QuadricFace8};
use crate::FillRule;
use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::extent::QuadricExtent;
use crate::faces::form::Form;
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Isa, Point3, Ring, U, Vec3};
use std::sync::Arc;

/// Precise enough for several maps, one after the other, before the only rounding to f64.
type N = EFloat<Dd>;

/// The polynomials of a surface's faces before rounding.
#[derive(Clone, Debug)]
pub struct FilterSource {
    /// The origin of the coordinates.
    centre: Point3,
    /// Negative inside. The first `walls` forms are part of the surface.
    forms: Vec<Form<N>>,
    walls: usize,
    /// See [`PacketFilter`].
    reach: f64,
    convex: bool,
    turned: bool,
    /// If the forms only bound the surface: a box that bounds it, too.
    vague: Option<Aabb>,
    own_face: Option<u32>,
    normals: Option<[Vec3; 4]>,
    loops: Option<Loops<Form<N>>>,
    /// See [`PacketFilter`].
    holes: Vec<Vec<Form<N>>>,
    /// See [`PacketFilter`].
    detail: Option<DetailSketch>,
    /// Walls and faces that are parallel planes.
    parallel: Vec<Parallel>,
}

/// A wall and a clipping face that are parallel planes some distance apart.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Parallel {
    wall: usize,
    face: usize,
    /// Whether the face cuts off the whole wall, or nothing of it.
    cuts: bool,
}

impl Parallel {
    /// The relation of two faces, where it is certain.
    ///
    /// With `b' = λ b`, `f' = 2 b'·x + c'` equals `c' - λ c` where `2 b·x + c = 0`, which has the
    /// sign of `(c' b_k - c b'_k) b_k` for every `k`.
    fn of(wall: (usize, &Form<N>), face: (usize, &Form<N>)) -> Option<Self> {
        let is_flat = |f: &Form<N>| f.q.iter().all(|x| x.magnitude() == 0.0);
        let (a, b) = (wall.1, face.1);
        let is_parallel = cross(&a.b, &b.b).iter().all(|x| x.magnitude() == 0.0);
        if !(is_flat(a) && is_flat(b) && is_parallel) {
            return None;
        }
        let k = (0..3).find(|&k| a.b[k].lo() > 0.0 || a.b[k].hi() < 0.0)?;
        let side = (b.c * a.b[k] - a.c * b.b[k]) * a.b[k];
        let cuts = side.lo() > 0.0;
        (cuts || side.hi() < 0.0).then_some(Self { wall: wall.0, face: face.0, cuts })
    }
}

/// The range of the numbers of a filter: all their products stay within the range of f64.
pub(super) const LARGEST: f64 = durer_math::scale::pow2(150);

/// Whether the set where a form is not positive is convex whatever its linear part: all principal
/// minors of `Q` are at least zero.
fn is_convex(form: &Form<Dyadic>) -> bool {
    let [xx, yy, zz, xy, xz, yz] = &form.q;
    let minor = |a: &Dyadic, b: &Dyadic, ab: &Dyadic| &(a * b) - &(ab * ab);
    let determinant = &(&(xx * &minor(yy, zz, yz)) + &(&(xy * yz) * xz).scale2(1))
        - &(&(yy * &(xz * xz)) + &(zz * &(xy * xy)));
    [xx, yy, zz].iter().all(|x| !x.exact_sign().is_lt())
        && ![minor(xx, yy, xy), minor(xx, zz, xz), minor(yy, zz, yz), determinant]
            .iter()
            .any(|m| m.exact_sign().is_lt())
}

fn zero() -> N {
    N::exact(0.0)
}

#[inline(always)]
fn exact(v: Vec3) -> [N; 3] {
    v.to_array().map(N::exact)
}

#[inline(always)]
fn minus(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: &[N; 3], b: &[N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl FilterSource {
    /// A sheet or solid with these faces about `centre`, all within `reach` of it.
    fn new(centre: Point3, forms: Vec<Form<N>>, walls: usize, reach: f64) -> Self {
        Self {
            centre,
            forms,
            walls,
            reach,
            convex: false,
            turned: false,
            vague: None,
            own_face: None,
            normals: None,
            loops: None,
            holes: Vec::new(),
            detail: None,
            parallel: Vec::new(),
        }
    }

    /// A solid with quadric faces.
    pub(crate) fn of_shape<S: QuadricFaces>(shape: &S) -> Self {
        let frame = shape.frame();
        // `y = (x - centre) / 2^k`; `f 2^k` has the world's units and the same sign.
        let k = frame.scale;
        let forms = (0..shape.faces()).map(|i| {
            let f: Form<N> = shape.form(i);
            Form { q: f.q.map(|x| x.scale2(-k)), b: f.b, c: f.c.scale2(k) }
        });
        let reach = durer_math::scale::ldexp(frame.reach, k);
        let convex = shape.walls() == shape.faces() && (0..shape.faces()).all(|i| is_convex(&shape.form(i)));
        Self { convex, ..Self::new(frame.centre, forms.collect(), shape.walls(), reach) }
    }

    /// The half-space `normal·(x - p) <= offset`, with its boundary.
    pub(crate) fn half_space(p: Point3, normal: Vec3, offset: N) -> Self {
        let form = Form::half_space(exact(normal), -offset);
        Self { convex: true, ..Self::new(p, vec![form], 1, f64::INFINITY) }
    }

    /// The solid box.
    pub(crate) fn axis_box(min: Point3, max: Point3) -> Self {
        let centre = Aabb::new(min, max).centre();
        let mut forms = Vec::with_capacity(6);
        for axis in 0..3 {
            for (sign, corner) in [(-1.0, min), (1.0, max)] {
                let mut n = [zero(), zero(), zero()];
                n[axis] = N::exact(sign);
                let width = (N::exact(corner[axis]) - N::exact(centre[axis])) * N::exact(sign);
                forms.push(Form::half_space(n, -width));
            }
        }
        let reach = (max - centre).length().max((min - centre).length()) * (1.0 + 16.0 * U);
        Self { convex: true, ..Self::new(centre, forms, 6, reach) }
    }

    /// The flat round sheet about `centre` between two radii.
    pub(crate) fn ring(centre: Point3, normal: Vec3, hole: f64, radius: f64) -> Self {
        let ball = |r: f64| {
            let one = || N::exact(1.0);
            Form::diagonal([one(), one(), one()], -N::exact(r).square())
        };
        let mut forms = vec![Form::half_space(exact(normal), zero()), ball(radius)];
        if hole > 0.0 {
            forms.push(ball(hole).negated());
        }
        Self::new(centre, forms, 1, radius * (1.0 + 2.0 * U))
    }

    /// A flat convex sheet whose coplanar vertices go round the normal `(v1 - v0) x (v2 - v0)`.
    pub(crate) fn flat<const K: usize>(vertices: [Point3; K]) -> Self {
        let centre = Aabb::from_points(vertices).centre();
        Isa::detect().run(
            #[inline(always)]
            || {
                let seen = vertices.map(|v| minus(&exact(v.to_vec()), &exact(centre.to_vec())));
                let edges: [_; K] = core::array::from_fn(|i| (seen[i], minus(&seen[(i + 1) % K], &seen[i])));
                let n = cross(&edges[0].1, &minus(&seen[2], &seen[0]));
                Self::sheet(centre, &n, &edges)
            },
        )
    }

    /// The flat sheet `corner + a u + b v` with `a` and `b` in `[0, 1]`.
    pub(crate) fn parallelogram(corner: Point3, u: Vec3, v: Vec3) -> Self {
        let centre = corner + (u + v) * 0.5;
        let (u, v) = (exact(u), exact(v));
        let near = minus(&exact(corner.to_vec()), &exact(centre.to_vec()));
        let back = |w: &[N; 3]| w.map(|x| -x);
        let far = minus(&near, &minus(&back(&u), &v));
        Self::sheet(centre, &cross(&u, &v), &[(near, u), (far, back(&u)), (near, back(&v)), (far, v)])
    }

    /// The part of the plane through three points that some closed outlines go around. The outlines
    /// lie in the plane, or so near it that the polygon's box exceeds theirs by `margin`.
    pub(crate) fn polygon<'a>(
        spanning: [Point3; 3],
        bounds: Aabb,
        outlines: impl Iterator<Item = &'a [Point3]>,
        rule: FillRule,
        margin: Option<f64>,
    ) -> Self {
        let centre = bounds.centre();
        let seen = |v: Point3| minus(&exact(v.to_vec()), &exact(centre.to_vec()));
        let [a, b, c] = spanning.map(seen);
        let up = minus(&b, &a);
        let n = cross(&up, &minus(&c, &a));
        let through = |n: &[N; 3], p: &[N; 3]| Form::half_space(*n, -dot(n, p));
        let mut loops = Loops { edges: Vec::new(), ends: Vec::new(), rule, off: None };
        let mut height = 0.0_f64;
        for outline in outlines {
            for (i, &vertex) in outline.iter().enumerate() {
                let (from, to) = (seen(vertex), seen(outline[(i + 1) % outline.len()]));
                let side = through(&cross(&minus(&to, &from), &n), &from);
                loops.edges.push(Edge { level: through(&up, &from), side });
                height = height.max(dot(&n, &minus(&from, &a)).magnitude());
            }
            loops.ends.push(loops.edges.len());
        }
        let reach = bounds.reach_from(centre);
        loops.off = margin.map(|margin| {
            let length = dot(&n, &n).sqrt();
            let distance = height / (length.hi() * (1.0 - 16.0 * U));
            Off { distance, room: (margin - distance) * (1.0 - 4.0 * U) }
        });
        Self { loops: Some(loops), ..Self::new(centre, vec![through(&n, &a)], 1, reach) }
    }

    /// The part of the plane across `n` to the left of some edges. Each edge is a point, relative
    /// to the centre, and a direction.
    #[inline(always)]
    fn sheet(centre: Point3, n: &[N; 3], edges: &[([N; 3], [N; 3])]) -> Self {
        let through = |n: &[N; 3], p: &[N; 3]| Form::half_space(*n, -dot(n, p));
        let mut forms = vec![through(n, &edges[0].0)];
        let mut reach = 0.0_f64;
        for (point, direction) in edges {
            forms.push(through(&cross(direction, n), point));
            // Each corner is the start or the end of an edge.
            let end = minus(point, &direction.map(|x| -x));
            reach = reach.max(dot(point, point).sqrt().hi()).max(dot(&end, &end).sqrt().hi());
        }
        Self::new(centre, forms, 1, reach)
    }

    /// A surface of which only a bounding box is known.
    pub fn vague(bounds: Aabb) -> Self {
        Self { vague: Some(bounds), ..Self::axis_box(bounds.min, bounds.max) }
    }

    /// A surface within a box, with a kernel in units of `2^scale` about `origin`, whose axes are
    /// the world's in this order.
    pub(crate) fn kernel(
        bounds: Aabb,
        kernel: impl PacketKernel + 'static,
        origin: Point3,
        scale: i32,
        order: [usize; 3],
    ) -> Self {
        let vague = Self::vague(bounds);
        let detail = DetailSketch::new(Arc::new(kernel), vague.centre, origin, scale, order);
        Self { detail: Some(detail), ..vague }
    }

    /// The part of a solid in a convex container, whose faces are numbered after its own, about
    /// `origin`.
    pub(crate) fn contained(container: Self, kernel: Segments, origin: Point3) -> Self {
        let detail = DetailSketch::new(Arc::new(kernel), container.centre, origin, 0, [0, 1, 2]);
        Self { vague: Some(container.bounds()), detail: Some(detail), ..container }
    }

    /// An unbounded surface with a kernel in units of `2^scale`.
    pub(crate) fn unbounded(kernel: impl PacketKernel + 'static, scale: i32) -> Self {
        let o = Point3::ORIGIN;
        let detail = Some(DetailSketch::new(Arc::new(kernel), o, o, scale, [0, 1, 2]));
        let endless = Self::new(o, Vec::new(), 0, f64::INFINITY);
        Self { convex: true, vague: Some(Aabb::UNBOUNDED), detail, ..endless }
    }

    /// Adds shading normals that vary linearly over the triangle.
    pub(crate) fn with_normals(mut self, vertices: [Point3; 3], normals: [Vec3; 3]) -> Self {
        let [v0, v1, v2] = vertices;
        let (u, v) = (v1 - v0, v2 - v0);
        let n = u.cross(v);
        let square = n.length_squared();
        // Gradients of the barycentric coordinates.
        let (g1, g2) = (v.cross(n) * (1.0 / square), n.cross(u) * (1.0 / square));
        let (n1, n2) = (normals[1] - normals[0], normals[2] - normals[0]);
        let from = self.centre - v0;
        let change = |i: usize| n1 * g1[i] + n2 * g2[i];
        let at_centre = normals[0] + n1 * g1.dot(from) + n2 * g2.dot(from);
        self.normals = Some([at_centre, change(0), change(1), change(2)]);
        self
    }

    /// The surface moved by a map.
    #[must_use]
    pub fn placed(self, map: &Affine) -> Self {
        let m = map.centre();
        let centre = m + map.vector(self.centre.to_vec());
        // With `h = x - centre` and `L⁻¹ = adj / det`: `det y = adj h + δ`, `δ = adj (centre - m) -
        // det c`.
        let (adj, det) = map.adjugate::<N>();
        let row = |i: usize, v: &[N; 3]| adj[i][0] * v[0] + adj[i][1] * v[1] + adj[i][2] * v[2];
        let from = [0, 1, 2].map(|i| N::exact(centre[i]) - N::exact(m[i]));
        let shift = [0, 1, 2].map(|i| row(i, &from) - det * N::exact(self.centre[i]));
        let transposed =
            |v: &[N; 3]| [0, 1, 2].map(|j| adj[0][j] * v[0] + adj[1][j] * v[1] + adj[2][j] * v[2]);
        let isa = Isa::detect();
        let moved = |f: Form<N>| {
            isa.run(
                #[inline(always)]
                || {
                    // `det² f(y) = z·Qz + 2 det b·z + det² c` at `z = adj h + δ`.
                    let b = f.b.map(|x| x * det);
                    let c = f.c * det.square();
                    if f.q.iter().all(|x| x.magnitude() == 0.0) {
                        // A plane needs one factor `det` less.
                        let (b, c) = (f.b, f.c * det + dot(&f.b, &shift).scale2(1));
                        return Form { q: f.q, b: transposed(&b), c };
                    }
                    let scaled = Form { q: f.q, b, c }.seen_from(&shift);
                    let [xx, yy, zz, xy, xz, yz] = scaled.q;
                    let q = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                    // `adjᵀ Q adj`, column by column.
                    let columns = [0, 1, 2].map(|j| {
                        let a = [adj[0][j], adj[1][j], adj[2][j]];
                        let qa = q.map(|r| r[0] * a[0] + r[1] * a[1] + r[2] * a[2]);
                        transposed(&qa)
                    });
                    Form {
                        q: [
                            columns[0][0],
                            columns[1][1],
                            columns[2][2],
                            columns[1][0],
                            columns[2][0],
                            columns[2][1],
                        ],
                        b: transposed(&scaled.b),
                        c: scaled.c,
                    }
                },
            )
        };
        let normals = self.normals.map(|[n, x, y, z]| {
            // `n(x) = L⁻ᵀ n(y)`, and `y` changes with `L⁻¹ h`.
            let covector = |v: Vec3| {
                let m = map.inverse_linear();
                Vec3::from([0, 1, 2].map(|j| m[0][j] * v.x + m[1][j] * v.y + m[2][j] * v.z))
            };
            let [x, y, z] = [x, y, z].map(covector);
            let m = map.inverse_linear();
            let change = |j: usize| x * m[0][j] + y * m[1][j] + z * m[2][j];
            [covector(n), change(0), change(1), change(2)]
        });
        // The rounded centre differs from the mapped one by three roundings of the products' sums
        // and one of the last sum.
        let slip = map.linear_reach(self.centre.to_vec().abs()).length() * 4.0 + centre.to_vec().length();
        let reach = (self.reach * map.linear_norm() + slip * (2.0 * U)) * (1.0 + 16.0 * U);
        let forms = self.forms.into_iter().map(moved).collect();
        let holes = self.holes.into_iter().map(|hole| hole.into_iter().map(moved).collect()).collect();
        let loops = self.loops.map(|l| {
            let off = l.off.map(|off| Off {
                distance: off.distance * map.linear_norm() * (1.0 + 4.0 * U),
                room: off.room / map.inverse_norm() * (1.0 - 4.0 * U),
            });
            Loops { off, ..l.map(moved) }
        });
        let vague = self.vague.map(|bounds| map.bounds(&bounds));
        let detail = self.detail.map(|detail| detail.moved(det, moved));
        Self { centre, forms, reach, normals, loops, holes, vague, detail, ..self }
    }

    /// The surface with its normals, and inside and outside, exchanged.
    #[must_use]
    pub fn turned(self) -> Self {
        // The inside is now the complement; the surface stays the same.
        Self { turned: !self.turned, ..self }
    }

    /// The filter of one part of a surface; all roots of the part are on this face.
    #[must_use]
    pub(crate) fn on_face(self, face: u32) -> Self {
        Self { own_face: Some(face), ..self }
    }

    /// The part of the surface inside the region where all faces of `region` are negative.
    #[must_use]
    pub(crate) fn within(mut self, region: Self) -> Self {
        if self.detail.as_ref().is_some_and(DetailSketch::is_unbounded) {
            return if region.convex { self.within_convex(region) } else { Self::vague(Aabb::UNBOUNDED) };
        }
        if self.vague.is_some() {
            // Where in its box the surface lies is unknown: only the part of the box in both is
            // known.
            self.detail = None;
            return if region.convex { self.within_convex(region) } else { self };
        }
        let before = self.forms.len();
        self.forms.extend(region.faces_from(self.centre));
        let (forms, parallel) = (&self.forms, &mut self.parallel);
        for wall in 0..self.walls {
            let of = |face| Parallel::of((wall, &forms[wall]), (face, &forms[face]));
            parallel.extend((before..forms.len()).filter_map(of));
        }
        self.convex = false;
        self.detail = None;
        self
    }

    /// The part of an unbounded surface, whose only faces are those that clip it, inside a convex
    /// set.
    fn within_convex(mut self, region: Self) -> Self {
        let away = (region.centre - self.centre).length() + region.reach;
        self.reach = self.reach.min(away * (1.0 + 16.0 * U));
        self.forms.extend(region.faces_from(self.centre));
        self.walls = self.forms.len();
        self
    }

    /// The part of the surface outside the region where all faces of `region` are negative.
    #[must_use]
    pub(crate) fn without(mut self, region: Self) -> Self {
        if self.detail.as_ref().is_some_and(DetailSketch::is_unbounded) {
            return Self::vague(Aabb::UNBOUNDED);
        }
        if self.vague.is_some() {
            self.detail = None;
            return self;
        }
        let seen = region.faces_from(self.centre);
        self.holes.push(seen.collect());
        self.convex = false;
        self.detail = None;
        self
    }

    /// The faces with coordinates relative to another point.
    fn faces_from(self, centre: Point3) -> impl Iterator<Item = Form<N>> {
        let shift = [0, 1, 2].map(|i| N::exact(centre[i]) - N::exact(self.centre[i]));
        self.forms.into_iter().map(move |f| f.seen_from(&shift))
    }

    /// A box that holds the surface; unbounded if only its faces bound it.
    pub fn bounds(&self) -> Aabb {
        if let Some(bounds) = self.vague {
            bounds
        } else if self.reach < f64::INFINITY {
            Aabb::centred(self.centre, Vec3::new(self.reach, self.reach, self.reach))
        } else {
            Aabb::UNBOUNDED
        }
    }

    /// The faces that may cut off part of a wall; `None` if one of them cuts off all of it.
    fn cutters(&self, wall: usize) -> Option<Box<[u32]>> {
        let known = |face: usize| self.parallel.iter().find(|p| (p.wall, p.face) == (wall, face));
        if self.parallel.iter().any(|p| p.wall == wall && p.cuts) {
            return None;
        }
        let others = (0..self.forms.len()).filter(|&face| face != wall && known(face).is_none());
        Some(others.map(|face| face as u32).collect())
    }

    /// The extent of the solid if it is a whole quadric.
    pub fn quadric_extent(&self) -> Option<QuadricExtent> {
        let [form] = &self.forms[..] else { return None };
        let is_whole = self.vague.is_none() && self.loops.is_none() && self.holes.is_empty();
        let is_solid = self.detail.is_none() && !self.turned;
        (is_whole && is_solid).then(|| QuadricExtent::new(self.centre, form))
    }

    /// The packet filter; `None` if its numbers are too large or too small for f64 packets.
    pub fn build(&self) -> Option<PacketFilter> {
        let ordinary = self.centre.is_finite()
            && self.centre.to_vec().max_abs() < LARGEST
            && (self.reach == f64::INFINITY || self.reach < LARGEST && self.reach > 1.0 / LARGEST);
        let detail = self.detail.as_ref().and_then(DetailSketch::round);
        let told = !self.forms.is_empty() || detail.is_some();
        if !ordinary || !told {
            return None;
        }
        let round = |forms: &Vec<Form<N>>| forms.iter().map(QuadricFace8::new).collect::<Option<Box<[_]>>>();
        let faces = round(&self.forms)?;
        let holes = self.holes.iter().map(round).collect::<Option<_>>()?;
        let slabs = (0..faces.len()).map(|i| faces.get(i + 1).is_some_and(|next| faces[i].is_opposite(next)));
        let slabs = slabs.collect();
        let known = if self.parallel.is_empty() { 0 } else { self.walls };
        let cutters = (0..known).map(|wall| self.cutters(wall)).collect();
        let Self { centre, walls, reach, convex, turned, vague, own_face, .. } = *self;
        let normals = self.normals.map(Box::new);
        let loops = match &self.loops {
            Some(loops) => Some(Box::new(loops.try_map(QuadricFace8::new)?)),
            None => None,
        };
        Some(PacketFilter {
            centre,
            faces,
            walls,
            reach,
            convex,
            slabs,
            cutters,
            turned,
            vague: vague.is_some(),
            own_face,
            normals,
            loops,
            holes,
            detail: detail.map(Box::new),
        })
    }
}
