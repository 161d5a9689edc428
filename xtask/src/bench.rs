//! `cargo xtask bench`: measures single rays and batches against Embree, in turns.
//!
//! The Embree side is a harness: a folder with `embree_bench.cpp`. It traces files of rays with
//! Embree and prints the same as `peer_rays` of durer-bvh does, with JSON in the last line. It is
//! compiled here if Embree's headers are installed. Each round runs Embree with its default kernel,
//! with AVX2 alone, in robust mode and in high quality, and then durer in each of its qualities,
//! all on the same rays. The report gives medians over the rounds of processor nanoseconds per ray.

use crate::Outcome;
use crate::command::{cargo, root, scratch, step};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const USAGE: &str = "usage: cargo xtask bench [--rounds N] HARNESS MESH.tri..";
const ROUNDS: usize = 5;
/// The number of programs and settings that take turns.
const ENGINES: usize = 7;
const WORKLOADS: [&str; 4] = ["primary", "ao", "diffuse", "random"];

/// Nanoseconds by mode, workload and threads, one for each round. Build times and bytes have names
/// of their own.
#[derive(Default)]
struct Figures(BTreeMap<String, Vec<f64>>);

impl Figures {
    /// Adds the figures in the last line of a program's output.
    fn take(&mut self, output: &str) -> Outcome {
        let line = output.lines().rev().find_map(|l| l.strip_prefix("JSON "));
        let line = line.ok_or_else(|| format!("no line of JSON in: {output}"))?;
        let (head, rows) = line.split_once("\"rows\":").ok_or_else(|| format!("no rows in: {line}"))?;
        for name in ["build_ms_1", "build_ms_2", "bytes", "peak_bytes"] {
            if let Some(value) = number(head, name) {
                self.0.entry(name.into()).or_default().push(value);
            }
        }
        for row in rows.split('{').skip(1) {
            if let (Some(mode), Some(work), Some(threads), Some(ns)) =
                (text(row, "mode"), text(row, "work"), number(row, "threads"), number(row, "cpu_ns"))
            {
                self.0.entry(format!("{mode} {work} {threads}")).or_default().push(ns);
            }
        }
        Ok(())
    }

    /// The median of the rounds.
    fn median(&self, name: &str) -> Option<f64> {
        let mut all = self.0.get(name)?.clone();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied()
    }
}

/// The value for a name in JSON without nesting.
fn value<'a>(json: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = json.split_once(&format!("\"{name}\":"))?;
    Some(rest.split([',', '}']).next().unwrap_or(rest).trim())
}

fn number(json: &str, name: &str) -> Option<f64> {
    value(json, name)?.parse().ok()
}

fn text<'a>(json: &'a str, name: &str) -> Option<&'a str> {
    Some(value(json, name)?.trim_matches('"'))
}

/// Compiles the harness. If that is impossible, prints what is missing.
fn harness(folder: &Path) -> Outcome<Option<PathBuf>> {
    let source = folder.join("embree_bench.cpp");
    if !source.is_file() {
        println!("Embree is not measured: there is no {}", source.display());
        return Ok(None);
    }
    let program = scratch("bench")?.join("embree_bench");
    let mut compiler = Command::new("g++");
    compiler.args(["-std=c++17", "-O3", "-march=native"]).arg(&source).arg("-o").arg(&program);
    match compiler.args(["-lembree3", "-pthread"]).output() {
        Ok(output) if output.status.success() => Ok(Some(program)),
        Ok(output) => {
            let reason = String::from_utf8_lossy(&output.stderr);
            println!(
                "Embree is not measured: its harness does not compile (Debian: apt-get install libembree-dev libtbb-dev):"
            );
            reason.lines().take(4).for_each(|line| println!("    {line}"));
            Ok(None)
        }
        Err(error) => {
            println!("Embree is not measured: g++ cannot be started: {error}");
            Ok(None)
        }
    }
}

