//! Meshes are crossed once at every edge and vertex, and touched where rays pass on.

use super::*;
use crate::laws::{TestRng, all_roots};
use durer_math::Ray;

/// The octahedron, its faces divided into `k * k` triangles with integer coordinates: flat
/// faces, and many vertices and edges.
fn octahedron(k: i32) -> Mesh {
    let mut data = MeshData::default();
    let find = |p: [i32; 3], vertices: &mut Vec<Point3>| {
        let p = Point3::from(p.map(f64::from));
        let known = vertices.iter().position(|q| *q == p);
        known.unwrap_or_else(|| {
            vertices.push(p);
            vertices.len() - 1
        }) as u32
    };
    for octant in 0..8 {
        let s = [0, 1, 2].map(|i| if octant >> i & 1 == 0 { 1 } else { -1 });
        let mirrored = s[0] * s[1] * s[2] < 0;
        for i in 0..k {
            for j in 0..k - i {
                let mut corner =
                    |i: i32, j: i32| find([s[0] * (k - i - j), s[1] * i, s[2] * j], &mut data.vertices);
                let mut faces = vec![[corner(i, j), corner(i + 1, j), corner(i, j + 1)]];
                if i + j + 1 < k {
                    faces.push([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
                }
                for [a, b, c] in faces {
                    data.faces.push(if mirrored { [a, c, b] } else { [a, b, c] });
                }
            }
        }
    }
    Mesh::new(data).unwrap()
}

#[test]
fn a_closed_mesh_is_crossed_an_even_number_of_times() {
    let mesh = octahedron(4);
    assert!(mesh.is_closed());
    let mut dice = TestRng::new(1);
    let (mut crossed, mut through_vertices) = (0, 0);
    for _ in 0..6000 {
        // Integers: through vertices, along edges, within faces.
        let target =
            if dice.once_in(2) { dice.lattice(4).to_point() } else { dice.pick(&mesh.data.vertices) };
        let direction = dice.lattice(3);
        let back = dice.pick(&[7.0, 1000.0, 1048577.0]);
        let ray = Ray::new(target - direction * back, direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let roots = all_roots(&mesh, &ray);
        if let [touch] = roots[..] {
            assert_eq!((touch.sign, touch.kind), (0, RootKind::Grazing), "{touch:?} for {ray:?}");
            continue;
        }
        assert!(roots.is_empty() || roots.len() == 2, "a convex solid: {roots:?} for {ray:?}");
        let turns: i32 = roots.iter().map(|r| i32::from(r.sign)).sum();
        assert_eq!(turns, 0, "{roots:?} for {ray:?}");
        let far = roots.iter().map(|r| r.t).fold(f64::NEG_INFINITY, f64::max);
        let near = roots.iter().map(|r| r.t).fold(f64::INFINITY, f64::min);
        if near < far {
            crossed += 1;
            let inner = roots.iter().filter(|r| r.lo > near && r.hi < far).count();
            assert_eq!(inner, 0, "{roots:?} for {ray:?}");
        }
        through_vertices += usize::from(mesh.data.vertices.contains(&target) && !roots.is_empty());
    }
    assert!(crossed > 2000 && through_vertices > 1000, "{crossed} {through_vertices}");
}

#[test]
fn no_ray_from_inside_escapes() {
    let mesh = octahedron(3);
    let mut dice = TestRng::new(2);
    for _ in 0..4000 {
        let from = Point3::from((dice.lattice(2) * 0.5 * dice.pick(&[0.5, 1.0])).to_array());
        if from.x.abs() + from.y.abs() + from.z.abs() >= 3.0 {
            continue;
        }
        let at = dice.pick(&mesh.data.vertices);
        let direction = if dice.once_in(3) { dice.vector() } else { at - from };
        let roots = all_roots(&mesh, &Ray::new(from, direction));
        assert_eq!(roots.len(), 1, "from {from:?} along {direction:?}: {roots:?}");
    }
}

#[test]
fn the_sides_of_a_solid_mesh_are_exact() {
    let sheet = octahedron(3);
    assert_eq!(sheet.solidity(), Solidity::Open);
    let solids = [Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.3, -0.2, 0.9)]
        .map(|d| sheet.clone().solid(d).unwrap());
    let mut dice = TestRng::new(3);
    let mut told = [0; 3];
    for _ in 0..2000 {
        let p = dice.lattice(4) * 0.5;
        let p = Point3::new(if dice.once_in(2) { dice.nudge(p.x, 1) } else { p.x }, p.y, p.z);
        let sum = crate::laws::Exact::from(p.x.abs());
        let sum = &(&sum + &p.y.abs().into()) + &p.z.abs().into();
        let expected = match (&sum - &3.0.into()).sign() {
            Ordering::Less => Side::In,
            Ordering::Equal => Side::On,
            Ordering::Greater => Side::Out,
        };
        for solid in &solids {
            assert_eq!(solid.side(&LocalPoint::new(p)), expected, "{p:?}");
        }
        told[expected as usize] += 1;
    }
    assert!(told.iter().all(|&n| n > 100), "{told:?}");
}

#[test]
fn parts_together_are_the_whole() {
    let mesh = octahedron(2);
    let mut dice = TestRng::new(4);
    for _ in 0..500 {
        let ray = Ray::new(dice.lattice(5).to_point(), dice.lattice(3));
        let mut sink = crate::All::default();
        mesh.parts(&mut |bounds, part| {
            let before = sink.roots.len();
            mesh.part_roots(part, &LocalRay::new(&ray), &mut sink);
            for root in &sink.roots[before..] {
                let p = mesh.resolve(&LocalRay::new(&ray), root, Need::POINT);
                assert_eq!(root.face, part.0);
                assert!(bounds.expanded(p.dp).contains(p.p));
            }
        });
        sink.roots.sort_by(Root::order);
        assert_eq!(sink.roots, all_roots(&mesh, &ray));
    }
}

#[test]
fn dropped_faces_keep_their_numbers() {
    let v = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]];
    let mesh = Mesh::new(MeshData {
        vertices: v.map(Point3::from).to_vec(),
        faces: vec![[0, 1, 3], [0, 0, 2], [0, 1, 4], [0, 1, 2]],
        ..MeshData::default()
    })
    .unwrap();
    assert_eq!(mesh.dropped(), [0, 1, 2]);
    let down = Ray::new(Point3::new(0.25, 0.25, 1.0), -Vec3::Z);
    assert_eq!(all_roots(&mesh, &down).iter().map(|r| r.face).collect::<Vec<_>>(), [3]);
}

