//! The state that all threads share.
//!
//! Two locks: `shared` for what changes often and is held only for moments, and `stage` for the
//! built scene, which renderers read for as long as they work. `stage` is always taken first.

use crate::canvas::{Canvas, Seen};
use crate::channel::{Channel, Scale};
use crate::load::{SceneFile, Stage};
use crate::rig::{Move, Rig};
use durer_math::{Point3, Ray};
use durer_render::film::{Depth, Encoding, Film};
use durer_render::{AntiAliasing, World};
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};
use std::task::Waker;
use std::time::Duration;

/// The most browsers that follow the picture at a time.
pub(crate) const MOST_BROWSERS: usize = 8;

pub(crate) struct Session {
    pub(crate) file: SceneFile,
    pub(crate) pool: rayon::ThreadPool,
    stage: RwLock<Stage>,
    shared: Mutex<Shared>,
    /// Wakes the painter.
    changed: Condvar,
    /// Ends the painter's current work.
    pub(crate) cancel: AtomicBool,
}

/// The state that changes often.
pub(crate) struct Shared {
    /// Grows with every change of what is to be painted.
    pub(crate) generation: u64,
    pub(crate) rig: Rig,
    home: Rig,
    pub(crate) channel: Channel,
    pub(crate) aa: AntiAliasing,
    pub(crate) canvas: Canvas,
    /// The picture in full, for files.
    pub(crate) film: Film,
    pub(crate) scale: Option<Scale>,
    /// The generation and the number of the last finished pass, and whether it was the last.
    pub(crate) done: (u64, u32, bool),
    /// The time that the last finished generation took.
    pub(crate) took: Duration,
    /// Why the scene as it is now cannot be shown.
    error: Option<String>,
    warnings: Vec<String>,
    /// The number of times that the scene was read.
    reads: u64,
    /// Grows with every change that browsers are informed of, other than pixels.
    pub(crate) news: u64,
    browsers: Vec<(u64, Option<Waker>)>,
    next_browser: u64,
}

/// The part of the state that a browser has received.
#[derive(Debug, Default)]
pub(crate) struct Known {
    /// Whether the coarse picture was sent that a new browser gets first.
    pub(crate) preview: bool,
    pub(crate) tiles: Seen,
    pub(crate) news: Option<u64>,
}

impl Session {
    pub(crate) fn new(file: SceneFile, pool: rayon::ThreadPool, stage: Stage, aa: AntiAliasing) -> Self {
        let (width, height) = file.size();
        let home = first_rig(&stage);
        let shared = Shared {
            generation: 1,
            rig: home.clone(),
            home,
            channel: Channel::Picture,
            aa,
            canvas: Canvas::new(width, height),
            film: Film::new(width, height, stage.world.encoding(), Depth::Numbers),
            scale: None,
            done: (0, 0, false),
            took: Duration::ZERO,
            error: None,
            warnings: stage.warnings.clone(),
            reads: 1,
            news: 1,
            browsers: Vec::new(),
            next_browser: 0,
        };
        Self {
            file,
            pool,
            stage: RwLock::new(stage),
            shared: Mutex::new(shared),
            changed: Condvar::new(),
            cancel: AtomicBool::new(false),
        }
    }

    /// The shared state. A thread that panicked cannot have left it half-written in a way that
    /// matters: the next generation paints all pixels again.
    pub(crate) fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The built scene.
    pub(crate) fn stage(&self) -> RwLockReadGuard<'_, Stage> {
        self.stage.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The camera's ray through the middle of a pixel of the picture.
    pub(crate) fn ray(&self, world: &World, (x, y): (u32, u32)) -> Option<Ray> {
        let (width, height) = self.file.size();
        Some(world.camera()?.pixel(x, y, width, height))
    }

    /// Ends the current work; everything is painted again.
    fn restart(&self, shared: &mut Shared) {
        shared.generation += 1;
        self.cancel.store(true, Ordering::Relaxed);
        self.changed.notify_all();
        shared.announce();
    }

    /// Moves the camera. Returns the generation that shows the move.
    pub(crate) fn move_camera(&self, how: Move) -> u64 {
        let target = match how {
            Move::LookAt(x, y) => self.point_at((x, y)),
            _ => None,
        };
        let mut shared = self.shared();
        match (how, target) {
            (Move::LookAt(..), Some(target)) => shared.rig.look_at(target),
            (Move::LookAt(..), None) => {}
            (Move::Reset, _) => shared.rig = shared.home.clone(),
            _ => shared.rig.apply(how),
        }
        self.restart(&mut shared);
        shared.generation
    }

    fn point_at(&self, pixel: (u32, u32)) -> Option<Point3> {
        let stage = self.stage();
        let ray = self.ray(&stage.world, pixel)?;
        let geometry = stage.world.geometry();
        Some(geometry.resolve(&ray, &geometry.closest(&ray)?).p)
    }

    /// Chooses what pixels show.
    pub(crate) fn show(&self, channel: Channel) -> u64 {
        let mut shared = self.shared();
        shared.channel = channel;
        self.restart(&mut shared);
        shared.generation
    }

    /// Chooses the anti-aliasing.
    pub(crate) fn anti_alias(&self, how: AntiAliasing) -> u64 {
        let mut shared = self.shared();
        shared.aa = how;
        self.restart(&mut shared);
        shared.generation
    }

