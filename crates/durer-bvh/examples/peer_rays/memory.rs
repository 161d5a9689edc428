//! The memory of this process, as Linux reports it.

/// A number of `/proc/self/status`, in bytes.
fn told(name: &str) -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    Some(line.split_whitespace().next()?.parse::<usize>().ok()? << 10)
}

/// The result of `f`, and the peak memory during `f` above that before, in bytes; `None` if the
/// system does not report it.
///
/// Counted are the process's resident pages: memory that was allocated but never written does not
/// count, and everything else on a page does.
pub(crate) fn most_held<R>(f: impl FnOnce() -> R) -> (R, Option<usize>) {
    // "5" resets the peak (proc(5), Linux 4.0 and later).
    let before = std::fs::write("/proc/self/clear_refs", "5").ok().and_then(|()| told("VmRSS"));
    let made = f();
    let most = before.and_then(|before| Some(told("VmHWM")?.saturating_sub(before)));
    (made, most)
}
