//! Which rays meet which objects: bits of the masks that lowering gives to surfaces.

/// Rays of the camera, and what they become behind clear surfaces.
pub const CAMERA: u32 = 1;
/// Rays of mirrors, and what they become behind clear surfaces.
pub const MIRROR: u32 = 1 << 1;
/// Shadow rays meet what lets no light pass.
pub const SHADOW: u32 = 1 << 2;
/// Shadow rays meet what may let light pass.
pub const CLEAR_SHADOW: u32 = 1 << 3;
/// Rays that ask for shapes and not for looks: every object has it.
pub const SHAPE: u32 = 1 << 4;
