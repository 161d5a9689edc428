//! Control nets in double-double: how a patch is cut into cells before any ray is seen.

use durer_math::Dd;

/// Coordinates times weight, and the weight.
pub(super) type Homogeneous<T> = [T; 4];

/// The control points of a patch or of a part of it: rows along `u`, one after another along `v`.
#[derive(Clone, Debug)]
pub(super) struct Net {
    pub(super) size: [usize; 2],
    pub(super) points: Vec<Homogeneous<Dd>>,
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

    /// Each point relative to `base`, rounded: coordinates less `base` times the weight.
    #[inline(always)]
    pub(super) fn relative(&self, base: [f64; 3]) -> Vec<Homogeneous<f64>> {
        let about = |p: &Homogeneous<Dd>| {
            let of = |k: usize| (p[k] - Dd::from(base[k]) * p[3]).to_f64();
            [of(0), of(1), of(2), p[3].to_f64()]
        };
        self.points.iter().map(about).collect()
    }
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
