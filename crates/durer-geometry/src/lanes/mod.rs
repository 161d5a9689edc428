//! Eight rays side by side, and what they meet.

use crate::beam::Candidate;
use crate::ids::Id;
use crate::{Beam, Geometry, Hit};
use arrayvec::ArrayVec;
use durer_math::lanes::{LANES, set_bits};
use durer_math::{Aabb, F8, Isa, M8, Point3, Ray, RaySide, Shaft, Source, U, Vec3};
use durer_surfaces::outline::{From8, Nearest, Outline, Points8, RayLanes, Scratch};
use durer_surfaces::{Need, ROUGH, SurfacePoint};

/// Eight rays `o + t d` with `t` in `[0, t_max]`.
#[derive(Clone, Copy, Debug)]
pub struct Rays8 {
    /// Where they start.
    pub origin: Point3<F8>,
    /// Their directions, of any length but zero.
    pub direction: Vec3<F8>,
    /// How far they go.
    pub t_max: F8,
    /// Which lanes hold a ray; the others may hold anything.
    pub live: M8,
    /// What they were spawned from.
    pub source: Sources8,
}

/// The primitives that rays leave, or none.
#[derive(Clone, Copy, Debug)]
pub struct Sources8 {
    /// Arena and index, the arena in the upper half; all ones where there is none.
    pub(crate) slot: [u64; LANES],
    pub(crate) instance: [u32; LANES],
    part: [u32; LANES],
    pub(crate) face: [u32; LANES],
    /// Where the ray starts behind the surface.
    pub(crate) back: M8,
}

/// What eight rays see first.
#[derive(Clone, Copy, Debug)]
pub struct Hits8 {
    /// Which rays meet anything. The rest is about these.
    pub hit: M8,
    /// Which rays only touch what they meet.
    pub touching: M8,
    /// Where, in units of the direction.
    pub t: F8,
    /// The points.
    pub p: Point3<F8>,
    /// The unit geometric normals: outward for solids, as stored for open surfaces.
    pub ng: Vec3<F8>,
    /// The unit shading normals, on the side of `ng`.
    pub ns: Vec3<F8>,
    /// See [`durer_surfaces::SurfacePoint::off`].
    pub off: F8,
    /// The objects.
    pub object: [u32; LANES],
    /// The primitives within the objects.
    pub primitive: [u32; LANES],
    /// What rays that are spawned here leave.
    pub source: Sources8,
}

/// The number that stands for no slot.
const NOWHERE: u64 = u64::MAX;

/// Arena and index in one number.
#[inline(always)]
pub(crate) fn slot_number(arena: u32, index: u32) -> u64 {
    u64::from(arena) << 32 | u64::from(index)
}

impl Sources8 {
    /// Rays from nowhere in particular.
    pub const NONE: Self = Self {
        slot: [NOWHERE; LANES],
        instance: [0; LANES],
        part: [0; LANES],
        face: [0; LANES],
        back: M8::NONE,
    };

    /// The source of a lane.
    #[inline]
    pub fn lane(&self, i: usize) -> Option<Source> {
        (self.slot[i] != NOWHERE).then(|| Source {
            arena: (self.slot[i] >> 32) as u32,
            index: self.slot[i] as u32,
            part: self.part[i],
            face: self.face[i],
            instance: self.instance[i],
            side: if self.back.lane(i) { RaySide::Back } else { RaySide::Front },
        })
    }

    /// Puts down every slot that some ray leaves, once.
    #[inline]
    fn all(&self, all: &mut ArrayVec<u64, LANES>) {
        let mut last = NOWHERE;
        for (&slot, &instance) in self.slot.iter().zip(&self.instance) {
            // Mostly they leave the same one.
            if slot != last && slot != NOWHERE && instance == 0 && !all.contains(&slot) {
                all.push(slot);
                last = slot;
            }
        }
    }

    /// The rays that leave a slot.
    fn of(&self, arena: u32, slot: u32, outline: &Outline) -> From8 {
        let number = slot_number(arena, slot);
        From8 {
            lanes: M8::from_fn(|i| self.slot[i] == number && self.instance[i] == 0),
            face: if outline.is_part() { F8::ZERO } else { F8(self.face.map(f64::from)) },
            back: self.back,
        }
    }

    /// Gives lane `i` a source.
    #[inline]
    pub fn set_lane(&mut self, i: usize, source: Option<Source>) {
        self.slot[i] = source.map_or(NOWHERE, |s| slot_number(s.arena, s.index));
        if let Some(s) = source {
            (self.part[i], self.face[i], self.instance[i]) = (s.part, s.face, s.instance);
            self.back.set_lane(i, s.side == RaySide::Back);
        }
    }

