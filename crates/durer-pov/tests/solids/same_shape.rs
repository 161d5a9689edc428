//! One solid written in several ways: the same rays meet it at the same places.

use super::{Draws, lowered};
use durer_math::Ray;
use durer_testkit::TestRng;

/// Each line shows exactly the same set of points.
const WAYS: [&[&str]; 9] = [
    &[
        "cylinder { 0, 2*y, 1 }",
        "lathe { linear_spline 4, <0, 0>, <1, 0>, <1, 2>, <0, 2> }",
        "lathe { linear_spline 5, <0, 2>, <1, 2>, <1, 0.75>, <1, 0>, <0, 0> }",
    ],
    &["cone { 0, 1, 2*y, 0 }", "lathe { linear_spline 3, <0, 0>, <1, 0>, <0, 2> }"],
    &["sphere { <0.5, 0, 0>, 1 }", "sphere_sweep { linear_spline 2, 0.5*x, 1, <0.5, 0.25, 0>, 0.5 }"],
    &[
        "merge { cylinder { -y, y, 0.5 } sphere { -y, 0.5 } sphere { y, 0.5 } }",
        "sphere_sweep { linear_spline 2, -y, 0.5, y, 0.5 }",
        "sphere_sweep { linear_spline 3, y, 0.5, 0.25*y, 0.5, -y, 0.5 }",
        "sphere_sweep { cubic_spline 4, -3*y, 0.5, -y, 0.5, y, 0.5, 3*y, 0.5 }",
    ],
    &[
        "paraboloid { 1, 1, from 0 to 2.25 rotate x*-90 }",
        "lathe { bezier_spline 8, <0, 0>, <0.5, 0>, <1, 0.75>, <1.5, 2.25>, <1.5, 2.25>, <1, 2.25>, <0.5, 2.25>, <0, 2.25> }",
    ],
    &[
        "box { -1, 1 }",
        "sweep { profile linear_spline 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> path linear_spline 2, -y, y }",
        "sweep { profile linear_spline 5, <-2, -2>, <2, -2>, <2, 2>, <-2, 2>, <-2, -2> path linear_spline 2, x, -x up y size 2, 0.5, 0.5 }",
        "prism { -1, 1, 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> }",
    ],
    &[
        "prism { conic_sweep 0.5, 2, 4, <-0.5, -0.5>, <0.5, -0.5>, <0.25, 0.5>, <-0.5, -0.5> }",
        "sweep { profile linear_spline 4, <-0.5, 0.5>, <0.5, 0.5>, <0.25, -0.5>, <-0.5, 0.5> path linear_spline 2, 0.5*y, 2*y size 2, 0.5, 2 }",
    ],
    &[
        "prism { bezier_spline -0.5, 1, 8, <0.5, 0>, <0.5, 0.5>, <-0.5, 0.5>, <-0.5, 0>, <-0.5, 0>, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0> rotate x*-90 }",
        "sweep { profile bezier_spline 8, <0.5, 0>, <0.5, 0.5>, <-0.5, 0.5>, <-0.5, 0>, <-0.5, 0>, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0> path linear_spline 2, 0.5*z, -z up y }",
    ],
    &[
        "difference { box { -1, 1 } box { <-0.25, -0.25, -2>, <0.25, 0.25, 2> } }",
        "sweep { profile linear_spline 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1>, linear_spline 5, <-0.25, -0.25>, <0.25, -0.25>, <0.25, 0.25>, <-0.25, 0.25>, <-0.25, -0.25> path linear_spline 2, -z, z }",
    ],
];

#[test]
fn one_solid_written_in_several_ways_is_met_at_the_same_places() {
    let mut dice = TestRng::new(37);
    for ways in WAYS {
        let scenes: Vec<_> = ways.iter().map(|text| lowered(text)).collect();
        let (mut met, mut rays) = (0, 0);
        while rays < 400 {
            // In general position: where a ray runs along a face or through an edge, each kind of
            // surface has a rule of its own.
            let d = dice.dyadic().to_vec();
            let ray = Ray::new(dice.dyadic() - d * 4.0, d);
            rays += 1;
            let first = scenes[0].geometry.all(&ray);
            for (scene, text) in scenes.iter().zip(ways).skip(1) {
                let all = scene.geometry.all(&ray);
                let same = all.len() == first.len()
                    && all.iter().zip(&first).all(|(a, b)| a.t_lo <= b.t_hi && b.t_lo <= a.t_hi);
                assert!(same, "{} and {text}: {ray:?}\n{first:?}\n{all:?}", ways[0]);
            }
            met += first.len();
        }
        assert!(met > 40, "{}: {met}", ways[0]);
    }
}
