//! Hollow cylinders around the pieces of a lathe's profile, in a tree over their numbers
//! (J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", SIGGRAPH 1983,
//! bounds them by strips of the profile's plane).

use crate::CentredRay;
use durer_math::scale::pow2;

/// Bounds of the heights and the radii of a group of pieces, in the frame, rounded outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hollow {
    pub(super) y: [f64; 2],
    /// Radii as distances from the axis.
    pub(super) r: [f64; 2],
}

impl Hollow {
    const EMPTY: Self = Self { y: [f64::INFINITY, f64::NEG_INFINITY], r: [f64::INFINITY, f64::NEG_INFINITY] };

    fn union(self, b: Self) -> Self {
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self { y: join(self.y, b.y), r: join(self.r, b.r) }
    }
}

/// How many pieces, or groups, make a group.
const GROUP: usize = 4;

/// The tree: the boxes of the pieces, of groups of them, and so on up to one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Boxes {
    levels: Vec<Vec<Hollow>>,
}

/// A ray with what every box is compared with.
struct Seen {
    oy: f64,
    dy: f64,
    /// The squared distance from the axis is `(a s + 2 b) s + c`.
    a: f64,
    b: f64,
    c: f64,
    /// The crossings lie within this of the parameter zero.
    far: f64,
    /// False if the ray's errors are too large for the margins.
    sure: bool,
}

/// By how much boxes are enlarged, so that no rounding matters.
///
/// The lathe lies in the ball of radius 2 about the centre, so crossings have `|s| <= 2 + |o|`, as
/// `|d| >= 1`. Where that is below 8 and the ray's numbers are wrong by less than `2^-34`,
/// coordinates, which are below 32, are wrong by `9 2^-34` and squared distances by less than
/// `2^-24`; rounding adds less than `2^-40`.
pub(super) const MARGIN: f64 = pow2(-23);

impl Boxes {
    pub(super) fn new(pieces: Vec<Hollow>) -> Self {
        let mut levels = vec![pieces];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let next = last.chunks(GROUP).map(|c| c.iter().copied().fold(Hollow::EMPTY, Hollow::union));
            let next = next.collect();
            levels.push(next);
        }
        Self { levels }
    }

    /// Calls `f` for each piece that the ray may meet, in order.
    #[inline(always)]
    pub(super) fn visit(&self, ray: &CentredRay<'_>, f: impl FnMut(usize)) {
        let (o, d) = (ray.o, ray.d);
        let far = 2.0 + MARGIN + o.x.abs() + o.y.abs() + o.z.abs();
        let seen = Seen {
            oy: o.y,
            dy: d.y,
            a: d.x * d.x + d.z * d.z,
            b: o.x * d.x + o.z * d.z,
            c: o.x * o.x + o.z * o.z,
            far,
            sure: far < 8.0 && ray.o_err.max_abs() + ray.d_err.max_abs() < pow2(-34),
        };
        self.walk(
            #[inline(always)]
            |hollow| seen.may_meet(hollow),
            f,
        );
    }

    /// Calls `f` for each piece that has the height `y` and a radius of at least `r`, as far as
    /// these are known within `e`.
    pub(super) fn visit_beyond(&self, y: f64, r: f64, e: f64, f: impl FnMut(usize)) {
        let may = |h: &Hollow| !(h.y[0] > y + e || h.y[1] < y - e || h.r[1] < r - e);
        self.walk(may, f);
    }

    /// Calls `f` for each piece all of whose groups `may`.
    #[inline(always)]
    fn walk(&self, may: impl Fn(&Hollow) -> bool, mut f: impl FnMut(usize)) {
        let Some(top) = self.levels.len().checked_sub(1) else { return };
        let (mut level, mut i) = (top, 0);
        loop {
            let Some(hollow) = self.levels[level].get(i) else {
                // Behind the last of a level: up, and on.
                if level == top {
                    return;
                }
                (level, i) = (level + 1, i / GROUP + usize::from(!i.is_multiple_of(GROUP)));
                continue;
            };
            if may(hollow) {
                if level > 0 {
                    (level, i) = (level - 1, i * GROUP);
                    continue;
                }
                f(i);
            }
            i += 1;
            while level < top && i.is_multiple_of(GROUP) {
                (level, i) = (level + 1, i / GROUP);
            }
        }
    }
}

impl Seen {
    #[inline(always)]
    fn may_meet(&self, hollow: &Hollow) -> bool {
        if !self.sure {
            return true;
        }
        let (low, high) = (hollow.y[0] - MARGIN - self.oy, hollow.y[1] + MARGIN - self.oy);
        let (mut from, mut to) = (-self.far, self.far);
        if self.dy == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
        } else {
            let (a, b) = (low / self.dy, high / self.dy);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
            if from > to {
                return false;
            }
        }
        let square = |s: f64| (self.a * s + 2.0 * self.b) * s + self.c;
        let nearest = (-self.b / self.a).max(from).min(to);
        let [r0, r1] = hollow.r;
        square(nearest) <= r1 * r1 + MARGIN && square(from).max(square(to)) >= r0 * r0 - MARGIN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_visited_once_and_in_order() {
        for n in 0..70 {
            let at = |i: usize| Hollow { y: [i as f64, i as f64 + 0.5], r: [0.0, 1.0] };
            let boxes = Boxes::new((0..n).map(at).collect());
            let mut seen = vec![];
            boxes.walk(|_| true, |i| seen.push(i));
            assert_eq!(seen, (0..n).collect::<Vec<_>>());
            for y in 0..n {
                seen.clear();
                boxes.visit_beyond(y as f64 + 0.25, 0.5, 0.0, |i| seen.push(i));
                assert_eq!(seen, [y]);
            }
        }
    }
}
