//! Sheets against the same triangles one by one, and against exact arithmetic over all triangles.

use super::*;
use crate::laws::{
    self, Crossing, Exact, ExactLine, Feature, LineCache, Oracle, Surd, TestRng, TestSurface, aim, all_roots,
    exact3, roots_are_the_exact_crossings,
};
use crate::{Placed, Triangle};
use durer_math::{Affine, Ray, elementary};

/// All triangles of a sheet, by exact arithmetic. With `walls` it is the solid, whose crossings are
/// those with the planes over the borders as well.
#[derive(Debug)]
struct Facets {
    faces: Vec<Facet>,
    water_level: f64,
    cells: [u32; 2],
    is_solid: bool,
    known: LineCache<Option<Vec<Crossing>>>,
}

impl Facets {
    fn of<H: Heights>(sheet: &Sheet<H>) -> Self {
        let faces = (0..sheet.heights().faces()).filter_map(|face| sheet.facet(face)).collect();
        Self {
            faces,
            water_level: sheet.water_level,
            cells: sheet.heights().cells(),
            is_solid: sheet.is_solid,
            known: LineCache::default(),
        }
    }

    fn cross(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
    }

    fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
        &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
    }

    fn minus(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
        [0, 1, 2].map(|i| &a[i] - &b[i])
    }

    fn normal(facet: &Facet) -> [Exact; 3] {
        let [a, b, c] = facet.map(|p| exact3(p.to_array()));
        Self::cross(&Self::minus(&b, &a), &Self::minus(&c, &a))
    }

    /// All crossings, ascending; `None` if the line meets an edge, runs within a triangle or meets
    /// the water's edge.
    fn met(&self, line: &ExactLine) -> Option<Vec<Crossing>> {
        self.known.get(line, || self.find(line))
    }

    fn find(&self, line: &ExactLine) -> Option<Vec<Crossing>> {
        let mut found: Vec<(Exact, Exact, i8)> = vec![];
        for facet in &self.faces {
            let points = facet.map(|p| Self::minus(&exact3(p.to_array()), &line.o));
            let side = |a: &[Exact; 3], b: &[Exact; 3]| Self::dot(&line.d, &Self::cross(b, a)).sign();
            let [a, b, c] = &points;
            let sides = [side(b, c), side(c, a), side(a, b)];
            if sides.contains(&Ordering::Less) && sides.contains(&Ordering::Greater) {
                continue;
            }
            if sides.contains(&Ordering::Equal) {
                return None;
            }
            let normal = Self::normal(facet);
            let slope = Self::dot(&normal, &line.d);
            let height = Self::dot(&normal, a);
            let (n, d) =
                if slope.sign().is_lt() { (-height, -slope.clone()) } else { (height, slope.clone()) };
            if !self.is_solid && self.water_level.is_finite() {
                let level = Exact::from(self.water_level);
                let over = &(&(&line.o[1] * &d) + &(&line.d[1] * &n)) - &(&level * &d);
                match over.sign() {
                    Ordering::Less => continue,
                    Ordering::Equal => return None,
                    Ordering::Greater => {}
                }
            }
            found.push((n, d, slope.sign() as i8));
        }
        if self.is_solid {
            self.find_walls(line, &mut found)?;
        }
        found.sort_by(|(n, d, _), (m, e, _)| (&(n * e) - &(m * d)).sign());
        let crossing = |(n, d, sign)| Crossing { t: Surd::ratio(n, d), sign, grazing: false };
        Some(found.into_iter().map(crossing).collect())
    }

    fn find_walls(&self, line: &ExactLine, found: &mut Vec<(Exact, Exact, i8)>) -> Option<()> {
        for (axis, at) in [(0, 0.0), (0, 1.0), (2, 0.0), (2, 1.0)] {
            let slope = line.d[axis].clone();
            let height = &Exact::from(at) - &line.o[axis];
            if slope.sign().is_eq() {
                if height.sign().is_eq() {
                    return None;
                }
                continue;
            }
            let (n, d) =
                if slope.sign().is_lt() { (-height, -slope.clone()) } else { (height, slope.clone()) };
            let p = [0, 1, 2].map(|i| &(&line.o[i] * &d) + &(&line.d[i] * &n));
            let far = &p[2 - axis] - &d;
            match (p[2 - axis].sign(), far.sign()) {
                (Ordering::Less, _) | (_, Ordering::Greater) => continue,
                (Ordering::Greater, Ordering::Less) => {}
                _ => return None,
            }
            match self.over(&p, &d)? {
                Ordering::Less => {}
                Ordering::Equal => return None,
                Ordering::Greater => continue,
            }
            let out = if at == 0.0 { -1 } else { 1 };
            found.push((n, d, out * slope.sign() as i8));
        }
        Some(())
    }

    /// Whether the point `p / d` is above the sheet, with the whole square below it; `None` above an
    /// inner vertical.
    fn over(&self, p: &[Exact; 3], d: &Exact) -> Option<Ordering> {
        for facet in &self.faces {
            let at = facet.map(|v| exact3(v.to_array()));
            let flat = |a: &[Exact; 3], b: &[Exact; 3]| {
                let (ex, ez) = (&b[0] - &a[0], &b[2] - &a[2]);
                let (px, pz) = (&p[0] - &(&a[0] * d), &p[2] - &(&a[2] * d));
                (&(&ez * &px) - &(&ex * &pz)).sign()
            };
            let sides = [flat(&at[0], &at[1]), flat(&at[1], &at[2]), flat(&at[2], &at[0])];
            if sides.contains(&Ordering::Less) && sides.contains(&Ordering::Greater) {
                continue;
            }
            let normal = Self::normal(facet);
            let q = [0, 1, 2].map(|i| &p[i] - &(&at[0][i] * d));
            return Some(Self::dot(&normal, &q).sign());
        }
        None
    }

    fn facet_of(&self, face: u32) -> Facet {
        if let Some(facet) = self.faces.get(face as usize) {
            return *facet;
        }
        let [columns, rows] = self.cells;
        let n = face - 2 * columns * rows;
        let at = |x: f64, z: f64| Point3::new(x, 0.0, z);
        let [a, b] = if n < rows {
            [at(0.0, 0.0), at(0.0, 1.0)]
        } else if n < 2 * rows {
            [at(1.0, 1.0), at(1.0, 0.0)]
        } else if n < 2 * rows + columns {
            [at(1.0, 0.0), at(0.0, 0.0)]
        } else {
            [at(0.0, 1.0), at(1.0, 1.0)]
        };
        [a, b, a + Vec3::Y]
    }

    /// Whether a ray's laws can be tested: no ray that leaves along a normal meets an edge.
    fn is_clear(&self, surface: &dyn TestSurface, ray: &Ray) -> bool {
        let is_plain = |ray: &Ray| {
            self.met(&ExactLine::new(ray)).is_some_and(|met| {
                let t: Vec<f64> = met.iter().map(|c| c.t.about(700).to_f64()).collect();
                t.windows(2).all(|t| t[1] - t[0] > 1e-12 * t[0].abs().max(t[1].abs()))
            })
        };
        is_plain(ray)
            && all_roots(surface, ray).iter().all(|root| {
                let point = surface.resolve(&LocalRay::new(ray), root, Need::POINT);
                let n = point.ng.to_vec();
                use durer_math::RaySide::{Back, Front};
                is_plain(&point.spawn_from(Front, n)) && is_plain(&point.spawn_from(Back, -n))
            })
    }
}

