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
        let mut rng = durer_testkit::TestRng::new(seed);
        let bytes: Vec<u8> = (0..64).flat_map(|_| rng.bits().to_le_bytes()).collect();
        if std::panic::catch_unwind(|| case::check(&bytes)).is_err() {
            println!("seed {seed}");
            std::process::exit(1);
        }
        seed += 1;
    }
    println!("{} formulas without a fault", seed - first);
}
