//! The oracle: exact nets, halved in big integers, share no code with the kernel.
//!
//! A crossing is where the two exact functions of `u` and `v` that belong to a line vanish. Boxes
//! whose exact hull leaves zero out are dropped; what is left at the finest width is one crossing if
//! the signs on the sides of a slightly wider box prove one (C. Miranda, "Un'osservazione su un
//! teorema di Brouwer", *Bollettino dell'Unione Matematica Italiana* 3 (1940) 5-7), and else open.

use crate::laws::Exact;
use durer_math::Ray;

/// Boxes are halved until they are `2^-FINEST` wide.
const FINEST: i64 = 72;
/// More boxes than this are not looked at: the ray is not tested.
const MOST: usize = 60_000;
/// How far beyond the patch crossings are looked for: they may be reported.
const BEYOND: f64 = 1.0 / (1u64 << 36) as f64;

/// A net of exact numbers of `n` kinds.
type Net = Vec<Vec<Exact>>;

/// A box of parameters.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) low: [Exact; 2],
    pub(super) high: [Exact; 2],
    /// One crossing is proven.
    pub(super) proven: bool,
    /// The sign of the determinant where one is proven.
    pub(super) sign: i8,
    /// The least and the greatest `(t d_z)`.
    along: [Exact; 2],
}

/// The exact functions of a line and a net: two that vanish, the third coordinate, the weight.
pub(super) struct Witness {
    size: [usize; 2],
    net: Net,
    d_z: Exact,
    flip: i8,
}

fn less(a: &Exact, b: &Exact) -> bool {
    (a - b).sign().is_lt()
}

fn blossom(curve: &[Exact], ts: &[&Exact]) -> Exact {
    let mut now = curve.to_vec();
    for t in ts {
        now = now.windows(2).map(|w| &w[0] + &(*t * &(&w[1] - &w[0]))).collect();
    }
    now[0].clone()
}

/// The control values of a curve on `[a, b]`.
fn cut(curve: &[Exact], a: &Exact, b: &Exact) -> Vec<Exact> {
    let n = curve.len() - 1;
    (0..=n)
        .map(|k| {
            let ts: Vec<&Exact> = (0..n).map(|i| if i < n - k { a } else { b }).collect();
            blossom(curve, &ts)
        })
        .collect()
}

fn halves(curve: &[Exact]) -> [Vec<Exact>; 2] {
    let (mut now, mut low, mut high) = (curve.to_vec(), vec![], vec![]);
    while let (Some(first), Some(last)) = (now.first(), now.last()) {
        low.push(first.clone());
        high.push(last.clone());
        now = now.windows(2).map(|w| (&w[0] + &w[1]).shifted(-1)).collect();
    }
    high.reverse();
    [low, high]
}

/// Applies `f` to all rows (`along` 0) or columns of a net.
fn each(net: &[Exact], [nu, nv]: [usize; 2], along: usize, f: impl Fn(&[Exact]) -> Vec<Exact>) -> Vec<Exact> {
    let mut out = net.to_vec();
    let (lines, n, next, step) = if along == 0 { (nv, nu, nu, 1) } else { (nu, nv, 1, nu) };
    for line in 0..lines {
        let curve: Vec<Exact> = (0..n).map(|k| net[line * next + k * step].clone()).collect();
        for (k, x) in f(&curve).into_iter().enumerate() {
            out[line * next + k * step] = x;
        }
    }
    out
}

fn range(net: &[Exact]) -> (Exact, Exact) {
    let mut out = (net[0].clone(), net[0].clone());
    for x in net {
        if less(x, &out.0) {
            out.0 = x.clone();
        }
        if less(&out.1, x) {
            out.1 = x.clone();
        }
    }
    out
}

fn holds_zero(net: &[Exact]) -> bool {
    net.iter().any(|x| x.sign().is_le()) && net.iter().any(|x| x.sign().is_ge())
}

struct Open {
    low: [Exact; 2],
    halved: [i64; 2],
    f: [Vec<Exact>; 2],
}

impl Witness {
    /// The functions of `ray` and a patch of points and weights.
    pub(super) fn new(size: [usize; 2], points: &[[f64; 4]], ray: &Ray) -> Self {
        let d = [ray.direction.x, ray.direction.y, ray.direction.z];
        let o = [ray.origin.x, ray.origin.y, ray.origin.z];
        let z = (0..3).fold(0, |best, k| if d[k].abs() > d[best].abs() { k } else { best });
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let [dx, dy, dz] = axes.map(|k| Exact::from(d[k]));
        let mut net: Net = vec![vec![]; 4];
        for p in points {
            let w = Exact::from(p[3]);
            let [x, y, z] = axes.map(|k| &(&Exact::from(p[k]) - &Exact::from(o[k])) * &w);
            net[0].push(&(&x * &dz) - &(&z * &dx));
            net[1].push(&(&y * &dz) - &(&z * &dy));
            net[2].push(z);
            net[3].push(w);
        }
        // Both functions are d_z times those that are sheared: the determinant keeps its sign.
        let flip = if d[z] < 0.0 { -1 } else { 1 };
        Self { size, net, d_z: dz, flip }
    }