impl Oracle for Facets {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        self.met(line).unwrap_or_default()
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        let facet = self.facet_of(face);
        Self::dot(&Self::normal(&facet), &Self::minus(point, &exact3(facet[0].to_array()))).sign()
    }

    fn face_normal(&self, face: u32, _: &[Exact; 3]) -> Vec3 {
        Vec3::from(Self::normal(&self.facet_of(face)).map(|x| x.to_f64()))
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        if !self.is_solid {
            return None;
        }
        let one = Exact::from(1.0);
        let (mut inner, mut on) = (true, false);
        for axis in [0, 2] {
            let ends = [point[axis].sign(), (&one - &point[axis]).sign()];
            inner &= !ends.contains(&Ordering::Less);
            on |= ends.contains(&Ordering::Equal);
        }
        if !inner {
            return Some(Ordering::Greater);
        }
        let over = self.over(point, &one).unwrap_or(Ordering::Greater);
        Some(if over.is_lt() && on { Ordering::Equal } else { over })
    }

    fn size(&self) -> f64 {
        1.0
    }

    fn is_convex(&self) -> bool {
        false
    }
}

fn field(columns: usize, rows: usize, seed: u64, choices: &[u16]) -> HeightField {
    let mut dice = TestRng::new(seed);
    let word = |_| if choices.is_empty() { dice.below(65536) as u16 } else { dice.pick(choices) };
    HeightField::from_words([columns, rows], (0..columns * rows).map(word).collect()).unwrap()
}

