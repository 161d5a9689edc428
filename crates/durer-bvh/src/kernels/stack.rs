//! The traversal's stack: two arrays that are never cleared.
#![expect(unsafe_code, reason = "a stack that is written before it is read needs no clearing, 2 KB per ray")]

use crate::node::{ChildRef, WIDTH};
use core::mem::MaybeUninit;

/// The deepest tree that is built.
pub(crate) const MAX_DEPTH: usize = 40;

/// On each level at most seven siblings wait while the eighth is entered; and one push writes eight lanes.
const CAPACITY: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH;

/// Children that wait, with the parameter at which the ray enters each.
pub(crate) struct Stack {
    refs: [MaybeUninit<u32>; CAPACITY],
    near: [MaybeUninit<f32>; CAPACITY],
    /// Everything below has been written. At most `CAPACITY`.
    len: usize,
}

impl Stack {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self {
            refs: [const { MaybeUninit::uninit() }; CAPACITY],
            near: [const { MaybeUninit::uninit() }; CAPACITY],
            len: 0,
        }
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, child: ChildRef, near: f32) {
        assert!(self.len < CAPACITY, "the builder bounds the depth");
        self.refs[self.len].write(child.0);
        self.near[self.len].write(near);
        self.len += 1;
    }

    #[inline(always)]
    pub(crate) fn pop(&mut self) -> Option<(ChildRef, f32)> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: the element at the old length less one was below that length, so it has been written; a f32 and a u32 are plain
        // data.
        Some(unsafe { (ChildRef(self.refs[self.len].assume_init()), self.near[self.len].assume_init()) })
    }

    /// The last child that the ray enters no later than this; those above it that it enters later are dropped.
    #[inline(always)]
    pub(crate) fn pop_before(&mut self, t_far: f32) -> Option<ChildRef> {
        loop {
            let (child, near) = self.pop()?;
            if near <= t_far {
                return Some(child);
            }
        }
    }

    /// Lets `write` fill eight elements of each array; the first `count` of them are kept.
    ///
    /// # Safety
    ///
    /// `write` gets pointers to eight unaligned elements, which it may write. It must write at least as many as it returns, at
    /// most eight.
    #[inline(always)]
    pub(crate) unsafe fn push_lanes(&mut self, write: impl FnOnce(*mut u32, *mut f32) -> usize) {
        assert!(self.len <= CAPACITY - WIDTH, "the builder bounds the depth");
        let refs = self.refs[self.len..][..WIDTH].as_mut_ptr();
        let near = self.near[self.len..][..WIDTH].as_mut_ptr();
        let count = write(refs.cast(), near.cast());
        debug_assert!(count <= WIDTH);
        self.len += count;
    }

    #[cfg(test)]
    pub(crate) fn drain(&mut self) -> Vec<(u32, u32)> {
        core::iter::from_fn(|| self.pop()).map(|(child, near)| (child.0, near.to_bits())).collect()
    }
}
