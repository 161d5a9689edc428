//! Maps of the point at which a pattern is evaluated, which need not be affine.

use core::f64::consts::TAU;
use durer_math::{F8, Point3, Vec3, elementary};
use durer_scene::{Around as WrapAround, BlackHole, CellNumbers, PointWarp, Wrap, unfolded};

use super::field::Stir;
use super::place::Place;
use super::{Around, Around8};
use crate::vector::{floor, length, unit};

/// A [`PointWarp`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Warp {
    Placed(Place),
    Stir(Stir),
    Repeat { axis: usize, width: f64, offset: Vec3, flip: [bool; 3] },
    BlackHole(BlackHole),
    Wrapped(Wrap),
    Planar(Vec3, f64),
    Cubic,
}

impl Warp {
    pub(crate) fn new(warp: &PointWarp) -> Self {
        match warp {
            PointWarp::Placed(placement) => Self::Placed(Place::new(placement.affine())),
            PointWarp::Turbulence(turbulence) => Self::Stir(Stir::new(turbulence)),
            &PointWarp::Repeat { axis, width, offset, flip } => Self::Repeat { axis, width, offset, flip },
            PointWarp::BlackHole(hole) => Self::BlackHole(within_blocks(*hole)),
            PointWarp::Wrapped(wrap) => Self::Wrapped(Wrap { orientation: unit(wrap.orientation), ..*wrap }),
            PointWarp::Cubic => Self::Cubic,
            &PointWarp::Planar { normal, distance } => Self::Planar(unit(normal), distance),
        }
    }

    /// The image of a point.
    pub(crate) fn image(&self, p: Point3) -> Point3 {
        match self {
            Self::Placed(place) => place.inside(p, Around::NOWHERE),
            Self::Stir(stir) => {
                stir.moved(Vec3::<F8>::splat(p.to_vec()).to_point()).to_vec().lane(0).to_point()
            }
            Self::Repeat { axis, width, offset, flip } => repeated(p, (*axis, *width), *offset, *flip),
            Self::BlackHole(hole) => drawn(p, hole),
            Self::Wrapped(wrap) => unrolled(p, wrap),
            Self::Planar(normal, distance) => flattened(p, *normal, *distance),
            Self::Cubic => {
                let [x, y, z] = p.to_array();
                let [u, v] = unfolded([x, y, z]);
                Point3::new(u, v, x.abs().max(y.abs()).max(z.abs()))
            }
        }
    }

    /// The images of eight points.
    pub(crate) fn images(&self, p: Point3<F8>) -> Point3<F8> {
        match self {
            Self::Placed(place) => place.inside_lanes(p, &Around8::NOWHERE),
            Self::Stir(stir) => stir.moved(p),
            _ => {
                let mut images = p.to_vec();
                for i in 0..durer_math::lanes::LANES {
                    images.set_lane(i, self.image(p.to_vec().lane(i).to_point()).to_vec());
                }
                images.to_point()
            }
        }
    }
}

/// Slices of a pattern side by side.
fn repeated(p: Point3, (axis, width): (usize, f64), offset: Vec3, flip: [bool; 3]) -> Point3 {
    let mut p = p.to_array();
    let number = floor(p[axis] / width);
    let is_odd = number * 0.5 != floor(number * 0.5);
    p[axis] -= number * width;
    if is_odd {
        for (i, x) in p.iter_mut().enumerate().filter(|(i, _)| flip[*i]) {
            *x = if i == axis { width - *x } else { -*x };
        }
    }
    Point3::new(p[0], p[1], p[2]) + offset * number
}

/// A point moved towards the centre of a black hole, or away from it.
fn drawn(p: Point3, hole: &BlackHole) -> Point3 {
    let (repeat, mut block) = (hole.repeat.to_array(), p.to_array());
    let mut number = [0.0; 3];
    for axis in 0..3 {
        if repeat[axis] > 0.0 {
            number[axis] = floor(block[axis] / repeat[axis]);
            block[axis] -= number[axis] * repeat[axis];
        }
    }
    let mut centre = hole.centre;
    if hole.scatter != Vec3::ZERO {
        centre = centre + shift(number, hole.scatter);
    }
    let inside = Point3::new(block[0], block[1], block[2]);
    let away = inside - centre;
    let distance = length(away);
    if distance >= hole.radius || distance == 0.0 {
        return p;
    }
    let closeness = (hole.radius - distance) / hole.radius;
    let force = elementary::pow(closeness, hole.falloff) * hole.strength;
    // No point moves farther than its distance.
    let force = force.min(1.0);
    p + away * if hole.inverse { -force } else { force }
}

/// The hole as POV-Ray takes it: along each axis along which it is repeated, its centre lies at least its
/// radius behind the begin of the block, and the block ends at least that far behind the farthest centre.
fn within_blocks(hole: BlackHole) -> BlackHole {
    let (mut centre, mut repeat) = (hole.centre.to_array(), hole.repeat.to_array());
    for axis in (0..3).filter(|&axis| hole.repeat.to_array()[axis] > 0.0) {
        centre[axis] = centre[axis].max(hole.radius);
        repeat[axis] = repeat[axis].max(centre[axis] + hole.scatter.to_array()[axis] + hole.radius);
    }
    BlackHole { centre: Point3::from(centre), repeat: Vec3::from(repeat), ..hole }
}