fn numbers(columns: usize, rows: usize, seed: u64) -> HeightField {
    let mut dice = TestRng::new(seed);
    HeightField::new([columns, rows], (0..columns * rows).map(|_| dice.unit()).collect()).unwrap()
}

fn terrain() -> Terrain {
    let corners = [0.0, 0.5, -0.25, 0.125];
    Terrain::new(TerrainData { levels: 3, seed: 5, corners, ..TerrainData::default() }).unwrap()
}

fn fields() -> Vec<HeightField> {
    vec![
        field(2, 2, 1, &[]),
        field(2, 2, 2, &[32768]),
        field(4, 3, 3, &[0, 32768]),
        field(9, 9, 4, &[]),
        field(5, 17, 5, &[0, 16384, 16384, 16384, 65535]),
        field(3, 9, 6, &[0]),
        field(6, 7, 7, &[]).with_water_level(0.5),
        field(5, 5, 8, &[0, 32768, 32769]).with_water_level(0.5),
        numbers(8, 5, 9),
        numbers(7, 6, 10).with_water_level(0.3).smooth(),
    ]
}

/// Vertices, middles of edges and of triangles, with the directions of edges.
fn features<H: Heights>(sheet: &Sheet<H>) -> Vec<Feature> {
    let mut all = vec![];
    for facet in (0..sheet.heights().faces()).filter_map(|face| sheet.facet(face)) {
        let [a, b, c] = facet;
        all.push(Feature { point: a, direction: b - a });
        all.push(Feature { point: a + (b - a) * 0.5, direction: c - b });
        all.push(Feature { point: b + (c - b) * 0.5, direction: b - c });
        let middle = a + ((b - a) + (c - a)) * 0.3125;
        all.push(Feature { point: middle, direction: Vec3::Y });
        all.push(Feature { point: middle, direction: c - a });
    }
    all
}

fn triangles_of<H: Heights>(sheet: &Sheet<H>) -> Vec<Triangle> {
    let facets = (0..sheet.heights().faces()).filter_map(|face| sheet.facet(face));
    facets.map(|facet| Triangle::new(facet).unwrap()).collect()
}

/// The roots of all triangles, each with its number as the face.
fn roots_of(triangles: &[Triangle], map: Option<Affine>, ray: &Ray) -> Vec<Root> {
    let numbered = triangles.iter().enumerate().flat_map(|(face, triangle)| {
        let roots = match map {
            None => all_roots(triangle, ray),
            Some(map) => all_roots(&Placed::new(triangle.clone(), map), ray),
        };
        roots.into_iter().map(move |root| Root { face: face as u32, ..root })
    });
    numbered.collect()
}

