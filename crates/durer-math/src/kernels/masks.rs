//! Eight masks as eight bits.
//!
//! From portable code the compiler makes thirty instructions and more, with shifts and memory;
//! seven are enough (docs/performance.md, "What helped", 5).

use crate::lanes::LANES;

/// Mask `i` as bit `i`; a mask has all bits set or none.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn bits_of_masks(masks: &[u64; LANES]) -> u8 {
    use core::arch::x86_64::{_mm_movemask_epi8, _mm_packs_epi16, _mm_packs_epi32, _mm_set_epi64x};
    let [a, b, c, d, e, f, g, h] = *masks;
    let (a, b, c, d) = (a.cast_signed(), b.cast_signed(), c.cast_signed(), d.cast_signed());
    let (e, f, g, h) = (e.cast_signed(), f.cast_signed(), g.cast_signed(), h.cast_signed());
    // SAFETY: these instructions are part of SSE2, which every x86-64 CPU has, and they touch no
    // memory.
    unsafe {
        // Two masks are four numbers of 32 bits, each -1 or 0, which stay what they are in half the
        // width; so do the masks in those.
        let (ab, cd) = (_mm_set_epi64x(b, a), _mm_set_epi64x(d, c));
        let (ef, gh) = (_mm_set_epi64x(f, e), _mm_set_epi64x(h, g));
        let halves = _mm_packs_epi32(_mm_packs_epi32(ab, cd), _mm_packs_epi32(ef, gh));
        (_mm_movemask_epi8(_mm_packs_epi16(halves, halves)) & 0xff) as u8
    }
}

/// Mask `i` as bit `i`; a mask has all bits set or none.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub(crate) fn bits_of_masks(masks: &[u64; LANES]) -> u8 {
    let mut bits = 0;
    for i in 0..LANES {
        bits |= u8::from(masks[i] != 0) << i;
    }
    bits
}
