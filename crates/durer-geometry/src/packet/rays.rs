//! What eight rays are, and what they see.

use crate::Hit;
use crate::ids::Id;
use arrayvec::ArrayVec;
use durer_math::lanes::{LANES, set_bits};
use durer_math::{F8, M8, Point3, Ray, RaySide, Source, U, Vec3};
use durer_surfaces::SurfacePoint;
use durer_surfaces::packet::{From8, PacketFilter};

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
    /// Bounds on the distance of `t` from the exact crossing.
    pub t_error: F8,
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
    pub(super) fn all(&self, all: &mut ArrayVec<u64, LANES>) {
        // Mostly they leave the same one, or none.
        let first = self.slot[0];
        let (mut differ, mut instances) = (0, 0);
        for i in 0..LANES {
            differ |= self.slot[i] ^ first;
            instances |= self.instance[i];
        }
        if differ == 0 && instances == 0 {
            if first != NOWHERE {
                all.push(first);
            }
            return;
        }
        for (&slot, &instance) in self.slot.iter().zip(&self.instance) {
            if slot != NOWHERE && instance == 0 && !all.contains(&slot) {
                all.push(slot);
            }
        }
    }

    /// The rays that leave a slot.
    #[inline(always)]
    pub(super) fn of(&self, arena: u32, slot: u32, outline: &PacketFilter) -> From8 {
        let lanes = self.leave(slot_number(arena, slot));
        let mut face = F8::ZERO;
        if outline.own_face().is_none() {
            for i in 0..LANES {
                face.0[i] = f64::from(self.face[i]);
            }
        }
        From8 { lanes, face, back: self.back }
    }

    /// Which rays leave a slot that no instance places.
    #[inline(always)]
    pub(super) fn leave(&self, slot: u64) -> M8 {
        M8::from_fn(
            #[inline(always)]
            |i| self.slot[i] == slot && self.instance[i] == 0,
        )
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
        t_error: F8::ZERO,
        p: Point3::new(F8::ZERO, F8::ZERO, F8::ZERO),
        ng: Vec3::new(F8::ZERO, F8::ZERO, F8::ONE),
        ns: Vec3::new(F8::ZERO, F8::ZERO, F8::ONE),
        off: F8::ZERO,
        object: [0; LANES],
        primitive: [0; LANES],
        source: Sources8::NONE,
    };

    /// Nothing is met; all else may stay.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        (self.hit, self.touching) = (M8::NONE, M8::NONE);
    }

    /// Says what these lanes meet, an instance of nothing.
    #[inline(always)]
    pub(super) fn name(&mut self, lanes: u8, name: Id, (slot, part, face): (u64, u32, u32)) {
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

    /// Puts the answer of a single ray into lane `i`.
    pub fn set_lane(&mut self, i: usize, seen: Option<(Hit, SurfacePoint)>) {
        self.hit.set_lane(i, seen.is_some());
        let Some((hit, point)) = seen else { return };
        self.touching.set_lane(i, hit.sign == 0);
        self.t.0[i] = hit.t;
        // The differences are rounded.
        self.t_error.0[i] = (hit.t - hit.t_lo).max(hit.t_hi - hit.t) * (1.0 + 2.0 * U);
        (self.p.x.0[i], self.p.y.0[i], self.p.z.0[i]) = (point.p.x, point.p.y, point.p.z);
        self.ng.set_lane(i, point.ng.to_vec());
        self.ns.set_lane(i, point.ns.to_vec());
        self.off.0[i] = point.off;
        (self.object[i], self.primitive[i]) = (hit.object, hit.primitive);
        self.source.set_lane(i, point.source);
    }

    /// Where rays along `direction` start, and which of them do so behind the surface: as
    /// [`durer_surfaces::SurfacePoint::spawn`].
    #[inline(always)]
    pub fn start_towards(&self, direction: Vec3<F8>) -> (Point3<F8>, M8) {
        let n = self.ng;
        let back = (n.x * direction.x + n.y * direction.y + n.z * direction.z).lt(F8::ZERO);
        let p = self.p.to_vec();
        // The start is rounded to the nearest f64, which costs up to U |p| per axis; `off` has room
        // for steps a little longer (see `SurfacePoint::start`, which rounds away from the surface
        // instead).
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
