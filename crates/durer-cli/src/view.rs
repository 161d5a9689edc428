//! `durer view`: shows a scene in the browser.

use crate::args::ViewArgs;
use crate::failure::Failure;
use crate::input;
use durer_view::{SceneFile, View, ViewError, ViewSettings};
use std::process::{Command, Stdio};

pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    let options = input::read_options(&args.scene, args.size.size())?;
    if args.scene.subdivide.is_some() {
        return Err(Failure::Usage("not supported yet: --subdivide with view".into()));
    }
    let settings =
        ViewSettings { anti_aliasing: args.aa, threads: args.threads.map(usize::from), port: args.port };
    let failed = |error: ViewError| match error {
        ViewError::Scene(message) => Failure::Input(message),
        ViewError::Size(..) => Failure::Usage(error.to_string()),
        other => Failure::Input(format!("error: {other}")),
    };
    let view = View::open(SceneFile::new(&args.scene.scene, options), settings).map_err(failed)?;
    for warning in view.warnings() {
        eprintln!("{warning}");
    }
    let ready = |address: &str| {
        println!("{address}");
        if args.open {
            open(address);
        }
    };
    view.serve(ready).map_err(failed)
}

/// Opens the address in the user's browser; if that fails, the printed address is still there.
fn open(address: &str) {
    let (program, first): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("cmd", &["/C", "start", ""])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(first).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Err(why) = command.spawn() {
        eprintln!("warning: no browser could be started: {program}: {why}");
    }
}