#[test]
fn a_bad_index_is_named() {
    let data = MeshData { vertices: vec![Point3::ORIGIN], faces: vec![[0, 0, 1]], ..MeshData::default() };
    assert_eq!(Mesh::new(data), Err(MeshError::Index { what: "vertex", face: 0, index: 1, len: 1 }));
}

/// A convex solid by its half-spaces `n . p <= level`, in whole numbers.
struct Convex {
    mesh: Mesh,
    planes: Vec<([i64; 3], i64)>,
}

/// What a line and a convex solid have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Common {
    Nothing,
    /// Points of the boundary alone, from this parameter on.
    Boundary(f64),
    /// Points of the inside, between these parameters.
    Inside(f64, f64),
}

/// `a / b` and `c / d`, both denominators positive.
fn compare((a, b): (i64, i64), (c, d): (i64, i64)) -> Ordering {
    (i128::from(a) * i128::from(d)).cmp(&(i128::from(c) * i128::from(b)))
}

impl Convex {
    fn of(mesh: Mesh) -> Self {
        let whole = |p: Point3| p.to_array().map(|x| x as i64);
        let mut planes = Vec::new();
        for face in &mesh.data.faces {
            let [a, b, c] = face.map(|v| whole(mesh.data.vertices[v as usize]));
            let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
            let n = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i]);
            planes.push((n, (0..3).map(|i| n[i] * a[i]).sum()));
        }
        Self { mesh, planes }
    }

    fn common(&self, o: [i64; 3], d: [i64; 3]) -> Common {
        let dot = |a: [i64; 3], b: [i64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<i64>();
        let (mut first, mut last) = (None, None);
        let mut is_inside = true;
        for &(n, level) in &self.planes {
            let (slope, room) = (dot(n, d), level - dot(n, o));
            match slope.cmp(&0) {
                Ordering::Equal if room < 0 => return Common::Nothing,
                Ordering::Equal => is_inside &= room > 0,
                Ordering::Greater => {
                    let t = (room, slope);
                    last = Some(last.filter(|&l: &(i64, i64)| compare(l, t).is_le()).unwrap_or(t));
                }
                Ordering::Less => {
                    let t = (-room, -slope);
                    first = Some(first.filter(|&f: &(i64, i64)| compare(f, t).is_ge()).unwrap_or(t));
                }
            }
        }
        let (first, last) = (first.unwrap(), last.unwrap());
        let value = |(a, b): (i64, i64)| a as f64 / b as f64;
        match compare(first, last) {
            Ordering::Greater => Common::Nothing,
            Ordering::Less if is_inside => Common::Inside(value(first), value(last)),
            _ => Common::Boundary(value(first)),
        }
    }

    /// Checks the roots of a line against the rule; returns what there was.
    fn check(&self, surface: &Mesh, ray: &Ray, common: Common) -> Common {
        let roots = all_roots(surface, ray);
        let near = |root: &Root, t: f64| root.lo <= t.next_up() && t.next_down() <= root.hi;
        match (common, &roots[..]) {
            (Common::Nothing, []) => {}
            (Common::Boundary(t), [touch]) => {
                assert_eq!((touch.sign, touch.kind), (0, RootKind::Grazing), "{ray:?}");
                assert!(near(touch, t), "{touch:?} not at {t} of {ray:?}");
                let point = surface.resolve(&LocalRay::new(ray), touch, Need::ALL);
                let off = ray.at(touch.t) - point.p;
                let reach = point.dp + ray.direction.abs() * (touch.hi - touch.lo + 1e-15 * touch.t.abs());
                assert!((0..3).all(|i| off[i].abs() <= 4.0 * reach[i] + 1e-14), "{off:?} of {ray:?}");
            }
            (Common::Inside(a, b), [entry, exit]) => {
                assert_eq!((entry.sign, exit.sign), (-1, 1), "{ray:?}");
                assert!(near(entry, a) && near(exit, b), "{roots:?} not at {a} and {b} of {ray:?}");
            }
            (_, roots) => panic!("{common:?} of {ray:?}, but {roots:?}"),
        }
        common
    }
}

