//! The laws of spans: ordered, apart, inside where they say and outside where they do not.

mod common;

use common::{Dice, fill, ground, rays};
use durer_geometry::Geometry;
use durer_math::{Point3, Ray, Vec3};
use durer_surfaces::{AxisBox, Disc, Side, Sphere};

/// A point of the ray in the middle of a stretch, if the stretch is long enough for rounding not to matter.
fn middle(ray: &Ray, a: f64, b: f64) -> Option<Point3> {
    let (a, b) = (a.max(-100.0), b.min(100.0));
    ((b - a) * ray.direction.length() > 1e-6).then(|| ray.at(0.5 * (a + b)))
}

fn check(world: &Geometry, ray: &Ray) -> usize {
    let spans = world.spans(ray);
    let mut at = ray.t_min;
    for (i, span) in spans.iter().enumerate() {
        assert!(at <= span.t_in && span.t_in <= span.t_out && span.t_out <= ray.t_max, "{spans:?}");
        assert!(i == 0 || at < span.t_in || spans[i - 1].t_out == at, "{spans:?}");
        assert_eq!(span.object_in.is_none(), i == 0 && span.t_in == ray.t_min && span.object_in.is_none());
        if let Some(p) = middle(ray, at, span.t_in) {
            assert_ne!(world.side(p), Side::In, "a gap of {spans:?} of {ray:?} is inside");
        }
        if let Some(p) = middle(ray, span.t_in, span.t_out) {
            assert_ne!(world.side(p), Side::Out, "a span of {spans:?} of {ray:?} is outside");
        }
        at = span.t_out;
    }
    if let Some(p) = middle(ray, at, ray.t_max) {
        assert_ne!(world.side(p), Side::In, "behind {spans:?} of {ray:?} it is inside");
    }
    // Each end is a crossing that all crossings know of.
    let all = world.all(ray);
    for span in &spans {
        for (t, object) in [(span.t_in, span.object_in), (span.t_out, span.object_out)] {
            if let Some(object) = object {
                assert!(all.iter().any(|h| h.t == t && (h.t_lo..=h.t_hi).contains(&t)), "{object:?} at {t}");
            }
        }
    }
    spans.len()
}

#[test]
fn spans_are_where_the_solids_are() {
    let mut spans = 0;
    for seed in 0..8 {
        let mut builder = Geometry::builder();
        fill(&mut builder, &mut Dice(seed), 40, seed % 2 == 0);
        if seed > 5 {
            builder.add(ground());
        }
        let world = builder.build().unwrap();
        for ray in rays(&mut Dice(50 + seed), 200) {
            spans += check(&world, &ray);
        }
    }
    assert!(spans > 800, "{spans}");
}

#[test]
fn ranges_that_begin_and_end_inside() {
    let world = Geometry::builder().add(Sphere::new(Point3::ORIGIN, 2.0).unwrap()).build().unwrap();
    let ray = |a: f64, b: f64| Ray::new(Point3::ORIGIN, Vec3::X).with_range(a, b);
    let spans = |a: f64, b: f64| {
        let all = world.spans(&ray(a, b));
        all.iter()
            .map(|s| (s.t_in, s.t_out, s.object_in.is_some(), s.object_out.is_some()))
            .collect::<Vec<_>>()
    };
    assert_eq!(spans(-5.0, 5.0), [(-2.0, 2.0, true, true)]);
    assert_eq!(spans(-1.0, 5.0), [(-1.0, 2.0, false, true)]);
    assert_eq!(spans(-5.0, 1.0), [(-2.0, 1.0, true, false)]);
    assert_eq!(spans(-1.0, 1.0), [(-1.0, 1.0, false, false)]);
    assert_eq!(spans(2.5, 5.0), []);
    assert_eq!(spans(-5.0, -3.0), []);
    // Its own ends: entering exactly at the start, leaving exactly at the start.
    assert_eq!(spans(-2.0, 1.0), [(-2.0, 1.0, true, false)]);
    assert_eq!(spans(2.0, 5.0), []);
}

#[test]
fn boxes_that_share_a_face_are_one() {
    let unit = |x: f64| AxisBox::new(Point3::new(x, 0.0, 0.0), Point3::new(x + 1.0, 1.0, 1.0)).unwrap();
    let mut builder = Geometry::builder();
    (0..10).for_each(|i| _ = builder.add(unit(f64::from(i))));
    builder.add(Disc::new(Point3::new(5.5, 0.5, 0.5), Vec3::X, 2.0).unwrap());
    let world = builder.build().unwrap();
    let spans = world.spans(&Ray::new(Point3::new(-3.0, 0.3, 0.7), Vec3::X));
    assert_eq!(spans.len(), 1);
    assert_eq!((spans[0].t_in, spans[0].t_out), (3.0, 13.0));
    assert_eq!((spans[0].object_in.map(|o| o.0), spans[0].object_out.map(|o| o.0)), (Some(0), Some(9)));
    // Slantwise too, where the crossings are rounded.
    let spans = world.spans(&Ray::new(Point3::new(-3.0, 0.1, 0.2), Vec3::new(1.0, 0.03, 0.031)));
    assert_eq!(spans.len(), 1);
    // The disc is open: it is hit, but holds nothing.
    assert_eq!(world.all(&Ray::new(Point3::new(-3.0, 1.5, 0.5), Vec3::X)).len(), 1);
    assert!(world.spans(&Ray::new(Point3::new(-3.0, 1.5, 0.5), Vec3::X)).is_empty());
}
