//! The world: a scene prepared for the integrator (geometry, textures, lights, camera).

use std::collections::HashMap;
use std::sync::Arc;

use durer_geometry::Geometry;
use durer_math::{Aabb, Affine, AffineError, Ray};
use durer_scene::{Chart, LightGroup, LowerError, Lowered, Place, Placement, Rainbow, Scene, Texture};

use crate::camera::{Camera, CameraError};
use crate::film::Encoding;
use crate::fog::{Air, RenderFog};
use crate::light::RenderLight;
use crate::medium::Medium;
use crate::ray_end::RayEnd;
use crate::sky::Sky;
use crate::texture::{Grains, NoiseSettings, RenderTexture, building_with};

/// A scene prepared for rendering: built once, then shared by all threads.
pub struct World {
    pub(crate) lowered: Lowered,
    pub(crate) looks: Vec<Look>,
    pub(crate) paints: Vec<RenderTexture>,
    pub(crate) charts: Vec<Arc<Chart>>,
    pub(crate) media: Vec<Medium>,
    pub(crate) lamps: Vec<RenderLight>,
    camera: Option<Camera>,
    /// The point or plane where the camera's rays start.
    pub(crate) camera_end: Option<RayEnd>,
    /// The media in which all of the camera's rays start, if there is a camera and these are
    /// certainly the same for all rays.
    standing: Option<Vec<u32>>,
    pub(crate) sky: Sky,
    pub(crate) fogs: Vec<RenderFog>,
    rainbows: Vec<Rainbow>,
    /// For each light group, and before them for surfaces without a group: whether each light
    /// lights its surfaces. Empty without groups.
    lit: Vec<Vec<bool>>,
    grains: Grains,
    noise_settings: NoiseSettings,
    pub(crate) max_level: u32,
    pub(crate) adc_bailout: f64,
    /// Whether the opacity of a layer uses its filter times its greatest channel.
    pub(crate) filter_by_colour: bool,
    pub(crate) has_clear_shadows: bool,
    /// Whether some surfaces look different from inside.
    pub(crate) has_insides: bool,
    pub(crate) encoding: Encoding,
}

/// The look of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// The index of its texture.
    pub(crate) paint: u32,
    /// The index of the medium behind it.
    pub(crate) medium: u32,
    pub(crate) double_illuminate: bool,
    /// The index of the look that rays along the normal see.
    pub(crate) inside: u32,
    /// The index of its texture coordinates, if the texture is shown by them.
    pub(crate) chart: Option<u32>,
    /// One more than the number of its light group, or 0.
    pub(crate) group: u32,
}

