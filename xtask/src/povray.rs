//! The POV-Ray program, used as an independent reference.

use crate::Outcome;
use crate::command::Shot;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The message if it is not installed.
pub(crate) const MISSING: &str = "not run: the program `povray` (POV-Ray 3.7; on Debian `apt-get install povray povray-includes`) is not installed";

/// Its message if its threads do not start in time, which happens on a busy machine.
const LATE: &str = "Timed out waiting for worker thread startup";

/// The number of times it is started if its threads do not start in time, at most.
const STARTS: usize = 20;

/// The longest time of a picture: that of the slowest scenes of its own distribution, several times.
const MOST_TIME: Duration = Duration::from_secs(600);

/// An installed POV-Ray.
#[derive(Debug)]
pub(crate) struct Povray {
    /// Its version as it reports it, for example `3.7.0.10`.
    pub(crate) version: String,
}

impl Povray {
    /// Looks for the program on the search path.
    pub(crate) fn find() -> Option<Self> {
        let output = Command::new("povray").arg("--version").stdin(Stdio::null()).output().ok()?;
        let said =
            String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
        version(&said).map(|version| Self { version: version.to_owned() })
    }

    /// Renders `scene` into `picture` with 8 bits per channel, on one thread.
    pub(crate) fn render(&self, scene: &Path, picture: &Path, shot: Shot<'_>) -> Outcome {
        self.render_with(scene, picture, shot, scene.parent().unwrap_or(scene))
    }

    /// As [`Povray::render`], but only one pixel, in column `x` and row `y`; the others are black.
    /// Its colour does not depend on pixels rendered before it.
    pub(crate) fn render_pixel(
        &self,
        scene: &Path,
        picture: &Path,
        shot: Shot<'_>,
        (x, y): (u32, u32),
    ) -> Outcome {
        let (column, row) = (x + 1, y + 1);
        let part = [format!("+SC{column}"), format!("+EC{column}"), format!("+SR{row}"), format!("+ER{row}")];
        self.run(scene, picture, shot, scene.parent().unwrap_or(scene), &part)
    }

    /// As [`Povray::render`], with a folder to search for included files.
    pub(crate) fn render_with(
        &self,
        scene: &Path,
        picture: &Path,
        shot: Shot<'_>,
        library: &Path,
    ) -> Outcome {
        self.run(scene, picture, shot, library, &[])
    }

    fn run(&self, scene: &Path, picture: &Path, shot: Shot<'_>, library: &Path, more: &[String]) -> Outcome {
        let start = || self.run_once(scene, picture, shot, library, more);
        let mut outcome = start();
        for _ in 1..STARTS {
            if !outcome.as_ref().is_err_and(|why| why.contains(LATE)) {
                break;
            }
            outcome = start();
        }
        outcome
    }

    fn run_once(
        &self,
        scene: &Path,
        picture: &Path,
        shot: Shot<'_>,
        library: &Path,
        more: &[String],
    ) -> Outcome {
        assert_eq!(shot.aa, "off", "pictures are compared without anti-aliasing only");
        let mut child = Command::new("povray")
            .arg(format!("+I{}", scene.display()))
            .arg(format!("+O{}", picture.display()))
            .arg(format!("+L{}", library.display()))
            .args([format!("+W{}", shot.width), format!("+H{}", shot.height)])
            .args(["+FN8", "-A", "-D", "-P", "Work_Threads=1"])
            .args(more)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| format!("povray: {e}"))?;
        let stderr = child.stderr.take();
        let said = std::thread::spawn(move || {
            let mut said = Vec::new();
            stderr.map(|mut pipe| pipe.read_to_end(&mut said));
            String::from_utf8_lossy(&said).into_owned()
        });
        let status = wait(&mut child).map_err(|e| format!("povray: {}: {e}", scene.display()))?;
        let said = said.join().unwrap_or_default();
        if status.success() {
            return Ok(());
        }
        let error = said.find("Error").map_or(&*said, |at| &said[at..]);
        Err(format!("povray: {}: {status}\n{error}", scene.display()))
    }
}

/// Waits for a program to end. POV-Ray has no limits of its own: an endless loop in a scene takes
/// all memory.
fn wait(child: &mut Child) -> Outcome<ExitStatus> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
            return Ok(status);
        }
        if start.elapsed() > MOST_TIME {
            let _ = child.kill();
            let _ = child.wait();
            return Err(format!("no end after {} s", MOST_TIME.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The version in `POV-Ray 3.7.0.10.unofficial`, up to the last number.
fn version(said: &str) -> Option<&str> {
    let (_, rest) = said.split_once("POV-Ray ")?;
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    Some(rest[..end].trim_end_matches('.')).filter(|v| !v.is_empty())
}

#[cfg(test)]
mod tests {
    use super::version;

    #[test]
    fn the_version_is_cut_out() {
        assert_eq!(version("POV-Ray 3.7.0.10.unofficial\n"), Some("3.7.0.10"));
        assert_eq!(version("povray: not found"), None);
    }
}
