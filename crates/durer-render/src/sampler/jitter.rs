//! Random shifts that depend only on counters.

/// The finaliser of splitmix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom
/// number generators", OOPSLA 2014).
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A pseudorandom number in `[0, 1)`, a function of three counters.
pub(crate) fn random(a: u64, b: u64, dimension: u64) -> f64 {
    let bits = mix(mix(mix(a) ^ b) ^ dimension);
    (bits >> 11) as f64 / 9_007_199_254_740_992.0 // 2^53
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_even_and_their_own() {
        let n = 10_000;
        let mean = (0..n).map(|i| random(i, 7, 0)).sum::<f64>() / n as f64;
        // The mean's standard deviation is sqrt(1/12 / n) = 0.0029.
        assert!((mean - 0.5).abs() < 0.0130);
        let together =
            (0..n).map(|i| (random(i, 7, 0) - 0.5) * (random(i, 7, 1) - 0.5)).sum::<f64>() / n as f64;
        assert!(together.abs() < 0.0038); // 4.5 sigma of 1/12 / sqrt(n)
        assert_eq!(random(1, 2, 3), random(1, 2, 3));
    }
}
