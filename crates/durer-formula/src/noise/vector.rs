//! Vectors of noise: three tables whose points are distributed by the same permutation, so that the
//! corners of cells are hashed once.

use super::table::{Hashed, TableLattice, TablePoints};
use super::{NoiseTable, Sum, are_one_cell, hashes, positions};
use durer_math::{F8, Isa};

/// Three tables whose points are distributed by the same permutation.
#[derive(Clone, Copy)]
pub struct VectorTable {
    components: [&'static NoiseTable; 3],
    lattices: [TableLattice<'static, Hashed>; 3],
}

impl VectorTable {
    /// The tables with these points each, see [`NoiseTable::shared`].
    pub fn shared(points: [&[[f64; 4]; Hashed::POINTS]; 3], order: &[u16; Hashed::PERIOD]) -> Option<Self> {
        let [x, y, z] = points.map(|points| NoiseTable::shared(points, order));
        let components = [x?, y?, z?];
        let [x, y, z] = components.map(|table| match table.points() {
            TablePoints::Hashed(points) => Some(TableLattice(&**points, table.size())),
            TablePoints::Rows(_) => None,
        });
        Some(Self { components, lattices: [x?, y?, z?] })
    }

    /// The tables of the components.
    pub fn components(&self) -> [&'static NoiseTable; 3] {
        self.components
    }

    /// The noise at eight points: bit for bit the values of the components, see [`values`](super::values).
    #[inline(never)]
    pub fn values(&self, p: [&F8; 3]) -> [F8; 3] {
        let lattices = self.lattices;
        Isa::detect().run_in_lanes(
            #[inline(always)]
            || {
                let along = positions(lattices[0], p);
                let mut out = [F8::ZERO; 3];
                if are_one_cell(&along) {
                    let hashes = hashes(lattices[0], &along);
                    for (out, lattice) in out.iter_mut().zip(lattices) {
                        *out = F8(Sum::of(&along, &Sum::corners_of_one(lattice, &along, &hashes)).v.0);
                    }
                } else {
                    let hashes = hashes(lattices[0], &along);
                    for (out, lattice) in out.iter_mut().zip(lattices) {
                        *out = F8(Sum::of(&along, &Sum::corners(lattice, &along, &hashes)).v.0);
                    }
                }
                out
            },
        )
    }
}

impl PartialEq for VectorTable {
    fn eq(&self, other: &Self) -> bool {
        self.components == other.components
    }
}

impl core::fmt::Debug for VectorTable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("VectorTable").finish_non_exhaustive()
    }
}
