//! The viewer: a session, its painter, its watcher and its server.

use crate::load::SceneFile;
use crate::session::Session;
use crate::{painter, server, watch};
use durer_render::AntiAliasing;
use std::sync::Arc;

/// How a scene is viewed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// The anti-aliasing that the finished picture has.
    pub anti_aliasing: AntiAliasing,
    /// The number of threads that render; one for each processor if absent.
    pub threads: Option<usize>,
    /// The port to listen on; 0 for any free one.
    pub port: u16,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self { anti_aliasing: AntiAliasing::Off, threads: None, port: 0 }
    }
}

/// Why a scene cannot be viewed.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The scene is wrong. The message is complete, with its place and the underlined text.
    #[error("{0}")]
    Scene(String),
    /// The picture has too many pixels.
    #[error(
        "a picture of {0} x {1} pixels is too large to be viewed: at most {MOST_PIXELS} pixels are shown"
    )]
    Size(u32, u32),
    /// No server could be started.
    #[error("the page cannot be served: {0}")]
    Server(#[source] std::io::Error),
    /// No threads could be started.
    #[error("threads: {0}")]
    Threads(String),
}

/// The most pixels of a picture in the page.
const MOST_PIXELS: u64 = 1 << 24;

/// The size of a renderer's stack. Without compiler optimisation, kernels have frames of hundreds
/// of kilobytes. Only the part that is used takes memory.
const STACK: usize = 64 << 20;

/// A scene that is read and built, and whose picture forms.
pub struct View {
    session: Arc<Session>,
    port: u16,
}

impl View {
    /// Reads and builds a scene, and begins to render it.
    ///
    /// # Errors
    ///
    /// Returns a [`ViewError`] if the scene is wrong or the picture too large.
    pub fn open(file: SceneFile, settings: ViewSettings) -> Result<Self, ViewError> {
        let (width, height) = file.size();
        if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(ViewError::Size(width, height));
        }
        let threads = settings.threads.unwrap_or(0);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
        let pool = pool.map_err(|e| ViewError::Threads(e.to_string()))?;
        let stage = pool.install(|| file.load()).map_err(|e| ViewError::Scene(e.message))?;
        let session = Arc::new(Session::new(file, pool, stage, settings.anti_aliasing));
        for (name, work) in [("painter", painter::paint as fn(&Session)), ("watcher", watch::watch)] {
            let session = Arc::clone(&session);
            let thread = std::thread::Builder::new().name(name.into()).stack_size(STACK);
            thread.spawn(move || work(&session)).map_err(|e| ViewError::Threads(e.to_string()))?;
        }
        Ok(Self { session, port: settings.port })
    }

    /// Warnings about the scene.
    pub fn warnings(&self) -> Vec<String> {
        self.session.stage().warnings.clone()
    }

    /// Serves the page on this machine until the program ends. `ready` gets the page's address.
    ///
    /// # Errors
    ///
    /// Returns [`ViewError::Server`] if no server can be started.
    pub fn serve(self, ready: impl FnOnce(&str)) -> Result<(), ViewError> {
        server::serve(self.session, self.port, ready)
    }
}

impl core::fmt::Debug for View {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("View").field("file", &self.session.file.path).finish_non_exhaustive()
    }
}
