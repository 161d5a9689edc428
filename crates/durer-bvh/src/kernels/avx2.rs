//! Eight lanes at once with AVX2 and FMA.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::{Kernel, Stack};
use crate::node::{Node8, WIDTH};
use crate::ray::CullRay;
use core::arch::x86_64::*;
use durer_math::Isa;
use durer_math::kernels::Path;

/// Proof that this CPU has AVX2, FMA and POPCNT.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// What an [`Isa`] proves.
    #[inline(always)]
    pub(crate) fn of(isa: Isa) -> Option<Self> {
        matches!(isa.path(), Path::Avx2 | Path::Avx512).then_some(Self(()))
    }
}

/// The ray in all lanes.
pub(crate) struct Lanes {
    r: [__m256; 3],
    near: [__m256; 3],
    far: [__m256; 3],
    /// Which of a node's six plane arrays is the near one of each axis; the far one is three off.
    near_plane: [usize; 3],
    far_plane: [usize; 3],
    octant_shift: u32,
}

/// For each set of lanes the lanes in it, in order, one per byte: what `vpcompressd` does, from a table.
static COMPRESS: [u64; 256] = {
    let mut table = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut filled) = (0, 0);
        while lane < WIDTH as u64 {
            if mask >> lane & 1 == 1 {
                table[mask] |= lane << (8 * filled);
                filled += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

impl Kernel for Avx2 {
    type Lanes = Lanes;

    #[inline(always)]
    fn lanes(self, ray: &CullRay) -> Lanes {
        // SAFETY: `self` exists, so an `Isa` has seen AVX2 and FMA on this CPU.
        unsafe { lanes(ray) }
    }

    #[inline(always)]
    fn push_ordered(self, node: &Node8, lanes: &Lanes, t_far: f32, stack: &mut Stack) {
        // SAFETY: `self` exists, so an `Isa` has seen AVX2, FMA and POPCNT on this CPU.
        unsafe { push::<true>(node, lanes, t_far, stack) }
    }

    #[inline(always)]
    fn push_unordered(self, node: &Node8, lanes: &Lanes, t_far: f32, stack: &mut Stack) {
        // SAFETY: as above.
        unsafe { push::<false>(node, lanes, t_far, stack) }
    }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn lanes(ray: &CullRay) -> Lanes {
    let near_plane = [0, 1, 2].map(|i| i + 3 * (ray.octant as usize >> i & 1));
    Lanes {
        r: [_mm256_set1_ps(ray.r[0]), _mm256_set1_ps(ray.r[1]), _mm256_set1_ps(ray.r[2])],
        near: [_mm256_set1_ps(ray.near[0]), _mm256_set1_ps(ray.near[1]), _mm256_set1_ps(ray.near[2])],
        far: [_mm256_set1_ps(ray.far[0]), _mm256_set1_ps(ray.far[1]), _mm256_set1_ps(ray.far[2])],
        near_plane,
        far_plane: near_plane.map(|i| if i < 3 { i + 3 } else { i - 3 }),
        octant_shift: 3 * ray.octant,
    }
}

/// Six fused multiply-adds, six minima and maxima; then a permutation that sorts and one that closes the gaps, in
/// place of a branch per child.
#[inline]
#[target_feature(enable = "avx2,fma,popcnt")]
fn push<const ORDERED: bool>(node: &Node8, lanes: &Lanes, t_far: f32, stack: &mut Stack) {
    let plane = |i: usize, axis: usize, c: &[__m256; 3]| {
        // SAFETY: `i < 6` by construction of `near_plane` and `far_plane`, and a row holds eight f32, aligned to 32 bytes in a node
        // aligned to 64.
        let planes = unsafe { _mm256_load_ps(node.planes.get_unchecked(i).as_ptr()) };
        _mm256_fmadd_ps(planes, lanes.r[axis], c[axis])
    };
    let [nx, ny, nz] = lanes.near_plane;
    let [fx, fy, fz] = lanes.far_plane;
    let (ex, ey, ez) = (plane(nx, 0, &lanes.near), plane(ny, 1, &lanes.near), plane(nz, 2, &lanes.near));
    let (lx, ly, lz) = (plane(fx, 0, &lanes.far), plane(fy, 1, &lanes.far), plane(fz, 2, &lanes.far));
    let near = _mm256_max_ps(_mm256_max_ps(ex, ey), _mm256_max_ps(ez, _mm256_setzero_ps()));
    let far = _mm256_min_ps(_mm256_min_ps(lx, ly), _mm256_min_ps(lz, _mm256_set1_ps(t_far)));
    let met = _mm256_cmp_ps::<_CMP_LE_OQ>(near, far);
    // SAFETY: both arrays hold eight u32, aligned to 32 bytes in a node aligned to 64.
    let (child, order) = unsafe {
        (_mm256_load_si256(node.child.as_ptr().cast()), _mm256_load_si256(node.order.as_ptr().cast()))
    };
    let mut mask = _mm256_movemask_ps(met) as usize;
    let (near, child) = if ORDERED {
        // Only the low three bits of each index count.
        let order = _mm256_srl_epi32(order, _mm_cvtsi32_si128(lanes.octant_shift as i32));
        mask = _mm256_movemask_ps(_mm256_permutevar8x32_ps(met, order)) as usize;
        (_mm256_permutevar8x32_ps(near, order), _mm256_permutevar8x32_epi32(child, order))
    } else {
        (near, child)
    };
    let close = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(COMPRESS[mask & 255] as i64));
    let near = _mm256_permutevar8x32_ps(near, close);
    let child = _mm256_permutevar8x32_epi32(child, close);
    // SAFETY: eight elements are written to each, through pointers to eight; at most eight are counted.
    unsafe {
        stack.push_lanes(
            #[inline(always)]
            |refs, distances| {
                _mm256_storeu_si256(refs.cast(), child);
                _mm256_storeu_ps(distances, near);
                mask.count_ones() as usize
            },
        );
    }
}