    /// The functions of `ray` and a triangular patch of points and weights, over the whole square.
    ///
    /// All are multiplied by the same number, so that they stay whole: coefficients of powers are
    /// differences of the net, and from these the net of the square follows.
    pub(super) fn triangular(side: usize, points: &[[f64; 4]], ray: &Ray) -> Self {
        let plain = Self::new([points.len(), 1], points, ray);
        let n = side - 1;
        let choose = |n: usize, k: usize| (0..k).fold(1_u64, |b, i| b * (n - i) as u64 / (i as u64 + 1));
        let number = |k: u64| Exact::from(k as f64);
        let all: u64 = (0..=n).map(|k| choose(n, k)).product();
        let square = |net: &Vec<Exact>| {
            let start = |j: usize| (0..j).map(|r| side - r).sum::<usize>();
            let power = |a: usize, b: usize| {
                // The difference, `a` times along u and `b` times along v.
                let mut sum = Exact::from(0.0);
                for j in 0..=b {
                    for i in 0..=a {
                        let term = &number(choose(a, i) * choose(b, j)) * &net[start(j) + i];
                        let odd = (a - i + b - j) % 2 == 1;
                        sum = if odd { &sum - &term } else { &sum + &term };
                    }
                }
                &number(choose(n, a) * choose(n - a, b)) * &sum
            };
            let powers: Vec<Vec<Exact>> =
                (0..=n).map(|a| (0..=n - a).map(|b| power(a, b)).collect()).collect();
            let mut out = vec![];
            for j in 0..=n {
                for i in 0..=n {
                    let mut sum = Exact::from(0.0);
                    for (a, row) in powers.iter().enumerate().take(i + 1) {
                        for (b, c) in row.iter().enumerate().take(j + 1) {
                            let u = choose(i, a) * (all / choose(n, a));
                            let v = choose(j, b) * (all / choose(n, b));
                            sum = &sum + &(&(&number(u) * &number(v)) * c);
                        }
                    }
                    out.push(sum);
                }
            }
            out
        };
        let net = plain.net.iter().map(square).collect();
        Self { size: [side; 2], net, ..plain }
    }

    fn part(&self, low: &[Exact; 2], high: &[Exact; 2]) -> Net {
        let cut_both = |net: &Vec<Exact>| {
            let rows = each(net, self.size, 0, |curve| cut(curve, &low[0], &high[0]));
            each(&rows, self.size, 1, |curve| cut(curve, &low[1], &high[1]))
        };
        self.net.iter().map(cut_both).collect()
    }

    /// All places where the line may meet the patch; `None` if there are too many.
    pub(super) fn places(&self) -> Option<Vec<Place>> {
        let start = [Exact::from(-BEYOND), Exact::from(-BEYOND)];
        let whole = Exact::from(1.0 + 2.0 * BEYOND);
        let end = [&start[0] + &whole, &start[1] + &whole];
        let net = self.part(&start, &end);
        let mut open = vec![Open { low: start, halved: [0; 2], f: [net[0].clone(), net[1].clone()] }];
        let (mut left, mut steps) = (vec![], 0);
        while let Some(now) = open.pop() {
            steps += 1;
            if steps > MOST {
                return None;
            }
            if !holds_zero(&now.f[0]) || !holds_zero(&now.f[1]) {
                continue;
            }
            // Other combinations, with the inverse of the slopes between the corners.
            if let Some(y) = self.inverse(&now.f)
                && y.iter().any(|row| !holds_zero(&combined(&now.f, *row)))
            {
                continue;
            }
            if now.halved == [FINEST; 2] {
                left.push(now);
                continue;
            }
            let along = usize::from(now.halved[1] < now.halved[0]);
            let width = |k: usize| whole.clone().shifted(-now.halved[k]);
            let mut both = [vec![], vec![]];
            for f in &now.f {
                for (half, out) in both.iter_mut().enumerate() {
                    out.push(each(f, self.size, along, |curve| halves(curve)[half].clone()));
                }
            }
            for (half, f) in both.into_iter().enumerate() {
                let mut next = Open { low: now.low.clone(), halved: now.halved, f: f.try_into().ok()? };
                next.halved[along] += 1;
                if half == 1 {
                    next.low[along] = &next.low[along] + &width(along).shifted(-1);
                }
                open.push(next);
            }
        }
        let width = whole.shifted(-FINEST);
        let mut places: Vec<[Exact; 4]> = vec![];
        for box_ in &left {
            let high = [0, 1].map(|k: usize| &box_.low[k] + &width);
            let mut now = [box_.low[0].clone(), box_.low[1].clone(), high[0].clone(), high[1].clone()];
            // Joined with all that touch it.
            while let Some(k) = places
                .iter()
                .position(|p| (0..2).all(|i| !less(&p[i + 2], &now[i]) && !less(&now[i + 2], &p[i])))
            {
                let other = places.swap_remove(k);
                for i in 0..2 {
                    if less(&other[i], &now[i]) {
                        now[i] = other[i].clone();
                    }
                    if less(&now[i + 2], &other[i + 2]) {
                        now[i + 2] = other[i + 2].clone();
                    }
                }
            }
            places.push(now);
        }
        Some(places.into_iter().map(|p| self.place(p, &width)).collect())
    }

