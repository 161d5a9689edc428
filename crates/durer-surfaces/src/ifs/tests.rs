//! The laws, tested against the union of all copies in exact arithmetic, which shares no code with
//! the kernel.

use super::*;
use crate::laws::{
    Crossing, Exact, ExactLine, Feature, Oracle, Surd, TestRng, a_reversed_ray_meets_the_same, aim,
    all_roots, check_many, closest_is_the_first_of_all, exact3, powers_of_two_change_nothing,
    roots_are_the_exact_crossings,
};
use crate::{Placed, RootKind};
use core::cmp::Ordering;
use durer_math::{Ray, Vec3};

/// A line `(o + t d) / w`, `w > 0`.
#[derive(Clone)]
struct Homogeneous {
    o: [Exact; 3],
    d: [Exact; 3],
    w: Exact,
}

/// A map of the oracle: how it takes lines to the frame of its copy.
#[derive(Clone)]
enum Way {
    /// `q x - c`.
    Lattice(f64, [f64; 3]),
    General(Affine),
}

fn times(m: &[[Exact; 3]; 3], v: &[Exact; 3]) -> [Exact; 3] {
    [0, 1, 2].map(|i| &(&(&m[i][0] * &v[0]) + &(&m[i][1] * &v[1])) + &(&m[i][2] * &v[2]))
}

impl Way {
    fn apply(&self, line: &Homogeneous) -> Homogeneous {
        match self {
            Self::Lattice(q, c) => {
                let q = Exact::from(*q);
                let o = [0, 1, 2].map(|i| &(&q * &line.o[i]) - &(&Exact::from(c[i]) * &line.w));
                Homogeneous { o, d: [0, 1, 2].map(|i| &q * &line.d[i]), w: line.w.clone() }
            }
            Self::General(map) => {
                let l = map.linear().map(|row| row.map(Exact::from));
                // Cofactors, transposed.
                let mut adjugate = [0, 1, 2].map(|i| {
                    [0, 1, 2].map(|j| {
                        let (a, b, c, d) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
                        &(&l[a][c] * &l[b][d]) - &(&l[a][d] * &l[b][c])
                    })
                });
                let mut det = (0..3).fold(Exact::zero(), |sum, j| &sum + &(&l[0][j] * &adjugate[j][0]));
                if det.sign().is_lt() {
                    det = -det;
                    adjugate = adjugate.map(|row| row.map(|x| -x));
                }
                let c = map.centre().to_array();
                let from = [0, 1, 2].map(|i| &line.o[i] - &(&Exact::from(c[i]) * &line.w));
                Homogeneous { o: times(&adjugate, &from), d: times(&adjugate, &line.d), w: &line.w * &det }
            }
        }
    }
}

/// An end of an interval.
#[derive(Clone)]
enum Number {
    Ratio(Exact, Exact),
    Surd(Surd),
}

impl Number {
    fn surd(&self) -> Surd {
        match self {
            Self::Ratio(n, m) => Surd::ratio(n.clone(), m.clone()),
            Self::Surd(s) => s.clone(),
        }
    }

    fn compare(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Ratio(n, m), Self::Ratio(p, q)) => (&(n * q) - &(p * m)).sign(),
            _ => self.surd().compare(&other.surd(), false),
        }
    }
}

/// All copies, one by one.
#[derive(Clone)]
struct Copies {
    ways: Vec<Way>,
    leaf: IfsLeaf,
    /// Of polytopes: `n.x <= h`.
    faces: Vec<([Exact; 3], Exact)>,
    depth: u32,
    /// Whether nodes lie in the leaf.
    nested: bool,
    placed: Option<Affine>,
}

fn cross(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &(&a[j] * &b[k]) - &(&a[k] * &b[j])
    })
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

impl Copies {
    fn new(leaf: IfsLeaf, maps: &[Affine], depth: u32) -> Self {
        let ways = maps.iter().map(|map| Way::General(*map)).collect();
        Self { ways, leaf, faces: faces(&leaf), depth, nested: false, placed: None }
    }