    /// Lane `i` becomes lane `j` of another eight.
    #[inline(always)]
    pub fn copy_lane(&mut self, i: usize, from: &Self, j: usize) {
        self.slot[i] = from.slot[j];
        self.instance[i] = from.instance[j];
        self.part[i] = from.part[j];
        self.face[i] = from.face[j];
        self.back.set_lane(i, from.back.lane(j));
    }
}

impl Rays8 {
    /// No rays.
    pub const NONE: Self = Self {
        origin: Point3::new(F8::ZERO, F8::ZERO, F8::ZERO),
        direction: Vec3::new(F8::ONE, F8::ZERO, F8::ZERO),
        t_max: F8::ZERO,
        live: M8::NONE,
        source: Sources8::NONE,
    };

    /// The ray in a lane.
    #[inline]
    pub fn lane(&self, i: usize) -> Ray {
        let o = self.origin;
        let origin = Point3::new(o.x.0[i], o.y.0[i], o.z.0[i]);
        Ray::new(origin, self.direction.lane(i))
            .with_range(0.0, self.t_max.0[i])
            .spawned_from(self.source.lane(i))
    }
}

impl Hits8 {
    /// No hits.
    pub const NONE: Self = Self {
        hit: M8::NONE,
        touching: M8::NONE,
        t: F8::ZERO,
        p: Point3::new(F8::ZERO, F8::ZERO, F8::ZERO),
        ng: Vec3::new(F8::ZERO, F8::ZERO, F8::ONE),
        ns: Vec3::new(F8::ZERO, F8::ZERO, F8::ONE),
        off: F8::ZERO,
        object: [0; LANES],
        primitive: [0; LANES],
        source: Sources8::NONE,
    };

    /// Says what these lanes meet, an instance of nothing.
    #[inline(always)]
    fn name(&mut self, lanes: u8, name: Id, (slot, part, face): (u64, u32, u32)) {
        let from = &mut self.source;
        if lanes == u8::MAX {
            (self.object, self.primitive) = ([name.object; LANES], [name.primitive; LANES]);
            (from.slot, from.face) = ([slot; LANES], [face; LANES]);
            (from.part, from.instance) = ([part; LANES], [0; LANES]);
            return;
        }
        for i in set_bits(lanes) {
            (self.object[i], self.primitive[i]) = (name.object, name.primitive);
            (from.slot[i], from.face[i]) = (slot, face);
            (from.part[i], from.instance[i]) = (part, 0);
        }
    }

    /// What a ray saw by itself.
    fn set_lane(&mut self, i: usize, seen: Option<(Hit, SurfacePoint)>) {
        self.hit.set_lane(i, seen.is_some());
        let Some((hit, point)) = seen else { return };
        self.touching.set_lane(i, hit.sign == 0);
        self.t.0[i] = hit.t;
        (self.p.x.0[i], self.p.y.0[i], self.p.z.0[i]) = (point.p.x, point.p.y, point.p.z);
        self.ng.set_lane(i, point.ng.to_vec());
        self.ns.set_lane(i, point.ns.to_vec());
        self.off.0[i] = point.off;
        (self.object[i], self.primitive[i]) = (hit.object, hit.primitive);
        self.source.set_lane(i, point.source);
    }

    /// Where rays along `direction` start, and which of them do so behind the surface: as [`durer_surfaces::SurfacePoint::spawn`].
    #[inline(always)]
    pub fn start_towards(&self, direction: Vec3<F8>) -> (Point3<F8>, M8) {
        let n = self.ng;
        let back = (n.x * direction.x + n.y * direction.y + n.z * direction.z).lt(F8::ZERO);
        let p = self.p.to_vec();
        // The start is rounded to the nearest f64, which costs up to U |p| per axis; `off` has room for steps a little longer (see
        // `SurfacePoint::start`, which rounds away from the surface instead).
        let size = p.x.abs() + p.y.abs() + p.z.abs();
        let far = size.mul_add(F8::splat(2.0 * U), self.off);
        let step = back.select(-far, far);
        let start = Point3::new(n.x.mul_add(step, p.x), n.y.mul_add(step, p.y), n.z.mul_add(step, p.z));
        (start, back)
    }

    /// The sources of rays that start on these sides.
    #[inline(always)]
    pub fn sources(&self, back: M8) -> Sources8 {
        Sources8 { back, ..self.source }
    }
}

/// Boxes around points, lane by lane.
struct Bounds8 {
    min: Vec3<F8>,
    max: Vec3<F8>,
}

