//! `durer learn-noise`: measures POV-Ray's noise in an installed POV-Ray, and where it is kept.

mod povray;
mod rows;
mod table;

use crate::args::{LearnNoiseArgs, NoiseChoice};
use crate::failure::Failure;
use durer::scene::LearnedNoise;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The number of points at which the noise of a generator is compared.
const CHECKED: usize = 300;
/// The greatest difference at any of them.
const ALLOWED: f64 = 1e-12;

pub(crate) fn run(args: &LearnNoiseArgs) -> Result<(), Failure> {
    let path = file()
        .ok_or_else(|| Failure::Input("error: no folder for user data is known: set XDG_DATA_HOME".into()))?;
    let program = args.povray.as_deref().unwrap_or(Path::new("povray"));
    let unlike = || Failure::file(program, "its noise is not the one that durer knows how to measure");
    let table_asked = table::asked().ok_or_else(unlike)?;
    let (version, said) = povray::printed(program, table_asked.iter().chain(&rows::asked()))?;
    let (for_table, for_rows) = said.split_at_checked(table::NUMBERS).ok_or_else(unlike)?;
    let (table, difference) = table::found(for_table).ok_or_else(unlike)?;
    let (rows, rows_difference) = rows::found(for_rows).ok_or_else(unlike)?;
    let largest = difference.max(rows_difference);
    let text = serde_json::json!({
        "povray": version,
        "largest_difference": largest,
        "table": table,
        "slopes": rows.slopes,
        "starts": rows.starts,
    });
    let written = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = written.and_then(|()| std::fs::write(&path, text.to_string()));
    written.map_err(|why| Failure::file(&path, format_args!("cannot write: {why}")))?;
    println!("the noise of POV-Ray {version}: at {} points it differs by at most {largest:e}", 2 * CHECKED);
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
    match serde_json::from_str(&text).ok().and_then(|data| known(&data)) {
        Some(known) => Ok(Some(known)),
        None => Err(Failure::file(&path, "this is no learned noise: `durer learn-noise` makes it anew")),
    }
}

/// The noise in a file. Files without the third generator's slopes have durer's own there.
fn known(data: &Value) -> Option<Known> {
    let noise = LearnedNoise::new(&list(data.get("table")?, Value::as_f64)?)?;
    let version = data.get("povray")?.as_str()?.to_owned();
    let Some(slopes) = data.get("slopes") else { return Some((Arc::new(noise), version)) };
    let slopes = list(slopes, |slope| list(slope, Value::as_f64)?.try_into().ok())?;
    let start = |k: &Value| u16::try_from(k.as_u64()?).ok();
    let starts = list(data.get("starts")?, |starts| list(starts, start))?;
    let [a, b] = &starts[..] else { return None };
    Some((Arc::new(noise.with_rows(&slopes, [a, b])?), version))
}

/// The items of a list; `None` if one of them cannot be read.
fn list<T>(data: &Value, item: impl Fn(&Value) -> Option<T>) -> Option<Vec<T>> {
    data.as_array()?.iter().map(item).collect()
}

/// The points at which noise is compared, on a grid of 2^-18.
fn checked() -> impl Iterator<Item = [f64; 3]> {
    let mut state = 1_u64;
    let mut number = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f64 - f64::from(1 << 23)) / f64::from(1 << 18)
    };
    (0..CHECKED).map(move |_| [number(), number(), number()])
}
