//! Finishes with their constants precomputed.

use super::metal::tint;
use crate::lanes::Rgb8;
use crate::power::Power;
use crate::texture::Stir;
use crate::vector::{dot, reflect};
use core::f64::consts::TAU;
use durer_math::{F8, M8, Point3, Vec3, elementary};
use durer_scene::{Irid, Octaves, Rgb, Turbulence};

/// From this size on, Phong's highlight is cut off where its cosine is [`PHONG_END`] (a fact of the
/// scene language).
const PHONG_SHARP: f64 = 60.0;
const PHONG_END: f64 = 0.0008;

/// The octaves of noise by which the thickness of a film varies (a fact of the scene language).
const FILM_OCTAVES: u32 = 5;

/// A finish with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finish {
    /// Ambient light and emission together.
    pub(crate) own_light: Rgb,
    diffuse: f64,
    diffuse_back: f64,
    brilliance: Power,
    phong: f64,
    phong_power: Power,
    phong_end: f64,
    specular: f64,
    specular_power: Power,
    metallic: f64,
    pub(crate) crand: f64,
    pub(crate) mirror: Option<Box<Mirror>>,
    pub(crate) conserve_energy: bool,
    pub(crate) irid: Option<Irid>,
    /// The noise that changes the film's thickness from place to place.
    pub(crate) stirred: Option<Box<Stir>>,
    /// Whether the scene's lights have any effect.
    pub(crate) is_lit: bool,
}

/// A reflection with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mirror {
    min: Rgb,
    max: Rgb,
    falloff: Power,
    pub(crate) fresnel: bool,
    metallic: f64,
    /// The reflected colour is raised to this power.
    exponent: Power,
}

/// The directions from eight surface points to a light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incidence {
    /// The lanes that are used. The answers in other lanes are unspecified.
    pub(crate) live: M8,
    /// The unit directions to the light.
    pub(crate) to_light: Vec3<F8>,
    /// The cosines of their angles to the normals; negative behind the surface.
    pub(crate) cosine: F8,
    /// Whether light from behind counts like light from the front.
    pub(crate) double: bool,
}

/// The directions from which eight surface points are viewed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// The unit directions from the eye to the points.
    pub(crate) eye: Vec3<F8>,
    /// The unit normals, on the side of the eye.
    pub(crate) normal: Vec3<F8>,
    /// The cosines between them.
    pub(crate) cosine: F8,
}

impl Finish {
    pub(crate) fn new(f: &durer_scene::Finish, ambient_light: Rgb) -> Self {
        // Negative amounts count as zero (a fact of the scene language).
        let [diffuse, diffuse_back, phong, specular, metallic] =
            [f.diffuse, f.diffuse_back, f.phong, f.specular, f.metallic].map(|amount| amount.max(0.0));
        let mirror = f.reflection.as_ref().filter(|r| !(r.min.is_black() && r.max.is_black()));
        Self {
            own_light: f.ambient * ambient_light + f.emission,
            diffuse,
            diffuse_back,
            brilliance: Power::new(f.brilliance),
            phong,
            phong_power: Power::new(f.phong_size),
            phong_end: if f.phong_size >= PHONG_SHARP { PHONG_END } else { 0.0 },
            specular,
            specular_power: Power::new(1.0 / f.roughness),
            metallic,
            crand: f.crand,
            mirror: mirror.map(|r| {
                Box::new(Mirror {
                    min: r.min,
                    max: r.max,
                    falloff: Power::new(r.falloff),
                    fresnel: r.fresnel,
                    metallic: r.metallic,
                    exponent: Power::new(1.0 / r.exponent),
                })
            }),
            conserve_energy: f.conserve_energy,
            irid: f.irid,
            stirred: f.irid.filter(|irid| irid.turbulence != 0.0).map(|irid| {
                let octaves = Octaves { count: FILM_OCTAVES, lambda: 2.0, omega: 0.5 };
                let amount = Vec3::new(1.0, 1.0, 1.0);
                Box::new(Stir::new(&Turbulence { amount, octaves, generator: irid.generator }))
            }),
            is_lit: diffuse != 0.0 || diffuse_back != 0.0 || phong != 0.0 || specular != 0.0,
        }
    }

