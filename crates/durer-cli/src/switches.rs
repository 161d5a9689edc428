//! POV-Ray's switches and INI files for `durer render`, so that old command lines work.
//!
//! `+W160 +H120 +Iscene.pov +Oout.png +A0.3` become durer's own options; an argument that ends in
//! `.ini` is read as a file of such settings. What has no effect here (`-D`, `+P`, `+V`, `+Q9`, ...)
//! is skipped.

use crate::failure::Failure;
use std::ffi::OsString;
use std::path::Path;

/// Settings of anti-aliasing, which POV-Ray gives in parts.
struct Smoothing {
    is_on: Option<bool>,
    method: u32,
    threshold: f64,
    depth: u32,
}

/// The switches of the command line as durer's own options.
struct Translated {
    options: Vec<OsString>,
    scene: Option<OsString>,
    smoothing: Smoothing,
}

/// The arguments with all switches of POV-Ray replaced; others do not change. Only the arguments of
/// `render` are translated.
pub(crate) fn translated(arguments: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let is_render = arguments.get(1).is_some_and(|word| word == "render");
    let has_switches = arguments.iter().skip(2).any(|word| {
        let text = word.to_string_lossy();
        text.starts_with('+') || is_ini(&text)
    });
    if !is_render || !has_switches {
        return Ok(arguments);
    }
    let smoothing = Smoothing { is_on: None, method: 1, threshold: 0.3, depth: 3 };
    let mut made = Translated { options: Vec::new(), scene: None, smoothing };
    let mut rest = Vec::new();
    for word in arguments.iter().skip(2) {
        let text = word.to_string_lossy();
        if is_ini(&text) {
            made.file(Path::new(word))?;
        } else if !made.switch(&text)? {
            rest.push(word.clone());
        }
    }
    let mut all: Vec<OsString> = arguments[..2].to_vec();
    all.append(&mut made.options);
    if let Some(is_on) = made.smoothing.is_on {
        let Smoothing { method, threshold, depth, .. } = made.smoothing;
        let how = if is_on { format!("method{method},{threshold},{depth}") } else { "off".into() };
        all.extend(["--aa".into(), how.into()]);
    }
    all.append(&mut rest);
    all.extend(made.scene);
    Ok(all)
}

/// Switches for sequences whose words have three letters.
const FRAMES: [(&str, &str); 2] = [("KFI", "--initial-frame"), ("KFF", "--final-frame")];

/// Switches for sequences and parts of pictures whose words have two letters.
const PARTS: [(&str, &str); 8] = [
    ("KI", "--initial-clock"),
    ("KF", "--final-clock"),
    ("SF", "--subset-start"),
    ("EF", "--subset-end"),
    ("SC", "--start-column"),
    ("EC", "--end-column"),
    ("SR", "--start-row"),
    ("ER", "--end-row"),
];

/// Words of INI files that stand for an option with the same value.
const SETTINGS: [(&str, &str); 10] = [
    ("initial_frame", "--initial-frame"),
    ("final_frame", "--final-frame"),
    ("initial_clock", "--initial-clock"),
    ("final_clock", "--final-clock"),
    ("subset_start_frame", "--subset-start"),
    ("subset_end_frame", "--subset-end"),
    ("start_column", "--start-column"),
    ("end_column", "--end-column"),
    ("start_row", "--start-row"),
    ("end_row", "--end-row"),
];

fn is_ini(text: &str) -> bool {
    text.to_ascii_lowercase().ends_with(".ini")
}

impl Translated {
    fn option(&mut self, name: &str, value: impl Into<OsString>) {
        self.options.extend([OsString::from(name), value.into()]);
    }

    /// Takes a switch; returns whether it was one.
    fn switch(&mut self, text: &str) -> Result<bool, Failure> {
        let (is_on, body) = match (text.strip_prefix('+'), text.strip_prefix('-')) {
            (Some(body), _) => (true, body),
            // Options of durer's own begin with one small letter or two dashes.
            (None, Some(body)) if body.starts_with(|c: char| c.is_ascii_uppercase() && c != 'L') => {
                (false, body)
            }
            _ => return Ok(false),
        };
        let upper = body.to_ascii_uppercase();
        let wrong = || Failure::Usage(format!("the switch {text} is not one that durer knows"));
        let after = |count: usize| body.get(count..).unwrap_or_default();
        let number = |count: usize| after(count).parse::<f64>().map_err(|_| wrong());
        let whole = |count: usize| after(count).parse::<u32>().map_err(|_| wrong());
        if upper.starts_with("WT") {
            self.option("--threads", whole(2)?.to_string());
        } else if upper.starts_with('W') {
            self.option("--width", whole(1)?.to_string());
        } else if upper.starts_with('H') && upper[1..].starts_with(|c: char| c.is_ascii_digit()) {
            self.option("--height", whole(1)?.to_string());
        } else if upper.starts_with('I') {
            self.scene = Some(after(1).into());
        } else if upper.starts_with('O') {
            self.option("--output", after(1));
        } else if upper.starts_with('L') {
            self.option("-L", after(1));
        } else if upper.starts_with("AM") {
            self.smoothing.method = whole(2)?;
        } else if upper.starts_with('A') {
            self.smoothing.is_on = Some(is_on);
            if is_on && body.len() > 1 {
                self.smoothing.threshold = number(1)?;
            }
        } else if upper.starts_with('R') {
            self.smoothing.depth = whole(1)?;
        } else if upper.starts_with("FN16") {
            self.option("--bits", "16");
        } else if let Some((_, name)) = FRAMES.iter().find(|(word, _)| upper.starts_with(word)) {
            self.option(name, number(3)?.to_string());
        } else if let Some((_, name)) = PARTS.iter().find(|(word, _)| upper.starts_with(word)) {
            self.option(name, number(2)?.to_string());
        } else if upper == "KC" {
            if is_on {
                self.options.push("--cyclic".into());
            }
        } else if upper.starts_with('K') {
            self.option("--clock", number(1)?.to_string());
        } else if !upper.starts_with(|c: char| "BCDFGJMPQSUVXH".contains(c)) {
            return Err(wrong());
        }
        Ok(true)
    }

