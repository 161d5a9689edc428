//! NumPy files: arrays of rays as input, arrays of answers as output.

use durer::math::{Point3, Ray, Vec3};
use npyz::{DType, NpyFile, Order, WriterBuilder};
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

/// Why rays could not be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ArrayError {
    #[error("cannot read the file: {0}")]
    Io(#[from] std::io::Error),
    #[error("not an .npy file of numbers: {0}")]
    Header(std::io::Error),
    #[error("expected dtype '<f8' and shape (n, 6) or (n, 8), got dtype {dtype} and shape {shape}")]
    Type { dtype: String, shape: String },
    #[error(
        "the header promises shape {shape}, {promised} bytes of numbers, but only {present} bytes follow it"
    )]
    Short { shape: String, promised: u128, present: u64 },
}

/// Reads an array of shape (n, 6) [origin, direction] or (n, 8) [origin, direction, t_min, t_max].
pub(crate) fn read_rays(path: &Path) -> Result<Vec<Ray>, ArrayError> {
    let file = File::open(path)?;
    let meta = file.metadata()?;
    if meta.is_dir() {
        return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory).into());
    }
    let npy = NpyFile::new(BufReader::new(file)).map_err(ArrayError::Header)?;
    let shape = npy.shape().to_vec();
    let shape_text = || {
        let sizes: Vec<String> = shape.iter().map(u64::to_string).collect();
        format!("({}{})", sizes.join(", "), if sizes.len() == 1 { "," } else { "" })
    };
    let dtype = npy.dtype();
    let is_f8 = matches!(&dtype, DType::Plain(plain) if plain.to_string() == "<f8");
    let &[n, k @ (6 | 8)] = shape.as_slice() else {
        return Err(ArrayError::Type { dtype: dtype.descr(), shape: shape_text() });
    };
    if !is_f8 {
        return Err(ArrayError::Type { dtype: dtype.descr(), shape: shape_text() });
    }
    let promised = u128::from(n) * u128::from(k) * 8;
    if promised > u128::from(meta.len()) {
        return Err(ArrayError::Short { shape: shape_text(), promised, present: meta.len() });
    }
    let order = npy.order();
    let numbers: Vec<f64> = npy.into_vec()?;
    let (n, k) = (n as usize, k as usize);
    let at = |row: usize, column: usize| match order {
        Order::C => numbers[row * k + column],
        Order::Fortran => numbers[column * n + row],
    };
    let ray = |row: usize| {
        let origin = Point3::new(at(row, 0), at(row, 1), at(row, 2));
        let direction = Vec3::new(at(row, 3), at(row, 4), at(row, 5));
        let ray = Ray::new(origin, direction);
        if k == 8 { ray.with_range(at(row, 6), at(row, 7)) } else { ray }
    };
    Ok((0..n).map(ray).collect())
}

/// Writes named arrays, uncompressed, as `numpy.savez` does.
pub(crate) struct NpzWriter {
    zip: zip::ZipWriter<BufWriter<File>>,
}

impl NpzWriter {
    /// Makes a writer for a file that is open for writing.
    pub(crate) fn new(file: File) -> Self {
        Self { zip: zip::ZipWriter::new(BufWriter::new(file)) }
    }

    /// Adds the array `name`: `values` in C order, with the shape `(len,)` or
    /// `(len / columns, columns)`.
    pub(crate) fn array<T>(&mut self, name: &str, columns: Option<u64>, values: Vec<T>) -> std::io::Result<()>
    where
        T: npyz::AutoSerialize + npyz::Serialize + Copy,
    {
        let options = zip::write::SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Stored)
            .large_file(values.len() as u64 * size_of::<T>() as u64 >= u64::from(u32::MAX) - 4096);
        self.zip.start_file(format!("{name}.npy"), options)?;
        let n = values.len() as u64;
        let shape = columns.map_or(vec![n], |c| vec![n / c, c]);
        let mut writer =
            npyz::WriteOptions::new().default_dtype().shape(&shape).writer(&mut self.zip).begin_nd()?;
        writer.extend(values)?;
        writer.finish()
    }

    /// Writes the directory and flushes the file.
    pub(crate) fn finish(self) -> std::io::Result<()> {
        let mut file = self.zip.finish()?;
        file.flush()?;
        file.into_inner().map_err(std::io::IntoInnerError::into_error)?.sync_all()
    }
}
