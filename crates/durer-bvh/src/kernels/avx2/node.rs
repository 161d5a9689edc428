//! A ray against a node: eight boxes at a time, in two halves.
#![expect(unsafe_code, reason = "vector loads and stores")]

use crate::kernels::Stack;
use crate::kernels::planes::Planes;
use crate::node::{ChildRef, Node, SLOT_BITS};
use crate::ray::CullRay;
use core::arch::x86_64::*;

/// The numbers that a node test needs of a ray.
///
/// The octant is not next to the end of `far`. When it followed `t_near`, the three were read back
/// as one vector, and this load had to wait until the stores before it had reached the cache
/// (single rays took 8 to 20 % longer).
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Numbers {
    octant: usize,
    pub(in crate::kernels) r: [f32; 4],
    pub(in crate::kernels) near: [f32; 4],
    pub(in crate::kernels) far: [f32; 4],
    pub(in crate::kernels) t_near: f32,
}

impl Numbers {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(in crate::kernels) fn new(r: __m128, near: __m128, far: __m128, octant: usize, t_near: f32) -> Self {
        Self { r: stored(r), near: stored(near), far: stored(far), t_near, octant }
    }

    #[inline(always)]
    pub(in crate::kernels) fn of(ray: &CullRay) -> Self {
        Self { r: ray.r, near: ray.near, far: ray.far, t_near: ray.way.t_near, octant: ray.octant as usize }
    }

    #[inline(always)]
    pub(in crate::kernels) fn planes(&self) -> Planes {
        Planes::of(self.octant)
    }

    /// The shift that moves the order for the ray's octant into the low bits.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(in crate::kernels) fn octant_shift(&self) -> __m128i {
        _mm_cvtsi32_si128(SLOT_BITS as i32 * self.octant as i32)
    }
}

#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn stored(x: __m128) -> [f32; 4] {
    let mut stored = [0.0_f32; 4];
    // SAFETY: four f32.
    unsafe { _mm_storeu_ps(stored.as_mut_ptr(), x) };
    stored
}

/// A ray, broadcast to all lanes.
pub(crate) struct Lanes {
    pub(in crate::kernels) r: [__m256; 3],
    pub(in crate::kernels) near: [__m256; 3],
    pub(in crate::kernels) far: [__m256; 3],
    pub(in crate::kernels) t_near: __m256,
    planes: Planes,
    octant_shift: __m128i,
}

/// For each set of lanes its members in order, one per byte: `vpcompressd` by a table.
static COMPRESS: [u64; 256] = {
    let mut table = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut filled) = (0, 0);
        while lane < 8 {
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

impl Lanes {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn of(ray: &Numbers) -> Self {
        let three = |x: &[f32; 4]| [_mm256_set1_ps(x[0]), _mm256_set1_ps(x[1]), _mm256_set1_ps(x[2])];
        Self {
            r: three(&ray.r),
            near: three(&ray.near),
            far: three(&ray.far),
            t_near: _mm256_set1_ps(ray.t_near),
            planes: ray.planes(),
            octant_shift: ray.octant_shift(),
        }
    }

    /// The parameters at which the ray enters and leaves a node's boxes, the latter at most
    /// `t_far`.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(in crate::kernels) fn slabs(&self, node: &Node, half: usize, t_far: f32) -> (__m256, __m256) {
        slabs((node, half), &self.planes, [(&self.r, &self.near), (&self.r, &self.far)], self.t_near, t_far)
    }

    /// The parameters at which the ray enters the boxes, and the mask of boxes that it meets.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn boxes(&self, node: &Node, half: usize, t_far: f32) -> (__m256, __m256) {
        let (near, far) = self.slabs(node, half, t_far);
        (near, _mm256_cmp_ps::<_CMP_LE_OQ>(near, far))
    }
}

