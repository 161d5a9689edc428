//! `cargo xtask soak`: the tests that draw their cases at random, round after round, with cases that no round before has drawn; docs/reliability.md adds them up.

use crate::Outcome;
use crate::command::{cargo, root};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// What is run in each round, and how many times as many cases as in a test run: a round takes some minutes.
const TESTS: [Test; 3] = [
    Test { name: "meshes", package: "durer-geometry", select: &["--test", "leaks"], factor: 40 },
    Test { name: "surfaces", package: "durer-surfaces", select: &["--lib", "laws"], factor: 1 },
    Test { name: "numbers", package: "durer-math", select: &["--tests"], factor: 1 },
];

const PAGE: &str = "docs/reliability.md";
/// Before what the next round needs to know.
const DRAWN: &str = "<!-- drawn: ";

struct Test {
    name: &'static str,
    package: &'static str,
    select: &'static [&'static str],
    factor: u64,
}

/// What the page adds up.
#[derive(Debug, Default)]
struct Sums {
    /// How many times the cases of a test run each of the tests has drawn.
    drawn: BTreeMap<String, u64>,
    /// Rays, and tests that failed, of each row.
    rows: BTreeMap<String, (u64, u64)>,
}

/// Runs rounds until so many minutes are over, an hour if it is not said.
pub(crate) fn run(words: &[String]) -> Outcome {
    let minutes = match words {
        [] => 60,
        [flag, n] if flag == "--minutes" => {
            n.parse().ok().filter(|&n| n > 0).ok_or_else(|| format!("soak: {n:?} is no number of minutes"))?
        }
        _ => return Err("soak: only --minutes N is understood".into()),
    };
    let path = root().join(PAGE);
    let end = Instant::now() + Duration::from_secs(60 * minutes);
    let mut sums = Sums::read(&std::fs::read_to_string(&path).unwrap_or_default());
    while Instant::now() < end {
        for test in &TESTS {
            let outcome = test.round(&mut sums);
            // What has been seen stays seen, whatever comes next.
            std::fs::write(&path, sums.page()).map_err(|e| format!("{PAGE}: {e}"))?;
            outcome?;
        }
    }
    println!("{}", sums.table());
    Ok(())
}

impl Test {
    fn round(&self, sums: &mut Sums) -> Outcome {
        let from = sums.drawn.get(self.name).copied().unwrap_or(0);
        println!("==> {}: {} times the cases of a test run, after {from}", self.name, self.factor);
        let mut child = cargo()
            .args(["test", "--release", "--quiet", "--package", self.package])
            .args(self.select)
            .args(["--", "--nocapture"])
            .env("DURER_SOAK", self.factor.to_string())
            .env("DURER_SOAK_FROM", from.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| format!("{}: cannot start: {e}", self.name))?;
        let mut failures = Vec::new();
        let mut listed = false;
        for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
            let line = line.map_err(|e| format!("{}: {e}", self.name))?;
            // The harness puts its dots before what a test prints.
            if let Some((_, soaked)) = line.split_once("soaked: ") {
                let (name, rays) = soaked.rsplit_once(' ').unwrap_or((soaked, "0"));
                sums.rows.entry(row(self.name, name)).or_default().0 += rays.parse::<u64>().unwrap_or(0);
            } else if line == "failures:" {
                listed = true;
            } else if let Some(name) = line.strip_prefix("    ").filter(|_| listed) {
                failures.push(row(self.name, name));
            }
        }
        let status = child.wait().map_err(|e| format!("{}: {e}", self.name))?;
        *sums.drawn.entry(self.name.into()).or_default() += self.factor;
        for name in &failures {
            sums.rows.entry(name.clone()).or_default().1 += 1;
        }
        if status.success() { Ok(()) } else { Err(format!("{}: failed ({status})", self.name)) }
    }
}

/// The row of a test: its module, without what all tests share.
fn row(test: &str, name: &str) -> String {
    let module = name.split("::tests").next().unwrap_or(name);
    format!("{test}: {}", module.replace("::", " ").replace('_', " "))
}

impl Sums {
    /// What a page has added up; nothing, if it is not one of ours.
    fn read(page: &str) -> Self {
        let mut sums = Self::default();
        for line in page.lines() {
            if let Some(drawn) = line.strip_prefix(DRAWN).and_then(|rest| rest.strip_suffix(" -->")) {
                let pairs = drawn.split(", ").filter_map(|pair| pair.split_once(' '));
                sums.drawn = pairs.filter_map(|(name, n)| Some((name.into(), n.parse().ok()?))).collect();
            }
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            if let [name, rays, failed, _] = cells[..]
                && let (Ok(rays), Ok(failed)) = (rays.replace(' ', "").parse(), failed.parse())
            {
                sums.rows.insert(name.into(), (rays, failed));
            }
        }
        sums
    }

    fn table(&self) -> String {
        let mut table = String::from("| what | rays | violations | rate below |\n|---|---:|---:|---:|\n");
        for (name, &(rays, failed)) in &self.rows {
            // The rule of three: with none in n, the rate is below 3/n with a confidence of 95 %.
            let bound =
                if failed == 0 && rays > 0 { format!("{:.1e}", 3.0 / rays as f64) } else { "-".into() };
            let _ = writeln!(table, "| {name} | {} | {failed} | {bound} |", grouped(rays));
        }
        table
    }

    fn page(&self) -> String {
        let drawn: Vec<String> = self.drawn.iter().map(|(name, n)| format!("{name} {n}")).collect();
        format!(
            "# Reliability\n\nAdded up by `cargo xtask soak [--minutes N]`: the laws that every test run checks for some rays, checked for ever more of them.\n\n\
             - **meshes**: closed meshes (a grid of integers, an icosphere, a body with spikes; shifted by up to 10⁶, scaled by 10⁻⁶, turned by a placement); rays from inside, half of them \
             aimed exactly at vertices and points of edges, some along axes. Each has to cross an odd number of times, and the first crossing is the closest hit (`crates/durer-geometry/tests/leaks.rs`).\n\
             - **surfaces**: rays aimed at tangents, edges and vertices from near and far; what a surface says of them against exact arithmetic: no crossing missing, extra, doubled or outside its bracket \
             (`crates/durer-surfaces/src/laws`).\n\
             - **numbers**: the laws of durer-math, of which no rays are counted.\n\n\
             With no violation in n rays the rate is below 3/n with a confidence of 95 %.\n\n{}\n{DRAWN}{} -->\n",
            self.table(),
            drawn.join(", ")
        )
    }
}

/// Digits in groups of three.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_read_as_it_was_written() {
        let sums = Sums {
            drawn: [("meshes".into(), 2500), ("surfaces".into(), 1)].into(),
            rows: [("surfaces: torus".into(), (1_234_567, 0)), ("meshes: leaks".into(), (40, 2))].into(),
        };
        let read = Sums::read(&sums.page());
        assert_eq!((&read.drawn, &read.rows), (&sums.drawn, &sums.rows));
        assert!(sums.table().contains("| surfaces: torus | 1 234 567 | 0 | 2.4e-6 |"), "{}", sums.table());
    }

    #[test]
    fn a_test_counts_for_its_module() {
        assert_eq!(row("surfaces", "prism::curved::tests::obeys_the_laws"), "surfaces: prism curved");
        assert_eq!(row("meshes", "closed_meshes_leak_nowhere"), "meshes: closed meshes leak nowhere");
    }
}
