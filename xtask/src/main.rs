//! Maintenance tasks of the project, run as `cargo xtask NAME`.
//!
//! - `test`: the checks that must pass before a change goes in ([`checks`]);
//! - `conformance`: compares our pictures with POV-Ray's, and the time and memory of both
//!   ([`conformance`]);
//! - `differential`: renders random scenes with both programs, and reduces those whose pictures
//!   differ ([`differential`]);
//! - `gallery`: makes the pictures and pages of docs/gallery.md ([`gallery`]);
//! - `examples`: compares the scenes that come with POV-Ray, rendered by both programs
//!   ([`examples`]);
//! - `bench`: measures the triangle kernels against Embree's, on the same rays ([`mod@bench`]);
//! - `python`: builds and tests the Python package ([`python`]);
//! - `soak`: runs the random tests with ever new cases, and adds up the results ([`soak`]);
//! - `fused`: finds compiled code that calls `fma` where one instruction should do ([`fused`]).
//!
//! The tasks run the programs that a user has: cargo, the `durer` command built for release, and
//! `povray`.
#![forbid(unsafe_code)]

mod bench;
mod checks;
mod command;
mod compare;
mod conformance;
mod differential;
mod examples;
mod fused;
mod gallery;
mod picture;
mod povray;
mod python;
mod report;
mod scenes;
mod soak;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask NAME

  test                             formatting, clippy, docs, all tests and doc-tests, every scene, the Python package
  conformance [--check] [SCENE]..  renders tests/conformance with durer and with POV-Ray, compares, times, and
                                   writes docs/conformance.md; --check only compares, SCENEs limit it to a few
  conformance --distribution [WORD]  renders POV-Ray's own scenes, all or those with WORD in their path, with both
                                   programs: a table, and a page of pictures under target/ (Python, numpy, pillow)
  differential [--looks] [--scenes N] [--seed S] [--first K] [--whole] [--threads N] [--durer PROGRAM]
                                   renders N random scenes (100) of seed S (1) from the K-th (0) on with durer and with POV-Ray:
                                   solids, or with --looks textures, patterns, cameras, lights, atmosphere and the words of the
                                   language; what differs is cut back, unless --whole, and left in target/differential.
                                   --durer takes a program that is there in place of building one
  gallery [SCENE]..                renders scenes/ into docs/gallery and writes docs/gallery.md
  examples [SCENE]..               compares the scenes that come with POV-Ray and writes docs/examples.md
  bench [--rounds N] HARNESS MESH.tri..
                                   traces the same rays with Embree and with durer, in turn, and prints both; HARNESS is
                                   a folder with embree_bench.cpp
  python [ARGUMENT]..              builds the Python package into target/python and runs pytest (with these arguments),
                                   mypy and stubtest
  soak [--minutes N] [--rays N] [KIND]..
                                   runs the random tests with ever new cases for N minutes (60) or until each KIND (all)
                                   has N rays, fewest rays first, and adds up in docs/reliability.md
  fused [BINARY]                   lists compiled code that calls fma where it should be one instruction";

/// The result of a task: nothing, or the reason why it failed.
type Outcome<T = ()> = Result<T, String>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match words.split_first() {
        Some((name, [])) if name == "test" => checks::run(),
        Some((name, rest)) if name == "conformance" => conformance::run(rest),
        Some((name, rest)) if name == "differential" => differential::run(rest),
        Some((name, rest)) if name == "examples" => examples::run(rest),
        Some((name, rest)) if name == "fused" => fused::run(rest),
        Some((name, rest)) if name == "bench" => bench::run(rest),
        Some((name, rest)) if name == "python" => python::run(rest),
        Some((name, rest)) if name == "soak" => soak::run(rest),
        Some((name, rest)) if name == "gallery" => gallery::run(rest),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("xtask: {reason}");
            ExitCode::FAILURE
        }
    }
}
