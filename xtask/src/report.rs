//! The table of `cargo xtask conformance`, for the terminal and for docs/conformance.md.

use crate::conformance::{Cost, Row};
use std::fmt::Write as _;

/// The names of the columns, for the terminal.
pub(crate) fn heading(sizes: &[(u32, u32)], timed: bool) -> String {
    let mut line = format!("{:<32}", "scene");
    for (width, height) in sizes {
        let _ = write!(line, "{:>16}", format!("{width}x{height}"));
    }
    if timed {
        let _ = write!(line, "{:>12}{:>12}{:>8}", "durer, s", "povray, s", "ratio");
    }
    line
}

/// The row of a scene, for the terminal.
pub(crate) fn line(row: &Row) -> String {
    let mut line = format!("{:<32}", row.name);
    for d in &row.differences {
        let mark = if d.passes() { ' ' } else { '!' };
        let _ = write!(line, "{mark}{:>8.2} % ({:>3})", percent(d.agreeing), d.worst);
    }
    if let Some(cost) = row.cost {
        let _ = write!(line, "{:>12.2}{:>12.2}{:>8.1}", cost.ours, cost.theirs, ratio(cost));
    }
    line
}

/// The percentage, rounded down to hundredths, so that 100.00 means all pixels.
fn percent(share: f64) -> f64 {
    (share * 1e4).floor() / 100.0
}

fn ratio(cost: Cost) -> f64 {
    cost.theirs / cost.ours.max(0.01)
}

/// A summary in one or two sentences.
pub(crate) fn summary(rows: &[Row]) -> String {
    let shares = || rows.iter().flat_map(|r| r.differences.iter().map(|d| d.agreeing));
    let least = shares().fold(1.0, f64::min);
    let passing = rows.iter().filter(|r| r.differences.iter().all(|d| d.passes())).count();
    let mut text = format!(
        "{passing} of {} scenes agree; the least agreement is {:.2} % of the pixels.",
        rows.len(),
        percent(least)
    );
    let costs: Vec<Cost> = rows.iter().filter_map(|r| r.cost).collect();
    if let Some((slowest, middle)) = slowest_and_median(&costs) {
        let (ours, theirs) = costs.iter().fold((0.0, 0.0), |sum, c| (sum.0 + c.ours, sum.1 + c.theirs));
        let _ = write!(
            text,
            " All scenes together took {ours:.1} s, POV-Ray took {theirs:.1} s: {:.1} times as much \
             (median of the ratios {middle:.1}, least {slowest:.1}).",
            theirs / ours.max(0.01)
        );
    }
    text
}

/// The least and the median of the ratios.
fn slowest_and_median(costs: &[Cost]) -> Option<(f64, f64)> {
    let mut ratios: Vec<f64> = costs.iter().map(|c| ratio(*c)).collect();
    ratios.sort_by(f64::total_cmp);
    Some((*ratios.first()?, ratios[ratios.len() / 2]))
}

/// The text of docs/conformance.md.
pub(crate) fn document(rows: &[Row], sizes: &[(u32, u32)], timed: (u32, u32), version: &str) -> String {
    let mut text = format!(
        "# Pictures beside POV-Ray's\n\n\
         Written by `cargo xtask conformance`. Each scene of [tests/conformance](../tests/conformance), and the gallery's composition, is rendered by \
         durer and by POV-Ray {version}, one ray through the centre of each pixel (`--aa off`). A pixel agrees if no \
         channel differs by more than 2/255; at least 99 % must. The number in parentheses is the largest difference of \
         any channel of any pixel: where a ray passes a silhouette, a shadow's edge or a border of a pattern within \
         rounding, the two programs may fall on different sides.\n\n\
         Seconds are processor time of the whole program, reading and building included, at {}x{} with one thread.\n\n\
         {}\n\n",
        timed.0,
        timed.1,
        summary(rows)
    );
    text.push_str("| scene |");
    for (width, height) in sizes {
        let _ = write!(text, " {width}x{height} |");
    }
    text.push_str(" durer | POV-Ray | ratio |\n|---|");
    text.push_str(&"---:|".repeat(sizes.len() + 3));
    text.push('\n');
    for row in rows {
        let _ = write!(text, "| [{}](../{}) |", row.name, row.file);
        for d in &row.differences {
            let _ = write!(text, " {:.2} % ({}) |", percent(d.agreeing), d.worst);
        }
        match row.cost {
            Some(cost) => {
                let _ = writeln!(text, " {:.2} s | {:.2} s | {:.1} |", cost.ours, cost.theirs, ratio(cost));
            }
            None => text.push_str(" | | |\n"),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Difference;

    #[test]
    fn the_document_has_a_line_per_scene_and_the_summary_counts() {
        let row = |name: &str, agreeing: f64| Row {
            name: name.into(),
            file: format!("tests/conformance/{name}.pov"),
            differences: vec![Difference { agreeing, worst: 9 }],
            cost: Some(Cost { ours: 0.5, theirs: 4.0 }),
        };
        let rows = [row("good", 0.999_99), row("bad", 0.98)];
        let text = document(&rows, &[(160, 120)], (1280, 720), "3.7");
        assert!(text.contains("1 of 2 scenes agree; the least agreement is 98.00 %"));
        assert!(
            text.contains("| [good](../tests/conformance/good.pov) | 99.99 % (9) | 0.50 s | 4.00 s | 8.0 |")
        );
    }
}
