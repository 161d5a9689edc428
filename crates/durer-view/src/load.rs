//! Reading and building a scene.

use durer_mesh::Format;
use durer_pov::{ReadOptions, Sources};
use durer_render::{World, WorldError};
use durer_scene::{LowerError, Lowered, Place, Scene};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The file of a scene, and how to read it.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// A `.pov` file or a mesh.
    pub path: PathBuf,
    /// Options for `.pov` files. The size of the picture counts for meshes too.
    pub options: ReadOptions,
}

impl SceneFile {
    /// The scene at `path`.
    pub fn new(path: impl Into<PathBuf>, options: ReadOptions) -> Self {
        Self { path: path.into(), options }
    }

    /// The columns and rows of the picture.
    pub(crate) fn size(&self) -> (u32, u32) {
        (self.options.image_width, self.options.image_height)
    }

    /// The name of the file, for display.
    pub(crate) fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Reads and builds the scene.
    pub(crate) fn load(&self) -> Result<Stage, Refused> {
        let (scene, text, mut warnings) = self.read()?;
        if scene.camera.is_none() {
            return Err(self.refused("the scene has no camera, and a picture needs one"));
        }
        let origin = Origin { path: self.path.clone(), text };
        let world = World::new(&scene).map_err(|e| match e {
            WorldError::Lower(e) => origin.refused(&e),
            other => Refused { message: origin.message(None, &other.to_string()), files: origin.files() },
        })?;
        let built = world.warnings().iter();
        warnings.extend(built.map(|(place, why)| origin.message(*place, &format!("warning: {why}"))));
        warnings.truncate(MOST_WARNINGS);
        Ok(Stage { scene, origin, world, warnings, queries: OnceLock::new() })
    }

    fn read(&self) -> Result<(Scene, Option<Sources>, Vec<String>), Refused> {
        if Format::of(&self.path).is_some() {
            let model = durer_mesh::read(&self.path).map_err(|e| self.refused(e))?;
            let warning = |w: &durer_mesh::Warning| format!("warning: {}: {w}", self.path.display());
            let warnings = model.warnings.iter().take(MOST_WARNINGS).map(warning).collect();
            let (width, height) = self.size();
            return Ok((model.into_scene(width, height), None, warnings));
        }
        let read = durer_pov::read(&self.path, &self.options).map_err(|e| Refused {
            message: e.to_string(),
            files: vec![self.path.clone(), e.path.clone()],
        })?;
        let said = read.messages.iter().filter(|m| m.kind != durer_pov::MessageKind::Debug);
        let warnings = said.take(MOST_WARNINGS).map(|m| m.to_string().trim_end().to_owned()).collect();
        Ok((read.scene, Some(read.sources), warnings))
    }

    fn refused(&self, what: impl std::fmt::Display) -> Refused {
        Refused { message: format!("error: {}: {what}", self.path.display()), files: vec![self.path.clone()] }
    }
}

/// The most warnings that are shown.
const MOST_WARNINGS: usize = 100;

/// A scene that could not be read or built.
#[derive(Clone, Debug)]
pub(crate) struct Refused {
    /// The whole message, with its place and the underlined text.
    pub(crate) message: String,
    /// The files in which the cause may lie.
    pub(crate) files: Vec<PathBuf>,
}

/// Where a scene comes from.
#[derive(Debug)]
pub(crate) struct Origin {
    pub(crate) path: PathBuf,
    /// The texts of a `.pov` scene.
    pub(crate) text: Option<Sources>,
}

impl Origin {
    /// A message about the scene, with its place if it is known.
    fn message(&self, place: Option<Place>, text: &str) -> String {
        match &self.text {
            Some(sources) => sources.error(place, text).to_string(),
            None => format!("{}: {text}", self.path.display()),
        }
    }

    fn refused(&self, error: &LowerError) -> Refused {
        Refused { message: self.message(error.place, &error.to_string()), files: self.files() }
    }

    /// All files of the scene.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut files = vec![self.path.clone()];
        let read = self.text.iter().flat_map(Sources::paths).map(Path::to_path_buf);
        files.extend(read);
        files.sort();
        files.dedup();
        files
    }
}

/// A scene that is built.
pub(crate) struct Stage {
    pub(crate) scene: Scene,
    pub(crate) origin: Origin,
    /// Built for pictures.
    pub(crate) world: World,
    pub(crate) warnings: Vec<String>,
    /// Built for exact queries, when first needed.
    queries: OnceLock<Result<Lowered, String>>,
}

impl Stage {
    /// The geometry for exact queries: that of `durer trace` and `durer explain`.
    pub(crate) fn queries(&self) -> Result<&Lowered, String> {
        let build = || self.scene.lower().map_err(|e| self.origin.refused(&e).message);
        self.queries.get_or_init(build).as_ref().map_err(Clone::clone)
    }
}
