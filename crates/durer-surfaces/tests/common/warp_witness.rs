//! The oracle of deformed solids: their maps in polar coordinates, and the solids, in f64 and in
//! 256 bits.

use astro_float::{BigFloat, Consts, RoundingMode};
use durer_math::{Aabb, Point3, Vec3};
use durer_surfaces::implicit::level_set::primitives;
use durer_surfaces::{Axis, LevelSet, Sphere, Surface, Torus, Warp};
use std::cell::RefCell;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

thread_local! {
    static CONSTS: RefCell<Consts> = RefCell::new(Consts::new().unwrap());
}

/// The numbers of the oracle: f64 for samples, 256 bits for signs.
pub(crate) trait Real: Clone {
    fn of(x: f64) -> Self;
    fn add(&self, b: &Self) -> Self;
    fn sub(&self, b: &Self) -> Self;
    fn mul(&self, b: &Self) -> Self;
    fn div(&self, b: &Self) -> Self;
    fn sqrt(&self) -> Self;
    fn sin(&self) -> Self;
    fn cos(&self) -> Self;
    /// The angle, within half a turn.
    fn atan2(&self, x: &Self) -> Self;
    fn pi() -> Self;
    fn is_negative(&self) -> bool;

    fn least(&self, b: &Self) -> Self {
        if self.sub(b).is_negative() { self.clone() } else { b.clone() }
    }
    fn greatest(&self, b: &Self) -> Self {
        if self.sub(b).is_negative() { b.clone() } else { self.clone() }
    }
    fn square(&self) -> Self {
        self.mul(self)
    }
}

impl Real for f64 {
    fn of(x: f64) -> Self {
        x
    }
    fn add(&self, b: &Self) -> Self {
        self + b
    }
    fn sub(&self, b: &Self) -> Self {
        self - b
    }
    fn mul(&self, b: &Self) -> Self {
        self * b
    }
    fn div(&self, b: &Self) -> Self {
        self / b
    }
    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }
    fn sin(&self) -> Self {
        durer_math::elementary::sin(*self)
    }
    fn cos(&self) -> Self {
        durer_math::elementary::cos(*self)
    }
    fn atan2(&self, x: &Self) -> Self {
        durer_math::elementary::atan2(*self, *x)
    }
    fn pi() -> Self {
        core::f64::consts::PI
    }
    fn is_negative(&self) -> bool {
        *self < 0.0
    }
}

impl Real for BigFloat {
    fn of(x: f64) -> Self {
        Self::from_f64(x, P)
    }
    fn add(&self, b: &Self) -> Self {
        Self::add(self, b, P, RM)
    }
    fn sub(&self, b: &Self) -> Self {
        Self::sub(self, b, P, RM)
    }
    fn mul(&self, b: &Self) -> Self {
        Self::mul(self, b, P, RM)
    }
    fn div(&self, b: &Self) -> Self {
        Self::div(self, b, P, RM)
    }
    fn sqrt(&self) -> Self {
        Self::sqrt(self, P, RM)
    }
    fn sin(&self) -> Self {
        CONSTS.with_borrow_mut(|c| Self::sin(self, P, RM, c))
    }
    fn cos(&self) -> Self {
        CONSTS.with_borrow_mut(|c| Self::cos(self, P, RM, c))
    }
    fn atan2(&self, x: &Self) -> Self {
        let right = Self::of(0.0);
        if x.is_zero() {
            let quarter = Self::pi().mul(&Self::of(0.5), P, RM);
            return if Real::is_negative(self) { right.sub(&quarter, P, RM) } else { quarter };
        }
        let a = CONSTS.with_borrow_mut(|c| Self::div(self, x, P, RM).atan(P, RM, c));
        match (Real::is_negative(x), Real::is_negative(self)) {
            (false, _) => a,
            (true, false) => Real::add(&a, &Self::pi()),
            (true, true) => Real::sub(&a, &Self::pi()),
        }
    }
    fn pi() -> Self {
        CONSTS.with_borrow_mut(|c| c.pi(P, RM))
    }
    fn is_negative(&self) -> bool {
        !self.is_zero() && Self::is_negative(self)
    }
}

/// The solids under test.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid {
    Block,
    Ball,
    Ring,
    /// The block without the ball.
    Shell,
}

const LOW: [f64; 3] = [-0.5, -0.375, -1.0];
const HIGH: [f64; 3] = [0.25, 0.5, 1.5];

