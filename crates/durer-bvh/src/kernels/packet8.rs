//! Packets of eight rays, with AVX2 and FMA.
//!
//! A node's boxes are tested at once against a bound of all eight rays. Then each box that the
//! bound meets is tested against the eight rays at once. So each ray visits what it visits in a
//! single query, to the bit (I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive rendering
//! with coherent ray tracing", Computer Graphics Forum 20(3), 2001; A. Reshetov, A. Soupikov, J.
//! Hurley, "Multi-level ray tracing algorithm", ACM Transactions on Graphics 24(3), 2005).
//!
//! # The bound of eight rays
//!
//! All planes of a tree are at `p` in `[-1, 1]`. Ray `i` meets one at the fused
//! `f_i(p) = p r_i + c_i`. Wanted is a line `g(p) = p r + c` below all of them. As all are
//! straight, it suffices to be below them at both ends. With `a` and `b` the least of the rounded
//! `c_i + r_i` and `c_i - r_i` and `u = 2^-24`, take
//!
//! ```text
//!     r = (a - b) / 2,    c = (a + b) / 2 - s,    s = 4 u (|a| + |b|).
//! ```
//!
//! `r + c` and `c - r` err by `u (|a| + |b|) (1/2 + 1/2 + 1/2)` before `s` is subtracted; `a` and
//! `b` are within `u |a|` and `u |b|` of the values that they are rounded from; and a unit and a
//! half pays for the second order and the rounding of `s`. Rounding is monotone, so the fused
//! `g(p)` is not above the rounded `f_i(p)` either. No underflow matters: `|r_i| >= 1/2`, so
//! `|a| + |b|` is not small. Where boxes are left, the same bound is taken from above. Where
//! `[-1, 1]` does not hold the origins, and these are one, it is the best line there is.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::Rows;
use super::avx2::{Numbers, OUTWARD, SLACK, edges, judge_halves, slabs};
use super::planes::Planes;
use crate::node::{Node, SLOT_BITS, WIDTH};
use crate::ray::{ClippedRay, INSIDE, LONGEST, NEARBY, Packet32, U32};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, Verdict};
use core::arch::x86_64::*;

/// The greatest difference between rays of a packet in each component of their directions, and of
/// their origins in tree units. Rays that differ more would soon diverge.
pub(super) const NEIGHBOURS: f32 = 1.0 / 16.0;

/// A packet of eight rays.
pub(crate) struct Packet {
    /// The bound of all of them.
    pub(super) hull: Hull,
    /// The numbers of each ray for node tests.
    pub(super) r: [__m256; 3],
    pub(super) near: [__m256; 3],
    pub(super) far: [__m256; 3],
    pub(super) t_near: __m256,
    /// The numbers of each ray for triangle tests.
    start: [__m256; 3],
    direction: [__m256; 3],
    t_far: __m256,
    pub(super) octant: usize,
}

/// The bound of a packet: `r` and `c` of near planes, and of far ones; and the least parameter.
pub(super) struct Hull {
    pub(super) enter: ([__m256; 3], [__m256; 3]),
    pub(super) leave: ([__m256; 3], [__m256; 3]),
    pub(super) t_near: __m256,
}

