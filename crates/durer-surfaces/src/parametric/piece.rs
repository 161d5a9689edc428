//! Parts of a sheet: interval bounds of a formula on a box of parameters.
//!
//! In a box `X` about `m`, with interval bounds `S'(X)` of the slopes,
//!
//! ```text
//!   S(x) in S(m) + S'(X) (x - m)
//! ```
//!
//! (the mean value form: R. E. Moore, *Interval Analysis*, 1966). `S(m)` and `S'(X)` are all that a
//! ray needs: sheared onto it they are the value and the slopes of Krawczyk's test.

use durer_formula::I8;
use durer_formula::{VectorTape, lanes};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Interval, U, Vec3};

/// The margin around a box in which its bounds on slopes hold, in widths of the box.
const MARGIN: f64 = 1.0 / 16.0;
/// A crossing within this many units in the last place of an end of the domain belongs to it: an
/// end such as 2 pi is rounded, and a seam must not have a gap.
const END_ULPS: f64 = 4.0;
/// The margin around the domain in which a formula is evaluated, in widths of the domain.
const BEYOND: f64 = 1.0 / 64.0;
/// Covers a few roundings of bounds.
const ROUNDED: f64 = 1.0 + 32.0 * U;

/// Covers slopes below the normal range.
const TINY: f64 = durer_math::scale::pow2(-1000);

/// A box of parameters: from the least to the greatest of each.
pub(super) use crate::degree::Domain;

/// A map from a rectangle of parameters into space.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Face {
    pub(super) tape: VectorTape,
    pub(super) domain: Domain,
    /// The parameters at which the formula may be evaluated.
    known: Domain,
    /// The slack by which the domain is extended beyond its ends.
    pub(super) slack: [f64; 2],
    /// Whether the map goes on beyond both ends of a parameter as it does within the other one.
    pub(super) has_seam: [bool; 2],
}

/// Bounds of a map on a box. Lengths are in units; slopes are by parameters divided by the width of
/// the box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) face: u32,
    pub(super) own: Domain,
    /// The box on which the slopes hold.
    pub(super) wide: Domain,
    pub(super) middle: [f64; 2],
    pub(super) width: [f64; 2],
    /// The point in the middle, and a bound on its error along each axis.
    pub(super) p: [f64; 3],
    pub(super) p_err: [f64; 3],
    /// The slopes in the wide box, by axis and parameter, and bounds on their errors there.
    pub(super) slope: [[f64; 2]; 3],
    pub(super) slope_err: [[f64; 2]; 3],
    /// A box in space that holds the map of the piece's own parameters.
    pub(super) hull: [Interval; 3],
    /// Whether the formula may jump in it.
    pub(super) jumps: bool,
}

/// The middle of an interval, and a bound on the distance of its ends.
fn about(x: Interval) -> (f64, f64) {
    let middle = 0.5 * x.lo + 0.5 * x.hi;
    if !middle.is_finite() {
        return (0.0, f64::INFINITY);
    }
    (middle, (x.hi - middle).max(middle - x.lo) * ROUNDED)
}

impl Face {
    pub(super) fn new(tape: VectorTape, domain: Domain) -> Self {
        let slack = domain.map(|[a, b]| END_ULPS * f64::EPSILON * a.abs().max(b.abs()));
        let mut face = Self { tape, domain, known: domain, slack, has_seam: [false; 2] };
        // Proofs at an end need the formula beyond it, if it is defined there.
        let mut known = domain;
        for k in 0..2 {
            for end in 0..2 {
                let beyond = BEYOND * (domain[k][1] - domain[k][0]);
                let far = domain[k][end] + if end == 0 { -beyond } else { beyond };
                let strip = |i: usize| {
                    let mut strip = domain;
                    let [from, to] = domain[1 - k];
                    let at = |n: usize| if n == 8 { to } else { from + (to - from) * (n as f64 / 8.0) };
                    strip[1 - k] = [at(i), at(i + 1)];
                    strip[k] = [far.min(domain[k][end]), far.max(domain[k][end])];
                    strip
                };
                let jets = face.tape.jets(&lanes(&core::array::from_fn(strip)));
                let goes_on = jets.iter().all(|jet| {
                    let all = [&jet.v, &jet.d.d[0], &jet.d.d[1]];
                    all.iter().all(|x| x.partial == 0) && jet.v.jump == 0
                });
                if goes_on {
                    known[k][end] = far;
                }
            }
        }
        face.known = known;
        face.has_seam = [0, 1].map(|k| face.comes_back(k));
        face
    }

