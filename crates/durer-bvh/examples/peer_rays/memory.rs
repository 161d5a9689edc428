//! What a process holds, as Linux tells.

/// A number of `/proc/self/status`, in bytes.
fn told(name: &str) -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    Some(line.split_whitespace().next()?.parse::<usize>().ok()? << 10)
}

/// What `f` gives, and the most memory that was held meanwhile above what was held before, in
/// bytes; `None` where the system does not tell.
///
/// That is memory in the process's pages: what was asked for and never written to does not count,
/// and what pages hold beside it does.
pub(crate) fn most_held<R>(f: impl FnOnce() -> R) -> (R, Option<usize>) {
    // "5" lets the most begin anew (proc(5), Linux 4.0 and later).
    let before = std::fs::write("/proc/self/clear_refs", "5").ok().and_then(|()| told("VmRSS"));
    let made = f();
    let most = before.and_then(|before| Some(told("VmHWM")?.saturating_sub(before)));
    (made, most)
}