    fn menger(depth: u32) -> Self {
        let mut ways = vec![];
        for i in 0..27 {
            let digits = [i % 3, i / 3 % 3, i / 9];
            if digits.iter().filter(|&&x| x == 1).count() < 2 {
                ways.push(Way::Lattice(3.0, digits.map(|x| 2.0 * f64::from(x) - 2.0)));
            }
        }
        let one = Point3::new(1.0, 1.0, 1.0);
        let leaf = IfsLeaf::Box((-one.to_vec()).to_point(), one);
        Self { ways, leaf, faces: faces(&leaf), depth, nested: true, placed: None }
    }

    fn sierpinski(depth: u32) -> Self {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let ways = corners.iter().map(|c| Way::Lattice(2.0, *c)).collect();
        let leaf = IfsLeaf::Tetrahedron(corners.map(Point3::from));
        // The face opposite to a corner has its number.
        let faces = corners.map(|c| (exact3(c.map(|x| -x)), Exact::from(1.0))).to_vec();
        Self { ways, leaf, faces, depth, nested: true, placed: None }
    }

    fn placed(&self, map: Affine) -> Self {
        Self { placed: Some(map), ..self.clone() }
    }

    fn start(&self, line: &ExactLine) -> Homogeneous {
        let line = Homogeneous { o: line.o.clone(), d: line.d.clone(), w: Exact::from(1.0) };
        match self.placed {
            Some(map) => Way::General(map).apply(&line),
            None => line,
        }
    }

    fn interval(&self, line: &Homogeneous) -> Option<(Number, Number)> {
        if let IfsLeaf::Sphere(c, r) = self.leaf {
            let o = [0, 1, 2].map(|i| &line.o[i] - &(&Exact::from(c[i]) * &line.w));
            let (a, b) = (dot(&line.d, &line.d), dot(&o, &line.d));
            let c = &dot(&o, &o) - &(&Exact::from(r) * &line.w).squared();
            let disc = &b.squared() - &(&a * &c);
            if disc.sign().is_lt() {
                return None;
            }
            let end = |k| Number::Surd(Surd::with_root(-b.clone(), k, disc.clone(), a.clone()));
            return Some((end(-1), end(1)));
        }
        let (mut from, mut to): (Option<Number>, Option<Number>) = (None, None);
        for (n, h) in &self.faces {
            let (height, slope) = (&dot(n, &line.o) - &(h * &line.w), dot(n, &line.d));
            match slope.sign() {
                Ordering::Less => {
                    let at = Number::Ratio(height, -slope);
                    from = Some(from.filter(|x| x.compare(&at).is_gt()).unwrap_or(at));
                }
                Ordering::Greater => {
                    let at = Number::Ratio(-height, slope);
                    to = Some(to.filter(|x| x.compare(&at).is_lt()).unwrap_or(at));
                }
                Ordering::Equal if height.sign().is_gt() => return None,
                Ordering::Equal => {}
            }
        }
        let (from, to) = (from.unwrap(), to.unwrap());
        from.compare(&to).is_le().then_some((from, to))
    }

    fn collect(&self, line: &Homogeneous, left: u32, out: &mut Vec<(Number, Number)>) {
        let own = self.interval(line);
        if left == 0 {
            out.extend(own);
        } else if !self.nested || own.is_some() {
            for way in &self.ways {
                self.collect(&way.apply(line), left - 1, out);
            }
        }
    }

    fn spans(&self, line: &ExactLine) -> Vec<(Number, Number)> {
        let mut all = vec![];
        self.collect(&self.start(line), self.depth, &mut all);
        all.sort_by(|a, b| a.0.compare(&b.0));
        let mut spans: Vec<(Number, Number)> = vec![];
        for next in all {
            match spans.last_mut() {
                Some(last) if next.0.compare(&last.1).is_le() => {
                    if next.1.compare(&last.1).is_gt() {
                        last.1 = next.1;
                    }
                }
                _ => spans.push(next),
            }
        }
        spans
    }

    /// Of the eight octants about a point, or of the whole point, those in a closed cube; whether it
    /// is in a cube at all, and whether inside one.
    fn corners(&self, at: &Homogeneous, left: u32, found: &mut (u8, bool)) {
        let mut octants = 0xff_u8;
        for (n, h) in &self.faces {
            let height = &dot(n, &at.o) - &(h * &at.w);
            match height.sign() {
                Ordering::Greater => return,
                Ordering::Less => {}
                Ordering::Equal => {
                    for octant in 0..8_u8 {
                        let v = [0, 1, 2].map(|i| if octant >> i & 1 == 1 { 1.0 } else { -1.0 });
                        if dot(n, &exact3(v)).sign().is_ge() {
                            octants &= !(1 << octant);
                        }
                    }
                }
            }
        }
        if left == 0 {
            found.0 |= octants;
            found.1 = true;
        } else {
            for way in &self.ways {
                self.corners(&way.apply(at), left - 1, found);
            }
        }
    }

