//! `cargo xtask soak`: runs the tests with random cases in turns, each with cases that no turn
//! before has drawn. docs/reliability.md adds up the results.
//!
//! Each turn runs the kind with the fewest rays so far, and takes about a minute.

use crate::Outcome;
use crate::command::{built, root, scratch};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const PAGE: &str = "docs/reliability.md";
/// The start of the line that the next turn reads.
const DRAWN: &str = "<!-- drawn: ";
/// The intended time of a turn. While the speed of a kind is not known, its turn may be shorter.
const TURN: Duration = Duration::from_secs(60);
/// The greatest growth of the number of cases from turn to turn. The speed of a short turn is not a
/// reliable measure.
const GROWTH: f64 = 32.0;
/// The tests of durer-surfaces in a soak have one of these in their names.
const LAWS: [&str; 7] = [
    "obey_the_laws",
    "have_their_exact_crossings",
    "rays_from_inside",
    "no_ray_escapes",
    "a_parametric_",
    "the_union_of_balls",
    "certain_signs_at_their_ends",
];

/// Tests that are counted together.
struct Kind {
    name: String,
    program: Program,
    /// The names of the tests; empty for all tests of the program.
    tests: Vec<String>,
    /// The number of cases of the next turn, as a multiple of an ordinary test run.
    factor: u64,
}

/// A test program.
#[derive(Clone, Copy)]
struct Program {
    package: &'static str,
    target: &'static [&'static str],
}

const MESHES: Program = Program { package: "durer-geometry", target: &["--test", "leaks"] };
const SURFACES: Program = Program { package: "durer-surfaces", target: &["--lib"] };
/// Test programs that are kinds of their own, with their names.
const PROGRAMS: [(&str, Program); 5] = [
    ("meshes", MESHES),
    ("blobs", Program { package: "durer-surfaces", target: &["--test", "blobs"] }),
    ("deformed solids", Program { package: "durer-surfaces", target: &["--test", "deform"] }),
    ("isosurfaces", Program { package: "durer-surfaces", target: &["--test", "isosurface"] }),
    ("Julia sets", Program { package: "durer-surfaces", target: &["--test", "julia_sets"] }),
];

/// The sums on the page.
#[derive(Debug, Default)]
struct Sums {
    /// The cases that each kind has drawn, as a multiple of an ordinary test run.
    drawn: BTreeMap<String, u64>,
    /// The rays and the failed tests of each row.
    rows: BTreeMap<String, (u64, u64)>,
}

/// The request on the command line.
#[derive(Debug, PartialEq)]
struct Request {
    minutes: u64,
    /// The number of rays at which a kind stops.
    rays: u64,
    /// The requested kinds; empty for all.
    kinds: Vec<String>,
}

impl Request {
    fn read(words: &[String]) -> Outcome<Self> {
        let mut request = Self { minutes: 60, rays: u64::MAX, kinds: vec![] };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut number = || {
                let n = words.next().ok_or_else(|| format!("soak: {word} needs a number"))?;
                n.parse().ok().filter(|&n| n > 0).ok_or_else(|| format!("soak: {n:?} is no number from 1 on"))
            };
            match word.as_str() {
                "--minutes" => request.minutes = number()?,
                "--rays" => request.rays = number()?,
                _ if word.starts_with('-') => {
                    return Err(format!(
                        "soak: there is no option {word}; there are --minutes N and --rays N"
                    ));
                }
                _ => request.kinds.push(word.clone()),
            }
        }
        Ok(request)
    }
}

/// Runs turns until the time is over or all kinds have enough rays.
pub(crate) fn run(words: &[String]) -> Outcome {
    let request = Request::read(words)?;
    let path = root().join(PAGE);
    let surfaces = SURFACES.build()?;
    let mut kinds = kinds(&surfaces)?;
    if let Some(name) = request.kinds.iter().find(|name| kinds.iter().all(|kind| kind.name != **name)) {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name.as_str()).collect();
        return Err(format!("soak: there is no kind {name:?}; there are {}", names.join(", ")));
    }
    kinds.retain(|kind| request.kinds.is_empty() || request.kinds.contains(&kind.name));
    let mut programs = BTreeMap::from([(SURFACES.name(), surfaces)]);
    let mut sums = Sums::read(&std::fs::read_to_string(&path).unwrap_or_default());
    let end = Instant::now() + Duration::from_secs(60 * request.minutes);
    while Instant::now() < end {
        let Some(kind) = kinds.iter_mut().min_by_key(|kind| sums.rays(&kind.name)) else { break };
        if sums.rays(&kind.name) >= request.rays {
            break;
        }
        let program = match programs.get(&kind.program.name()) {
            Some(program) => program.clone(),
            None => kind.program.build()?,
        };
        programs.insert(kind.program.name(), program.clone());
        let start = Instant::now();
        let outcome = kind.turn(&program, &mut sums);
        // The results so far are saved, whatever happens next.
        std::fs::write(&path, sums.page()).map_err(|e| format!("{PAGE}: {e}"))?;
        outcome?;
        if sums.rays(&kind.name) == 0 {
            return Err(format!("{}: its tests report no rays", kind.name));
        }
        kind.factor = next_factor(kind.factor, start.elapsed());
    }
    println!("{}", sums.table());
    Ok(())
}

