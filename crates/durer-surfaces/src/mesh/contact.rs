//! Rays that meet edges and vertices of a mesh exactly.
//!
//! The common points of a line and a mesh are single points and stretches, where the line runs
//! within faces or along edges. **One rule:** the line *touches* the mesh in such a piece if
//! parallel lines as near as you like miss the mesh there. A touch is one grazing root, at the
//! first point of the piece. Everywhere else the symbolic displacement of `edges.rs` decides which
//! faces are crossed, as for a line that has been moved a little.
//!
//! Seen along the line, a piece is one point. Each face that meets it and is not seen edge-on
//! covers an angle there: at a vertex its own wedge, at an edge the half-plane on its side. So the
//! line touches the mesh if and only if these angles leave a gap. That holds without regard to
//! orientation, for closed meshes, for open ones, whose borders are touched, and for edges with any
//! number of faces.
//!
//! Where a mesh ends, faces may go on that have other vertices on the same edge: the borders that
//! meet the line in the same point belong to the piece, too.
//!
//! All signs are exact. Angles are compared by `d . (x x y)` of vectors between vertices, places
//! along the line by the crossings with planes through them.

use super::Mesh;
use super::fans::Fans;
use crate::RingRay;
use crate::edges::{EdgeFilter, EdgeForm, MinorForm};
use crate::planar::{
    self, AlongRay, Crossing, Line, PlaneForm, Probe, Ratios, cross, dot, seen_from, towards,
};
use core::cmp::Ordering;
use durer_math::{Isa, Point3, Ring, Vec3};

/// A place where faces meet: a vertex, or an edge (without its ends), by first vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Site {
    Vertex(u32),
    Edge(u32, u32),
}

impl Site {
    fn edge(a: u32, b: u32) -> Self {
        Self::Edge(a.min(b), a.max(b))
    }
}

/// The report of a face about a line that meets one of its edges or vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Report {
    /// Nothing: another face does, or none.
    Nothing,
    /// The crossing of the displaced line, if that meets the face.
    Crossing,
    /// The touch, which is at this place.
    Touch(Site),
}

/// The vector from one vertex to another.
type Way = (u32, u32);

/// A face at a site.
struct Member {
    face: u32,
    corners: [u32; 3],
    /// The ways that bound the angle it covers at the site, in the order of their angles; none if
    /// the face is seen edge-on.
    angle: Option<[Way; 3]>,
}

/// `d . ((b - a) x (q - p))`.
struct TurnForm {
    ways: [(Point3, Point3); 2],
    scale: i32,
}

impl AlongRay for TurnForm {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let [(a, b), (p, q)] = self.ways;
        Some(dot(&ray.d, &cross(&seen_from(b, a, self.scale), &seen_from(q, p, self.scale))))
    }
}

/// `((v - o) x d)_axis`.
#[derive(Clone, Copy)]
struct OffsetForm {
    v: Point3,
    axis: usize,
    centre: Point3,
    scale: i32,
}

impl AlongRay for OffsetForm {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (j, k) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let to = towards(ray, self.v, self.centre, self.scale);
        Some(to[j].clone() * ray.d[k].clone() - to[k].clone() * ray.d[j].clone())
    }
}

/// How far along an edge the line meets it: the offset of its first end over the difference.
struct ShareForm([OffsetForm; 2]);

impl Ratios for ShareForm {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let zero = || T::exact(0.0);
        let [a, b] = self.0;
        let (a, b) = (a.eval(ray).unwrap_or_else(zero), b.eval(ray).unwrap_or_else(zero));
        [a.clone(), zero(), a - b]
    }
}

/// A plane through a site that the line crosses: across an axis at a vertex; else through the edge,
/// along an axis.
struct SitePlane {
    base: Point3,
    along: Option<Point3>,
    axis: usize,
    centre: Point3,
    scale: i32,
}

impl PlaneForm for SitePlane {
    #[inline(always)]
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        match self.along {
            None => ray.d[self.axis].clone(),
            Some(b) => {
                let [x, y, z] = cross(&ray.d, &seen_from(b, self.base, self.scale));
                [x, y, z][self.axis].clone()
            }
        }
    }

    #[inline(always)]
    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let to = towards(ray, self.base, self.centre, self.scale);
        Some(match self.along {
            None => -to[self.axis].clone(),
            Some(b) => cross(&seen_from(b, self.base, self.scale), &to)[self.axis].clone(),
        })
    }
}