fn mesh_of(vertices: &[[i32; 3]], faces: &[[u32; 3]]) -> Mesh {
    let vertices = vertices.iter().map(|v| Point3::from(v.map(f64::from))).collect();
    Mesh::new(MeshData { vertices, faces: faces.to_vec(), ..MeshData::default() }).unwrap()
}

fn cube() -> Mesh {
    let v = [0, 1, 2, 3, 4, 5, 6, 7].map(|i: i32| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|b| 4 * b - 2));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh_of(&v, &faces)
}

fn tetrahedron() -> Mesh {
    mesh_of(&[[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

/// The mesh with three vertices of its own for each face, as files of type STL have them.
fn unshared(mesh: &Mesh) -> Mesh {
    let mut data = MeshData::default();
    for face in &mesh.data.faces {
        let first = data.vertices.len() as u32;
        data.vertices.extend(face.map(|v| mesh.data.vertices[v as usize]));
        data.faces.push([first, first + 1, first + 2]);
    }
    Mesh::new(data).unwrap()
}

fn lattice_ray(from: [i64; 3], d: [i64; 3], back: i64) -> (Ray, [i64; 3]) {
    let o = [0, 1, 2].map(|i| from[i] - back * d[i]);
    let float = |v: [i64; 3]| v.map(|x| x as f64);
    let ray = Ray::new(Point3::from(float(o)), Vec3::from(float(d)));
    (ray.with_range(f64::NEG_INFINITY, f64::INFINITY), o)
}

#[test]
fn convex_meshes_are_missed_touched_once_or_entered_and_left_in_every_direction() {
    let solids = [cube(), tetrahedron(), octahedron(1), octahedron(3)].map(Convex::of);
    let mut seen = [0; 3];
    for (number, solid) in solids.iter().enumerate() {
        let loose = unshared(&solid.mesh);
        let mut dice = TestRng::new(10 + number as u64);
        for d in (0..343).map(|i| [i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3]).filter(|d| *d != [0; 3]) {
            for vertex in 0..solid.mesh.data.vertices.len().min(8) + 12 {
                let from = match solid.mesh.data.vertices.get(vertex) {
                    Some(v) if vertex < 8 => v.to_array().map(|x| x as i64),
                    _ => dice.lattice(4).to_array().map(|x| x as i64),
                };
                let (ray, o) = lattice_ray(from, d, [5, 1001, 1 << 21][dice.below(3) as usize]);
                let common = solid.common(o, d);
                solid.check(&solid.mesh, &ray, common);
                solid.check(&loose, &ray, common);
                seen[match common {
                    Common::Nothing => 0,
                    Common::Boundary(_) => 1,
                    Common::Inside(..) => 2,
                }] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 3000), "{seen:?}");
}

#[test]
fn placed_meshes_follow_the_same_rule() {
    let solids = [cube(), tetrahedron(), octahedron(2)].map(Convex::of);
    let rows = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, -2.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 2.0, -1.0], [0.0, 3.0, 1.0], [2.0, 0.0, 7.0]],
    ];
    let mut touches = 0;
    for (number, solid) in solids.iter().enumerate() {
        for rows in rows {
            // The map's stored numbers are whole, so the rays' images are exact.
            let map = durer_math::Affine::new(rows, Point3::new(5.0, -3.0, 8.0)).unwrap();
            let placed = crate::Placed::new(solid.mesh.clone(), map);
            let mut dice = TestRng::new(20 + number as u64);
            for _ in 0..1500 {
                let whole = |v: Vec3| v.to_array().map(|x| x as i64);
                let from = if dice.once_in(2) {
                    dice.pick(&solid.mesh.data.vertices).to_vec()
                } else {
                    dice.lattice(3)
                };
                let d = whole(dice.lattice(3));
                if d == [0; 3] {
                    continue;
                }
                let (inner, o) = lattice_ray(whole(from), d, 9);
                let outer = Ray::new(map.point(inner.origin), map.vector(inner.direction))
                    .with_range(f64::NEG_INFINITY, f64::INFINITY);
                let common = solid.common(o, d);
                touches += usize::from(matches!(common, Common::Boundary(_)));
                let roots = all_roots(&placed, &outer);
                let kinds: Vec<_> = roots.iter().map(|r| (r.sign.abs(), r.kind)).collect();
                let expected = match common {
                    Common::Nothing => vec![],
                    Common::Boundary(_) => vec![(0, RootKind::Grazing)],
                    Common::Inside(..) => vec![(1, RootKind::Simple); 2],
                };
                assert_eq!(kinds, expected, "{outer:?} {common:?}");
                if let Common::Boundary(t) = common {
                    assert!(roots[0].lo <= t.next_up() && t.next_down() <= roots[0].hi, "{roots:?} {t}");
                }
            }
        }
    }
    assert!(touches > 1500, "{touches}");
}

/// Signs and parameters of a mesh's roots on the line from a point along a direction.
fn signs(mesh: &Mesh, from: [f64; 3], d: [f64; 3]) -> Vec<(i8, f64)> {
    let ray = Ray::new(Point3::from(from), Vec3::from(d)).with_range(f64::NEG_INFINITY, f64::INFINITY);
    let roots = all_roots(mesh, &ray);
    assert!(roots.iter().all(|r| (r.kind == RootKind::Grazing) == (r.sign == 0)), "{roots:?}");
    roots.iter().map(|r| (r.sign, r.t)).collect()
}

#[test]
fn a_ray_on_a_ledge_enters_once_and_a_ray_over_a_groove_touches_once() {
    // Seen along x: a step, z in [0, 1] up to y = 1 and z in [1, 2] up to y = 2; then a groove,
    // z in [2, 3] up to y = 1, and z in [3, 4] up to y = 2.
    let outline = [[0, 0], [0, 1], [1, 1], [1, 2], [2, 2], [2, 1], [3, 1], [3, 2], [4, 2], [4, 0]];
    let mut vertices: Vec<[i32; 3]> = Vec::new();
    for x in [0, 2] {
        vertices.extend(outline.iter().map(|&[z, y]| [x, y, z]));
    }
    let n = outline.len() as u32;
    let mut faces = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        faces.extend([[i, i + n, j + n], [i, j + n, j]]);
    }
    // The ends, cut into triangles.
    for cap in [[0, 1, 2], [0, 2, 5], [2, 3, 4], [2, 4, 5], [0, 5, 6], [0, 6, 9], [6, 7, 8], [6, 8, 9]] {
        faces.extend([cap, cap.map(|v| v + n)]);
        faces.last_mut().unwrap().reverse();
    }
    let mesh = mesh_of(&vertices, &faces);
    assert!(mesh.is_closed());
    let outward = if signs(&mesh, [1.0, 0.5, -5.0], [0.0, 0.0, 1.0])[0].0 == -1 { 1 } else { -1 };
    let seen = |y: f64, x: f64, d: f64| {
        let found = signs(&mesh, [x, y, -5.0], [0.0, 0.0, d]);
        found.iter().map(|&(sign, t)| (sign * outward, t * d - 5.0)).collect::<Vec<_>>()
    };
    for x in [1.0, 0.75] {
        // Level with the ledge: it runs on the ledge, enters, touches the groove and leaves.
        let there = seen(1.0, x, 1.0);
        assert_eq!(there.iter().map(|s| s.0).collect::<Vec<_>>(), [-1, 0, 1], "{there:?}");
        assert!((0.0..=1.0).contains(&there[0].1) && there[1].1 == 2.0 && there[2].1 == 4.0, "{there:?}");
        let back = seen(1.0, x, -1.0);
        assert_eq!(back.iter().map(|s| s.0).collect::<Vec<_>>(), [-1, 0, 1], "{back:?}");
        assert!(back[0].1 == 4.0 && back[1].1 == 3.0 && (0.0..=1.0).contains(&back[2].1), "{back:?}");
        // Over the tops, and below.
        assert_eq!(seen(2.0, x, 1.0), [(0, 1.0), (0, 3.0)]);
        assert_eq!(seen(0.0, x, 1.0), [(0, 0.0)]);
        assert_eq!(seen(0.5, x, 1.0), [(-1, 0.0), (1, 4.0)]);
    }
    // Along an end and along its edges: in one plane with the end's many triangles.
    for y in [0.0, 0.25, 1.0] {
        assert_eq!(seen(y, 0.0, 1.0), [(0, 0.0)], "at {y}");
        assert_eq!(seen(y, 2.0, -1.0), [(0, 4.0)], "at {y}");
    }
}

#[test]
fn the_borders_of_open_meshes_are_touched() {
    // A square of two triangles in the plane z = 0.
    let square = mesh_of(&[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], &[[0, 1, 2], [0, 2, 3]]);
    let down = |x: f64, y: f64| signs(&square, [x, y, 3.0], [0.0, 0.0, -1.0]);
    assert_eq!(down(1.0, 1.0), [(-1, 3.0)], "through the diagonal");
    assert_eq!(down(0.5, 1.0), [(-1, 3.0)]);
    for (x, y) in
        [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 0.0), (2.0, 0.7), (0.3, 2.0), (0.0, 1.9)]
    {
        assert_eq!(down(x, y), [(0, 3.0)], "at {x} {y}");
        let slanted = signs(&square, [x - 1.0, y + 2.0, -4.0], [0.25, -0.5, 1.0]);
        assert_eq!(slanted, [(0, 4.0)], "at {x} {y}");
    }
    assert_eq!(down(2.5, 0.0), []);
    // Edge-on: along the middle, the diagonal, the border, and at a corner.
    assert_eq!(signs(&square, [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]), [(0, 1.0)]);
    assert_eq!(signs(&square, [-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]), [(0, 1.0)]);
    assert_eq!(signs(&square, [5.0, 2.0, 0.0], [-1.0, 0.0, 0.0]), [(0, 3.0)]);
    assert_eq!(signs(&square, [-1.0, 1.0, 0.0], [1.0, -1.0, 0.0]), [(0, 1.0)]);
    assert_eq!(signs(&square, [-1.0, 0.5, 0.0], [1.0, -1.0, 0.0]), []);
    // Points of touches edge-on.
    let ray = Ray::new(Point3::new(-1.0, 0.5, 0.0), Vec3::new(1.0, 0.25, 0.0));
    let roots = all_roots(&square, &ray);
    let point = square.resolve(&LocalRay::new(&ray), &roots[0], Need::ALL);
    assert_eq!((roots.len(), roots[0].t, point.p), (1, 1.0, Point3::new(0.0, 0.75, 0.0)));
}

