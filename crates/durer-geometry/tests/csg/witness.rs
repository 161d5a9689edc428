//! Solids with the exact truth about them: the exact crossings of all leaves, merged exactly, and
//! the Boolean expression itself.

use core::cmp::Ordering;
use durer_geometry::{Compound, CompoundBuilder, Geometry, Part};
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::laws::exact::{Crossing, Exact, ExactBody, ExactForm, ExactLine, Oracle, Surd, exact3};
use durer_surfaces::{
    AxisBox, CappedCylinder, Complement, DynSurface, Placed, Plane, Quadric, RootKind, Side, Sphere,
};
use durer_testkit::TestRng;

/// A solid with its witness.
#[derive(Clone, Debug)]
pub(crate) enum Leaf {
    Ball(Point3, f64),
    Block(Point3, Point3),
    Half(Vec3, f64),
    /// From a point along an axis, so that its equation has f64 coefficients.
    Rod(Point3, usize, f64, f64),
    General([f64; 10]),
    Moved(Box<Leaf>, Affine),
    Turned(Box<Leaf>),
}

impl Leaf {
    pub(crate) fn witness(&self) -> ExactBody {
        match self {
            Leaf::Ball(c, r) => {
                let ball = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                let mut form = ExactForm::from_f64(ball);
                form.c = -Exact::from(*r).squared();
                ExactBody::solid(vec![form.translated(&exact3(c.to_array()))], *r, true)
            }
            Leaf::Block(a, b) => {
                let mut faces = Vec::new();
                for i in 0..3 {
                    let mut n = [0.0; 3];
                    n[i] = 1.0;
                    faces.push(ExactForm::half_space(exact3(n.map(|x| -x)), exact3(a.to_array())));
                    faces.push(ExactForm::half_space(exact3(n), exact3(b.to_array())));
                }
                ExactBody::solid(faces, (*b - *a).max_abs(), true)
            }
            Leaf::Half(n, d) => {
                // n.x <= d |n|, for normals whose length is a number.
                let form = ExactForm::half_space(exact3(n.to_array()), exact3([0.0; 3]));
                let form = ExactForm { c: -(Exact::from(*d) * Exact::from(n.length())), ..form };
                ExactBody::solid(vec![form], 1.0, true)
            }
            Leaf::Rod(c, axis, length, r) => {
                let mut k = [0.0; 10];
                let mut n = [0.0; 3];
                n[*axis] = 1.0;
                for (i, k) in k.iter_mut().take(3).enumerate() {
                    *k = if i == *axis { 0.0 } else { 1.0 };
                }
                let mut wall = ExactForm::from_f64(k);
                wall.c = -Exact::from(*r).squared();
                let wall = wall.translated(&exact3(c.to_array()));
                let mut end = *c;
                end[*axis] += length;
                let faces = vec![
                    wall,
                    ExactForm::half_space(exact3(n.map(|x| -x)), exact3(c.to_array())),
                    ExactForm::half_space(exact3(n), exact3(end.to_array())),
                ];
                ExactBody::solid(faces, r.max(*length), true)
            }
            Leaf::General(k) => ExactBody::solid(vec![ExactForm::from_f64(*k)], 2.0, false),
            Leaf::Moved(leaf, map) => leaf.witness().placed(map),
            Leaf::Turned(leaf) => leaf.witness(),
        }
    }

    pub(crate) fn is_turned(&self) -> bool {
        match self {
            Leaf::Moved(leaf, _) => leaf.is_turned(),
            Leaf::Turned(leaf) => !leaf.is_turned(),
            _ => false,
        }
    }

    pub(crate) fn add(&self, csg: &mut CompoundBuilder) -> Part {
        // Two arrays of leaves, one for balls and one for all else.
        match self {
            Leaf::Ball(c, r) => csg.leaf(Sphere::new(*c, *r).unwrap()),
            _ => csg.leaf(self.solid()),
        }
        .unwrap()
    }

