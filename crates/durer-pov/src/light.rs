//! Lights: point lights, spotlights, cylindrical lights.

use std::rc::Rc;

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::object::{Object, Shape};
use crate::parser::{Item, Parser};
use crate::transform::{Matrix, length};
use crate::value::Value;

/// The form of a light. The last statement counts, `shadowless` included: a spotlight that is made
/// shadowless afterwards shines in all directions, and a shadowless light that becomes a spotlight
/// throws shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Beam {
    #[default]
    Point,
    Spot,
    Cylinder,
    Shadowless,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Light {
    pub(crate) location: [f64; 3],
    pub(crate) color: [f64; 3],
    pub(crate) beam: Beam,
    pub(crate) point_at: [f64; 3],
    /// Spotlight: the half angle in degrees of the bright cone. Cylinder: the bright radius.
    pub(crate) radius: f64,
    /// Spotlight: the half angle in degrees where the light ends. Cylinder: the radius where it
    /// ends.
    pub(crate) falloff: f64,
    pub(crate) tightness: f64,
    pub(crate) parallel: bool,
    /// The fade distance; 0 if the light does not fade.
    pub(crate) fade_distance: f64,
    pub(crate) fade_power: f64,
    /// Its extent, for soft shadows.
    pub(crate) area: Option<Area>,
    /// The object that is shown in its place; it does not shadow this light.
    pub(crate) looks_like: Option<Rc<Object>>,
    /// The object through which it shines.
    pub(crate) through: Option<Rc<Object>>,
}

impl Light {
    fn new(location: [f64; 3], color: [f64; 3]) -> Self {
        Self {
            location,
            color,
            beam: Beam::Point,
            point_at: [0.0, 0.0, 1.0],
            radius: 0.0,
            falloff: 0.0,
            tightness: 0.0,
            parallel: false,
            fade_distance: 0.0,
            fade_power: 0.0,
            area: None,
            looks_like: None,
            through: None,
        }
    }

    /// Transforms the light and the point it is aimed at.
    pub(crate) fn transform(&mut self, by: &Matrix) {
        self.location = by.point(self.location);
        self.point_at = by.point(self.point_at);
        if let Some(area) = &mut self.area {
            area.sides = area.sides.map(|side| by.direction(side));
        }
        for object in self.looks_like.iter_mut().chain(&mut self.through) {
            Rc::make_mut(object).transform(by);
        }
    }
}

/// The greatest number of points along a side of an area light.
const MOST_POINTS: f64 = 1024.0;

/// The extent of an area light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Area {
    pub(crate) sides: [[f64; 3]; 2],
    pub(crate) points: [u32; 2],
    pub(crate) circular: bool,
    pub(crate) orient: bool,
    pub(crate) adaptive: Option<u32>,
    /// Whether each of the points lights surfaces, and not the location alone.
    pub(crate) illuminates: bool,
}

impl Parser<'_> {
    /// Reads what stands in braces after `light_source`, as an object without a surface.
    pub(crate) fn light_block(&mut self) -> Result<Object> {
        let begin = self.here();
        self.expect(Mark::BraceOpen)?;
        let mut light = match self.peek()? {
            Item::Value(Value::Object(known)) => {
                let known = known.clone();
                let lexeme = self.next()?;
                let Shape::Light(light) = &known.shape else {
                    return Err(self.unexpected(&lexeme, "a light"));
                };
                let mut light = (**light).clone();
                light.transform(&known.place);
                light
            }
            _ => {
                let location = self.vector()?;
                self.skip_comma()?;
                let [r, g, b, ..] = self.colour()?;
                Light::new(location, [r, g, b])
            }
        };
        self.light_items(&mut light)?;
        if (matches!(light.beam, Beam::Spot | Beam::Cylinder) || light.parallel)
            && length(std::array::from_fn(|i| light.point_at[i] - light.location[i])) == 0.0
        {
            self.notice(begin, "this light points at its own location: it does not shine");
        }
        Ok(Object::new(Shape::Light(Rc::new(light)), begin))
    }

    fn light_items(&mut self, light: &mut Light) -> Result<()> {
        loop {
            self.skip_comma()?;
            if let Some(by) = self.transform_item()? {
                light.transform(&by);
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(()),
                Item::Word(Keyword::Spotlight) => {
                    (light.beam, light.radius, light.falloff) = (Beam::Spot, 30.0, 45.0);
                }
                Item::Word(Keyword::Cylinder) => {
                    (light.beam, light.radius, light.falloff) = (Beam::Cylinder, 0.75, 1.0);
                    light.parallel = true;
                }
                Item::Word(Keyword::Parallel) => light.parallel = true,
                Item::Word(Keyword::Shadowless) => light.beam = Beam::Shadowless,
                Item::Word(Keyword::PointAt) => light.point_at = self.vector()?,
                Item::Word(Keyword::Radius) => light.radius = self.float()?,
                Item::Word(Keyword::Falloff) => light.falloff = self.float()?,
                Item::Word(Keyword::Tightness) => light.tightness = self.float()?,
                Item::Word(Keyword::FadeDistance) => light.fade_distance = self.float()?,
                Item::Word(Keyword::FadePower) => light.fade_power = self.float()?,
                // There are no media yet with which the light could interact.
                Item::Word(Keyword::MediaInteraction | Keyword::MediaAttenuation) => {
                    self.switch_value()?;
                }
                Item::Word(Keyword::AreaLight) => {
                    let first = self.corner()?;
                    let second = self.corner()?;
                    let columns = self.points_of_area()?;
                    self.skip_comma()?;
                    let rows = self.points_of_area()?;
                    let area = light.area.get_or_insert_with(Area::default);
                    (area.sides, area.points) = ([first, second], [columns, rows]);
                }
                Item::Word(Keyword::Adaptive) => {
                    let level = self.float()?;
                    light.area.get_or_insert_with(Area::default).adaptive = Some(level.max(0.0) as u32);
                }
                // Points that are moved at random would make the picture grainy.
                Item::Word(Keyword::Jitter) => {}
                Item::Word(Keyword::Circular) => {
                    light.area.get_or_insert_with(Area::default).circular = true;
                }
                Item::Word(Keyword::Orient) => {
                    light.area.get_or_insert_with(Area::default).orient = true;
                }
                Item::Word(Keyword::AreaIllumination) => {
                    let on = self.switch_value()?;
                    light.area.get_or_insert_with(Area::default).illuminates = on;
                }
                Item::Word(Keyword::ProjectedThrough) => {
                    light.through = Some(self.nested(Self::object_in_braces)?);
                }
                Item::Word(Keyword::Photons) => self.skip_photons()?,
                Item::Word(Keyword::LooksLike) => {
                    let shown = self.nested(Self::object_in_braces)?;
                    let mut shown = (*shown).clone();
                    shown.transform(&Matrix::translation(light.location));
                    light.looks_like = Some(Rc::new(shown));
                }
                _ => return Err(self.unexpected(&lexeme, "a part of a light")),
            }
        }
    }

    /// The number of points along a side of an area light.
    fn points_of_area(&mut self) -> Result<u32> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        if !(1.0..=MOST_POINTS).contains(&count) {
            let text = format!("an area light has 1 to {MOST_POINTS} points along a side, not {count}");
            return Err(Error::invalid(at, text));
        }
        Ok(count as u32)
    }
}
