//! Eight lanes at once with AVX-512, and sixteen where two children or two rays are asked side by side.
//!
//! Comparisons give masks in registers of their own, and such a mask closes gaps by itself. Rays are made ready as with AVX2, whose vectors serve here, too.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::avx2::{Lanes, PLANES};
use super::packet::{Filters, Packet, eight, numbers};
use super::{Avx2, Kernel, Rows, Stack};
use crate::node::{ChildRef, Node8};
use crate::ray::{Glances, PACKET, Sight, Way};
use crate::tree::Bvh;
use crate::triangles::{Block, FAR, FLAT, Filter, NEAR, Verdict};
use core::arch::x86_64::*;
use durer_math::Isa;
use durer_math::kernels::Path;

/// Proof that this CPU has all that [`Path::Avx512`] asks for: AVX-512 F, VL, DQ and BW, and what [`Avx2`] proves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(Avx2);

impl Avx512 {
    /// What an [`Isa`] proves.
    #[inline(always)]
    pub(crate) fn of(isa: Isa) -> Option<Self> {
        if isa.path() == Path::Avx512 { Avx2::of(isa).map(Self) } else { None }
    }
}

impl Kernel for Avx512 {
    type Lanes = Lanes;
    type Packet = Packet;
    type Filters = Filters;

    #[inline(always)]
    fn nearby(self, tree: &Bvh, sight: &impl Sight) -> Option<(Lanes, Way)> {
        self.0.nearby(tree, sight)
    }

    #[inline(always)]
    fn afar(self, tree: &Bvh, sight: &impl Sight) -> Option<(Lanes, Way)> {
        self.0.afar(tree, sight)
    }

    #[inline(always)]
    fn descend<const ORDERED: bool>(
        self,
        node: &Node8,
        lanes: &Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef {
        // SAFETY: `self` exists, so an `Isa` has seen all of its features on this CPU.
        unsafe { descend::<ORDERED>(node, lanes, t_far, stack) }
    }

    #[inline(always)]
    fn meets(self, node: &Node8, slot: usize, lanes: &Lanes, t_far: f32) -> bool {
        self.0.meets(node, slot, lanes, t_far)
    }

    #[inline(always)]
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict {
        self.0.judge(block, filter, t_far)
    }

    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.apart(f)
    }

    #[inline(always)]
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R {
        // SAFETY: as above.
        unsafe { apart(f) }
    }

    #[inline(always)]
    fn gather(self, tree: &Bvh, rays: &Glances) -> Option<Packet> {
        self.0.gather(tree, rays)
    }

    #[inline(always)]
    fn ends(self, packet: &Packet) -> [f32; PACKET] {
        self.0.ends(packet)
    }

    #[inline(always)]
    fn one(self, tree: &Bvh, packet: &Packet, ray: usize) -> (Lanes, Way) {
        self.0.one(tree, packet, ray)
    }

    #[inline(always)]
    fn way(self, tree: &Bvh, packet: &Packet, ray: usize) -> Way {
        self.0.way(tree, packet, ray)
    }

    #[inline(always)]
    fn awake(self, row: &[f32; PACKET], t_far: &[f32; PACKET]) -> u32 {
        // SAFETY: as above.
        unsafe { awake(row, t_far) }
    }

    #[inline(always)]
    fn filters(self, tree: &Bvh, packet: &Packet) -> Filters {
        self.0.filters(tree, packet)
    }

    #[inline(always)]
    fn judge_together(
        self,
        block: &Block,
        filters: &Filters,
        awake: u32,
        t_far: &[f32; PACKET],
        verdicts: &mut [Verdict; PACKET],
    ) -> u32 {
        // SAFETY: as above.
        unsafe { judge_together(block, filters, awake, t_far, verdicts) }
    }

    #[inline(always)]
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node8,
        packet: &Packet,
        row: &[f32; PACKET],
        (t_far, far): (&[f32; PACKET], f32),
        rows: &mut Rows,
    ) {
        // SAFETY: as above.
        unsafe { descend_together::<ORDERED>(node, packet, row, (t_far, far), rows) }
    }

    #[inline(always)]
    fn fetch(self, tree: &Bvh, child: ChildRef) {
        self.0.fetch(tree, child);
    }
}

#[inline(never)]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn apart<R>(f: impl FnOnce() -> R) -> R {
    f()
}

