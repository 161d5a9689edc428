//! Packets of sixteen rays, with AVX-512: one box against all of them is one step, as it is for
//! eight (see [`packet8`](super::packet8), where the bounds of a packet are derived; they hold for
//! any number of rays).
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::avx2::{Numbers, OUTWARD, SLACK};
use super::avx512::{Rest, Three, earliest, edges, judge_edges, latest, planes_of, slabs};
use super::packet8::{NEIGHBOURS, eight, least_of_each};
use super::planes::Planes;
use super::{Avx512, Rows, Together};
use crate::node::{Node, SLOT_BITS, WIDTH};
use crate::ray::{ClippedRay, INSIDE, LONGEST, NEARBY, Packet32, TWICE, U32};
use crate::tree::Bvh;
use crate::triangles::{Block, FLAT, Filter, NEAR, Verdict};
use core::arch::x86_64::*;

/// A packet of sixteen rays.
pub(crate) struct Sixteen {
    /// `r` and `c` of near planes that bound all of the rays, and of far planes; and the least
    /// parameter.
    enter: (Three, Three),
    leave: (Three, Three),
    t_first: __m512,
    /// The numbers of each ray for node tests.
    r: Three,
    near: Three,
    far: Three,
    t_near: __m512,
    /// The numbers of each ray for triangle tests.
    start: Three,
    direction: Three,
    t_far: __m512,
    octant: usize,
}

/// The `Filter`s of sixteen rays, member by member.
pub(crate) struct Filters {
    o: [[f32; 16]; 3],
    d: [[f32; 16]; 3],
    a: __m512,
    b: __m512,
    g: __m512,
    p: __m512,
    t_near: [f32; 16],
    first: [f32; 16],
    last: [f32; 16],
}

