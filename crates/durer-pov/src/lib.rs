//! POV-Ray's scene description language, read into [`durer_scene::Scene`].
//!
//! ```no_run
//! let read = durer_pov::read("melencolia.pov".as_ref(), &durer_pov::ReadOptions::default())?;
//! println!("{} objects, {} lights", read.scene.objects.len(), read.scene.lights.len());
//! # Ok::<(), durer_pov::PovError>(())
//! ```
//!
//! A file becomes tokens once (`lexer`), and where its directives lead is found once (`blocks`). The `reader` then
//! hands tokens to the grammar one by one; on the way it runs directives (`directives`), unfolds macros (`macros`)
//! and replaces names by their values (`scope`, `value`, `arrays`), because all of them may stand anywhere. Values are
//! computed in `expression`, `functions`, `strings` and `colour`; blocks are read in `object`, `texture`, `light`,
//! `camera` and `settings`; `emit` makes scene data of what is finished (`volume` of what is flat or empty).
//!
//! Whatever the text is, reading ends: [`Limits`] bounds it in time, memory and depth, and every fault is one
//! [`PovError`] with its file, line, column and the words underlined. The reader shades nothing, and the only thing it
//! does to the world is to read files.
#![forbid(unsafe_code)]

mod arrays;
mod branches;
mod camera;
mod colour;
mod declare;
mod diagnostics;
mod directives;
mod expression;
mod formula;
mod formulas;
mod functions;
mod interner;
mod keywords;
mod lexer;
mod light;
mod limits;
mod macros;
mod messages;
mod noise_pattern;
mod object;
mod parser;
mod pattern_function;
mod pigment_function;
mod read;
mod scene_builder;
mod scope;
mod settings;
mod source;
mod spline;
mod strings;
mod texture;
mod transform;
mod unsupported;
mod value;
mod vector_function;
mod volume;

pub use crate::diagnostics::{ErrorKind, PovError};
pub use crate::limits::Limits;
pub use crate::messages::{Message, MessageKind};
pub use crate::read::{Read, ReadOptions, Sources, read, read_with};
