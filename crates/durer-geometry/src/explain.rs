//! A report of all steps of one ray.

use crate::closest::Placement;
use crate::context::RayContext;
use crate::geometry::{Geometry, slots};
use crate::ids::EVERYTHING;
use crate::{Hit, ObjectId};
use core::fmt;
use core::ops::ControlFlow;
use durer_bvh::{Leaf, Step};
use durer_math::{Aabb, Ray};
use durer_surfaces::LocalRay;

/// The report of a ray: the same steps, in the same order, as [`Geometry::closest`] takes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The ray.
    pub ray: Ray,
    /// Whether it can hit anything at all ([`Ray::is_valid`]).
    pub valid: bool,
    /// The steps.
    pub events: Vec<Event>,
    /// The closest hit.
    pub closest: Option<Hit>,
}

/// A step of the report.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Surfaces without a bounded box are tested first.
    Beside {
        /// How deeply nested in instances.
        depth: u32,
        /// The surfaces.
        surfaces: SurfaceCounts,
    },
    /// The ray misses the box around everything in the tree.
    OutsideTree {
        /// How deeply nested in instances.
        depth: u32,
    },
    /// A node's box was entered.
    Node {
        /// How deeply nested in instances.
        depth: u32,
        /// The level in the tree.
        level: u32,
        /// The box.
        bounds: Aabb,
        /// Where the ray enters the box, in the parameter of the tree's frame.
        t: f64,
        /// How many children it has.
        children: u32,
        /// How many of their boxes the ray may meet.
        met: u32,
    },
    /// A box that the ray meets, but behind the closest hit.
    Skipped {
        /// How deeply nested in instances.
        depth: u32,
        /// The level in the tree.
        level: u32,
        /// The box.
        bounds: Aabb,
        /// Where the ray enters the box.
        t: f64,
    },
    /// A leaf's box was entered.
    Leaf {
        /// How deeply nested in instances.
        depth: u32,
        /// The level in the tree.
        level: u32,
        /// The box.
        bounds: Aabb,
        /// Where the ray enters the box.
        t: f64,
        /// Its surfaces.
        surfaces: SurfaceCounts,
    },
    /// The ray reached an instance and was transformed into its frame.
    Instance {
        /// How deeply nested in instances, this one not counted.
        depth: u32,
        /// Its placement.
        instance: u32,
        /// Whether the mask admits the ray.
        admitted: bool,
    },
    /// A surface was tested.
    Tested {
        /// How deeply nested in instances.
        depth: u32,
        /// Its name.
        surface: &'static str,
        /// Its object.
        object: ObjectId,
        /// Its primitive.
        primitive: u32,
        /// Whether the ray started on it, so that the crossing at its start is known and not
        /// counted.
        source: bool,
        /// Its first crossings in the ray's range, [`MOST_CROSSINGS`] at most, with the verdict on
        /// each.
        roots: Vec<(Hit, Verdict)>,
        /// Whether there are more.
        has_more: bool,
    },
}

/// Names of surfaces, and how many there are of each, in the order of their first appearance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SurfaceCounts(pub Vec<(&'static str, u64)>);

impl SurfaceCounts {
    pub(crate) fn add(&mut self, name: &'static str, more: u64) {
        match self.0.iter_mut().find(|known| known.0 == name) {
            Some(known) => known.1 += more,
            None => self.0.push((name, more)),
        }
    }
}

impl fmt::Display for SurfaceCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (name, count)) in self.0.iter().enumerate() {
            write!(f, "{}{count} x {name}", if i > 0 { ", " } else { "" })?;
        }
        Ok(())
    }
}

/// So many crossings of one surface are listed: a fractal may have billions on a ray.
pub const MOST_CROSSINGS: usize = 1000;

/// The verdict on a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It was the closest so far.
    Closest,
    /// A closer one was known already.
    Farther,
    /// It is as far as the closest so far, and its (object, primitive) comes later, or the same
    /// primitive reported it later.
    LaterInOrder,
}

impl Geometry {
    /// Reports all steps of the search for a ray's closest hit.
    pub fn explain(&self, ray: &Ray) -> Explanation {
        let mut story = Story { events: Vec::new(), best: None };
        let valid = ray.is_valid();
        if valid {
            let local = LocalRay::new(ray);
            story.geometry(&RayContext::new(self, ray, &local, EVERYTHING), 0);
        }
        Explanation { ray: *ray, valid, events: story.events, closest: story.best }
    }
}