    pub(crate) fn solid(&self) -> DynSurface {
        match self {
            Leaf::Ball(c, r) => DynSurface::new(Sphere::new(*c, *r).unwrap()),
            Leaf::Block(a, b) => DynSurface::new(AxisBox::new(*a, *b).unwrap()),
            Leaf::Half(n, d) => DynSurface::new(Plane::new(*n, *d).unwrap()),
            Leaf::Rod(c, axis, length, r) => {
                let mut end = *c;
                end[*axis] += length;
                DynSurface::new(CappedCylinder::new(*c, end, *r).unwrap())
            }
            Leaf::General(k) => DynSurface::new(Quadric::new(*k).unwrap()),
            Leaf::Moved(leaf, map) => DynSurface::new(Placed::new(leaf.solid(), *map)),
            Leaf::Turned(leaf) => DynSurface::new(Complement(leaf.solid())),
        }
    }
}

/// An expression over leaves by number.
#[derive(Clone, Debug)]
pub(crate) enum Expr {
    Leaf(usize),
    All(Vec<Expr>),
    Any(Vec<Expr>),
    AnyWithInner(Vec<Expr>),
    Minus(Box<Expr>, Vec<Expr>),
    Not(Box<Expr>),
}

impl Expr {
    pub(crate) fn holds(&self, bits: &[bool]) -> bool {
        match self {
            Expr::Leaf(i) => bits[*i],
            Expr::All(parts) => parts.iter().all(|p| p.holds(bits)),
            Expr::Any(parts) | Expr::AnyWithInner(parts) => parts.iter().any(|p| p.holds(bits)),
            Expr::Minus(a, others) => a.holds(bits) && !others.iter().any(|p| p.holds(bits)),
            Expr::Not(a) => !a.holds(bits),
        }
    }

    /// Whether a face of a leaf is visible where all other leaves have the values `bits`: `None` if
    /// the leaf is not in the expression, otherwise also whether the leaf's complement is.
    pub(crate) fn shows(&self, leaf: usize, inverted: bool, bits: &[bool]) -> Option<(bool, bool)> {
        let (parts, taken_away, rule): (Vec<&Expr>, usize, _) = match self {
            Expr::Leaf(i) => return (*i == leaf).then_some((true, inverted)),
            Expr::Not(part) => return part.shows(leaf, !inverted, bits),
            Expr::All(parts) => (parts.iter().collect(), usize::MAX, "all"),
            Expr::Any(parts) => (parts.iter().collect(), usize::MAX, "any"),
            Expr::AnyWithInner(parts) => (parts.iter().collect(), usize::MAX, "any with inner"),
            Expr::Minus(a, others) => (core::iter::once(&**a).chain(others).collect(), 1, "all"),
        };
        let own = |i: usize| inverted != (i >= taken_away);
        let (at, (is_visible, is_inverted)) =
            parts.iter().enumerate().find_map(|(i, p)| Some((i, p.shows(leaf, own(i), bits)?)))?;
        let mut others =
            parts.iter().enumerate().filter(|(i, _)| *i != at).map(|(i, p)| p.holds(bits) != own(i));
        let is_intersection = (rule == "all") != inverted;
        let agree = if is_intersection {
            others.all(|holds| holds)
        } else {
            rule == "any with inner" || !others.any(|holds| holds)
        };
        Some((is_visible && agree, is_inverted))
    }

    /// Turns every other union into one with inner faces.
    pub(crate) fn with_inner_faces(self, dice: &mut TestRng) -> Expr {
        let mut each =
            |parts: Vec<Expr>| parts.into_iter().map(|p| p.with_inner_faces(dice)).collect::<Vec<_>>();
        match self {
            Expr::Leaf(i) => Expr::Leaf(i),
            Expr::All(parts) => Expr::All(each(parts)),
            Expr::Any(parts) | Expr::AnyWithInner(parts) => {
                let parts = each(parts);
                if dice.below(3) == 0 { Expr::Any(parts) } else { Expr::AnyWithInner(parts) }
            }
            Expr::Minus(a, others) => {
                let others = each(others);
                Expr::Minus(Box::new(a.with_inner_faces(dice)), others)
            }
            Expr::Not(a) => Expr::Not(Box::new(a.with_inner_faces(dice))),
        }
    }

