//! Laws for the roots of any solid.

use durer_math::{Point3, Ray};
use durer_surfaces::algebraic::{coefficient_count, place_of};
use durer_surfaces::{AlgebraicSurface, LocalPoint, Root, RootKind, Side, Surface};

/// Brackets overlap one by one if all roots are certain; otherwise the sums of signs are equal.
pub(crate) fn same(a: &[Root], b: &[Root]) -> bool {
    let sure = |roots: &[Root]| roots.iter().all(|r| r.kind == RootKind::Simple);
    if sure(a) && sure(b) {
        return a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign);
    }
    let net = |roots: &[Root]| roots.iter().map(|r| i32::from(r.sign)).sum::<i32>();
    net(a) == net(b)
}

/// A polynomial by its terms.
pub(crate) fn polynomial(order: u32, terms: &[([u32; 3], f64)]) -> AlgebraicSurface {
    let mut list = vec![0.0; coefficient_count(order)];
    for &(powers, value) in terms {
        list[place_of(order, powers)] = value;
    }
    AlgebraicSurface::new(order, &list).unwrap()
}

/// Signs of roots alternate, and samples of the rounded formula find no change of sign without a
/// root.
pub(crate) fn holds_together<S: Surface>(
    surface: &S,
    ray: &Ray,
    roots: &[Root],
    value: impl Fn(Point3) -> f64,
) {
    let signs: Vec<_> = roots.iter().filter(|r| r.sign != 0).map(|r| r.sign).collect();
    assert!(
        signs.iter().enumerate().all(|(i, &s)| s == if i % 2 == 0 { -1 } else { 1 }),
        "{ray:?}: {roots:?}"
    );
    assert_eq!(signs.len() % 2, 0, "{ray:?}: {roots:?}");
    let middle = roots.iter().map(|r| r.t).sum::<f64>() / roots.len().max(1) as f64;
    let middle = if roots.is_empty() {
        -ray.origin.to_vec().dot(ray.direction) / ray.direction.dot(ray.direction)
    } else {
        middle
    };
    let reach = 3.0 / ray.direction.length();
    for i in 0..400 {
        let t = middle + reach * (f64::from(i) / 200.0 - 1.0);
        let p = ray.at(t);
        let v = value(p);
        // Within the rounding of the point and of the value.
        if t < 0.0 || v.abs() < 1e-6 || ray.origin.to_vec().length() > 1e3 {
            continue;
        }
        let crossed = roots.iter().filter(|r| r.t < t).map(|r| i32::from(r.sign)).sum::<i32>();
        let near = roots.iter().any(|r| (r.t - t).abs() * ray.direction.length() < 1e-9);
        assert!(near || (crossed < 0) == (v < 0.0), "{ray:?} at {t}: {v}, {roots:?}");
        let side = surface.side(&LocalPoint::new(p));
        assert_eq!(side, if v < 0.0 { Side::In } else { Side::Out }, "{p:?}");
    }
}
