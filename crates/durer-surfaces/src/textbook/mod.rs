//! The textbook forms: how one learns to intersect a triangle, a sphere and a box, in plain f64.
//!
//! Each function is one page: the formula, the code that follows it letter by letter, what goes
//! wrong with it on a computer, and which part of this crate cures that. The tests use them as
//! second witnesses: where a problem is well-conditioned they must agree with the exact kernels up
//! to the rounding that their text admits.
//!
//! | form | function | what goes wrong | cure |
//! |---|---|---|---|
//! | triangle, by its plane | [`triangle_by_plane`] | the edge test sees a rounded point: neighbours leak | [`Triangle`](crate::Triangle), [`Mesh`](crate::Mesh) |
//! | triangle, by its edges | [`triangle_by_edges`] | signs of rounded volumes; ties counted twice | the same |
//! | sphere, algebraic | [`sphere_algebraic`] | `b^2 - 4ac` cancels when the sphere is far | [`LocalRay::recentre`](crate::LocalRay::recentre) |
//! | sphere, geometric | [`sphere_geometric`] | still sees the distance through `t` and the foot point | the same |
//! | box, by slabs | [`box_by_slabs`] | 0/0: a ray in a face is lost; ties by chance | [`AxisBox`](crate::AxisBox) |

mod slabs;
mod sphere;
mod triangle;

