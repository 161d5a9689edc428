//! Running other programs: cargo, and the `durer` command itself.

use crate::Outcome;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// The top folder of the checkout.
pub(crate) fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// The folder for the output of tasks, created if it is missing; not under version control.
pub(crate) fn scratch(name: &str) -> Outcome<PathBuf> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let folder = target.join("xtask").join(name);
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    Ok(folder)
}

/// The cargo program that runs this task.
pub(crate) fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Prints the command, runs it with its output visible, and prints how long it took.
pub(crate) fn step(title: &str, command: &mut Command) -> Outcome {
    println!("==> {title}");
    let start = Instant::now();
    let status = command.status().map_err(|e| format!("{title}: cannot start: {e}"))?;
    if !status.success() {
        return Err(format!("{title}: failed ({status})"));
    }
    println!("    {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The `durer` command.
#[derive(Debug)]
pub(crate) struct Durer {
    program: PathBuf,
    /// The folder for a user's data, if it is not that of the user.
    data: Option<PathBuf>,
}

/// The settings of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shot<'a> {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Anti-aliasing as on the command line: `off`, `method2`, `4x4` ...
    pub(crate) aa: &'a str,
    /// The number of threads; `None` for all cores.
    pub(crate) threads: Option<u32>,
}

impl Durer {
    /// Builds the command for release and finds where cargo put it.
    pub(crate) fn build() -> Outcome<Self> {
        Self::made_by(
            "cargo build --release --package durer-cli",
            &["build", "--release", "--package", "durer-cli"],
        )
    }

    /// Finds the command as `cargo test --workspace` builds it: optimised, with assertions and
    /// overflow checks.
    pub(crate) fn tested() -> Outcome<Self> {
        let title = "cargo test --workspace --lib --bins --tests --no-run";
        Self::made_by(title, &["test", "--workspace", "--lib", "--bins", "--tests", "--no-run"])
    }

    fn made_by(title: &str, arguments: &[&str]) -> Outcome<Self> {
        let is_durer = |path: &Path| path.file_stem().is_some_and(|name| name == "durer");
        Ok(Self::at(built(title, arguments, is_durer)?))
    }

    /// The command that is this program.
    pub(crate) fn at(program: PathBuf) -> Self {
        Self { program, data: None }
    }

    /// Measures the noise of POV-Ray, which must be installed, and uses it from then on. It is kept in
    /// this folder.
    pub(crate) fn with_learned_noise(mut self, folder: &Path) -> Outcome<Self> {
        self.data = Some(folder.to_path_buf());
        let output = self.command().arg("learn-noise").output();
        let output = output.map_err(|e| format!("{}: {e}", self.program.display()))?;
        if output.status.success() {
            return Ok(self);
        }
        Err(format!("durer learn-noise: {}\n{}", output.status, String::from_utf8_lossy(&output.stderr)))
    }

    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        if let Some(folder) = &self.data {
            command.env("XDG_DATA_HOME", folder);
        }
        command
    }

    /// The path of the program.
    pub(crate) fn program(&self) -> &Path {
        &self.program
    }

    /// Renders `scene` into `picture`. The error contains the output of the command.
    pub(crate) fn render(&self, scene: &Path, picture: &Path, shot: Shot<'_>) -> Outcome {
        let mut command = self.command();
        command.arg("render").arg(scene).arg("-o").arg(picture);
        command.args(["--width", &shot.width.to_string(), "--height", &shot.height.to_string()]);
        command.args(["--aa", shot.aa, "--no-progress"]);
        if let Some(threads) = shot.threads {
            command.args(["--threads", &threads.to_string()]);
        }
        let output = command.output().map_err(|e| format!("{}: {e}", self.program.display()))?;
        if output.status.success() {
            return Ok(());
        }
        Err(format!("{}: {}\n{}", scene.display(), output.status, String::from_utf8_lossy(&output.stderr)))
    }
}

/// Runs cargo and finds the last executable for which `is_wanted` is true.
pub(crate) fn built(title: &str, arguments: &[&str], is_wanted: impl Fn(&Path) -> bool) -> Outcome<PathBuf> {
    println!("==> {title}");
    let output = cargo()
        .args(arguments)
        .arg("--message-format=json-render-diagnostics")
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("{title}: cannot start: {e}"))?;
    if !output.status.success() {
        return Err(format!("{title}: failed ({})", output.status));
    }
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| executable(line).map(PathBuf::from))
        .rfind(|path| is_wanted(path))
        .ok_or_else(|| format!("{title}: cargo named no executable"))
}

/// The value of `"executable":"..."` in one of cargo's JSON lines.
fn executable(line: &str) -> Option<&str> {
    let (_, rest) = line.split_once("\"executable\":\"")?;
    rest.split_once('"').map(|(path, _)| path)
}

#[cfg(test)]
mod tests {
    use super::executable;

    #[test]
    fn the_executable_is_read_from_cargos_message() {
        assert_eq!(
            executable(r#"{"reason":"compiler-artifact","executable":"/t/durer","fresh":true}"#),
            Some("/t/durer")
        );
        assert_eq!(executable(r#"{"reason":"compiler-artifact","executable":null}"#), None);
    }
}
