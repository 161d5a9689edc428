//! Eight lanes at once with AVX2 and FMA: nodes and blocks are asked in two halves.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

use super::packet::{self, Filters, Packet};
use super::{Kernel, Rows, Stack};
use crate::frame::up32;
use crate::node::{ChildRef, Node, SLOT_BITS, WIDTH};
use crate::ray::{
    CullRay, Glance, Glances, LEAST, LONGEST, Line, NEARBY, PACKET, Rounding, SLOWEST, Sight, TO_NEAREST,
    U32, WIDEN, Way,
};
use crate::tree::Bvh;
use crate::triangles::{Block, FAR, FLAT, Filter, NEAR, ROUGH, Verdict};
use core::arch::x86_64::*;
use durer_math::kernels::Path;
use durer_math::{Isa, Vec3};

/// Proof that this CPU has all that [`Path::Avx2`] asks for: AVX2, FMA, BMI1 and 2, LZCNT and POPCNT.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// What an [`Isa`] proves.
    #[inline(always)]
    pub(crate) fn of(isa: Isa) -> Option<Self> {
        matches!(isa.path(), Path::Avx2 | Path::Avx512).then_some(Self(()))
    }

    #[inline(always)]
    fn clipped(self, tree: &Bvh, sight: &impl Sight) -> Option<CullRay> {
        self.apart(
            #[inline(always)]
            || {
                let line = sight.line();
                if line.origin_error != Vec3::ZERO || line.direction_error != Vec3::ZERO {
                    return tree.cull(&line, Rounding::Fused);
                }
                // SAFETY: as below.
                match unsafe { clip(tree, &line) } {
                    Clipped::Missed => None,
                    Clipped::Enters(ray) => Some(ray),
                    Clipped::Unusual => tree.cull(&line, Rounding::Fused),
                }
            },
        )
    }
}

/// A ray as a node test needs it, number by number.
#[derive(Clone, Copy)]
pub(crate) struct Numbers {
    pub(super) r: [f32; 4],
    pub(super) near: [f32; 4],
    pub(super) far: [f32; 4],
    pub(super) t_near: f32,
    octant: u32,
}

impl Numbers {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn new(r: __m128, near: __m128, far: __m128, octant: usize, t_near: f32) -> Self {
        Self { r: stored(r), near: stored(near), far: stored(far), t_near, octant: octant as u32 }
    }

    #[inline(always)]
    pub(super) fn of(ray: &CullRay) -> Self {
        Self { r: ray.r, near: ray.near, far: ray.far, t_near: ray.way.t_near, octant: ray.octant }
    }

    /// Where a node's near planes of each axis begin, in bytes, and the far ones.
    #[inline(always)]
    pub(super) fn planes(&self) -> [[usize; 3]; 2] {
        let [near, far] = &PLANES[self.octant as usize & 7];
        let three =
            |planes: &[u16; 3]| [usize::from(planes[0]), usize::from(planes[1]), usize::from(planes[2])];
        [three(near), three(far)]
    }

