//! A scene in the browser: the page of `durer view`, and the server behind it.
//!
//! [`View::open`] reads and builds a scene; [`View::serve`] answers a browser on this machine until
//! the program ends. The picture forms step by step and is sent as it forms. The page turns the
//! camera, shows what surfaces are (depth, normals, objects, error bounds), and explains the ray of
//! a clicked pixel. A saved change of the scene's file appears by itself.
//!
//! ```no_run
//! use durer_view::{SceneFile, View, ViewSettings};
//!
//! let scene = SceneFile::new("scene.pov", durer_pov::ReadOptions::default());
//! let view = View::open(scene, ViewSettings::default())?;
//! view.serve(|address| println!("{address}"))?;
//! # Ok::<(), durer_view::ViewError>(())
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | `load` | reading and building a scene |
//! | `rig` | the camera and its moves |
//! | `session` | the state that all threads share |
//! | `painter` | the thread that renders, coarse pixels first |
//! | `channel` | what a pixel can show besides its colour |
//! | `canvas` | the pixels so far, and what each browser has seen of them |
//! | `explain` | the ray of one pixel, as data for the page |
//! | `watch` | saved changes of the scene's files |
//! | `server`, `routes`, `events` | HTTP, on loopback only |
//!
//! # Safety of the server
//!
//! It listens on 127.0.0.1 only. Every path begins with a random token, and the `Host` header must
//! name this machine, so that neither other users' programs nor web pages can read the scene.
//! Connections, request sizes and times are limited. A browser that stops reading costs a fixed
//! amount of memory: messages are made only when it can take them.
#![forbid(unsafe_code)]

mod canvas;
mod channel;
mod events;
mod explain;
mod load;
mod painter;
mod palette;
mod rig;
mod routes;
mod server;
mod session;
mod source;
mod view;
mod watch;

pub use crate::load::SceneFile;
pub use crate::view::{View, ViewError, ViewSettings};