/// The output of a program.
fn output(program: &Path, arguments: &[&str], files: [&Path; 2], load: &str) -> Outcome<String> {
    let mut command = Command::new(program);
    command.arg(files[0]).args(arguments).arg(load).arg(files[1]);
    let output = command.output().map_err(|e| format!("{}: {e}", program.display()))?;
    if !output.status.success() {
        return Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

pub(crate) fn run(words: &[String]) -> Outcome {
    let (rounds, words) = match words {
        [option, n, rest @ ..] if option == "--rounds" => (
            n.parse()
                .ok()
                .filter(|&n| n > 0)
                .ok_or_else(|| format!("bench: {n:?} is no number above 0\n{USAGE}"))?,
            rest,
        ),
        _ => (ROUNDS, words),
    };
    let [folder, meshes @ ..] = words else { return Err(USAGE.into()) };
    if meshes.is_empty() {
        return Err(USAGE.into());
    }
    let Some(embree) = harness(Path::new(folder))? else { return Ok(()) };
    let example = ["--release", "--package", "durer-bvh", "--example", "peer_rays"];
    step("cargo build --example peer_rays", cargo().arg("build").args(example))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let durer = target.join("release/examples/peer_rays");
    for mesh in meshes.iter().map(Path::new) {
        compare(&embree, &durer, mesh, rounds)?;
    }
    Ok(())
}

fn compare(embree: &Path, durer: &Path, mesh: &Path, rounds: usize) -> Outcome {
    let name = mesh.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let rays = scratch("bench")?.join("rays").join(&name);
    if !rays.join("random.hits").is_file() {
        std::fs::create_dir_all(&rays).map_err(|e| format!("{}: {e}", rays.display()))?;
        output(embree, &["--robust", "--repeats", "1", "--builds", "1"], [mesh, &rays], "--dump")?;
    }
    let engines: [(&Path, &[&str]); ENGINES] = [
        (embree, &["--repeats", "1", "--modes", "1,8,16"]),
        (embree, &["--repeats", "1", "--modes", "1,8,16", "--config", "isa=avx2"]),
        (embree, &["--repeats", "1", "--modes", "1", "--robust"]),
        (embree, &["--repeats", "1", "--modes", "1", "--config", "isa=avx2", "--high"]),
        (durer, &["--repeats", "1"]),
        (durer, &["--repeats", "1", "--modes", "single", "--quality", "fast"]),
        (durer, &["--repeats", "1", "--modes", "single", "--quality", "best"]),
    ];
    let mut figures: [Figures; ENGINES] = Default::default();
    for _ in 0..rounds {
        for ((program, arguments), figures) in engines.iter().zip(&mut figures) {
            figures.take(&output(program, arguments, [mesh, &rays], "--load")?)?;
        }
    }
    let [default, avx2, robust, high, good, fast, best] = &figures;
    report(&name, rounds, [default, avx2, robust, good]);
    let qualities =
        [("Embree medium", avx2), ("Embree high", high), ("fast", fast), ("good", good), ("best", best)];
    report_qualities(&qualities);
    Ok(())
}

/// Reports the cost of each way to build a tree, and the time of its single rays on one thread.
fn report_qualities(qualities: &[(&str, &Figures)]) {
    println!("  {:14} {:>10} {:>10} {:>12}  ns per ray: {WORKLOADS:?}", "", "ms 1 thr", "ms 2 thr", "bytes");
    for (name, figures) in qualities {
        let median = |what: &str| figures.median(what).unwrap_or(f64::NAN);
        print!(
            "  {name:14} {:10.1} {:10.1} {:12.0} ",
            median("build_ms_1"),
            median("build_ms_2"),
            median("bytes")
        );
        for work in WORKLOADS {
            print!(" {:8.1}", median(&format!("single {work} 1")));
        }
        println!();
    }
}

/// Reports the times of Embree at its best, of its robust mode and of durer, and durer's time as a
/// multiple of the other two: above 1 is slower.
fn report(name: &str, rounds: usize, [default, avx2, robust, durer]: [&Figures; 4]) {
    let best = |names: &[String]| {
        let all = names.iter().flat_map(|n| [default.median(n), avx2.median(n)]).flatten();
        all.fold(f64::INFINITY, f64::min)
    };
    println!(
        "{name}, medians of {rounds} rounds, processor ns per ray: Embree, robust, durer (durer / Embree, durer / robust)"
    );
    for (mode, modes) in [("single", &["single"][..]), ("batch", &["single", "packet8", "packet16"])] {
        for threads in [1, 2] {
            let (mut product, mut count) = (1.0_f64, 0);
            for work in WORKLOADS {
                let names: Vec<String> = modes.iter().map(|m| format!("{m} {work} {threads}")).collect();
                let other = best(&names);
                let firm = robust.median(&format!("single {work} {threads}"));
                let Some(ours) = durer.median(&format!("{mode} {work} {threads}")) else { continue };
                product *= ours / other;
                count += 1;
                let firm = firm.unwrap_or(f64::NAN);
                println!(
                    "  {mode:6} {work:8} {threads} thr {other:8.1} {firm:8.1} {ours:8.1}   ({:.2}, {:.2})",
                    ours / other,
                    ours / firm
                );
            }
            if count == WORKLOADS.len() {
                // The fourth root.
                println!("  {mode:6} {threads} thr, geometric mean: {:.2}", product.sqrt().sqrt());
            }
        }
    }
    for name in ["build_ms_1", "build_ms_2", "bytes", "peak_bytes"] {
        if let Some(ours) = durer.median(name) {
            let other = best(&[name.into()]);
            println!("  {name:10} {other:12.1} {ours:12.1}   ({:.2})", ours / other);
        }
    }
}
