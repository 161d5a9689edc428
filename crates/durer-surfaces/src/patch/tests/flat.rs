//! Flat patches, and lines in their plane. Control points and lines are whole multiples of two vectors,
//! so that where a line is in the hull of the control points is decided without rounding.

use super::*;
use durer_math::{Dyadic, Ring};

/// A flat patch, and its control points in its plane.
struct Flat {
    surface: Box<dyn crate::laws::TestSurface>,
    base: Point3,
    axes: [Vec3; 2],
    points: Vec<[f64; 2]>,
    /// A point of the patch, in its plane.
    middle: [f64; 2],
}

impl Flat {
    fn new(dice: &mut TestRng) -> Option<Self> {
        let base = (dice.lattice(8) * 0.25).to_point();
        let axes = [dice.lattice(3), dice.lattice(3)];
        let size = [2 + dice.below(3) as usize, 2 + dice.below(3) as usize];
        let is_triangle = dice.once_in(3);
        let is_bent = dice.once_in(2);
        let weighted = dice.once_in(3);
        let (side, mut points) = (size[0], Vec::new());
        for j in 0..if is_triangle { side } else { size[1] } {
            for i in 0..if is_triangle { side - j } else { size[0] } {
                let moved = if is_bent { dice.lattice(2) * 0.25 } else { Vec3::ZERO };
                points.push([i as f64 + moved.x, j as f64 + moved.y]);
            }
        }
        let weights: Vec<f64> =
            points.iter().map(|_| if weighted { dice.pick(&[1.0, 2.0, 0.5]) } else { 1.0 }).collect();
        let at = |p: &[f64; 2]| base + axes[0] * p[0] + axes[1] * p[1];
        let net: Vec<[f64; 4]> = points
            .iter()
            .zip(&weights)
            .map(|(p, w)| {
                let p = at(p);
                [p.x, p.y, p.z, *w]
            })
            .collect();
        if axes[0].cross(axes[1]) == Vec3::ZERO {
            return None;
        }
        // A corner is a control point.
        let mut middle = points[0];
        let surface: Box<dyn crate::laws::TestSurface> = if is_triangle {
            Box::new(TriangularPatch::rational(side, &net).ok()?)
        } else {
            if !weighted && size == [2, 2] {
                middle = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() * 0.25);
            }
            Box::new(BezierPatch::rational(size, &net).ok()?)
        };
        Some(Self { surface, base, axes, points, middle })
    }

    fn at(&self, [a, b]: [f64; 2]) -> Point3 {
        self.base + self.axes[0] * a + self.axes[1] * b
    }

    /// The least and the greatest parameter at which a line in the plane is off the hull by at most `off`.
    /// For 0 that is decided without rounding: products of whole numbers are exact, and so is everything
    /// but the quotients.
    fn extent(&self, [a, b]: [f64; 2], [c, d]: [f64; 2], off: f64) -> Option<[f64; 2]> {
        let seen: Vec<[f64; 2]> = self
            .points
            .iter()
            .map(|p| [(p[0] - a) * d - (p[1] - b) * c, (p[0] - a) * c + (p[1] - b) * d])
            .collect();
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |at: f64| {
            let t = at / (c * c + d * d);
            ends = [ends[0].min(t), ends[1].max(t)];
        };
        for [g, z] in &seen {
            if g.abs() <= off {
                add(*z);
            }
            for [h, y] in &seen {
                for level in [-off, off] {
                    let (g, h) = (g - level, h - level);
                    if g > 0.0 && h < 0.0 {
                        add((g * y - h * z) / (g - h));
                    }
                }
            }
        }
        (ends[0] <= ends[1]).then_some(ends)
    }

    /// The greater of the two functions of a line with this direction at a point that is off the line by
    /// 1, as [`Flat::extent`] measures it. A function is a coordinate less the slope times the one along
    /// which the direction is greatest, both from a point of the line.
    fn across(&self, [c, d]: [f64; 2]) -> f64 {
        let direction = (self.axes[0] * c + self.axes[1] * d).to_array();
        let off = ((self.axes[0] * d - self.axes[1] * c) / (c * c + d * d)).to_array();
        let z = (0..3).fold(0, |z, k| if direction[k].abs() > direction[z].abs() { k } else { z });
        (0..3).map(|k| (off[k] - direction[k] / direction[z] * off[z]).abs()).fold(0.0, f64::max)
    }
}

/// Bound on the errors of both functions of a line, combined, and of the third coordinate, in roundings of
/// the greatest coordinate `S` of points and origin, for weights from 1/2 to 2.
///
/// Relative to a cell's base, points times their weights are at most `4 S`, and with the origin `8 S`.
/// So the errors of `View::new` are 18 for two coordinates of a point, 24 for two of the origin, 24 for the
/// slope, which errs by three roundings, and 32 for its own roundings. `View::control_errors` adds 8 for the
/// point's own roundings, divides by a weight of at least 1/2, and adds 58 for the weight's error: 270.
/// The combination of two functions is `sqrt(2)` times that and the four roundings of each: 450.
const ERROR: f64 = 512.0;

