//! The output of the comparison's programs: a line per workload and mode, then one line of JSON.

use crate::files::{Hits, MISS};
use std::fmt::Write as _;

/// Millions of rays per second of wall-clock time, and nanoseconds of processor time per ray.
pub(crate) struct Rate {
    pub(crate) median: f64,
    pub(crate) best: f64,
    pub(crate) cpu_ns: f64,
}

#[derive(Default)]
pub(crate) struct Samples {
    rates: Vec<f64>,
    cpu: Vec<f64>,
}

impl Samples {
    pub(crate) fn add(&mut self, rays: usize, seconds: f64, cpu_ns: f64) {
        self.rates.push(rays as f64 / seconds * 1e-6);
        self.cpu.push(cpu_ns / rays.max(1) as f64);
    }

    pub(crate) fn rate(self) -> Rate {
        let best = self.rates.iter().copied().fold(0.0, f64::max);
        Rate { median: median(self.rates), best, cpu_ns: median(self.cpu) }
    }
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    let n = x.len();
    if n == 0 { 0.0 } else { 0.5 * (x[(n - 1) / 2] + x[n / 2]) }
}

/// The processor time that this thread has used so far.
pub(crate) fn thread_cpu_ns() -> f64 {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID)
        .map_or(f64::NAN, |t| t.tv_sec() as f64 * 1e9 + t.tv_nsec() as f64)
}

pub(crate) struct Report {
    engine: String,
    mesh: String,
    triangles: usize,
    talks: bool,
    numbers: Vec<(String, f64)>,
    rows: String,
}

impl Report {
    pub(crate) fn new(engine: String, mesh: String, triangles: usize, talks: bool) -> Self {
        if talks {
            println!("{engine}, {mesh}: {triangles} triangles");
        }
        Self { engine, mesh, triangles, talks, numbers: Vec::new(), rows: String::new() }
    }

    fn say(&self, line: &str) {
        if self.talks {
            println!("{line}");
        }
    }

    fn note(&mut self, name: String, value: f64) {
        self.numbers.retain(|(known, _)| *known != name);
        self.numbers.push((name, value));
    }

    pub(crate) fn build(&mut self, threads: usize, times: Vec<f64>) {
        let best = times.iter().copied().fold(f64::INFINITY, f64::min);
        let median = median(times);
        self.say(&format!(
            "  build        {threads:2} thr {median:9.2} ms (best {best:.2})  {:.2} Mtris/s",
            self.triangles as f64 / median * 1e-3
        ));
        self.note(format!("build_ms_{threads}"), median);
        self.note(format!("build_ms_{threads}_best"), best);
    }

    /// Records the memory that queries need, and the peak during the build.
    pub(crate) fn memory(&mut self, bytes: usize, most: Option<usize>) {
        let peak = most.map_or_else(String::new, |most| format!(", {most} at the peak of the build"));
        self.say(&format!(
            "  memory       {bytes} bytes held{peak}: {:.1} bytes a triangle",
            bytes as f64 / self.triangles.max(1) as f64
        ));
        self.note("bytes".to_owned(), bytes as f64);
        if let Some(most) = most {
            self.note("peak_bytes".to_owned(), most as f64);
        }
    }

    pub(crate) fn row(&mut self, mode: &str, work: &str, threads: usize, rate: &Rate) {
        self.say(&format!(
            "  {mode:<12} {work:<8} {threads:2} thr {:9.3} Mrays/s (best {:8.3})  {:9.1} cpu ns/ray",
            rate.median, rate.best, rate.cpu_ns
        ));
        let comma = if self.rows.is_empty() { "" } else { "," };
        // Writing to a string cannot fail.
        let _ = write!(
            self.rows,
            "{comma}{{\"mode\":\"{mode}\",\"work\":\"{work}\",\"threads\":{threads},\"mrays\":{:.4},\"best\":{:.4},\"cpu_ns\":{:.2}}}",
            rate.median, rate.best, rate.cpu_ns
        );
    }

    /// Compares with the reference: hit or miss, `t` within 1e-4, and triangles. Any-hit answers
    /// are compared by hit or miss alone.
    pub(crate) fn compare(&mut self, work: &str, hits: &Hits, reference: Option<&Hits>, any: bool) {
        let found = hits.t.iter().filter(|t| t.is_finite()).count();
        let mut line = format!("  check        {work:<8} n {} hits {found}", hits.t.len());
        self.note(format!("hits_{work}"), found as f64);
        match reference.filter(|r| r.t.len() == hits.t.len()) {
            None => line += " (no .hits to compare with)",
            Some(reference) => {
                let (mut missed, mut far, mut other) = (0, 0, 0);
                for i in 0..hits.t.len() {
                    let (a, b) = (hits.t[i], reference.t[i]);
                    if a.is_finite() != b.is_finite() {
                        missed += 1;
                    } else if a.is_finite() && !any {
                        if (a - b).abs() > 1e-4 * b.abs().max(1e-3) {
                            far += 1;
                        } else if hits.triangle[i] != reference.triangle[i] {
                            other += 1;
                        }
                    }
                }
                let _ = write!(
                    line,
                    "  hit/miss differs {missed}  t differs {far}  prim differs at same t {other}"
                );
                self.note(format!("hitmiss_{work}"), f64::from(missed));
                self.note(format!("tdiff_{work}"), f64::from(far));
            }
        }
        debug_assert!(hits.t.iter().zip(&hits.triangle).all(|(t, &p)| t.is_finite() || p == MISS));
        self.say(&line);
    }

    pub(crate) fn json(&self) {
        let mut line = format!(
            "JSON {{\"engine\":\"{}\",\"mesh\":\"{}\",\"tris\":{}",
            self.engine, self.mesh, self.triangles
        );
        for (name, value) in &self.numbers {
            let _ = write!(line, ",\"{name}\":{value}");
        }
        println!("{line},\"rows\":[{}]}}", self.rows);
    }
}