#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn eight(v: &[f32; 8]) -> __m256 {
    // SAFETY: eight f32.
    unsafe { _mm256_loadu_ps(v.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn numbers(v: __m256) -> [f32; 8] {
    let mut numbers = [0.0; 8];
    // SAFETY: eight f32.
    unsafe { _mm256_storeu_ps(numbers.as_mut_ptr(), v) };
    numbers
}

/// The least, or the greatest, element of each of four vectors.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn least_of_each<const GREATEST: bool>(x: [__m256; 4]) -> __m128 {
    let pick = |a: __m256, b: __m256| if GREATEST { _mm256_max_ps(a, b) } else { _mm256_min_ps(a, b) };
    let fold = |a: __m256, b: __m256| pick(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
    let (a, b) = (fold(x[0], x[1]), fold(x[2], x[3]));
    let four = pick(_mm256_shuffle_ps::<0x44>(a, b), _mm256_shuffle_ps::<0xee>(a, b));
    let (a, b) = (_mm256_castps256_ps128(four), _mm256_extractf128_ps::<1>(four));
    if GREATEST { _mm_max_ps(a, b) } else { _mm_min_ps(a, b) }
}

/// `super::avx2::nearby` for eight rays that are exactly known; `None` if one of them is not near
/// the tree, or if they differ too much.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn gather(tree: &Bvh, rays: &Packet32) -> Option<Packet> {
    let minus = _mm256_set1_ps(-0.0);
    let all = |x: f32| _mm256_set1_ps(x);
    let size = |x: __m256| _mm256_andnot_ps(minus, x);
    let shrink = all(tree.clip.shrink32);
    let three = |v: &[[f32; 8]; 3]| [eight(&v[0]), eight(&v[1]), eight(&v[2])];
    let (mut o, d) = (three(&rays.origin), three(&rays.direction));
    let (mut is_close, mut octant) = (_mm256_castsi256_ps(_mm256_set1_epi32(-1)), 0);
    for axis in 0..3 {
        o[axis] = _mm256_mul_ps(o[axis], shrink);
        let signs = _mm256_movemask_ps(d[axis]) & 255;
        if signs != 0 && signs != 255 {
            return None;
        }
        octant |= (signs as usize & 1) << axis;
        let is_nearby = _mm256_cmp_ps::<_CMP_LE_OQ>(size(o[axis]), all(NEARBY));
        // The distance of each ray from the first.
        let aside = |x: __m256| size(_mm256_sub_ps(x, _mm256_broadcastss_ps(_mm256_castps256_ps128(x))));
        let apart = _mm256_max_ps(aside(o[axis]), aside(d[axis]));
        let are_neighbours = _mm256_cmp_ps::<_CMP_LE_OQ>(apart, all(NEIGHBOURS));
        is_close = _mm256_and_ps(is_close, _mm256_and_ps(is_nearby, are_neighbours));
    }
    let (first, last) =
        (_mm256_mul_ps(eight(&rays.t_min), shrink), _mm256_mul_ps(eight(&rays.t_max), shrink));
    // Minima and maxima ignore a NaN; so it is excluded here.
    is_close = _mm256_and_ps(is_close, _mm256_cmp_ps::<_CMP_ORD_Q>(first, last));
    if _mm256_movemask_ps(is_close) & 255 != 255 {
        return None;
    }
    let (mut r, mut near, mut far) = (o, o, o);
    for axis in 0..3 {
        let most = all(tree.clip.most32[axis]);
        let (o, d) = (o[axis], d[axis]);
        let sign = _mm256_and_ps(minus, d);
        let least = _mm256_mul_ps(_mm256_add_ps(most, size(o)), all(0.05 * U32 as f32));
        r[axis] = _mm256_div_ps(all(1.0), _mm256_or_ps(sign, _mm256_max_ps(size(d), least)));
        let slack =
            _mm256_fmadd_ps(most, all(SLACK.0), _mm256_fmadd_ps(size(o), all(SLACK.1), _mm256_setzero_ps()));
        let slack = _mm256_mul_ps(size(r[axis]), slack);
        let base = _mm256_mul_ps(o, r[axis]);
        near[axis] = _mm256_sub_ps(_mm256_sub_ps(_mm256_setzero_ps(), base), slack);
        far[axis] = _mm256_sub_ps(slack, base);
    }
    let t_near = _mm256_fnmadd_ps(size(first), all(OUTWARD), first);
    let t_far = _mm256_fmadd_ps(size(last), all(OUTWARD), last);
    let ends = |c: &[__m256; 3], r: &[__m256; 3], fourth: __m256| {
        (
            [_mm256_add_ps(c[0], r[0]), _mm256_add_ps(c[1], r[1]), _mm256_add_ps(c[2], r[2]), fourth],
            [_mm256_sub_ps(c[0], r[0]), _mm256_sub_ps(c[1], r[1]), _mm256_sub_ps(c[2], r[2]), fourth],
        )
    };
    let line = |a: __m128, b: __m128, outward: f32| {
        let half = _mm_set1_ps(0.5);
        let size = |x: __m128| _mm_andnot_ps(_mm_set1_ps(-0.0), x);
        let sizes = _mm_add_ps(size(a), size(b));
        let middle = _mm_mul_ps(_mm_add_ps(a, b), half);
        (_mm_mul_ps(_mm_sub_ps(a, b), half), _mm_add_ps(middle, _mm_mul_ps(sizes, _mm_set1_ps(outward))))
    };
    const FOUR: f32 = 4.0 * U32 as f32;
    let (a, b) = ends(&near, &r, t_near);
    let (a, b) = (least_of_each::<false>(a), least_of_each::<false>(b));
    let enter = line(a, b, -FOUR);
    let t_first = _mm_cvtss_f32(_mm_shuffle_ps::<3>(a, a));
    let (a, b) = ends(&far, &r, t_far);
    let leave = line(least_of_each::<true>(a), least_of_each::<true>(b), FOUR);
    let spread = |x: __m128| {
        let x = _mm256_set_m128(x, x);
        [_mm256_permute_ps::<0x00>(x), _mm256_permute_ps::<0x55>(x), _mm256_permute_ps::<0xaa>(x)]
    };
    let hull = Hull {
        enter: (spread(enter.0), spread(enter.1)),
        leave: (spread(leave.0), spread(leave.1)),
        t_near: _mm256_set1_ps(t_first),
    };
    Some(Packet { hull, r, near, far, t_near, start: o, direction: d, t_far, octant })
}

/// Permutes a mask of slots into the order of an octant.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn ordered(node: &Node, mask: u32, octant: usize) -> u32 {
    let shift = _mm_cvtsi32_si128((SLOT_BITS as usize * octant) as i32);
    let mut places = 0;
    for half in 0..WIDTH / 8 {
        // SAFETY: eight u32 of sixteen, aligned to 32 bytes in a node aligned to 64.
        let order = unsafe { _mm256_load_si256(node.order.as_ptr().add(8 * half).cast()) };
        let slot = _mm256_and_si256(_mm256_srl_epi32(order, shift), _mm256_set1_epi32(WIDTH as i32 - 1));
        let bit = _mm256_slli_epi32::<31>(_mm256_srlv_epi32(_mm256_set1_epi32(mask as i32), slot));
        places |= (_mm256_movemask_ps(_mm256_castsi256_ps(bit)) as u32 & 255) << (8 * half);
    }
    places
}