/// The factor for a turn of the intended time, if a turn with `factor` took this long.
fn next_factor(factor: u64, took: Duration) -> u64 {
    let growth = (TURN.as_secs_f64() / took.as_secs_f64().max(1e-3)).min(GROWTH);
    ((factor as f64 * growth) as u64).max(1)
}

/// The kinds: some test programs, and all modules of durer-surfaces with tests of the laws.
fn kinds(surfaces: &Path) -> Outcome<Vec<Kind>> {
    let whole =
        |(name, program): (&str, Program)| Kind { name: name.into(), program, tests: vec![], factor: 1 };
    let mut kinds: Vec<Kind> = PROGRAMS.into_iter().map(whole).collect();
    let list = Command::new(surfaces).arg("--list").output();
    let list = list.map_err(|e| format!("{}: cannot start: {e}", surfaces.display()))?;
    if !list.status.success() {
        return Err(format!("{}: {}", surfaces.display(), String::from_utf8_lossy(&list.stderr)));
    }
    let list = String::from_utf8_lossy(&list.stdout);
    let is_law = |name: &&str| LAWS.iter().any(|law| name.contains(law));
    for test in list.lines().filter_map(|line| line.strip_suffix(": test")).filter(is_law) {
        let name = module(test);
        match kinds.iter_mut().find(|kind| kind.name == name) {
            Some(kind) => kind.tests.push(test.into()),
            None => kinds.push(Kind { name, program: SURFACES, tests: vec![test.into()], factor: 1 }),
        }
    }
    Ok(kinds)
}

impl Program {
    /// A name for a file, one for each program.
    fn name(self) -> String {
        let target = self.target.join("-");
        format!("{}{target}", self.package)
    }

    /// Builds the program and keeps a copy, so that later builds do not change a running soak.
    fn build(self) -> Outcome<PathBuf> {
        let arguments = [&["test", "--release", "--no-run", "--package", self.package], self.target].concat();
        let path = built(&format!("cargo {}", arguments.join(" ")), &arguments, |_| true)?;
        let copy = scratch("soak")?.join(self.name());
        std::fs::copy(path, &copy).map_err(|e| format!("{}: {e}", copy.display()))?;
        Ok(copy)
    }
}

impl Kind {
    fn turn(&self, program: &Path, sums: &mut Sums) -> Outcome {
        let from = sums.drawn.get(&self.name).copied().unwrap_or(0);
        println!("==> {}: {} times the cases of a test run, after {from}", self.name, self.factor);
        let mut child = Command::new(program)
            .args(["--nocapture", "--exact", "--quiet"])
            .args(&self.tests)
            .env("DURER_SOAK", self.factor.to_string())
            .env("DURER_SOAK_FROM", from.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| format!("{}: cannot start: {e}", self.name))?;
        let mut failures = Vec::new();
        let mut listed = false;
        for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
            let line = line.map_err(|e| format!("{}: {e}", self.name))?;
            // The test harness prints its dots before the output of a test.
            if let Some((_, soaked)) = line.split_once("soaked: ") {
                let (test, rays) = soaked.rsplit_once(' ').unwrap_or((soaked, "0"));
                sums.rows.entry(self.row(test)).or_default().0 += rays.parse::<u64>().unwrap_or(0);
            } else if line == "failures:" {
                listed = true;
            } else if let Some(test) = line.strip_prefix("    ").filter(|_| listed) {
                failures.push(self.row(test));
            }
        }
        let status = child.wait().map_err(|e| format!("{}: {e}", self.name))?;
        *sums.drawn.entry(self.name.clone()).or_default() += self.factor;
        for name in &failures {
            sums.rows.entry(name.clone()).or_default().1 += 1;
        }
        if status.success() { Ok(()) } else { Err(format!("{}: failed ({status})", self.name)) }
    }

    /// The row in which a test is counted. Tests of meshes have rows of their own.
    fn row(&self, test: &str) -> String {
        if self.tests.is_empty() { format!("{}: {}", self.name, module(test)) } else { self.name.clone() }
    }
}

/// The module that a test tests, in words; the test's own name if it has no module.
fn module(test: &str) -> String {
    let module = match test.split_once("::tests") {
        Some((module, _)) => module,
        None => test.rsplit_once("_tests::").map_or(test, |(module, _)| module),
    };
    module.replace("::", " ").replace('_', " ")
}