    /// The fraction of a light that is scattered diffusely, less `grain`.
    #[inline(always)]
    pub(crate) fn scattered(&self, at: &Incidence, grain: F8) -> F8 {
        let front = if at.double { M8::ALL } else { (F8::ZERO).le(at.cosine) };
        let k = front.select(F8::splat(self.diffuse), F8::splat(self.diffuse_back));
        let scatters = !k.equals(F8::ZERO);
        let mut shown = k * self.brilliance.lanes(at.cosine.abs(), at.live & scatters);
        if self.crand > 0.0 {
            shown = shown - grain;
            shown = (F8::ZERO).lt(grain).select(shown.max(F8::ZERO), shown);
        }
        scatters.keep(shown)
    }

    /// Whether light from behind the surface has any effect.
    #[inline]
    pub(crate) fn lit_from_behind(&self) -> bool {
        self.diffuse_back != 0.0
    }

    /// Whether there are highlights.
    #[inline]
    pub(crate) fn shines(&self) -> bool {
        self.phong != 0.0 || self.specular != 0.0
    }

    /// The fraction of a light that is seen as a highlight, on a pigment of colour `colour`.
    #[inline(always)]
    pub(crate) fn highlight(&self, at: &Incidence, view: &View, colour: Rgb8) -> Rgb8 {
        let mut shine = F8::ZERO;
        if self.phong != 0.0 {
            let cosine = dot(reflect(view.eye, view.normal), at.to_light);
            let seen = (F8::splat(self.phong_end)).lt(cosine);
            shine += seen.keep(self.phong_power.lanes(cosine, at.live & seen) * self.phong);
        }
        if self.specular != 0.0 {
            let half = at.to_light - view.eye;
            let length = dot(half, half).sqrt();
            let cosine = dot(half, view.normal);
            let seen = (F8::ZERO).lt(cosine) & (F8::ZERO).lt(length);
            let power = self.specular_power.lanes(cosine / length, at.live & seen);
            shine += seen.keep(power * self.specular);
        }
        if self.metallic == 0.0 {
            Rgb8::grey(shine)
        } else {
            let live = at.live & !shine.equals(F8::ZERO);
            tint(self.metallic, at.cosine, colour, live) * shine
        }
    }
}

impl Finish {
    /// The factors by which the interference of a thin film changes light at some points. `way` is
    /// the sum of the cosines of the angles at which light comes and goes.
    pub(crate) fn interference(&self, p: Point3<F8>, way: F8, live: M8) -> Rgb8 {
        let mut factors = Rgb8::WHITE;
        let Some(irid) = &self.irid else { return factors };
        let thickness = match self.stirred.as_deref() {
            None => F8::splat(irid.thickness),
            Some(stir) => {
                let varied = stir.scalar(p) * 2.0 - F8::ONE;
                (varied * irid.turbulence + F8::ONE) * irid.thickness
            }
        };
        for lane in live.lanes() {
            let factor = |wavelength: f64| {
                let turns = thickness.0[lane] * way.0[lane] / wavelength;
                1.0 + irid.amount * elementary::cos(TAU * turns)
            };
            factors.set_lane(lane, irid.wavelength.map(factor));
        }
        factors
    }
}

impl Mirror {
    /// Whether the mirror shows reflected colours unchanged.
    #[inline]
    pub(crate) fn is_plain(&self) -> bool {
        self.exponent == Power::One
    }

    /// The colour that the mirror shows for a reflected colour.
    #[inline]
    pub(crate) fn shown(&self, seen: Rgb) -> Rgb {
        seen.map(|v| self.exponent.of(v.max(0.0)))
    }

