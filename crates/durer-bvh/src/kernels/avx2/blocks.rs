//! A ray against the triangles of a block: eight at a time, in two halves.
#![expect(unsafe_code, reason = "vector loads and stores")]

use crate::triangles::{Block, FAR, FLAT, Filter, NEAR, Verdict};
use core::arch::x86_64::*;

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

/// Eight triangles, half a block, without a ray: the first corner, the edges from there, their
/// cross product, and the size of the block.
pub(in crate::kernels) struct Edges {
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
pub(in crate::kernels) fn edges(block: &Block, half: usize) -> Edges {
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
pub(super) fn judge(block: &Block, filter: &Filter, t_far: f32) -> Verdict {
    let mut verdict = Verdict::NOTHING;
    judge_halves(&[edges(block, 0), edges(block, 1)], filter, t_far, &mut verdict);
    verdict
}

/// `Scalar::judge` in two halves. Writes the other results only if a triangle is alive.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(in crate::kernels) fn judge_halves(
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

/// One half: which triangles are alive, and which of these are certainly hit. Most calls end at the
/// first test.
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
