//! The entry point: from the path of a file to a scene.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use crate::camera::Camera;
use crate::diagnostics::{Error, ErrorKind, Place, PovError, Result, lexeme_length};
use crate::files::WrittenFile;
use crate::keywords::Keyword;
use crate::lexer::{Directive, NO_BLOCK};
use crate::limits::{self, Limits};
use crate::messages::{Message, Messages};
use crate::object::begins_object;
use crate::parser::{Item, Parser};
use crate::source::{Library, Source};
use crate::value::Value;

/// Options for reading a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// Folders to search for include files, after the scene's own folder and before those of an
    /// installed POV-Ray.
    pub library_paths: Vec<PathBuf>,
    /// Names declared as floats before the scene begins.
    pub declares: Vec<(String, f64)>,
    /// The value of `clock`.
    pub clock: f64,
    /// The value of `image_width`, in pixels.
    pub image_width: u32,
    /// The value of `image_height`, in pixels.
    pub image_height: u32,
    /// The limits of the reader.
    pub limits: Limits,
    /// Whether a scene is refused that uses a feature which would be left out of the picture:
    /// `radiosity`, `photons`, `media`, `subsurface`.
    pub strict: bool,
    /// The noise of textures and functions, if it is not durer's own.
    pub noise: Option<std::sync::Arc<durer_scene::LearnedNoise>>,
    /// The folder of the files that the scene writes; `None` for the scene's own.
    pub write_folder: Option<PathBuf>,
    /// Whether the names of these files may lead out of their folder.
    pub any_file: bool,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            library_paths: Vec::new(),
            declares: Vec::new(),
            clock: 0.0,
            image_width: 800,
            image_height: 600,
            limits: Limits::default(),
            strict: false,
            noise: None,
            write_folder: None,
            any_file: false,
        }
    }
}

/// A scene that was read, and the messages on the way.
#[derive(Clone, Debug)]
pub struct Read {
    /// The scene.
    pub scene: durer_scene::Scene,
    /// `#debug`, `#warning` and the reader's own warnings, in their order (the first ten thousand).
    /// A `#warning` that repeats its text is reported once, and once more at the end with the
    /// number of times.
    pub messages: Vec<Message>,
    /// The files that the scene has written, with `#write`. They are only here: whoever wants them
    /// saves them.
    pub written: Vec<WrittenFile>,
    /// The files, for messages about a [`durer_scene::Place`].
    pub sources: Sources,
}

/// The files of a scene.
#[derive(Clone, Debug)]
pub struct Sources {
    files: Vec<std::sync::Arc<Source>>,
    main: PathBuf,
}

/// A place in the text of a scene, for display.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located<'a> {
    /// The file.
    pub path: &'a Path,
    /// The line, counted from 1.
    pub line: usize,
    /// The column, counted from 1 in characters.
    pub column: usize,
    /// The number of characters of the word there.
    pub length: usize,
    /// The text of the whole file.
    pub text: &'a str,
}

impl Sources {
    /// The files that were read, the scene's own among them.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|file| file.path.as_path())
    }

    /// Where a place is; `None` if it is in none of these files.
    pub fn locate(&self, place: durer_scene::Place) -> Option<Located<'_>> {
        let source = self.files.get(place.file as usize)?;
        let start = place.start as usize;
        let (line, column) = source.line_and_column(start);
        let rest = source.text.get(start..)?;
        let rest = rest.lines().next().unwrap_or_default();
        let length = rest[..lexeme_length(rest)].chars().count();
        Some(Located { path: &source.path, line, column, length, text: &source.text })
    }

    /// A message about `place`, in the same form as all others.
    pub fn error(&self, place: Option<durer_scene::Place>, text: impl Into<String>) -> PovError {
        let place = place.map(|p| Place { file: p.file, start: p.start });
        let fault = Error { place, kind: ErrorKind::Invalid, text: text.into(), route: Vec::new() };
        PovError::new(&fault, &self.main, &self.files)
    }
}

/// The stack of the reading thread. Nested blocks and brackets are read recursively, as deep as
/// [`Limits::nesting`] allows. Only the part that is used takes memory.
const STACK: usize = 512 << 20;

/// Reads the scene at `path`.
///
/// # Errors
///
/// Returns a [`PovError`] if something is wrong with the text, if a file cannot be read, or if a
/// limit is exceeded.
pub fn read(path: &Path, options: &ReadOptions) -> std::result::Result<Read, PovError> {
    read_with(path, options, |_| {})
}