    /// Takes the settings of an INI file.
    fn file(&mut self, path: &Path) -> Result<(), Failure> {
        let failed = |why: &dyn std::fmt::Display| Failure::file(path, why);
        let about = std::fs::metadata(path).map_err(|why| failed(&format!("cannot be read: {why}")))?;
        if !about.is_file() || about.len() > 1 << 20 {
            return Err(failed(&"is no INI file: it is not a regular file, or too long"));
        }
        let bytes = std::fs::read(path).map_err(|why| failed(&format!("cannot be read: {why}")))?;
        for (i, line) in String::from_utf8_lossy(&bytes).lines().enumerate() {
            let line = line.split(';').next().unwrap_or_default().trim();
            // Sections are for a choice that is not made here.
            if line.is_empty() || line.starts_with('[') {
                continue;
            }
            let done = match line.split_once('=') {
                Some((key, value)) => self.setting(key.trim(), value.trim().trim_matches('"')),
                None => line.split_whitespace().try_for_each(|word| {
                    let known = self.switch(word)?;
                    if !known {
                        self.scene = Some(word.into());
                    }
                    Ok(())
                }),
            };
            done.map_err(|fault| match fault {
                Failure::Usage(text) => Failure::Usage(format!("{}:{}: {text}", path.display(), i + 1)),
                other => other,
            })?;
        }
        Ok(())
    }

    fn setting(&mut self, key: &str, value: &str) -> Result<(), Failure> {
        let wrong = || Failure::Usage(format!("{key}={value} cannot be understood"));
        let truth = matches!(value.to_ascii_lowercase().as_str(), "on" | "yes" | "true" | "1");
        match key.to_ascii_lowercase().as_str() {
            "width" => self.option("--width", value),
            "height" => self.option("--height", value),
            "input_file_name" => self.scene = Some(value.into()),
            "output_file_name" => self.option("--output", value),
            "library_path" => self.option("-L", value),
            "clock" => self.option("--clock", value),
            "work_threads" => self.option("--threads", value),
            "bits_per_color" if value == "16" => self.option("--bits", "16"),
            "antialias" => self.smoothing.is_on = Some(truth),
            "antialias_threshold" => self.smoothing.threshold = value.parse().map_err(|_| wrong())?,
            "antialias_depth" => self.smoothing.depth = value.parse().map_err(|_| wrong())?,
            "sampling_method" => self.smoothing.method = value.parse().map_err(|_| wrong())?,
            "declare" => self.option("--declare", value),
            "cyclic_animation" if truth => self.options.push("--cyclic".into()),
            // Displays, buffers, formats and the like have no effect here.
            word => {
                if let Some((_, name)) = SETTINGS.iter().find(|(known, _)| *known == word) {
                    self.option(name, value);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn old_command_lines_become_options() {
        let own = translated(words(
            "durer render +Ia.pov +Oa.png +W160 +H120 +A0.1 +AM2 +R2 +Linc -D +P +Q9 +WT2 +K0.5 +FN16 --noise own",
        ));
        let wanted = "durer render --output a.png --width 160 --height 120 -L inc --threads 2 --clock 0.5 --bits 16 --aa method2,0.1,2 --noise own a.pov";
        assert_eq!(own.ok(), Some(words(wanted)));
        let off = translated(words("durer render a.pov +W8 -A")).ok();
        assert_eq!(off, Some(words("durer render --width 8 --aa off a.pov")));
    }

    #[test]
    fn sequences_and_parts_become_options() {
        let own = translated(words(
            "durer render +Ia.pov +KFI1 +KFF10 +KI2 +KF4.5 +SF3 +EF0.5 +KC +SC0.25 +EC8 +SR3 +ER.5",
        ))
        .ok();
        let wanted = "durer render --initial-frame 1 --final-frame 10 --initial-clock 2 --final-clock 4.5 \
                      --subset-start 3 --subset-end 0.5 --cyclic --start-column 0.25 --end-column 8 \
                      --start-row 3 --end-row 0.5 a.pov";
        assert_eq!(own, Some(words(wanted)));
    }

    #[test]
    fn other_command_lines_stay_as_they_are() {
        for text in ["durer check +W8", "durer render a.pov -o b.png -L x --width 8", "durer"] {
            assert_eq!(translated(words(text)).ok(), Some(words(text)));
        }
    }

    #[test]
    fn what_is_not_understood_is_named() {
        for text in ["+Wwide", "+Z1", "+KFIx", "nowhere.ini"] {
            assert!(translated(words(&format!("durer render a.pov {text}"))).is_err(), "{text}");
        }
    }

    #[test]
    fn ini_files_are_read() {
        let path = std::env::temp_dir().join(format!("durer-switches-{}.ini", std::process::id()));
        std::fs::write(
            &path,
            "; a comment\n[Small]\nWidth = 64\nHeight=48 ; low\nAntialias=On\n+Ib.pov\nDisplay=Off\n",
        )
        .unwrap();
        let mut arguments = words("durer render");
        arguments.push(path.clone().into());
        let own = translated(arguments).ok();
        std::fs::remove_file(path).unwrap();
        let wanted = "durer render --width 64 --height 48 --aa method1,0.3,3 b.pov";
        assert_eq!(own, Some(words(wanted)));
    }
}
