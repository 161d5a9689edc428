//! The harness's files: triangles, rays and hits, all little endian.

use std::io;
use std::path::{Path, PathBuf};

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FileError {
    #[error("{}: {error}", .path.display())]
    Io { path: PathBuf, error: io::Error },
    #[error("{}: it does not begin with {magic:?}", .path.display())]
    Magic { path: PathBuf, magic: &'static str },
    #[error("{}: {found} bytes, but its header promises {promised}", .path.display())]
    Length { path: PathBuf, found: usize, promised: u64 },
    #[error("{}: triangle {triangle} uses vertex {index} of {len}", .path.display())]
    Index { path: PathBuf, triangle: usize, index: u32, len: usize },
}

/// Indexed triangles.
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
}

/// A ray; `t_near` and `t_far` are its range.
#[derive(Clone, Copy)]
pub(crate) struct PeerRay {
    pub(crate) origin: [f32; 3],
    pub(crate) t_near: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) t_far: f32,
}

/// The hit of each ray: `t` and triangle, or infinity and [`MISS`].
#[derive(Default)]
pub(crate) struct Hits {
    pub(crate) t: Vec<f32>,
    pub(crate) triangle: Vec<u32>,
}

/// The triangle number of a miss.
pub(crate) const MISS: u32 = u32::MAX;

/// The words of a file after its magic number. `words` computes from the header how many there must
/// be.
fn words(path: &Path, magic: &'static str, words: impl Fn(&[u32]) -> u64) -> Result<Vec<u32>, FileError> {
    let bytes = std::fs::read(path).map_err(|error| FileError::Io { path: path.into(), error })?;
    let rest =
        bytes.strip_prefix(magic.as_bytes()).ok_or_else(|| FileError::Magic { path: path.into(), magic })?;
    let all: Vec<u32> = rest.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect();
    let promised = 4 + 4 * words(&all);
    if promised != bytes.len() as u64 {
        return Err(FileError::Length { path: path.into(), found: bytes.len(), promised });
    }
    Ok(all)
}

fn count(words: &[u32], i: usize) -> u64 {
    words.get(i).map_or(0, |&n| u64::from(n))
}

fn floats(words: &[u32]) -> [f32; 3] {
    [0, 1, 2].map(|i| f32::from_bits(words[i]))
}

/// Reads a `.tri` file.
pub(crate) fn mesh(path: &Path) -> Result<Mesh, FileError> {
    let all = words(path, "TRI1", |w| 2 + 3 * (count(w, 0) + count(w, 1)))?;
    let (vertices, faces) = all[2..].split_at(3 * all[0] as usize);
    let mesh = Mesh {
        vertices: vertices.chunks_exact(3).map(floats).collect(),
        faces: faces.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect(),
    };
    let len = mesh.vertices.len();
    for (triangle, face) in mesh.faces.iter().enumerate() {
        if let Some(&index) = face.iter().find(|&&i| i as usize >= len) {
            return Err(FileError::Index { path: path.into(), triangle, index, len });
        }
    }
    Ok(mesh)
}

/// Reads a `.rays` file.
pub(crate) fn rays(path: &Path) -> Result<Vec<PeerRay>, FileError> {
    let all = words(path, "RAY1", |w| 1 + 8 * count(w, 0))?;
    let ray = |w: &[u32]| PeerRay {
        origin: floats(w),
        t_near: f32::from_bits(w[3]),
        direction: floats(&w[4..]),
        t_far: f32::from_bits(w[7]),
    };
    Ok(all[1..].chunks_exact(8).map(ray).collect())
}

/// Reads a `.hits` file.
pub(crate) fn hits(path: &Path) -> Result<Hits, FileError> {
    let all = words(path, "HIT1", |w| 1 + 2 * count(w, 0))?;
    let (t, triangle) = all[1..].split_at(all[0] as usize);
    Ok(Hits { t: t.iter().map(|&w| f32::from_bits(w)).collect(), triangle: triangle.to_vec() })
}