    /// The side of the nearest plane `n.x = k / q^N` of a face: all `k` are odd on the sponge, and
    /// `2^N` modulo 4 on the tetrahedron.
    fn above_plane(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        let (n, _) = &self.faces[face as usize];
        let zero = [Exact::zero(), Exact::zero(), Exact::zero()];
        let at = self.start(&ExactLine { o: point.clone(), d: zero });
        let Way::Lattice(q, _) = self.ways[0] else { unreachable!() };
        let q = Exact::from(power(q, self.depth));
        let height = &dot(n, &at.o) * &q;
        let w = at.w.to_f64();
        let level = height.to_f64() / w;
        let (step, first) = match self.leaf {
            IfsLeaf::Box(..) => (2.0, 1.0),
            _ => (4.0, power(2.0, self.depth) % 4.0),
        };
        let nearest = step * ((level - first) / step).round() + first;
        (&height - &(&Exact::from(nearest) * &at.w)).sign()
    }
}

fn faces(leaf: &IfsLeaf) -> Vec<([Exact; 3], Exact)> {
    match *leaf {
        IfsLeaf::Sphere(..) => vec![],
        IfsLeaf::Box(a, b) => (0..6)
            .map(|i| {
                let (axis, sign) = (i / 2, if i % 2 == 0 { -1.0 } else { 1.0 });
                let at = if i % 2 == 0 { a[axis].min(b[axis]) } else { a[axis].max(b[axis]) };
                let mut n = [0.0; 3];
                n[axis] = sign;
                (exact3(n), Exact::from(sign * at))
            })
            .collect(),
        IfsLeaf::Tetrahedron(p) => [[1, 2, 3, 0], [0, 3, 2, 1], [0, 1, 3, 2], [0, 2, 1, 3]]
            .iter()
            .map(|&[a, b, c, other]| {
                let point = |i: usize| exact3(p[i].to_array());
                let from = |i: usize| [0, 1, 2].map(|k| &point(i)[k] - &point(a)[k]);
                let n = cross(&from(b), &from(c));
                let n = if dot(&n, &from(other)).sign().is_gt() { n.map(|x| -x) } else { n };
                let h = dot(&n, &point(a));
                (n, h)
            })
            .collect(),
    }
}

impl Oracle for Copies {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        let mut out = vec![];
        for (from, to) in self.spans(line) {
            if from.compare(&to).is_eq() {
                out.push(Crossing { t: from.surd(), sign: 0, grazing: true });
            } else {
                out.push(Crossing { t: from.surd(), sign: -1, grazing: false });
                out.push(Crossing { t: to.surd(), sign: 1, grazing: false });
            }
        }
        out
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        self.above_plane(face, point)
    }

    fn face_normal(&self, face: u32, _point: &[Exact; 3]) -> Vec3 {
        let n = Vec3::from([0, 1, 2].map(|i| self.faces[face as usize].0[i].to_f64()));
        match self.placed {
            Some(map) => {
                // Cofactors of L.
                let l = map.linear();
                let rows = [0, 1, 2].map(|i| Vec3::from(l[i]));
                let c = [rows[1].cross(rows[2]), rows[2].cross(rows[0]), rows[0].cross(rows[1])];
                let v = Vec3::from([0, 1, 2].map(|i| c[i].dot(n)));
                if map.determinant_is_negative() { -v } else { v }
            }
            None => n,
        }
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        let zero = [Exact::zero(), Exact::zero(), Exact::zero()];
        let at = self.start(&ExactLine { o: point.clone(), d: zero });
        let mut found = (0, false);
        self.corners(&at, self.depth, &mut found);
        Some(match found {
            (0xff, _) => Ordering::Less,
            (_, true) => Ordering::Equal,
            (_, false) => Ordering::Greater,
        })
    }

    fn size(&self) -> f64 {
        let size = match self.leaf {
            IfsLeaf::Sphere(_, r) => r,
            IfsLeaf::Box(a, b) => (b - a).max_abs() * 0.5,
            IfsLeaf::Tetrahedron(p) => (p[1] - p[0]).max_abs() * 0.5,
        };
        self.placed.map_or(size, |map| size * map.linear_norm() / 3_f64.sqrt())
    }

    fn is_convex(&self) -> bool {
        false
    }
}

