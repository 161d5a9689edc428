//! Open NURBS with a crease, and lines nearly in the plane of one side of it, against exact arithmetic.

use super::*;

/// A NURBS of two patches with a crease between them, and the patches.
fn creased(dice: &mut TestRng) -> Option<(Nurbs, [BezierPatch; 2])> {
    let [p, q] = [1 + dice.below(3) as usize, 1 + dice.below(3) as usize];
    let size = [2 * p + 1, q + 1];
    let weighted = dice.once_in(3);
    let mut points = Vec::new();
    for j in 0..size[1] {
        for i in 0..size[0] {
            let at = Vec3::new(i as f64, j as f64, 0.0) * 4.0 + dice.lattice(6);
            let w = if weighted { dice.pick(&[1.0, 2.0, 0.5]) } else { 1.0 };
            points.push([at.x * 0.125, at.y * 0.125, at.z * 0.125, w]);
        }
    }
    if dice.once_in(2) {
        // One side is flat.
        for j in 0..size[1] {
            for i in 0..=p {
                points[j * size[0] + i][2] = 0.0;
            }
        }
    }
    let ends = |n: usize, inner: &[f64]| {
        let mut knots = vec![0.0; n + 1];
        knots.extend(inner);
        knots.extend(vec![2.0; n + 1]);
        knots
    };
    let part = |from: usize| {
        let of = |j: usize| points[j * size[0] + from..j * size[0] + from + p + 1].to_vec();
        BezierPatch::rational([p + 1, q + 1], &(0..=q).flat_map(of).collect::<Vec<_>>()).ok()
    };
    let sides = [part(0)?, part(p)?];
    let data = NurbsData {
        degree: [p, q],
        size,
        knots: [ends(p, &vec![1.0; p]), ends(q, &[])],
        points: points.clone(),
        ..NurbsData::default()
    };
    Some((Nurbs::new(data).ok()?, sides))
}

/// A line that surely meets one side meets the surface there.
#[test]
fn a_crossing_beside_a_crease_is_not_missed() {
    let (mut lines, mut places, mut both, mut fewer) = (0_u64, 0, 0, 0);
    for case in drawn(40) {
        let mut dice = crate::laws::dice(89, case);
        let Some((nurbs, sides)) = creased(&mut dice) else { continue };
        assert_eq!(nurbs.patches(), 2);
        for _ in 0..10 {
            let v = dice.pick(&[0.0, 0.25, 0.5, 0.625, 1.0]);
            let k = dice.below(2) as usize;
            let shell = sides[k].shell();
            let jet = shell.faces[0].jet([1.0 - k as f64, v]);
            let scale = durer_math::scale::ldexp(1.0, shell.scale);
            let target = shell.centre + jet.p * scale;
            let along = jet.pu * dice.between(-1.0, 1.0) + jet.pv * dice.between(-1.0, 1.0);
            let away = |dice: &mut TestRng, low: i32| match dice.below(3) {
                0 => Vec3::ZERO,
                _ => dice.vector() * dice.scale(low, -20),
            };
            let direction = along + away(&mut dice, -54) * along.length();
            if direction == Vec3::ZERO {
                continue;
            }
            let origin = target + away(&mut dice, -56) * scale - direction * dice.pick(&[0.0, 1.0, 4.0]);
            let ray = Ray::new(origin, direction).with_range(-1e9, 1e9);
            let roots = all_roots(&nurbs, &ray);
            lines += 1;
            let mut count = 0;
            for side in &sides {
                let witness = side.witness(&ray);
                let Some(found) = witness.places() else { continue };
                for place in found.iter().filter(|p| p.proven && BezierPatch::has(p)) {
                    count += 1;
                    let is_told = roots.iter().any(|r| witness.fits(place, r.lo, r.hi));
                    assert!(is_told, "{case}: {place:?} is missing from {roots:?} {ray:?} {nurbs:?}");
                }
            }
            places += count;
            both += u64::from(count > 1);
            fewer += u64::from(count > roots.len());
        }
    }
    println!("{lines} lines, {places} crossings; {both} lines with two or more, {fewer} told less often");
    assert!(places > 100);
    report(lines);
}
