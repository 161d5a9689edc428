//! `density_file df3 "NAME"`: numbers on a grid.
//!
//! ```text
//!   three sizes of 2 bytes, then numbers of 1, 2 or 4 bytes; the highest byte is the first
//! ```

use std::sync::Arc;

use durer_scene::DensityGrid;

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;

/// The bytes of the sizes.
const HEADER: usize = 6;

impl Parser<'_> {
    /// Reads `df3 "NAME"` and the file.
    pub(super) fn density_grid(&mut self) -> Result<Arc<DensityGrid>> {
        let lexeme = self.next()?;
        if !matches!(lexeme.item, crate::parser::Item::Word(Keyword::Df3)) {
            return Err(self.unexpected(&lexeme, "df3"));
        }
        let name = self.file_name()?;
        let at = self.here();
        let path = self.picture_path(&name, at)?;
        let failed = |why: String| Error::file(Some(at), format!("{}: {why}", path.display()));
        let bytes = std::fs::metadata(&path).map_err(|why| failed(why.to_string()))?;
        if !bytes.is_file() {
            return Err(failed("this is no file".into()));
        }
        self.check_memory((bytes.len() as usize).saturating_mul(5), at)?;
        let data = std::fs::read(&path).map_err(|why| failed(why.to_string()))?;
        let grid = grid(&data).ok_or_else(|| failed("this is no density file: its size is wrong".into()))?;
        crate::limits::charge_for_good(data.len() * 4);
        Ok(Arc::new(grid))
    }
}

/// The grid of a file.
fn grid(data: &[u8]) -> Option<DensityGrid> {
    let (header, numbers) = data.split_at_checked(HEADER)?;
    let size: [usize; 3] =
        std::array::from_fn(|i| usize::from(header[2 * i]) << 8 | usize::from(header[2 * i + 1]));
    let count = size[0].checked_mul(size[1])?.checked_mul(size[2])?;
    let width = numbers.len().checked_div(count)?;
    if !matches!(width, 1 | 2 | 4) || width * count != numbers.len() {
        return None;
    }
    let most = ((1_u64 << (8 * width)) - 1) as f64;
    let number = |bytes: &[u8]| {
        let whole = bytes.iter().fold(0_u32, |whole, &byte| whole << 8 | u32::from(byte));
        (f64::from(whole) / most) as f32
    };
    DensityGrid::new(size, numbers.chunks_exact(width).map(number).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::GridBetween;

    #[test]
    fn numbers_have_one_two_or_four_bytes() {
        let file = |numbers: &[u8]| grid(&[&[0, 2, 0, 1, 0, 1], numbers].concat());
        let at = |grid: &DensityGrid, x: f64| grid.value([x, 0.0, 0.0], GridBetween::Nearest);
        let one = file(&[0, 255]).unwrap();
        assert_eq!((at(&one, 0.25), at(&one, 0.75)), (0.0, 1.0));
        let two = file(&[0x80, 0, 0xff, 0xff]).unwrap();
        assert_eq!((at(&two, 0.25), at(&two, 0.75)), (f64::from((32768.0_f64 / 65535.0) as f32), 1.0));
        let four = file(&[0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0]).unwrap();
        assert_eq!((at(&four, 0.25), at(&four, 0.75)), (1.0, 0.0));
        assert!(file(&[0]).is_none() && file(&[0, 1, 2]).is_none() && grid(&[0, 1]).is_none());
        assert!(grid(&[0; 6]).is_none());
    }
}