    /// Whether the map has the same points beyond one end of a parameter as within the other one: at
    /// eight pairs of points, within the errors of the formula and of the ends.
    fn comes_back(&self, k: usize) -> bool {
        if (0..2).any(|end| self.known[k][end] == self.domain[k][end]) {
            return false;
        }
        let beyond = BEYOND * (self.domain[k][1] - self.domain[k][0]) * (1.0 - 8.0 * U);
        let bounds = [0, 1].map(|end| {
            let boxes: [Domain; 8] = core::array::from_fn(|i| {
                let ([from, to], part) = (self.domain[1 - k], [0.0, 0.3125, 0.6875, 1.0][i / 2]);
                let across = (from + (to - from) * part).min(to);
                let along = self.domain[k][end] + if i % 2 == 0 { beyond } else { -beyond };
                let mut own = [[across; 2]; 2];
                own[k] = [along - self.slack[k], along + self.slack[k]];
                own
            });
            self.tape.bounds(&lanes(&boxes))
        });
        (0..8).all(|i| {
            (0..3).all(|c| {
                let [a, b] = [0, 1].map(|end| &bounds[end][c]);
                let is_known = (a.empty | b.empty | a.partial | b.partial) >> i & 1 == 0;
                is_known && a.lane(i).intersection(b.lane(i)).is_some()
            })
        })
    }

    /// Whether the formula may be evaluated everywhere in a box.
    pub(super) fn knows(&self, around: &Domain) -> bool {
        around.iter().zip(&self.known).all(|([from, to], [first, last])| first <= from && to <= last)
    }

    /// Extends the domain beyond its ends by this fraction of its width.
    pub(super) fn reaching(mut self, part: f64) -> Self {
        for k in 0..2 {
            self.slack[k] = part * (self.domain[k][1] - self.domain[k][0]);
        }
        self
    }

    /// Appends the bounds on each of these boxes, except those where nothing is defined.
    pub(super) fn pieces(&self, number: u32, boxes: &[Domain], unit: &Unit, out: &mut Vec<Piece>) {
        for boxes in boxes.chunks(8) {
            let own: [Domain; 8] = core::array::from_fn(|i| boxes[i.min(boxes.len() - 1)]);
            let wide = own.map(|own| {
                [0, 1].map(|k| {
                    let [from, to] = own[k];
                    let margin = (MARGIN * (to - from)).max(2.0 * self.slack[k]);
                    [(from - margin).max(self.known[k][0]), (to + margin).min(self.known[k][1])]
                })
            });
            let middle = own.map(|own| own.map(|[from, to]| (0.5 * from + 0.5 * to).max(from).min(to)));
            let jets = self.tape.jets(&lanes(&wide));
            let points = self.tape.bounds(&lanes(&middle.map(|m| m.map(|x| [x, x]))));
            for lane in 0..boxes.len() {
                if (0..3).any(|c| jets[c].v.empty >> lane & 1 == 1) {
                    continue;
                }
                let partial = jets.iter().any(|jet| {
                    let all = [&jet.v, &jet.d.d[0], &jet.d.d[1]];
                    all.iter().any(|x| x.partial >> lane & 1 == 1)
                });
                // Where only slopes jump, at a kink, the values at two points differ by their
                // distance times a slope between those of the two sides: bounds of both hold.
                let jumps = jets.iter().any(|jet| jet.v.jump >> lane & 1 == 1);
                let width = own[lane].map(|[from, to]| to - from);
                let mut piece = Piece {
                    face: number,
                    own: own[lane],
                    wide: wide[lane],
                    middle: middle[lane],
                    width,
                    p: [0.0; 3],
                    p_err: [f64::INFINITY; 3],
                    slope: [[0.0; 2]; 3],
                    slope_err: [[f64::INFINITY; 2]; 3],
                    hull: [Interval::ENTIRE; 3],
                    jumps,
                };
                for c in 0..3 {
                    if points[c].empty >> lane & 1 == 0 {
                        (piece.p[c], piece.p_err[c]) = unit.place(points[c].lane(lane), c);
                    }
                    piece.hull[c] = unit.range(jets[c].v.lane(lane), c);
                    if partial || jumps {
                        continue;
                    }
                    for k in 0..2 {
                        let (slope, err) = about(jets[c].d.d[k].lane(lane));
                        let by = |x: f64| scale2(x, -unit.scale) * width[k];
                        piece.slope[c][k] = by(slope);
                        // One product rounds.
                        piece.slope_err[c][k] = by(err) * ROUNDED + U * by(slope).abs() + TINY;
                    }
                    let far = |k: usize| piece.slope[c][k].abs() + piece.slope_err[c][k];
                    let reach = piece.half() * (far(0) + far(1)) + piece.p_err[c];
                    let held = Interval::around(piece.p[c], reach * ROUNDED);
                    if reach.is_finite() {
                        piece.hull[c] = piece.hull[c].intersection(held).unwrap_or(held);
                    }
                }
                out.push(piece);
            }
        }
    }
}

impl Piece {
    /// A bound on the error of the map's edge on a piece at its border: from the rounding of the
    /// formula, and from the slack of the domain. 0 for other pieces.
    pub(super) fn edge_error(&self, face: &Face) -> f64 {
        let is_at_edge = (0..2).any(|k| {
            let ([from, to], [first, last]) = (self.own[k], face.domain[k]);
            from == first || to == last
        });
        let along = |c: usize| {
            let moved =
                |k: usize| (self.slope[c][k].abs() + self.slope_err[c][k]) * (face.slack[k] / self.width[k]);
            self.p_err[c] + moved(0) + moved(1)
        };
        let off = (along(0) + along(1) + along(2)) * ROUNDED;
        if is_at_edge && off.is_finite() { off } else { 0.0 }
    }

