//! Control nets in double-double: how a patch is cut into cells before any ray is seen.

use super::cell::power;
use super::triangle_net::TriangleNet;
use durer_math::Dd;

/// Coordinates times weight, and the weight.
pub(crate) type Homogeneous<T> = [T; 4];

/// The control points of a patch or of a part of it: rows along `u`, one after another along `v`.
#[derive(Clone, Debug)]
pub(crate) struct Net {
    pub(crate) size: [usize; 2],
    pub(crate) points: Vec<Homogeneous<Dd>>,
}

/// A face: the control points of a patch over the unit square, or over the triangle `u, v >= 0`,
/// `u + v <= 1`.
#[derive(Clone, Debug)]
pub(crate) enum FaceNet {
    Square(Net),
    Triangle(TriangleNet),
}

impl FaceNet {
    /// The control points.
    pub(super) fn points(&self) -> &[Homogeneous<Dd>] {
        match self {
            Self::Square(net) => &net.points,
            Self::Triangle(net) => &net.points,
        }
    }

    /// The face with each control point replaced.
    pub(super) fn map(&self, f: impl Fn(&Homogeneous<Dd>) -> Homogeneous<Dd>) -> Self {
        match self {
            Self::Square(net) => {
                Self::Square(Net { size: net.size, points: net.points.iter().map(f).collect() })
            }
            Self::Triangle(net) => {
                let points = net.points.iter().map(f).collect();
                Self::Triangle(TriangleNet { side: net.side, points, lost: net.lost })
            }
        }
    }

    pub(super) fn is_triangle(&self) -> bool {
        matches!(self, Self::Triangle(_))
    }

    /// The net over a box of parameters, which may reach beyond the patch.
    #[inline(always)]
    pub(super) fn part(&self, from: [f64; 2], to: [f64; 2]) -> Net {
        match self {
            Self::Square(net) => net.part(from, to),
            Self::Triangle(net) => net.part(half(from, to)).over_square(),
        }
    }

    /// What is lost in double-double, as a part of the size of all: on the way from a triangle to a
    /// square errors grow by three with each degree.
    pub(super) fn lost(&self) -> f64 {
        match self {
            Self::Square(_) => durer_math::scale::pow2(-90),
            Self::Triangle(net) => net.lost * power(3.0, net.side - 1),
        }
    }
}

/// The corners of the lower left half of a box.
pub(super) fn half(from: [f64; 2], to: [f64; 2]) -> [[f64; 2]; 3] {
    [from, [to[0], from[1]], [from[0], to[1]]]
}

/// `a + t (b - a)`.
#[inline(always)]
pub(super) fn between(a: Dd, b: Dd, t: Dd) -> Dd {
    a + t * (b - a)
}

/// The control points of a curve between the parameters `from` and `to`: the blossom at `from`
/// (`i` times less) and `to` (`i` times), by de Casteljau's algorithm (L. Ramshaw, "Blossoms are
/// polar forms", *Computer Aided Geometric Design* 6 (1989) 323-358).
#[inline(always)]
fn cut(curve: &mut [Homogeneous<Dd>], from: f64, to: f64) {
    // First the part from `from` to 1, then of that the part up to `to`.
    steps(curve, Dd::from(from), false);
    let rest = Dd::difference(1.0, from);
    steps(curve, Dd::difference(to, from) / rest, true);
}

/// De Casteljau's algorithm in place: the control points from `t` on, or those up to `t`.
#[inline(always)]
fn steps(curve: &mut [Homogeneous<Dd>], t: Dd, backwards: bool) {
    let n = curve.len();
    for level in 1..n {
        for i in 0..n - level {
            // From the front the last point stays, from behind the first.
            let k = if backwards { n - 1 - i } else { i };
            let next = if backwards { k - 1 } else { k + 1 };
            for c in 0..4 {
                curve[k][c] = if backwards {
                    between(curve[next][c], curve[k][c], t)
                } else {
                    between(curve[k][c], curve[next][c], t)
                };
            }
        }
    }
}

impl Net {
    /// The net of these points and weights, `[x, y, z, w]`: products of two f64 are exact.
    pub(super) fn new(size: [usize; 2], points: &[Homogeneous<f64>]) -> Self {
        let times = |p: &Homogeneous<f64>| {
            let of = |k: usize| Dd::product(p[k], p[3]);
            [of(0), of(1), of(2), Dd::from(p[3])]
        };
        Self { size, points: points.iter().map(times).collect() }
    }

