//! The scene builder: turns the reader's values into scene data, one finished statement after the
//! other.

use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

use durer_math::{Affine, Point3, Vec3};
use durer_scene as scene;

use crate::atmosphere::SkySphere;
use crate::camera::Camera;
use crate::colour::Colour;
use crate::diagnostics::{Error, Place, Result};
use crate::light::{Beam, Light};
use crate::limits::{self, Charge};
use crate::object::{Object, Shape};
use crate::parser::Parser;
use crate::settings::{Gamma, Globals};
use crate::texture::{Film, Finish, Interior, Layer, Texture};
use crate::texture_builder::{pigment, texture};
use crate::transform::{Matrix, length};

/// The scene so far.
#[derive(Debug, Default)]
pub(crate) struct Output {
    pub(crate) camera: Option<Camera>,
    pub(crate) background: Option<Colour>,
    pub(crate) fogs: Vec<scene::Fog>,
    pub(crate) sky: Option<(Rc<SkySphere>, Place)>,
    pub(crate) globals: Globals,
    pub(crate) objects: Vec<scene::Object>,
    /// The charges for what the objects share with those of the reader.
    shared: Vec<Rc<Charge>>,
    lights: Vec<scene::Light>,
    pub(crate) rainbows: Vec<scene::Rainbow>,
    /// The light groups.
    groups: Vec<scene::LightGroup>,
    /// The number of the light group whose objects are being converted.
    pub(crate) group: Option<u32>,
    /// The textures made lately. Equal textures are shared.
    textures: VecDeque<(Rc<Texture>, Arc<scene::Texture>)>,
    default: Option<(Rc<Layer>, Arc<scene::Texture>)>,
}

/// The number of textures that a new one is compared with.
const TEXTURES_COMPARED: usize = 8;

/// The approximate memory of a texture beyond its layers and finishes.
const TEXTURE_EXTRA: usize = 448;

pub(crate) fn point(p: [f64; 3]) -> Point3 {
    Point3::new(p[0], p[1], p[2])
}