/// Pushes the children of a node that one of the `awake` rays meets: those whose entry into the
/// node is not behind their limit.
///
/// The bound's `far` is not below any of `t_far`.
#[inline]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn descend<const ORDERED: bool>(
    node: &Node,
    packet: &Packet,
    row: &[f32; 8],
    (t_far, far): (&[f32; 8], f32),
    rows: &mut Rows<8>,
) {
    let planes = Planes::of(packet.octant);
    let (near_plane, far_plane) = (planes.near(), planes.far());
    let mut left = 0;
    for half in 0..WIDTH / 8 {
        let (near, far) = packet.slabs(node, half, far);
        let met = _mm256_cmp_ps::<_CMP_LE_OQ>(near, far);
        left |= (_mm256_movemask_ps(met) as u32 & 255) << (8 * half);
    }
    if ORDERED {
        left = ordered(node, left, packet.octant);
    }
    let t_far = eight(t_far);
    let awake = _mm256_cmp_ps::<_CMP_LE_OQ>(eight(row), t_far);
    let nothing = _mm256_set1_ps(f32::NAN);
    while left != 0 {
        let at = left.trailing_zeros() as usize % WIDTH;
        left &= left - 1;
        let slot = if ORDERED {
            (node.order[at] >> (SLOT_BITS as usize * packet.octant)) as usize % WIDTH
        } else {
            at
        };
        let plane = |begins: usize, axis: usize, c: &[__m256; 3]| {
            let plane = _mm256_set1_ps(node.planes[Planes::row(begins)][slot]);
            _mm256_fmadd_ps(plane, packet.r[axis], c[axis])
        };
        let (ex, ey, ez) = (
            plane(near_plane[0], 0, &packet.near),
            plane(near_plane[1], 1, &packet.near),
            plane(near_plane[2], 2, &packet.near),
        );
        let (lx, ly, lz) = (
            plane(far_plane[0], 0, &packet.far),
            plane(far_plane[1], 1, &packet.far),
            plane(far_plane[2], 2, &packet.far),
        );
        let near = _mm256_max_ps(_mm256_max_ps(ex, ey), _mm256_max_ps(ez, packet.t_near));
        let far = _mm256_min_ps(_mm256_min_ps(lx, ly), _mm256_min_ps(lz, t_far));
        let met = _mm256_and_ps(awake, _mm256_cmp_ps::<_CMP_LE_OQ>(near, far));
        let is_met = _mm256_movemask_ps(met) != 0;
        rows.push_if(is_met, node.child[slot], numbers(_mm256_blendv_ps(nothing, near, met)));
    }
}

/// The mask of rays whose entry is not behind their limit.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn awake(row: &[f32; 8], t_far: &[f32; 8]) -> u32 {
    _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(eight(row), eight(t_far))) as u32 & 255
}