    /// By how much the places for rays of its octant are to be shifted.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(super) fn octant_shift(&self) -> __m128i {
        _mm_cvtsi32_si128((SLOT_BITS * self.octant) as i32)
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn stored(x: __m128) -> [f32; 4] {
    let mut stored = [0.0_f32; 4];
    // SAFETY: four f32.
    unsafe { _mm_storeu_ps(stored.as_mut_ptr(), x) };
    stored
}

/// The ray in all lanes.
pub(crate) struct Lanes {
    pub(super) r: [__m256; 3],
    pub(super) near: [__m256; 3],
    pub(super) far: [__m256; 3],
    pub(super) t_near: __m256,
    /// Where a node's near planes of each axis begin, in bytes, and the far ones.
    pub(super) near_plane: [usize; 3],
    pub(super) far_plane: [usize; 3],
    octant_shift: __m128i,
}

/// For each set of lanes the lanes in it, in order, one per byte: what `vpcompressd` does, from a table.
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

/// Where the near planes for rays of each octant begin in a node, in bytes, and the far ones.
pub(super) static PLANES: [[[u16; 3]; 2]; 8] = {
    const ROW: u16 = 4 * WIDTH as u16;
    let mut table = [[[0, ROW, 2 * ROW], [3 * ROW, 4 * ROW, 5 * ROW]]; 8];
    let mut octant = 0;
    while octant < 8 {
        let mut axis = 0;
        while axis < 3 {
            if octant >> axis & 1 == 1 {
                (table[octant][0][axis], table[octant][1][axis]) =
                    (table[octant][1][axis], table[octant][0][axis]);
            }
            axis += 1;
        }
        octant += 1;
    }
    table
};

impl Lanes {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn of(ray: &Numbers) -> Self {
        let three = |x: &[f32; 4]| [_mm256_set1_ps(x[0]), _mm256_set1_ps(x[1]), _mm256_set1_ps(x[2])];
        let [near_plane, far_plane] = ray.planes();
        Self {
            r: three(&ray.r),
            near: three(&ray.near),
            far: three(&ray.far),
            t_near: _mm256_set1_ps(ray.t_near),
            near_plane,
            far_plane,
            octant_shift: ray.octant_shift(),
        }
    }

    /// Where the ray enters a node's boxes and leaves them, this up to `t_far`.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn slabs(&self, node: &Node, half: usize, t_far: f32) -> (__m256, __m256) {
        let planes = [self.near_plane.map(|i| i + 32 * half), self.far_plane.map(|i| i + 32 * half)];
        slabs(node, planes, [(&self.r, &self.near), (&self.r, &self.far)], self.t_near, t_far)
    }

    /// Where it enters them, and which it meets.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn boxes(&self, node: &Node, half: usize, t_far: f32) -> (__m256, __m256) {
        let (near, far) = self.slabs(node, half, t_far);
        (near, _mm256_cmp_ps::<_CMP_LE_OQ>(near, far))
    }
}

impl Kernel for Avx2 {
    type Ray = Numbers;
    type Lanes = Lanes;
    type Packet = Packet;
    type Filters = Filters;

    #[inline(always)]
    fn nearby(self, tree: &Bvh, sight: &impl Sight) -> Option<(Numbers, Way)> {
        // SAFETY: as below.
        unsafe { nearby(tree, &sight.glance()) }
    }

    #[inline(always)]
    fn afar(self, tree: &Bvh, sight: &impl Sight) -> Option<(Numbers, Way)> {
        let ray = self.clipped(tree, sight)?;
        Some((Numbers::of(&ray), ray.way))
    }

    #[inline(always)]
    fn spread(self, ray: &Numbers) -> Lanes {
        // SAFETY: as below.
        unsafe { Lanes::of(ray) }
    }

    #[inline(always)]
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        lanes: &Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef {
        // SAFETY: as above.
        unsafe { descend::<ORDERED>(node, lanes, t_far, stack) }
    }

    #[inline(always)]
    fn meets(self, node: &Node, slot: usize, lanes: &Lanes, t_far: f32) -> bool {
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
        // SAFETY: as above.
        unsafe { apart(f) }
    }

    #[inline(always)]
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R {
        self.apart(f)
    }

    #[inline(always)]
    fn gather(self, tree: &Bvh, rays: &Glances) -> Option<Packet> {
        // SAFETY: as above.
        unsafe { packet::gather(tree, rays) }
    }

    #[inline(always)]
    fn ends(self, packet: &Packet) -> [f32; PACKET] {
        // SAFETY: as above.
        unsafe { packet.ends() }
    }

    #[inline(always)]
    fn one(self, tree: &Bvh, packet: &Packet, ray: usize) -> (Numbers, Way) {
        // SAFETY: as above.
        unsafe { (packet.numbers(ray), packet.way(tree, ray)) }
    }

    #[inline(always)]
    fn way(self, tree: &Bvh, packet: &Packet, ray: usize) -> Way {
        // SAFETY: as above.
        unsafe { packet.way(tree, ray) }
    }