/// [`read`], which also passes every message to `listener` at once.
///
/// # Errors
///
/// See [`read`].
pub fn read_with(
    path: &Path,
    options: &ReadOptions,
    listener: impl FnMut(&Message) + Send,
) -> std::result::Result<Read, PovError> {
    let failed = |text: String| {
        PovError::new(
            &Error { place: None, kind: ErrorKind::File, text, route: Vec::new() },
            path,
            &[] as &[Rc<Source>],
        )
    };
    std::thread::scope(|scope| {
        let work = || on_this_thread(path, options, Box::new(listener));
        let thread = std::thread::Builder::new().name("durer-pov".into()).stack_size(STACK);
        let thread =
            thread.spawn_scoped(scope, work).map_err(|why| failed(format!("no thread to read it: {why}")))?;
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

fn on_this_thread<'a>(
    path: &Path,
    options: &'a ReadOptions,
    listener: Box<dyn FnMut(&Message) + Send + 'a>,
) -> std::result::Result<Read, PovError> {
    limits::reset_memory();
    let library = Library::new(path, &options.library_paths);
    let mut reader = Parser::new(options, library, Messages::new(listener));
    let scene = reader.scene(path);
    reader.messages.finish();
    match scene {
        Ok(scene) => {
            let messages = std::mem::take(&mut reader.messages.kept);
            let sources = reader.sources.drain(..).map(|source| {
                let text = match Rc::try_unwrap(source) {
                    Ok(own) => Source::new(own.path, own.text),
                    Err(shared) => Source::new(shared.path.clone(), shared.text.clone()),
                };
                std::sync::Arc::new(text)
            });
            let sources = Sources { files: sources.collect(), main: path.to_path_buf() };
            let written = std::mem::take(&mut reader.files.written);
            Ok(Read { scene, messages, written, sources })
        }
        Err(mut fault) => {
            fault.route.extend(reader.route());
            Err(PovError::new(&fault, path, &reader.sources))
        }
    }
}

impl Parser<'_> {
    /// Reads the whole scene.
    fn scene(&mut self, path: &Path) -> Result<durer_scene::Scene> {
        let options = self.options;
        let named = [
            ("image_width", f64::from(options.image_width)),
            ("image_height", f64::from(options.image_height)),
            ("clock_delta", 0.0),
            ("frame_number", 0.0),
            ("initial_frame", 0.0),
            ("final_frame", 0.0),
            ("initial_clock", 0.0),
            ("final_clock", 0.0),
        ];
        let given = options.declares.iter().map(|(name, value)| (name.as_str(), *value));
        for (name, value) in named.into_iter().chain(given) {
            if !is_name(name) || self.predeclare(name, value).is_none() {
                return Err(Error::file(
                    None,
                    format!("`{name}` cannot be declared: it is no name, or a word of the language"),
                ));
            }
        }
        let file = self.load(path.to_path_buf(), None)?;
        self.enter_file(file, None)?;
        loop {
            let lexeme = self.next()?;
            let place = lexeme.place;
            match &lexeme.item {
                Item::End => break,
                Item::Word(Keyword::Camera) => self.camera_statement(place)?,
                // These may begin a statement without `#`.
                Item::Word(keyword) if let Some(directive) = bare_directive(*keyword) => {
                    self.nested(|r| r.run_directive(directive, NO_BLOCK, place))?;
                }
                Item::Word(Keyword::Media) => self.leave_out(Keyword::Media, place)?,
                Item::Word(Keyword::Rainbow) => self.rainbow_statement()?,
                Item::Word(Keyword::Background) => self.background()?,
                Item::Word(Keyword::Fog) => {
                    self.put_back(lexeme);
                    self.fog_statement()?;
                }
                Item::Word(Keyword::SkySphere) => {
                    self.put_back(lexeme);
                    self.sky_sphere_statement()?;
                }
                Item::Word(Keyword::GlobalSettings) => self.global_settings()?,
                Item::Word(keyword) if begins_object(*keyword) => self.object_statement(lexeme)?,
                Item::Value(Value::Object(_)) | Item::Unknown(_) => self.object_statement(lexeme)?,
                _ => return Err(self.unexpected(&lexeme, "an object or a directive")),
            }
        }
        if self.language.gamma.is_none() && self.language.shading_version() >= 3.7 {
            let start = Place { file, start: 0 };
            self.notice(start, "assumed_gamma is not given: taken as 1.0");
        }
        if self.scene.camera.is_none() {
            self.scene.camera = Some(Camera::default());
            if !self.scene.objects.is_empty() {
                let start = Place { file, start: 0 };
                self.notice(start, "the scene has no camera: the default one is used");
            }
        }
        self.finished()
    }

    fn object_statement(&mut self, first: crate::parser::Lexeme) -> Result<()> {
        self.put_back(first);
        let object = self.object()?;
        self.emit(&object)
    }
}

/// The directive that `keyword` stands for at the beginning of a statement.
fn bare_directive(keyword: Keyword) -> Option<Directive> {
    match keyword {
        Keyword::Declare => Some(Directive::Declare),
        Keyword::Include => Some(Directive::Include),
        Keyword::Default => Some(Directive::Default),
        Keyword::Version => Some(Directive::Version),
        _ => None,
    }
}

/// Whether the lexer would take `text` for one name.
fn is_name(text: &str) -> bool {
    let mut letters = text.chars();
    letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
}