/// The parameters at which half of a node's boxes are entered and left, the latter at most `t_far`.
/// A plane `x` is met at `x r + c`, with one `r` and `c` for near planes and one for far ones. Six
/// fused multiply-adds, six minima and maxima.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(in crate::kernels) fn slabs(
    (node, half): (&Node, usize),
    planes: &Planes,
    [enter, leave]: [(&[__m256; 3], &[__m256; 3]); 2],
    t_near: __m256,
    t_far: f32,
) -> (__m256, __m256) {
    let plane = |begins: usize, axis: usize, (r, c): (&[__m256; 3], &[__m256; 3])| {
        // SAFETY: one of six rows begins there, and half a row holds eight f32, 32 bytes, aligned
        // to as many in a node aligned to 64.
        let planes =
            unsafe { _mm256_load_ps(node.planes.as_ptr().cast::<f32>().byte_add(begins + 32 * (half & 1))) };
        _mm256_fmadd_ps(planes, r[axis], c[axis])
    };
    let ([nx, ny, nz], [fx, fy, fz]) = (planes.near(), planes.far());
    let (ex, ey, ez) = (plane(nx, 0, enter), plane(ny, 1, enter), plane(nz, 2, enter));
    let (lx, ly, lz) = (plane(fx, 0, leave), plane(fy, 1, leave), plane(fz, 2, leave));
    let near = _mm256_max_ps(_mm256_max_ps(ex, ey), _mm256_max_ps(ez, t_near));
    let far = _mm256_min_ps(_mm256_min_ps(lx, ly), _mm256_min_ps(lz, _mm256_set1_ps(t_far)));
    (near, far)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn meets(node: &Node, slot: usize, lanes: &Lanes, t_far: f32) -> bool {
    let (_, met) = lanes.boxes(node, slot / 8, t_far);
    _mm256_movemask_ps(met) >> (slot % 8) & 1 != 0
}

/// One half of a permutation of sixteen elements by `places`, of which the low four bits count.
#[inline]
#[target_feature(enable = "avx2")]
fn placed(places: __m256i, [low, high]: [__m256; 2]) -> __m256 {
    let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(places));
    let (low, high) = (_mm256_permutevar8x32_ps(low, places), _mm256_permutevar8x32_ps(high, places));
    _mm256_blendv_ps(low, high, is_high)
}

/// Pushes the children that the ray meets. One permutation sorts the children by the ray's octant
/// (if `ORDERED`), another compacts those that are met, in place of a branch per child. In two
/// halves.
///
/// The latency to the next child is as short as possible: all sixteen are written to a staging
/// array while the boxes are still being tested, and the highest bit of the mask selects which to
/// read; if no bit is set, the old top of the stack is read.
#[inline]
#[target_feature(enable = "avx2,fma,popcnt,lzcnt")]
pub(super) fn descend<const ORDERED: bool>(
    node: &Node,
    lanes: &Lanes,
    t_far: f32,
    stack: &mut Stack,
) -> ChildRef {
    let ((near0, met0), (near1, met1)) = (lanes.boxes(node, 0, t_far), lanes.boxes(node, 1, t_far));
    // SAFETY: both arrays hold sixteen u32, aligned to 64 bytes.
    let eight = |words: *const u32, half: usize| unsafe { _mm256_load_si256(words.add(8 * half).cast()) };
    let child = |half: usize| _mm256_castsi256_ps(eight(node.child.as_ptr().cast(), half));
    let (mut near, mut met, mut child) = ([near0, near1], [met0, met1], [child(0), child(1)]);
    if ORDERED {
        // Only the low four bits of each place count.
        let order = |half: usize| _mm256_srl_epi32(eight(node.order.as_ptr(), half), lanes.octant_shift);
        let (a, b) = (order(0), order(1));
        near = [placed(a, near), placed(b, near)];
        met = [placed(a, met), placed(b, met)];
        child = [placed(a, child), placed(b, child)];
    }
    let half = |met: __m256| _mm256_movemask_ps(met) as u32 & 255;
    let (low, high) = (half(met[0]), half(met[1]));
    let mask = low | high << 8;
    let close = |mask: u32| _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(COMPRESS[mask as usize] as i64));
    let (close0, close1) = (close(low), close(high));
    // SAFETY: sixteen elements are written to each, or as many as a mask of sixteen bits has and at
    // most eight more, through pointers to sixteen: the first of the second half go where the first
    // half ends, after at most eight.
    unsafe {
        stack.exchange(
            (32 - mask.leading_zeros()) as usize,
            mask.count_ones() as usize,
            #[inline(always)]
            |refs| {
                _mm256_store_ps(refs.cast(), child[0]);
                _mm256_store_ps(refs.add(8).cast(), child[1]);
            },
            #[inline(always)]
            |refs, distances| {
                let ends = low.count_ones() as usize;
                _mm256_storeu_ps(refs.cast(), _mm256_permutevar8x32_ps(child[0], close0));
                _mm256_storeu_ps(refs.add(ends).cast(), _mm256_permutevar8x32_ps(child[1], close1));
                _mm256_storeu_ps(distances, _mm256_permutevar8x32_ps(near[0], close0));
                _mm256_storeu_ps(distances.add(ends), _mm256_permutevar8x32_ps(near[1], close1));
            },
        )
    }
}