/// As with AVX2, but a mask closes the gaps.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma,lzcnt,popcnt")]
fn descend<const ORDERED: bool>(node: &Node8, lanes: &Lanes, t_far: f32, stack: &mut Stack) -> ChildRef {
    let (near, far) = lanes.slabs(node, t_far);
    // SAFETY: both arrays hold eight u32, aligned to 32 bytes in a node aligned to 64.
    let (child, order) = unsafe {
        (_mm256_load_si256(node.child.as_ptr().cast()), _mm256_load_si256(node.order.as_ptr().cast()))
    };
    let (near, far, child) = if ORDERED {
        // Only the low three bits of each index count.
        let order = _mm256_srl_epi32(order, lanes.octant_shift);
        (
            _mm256_permutexvar_ps(order, near),
            _mm256_permutexvar_ps(order, far),
            _mm256_permutexvar_epi32(order, child),
        )
    } else {
        (near, far, child)
    };
    let met = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(near, far);
    let mask = u32::from(met);
    // SAFETY: eight elements are written to each, through pointers to eight; a mask of eight bits has at most eight.
    unsafe {
        stack.exchange(
            (32 - mask.leading_zeros()) as usize,
            mask.count_ones() as usize,
            #[inline(always)]
            |refs| _mm256_storeu_si256(refs.cast(), child),
            #[inline(always)]
            |refs, distances| {
                _mm256_storeu_si256(refs.cast(), _mm256_maskz_compress_epi32(met, child));
                _mm256_storeu_ps(distances, _mm256_maskz_compress_ps(met, near));
            },
        )
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
fn awake(row: &[f32; 8], t_far: &[f32; 8]) -> u32 {
    u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(eight(row), eight(t_far)))
}

/// Two of eight numbers, each in half of the lanes.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
fn pair(numbers: &[f32; 8], (a, b): (usize, usize)) -> __m512 {
    let of = |at: usize| _mm_set_ss(numbers[at & 7]);
    _mm512_mask_broadcastss_ps(_mm512_broadcastss_ps(of(a)), 0xff00, of(b))
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
fn halves(x: __m512) -> [__m256; 2] {
    [_mm512_castps512_ps256(x), _mm512_extractf32x8_ps::<1>(x)]
}

/// As with AVX2, but two children at a time.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn descend_together<const ORDERED: bool>(
    node: &Node8,
    packet: &Packet,
    row: &[f32; 8],
    (t_far, far): (&[f32; 8], f32),
    rows: &mut Rows,
) {
    let [near_plane, far_plane] = PLANES[packet.octant & 7];
    let (mut near, mut far) = packet.slabs(node, far);
    if ORDERED {
        // SAFETY: eight u32, aligned to 32 bytes in a node aligned to 64.
        let order = unsafe { _mm256_load_si256(node.order.as_ptr().cast()) };
        let order = _mm256_srl_epi32(order, _mm_cvtsi32_si128(3 * packet.octant as i32));
        near = _mm256_permutexvar_ps(order, near);
        far = _mm256_permutexvar_ps(order, far);
    }
    let mut left = u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(near, far));
    let awake = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(eight(row), eight(t_far));
    let awake = u16::from(awake) << 8 | u16::from(awake);
    let twice = |x: __m256| _mm512_broadcast_f32x8(x);
    let (t_near, t_far) = (twice(packet.t_near), twice(eight(t_far)));
    let nothing = _mm512_set1_ps(f32::NAN);
    let slot = |at: u32| {
        let at = at as usize & 7;
        if ORDERED { (node.order[at] >> (3 * packet.octant)) as usize & 7 } else { at }
    };
    while left != 0 {
        let a = slot(left.trailing_zeros());
        left &= left - 1;
        // Without another the same again.
        let is_pair = left != 0;
        let b = if is_pair { slot(left.trailing_zeros()) } else { a };
        left &= left.wrapping_sub(1);
        let plane = |begins: u8, axis: usize, c: &[__m256; 3]| {
            let planes = pair(&node.planes[usize::from(begins) / 32 % 6], (a, b));
            _mm512_fmadd_ps(planes, twice(packet.r[axis]), twice(c[axis]))
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
        let near = _mm512_max_ps(_mm512_max_ps(ex, ey), _mm512_max_ps(ez, t_near));
        let far = _mm512_min_ps(_mm512_min_ps(lx, ly), _mm512_min_ps(lz, t_far));
        let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(awake, near, far);
        let [first, second] = halves(_mm512_mask_blend_ps(met, nothing, near));
        rows.push_if(met & 0xff != 0, node.child[a], numbers(first));
        rows.push_if(is_pair & (met >> 8 != 0), node.child[b], numbers(second));
    }
}

type Three = [__m512; 3];

#[inline]
#[target_feature(enable = "avx512f")]
fn difference(a: &Three, b: &Three) -> Three {
    [_mm512_sub_ps(a[0], b[0]), _mm512_sub_ps(a[1], b[1]), _mm512_sub_ps(a[2], b[2])]
}

/// Three products: one rounded, two fused.
#[inline]
#[target_feature(enable = "avx512f")]
fn dot(a: &Three, b: &Three) -> __m512 {
    _mm512_fmadd_ps(a[2], b[2], _mm512_fmadd_ps(a[1], b[1], _mm512_mul_ps(a[0], b[0])))
}

#[inline]
#[target_feature(enable = "avx512f")]
fn cross(a: &Three, b: &Three) -> Three {
    let minor = |i: usize, j: usize| _mm512_fmsub_ps(a[i], b[j], _mm512_mul_ps(a[j], b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// What [`Kernel::judge`] says for each ray that is awake, two rays at a time.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn judge_together(
    block: &Block,
    filters: &Filters,
    mut awake: u32,
    t_far: &[f32; 8],
    verdicts: &mut [Verdict; 8],
) -> u32 {
    let all = |x: f32| _mm512_set1_ps(x);
    let row = |r: usize| {
        // SAFETY: a row holds eight f32, aligned to 32 bytes in a block aligned to 64.
        let twice = |r: usize| _mm512_broadcast_f32x8(unsafe { _mm256_load_ps(block.rows[r].as_ptr()) });
        [twice(r), twice(r + 1), twice(r + 2)]
    };
    let first = row(0);
    let (e1, e2) = (difference(&row(3), &first), difference(&row(6), &first));
    let n = cross(&e1, &e2);
    let length = |e: &Three| {
        _mm512_add_ps(_mm512_add_ps(_mm512_abs_ps(e[0]), _mm512_abs_ps(e[1])), _mm512_abs_ps(e[2]))
    };
    // What depends on ray and block, for all rays.
    let (slack, nearby, certain) = {
        let extent = block.size();
        let (all, square) = (|x: f32| _mm256_set1_ps(x), extent * extent);
        let (a, b, g) = (eight(&filters.a), eight(&filters.b), eight(&filters.g));
        let slack = _mm256_fmadd_ps(all(extent), _mm256_fmadd_ps(b, all(extent), a), g);
        let nearby = _mm256_fmadd_ps(all(NEAR), all(extent), eight(&filters.p));
        let flat = _mm256_mul_ps(all(2.0), b);
        let certain = _mm256_fmadd_ps(all(4.0), slack, _mm256_fmadd_ps(flat, all(square), all(FLAT)));
        (numbers(slack), numbers(nearby), numbers(certain))
    };
    let mut are_alive = 0;
    while awake != 0 {
        let a = awake.trailing_zeros() as usize & 7;
        awake &= awake - 1;
        // Without another the same again.
        let b = if awake != 0 { awake.trailing_zeros() as usize & 7 } else { a };
        awake &= awake.wrapping_sub(1);
        let each = |x: &[f32; 8]| pair(x, (a, b));
        let three = |x: &[[f32; 8]; 3]| [each(&x[0]), each(&x[1]), each(&x[2])];
        let (start, direction) = (three(&filters.o), three(&filters.d));
        let c = difference(&first, &start);
        let r = cross(&c, &direction);
        let (u, v) = (dot(&r, &e2), _mm512_xor_ps(all(-0.0), dot(&r, &e1)));
        let d = dot(&direction, &n);
        let w = _mm512_sub_ps(_mm512_sub_ps(d, u), v);
        let least = _mm512_min_ps(_mm512_min_ps(u, v), w);
        let most = _mm512_max_ps(_mm512_max_ps(u, v), w);
        let above = each(&slack);
        let below = _mm512_xor_ps(all(-0.0), above);
        let possible =
            _mm512_cmp_ps_mask::<_CMP_GE_OQ>(least, below) | _mm512_cmp_ps_mask::<_CMP_LE_OQ>(most, above);
        if possible == 0 {
            continue;
        }
        let inverse = _mm512_div_ps(all(1.0), d);
        let t = _mm512_mul_ps(dot(&c, &n), inverse);
        let size = _mm512_abs_ps(t);
        let spread = _mm512_mul_ps(_mm512_abs_ps(inverse), _mm512_mul_ps(length(&e1), length(&e2)));
        let q = _mm512_mul_ps(all(4.0), each(&filters.b));
        let far = _mm512_mul_ps(_mm512_fmadd_ps(q, size, each(&nearby)), spread);
        let tau = _mm512_add_ps(far, _mm512_fmadd_ps(all(FAR), size, all(Filter::S)));
        let known = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(_mm512_abs_ps(d), each(&certain));
        let lo = _mm512_mask_sub_ps(all(f32::NEG_INFINITY), known, t, tau);
        let hi = _mm512_mask_add_ps(all(f32::INFINITY), known, t, tau);
        let alive = _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(possible, hi, each(&filters.t_near));
        let alive = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(alive, lo, each(t_far));
        if alive == 0 {
            continue;
        }
        let through =
            _mm512_cmp_ps_mask::<_CMP_GT_OQ>(least, above) | _mm512_cmp_ps_mask::<_CMP_LT_OQ>(most, below);
        let sure = _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(alive & known & through, lo, each(&filters.first));
        let sure = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(sure, hi, each(&filters.last));
        let ([lo_a, lo_b], [hi_a, hi_b]) = (halves(lo), halves(hi));
        verdicts[a] = verdict(alive & 0xff, sure & 0xff, lo_a, hi_a);
        verdicts[b] = verdict(alive >> 8, sure >> 8, lo_b, hi_b);
        are_alive |= u32::from(alive & 0xff != 0) << a | u32::from(alive >> 8 != 0) << b;
    }
    are_alive
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn verdict(alive: u16, sure: u16, lo: __m256, hi: __m256) -> Verdict {
    Verdict { alive: u32::from(alive), sure: u32::from(sure), lo: numbers(lo), hi: numbers(hi) }
}