    pub(crate) fn build(&self, leaves: &mut [Option<Part>], csg: &mut CompoundBuilder) -> Part {
        match self {
            Expr::Leaf(i) => leaves[*i].take().unwrap(),
            Expr::All(parts) => {
                let parts: Vec<Part> = parts.iter().map(|p| p.build(leaves, csg)).collect();
                csg.intersection(parts)
            }
            Expr::Any(parts) => {
                let parts: Vec<Part> = parts.iter().map(|p| p.build(leaves, csg)).collect();
                csg.union(parts)
            }
            Expr::AnyWithInner(parts) => {
                let parts: Vec<Part> = parts.iter().map(|p| p.build(leaves, csg)).collect();
                csg.union_with_inner_faces(parts)
            }
            Expr::Minus(a, others) => {
                let a = a.build(leaves, csg);
                let others: Vec<Part> = others.iter().map(|p| p.build(leaves, csg)).collect();
                csg.difference(a, others)
            }
            Expr::Not(a) => {
                let a = a.build(leaves, csg);
                csg.inverse(a)
            }
        }
    }
}

pub(crate) fn random_expr(dice: &mut TestRng, first: usize, count: usize) -> Expr {
    if count == 1 {
        let leaf = Expr::Leaf(first);
        return if dice.below(8) == 0 { Expr::Not(Box::new(leaf)) } else { leaf };
    }
    let mut cuts = vec![0, count];
    for _ in 0..=dice.below(3) {
        cuts.push(dice.below(count as u64 + 1) as usize);
    }
    cuts.sort_unstable();
    cuts.dedup();
    let mut parts: Vec<Expr> = cuts
        .windows(2)
        .map(|w| {
            if w[1] - w[0] == count {
                Expr::All(vec![random_expr(dice, first, 1), random_expr(dice, first + 1, count - 1)])
            } else {
                random_expr(dice, first + w[0], w[1] - w[0])
            }
        })
        .collect();
    match dice.below(4) {
        0 => Expr::All(parts),
        1 => Expr::Any(parts),
        2 => {
            let rest = parts.split_off(1);
            Expr::Minus(Box::new(parts.remove(0)), rest)
        }
        _ => Expr::Not(Box::new(Expr::All(parts))),
    }
}

/// A CSG solid with its witnesses.
pub(crate) struct Body {
    pub(crate) scene: Geometry,
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) witnesses: Vec<ExactBody>,
    pub(crate) expr: Expr,
    /// Whether unions keep inner faces. Then crossings need not alternate between in and out.
    pub(crate) has_inner_faces: bool,
}

pub(crate) fn body(leaves: Vec<Leaf>, expr: Expr) -> Body {
    let mut csg = Compound::builder();
    let mut parts: Vec<Option<Part>> = leaves.iter().map(|l| Some(l.add(&mut csg))).collect();
    let whole = expr.build(&mut parts, &mut csg);
    let scene = Geometry::builder().with_compound(csg.build(whole).unwrap()).build().unwrap();
    let witnesses = leaves.iter().map(Leaf::witness).collect();
    let has_inner_faces = format!("{expr:?}").contains("AnyWithInner");
    Body { scene, leaves, witnesses, expr, has_inner_faces }
}

/// An exact crossing of the CSG solid.
pub(crate) struct Truth {
    pub(crate) t: Surd,
    pub(crate) sign: i8,
}

/// Crossings of leaves that are closer than this, but not equal, may form a tie.
const CLOSE: i64 = 36;