#[test]
fn edges_that_end_within_others_are_crossed_once() {
    // A square of one triangle on the left and two on the right, whose common vertex lies within
    // the edge of the first.
    let corners = [[0, 0, 0], [4, 4, 0], [0, 4, 0], [4, 0, 0], [2, 2, 0]];
    let (left, right) = ([0, 1, 2], [[3, 4, 0], [3, 1, 4]]);
    let filler = [0, 4, 1];
    for faces in [vec![left, right[0], right[1]], vec![left, right[0], right[1], filler]] {
        let mesh = mesh_of(&corners, &faces);
        let down = |x: f64, y: f64| signs(&mesh, [x, y, 3.0], [0.0, 0.0, -1.0]);
        for at in [0.5, 1.0, 2.0, 3.0, 3.5] {
            assert_eq!(down(at, at), [(-1, 3.0)], "at {at}");
        }
        for (x, y) in [(0.0, 0.0), (4.0, 4.0), (4.0, 1.0), (1.0, 4.0)] {
            assert_eq!(down(x, y), [(0, 3.0)], "at {x} {y}");
        }
    }
}

#[test]
fn doubled_walls_are_crossed_twice_and_bodies_side_by_side_keep_their_own_roots() {
    // Two boxes that share a wall at x = 2, in one mesh.
    let first = cube();
    let mut data = first.data.clone();
    let count = data.vertices.len() as u32;
    data.vertices.extend(first.data.vertices.iter().map(|v| *v + Vec3::X * 4.0));
    data.faces.extend(first.data.faces.iter().map(|f| f.map(|v| v + count)));
    let mesh = Mesh::new(data).unwrap();
    for (y, z) in [(0.0, 0.0), (0.5, 0.5), (0.5, 0.25), (-1.5, -1.5)] {
        let found = signs(&mesh, [-5.0, y, z], [1.0, 0.0, 0.0]);
        let mut turns: Vec<i8> = found.iter().map(|s| s.0).collect();
        // Where the bodies meet, the order has no meaning.
        turns[1..3].sort_unstable();
        assert_eq!(turns, [-1, -1, 1, 1], "{found:?}");
        assert_eq!(found.iter().map(|s| s.1).collect::<Vec<_>>(), [3.0, 7.0, 7.0, 11.0]);
    }
}