    /// The factor of the reflected light, and the factor of the weight of its rays. `cosine` is
    /// that of the angle between the normal and the eye; `fresnel` is Fresnel's reflectance, for
    /// mirrors that use it.
    #[inline(always)]
    pub(crate) fn reflectance(&self, cosine: F8, colour: Rgb8, live: M8, fresnel: F8) -> (Rgb8, F8) {
        let most = F8::splat(self.min.greatest().max(self.max.greatest()));
        let (r, importance) = if self.fresnel {
            let r = Rgb8::mixed(self.min, self.max, fresnel);
            (r, r.greatest())
        } else if self.min == self.max {
            (Rgb8::splat(self.min), most)
        } else {
            // Where a perturbed normal points away from the eye this is above 1 (a fact of the language).
            let k = self.falloff.lanes((F8::ONE - cosine).max(F8::ZERO), live);
            // Here the angle has no effect.
            (Rgb8::mixed(self.min, self.max, k), most)
        };
        // Nor has a metal's colour.
        let r = if self.metallic == 0.0 { r } else { r * tint(self.metallic, cosine, colour, live) };
        (r, importance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Reflection;

    fn ready(finish: &durer_scene::Finish) -> Finish {
        Finish::new(finish, Rgb::WHITE)
    }

    fn incidence(to_light: Vec3) -> Incidence {
        let to_light = Vec3::<F8>::splat(to_light);
        Incidence { live: M8::ALL, to_light, cosine: to_light.y, double: false }
    }

    /// The fraction of the light that is scattered, without grain.
    fn scattered(f: &Finish, to_light: Vec3) -> f64 {
        f.scattered(&incidence(to_light), F8::ZERO).0[4]
    }

    /// The highlight, viewed perpendicularly.
    fn highlight(f: &Finish, to_light: Vec3) -> f64 {
        let up = Vec3::<F8>::splat(Vec3::Y);
        let view = View { eye: -up, normal: up, cosine: F8::ONE };
        f.highlight(&incidence(to_light), &view, Rgb8::WHITE).lane(6).r
    }

    #[test]
    fn brilliance_is_an_exponent() {
        let f = ready(&durer_scene::Finish { brilliance: 3.0, diffuse: 0.5, ..Default::default() });
        assert_eq!(scattered(&f, Vec3::new(0.0, 0.5, 0.0)), 0.0625);
    }

    #[test]
    fn light_from_behind_has_its_own_part() {
        let f = ready(&durer_scene::Finish { diffuse: 0.5, diffuse_back: 0.25, ..Default::default() });
        assert_eq!(scattered(&f, -Vec3::Y), 0.25);
        let f = ready(&durer_scene::Finish { diffuse: 0.5, ..Default::default() });
        assert_eq!(scattered(&f, -Vec3::Y), 0.0);
    }

    #[test]
    fn grain_takes_light_away_but_not_more_than_there_is() {
        let f = ready(&durer_scene::Finish { diffuse: 0.5, crand: 0.9, ..Default::default() });
        let grain = F8([0.0, 0.25, 0.5, 0.75, 0.0, 0.25, 0.5, 0.75]);
        let shown = f.scattered(&incidence(Vec3::Y), grain);
        assert_eq!(shown, F8([0.5, 0.25, 0.0, 0.0, 0.5, 0.25, 0.0, 0.0]));
    }

    #[test]
    fn blinns_exponent_is_one_over_roughness() {
        let f = durer_scene::Finish { specular: 1.0, roughness: 0.5, ..Default::default() };
        // Eye straight down, light at 90 degrees: the half vector is at 45 degrees, cos^2 = 1/2.
        assert!((highlight(&ready(&f), Vec3::X) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_sharp_phong_highlight_ends() {
        let shine = |size, cosine: f64| {
            let f = durer_scene::Finish { phong: 1.0, phong_size: size, ..Default::default() };
            highlight(&ready(&f), Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0))
        };
        assert_eq!(shine(60.0, 0.0005), 0.0);
        assert_eq!(shine(2.0, 0.5), 0.25);
    }

    #[test]
    fn mirrors_go_from_min_to_max() {
        let r = Reflection { falloff: 2.0, min: Rgb::grey(0.2), ..Reflection::constant(Rgb::grey(1.0)) };
        let f = durer_scene::Finish { reflection: Some(Box::new(r)), ..Default::default() };
        let mirror = ready(&f).mirror.unwrap();
        let at = |cosine| {
            let cosine = F8::splat(cosine);
            mirror.reflectance(cosine, Rgb8::WHITE, M8::ALL, F8::ZERO).0.lane(1).r
        };
        assert_eq!(at(1.0), 0.2);
        assert!((at(0.5) - 0.4).abs() < 1e-15);
        assert_eq!(at(0.0), 1.0);
        // POV-Ray's mirrors reflect more than that where a perturbed normal points away.
        assert!((at(-0.5) - 2.0).abs() < 1e-15);
    }
}
