//! Any bytes as a formula: its bounds hold its values, its slopes its changes, its roots are in
//! order.
#![no_main]

#[path = "../../crates/durer-surfaces/examples/tape_soak/case.rs"]
mod case;

libfuzzer_sys::fuzz_target!(|data: &[u8]| case::check(data));