impl Sums {
    /// The number of rays of a kind: the least of its rows.
    fn rays(&self, kind: &str) -> u64 {
        let is_of =
            |row: &str| row == kind || row.strip_prefix(kind).is_some_and(|rest| rest.starts_with(": "));
        self.rows.iter().filter(|(row, _)| is_of(row)).map(|(_, sums)| sums.0).min().unwrap_or(0)
    }

    /// Reads the sums on a page; empty if it is not one of ours.
    fn read(page: &str) -> Self {
        let mut sums = Self::default();
        for line in page.lines() {
            if let Some(drawn) = line.strip_prefix(DRAWN).and_then(|rest| rest.strip_suffix(" -->")) {
                let pairs = drawn.split(", ").filter_map(|pair| pair.rsplit_once(' '));
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
        let mut table = String::from("| kind | rays | violations | rate below |\n|---|---:|---:|---:|\n");
        for (name, &(rays, failed)) in &self.rows {
            // The rule of three: with no failure in n cases, the rate is below 3/n with a
            // confidence of 95 %.
            let bound =
                if failed == 0 && rays > 0 { format!("{:.1e}", 3.0 / rays as f64) } else { "-".into() };
            let _ = writeln!(table, "| {name} | {} | {failed} | {bound} |", grouped(rays));
        }
        table
    }

    fn page(&self) -> String {
        let drawn: Vec<String> = self.drawn.iter().map(|(name, n)| format!("{name} {n}")).collect();
        format!(
            "# Reliability\n\n`cargo xtask soak` runs the laws that every test run checks, with ever new rays, and adds up this table. \
             Each turn goes to the kind with the fewest rays. `--minutes N` limits the time (60), `--rays N` the rays of each kind, and names of kinds the kinds.\n\n\
             - **meshes**: closed meshes (a grid of integers, an icosphere, a body with spikes; shifted by up to 10⁶, scaled by 10⁻⁶, turned by a placement); rays from inside, half of them \
             aimed exactly at vertices and points of edges, some along axes. Each has to cross an odd number of times, and the first crossing is the closest hit (`crates/durer-geometry/tests/leaks.rs`).\n\
             - **blobs**, **Julia sets**, **isosurfaces**, **deformed solids**: signs at the ends of brackets in exact arithmetic or 256 bits, and the same surface in another form \
             (`crates/durer-surfaces/tests`).\n\
             - **other kinds**: rays aimed at tangents, edges and vertices from near and far. The laws compare the surface's answers with exact arithmetic: no crossing is missing, extra, doubled or \
             outside its bracket, points and normals are within their bounds, and rays that leave the surface start on its right side and meet what the exact ray meets \
             (`crates/durer-surfaces/src/laws`). A ray counts once, with all rays that leave its crossings.\n\n\
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
            drawn: [("meshes".into(), 2500), ("quadric general".into(), 1)].into(),
            rows: [("torus".into(), (1_234_567, 0)), ("meshes: leaks".into(), (40, 2))].into(),
        };
        let read = Sums::read(&sums.page());
        assert_eq!((&read.drawn, &read.rows), (&sums.drawn, &sums.rows));
        assert!(sums.table().contains("| torus | 1 234 567 | 0 | 2.4e-6 |"), "{}", sums.table());
    }

    #[test]
    fn a_test_counts_for_its_module() {
        assert_eq!(module("prism::curved::tests::prisms_obey_the_laws"), "prism curved");
        assert_eq!(module("closed_meshes_leak_nowhere"), "closed meshes leak nowhere");
    }

    #[test]
    fn a_kind_has_had_as_many_rays_as_the_least_of_its_rows() {
        let rows = [("quadric", 9), ("quadric general", 3), ("meshes: a", 7), ("meshes: b", 5)];
        let rows = rows.map(|(name, rays)| (name.to_string(), (rays, 0)));
        let sums = Sums { rows: rows.into(), ..Sums::default() };
        assert_eq!(
            ["quadric", "quadric general", "meshes", "torus"].map(|kind| sums.rays(kind)),
            [9, 3, 5, 0]
        );
    }

    #[test]
    fn turns_become_a_minute_long() {
        assert_eq!(next_factor(10, Duration::from_secs(30)), 20);
        assert_eq!(next_factor(10, Duration::from_secs(600)), 1);
        assert_eq!(next_factor(1, Duration::from_secs(600)), 1);
        assert_eq!(next_factor(1, Duration::ZERO), 32);
    }

    #[test]
    fn what_is_asked_for_is_read() {
        let read = |words: &str| Request::read(&words.split(' ').map(String::from).collect::<Vec<_>>());
        let request = Request { minutes: 5, rays: 9, kinds: vec!["torus".into()] };
        assert_eq!(read("--minutes 5 torus --rays 9"), Ok(request));
        assert_eq!(read("--minutes"), Err("soak: --minutes needs a number".into()));
        assert_eq!(read("--rays 0"), Err("soak: \"0\" is no number from 1 on".into()));
        assert!(read("--hours 5").is_err());
    }
}
