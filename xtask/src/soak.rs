//! `cargo xtask soak`: the tests that draw their cases at random, with many more of them than a test run has time for.

use crate::Outcome;
use crate::command::{cargo, step};

/// How many times as many cases: the meshes' rays come to 10^9, the others to about an hour of one core.
const TESTS: [(&str, &[&str], u64); 3] = [
    ("durer-geometry", &["--test", "leaks"], 3200),
    ("durer-math", &["--tests"], 20),
    ("durer-surfaces", &["--lib", "laws"], 20),
];

/// Runs them all, or with the factor that is given in place of theirs.
pub(crate) fn run(words: &[String]) -> Outcome {
    let given = match words {
        [] => None,
        [n] => Some(
            n.parse::<u64>()
                .ok()
                .filter(|&n| n > 0)
                .ok_or_else(|| format!("soak: {n:?} is no number above 0"))?,
        ),
        _ => return Err("soak: at most one factor".into()),
    };
    for (package, tests, factor) in TESTS {
        let factor = given.unwrap_or(factor);
        let mut command = cargo();
        command
            .args(["test", "--release", "--package", package])
            .args(tests)
            .env("DURER_SOAK", factor.to_string());
        step(&format!("{package} {}, {factor} times", tests.join(" ")), &mut command)?;
    }
    Ok(())
}