/// A bracket is where the hull's combination of both functions is within their error `e` of 0 as
/// computed, so within `2 e` truly. The combination is along the difference of two points that are at
/// least half as far apart as any. If that is more than `12 e`, then it is along the plane but for an
/// angle whose cosine is above 1/2, and both functions are within `4 e`. Otherwise all points are
/// within `24 e` of zero, because neither function is certainly not zero.
const WIDER: f64 = 24.0 * ERROR;

/// Brackets of lines in the plane of a flat patch are within the hull of its control points but for the
/// errors of rounding, and a ray that ends before the hull meets nothing.
#[test]
fn lines_in_the_plane_of_a_flat_patch_meet_it_within_its_hull() {
    let (mut lines, mut uncertain, mut early) = (0_u64, 0, 0_u64);
    for case in drawn(150) {
        let mut dice = crate::laws::dice(83, case);
        let Some(flat) = Flat::new(&mut dice) else { continue };
        for _ in 0..20 {
            let direction = [dice.integer(-3, 3), dice.integer(-3, 3)];
            let start = if dice.once_in(2) {
                let back = dice.pick(&[8.0, 16.0, 1024.0, 1048576.0]);
                [0, 1].map(|k| flat.middle[k] - back * direction[k])
            } else {
                [dice.integer(-32, 64) / 8.0, dice.integer(-32, 64) / 8.0]
            };
            let d = flat.axes[0] * direction[0] + flat.axes[1] * direction[1];
            if d == Vec3::ZERO {
                continue;
            }
            let ray = Ray::new(flat.at(start), d).with_range(-1e9, 1e9);
            let roots = all_roots(&*flat.surface, &ray);
            let told = || format!("{case}: {start:?} {direction:?} {roots:?} {ray:?}");
            lines += 1;
            let size = flat.surface.bounds().magnitude().max(ray.origin.to_vec().max_abs());
            let off = WIDER * U * size / flat.across(direction);
            let wider = flat.extent(start, direction, off);
            let Some([low, high]) = wider.filter(|_| flat.extent(start, direction, 0.0).is_some()) else {
                assert!(roots.is_empty(), "beside the hull: {}", told());
                // Rounding cannot reach a hull from a line beside it.
                assert!(wider.is_none(), "{}", told());
                continue;
            };
            let room = ERROR * U * low.abs().max(high.abs()).max(size / d.max_abs());
            for root in &roots {
                uncertain += u64::from(root.kind != RootKind::Simple);
                assert!(root.lo >= low - room && root.hi <= high + room, "{low} to {high}: {}", told());
            }
            let far = low.abs().max(1.0);
            for k in (1..60).step_by(4) {
                let t_max = low - far * durer_math::scale::pow2(-k);
                let ray = Ray::new(ray.origin, d).with_range(-1e9, t_max);
                if t_max < low - room {
                    assert!(all_roots(&*flat.surface, &ray).is_empty(), "up to {t_max}: {}", told());
                    early += 1;
                }
            }
        }
    }
    println!("{lines} lines, {uncertain} uncertain, {early} that end early");
    assert!(uncertain > 500 && early > 5000, "{uncertain} {early}");
    report(lines);
}

/// A line in the plane of a triangle but for an angle of 2.8e-17 goes through it once. Parts of the
/// triangle, a patch with an edge that is one point, cannot be proven to hold that crossing.
#[test]
fn a_line_almost_in_the_plane_has_the_sign_of_its_crossing() {
    let corners = [
        [-0.013258226712515538, -0.006035289185656781, 0.014401001498325551],
        [0.00185252224326405, 0.026545659369410564, 0.02450304277509182],
        [-0.002900403101261495, -0.012357195574609306, -0.025770928193837216],
        [-0.002900403101261495, -0.012357195574609306, -0.025770928193837216],
    ];
    let triangle = BezierPatch::new([2, 2], &corners.map(Point3::from)).unwrap();
    let origin = Point3::new(-0.000860752140938497, 0.012447098398003236, 0.009132326317956099);
    let direction = Vec3::new(-0.1314180227863248, -0.5083191341453965, -0.45760135577601224);
    let signs = |ray: &Ray| all_roots(&triangle, ray).iter().map(|r| (r.kind, r.sign)).collect::<Vec<_>>();
    // In exact arithmetic d . n is positive.
    assert_eq!(signs(&Ray::new(origin, direction)), [(RootKind::Cluster, 1)]);
    assert_eq!(signs(&Ray::new(origin, -direction).with_range(-1.0, 0.0)), [(RootKind::Cluster, -1)]);
}

