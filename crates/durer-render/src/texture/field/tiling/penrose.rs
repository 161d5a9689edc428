//! Penrose's tilings: rhombi, kites and darts, and pentagons with stars, boats and diamonds.
//!
//! All three follow from tilings by rhombi with fivefold symmetry around the origin, which N. G. de
//! Bruijn's pentagrid gives: the lines `p·ζⱼ + s = n` for whole `n` and the five directions
//! `ζⱼ = e^(2πij/5)`, with one shift `s`. To each point where a line of family `r` meets one of
//! family `q` belongs a rhombus with the sides `ζᵣ` and `ζ_q`; its corners are sums of whole
//! multiples of the directions. The sum of the multiples is the level of a corner, one of four; the
//! ends of a side are on neighbouring levels.
//!
//! N. G. de Bruijn, "Algebraic theory of Penrose's non-periodic tilings of the plane",
//! *Indagationes Mathematicae* 43 (1981) 39-66.

use crate::vector::floor;

/// Cosines and sines of 36 and 72 degrees.
const C36: f64 = 0.809_016_994_374_947_5;
const S36: f64 = 0.587_785_252_292_473_1;
const C72: f64 = 0.309_016_994_374_947_45;
const S72: f64 = 0.951_056_516_295_153_5;
/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;
/// The radius of the circle in a pentagon with sides of 1.
const PENTAGON: f64 = 0.688_190_960_235_586_8;

/// The five directions.
const ZETA: [[f64; 2]; 5] = [[1.0, 0.0], [C72, S72], [-C36, S36], [-C36, -S36], [C72, -S72]];

fn dot([ax, az]: [f64; 2], [bx, bz]: [f64; 2]) -> f64 {
    ax * bx + az * bz
}

fn cross([ax, az]: [f64; 2], [bx, bz]: [f64; 2]) -> f64 {
    ax * bz - az * bx
}

fn plus([ax, az]: [f64; 2], [bx, bz]: [f64; 2]) -> [f64; 2] {
    [ax + bx, az + bz]
}

fn minus([ax, az]: [f64; 2], [bx, bz]: [f64; 2]) -> [f64; 2] {
    [ax - bx, az - bz]
}

fn times([x, z]: [f64; 2], k: f64) -> [f64; 2] {
    [k * x, k * z]
}

/// A sum of multiples of the directions.
#[derive(Clone, Copy)]
struct Corner([f64; 5]);

impl Corner {
    fn step(mut self, direction: usize, by: f64) -> Self {
        self.0[direction] += by;
        self
    }

    fn level(self) -> f64 {
        self.0.iter().sum()
    }

    fn place(self) -> [f64; 2] {
        (0..5).fold([0.0; 2], |sum, j| plus(sum, times(ZETA[j], self.0[j])))
    }

    /// The conjugate of the place, which decides whether the corner belongs to the tiling.
    fn conjugate(self) -> [f64; 2] {
        (0..5).fold([0.0; 2], |sum, j| plus(sum, times(ZETA[2 * j % 5], self.0[j])))
    }
}

/// A rhombus, and where a point lies in it.
struct Rhombus {
    base: Corner,
    /// The two directions of its sides.
    sides: [usize; 2],
    /// The point less the base, in sides.
    at: [f64; 2],
}

impl Rhombus {
    /// The rhombus around a point in the tiling of a pentagrid with a shift.
    fn around(p: [f64; 2], shift: f64) -> Self {
        let mut best = Self { base: Corner([0.0; 5]), sides: [0, 1], at: [0.0; 2] };
        let mut inside = f64::NEG_INFINITY;
        // A rhombus is near the point of its lines, enlarged by 5/2: by at most the golden ratio.
        let middle = times(p, 0.4);
        let line = ZETA.map(|zeta| floor(dot(zeta, middle) + shift));
        for (r, q) in (0..5).flat_map(|r| (r + 1..5).map(move |q| (r, q))) {
            let area = cross(ZETA[r], ZETA[q]);
            for (i, j) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
                let lines = [line[r] + i, line[q] + j];
                let [a, b] = [lines[0] - shift, lines[1] - shift];
                let meeting =
                    [(a * ZETA[q][1] - b * ZETA[r][1]) / area, (b * ZETA[r][0] - a * ZETA[q][0]) / area];
                let far = minus(meeting, middle);
                if dot(far, far) > 0.5 {
                    continue;
                }
                let mut counts = ZETA.map(|zeta| floor(dot(zeta, meeting) + shift));
                (counts[r], counts[q]) = (lines[0] - 1.0, lines[1] - 1.0);
                let base = Corner(counts);
                let own = minus(p, base.place());
                let at = [cross(own, ZETA[q]) / area, cross(ZETA[r], own) / area];
                let depth = at[0].min(1.0 - at[0]).min(at[1]).min(1.0 - at[1]);
                if depth > inside {
                    (best, inside) = (Self { base, sides: [r, q], at }, depth);
                    if depth > 0.0 {
                        return best;
                    }
                }
            }
        }
        best
    }

    /// Whether the angles are 36 and 144 degrees; they are 72 and 108 degrees if not.
    fn is_thin(&self) -> bool {
        matches!(self.sides[1] - self.sides[0], 2 | 3)
    }

    fn opposite(&self) -> Corner {
        self.base.step(self.sides[0], 1.0).step(self.sides[1], 1.0)
    }
}