    /// The inverse of the slopes, times the determinant, rounded.
    fn inverse(&self, f: &[Vec<Exact>; 2]) -> Option<[[f64; 2]; 2]> {
        let [nu, nv] = self.size;
        let slope = |f: &[Exact], along: usize| {
            let at = |u: usize, v: usize| &f[v * nu + u];
            let (a, b) = (nu - 1, nv - 1);
            let sum = if along == 0 {
                &(at(a, 0) - at(0, 0)) + &(at(a, b) - at(0, b))
            } else {
                &(at(0, b) - at(0, 0)) + &(at(a, b) - at(a, 0))
            };
            sum.to_f64()
        };
        let j = [[slope(&f[0], 0), slope(&f[0], 1)], [slope(&f[1], 0), slope(&f[1], 1)]];
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let most = j.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        (det.abs() > 1e-12 * most * most).then(|| {
            let s = det.signum() / most;
            [[j[1][1] * s, -j[0][1] * s], [-j[1][0] * s, j[0][0] * s]]
        })
    }

    fn place(&self, [u0, v0, u1, v1]: [Exact; 4], width: &Exact) -> Place {
        let room = width.clone().shifted(3);
        let (low, high) = ([&u0 - &room, &v0 - &room], [&u1 + &room, &v1 + &room]);
        let net = self.part(&low, &high);
        let f = [net[0].clone(), net[1].clone()];
        let [nu, nv] = self.size;
        let mut proven = false;
        let mut sign = 0;
        if let Some(y) = self.inverse(&f) {
            let g = y.map(|row| combined(&f, row));
            let side = |g: &[Exact], along: usize, last: bool| -> Vec<Exact> {
                (0..if along == 0 { nv } else { nu })
                    .map(|k| match (along, last) {
                        (0, false) => g[k * nu].clone(),
                        (0, true) => g[k * nu + nu - 1].clone(),
                        (_, false) => g[k].clone(),
                        (_, true) => g[(nv - 1) * nu + k].clone(),
                    })
                    .collect()
            };
            proven = (0..2).all(|k| {
                side(&g[k], k, false).iter().all(|x| x.sign().is_lt())
                    && side(&g[k], k, true).iter().all(|x| x.sign().is_gt())
            });
            let det = y[0][0] * y[1][1] - y[0][1] * y[1][0];
            sign = if det > 0.0 { self.flip } else { -self.flip };
        }
        // z = Z / W, between the extremes of both.
        let (z, w) = (range(&net[2]), range(&net[3]));
        Place { low: [u0, v0], high: [u1, v1], proven, sign, along: self.along(&z, &w) }
    }

    /// Bounds of `t d_z`: of `Z / W`, to 300 bits.
    fn along(&self, z: &(Exact, Exact), w: &(Exact, Exact)) -> [Exact; 2] {
        let of = |z: &Exact, low: bool| {
            // Divided by the weight that makes it least, or greatest.
            let w = if z.sign().is_lt() == low { &w.0 } else { &w.1 };
            let ratio = crate::laws::Surd::ratio(z.clone(), w.clone()).about(300);
            let slack = Exact::from(1.0).shifted(-280);
            if low { &ratio - &slack } else { &ratio + &slack }
        };
        [of(&z.0, true), of(&z.1, false)]
    }

    /// Whether a bracket of `t` is not proven wrong by a place.
    pub(super) fn fits(&self, place: &Place, lo: f64, hi: f64) -> bool {
        let (a, b) = (&Exact::from(lo) * &self.d_z, &Exact::from(hi) * &self.d_z);
        let (a, b) = if less(&b, &a) { (b, a) } else { (a, b) };
        !less(&place.along[1], &a) && !less(&b, &place.along[0])
    }
}

/// A combination of both functions.
fn combined(f: &[Vec<Exact>; 2], by: [f64; 2]) -> Vec<Exact> {
    let [a, b] = by.map(Exact::from);
    f[0].iter().zip(&f[1]).map(|(x, y)| &(&a * x) + &(&b * y)).collect()
}
