//! The command `durer`.
fn main() {}