struct Story {
    events: Vec<Event>,
    best: Option<Hit>,
}

impl Story {
    fn geometry(&mut self, walk: &RayContext<'_>, depth: u32) {
        let geometry = walk.geometry;
        for beside in &geometry.beside {
            let surfaces = self.surfaces(geometry, &beside.leaf());
            self.events.push(Event::Beside { depth, surfaces });
            self.leaf(walk, &beside.leaf(), depth);
        }
        let mut line = walk.line();
        if let Some(best) = &self.best {
            line.t_max = line.t_max.min(walk.limit(best.t_hi));
        }
        let entered = geometry.tree.trace(&line, |step| match *step {
            Step::Node { level, bounds, t, children, met, .. } => {
                self.events.push(Event::Node { depth, level, bounds, t, children, met });
                f64::INFINITY
            }
            Step::Skipped { level, bounds, t } => {
                self.events.push(Event::Skipped { depth, level, bounds, t });
                f64::INFINITY
            }
            Step::Leaf { leaf, level, bounds, t } => {
                let surfaces = self.surfaces(geometry, &leaf);
                self.events.push(Event::Leaf { depth, level, bounds, t, surfaces });
                self.leaf(walk, &leaf, depth);
                self.best.map_or(f64::INFINITY, |best| walk.limit(best.t_hi))
            }
        });
        if !entered && !geometry.tree.is_empty() {
            self.events.push(Event::OutsideTree { depth });
        }
    }

    /// The names of a leaf's surfaces and how many there are of each.
    fn surfaces(&self, geometry: &Geometry, leaf: &Leaf) -> SurfaceCounts {
        let mut counts = SurfaceCounts::default();
        match geometry.arenas.get(leaf.kind as usize) {
            Some(arena) => slots(leaf).for_each(|slot| counts.add(arena.surface_name(slot), 1)),
            None => counts.add("instance", u64::from(leaf.count)),
        }
        counts
    }

    fn leaf(&mut self, walk: &RayContext<'_>, leaf: &Leaf, depth: u32) {
        let geometry = walk.geometry;
        if geometry.is_instances(leaf) {
            for i in slots(leaf) {
                let instance = geometry.instance(i);
                let placement: Placement = instance.within(&walk.placement);
                let admitted = instance.mask & walk.mask != 0;
                self.events.push(Event::Instance { depth, instance: placement.instance, admitted });
                walk.enter(instance, |inner| self.geometry(inner, depth + 1));
            }
            return;
        }
        let arena = &geometry.arenas[leaf.kind as usize];
        let filter = walk.filter(leaf.kind);
        for slot in slots(leaf) {
            let (mut roots, mut has_more) = (Vec::new(), false);
            let _ = arena.each(geometry.isa, slot..slot + 1, walk.ray, &filter, &mut |slot, name, root| {
                if roots.len() == MOST_CROSSINGS {
                    has_more = true;
                    return ControlFlow::Break(());
                }
                let hit = walk.placement.hit(leaf.kind, slot, name, &root);
                let verdict = match &self.best {
                    Some(best) if hit.t > best.t => Verdict::Farther,
                    Some(best) if hit.order(best).is_ge() => Verdict::LaterInOrder,
                    _ => {
                        self.best = Some(hit);
                        Verdict::Closest
                    }
                };
                roots.push((hit, verdict));
                ControlFlow::Continue(())
            });
            let name = arena.name(slot);
            self.events.push(Event::Tested {
                depth,
                surface: arena.surface_name(slot),
                object: ObjectId(walk.placement.object.wrapping_add(name.object)),
                primitive: walk.placement.primitive.wrapping_add(name.primitive),
                source: filter.source.is_some_and(|s| s.0 == slot),
                roots,
                has_more,
            });
        }
    }
}

impl Explanation {
    /// The report in words, with the place in the scene's text of each object for which `place_of`
    /// returns one.
    pub fn with_places<'a>(
        &'a self,
        place_of: impl Fn(ObjectId) -> Option<String> + 'a,
    ) -> impl fmt::Display + 'a {
        InWords { explanation: self, place_of }
    }
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.with_places(|_| None).fmt(f)
    }
}

struct InWords<'a, P> {
    explanation: &'a Explanation,
    place_of: P,
}

