//! The stream of server-sent events that a browser follows.
//!
//! A message is made when the connection can take one, from what has changed since the last one.
//! So nothing piles up for a browser that reads slowly or not at all.

use crate::session::{Known, Session};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bytes::Bytes;
use hyper::body::{Body, Frame};
use std::convert::Infallible;
use std::pin::Pin;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};
use std::time::Instant;

/// A message with tiles has about this many bytes, before they are written as text.
const ENOUGH: usize = 48 << 10;

/// Tells whether a connection still takes messages.
#[derive(Debug, Default)]
pub(crate) struct Pulse(Mutex<Option<Instant>>);

impl Pulse {
    fn beat(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }

    /// The time since the connection requested the last message; `None` if it is no stream.
    pub(crate) fn age(&self) -> Option<std::time::Duration> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).map(|at| at.elapsed())
    }
}

/// Counts the beats: comments that keep the streams alive and show which ones are dead.
#[derive(Debug, Default)]
pub(crate) struct Beats(pub(crate) AtomicU64);

/// The state and the coarse picture so far, for the page to show before its stream has begun.
pub(crate) fn so_far(session: &Session) -> serde_json::Value {
    let shared = session.shared();
    let mut tiles = Vec::new();
    let generation = shared.canvas.preview(&mut tiles);
    let state = shared.state(&session.file.name(), session.file.size());
    drop(shared);
    serde_json::json!({ "state": state, "tiles": format!("{generation} {}", STANDARD.encode(tiles)) })
}

/// The body of the stream.
pub(crate) struct Events {
    session: Arc<Session>,
    pulse: Arc<Pulse>,
    beats: Arc<Beats>,
    beat: u64,
    browser: u64,
    known: Known,
}

impl Events {
    /// A stream for one more browser, unless there are too many.
    pub(crate) fn join(session: &Arc<Session>, pulse: &Arc<Pulse>, beats: &Arc<Beats>) -> Option<Self> {
        let browser = session.join()?;
        pulse.beat();
        Some(Self {
            session: Arc::clone(session),
            pulse: Arc::clone(pulse),
            beats: Arc::clone(beats),
            beat: beats.0.load(Ordering::Relaxed),
            browser,
            known: Known::default(),
        })
    }

    /// The next message, if something has changed.
    fn message(&mut self, context: &Context<'_>) -> Option<String> {
        let beat = self.beats.0.load(Ordering::Relaxed);
        let mut shared = self.session.shared();
        // The size must be known before tiles come.
        if self.known.news.is_some() {
            let mut tiles = Vec::new();
            let mut generation = 0;
            if !std::mem::replace(&mut self.known.preview, true) {
                generation = shared.canvas.preview(&mut tiles);
            }
            if tiles.is_empty() {
                generation = shared.canvas.news(&mut self.known.tiles, ENOUGH, &mut tiles);
            }
            if !tiles.is_empty() {
                drop(shared);
                return Some(format!("event: tiles\ndata: {generation} {}\n\n", STANDARD.encode(tiles)));
            }
        }
        if self.known.news != Some(shared.news) {
            self.known.news = Some(shared.news);
            let state = shared.state(&self.session.file.name(), self.session.file.size());
            return Some(format!("event: state\ndata: {state}\n\n"));
        }
        shared.wait(self.browser, context.waker());
        drop(shared);
        (beat != self.beat).then(|| {
            self.beat = beat;
            ": still here\n\n".to_owned()
        })
    }
}

impl Body for Events {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let this = self.get_mut();
        this.pulse.beat();
        match this.message(context) {
            Some(text) => Poll::Ready(Some(Ok(Frame::data(text.into())))),
            None => Poll::Pending,
        }
    }
}

impl Drop for Events {
    fn drop(&mut self) {
        self.session.leave(self.browser);
    }
}
