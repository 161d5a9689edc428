//! Finishes with their constants worked out.

use super::metal::tint;
use crate::power::Power;
use crate::vector::dot;
use durer_math::{Vec3, elementary};
use durer_scene::Rgb;

/// From this size on, Phong's highlight ends where its cosine is [`PHONG_END`]: a fact of the scene language.
const PHONG_SHARP: f64 = 60.0;
const PHONG_END: f64 = 0.0008;

/// A finish made ready.
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
    /// Whether light changes anything.
    pub(crate) is_lit: bool,
}

/// A reflection made ready.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mirror {
    min: Rgb,
    max: Rgb,
    falloff: Power,
    fresnel: bool,
    metallic: f64,
    /// The reflected colour is raised to this.
    exponent: Power,
}

/// A light seen from a point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incidence {
    /// The unit direction to the light.
    pub(crate) to_light: Vec3,
    /// The cosine of its angle to the normal; negative behind the surface.
    pub(crate) cosine: f64,
    /// Light from behind counts like light from the front.
    pub(crate) double: bool,
}

impl Finish {
    pub(crate) fn new(f: &durer_scene::Finish, ambient_light: Rgb) -> Self {
        let albedo = if f.diffuse_albedo { (f.brilliance + 1.0) * 0.5 } else { 1.0 };
        let phong_albedo = if f.phong_albedo { (f.phong_size + 1.0) * 0.5 } else { 1.0 };
        let n = 1.0 / f.roughness;
        let specular_albedo =
            if f.specular_albedo { (n + 2.0) / (4.0 * (2.0 - elementary::exp2(-n * 0.5))) } else { 1.0 };
        let mirror = f.reflection.as_ref().filter(|r| !(r.min.is_black() && r.max.is_black()));
        Self {
            own_light: f.ambient * ambient_light + f.emission,
            diffuse: f.diffuse * albedo,
            diffuse_back: f.diffuse_back * albedo,
            brilliance: Power::new(f.brilliance),
            phong: f.phong * phong_albedo,
            phong_power: Power::new(f.phong_size),
            phong_end: if f.phong_size >= PHONG_SHARP { PHONG_END } else { 0.0 },
            specular: f.specular * specular_albedo,
            specular_power: Power::new(n),
            metallic: f.metallic,
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
            is_lit: f.diffuse != 0.0 || f.diffuse_back != 0.0 || f.phong != 0.0 || f.specular != 0.0,
        }
    }

    /// The part of a light that is scattered evenly, less `grain`.
    #[inline]
    pub(crate) fn scattered(&self, at: &Incidence, grain: f64) -> f64 {
        let k = if at.cosine >= 0.0 || at.double { self.diffuse } else { self.diffuse_back };
        if k == 0.0 {
            return 0.0;
        }
        let cosine = at.cosine.abs();
        let shown = k * self.brilliance.of(cosine) - grain;
        if grain > 0.0 { shown.max(0.0) } else { shown }
    }

    /// Whether light from behind the surface changes anything.
    #[inline]
    pub(crate) fn lit_from_behind(&self) -> bool {
        self.diffuse_back != 0.0
    }

    /// Whether there are highlights.
    #[inline]
    pub(crate) fn shines(&self) -> bool {
        self.phong != 0.0 || self.specular != 0.0
    }

    /// The part of a light that is seen as a highlight, on paint of colour `colour`. `eye` is the unit direction of sight, `mirrored` its mirror
    /// image in the surface, `normal` the unit normal that faces the eye.
    #[inline]
    pub(crate) fn highlight(
        &self,
        at: &Incidence,
        eye: Vec3,
        mirrored: Vec3,
        normal: Vec3,
        colour: Rgb,
    ) -> Rgb {
        let mut shine = 0.0;
        if self.phong != 0.0 {
            let cosine = dot(mirrored, at.to_light);
            if cosine > self.phong_end {
                shine += self.phong * self.phong_power.of(cosine);
            }
        }
        if self.specular != 0.0 {
            let half = at.to_light - eye;
            let length = dot(half, half).sqrt();
            let cosine = dot(half, normal);
            if cosine > 0.0 && length > 0.0 {
                shine += self.specular * self.specular_power.of(cosine / length);
            }
        }
        if shine == 0.0 {
            Rgb::BLACK
        } else if self.metallic == 0.0 {
            Rgb::grey(shine)
        } else {
            tint(self.metallic, at.cosine, colour) * shine
        }
    }
}

