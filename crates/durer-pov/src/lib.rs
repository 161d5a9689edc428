//! This crate reads POV-Ray's scene description language into a [`durer_scene::Scene`].
//!
//! ```no_run
//! let read = durer_pov::read("melencolia.pov".as_ref(), &durer_pov::ReadOptions::default())?;
//! println!("{} objects, {} lights", read.scene.objects.len(), read.scene.lights.len());
//! # Ok::<(), durer_pov::PovError>(())
//! ```
//!
//! The `lexer` turns each file into tokens, once, and `branches` finds the targets of its
//! directives, once. The `parser` passes the tokens to the grammar one by one. On the way it runs
//! directives (`directives`), expands macros (`macros`) and replaces names by their values
//! (`scope`, `value`, `arrays`), because all of these may stand anywhere. `expression`,
//! `functions`, `strings` and `colour` compute values. `object`, `texture`, `light`, `camera` and
//! `settings` read blocks. `scene_builder` turns finished objects into scene data (`volume` does so
//! for flat or empty ones).
//!
//! Reading ends for every text: [`Limits`] bounds its time, memory and depth. Every error is one
//! [`PovError`] with file, line and column, and the text underlined. The reader does not shade. Its
//! only access to the outside is that it reads files.
#![forbid(unsafe_code)]

mod arrays;
mod atmosphere;
mod branches;
mod camera;
mod colour;
mod declare;
mod diagnostics;
mod directives;
mod expression;
mod files;
mod formula;
mod formulas;
mod functions;
mod internal_function;
mod interner;
mod keywords;
mod lens;
mod lexer;
mod light;
mod limits;
mod macros;
mod mesh_camera;
mod messages;
mod noise_pattern;
mod normal_builder;
mod object;
mod parser;
mod pattern_function;
mod picture;
mod pigment_function;
mod rainbow;
mod read;
mod sampled;
mod scene_builder;
mod scope;
mod settings;
mod shipped;
mod source;
mod spline;
mod strings;
mod texture;
mod texture_builder;
mod transform;
mod unsupported;
mod value;
mod vector_function;
mod volume;

pub use crate::diagnostics::{ErrorKind, PovError};
pub use crate::files::WrittenFile;
pub use crate::limits::Limits;
pub use crate::messages::{Message, MessageKind};
pub use crate::read::{Located, Read, ReadOptions, Sources, read, read_with};