/// `s_a - s_b` times the two slopes.
struct LaterForm<'a>(&'a SitePlane, &'a SitePlane);

impl AlongRay for LaterForm<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let Self(a, b) = self;
        Some(b.height(ray)? * a.slope(ray) - a.height(ray)? * b.slope(ray))
    }
}

/// A line and a mesh that have points of edges or vertices in common. Every method returns `None`
/// where the line is not exactly known and its error leaves the answer open.
pub(super) struct Contact<'a, 'r> {
    pub(super) mesh: &'a Mesh,
    pub(super) fans: &'a Fans,
    pub(super) probe: &'a Probe<'r>,
}

impl Contact<'_, '_> {
    /// The report of a face whose edges the line passes on these sides, zero on an edge; `crosses`
    /// is whether the displaced line meets the face.
    pub(super) fn report(&self, face: u32, sides: [i8; 3], crosses: bool) -> Option<Report> {
        let [a, b, c] = self.fans.corners(&self.mesh.data, face);
        let own = match sides {
            [0, 0, 0] => self.first_of(&self.sites_edge_on([a, b, c])?)?,
            [0, 0, _] => Some(Site::Vertex(c)),
            [0, _, 0] => Some(Site::Vertex(b)),
            [_, 0, 0] => Some(Site::Vertex(a)),
            [0, ..] => Some(Site::edge(b, c)),
            [_, 0, _] => Some(Site::edge(c, a)),
            [.., 0] => Some(Site::edge(a, b)),
            _ => return Some(Report::Crossing),
        };
        let Some(own) = own else { return Some(Report::Nothing) };
        // Most faces have nothing to report, which is known from the faces around.
        let may_report = self.owner(&self.fan(own)?) == Some(face) && self.begins_at(own)?;
        if !may_report && !crosses {
            return Some(Report::Nothing);
        }
        let (is_touch, first) = self.piece(own)?;
        Some(match (is_touch, crosses) {
            (false, true) => Report::Crossing,
            (true, _) if may_report && first == Some(own) => Report::Touch(own),
            _ => Report::Nothing,
        })
    }

    /// The crossing of the line with a plane through a site.
    pub(super) fn crossing(&self, site: Site) -> Option<(Crossing, impl PlaneForm)> {
        let plane = self.plane(site)?;
        Some((self.probe.crossing(&plane)?, plane))
    }

    /// The barycentric coordinates `(b1, b2)` of a face's site.
    pub(super) fn coordinates(&self, face: u32, site: Site) -> Option<[f64; 2]> {
        let corners = self.fans.corners(&self.mesh.data, face);
        let place = |v: u32| corners.iter().position(|&w| w == v);
        let mut b = [0.0; 3];
        match site {
            Site::Vertex(v) => b[place(v)?] = 1.0,
            Site::Edge(p, q) => {
                let axis = self.axis_beside([p, q])?;
                let ends = [p, q].map(|v| self.offset(v, axis));
                let [share, _] = Isa::detect().run(
                    #[inline(always)]
                    || planar::ratios(self.probe, &ShareForm(ends)),
                );
                if share.e.is_nan() || share.e > planar::TIGHT {
                    return None;
                }
                let share = share.v.clamp(0.0, 1.0);
                (b[place(p)?], b[place(q)?]) = (1.0 - share, share);
            }
        }
        Some([b[1], b[2]])
    }

    /// The face that reports a touch at a site.
    fn owner(&self, fan: &[Member]) -> Option<u32> {
        let live = || fan.iter().filter(|m| self.mesh.is_live(m.face));
        let least = live().filter(|m| m.angle.is_some()).map(|m| m.face).min();
        least.or_else(|| live().map(|m| m.face).min())
    }

    /// Whether no face at the site that is seen edge-on reaches farther back along the line.
    fn begins_at(&self, site: Site) -> Option<bool> {
        for member in self.fan(site)?.iter().filter(|m| m.angle.is_none()) {
            for other in self.sites_edge_on(member.corners)? {
                if self.order(other, site)?.is_lt() {
                    return Some(false);
                }
            }
        }
        Some(true)
    }

