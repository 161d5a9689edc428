//! Root finders: one solver, one file.

pub(crate) mod quadratic;
