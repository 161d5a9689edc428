//! Blobs: the surface where a sum of fields of balls and cylinders has one value.
//!
//! ```text
//!   sum of S max(0, 1 - d²/R²)² = T,  inside: more
//!
//!   d: the distance from the centre of a ball component, or from the segment that is the axis of a cylinder component
//! ```
//!
//! J. F. Blinn, "A generalization of algebraic surface drawing", *ACM Transactions on Graphics*
//! 1(3), 1982, with fields of finite reach: G. Wyvill, C. McPheeters, B. Wyvill, "Data structure
//! for soft objects", *The Visual Computer* 2, 1986. Strengths may be negative: such components
//! dent the surface.
//!
//! Along a ray each field begins and ends, and in between it is a polynomial of degree four
//! (`component.rs`). So is the sum between two such points (`march.rs`): T. Nishita, E. Nakamae, "A
//! method for displaying metaballs by using Bézier clipping", *Computer Graphics Forum* 13(3), 1994.
//! The sum is computed anew for each stretch, so no rounding accumulates, and its sign
//! follows from its Bernstein form (`segment.rs`). A tree of boxes finds the fields that a ray
//! meets, in the order of the ray (`tree.rs`; O. Gourmel et al., "Fitted BVH for fast raytracing of
//! metaballs", *Computer Graphics Forum* 29(2), 2010).
//!
//! A simple root is proven to be the only crossing in its bracket, and the sum is certainly on
//! opposite sides of the threshold at the bracket's ends. Where f64 cannot decide the sign over a
//! stretch (mostly at tangents) the crossings there form one
//! [`RootKind::Cluster`](crate::RootKind).

mod component;
mod march;
mod packet;
mod point;
mod refine;
mod segment;
mod tree;

use self::packet::Fields;
use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, AxisBox, AxisBoxError, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink,
    Solidity, SphereError, Surface, SurfacePoint,
};
use durer_roots::quadratic::Quadratic;
pub(crate) use march::Along;
pub(crate) use tree::{Inner, MARGIN, Tree};

use component::Component;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Affine, Dyadic, Isa, Point3};
use std::sync::Arc;

/// The point or segment from which a field's distance is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlobShape {
    /// A point.
    Ball(Point3),
    /// All points between two.
    Segment(Point3, Point3),
}

/// One component of the sum.
#[derive(Clone, Debug, PartialEq)]
pub struct BlobComponent {
    /// The centre of the field.
    pub shape: BlobShape,
    /// The reach of the field; positive.
    pub radius: f64,
    /// The strength of the field at distance zero.
    pub strength: f64,
    /// The map from the component's frame to the blob's.
    pub place: Affine,
}

/// Why a blob cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BlobError {
    /// The threshold is not positive, or infinite.
    #[error("blob: its threshold must be finite and positive, got {0}")]
    Threshold(f64),
    /// A strength is infinite or NaN.
    #[error("blob: the strength of a component must be finite, got {0}")]
    Strength(f64),
    /// No component has a positive strength: the sum never reaches the threshold.
    #[error("blob: none of its components has a positive strength, so it has no surface")]
    Nothing,
    /// The radius or the centre of a component is not valid.
    #[error("blob: {0}")]
    Component(#[from] SphereError),
    /// The components reach too far or nowhere.
    #[error("blob: {0}")]
    Container(#[from] AxisBoxError),
    /// There are more components than can be numbered.
    #[error("blob: {0} components are too many")]
    Count(usize),
}

/// The solid in which the fields of the components add up to more than the threshold. It has one
/// face.
///
/// # Invariants
///
/// The threshold is positive and finite, so the whole surface lies where components of positive
/// strength reach.
#[derive(Clone, Debug)]
pub struct Blob {
    threshold: f64,
    bounds: Aabb,
    centre: Point3,
    scale: i32,
    /// The radius of a ball about the centre that holds the blob.
    reach: f64,
    parts: Arc<[Component]>,
    /// The components after sorting into the tree's order.
    components: Arc<[BlobComponent]>,
    /// The numbers of the components in the caller's list.
    numbers: Arc<[u32]>,
    tree: Arc<Tree>,
}

impl Blob {
    /// The blob of these components.
    pub fn new(threshold: f64, components: &[BlobComponent]) -> Result<Self, BlobError> {
        if !(threshold > 0.0 && threshold.is_finite()) {
            return Err(BlobError::Threshold(threshold));
        }
        if u32::try_from(components.len()).is_err() {
            return Err(BlobError::Count(components.len()));
        }
        let mut bounds = Aabb::EMPTY;
        let mut boxes = Vec::with_capacity(components.len());
        for part in components {
            if !part.strength.is_finite() {
                return Err(BlobError::Strength(part.strength));
            }
            let reach = part.bounds()?;
            if part.strength > 0.0 {
                bounds = bounds.union(reach);
            }
            boxes.push(reach);
        }
        if bounds.is_empty() {
            return Err(BlobError::Nothing);
        }
        let bounds = AxisBox::new(bounds.min, bounds.max)?.bounds();
        let centre = bounds.centre();
        let reach = bounds.reach_from(centre);
        let scale = exponent(reach) + 1;
        // Distant components add nothing where there is a surface.
        let meets = |b: &Aabb| b.intersection(bounds);
        let (mut parts, mut units) = (Vec::with_capacity(boxes.len()), Vec::with_capacity(boxes.len()));
        let mut sources = Vec::with_capacity(boxes.len());
        for (number, (component, reach)) in (0..).zip(components.iter().zip(&boxes)) {
            let held = meets(reach);
            if component.strength == 0.0 || held.is_empty() {
                continue;
            }
            let unit = |p: Point3| (p - centre).map(|x| scale2(x, -scale)).to_point();
            units.push(Aabb::new(unit(held.min), unit(held.max)));
            parts.push(Component::new(component, centre, scale));
            sources.push((number, component));
        }
        let (tree, order) = Tree::new(&units);
        let parts = order.iter().map(|&i| parts[i as usize].clone()).collect();
        let components = order.iter().map(|&i| sources[i as usize].1.clone()).collect();
        let numbers = order.iter().map(|&i| sources[i as usize].0).collect();
        Ok(Self { threshold, bounds, centre, scale, reach, parts, components, numbers, tree: Arc::new(tree) })
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || {
                let at = ray.recentre(self.centre, self.scale).sharp(1.0);
                march::roots(self, &at, sink);
            },
        );
    }
}

/// Blobs are equal if threshold and list of components are.
impl PartialEq for Blob {
    fn eq(&self, other: &Self) -> bool {
        self.threshold == other.threshold
            && self.components == other.components
            && self.numbers == other.numbers
    }
}

impl Surface for Blob {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.centre, self.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.point(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.side_of(point)
    }
}

impl Accelerate for Blob {
    fn name(&self) -> &'static str {
        "blob"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        let unit = |p: Point3| (p - self.centre).map(|x| scale2(x, -self.scale)).to_point();
        let boxes = self.components.iter().filter_map(|it| it.bounds().ok());
        let boxes: Vec<_> = boxes.map(|b| Aabb::new(unit(b.min), unit(b.max))).collect();
        match Fields::new(self.parts.iter().map(Component::for_lanes).collect(), &boxes, self.threshold) {
            Some(fields) => FilterSource::kernel(self.bounds, fields, self.centre, self.scale, [0, 1, 2]),
            None => FilterSource::vague(self.bounds),
        }
    }
}

impl Algebraic for Blob {
    /// A blob has no polynomial of its own along a ray: it is one polynomial after another.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }
}
