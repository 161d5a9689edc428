//! The random numbers of the unit cubes of space, of which `cells` and `crackle` are made.
//!
//! ```text
//!   u_k(cube) = m[h + k] / 2^32,   h = p[p[p[x] ^ y] ^ z]
//! ```
//!
//! `p` is the permutation of 0 to 4095 that the scene language's noise uses, too; `m` are the
//! outputs of M. Matsumoto and T. Nishimura's generator, "Mersenne Twister", *ACM Transactions on
//! Modeling and Computer Simulation* 8 (1998) 3-30, from its standard seed 5489. Found from values
//! of the patterns in POV-Ray 3.7: at 3 000 points all are the same to nine digits.

use std::sync::OnceLock;

use super::permutation::{PERIOD, permutation, wide_hash};

/// The numbers of a cube: three in a row.
const IN_A_CUBE: usize = 3;

/// The seed of the generator.
const SEED: u32 = 5489;

/// The size of the generator's state, and the distance of the words that are combined.
const STATE: usize = 624;
const SHIFT: usize = 397;

/// The random numbers of all unit cubes. They repeat after 4096 cubes along each axis.
#[derive(Debug)]
pub struct CellNumbers {
    order: Box<[u16]>,
    numbers: Box<[f64]>,
}

impl CellNumbers {
    /// The numbers, made at the first call.
    pub fn get() -> &'static Self {
        static NUMBERS: OnceLock<CellNumbers> = OnceLock::new();
        NUMBERS.get_or_init(|| Self {
            order: permutation(),
            numbers: twister(PERIOD + IN_A_CUBE - 1)
                .into_iter()
                .map(|n| f64::from(n) / 4_294_967_296.0)
                .collect(),
        })
    }

    /// Three numbers from 0 to 1 for the cube whose lowest corner is `cube`, whole coordinates.
    pub fn of(&self, cube: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = cube.map(|c| (c as i64).rem_euclid(PERIOD as i64) as usize);
        let h = wide_hash(&self.order, x, y, z);
        core::array::from_fn(|k| self.numbers[h + k])
    }
}

/// The first outputs of the generator.
fn twister(count: usize) -> Vec<u32> {
    let mut state = [SEED; STATE];
    for i in 1..STATE {
        let before = state[i - 1];
        state[i] = (before ^ before >> 30).wrapping_mul(1_812_433_253).wrapping_add(i as u32);
    }
    let mut outputs = Vec::with_capacity(count);
    while outputs.len() < count {
        for i in 0..STATE {
            let both = state[i] & 0x8000_0000 | state[(i + 1) % STATE] & 0x7fff_ffff;
            let twist = if both & 1 == 1 { 0x9908_b0df } else { 0 };
            state[i] = state[(i + SHIFT) % STATE] ^ both >> 1 ^ twist;
        }
        outputs.extend(state.iter().take(count - outputs.len()).map(|&word| {
            let mut y = word ^ word >> 11;
            y ^= y << 7 & 0x9d2c_5680;
            y ^= y << 15 & 0xefc6_0000;
            y ^ y >> 18
        }));
    }
    outputs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_is_the_standard_one() {
        let outputs = twister(10_000);
        assert_eq!(outputs[..3], [3_499_211_612, 581_869_302, 3_890_346_734]);
        // The number that the C++ standard gives for `std::mt19937`.
        assert_eq!(outputs[9_999], 4_123_659_995);
    }

    #[test]
    fn cubes_have_the_numbers_of_the_scene_language() {
        // Values of `function { pattern { cells } }` in POV-Ray 3.7.
        for (cube, want) in [
            ([0.0, 0.0, 0.0], 0.711_818_915_326_1),
            ([-8.0, 0.0, 0.0], 0.133_780_500_851_5),
            ([0.0, -8.0, 0.0], 0.350_776_740_815_4),
            ([0.0, 0.0, 15.0], 0.524_637_345_690_2),
            ([0.0, 4.0, 0.0], 0.655_098_003_800_9),
        ] {
            let found = CellNumbers::get().of(cube)[0];
            assert!((found - want).abs() < 1e-12, "{cube:?}: {found}");
        }
    }

    #[test]
    fn far_cubes_have_numbers() {
        for c in [1e300, -1e300, f64::INFINITY, f64::NAN] {
            assert!(CellNumbers::get().of([c, 0.0, c]).iter().all(|n| (0.0..1.0).contains(n)));
        }
    }
}
