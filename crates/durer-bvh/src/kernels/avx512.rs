//! The kernel for AVX-512: sixteen lanes hold all of a node, all of a block, or two children for
//! eight rays.
//!
//! Comparisons give masks in registers of their own, and the compress instruction takes such a
//! mask. The setup of rays is that of AVX2.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::avx2::Numbers;
use super::packet8::{Filters, Packet, eight, numbers};
use super::planes::Planes;
use super::{Avx2, Kernel, Rows, Stack, Together};
use crate::node::{ChildRef, Node, SLOT_BITS, WIDTH};
use crate::ray::{ClippedRay, PACKET, Packet32, TreeRay};
use crate::tree::Bvh;
use crate::triangles::{Block, FAR, FLAT, Filter, NEAR, Verdict};
use core::arch::x86_64::*;
use durer_math::Isa;
use durer_math::kernels::Path;

/// Proof that this CPU has all features of [`Path::Avx512`]: AVX-512 F, VL, DQ and BW, and those of
/// [`Avx2`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(pub(super) Avx2);

impl Avx512 {
    /// The kernel, if `isa` proves the features.
    #[inline(always)]
    pub(crate) fn of(isa: Isa) -> Option<Self> {
        if isa.path() == Path::Avx512 { Avx2::of(isa).map(Self) } else { None }
    }
}

impl Kernel for Avx512 {
    type Ray = Numbers;
    type Lanes = Wide;

    #[inline(always)]
    fn nearby(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Numbers, ClippedRay)> {
        self.0.nearby(tree, sight)
    }

    #[inline(always)]
    fn afar(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Numbers, ClippedRay)> {
        self.0.afar(tree, sight)
    }

    #[inline(always)]
    fn spread(self, ray: &Numbers) -> Wide {
        // SAFETY: as below.
        unsafe { Wide::of(ray) }
    }

    #[inline(always)]
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        lanes: &Wide,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef {
        // SAFETY: `self` exists, so an `Isa` has seen all of its features on this CPU.
        unsafe { descend::<ORDERED>(node, lanes, t_far, stack) }
    }

    #[inline(always)]
    fn meets(self, node: &Node, slot: usize, lanes: &Wide, t_far: f32) -> bool {
        // SAFETY: as above.
        unsafe { meets(node, slot, lanes, t_far) }
    }

    #[inline(always)]
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict {
        // SAFETY: as above.
        unsafe { judge(block, filter, t_far) }
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
    fn fetch(self, tree: &Bvh, child: ChildRef) {
        self.0.fetch(tree, child);
    }
}

impl Together<PACKET> for Avx512 {
    type Packet = Packet;
    type Filters = Filters;

    #[inline(always)]
    fn gather(self, tree: &Bvh, rays: &[&Packet32]) -> Option<Packet> {
        Together::<PACKET>::gather(self.0, tree, rays)
    }

    #[inline(always)]
    fn ends(self, packet: &Packet) -> [f32; PACKET] {
        Together::<PACKET>::ends(self.0, packet)
    }

    #[inline(always)]
    fn one(self, tree: &Bvh, packet: &Packet, ray: usize) -> (Numbers, ClippedRay) {
        Together::<PACKET>::one(self.0, tree, packet, ray)
    }

    #[inline(always)]
    fn way(self, tree: &Bvh, packet: &Packet, ray: usize) -> ClippedRay {
        Together::<PACKET>::way(self.0, tree, packet, ray)
    }

    #[inline(always)]
    fn awake(self, row: &[f32; PACKET], t_far: &[f32; PACKET]) -> u32 {
        // SAFETY: as above.
        unsafe { awake(row, t_far) }
    }

    #[inline(always)]
    fn filters(self, tree: &Bvh, packet: &Packet) -> Filters {
        Together::<PACKET>::filters(self.0, tree, packet)
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
        node: &Node,
        packet: &Packet,
        row: &[f32; PACKET],
        (t_far, far): (&[f32; PACKET], f32),
        rows: &mut Rows<PACKET>,
    ) {
        // SAFETY: as above.
        unsafe { descend_together::<ORDERED>(node, packet, row, (t_far, far), rows) }
    }
}

#[inline(never)]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn apart<R>(f: impl FnOnce() -> R) -> R {
    f()
}

