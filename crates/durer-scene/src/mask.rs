//! Ray masks: which kinds of rays can hit which objects. Lowering gives each surface a mask of
//! these bits.

/// Camera rays, and their continuations behind clear surfaces.
pub const CAMERA: u32 = 1;
/// Reflected rays, and their continuations behind clear surfaces.
pub const MIRROR: u32 = 1 << 1;
/// Shadow rays, for surfaces that let no light pass.
pub const SHADOW: u32 = 1 << 2;
/// Shadow rays, for surfaces that may let light pass.
pub const CLEAR_SHADOW: u32 = 1 << 3;
/// Rays that need shapes and not looks: every object has this bit.
pub const SHAPE: u32 = 1 << 4;