#[inline]
#[target_feature(enable = "avx512f")]
fn sixteen(v: &[f32; 16]) -> __m512 {
    // SAFETY: sixteen f32.
    unsafe { _mm512_loadu_ps(v.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn numbers(v: __m512) -> [f32; 16] {
    let mut numbers = [0.0; 16];
    // SAFETY: sixteen f32.
    unsafe { _mm512_storeu_ps(numbers.as_mut_ptr(), v) };
    numbers
}

#[inline]
#[target_feature(enable = "avx512f")]
fn all(x: f32) -> __m512 {
    _mm512_set1_ps(x)
}

/// The least, or the greatest, element of each of four vectors.
#[inline]
#[target_feature(enable = "avx512f,avx512dq,avx2,fma")]
fn least<const GREATEST: bool>(x: [__m512; 4]) -> __m128 {
    let half = |x: __m512| {
        let (a, b) = (_mm512_castps512_ps256(x), _mm512_extractf32x8_ps::<1>(x));
        if GREATEST { _mm256_max_ps(a, b) } else { _mm256_min_ps(a, b) }
    };
    least_of_each::<GREATEST>([half(x[0]), half(x[1]), half(x[2]), half(x[3])])
}

/// `super::packet8::gather` for two times eight rays.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
fn gather(tree: &Bvh, [a, b]: [&Packet32; 2]) -> Option<Sixteen> {
    let both =
        |a: &[f32; 8], b: &[f32; 8]| _mm512_insertf32x8::<1>(_mm512_castps256_ps512(eight(a)), eight(b));
    let three =
        |a: &[[f32; 8]; 3], b: &[[f32; 8]; 3]| [both(&a[0], &b[0]), both(&a[1], &b[1]), both(&a[2], &b[2])];
    let size = |x: __m512| _mm512_abs_ps(x);
    let shrink = all(tree.clip.shrink32);
    let (mut o, d) = (three(&a.origin, &b.origin), three(&a.direction, &b.direction));
    let (mut is_close, mut octant) = (u16::MAX, 0);
    for axis in 0..3 {
        o[axis] = _mm512_mul_ps(o[axis], shrink);
        let signs = _mm512_movepi32_mask(_mm512_castps_si512(d[axis]));
        if signs != 0 && signs != u16::MAX {
            return None;
        }
        octant |= usize::from(signs & 1) << axis;
        is_close &= _mm512_cmp_ps_mask::<_CMP_LE_OQ>(size(o[axis]), all(NEARBY));
        // The distance of each ray from the first.
        let aside = |x: __m512| size(_mm512_sub_ps(x, _mm512_broadcastss_ps(_mm512_castps512_ps128(x))));
        let apart = _mm512_max_ps(aside(o[axis]), aside(d[axis]));
        is_close &= _mm512_cmp_ps_mask::<_CMP_LE_OQ>(apart, all(NEIGHBOURS));
    }
    let first = _mm512_mul_ps(both(&a.t_min, &b.t_min), shrink);
    let last = _mm512_mul_ps(both(&a.t_max, &b.t_max), shrink);
    // Minima and maxima ignore a NaN; so it is excluded here.
    is_close &= _mm512_cmp_ps_mask::<_CMP_ORD_Q>(first, last);
    if is_close != u16::MAX {
        return None;
    }
    let (mut r, mut near, mut far) = (o, o, o);
    for axis in 0..3 {
        let most = all(tree.clip.most32[axis]);
        let (o, d) = (o[axis], d[axis]);
        let sign = _mm512_and_ps(all(-0.0), d);
        let least = _mm512_mul_ps(_mm512_add_ps(most, size(o)), all(0.05 * U32 as f32));
        r[axis] = _mm512_div_ps(all(1.0), _mm512_or_ps(sign, _mm512_max_ps(size(d), least)));
        let slack = _mm512_fmadd_ps(most, all(SLACK.0), _mm512_fmadd_ps(size(o), all(SLACK.1), all(0.0)));
        let slack = _mm512_mul_ps(size(r[axis]), slack);
        let base = _mm512_mul_ps(o, r[axis]);
        near[axis] = _mm512_sub_ps(_mm512_sub_ps(all(0.0), base), slack);
        far[axis] = _mm512_sub_ps(slack, base);
    }
    let t_near = _mm512_fnmadd_ps(size(first), all(OUTWARD), first);
    let t_far = _mm512_fmadd_ps(size(last), all(OUTWARD), last);
    let ends = |c: &Three, fourth: __m512| {
        (
            [_mm512_add_ps(c[0], r[0]), _mm512_add_ps(c[1], r[1]), _mm512_add_ps(c[2], r[2]), fourth],
            [_mm512_sub_ps(c[0], r[0]), _mm512_sub_ps(c[1], r[1]), _mm512_sub_ps(c[2], r[2]), fourth],
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
    let (a, b) = ends(&near, t_near);
    let (a, b) = (least::<false>(a), least::<false>(b));
    let enter = line(a, b, -FOUR);
    let t_first = _mm512_broadcastss_ps(_mm_shuffle_ps::<3>(a, a));
    let (a, b) = ends(&far, t_far);
    let leave = line(least::<true>(a), least::<true>(b), FOUR);
    let spread = |x: __m128| {
        [
            _mm512_broadcastss_ps(x),
            _mm512_broadcastss_ps(_mm_movehdup_ps(x)),
            _mm512_broadcastss_ps(_mm_movehl_ps(x, x)),
        ]
    };
    Some(Sixteen {
        enter: (spread(enter.0), spread(enter.1)),
        leave: (spread(leave.0), spread(leave.1)),
        t_first,
        r,
        near,
        far,
        t_near,
        start: o,
        direction: d,
        t_far,
        octant,
    })
}

#[inline]
#[target_feature(enable = "avx512f")]
fn awake(row: &[f32; 16], t_far: &[f32; 16]) -> u32 {
    u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(sixteen(row), sixteen(t_far)))
}

/// The packet step of eight rays, for sixteen: one child after the other.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn descend<const ORDERED: bool>(
    node: &Node,
    packet: &Sixteen,
    row: &[f32; 16],
    (t_far, far): (&[f32; 16], f32),
    rows: &mut Rows<TWICE>,
) {
    let (planes, shift) = (Planes::of(packet.octant), SLOT_BITS as usize * packet.octant);
    let (enter, leave) = (&packet.enter, &packet.leave);
    let (mut near, mut leaves) =
        slabs(node, &planes, [(&enter.0, &enter.1), (&leave.0, &leave.1)], packet.t_first, far);
    if ORDERED {
        // SAFETY: sixteen u32, aligned to 64 bytes.
        let order = unsafe { _mm512_load_si512(node.order.as_ptr().cast()) };
        let order = _mm512_srl_epi32(order, _mm_cvtsi32_si128(shift as i32));
        near = _mm512_permutexvar_ps(order, near);
        leaves = _mm512_permutexvar_ps(order, leaves);
    }
    let mut left = u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(near, leaves));
    let t_far = sixteen(t_far);
    let awake = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(sixteen(row), t_far);
    let (near_planes, far_planes) = planes_of(node, &planes);
    while left != 0 {
        let at = left.trailing_zeros() as usize % WIDTH;
        left &= left - 1;
        let slot = if ORDERED { (node.order[at] >> shift) as usize % WIDTH } else { at };
        let lane = _mm512_set1_epi32(slot as i32);
        let pick = |row: __m512| _mm512_permutexvar_ps(lane, row);
        let of_child = |rows: &Three| [pick(rows[0]), pick(rows[1]), pick(rows[2])];
        let near = latest(&of_child(&near_planes), (&packet.r, &packet.near), packet.t_near);
        let far = earliest(&of_child(&far_planes), (&packet.r, &packet.far), t_far);
        let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(awake, near, far);
        let near = _mm512_mask_blend_ps(met, all(f32::NAN), near);
        rows.push_if(met != 0, node.child[slot], numbers(near));
    }
}

/// [`Kernel::judge`](super::Kernel::judge) for each ray that is awake.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn judge(
    block: &Block,
    filters: &Filters,
    mut awake: u32,
    t_far: &[f32; 16],
    verdicts: &mut [Verdict; 16],
) -> u32 {
    let edges = edges(block);
    let extent = all(edges.extent);
    let (a, b, g, p) = (filters.a, filters.b, filters.g, filters.p);
    let slack = _mm512_fmadd_ps(extent, _mm512_fmadd_ps(b, extent, a), g);
    let flat = _mm512_mul_ps(all(2.0), b);
    let certain = _mm512_fmadd_ps(flat, _mm512_mul_ps(extent, extent), all(FLAT));
    // Computed for all rays at once, then broadcast one by one.
    let slacks = numbers(slack);
    let certain = numbers(_mm512_fmadd_ps(all(4.0), slack, certain));
    let nearby = numbers(_mm512_fmadd_ps(all(NEAR), extent, p));
    let q = numbers(_mm512_mul_ps(all(4.0), b));
    let mut alive = 0;
    while awake != 0 {
        let ray = awake.trailing_zeros() as usize % TWICE;
        awake &= awake - 1;
        let of = |v: &[[f32; 16]; 3]| [all(v[0][ray]), all(v[1][ray]), all(v[2][ray])];
        let slack = || slacks[ray];
        let rest = |_| Rest {
            q: q[ray],
            nearby: nearby[ray],
            s: Filter::S,
            certain: certain[ray],
            t_near: filters.t_near[ray],
            t_far: t_far[ray],
            first: filters.first[ray],
            last: filters.last[ray],
        };
        let verdict = &mut verdicts[ray];
        let is_any = judge_edges(&edges, &of(&filters.o), &of(&filters.d), slack, rest, verdict) != 0;
        alive |= u32::from(is_any) << ray;
    }
    alive
}

impl Sixteen {
    /// One of the rays.
    #[inline]
    #[target_feature(enable = "avx512f,avx2,fma")]
    fn numbers(&self, ray: usize) -> Numbers {
        let one = |x: &__m512| numbers(*x)[ray % TWICE];
        let three = |x: &Three| _mm_setr_ps(one(&x[0]), one(&x[1]), one(&x[2]), 0.0);
        Numbers::new(three(&self.r), three(&self.near), three(&self.far), self.octant, one(&self.t_near))
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn way(&self, tree: &Bvh, ray: usize) -> ClippedRay {
        let one = |x: &__m512| numbers(*x)[ray % TWICE];
        let three = |x: &Three| [one(&x[0]), one(&x[1]), one(&x[2]), 0.0];
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

    /// `Filter::of_exact`.
    #[inline]
    #[target_feature(enable = "avx512f,avx512dq")]
    fn filters(&self, rounded: bool) -> Filters {
        let size = |x: __m512| _mm512_abs_ps(x);
        let most = |v: &Three| _mm512_max_ps(_mm512_max_ps(size(v[0]), size(v[1])), size(v[2]));
        let w = Filter::of_corners(rounded);
        let (o, m) = (most(&self.start), most(&self.direction));
        let c = _mm512_add_ps(all(1.0), o);
        let b = _mm512_mul_ps(all(Filter::B), m);
        let step = |x: __m512| _mm512_fmadd_ps(size(x), all(INSIDE.0), all(INSIDE.1));
        let last = _mm512_min_ps(all(LONGEST as f32), self.t_far);
        let three = |x: &Three| [numbers(x[0]), numbers(x[1]), numbers(x[2])];
        Filters {
            o: three(&self.start),
            d: three(&self.direction),
            a: _mm512_mul_ps(_mm512_fmadd_ps(all(Filter::A), c, all(Filter::ROUNDED_A * w)), m),
            b,
            g: _mm512_mul_ps(_mm512_mul_ps(all(w), c), _mm512_mul_ps(all(12.0), b)),
            p: _mm512_fmadd_ps(all(Filter::P), o, all(Filter::ROUNDED_P * w)),
            t_near: numbers(self.t_near),
            first: numbers(_mm512_add_ps(self.t_near, step(self.t_near))),
            last: numbers(_mm512_sub_ps(last, step(last))),
        }
    }
}

impl Together<TWICE> for Avx512 {
    type Packet = Sixteen;
    type Filters = Filters;

    #[inline(always)]
    fn gather(self, tree: &Bvh, rays: &[&Packet32]) -> Option<Sixteen> {
        let &[a, b] = rays else { return None };
        // SAFETY: `self` exists, so an `Isa` has seen all of its features on this CPU.
        unsafe { gather(tree, [a, b]) }
    }

    #[inline(always)]
    fn ends(self, packet: &Sixteen) -> [f32; TWICE] {
        // SAFETY: as above.
        unsafe { numbers(packet.t_far) }
    }

    #[inline(always)]
    fn one(self, tree: &Bvh, packet: &Sixteen, ray: usize) -> (Numbers, ClippedRay) {
        // SAFETY: as above.
        unsafe { (packet.numbers(ray), packet.way(tree, ray)) }
    }

    #[inline(always)]
    fn way(self, tree: &Bvh, packet: &Sixteen, ray: usize) -> ClippedRay {
        // SAFETY: as above.
        unsafe { packet.way(tree, ray) }
    }

    #[inline(always)]
    fn awake(self, row: &[f32; TWICE], t_far: &[f32; TWICE]) -> u32 {
        // SAFETY: as above.
        unsafe { awake(row, t_far) }
    }

    #[inline(always)]
    fn filters(self, tree: &Bvh, packet: &Sixteen) -> Filters {
        // SAFETY: as above.
        unsafe { packet.filters(tree.rounded) }
    }

    #[inline(always)]
    fn judge_together(
        self,
        block: &Block,
        filters: &Filters,
        awake: u32,
        t_far: &[f32; TWICE],
        verdicts: &mut [Verdict; TWICE],
    ) -> u32 {
        // SAFETY: as above.
        unsafe { judge(block, filters, awake, t_far, verdicts) }
    }

    #[inline(always)]
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node,
        packet: &Sixteen,
        row: &[f32; TWICE],
        (t_far, far): (&[f32; TWICE], f32),
        rows: &mut Rows<TWICE>,
    ) {
        // SAFETY: as above.
        unsafe { descend::<ORDERED>(node, packet, row, (t_far, far), rows) }
    }
}
