//! The sum of the signs of the crossings that an unproven crossing represents.
//!
//! A crossing of a line and a map of two parameters is a zero of two functions `F`. Along the border of
//! a box of parameters, `F` turns around zero as many times as the signs of its zeros in the box add up
//! to: its degree, for any number of zeros (R. B. Kearfott, "An efficient degree-computation method for
//! a generalized method of bisection", *Numerische Mathematik* 32 (1979) 109-127). So the border decides
//! what is hidden inside: 0 beside a tangent, whether the line meets the map twice there or misses it,
//! and 1 or -1 where it leads through.
//!
//! The border has to be so far away that `F` is certainly not zero there: the box is doubled until it is.

/// A box of parameters.
pub(crate) type Domain = [[f64; 2]; 2];

/// By how much the box is enlarged. Twice as large, `F` beside a tangent is four times as large as in
/// the unproven box.
const SIZES: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// A crossing: its map, its parameters and its place on the line with bounds on their errors, and its
/// sign, 0 if nothing is proven.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) face: u32,
    pub(crate) uv: [f64; 2],
    pub(crate) radius: [f64; 2],
    pub(crate) s: f64,
    pub(crate) s_err: f64,
    pub(crate) sign: i8,
}

/// The signs of the crossings that one unproven crossing represents.
pub(crate) enum Sum {
    /// The sum of the signs of all crossings there; 0 where the line may touch a border.
    Of(i8),
    /// The unproven crossing of this index is too near for a sum of its own.
    Near(usize),
    /// Likewise across a seam, for boxes enlarged to this size.
    Across(usize, f64),
    Unknown,
}

/// The sum of the signs of the crossings that the unproven one `found[i]` represents. `sum_in` gives
/// the sum of the signs of all crossings with its map in a box, if it is known. At a seam the map goes
/// on beyond its domain, at a border it ends.
#[cold]
#[inline(never)]
pub(crate) fn sum_of_signs(
    found: &[Place],
    i: usize,
    domain: &Domain,
    has_seam: [bool; 2],
    sum_in: impl Fn(&Domain) -> Option<i32>,
) -> Sum {
    let own = &found[i];
    let others = || found.iter().enumerate().filter(|&(j, other)| j != i && other.face == own.face);
    for size in SIZES {
        let enlarged = |found: &Place| enlarged(found, size);
        let mut around = enlarged(own);
        for k in (0..2).filter(|&k| !has_seam[k]) {
            around[k] = [around[k][0].max(domain[k][0]), around[k][1].min(domain[k][1])];
        }
        if (0..2).any(|k| around[k][0] >= around[k][1]) {
            break;
        }
        let beyond = [0, 1]
            .map(|k: usize| [(domain[k][0] - around[k][0]).max(0.0), (around[k][1] - domain[k][1]).max(0.0)]);
        let Some(all) = sum_in(&around) else { continue };
        // Whether another one's box is in this one, made smaller by a part of the other's radius.
        let holds = |other: &Place, part: f64| {
            (0..2).all(|k: usize| {
                let ([from, to], room) = (around[k], part * other.radius[k]);
                from + room <= other.uv[k] && other.uv[k] <= to - room
            })
        };
        // Whether another one, as much enlarged, reaches this box across a seam.
        let is_across = |other: &Place| {
            let box_of_other = enlarged(other);
            let reaches = |k: usize| {
                let ([low, high], [from, to], [first, last]) = (beyond[k], box_of_other[k], domain[k]);
                low > 0.0 && to >= last - low || high > 0.0 && from <= first + high
            };
            (reaches(0) || reaches(1)) && (own.s - other.s).abs() <= size * (own.s_err + other.s_err)
        };
        let mut unproven = others().filter(|(_, other)| other.sign == 0);
        if let Some((j, _)) = unproven.clone().find(|(_, other)| holds(other, -1.0)) {
            return Sum::Near(j);
        }
        if let Some((j, _)) = unproven.find(|(_, other)| is_across(other)) {
            return Sum::Across(j, size);
        }
        let is_unclear =
            |other: &Place| if holds(other, -1.0) { !holds(other, 1.0) } else { is_across(other) };
        if others().any(|(_, other)| is_unclear(other)) {
            continue;
        }
        let proven: i32 =
            others().filter(|(_, other)| holds(other, 1.0)).map(|(_, other)| i32::from(other.sign)).sum();
        return match i8::try_from(all - proven) {
            Ok(sum @ -1..=1) => Sum::Of(sum),
            _ => Sum::Unknown,
        };
    }
    // Rounding hides whether a crossing at a border is on the map. If the map, continued beyond its
    // borders, has none or as many in either direction, the line may touch the border.
    let is_touch = |size: f64| {
        let around = enlarged(own, size);
        let holds =
            |other: &Place| (0..2).all(|k| around[k][0] <= other.uv[k] && other.uv[k] <= around[k][1]);
        sum_in(&around) == Some(0) && !others().any(|(_, other)| holds(other))
    };
    if SIZES.into_iter().any(is_touch) { Sum::Of(0) } else { Sum::Unknown }
}

/// The box of a crossing, enlarged.
fn enlarged(found: &Place, size: f64) -> Domain {
    [0, 1].map(|k| {
        let by = size * found.radius[k];
        [found.uv[k] - by, found.uv[k] + by]
    })
}

/// The direction of a half plane, or of a quarter, that holds all values of `F` on a stretch, in eighths
/// of a turn; `None` if there is none. Given are the signs of the coordinates of all values, 0 if they
/// differ.
pub(crate) fn eighth(signs: (i8, i8)) -> Option<i32> {
    match signs {
        (1, 0) => Some(0),
        (1, 1) => Some(1),
        (0, 1) => Some(2),
        (-1, 1) => Some(3),
        (-1, 0) => Some(4),
        (-1, -1) => Some(5),
        (0, -1) => Some(6),
        (1, -1) => Some(7),
        _ => None,
    }
}

/// How often a closed curve turns around the origin, by the directions of half planes, each of which
/// holds a stretch of it, in eighths of a turn.
pub(crate) fn turns(eighths: impl Iterator<Item = i32> + Clone) -> Option<i32> {
    let next = eighths.clone().skip(1).chain(eighths.clone().take(1));
    let mut sum = 0;
    for (from, to) in eighths.zip(next) {
        let by = (to - from).rem_euclid(8);
        if by == 4 {
            // Opposite half planes have no point in common.
            return None;
        }
        sum += if by > 4 { by - 8 } else { by };
    }
    Some(sum / 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turns_of(eighths: &[i32]) -> Option<i32> {
        turns(eighths.iter().copied())
    }

    #[test]
    fn turns_of_curves_around_the_origin() {
        assert_eq!(turns_of(&[0, 1, 2, 3, 4, 5, 6, 7]), Some(1));
        assert_eq!(turns_of(&[7, 6, 5, 4, 3, 2, 1, 0]), Some(-1));
        assert_eq!(turns_of(&[0, 3, 6, 1, 4, 7, 2, 5]), Some(3));
        assert_eq!(turns_of(&[0, 2, 4, 6]), Some(1));
        // Beside the origin, and past it both ways.
        assert_eq!(turns_of(&[7, 0, 1, 2, 1]), Some(0));
        assert_eq!(turns_of(&[6, 4, 2, 4]), Some(0));
        assert_eq!(turns_of(&[0, 4]), None);
    }
}