impl Mirror {
    /// What the mirror makes of what is seen in it.
    #[inline]
    pub(crate) fn shown(&self, seen: Rgb) -> Rgb {
        if self.exponent == Power::One { seen } else { seen.map(|v| self.exponent.of(v.max(0.0))) }
    }

    /// What the reflected light is multiplied by. `cosine` is that of the angle between the normal and the eye; `fresnel` is Fresnel's
    /// reflectance, asked for only if it is needed.
    #[inline]
    pub(crate) fn reflectance(&self, cosine: f64, colour: Rgb, fresnel: impl FnOnce() -> f64) -> Rgb {
        let r = if self.fresnel {
            let k = fresnel();
            self.min.zip(self.max, |a, b| a + (b - a) * k)
        } else if self.min == self.max {
            self.min
        } else {
            let k = self.falloff.of((1.0 - cosine).max(0.0));
            self.min.zip(self.max, |a, b| a + (b - a) * k)
        };
        if self.metallic == 0.0 { r } else { r * tint(self.metallic, cosine, colour) }
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
        Incidence { to_light, cosine: to_light.y, double: false }
    }

    #[test]
    fn brilliance_is_an_exponent() {
        let f = ready(&durer_scene::Finish { brilliance: 3.0, diffuse: 0.5, ..Default::default() });
        assert_eq!(f.scattered(&incidence(Vec3::new(0.0, 0.5, 0.0)), 0.0), 0.0625);
    }

    #[test]
    fn the_albedo_forms_scatter_what_they_say() {
        // The integral of k cos^b over the half sphere, with the cosine of projection, is 2 pi k / (b + 2) for plain diffuse light: the
        // language's factor is (b + 1) / 2 all the same.
        let f =
            durer_scene::Finish { brilliance: 3.0, diffuse: 0.5, diffuse_albedo: true, ..Default::default() };
        assert_eq!(ready(&f).scattered(&incidence(Vec3::Y), 0.0), 1.0);
    }

    #[test]
    fn light_from_behind_has_its_own_part() {
        let f = ready(&durer_scene::Finish { diffuse: 0.5, diffuse_back: 0.25, ..Default::default() });
        assert_eq!(f.scattered(&incidence(-Vec3::Y), 0.0), 0.25);
        let f = ready(&durer_scene::Finish { diffuse: 0.5, ..Default::default() });
        assert_eq!(f.scattered(&incidence(-Vec3::Y), 0.0), 0.0);
    }

    #[test]
    fn blinns_exponent_is_one_over_roughness() {
        let f = durer_scene::Finish { specular: 1.0, roughness: 0.5, ..Default::default() };
        // Eye straight down, light at 90 degrees: the half vector is at 45 degrees, cos^2 = 1/2.
        let light = incidence(Vec3::X);
        let shine = ready(&f).highlight(&light, -Vec3::Y, Vec3::Y, Vec3::Y, Rgb::WHITE);
        assert!((shine.r - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_sharp_phong_highlight_ends() {
        let shine = |size, cosine: f64| {
            let f = durer_scene::Finish { phong: 1.0, phong_size: size, ..Default::default() };
            let light = incidence(Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0));
            ready(&f).highlight(&light, -Vec3::Y, Vec3::Y, Vec3::Y, Rgb::WHITE).r
        };
        assert_eq!(shine(60.0, 0.0005), 0.0);
        assert_eq!(shine(2.0, 0.5), 0.25);
    }

    #[test]
    fn mirrors_go_from_min_to_max() {
        let r = Reflection { falloff: 2.0, min: Rgb::grey(0.2), ..Reflection::constant(Rgb::grey(1.0)) };
        let f = durer_scene::Finish { reflection: Some(Box::new(r)), ..Default::default() };
        let mirror = ready(&f).mirror.unwrap();
        assert_eq!(mirror.reflectance(1.0, Rgb::WHITE, || unreachable!()).r, 0.2);
        assert!((mirror.reflectance(0.5, Rgb::WHITE, || unreachable!()).r - 0.4).abs() < 1e-15);
        assert_eq!(mirror.reflectance(0.0, Rgb::WHITE, || unreachable!()).r, 1.0);
    }
}
