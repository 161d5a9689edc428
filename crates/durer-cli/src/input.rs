//! Scenes: from a file's name to what can be asked.

use crate::args::SceneArgs;
use crate::failure::Failure;
use durer::math::Isa;
use durer::pov::{Limits, MessageKind, Read, ReadOptions};
use durer::render::{World, WorldError};
use durer::scene::{LowerError, Lowered, Place, Scene};
use std::path::Path;

/// Endings of mesh files, which are announced but cannot be read yet.
const MESHES: [&str; 5] = ["obj", "ply", "stl", "gltf", "glb"];

/// A scene that was read.
pub(crate) struct Loaded(Read);

/// Reads the scene; what it says goes to stderr.
pub(crate) fn load(args: &SceneArgs, (width, height): (u32, u32)) -> Result<Loaded, Failure> {
    Isa::requested().map_err(|e| Failure::Usage(e.to_string()))?;
    check_ending(&args.scene)?;
    let mut limits = Limits::default();
    for (name, value) in &args.limit {
        if !limits.set(&name.replace('-', "_"), *value) {
            let known = Limits::NAMES.join(", ");
            return Err(Failure::Usage(format!("--limit {name}: the limits are {known}")));
        }
    }
    let options = ReadOptions {
        library_paths: args.library.clone(),
        declares: args.declare.clone(),
        clock: args.clock,
        image_width: width,
        image_height: height,
        limits,
    };
    let listener = |message: &durer::pov::Message| match message.kind {
        MessageKind::Debug => eprint!("{message}"),
        MessageKind::Warning | MessageKind::Notice => eprintln!("{}", message.to_string().trim_end()),
    };
    let read = durer::pov::read_with(&args.scene, &options, listener);
    read.map(Loaded).map_err(|e| Failure::Input(e.to_string()))
}

fn check_ending(scene: &Path) -> Result<(), Failure> {
    let ending = scene.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if ending == "pov" {
        Ok(())
    } else if MESHES.contains(&ending.as_str()) {
        Err(Failure::file(scene, format_args!("not supported yet: .{ending} files")))
    } else {
        Err(Failure::Usage(format!("the scene must be a .pov file, got '{}'", scene.display())))
    }
}

impl Loaded {
    pub(crate) fn scene(&self) -> &Scene {
        &self.0.scene
    }

    /// Builds the geometry; what the scene's author should know goes to stderr.
    pub(crate) fn lower(&self) -> Result<Lowered, Failure> {
        let lowered = self.0.scene.lower().map_err(|e| self.refused(&e))?;
        self.warn(&lowered.warnings);
        Ok(lowered)
    }

    /// Builds all that a picture needs, warnings as for [`Loaded::lower`].
    pub(crate) fn world(&self) -> Result<World, Failure> {
        let world = World::new(&self.0.scene).map_err(|e| match e {
            WorldError::Lower(e) => self.refused(&e),
            other => Failure::Input(self.0.sources.error(None, other.to_string()).to_string()),
        })?;
        self.warn(world.warnings());
        Ok(world)
    }

    fn refused(&self, error: &LowerError) -> Failure {
        Failure::Input(self.0.sources.error(error.place, error.to_string()).to_string())
    }

    fn warn(&self, warnings: &[(Option<Place>, String)]) {
        for (place, why) in warnings {
            eprintln!("{}", self.0.sources.error(*place, format!("warning: {why}")));
        }
    }
}

/// Runs `work` with so many threads, or with as many as there are cores.
pub(crate) fn with_threads<R: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<R, Failure> + Send,
) -> Result<R, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build();
    pool.map_err(|e| Failure::Input(format!("error: cannot start threads: {e}")))?.install(work)
}