impl Solid {
    pub(crate) fn level_set(self) -> LevelSet {
        match self {
            Self::Block => {
                let (a, b) = (Point3::from(LOW), Point3::from(HIGH));
                LevelSet::new(primitives::cuboid(a, b).unwrap(), Aabb::new(a, b))
            }
            Self::Ball => {
                let ball = Sphere::new(Point3::new(0.2, -0.1, 0.3), 0.6).unwrap();
                LevelSet::new(primitives::ball(ball.centre(), ball.radius()).unwrap(), Surface::bounds(&ball))
            }
            Self::Ring => {
                let ring = Torus::new(Point3::ORIGIN, Axis::Y, 0.5, 0.2).unwrap();
                LevelSet::new(primitives::torus(0.5, 0.2).unwrap(), ring.bounds())
            }
            Self::Shell => {
                let without = Self::Ball.level_set().complement().unwrap();
                LevelSet::intersection(&[Self::Block.level_set(), without]).unwrap()
            }
        }
    }

    /// The value of the solid's formula, negative inside.
    pub(crate) fn value<T: Real>(self, p: &[T; 3]) -> T {
        match self {
            Self::Block => (0..3)
                .map(|i| T::of(LOW[i]).sub(&p[i]).greatest(&p[i].sub(&T::of(HIGH[i]))))
                .reduce(|a, b| a.greatest(&b))
                .unwrap(),
            Self::Ball => {
                let c = [0.2, -0.1, 0.3];
                let square = |i: usize| p[i].sub(&T::of(c[i])).square();
                square(0).add(&square(1)).add(&square(2)).sqrt().sub(&T::of(0.6))
            }
            Self::Ring => {
                let far = p[0].square().add(&p[2].square()).sqrt().sub(&T::of(0.5));
                far.square().add(&p[1].square()).sub(&T::of(0.2).square())
            }
            Self::Shell => {
                let ball = Self::Ball.value(p);
                Self::Block.value(p).greatest(&T::of(0.0).sub(&ball))
            }
        }
    }
}

/// The point that a warp about a coordinate axis, of either direction, moves to `p`; computed
/// independently.
pub(crate) fn was<T: Real>(warp: &Warp, p: &[T; 3]) -> [T; 3] {
    let along = |axis: &Vec3| {
        let k = (0..3).find(|&k| axis[k] != 0.0).unwrap();
        (k, T::of(axis[k].signum()))
    };
    let clamp = |t: T| t.greatest(&T::of(0.0)).least(&T::of(1.0));
    let radians = |degrees: f64| T::of(degrees).mul(&T::pi()).div(&T::of(180.0));
    let mut q = p.clone();
    match warp {
        Warp::Twist { axis, degrees, from, to } => {
            let (k, sign) = along(axis);
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let height = sign.mul(&p[k]);
            let t = clamp(height.sub(&T::of(*from)).div(&T::of(*to).sub(&T::of(*from))));
            let a = sign.mul(&radians(*degrees)).mul(&t);
            // Polar coordinates: the angle decreases by a.
            let far = p[i].square().add(&p[j].square()).sqrt();
            let angle = p[j].atan2(&p[i]).sub(&a);
            q[i] = far.mul(&angle.cos());
            q[j] = far.mul(&angle.sin());
        }
        Warp::Taper { axis, factor, from, to } => {
            let (k, sign) = along(axis);
            let height = sign.mul(&p[k]);
            let t = clamp(height.sub(&T::of(*from)).div(&T::of(*to).sub(&T::of(*from))));
            let s = T::of(1.0).sub(&t).add(&T::of(*factor).mul(&t));
            for i in [(k + 1) % 3, (k + 2) % 3] {
                q[i] = p[i].div(&s);
            }
        }
        Warp::Bend { axis, toward, degrees, from, to } => {
            let ((k, sign), (m, side)) = (along(axis), along(toward));
            let side = if *degrees < 0.0 { T::of(0.0).sub(&side) } else { side };
            let whole = radians(degrees.abs());
            let radius = T::of(*to).sub(&T::of(*from)).div(&whole);
            let (height, near) = (sign.mul(&p[k]), side.mul(&p[m]));
            let (u, v) = (radius.sub(&near), height.sub(&T::of(*from)));
            let mut a = v.atan2(&u);
            // An angle this far back is either empty or beyond the other end.
            if a.add(&T::of(1.9)).is_negative() {
                a = a.add(&T::pi()).add(&T::pi());
            }
            let (height, near) = if a.is_negative() {
                (height, near)
            } else if whole.sub(&a).is_negative() {
                let beyond = v.mul(&whole.cos()).sub(&u.mul(&whole.sin()));
                let left = u.mul(&whole.cos()).add(&v.mul(&whole.sin()));
                (T::of(*to).add(&beyond), radius.sub(&left))
            } else {
                let far = u.square().add(&v.square()).sqrt();
                (T::of(*from).add(&radius.mul(&a)), radius.sub(&far))
            };
            q[k] = sign.mul(&height);
            q[m] = side.mul(&near);
        }
        Warp::Inverse { .. } => {
            // The only inverse warp of these tests; see `wave`.
            let three = T::of(3.0).mul(&p[0]);
            q[1] = p[1].sub(&T::of(0.125).mul(&three.sin()));
        }
        // It has no inverse, so solids do not take it.
        Warp::Lattice(_) => {}
    }
    q
}
