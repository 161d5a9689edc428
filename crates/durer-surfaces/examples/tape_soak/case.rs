//! One random formula, made from any bytes, and tests of everything that must hold for it.

#[path = "../../../../fuzz/shared/bytes.rs"]
#[allow(clippy::duplicate_mod, reason = "each target stands alone, too; only the tests load them all")]
mod bytes;

use bytes::Bytes;
use durer_formula::noise::Nearest;
use durer_formula::{Builder, Formula, NodeId, Op, Tape};
use durer_formula::{Comparison, Dual, Function, I8, Number};
use durer_math::{F8, Interval, Point3, Ray, Vec3};
use durer_surfaces::{All, AxisBox, Container, Isosurface, LocalRay, Need, RootKind, Surface};

impl Bytes<'_> {
    /// Usually a small round number, sometimes any number.
    fn number(&mut self) -> f64 {
        match self.next() {
            0 => f64::from_bits(self.bits()),
            1 => f64::from(self.next()) * 1e-3,
            n => (f64::from(n) - 128.0) / 16.0,
        }
    }

    fn finite(&mut self) -> f64 {
        let x = self.number();
        if x.is_finite() && x.abs() < 1e6 { x } else { 1.0 }
    }
}

/// The steps of a formula, the last one its value.
struct Steps {
    builder: Builder,
    made: Vec<NodeId>,
}

impl Steps {
    /// The formula of the last step.
    fn formula(&self) -> Option<Formula> {
        Some(self.builder.finish(*self.made.last()?, 3))
    }

    /// Whether a step leaves the range of f64 at a point: values that follow from its infinity do
    /// not test the formula.
    fn overflow(&self, p: Point3) -> bool {
        self.made.iter().any(|&step| self.builder.finish(step, 3).value(&p.to_array()).is_infinite())
    }
}

/// The formula that the bytes encode: each step takes operands from earlier steps.
fn steps(bytes: &mut Bytes<'_>) -> Option<Steps> {
    const FUNCTIONS: [Function; 18] = [
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Asin,
        Function::Acos,
        Function::Atan,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Asinh,
        Function::Acosh,
        Function::Atanh,
        Function::Exp,
        Function::Ln,
        Function::Log10,
        Function::Floor,
        Function::Ceil,
        Function::Trunc,
    ];
    const COMPARISONS: [Comparison; 6] = [
        Comparison::Less,
        Comparison::LessEqual,
        Comparison::Equal,
        Comparison::NotEqual,
        Comparison::And,
        Comparison::Or,
    ];
    let mut b = Builder::new();
    let mut made: Vec<NodeId> = (0..3).map(|i| b.input(i)).collect::<Result<_, _>>().ok()?;
    for _ in 0..bytes.next() % 24 + 1 {
        let code = bytes.next() % 21;
        let mut pick = || made[made.len() - 1 - usize::from(bytes.next()) % made.len()];
        let (x, y) = (pick(), pick());
        let op = match code {
            0 => Op::Add(x, y),
            1 => Op::Sub(x, y),
            2 => Op::Mul(x, y),
            3 => Op::Div(x, y),
            4 => Op::Min(x, y),
            5 => Op::Max(x, y),
            6 => Op::Sqr(x),
            7 => Op::Sqrt(x),
            8 => Op::Abs(x),
            9 => Op::Neg(x),
            10 => Op::Pow(x, y),
            11 => Op::Atan2(x, y),
            12 => Op::Rem(x, y),
            13 => Op::Select([x, y, pick(), pick()]),
            14 => Op::Powi(x, i32::from(bytes.next() % 9) - 3),
            15 => Op::Compare(COMPARISONS[usize::from(bytes.next()) % 6], x, y),
            16 => {
                let c = bytes.finite();
                made.push(b.constant(c).ok()?);
                continue;
            }
            17 => Op::Noise(None, [x, y, pick()]),
            18 => {
                // y + x a or y + x b, which are equal where x is zero.
                let (below, above) = (b.push(Op::Mul(x, pick())).ok()?, b.push(Op::Mul(x, pick())).ok()?);
                Op::Joined([x, b.push(Op::Add(y, below)).ok()?, b.push(Op::Add(y, above)).ok()?])
            }
            19 => {
                let z = pick();
                let exponent = [1.0, 2.0, 2.5, 6.0][usize::from(bytes.next()) % 4];
                let offset = [0.0, 0.3][usize::from(bytes.next()) % 2];
                let nearest = Nearest::shared(usize::from(bytes.next()) % 3, exponent, offset)?;
                Op::Nearest(nearest, [x, y, z])
            }
            _ => Op::Function(FUNCTIONS[usize::from(bytes.next()) % 18], x),
        };
        made.push(b.push(op).ok()?);
    }
    Some(Steps { builder: b, made })
}

