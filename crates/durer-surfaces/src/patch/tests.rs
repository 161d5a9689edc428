//! Tests of patches.

use super::*;
use crate::laws::all_roots;
use durer_math::{Ray, Vec3};

#[test]
fn a_saddle_is_met_once() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    let patch = BezierPatch::new([2, 2], &corners.map(Point3::from)).unwrap();
    for (x, y) in [(0.5, 0.25), (0.0, 0.0), (1.0, 1.0), (1.0, 0.5), (0.5, 0.5), (0.25, 0.75)] {
        let ray = Ray::new(Point3::new(x, y, 2.0), Vec3::new(0.0, 0.0, -1.0));
        let roots = all_roots(&patch, &ray);
        assert_eq!(roots.len(), 1, "{x} {y} {roots:?}");
        let t = 2.0 - x * y;
        assert!(roots[0].lo <= t && t <= roots[0].hi, "{x} {y} {roots:?}");
        assert!(roots[0].hi - roots[0].lo < 64.0 * f64::EPSILON, "{x} {y} {roots:?}");
        assert_eq!(roots[0].sign, -1);
    }
}
