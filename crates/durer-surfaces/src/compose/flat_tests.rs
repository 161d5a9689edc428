//! Clipped flat surfaces against exact arithmetic.

use crate::compose::clip::Algebraic;
use crate::laws::{
    Clipped, Crossing, Exact, ExactBody, ExactForm, ExactLine, Feature, Oracle, Surd, Tally, TestRng, aim,
    all_roots, check_many, exact3,
};
use crate::{
    Annulus, AxisBox, Clip, Cone, Disc, Ellipsoid, EllipticParaboloid, FillRule, HyperboloidOfOneSheet, Mesh,
    MeshData, Parallelogram, Placed, Plane, Polygon, Region, Sphere, Surface, Triangle,
};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Normal3, Point3, Ray, Vec3};

/// Regions, each with its faces' exact polynomials, chosen so that borders go through whole
/// points.
fn regions(dice: &mut TestRng) -> (Vec<Region>, Vec<ExactForm>) {
    let half = |n: [f64; 3], p: [f64; 3]| ExactForm::half_space(exact3(n), exact3(p));
    let (mut all, mut cuts) = (vec![], vec![]);
    for _ in 0..1 + dice.below(2) {
        let (region, faces) = match dice.below(5) {
            0 => {
                let (min, max) = ([-1.0, -2.0, -0.5], [1.5, 1.0, 2.0]);
                let faces = (0..3).flat_map(|i| {
                    let mut n = [0.0; 3];
                    n[i] = 1.0;
                    [half(n.map(|x: f64| -x), min), half(n, max)]
                });
                (Region::axis_box(min.into(), max.into()).unwrap(), faces.collect())
            }
            1 => {
                let n = dice.lattice(2);
                let at = dice.pick(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 1.0]]);
                let distance = n.dot(Vec3::from(at));
                let region = Region::half_space(n.to_normal(), distance).unwrap();
                (region, vec![half(n.to_array(), at)])
            }
            2 => {
                let ball = Sphere::new(Point3::new(0.0, 0.0, 1.0), 2.0).unwrap();
                let k = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0, -3.0];
                (Region::solid(ball), vec![ExactForm::from_f64(k)])
            }
            3 => {
                let cone = Cone::new(2.0, 1.0, 2.0).unwrap();
                let k = [1.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                (Region::solid(*cone.shape()), vec![ExactForm::from_f64(k)])
            }
            _ => {
                let bowl = EllipticParaboloid::new(1.0, 2.0, 2.0).unwrap().between(-1.0, 2.0).unwrap();
                let k = [4.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0];
                let ends = [half([0.0, 0.0, -1.0], [0.0, 0.0, -1.0]), half([0.0, 0.0, 1.0], [0.0, 0.0, 2.0])];
                (Region::solid(*bowl.shape()), [vec![ExactForm::from_f64(k)], ends.to_vec()].concat())
            }
        };
        all.push(region);
        cuts.extend(faces);
    }
    (all, cuts)
}

/// Whole points with whole directions: corners, borders of regions, and places beside them.
fn features(dice: &mut TestRng, own: &[Point3]) -> Vec<Feature> {
    let mut at = vec![];
    for _ in 0..40 {
        let point =
            if dice.once_in(2) { dice.pick(own) } else { dice.lattice(4).to_point().map(|x| 0.5 * x) };
        at.push(Feature { point, direction: dice.lattice(2) });
    }
    at
}

/// The laws for a flat surface under random clips, as it is and placed.
fn laws<S: Algebraic + Clone + core::fmt::Debug, O: Oracle + Clone>(
    surface: &S,
    oracle: &O,
    placed: impl Fn(&O, &Affine) -> O,
    own: &[Point3],
    seed: u64,
) -> Tally {
    let mut dice = TestRng::new(seed);
    let (regions, cuts) = regions(&mut dice);
    let at = features(&mut dice, own);
    let clip = Clip::new(surface.clone(), regions.clone());
    let mut tally = check_many(&clip, &Clipped { whole: oracle.clone(), cuts: cuts.clone() }, &at, seed, 120);
    let map = dice.map();
    let whole = placed(oracle, &map);
    let cuts = cuts.iter().map(|f| f.placed(&map)).collect();
    let regions = regions.into_iter().map(|r| r.placed(map)).collect();
    let at: Vec<_> = at.into_iter().map(|f| f.placed(&map)).collect();
    let clip = Clip::new(Placed::new(surface.clone(), map), regions);
    tally.roots += check_many(&clip, &Clipped { whole, cuts }, &at, seed, 60).roots;
    tally
}

fn half(n: Vec3, p: Point3) -> ExactForm {
    ExactForm::half_space(exact3(n.to_array()), exact3(p.to_array()))
}

