//! Control nets of triangular Bezier patches in double-double.
//!
//! ```text
//!    v ▲  2                 S(u, v) = Σ  n! / (i! j! k!)  u^i v^j (1 - u - v)^k  P_ij,
//!      │  ● ●                       i+j+k=n
//!      │  ● ● ●
//!      │  0 ● ● 1 ▶ u       rows one after another along v, each one point shorter
//! ```
//!
//! `P_ij` is the blossom of the patch at the corner 1 (`i` times), 2 (`j` times) and 0 (L. Ramshaw,
//! "Blossoms are polar forms", *Computer Aided Geometric Design* 6 (1989) 323-358; G. Farin,
//! "Triangular Bernstein-Bezier patches", *Computer Aided Geometric Design* 3 (1986) 83-127).

use super::cell::power;
use super::net::{Homogeneous, Net};
use durer_math::Dd;
use durer_roots::bernstein::binomial;

/// The control points of a triangular patch or of a part of it.
#[derive(Clone, Debug)]
pub(crate) struct TriangleNet {
    /// The number of points of a side: the degree plus one.
    pub(crate) side: usize,
    pub(crate) points: Vec<Homogeneous<Dd>>,
    /// The error of the points, relative to the size of all.
    pub(crate) lost: f64,
}

/// The number of points of a net with this many points on each side.
pub(super) fn count(side: usize) -> usize {
    side * (side + 1) / 2
}

/// The index of a point in the list of a net: `i` along u, `j` along v.
#[inline(always)]
fn place(side: usize, i: usize, j: usize) -> usize {
    j * (2 * side + 1 - j) / 2 + i
}

/// The control points of the lower left half of a patch over a square, of total degree n in both
/// parameters and without weights; and their error, in roundings of the largest point.
///
/// With `D_pq` the blossom at the corner (`n - p - q` times) and along `u` (`p` times) and `v` (`q`
/// times): `P_ij = sum (i over p) (j over q) D_pq`, and by the differences of the square's points
/// `D_pq = n! (n - p - q)! / ((n - p)! (n - q)!) Delta_u^p Delta_v^q`. Each difference or sum at
/// most doubles errors, and there are at most n of either.
pub(super) fn lower_half(square: &[Homogeneous<f64>], side: usize) -> (Vec<[f64; 3]>, f64) {
    let n = side - 1;
    let mut d: Vec<[f64; 3]> = square.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let at = |i: usize, j: usize| j * side + i;
    let change = |d: &mut [[f64; 3]], to: usize, from: usize, sign: f64| {
        for c in 0..3 {
            d[to][c] += sign * d[from][c];
        }
    };
    for level in 1..=n {
        for other in 0..side {
            for k in (level..side).rev() {
                change(&mut d, at(k, other), at(k - 1, other), -1.0);
            }
        }
        for other in 0..side {
            for k in (level..side).rev() {
                change(&mut d, at(other, k), at(other, k - 1), -1.0);
            }
        }
    }
    for q in 0..side {
        for p in 0..side - q {
            let by = (0..p).fold(1.0, |b, k| b * (n - k) as f64 / (n - q - k) as f64);
            d[at(p, q)] = d[at(p, q)].map(|x| x * by);
        }
    }
    // Sums undo the differences of the remaining points.
    for level in (1..=n).rev() {
        for j in 0..side {
            for i in level..side - j {
                change(&mut d, at(i, j), at(i - 1, j), 1.0);
            }
        }
        for i in 0..side {
            for j in level..side - i {
                change(&mut d, at(i, j), at(i, j - 1), 1.0);
            }
        }
    }
    let points = (0..side).flat_map(|j| (0..side - j).map(move |i| at(i, j))).map(|k| d[k]).collect();
    (points, 4.0 * n as f64 * power(8.0, n))
}

/// De Casteljau's algorithm, one step: a net with one point less along each side.
fn step(points: &[Homogeneous<Dd>], side: usize, [u, v]: [f64; 2]) -> Vec<Homogeneous<Dd>> {
    let (u, v) = (Dd::from(u), Dd::from(v));
    let mut out = Vec::with_capacity(count(side - 1));
    for j in 0..side - 1 {
        for i in 0..side - 1 - j {
            let [p, a, b] =
                [place(side, i, j), place(side, i + 1, j), place(side, i, j + 1)].map(|k| &points[k]);
            out.push([0, 1, 2, 3].map(|c| p[c] + (u * (a[c] - p[c]) + v * (b[c] - p[c]))));
        }
    }
    out
}

impl TriangleNet {
    /// The part of the patch in the triangle of these corners, which may reach beyond the patch.
    pub(super) fn part(&self, corners: [[f64; 2]; 3]) -> Self {
        let [o, a, b] = corners;
        if corners == [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
            return self.clone();
        }
        let (side, n) = (self.side, self.side - 1);
        let mut points = self.points.clone();
        let mut first = self.points.clone();
        for k in 0..=n {
            let mut second = first.clone();
            for j in 0..=n - k {
                let mut last = second.clone();
                for left in (1..=n - k - j).rev() {
                    last = step(&last, left + 1, a);
                }
                points[place(side, n - k - j, j)] = last[0];
                if j < n - k {
                    second = step(&second, n - k - j + 1, b);
                }
            }
            if k < n {
                first = step(&first, n - k + 1, o);
            }
        }
        Self { side, points, lost: self.lost }
    }

    /// The polynomials over the square whose lower left half is the triangle, as the net of a patch
    /// of degree n along both parameters.
    ///
    /// With `C` the corner (1, 1), the point `P_ij` of that net is the mean over all ways to pair `i`
    /// times `u = 1` with `j` times `v = 1`: `k` of the pairs are at `C`. The blossom there follows
    /// from `C = 1 + 2 - 0`. Points along u = 0 and v = 0 stay as they are.
    pub(super) fn over_square(&self) -> Net {
        let (side, n) = (self.side, self.side - 1);
        // The blossom with `k` arguments at C: nets of sides that shrink.
        let mut beyond = vec![self.points.clone()];
        for k in 1..=n {
            let (wide, last) = (side + 1 - k, &beyond[k - 1]);
            let mut next = Vec::with_capacity(count(wide - 1));
            for j in 0..wide - 1 {
                for i in 0..wide - 1 - j {
                    let [p, a, b] =
                        [place(wide, i, j), place(wide, i + 1, j), place(wide, i, j + 1)].map(|k| &last[k]);
                    next.push([0, 1, 2, 3].map(|c| a[c] + (b[c] - p[c])));
                }
            }
            beyond.push(next);
        }
        let mut points = Vec::with_capacity(side * side);
        for j in 0..side {
            let all = binomial(n, j);
            for i in 0..side {
                let mut sum = [Dd::from(0.0); 4];
                for k in (i + j).saturating_sub(n)..=i.min(j) {
                    let ways = binomial(i, k) * binomial(n - i, j - k);
                    let p = &beyond[k][place(side - k, i - k, j - k)];
                    if ways == all {
                        sum = *p;
                        break;
                    }
                    sum = [0, 1, 2, 3].map(|c| sum[c] + p[c] * ways / Dd::from(all));
                }
                points.push(sum);
            }
        }
        Net { size: [side; 2], points }
    }
}
