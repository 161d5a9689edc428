//! Every surface of a scene keeps its own texture and interior, however unions, merges,
//! intersections, differences, placements, copies and instances are nested.
//!
//! Random scenes are written as text, one colour and one index of refraction for each object that
//! has its own. What a ray sees first is worked out a second time from the tree that the text was
//! written from: by the rules of sets, with the crossings of spheres, boxes and planes in closed
//! form. Rays on which two crossings are too near to each other to be put in order are left out.

use durer::geometry::{Geometry, Hits8, Rays8, Scratch, Sources8};
use durer::math::{F8, M8, Ray, Vec3, elementary};
use durer::pov::ReadOptions;
use durer::scene::{Lowered, PigmentBody, TextureBody, mask};
use durer::surfaces::Need;
use durer_testkit::TestRng;
use std::fmt::Write as _;

/// Draws that only these tests need.
trait Draws {
    /// Between -1 and 1, three digits.
    fn thousandth(&mut self) -> f64;
    fn coordinates(&mut self, size: f64) -> [f64; 3];
}

impl Draws for TestRng {
    fn thousandth(&mut self) -> f64 {
        (self.below(2001) as f64 - 1000.0) / 1000.0
    }

    fn coordinates(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.thousandth() * size)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Leaf {
    Sphere([f64; 3], f64),
    Box([f64; 3], [f64; 3]),
    /// A box of triangles.
    Mesh([f64; 3], [f64; 3]),
    Plane([f64; 3], f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Union,
    Merge,
    Intersection,
    Difference,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// About an axis by right angles and a bit.
    Rotate(usize, f64),
    Scale([f64; 3]),
    Move([f64; 3]),
}

#[derive(Clone, Debug)]
enum Kind {
    Leaf(Leaf),
    Parts(Operation, Vec<Tree>),
}

#[derive(Clone, Debug)]
struct Tree {
    kind: Kind,
    steps: Vec<Step>,
    colour: Option<u32>,
    ior: Option<u32>,
    inverse: bool,
    no_shadow: bool,
    /// The name under which the object was declared, without its last steps, colour and interior.
    name: Option<usize>,
}

/// A scene under construction.
struct Writer {
    dice: TestRng,
    text: String,
    /// Objects with names.
    named: Vec<Tree>,
    looks: u32,
}

impl Writer {
    fn look(&mut self) -> u32 {
        self.looks += 1;
        self.looks
    }

    fn leaf(&mut self) -> Leaf {
        let dice = &mut self.dice;
        let corner = dice.coordinates(1.2);
        let size = [0; 3].map(|_| 0.5 + dice.thousandth().abs());
        let opposite = [0, 1, 2].map(|i| corner[i] + size[i]);
        match dice.below(8) {
            0..=3 => Leaf::Sphere(corner, size[0]),
            4 | 5 => Leaf::Box(corner, opposite),
            6 => Leaf::Mesh(corner, opposite),
            _ => Leaf::Plane(loop_until(|| dice.coordinates(1.0), |n| dot(*n, *n) > 0.1), dice.thousandth()),
        }
    }

    /// A tree at most so deep. Solids within solids have no sheets, and all that we write is solid.
    fn tree(&mut self, depth: u64) -> Tree {
        if !self.named.is_empty() && self.dice.once_in(6) {
            let at = self.dice.below(self.named.len() as u64) as usize;
            let mut copy = self.named[at].clone();
            copy.name = Some(at);
            self.dress(&mut copy);
            return copy;
        }
        let kind = if depth == 0 || self.dice.once_in(4) {
            Kind::Leaf(self.leaf())
        } else {
            let count = 2 + self.dice.below(2);
            let operation = [
                Operation::Union,
                Operation::Union,
                Operation::Merge,
                Operation::Intersection,
                Operation::Difference,
            ][self.dice.below(5) as usize];
            Kind::Parts(operation, (0..count).map(|_| self.tree(depth - 1)).collect())
        };
        let mut tree = Tree {
            kind,
            steps: Vec::new(),
            colour: None,
            ior: None,
            inverse: false,
            no_shadow: false,
            name: None,
        };
        self.dress(&mut tree);
        if self.dice.once_in(6) {
            let text = self.written(&tree);
            let _ = writeln!(self.text, "#declare N{} = {text}", self.named.len());
            self.named.push(tree.clone());
            tree.name = Some(self.named.len() - 1);
        }
        tree
    }

    /// Adds what may follow an object's parts.
    fn dress(&mut self, tree: &mut Tree) {
        if tree.colour.is_none() && !self.dice.once_in(3) {
            tree.colour = Some(self.look());
        }
        if tree.ior.is_none() && self.dice.once_in(3) {
            tree.ior = Some(self.look());
        }
        for _ in 0..self.dice.below(3) {
            let step = match self.dice.below(3) {
                0 => {
                    let axis = self.dice.below(3) as usize;
                    Step::Rotate(axis, self.dice.thousandth() * 180.0)
                }
                1 => Step::Scale([0; 3].map(|_| 0.7 + self.dice.thousandth().abs())),
                _ => Step::Move(self.dice.coordinates(0.8)),
            };
            tree.steps.push(step);
        }
    }

    /// The object as text.
    fn written(&self, tree: &Tree) -> String {
        let mut text = String::new();
        let mut known = (0, None, None, false);
        match (tree.name, &tree.kind) {
            (Some(name), _) => {
                let named = &self.named[name];
                known = (named.steps.len(), named.colour, named.ior, named.inverse);
                let _ = write!(text, "object {{ N{name}");
            }
            (None, Kind::Leaf(leaf)) => text.push_str(&written_leaf(*leaf)),
            (None, Kind::Parts(operation, parts)) => {
                let _ = write!(text, "{} {{", format!("{operation:?}").to_lowercase());
                parts.iter().for_each(|part| text.push_str(&self.written(part)));
            }
        }
        for step in &tree.steps[known.0..] {
            let _ = match step {
                Step::Rotate(axis, by) => write!(text, " rotate {by}*{}", ["x", "y", "z"][*axis]),
                Step::Scale(by) => write!(text, " scale {}", list(*by)),
                Step::Move(by) => write!(text, " translate {}", list(*by)),
            };
        }
        if let Some(colour) = tree.colour.filter(|_| known.1.is_none()) {
            let _ = write!(text, " pigment {{ rgb <{colour},0,0> }}");
        }
        if let Some(ior) = tree.ior.filter(|_| known.2.is_none()) {
            let _ = write!(text, " interior {{ ior {ior} }}");
        }
        if tree.inverse != known.3 {
            text.push_str(" inverse");
        }
        if tree.no_shadow {
            text.push_str(" no_shadow");
        }
        text + " }\n"
    }
}

fn loop_until<T>(mut make: impl FnMut() -> T, is_good: impl Fn(&T) -> bool) -> T {
    loop {
        let made = make();
        if is_good(&made) {
            return made;
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn list([x, y, z]: [f64; 3]) -> String {
    format!("<{x},{y},{z}>")
}

fn written_leaf(leaf: Leaf) -> String {
    match leaf {
        Leaf::Sphere(c, r) => format!("sphere {{ {}, {r}", list(c)),
        Leaf::Box(a, b) => format!("box {{ {}, {}", list(a), list(b)),
        Leaf::Plane(n, d) => format!("plane {{ {}, {d}", list(n)),
        Leaf::Mesh(a, b) => {
            let corners = (0..8).map(|i: usize| {
                let pick = |k: usize| if i >> k & 1 == 0 { a[k] } else { b[k] };
                list([pick(0), pick(1), pick(2)])
            });
            let corners = corners.collect::<Vec<_>>().join(",");
            let faces = "<0,1,3>,<0,2,3>,<4,5,7>,<4,6,7>,<0,1,5>,<0,4,5>,<2,3,7>,<2,6,7>,<0,2,6>,<0,4,6>,<1,3,7>,<1,5,7>";
            format!(
                "mesh2 {{ vertex_vectors {{ 8,{corners} }} face_indices {{ 12,{faces} }} inside_vector <0.3,0.5,0.8>"
            )
        }
    }
}

/// What is known of a node on a ray.
#[derive(Clone, Debug)]
struct Seen {
    /// Where its inside begins or ends; before the first it is outside, or inside if `first`.
    changes: Vec<f64>,
    first: bool,
    /// Its surfaces, each with its colour and interior.
    surfaces: Vec<(f64, Look)>,
}

/// Colour and index of refraction; 0 where there is none.
type Look = (u32, u32);

impl Seen {
    fn holds(&self, t: f64) -> bool {
        self.first ^ (self.changes.iter().filter(|&&c| c < t).count() % 2 == 1)
    }
}

/// The ray's crossings of a leaf; `None` if they are not sure.
fn crossings(leaf: Leaf, o: [f64; 3], d: [f64; 3]) -> Option<(bool, Vec<f64>)> {
    Some(match leaf {
        Leaf::Sphere(c, r) => {
            let m = [0, 1, 2].map(|i| o[i] - c[i]);
            let (a, b, c) = (dot(d, d), dot(m, d), dot(m, m) - r * r);
            let disc = b * b - a * c;
            if disc.abs() < 1e-7 * a * r * r {
                return None;
            }
            if disc < 0.0 {
                return Some((false, Vec::new()));
            }
            (false, vec![(-b - disc.sqrt()) / a, (-b + disc.sqrt()) / a])
        }
        Leaf::Box(a, b) | Leaf::Mesh(a, b) => {
            let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
            for i in 0..3 {
                let (p, q) = ((a[i] - o[i]) / d[i], (b[i] - o[i]) / d[i]);
                (near, far) = (near.max(p.min(q)), far.min(p.max(q)));
            }
            if (near - far).abs() < 1e-5 {
                return None;
            }
            (false, if near < far { vec![near, far] } else { Vec::new() })
        }
        Leaf::Plane(n, distance) => {
            // The inside is behind the normal, and the ray comes from there if it goes along it.
            let along = dot(n, d);
            if along.abs() < 1e-4 {
                return None;
            }
            (along > 0.0, vec![(distance * dot(n, n).sqrt() - dot(n, o)) / along])
        }
    })
}

/// What a ray sees of a tree, whose parts inherit `look`. All crossings of leaves go to `all`.
fn seen(
    tree: &Tree,
    (mut o, mut d): ([f64; 3], [f64; 3]),
    look: Look,
    turned: Turned,
    all: &mut Vec<f64>,
) -> Option<Seen> {
    let turned = turned.by(tree.inverse);
    let look = (tree.colour.unwrap_or(look.0), tree.ior.unwrap_or(look.1));
    for step in tree.steps.iter().rev() {
        let undo = |v: [f64; 3], is_point: bool| match *step {
            Step::Rotate(axis, by) => {
                let turn = -by.to_radians();
                let (s, c) = (elementary::sin(turn), elementary::cos(turn));
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut to = v;
                (to[j], to[k]) = (v[j] * c - v[k] * s, v[j] * s + v[k] * c);
                to
            }
            Step::Scale(by) => [0, 1, 2].map(|i| v[i] / by[i]),
            Step::Move(by) if is_point => [0, 1, 2].map(|i| v[i] - by[i]),
            Step::Move(_) => v,
        };
        (o, d) = (undo(o, true), undo(d, false));
    }
    Some(match &tree.kind {
        Kind::Leaf(leaf) => {
            let (first, changes) = crossings(*leaf, o, d)?;
            all.extend(&changes);
            let surfaces = changes.iter().map(|&t| (t, look)).collect();
            Seen { surfaces, changes, first: first != turned.now }
        }
        Kind::Parts(operation, parts) => {
            let mut of = Vec::new();
            for (i, part) in parts.iter().enumerate() {
                let is_taken_away = *operation == Operation::Difference && i > 0;
                of.push(seen(part, (o, d), look, turned.by(is_taken_away), all)?);
            }
            let is_union = matches!(operation, Operation::Union | Operation::Merge);
            let keeps = *operation == Operation::Union && !turned.ever;
            combined(is_union != turned.now, keeps, &of)
        }
    })
}

/// Whether a node is turned inside out, and whether it has been at all: a fact of the scene
/// language is that a union that has been turned keeps no inner surfaces.
#[derive(Clone, Copy, Default)]
struct Turned {
    now: bool,
    ever: bool,
}

impl Turned {
    fn by(self, once_more: bool) -> Self {
        Self { now: self.now != once_more, ever: self.ever || once_more }
    }
}

/// The rules of sets, for parts that are turned inside out where a complement is meant.
fn combined(is_union: bool, keeps_inner_surfaces: bool, parts: &[Seen]) -> Seen {
    let holds =
        |t: f64| if is_union { parts.iter().any(|p| p.holds(t)) } else { parts.iter().all(|p| p.holds(t)) };
    // What shows of a part: what the other parts leave of it.
    let shows = |i: usize, t: f64| {
        let mut others = parts.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, p)| p.holds(t));
        if is_union { keeps_inner_surfaces || !others.any(|holds| holds) } else { others.all(|holds| holds) }
    };
    let mut surfaces = Vec::new();
    let mut changes = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        surfaces.extend(part.surfaces.iter().filter(|(t, _)| shows(i, *t)));
        let matters = |t: &&f64| holds(t.next_down()) != holds(t.next_up());
        changes.extend(part.changes.iter().filter(matters));
    }
    changes.sort_by(f64::total_cmp);
    Seen { changes, first: holds(-1e9), surfaces }
}

/// A scene as text, and the trees that it was written from.
fn scene(seed: u64) -> (String, Vec<Tree>) {
    // An index of refraction of 1 is that of nothing.
    let mut writer = Writer { dice: TestRng::new(seed), text: String::new(), named: Vec::new(), looks: 1 };
    let count = 1 + writer.dice.below(3);
    let mut objects = Vec::new();
    for _ in 0..count {
        let depth = writer.dice.below(5);
        let mut object = writer.tree(depth);
        if object.colour.is_none() {
            object.colour = Some(writer.look());
        }
        object.no_shadow = writer.dice.once_in(4);
        let text = writer.written(&object);
        writer.text.push_str(&text);
        objects.push(object);
    }
    (format!("#version 3.7; global_settings {{ assumed_gamma 1 }}\n{}", writer.text), objects)
}

fn lowered(name: &str, text: &str) -> Lowered {
    let path = std::env::temp_dir().join(format!("durer-leaf-looks-{}-{name}.pov", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let read = durer::pov::read(&path, &ReadOptions::default());
    // A leftover in the temporary folder is no failure of the test.
    let _ = std::fs::remove_file(&path);
    let scene = read.unwrap_or_else(|e| panic!("{e}\n{text}")).scene;
    scene.lower().unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// What the scene says that a primitive looks like.
fn look(scene: &Lowered, object: u32, primitive: u32) -> Look {
    let look = &scene.looks[scene.look_of(object, primitive).expect("every primitive has a look").0 as usize];
    let TextureBody::Layers(layers) = &look.texture.body else { panic!("layers were written") };
    let PigmentBody::Solid(colour) = layers[0].pigment.body else { panic!("a colour was written") };
    let ior = scene.media[look.medium as usize].ior;
    (colour.rgb.r as u32, if ior == 1.0 { 0 } else { ior as u32 })
}

/// Eight rays from one place.
fn eight(dice: &mut TestRng) -> Rays8 {
    let far = [1.0, 3.0, 9.0][dice.below(3) as usize];
    let from = dice.coordinates(far);
    let aim = dice.coordinates(2.0);
    let mut rays = Rays8::NONE;
    rays.live = M8::from_bits(u8::MAX);
    (rays.t_max, rays.source) = (F8::splat(f64::INFINITY), Sources8::NONE);
    for i in 0..8 {
        let to = dice.coordinates(0.4);
        let way = [0, 1, 2].map(|k| aim[k] + to[k] - from[k] + 1e-3);
        rays.direction.set_lane(i, Vec3::new(way[0], way[1], way[2]));
        let at = &mut rays.origin;
        (at.x.0[i], at.y.0[i], at.z.0[i]) = (from[0], from[1], from[2]);
    }
    rays
}

/// What a ray sees first, and whether it meets anything that throws a shadow; `None` if that is not
/// sure.
fn expected(objects: &[Tree], ray: &Ray) -> Option<(Option<(f64, Look)>, bool)> {
    let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
    let mut all = Vec::new();
    let (mut first, mut shadow) = (None::<(f64, Look)>, false);
    for object in objects {
        let found = seen(object, (o, d), (0, 0), Turned::default(), &mut all)?;
        if found.holds(0.0) {
            return None;
        }
        for &(t, look) in found.surfaces.iter().filter(|(t, _)| *t > 0.0) {
            shadow |= !object.no_shadow;
            if first.is_none_or(|(known, _)| t < known) {
                first = Some((t, look));
            }
        }
    }
    all.push(0.0);
    all.sort_by(f64::total_cmp);
    let are_apart = |pair: &[f64]| pair[1] - pair[0] > 1e-6 * (1.0 + pair[0].abs());
    all.windows(2).all(are_apart).then_some((first, shadow))
}

#[test]
fn every_leaf_keeps_its_look() {
    let (mut compared, mut unsure) = (0, 0);
    let mut scratch = Scratch::default();
    for seed in 0..600 {
        let (text, objects) = scene(seed);
        let lowered = lowered("random", &text);
        let geometry: &Geometry = &lowered.geometry;
        let mut dice = TestRng::new(!seed);
        for _ in 0..12 {
            let rays = [eight(&mut dice)];
            let candidates = geometry.bundle_candidates(&rays);
            let mut hits = [Hits8::NONE];
            geometry.first_visible8(candidates.as_ref(), &rays, mask::CAMERA, &mut hits, &mut scratch);
            let mut dark = [M8::NONE];
            geometry.any8(candidates.as_ref(), &rays, mask::SHADOW, &mut dark, &mut scratch);
            for i in 0..8 {
                let ray = rays[0].lane(i);
                let Some((want, shadow)) = expected(&objects, &ray) else {
                    unsure += 1;
                    continue;
                };
                compared += 1;
                let told = || format!("scene {seed}, {ray:?}\n{text}");
                let alone = geometry.masked(mask::CAMERA).first_visible(&ray, Need::SHADING_NORMAL);
                let got = alone.map(|(hit, _)| (hit.t, look(&lowered, hit.object.0, hit.primitive.0)));
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-7 * (1.0 + b.abs());
                let agree = match (got, want) {
                    (Some(got), Some(want)) => near(got.0, want.0) && got.1 == want.1,
                    (got, want) => got.is_none() && want.is_none(),
                };
                assert!(agree, "got {got:?}, want {want:?}: {}", told());
                let together = hits[0].hit.lane(i).then(|| (hits[0].object[i], hits[0].primitive[i]));
                let alone = alone.map(|(hit, _)| (hit.object.0, hit.primitive.0));
                assert_eq!(together, alone, "eight rays together: {}", told());
                assert_eq!(geometry.masked(mask::SHADOW).any(&ray), shadow, "shadow: {}", told());
                assert_eq!(dark[0].lane(i), shadow, "shadows of eight rays: {}", told());
            }
        }
    }
    assert!(compared > 10_000, "only {compared} rays were compared, {unsure} were left out");
}