/// A root without `t`, which depends on the exact order, which triangles do not have.
type Unordered = (u32, i8, [f64; 2], f64, [f64; 2]);

fn by_face(roots: &[Root]) -> Vec<Unordered> {
    let mut all: Vec<_> = roots.iter().map(|r| (r.face, r.sign, [r.lo, r.hi], r.s, r.tag)).collect();
    all.sort_by_key(|r| r.0);
    all
}

fn same_as_triangles<H: Heights>(sheet: &Sheet<H>, seed: u64) -> (usize, usize) {
    assert!(sheet.water_level <= sheet.range[0]);
    let triangles = triangles_of(sheet);
    let features = features(sheet);
    let (mut rays, mut hits) = (0, 0);
    for i in laws::drawn(1500) {
        let mut dice = laws::dice(seed, i);
        let ray = aim(&mut dice, &features, 1.0);
        if !ray.is_valid() {
            continue;
        }
        let roots = all_roots(sheet, &ray);
        let expected = roots_of(&triangles, None, &ray);
        assert_eq!(by_face(&roots), by_face(&expected), "{ray:?} {i} {sheet:?}");
        assert!(roots.windows(2).all(|w| w[0].t <= w[1].t), "{roots:?}");
        let mut closest = crate::Closest::default();
        sheet.roots(&LocalRay::new(&ray), &mut closest);
        assert_eq!(closest.root, roots.first().copied(), "{ray:?}");
        let map = dice.map();
        let target = map.point(dice.pick(&features).point);
        let direction = map.vector(ray.direction);
        let back = dice.pick(&[3.0, 1e3, 1e6]) / direction.max_abs();
        let moved = Ray::new(target - direction * back, direction);
        if moved.is_valid() {
            let (a, b) = (
                all_roots(&Placed::new(sheet.clone(), map), &moved),
                roots_of(&triangles, Some(map), &moved),
            );
            assert_eq!(by_face(&a), by_face(&b), "{moved:?} {map:?} {i} {sheet:?}");
            hits += a.len();
        }
        rays += 1;
        hits += roots.len();
    }
    (rays, hits)
}

#[test]
fn a_sheet_is_met_as_each_of_its_triangles() {
    let (mut rays, mut hits) = (0, 0);
    let mut add = |(r, h)| {
        rays += r;
        hits += h;
    };
    for (seed, sheet) in fields().iter().enumerate() {
        let mut sheet = sheet.clone();
        sheet.water_level = f64::NEG_INFINITY;
        add(same_as_triangles(&sheet, 50 + seed as u64));
    }
    add(same_as_triangles(&terrain(), 90));
    laws::report(rays as u64);
    assert!(rays > 10_000 && hits > 10_000, "{rays} {hits}");
}

/// Checks all laws, or only the crossings where rays along a normal meet an edge; how many rays and
/// roots there were.
fn obeys<H: Heights>(sheet: &Sheet<H>, seed: u64, count: u64) -> (u64, usize) {
    let oracle = Facets::of(sheet);
    let features = features(sheet);
    let (mut rays, mut hits) = (0, 0);
    for i in laws::drawn(count) {
        let ray = aim(&mut laws::dice(seed, i), &features, 1.0);
        if !ray.is_valid() || oracle.met(&ExactLine::new(&ray)).is_none() {
            continue;
        }
        let met = if oracle.is_clear(sheet, &ray) {
            laws::check(sheet, &oracle, &ray)
        } else {
            roots_are_the_exact_crossings(sheet, &oracle, &ray, None)
        };
        hits += met.unwrap_or_else(|broken| panic!("{broken}\n  {i} of {seed}: {ray:?}\n  {sheet:?}")).len();
        rays += 1;
    }
    (rays, hits)
}