impl Bounds8 {
    const NONE: Self = Self {
        min: Vec3::splat(Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY)),
        max: Vec3::splat(Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY)),
    };

    #[inline(always)]
    fn take(&mut self, live: M8, p: Vec3<F8>) {
        let (a, b) = (self.min, self.max);
        self.min = live.select3(Vec3::new(p.x.min(a.x), p.y.min(a.y), p.z.min(a.z)), a);
        self.max = live.select3(Vec3::new(p.x.max(b.x), p.y.max(b.y), p.z.max(b.z)), b);
    }

    /// The box around all lanes.
    fn all(&self) -> Aabb {
        let least = |v: F8| v.0.into_iter().fold(f64::INFINITY, f64::min);
        let most = |v: F8| v.0.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let (a, b) = (self.min, self.max);
        Aabb::new(
            Point3::new(least(a.x), least(a.y), least(a.z)),
            Point3::new(most(b.x), most(b.y), most(b.z)),
        )
    }
}

/// The source of all rays, if they have the same and start on the same side of it.
fn common_source(isa: Isa, rays: &[Rays8]) -> Option<Source> {
    let source = rays.iter().find_map(|r| r.live.first_set().map(|i| r.source.lane(i)))??;
    let (slot, back) = (slot_number(source.arena, source.index), M8::splat(source.side == RaySide::Back));
    let shared = isa.run_in_lanes(
        #[inline(always)]
        || {
            rays.iter().all(|Rays8 { live, source: from, .. }| {
                let same = M8::from_fn(
                    #[inline(always)]
                    |i| from.slot[i] == slot && from.instance[i] == 0,
                );
                let side = from.back & back | !from.back & !back;
                (!*live | same & side).all()
            })
        },
    );
    (source.instance == 0 && shared).then_some(source)
}

/// Puts down the lanes that wait with these numbers; answers with their bits.
#[inline(never)]
fn together(isa: Isa, waiting: &M8, (number, n): (&F8, f64), (face, f): (&F8, f64), to: &mut M8) -> u8 {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            let same = |v: &F8, x: F8| v.le(x) & v.ge(x);
            *to = *waiting & same(number, F8::splat(n)) & same(face, F8::splat(f));
            to.bits()
        },
    )
}

impl Geometry {
    /// What the rays of some eights may meet; `None` if that is so much that each ray should look for itself.
    pub fn beam_of(&self, rays: &[Rays8]) -> Option<Beam> {
        let (mut start, mut end, mut way) = (Bounds8::NONE, Bounds8::NONE, Bounds8::NONE);
        let mut endless = false;
        self.isa.run_in_lanes(
            #[inline(always)]
            || {
                for Rays8 { origin, direction, t_max, live, .. } in rays {
                    let (o, d) = (origin.to_vec(), *direction);
                    start.take(*live, o);
                    way.take(*live, d);
                    end.take(*live, Vec3::new(o.x + d.x, o.y + d.y, o.z + d.z));
                    endless |= (*live & !t_max.le(F8::ONE)).any();
                }
            },
        );
        let (start, end, way) = (start.all(), end.all(), way.all());
        // Shorter rays are held by the shaft of longer ones.
        let shaft = if endless {
            Shaft::new(start, way.min.to_vec(), way.max.to_vec())
        } else {
            Shaft::between(start, end)
        };
        self.beam(&shaft, common_source(self.isa, rays))
    }

    /// Puts down what each ray sees first, as [`Geometry::seen`] answers. `beam` holds what these rays may meet, if that is known; `scratch`
    /// may hold anything.
    pub fn seen_by_lanes(
        &self,
        beam: Option<&Beam>,
        rays: &Rays8,
        mask: u32,
        hits: &mut Hits8,
        scratch: &mut Scratch,
    ) {
        hits.hit = M8::NONE;
        hits.touching = M8::NONE;
        if !rays.live.any() || beam.is_some_and(Beam::is_empty) {
            return;
        }
        let own;
        let beam = match beam {
            Some(beam) => Some(beam),
            None => {
                own = self.beam_of(core::slice::from_ref(rays));
                own.as_ref()
            }
        };
        let mut left = rays.live;
        if let Some(beam) = beam {
            left = self.see(beam, rays, mask, hits, scratch);
        }
        for i in left.lanes() {
            let ray = rays.lane(i);
            let seen = match beam {
                Some(beam) => self.seen_in(beam, &ray, mask, Need::SHADING_NORMAL),
                None => self.seen(&ray, mask, Need::SHADING_NORMAL),
            };
            hits.set_lane(i, seen);
        }
    }