    #[inline(always)]
    fn awake(self, row: &[f32; PACKET], t_far: &[f32; PACKET]) -> u32 {
        // SAFETY: as above.
        unsafe { packet::awake(row, t_far) }
    }

    #[inline(always)]
    fn filters(self, tree: &Bvh, packet: &Packet) -> Filters {
        // SAFETY: as above.
        unsafe { packet.filters(tree.rounded) }
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
        unsafe { packet::judge(block, filters, awake, t_far, verdicts) }
    }

    #[inline(always)]
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node,
        packet: &Packet,
        row: &[f32; PACKET],
        (t_far, far): (&[f32; PACKET], f32),
        rows: &mut Rows,
    ) {
        // SAFETY: as above.
        unsafe { packet::descend::<ORDERED>(node, packet, row, (t_far, far), rows) }
    }

    #[inline(always)]
    fn fetch(self, tree: &Bvh, child: ChildRef) {
        let place = tree.place(child);
        for line in 0..size_of::<Block>() / 64 {
            // SAFETY: a prefetch reads nothing that the program could see, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(place.wrapping_add(64 * line).cast()) };
        }
    }
}

/// What [`nearby`] charges of the tree's coordinates, and of the origin's.
pub(super) const SLACK: (f32, f32) = (4.0 * U32 as f32, 7.0 * U32 as f32);
/// Eight units: errors are rounded to f32, multiplied, added and grown by this, a rounding each; the range has fewer.
pub(super) const OUTWARD: f32 = 8.0 * U32 as f32;

/// A ray that starts nearby, at a glance, in f32: neither the way to the tree nor the end of that through it is looked for.
///
/// Let `u = 2^-24`, `M` the greatest magnitude of a coordinate of the tree on an axis, `o` that of the origin, and `e` and `g` the errors of origin and
/// direction. Both `e + 6 g` and so `g` are at most [`ROUGH`] (else the ray is left to others), so `t` is at most `(1 + NEARBY + e) / (1 - g) < 6` in magnitude within the tree,
/// where the ray's points err by `e + 6 g`. A component of the direction below `(M + o) u / 20` counts as that, which moves them by less than
/// `0.3 u (M + o)`. `r` errs by two units, the one of `d` and its own; so a plane at `x` is met at `x r - o r` with an error of
///
/// ```text
///     |r| (u (2 M  +  4 o  +  o  +  M + o  +  0.3 (M + o))  +  e + 6 g)
///              x r    o r    -slack  sum       bent
/// ```
///
/// at most. [`SLACK`] pays for this and for second-order terms; [`OUTWARD`] for the roundings of the errors and of the range. What underflow may take from
/// them is far below either.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn nearby(tree: &Bvh, glance: &Glance) -> Option<(Numbers, Way)> {
    let minus = _mm_set1_ps(-0.0);
    let all = |x: f32| _mm_set1_ps(x);
    let size = |x: __m128| _mm_andnot_ps(minus, x);
    // SAFETY: four f32.
    let four = |v: &[f32; 4]| unsafe { _mm_loadu_ps(v.as_ptr()) };
    let shrink = tree.clip.shrink32;
    let o = _mm_mul_ps(four(&glance.origin), all(shrink));
    let d = _mm_mul_ps(four(&glance.direction), _mm_setr_ps(1.0, 1.0, 1.0, shrink));
    let error = if glance.is_exact {
        _mm_setzero_ps()
    } else {
        let errors = (four(&glance.origin_error), four(&glance.direction_error));
        let error = _mm_fmadd_ps(errors.0, all(shrink), _mm_mul_ps(errors.1, all(6.0)));
        _mm_fmadd_ps(error, all(OUTWARD), error)
    };
    let mut close = _mm_cmp_ps::<_CMP_LE_OQ>(size(o), all(NEARBY));
    if !glance.is_exact {
        close = _mm_and_ps(close, _mm_cmp_ps::<_CMP_LE_OQ>(error, all(ROUGH)));
    }
    // In a tree that is not to be looked at so all is far away, or NaN.
    if _mm_movemask_ps(close) & 7 != 7 {
        return None;
    }
    let most = four(&tree.clip.most32);
    let sign = _mm_and_ps(minus, d);
    let least = _mm_mul_ps(_mm_add_ps(most, size(o)), all(0.05 * U32 as f32));
    let r = _mm_div_ps(all(1.0), _mm_or_ps(sign, _mm_max_ps(size(d), least)));
    let slack = _mm_fmadd_ps(most, all(SLACK.0), _mm_fmadd_ps(size(o), all(SLACK.1), error));
    let slack = _mm_mul_ps(size(r), slack);
    let base = _mm_mul_ps(o, r);
    let (near, far) = (_mm_sub_ps(_mm_sub_ps(_mm_setzero_ps(), base), slack), _mm_sub_ps(slack, base));
    let outward = _mm_set1_ps(OUTWARD);
    let first = _mm_fnmadd_ps(size(o), outward, o);
    let last = _mm_fmadd_ps(size(d), outward, d);
    let octant = _mm_movemask_ps(sign) as usize & 7;
    let error = if glance.is_exact {
        0.0
    } else {
        let two = _mm_max_ps(error, _mm_movehl_ps(error, error));
        f64::from(_mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps::<1>(error, error))))
    };
    let fourth = |x: __m128| _mm_cvtss_f32(_mm_shuffle_ps::<3>(x, x));
    let way = Way {
        start: stored(o),
        direction: stored(d),
        t_near: fourth(first),
        t_far: fourth(last),
        is_exact: glance.is_exact,
        error,
        t_enter: 0.0,
        frame: tree.frame,
    };
    Some((Numbers::new(r, near, far, octant, way.t_near), way))
}