/// Corners of copies, middles of their edges and faces, with directions along them.
fn features(q: f64, depth: u32) -> Vec<Feature> {
    let scale = power(q, depth);
    let mut out = vec![];
    let mut rng = TestRng::new(77);
    for _ in 0..200 {
        let p: [f64; 3] = [0, 1, 2].map(|_| rng.integer(-(scale as i64), scale as i64) / scale);
        let mut along = [0.0; 3];
        along[rng.below(3) as usize] = 1.0;
        out.push(Feature::new(p, along));
        out.push(Feature::new(p, [1.0, 1.0, 1.0]));
        out.push(Feature::new(p, [1.0, -1.0, 0.0]));
        out.push(Feature::new(p, [0, 1, 2].map(|_| rng.integer(-3, 3))));
    }
    out
}

fn shear() -> Affine {
    Affine::new([[0.5, 0.25, 0.0], [0.0, 1.5, -0.375], [0.125, 0.0, 0.75]], Point3::new(3.0, -1.0, 0.5))
        .unwrap()
}

fn turned() -> Affine {
    let turn = Affine::rotation(Vec3::new(1.0, 2.0, 3.0), 0.7).unwrap();
    turn.then(&Affine::translation(Vec3::new(0.3, 20.0, -7.0)).unwrap()).unwrap()
}

#[test]
fn the_sponge_of_menger_obeys_the_laws() {
    let (mut roots, mut grazing) = (0, 0);
    for (depth, rays) in [(0, 150), (1, 150), (2, 100), (3, 40)] {
        let (sponge, oracle) = (Ifs::menger(depth).unwrap(), Copies::menger(depth));
        let tally = check_many(&sponge, &oracle, &features(3.0, depth), 40 + u64::from(depth), rays);
        roots += tally.roots;
        grazing += tally.grazing;
    }
    assert!(roots > 500 && grazing > 10, "{roots} {grazing}");
}

#[test]
fn the_tetrahedron_of_sierpinski_obeys_the_laws() {
    let (mut roots, mut grazing) = (0, 0);
    for (depth, rays) in [(0, 150), (1, 150), (2, 150), (3, 100), (4, 60)] {
        let (set, oracle) = (Ifs::sierpinski(depth).unwrap(), Copies::sierpinski(depth));
        let tally = check_many(&set, &oracle, &features(2.0, depth), 50 + u64::from(depth), rays);
        roots += tally.roots;
        grazing += tally.grazing;
    }
    assert!(roots > 300 && grazing > 10, "{roots} {grazing}");
}

#[test]
fn placed_sets_obey_the_laws() {
    let mut roots = 0;
    for (k, map) in [shear(), turned()].into_iter().enumerate() {
        let near = |f: &Vec<Feature>| f.iter().map(|f| f.placed(&map)).collect::<Vec<_>>();
        let seed = 60 + k as u64;
        let sponge = Placed::new(Ifs::menger(2).unwrap(), map);
        roots +=
            check_many(&sponge, &Copies::menger(2).placed(map), &near(&features(3.0, 2)), seed, 60).roots;
        let set = Placed::new(Ifs::sierpinski(3).unwrap(), map);
        let oracle = Copies::sierpinski(3).placed(map);
        roots += check_many(&set, &oracle, &near(&features(2.0, 3)), seed, 60).roots;
    }
    assert!(roots > 100, "{roots}");
}

#[test]
fn a_far_ray_meets_two_copies_within_one_bracket() {
    let mut ray = Ray::new(
        Point3::new(3.062499999999999, -0.3437500000000001, -548312.8431143716),
        Vec3::new(0.0, 0.0, 1.0458250331675947),
    );
    ray.t_min = -524288.0;
    let set = Placed::new(Ifs::sierpinski(3).unwrap(), shear());
    crate::laws::check(&set, &Copies::sierpinski(3).placed(shear()), &ray).unwrap();
}

