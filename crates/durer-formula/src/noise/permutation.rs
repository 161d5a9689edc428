//! The permutation of the scene language's noise, which gives each cube of the unit lattice a number.

/// The period of the cubes along each axis.
pub const PERIOD: usize = 4096;

/// The number of a cube, from 0 to 4095, by its coordinates modulo [`PERIOD`].
pub fn wide_hash(permutation: &[u16], x: usize, y: usize, z: usize) -> usize {
    let one = usize::from(permutation[x]) ^ y;
    let two = usize::from(permutation[one]) ^ z;
    usize::from(permutation[two])
}

/// The permutation, twice: numbers exchanged by a linear congruential generator.
pub fn permutation() -> Box<[u16]> {
    let mut order: Vec<u16> = (0..PERIOD as u16).collect();
    let mut seed = 0_u32;
    for i in (0..PERIOD).rev() {
        seed = seed.wrapping_mul(1_812_433_253).wrapping_add(12_345);
        order.swap(i, (seed >> 16 & 0x7fff) as usize % PERIOD);
    }
    order.extend_from_within(..);
    order.into()
}