pub(super) type Three = [__m512; 3];

/// A ray, broadcast to sixteen lanes.
pub(crate) struct Wide {
    r: Three,
    near: Three,
    far: Three,
    t_near: __m512,
    planes: Planes,
    octant_shift: __m128i,
}

impl Wide {
    #[inline]
    #[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
    fn of(ray: &Numbers) -> Self {
        let three = |x: &[f32; 4]| [_mm512_set1_ps(x[0]), _mm512_set1_ps(x[1]), _mm512_set1_ps(x[2])];
        Self {
            r: three(&ray.r),
            near: three(&ray.near),
            far: three(&ray.far),
            t_near: _mm512_set1_ps(ray.t_near),
            planes: ray.planes(),
            octant_shift: ray.octant_shift(),
        }
    }

    /// The parameters at which the ray enters and leaves a node's boxes, the latter at most
    /// `t_far`.
    #[inline]
    #[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
    fn slabs(&self, node: &Node, t_far: f32) -> (__m512, __m512) {
        slabs(node, &self.planes, [(&self.r, &self.near), (&self.r, &self.far)], self.t_near, t_far)
    }
}

/// A node's near planes, and its far ones.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn planes_of(node: &Node, planes: &Planes) -> (Three, Three) {
    let row = |begins: usize| {
        // SAFETY: one of six rows begins there, and a row holds sixteen f32, aligned to 64 bytes.
        unsafe { _mm512_load_ps(node.planes.as_ptr().cast::<f32>().byte_add(begins)) }
    };
    let ([nx, ny, nz], [fx, fy, fz]) = (planes.near(), planes.far());
    ([row(nx), row(ny), row(nz)], [row(fx), row(fy), row(fz)])
}

/// The parameter at which the last of three planes is met, but at least `t_near`.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn latest(planes: &Three, (r, c): (&Three, &Three), t_near: __m512) -> __m512 {
    let plane = |axis: usize| _mm512_fmadd_ps(planes[axis], r[axis], c[axis]);
    _mm512_max_ps(_mm512_max_ps(plane(0), plane(1)), _mm512_max_ps(plane(2), t_near))
}

/// The parameter at which the first of three planes is met, but at most `t_far`.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn earliest(planes: &Three, (r, c): (&Three, &Three), t_far: __m512) -> __m512 {
    let plane = |axis: usize| _mm512_fmadd_ps(planes[axis], r[axis], c[axis]);
    _mm512_min_ps(_mm512_min_ps(plane(0), plane(1)), _mm512_min_ps(plane(2), t_far))
}