    /// Replaces the scene after a change of its files. A camera that was moved stays where it is,
    /// unless the scene's own camera has changed.
    pub(crate) fn replace(&self, stage: Stage) {
        let home = first_rig(&stage);
        self.cancel.store(true, Ordering::Relaxed);
        let mut current = self.stage.write().unwrap_or_else(PoisonError::into_inner);
        let mut shared = self.shared();
        if home.camera != shared.home.camera {
            shared.rig = home.clone();
        }
        shared.home = home;
        shared.error = None;
        shared.warnings.clone_from(&stage.warnings);
        shared.reads += 1;
        *current = stage;
        self.restart(&mut shared);
    }

    /// Shows why the changed scene cannot be shown. The picture stays.
    pub(crate) fn refuse(&self, message: String) {
        let mut shared = self.shared();
        shared.error = Some(message);
        shared.announce();
    }

    /// Waits until something is to be painted that is newer than `generation`, and gives the scene
    /// the camera for it. Returns what is to be painted.
    pub(crate) fn next_work(&self, generation: u64) -> Work {
        let mut shared = self.shared();
        while shared.generation == generation {
            shared = self.changed.wait(shared).unwrap_or_else(PoisonError::into_inner);
        }
        drop(shared);
        let mut stage = self.stage.write().unwrap_or_else(PoisonError::into_inner);
        let mut shared = self.shared();
        self.cancel.store(false, Ordering::Relaxed);
        let camera = shared.rig.camera.clone();
        if shared.channel != Channel::Picture {
            // Measurements are written as they are, and pixels that hit nothing are clear.
            shared.new_film(self.file.size(), Encoding::Linear);
        } else if shared.film.encoding() != stage.world.encoding() || !shared.film.is_complete() {
            shared.new_film(self.file.size(), stage.world.encoding());
        }
        let work = Work { generation: shared.generation, channel: shared.channel, aa: shared.aa };
        drop(shared);
        // A rig refuses moves that would make a camera that cannot be built.
        let _ = stage.world.set_camera(&camera);
        work
    }

    /// Admits a browser that follows the picture, unless there are too many.
    pub(crate) fn join(&self) -> Option<u64> {
        let mut shared = self.shared();
        if shared.browsers.len() >= MOST_BROWSERS {
            return None;
        }
        shared.next_browser += 1;
        let id = shared.next_browser;
        shared.browsers.push((id, None));
        Some(id)
    }

    pub(crate) fn leave(&self, browser: u64) {
        self.shared().browsers.retain(|(id, _)| *id != browser);
    }

    /// Wakes all browsers.
    pub(crate) fn wake(&self) {
        self.shared().wake();
    }
}

/// The task of the painter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    pub(crate) generation: u64,
    pub(crate) channel: Channel,
    pub(crate) aa: AntiAliasing,
}

impl Shared {
    fn new_film(&mut self, (width, height): (u32, u32), encoding: Encoding) {
        self.film = Film::new(width, height, encoding, Depth::Numbers);
    }

    /// Informs browsers of a change.
    pub(crate) fn announce(&mut self) {
        self.news += 1;
        self.wake();
    }

    pub(crate) fn wake(&mut self) {
        for (_, waker) in &mut self.browsers {
            if let Some(waker) = waker.take() {
                waker.wake();
            }
        }
    }

    /// Wakes `browser` by this at the next change.
    pub(crate) fn wait(&mut self, browser: u64, waker: &Waker) {
        if let Some((_, slot)) = self.browsers.iter_mut().find(|(id, _)| *id == browser) {
            *slot = Some(waker.clone());
        }
    }

    /// The state as the page shows it.
    pub(crate) fn state(&self, name: &str, (width, height): (u32, u32)) -> Value {
        let (generation, pass, is_last) = self.done;
        json!({
            "name": name,
            "width": width,
            "height": height,
            "generation": self.generation,
            "painted": { "generation": generation, "pass": pass, "last": is_last, "ms": self.took.as_secs_f64() * 1e3 },
            "channel": self.channel.name(),
            "scale": self.scale.map(|s| [s.low, s.high]),
            "aa": aa_name(self.aa),
            "camera": self.rig.text(),
            "moved": self.rig.camera != self.home.camera,
            "error": self.error,
            "warnings": self.warnings,
            "reads": self.reads,
        })
    }
}

/// Anti-aliasing as the command line writes it.
fn aa_name(aa: AntiAliasing) -> String {
    let depth_only = |threshold: f64, depth: u32| {
        if (threshold, depth) == (AntiAliasing::THRESHOLD, AntiAliasing::DEPTH) {
            String::new()
        } else {
            format!(",{threshold},{depth}")
        }
    };
    match aa {
        AntiAliasing::Off => "off".to_owned(),
        AntiAliasing::Grid(n) => format!("{n}x{n}"),
        AntiAliasing::Method1 { threshold, depth } => format!("method1{}", depth_only(threshold, depth)),
        AntiAliasing::Method2 { threshold, depth } => format!("method2{}", depth_only(threshold, depth)),
    }
}

/// The scene's camera. It turns about the surface in the middle of the picture, or about the middle
/// of the scene if there is nothing.
fn first_rig(stage: &Stage) -> Rig {
    let camera = stage.scene.camera.clone().unwrap_or_default();
    let geometry = stage.world.geometry();
    let ray = Ray::new(camera.location, camera.direction);
    let bounds = geometry.bounds();
    let pivot = match geometry.closest(&ray) {
        Some(hit) => geometry.resolve(&ray, &hit).p,
        None if bounds.is_bounded() && !bounds.is_empty() => {
            let d = camera.direction;
            let t = (bounds.centre() - camera.location).dot(d) / d.dot(d);
            camera.location + d * if t > 0.0 { t } else { 1.0 }
        }
        None => camera.location + camera.direction,
    };
    let pivot = if pivot.is_finite() { pivot } else { camera.location + camera.direction };
    Rig::new(camera, pivot)
}