/// What [`clip`] says of a line.
enum Clipped {
    Missed,
    Enters(CullRay),
    /// Far away, or of unusual size: `Bvh::cull` knows.
    Unusual,
}

/// `CullRay::new` for a line that is exactly known, all axes at once and without branches.
///
/// It differs in two ways, both conservative: a component of the direction that is (nearly) zero counts as [`SLOWEST`], for which the box is a
/// little larger; and what is rounded to f32 is moved outward before, by what rounding to nearest may move it inward, instead of after.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn clip(tree: &Bvh, line: &Line) -> Clipped {
    let minus = _mm256_set1_pd(-0.0);
    let all = |x: f64| _mm256_set1_pd(x);
    let size = |x: __m256d| _mm256_andnot_pd(minus, x);
    // SAFETY: four f64 each, aligned to 32 bytes as the first fields of a struct with that alignment.
    let (lo, hi, most) = unsafe {
        (
            _mm256_load_pd(tree.clip.lo.as_ptr()),
            _mm256_load_pd(tree.clip.hi.as_ptr()),
            _mm256_load_pd(tree.clip.most.as_ptr()),
        )
    };
    let (t_min, t_max) = (line.t_min * tree.clip.shrink, line.t_max * tree.clip.shrink);
    if (t_min == 0.0 && line.t_min != 0.0) || (t_max == 0.0 && line.t_max != 0.0) || tree.clip.shrink == 0.0 {
        return Clipped::Unusual;
    }
    let [x, y, z] = line.origin.to_array();
    let o = _mm256_mul_pd(_mm256_setr_pd(x, y, z, 0.0), all(tree.clip.shrink));
    let [x, y, z] = line.direction.to_array();
    let d = _mm256_setr_pd(x, y, z, 1.0);
    let sign = _mm256_and_pd(minus, d);
    let inverse = _mm256_div_pd(all(1.0), _mm256_or_pd(sign, _mm256_max_pd(size(d), all(SLOWEST))));
    let a = _mm256_mul_pd(_mm256_sub_pd(lo, o), inverse);
    let b = _mm256_mul_pd(_mm256_sub_pd(hi, o), inverse);
    let (near, far) = (_mm256_min_pd(a, b), _mm256_max_pd(a, b));
    let near = _mm256_fnmadd_pd(size(near), all(WIDEN), near);
    let far = _mm256_fmadd_pd(size(far), all(WIDEN), far);
    let (enter, exit) = (greatest(near).max(t_min), least(far).min(t_max.next_up()));
    if enter > exit {
        return Clipped::Missed;
    }
    let way = (exit - enter).max(LEAST);
    if way.is_nan() || way > LONGEST {
        return Clipped::Unusual;
    }
    let start = _mm256_fmadd_pd(all(enter), d, o);
    let extent = _mm256_add_pd(most, size(start));
    let bends = _mm256_mul_pd(all(0.4 * U32), extent);
    let bent = _mm256_cmp_pd::<_CMP_GT_OQ>(_mm256_mul_pd(size(inverse), bends), all(way));
    let r = if _mm256_movemask_pd(bent) == 0 {
        inverse
    } else {
        _mm256_blendv_pd(inverse, _mm256_or_pd(sign, _mm256_div_pd(all(way), bends)), bent)
    };
    let slack = _mm256_mul_pd(_mm256_mul_pd(all(Rounding::Fused.slack() * U32), extent), size(r));
    let base = _mm256_xor_pd(minus, _mm256_mul_pd(start, r));
    let (low, high) = (_mm256_sub_pd(base, slack), _mm256_add_pd(base, slack));
    let low = _mm256_fnmadd_pd(size(low), all(TO_NEAREST), low);
    let high = _mm256_fmadd_pd(size(high), all(TO_NEAREST), high);
    let four = |x: __m256d| {
        let mut four = [0.0_f32; 4];
        // SAFETY: four f32.
        unsafe { _mm_storeu_ps(four.as_mut_ptr(), _mm256_cvtpd_ps(x)) };
        four
    };
    Clipped::Enters(CullRay {
        r: four(r),
        near: four(low),
        far: four(high),
        octant: _mm256_movemask_pd(sign) as u32 & 7,
        way: Way {
            start: four(start),
            direction: four(d),
            t_near: 0.0,
            t_far: up32(way.next_up()),
            is_exact: false,
            error: f64::MIN_POSITIVE,
            t_enter: enter,
            frame: tree.frame,
        },
    })
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn greatest(x: __m256d) -> f64 {
    let two = _mm_max_pd(_mm256_castpd256_pd128(x), _mm256_extractf128_pd::<1>(x));
    _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn least(x: __m256d) -> f64 {
    let two = _mm_min_pd(_mm256_castpd256_pd128(x), _mm256_extractf128_pd::<1>(x));
    _mm_cvtsd_f64(_mm_min_sd(two, _mm_unpackhi_pd(two, two)))
}

/// A node's boxes: where they are entered and left, this up to `t_far`. A plane `x` is met at `x r + c`, with the `r` and `c` of near planes and of far ones; where each
/// axis' planes begin is told in bytes. Six fused multiply-adds, six minima and maxima.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn slabs(
    node: &Node,
    [near_plane, far_plane]: [[usize; 3]; 2],
    [enter, leave]: [(&[__m256; 3], &[__m256; 3]); 2],
    t_near: __m256,
    t_far: f32,
) -> (__m256, __m256) {
    let plane = |i: usize, axis: usize, (r, c): (&[__m256; 3], &[__m256; 3])| {
        // SAFETY: `i < 6` as in `PLANES`, and half a row holds eight f32, aligned to 32 bytes in a node
        // aligned to 64.
        let planes = unsafe { _mm256_load_ps(node.planes.as_ptr().cast::<f32>().byte_add(i)) };
        _mm256_fmadd_ps(planes, r[axis], c[axis])
    };
    let [nx, ny, nz] = near_plane;
    let [fx, fy, fz] = far_plane;
    let (ex, ey, ez) = (plane(nx, 0, enter), plane(ny, 1, enter), plane(nz, 2, enter));
    let (lx, ly, lz) = (plane(fx, 0, leave), plane(fy, 1, leave), plane(fz, 2, leave));
    let near = _mm256_max_ps(_mm256_max_ps(ex, ey), _mm256_max_ps(ez, t_near));
    let far = _mm256_min_ps(_mm256_min_ps(lx, ly), _mm256_min_ps(lz, _mm256_set1_ps(t_far)));
    (near, far)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn meets(node: &Node, slot: usize, lanes: &Lanes, t_far: f32) -> bool {
    let (_, met) = lanes.boxes(node, slot / 8, t_far);
    _mm256_movemask_ps(met) >> (slot % 8) & 1 != 0
}

/// Sixteen elements in the order of `places`, of which the low four bits count: one half of them.
#[inline]
#[target_feature(enable = "avx2")]
fn placed(places: __m256i, [low, high]: [__m256; 2]) -> __m256 {
    let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(places));
    let (low, high) = (_mm256_permutevar8x32_ps(low, places), _mm256_permutevar8x32_ps(high, places));
    _mm256_blendv_ps(low, high, is_high)
}

