//! The command `durer`: it parses the command line, calls the library, and prints the answers.
#![forbid(unsafe_code)]

mod args;
mod arrays;
mod check;
mod explain;
mod failure;
mod frames;
mod input;
mod noise;
mod output;
mod render;
mod switches;
mod trace;
mod view;

use crate::args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match switches::translated(std::env::args_os().collect()) {
        Ok(arguments) => arguments,
        Err(failure) => {
            eprintln!("{failure}");
            return failure.exit_code();
        }
    };
    let done = match Cli::parse_from(arguments).command {
        Command::Render(args) => render::run(&args),
        Command::Trace(args) => trace::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Check(args) => check::run(&args),
        Command::View(args) => view::run(&args),
        Command::LearnNoise(args) => noise::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}
