//! Lights with their constants precomputed: direction and strength of their light at a point.

mod area;

pub(crate) use self::area::{Area, Divides};

use crate::medium::NO_DISTANCE;
use crate::power::Power;
use crate::ray_end::RayEnd;
use crate::vector::{dot, length, unit};
use durer_geometry::Geometry;
use durer_math::{F8, M8, Point3, Vec3, elementary};
use durer_scene::{Light, LightKind, LowerError, Lowered, Object, Rgb, Scene, mask};
use std::sync::Arc;

/// A light.
#[derive(Clone, Debug)]
pub(crate) struct RenderLight {
    location: Point3,
    /// The point it is aimed at.
    point_at: Point3,
    pub(crate) colour: Rgb,
    /// The unit vector from the location to the point it is aimed at.
    axis: Vec3,
    beam: Beam,
    pub(crate) parallel: bool,
    pub(crate) shadowless: bool,
    fade: Option<(f64, Power)>,
    /// The end of its shadow rays, if a surface may pass through it.
    pub(crate) end: Option<RayEnd>,
    /// The points that throw its shadows, if there are several.
    pub(crate) area: Option<Area>,
    /// Whether all points of its area light, not only its location.
    pub(crate) illuminates: bool,
    /// The object through which it shines.
    pub(crate) through: Option<Arc<Lowered>>,
    /// The number of its light group.
    pub(crate) group: Option<u32>,
}

#[derive(Clone, Copy, Debug)]
enum Beam {
    All,
    /// The cosines at which the light begins to fall off and at which it is zero.
    Cone {
        full: f64,
        end: f64,
        tightness: Power,
    },
    /// The distances from the axis at which the light begins to fall off and at which it is zero.
    Tube {
        full: f64,
        end: f64,
        tightness: Power,
    },
}

/// A light at eight points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beamed {
    /// The points that it lights. The other fields are valid for these only.
    pub(crate) lit: M8,
    /// The unit directions from the points to the light.
    pub(crate) to_light: Vec3<F8>,
    /// The factor of the light's colour.
    pub(crate) strength: F8,
    /// The end of shadow rays: the light itself, or for parallel light the point above on the
    /// light's plane.
    pub(crate) target: Point3<F8>,
    /// The points whose way to the light can be blocked.
    pub(crate) blockable: M8,
}

/// 0 up to `a`, 1 from `b` on, and between them a cubic with zero slope at both ends.
#[inline(always)]
fn smooth_step(a: f64, b: f64, x: F8) -> F8 {
    let t = (x - a) / (b - a);
    let between = t * t * (F8::splat(3.0) - t * 2.0);
    let ended = (F8::splat(b)).le(x).select(F8::ONE, between);
    x.le(F8::splat(a)).select(F8::ZERO, ended)
}

impl RenderLight {
    /// Prepares a light. `None` for a light that is black, or that has a direction but points at
    /// its own location.
    ///
    /// # Errors
    ///
    /// Returns a [`LowerError`] if the object through which it shines cannot be built.
    pub(crate) fn new(light: &Light) -> Result<Option<Self>, LowerError> {
        let way = light.point_at - light.location;
        let is_aimed = light.parallel || !matches!(light.kind, LightKind::Point);
        if light.colour.is_black() || is_aimed && length(way) < NO_DISTANCE {
            return Ok(None);
        }
        let beam = match light.kind {
            LightKind::Point => Beam::All,
            LightKind::Spot { radius, falloff, tightness } => Beam::Cone {
                full: elementary::cos(radius),
                end: elementary::cos(falloff),
                tightness: Power::new(tightness),
            },
            LightKind::Cylinder { radius, falloff, tightness } => {
                // Without a positive radius the beam has no soft edge (a fact of the scene
                // language).
                let full = if radius > 0.0 { radius } else { falloff };
                Beam::Tube { full, end: falloff, tightness: Power::new(tightness) }
            }
        };
        let tube = matches!(beam, Beam::Tube { .. });
        let through = match &light.through {
            Some(object) => {
                let objects = vec![Object::clone(object)];
                Some(Arc::new(Scene { objects, ..Scene::default() }.lower_for_pictures()?))
            }
            None => None,
        };
        Ok(Some(Self {
            location: light.location,
            point_at: light.point_at,
            colour: light.colour,
            axis: unit(way),
            beam,
            parallel: light.parallel || tube,
            shadowless: light.shadowless,
            fade: light
                .fade
                .filter(|fade| fade.power > 0.0 && fade.distance.abs() > NO_DISTANCE)
                .map(|fade| (fade.distance, Power::new(fade.power))),
            end: None,
            // Without shadows the points of an area differ only in what they shine through, unless each
            // lights surfaces.
            area: light
                .area
                .as_ref()
                .filter(|area| !light.shadowless || light.through.is_some() || area.illuminates)
                .and_then(Area::new),
            illuminates: light.area.as_ref().is_some_and(|area| area.illuminates),
            through,
            group: light.group,
        }))
    }