pub(crate) fn vector(v: [f64; 3]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

/// A normal, scaled to length 1 as POV-Ray does before it interpolates. One without length stays as
/// it is.
pub(crate) fn unit(v: [f64; 3]) -> Vec3 {
    let length = length(v);
    if length > 0.0 && length.is_finite() { vector(v.map(|x| x / length)) } else { vector(v) }
}

pub(crate) fn rgb(c: [f64; 3]) -> scene::Rgb {
    scene::Rgb::new(c[0], c[1], c[2])
}

/// The map in the convention of the geometry: points are columns to the right of the matrix, not
/// rows to its left.
pub(crate) fn affine(matrix: &Matrix, at: Place) -> Result<Affine> {
    let [x, y, z, t] = matrix.rows;
    let rows = std::array::from_fn(|i| [x[i], y[i], z[i]]);
    Affine::new(rows, point(t))
        .map_err(|why| Error::invalid(at, format!("the transform of this object cannot be inverted: {why}")))
}

pub(crate) fn placement(matrix: &Matrix, at: Place) -> Result<scene::Placement> {
    if matrix.is_identity() {
        return Ok(scene::Placement::IDENTITY);
    }
    affine(matrix, at).map(scene::Placement::new)
}

/// The lights of an object.
pub(crate) type Lights = Vec<PlacedLight>;

/// A light with its placement by the unions around it, and the number of its light group.
pub(crate) type PlacedLight = (Rc<Light>, Matrix, Option<u32>);

/// Transforms lights by a union's transformation.
pub(crate) fn move_lights(lights: &mut [PlacedLight], by: &Matrix) {
    for (_, moved, _) in lights {
        *moved = moved.then(by);
    }
}

impl Parser<'_> {
    /// Adds a finished object at the top level of the scene.
    pub(crate) fn emit(&mut self, object: &Rc<Object>) -> Result<()> {
        let at = object.at;
        // Nested declarations can stand for more objects than there is memory for.
        self.check_memory((object.leaves as usize).saturating_mul(size_of::<scene::Object>()), at)?;
        self.count_steps(object.leaves, at)?;
        let mut lights = Lights::new();
        let default = self.default_look(at)?;
        let shown = self.emitted(object, &mut lights)?;
        if let Some(mut shown) = shown {
            dress(&mut shown, &default);
            self.scene.objects.push(shown);
        }
        for light in lights {
            self.emit_light(&light, &default)?;
        }
        Ok(())
    }

    /// The current default texture, converted once for each change.
    fn default_look(&mut self, at: Place) -> Result<Arc<scene::Texture>> {
        if let Some((layer, made)) = &self.scene.default
            && Rc::ptr_eq(layer, &self.defaults)
        {
            return Ok(made.clone());
        }
        let made = Arc::new(texture(&Texture::single((*self.defaults).clone()), at)?);
        self.scene.default = Some((self.defaults.clone(), made.clone()));
        Ok(made)
    }

    fn emit_light(
        &mut self,
        (light, moved, group): &PlacedLight,
        default: &Arc<scene::Texture>,
    ) -> Result<()> {
        let kind = match light.beam {
            Beam::Point | Beam::Shadowless => scene::LightKind::Point,
            Beam::Spot => scene::LightKind::Spot {
                radius: light.radius.to_radians(),
                falloff: light.falloff.to_radians(),
                tightness: light.tightness,
            },
            Beam::Cylinder => scene::LightKind::Cylinder {
                radius: light.radius,
                falloff: light.falloff,
                tightness: light.tightness,
            },
        };
        let through = match &light.through {
            Some(object) => {
                let mut object = (**object).clone();
                object.transform(moved);
                self.emitted(&object, &mut Lights::new())?.map(Arc::new)
            }
            None => None,
        };
        let fades = light.fade_distance != 0.0 && light.fade_power > 0.0;
        limits::charge_for_good(size_of::<scene::Light>());
        self.scene.lights.push(scene::Light {
            location: point(moved.point(light.location)),
            colour: rgb(light.color),
            kind,
            point_at: point(moved.point(light.point_at)),
            parallel: light.parallel,
            shadowless: light.beam == Beam::Shadowless,
            area: light.area.filter(|area| area.points.iter().all(|n| *n > 0)).map(|area| scene::AreaLight {
                sides: area.sides.map(|side| vector(moved.direction(side))),
                points: area.points,
                circular: area.circular,
                orient: area.orient,
                adaptive: area.adaptive,
                illuminates: area.illuminates,
            }),
            through,
            group: *group,
            fade: fades.then_some(scene::Fade { distance: light.fade_distance, power: light.fade_power }),
        });
        let Some(shown) = &light.looks_like else { return Ok(()) };
        let mut shown = (**shown).clone();
        shown.transform(moved);
        let mut lights = Vec::new();
        if let Some(mut shown) = self.emitted(&shown, &mut lights)? {
            // It must not shadow its own light. The price is that it shadows no other light either.
            shown.flags.no_shadow = true;
            dress(&mut shown, default);
            self.scene.objects.push(shown);
        }
        Ok(())
    }

    /// Converts an object to scene data; its lights are added to `lights`. `None` if no surface is
    /// left.
    pub(crate) fn emitted(&mut self, object: &Object, lights: &mut Lights) -> Result<Option<scene::Object>> {
        let Some(global_lights) = object.habits.light_group else {
            return self.emitted_in_group(object, lights);
        };
        let around = self.scene.group;
        // The outermost group decides on global lights (a fact of the scene language).
        let outer = around.and_then(|group| self.scene.groups.get(group as usize));
        let global_lights = outer.map_or(global_lights, |outer| outer.global_lights);
        limits::charge_for_good(size_of::<scene::LightGroup>());
        let number = self.scene.groups.len() as u32;
        self.scene.groups.push(scene::LightGroup { global_lights });
        self.scene.group = Some(number);
        let made = self.emitted_in_group(object, lights);
        self.scene.group = around;
        Ok(made?.map(|mut made| {
            made.flags.light_group = Some(number);
            made
        }))
    }

    /// [`Self::emitted`], for scene data that is soon dropped: what it charges is released.
    pub(crate) fn emitted_for_a_question(&mut self, object: &Object) -> Result<Option<scene::Object>> {
        let shared = self.scene.shared.len();
        let made = limits::giving_back(|| self.emitted(object, &mut Lights::new()));
        self.scene.shared.truncate(shared);
        made
    }

    /// [`Self::emitted`], within the light group that is open.
    fn emitted_in_group(&mut self, object: &Object, lights: &mut Lights) -> Result<Option<scene::Object>> {
        if object.lacks_volume {
            return Ok(self.without_volume(object, lights)?.surfaces());
        }
        let shape = match &object.shape {
            Shape::Light(light) => {
                lights.push((light.clone(), object.place, self.scene.group));
                return Ok(None);
            }
            Shape::Union(parts) => {
                let first = lights.len();
                let mut shown = Vec::with_capacity(parts.len());
                for part in parts {
                    shown.extend(self.emitted(part, lights)?);
                }
                move_lights(&mut lights[first..], &object.place);
                if shown.is_empty() {
                    return Ok(None);
                }
                scene::Shape::Union(shown)
            }
            Shape::Csg(operation, parts) => {
                let first = lights.len();
                let mut shown = Vec::with_capacity(parts.len());
                for part in parts {
                    shown.extend(self.emitted(part, lights)?);
                }
                move_lights(&mut lights[first..], &object.place);
                scene::Shape::Csg(*operation, shown)
            }
            Shape::Deform(solid, warps) => {
                let clips = self.clips(object)?;
                return self.emitted_deformed(object, solid, warps, clips).map(Some);
            }
            _ => self.surface(object)?,
        };
        let clips = self.clips(object)?;
        self.finished_object(object, shape, clips).map(Some)
    }

    /// Converts the shape of an object that is a single surface. The scene shares its lists, but has
    /// copies of meshes and of blobs with textures: lowering instances meshes that objects share,
    /// and the hits of an instance may have other last bits.
    pub(crate) fn surface(&mut self, object: &Object) -> Result<scene::Shape> {
        let (leaf, textures) = match &object.shape {
            Shape::Leaf(leaf) => (leaf, &[][..]),
            Shape::Textured(leaf, textures) => (leaf, &textures[..]),
            _ => return Err(Error::invalid(object.at, "a single surface is needed here")),
        };
        let textures = converted_textures(textures, object.at)?;
        let copied = match leaf {
            scene::Shape::Mesh(mesh) => {
                let textures = textures.into_iter().flatten().collect();
                scene::Shape::Mesh(Arc::new(scene::Mesh { textures, ..(**mesh).clone() }))
            }
            scene::Shape::Blob(blob) if !textures.is_empty() => {
                scene::Shape::Blob(Arc::new(scene::Blob { textures, ..(**blob).clone() }))
            }
            _ => {
                self.scene.shared.extend(object.shared.clone());
                return Ok(leaf.clone());
            }
        };
        limits::charge_for_good(object.shape.shared_bytes());
        Ok(copied)
    }

    /// Converts the objects that clip an object.
    fn clips(&mut self, object: &Object) -> Result<Vec<scene::Object>> {
        let mut clips = Vec::with_capacity(object.clips.len());
        for clip in &object.clips {
            clips.extend(self.emitted(clip, &mut Lights::new())?);
        }
        Ok(clips)
    }

    /// Adds everything else of an object to its shape.
    pub(crate) fn finished_object(
        &mut self,
        object: &Object,
        shape: scene::Shape,
        clips: Vec<scene::Object>,
    ) -> Result<scene::Object> {
        let at = object.at;
        let mut made = scene::Object::new(shape);
        made.placement = placement(&object.place, at)?;
        let moved = if object.place.is_identity() { 0 } else { size_of::<Affine>() };
        // The reader's own copy of a union's part is dropped before the next statement.
        limits::charge_for_good(size_of::<scene::Object>() + moved);
        self.check_memory(0, at)?;
        made.texture = match &object.texture {
            Some(texture) => Some(self.shared_texture(texture, at)?),
            None => None,
        };
        made.interior_texture = match &object.interior_texture {
            Some(texture) => Some(self.shared_texture(texture, at)?),
            None => None,
        };
        if object.cutaway_textures {
            made.cutaway_textures = Some(self.default_look(at)?);
        }
        made.interior = inside(object).map(Arc::new);
        made.clips = clips;
        made.flags = flags(object);
        made.place = Some(scene::Place { file: at.file, start: at.start });
        Ok(made)
    }

    /// Converts a deformed solid; a deformed union becomes a union of deformed parts.
    pub(crate) fn emitted_deformed(
        &mut self,
        object: &Object,
        solid: &Object,
        warps: &[scene::Warp],
        clips: Vec<scene::Object>,
    ) -> Result<scene::Object> {
        let at = object.at;
        let Some(solid) = self.emitted(solid, &mut Vec::new())? else {
            return Err(Error::invalid(at, "there is no solid here to deform"));
        };
        let singular =
            |why| Error::invalid(at, format!("the transform of this object cannot be inverted: {why}"));
        let mut made = scene::Object::deformed(solid, warps).map_err(singular)?;
        let own = placement(&object.place, at)?;
        made.transform(own.affine()).map_err(singular)?;
        limits::charge_for_good(size_of::<scene::Object>() + size_of_val(warps));
        self.check_memory(0, at)?;
        if let Some(texture) = &object.texture {
            let texture = self.shared_texture(texture, at)?;
            made.texture.get_or_insert(texture);
        }
        if let Some(texture) = &object.interior_texture {
            let texture = self.shared_texture(texture, at)?;
            made.interior_texture.get_or_insert(texture);
        }
        if let Some(interior) = inside(object) {
            made.interior.get_or_insert_with(|| Arc::new(interior));
        }
        made.clips.extend(clips);
        made.flags = made.flags.or(flags(object));
        made.place = Some(scene::Place { file: at.file, start: at.start });
        Ok(made)
    }

    fn shared_texture(&mut self, own: &Rc<Texture>, at: Place) -> Result<Arc<scene::Texture>> {
        let equal = |(known, _): &&(Rc<Texture>, Arc<scene::Texture>)| Rc::ptr_eq(known, own) || known == own;
        if let Some((_, made)) = self.scene.textures.iter().find(equal) {
            return Ok(made.clone());
        }
        limits::charge_for_good(
            own.size() * (size_of::<scene::Layer>() + size_of::<scene::Finish>() + TEXTURE_EXTRA),
        );
        let made = texture_of_object(own, at)?;
        if self.scene.textures.len() == TEXTURES_COMPARED {
            self.scene.textures.pop_front();
        }
        self.scene.textures.push_back((own.clone(), made.clone()));
        Ok(made)
    }

    /// The whole scene.
    pub(crate) fn finished(&mut self) -> Result<scene::Scene> {
        let output = std::mem::take(&mut self.scene);
        let version = self.language.shading_version();
        let gamma = match self.language.gamma {
            Some(Gamma::Power(power)) => scene::AssumedGamma::Power(power),
            Some(Gamma::Srgb) => scene::AssumedGamma::Srgb,
            None if version < 3.7 => scene::AssumedGamma::None,
            None => scene::AssumedGamma::Power(1.0),
        };
        let globals = output.globals;
        let sky = output.sky.map(|(sky, at)| sky_sphere(&sky, at)).transpose()?;
        Ok(scene::Scene {
            objects: output.objects,
            lights: output.lights,
            camera: output.camera.map(|camera| camera.scene()).transpose()?,
            background: output.background.map_or_else(scene::Background::default, |color| {
                scene::Background(scene::Colour::from_terms(color))
            }),
            sky,
            fogs: output.fogs,
            rainbows: output.rainbows,
            light_groups: output.groups,
            noise: self.options.noise.clone(),
            settings: scene::Settings {
                assumed_gamma: gamma,
                version,
                max_trace_level: globals.max_trace_level,
                adc_bailout: globals.adc_bailout,
                ambient_light: rgb(globals.ambient_light),
                number_of_waves: globals.number_of_waves,
                noise_generator: self.language.noise_generator(),
            },
        })
    }
}

