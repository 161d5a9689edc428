//! Runs POV-Ray on a scene that prints numbers.

use crate::failure::Failure;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// Something that a scene prints: a string expression of POV-Ray's language with numbers in it.
pub(super) type Asked = String;

/// What prints a float with all its digits.
pub(super) fn float(expression: &str) -> Asked {
    format!("str({expression}, 0, 17)")
}

/// What prints the three components of a vector.
pub(super) fn vector(expression: &str) -> Asked {
    format!("vstr(3, {expression}, \" \", 0, 17)")
}

/// Runs POV-Ray on a scene that prints these. Returns its version and all printed numbers.
pub(super) fn printed<'a>(
    program: &Path,
    asked: impl Iterator<Item = &'a Asked>,
) -> Result<(String, Vec<f64>), Failure> {
    let mut scene =
        String::from("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#include \"functions.inc\"\n");
    for expression in asked {
        let _ = writeln!(scene, "#debug concat(\"durer-noise \", {expression}, \"\\n\")");
    }
    scene += "camera { location -z }\n";
    let folder = std::env::temp_dir().join(format!("durer-learn-noise-{}", std::process::id()));
    let failed = |why: &dyn std::fmt::Display| Failure::file(&folder, format_args!("cannot write: {why}"));
    std::fs::create_dir(&folder).map_err(|why| failed(&why))?;
    let input = folder.join("noise.pov");
    let output = std::fs::write(&input, scene).map(|()| {
        let mut command = Command::new(program);
        command.args(["+Inoise.pov", "+W1", "+H1", "-F", "-D"]).current_dir(&folder);
        command.stdin(Stdio::null()).output()
    });
    let _ = std::fs::remove_dir_all(&folder);
    let output = output.map_err(|why| failed(&why))?.map_err(|why| {
        Failure::file(program, format_args!("POV-Ray cannot be run: {why}; --povray PATH says where it is"))
    })?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(Failure::file(program, "POV-Ray stopped with an error"));
    }
    let numbers = said
        .lines()
        .filter_map(|line| line.strip_prefix("durer-noise "))
        .flat_map(str::split_whitespace)
        .map_while(|word| word.parse().ok())
        .collect();
    let version = said.split("Version ").nth(1).and_then(|rest| rest.split_whitespace().next());
    Ok((version.unwrap_or("of unknown version").to_owned(), numbers))
}
