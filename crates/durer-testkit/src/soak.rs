//! Cases by the thousand: how a test draws more of them in a soak (`cargo xtask soak`).

use crate::TestRng;
use core::ops::Range;

/// The numbers of the cases that this run tests, where a normal test run tests `count`.
///
/// `DURER_SOAK=N` tests N times as many, and `DURER_SOAK_FROM=K` starts after the cases of K such
/// runs (`cargo xtask soak`).
pub fn drawn(count: u64) -> Range<u64> {
    let variable = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    let from = variable("DURER_SOAK_FROM").unwrap_or(0);
    count * from..count * (from + variable("DURER_SOAK").unwrap_or(1))
}

/// The random numbers of one of these cases: they differ for all seeds and cases.
pub fn dice(seed: u64, case: u64) -> TestRng {
    TestRng::new(case_seed(seed, case))
}

/// The seed of one of these cases.
pub fn case_seed(seed: u64, case: u64) -> u64 {
    seed.wrapping_mul(0x1_0000_0001).wrapping_add(case)
}

/// Prints how many rays obeyed the laws, for a soak test to add up.
pub fn report(rays: u64) {
    if std::env::var_os("DURER_SOAK").is_some() {
        println!("soaked: {} {rays}", std::thread::current().name().unwrap_or("laws"));
    }
}