/// Why a scene cannot be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// An object cannot be built.
    #[error(transparent)]
    Lower(#[from] LowerError),
    /// The camera cannot be built.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A texture's transformation is singular or not finite.
    #[error("texture: {0}")]
    Texture(#[from] AffineError),
}

/// Before this version of the language, a filtering layer is less opaque.
const NEW_OPACITY: f64 = 3.7;

impl World {
    /// Builds the geometry of a scene and prepares its looks, lights and camera.
    pub fn new(scene: &Scene) -> Result<Self, WorldError> {
        let grains = scene.noise.as_ref().map_or(Grains::Own, |noise| Grains::Learned(noise.clone()));
        building_with(grains.clone(), (&scene.settings).into(), || Self::built(scene, grains))
    }

    fn built(scene: &Scene, grains: Grains) -> Result<Self, WorldError> {
        let lowered = scene.lower_for_pictures()?;
        let settings = &scene.settings;
        let (mut paints, mut charts) = (Vec::new(), Vec::new());
        let mut looks = Vec::with_capacity(lowered.looks.len());
        // Looks that differ only in their interior share a texture.
        let mut known: HashMap<(*const Texture, *const Placement), u32> = HashMap::new();
        for (own, look) in (0..).zip(&lowered.looks) {
            let key = (&raw const *look.texture, &raw const *look.frame);
            let paint = match known.get(&key) {
                Some(&paint) => paint,
                None => {
                    paints.push(RenderTexture::new(
                        &look.texture,
                        look.frame.affine(),
                        &Affine::IDENTITY,
                        settings.ambient_light,
                    )?);
                    let number = (paints.len() - 1) as u32;
                    known.insert(key, number);
                    number
                }
            };
            let inside = look.inside.map_or(own, |inside| inside.0);
            let double_illuminate = look.double_illuminate;
            let group = look.light_group.map_or(0, |group| group + 1);
            let chart = look.chart.as_ref().map(|chart| {
                charts.push(chart.clone());
                (charts.len() - 1) as u32
            });
            looks.push(Look { paint, medium: look.medium, double_illuminate, inside, chart, group });
        }
        let camera = scene.camera.as_ref().map(Camera::new).transpose()?;
        let standing = standing(&lowered, scene.camera.as_ref(), camera.as_ref());
        let mut lamps = Vec::with_capacity(scene.lights.len());
        for light in &scene.lights {
            if let Some(lamp) = RenderLight::new(light)? {
                lamps.push(lamp.among(&lowered.geometry));
            }
        }
        Ok(Self {
            has_insides: lowered.looks.iter().any(|l| l.inside.is_some()),
            has_clear_shadows: lowered.looks.iter().any(|l| l.is_clear),
            media: lowered.media.iter().map(|i| Medium::new(i)).collect(),
            lit: lit(&scene.light_groups, &lamps),
            lamps,
            looks,
            charts,
            paints,
            camera_end: camera.as_ref().map(|camera| RayEnd::camera(&lowered.geometry, camera.start_size())),
            camera,
            standing,
            fogs: scene.fogs.iter().map(RenderFog::new).collect(),
            rainbows: scene.rainbows.clone(),
            grains,
            noise_settings: settings.into(),
            sky: Sky::new(scene, settings.version < NEW_OPACITY)?,
            max_level: settings.max_trace_level,
            adc_bailout: settings.adc_bailout,
            filter_by_colour: settings.version < NEW_OPACITY,
            encoding: settings.assumed_gamma.into(),
            lowered,
        })
    }

    /// The geometry that rays hit.
    pub fn geometry(&self) -> &Geometry {
        &self.lowered.geometry
    }

    /// The camera, if the scene has one.
    pub fn camera(&self) -> Option<&Camera> {
        self.camera.as_ref()
    }

    /// Replaces the camera. Nothing else is built again.
    ///
    /// # Errors
    ///
    /// Returns a [`CameraError`] if the camera cannot be built; the world then keeps its own.
    pub fn set_camera(&mut self, camera: &durer_scene::Camera) -> Result<(), CameraError> {
        let built = building_with(self.grains.clone(), self.noise_settings, || Camera::new(camera))?;
        self.standing = standing(&self.lowered, Some(camera), Some(&built));
        self.camera_end = Some(RayEnd::camera(&self.lowered.geometry, built.start_size()));
        self.camera = Some(built);
        Ok(())
    }

    /// How the colour values of its pictures relate to light.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Warnings about the scene. It is rendered nevertheless.
    pub fn warnings(&self) -> &[(Option<Place>, String)] {
        &self.lowered.warnings
    }

    /// The index of a primitive's look in [`World::looks`].
    #[inline(always)]
    pub(crate) fn look_number(&self, object: u32, primitive: u32) -> u32 {
        // Every primitive of the geometry has a look.
        self.lowered.look_of(object, primitive).map_or(0, |l| l.0)
    }

    /// The media in which camera rays that start in this box begin, if these are certainly the
    /// same.
    pub(crate) fn standing(&self, origins: impl FnOnce() -> Aabb) -> Option<Vec<u32>> {
        self.standing.clone().or_else(|| self.lowered.media_in(&origins()))
    }

    /// The fog and the rainbows around rays in these media.
    #[inline(always)]
    pub(crate) fn air_in(&self, media: &[u32]) -> Air<'_> {
        let air = Air { fogs: &self.fogs, rainbows: &self.rainbows };
        if air.is_clear() || media.iter().any(|&m| !self.lowered.hollow[m as usize]) {
            return Air::CLEAR;
        }
        air
    }

    /// Whether a light lights surfaces with this look.
    #[inline(always)]
    pub(crate) fn lights(&self, lamp: usize, look: &Look) -> bool {
        // Without groups the list is empty.
        self.lit.get(look.group as usize).is_none_or(|lit| lit.get(lamp).is_none_or(|&lit| lit))
    }

    /// Appends the media in which a camera ray starts.
    pub(crate) fn media_of(&self, ray: &Ray, media: &mut Vec<u32>) {
        self.lowered.media_of(ray, media);
    }
}

/// Which lights light the surfaces of each light group, and before them those without a group.
fn lit(groups: &[LightGroup], lamps: &[RenderLight]) -> Vec<Vec<bool>> {
    if groups.is_empty() {
        return Vec::new();
    }
    let all = core::iter::once(None).chain((0..).map(Some).take(groups.len()));
    let lights = |group| lamps.iter().map(|lamp| LightGroup::lights(groups, lamp.group, group)).collect();
    all.map(lights).collect()
}

/// The media in which all of the camera's rays start, if these are certainly the same for all.
fn standing(
    lowered: &Lowered,
    camera: Option<&durer_scene::Camera>,
    built: Option<&Camera>,
) -> Option<Vec<u32>> {
    match built {
        Some(Camera::Perspective(camera)) => lowered.media_at(camera.origin()),
        _ => camera.and_then(|camera| lowered.media_in(&camera.standpoints())),
    }
}

impl core::fmt::Debug for World {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("World")
            .field("lowered", &self.lowered)
            .field("paints", &self.paints.len())
            .field("lamps", &self.lamps.len())
            .field("camera", &self.camera)
            .finish_non_exhaustive()
    }
}
