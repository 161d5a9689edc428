//! Texture coordinates by the rules of the surface.

use super::*;
use durer_math::Point3;

fn smooth(mut data: SubdivisionData) -> SubdivisionData {
    data.uv_interpolation = UvInterpolation::Smooth;
    data
}

/// The points that rays meet.
fn points(it: &SubdivisionSurface, rays: u64) -> Vec<(Root, SurfacePoint)> {
    let mut dice = crate::laws::dice(31, 0);
    let mut all = vec![];
    for _ in 0..rays {
        let from = dice.vector() * 4.0;
        let ray = Ray::new(from.to_point(), dice.vector() * 0.7 - from);
        let local = LocalRay::new(&ray);
        all.extend(all_roots(it, &ray).into_iter().map(|root| (root, it.resolve(&local, &root, Need::ALL))));
    }
    all
}

#[test]
fn coordinates_that_are_those_of_vertices_are_those_of_the_limit() {
    for (name, mut data) in all_meshes() {
        data.uv = data.vertices.iter().map(|p| [p.x, p.y]).collect();
        data.uv_faces = data.faces.clone();
        let it = surface(&smooth(data));
        for (root, p) in points(&it, 40) {
            // The crossing is known to its bracket only, the parameters to as much.
            let most = 4.0 * p.dp.length() + 64.0 * U;
            let off = (p.uv[0] - p.p.x).abs().max((p.uv[1] - p.p.y).abs());
            assert!(off <= most, "{name}: {off:e} of {most:e}, {root:?} {p:?}");
            let (du, dv) = (p.dpdu, p.dpdv);
            let area = du.cross(dv).length();
            if p.ng.to_vec().z.abs() > 1e-3 && p.bend.is_finite() {
                let off = (du.x - 1.0).abs().max(du.y.abs()).max(dv.x.abs()).max((dv.y - 1.0).abs());
                assert!(off < 1e-6, "{name}: {du:?} {dv:?} {area} {root:?}");
            }
        }
    }
}

#[test]
fn seams_are_boundaries_of_the_mesh_of_coordinates() {
    let wave = |i: usize, j: usize| {
        let (x, y) = (i as f64 / 2.0 - 1.0, j as f64 / 2.0 - 1.0);
        Vec3::new(x, y, 0.4 * x * y + 0.3 * x * x)
    };
    let quads = grid(5, 5, true, wave);
    for mut data in [quads.clone(), triangulated(quads)] {
        let mut dice = crate::laws::dice(33, 0);
        let mut place = |far: bool| {
            data.vertices
                .iter()
                .map(|p| {
                    let [x, y] = [dice.between(-0.1, 0.1), dice.between(-0.1, 0.1)];
                    [p.x + x + if far { 10.0 } else { 0.0 }, p.y + y]
                })
                .collect::<Vec<_>>()
        };
        let (near, far) = (place(false), place(true));
        data.uv = near.into_iter().chain(far).collect();
        // Faces on the right have coordinates of their own.
        let count = data.vertices.len() as u32;
        let is_far = |face: &Vec<u32>| face.iter().all(|v| v % 5 >= 2);
        data.uv_faces = data
            .faces
            .iter()
            .map(|face| face.iter().map(|v| v + if is_far(face) { count } else { 0 }).collect())
            .collect();
        let flat = SubdivisionData {
            vertices: data.uv.iter().map(|&[u, v]| Point3::new(u, v, 0.0)).collect(),
            faces: data.uv_faces.clone(),
            uv: vec![],
            uv_faces: vec![],
            ..data.clone()
        };
        let (it, flat) = (surface(&smooth(data)), surface(&flat));
        let mut met = 0;
        for (root, p) in points(&it, 200) {
            let down = Ray::new(Point3::new(p.uv[0], p.uv[1], 1.0), Vec3::new(0.0, 0.0, -1.0));
            let roots = all_roots(&flat, &down);
            let [found] = roots[..] else { panic!("{roots:?} {root:?} {p:?}") };
            assert_eq!(found.face, root.face);
            let [a, b] = [found, root].map(|r| limit::parameters(false, r.tag));
            assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-9, "{a:?} {b:?}");
            met += 1;
        }
        assert!(met > 100, "{met}");
    }
}
