//! `durer learn-noise`: measures POV-Ray's noise in an installed POV-Ray, and where it is kept.

use crate::args::{LearnNoiseArgs, NoiseChoice};
use crate::failure::Failure;
use durer::math::Point3;
use durer::scene::LearnedNoise;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

/// The number of points at which noise is compared.
const CHECKED: usize = 300;
/// The greatest difference at any of them.
const ALLOWED: f64 = 1e-12;
/// How far the points are from the lattice at which slopes are measured.
const AWAY: f64 = 1.0 / 1024.0;
/// The hash whose slopes stand at the table's end.
const LAST: usize = 255;
/// The lattice points that are searched for all hashes.
const SEARCHED: i64 = 4096;

pub(crate) fn run(args: &LearnNoiseArgs) -> Result<(), Failure> {
    let path = file()
        .ok_or_else(|| Failure::Input("error: no folder for user data is known: set XDG_DATA_HOME".into()))?;
    let program = args.povray.as_deref().unwrap_or(Path::new("povray"));
    let (version, said) = measured(program)?;
    let (table, difference) = table(&said)
        .ok_or_else(|| Failure::file(program, "its noise is not the one that durer knows how to measure"))?;
    let text = serde_json::json!({
        "povray": version,
        "largest_difference": difference,
        "table": table,
    });
    let written = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = written.and_then(|()| std::fs::write(&path, text.to_string()));
    written.map_err(|why| Failure::file(&path, format_args!("cannot write: {why}")))?;
    println!(
        "{} numbers of the noise of POV-Ray {version}; at {CHECKED} points it differs by at most {difference:e}",
        table.len()
    );
    println!("kept in {}", path.display());
    Ok(())
}

/// The file of the learned noise.
fn file() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = set("XDG_DATA_HOME").or_else(|| {
        if cfg!(windows) {
            set("APPDATA")
        } else if cfg!(target_os = "macos") {
            set("HOME").map(|home| home.join("Library/Application Support"))
        } else {
            set("HOME").map(|home| home.join(".local/share"))
        }
    })?;
    Some(folder.join("durer").join("pov-noise.json"))
}

/// A noise, and where it is from.
type Known = (Arc<LearnedNoise>, String);

/// The learned noise, if it is chosen and there; without a choice it is used where it is there.
pub(crate) fn chosen(choice: Option<NoiseChoice>) -> Result<Option<Known>, Failure> {
    if choice == Some(NoiseChoice::Own) {
        return Ok(None);
    }
    let path = file().filter(|path| path.is_file());
    let Some(path) = path else {
        return match choice {
            Some(_) => Err(Failure::Usage(
                "no noise has been learned: `durer learn-noise` measures it in an installed POV-Ray".into(),
            )),
            None => Ok(None),
        };
    };
    let text = std::fs::read_to_string(&path)
        .map_err(|why| Failure::file(&path, format_args!("cannot read: {why}")))?;
    let known = serde_json::from_str::<serde_json::Value>(&text).ok().and_then(|data| {
        let numbers: Option<Vec<f64>> =
            data.get("table")?.as_array()?.iter().map(serde_json::Value::as_f64).collect();
        let version = data.get("povray")?.as_str()?.to_owned();
        Some((Arc::new(LearnedNoise::new(&numbers?)?), version))
    });
    match known {
        Some(known) => Ok(Some(known)),
        None => Err(Failure::file(&path, "this is no learned noise: `durer learn-noise` makes it anew")),
    }
}

/// A lattice point `(x, 0, 0)` for each hash.
fn lattice() -> Option<Vec<i64>> {
    (0..=LAST).map(|hash| (0..SEARCHED).find(|&x| LearnedNoise::hash_at(x) == hash)).collect()
}

/// The points at which noise is compared.
fn checked() -> impl Iterator<Item = [f64; 3]> {
    let mut state = 1_u64;
    let mut number = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f64 / (1_u64 << 24) as f64 - 0.5) * 100.0
    };
    (0..CHECKED).map(move |_| [number(), number(), number()])
}

