//! Input: from a file's name to a scene and its geometry.

use crate::args::{SceneArgs, Subdivide};
use crate::failure::Failure;
use durer::geometry::ObjectId;
use durer::math::Isa;
use durer::mesh::{Format, Topology};
use durer::pov::{Limits, MessageKind, Read, ReadOptions};
use durer::render::{World, WorldError};
use durer::scene::{LowerError, Lowered, Place, Scene, Scheme, Shape};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// A scene that has been read.
pub(crate) enum Loaded {
    /// A scene in POV-Ray's language, with its text for error messages.
    Pov(Box<Read>),
    /// The scene of a mesh file.
    Mesh(PathBuf, Box<Scene>),
}

/// Reads the scene; its messages go to stderr.
pub(crate) fn load(args: &SceneArgs, (width, height): (u32, u32)) -> Result<Loaded, Failure> {
    let options = read_options(args, (width, height))?;
    if Format::of(&args.scene).is_some() {
        return match args.subdivide {
            Some(scheme) => load_subdivided(&args.scene, scheme, (width, height)),
            None => load_mesh(&args.scene, (width, height)),
        };
    }
    // Scenes end the lines of their `#debug` messages themselves, or forget to. Other messages
    // start on a new line.
    let is_open = std::sync::atomic::AtomicBool::new(false);
    let end_line = || {
        if is_open.swap(false, Ordering::Relaxed) {
            eprintln!();
        }
    };
    let listener = |message: &durer::pov::Message| match message.kind {
        MessageKind::Debug => {
            eprint!("{message}");
            if !message.text.is_empty() {
                is_open.store(!message.text.ends_with('\n'), Ordering::Relaxed);
            }
        }
        MessageKind::Warning | MessageKind::Notice => {
            end_line();
            eprintln!("{}", message.to_string().trim_end());
        }
    };
    let read = durer::pov::read_with(&args.scene, &options, listener);
    end_line();
    read.map(|read| Loaded::Pov(Box::new(read))).map_err(|e| Failure::Input(e.to_string()))
}

/// Checks the name of the scene, and returns how to read it.
pub(crate) fn read_options(args: &SceneArgs, (width, height): (u32, u32)) -> Result<ReadOptions, Failure> {
    Isa::requested().map_err(|e| Failure::Usage(e.to_string()))?;
    if Format::of(&args.scene).is_none() {
        check_ending(&args.scene)?;
    }
    if args.subdivide.is_some() && Format::of(&args.scene) != Some(Format::Obj) {
        let got = args.scene.display();
        return Err(Failure::Usage(format!("--subdivide needs an .obj file, got '{got}'")));
    }
    let mut limits = Limits::default();
    for (name, value) in &args.limit {
        if !limits.set(&name.replace('-', "_"), *value) {
            let known = Limits::NAMES.join(", ");
            return Err(Failure::Usage(format!("--limit {name}: the limits are {known}")));
        }
    }
    Ok(ReadOptions {
        library_paths: args.library.clone(),
        declares: args.declare.clone(),
        clock: args.clock,
        image_width: width,
        image_height: height,
        limits,
        strict: args.strict,
        noise: crate::noise::chosen(args.noise)?.map(|(noise, _)| noise),
        write_folder: args.write_folder.clone(),
        any_file: args.allow_io,
    })
}

fn load_mesh(path: &Path, (width, height): (u32, u32)) -> Result<Loaded, Failure> {
    let model = durer::mesh::read(path).map_err(|e| Failure::Input(format!("error: {e}")))?;
    for warning in &model.warnings {
        eprintln!("{}", mesh_warning(path, warning));
    }
    Ok(Loaded::Mesh(path.to_path_buf(), Box::new(model.into_scene(width, height))))
}

fn load_subdivided(
    path: &Path,
    subdivide: Subdivide,
    (width, height): (u32, u32),
) -> Result<Loaded, Failure> {
    let read = durer::mesh::read_control_mesh(path).map_err(|e| Failure::Input(format!("error: {e}")))?;
    let (mut data, warnings) = read;
    for warning in &warnings {
        eprintln!("{}", mesh_warning(path, warning));
    }
    data.scheme = match subdivide {
        Subdivide::CatmullClark => Scheme::CatmullClark,
        Subdivide::Loop => Scheme::Loop,
    };
    let scene = durer::mesh::subdivided_scene(data, width, height);
    Ok(Loaded::Mesh(path.to_path_buf(), Box::new(scene)))
}

