//! The closest hit so far.

use crate::ids::Id;
use crate::{Hit, ObjectId, PrimitiveId};
use durer_surfaces::Root;

/// The placement whose surfaces are being tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Placement {
    /// Added to object numbers.
    pub(crate) object: u32,
    /// Added to primitive numbers.
    pub(crate) primitive: u32,
    /// The number of the placement.
    pub(crate) instance: u32,
}

impl Placement {
    /// The hit for a root of a slot in this placement.
    #[inline(always)]
    pub(crate) fn hit(&self, arena: u32, slot: u32, name: Id, root: &Root) -> Hit {
        // Minus zero becomes zero: the least of both is either one, by the processor's instructions.
        Hit {
            t: root.t + 0.0,
            t_lo: root.lo + 0.0,
            t_hi: root.hi + 0.0,
            tag: root.tag,
            object: ObjectId(self.object.wrapping_add(name.object)),
            primitive: PrimitiveId(self.primitive.wrapping_add(name.primitive)),
            instance: self.instance,
            face: root.face,
            sign: root.sign,
            kind: root.kind,
            s: root.s,
            arena,
            slot,
        }
    }
}

/// The least hit so far, by [`Hit::order`]; of equal ones the first, which is the first in the
/// exact order.
#[derive(Debug)]
pub(crate) struct ClosestHit {
    pub(crate) hit: Option<Hit>,
    /// The least upper end of a bracket: a bracket that begins behind it cannot win.
    limit: f64,
    pub(crate) placement: Placement,
    pub(crate) arena: u32,
    /// Whether any hit suffices, whatever it is.
    any: bool,
    satisfied: bool,
}

impl ClosestHit {
    /// A search for the least hit.
    pub(crate) fn least() -> Self {
        let (placement, limit) = (Placement::default(), f64::INFINITY);
        Self { hit: None, limit, placement, arena: 0, any: false, satisfied: false }
    }

    /// A search for any hit.
    pub(crate) fn any() -> Self {
        Self { any: true, ..Self::least() }
    }

    /// Whether no further hit matters.
    #[inline(always)]
    pub(crate) fn is_satisfied(&self) -> bool {
        self.satisfied
    }

    /// No root beyond this can win; ties are not beyond.
    #[inline(always)]
    pub(crate) fn limit(&self) -> f64 {
        self.limit
    }

    /// Takes the root if it is less than the best; returns whether it did.
    #[inline(always)]
    pub(crate) fn offer(&mut self, slot: u32, name: Id, root: &Root) -> bool {
        if self.any {
            self.satisfied = true;
            return false;
        }
        if let Some(best) = &self.hit {
            if root.t > best.t {
                return false;
            }
            let hit = self.placement.hit(self.arena, slot, name, root);
            if hit.order(best).is_ge() {
                return false;
            }
            self.hit = Some(hit);
        } else {
            self.hit = Some(self.placement.hit(self.arena, slot, name, root));
        }
        self.limit = self.limit.min(root.hi);
        true
    }
}