/// Whether a part of it borrows textures of other parts.
fn borrows(object: &scene::Object) -> bool {
    let within = || match &object.shape {
        scene::Shape::Union(parts) | scene::Shape::Csg(_, parts) => parts.iter().any(borrows),
        _ => false,
    };
    object.texture.is_none() && (object.cutaway_textures.is_some() || within())
}

/// Gives the default texture to everything that has none and borrows none.
fn dress(object: &mut scene::Object, default: &Arc<scene::Texture>) {
    if !borrows(object) {
        object.texture.get_or_insert_with(|| default.clone());
    } else if let scene::Shape::Union(parts) = &mut object.shape {
        parts.iter_mut().for_each(|part| dress(part, default));
    }
}

fn flags(object: &Object) -> scene::Flags {
    let habits = object.habits;
    scene::Flags {
        no_shadow: habits.no_shadow,
        no_image: habits.no_image,
        no_reflection: habits.no_reflection,
        hollow: habits.hollow,
        inverse: habits.inverse,
        open: habits.open,
        double_illuminate: habits.double_illuminate,
        light_group: None,
    }
}

/// The factor from the language's number for caustics to the exponent of the cosine.
const CAUSTICS: f64 = 45.0;

/// The interior of an object, with the settings that the finish of its texture has in old scenes.
fn inside(object: &Object) -> Option<scene::Interior> {
    let own = object.interior.as_deref().map(filling);
    let Some(Texture::Layers(layers)) = object.texture.as_deref() else { return own };
    let ior = layers.iter().find_map(|layer| layer.finish.ior);
    let caustics = layers.iter().find_map(|layer| layer.finish.caustics);
    // That of the outermost layer counts, and it counts without an index of refraction, too.
    let refraction = layers.last().map_or(1.0, |layer| layer.finish.refraction);
    if ior.is_none() && caustics.is_none() && refraction == 1.0 {
        return own;
    }
    let mut made = own.unwrap_or_else(|| filling(&Interior::default()));
    made.ior = ior.unwrap_or(made.ior);
    made.caustics = caustics.unwrap_or(made.caustics);
    made.refraction = refraction;
    Some(made)
}