    /// Whether the line touches the mesh in the piece that holds a site, and the piece's first
    /// site.
    fn piece(&self, site: Site) -> Option<(bool, Option<Site>)> {
        let mut sites = vec![site];
        let mut first: Option<Site> = None;
        let mut angles: Vec<[Way; 2]> = Vec::new();
        let mut done = 0;
        while let Some(&site) = sites.get(done) {
            done += 1;
            let fan = self.fan(site)?;
            if self.owner(&fan).is_some() {
                first = match first {
                    Some(least) if self.order(least, site)?.then(least.cmp(&site)).is_le() => Some(least),
                    _ => Some(site),
                };
            }
            let mut more = Vec::new();
            for member in &fan {
                match member.angle {
                    // A way that turns by half a circle is two of less.
                    Some([x, y, z]) if x != y => angles.extend([[x, y], [y, z]]),
                    Some([x, _, z]) => angles.push([x, z]),
                    None => more.extend(self.sites_edge_on(member.corners)?),
                }
            }
            let ends = match site {
                Site::Vertex(v) => self.fans.ends_at(v),
                Site::Edge(a, b) => self.fans.ends_along([a, b]),
            };
            if ends {
                more.extend(self.borders_at(site)?);
            }
            for site in more {
                if !sites.contains(&site) {
                    sites.push(site);
                }
            }
        }
        Some((!self.go_round(&angles)?, first))
    }

    /// Whether angles, each less than half a circle, cover the whole circle: from the end of one,
    /// the farthest end of those that hold it, again and again, until the begin is passed.
    fn go_round(&self, angles: &[[Way; 2]]) -> Option<bool> {
        let Some(&[begin, mut at]) = angles.first() else { return Some(false) };
        for _ in 0..=angles.len() {
            let mut farthest: Option<Way> = None;
            for &[x, y] in angles {
                if self.holds([x, y], at)? {
                    let farther = match farthest {
                        Some(end) => self.turn(end, y)? > 0,
                        None => true,
                    };
                    farthest = if farther { Some(y) } else { farthest };
                }
            }
            let Some(end) = farthest else { return Some(false) };
            if self.holds([at, end], begin)? || (self.turn(end, begin)? == 0 && self.turn(at, begin)? > 0) {
                return Some(true);
            }
            at = end;
        }
        Some(true)
    }

    /// Whether an angle, without its end, holds a direction.
    fn holds(&self, [x, y]: [Way; 2], way: Way) -> Option<bool> {
        Some(self.turn(x, way)? >= 0 && self.turn(way, y)? > 0)
    }

    /// The faces at a site.
    fn fan(&self, site: Site) -> Option<Vec<Member>> {
        let (at, other) = match site {
            Site::Vertex(v) => (v, None),
            Site::Edge(a, b) => (a, Some(b)),
        };
        let mut fan = Vec::new();
        for &face in self.fans.around(at) {
            let corners = self.fans.corners(&self.mesh.data, face);
            let from = corners.iter().position(|&v| v == at)?;
            let (next, last) = (corners[(from + 1) % 3], corners[(from + 2) % 3]);
            // The ways in the order of the angle, if the face is seen from one side.
            let ways = match other {
                None => [(at, next), (at, next), (at, last)],
                Some(b) if b == next => [(at, b), (at, last), (b, at)],
                Some(b) if b == last => [(at, b), (at, next), (b, at)],
                Some(_) => continue,
            };
            let [x, y, z] = ways;
            let middle = if x == y { z } else { y };
            let angle = match self.turn(x, middle)? {
                0 => None,
                1 => Some(ways),
                // A wedge at a vertex is one angle, from its second way to its first.
                _ if x == y => Some([z, z, x]),
                _ => Some([z, y, x]),
            };
            fan.push(Member { face, corners, angle });
        }
        Some(fan)
    }

    /// The sites at which the line, which lies in the plane of these vertices, meets the edges
    /// between them.
    fn sites_edge_on(&self, corners: [u32; 3]) -> Option<Vec<Site>> {
        let sides = self.sides(&corners)?;
        let mut sites = Vec::new();
        for i in 0..3 {
            let j = (i + 1) % 3;
            if sides[i] == 0 {
                sites.push(Site::Vertex(corners[i]));
            }
            if sides[i] * sides[j] < 0 {
                sites.push(Site::edge(corners[i], corners[j]));
            }
        }
        Some(sites)
    }

    /// The sides on which vertices lie that are in one plane with the line.
    fn sides(&self, vertices: &[u32]) -> Option<Vec<i8>> {
        for axis in 0..3 {
            let mut sides = Vec::with_capacity(vertices.len());
            for &v in vertices {
                sides.push(self.sign(&self.offset(v, axis))? as i8);
            }
            // Along this axis the plane is seen edge-on if all are zero.
            if sides.iter().any(|&side| side != 0) {
                return Some(sides);
            }
        }
        Some(vec![0; vertices.len()])
    }