#[test]
fn clipped_boxes_obey_the_laws() {
    let mut roots = 0;
    for seed in 0..24 {
        let block = AxisBox::new(Point3::new(-1.0, -1.0, -0.5), Point3::new(1.0, 2.0, 1.0)).unwrap();
        let face =
            |i: u32| half(AxisBox::normal(i).to_vec(), if i & 1 == 0 { block.min() } else { block.max() });
        let oracle = ExactBody::solid((0..6).map(face).collect(), 2.0, true);
        let own = [block.min(), block.max(), Point3::new(1.0, 0.0, 1.0), Point3::new(-1.0, 2.0, 0.0)];
        roots += laws(&block, &oracle, ExactBody::placed, &own, seed).roots;
    }
    assert!(roots > 400, "{roots}");
}

#[test]
fn clipped_sheets_obey_the_laws() {
    let mut roots = 0;
    for seed in 0..24 {
        let centre = Point3::new(0.5, 0.0, 0.5);
        let n = Vec3::new(1.0, 2.0, -2.0);
        let own = [centre, Point3::new(2.5, 0.0, 1.5), Point3::new(0.5, 1.0, 1.5)];
        let ball = |r: f64| {
            let k = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -r * r];
            ExactForm::from_f64(k).translated(&exact3(centre.to_array()))
        };
        let sheet = |faces: Vec<ExactForm>| ExactBody { walls: 1, faces, size: 3.0, convex: false };
        let disc = Disc::new(centre, n, 3.0).unwrap();
        roots += laws(&disc, &sheet(vec![half(n, centre), ball(3.0)]), ExactBody::placed, &own, seed).roots;
        let ring = Annulus::new(centre, n, 1.0, 3.0).unwrap();
        let faces = vec![half(n, centre), ball(3.0), ball(1.0).negated()];
        roots += laws(&ring, &sheet(faces), ExactBody::placed, &own, seed).roots;
        let (u, v) = (Vec3::new(4.0, 0.0, 2.0), Vec3::new(0.0, 4.0, 4.0));
        let (n, far) = (u.cross(v), centre + u + v);
        let (left, front) = (n.cross(v), u.cross(n));
        let faces = vec![
            half(n, centre),
            half(left, centre),
            half(-left, far),
            half(front, centre),
            half(-front, far),
        ];
        let sheared = Parallelogram::new(centre, u, v).unwrap();
        roots += laws(&sheared, &sheet(faces), ExactBody::placed, &own, seed).roots;
    }
    assert!(roots > 400, "{roots}");
}

/// One of the two planes of `body`'s first face, on the side that its second face leaves.
#[derive(Clone)]
struct OneOfTwo {
    body: ExactBody,
    /// Points on the other side are in front of this plane, or behind it.
    beyond: Ordering,
}

impl Oracle for OneOfTwo {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        self.body.crossings(line)
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        let here = self.body.faces.get(1).is_none_or(|f| f.value(point).sign().is_le());
        if here { self.body.face_side(face, point) } else { self.beyond }
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        self.body.face_normal(face, point)
    }

    fn side(&self, _: &[Exact; 3]) -> Option<Ordering> {
        None
    }

    fn size(&self) -> f64 {
        self.body.size()
    }

    fn is_convex(&self) -> bool {
        false
    }
}

#[test]
fn clipped_planes_obey_the_laws() {
    let mut roots = 0;
    for seed in 0..40 {
        let mut dice = TestRng::new(seed);
        // Few of these lengths are rational.
        let (n, h) = (dice.lattice(3), dice.pick(&[1.0, 0.5, -1.0, -0.25, 0.0]));
        let plane = Plane::new(n, h).unwrap();
        let stored = exact3(plane.normal().to_array());
        let square = |i: usize, j: usize| &stored[i] * &stored[j];
        let n2 = &(&square(0, 0) + &square(1, 1)) + &square(2, 2);
        // One of the two planes (n·x)² = h² n·n: another face decides its side.
        let pair = ExactForm {
            q: core::array::from_fn(|i| core::array::from_fn(|j| square(i, j))),
            b: core::array::from_fn(|_| Exact::zero()),
            c: -(&Exact::from(h).squared() * &n2),
        };
        let side = half(-plane.normal() * h, Point3::ORIGIN);
        let faces = match h {
            0.0 => vec![half(plane.normal(), Point3::ORIGIN)],
            _ if h > 0.0 => vec![pair, side],
            _ => vec![pair.negated(), side],
        };
        let body = ExactBody { walls: 1, faces, size: 1.0, convex: false };
        let beyond = if h > 0.0 { Ordering::Less } else { Ordering::Greater };
        let oracle = OneOfTwo { body, beyond };
        let placed = |o: &OneOfTwo, map: &Affine| OneOfTwo { body: o.body.placed(map), ..o.clone() };
        let foot = (plane.normal() * (h / plane.normal().length())).to_point();
        roots +=
            laws(&plane, &oracle, placed, &[foot, Point3::ORIGIN, Point3::new(1.0, 0.0, 1.0)], seed).roots;
    }
    assert!(roots > 400, "{roots}");
}