/// Tests everything about the formula that the bytes encode.
///
/// # Panics
///
/// If something does not hold.
pub(crate) fn check(data: &[u8]) {
    let mut bytes = Bytes(data);
    let Some(steps) = steps(&mut bytes) else { return };
    let Some(formula) = steps.formula() else { return };
    let tape = Tape::new(&formula);
    let boxes: [I8; 3] = core::array::from_fn(|_| {
        let (mut lo, mut hi) = (F8::ZERO, F8::ZERO);
        for i in 0..8 {
            let (a, b) = (bytes.finite(), bytes.finite());
            let b = if i % 2 == 0 { b } else { a + b * 1e-4 };
            (lo.0[i], hi.0[i]) = (a.min(b), a.max(b));
        }
        I8::new(lo, hi)
    });
    bounds_hold(&steps, &formula, &tape, &boxes);
    slopes_hold(&tape, &boxes);
    gradients_hold(&tape, &boxes);
    // Cells take long: only a few formulas are tested with them.
    if bytes.next().is_multiple_of(64) {
        roots_are_in_order(&formula, &mut bytes);
    }
}

fn point(boxes: &[I8; 3], lane: usize, k: [f64; 3]) -> Point3 {
    let at = |axis: usize| {
        let x = boxes[axis].lane(lane);
        (x.lo + (x.hi - x.lo) * k[axis]).clamp(x.lo, x.hi)
    };
    Point3::new(at(0), at(1), at(2))
}

/// Bounds contain the values at points. A tape that was shortened on a box has the same exact
/// values there, so its bounds and those of the whole tape overlap. If a decision makes a step
/// constant, everything that follows from it is computed as an interval, whose middle may differ
/// from the result of rounding step by step.
fn bounds_hold(steps: &Steps, formula: &Formula, tape: &Tape, boxes: &[I8; 3]) {
    let (v, shorter) = tape.shortened(boxes, |_, _| true);
    for lane in 0..8 {
        let range = v.lane(lane);
        let beside = tape.sign_beside_jumps(&boxes.each_ref().map(|x| I8::splat(x.lane(lane))));
        for k in [[0.0; 3], [1.0; 3], [0.5; 3], [0.0, 1.0, 0.3], [0.9, 0.1, 0.6]] {
            let p = point(boxes, lane, k);
            let value = tape.value(p);
            assert_eq!(value.to_bits(), formula.value(&p.to_array()).to_bits());
            if value.is_nan() {
                let told = v.partial >> lane & 1 == 1;
                assert!(told || steps.overflow(p), "{formula:?} is undefined at {p:?}, {v:?}");
            } else if value.is_finite() {
                assert!(range.contains(value), "{formula:?} at {p:?} is {value}, lane {lane} of {v:?}");
                let agrees = beside.is_none_or(|above| if above { value > 0.0 } else { value < 0.0 });
                assert!(
                    agrees,
                    "{formula:?} at {p:?} is {value}, beside jumps {beside:?}, lane {lane} of {v:?}"
                );
                if let Some(shorter) = &shorter[lane] {
                    let short = shorter.value(p);
                    let here = p.to_array().map(|x| I8::splat(Interval { lo: x, hi: x }));
                    let (told, known) = (shorter.bounds(&here), tape.bounds(&here));
                    // An exponent that is no longer known to be an integer may leave the domain:
                    // then the bounds report this, and there is no value or no bound. Also, the
                    // side of a joined pair that the whole formula did not take may have come from
                    // an infinity.
                    let left = told.partial & 1 == 1 && (short.is_nan() || told.empty & 1 == 1);
                    let lost = left || short.is_nan() && steps.overflow(p);
                    let agree = told.lane(0).intersection(known.lane(0)).is_some();
                    assert!(
                        lost || agree && told.lane(0).contains(short),
                        "{formula:?} at {p:?} is in {known:?}, shortened {short} in {told:?}"
                    );
                }
            }
        }
    }
}

/// Between two points of a box a smooth formula changes by a slope within the bounds.
fn slopes_hold(tape: &Tape, boxes: &[I8; 3]) {
    let zero = I8::constant(Interval { lo: 0.0, hi: 0.0 });
    let one = I8::constant(Interval { lo: 1.0, hi: 1.0 });
    let g = tape.slopes(&[
        Dual { v: boxes[0], d: one },
        Dual { v: boxes[1], d: zero },
        Dual { v: boxes[2], d: zero },
    ]);
    for lane in 0..8 {
        if (g.v.partial | g.v.jump | g.d.partial) >> lane & 1 == 1 {
            continue;
        }
        let (p, q) = (point(boxes, lane, [0.0, 0.5, 0.5]), point(boxes, lane, [1.0, 0.5, 0.5]));
        let at = |p: Point3| {
            let x = p.to_array().map(|x| I8::splat(Interval { lo: x, hi: x }));
            tape.bounds(&x).lane(0)
        };
        let change = at(q) - at(p);
        let run = Interval { lo: q.x, hi: q.x } - Interval { lo: p.x, hi: p.x };
        let told = g.d.lane(lane) * run;
        assert!(told.intersection(change).is_some(), "the slope says {told:?}, it is {change:?}: {tape:?}");
    }
}