#[test]
fn sheets_obey_the_laws_off_their_edges() {
    let (mut rays, mut hits) = (0, 0);
    let mut add = |(r, h)| {
        rays += r;
        hits += h;
    };
    for (seed, sheet) in fields().iter().enumerate() {
        add(obeys(sheet, seed as u64, 200));
    }
    add(obeys(&terrain(), 20, 200));
    add(obeys(&terrain().with_water_level(0.1), 21, 200));
    laws::report(rays);
    assert!(rays > 1000 && hits > 800, "{rays} {hits}");
}

#[test]
fn solids_obey_the_laws_off_their_edges() {
    let (mut rays, mut hits) = (0, 0);
    let mut add = |(r, h)| {
        rays += r;
        hits += h;
    };
    for (seed, sheet) in fields().iter().enumerate() {
        add(obeys(&sheet.clone().solid(), 100 + seed as u64, 200));
    }
    add(obeys(&terrain().solid(), 120, 200));
    laws::report(rays);
    assert!(rays > 1000 && hits > 800, "{rays} {hits}");
}

#[test]
fn a_solid_is_entered_and_left_in_turn() {
    let mut through = 0;
    for (seed, sheet) in fields().iter().enumerate() {
        let solid = sheet.clone().solid();
        let features = features(&solid);
        for i in laws::drawn(400) {
            let mut dice = laws::dice(200 + seed as u64, i);
            // Through vertices and along borders and edges.
            let (a, b) = (dice.pick(&features).point, dice.pick(&features).point);
            let direction = if dice.once_in(2) { b - a } else { dice.lattice(2) };
            if direction == Vec3::ZERO {
                continue;
            }
            let ray = Ray::new(a - direction * dice.pick(&[4.0, 1024.0]), direction);
            let roots = all_roots(&solid, &ray.with_range(f64::NEG_INFINITY, f64::INFINITY));
            assert!(roots.windows(2).all(|w| w[0].sign == -w[1].sign), "{roots:?} {ray:?} {i} {solid:?}");
            // Far away it is inside only straight below.
            let is_steep = direction.x == 0.0 && direction.z == 0.0;
            assert!(is_steep || roots.len().is_multiple_of(2), "{roots:?} {ray:?} {solid:?}");
            through += usize::from(!roots.is_empty());
        }
    }
    assert!(through > 1000, "{through}");
}

#[test]
fn terrain_is_bounded_and_its_own_at_every_point() {
    let terrain = Terrain::new(TerrainData { levels: 6, seed: 11, ..TerrainData::default() }).unwrap();
    let heights = terrain.heights();
    fn below(heights: &Midpoints, block: Block, data: [f64; 4]) {
        let corner =
            |i: u32, j: u32| heights.height((block.i + i) << block.level, (block.j + j) << block.level);
        assert_eq!(data, [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)], "{block:?}");
        let [low, high] = heights.range(block, data);
        for i in block.i << block.level..=(block.i + 1) << block.level {
            for j in block.j << block.level..=(block.j + 1) << block.level {
                let height = heights.height(i, j);
                assert!(low <= height && height <= high, "{block:?}");
            }
        }
        if block.level > 0 {
            for (k, data) in heights.quarters(block, data).into_iter().enumerate() {
                below(heights, block.quarter(k), data);
            }
        }
    }
    let (block, data) = heights.whole();
    below(heights, block, data);
}