#[test]
fn a_long_ridge_is_touched_once() {
    // Sixty vertices in a row, with faces down on both sides: along it, and across it.
    let n = 60;
    let mut vertices: Vec<[i32; 3]> = Vec::new();
    for i in 0..n {
        vertices.extend([[i, 0, 0], [i, -1 - i % 3, 2], [i, -1 - i % 2, -2]]);
    }
    let mut faces = Vec::new();
    for i in 0..n as u32 - 1 {
        let (a, b) = (3 * i, 3 * i + 3);
        faces.extend([[a, b, b + 1], [a, b + 1, a + 1], [b, a, a + 2], [b, a + 2, b + 2]]);
    }
    let ridge = mesh_of(&vertices, &faces);
    assert_eq!(signs(&ridge, [-7.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [(0, 7.0)]);
    assert_eq!(signs(&ridge, [100.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), [(0, 41.0)]);
    for at in [1.0, 2.5, 30.0] {
        assert_eq!(signs(&ridge, [at, 0.0, -5.0], [0.0, 0.0, 1.0]), [(0, 5.0)]);
        assert_eq!(
            signs(&ridge, [at, 4.0, 0.0], [0.0, -2.0, 0.0]).iter().map(|s| s.1).collect::<Vec<_>>(),
            [2.0]
        );
    }
}
