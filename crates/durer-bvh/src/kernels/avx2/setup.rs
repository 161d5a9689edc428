//! The setup of a ray for a tree.
#![expect(unsafe_code, reason = "vector loads and stores")]

use super::node::{Numbers, stored};
use crate::frame::up32;
use crate::ray::{
    ClippedRay, CullRay, LEAST, LONGEST, NEARBY, Ray32, Ray64, Rounding, SLOWEST, TO_NEAREST, U32, WIDEN,
};
use crate::tree::Bvh;
use crate::triangles::ROUGH;
use core::arch::x86_64::*;

/// The error that [`nearby`] charges, in units of the greatest coordinate of the tree and of the
/// origin.
pub(in crate::kernels) const SLACK: (f32, f32) = (4.0 * U32 as f32, 7.0 * U32 as f32);
/// Eight units: errors are rounded to f32, multiplied, added and increased by this, one rounding
/// each. The range has fewer roundings.
pub(in crate::kernels) const OUTWARD: f32 = 8.0 * U32 as f32;

/// Sets up a ray that starts near the tree, in f32, without clipping it to the tree's box.
///
/// Let `u = 2^-24`, `M` the greatest magnitude of a coordinate of the tree on an axis, `o` that of
/// the origin, and `e` and `g` the errors of origin and direction. Both `e + 6 g` and so `g` are at
/// most [`ROUGH`] (else the answer is `None`), so `t` is at most `(1 + NEARBY + e) / (1 - g) < 6`
/// in magnitude within the tree, where the ray's points err by `e + 6 g`. A component of the
/// direction below `(M + o) u / 20` is replaced by that value, which moves the points by less than
/// `0.3 u (M + o)`. `r` errs by two units, one of `d` and one of its own; so a plane at `x` is met
/// at `x r - o r` with an error of at most
///
/// ```text
///     |r| (u (2 M  +  4 o  +  o  +  M + o  +  0.3 (M + o))  +  e + 6 g).
///              x r    o r    -slack  sum       bent
/// ```
///
/// [`SLACK`] pays for this and for second-order terms; [`OUTWARD`] for the roundings of the errors
/// and of the range. The effect of underflow on them is far below either.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn nearby(tree: &Bvh, glance: &Ray32) -> Option<(Numbers, ClippedRay)> {
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
    // In a tree that f32 does not suit, every origin is far away, or NaN.
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
    let way = ClippedRay {
        start: stored(o),
        direction: stored(d),
        t_near: fourth(first),
        t_far: fourth(last),
        is_exact: glance.is_exact,
        error,
        t_enter: 0.0,
        units: tree.frame.units(),
    };
    Some((Numbers::new(r, near, far, octant, way.t_near), way))
}

/// The result of [`clip`].
pub(super) enum Clipped {
    Missed,
    Enters(CullRay),
    /// The ray is far away, or the tree's size is unusual: `Bvh::cull` decides.
    Unusual,
}

/// Parameters below this are certain although a zero component of the direction counts as
/// [`SLOWEST`], `2^-300`: a ray that is in the box on that axis leaves the box with its margin of
/// `2^-40` only at `2^260`.
const CERTAIN: f64 = durer_math::scale::pow2(256);

/// `CullRay::new` for an exactly known ray, all axes at once and without branches.
///
/// It differs in two ways, both conservative. A component of the direction that is (nearly) zero is
/// replaced by [`SLOWEST`], for which the box is slightly larger. A value that is rounded to f32 is
/// moved outward before the rounding, by as much as rounding to nearest may move it inward, instead
/// of after.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn clip(tree: &Bvh, line: &Ray64) -> Clipped {
    let minus = _mm256_set1_pd(-0.0);
    let all = |x: f64| _mm256_set1_pd(x);
    let size = |x: __m256d| _mm256_andnot_pd(minus, x);
    // SAFETY: four f64 each, aligned to 32 bytes as the first fields of a struct with that
    // alignment.
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
        let is_certain = enter.abs().max(exit.abs()) < CERTAIN;
        return if is_certain { Clipped::Missed } else { Clipped::Unusual };
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
        way: ClippedRay {
            start: four(start),
            direction: four(d),
            t_near: 0.0,
            t_far: up32(way.next_up()),
            is_exact: false,
            error: f64::MIN_POSITIVE,
            t_enter: enter,
            units: tree.frame.units(),
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