/// Slopes in all directions at once lie within those of single directions; rounded numbers are
/// within the bounds at their points.
fn gradients_hold(tape: &Tape, boxes: &[I8; 3]) {
    let number = |x: f64| I8::constant(Interval { lo: x, hi: x });
    let all = tape.gradients(boxes);
    for (axis, d) in all.d.d.iter().enumerate() {
        let seed = |i: usize| number(if i == axis { 1.0 } else { 0.0 });
        let one = tape.slopes(&[0, 1, 2].map(|i| Dual { v: boxes[i], d: seed(i) }));
        let flags = |v: &I8| (v.partial, v.empty, v.jump);
        assert_eq!(flags(&all.v), flags(&one.v), "{tape:?}");
        for lane in 0..8 {
            assert_eq!(all.v.lane(lane), one.v.lane(lane), "{tape:?}");
            if (one.v.partial | one.v.jump | one.d.partial) >> lane & 1 == 1 {
                continue;
            }
            let (told, wider) = (d.lane(lane), one.d.lane(lane));
            assert!(d.partial >> lane & 1 == 0, "{tape:?}");
            // Both contain the slopes. Computed together they are also narrower, up to the charge
            // of each step for underflow, because they skip products with what does not vary.
            let is_tiny = |x: f64| x.abs() < durer_math::scale::pow2(-900);
            let is_below = wider.lo <= told.lo || is_tiny(told.lo) && is_tiny(wider.lo);
            let is_above = told.hi <= wider.hi || is_tiny(told.hi) && is_tiny(wider.hi);
            assert!(
                told.intersection(wider).is_some() && is_below && is_above,
                "along {axis} {told:?}, by itself {wider:?}: {tape:?}"
            );
        }
    }
    let p = [0, 1, 2].map(|axis| F8(core::array::from_fn(|lane| point(boxes, lane, [0.3, 0.6, 0.9])[axis])));
    let at = p.map(|p| I8::new(p, p));
    let (bounds, values) = (tape.bounds(&at), tape.values(&p));
    let (steep, slants) = (tape.gradients(&at), tape.slants(&p));
    for lane in 0..8 {
        if bounds.partial >> lane & 1 == 1 {
            continue;
        }
        let holds = |bounds: &I8, value: &F8| {
            let (bounds, value) = (bounds.lane(lane), value.0[lane]);
            // Overflow is not bounded; rounded numbers may be lost where bounds are unknown.
            !value.is_finite() || bounds.contains(value)
        };
        assert!(holds(&bounds, &values), "{values:?}, {bounds:?}: {tape:?}");
        for (bounds, value) in steep.d.d.iter().zip(&slants.d.d) {
            let smooth = (steep.v.jump | steep.v.partial | bounds.partial) >> lane & 1 == 0;
            assert!(!smooth || holds(bounds, value), "{value:?}, {bounds:?}: {tape:?}");
        }
    }
}

/// Roots ascend, those of a solid alternate, and their points can be computed.
fn roots_are_in_order(formula: &Formula, bytes: &mut Bytes<'_>) {
    let block = AxisBox::new(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
    let Ok(block) = block else { return };
    let Ok(surface) = Isosurface::new(formula, 0.0, Container::Box(block)) else { return };
    for _ in 0..2 {
        let origin = Point3::new(bytes.finite(), bytes.finite(), bytes.finite());
        let ray = Ray::new(origin, Point3::ORIGIN - origin + Vec3::new(0.1, bytes.finite() * 0.01, 0.03));
        if !ray.is_valid() {
            continue;
        }
        let ray = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
        let (local, mut all) = (LocalRay::new(&ray), All::default());
        surface.roots(&local, &mut all);
        let roots = all.roots;
        assert!(roots.windows(2).all(|w| w[0].t <= w[1].t), "{formula:?}, {ray:?}: {roots:?}");
        assert!(roots.iter().all(|r| r.lo <= r.t && r.t <= r.hi), "{formula:?}, {ray:?}: {roots:?}");
        if roots.iter().all(|r| r.kind == RootKind::Simple) && always_defined(formula) {
            let alternate = roots.iter().enumerate().all(|(i, r)| r.sign == if i % 2 == 0 { -1 } else { 1 });
            assert!(alternate && roots.len() % 2 == 0, "{formula:?}, {ray:?}: {roots:?}");
        }
        for root in roots.iter().take(4) {
            let point = surface.resolve(&local, root, Need::ALL);
            assert!(point.p.is_finite() && point.off > 0.0, "{formula:?}, {ray:?}: {point:?}");
        }
    }
}

/// Whether no step of the formula is ever undefined.
fn always_defined(formula: &Formula) -> bool {
    formula.ops().iter().all(|op| {
        matches!(
            op,
            Op::Input(_)
                | Op::Constant(_)
                | Op::Neg(_)
                | Op::Abs(_)
                | Op::Sqr(_)
                | Op::Add(..)
                | Op::Sub(..)
                | Op::Mul(..)
                | Op::Times(..)
                | Op::Min(..)
                | Op::Max(..)
                | Op::Noise(..)
                | Op::Nearest(..)
                | Op::Joined(_)
                | Op::Function(Function::Sin | Function::Cos | Function::Atan | Function::Tanh, _)
        )
    })
}
