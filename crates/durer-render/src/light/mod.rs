//! Lights made ready: from where they shine on a point, and how strongly.

use crate::power::Power;
use crate::vector::{dot, length, unit};
use durer_math::{Point3, Vec3, elementary};
use durer_scene::{Light, LightKind, Rgb};

/// A light.
#[derive(Clone, Debug)]
pub(crate) struct Lamp {
    location: Point3,
    pub(crate) colour: Rgb,
    /// From the location to where it points, of length 1.
    axis: Vec3,
    beam: Beam,
    pub(crate) parallel: bool,
    pub(crate) shadowless: bool,
    fade: Option<(f64, Power)>,
}

#[derive(Clone, Copy, Debug)]
enum Beam {
    All,
    /// Cosines at which light is full and at which it ends.
    Cone {
        full: f64,
        end: f64,
        tightness: Power,
    },
    /// Distances to the axis at which light is full and at which it ends.
    Tube {
        full: f64,
        end: f64,
        tightness: Power,
    },
}

/// A light at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beamed {
    /// The unit direction from the point to the light.
    pub(crate) to_light: Vec3,
    /// What the light's colour is multiplied by.
    pub(crate) strength: f64,
    /// How far blockers may be: the light itself, or for parallel light the point of its plane above. `None` if nothing can block it.
    pub(crate) target: Option<Point3>,
}

/// 0 up to `a`, 1 from `b` on, and between them a cubic with level ends.
fn smooth_step(a: f64, b: f64, x: f64) -> f64 {
    if x <= a {
        return 0.0;
    }
    if x >= b {
        return 1.0;
    }
    let t = (x - a) / (b - a);
    t * t * (3.0 - 2.0 * t)
}

impl Lamp {
    /// `None` for a light that is black.
    pub(crate) fn new(light: &Light) -> Option<Self> {
        if light.colour.is_black() {
            return None;
        }
        let beam = match light.kind {
            LightKind::Point => Beam::All,
            LightKind::Spot { radius, falloff, tightness } => Beam::Cone {
                full: elementary::cos(radius),
                end: elementary::cos(falloff),
                tightness: Power::new(tightness),
            },
            LightKind::Cylinder { radius, falloff, tightness } => {
                Beam::Tube { full: radius, end: falloff, tightness: Power::new(tightness) }
            }
        };
        let tube = matches!(beam, Beam::Tube { .. });
        Some(Self {
            location: light.location,
            colour: light.colour,
            axis: unit(light.point_at - light.location),
            beam,
            parallel: light.parallel || tube,
            shadowless: light.shadowless,
            fade: light.fade.map(|f| (f.distance, Power::new(f.power))),
        })
    }

    /// The light at `p`; `None` where it does not shine. Blockers are not looked for.
    #[inline]
    pub(crate) fn at(&self, p: Point3) -> Option<Beamed> {
        let from = p - self.location;
        let depth = dot(from, self.axis);
        let distance = if self.parallel { depth } else { length(from) };
        let to_light = if self.parallel { -self.axis } else { from * (-1.0 / distance) };
        if !to_light.is_finite() {
            return None;
        }
        let mut strength = match self.beam {
            Beam::All => 1.0,
            Beam::Cone { full, end, tightness } => {
                let cosine = if self.parallel { 1.0 } else { depth / distance };
                // The full cone is asked for first, and decides alone where it is the wider one.
                let edge = if cosine >= full { 1.0 } else { smooth_step(end, full, cosine) };
                if edge == 0.0 || cosine <= 0.0 {
                    return None;
                }
                edge * tightness.of(cosine)
            }
            Beam::Tube { full, end, tightness } => {
                let off_axis = length(from - self.axis * depth);
                if depth <= 0.0 || off_axis >= end {
                    return None;
                }
                tightness.of(1.0 - off_axis / end) * (1.0 - smooth_step(full, end, off_axis))
            }
        };
        if let Some((at, power)) = self.fade {
            strength *= 2.0 / (1.0 + power.of((distance / at).abs()));
        }
        let target =
            if !self.parallel { Some(self.location) } else { (depth > 0.0).then(|| p - self.axis * depth) };
        Some(Beamed { to_light, strength, target: target.filter(|_| !self.shadowless) })
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

    fn strength(light: &Light, p: [f64; 3]) -> f64 {
        Lamp::new(light).unwrap().at(p.into()).map_or(0.0, |b| b.strength)
    }

    #[test]
    fn fading_halves_nothing_at_the_fade_distance() {
        let fade = Some(Fade { distance: 5.0, power: 2.0 });
        let light = Light { fade, ..down(LightKind::Point) };
        assert!((strength(&light, [0.0, 0.0, 0.0]) - 0.4).abs() < 1e-15);
        assert!((strength(&light, [0.0, 5.0, 0.0]) - 1.0).abs() < 1e-15);
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
    fn parallel_light_is_blocked_only_up_to_its_plane() {
        let light = Light { parallel: true, ..down(LightKind::Point) };
        let lamp = Lamp::new(&light).unwrap();
        let below = lamp.at(Point3::new(3.0, 0.0, 4.0)).unwrap();
        assert_eq!((below.to_light, below.target), (Vec3::Y, Some(Point3::new(3.0, 10.0, 4.0))));
        let above = lamp.at(Point3::new(3.0, 20.0, 4.0)).unwrap();
        assert_eq!((above.strength, above.target), (1.0, None));
    }

    #[test]
    fn a_light_at_the_point_itself_does_not_shine() {
        assert!(Lamp::new(&down(LightKind::Point)).unwrap().at(Point3::new(0.0, 10.0, 0.0)).is_none());
    }
}