fn scaling(s: f64, t: [f64; 3]) -> Affine {
    Affine::new([[s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]], Point3::from(t)).unwrap()
}

/// Systems with copies that overlap, touch, and are turned, mirrored and squeezed.
fn systems() -> Vec<(IfsLeaf, Vec<Affine>, u32)> {
    let cube = IfsLeaf::Box(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
    let ball = IfsLeaf::Sphere(Point3::new(0.25, 0.0, 0.0), 0.75);
    let tetra = IfsLeaf::Tetrahedron(
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.25], [0.0, 1.0, 0.0], [0.25, 0.0, 1.0]].map(Point3::from),
    );
    let halves = vec![
        scaling(0.5, [0.5, 0.5, 0.5]),
        scaling(0.5, [-0.5, 0.5, 0.5]),
        scaling(0.5, [-0.5, -0.5, 0.5]),
        scaling(0.5, [0.5, -0.5, -0.5]),
    ];
    let turn = Affine::rotation(Vec3::new(1.0, 1.0, 0.0), 0.6).unwrap();
    let mixed = vec![
        turn.then(&scaling(0.6, [0.4, 0.0, 0.1])).unwrap(),
        Affine::new([[0.5, 0.2, 0.0], [0.0, -0.4, 0.1], [0.0, 0.0, 0.3]], Point3::new(-0.5, 0.25, 0.0))
            .unwrap(),
        scaling(0.375, [0.0, -0.75, 0.5]),
    ];
    let mut all = vec![];
    for leaf in [cube, ball, tetra] {
        all.push((leaf, halves.clone(), 3));
        all.push((leaf, mixed.clone(), 4));
        all.push((leaf, vec![scaling(0.5, [1e6, 0.0, -3.0]), scaling(0.25, [2e6, 1.0, 0.0])], 3));
    }
    all
}

#[test]
fn any_maps_obey_the_laws_of_crossings() {
    let mut met = 0;
    for (k, (leaf, maps, depth)) in systems().into_iter().enumerate() {
        let (set, oracle) = (Ifs::new(leaf, &maps, depth).unwrap(), Copies::new(leaf, &maps, depth));
        let mut rng = TestRng::new(900 + k as u64);
        let bounds = set.bounds();
        let mut aims: Vec<Feature> = vec![];
        for _ in 0..40 {
            // A corner or the centre of some copy.
            let mut p = match leaf {
                IfsLeaf::Box(a, b) => {
                    Point3::new(rng.pick(&[a.x, b.x]), rng.pick(&[a.y, b.y]), rng.pick(&[a.z, b.z]))
                }
                IfsLeaf::Sphere(c, r) => c + rng.pick(&[Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]) * r,
                IfsLeaf::Tetrahedron(p) => rng.pick(&p),
            };
            for _ in 0..depth {
                p = maps[rng.below(maps.len() as u64) as usize].point(p);
            }
            aims.push(Feature::new(p.to_array(), rng.lattice(3).to_array()));
        }
        let size = bounds.widths().max_abs();
        for i in 0..60 {
            let ray = aim(&mut TestRng::new(1000 * k as u64 + i), &aims, size);
            if !ray.is_valid() {
                continue;
            }
            let told = |why: String| panic!("{why}\n  system {k} ray {i}: {ray:?}");
            let roots = roots_are_the_exact_crossings(&set, &oracle, &ray, None).unwrap_or_else(told);
            closest_is_the_first_of_all(&set, &ray, &roots).unwrap_or_else(|why| panic!("{why} {ray:?}"));
            a_reversed_ray_meets_the_same(&set, &ray, &roots).unwrap_or_else(|why| panic!("{why} {ray:?}"));
            powers_of_two_change_nothing(&set, &ray, &roots).unwrap_or_else(|why| panic!("{why} {ray:?}"));
            met += roots.len();
            for root in &roots {
                let unit = root.t.abs().max(size / ray.direction.length());
                assert!((root.hi - root.lo) <= 96.0 * (unit.next_up() - unit), "{root:?} {ray:?}");
                let point = set.resolve(&LocalRay::new(&ray), root, Need::ALL);
                let exact = ray.at(root.t);
                let slack = ray.direction.abs() * ((root.hi - root.lo) + root.t.abs() * 1e-15);
                let room = point.dp + slack + exact.to_vec().abs() * 1e-15;
                let off = (point.p - exact).abs();
                assert!((0..3).all(|i| off[i] <= room[i]), "{point:?} {exact:?} {root:?} {ray:?}");
                if root.kind == RootKind::Simple {
                    let along = point.ng.to_vec().dot(ray.direction);
                    assert!(
                        along * f64::from(root.sign) >= -1e-9 * ray.direction.length(),
                        "{point:?} {root:?}"
                    );
                }
            }
        }
    }
    assert!(met > 400, "{met}");
}