    /// The part of the patch in a box of parameters, which may reach beyond the patch.
    #[inline(always)]
    pub(super) fn part(&self, from: [f64; 2], to: [f64; 2]) -> Self {
        let mut out = self.clone();
        let [nu, nv] = self.size;
        if [from[0], to[0]] != [0.0, 1.0] {
            for row in out.points.chunks_exact_mut(nu) {
                cut(row, from[0], to[0]);
            }
        }
        if [from[1], to[1]] != [0.0, 1.0] {
            let mut column = Vec::with_capacity(nv);
            for i in 0..nu {
                column.clear();
                column.extend((0..nv).map(|j| out.points[j * nu + i]));
                cut(&mut column, from[1], to[1]);
                for (j, point) in column.iter().enumerate() {
                    out.points[j * nu + i] = *point;
                }
            }
        }
        out
    }

    /// Both halves along a parameter, by de Casteljau's algorithm: means of points, so that no error
    /// grows.
    pub(super) fn halves(&self, along: usize) -> [Self; 2] {
        let [nu, nv] = self.size;
        let (mut low, mut high) = (self.clone(), self.clone());
        let (n, step, lines, next) = if along == 0 { (nu, 1, nv, nu) } else { (nv, nu, nu, 1) };
        for line in 0..lines {
            let at = |k: usize| line * next + k * step;
            for level in 1..n {
                for k in 0..n - level {
                    let (a, b) = (high.points[at(k)], high.points[at(k + 1)]);
                    high.points[at(k)] = [0, 1, 2, 3].map(|c| (a[c] + b[c]).scale2(-1));
                }
                low.points[at(level)] = high.points[at(0)];
            }
        }
        [low, high]
    }

    /// Each point relative to `base`, rounded: coordinates less `base` times the weight.
    #[inline(always)]
    pub(super) fn relative(&self, base: [f64; 3]) -> Vec<Homogeneous<f64>> {
        relative(&self.points, base)
    }
}

/// Each point relative to `base`, rounded: coordinates less `base` times the weight.
pub(super) fn relative(points: &[Homogeneous<Dd>], base: [f64; 3]) -> Vec<Homogeneous<f64>> {
    let about = |p: &Homogeneous<Dd>| {
        let of = |k: usize| (p[k] - Dd::from(base[k]) * p[3]).to_f64();
        [of(0), of(1), of(2), p[3].to_f64()]
    };
    points.iter().map(about).collect()
}

/// The net of the patch over a box that is wider by `margin` on all sides, and a bound on its
/// error, in roundings of the largest point.
///
/// Each of the `4 (n - 1)` levels rounds three times, and enlarges points and their errors by less than
/// `(1 + 2 margin)`.
pub(super) fn widened(
    points: &[Homogeneous<f64>],
    [nu, nv]: [usize; 2],
    margin: f64,
) -> (Vec<Homogeneous<f64>>, f64) {
    let mut out = points.to_vec();
    for (n, step, lines, next) in [(nu, 1, nv, nu), (nv, nu, nu, 1)] {
        for line in 0..lines {
            let at = |k: usize| line * next + k * step;
            for level in 1..n {
                for k in 0..n - level {
                    let (a, b) = (out[at(k)], out[at(k + 1)]);
                    out[at(k)] = [0, 1, 2, 3].map(|c| (-margin).mul_add(b[c] - a[c], a[c]));
                }
            }
            let t = (1.0 + 2.0 * margin) / (1.0 + margin);
            for level in 1..n {
                for k in (level..n).rev() {
                    let (a, b) = (out[at(k - 1)], out[at(k)]);
                    out[at(k)] = [0, 1, 2, 3].map(|c| t.mul_add(b[c] - a[c], a[c]));
                }
            }
        }
    }
    let levels = 2 * (nu + nv - 2);
    (out, 3.0 * levels as f64 * power(1.0 + 2.0 * margin, levels))
}

/// The greatest magnitude of the differences of a net, `along` times in each direction; times the
/// factor that makes derivatives of them.
pub(super) fn steepest(points: &[Homogeneous<f64>], size: [usize; 2], along: [usize; 2]) -> Homogeneous<f64> {
    let mut now: Vec<Homogeneous<f64>> = points.to_vec();
    let [mut nu, mut nv] = size;
    let mut factor = 1.0;
    let less = |a: &Homogeneous<f64>, b: &Homogeneous<f64>| [0, 1, 2, 3].map(|c| a[c] - b[c]);
    for _ in 0..along[0] {
        if nu < 2 {
            return [0.0; 4];
        }
        factor *= (nu - 1) as f64;
        now = now
            .chunks_exact(nu)
            .flat_map(|row| row.windows(2).map(|w| less(&w[1], &w[0])).collect::<Vec<_>>())
            .collect();
        nu -= 1;
    }
    for _ in 0..along[1] {
        if nv < 2 {
            return [0.0; 4];
        }
        factor *= (nv - 1) as f64;
        now = (0..(nv - 1) * nu).map(|k| less(&now[k + nu], &now[k])).collect();
        nv -= 1;
    }
    let mut most = [0.0_f64; 4];
    for p in &now {
        for c in 0..4 {
            most[c] = most[c].max(p[c].abs() * factor);
        }
    }
    most
}