    /// Sets `end` if a surface of the geometry may pass through the light.
    #[must_use]
    pub(crate) fn among(self, geometry: &Geometry) -> Self {
        let end = if self.shadowless || self.area.is_some() || self.through.is_some() {
            None
        } else if self.parallel {
            RayEnd::light_plane(geometry, self.location, self.axis)
        } else {
            RayEnd::light(geometry, self.location, mask::SHADOW | mask::CLEAR_SHADOW)
        };
        Self { end, ..self }
    }

    /// The light at some points, without shadows.
    #[inline(always)]
    pub(crate) fn at(&self, p: Point3<F8>, live: M8) -> Beamed {
        let (location, axis) = (self.location.to_vec(), self.axis);
        self.at_from(Vec3::<F8>::splat(location), Vec3::<F8>::splat(axis), p, live)
    }

    /// The light of one point of its area at some points, without shadows.
    pub(crate) fn at_from_point(&self, area: &Area, number: usize, p: Point3<F8>, live: M8) -> Beamed {
        let (location, axis) = self.point_of(area, number, self.at(p, live).to_light);
        self.at_from(location, axis, p, live)
    }

    /// The ends of shadow rays from some points to one point of its area, the ways there, and the points
    /// whose ways can be blocked. The ways of parallel light are exactly along it: from a surface that it
    /// only grazes they do not cross that surface.
    #[inline(always)]
    pub(crate) fn target(
        &self,
        (area, number): (&Area, usize),
        p: Point3<F8>,
        to_light: Vec3<F8>,
    ) -> (Point3<F8>, Vec3<F8>, M8) {
        let (location, axis) = self.point_of(area, number, to_light);
        if !self.parallel {
            return (location.to_point(), location - p.to_vec(), M8::ALL);
        }
        let depth = dot(p.to_vec() - location, axis);
        let way = axis * -depth;
        ((p.to_vec() + way).to_point(), way, (F8::ZERO).lt(depth))
    }

    /// The location and axis of one point of its area, for points that are lit from some directions.
    ///
    /// A fact of the scene language: each point of a parallel light is a parallel light of its own,
    /// which is aimed at the same point.
    #[inline(always)]
    fn point_of(&self, area: &Area, number: usize, to_light: Vec3<F8>) -> (Vec3<F8>, Vec3<F8>) {
        let location = Vec3::<F8>::splat(self.location.to_vec()) + area.offset(number, to_light);
        let axis = Vec3::<F8>::splat(self.axis);
        if !self.parallel {
            return (location, axis);
        }
        let way = Vec3::<F8>::splat(self.point_at.to_vec()) - location;
        let distance = length(way);
        let is_aimed = (F8::splat(NO_DISTANCE)).le(distance);
        (location, is_aimed.select3(way * (F8::ONE / distance), axis))
    }