#[test]
fn deep_sets_are_met_at_once_and_rays_in_faces_and_edges_are_met_once() {
    let sponge = Ifs::menger(20).unwrap();
    let first = |origin: [f64; 3], d: [f64; 3]| {
        let ray = Ray::new(Point3::from(origin), Vec3::from(d)).with_range(0.0, f64::INFINITY);
        let mut sink = crate::Closest::default();
        sponge.roots(&LocalRay::new(&ray), &mut sink);
        sink.root
    };
    assert_eq!(first([-3.0, 0.9, 0.95], [1.0, 0.0, 0.0]).map(|r| (r.t, r.sign)), Some((2.0, -1)));
    // Along an edge, and in a face.
    assert_eq!(first([-3.0, 1.0, 1.0], [1.0, 0.0, 0.0]).map(|r| (r.t, r.sign)), Some((2.0, -1)));
    assert_eq!(first([-3.0, 1.0, 0.9], [1.0, 0.0, 0.0]).map(|r| (r.t, r.sign)), Some((2.0, -1)));
    // Through the middle there is a hole.
    assert_eq!(first([-3.0, 0.1, 0.1], [1.0, 0.0, 0.0]), None);
    // From 1e6 away.
    assert_eq!(first([-1e6, 1.0, 1.0], [1.0, 0.0, 0.0]).map(|r| r.t), Some(999_999.0));
    // Beside an edge by less than the rounding of the ray.
    assert_eq!(first([-1e6, 1.0_f64.next_up(), 1.0], [1.0, 0.0, 0.0]), None);
    let whole = Ifs::menger(3).unwrap();
    let edge = Ray::new(Point3::new(-3.0, 1.0, 1.0), Vec3::X);
    let signs: Vec<_> = all_roots(&whole, &edge).iter().map(|r| (r.t, r.sign)).collect();
    assert_eq!(signs, [(2.0, -1), (4.0, 1)]);
}

#[test]
fn chords_add_up_to_the_volume() {
    // Midpoints of a grid that no plane of the set passes through.
    let volume = |set: &Ifs, n: u32| {
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let at = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(n) - 1.0;
                let ray = Ray::new(Point3::new(at(i), at(j), -3.0), Vec3::Z);
                sum += all_roots(set, &ray).iter().map(|r| f64::from(r.sign) * r.t).sum::<f64>();
            }
        }
        sum * 4.0 / f64::from(n * n)
    };
    for depth in 1..=3 {
        // Of each column of copies the middle is met, so the sum is exact.
        let n = 3_u32.pow(depth);
        let exact = 8.0 * power(20.0 / 27.0, depth);
        let found = volume(&Ifs::menger(depth).unwrap(), n);
        assert!((found - exact).abs() < 1e-12, "{depth}: {found} {exact}");
    }
    for depth in 1..=4 {
        // The copies' shadows tile the square. Over each the chord is linear in four parts, of which
        // the rule of midpoints with m x m points makes 2 / m^2 too much.
        let m = f64::from(96 >> depth);
        let exact = 8.0 / 3.0 * power(0.5, depth) * (1.0 + 2.0 / (m * m));
        let found = volume(&Ifs::sierpinski(depth).unwrap(), 96);
        assert!((found / exact - 1.0).abs() < 1e-9, "{depth}: {found} {exact}");
    }
}