/// The kind of the rhombus at a point and the depth there.
pub(super) fn rhombi(p: [f64; 2]) -> (u8, f64) {
    let rhombus = Rhombus::around(p, 0.8);
    let [u, w] = rhombus.at;
    let height = if rhombus.is_thin() { S36 } else { S72 };
    (rhombus.is_thin().into(), height * u.min(1.0 - u).min(w).min(1.0 - w))
}

/// The kind of the kite or dart at a point and the depth there.
///
/// A kite is a thin rhombus and a half of each of two thick ones, cut along their long diagonals.
/// All other halves are halves of darts.
pub(super) fn kites_and_darts(p: [f64; 2]) -> (u8, f64) {
    // Sides of 1 of rhombi are the short sides here.
    let p = times(p, PHI);
    let rhombus = Rhombus::around(p, 0.8);
    let (base, opposite) = (rhombus.base.place(), rhombus.opposite().place());
    // The corner on one of the outer levels, and the one across from it.
    let is_outer = rhombus.base.level() < 0.5;
    let (outer, inner) = if is_outer { (base, opposite) } else { (opposite, base) };
    let (is_kite, tip, axis);
    if rhombus.is_thin() {
        axis = times(minus(outer, inner), PHI);
        (is_kite, tip) = (true, minus(inner, axis));
    } else {
        let side = rhombus.sides[usize::from(rhombus.at[0] <= rhombus.at[1])];
        let blunt = plus(base, ZETA[side]);
        // The rhombus beyond the side between the blunt corner and the inner one.
        let middle = times(plus(base, opposite), 0.5);
        let outward = minus(times(plus(blunt, inner), 0.5), middle);
        let beyond = Rhombus::around(plus(middle, times(outward, 1.25)), 0.8);
        is_kite = beyond.is_thin();
        tip = if is_kite { outer } else { inner };
        axis = minus(blunt, tip);
    }
    let own = minus(p, tip);
    let (along, across) = (dot(own, axis), cross(own, axis).abs());
    let long = along * S36 - across * C36;
    let short = if is_kite { (PHI - along) * S72 - across * C72 } else { (1.0 - along) * S72 + across * C72 };
    ((!is_kite).into(), long.min(short) / PHI)
}

/// Whether a corner with a conjugate belongs to a level of the tiling with the shift 0.6, whose
/// levels are -1 to 2.
fn belongs(conjugate: [f64; 2], level: f64) -> bool {
    let (sign, radius) = match level {
        -1.0 => (1.0, 1.0),
        0.0 => (-1.0, PHI),
        1.0 => (1.0, PHI),
        2.0 => (-1.0, 1.0),
        _ => return false,
    };
    ZETA.iter().all(|&zeta| -sign * dot(zeta, conjugate) <= radius * C36)
}

/// How many neighbours at the ends of sides a corner has on the level above it, or below it.
fn neighbours(corner: Corner, by: f64) -> usize {
    let is_there = |&j: &usize| {
        let next = corner.step(j, by);
        belongs(next.conjugate(), next.level())
    };
    (0..5).filter(is_there).count()
}

/// How far outside of the pentagon around a corner on level 0 or 1 a point is, by the lines of its
/// sides.
fn beyond_pentagon(corner: Corner, p: [f64; 2]) -> f64 {
    let own = minus(p, times(corner.place(), 2.0 * PENTAGON));
    let sign = if corner.level() == 0.0 { 1.0 } else { -1.0 };
    ZETA.iter().map(|&zeta| sign * dot(own, zeta)).fold(f64::NEG_INFINITY, f64::max) - PENTAGON
}

/// The kind of the pentagon, star, boat or diamond at a point and the depth there.
///
/// The pentagons stand around the corners on levels 0 and 1, the others are left between them.
pub(super) fn pentagons(p: [f64; 2]) -> (u8, f64) {
    let rhombus = Rhombus::around(times(p, 0.5 / PENTAGON), 0.6);
    let [r, q] = rhombus.sides;
    let base = rhombus.base;
    let (mut nearest, mut beyond, mut outer) = (base, f64::INFINITY, base);
    for corner in [base, base.step(r, 1.0), base.step(q, 1.0), rhombus.opposite()] {
        if (0.0..=1.0).contains(&corner.level()) {
            let own = beyond_pentagon(corner, p);
            if own < beyond {
                (nearest, beyond) = (corner, own);
            }
        } else {
            outer = corner;
        }
    }
    if beyond <= 0.0 {
        let by = if nearest.level() == 0.0 { 1.0 } else { -1.0 };
        let kind = match neighbours(nearest, by) {
            5 => 0,
            2 => 1,
            _ => 2,
        };
        return (kind, -beyond);
    }
    // Other pentagons can be nearer.
    let by = if outer.level() < 0.0 { 1.0 } else { -1.0 };
    for (r, q) in (0..5).flat_map(|r| (r + 1..5).map(move |q| (r, q))) {
        let corner = outer.step(r, by).step(q, by);
        if belongs(corner.conjugate(), corner.level()) {
            beyond = beyond.min(beyond_pentagon(corner, p));
        }
    }
    let kind = match neighbours(outer, by) {
        5 => 3,
        4 => 4,
        _ => 5,
    };
    (kind, beyond)
}

/// The number of kinds and the width of the bevel of tilings 25 to 27 (facts of POV-Ray).
pub(super) fn kinds_and_bevel(number: u8) -> (u8, f64) {
    match number {
        25 => (6, C36 / 2.775),
        26 => (2, 1.0 / 4.46),
        _ => (2, C36 / 2.775),
    }
}
