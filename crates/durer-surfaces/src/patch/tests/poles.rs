//! Poles: edges that are one point.

use super::*;

/// At a pole of a sphere nothing can be proven: slopes along the collapsed edge are zero. Brackets are as
/// narrow as the place of the line allows there: with the tangent plane at a height `h` within the errors
/// a line at an angle `a` is in doubt as far as `h / a`, and where it is a tangent as far as `h`'s root.
#[test]
fn brackets_at_a_pole_are_narrow() {
    let sphere = sphere();
    let (mut steep, mut flat, mut uncertain) = (0.0_f64, 0.0_f64, 0_u64);
    for case in drawn(1500) {
        let mut dice = crate::laws::dice(97, case);
        let mut direction = dice.vector();
        direction.y *= if dice.once_in(3) { 0.0 } else { dice.scale(-40, 0) };
        direction.x *= if dice.once_in(3) { dice.scale(-56, 0) } else { 1.0 };
        let off = dice.vector() * dice.pick(&[0.0, 1.0]) * dice.scale(-60, -30);
        let pole = Point3::new(0.0, dice.pick(&[1.0, -1.0]), 0.0);
        if direction == Vec3::ZERO {
            continue;
        }
        let origin = pole + off - direction * dice.pick(&[0.0, 1.0, 4.0]);
        let ray = Ray::new(origin, direction).with_range(-1e9, 1e9);
        for root in all_roots(&sphere, &ray).iter().filter(|root| root.kind != RootKind::Simple) {
            let tilt = direction.y.abs() / direction.length();
            let wide = (root.hi - root.lo) * direction.length();
            uncertain += 1;
            steep = steep.max(wide * tilt);
            flat = flat.max(wide);
        }
    }
    println!("{uncertain} uncertain, at most {} roundings over the angle, {flat} wide", steep / U);
    assert!(uncertain > 100 && steep <= 1024.0 * U && flat <= 32.0 * (512.0 * U).sqrt(), "{steep} {flat}");
    report(uncertain);
}
