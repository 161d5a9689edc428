//! Iterated function systems: a leaf under all products of `N` contractions.
//!
//! ```text
//!        /\            A  =  union over all words i1 ... iN of  M_i1 M_i2 ... M_iN (LEAF)
//!       /__\
//!      /\  /\          in the frame of a word's copy a ray is  M_iN^-1 ... M_i1^-1 (o + s d),
//!     /__\/__\         with the same parameter s; there the copy is LEAF, and all of the smaller
//!    /\      /\        copies inside a node of k levels are in one box B_k
//!   /__\    /__\
//! ```
//!
//! J. C. Hart, T. A. DeFanti, "Efficient antialiased rendering of 3-D linear fractals", *SIGGRAPH*
//! 1991; the maps: J. E. Hutchinson, "Fractals and self similarity", *Indiana University
//! Mathematics Journal* 30, 1981. Nothing is stored but the maps: nodes unfold along the ray, the
//! nearest first.
//!
//! Copies are convex and closed, so each meets a line in a closed interval. The crossings are the
//! ends of the union of these intervals: where copies overlap, share a face, an edge or a corner,
//! the line stays inside and nothing is crossed. Whether two intervals touch is decided exactly:
//! with integers for the Menger sponge and the Sierpinski tetrahedron, whose planes are
//! `n.x = k / q^N`, else by exact arithmetic where f64 leaves it open.
//!
//! * `frame.rs`: rays in the frames of copies, in f64 with their errors and in any ring;
//! * `leaf.rs`: the leaves, and the interval of a line in one;
//! * `exact.rs`: ends of intervals as exact numbers, and their order;
//! * `contraction.rs`: singular values, and the boxes of nodes;
//! * `walk.rs`: the search along a ray, and the union;
//! * `point.rs`: points of the surface; `side.rs`: on which side of it a point is.

mod contraction;
mod exact;
mod frame;
mod leaf;
mod point;
mod side;
mod walk;

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, AxisBoxError, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity,
    SphereError, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::{Aabb, Affine, Dyadic, Isa, Point3};
use durer_roots::quadratic::Quadratic;
use frame::Frames;
use leaf::Leaf;
use std::sync::Arc;

/// The greatest depth.
pub const MOST_LEVELS: u32 = 20;

/// The solid that an [`Ifs`] copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IfsLeaf {
    /// The box between two corners.
    Box(Point3, Point3),
    /// The ball with this centre and radius.
    Sphere(Point3, f64),
    /// The tetrahedron with these corners.
    Tetrahedron([Point3; 4]),
}

