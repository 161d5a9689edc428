//! Numbers on a grid in the unit cube.
//!
//! On a grid of size `(a, b, c)` the number with the indices `(i, j, k)` is at `(i/a, j/b, k/c)`,
//! and indices wrap around. Outside the unit cube the value is 0. These are facts of the scene
//! language, found from values of `density_file` in POV-Ray 3.7.

/// How values between the points of a grid are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridBetween {
    /// The number of the grid point below.
    Nearest,
    /// Linear along each axis.
    Linear,
    /// A Catmull-Rom spline along each axis.
    Cubic,
}

/// Numbers from 0 to 1 on a grid in the unit cube.
#[derive(Clone, PartialEq)]
pub struct DensityGrid {
    size: [usize; 3],
    numbers: Box<[f32]>,
}

impl core::fmt::Debug for DensityGrid {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("DensityGrid").field("size", &self.size).finish_non_exhaustive()
    }
}

impl DensityGrid {
    /// The grid with these numbers, with x varying fastest; `None` if their count differs from the
    /// size, or is 0.
    pub fn new(size: [usize; 3], numbers: Vec<f32>) -> Option<Self> {
        let [a, b, c] = size;
        let count = a.checked_mul(b)?.checked_mul(c)?;
        (count > 0 && count == numbers.len()).then(|| Self { size, numbers: numbers.into() })
    }

    fn number(&self, at: [usize; 3]) -> f64 {
        let [a, b, c] = self.size;
        let [i, j, k] = [at[0] % a, at[1] % b, at[2] % c];
        f64::from(self.numbers[(k * b + j) * a + i])
    }

    /// The value at a point.
    pub fn value(&self, p: [f64; 3], between: GridBetween) -> f64 {
        if !p.iter().all(|x| (0.0..1.0).contains(x)) {
            return 0.0;
        }
        let mut low = [0; 3];
        let mut weights = [[0.0; 4]; 3];
        for axis in 0..3 {
            let x = p[axis] * self.size[axis] as f64;
            low[axis] = x as usize;
            let s = x - low[axis] as f64;
            weights[axis] = match between {
                GridBetween::Nearest => [0.0, 1.0, 0.0, 0.0],
                GridBetween::Linear => [0.0, 1.0 - s, s, 0.0],
                GridBetween::Cubic => [
                    0.5 * s * (-1.0 + s * (2.0 - s)),
                    1.0 + 0.5 * s * s * (-5.0 + 3.0 * s),
                    0.5 * s * (1.0 + s * (4.0 - 3.0 * s)),
                    0.5 * s * s * (s - 1.0),
                ],
            };
        }
        let mut sum = 0.0;
        for (k, wz) in weights[2].iter().enumerate().filter(|(_, w)| **w != 0.0) {
            for (j, wy) in weights[1].iter().enumerate().filter(|(_, w)| **w != 0.0) {
                for (i, wx) in weights[0].iter().enumerate().filter(|(_, w)| **w != 0.0) {
                    // One step back along each axis, all around.
                    let step = [i, j, k];
                    let at = core::array::from_fn(|axis| low[axis] + step[axis] + self.size[axis] - 1);
                    sum += wx * wy * wz * self.number(at);
                }
            }
        }
        sum.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_scene_language() {
        let four = [0.0_f32, 1.0, 0.4, 0.2].to_vec();
        let line = DensityGrid::new([4, 1, 1], four).unwrap();
        // Values of `function { pattern { density_file ... } }` in POV-Ray 3.7.
        for (x, nearest, linear, cubic) in [
            (0.031_25, 0.0, 0.125, 0.078_516),
            (0.281_25, 1.0, 0.925, 0.998_828),
            (0.468_75, 1.0, 0.475, 0.466_797),
            (0.656_25, 0.4, 0.275, 0.257_422),
            (0.906_25, 0.2, 0.075, 0.0),
            (1.031_25, 0.0, 0.0, 0.0),
        ] {
            let at = |between| line.value([x, 0.5, 0.5], between);
            let found = [GridBetween::Nearest, GridBetween::Linear, GridBetween::Cubic].map(at);
            for (found, want) in found.into_iter().zip([nearest, linear, cubic]) {
                assert!((found - want).abs() < 1e-6, "{x}: {found} instead of {want}");
            }
        }
    }

    #[test]
    fn a_grid_without_numbers_is_refused() {
        assert!(DensityGrid::new([0, 1, 1], Vec::new()).is_none());
        assert!(DensityGrid::new([2, 1, 1], vec![0.0]).is_none());
        assert!(DensityGrid::new([usize::MAX, 2, 1], vec![0.0]).is_none());
    }
}