    /// The light at some points, from some locations along some axes.
    #[inline(always)]
    fn at_from(&self, location: Vec3<F8>, axis: Vec3<F8>, p: Point3<F8>, live: M8) -> Beamed {
        let main = Vec3::<F8>::splat(self.axis);
        let from = p.to_vec() - location;
        let depth = dot(from, axis);
        let distance = if self.parallel { depth } else { length(from) };
        let to_light = if self.parallel { -axis } else { from * (F8::splat(-1.0) / distance) };
        // Each term is at most the length, 1, so the sum is finite if every term is.
        let size = to_light.x.abs() + to_light.y.abs() + to_light.z.abs();
        let mut lit = live & size.lt(F8::splat(f64::INFINITY));
        let mut strength = match self.beam {
            Beam::All => F8::ONE,
            Beam::Cone { full, end, tightness } => {
                let cosine = match (self.parallel, &self.area) {
                    (false, _) => depth / distance,
                    (true, None) => F8::ONE,
                    (true, Some(_)) => dot(axis, main),
                };
                // Behind its plane a parallel spotlight does not shine.
                if self.parallel {
                    lit &= (F8::ZERO).lt(depth);
                }
                // The full cone is tested first, and it alone decides where it is the wider one.
                let inside = (F8::splat(full)).le(cosine);
                let edge = inside.select(F8::ONE, smooth_step(end, full, cosine));
                lit &= !(edge.equals(F8::ZERO) | cosine.le(F8::ZERO));
                edge * tightness.lanes(cosine, lit)
            }
            Beam::Tube { full, end, tightness } => {
                // The tube is the same for all points of an area light.
                let from = p.to_vec() - Vec3::<F8>::splat(self.location.to_vec());
                let depth = dot(from, main);
                let off_axis = length(from - main * depth);
                lit &= !(depth.le(F8::ZERO) | (F8::splat(end)).le(off_axis));
                tightness.lanes(F8::ONE - off_axis / end, lit) * (F8::ONE - smooth_step(full, end, off_axis))
            }
        };
        if let Some((at, power)) = self.fade {
            // Behind the plane of a parallel light, and with a negative fade distance, the quotient
            // is negative. The formula is evaluated as it stands: light may be negative, and where
            // the power is undefined there is no light.
            let power = power.signed_lanes(distance / at, lit);
            lit &= power.equals(power);
            strength = strength * (F8::splat(2.0) / (F8::ONE + power));
        }
        // Only its shadow rays find the object through which a light shines.
        let never = self.shadowless && self.through.is_none();
        let (target, blockable) = match (never, self.parallel) {
            (true, _) => (location, M8::NONE),
            (false, false) => (location, lit),
            // Each point of an area light has a plane of its own.
            (false, true) if self.area.is_some() => (p.to_vec() - axis * depth, lit),
            (false, true) => (p.to_vec() - axis * depth, lit & (F8::ZERO).lt(depth)),
        };
        Beamed { lit, to_light, strength, target: target.to_point(), blockable }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use durer_scene::Fade;

    fn down(kind: LightKind) -> Light {
        Light { kind, point_at: Point3::ORIGIN, ..Light::point(Point3::new(0.0, 10.0, 0.0), Rgb::WHITE) }
    }

    fn point(p: [f64; 3]) -> Point3<F8> {
        Vec3::<F8>::splat(p.into()).to_point()
    }

    fn strength(light: &Light, p: [f64; 3]) -> f64 {
        let beamed = RenderLight::new(light).unwrap().unwrap().at(point(p), M8::ALL);
        beamed.lit.keep(beamed.strength).0[3]
    }

    #[test]
    fn fading_halves_nothing_at_the_fade_distance() {
        let fade = Some(Fade { distance: 5.0, power: 2.0 });
        let light = Light { fade, ..down(LightKind::Point) };
        assert!((strength(&light, [0.0, 0.0, 0.0]) - 0.4).abs() < 1e-15);
        assert!((strength(&light, [0.0, 5.0, 0.0]) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn parallel_light_fades_behind_its_plane_as_the_formula_says() {
        let at = |power, height| {
            let fade = Some(Fade { distance: 4.0, power });
            strength(&Light { fade, parallel: true, ..down(LightKind::Point) }, [1.0, height, 2.0])
        };
        assert_eq!([at(1.0, 9.0), at(1.0, 12.0), at(1.0, 18.0)], [2.0 / 1.25, 4.0, -2.0]);
        assert_eq!([at(2.0, 9.0), at(2.0, 18.0)], [2.0 / 1.0625, 0.4]);
        assert_eq!([at(0.5, 11.0), at(0.5, 6.0)], [0.0, 1.0]);
    }

    #[test]
    fn a_cone_ends_smoothly() {
        let degrees = |d: f64| d * PI / 180.0;
        let spot = LightKind::Spot { radius: degrees(30.0), falloff: degrees(45.0), tightness: 0.0 };
        let at = |angle: f64| strength(&down(spot), [10.0 * elementary::tan(degrees(angle)), 0.0, 0.0]);
        assert_eq!([at(0.0), at(29.9), at(45.1)], [1.0, 1.0, 0.0]);
        let (c, a, b) =
            (elementary::cos(degrees(40.0)), elementary::cos(degrees(45.0)), elementary::cos(degrees(30.0)));
        let t = (c - a) / (b - a);
        assert!((at(40.0) - t * t * (3.0 - 2.0 * t)).abs() < 1e-12);
        let wide = LightKind::Spot { radius: degrees(60.0), falloff: degrees(45.0), tightness: 1.0 };
        assert!((strength(&down(wide), [10.0, 0.0, 0.0]) - elementary::cos(degrees(45.0))).abs() < 1e-12);
    }

    #[test]
    fn a_tube_ends_at_its_falloff_and_shines_one_way() {
        let tube = LightKind::Cylinder { radius: 1.0, falloff: 2.0, tightness: 1.0 };
        assert_eq!(strength(&down(tube), [0.0, 0.0, 0.0]), 1.0);
        assert_eq!(strength(&down(tube), [1.0, -7.0, 0.0]), 0.5);
        assert_eq!(strength(&down(tube), [1.5, 0.0, 0.0]), 0.25 * 0.5);
        assert_eq!(strength(&down(tube), [2.0, 0.0, 0.0]), 0.0);
        assert_eq!(strength(&down(tube), [0.0, 11.0, 0.0]), 0.0);
    }

    #[test]
    fn a_tube_without_a_positive_radius_has_no_soft_edge() {
        for radius in [0.0, -1.0] {
            let tube = LightKind::Cylinder { radius, falloff: 2.0, tightness: 1.0 };
            assert_eq!(strength(&down(tube), [1.5, 0.0, 0.0]), 0.25);
        }
    }

    #[test]
    fn a_light_that_points_at_itself_does_not_shine() {
        let at = |kind, parallel, away| {
            let location = Point3::new(1.0, 0.0, 2.0);
            let point_at = Point3::new(1.0, away, 2.0);
            let light = Light { kind, parallel, point_at, ..Light::point(location, Rgb::WHITE) };
            RenderLight::new(&light).unwrap().is_some()
        };
        let spot = LightKind::Spot { radius: 0.5, falloff: 0.7, tightness: 0.0 };
        let tube = LightKind::Cylinder { radius: 1.0, falloff: 2.0, tightness: 0.0 };
        for (kind, parallel) in [(spot, false), (tube, false), (LightKind::Point, true)] {
            assert_eq!([0.0, 0.9e-10, 1.1e-10].map(|away| at(kind, parallel, away)), [false, false, true]);
        }
        assert!(at(LightKind::Point, false, 0.0));
    }

    #[test]
    fn a_negative_fade_distance_is_taken_at_its_word() {
        let at = |power| {
            let fade = Some(Fade { distance: -5.0, power });
            strength(&Light { fade, ..down(LightKind::Point) }, [0.0, 0.0, 0.0])
        };
        assert_eq!([at(1.0), at(2.0), at(0.5), at(0.0), at(-2.0)], [-2.0, 0.4, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn parallel_light_is_blocked_only_up_to_its_plane() {
        let light = Light { parallel: true, ..down(LightKind::Point) };
        let lamp = RenderLight::new(&light).unwrap().unwrap();
        let below = lamp.at(point([3.0, 0.0, 4.0]), M8::ALL);
        assert_eq!(below.to_light.lane(0), Vec3::Y);
        assert_eq!(below.target.to_vec().lane(0), Vec3::new(3.0, 10.0, 4.0));
        assert_eq!(below.blockable, M8::ALL);
        let above = lamp.at(point([3.0, 20.0, 4.0]), M8::ALL);
        assert_eq!((above.strength.0[0], above.blockable), (1.0, M8::NONE));
    }

    #[test]
    fn a_light_at_the_point_itself_does_not_shine() {
        let mut p = point([0.0, 10.0, 0.0]);
        p.x.0[2] = 1.0;
        assert_eq!(
            RenderLight::new(&down(LightKind::Point)).unwrap().unwrap().at(p, M8::ALL).lit.bits(),
            0b100
        );
    }
}