/// The recipe as it is written down, over the whole grid.
#[test]
fn terrain_follows_its_recipe_to_the_bit() {
    let data =
        TerrainData { levels: 4, roughness: 0.7, amplitude: 0.3, seed: 42, corners: [0.1, 0.2, -0.3, 0.4] };
    let terrain = Terrain::new(data).unwrap();
    let n = 1_usize << data.levels;
    let mut h = vec![vec![0.0_f64; n + 1]; n + 1];
    (h[0][0], h[n][0], h[0][n], h[n][n]) =
        (data.corners[0], data.corners[1], data.corners[2], data.corners[3]);
    for l in 1..=data.levels {
        let s = 1 << (data.levels - l);
        let fall = elementary::exp2(-data.roughness * f64::from(l - 1));
        let e = |i: usize, j: usize| {
            let mut z = data.seed.wrapping_mul(0x9E3779B97F4A7C15);
            z = z.wrapping_add((i as u64).wrapping_mul(0xBF58476D1CE4E5B9));
            z = z.wrapping_add((j as u64).wrapping_mul(0x94D049BB133111EB));
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58476D1CE4E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D049BB133111EB);
            z ^= z >> 31;
            let r = (z >> 11) as f64 / 9007199254740992.0;
            data.amplitude * fall * (2.0 * r - 1.0)
        };
        for i in (0..=n).step_by(s) {
            for j in (0..=n).step_by(s) {
                match (i / s % 2, j / s % 2) {
                    (1, 0) => h[i][j] = (h[i - s][j] + h[i + s][j]) / 2.0 + e(i, j),
                    (0, 1) => h[i][j] = (h[i][j - s] + h[i][j + s]) / 2.0 + e(i, j),
                    (1, 1) => h[i][j] = (h[i + s][j - s] + h[i - s][j + s]) / 2.0 + e(i, j),
                    _ => {}
                }
            }
        }
    }
    for (i, column) in h.iter().enumerate() {
        for (j, &height) in column.iter().enumerate() {
            assert_eq!(terrain.heights().height(i as u32, j as u32), height, "{i} {j}");
        }
    }
}

#[test]
fn bad_numbers_are_named() {
    let new = |size, heights| HeightField::new(size, heights).unwrap_err().to_string();
    assert_eq!(new([1, 2], vec![]), "height field: a side must have from 2 to 65536 samples, got 1 x 2");
    assert_eq!(new([2, 2], vec![0.0; 3]), "height field: 4 heights are needed, got 3");
    assert_eq!(
        new([2, 2], vec![0.0, 0.0, 0.0, f64::NAN]),
        "height field: the height in column 1 of row 1 must be finite, below 1e300, got NaN"
    );
    let wrong = |data| Terrain::new(data).unwrap_err();
    let good = TerrainData::default();
    assert_eq!(wrong(TerrainData { levels: 16, ..good }), TerrainError::Levels(16));
    assert_eq!(wrong(TerrainData { roughness: 0.0, ..good }), TerrainError::Roughness(0.0));
    assert_eq!(wrong(TerrainData { amplitude: -1.0, ..good }), TerrainError::Amplitude(-1.0));
}

/// Values of `trace` in POV-Ray: as it is, and scaled by 4, 65536 and 4.
#[test]
fn normals_for_shading_are_those_of_the_scene_language() {
    let heights: Vec<f64> = (0..25_u32)
        .map(|k| {
            let (x, y) = (f64::from(k % 5) * 0.25, f64::from(k / 5) * 0.25);
            let height = 0.5 + 0.3 * elementary::sin(7.0 * x) * elementary::cos(5.0 * y);
            (height * 65536.0).floor() / 65536.0
        })
        .collect();
    let field = HeightField::new([5, 5], heights).unwrap().smooth();
    let scaled = Affine::scaling(4.0, 65536.0, 4.0).unwrap();
    let at = |field: &HeightField, x: f64, z: f64| {
        let ray = Ray::new(Point3::new(x, 2.0, z), Vec3::new(0.0, -1.0, 0.0));
        let roots = all_roots(field, &ray);
        field.resolve(&LocalRay::new(&ray), &roots[0], Need::SHADING_NORMAL).ns.to_vec()
    };
    let close = |n: Vec3, to: [f64; 3]| {
        let way = n - Vec3::new(to[0], to[1], to[2]);
        assert!(way.max_abs() < 2e-6, "{n:?} instead of {to:?}");
    };
    close(at(&field, 0.3, 0.6), [-0.071_968_8, 0.810_837_0, -0.580_830_2]);
    close(at(&field.clone().shown_in(Some(&scaled)), 0.3, 0.6), [-0.059_298_3, 0.853_280_3, -0.518_069_8]);
}
