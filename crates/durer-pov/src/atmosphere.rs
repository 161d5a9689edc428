//! The surroundings of the objects: the sky and fog.

use std::rc::Rc;

use crate::colour::Colour;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::noise_pattern::Turbulence;
use crate::parser::{Item, Parser};
use crate::texture::Pigment;
use crate::transform::Matrix;
use crate::value::Value;

/// Pigments at an infinite distance in every direction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SkySphere {
    /// The layers, the lowest first.
    pub(crate) pigments: Vec<Pigment>,
    /// The factor of their colours.
    pub(crate) emission: [f64; 3],
}

impl SkySphere {
    fn transform(&mut self, by: &Matrix) {
        self.pigments.iter_mut().for_each(|pigment| pigment.transform(by));
    }
}

/// Fog.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fog {
    pub(crate) colour: Colour,
    /// 0 for no fog.
    pub(crate) distance: f64,
    pub(crate) is_ground: bool,
    pub(crate) offset: f64,
    pub(crate) fade: f64,
    pub(crate) up: [f64; 3],
    pub(crate) turbulence: Turbulence,
    pub(crate) turbulence_depth: f64,
}

impl Default for Fog {
    fn default() -> Self {
        Self {
            colour: [0.0; 5],
            distance: 0.0,
            is_ground: false,
            offset: 0.0,
            fade: 0.0,
            up: [0.0, 1.0, 0.0],
            turbulence: Turbulence::default(),
            turbulence_depth: 0.5,
        }
    }
}

impl Fog {
    /// As data of the scene; `None` if there is nothing to see.
    pub(crate) fn scene(&self) -> Option<durer_scene::Fog> {
        if self.distance == 0.0 {
            return None;
        }
        let [x, y, z] = self.up;
        let length = crate::transform::length(self.up);
        let up = durer_math::Vec3::new(x / length, y / length, z / length);
        Some(durer_scene::Fog {
            colour: durer_scene::Colour::from_terms(self.colour),
            distance: self.distance,
            ground: self.is_ground.then_some(durer_scene::GroundFog {
                up,
                offset: self.offset,
                fade: self.fade,
            }),
            turbulence: (!self.turbulence.is_none()).then(|| self.turbulence.scene()),
            turbulence_depth: self.turbulence_depth,
        })
    }
}

impl Parser<'_> {
    /// Reads what stands in braces after `fog`.
    pub(crate) fn fog_block(&mut self) -> Result<Rc<Fog>> {
        self.expect(Mark::BraceOpen)?;
        let mut fog = Fog::default();
        loop {
            let place = {
                self.peek()?;
                self.here()
            };
            if let Some(by) = self.transform_item()? {
                fog.up = by.direction(fog.up);
                continue;
            }
            if self.starts_colour()? {
                fog.colour = self.colour()?;
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(Rc::new(fog)),
                Item::Value(Value::Fog(known)) => fog = (**known).clone(),
                Item::Word(Keyword::FogType) => match self.float()? {
                    1.0 => fog.is_ground = false,
                    2.0 => fog.is_ground = true,
                    other => {
                        return Err(Error::invalid(place, format!("fog_type is 1 or 2, not {other}")));
                    }
                },
                Item::Word(Keyword::Distance) => fog.distance = self.float()?,
                Item::Word(Keyword::FogOffset) => fog.offset = self.float()?,
                Item::Word(Keyword::FogAlt) => fog.fade = self.float()?,
                Item::Word(Keyword::Up) => {
                    fog.up = self.vector()?;
                    if fog.up == [0.0; 3] {
                        return Err(Error::invalid(place, "the direction up of fog cannot be zero"));
                    }
                }
                Item::Word(Keyword::Turbulence) => fog.turbulence.amount = self.vector()?,
                Item::Word(Keyword::TurbDepth) => fog.turbulence_depth = self.float()?,
                Item::Word(Keyword::Omega) => fog.turbulence.omega = self.float()?,
                Item::Word(Keyword::Lambda) => fog.turbulence.lambda = self.float()?,
                Item::Word(Keyword::Octaves) => fog.turbulence.octaves = self.float()?,
                _ => return Err(self.unexpected(&lexeme, "a part of fog")),
            }
        }
    }

    /// Reads a `fog` statement; the word comes next.
    pub(crate) fn fog_statement(&mut self) -> Result<()> {
        self.next()?;
        let fog = self.nested(Self::fog_block)?;
        crate::limits::charge_for_good(size_of::<durer_scene::Fog>());
        self.scene.fogs.extend(fog.scene());
        Ok(())
    }

    /// Reads what stands in braces after `sky_sphere`.
    pub(crate) fn sky_sphere_block(&mut self) -> Result<Rc<SkySphere>> {
        self.expect(Mark::BraceOpen)?;
        let mut sky = SkySphere { pigments: Vec::new(), emission: [1.0; 3] };
        loop {
            if let Some(by) = self.transform_item()? {
                sky.transform(&by);
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(Rc::new(sky)),
                Item::Value(Value::SkySphere(known)) => sky = (**known).clone(),
                Item::Value(Value::Pigment(known)) => sky.pigments.push((**known).clone()),
                Item::Word(Keyword::Pigment) => {
                    let base = self.defaults.clone();
                    sky.pigments.push(self.nested(|r| r.pigment_block(&base.pigment))?);
                }
                Item::Word(Keyword::Emission) => {
                    let [r, g, b, ..] = self.colour()?;
                    sky.emission = [r, g, b];
                }
                _ => return Err(self.unexpected(&lexeme, "a part of a sky sphere")),
            }
        }
    }

    /// Reads a `sky_sphere` statement; the word comes next. The last one counts.
    pub(crate) fn sky_sphere_statement(&mut self) -> Result<()> {
        self.next()?;
        let place = self.here();
        let sky = self.nested(Self::sky_sphere_block)?;
        if self.scene.sky.replace((sky, place)).is_some() {
            self.notice(place, "the scene has more than one sky_sphere: this one replaces the earlier one");
        }
        Ok(())
    }
}
