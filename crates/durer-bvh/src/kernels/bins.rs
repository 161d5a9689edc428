//! The builder's work per entry: boxes and bins, eight lanes at a time. The plain loops are the
//! definition.
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")
)]

use crate::build::{BINS, Bins, Extent, Filled};
use crate::frame::Entry;
use durer_math::Isa;

/// Grows a box around the twice-centres of entries.
pub(crate) fn add_centres(isa: Isa, entries: &[Entry], centres: &mut Extent) {
    #[cfg(target_arch = "x86_64")]
    if super::Avx2::of(isa).is_some() {
        // SAFETY: an `Avx2` exists, so an `Isa` has seen its features on this CPU.
        return unsafe { avx2::add_centres(entries, centres) };
    }
    let _ = isa;
    add_centres_in_turn(entries, centres);
}

/// Sorts entries into bins.
pub(crate) fn fill(isa: Isa, entries: &[Entry], bins: &Bins, filled: &mut Filled) {
    #[cfg(target_arch = "x86_64")]
    if super::Avx2::of(isa).is_some() {
        // SAFETY: as above.
        return unsafe { avx2::fill(entries, bins, filled) };
    }
    let _ = isa;
    fill_in_turn(entries, bins, filled);
}

fn add_centres_in_turn(entries: &[Entry], centres: &mut Extent) {
    for entry in entries {
        let [x, y, z] = [0, 1, 2].map(|axis| entry.centre2(axis));
        centres.unite(&Extent([-x, -y, -z, 0.0, x, y, z, 0.0]));
    }
}

fn fill_in_turn(entries: &[Entry], bins: &Bins, filled: &mut Filled) {
    for entry in entries {
        for axis in 0..3 {
            let bin = bins.of(entry, axis) as usize;
            filled.extents[axis][bin].add(entry);
            filled.counts[axis][bin] += 1;
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{BINS, Bins, Entry, Extent, Filled};
    use crate::build::INTEGERS;
    use core::arch::x86_64::*;

    /// The low corner, negated, and the high one. Kind and index are replaced by zeros: as f32 they
    /// would be subnormal, and subnormal numbers are slow.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn reach(entry: &Entry) -> __m256 {
        let corners = _mm256_castsi256_ps(_mm256_setr_epi32(-1, -1, -1, 0, -1, -1, -1, 0));
        // SAFETY: eight words of four bytes, aligned to 32.
        let words = unsafe { _mm256_load_ps(entry.words.as_ptr().cast()) };
        _mm256_and_ps(words, corners)
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn centres2(reach: __m256) -> __m128 {
        _mm_sub_ps(_mm256_extractf128_ps::<1>(reach), _mm256_castps256_ps128(reach))
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn load(extent: &Extent) -> __m256 {
        // SAFETY: eight f32, aligned to 32 bytes.
        unsafe { _mm256_load_ps(extent.0.as_ptr()) }
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn store(extent: &mut Extent, reach: __m256) {
        // SAFETY: as above.
        unsafe { _mm256_store_ps(extent.0.as_mut_ptr(), reach) };
    }

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn add_centres(entries: &[Entry], centres: &mut Extent) {
        // `-lo` and `hi` of a point: the coordinates with either sign.
        let negated = _mm256_castsi256_ps(_mm256_setr_epi32(i32::MIN, i32::MIN, i32::MIN, 0, 0, 0, 0, 0));
        let mut most = load(centres);
        for entry in entries {
            let x = centres2(reach(entry));
            most = _mm256_max_ps(_mm256_xor_ps(_mm256_set_m128(x, x), negated), most);
        }
        store(centres, most);
    }

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn fill(entries: &[Entry], bins: &Bins, filled: &mut Filled) {
        // SAFETY: four f32 each.
        let four = |v: &[f32; 4]| unsafe { _mm_loadu_ps(v.as_ptr()) };
        let (from, scale) = (four(&bins.from), four(&bins.scale));
        let (half, integers) = (_mm_set1_ps(0.5), _mm_set1_ps(INTEGERS));
        let mask = _mm_set1_epi32(BINS as i32 - 1);
        let Filled { extents: [ex, ey, ez], counts: [cx, cy, cz] } = filled;
        // Two halves side by side: neighbours often go to the same bin, where each would have to
        // wait for the one before.
        let (first, second) = entries.split_at(entries.len() / 2);
        let pairs = second.iter().zip(first.iter().map(Some).chain([None]));
        for entry in pairs.flat_map(|(b, a)| a.into_iter().chain([b])) {
            let reach = reach(entry);
            let x = _mm_sub_ps(_mm_mul_ps(_mm_sub_ps(centres2(reach), from), scale), half);
            let bins = _mm_and_si128(_mm_castps_si128(_mm_add_ps(x, integers)), mask);
            let x = _mm_extract_epi32::<0>(bins) as usize % BINS;
            let y = _mm_extract_epi32::<1>(bins) as usize % BINS;
            let z = _mm_extract_epi32::<2>(bins) as usize % BINS;
            for (extents, counts, bin) in [(&mut *ex, &mut *cx, x), (ey, cy, y), (ez, cz, z)] {
                // Of two equal numbers the second is taken, as in the definition.
                let most = _mm256_max_ps(reach, load(&extents[bin]));
                store(&mut extents[bin], most);
                counts[bin] += 1;
            }
        }
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use durer_math::{Aabb, Point3};
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = [f64; 3]> {
        let coordinate =
            prop_oneof![-1.0..1.0_f64, (-4_i32..=4).prop_map(|i| f64::from(i) / 4.0), Just(-0.0)];
        prop::array::uniform3(coordinate)
    }

    fn same(a: &Extent, b: &Extent) -> bool {
        let bits = |e: &Extent| [0, 1, 2, 4, 5, 6].map(|i| e.0[i].to_bits());
        bits(a) == bits(b)
    }

    proptest! {
        #[test]
        fn lanes_fill_bins_as_loops_do(boxes in prop::collection::vec((point(), point()), 1..200)) {
            let frame = Frame::around(&Aabb::from_points([Point3::new(1.0, 1.0, 1.0)]));
            let bounds = |(a, b): &([f64; 3], [f64; 3])| Aabb::from_points([Point3::from(*a), Point3::from(*b)]);
            let entries: Vec<Entry> =
                boxes.iter().enumerate().map(|(i, b)| frame.entry(&bounds(b), 1, i as u32)).collect();
            let mut centres = Extent::EMPTY;
            add_centres_in_turn(&entries, &mut centres);
            let bins = Bins::over(&centres);
            let mut filled = Filled::EMPTY;
            fill_in_turn(&entries, &bins, &mut filled);
            for isa in Isa::available() {
                let (mut other, mut refilled) = (Extent::EMPTY, Filled::EMPTY);
                add_centres(isa, &entries, &mut other);
                prop_assert_eq!((centres.lo(), centres.hi()), (other.lo(), other.hi()));
                fill(isa, &entries, &bins, &mut refilled);
                prop_assert_eq!(filled.counts, refilled.counts);
                let (a, b) = (filled.extents.as_flattened(), refilled.extents.as_flattened());
                prop_assert!(a.iter().zip(b).all(|(a, b)| same(a, b)));
            }
        }
    }
}