    /// The sites on borders of the mesh that are the same point of the line as a site.
    fn borders_at(&self, site: Site) -> Option<Vec<Site>> {
        let mut found = Vec::new();
        for &edge in self.fans.borders() {
            let [a, b] = edge.map(|v| self.point(v));
            let apart = Isa::detect().run(
                #[inline(always)]
                || {
                    let filter = EdgeFilter::new(self.probe);
                    let (p, q) = (filter.seen(a), filter.seen(b));
                    filter.side(p, q).abs() > filter.bound(p.max_abs().max(q.max_abs()))
                },
            );
            let (centre, scale) = self.probe.view();
            if apart || self.sign(&EdgeForm { a, b, centre, scale })?.is_ne() {
                continue;
            }
            let sides = self.sides(&edge)?;
            let mut here = Vec::new();
            if sides[0] * sides[1] < 0 {
                here.push(Site::Edge(edge[0], edge[1]));
            }
            here.extend((0..2).filter(|&i| sides[i] == 0).map(|i| Site::Vertex(edge[i])));
            for other in here {
                if self.order(other, site)?.is_eq() {
                    found.push(other);
                }
            }
        }
        Some(found)
    }

    /// The first of some sites along the line.
    fn first_of(&self, sites: &[Site]) -> Option<Option<Site>> {
        let mut first = None;
        for &site in sites {
            first = match first {
                Some(least) if self.order(least, site)?.then(least.cmp(&site)).is_le() => Some(least),
                _ => Some(site),
            };
        }
        Some(first)
    }

    /// The order of two sites along the line.
    fn order(&self, a: Site, b: Site) -> Option<Ordering> {
        if a == b {
            return Some(Ordering::Equal);
        }
        let (p, q) = (self.plane(a)?, self.plane(b)?);
        let (x, y) = (self.probe.crossing(&p)?, self.probe.crossing(&q)?);
        if x.s_hi < y.s_lo {
            return Some(Ordering::Less);
        }
        if x.s_lo > y.s_hi {
            return Some(Ordering::Greater);
        }
        let order = self.sign(&LaterForm(&p, &q))?;
        Some(if x.sign * y.sign < 0 { order.reverse() } else { order })
    }

    /// A plane through a site that the line crosses there.
    fn plane(&self, site: Site) -> Option<SitePlane> {
        let (centre, scale) = self.probe.view();
        match site {
            Site::Vertex(v) => {
                let axis = largest(self.probe.ray.d.abs());
                Some(SitePlane { base: self.point(v), along: None, axis, centre, scale })
            }
            Site::Edge(a, b) => {
                let axis = self.axis_beside([a, b])?;
                Some(SitePlane { base: self.point(a), along: Some(self.point(b)), axis, centre, scale })
            }
        }
    }

    /// An axis along which the edge and the line are not seen in one direction.
    fn axis_beside(&self, edge: [u32; 2]) -> Option<usize> {
        let [a, b] = edge.map(|v| self.point(v));
        let rough = largest((b - a).cross(self.probe.ray.d).abs());
        for axis in [rough, 0, 1, 2] {
            if self.sign(&MinorForm { a, b, axis })?.is_ne() {
                return Some(axis);
            }
        }
        None
    }

    fn offset(&self, v: u32, axis: usize) -> OffsetForm {
        let (centre, scale) = self.probe.view();
        OffsetForm { v: self.point(v), axis, centre, scale }
    }

    /// The sign of the turn from one way to another, as seen along the line.
    fn turn(&self, x: Way, y: Way) -> Option<i8> {
        if x == y || x == (y.1, y.0) {
            return Some(0);
        }
        let ways = [x, y].map(|(from, to)| (self.point(from), self.point(to)));
        Some(self.sign(&TurnForm { ways, scale: self.probe.view().1 })? as i8)
    }

    fn point(&self, v: u32) -> Point3 {
        self.mesh.data.vertices[v as usize]
    }

    #[inline(never)]
    fn sign<P: AlongRay>(&self, p: &P) -> Option<Ordering> {
        Isa::detect().run(
            #[inline(always)]
            || self.probe.sign(p),
        )
    }
}

/// The axis of the largest component.
fn largest(v: Vec3) -> usize {
    if v.x >= v.y && v.x >= v.z {
        0
    } else if v.y >= v.z {
        1
    } else {
        2
    }
}