/// Why an [`Ifs`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum IfsError {
    /// There is no map.
    #[error("ifs: it needs a map at least")]
    NoMap,
    /// The depth is too great.
    #[error("ifs: the depth must be a whole number from 0 to {MOST_LEVELS}, got {0}")]
    Depth(u32),
    /// A map does not contract.
    #[error("ifs: map {map} must contract: its largest singular value must be below 1, it is {value}")]
    Expands {
        /// The map, from 1.
        map: usize,
        /// Its largest singular value, rounded.
        value: f64,
    },
    /// There are too many copies to number.
    #[error("ifs: {maps} maps of depth {depth} make more than 2^106 leaves")]
    TooMany {
        /// How many maps there are.
        maps: usize,
        /// The depth.
        depth: u32,
    },
    /// The leaf is no box.
    #[error("ifs: {0}")]
    Box(#[from] AxisBoxError),
    /// The leaf is no ball.
    #[error("ifs: {0}")]
    Sphere(#[from] SphereError),
    /// The corners of the leaf lie in a plane, or are not finite.
    #[error("ifs: the corners of the tetrahedron must be finite and not lie in one plane")]
    Tetrahedron,
    /// A number is too large.
    #[error("ifs: the coordinate {0:?} is too large; the limit is 1.6e60")]
    TooLarge(f64),
}

/// The union of a leaf under all products of `depth` contractions: a solid.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{Closest, Ifs, LocalRay, Surface};
///
/// let sponge = Ifs::menger(20)?; // 20^20 cubes
/// let ray = Ray::new(Point3::new(0.9, 0.95, -5.0), Vec3::new(0.0, 0.0, 1.0));
/// let mut first = Closest::default();
/// sponge.roots(&LocalRay::new(&ray), &mut first);
/// assert!(first.root.is_some_and(|root| root.t == 4.0));
/// # Ok::<(), durer_surfaces::IfsError>(())
/// ```
///
/// # Invariants
///
/// Each map's largest singular value is below 1. All numbers are finite and below `2^200`.
#[derive(Clone, Debug)]
pub struct Ifs(Arc<System>);

/// Products of larger numbers could leave the range of f64.
const LARGEST: f64 = durer_math::scale::pow2(200);

#[derive(Clone, Debug)]
struct System {
    /// The input.
    given: IfsLeaf,
    depth: u32,
    frames: Frames,
    leaf: Leaf,
    /// For each number of levels below a node, a box of its copies in the set's own frame, and the
    /// same box for cells' rays.
    bounds: Vec<Aabb>,
    boxes: Vec<Aabb>,
    /// Whether a node's copies lie in the leaf, and the leaf is a better bound than a box.
    leaf_holds_all: bool,
    /// Whether it is Menger's or Sierpinski's set, where all copies of a node lie in its leaf.
    is_lattice: bool,
    /// The origin of the coordinates; their unit is `2^scale`.
    centre: Point3,
    scale: i32,
    /// The radius of a ball about the centre that holds the set.
    reach: f64,
}

/// The number of a copy: the letters of its word, the first one with the greatest weight.
type Word = u128;

impl Ifs {
    /// The union of `leaf` under all products of `depth` of these maps.
    pub fn new(leaf: IfsLeaf, maps: &[Affine], depth: u32) -> Result<Self, IfsError> {
        if maps.is_empty() {
            return Err(IfsError::NoMap);
        }
        let bounds = leaf::bounds(&leaf)?;
        for (i, map) in maps.iter().enumerate() {
            if !contraction::contracts(map) {
                return Err(IfsError::Expands { map: i + 1, value: contraction::singular_value(map) });
            }
            if let Some(large) = first_large(map.centre()) {
                return Err(IfsError::TooLarge(large));
            }
        }
        for corner in [bounds.min, bounds.max] {
            if let Some(large) = first_large(corner) {
                return Err(IfsError::TooLarge(large));
            }
        }
        // Equal maps make equal copies.
        let mut different: Vec<Affine> = vec![];
        for map in maps {
            if !different.contains(map) {
                different.push(*map);
            }
        }
        check_depth(different.len(), depth)?;
        let bounds = contraction::node_bounds(bounds, &different, depth);
        let all = bounds.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let (centre, scale) = (all.centre(), durer_math::eft::exponent(all.reach_from(all.centre())) + 1);
        let frames = Frames::general(different, centre, scale);
        Ok(Self::made(leaf, depth, frames, Leaf::new(&leaf, centre, scale)?, bounds, (centre, scale)))
    }

    /// The sponge of Menger in the cube from -1 to 1: of 27 cubes those with two or more middle
    /// coordinates are taken out, `depth` times.
    pub fn menger(depth: u32) -> Result<Self, IfsError> {
        let digits = [-2.0, 0.0, 2.0];
        let mut shifts = vec![];
        for x in digits {
            for y in digits {
                for z in digits {
                    if [x, y, z].iter().filter(|&&x| x == 0.0).count() < 2 {
                        shifts.push([x, y, z]);
                    }
                }
            }
        }
        let leaf = IfsLeaf::Box(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
        Self::lattice(leaf, Leaf::new(&leaf, Point3::ORIGIN, 0)?, 3.0, shifts, depth)
    }

    /// The tetrahedron of Sierpinski: `4^depth` tetrahedra in the one with the corners (1, 1, 1),
    /// (1, -1, -1), (-1, 1, -1) and (-1, -1, 1).
    pub fn sierpinski(depth: u32) -> Result<Self, IfsError> {
        let leaf = IfsLeaf::Tetrahedron(leaf::SIERPINSKI.map(|[x, y, z]| Point3::new(x, y, z)));
        Self::lattice(leaf, Leaf::sierpinski(), 2.0, leaf::SIERPINSKI.to_vec(), depth)
    }

    /// The maps `x -> (x + c) / q`.
    fn lattice(
        given: IfsLeaf,
        leaf: Leaf,
        q: f64,
        shifts: Vec<[f64; 3]>,
        depth: u32,
    ) -> Result<Self, IfsError> {
        check_depth(shifts.len(), depth)?;
        let bounds = vec![leaf::bounds(&given)?; depth as usize + 1];
        Ok(Self::made(given, depth, Frames::lattice(q, shifts), leaf, bounds, (Point3::ORIGIN, 0)))
    }

    fn made(
        given: IfsLeaf,
        depth: u32,
        frames: Frames,
        leaf: Leaf,
        bounds: Vec<Aabb>,
        (centre, scale): (Point3, i32),
    ) -> Self {
        let boxes = bounds.iter().map(|b| contraction::seen_from(b, centre, scale)).collect();
        let reach = bounds[depth as usize].reach_from(centre);
        let is_lattice = frames.weight(depth).is_some();
        let leaf_holds_all = is_lattice && matches!(given, IfsLeaf::Tetrahedron(_));
        let system = System {
            given,
            depth,
            frames,
            leaf,
            bounds,
            boxes,
            leaf_holds_all,
            is_lattice,
            centre,
            scale,
            reach,
        };
        Self(Arc::new(system))
    }

    /// How many maps are multiplied.
    pub fn depth(&self) -> u32 {
        self.0.depth
    }

    /// The solid that is copied.
    pub fn leaf(&self) -> IfsLeaf {
        self.0.given
    }

    /// How many different maps there are.
    pub fn maps(&self) -> usize {
        self.0.frames.len()
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || walk::roots(&self.0, ray, sink),
        );
    }
}

impl System {
    /// The letters of a copy's word.
    fn letters(&self, word: Word) -> Vec<usize> {
        self.first_letters(word, self.depth)
    }

    /// The letters of a node with this many levels above it.
    fn first_letters(&self, mut word: Word, levels: u32) -> Vec<usize> {
        let m = self.frames.len() as u128;
        let mut letters = vec![0; levels as usize];
        for letter in letters.iter_mut().rev() {
            *letter = (word % m) as usize;
            word /= m;
        }
        letters
    }
}

/// Half of a word's bits: they fit in an f64.
const HALF: u32 = 53;

/// A word as a root's tag.
fn tag(word: Word) -> [f64; 2] {
    let half = (1_u128 << HALF) - 1;
    [(word >> HALF) as f64, (word & half) as f64]
}

/// The word of a tag.
fn word_of([high, low]: [f64; 2]) -> Word {
    (high as u128) << HALF | low as u128
}

fn first_large(p: Point3) -> Option<f64> {
    p.to_array().into_iter().find(|x| x.abs() >= LARGEST)
}

fn check_depth(maps: usize, depth: u32) -> Result<(), IfsError> {
    if depth > MOST_LEVELS {
        return Err(IfsError::Depth(depth));
    }
    match (maps as u128).checked_pow(depth) {
        Some(leaves) if leaves <= 1 << (2 * HALF) => Ok(()),
        _ => Err(IfsError::TooMany { maps, depth }),
    }
}

/// Systems are equal if their leaves, maps and depths are.
impl PartialEq for Ifs {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        a.given == b.given && a.depth == b.depth && a.frames.same(&b.frames)
    }
}

impl Surface for Ifs {
    fn bounds(&self) -> Aabb {
        self.0.bounds[self.0.depth as usize]
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.0.centre, self.0.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    /// Texture coordinates: those of the leaf; on the sponge of Menger those of the whole cube.
    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.0.point(ray, root, need),
        )
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.0.side_of(point)
    }
}

impl Accelerate for Ifs {
    fn name(&self) -> &'static str {
        "iterated function system"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds())
    }
}

impl Algebraic for Ifs {
    /// A face is a plane or an ellipsoid of one copy, and its number does not identify the copy:
    /// see [`Algebraic::sign_at_root`].
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        exact::sign_at_root(&self.0, ray, root, q)
    }
}

#[cfg(test)]
mod tests;