/// The shift of a block's hole, from 0 to `most` along each axis: by the block's random numbers.
fn shift(block: [f64; 3], most: Vec3) -> Vec3 {
    let [x, y, z] = CellNumbers::get().of(block);
    Vec3::new(most.x * x, most.y * y, most.z * z)
}

/// The point of the flat pattern that lies at `p`.
pub(super) fn unrolled(p: Point3, wrap: &Wrap) -> Point3 {
    let Vec3 { x, y, z } = p.to_vec();
    let across = (x * x + z * z).sqrt();
    let turn = angle(x, z);
    let (u, v, distance) = match wrap.around {
        WrapAround::Cylinder => (turn, y, across),
        WrapAround::Sphere => (turn, elementary::atan2(y, across) / (TAU * 0.5) + 0.5, length(p.to_vec())),
        WrapAround::Torus(major) => {
            let out = across - major;
            let around = elementary::atan2(y, out) / TAU;
            (turn, around + 0.5, (out * out + y * y).sqrt())
        }
    };
    let (u, v) = match wrap.growth {
        0.0 => (u, v),
        growth => {
            let factor = elementary::pow(distance, growth);
            (u * factor, if matches!(wrap.around, WrapAround::Cylinder) { v } else { v * factor })
        }
    };
    let flat = Vec3::new(u, v, distance);
    along(flat, wrap.orientation)
}

/// The angle around the y axis, in turns from 0 to 1.
fn angle(x: f64, z: f64) -> f64 {
    let turn = elementary::atan2(z, x) / TAU;
    turn - floor(turn)
}

/// The point of a flat pattern, which is seen along the unit vector `n` instead of z. This is the
/// scene language's map, which is a rotation only for directions along an axis; it was fitted to
/// POV-Ray's values.
fn along(flat: Vec3, n: Vec3) -> Point3 {
    let Vec3 { x: u, y: v, z: d } = flat;
    Point3::new((n.y + n.z) * u + n.x * d, (n.x + n.z) * v - n.y * d, n.y * v - n.x * u + n.z * d)
}

/// The point of the plane `z = d` for a point of another plane with the unit normal `n` and the
/// distance `d` from the origin.
fn flattened(p: Point3, n: Vec3, d: f64) -> Point3 {
    along(Vec3::new(p.x, p.y, d), n)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values are those of POV-Ray: its gradients along the three axes, without their waves.
    /// Measured from POV-Ray's pictures.
    #[test]
    fn repeated_black_holes_fit_into_their_blocks() {
        let blocks = |x: f64, radius: f64, repeat: Vec3| {
            let (strength, falloff, inverse) = (1.0, 2.0, false);
            let hole = BlackHole {
                centre: Point3::new(x, 0.2, 0.0),
                radius,
                strength,
                falloff,
                inverse,
                repeat,
                scatter: Vec3::ZERO,
            };
            let made = within_blocks(hole);
            (made.centre.to_array(), made.repeat.to_array())
        };
        let along_x = Vec3::new(1.5, 0.0, 0.0);
        assert_eq!(blocks(0.5, 0.25, along_x), ([0.5, 0.2, 0.0], [1.5, 0.0, 0.0]));
        assert_eq!(blocks(-0.5, 0.25, along_x), ([0.25, 0.2, 0.0], [1.5, 0.0, 0.0]));
        assert_eq!(blocks(1.5, 0.25, along_x), ([1.5, 0.2, 0.0], [1.75, 0.0, 0.0]));
        assert_eq!(blocks(0.5, 1.0, along_x), ([1.0, 0.2, 0.0], [2.0, 0.0, 0.0]));
        let first = shift([0.0; 3], Vec3::new(1.0, 1.0, 0.0));
        assert!((first.x - 0.7118).abs() < 1e-3 && (first.y - 0.4367).abs() < 1e-3 && first.z == 0.0);
    }

    #[test]
    fn a_wrapped_pattern_turns_with_its_orientation() {
        let p = Point3::new(-1.048, 0.177, -0.52);
        let at = |around, orientation| {
            Warp::new(&PointWarp::Wrapped(Wrap { around, orientation, growth: 0.0 })).image(p).to_array()
        };
        let (u, v, r) = (0.5733, 0.177, 1.1699);
        let all = [
            (Vec3::Z, [u, v, r]),
            (Vec3::Y * 2.0, [u, -r, v]),
            (Vec3::X, [r, v, -u]),
            (Vec3::Z * -1.0, [-u, -v, -r]),
            (Vec3::Y * -1.0, [-u, r, -v]),
            (Vec3::X * -1.0, [-r, -v, u]),
            (Vec3::new(1.0, 1.0, 0.0), [1.2326, -0.7021, -0.2802]),
        ];
        for (orientation, want) in all {
            let found = at(WrapAround::Cylinder, orientation);
            assert!(found.iter().zip(want).all(|(a, b)| (a - b).abs() < 2e-4), "{orientation:?}: {found:?}");
        }
        let found = at(WrapAround::Sphere, Vec3::Y);
        assert!(found.iter().zip([u, -1.1832, 0.5478]).all(|(a, b)| (a - b).abs() < 2e-4), "{found:?}");
    }
}