/// A permutation that sorts children by the ray's octant (or none); and one that closes the
/// gaps between those that are met, in place of a branch per child. In two halves.
///
/// The way to the next child is as short as can be: all sixteen are written to one place, while the boxes are still being tested, and
/// the highest bit of the mask says which to read; with no bit it is the one that was on top before.
#[inline]
#[target_feature(enable = "avx2,fma,popcnt,lzcnt")]
fn descend<const ORDERED: bool>(node: &Node, lanes: &Lanes, t_far: f32, stack: &mut Stack) -> ChildRef {
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
    // SAFETY: sixteen elements are written to each, or as many as a mask of sixteen bits has and at most eight more, through pointers to sixteen: the first of
    // the second half go where the first half ends, after at most eight.
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

#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn apart<R>(f: impl FnOnce() -> R) -> R {
    f()
}

/// Three products: one rounded, two fused.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn dot(a: &[__m256; 3], b: &[__m256; 3]) -> __m256 {
    _mm256_fmadd_ps(a[2], b[2], _mm256_fmadd_ps(a[1], b[1], _mm256_mul_ps(a[0], b[0])))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn cross(a: &[__m256; 3], b: &[__m256; 3]) -> [__m256; 3] {
    let minor = |i: usize, j: usize| _mm256_fmsub_ps(a[i], b[j], _mm256_mul_ps(a[j], b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Eight triangles, half a block, without a ray: the first corner, the edges from there, their cross product, and the size of the block.
pub(super) struct Edges {
    v: [__m256; 3],
    e1: [__m256; 3],
    e2: [__m256; 3],
    n: [__m256; 3],
    extent: f32,
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn difference(a: &[__m256; 3], b: &[__m256; 3]) -> [__m256; 3] {
    [_mm256_sub_ps(a[0], b[0]), _mm256_sub_ps(a[1], b[1]), _mm256_sub_ps(a[2], b[2])]
}

#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn edges(block: &Block, half: usize) -> Edges {
    let row = |r: usize| {
        // SAFETY: half a row holds eight f32, aligned to 32 bytes in a block aligned to 64.
        let load = |r: usize| unsafe { _mm256_load_ps(block.rows[r].as_ptr().add(8 * half)) };
        [load(r), load(r + 1), load(r + 2)]
    };
    let v = row(0);
    let (e1, e2) = (difference(&row(3), &v), difference(&row(6), &v));
    let n = cross(&e1, &e2);
    Edges { v, e1, e2, n, extent: block.size() }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn judge(block: &Block, filter: &Filter, t_far: f32) -> Verdict {
    let mut verdict = Verdict::NOTHING;
    judge_halves(&[edges(block, 0), edges(block, 1)], filter, t_far, &mut verdict);
    verdict
}

/// What `Scalar::judge` does, in two halves; says which are alive, and the rest only if one is.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn judge_halves(
    [low, high]: &[Edges; 2],
    filter: &Filter,
    t_far: f32,
    verdict: &mut Verdict,
) -> u32 {
    let a = judge_edges(low, 0, filter, t_far, verdict);
    let b = judge_edges(high, 1, filter, t_far, verdict);
    (verdict.alive, verdict.sure) = (a.0 | b.0 << 8, a.1 | b.1 << 8);
    verdict.alive
}

/// One half: which are alive, and which of these surely met. Most end at the first test.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn judge_edges(edges: &Edges, half: usize, filter: &Filter, t_far: f32, verdict: &mut Verdict) -> (u32, u32) {
    let spread = |v: &[f32; 4]| [_mm256_set1_ps(v[0]), _mm256_set1_ps(v[1]), _mm256_set1_ps(v[2])];
    let (start, direction) = (spread(&filter.o), spread(&filter.d));
    let Edges { v, e1, e2, n, extent } = edges;
    let (c, extent) = (difference(v, &start), *extent);
    let slack = extent.mul_add(filter.b.mul_add(extent, filter.a), filter.g);
    let minus = _mm256_set1_ps(-0.0);
    let r = cross(&c, &direction);
    let (u, v) = (dot(&r, e2), _mm256_xor_ps(minus, dot(&r, e1)));
    let d = dot(&direction, n);
    let w = _mm256_sub_ps(_mm256_sub_ps(d, u), v);
    let least = _mm256_min_ps(_mm256_min_ps(u, v), w);
    let most = _mm256_max_ps(_mm256_max_ps(u, v), w);
    let (above, below) = (_mm256_set1_ps(slack), _mm256_set1_ps(-slack));
    let possible =
        _mm256_or_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(least, below), _mm256_cmp_ps::<_CMP_LE_OQ>(most, above));
    if _mm256_movemask_ps(possible) == 0 {
        return (0, 0);
    }
    let square = extent * extent;
    let all = |x: f32| _mm256_set1_ps(x);
    let size = |x: __m256| _mm256_andnot_ps(minus, x);
    let inverse = _mm256_div_ps(all(1.0), d);
    let t = _mm256_mul_ps(dot(&c, n), inverse);
    let length = |e: &[__m256; 3]| _mm256_add_ps(_mm256_add_ps(size(e[0]), size(e[1])), size(e[2]));
    let spread = _mm256_mul_ps(size(inverse), _mm256_mul_ps(length(e1), length(e2)));
    let nearby = NEAR.mul_add(extent, filter.p);
    let far = _mm256_mul_ps(_mm256_fmadd_ps(all(filter.q), size(t), all(nearby)), spread);
    let tau = _mm256_add_ps(far, _mm256_fmadd_ps(all(FAR), size(t), all(filter.s)));
    let certain = 4.0_f32.mul_add(slack, filter.flat.mul_add(square, FLAT));
    let known = _mm256_cmp_ps::<_CMP_GT_OQ>(size(d), all(certain));
    let lo = _mm256_blendv_ps(all(f32::NEG_INFINITY), _mm256_sub_ps(t, tau), known);
    let hi = _mm256_blendv_ps(all(f32::INFINITY), _mm256_add_ps(t, tau), known);
    let here = _mm256_and_ps(
        _mm256_cmp_ps::<_CMP_GE_OQ>(hi, all(filter.t_near)),
        _mm256_cmp_ps::<_CMP_LE_OQ>(lo, all(t_far)),
    );
    let alive = _mm256_and_ps(possible, here);
    let through =
        _mm256_or_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(least, above), _mm256_cmp_ps::<_CMP_LT_OQ>(most, below));
    let within = _mm256_and_ps(
        _mm256_cmp_ps::<_CMP_GE_OQ>(lo, all(filter.first)),
        _mm256_cmp_ps::<_CMP_LE_OQ>(hi, all(filter.last)),
    );
    let sure = _mm256_and_ps(_mm256_and_ps(alive, known), _mm256_and_ps(through, within));
    // SAFETY: eight f32 each, of sixteen in two halves.
    unsafe {
        _mm256_storeu_ps(verdict.lo.as_mut_ptr().add(8 * half), lo);
        _mm256_storeu_ps(verdict.hi.as_mut_ptr().add(8 * half), hi);
    }
    let bits = |x: __m256| _mm256_movemask_ps(x) as u32 & 255;
    (bits(alive), bits(sure))
}
