//! Large arrays in large pages.
//!
//! A ray through millions of triangles reads memory all over the place, and for pages of 4 KiB most
//! of these reads have to look up first where the page is. And what is written once, as a film,
//! costs a call of the system for each page, which takes longer than to write it. Linux backs
//! memory by pages of 2 MiB where it is asked to; elsewhere, and for small arrays, nothing is done.

/// Asks for large pages for all the room that a list has, which should not have been written yet:
/// zeros from the system count as not written.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "advice about a list's own memory, which changes nothing that can be seen")]
pub fn in_large_pages<T>(list: &Vec<T>) {
    use core::ffi::c_void;
    use core::ptr::NonNull;
    use nix::sys::mman::{MmapAdvise, madvise};
    const PAGE: usize = 1 << 21;
    let start = list.as_ptr().cast::<u8>();
    let bytes = list.capacity() * size_of::<T>();
    // The large pages that lie wholly within.
    let before = start.align_offset(PAGE);
    let inside = bytes.saturating_sub(before) / PAGE * PAGE;
    if inside == 0 {
        return;
    }
    let Some(first) = NonNull::new(start.wrapping_add(before).cast_mut().cast::<c_void>()) else { return };
    // SAFETY: the range is part of the list's allocation, and this advice, unlike others, leaves
    // all contents and rights as they are: it only says by which pages they are to be held.
    let advised = unsafe { madvise(first, inside, MmapAdvise::MADV_HUGEPAGE) };
    // A system without large pages goes on without them.
    let _ = advised;
}

/// Asks for nothing: this system is not known to give large pages on demand.
#[cfg(not(target_os = "linux"))]
pub fn in_large_pages<T>(_: &Vec<T>) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_do_not_change() {
        for n in [0, 1, 1000, 3_000_000] {
            let mut list: Vec<u32> = Vec::with_capacity(n);
            in_large_pages(&list);
            list.extend(0..n as u32);
            in_large_pages(&list);
            assert!(list.iter().copied().eq(0..n as u32));
        }
    }
}
