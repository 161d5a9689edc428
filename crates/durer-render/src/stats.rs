//! The number of rays that a picture took.

use core::ops::AddAssign;

/// How many rays of each kind were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// From mirrors, total reflection included.
    pub reflected: u64,
    /// Through clear surfaces, bent or not.
    pub transmitted: u64,
    /// To lights.
    pub shadow: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.camera + self.reflected + self.transmitted + self.shadow
    }
}

impl AddAssign for RayCounts {
    fn add_assign(&mut self, o: Self) {
        self.camera += o.camera;
        self.reflected += o.reflected;
        self.transmitted += o.transmitted;
        self.shadow += o.shadow;
    }
}
