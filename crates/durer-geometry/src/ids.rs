//! Object and primitive numbers and masks, in arrays beside the surfaces.

/// The mask that every ray matches.
pub const EVERYTHING: u32 = u32::MAX;

/// The object and primitive numbers of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Id {
    pub(crate) object: u32,
    pub(crate) primitive: u32,
}

/// The numbers and masks of an arena's surfaces.
#[derive(Debug, Default)]
pub(crate) struct Ids {
    names: Vec<Id>,
    /// Empty as long as every mask is [`EVERYTHING`].
    masks: Vec<u32>,
}

impl Ids {
    pub(crate) fn push(&mut self, id: Id, mask: u32) {
        if mask != EVERYTHING && self.masks.is_empty() {
            self.masks = vec![EVERYTHING; self.names.len()];
        }
        if mask != EVERYTHING || !self.masks.is_empty() {
            self.masks.push(mask);
        }
        self.names.push(id);
    }

    #[inline(always)]
    pub(crate) fn name(&self, surface: usize) -> Id {
        self.names[surface]
    }

    /// The mask of a surface.
    #[inline(always)]
    pub(crate) fn mask(&self, surface: usize) -> u32 {
        self.masks.get(surface).copied().unwrap_or(EVERYTHING)
    }

    /// Whether a ray with this mask can hit the surface.
    #[inline(always)]
    pub(crate) fn admits(&self, surface: usize, mask: u32) -> bool {
        self.mask(surface) & mask != 0
    }

    pub(crate) fn swap(&mut self, a: usize, b: usize) {
        self.names.swap(a, b);
        if !self.masks.is_empty() {
            self.masks.swap(a, b);
        }
    }

    pub(crate) fn shrink(&mut self) {
        self.names.shrink_to_fit();
        self.masks.shrink_to_fit();
    }

    pub(crate) fn bytes(&self) -> usize {
        self.names.capacity() * size_of::<Id>() + self.masks.capacity() * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_cost_nothing_until_one_is_set() {
        let mut ids = Ids::default();
        for object in 0..3 {
            ids.push(Id { object, primitive: 0 }, EVERYTHING);
        }
        assert!(ids.masks.is_empty());
        ids.push(Id { object: 3, primitive: 0 }, 2);
        assert!(ids.admits(0, 1) && !ids.admits(3, 1) && ids.admits(3, 2));
        ids.swap(0, 3);
        assert!(!ids.admits(0, 1) && ids.admits(3, 1));
        assert_eq!(ids.name(0).object, 3);
    }
}