/// The AVX2 kernel's `slabs`, for a whole node at once.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
pub(super) fn slabs(
    node: &Node,
    planes: &Planes,
    [enter, leave]: [(&Three, &Three); 2],
    t_near: __m512,
    t_far: f32,
) -> (__m512, __m512) {
    let (near, far) = planes_of(node, planes);
    let near = latest(&near, enter, t_near);
    let far = earliest(&far, leave, _mm512_set1_ps(t_far));
    (near, far)
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
fn meets(node: &Node, slot: usize, lanes: &Wide, t_far: f32) -> bool {
    let (near, far) = lanes.slabs(node, t_far);
    _mm512_cmp_ps_mask::<_CMP_LE_OQ>(near, far) >> slot & 1 != 0
}

/// The AVX2 kernel's `descend`, for a whole node at once; a compress instruction removes the gaps.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma,lzcnt,popcnt")]
fn descend<const ORDERED: bool>(node: &Node, lanes: &Wide, t_far: f32, stack: &mut Stack) -> ChildRef {
    let (near, far) = lanes.slabs(node, t_far);
    // SAFETY: both arrays hold sixteen u32, in a node aligned to 64.
    let (child, order) = unsafe {
        (_mm512_load_si512(node.child.as_ptr().cast()), _mm512_load_si512(node.order.as_ptr().cast()))
    };
    let (near, far, child) = if ORDERED {
        // Only the low four bits of each index count.
        let order = _mm512_srl_epi32(order, lanes.octant_shift);
        (
            _mm512_permutexvar_ps(order, near),
            _mm512_permutexvar_ps(order, far),
            _mm512_permutexvar_epi32(order, child),
        )
    } else {
        (near, far, child)
    };
    let met = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(near, far);
    let mask = u32::from(met);
    // SAFETY: sixteen elements are staged; eight or sixteen, and not fewer than are met, are
    // written to each of the others, through pointers to sixteen; a mask of sixteen bits has at
    // most sixteen.
    unsafe {
        stack.exchange(
            (32 - mask.leading_zeros()) as usize,
            mask.count_ones() as usize,
            #[inline(always)]
            |refs| _mm512_store_si512(refs.cast(), child),
            #[inline(always)]
            |refs, distances| {
                let (child, near) =
                    (_mm512_maskz_compress_epi32(met, child), _mm512_maskz_compress_ps(met, near));
                _mm256_storeu_si256(refs.cast(), _mm512_castsi512_si256(child));
                _mm256_storeu_ps(distances, _mm512_castps512_ps256(near));
                if mask.count_ones() > 8 {
                    _mm256_storeu_si256(refs.add(8).cast(), _mm512_extracti64x4_epi64::<1>(child));
                    _mm256_storeu_ps(distances.add(8), _mm512_extractf32x8_ps::<1>(near));
                }
            },
        )
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
fn awake(row: &[f32; 8], t_far: &[f32; 8]) -> u32 {
    u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(eight(row), eight(t_far)))
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
fn halves(x: __m512) -> [__m256; 2] {
    [_mm512_castps512_ps256(x), _mm512_extractf32x8_ps::<1>(x)]
}

/// The AVX2 kernel's packet step, two children at a time.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn descend_together<const ORDERED: bool>(
    node: &Node,
    packet: &Packet,
    row: &[f32; 8],
    (t_far, far): (&[f32; 8], f32),
    rows: &mut Rows<PACKET>,
) {
    let (planes, hull) = (Planes::of(packet.octant), &packet.hull);
    let (near_planes, far_planes) = planes_of(node, &planes);
    let twice = |x: __m256| _mm512_broadcast_f32x8(x);
    let three = |x: &[__m256; 3]| [twice(x[0]), twice(x[1]), twice(x[2])];
    let (r, c_near, c_far) = (three(&packet.r), three(&packet.near), three(&packet.far));
    let (enter, leave) =
        ((three(&hull.enter.0), three(&hull.enter.1)), (three(&hull.leave.0), three(&hull.leave.1)));
    let (mut near, mut far) =
        slabs(node, &planes, [(&enter.0, &enter.1), (&leave.0, &leave.1)], twice(hull.t_near), far);
    if ORDERED {
        // SAFETY: sixteen u32, aligned to 64 bytes.
        let order = unsafe { _mm512_load_si512(node.order.as_ptr().cast()) };
        let order = _mm512_srl_epi32(order, _mm_cvtsi32_si128((SLOT_BITS as usize * packet.octant) as i32));
        near = _mm512_permutexvar_ps(order, near);
        far = _mm512_permutexvar_ps(order, far);
    }
    let mut left = u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(near, far));
    let awake = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(eight(row), eight(t_far));
    let awake = u16::from(awake) << 8 | u16::from(awake);
    let (t_near, t_far) = (twice(packet.t_near), twice(eight(t_far)));
    let nothing = _mm512_set1_ps(f32::NAN);
    let slot = |at: u32| {
        let at = at as usize % WIDTH;
        if ORDERED { (node.order[at] >> (SLOT_BITS as usize * packet.octant)) as usize % WIDTH } else { at }
    };
    while left != 0 {
        let a = slot(left.trailing_zeros());
        left &= left - 1;
        // Without a second child the first is tested twice.
        let is_pair = left != 0;
        let b = if is_pair { slot(left.trailing_zeros()) } else { a };
        left &= left.wrapping_sub(1);
        // The first child's planes in one half of the lanes, the second child's in the other.
        let both = _mm512_mask_set1_epi32(_mm512_set1_epi32(a as i32), 0xff00, b as i32);
        let pick = |row: __m512| _mm512_permutexvar_ps(both, row);
        let of_both = |rows: &Three| [pick(rows[0]), pick(rows[1]), pick(rows[2])];
        let near = latest(&of_both(&near_planes), (&r, &c_near), t_near);
        let far = earliest(&of_both(&far_planes), (&r, &c_far), t_far);
        let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(awake, near, far);
        let [first, second] = halves(_mm512_mask_blend_ps(met, nothing, near));
        rows.push_if(met & 0xff != 0, node.child[a], numbers(first));
        rows.push_if(is_pair & (met >> 8 != 0), node.child[b], numbers(second));
    }
}

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

/// Sixteen triangles without a ray: the first corner, the edges from there, their cross product,
/// and the size of the block.
pub(super) struct Edges {
    first: Three,
    e1: Three,
    e2: Three,
    n: Three,
    pub(super) extent: f32,
}

#[inline]
#[target_feature(enable = "avx512f,avx2,fma")]
pub(super) fn edges(block: &Block) -> Edges {
    let row = |r: usize| {
        // SAFETY: a row holds sixteen f32, aligned to 64 bytes.
        let load = |r: usize| unsafe { _mm512_load_ps(block.rows[r].as_ptr()) };
        [load(r), load(r + 1), load(r + 2)]
    };
    let first = row(0);
    let (e1, e2) = (difference(&row(3), &first), difference(&row(6), &first));
    Edges { first, e1, e2, n: cross(&e1, &e2), extent: block.size() }
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn judge(block: &Block, filter: &Filter, t_far: f32) -> Verdict {
    let edges = edges(block);
    let extent = edges.extent;
    let slack = || extent.mul_add(filter.b.mul_add(extent, filter.a), filter.g);
    let rest = |slack: f32| Rest {
        q: filter.q,
        nearby: NEAR.mul_add(extent, filter.p),
        s: filter.s,
        certain: 4.0_f32.mul_add(slack, filter.flat.mul_add(extent * extent, FLAT)),
        t_near: filter.t_near,
        t_far,
        first: filter.first,
        last: filter.last,
    };
    let mut verdict = Verdict::NOTHING;
    let spread = |v: &[f32; 4]| [_mm512_set1_ps(v[0]), _mm512_set1_ps(v[1]), _mm512_set1_ps(v[2])];
    judge_edges(&edges, &spread(&filter.o), &spread(&filter.d), slack, rest, &mut verdict);
    verdict
}

/// The members of [`Filter`], and values that follow from these and the size of the block, that are
/// needed only if the first test has not excluded all triangles.
pub(super) struct Rest {
    pub(super) q: f32,
    /// `p + NEAR E`.
    pub(super) nearby: f32,
    pub(super) s: f32,
    /// `D` is of use only if it exceeds this.
    pub(super) certain: f32,
    pub(super) t_near: f32,
    pub(super) t_far: f32,
    pub(super) first: f32,
    pub(super) last: f32,
}

/// `Scalar::judge` for sixteen triangles at once. Returns which are alive, and writes the rest only
/// if one is. Most blocks end at the first test.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn judge_edges(
    edges: &Edges,
    start: &Three,
    direction: &Three,
    slack: impl FnOnce() -> f32,
    rest: impl FnOnce(f32) -> Rest,
    verdict: &mut Verdict,
) -> u32 {
    let all = |x: f32| _mm512_set1_ps(x);
    let Edges { first, e1, e2, n, .. } = edges;
    let (c, slack) = (difference(first, start), slack());
    let r = cross(&c, direction);
    let (u, v) = (dot(&r, e2), _mm512_xor_ps(all(-0.0), dot(&r, e1)));
    let d = dot(direction, n);
    let w = _mm512_sub_ps(_mm512_sub_ps(d, u), v);
    let least = _mm512_min_ps(_mm512_min_ps(u, v), w);
    let most = _mm512_max_ps(_mm512_max_ps(u, v), w);
    let (above, below) = (all(slack), all(-slack));
    let possible =
        _mm512_cmp_ps_mask::<_CMP_GE_OQ>(least, below) | _mm512_cmp_ps_mask::<_CMP_LE_OQ>(most, above);
    if possible == 0 {
        return 0;
    }
    let rest = rest(slack);
    let length = |e: &Three| {
        _mm512_add_ps(_mm512_add_ps(_mm512_abs_ps(e[0]), _mm512_abs_ps(e[1])), _mm512_abs_ps(e[2]))
    };
    let inverse = _mm512_div_ps(all(1.0), d);
    let t = _mm512_mul_ps(dot(&c, n), inverse);
    let size = _mm512_abs_ps(t);
    let spread = _mm512_mul_ps(_mm512_abs_ps(inverse), _mm512_mul_ps(length(e1), length(e2)));
    let far = _mm512_mul_ps(_mm512_fmadd_ps(all(rest.q), size, all(rest.nearby)), spread);
    let tau = _mm512_add_ps(far, _mm512_fmadd_ps(all(FAR), size, all(rest.s)));
    let known = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(_mm512_abs_ps(d), all(rest.certain));
    let lo = _mm512_mask_sub_ps(all(f32::NEG_INFINITY), known, t, tau);
    let hi = _mm512_mask_add_ps(all(f32::INFINITY), known, t, tau);
    let alive = _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(possible, hi, all(rest.t_near));
    let alive = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(alive, lo, all(rest.t_far));
    let through =
        _mm512_cmp_ps_mask::<_CMP_GT_OQ>(least, above) | _mm512_cmp_ps_mask::<_CMP_LT_OQ>(most, below);
    let sure = _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(alive & known & through, lo, all(rest.first));
    let sure = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(sure, hi, all(rest.last));
    verdict.alive = u32::from(alive);
    verdict.sure = u32::from(sure);
    // SAFETY: sixteen f32 each.
    unsafe {
        _mm512_storeu_ps(verdict.lo.as_mut_ptr(), lo);
        _mm512_storeu_ps(verdict.hi.as_mut_ptr(), hi);
    }
    verdict.alive
}

/// [`Kernel::judge`] for each ray that is awake.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn judge_together(
    block: &Block,
    filters: &Filters,
    mut awake: u32,
    t_far: &[f32; 8],
    verdicts: &mut [Verdict; 8],
) -> u32 {
    let edges = edges(block);
    let all = |x: f32| _mm256_set1_ps(x);
    let extent = all(edges.extent);
    let (a, b, g, p) = (eight(&filters.a), eight(&filters.b), eight(&filters.g), eight(&filters.p));
    let slack = _mm256_fmadd_ps(extent, _mm256_fmadd_ps(b, extent, a), g);
    let flat = _mm256_mul_ps(all(2.0), b);
    let certain = _mm256_fmadd_ps(flat, _mm256_mul_ps(extent, extent), all(FLAT));
    // Computed for all rays at once, then broadcast one by one.
    let slacks = numbers(slack);
    let certain = numbers(_mm256_fmadd_ps(all(4.0), slack, certain));
    let nearby = numbers(_mm256_fmadd_ps(all(NEAR), extent, p));
    let q = numbers(_mm256_mul_ps(all(4.0), b));
    let mut alive = 0;
    while awake != 0 {
        let ray = awake.trailing_zeros() as usize & 7;
        awake &= awake - 1;
        let of = |v: &[[f32; 8]; 3]| {
            [_mm512_set1_ps(v[0][ray]), _mm512_set1_ps(v[1][ray]), _mm512_set1_ps(v[2][ray])]
        };
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