pub use slabs::box_by_slabs;
pub use sphere::{sphere_algebraic, sphere_geometric};
pub use triangle::{triangle_by_edges, triangle_by_plane};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{TestRng, all_roots};
    use crate::{AxisBox, Surface, Triangle};
    use durer_math::{Point3, Ray, Vec3};

    /// Rays from a few sizes away towards the unit cube about the origin.
    fn ray(dice: &mut TestRng) -> Ray {
        let target = dice.vector().to_point();
        let direction = dice.vector();
        Ray::new(target - direction * dice.between(2.0, 5.0), direction)
            .with_range(f64::NEG_INFINITY, f64::INFINITY)
    }

    /// Whether a textbook `t` is the production one, up to rounding: `1e-9` is a million times the
    /// rounding of these sizes, and a millionth of what a wrong formula would show.
    fn agrees(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * b.abs().max(1.0)
    }

    #[test]
    fn both_triangles_agree_with_production_away_from_edges() {
        let mut dice = TestRng::new(11);
        let (mut met, mut missed) = (0, 0);
        for _ in 0..20_000 {
            let v = core::array::from_fn(|_| dice.vector().to_point());
            let ray = ray(&mut dice);
            let Ok(triangle) = Triangle::new(v) else { continue };
            let n = (v[1] - v[0]).cross(v[2] - v[0]);
            // Well-conditioned: not edge-on, not a sliver.
            if n.dot(ray.direction).abs() < 1e-3 {
                continue;
            }
            let roots = all_roots(&triangle, &ray);
            let answers = [triangle_by_plane(&v, &ray), triangle_by_edges(&v, &ray)];
            if let Some(root) = roots.first() {
                let [b1, b2] = root.tag;
                if b1.min(b2).min(1.0 - b1 - b2) < 1e-6 {
                    continue;
                }
                met += 1;
                assert!(answers.iter().all(|t| t.is_some_and(|t| agrees(t, root.t))), "{answers:?} {root:?}");
            } else if answers != [None, None] {
                // Only a ray that all but meets an edge may be told differently.
                let t = answers[0].or(answers[1]).unwrap();
                let p = ray.at(t);
                let near = (0..3).any(|i| {
                    let (a, e) = (v[i], v[(i + 1) % 3] - v[i]);
                    (p - a).cross(e).length() < 1e-9 * e.length()
                });
                assert!(near, "{answers:?} for {ray:?} and {v:?}");
            } else {
                missed += 1;
            }
        }
        assert!(met > 500 && missed > 5000, "{met} {missed}");
    }

    #[test]
    fn both_spheres_agree_with_each_other_nearby() {
        let mut dice = TestRng::new(12);
        let mut met = 0;
        for _ in 0..20_000 {
            let (ray, radius) = (ray(&mut dice), dice.between(0.5, 1.5));
            let (a, b) = (
                sphere_algebraic(Point3::ORIGIN, radius, &ray),
                sphere_geometric(Point3::ORIGIN, radius, &ray),
            );
            let grazing = a.or(b).is_some_and(|[t0, t1]| (t1 - t0) * ray.direction.length() < 1e-3);
            if !grazing {
                assert_eq!(a.is_some(), b.is_some(), "{ray:?} {radius}");
            }
            if let (Some(a), Some(b), false) = (a, b, grazing) {
                met += 1;
                assert!(agrees(a[0], b[0]) && agrees(a[1], b[1]), "{a:?} {b:?}");
            }
        }
        assert!(met > 5000, "{met}");
    }

    #[test]
    fn slabs_agree_with_production() {
        let mut dice = TestRng::new(13);
        let mut met = 0;
        for _ in 0..20_000 {
            let (a, b) = (dice.vector().to_point(), dice.vector().to_point());
            let Ok(solid) = AxisBox::new(a, b) else { continue };
            let ray = ray(&mut dice);
            let roots = all_roots(&solid, &ray);
            let bounds = solid.bounds();
            let answer = box_by_slabs(bounds.min, bounds.max, &ray);
            // Chords shorter than the rounding may be told differently.
            match (roots.as_slice(), answer) {
                ([enter, leave], Some([t0, t1])) => {
                    met += 1;
                    assert!(agrees(t0, enter.t) && agrees(t1, leave.t), "{roots:?} {answer:?}");
                }
                (roots, Some([t0, t1])) => assert!(agrees(t0, t1), "{roots:?} {answer:?}"),
                ([enter, leave], None) => assert!(agrees(enter.t, leave.t), "{roots:?}"),
                _ => {}
            }
        }
        assert!(met > 2000, "{met}");
    }

    #[test]
    fn slabs_lose_the_ray_in_a_face_and_production_does_not() {
        let (lo, hi) = (Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0));
        let ray = Ray::new(Point3::new(-1.0, 0.0, 0.5), Vec3::X);
        assert_eq!(box_by_slabs(lo, hi, &ray), None);
        assert_eq!(all_roots(&AxisBox::new(lo, hi).unwrap(), &ray).len(), 2);
    }

    #[test]
    fn the_plane_form_leaks_where_the_mesh_does_not() {
        // Two triangles share an edge at an angle; rays are aimed at it from far away.
        let v = [[0.1, 0.2, 0.0], [0.7, 0.9, 0.3], [0.9, 0.1, 0.5], [0.0, 0.8, -0.4]].map(Point3::from);
        let mesh = crate::Mesh::new(crate::MeshData {
            vertices: v.to_vec(),
            faces: vec![[0, 2, 1], [0, 1, 3]],
            ..crate::MeshData::default()
        })
        .unwrap();
        let (one, two) = ([v[0], v[2], v[1]], [v[0], v[1], v[3]]);
        let mut dice = TestRng::new(14);
        let (mut leaks, mut production) = (0, 0);
        for _ in 0..3000 {
            let at = v[0] + (v[1] - v[0]) * dice.between(0.1, 0.9);
            let direction = Vec3::new(dice.between(-0.2, 0.2), dice.between(-0.2, 0.2), -1.0);
            let ray = Ray::new(at - direction * 1e5, direction);
            leaks += usize::from(
                triangle_by_plane(&one, &ray).is_none() && triangle_by_plane(&two, &ray).is_none(),
            );
            production += usize::from(all_roots(&mesh, &ray).is_empty());
        }
        assert!(leaks > 0, "the text claims that it leaks");
        assert_eq!(production, 0);
    }
}
