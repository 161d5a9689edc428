//! The Python package: builds it for release into an environment under target/, then runs its
//! tests, type checks and stub checks.

use crate::Outcome;
use crate::command::{root, step};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The packages that its tests need, with the versions that the tests were written for.
const PACKAGES: [&str; 8] =
    ["maturin>=1.9,<2", "numpy", "pytest", "mypy", "trimesh", "pandas", "distributed", "types-tqdm"];

/// The path of a program in the environment.
fn program(environment: &Path, name: &str) -> PathBuf {
    let folder = if cfg!(windows) { "Scripts" } else { "bin" };
    environment.join(folder).join(name)
}

/// The name of the Python 3 program.
fn interpreter() -> Option<&'static str> {
    let works = |name: &&str| {
        let old = "import sys, venv; sys.exit(sys.version_info < (3, 10))";
        Command::new(name).args(["-c", old]).output().is_ok_and(|output| output.status.success())
    };
    ["python3", "python"].into_iter().find(works)
}

/// Builds and tests the package. Without a recent enough Python it prints so and runs nothing.
pub(crate) fn run(rest: &[String]) -> Outcome {
    let Some(python) = interpreter() else {
        println!("==> Python: not run, as there is no python3 of version 3.10 or later with venv");
        return Ok(());
    };
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let environment = target.join("python");
    let within = |name: &str| {
        let mut command = Command::new(program(&environment, name));
        command.current_dir(root()).env("VIRTUAL_ENV", &environment).env_remove("PYTHONPATH");
        command
    };
    if !program(&environment, "python").exists() {
        step("python3 -m venv target/python", Command::new(python).args(["-m", "venv"]).arg(&environment))?;
    }
    if !program(&environment, "mypy").exists() {
        let mut install = within("python");
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(PACKAGES);
        step("pip install maturin numpy pytest mypy ...", &mut install)?;
    }
    step("maturin develop --release", within("maturin").args(["develop", "--release", "--quiet"]))?;
    step("pytest", within("python").args(["-m", "pytest", "-q"]).args(rest))?;
    if rest.is_empty() {
        step("mypy", within("python").args(["-m", "mypy"]))?;
        step("stubtest durer", within("python").args(["-m", "mypy.stubtest", "durer"]))?;
    }
    Ok(())
}