impl Packet {
    /// The parameters at which the bound of the rays enters and leaves a node's boxes.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn slabs(&self, node: &Node, half: usize, far: f32) -> (__m256, __m256) {
        let (planes, hull) = (Planes::of(self.octant), &self.hull);
        slabs(
            (node, half),
            &planes,
            [(&hull.enter.0, &hull.enter.1), (&hull.leave.0, &hull.leave.1)],
            hull.t_near,
            far,
        )
    }

    /// The greatest parameter of each ray.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn ends(&self) -> [f32; 8] {
        numbers(self.t_far)
    }

    /// One of the rays.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn numbers(&self, ray: usize) -> Numbers {
        let one = |x: &__m256| numbers(*x)[ray & 7];
        let three = |x: &[__m256; 3]| _mm_setr_ps(one(&x[0]), one(&x[1]), one(&x[2]), 0.0);
        Numbers::new(three(&self.r), three(&self.near), three(&self.far), self.octant, one(&self.t_near))
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn way(&self, tree: &Bvh, ray: usize) -> ClippedRay {
        let one = |x: &__m256| numbers(*x)[ray & 7];
        let three = |x: &[__m256; 3]| [one(&x[0]), one(&x[1]), one(&x[2]), 0.0];
        ClippedRay {
            start: three(&self.start),
            direction: three(&self.direction),
            t_near: one(&self.t_near),
            t_far: one(&self.t_far),
            is_exact: true,
            error: 0.0,
            t_enter: 0.0,
            units: tree.frame.units(),
        }
    }
}

/// The `Filter`s of eight rays, member by member.
pub(crate) struct Filters {
    pub(super) o: [[f32; 8]; 3],
    pub(super) d: [[f32; 8]; 3],
    pub(super) a: [f32; 8],
    pub(super) b: [f32; 8],
    pub(super) g: [f32; 8],
    pub(super) p: [f32; 8],
    pub(super) t_near: [f32; 8],
    pub(super) first: [f32; 8],
    pub(super) last: [f32; 8],
}

impl Packet {
    /// `Filter::of_exact`.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn filters(&self, rounded: bool) -> Filters {
        let all = |x: f32| _mm256_set1_ps(x);
        let size = |x: __m256| _mm256_andnot_ps(all(-0.0), x);
        let most = |v: &[__m256; 3]| _mm256_max_ps(_mm256_max_ps(size(v[0]), size(v[1])), size(v[2]));
        let w = Filter::of_corners(rounded);
        let (o, m) = (most(&self.start), most(&self.direction));
        let c = _mm256_add_ps(all(1.0), o);
        let b = _mm256_mul_ps(all(Filter::B), m);
        let step = |x: __m256| _mm256_fmadd_ps(size(x), all(INSIDE.0), all(INSIDE.1));
        let last = _mm256_min_ps(all(LONGEST as f32), self.t_far);
        let three = |x: &[__m256; 3]| [numbers(x[0]), numbers(x[1]), numbers(x[2])];
        Filters {
            o: three(&self.start),
            d: three(&self.direction),
            a: numbers(_mm256_mul_ps(_mm256_fmadd_ps(all(Filter::A), c, all(Filter::ROUNDED_A * w)), m)),
            b: numbers(b),
            g: numbers(_mm256_mul_ps(_mm256_mul_ps(all(w), c), _mm256_mul_ps(all(12.0), b))),
            p: numbers(_mm256_fmadd_ps(all(Filter::P), o, all(Filter::ROUNDED_P * w))),
            t_near: numbers(self.t_near),
            first: numbers(_mm256_add_ps(self.t_near, step(self.t_near))),
            last: numbers(_mm256_sub_ps(last, step(last))),
        }
    }
}

impl Filters {
    #[inline(always)]
    pub(super) fn one(&self, ray: usize) -> Filter {
        let ray = ray & 7;
        Filter {
            o: [self.o[0][ray], self.o[1][ray], self.o[2][ray], 0.0],
            d: [self.d[0][ray], self.d[1][ray], self.d[2][ray], 0.0],
            a: self.a[ray],
            b: self.b[ray],
            g: self.g[ray],
            flat: 2.0 * self.b[ray],
            p: self.p[ray],
            q: 4.0 * self.b[ray],
            s: Filter::S,
            t_near: self.t_near[ray],
            first: self.first[ray],
            last: self.last[ray],
        }
    }
}

/// `super::avx2::judge` for each ray that is awake.
#[inline]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn judge(
    block: &Block,
    filters: &Filters,
    mut awake: u32,
    t_far: &[f32; 8],
    verdicts: &mut [Verdict; 8],
) -> u32 {
    let edges = [edges(block, 0), edges(block, 1)];
    let mut alive = 0;
    while awake != 0 {
        let ray = awake.trailing_zeros() as usize & 7;
        awake &= awake - 1;
        let (filter, verdict) = (filters.one(ray), &mut verdicts[ray]);
        let is_any = judge_halves(&edges, &filter, t_far[ray], verdict) != 0;
        alive |= u32::from(is_any) << ray;
    }
    alive
}