    /// Half the width of the own box, in widths.
    pub(super) fn half(&self) -> f64 {
        let of = |k: usize| {
            let [from, to] = self.own[k];
            (to - self.middle[k]).max(self.middle[k] - from) / self.width[k]
        };
        of(0).max(of(1)) * ROUNDED
    }

    /// Whether a bounded box holds it.
    pub(super) fn is_bounded(&self) -> bool {
        self.hull.iter().all(|x| x.lo.is_finite() && x.hi.is_finite())
    }

    /// A bound on the relative change of the slopes in the wide box, seen along the normal. Below 1
    /// a ray along the normal meets the piece at most once.
    pub(super) fn bend(&self) -> f64 {
        let column = |m: &[[f64; 2]; 3], k: usize| Vec3::new(m[0][k], m[1][k], m[2][k]);
        let (a, b) = (column(&self.slope, 0), column(&self.slope, 1));
        let area = a.cross(b).length();
        let change = column(&self.slope_err, 0).length() + column(&self.slope_err, 1).length();
        // The rows of the inverse for a ray along the normal.
        let bend = a.length().max(b.length()) / area * change;
        if bend.is_nan() { f64::INFINITY } else { bend }
    }

    /// A bound on the change of the point along each parameter.
    pub(super) fn change(&self) -> [f64; 2] {
        [0, 1].map(|k| {
            let far = |c: usize| self.slope[c][k].abs() + self.slope_err[c][k];
            far(0).max(far(1)).max(far(2))
        })
    }

    /// Whether there are numbers between the ends of its box along a parameter.
    pub(super) fn has_halves(&self, k: usize) -> bool {
        self.own[k][0] < self.middle[k] && self.middle[k] < self.own[k][1]
    }

    /// Both halves of its box along a parameter.
    pub(super) fn halves(&self, k: usize) -> [Domain; 2] {
        halves(&self.own, k)
    }

    /// Converts a piece from the formula's own units to others.
    pub(super) fn in_units(mut self, unit: &Unit) -> Self {
        let back = |x: f64| scale2(x, -unit.scale);
        for c in 0..3 {
            let (p, lost) = two_sum(self.p[c], -unit.centre[c]);
            self.p[c] = back(p);
            self.p_err[c] = back((self.p_err[c] + lost.abs()) * ROUNDED);
            self.hull[c] = unit.range(self.hull[c], c);
            self.slope[c] = self.slope[c].map(back);
            self.slope_err[c] = self.slope_err[c].map(back);
        }
        self
    }
}

/// Both halves of a box along a parameter.
pub(super) fn halves(own: &Domain, k: usize) -> [Domain; 2] {
    let [from, to] = own[k];
    let middle = (0.5 * from + 0.5 * to).max(from).min(to);
    let (mut low, mut high) = (*own, *own);
    (low[k][1], high[k][0]) = (middle, middle);
    [low, high]
}

/// A frame: coordinates are relative to a centre, in units of a power of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    pub(super) centre: [f64; 3],
    pub(super) scale: i32,
}

impl Unit {
    /// The formula's own.
    pub(super) const OWN: Self = Self { centre: [0.0; 3], scale: 0 };

    /// A coordinate in units, and a bound on its error.
    pub(super) fn place(&self, x: Interval, axis: usize) -> (f64, f64) {
        let (middle, err) = about(x);
        let (p, lost) = two_sum(middle, -self.centre[axis]);
        (scale2(p, -self.scale), scale2((err + lost.abs()) * ROUNDED, -self.scale))
    }

    fn range(&self, x: Interval, axis: usize) -> Interval {
        let end = |x: f64, away: f64| {
            let (near, lost) = two_sum(x, -self.centre[axis]);
            let moved = if lost == 0.0 || !near.is_finite() {
                near
            } else if away < 0.0 {
                near.next_down()
            } else {
                near.next_up()
            };
            scale2(moved, -self.scale)
        };
        Interval { lo: end(x.lo, -1.0), hi: end(x.hi, 1.0) }
    }
}

/// The box of half-width `r`, in widths of a piece, about a point of it.
pub(super) fn around(x: [f64; 2], width: [f64; 2], r: f64) -> Domain {
    [0, 1].map(|k| {
        if r == 0.0 {
            return [x[k], x[k]];
        }
        let by = (r * width[k]).next_up();
        [(x[k] - by).next_down(), (x[k] + by).next_up()]
    })
}

/// The value in a lane and a bound on its error; `None` if it may jump or be undefined.
pub(super) fn lane_of(x: &I8, lane: usize) -> Option<(f64, f64)> {
    let bit = 1_u8 << lane;
    if x.jump & bit == 0 { slope_of(x, lane) } else { None }
}

/// The slope in a lane and a bound on its error; `None` if it may be undefined. At a kink it has
/// all values between those of both sides.
pub(super) fn slope_of(x: &I8, lane: usize) -> Option<(f64, f64)> {
    let bit = 1_u8 << lane;
    ((x.partial | x.empty) & bit == 0).then(|| about(x.lane(lane)))
}
