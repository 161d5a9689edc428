//! The traversal's stacks, for single rays and for packets: two arrays each that are never cleared.
#![expect(unsafe_code, reason = "a stack that is written before it is read needs no clearing, 2 KB per ray")]

use crate::node::{ChildRef, WIDTH};
use core::mem::MaybeUninit;

/// The greatest depth of a tree.
pub(crate) const MAX_DEPTH: usize = 40;

/// On each level at most fifteen siblings wait while the sixteenth is visited; one push writes
/// sixteen lanes; and the bottom element marks the end.
const CAPACITY: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH + 1;

/// The children to visit, with the parameter at which the ray enters each; at the bottom
/// [`ChildRef::END`].
pub(crate) struct Stack {
    refs: [MaybeUninit<u32>; CAPACITY],
    near: [MaybeUninit<f32>; CAPACITY],
    staged: Staged,
    /// All elements below this have been written. At most `CAPACITY`; 0 once the end was popped.
    len: usize,
}

/// The top of the stack in the last word of a cache line, and all children of a node in the next
/// line: a store across the border of two lines delays a load of one of its words that follows at
/// once.
#[repr(align(64))]
struct Staged([MaybeUninit<u32>; 2 * WIDTH]);

impl Stack {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let mut stack = Self {
            refs: [const { MaybeUninit::uninit() }; CAPACITY],
            near: [const { MaybeUninit::uninit() }; CAPACITY],
            staged: Staged([const { MaybeUninit::uninit() }; 2 * WIDTH]),
            len: 0,
        };
        stack.clear();
        stack
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.refs[0].write(ChildRef::END.0);
        self.near[0].write(f32::NEG_INFINITY);
        self.len = 1;
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, child: ChildRef, near: f32) {
        assert!(self.len < CAPACITY, "the builder bounds the depth");
        self.refs[self.len].write(child.0);
        self.near[self.len].write(near);
        self.len += 1;
    }

    /// Pops the last child, or the end. Must not be called again after the end.
    #[inline(always)]
    pub(crate) fn pop(&mut self) -> ChildRef {
        assert!(self.len > 0, "the end is taken once");
        self.len -= 1;
        // SAFETY: the element was below the length, so it has been written; a u32 is plain data.
        ChildRef(unsafe { self.refs[self.len].assume_init() })
    }

    /// Removes the children that the ray enters later than this; the others keep their order.
    /// Without branches, which would be unpredictable.
    pub(crate) fn prune(&mut self, t_far: f32) {
        let mut kept = 0;
        for i in 0..self.len {
            // SAFETY: both elements are below the length, so they have been written; plain data.
            let (child, near) = unsafe { (self.refs[i].assume_init(), self.near[i].assume_init()) };
            self.refs[kept].write(child);
            self.near[kept].write(near);
            kept += usize::from(near <= t_far);
        }
        self.len = kept;
    }

    /// Pushes the children of a node that are met and pops the last of them, or the old top if none
    /// is met. `stage` writes all sixteen children; `push` writes the `count` that are met, without
    /// gaps. `last` is one more than the index of the last of them among the sixteen, 0 if there is
    /// none.
    ///
    /// # Safety
    ///
    /// Both functions get pointers to sixteen elements; those of `stage` are aligned to 64 bytes.
    /// `stage` must write all of them; `push` must write at least `count` of each, at most sixteen;
    /// `count` is at most sixteen, and so is `last`.
    #[inline(always)]
    pub(crate) unsafe fn exchange(
        &mut self,
        last: usize,
        count: usize,
        stage: impl FnOnce(*mut u32),
        push: impl FnOnce(*mut u32, *mut f32),
    ) -> ChildRef {
        // One comparison for both ends: the stack is not empty, and there is room.
        assert!(self.len.wrapping_sub(1) < CAPACITY - WIDTH, "the builder bounds the depth");
        debug_assert!(count <= WIDTH && last <= WIDTH);
        // SAFETY: `1 <= len <= CAPACITY - 16`, so sixteen elements from `len` on are in the arrays,
        // and so is the one before them. The staging array has sixteen words before the sixteen
        // that `stage` writes.
        unsafe {
            let refs = self.refs.as_mut_ptr().add(self.len).cast::<u32>();
            let near = self.near.as_mut_ptr().add(self.len).cast::<f32>();
            let staged = self.staged.0.as_mut_ptr().add(WIDTH).cast::<u32>();
            // This element has been written, as it is below the length.
            staged.sub(1).write(refs.sub(1).read());
            stage(staged);
            let next = staged.sub(1).add(last).read();
            push(refs, near);
            self.len = self.len + count - 1;
            ChildRef(next)
        }
    }

    #[cfg(test)]
    pub(crate) fn drain(&mut self) -> Vec<(u32, u32)> {
        // SAFETY: both elements are below the length, so they have been written; plain data.
        let one = |i: usize| unsafe { (self.refs[i].assume_init(), self.near[i].assume_init().to_bits()) };
        (0..self.len).map(one).collect()
    }
}

/// The stack of a packet: the children to visit, with the parameter at which each ray enters them,
/// NaN where it does not.
pub(crate) struct Rows<const N: usize> {
    refs: [MaybeUninit<u32>; CAPACITY],
    near: [MaybeUninit<[f32; N]>; CAPACITY],
    /// All elements below this have been written. At most `CAPACITY`.
    len: usize,
}

impl<const N: usize> Rows<N> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self {
            refs: [const { MaybeUninit::uninit() }; CAPACITY],
            near: [const { MaybeUninit::uninit() }; CAPACITY],
            len: 0,
        }
    }

    #[inline(always)]
    pub(crate) fn push_if(&mut self, wanted: bool, child: ChildRef, near: [f32; N]) {
        assert!(self.len < CAPACITY, "the builder bounds the depth");
        self.refs[self.len].write(child.0);
        self.near[self.len].write(near);
        self.len += usize::from(wanted);
    }

    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// A child on the stack.
    #[inline(always)]
    pub(crate) fn child(&self, at: usize) -> ChildRef {
        assert!(at < self.len);
        // SAFETY: the element is below the length, so it has been written; a u32 is plain data.
        ChildRef(unsafe { self.refs[at].assume_init() })
    }

    #[inline(always)]
    pub(crate) fn pop(&mut self) -> Option<(ChildRef, [f32; N])> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: the element was below the length, so it has been written; both are plain data.
        Some(unsafe { (ChildRef(self.refs[self.len].assume_init()), self.near[self.len].assume_init()) })
    }

    #[cfg(test)]
    pub(crate) fn drain(&mut self) -> Vec<(u32, [f32; N])> {
        core::iter::from_fn(|| self.pop()).map(|(child, near)| (child.0, near)).collect()
    }
}