#[test]
fn sides_are_exact_where_copies_meet() {
    let side = |set: &Ifs, p: [f64; 3]| set.side(&LocalPoint::new(Point3::from(p)));
    // Four halves of a slab, glued: maps to the eight octants fill the cube.
    let mut octants = vec![];
    for i in 0..8 {
        octants.push(scaling(0.5, [0, 1, 2].map(|k| if i >> k & 1 == 1 { 0.5 } else { -0.5 })));
    }
    let cube = IfsLeaf::Box(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
    let full = Ifs::new(cube, &octants, 2).unwrap();
    assert_eq!(side(&full, [0.0, 0.0, 0.0]), Side::In);
    assert_eq!(side(&full, [0.5, 0.0, 0.3]), Side::In);
    assert_eq!(side(&full, [1.0, 0.0, 0.0]), Side::On);
    assert_eq!(side(&full, [1.0, 1.0, 1.0]), Side::On);
    assert_eq!(side(&full, [1.0, 1.0, 1.5]), Side::Out);
    let line = Ray::new(Point3::new(-3.0, 0.0, 0.0), Vec3::X);
    assert_eq!(all_roots(&full, &line).iter().map(|r| r.t).collect::<Vec<_>>(), [2.0, 4.0]);
    let seven = Ifs::new(cube, &octants[..7], 1).unwrap();
    assert_eq!(side(&seven, [0.0, 0.0, 0.0]), Side::On);
    assert_eq!(side(&seven, [0.0, -0.5, -0.5]), Side::In);
    // Balls that overlap cover a corner of theirs, balls that touch do not.
    let ball = IfsLeaf::Sphere(Point3::ORIGIN, 1.0);
    let two =
        |x: f64| Ifs::new(ball, &[scaling(0.5, [x, 0.0, 0.0]), scaling(0.5, [-x, 0.0, 0.0])], 1).unwrap();
    assert_eq!(side(&two(0.5), [0.0, 0.0, 0.0]), Side::On);
    assert_eq!(side(&two(0.25), [0.0, 0.0, 0.0]), Side::In);
    let sponge = Ifs::menger(1).unwrap();
    assert_eq!(side(&sponge, [0.0, 0.0, 0.0]), Side::Out);
    assert_eq!(side(&sponge, [0.9, 0.9, 0.0]), Side::In);
    assert_eq!(side(&sponge, [1.0, 0.9, 0.0]), Side::On);
}

#[test]
fn wrong_systems_are_named() {
    let cube = IfsLeaf::Box(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0));
    let half = scaling(0.5, [0.0; 3]);
    assert_eq!(Ifs::new(cube, &[], 1), Err(IfsError::NoMap));
    assert_eq!(Ifs::menger(21), Err(IfsError::Depth(21)));
    assert_eq!(Ifs::new(cube, &[half], 40), Err(IfsError::Depth(40)));
    let turn = Affine::rotation(Vec3::new(1.0, 2.0, 0.5), 1.0).unwrap();
    let wide = turn.then(&Affine::scaling(1.25, 0.5, 0.5).unwrap()).unwrap();
    let Err(IfsError::Expands { map: 2, value }) = Ifs::new(cube, &[half, wide], 2) else { panic!() };
    assert!((value - 1.25).abs() < 1e-12, "{value}");
    // Exactly 1 does not contract; a little less does.
    assert!(matches!(Ifs::new(cube, &[scaling(1.0, [1.0, 0.0, 0.0])], 2), Err(IfsError::Expands { .. })));
    assert!(Ifs::new(cube, &[scaling(1.0_f64.next_down(), [0.0; 3])], 2).is_ok());
    let flat = IfsLeaf::Box(Point3::ORIGIN, Point3::new(1.0, 0.0, 1.0));
    assert!(matches!(Ifs::new(flat, &[half], 2), Err(IfsError::Box(_))));
    let none = IfsLeaf::Sphere(Point3::ORIGIN, 0.0);
    assert!(matches!(Ifs::new(none, &[half], 2), Err(IfsError::Sphere(_))));
    let plane =
        IfsLeaf::Tetrahedron([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]].map(Point3::from));
    assert_eq!(Ifs::new(plane, &[half], 2), Err(IfsError::Tetrahedron));
    let many: Vec<Affine> = (0..40).map(|i| scaling(0.5, [f64::from(i), 0.0, 0.0])).collect();
    assert_eq!(Ifs::new(cube, &many, 20), Err(IfsError::TooMany { maps: 40, depth: 20 }));
}

/// `x` times itself, so many times; exact where all products are.
fn power(x: f64, times: u32) -> f64 {
    (0..times).fold(1.0, |product, _| product * x)
}