impl<P: Fn(ObjectId) -> Option<String>> fmt::Display for InWords<'_, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Explanation { ray, valid, events, closest } = self.explanation;
        let (o, d) = (ray.origin, ray.direction);
        writeln!(f, "ray from <{}, {}, {}> along <{}, {}, {}>", o.x, o.y, o.z, d.x, d.y, d.z)?;
        writeln!(f, "    t in [{}, {}]", ray.t_min, ray.t_max)?;
        if !valid {
            writeln!(f, "it is no ray (not finite, without direction, or with an empty range): it misses")?;
        }
        for event in events {
            event.write(f, &self.place_of)?;
        }
        let Some(hit) = closest else {
            return writeln!(f, "it meets nothing");
        };
        write!(f, "closest: object {}, primitive {}", hit.object, hit.primitive)?;
        if let Some(place) = (self.place_of)(hit.object) {
            write!(f, " ({place})")?;
        }
        if hit.instance > 0 {
            write!(f, ", instance {}", hit.instance)?;
        }
        writeln!(f, ", at {}", Crossing(hit))
    }
}

/// A crossing in words.
struct Crossing<'a>(&'a Hit);

impl fmt::Display for Crossing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hit = self.0;
        let way = match hit.sign {
            -1 => "entering (against the normal)",
            1 => "leaving (with the normal)",
            _ => "grazing",
        };
        write!(f, "t = {} in [{}, {}], face {}, {way}", hit.t, hit.t_lo, hit.t_hi, hit.face)
    }
}

/// A box in words.
struct Box<'a>(&'a Aabb);

impl fmt::Display for Box<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (a, b) = (self.0.min, self.0.max);
        write!(f, "<{:.4}, {:.4}, {:.4}> to <{:.4}, {:.4}, {:.4}>", a.x, a.y, a.z, b.x, b.y, b.z)
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, &|_| None)
    }
}

impl Event {
    fn write(
        &self,
        f: &mut fmt::Formatter<'_>,
        place_of: &dyn Fn(ObjectId) -> Option<String>,
    ) -> fmt::Result {
        let indent = |f: &mut fmt::Formatter<'_>, depth: u32, level: u32| {
            write!(f, "{:width$}", "", width = 2 * (2 * depth + level) as usize)
        };
        match self {
            Self::Beside { depth, surfaces } => {
                indent(f, *depth, 0)?;
                writeln!(f, "{surfaces} without a bounded box: tested first")
            }
            Self::OutsideTree { depth } => {
                indent(f, *depth, 0)?;
                writeln!(f, "the box around everything is missed")
            }
            Self::Node { depth, level, bounds, t, children, met } => {
                indent(f, *depth, *level)?;
                writeln!(f, "box {} entered at t >= {t:.6}: {met} of {children} boxes in it met", Box(bounds))
            }
            Self::Skipped { depth, level, bounds, t } => {
                indent(f, *depth, *level)?;
                writeln!(f, "box {} begins at t >= {t:.6}, behind the closest hit: skipped", Box(bounds))
            }
            Self::Leaf { depth, level, bounds, t, surfaces } => {
                indent(f, *depth, *level)?;
                writeln!(f, "leaf {} entered at t >= {t:.6}: {surfaces}", Box(bounds))
            }
            Self::Instance { depth, instance, admitted } => {
                indent(f, *depth, 1)?;
                let verdict = if *admitted { "entered" } else { "hidden by its mask" };
                writeln!(f, "instance {instance}: {verdict}")
            }
            Self::Tested { depth, surface, object, primitive, source, roots, has_more } => {
                indent(f, *depth, 2)?;
                write!(f, "{surface} (object {}, primitive {primitive}", object.0)?;
                if let Some(place) = place_of(*object) {
                    write!(f, ", {place}")?;
                }
                write!(f, ")")?;
                if *source {
                    write!(f, ", on which the ray starts")?;
                }
                if roots.is_empty() {
                    writeln!(f, ": no crossing")?;
                } else {
                    writeln!(f, ":")?;
                }
                for (hit, verdict) in roots {
                    indent(f, *depth, 3)?;
                    let verdict = match verdict {
                        Verdict::Closest => "the closest so far",
                        Verdict::Farther => "farther than the closest so far",
                        Verdict::LaterInOrder => "as far as the closest so far, which comes first in order",
                    };
                    writeln!(f, "{}: {verdict}", Crossing(hit))?;
                }
                if *has_more {
                    indent(f, *depth, 3)?;
                    writeln!(f, "further crossings are not listed")?;
                }
                Ok(())
            }
        }
    }
}