fn filling(interior: &Interior) -> scene::Interior {
    scene::Interior {
        ior: interior.ior,
        refraction: 1.0,
        fade_distance: interior.fade_distance,
        fade_power: interior.fade_power,
        fade_color: rgb(interior.fade_color),
        caustics: interior.caustics * CAUSTICS,
    }
}

/// Converts the textures of a mesh or a blob. Neighbours often share textures.
fn converted_textures(all: &[Option<Rc<Texture>>], at: Place) -> Result<Vec<Option<Arc<scene::Texture>>>> {
    let mut made: Vec<Option<Arc<scene::Texture>>> = Vec::with_capacity(all.len());
    let mut last: Option<(&Rc<Texture>, Arc<scene::Texture>)> = None;
    for own in all {
        let Some(own) = own else {
            made.push(None);
            continue;
        };
        let known = last.take().filter(|(known, _)| *known == own);
        let one = match known {
            Some((_, one)) => one,
            None => texture_of_object(own, at)?,
        };
        made.push(Some(Arc::clone(&one)));
        last = Some((own, one));
    }
    Ok(made)
}

/// Converts a texture. An error in a part that comes from another file also names the object.
fn texture_of_object(own: &Texture, at: Place) -> Result<Arc<scene::Texture>> {
    texture(own, at).map(Arc::new).map_err(|fault| fault.of_object(at))
}