impl Body {
    /// All crossings of the line `t >= 0`; `None` where distinct ones are so close that they may
    /// form a tie.
    pub(crate) fn truth(&self, ray: &Ray) -> Option<Vec<Truth>> {
        let line = ExactLine::new(ray);
        let zero = Exact::zero();
        let mut events: Vec<(usize, Crossing)> = Vec::new();
        let mut bits = Vec::new();
        for (i, w) in self.witnesses.iter().enumerate() {
            let all = w.crossings(&line);
            let (before, ahead): (Vec<_>, Vec<_>) =
                all.into_iter().partition(|c| c.t.cmp_exact(&zero).is_lt());
            if ahead.iter().any(|c| c.grazing) {
                return None;
            }
            let last = before.iter().rev().find(|c| !c.grazing).map(|c| c.sign < 0);
            let first = ahead.first().map(|c| c.sign > 0);
            let start = || w.side(&line.o).is_some_and(Ordering::is_lt);
            if first.is_none() && last.is_none() && w.side(&line.o).is_some_and(Ordering::is_eq) {
                // The line lies in the surface.
                return None;
            }
            bits.push(first.or(last).unwrap_or_else(start));
            events.extend(ahead.into_iter().map(|c| (i, c)));
        }
        let value = |t: &Surd| t.about(400);
        let close =
            |a: &Surd, b: &Surd, bits: i64| (&value(a) - &value(b)).abs().shifted(bits).to_f64() < 1.0;
        events.sort_by(|a, b| (&value(&a.1.t) - &value(&b.1.t)).sign());
        let state = |bits: &[bool]| {
            let told: Vec<bool> = bits.iter().zip(&self.leaves).map(|(b, l)| *b != l.is_turned()).collect();
            self.expr.holds(&told)
        };
        let mut out = Vec::new();
        let mut i = 0;
        while i < events.len() {
            let mut end = i + 1;
            while end < events.len() && close(&events[i].1.t, &events[end].1.t, 380) {
                end += 1;
            }
            if end < events.len() && close(&events[i].1.t, &events[end].1.t, CLOSE) {
                return None;
            }
            if self.has_inner_faces && end > i + 1 {
                return None;
            }
            let before = state(&bits);
            for (leaf, crossing) in &events[i..end] {
                bits[*leaf] = crossing.sign < 0;
            }
            let after = state(&bits);
            if before != after {
                out.push(Truth { t: events[i].1.t.clone(), sign: if after { -1 } else { 1 } });
            } else if self.has_inner_faces {
                let (leaf, crossing) = &events[i];
                let told: Vec<bool> =
                    bits.iter().zip(&self.leaves).map(|(b, l)| *b != l.is_turned()).collect();
                let (is_visible, is_inverted) = self.expr.shows(*leaf, false, &told).unwrap();
                // The sign of the leaf's own solid, which may be a complement twice.
                let flip = is_inverted != self.leaves[*leaf].is_turned();
                if is_visible {
                    let sign = if flip { -crossing.sign } else { crossing.sign };
                    out.push(Truth { t: crossing.t.clone(), sign });
                }
            }
            i = end;
        }
        Some(out)
    }

    /// Compares every query with the truth; returns how many hits were compared.
    pub(crate) fn check(&self, ray: &Ray) -> usize {
        let Some(truth) = self.truth(ray) else { return 0 };
        let hits = self.scene.all(ray);
        let told = || {
            let exact: Vec<_> = truth.iter().map(|c| (c.t.about(200).to_f64(), c.sign)).collect();
            format!("{ray:?}\nfound {hits:?}\nexact {exact:?}\n{:?}", self.expr)
        };
        assert_eq!(hits.len(), truth.len(), "{}", told());
        for (hit, exact) in hits.iter().zip(&truth) {
            assert_eq!(hit.sign, exact.sign, "{}", told());
            assert_eq!(hit.kind, RootKind::Simple, "{}", told());
            assert!(exact.t.cmp_exact(&hit.t_lo.into()).is_ge(), "{}", told());
            assert!(exact.t.cmp_exact(&hit.t_hi.into()).is_le(), "{}", told());
            assert!(hit.t_lo <= hit.t && hit.t <= hit.t_hi, "{}", told());
        }
        assert_eq!(self.scene.closest(ray), hits.first().copied(), "{}", told());
        assert_eq!(self.scene.any(ray), !hits.is_empty(), "{}", told());
        if self.has_inner_faces {
            return hits.len();
        }
        // The ends of spans alternate: in, out.
        let spans = self.scene.spans(ray);
        let ends: Vec<f64> = spans
            .iter()
            .flat_map(|s| {
                let a = s.object_in.map(|_| s.t_in);
                let b = s.object_out.map(|_| s.t_out);
                a.into_iter().chain(b)
            })
            .collect();
        // A range that begins where the solid ends contains nothing of it.
        let all: Vec<f64> = hits
            .iter()
            .enumerate()
            .filter(|(i, h)| *i > 0 || h.sign < 0 || h.t > 0.0)
            .map(|x| x.1.t)
            .collect();
        assert_eq!(ends, all, "{}", told());
        if all.len() < hits.len() {
            return hits.len();
        }
        let starts_inside = spans.first().is_some_and(|s| s.object_in.is_none());
        match truth.first() {
            Some(first) => assert_eq!(starts_inside, first.sign > 0, "{}", told()),
            None => {
                let side = self.scene.side(ray.origin);
                assert!(side == Side::On || starts_inside == (side == Side::In), "{}", told());
            }
        }
        for hit in &hits {
            let point = self.scene.resolve(ray, hit);
            let along = point.ng.to_vec().dot(ray.direction);
            assert!(along * f64::from(hit.sign) > -1e-6, "{along} {}", told());
        }
        hits.len()
    }
}