/// Runs POV-Ray on a scene that prints its noise. Returns its version and the printed numbers.
fn measured(program: &Path) -> Result<(String, Vec<f64>), Failure> {
    let Some(lattice) = lattice() else {
        return Err(Failure::Input(
            "error: the noise cannot be measured: not all of its hash values were found".into(),
        ));
    };
    let mut scene =
        String::from("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#include \"functions.inc\"\n");
    let x0 = lattice[LAST] as f64;
    let near = [[x0 + AWAY, 0.0, 0.0], [x0, AWAY, 0.0], [x0, 0.0, AWAY]];
    for [x, y, z] in lattice.iter().map(|&x| [x as f64, 0.0, 0.0]).chain(near) {
        let _ = writeln!(
            scene,
            "#debug concat(\"durer-noise \", vstr(3, vturbulence(2, 0.5, 1, <{x}, {y}, {z}>), \" \", 0, 17), \"\\n\")"
        );
    }
    for [x, y, z] in checked() {
        let _ =
            writeln!(scene, "#debug concat(\"durer-noise \", str(f_noise3d({x}, {y}, {z}), 0, 17), \"\\n\")");
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

/// The table for the printed numbers, and the largest difference at the checked points.
fn table(said: &[f64]) -> Option<(Vec<f64>, f64)> {
    let lattice = lattice()?;
    let vectors = 3 * (lattice.len() + 3);
    if said.len() != vectors + CHECKED {
        return None;
    }
    let mut table = [f64::NAN; LearnedNoise::TABLE];
    for (hash, v) in said.chunks_exact(3).take(lattice.len()).enumerate() {
        for (component, value) in v.iter().enumerate() {
            let (held, value) = (&mut table[hash + 4 * component], rounded(2.0 * value));
            // Most numbers are seen three times.
            if *held != value && !held.is_nan() {
                return None;
            }
            *held = value;
        }
    }
    let end = LearnedNoise::TABLE - 3;
    table[end..].fill(0.0);
    let x0 = lattice[LAST] as f64;
    let weight = 1.0 - AWAY * AWAY * (3.0 - 2.0 * AWAY);
    let without = LearnedNoise::new(&table)?;
    for axis in 0..3 {
        let mut p = [x0, 0.0, 0.0];
        p[axis] += AWAY;
        let seen = said[3 * (lattice.len() + axis) + 2];
        let rest = seen - without.vector(Point3::new(p[0], p[1], p[2])).z;
        table[end + axis] = rounded(rest / (weight * AWAY));
    }
    let noise = LearnedNoise::new(&table)?;
    let mut largest = 0.0_f64;
    for ([x, y, z], seen) in checked().zip(&said[vectors..]) {
        let own = ((noise.value(Point3::new(x, y, z)) + 1.052_42) * 0.489_855_82).clamp(0.0, 1.0);
        largest = largest.max((own - seen).abs());
    }
    (largest <= ALLOWED).then(|| (table.to_vec(), largest))
}

/// With six significant digits, as the numbers of the table have.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_found_again_in_its_noise() {
        let made: Vec<f64> =
            (0..LearnedNoise::TABLE).map(|i| rounded(((i * 37 % 101) as f64 - 50.0) / 70.0)).collect();
        let noise = LearnedNoise::new(&made).unwrap();
        let lattice = lattice().unwrap();
        let x0 = lattice[LAST] as f64;
        let near = [[x0 + AWAY, 0.0, 0.0], [x0, AWAY, 0.0], [x0, 0.0, AWAY]];
        let points = lattice.iter().map(|&x| [x as f64, 0.0, 0.0]).chain(near);
        let mut said: Vec<f64> =
            points.flat_map(|[x, y, z]| noise.vector(Point3::new(x, y, z)).to_array()).collect();
        said.extend(checked().map(|[x, y, z]| {
            ((noise.value(Point3::new(x, y, z)) + 1.052_42) * 0.489_855_82).clamp(0.0, 1.0)
        }));
        let (found, difference) = table(&said).unwrap();
        assert_eq!((found, difference), (made, 0.0));
        // A single wrong number is noticed.
        said[100] += 1e-3;
        assert!(table(&said).is_none());
    }
}
