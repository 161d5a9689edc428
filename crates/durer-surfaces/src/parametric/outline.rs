//! Outlines of a sweep's profile: their orientation and what they enclose.

use crate::prism::curved::Bezier;

/// Twice the signed area of the polygon of an outline's control points.
fn area(outline: &[Bezier]) -> f64 {
    let points = outline.iter().flat_map(|piece| piece[..3].iter());
    let points: Vec<_> = points.collect();
    let next = |k: usize| points[(k + 1) % points.len()];
    (0..points.len()).map(|k| points[k][0] * next(k)[1] - points[k][1] * next(k)[0]).sum()
}

/// Orients the outlines so that the inside of the profile is to their left. An outline within an
/// odd number of others is a hole.
pub(super) fn oriented(outlines: &[Vec<Bezier>]) -> Vec<Vec<Bezier>> {
    let crosses = |[x, y]: [f64; 2], piece: &Bezier| {
        piece.windows(2).fold(false, |odd, w| {
            let ([ax, ay], [bx, by]) = (w[0], w[1]);
            let between = (ay > y) != (by > y);
            odd ^ (between && x < (bx - ax) * (y - ay) / (by - ay) + ax)
        })
    };
    let within =
        |p: [f64; 2], outline: &[Bezier]| outline.iter().fold(false, |odd, piece| odd ^ crosses(p, piece));
    let mut out = Vec::new();
    for (k, outline) in outlines.iter().enumerate() {
        let Some(first) = outline.first() else { continue };
        let others = outlines.iter().enumerate().filter(|(i, _)| *i != k);
        let is_hole = others.fold(false, |odd, (_, other)| odd ^ within(first[0], other));
        let mut outline = outline.clone();
        if (area(&outline) > 0.0) == is_hole {
            outline.reverse();
            outline.iter_mut().for_each(|piece| piece.reverse());
        }
        out.push(outline);
    }
    out
}

/// A point near the middle of the profile, off its likely axes of symmetry.
pub(super) fn centre(pieces: &[Bezier]) -> [f64; 2] {
    [0, 1].map(|k: usize| {
        let (low, high) = pieces
            .iter()
            .flatten()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        low + (high - low) * [0.5093, 0.4871][k]
    })
}
