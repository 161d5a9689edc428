//! Statistics of a geometry.

use crate::explain::SurfaceCounts;
use crate::geometry::{Geometry, Instance};
use std::collections::HashMap;
use std::sync::Arc;

/// Counts and memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Stats {
    /// Each kind of surface with the number of its surfaces or parts, in the order in which the
    /// kinds were first added.
    pub kinds: SurfaceCounts,
    /// The number of surfaces and parts, without instances.
    pub primitives: u64,
    /// The number of instances.
    pub instances: usize,
    /// The number of slots beside the tree, which every ray tests.
    pub beside: u64,
    /// The tree.
    pub tree: durer_bvh::Stats,
    /// Bytes on the heap: surfaces (without what they own in turn), numbers and masks, the tree.
    /// Memory that instances share is not counted.
    pub bytes: usize,
}

pub(crate) fn of(geometry: &Geometry) -> Stats {
    let mut kinds = SurfaceCounts::default();
    for arena in &geometry.arenas {
        (0..arena.len()).for_each(|slot| kinds.add(arena.surface_name(slot), 1));
    }
    let tree = geometry.tree.stats();
    Stats {
        primitives: kinds.0.iter().map(|k| k.1).sum(),
        instances: geometry.instances().len(),
        beside: geometry.beside.iter().map(|b| u64::from(b.count)).sum(),
        bytes: geometry.arenas.iter().map(|a| a.bytes()).sum::<usize>()
            + geometry.instances().len() * (size_of::<Instance>() + size_of::<u32>())
            + tree.bytes,
        tree,
        kinds,
    }
}

/// Counts of a geometry and of all that its instances place, at any depth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inventory {
    /// The number of geometries, itself included, each counted once however often it is placed.
    pub geometries: usize,
    /// Each kind of surface with the number of its surfaces or parts in these geometries.
    pub kinds: SurfaceCounts,
    /// The number of surfaces and parts, counted once for each placement.
    pub placed: u128,
    /// Bytes on the heap of all of these geometries, counted as in [`Stats::bytes`].
    pub bytes: usize,
}

impl Inventory {
    pub(crate) fn of(geometry: &Geometry) -> Self {
        let (mut inventory, mut known) = (Self::default(), HashMap::new());
        inventory.placed = inventory.count(geometry, &mut known);
        inventory
    }

    /// Adds a geometry and those that it places; returns its number of primitives, counted once for
    /// each placement.
    fn count(&mut self, geometry: &Geometry, known: &mut HashMap<*const Geometry, u128>) -> u128 {
        let stats = of(geometry);
        self.geometries += 1;
        self.bytes += stats.bytes;
        for (name, count) in stats.kinds.0 {
            self.kinds.add(name, count);
        }
        let mut placed = u128::from(stats.primitives);
        for instance in geometry.instances() {
            let place = Arc::as_ptr(&instance.geometry);
            placed += match known.get(&place) {
                Some(&placed) => placed,
                None => {
                    let placed = self.count(&instance.geometry, known);
                    known.insert(place, placed);
                    placed
                }
            };
        }
        placed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::{Affine, Point3, Vec3};
    use durer_surfaces::{AxisBox, Sphere};

    #[test]
    fn what_is_placed_often_is_held_once() {
        let ball = Sphere::new(Point3::ORIGIN, 1.0).unwrap();
        let block = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)).unwrap();
        let at = |x: f64| Affine::translation(Vec3::new(x, 0.0, 0.0)).unwrap();
        let pair = Arc::new(Geometry::builder().with(ball).with(block).build().unwrap());
        let row = |count: u32| {
            let mut builder = Geometry::builder();
            (0..count).for_each(|i| {
                builder.instance(&pair, at(f64::from(i)), u32::MAX);
            });
            Arc::new(builder.with(ball).build().unwrap())
        };
        let (three, five) = (row(3), row(5));
        let mut builder = Geometry::builder();
        for (i, rows) in [&three, &five, &five].into_iter().enumerate() {
            builder.instance(rows, at(i as f64), u32::MAX);
        }
        let all = builder.with(block).with_instance(&pair, at(9.0), u32::MAX).build().unwrap();
        let inventory = all.inventory();
        assert_eq!(inventory.geometries, 4);
        assert_eq!(inventory.placed, (3 * 2 + 1) + 2 * (5 * 2 + 1) + 1 + 2);
        let total = |name: &str| inventory.kinds.0.iter().find(|k| k.0 == name).map(|k| k.1);
        assert_eq!((total("sphere"), total("box")), (Some(3), Some(2)));
        let held: usize = [&all, &*three, &*five, &*pair].map(|g| g.stats().bytes).iter().sum();
        assert_eq!(inventory.bytes, held);
    }
}