/// A line that is in the plane of a triangular patch but for an angle of 4e-18 goes through it once: the
/// degree in double-double gives the sign of `d . n` in exact arithmetic, and the line back the other.
#[test]
fn a_line_almost_in_the_plane_of_a_triangular_patch_has_the_sign_of_its_crossing() {
    let net = [
        [0.0, 0.04926094997755026, 0.0, 1.0],
        [1.0, -1.623798095416264, 0.0, 1.0],
        [0.0, 1.838885178052775, 1.0, 1.0],
    ];
    let triangle = TriangularPatch::rational(2, &net).unwrap();
    let origin = Point3::new(0.3978071890349969, -0.09209540118446949, 0.2929098503206198);
    let direction = Vec3::new(0.5, 0.05828259134070522, 0.5);
    for (way, sign) in [(1.0, 1), (-1.0, -1)] {
        let roots = all_roots(&triangle, &Ray::new(origin, direction * way).with_range(-10.0, 10.0));
        let [root] = &roots[..] else { panic!("{roots:?}") };
        assert!(root.sign == sign && root.kind == RootKind::Cluster, "{root:?}");
        let t = -0.3700593083459438 * way;
        assert!(root.lo <= t && t <= root.hi && root.hi - root.lo < 1e-8, "{root:?}");
    }
}

/// Lines through a flat triangle of three control points that are in its plane but for an angle of some
/// 1e-17, or exactly, meet it. A crossing has the sign of `d . n` in whole numbers, or 0 where rounding hides
/// it, which is so for most of these lines: they are nowhere farther from the plane than their errors.
#[test]
fn lines_almost_in_the_plane_of_a_triangle_have_no_wrong_sign() {
    let exact = |v: Vec3| [v.x, v.y, v.z].map(Dyadic::exact);
    let (mut rays, mut unknown) = (0, 0);
    for case in drawn(2000) {
        let mut dice = crate::laws::dice(86, case);
        let corners = [dice.lattice(8) * 0.125, dice.lattice(8) * 0.125, dice.lattice(8) * 0.125];
        let [a, b, c] = corners;
        let n = (b - a).cross(c - a);
        if n == Vec3::ZERO {
            continue;
        }
        let net = corners.map(|p| [p.x, p.y, p.z, 1.0]);
        let triangle = TriangularPatch::rational(2, &net).unwrap();
        // A point within the triangle, exactly, and a direction in its plane, rounded.
        let [s, t] = [0.0; 2].map(|_: f64| dice.integer(12, 28) / 64.0);
        let through = a + (b - a) * s + (c - a) * t;
        let [p, q] = [0.0; 2].map(|_: f64| dice.unit() - 0.5);
        let direction = (b - a) * p + (c - a) * q;
        let ray = Ray::new(through.to_point(), direction).with_range(-1e3, 1e3);
        let [x, y, z] = exact(direction);
        let [nx, ny, nz] = exact(n);
        let way = (x * nx + y * ny + z * nz).exact_sign() as i8;
        rays += 1;
        let roots = all_roots(&triangle, &ray);
        let sum: i8 = roots.iter().map(|root| root.sign).sum();
        assert!(sum == 0 || sum == way, "{case}: {sum} {way} {roots:?} {ray:?}");
        unknown += u64::from(sum == 0 && way != 0);
        assert!(roots.iter().any(|root| root.lo <= 0.0 && root.hi >= 0.0), "{case}: {roots:?} {ray:?}");
    }
    println!("{rays} rays, {unknown} of unknown sign");
    report(rays);
}

/// A tangent of the paraboloid `y = x² + z²` meets it nowhere else, so the signs add up to 0. The lines
/// are tangents exactly, which no arithmetic with errors can prove.
#[test]
fn signs_add_up_along_tangents_of_a_paraboloid() {
    let squares = [1.0, -1.0, 1.0];
    let net: Vec<Point3> = (0..9)
        .map(|k| (k % 3, k / 3))
        .map(|(i, j)| Point3::new(i as f64 - 1.0, squares[i] + squares[j], j as f64 - 1.0))
        .collect();
    let bowl = BezierPatch::new([3, 3], &net).unwrap();
    let (mut rays, mut unproven, mut off) = (0, 0, Vec::new());
    for case in drawn(2000) {
        let mut dice = crate::laws::dice(85, case);
        let [x, z] = [0.0; 2].map(|_: f64| dice.integer(-6, 6) / 8.0);
        let [a, b] = [0.0; 2].map(|_: f64| dice.integer(-4, 4));
        let direction = Vec3::new(a, 2.0 * (x * a + z * b), b);
        if direction == Vec3::ZERO {
            continue;
        }
        let back = dice.pick(&[0.0, 0.5, 4.0, 1024.0, 1048576.0]);
        let place = Vec3::new(x, x * x + z * z, z);
        let ray = Ray::new((place - direction * back).to_point(), direction).with_range(-1e9, 1e9);
        rays += 1;
        let roots = all_roots(&bowl, &ray);
        unproven += roots.iter().filter(|root| root.kind != RootKind::Simple).count();
        if roots.iter().map(|root| i32::from(root.sign)).sum::<i32>() != 0 {
            off.push((ray, roots));
        }
    }
    println!("{} of {rays} do not add up, {unproven} unproven", off.len());
    report(rays);
    assert!(off.is_empty() && unproven > 1000, "{unproven}: {:?}", off.first());
}