fn sky_sphere(own: &SkySphere, at: Place) -> Result<scene::SkySphere> {
    let pigments = own.pigments.iter().map(|own| pigment(own, at)).collect::<Result<_>>()?;
    Ok(scene::SkySphere { pigments, emission: rgb(own.emission) })
}

/// Converts a finish. Negative amounts of scattering or highlights have no effect (a fact of the
/// language).
pub(crate) fn finish(own: &Finish) -> scene::Finish {
    let mirror = own.reflection;
    let mirrors = mirror.min.iter().chain(&mirror.max).any(|part| *part != 0.0);
    scene::Finish {
        ambient: rgb(own.ambient),
        emission: rgb(own.emission),
        diffuse: own.diffuse.max(0.0),
        diffuse_back: own.diffuse_back.max(0.0),
        brilliance: own.brilliance,
        phong: own.phong.max(0.0),
        phong_size: own.phong_size,
        specular: own.specular.max(0.0),
        roughness: own.roughness,
        metallic: own.metallic.max(0.0),
        crand: own.crand,
        reflection: mirrors.then(|| {
            Box::new(scene::Reflection {
                min: rgb(mirror.min),
                max: rgb(mirror.max),
                falloff: mirror.falloff,
                fresnel: mirror.fresnel,
                exponent: mirror.exponent,
                metallic: mirror.metallic,
            })
        }),
        irid: own.irid.map(|film| {
            let Film { amount, thickness, turbulence } = film;
            let wavelength = scene::Rgb::new(0.70, 0.52, 0.48);
            scene::Irid { amount, thickness, wavelength, turbulence, generator: None }
        }),
        conserve_energy: own.conserve_energy,
    }
}
