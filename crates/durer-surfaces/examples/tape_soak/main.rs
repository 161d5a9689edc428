//! Tests random formulas for the given number of seconds:
//! `cargo run --release -p durer-surfaces --example tape_soak -- 60 1`.
//!
//! It runs the tests of the fuzz target `tape` without a fuzzer. The second number is the first
//! seed.

mod case;

use std::time::{Duration, Instant};

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|x| x.parse::<u64>().ok());
    let (seconds, first) = (numbers.next().unwrap_or(10), numbers.next().unwrap_or(1));
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut seed = first;
    while Instant::now() < end {
        // S. Vigna's SplitMix64.
        let mut state = seed.wrapping_mul(0xd129_0cb3_7f4a_7c15);
        let mut bits = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        let bytes: Vec<u8> = (0..64).flat_map(|_| bits().to_le_bytes()).collect();
        if std::panic::catch_unwind(|| case::check(&bytes)).is_err() {
            println!("seed {seed}");
            std::process::exit(1);
        }
        seed += 1;
    }
    println!("{} formulas without a fault", seed - first);
}
