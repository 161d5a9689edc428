//! The [`Surface`](crate::Surface) implementation that all surfaces of patches share.

use super::shell::Shell;
use crate::{LocalPoint, Need, Root, Side, Solidity, SurfacePoint};

/// A surface whose crossings are those of its shell.
pub(super) trait Patches {
    /// Its name.
    const NAME: &'static str;

    fn shell(&self) -> &Shell;

    /// Replaces the parameters of the root's face by the surface's texture coordinates, and the
    /// slopes by those along them.
    fn map_uv(&self, root: &Root, point: &mut SurfacePoint, need: Need);

    fn solidity(&self) -> Solidity {
        Solidity::Open
    }

    fn side(&self, _point: &LocalPoint<'_>) -> Side {
        Side::Out
    }
}

/// Implements [`Surface`](crate::Surface) and [`Accelerate`](crate::Accelerate) by [`Patches`].
macro_rules! surface_of_patches {
    ($type:ty) => {
        impl crate::Surface for $type {
            fn bounds(&self) -> durer_math::Aabb {
                self.shell().bounds
            }

            #[inline(always)]
            fn roots<S: crate::Sink + ?Sized>(&self, ray: &crate::LocalRay<'_>, sink: &mut S) {
                let shell = self.shell();
                if !ray.passes_by(shell.centre, shell.reach) {
                    shell.all_roots(ray, &mut crate::Forward(sink));
                }
            }

            fn resolve(
                &self,
                ray: &crate::LocalRay<'_>,
                root: &crate::Root,
                need: crate::Need,
            ) -> crate::SurfacePoint {
                let mut point = self.shell().point(ray, root);
                self.map_uv(root, &mut point, need);
                point
            }

            fn solidity(&self) -> crate::Solidity {
                <Self as $crate::patch::surface::Patches>::solidity(self)
            }

            fn side(&self, point: &crate::LocalPoint<'_>) -> crate::Side {
                <Self as $crate::patch::surface::Patches>::side(self, point)
            }
        }

        impl crate::Accelerate for $type {
            fn name(&self) -> &'static str {
                <Self as $crate::patch::surface::Patches>::NAME
            }

            fn packet_filter(&self, _part: crate::PartId) -> crate::packet::FilterSource {
                crate::packet::FilterSource::vague(self.shell().bounds)
            }
        }

        impl crate::compose::clip::Algebraic for $type {
            /// The surface has no polynomial of low degree along a ray.
            fn polynomial(
                &self,
                _face: u32,
                _ray: &crate::LocalRay<'_>,
            ) -> Option<durer_roots::quadratic::Quadratic<durer_math::Dyadic>> {
                None
            }
        }
    };
}

pub(super) use surface_of_patches;
