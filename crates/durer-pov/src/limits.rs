//! Hard limits, each with a number and a name, so that no text can make the reader hang or exhaust
//! the memory.

use std::cell::Cell;

use crate::diagnostics::{Error, ErrorKind, Place, Result};

/// The limits of the reader. A scene that exceeds one is refused with a message.
///
/// The names are those of the command's `--limit NAME=N`; see [`Limits::set`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The number of include files that are open at the same time (`include_depth`).
    pub include_depth: u64,
    /// The number of macro calls that are open at the same time (`macro_depth`).
    pub macro_depth: u64,
    /// The number of tokens and directives read; a loop counts each time it runs (`steps`).
    pub steps: u64,
    /// The bytes of scene data: texts, tokens, values and objects (`memory`).
    pub memory: u64,
    /// The bytes of one file (`file_size`).
    pub file_size: u64,
    /// The depth of nested brackets, blocks and operators (`nesting`).
    pub nesting: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            include_depth: 64,
            macro_depth: 1024,
            steps: 50_000_000,
            memory: half_of_memory(),
            file_size: 192 << 20,
            nesting: 512,
        }
    }
}

/// Half of the machine's memory, or 768 MB if the system does not report it.
fn half_of_memory() -> u64 {
    let told = std::fs::read_to_string("/proc/meminfo").ok();
    let total = told.as_deref().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()
    });
    total.map_or(768 << 20, |kilobytes| kilobytes * 512)
}

impl Limits {
    /// The names that [`Limits::set`] knows, in the order of the fields.
    pub const NAMES: [&'static str; 6] =
        ["include_depth", "macro_depth", "steps", "memory", "file_size", "nesting"];

    /// Sets the limit called `name`. Returns `false` if there is no such limit.
    pub fn set(&mut self, name: &str, value: u64) -> bool {
        let field = match name {
            "include_depth" => &mut self.include_depth,
            "macro_depth" => &mut self.macro_depth,
            "steps" => &mut self.steps,
            "memory" => &mut self.memory,
            "file_size" => &mut self.file_size,
            "nesting" => &mut self.nesting,
            _ => return false,
        };
        *field = value;
        true
    }
}

/// The error for exceeding the limit `name`.
pub(crate) fn exceeded(place: Place, name: &str, limit: u64, what: &str) -> Box<Error> {
    Error::at(
        place,
        ErrorKind::Limit,
        format!("{what}: the limit `{name}` is {limit} (a larger one can be given with --limit {name}=N)"),
    )
}

thread_local! {
    /// The bytes held by the values of the scene that this thread is reading.
    static HELD: Cell<u64> = const { Cell::new(0) };
    /// The part of these bytes that is charged until the scene is finished.
    static FOR_GOOD: Cell<u64> = const { Cell::new(0) };
}

/// Bytes charged to the scene's memory. They are released when the value that owns them is dropped.
#[derive(Debug, PartialEq)]
pub(crate) struct Charge(u64);

impl Charge {
    /// Charges `bytes`. The limit is tested at the next [`check_memory`].
    pub(crate) fn new(bytes: usize) -> Self {
        HELD.with(|held| held.set(held.get() + bytes as u64));
        Self(bytes as u64)
    }

    /// Charges `after` instead of `before`.
    pub(crate) fn change(&mut self, before: usize, after: usize) {
        self.resize((self.0 as usize).saturating_sub(before).saturating_add(after));
    }

    /// Changes the charge to `bytes`.
    pub(crate) fn resize(&mut self, bytes: usize) {
        HELD.with(|held| held.set(held.get() - self.0 + bytes as u64));
        self.0 = bytes as u64;
    }
}

impl Clone for Charge {
    fn clone(&self) -> Self {
        Self::new(self.0 as usize)
    }
}

impl Drop for Charge {
    fn drop(&mut self) {
        HELD.with(|held| held.set(held.get() - self.0));
    }
}

/// Charges bytes that stay charged until the scene is finished.
pub(crate) fn charge_for_good(bytes: usize) {
    HELD.with(|held| held.set(held.get() + bytes as u64));
    FOR_GOOD.with(|held| held.set(held.get() + bytes as u64));
}

/// Runs `work`, whose scene data is soon dropped, and releases what it charged until the end of the
/// scene.
pub(crate) fn giving_back<T>(work: impl FnOnce() -> T) -> T {
    let before = FOR_GOOD.with(Cell::get);
    let made = work();
    let more = FOR_GOOD.with(|held| held.replace(before)) - before;
    HELD.with(|held| held.set(held.get() - more));
    made
}

/// Resets the count to zero.
pub(crate) fn reset_memory() {
    HELD.with(|held| held.set(0));
    FOR_GOOD.with(|held| held.set(0));
}

/// Fails if the charged bytes and `more` bytes, which are about to be charged, exceed the limit
/// `memory`.
pub(crate) fn check_memory(place: Place, limits: &Limits, more: usize) -> Result<()> {
    let held = HELD.with(Cell::get).saturating_add(more as u64);
    if held > limits.memory {
        return Err(exceeded(place, "memory", limits.memory, "the scene's data need too much memory"));
    }
    Ok(())
}
