//! Packets of eight rays, and their hits.

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
    /// The origins.
    pub origin: Point3<F8>,
    /// The directions, of any length but zero.
    pub direction: Vec3<F8>,
    /// The ends of the ranges.
    pub t_max: F8,
    /// The lanes that hold a ray; the contents of the others do not matter.
    pub live: M8,
    /// The sources of spawned rays.
    pub source: Sources8,
}

/// The primitives from which eight rays start, if any.
#[derive(Clone, Copy, Debug)]
pub struct Sources8 {
    /// Arena and index, the arena in the upper half; all ones where there is none.
    pub(crate) slot: [u64; LANES],
    pub(crate) instance: [u32; LANES],
    part: [u32; LANES],
    pub(crate) face: [u32; LANES],
    /// Whether the ray starts behind the surface.
    pub(crate) back: M8,
}

/// The first hits of eight rays.
#[derive(Clone, Copy, Debug)]
pub struct Hits8 {
    /// The rays that hit anything. The other members are valid only in their lanes.
    pub hit: M8,
    /// The grazing hits.
    pub touching: M8,
    /// The parameters, in units of the direction.
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
    /// The sources for rays that are spawned at the hits.
    pub source: Sources8,
}

/// The number for no slot.
const NOWHERE: u64 = u64::MAX;

/// Arena and index in one number.
#[inline(always)]
pub(crate) fn slot_number(arena: u32, index: u32) -> u64 {
    u64::from(arena) << 32 | u64::from(index)
}

impl Sources8 {
    /// No sources.
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

    /// Lists every slot from which some ray starts, once.
    #[inline]
    pub(super) fn all(&self, all: &mut ArrayVec<u64, LANES>) {
        // Usually all rays start from the same slot, or from none.
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

    /// The rays that start from a slot.
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

    /// The mask of rays that start from a slot outside of instances.
    #[inline(always)]
    pub(super) fn leave(&self, slot: u64) -> M8 {
        M8::from_fn(
            #[inline(always)]
            |i| self.slot[i] == slot && self.instance[i] == 0,
        )
    }

    /// Sets the source of lane `i`.
    #[inline]
    pub fn set_lane(&mut self, i: usize, source: Option<Source>) {
        self.slot[i] = source.map_or(NOWHERE, |s| slot_number(s.arena, s.index));
        if let Some(s) = source {
            (self.part[i], self.face[i], self.instance[i]) = (s.part, s.face, s.instance);
            self.back.set_lane(i, s.side == RaySide::Back);
        }
    }

    /// Copies lane `j` of another packet to lane `i`.
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

    /// Clears the mask of hits; the other members keep their contents.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        (self.hit, self.touching) = (M8::NONE, M8::NONE);
    }

    /// Sets the numbers of hits in these lanes, outside of instances.
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

    /// Stores the answer of a single ray in lane `i`.
    pub fn set_lane(&mut self, i: usize, seen: Option<(Hit, SurfacePoint)>) {
        self.hit.set_lane(i, seen.is_some());
        let Some((hit, point)) = seen else { return };
        self.touching.set_lane(i, hit.sign == 0);
        self.t.0[i] = hit.t;
        // The factor covers the rounding of the differences.
        self.t_error.0[i] = (hit.t - hit.t_lo).max(hit.t_hi - hit.t) * (1.0 + 2.0 * U);
        // At a double tip, the middle between the starts.
        let p = point.p + point.aside;
        (self.p.x.0[i], self.p.y.0[i], self.p.z.0[i]) = (p.x, p.y, p.z);
        self.ng.set_lane(i, point.ng.to_vec());
        self.ns.set_lane(i, point.ns.to_vec());
        self.off.0[i] = point.off;
        (self.object[i], self.primitive[i]) = (hit.object.0, hit.primitive.0);
        self.source.set_lane(i, point.source);
    }

    /// The origins of rays along `direction`, and which of them are behind the surface: like
    /// [`durer_surfaces::SurfacePoint::spawn`].
    #[inline(always)]
    pub fn start_towards(&self, direction: Vec3<F8>) -> (Point3<F8>, M8) {
        let n = self.ng;
        let back = (n.x * direction.x + n.y * direction.y + n.z * direction.z).lt(F8::ZERO);
        let p = self.p.to_vec();
        // The origin is rounded to the nearest f64, which costs up to U |p| per axis; `off` has
        // room for steps a little longer (see `SurfacePoint::start`, which rounds away from the
        // surface instead).
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