#[test]
fn clipped_triangles_polygons_and_meshes_agree_with_the_whole_ones() {
    let corners = [[-2.0, -2.0, 0.0], [2.0, -2.0, 1.0], [2.0, 2.0, 2.0], [-2.0, 2.0, 1.0]].map(Point3::from);
    let [a, b, c, d] = corners;
    let faces = vec![[0, 1, 2], [0, 2, 3]];
    let mesh = Mesh::new(MeshData { vertices: corners.to_vec(), faces, ..MeshData::default() }).unwrap();
    let polygon = Polygon::new(&[corners], FillRule::EvenOdd).unwrap();
    let triangles = [Triangle::new([a, b, c]).unwrap(), Triangle::new([a, c, d]).unwrap()];
    let (mut kept, mut lost, mut touched) = (0, 0, 0);
    for seed in 0..40 {
        let mut dice = TestRng::new(seed);
        let (regions, cuts) = regions(&mut dice);
        let clips = triangles.each_ref().map(|t| Clip::new(t.clone(), regions.clone()));
        let clipped_mesh = Clip::new(mesh.clone(), regions.clone());
        let clipped_polygon = Clip::new(polygon.clone(), regions);
        let at = features(&mut dice, &corners);
        for _ in 0..100 {
            let ray = aim(&mut dice, &at, 2.0);
            if !ray.is_valid() {
                continue;
            }
            let line = ExactLine::new(&ray);
            let n = (b - a).cross(d - a);
            let plane = half(n, a).along(&line);
            let root = Surd::ratio(-plane.c.clone(), plane.b.clone().shifted(1));
            let whole = [0, 1].map(|i| all_roots(&triangles[i], &ray));
            let inside = || cuts.iter().all(|f| root.sign_of(&f.along(&line)).is_le());
            for (i, roots) in whole.iter().enumerate() {
                let expected = if !roots.is_empty() && inside() { roots.clone() } else { vec![] };
                kept += expected.len();
                lost += roots.len() - expected.len();
                assert_eq!(all_roots(&clips[i], &ray), expected, "{ray:?}");
            }
            let both = whole.iter().flatten().count();
            let expected = if both > 0 && inside() { both } else { 0 };
            assert_eq!(all_roots(&clipped_polygon, &ray).len(), expected, "{ray:?}");
            // Borders of the mesh are touched; edge-on that is apart from the plane's crossing.
            let of_mesh = all_roots(&mesh, &ray);
            if of_mesh.iter().any(|r| r.sign != 0) {
                assert_eq!((of_mesh.len(), both), (1, 1), "{ray:?}");
            }
            let is_edge_on = plane.b.sign().is_eq();
            if !is_edge_on {
                let expected = usize::from(!of_mesh.is_empty() && inside());
                assert_eq!(all_roots(&clipped_mesh, &ray).len(), expected, "{ray:?}");
            }
            touched += of_mesh.iter().filter(|r| r.sign == 0).count();
        }
    }
    assert!(kept > 100 && lost > 100 && touched > 50, "{kept} {lost} {touched}");
}

#[test]
fn the_border_of_a_region_is_kept() {
    let block = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)).unwrap();
    let top = Region::half_space(Normal3::Y, 1.0).unwrap();
    let down = Ray::new(Point3::new(0.25, 3.0, 0.5), -Vec3::Y);
    // The face y = 1 is the region's border; below it all is inside.
    assert_eq!(all_roots(&Clip::new(block, vec![top.clone()]), &down).len(), 2);
    assert_eq!(all_roots(&Clip::new(block, vec![top.inverse()]), &down).len(), 1);
    let egg = Region::solid(*Ellipsoid::new(2.0, 1.0, 1.0).unwrap().shape());
    let tower = Region::solid(*HyperboloidOfOneSheet::new(1.0, 1.0, 2.0).unwrap().shape());
    let plane = Plane::new(Vec3::Y, 1.0).unwrap();
    let at = |x: f64, z: f64| Ray::new(Point3::new(x, 3.0, z), -Vec3::Y);
    // The plane touches the ellipsoid in one point.
    let clip = Clip::new(plane, vec![egg]);
    assert_eq!((all_roots(&clip, &at(0.0, 0.0)).len(), all_roots(&clip, &at(1e-300, 0.0)).len()), (1, 0));
    // And meets the hyperboloid in the lines x = ±z / 2.
    let clip = Clip::new(plane, vec![tower]);
    assert_eq!(all_roots(&clip, &at(2.0, 4.0)).len(), 1);
    assert_eq!(all_roots(&clip, &at(2.0_f64.next_up(), 4.0)).len(), 0);
    assert_eq!(clip.bounds(), Aabb::UNBOUNDED);
}