fn mesh_warning(path: &Path, text: impl std::fmt::Display) -> String {
    format!("warning: {}: {text}", path.display())
}

fn check_ending(scene: &Path) -> Result<(), Failure> {
    let ending = scene.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if ending == "pov" {
        Ok(())
    } else {
        let got = scene.display();
        Err(Failure::Usage(format!(
            "the scene must be a .pov, .obj, .ply, .stl, .gltf or .glb file, got '{got}'"
        )))
    }
}

impl Loaded {
    /// Saves the files that the scene has written.
    pub(crate) fn save_written(&self) -> Result<(), Failure> {
        let Self::Pov(read) = self else { return Ok(()) };
        for file in &read.written {
            let failed = |why: &dyn std::fmt::Display| {
                Failure::file(&file.path, format_args!("the scene's file cannot be written: {why}"))
            };
            // A device or a link would lead elsewhere.
            if std::fs::symlink_metadata(&file.path).is_ok_and(|about| !about.is_file()) {
                return Err(failed(&"the path exists and is not a regular file"));
            }
            std::fs::write(&file.path, &file.text).map_err(|why| failed(&why))?;
        }
        Ok(())
    }

    pub(crate) fn scene(&self) -> &Scene {
        match self {
            Self::Pov(read) => &read.scene,
            Self::Mesh(_, scene) => scene,
        }
    }

    /// The file and line of an object's text, if it has one.
    pub(crate) fn place_of(&self, object: ObjectId) -> Option<String> {
        let Self::Pov(read) = self else { return None };
        let place = read.scene.objects.get(object.0 as usize)?.place?;
        let at = read.sources.locate(place)?;
        Some(format!("{}:{}", at.path.display(), at.line))
    }

    /// The number of faces of each mesh of a mesh file, and how they are connected.
    pub(crate) fn topologies(&self) -> Vec<(usize, Topology)> {
        let Self::Mesh(_, scene) = self else { return Vec::new() };
        let mut known = HashSet::new();
        let meshes = scene.objects.iter().filter_map(|object| match &object.shape {
            // Each mesh is counted once, however many objects share it.
            Shape::Mesh(mesh) => {
                known.insert(Arc::as_ptr(mesh)).then(|| (mesh.faces.len(), Topology::of(mesh)))
            }
            _ => None,
        });
        meshes.collect()
    }

    /// A message about the input, with its place if the place is known.
    fn message(&self, place: Option<Place>, text: String) -> String {
        match self {
            Self::Pov(read) => read.sources.error(place, text).to_string(),
            Self::Mesh(path, _) => format!("error: {}: {text}", path.display()),
        }
    }

    /// Builds the geometry; warnings for the scene's author go to stderr.
    pub(crate) fn lower(&self) -> Result<Lowered, Failure> {
        let lowered = self.scene().lower().map_err(|e| self.refused(&e))?;
        self.warn(&lowered.warnings);
        Ok(lowered)
    }

    /// Builds everything that a picture needs; warnings as in [`Loaded::lower`].
    pub(crate) fn world(&self) -> Result<World, Failure> {
        let world = World::new(self.scene()).map_err(|e| match e {
            WorldError::Lower(e) => self.refused(&e),
            other => Failure::Input(self.message(None, other.to_string())),
        })?;
        self.warn(world.warnings());
        Ok(world)
    }

    fn refused(&self, error: &LowerError) -> Failure {
        Failure::Input(self.message(error.place, error.to_string()))
    }

    fn warn(&self, warnings: &[(Option<Place>, String)]) {
        for (place, why) in warnings {
            let text = match self {
                Self::Pov(_) => self.message(*place, format!("warning: {why}")),
                Self::Mesh(path, _) => mesh_warning(path, why),
            };
            eprintln!("{text}");
        }
    }
}

/// The size of a thread's stack. Without compiler optimisation, kernels have frames of hundreds of
/// kilobytes. Only the part that is used takes memory.
const STACK: usize = 64 << 20;

/// Runs `work` with this many threads, or with one for each core.
pub(crate) fn with_threads<R: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<R, Failure> + Send,
) -> Result<R, Failure> {
    let threads = threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    pool.map_err(|e| Failure::Input(format!("error: cannot start threads: {e}")))?.install(work)
}