    /// Puts down what is sure; answers with the rays of which something is not.
    fn see(&self, beam: &Beam, rays: &Rays8, mask: u32, hits: &mut Hits8, scratch: &mut Scratch) -> M8 {
        let lanes = RayLanes::new(self.isa, &rays.origin, &rays.direction, &rays.t_max, &rays.live);
        let mut nearest = Nearest::NONE;
        self.nearest(beam, rays, &lanes, mask, &mut nearest, scratch);
        let (mut clear, mut left) = (M8::NONE, M8::NONE);
        let mut waiting = self.isa.run_in_lanes(
            #[inline(always)]
            || {
                let Nearest { t, e, doubt, .. } = nearest;
                let never = F8::splat(f64::INFINITY);
                // Known well enough to be seen, and before all doubt.
                clear = t.lt(never) & doubt.gt(t + e) & e.le(t * (0.5 * ROUGH));
                left = rays.live & !(clear | t.ge(never) & doubt.ge(never));
                clear.bits()
            },
        );
        let Nearest { t, number, face, .. } = &nearest;
        hits.t = *t;
        let (mut is_first, mut these) = (true, M8::NONE);
        while waiting != 0 {
            let i = waiting.trailing_zeros() as usize;
            let (n, f) = (number.0[i], face.0[i]);
            waiting &= !together(self.isa, &clear, (number, n), (face, f), &mut these);
            let candidate = &beam.candidates[n as usize];
            let Some(outline) = self.outline(candidate.arena, candidate.slot) else { continue };
            let Hits8 { p, ng, ns, off, .. } = &mut *hits;
            let sure = outline.points(f as usize, &lanes, t, &these, Points8 { p, ng, ns, off });
            let lanes = self.isa.run_in_lanes(
                #[inline(always)]
                || {
                    left |= these & !sure;
                    hits.hit |= sure;
                    sure.bits()
                },
            );
            let part = self.arenas[candidate.arena as usize].part(candidate.slot).0;
            // The kernels of meshes count faces, and lanes see one of them.
            let face = if outline.is_part() { part } else { f as u32 };
            let slot = slot_number(candidate.arena, candidate.slot);
            hits.name(if is_first { u8::MAX } else { lanes }, candidate.name, (slot, part, face));
            is_first = false;
        }
        left
    }

    /// The first sure hit of each ray among the candidates, and the first doubt.
    fn nearest(
        &self,
        beam: &Beam,
        rays: &Rays8,
        lanes: &RayLanes<'_>,
        mask: u32,
        nearest: &mut Nearest,
        scratch: &mut Scratch,
    ) {
        let mut sources = ArrayVec::new();
        rays.source.all(&mut sources);
        for (number, candidate) in beam.candidates.iter().enumerate() {
            let Candidate { arena, slot, .. } = *candidate;
            if candidate.mask & mask == 0 {
                continue;
            }
            match self.outline(arena, slot) {
                Some(outline) if sources.contains(&slot_number(arena, slot)) => {
                    let from = rays.source.of(arena, slot, outline);
                    outline.meet(lanes, Some(&from), number as f64, nearest, scratch);
                }
                Some(outline) => outline.meet(lanes, None, number as f64, nearest, scratch),
                None => nearest.doubt = F8::ZERO,
            }
        }
    }

    /// Which rays meet anything, as [`Geometry::any_masked`] answers.
    pub fn any_by_lanes(&self, beam: Option<&Beam>, rays: &Rays8, mask: u32, scratch: &mut Scratch) -> M8 {
        if !rays.live.any() || beam.is_some_and(Beam::is_empty) {
            return M8::NONE;
        }
        let own;
        let beam = match beam {
            Some(beam) => Some(beam),
            None => {
                own = self.beam_of(core::slice::from_ref(rays));
                own.as_ref()
            }
        };
        let (mut met, mut left) = (M8::NONE, rays.live);
        if let Some(beam) = beam {
            let lanes = RayLanes::new(self.isa, &rays.origin, &rays.direction, &rays.t_max, &rays.live);
            let mut nearest = Nearest::NONE;
            self.nearest(beam, rays, &lanes, mask, &mut nearest, scratch);
            self.isa.run_in_lanes(
                #[inline(always)]
                || {
                    let never = F8::splat(f64::INFINITY);
                    met = nearest.t.lt(never) & rays.live;
                    left = rays.live & !(met | nearest.doubt.ge(never));
                },
            );
        }
        for i in left.lanes() {
            let ray = rays.lane(i);
            met.set_lane(
                i,
                match beam {
                    Some(beam) => self.any_in(beam, &ray, mask),
                    None => self.any_masked(&ray, mask),
                },
            );
        }
        met
    }
}

#[cfg(test)]
mod tests;
