//! Rainbows.

use std::rc::Rc;

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::scene_builder::vector;
use crate::texture::ColorMap;
use crate::transform::{cross, dot, length};
use crate::value::Value;

/// A rainbow; angles in degrees.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rainbow {
    direction: [f64; 3],
    up: [f64; 3],
    angle: f64,
    width: f64,
    distance: f64,
    colors: Option<Rc<ColorMap>>,
    arc_angle: f64,
    falloff_angle: f64,
}

impl Default for Rainbow {
    fn default() -> Self {
        Self {
            direction: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            angle: 0.0,
            width: 0.0,
            distance: 1e7,
            colors: None,
            arc_angle: 360.0,
            falloff_angle: 360.0,
        }
    }
}

impl Rainbow {
    /// As data of the scene; `None` if there is nothing to see.
    fn scene(&self) -> Option<durer_scene::Rainbow> {
        let colors = self.colors.as_ref()?;
        if self.distance <= 0.0 || self.width <= 0.0 || length(self.direction) == 0.0 {
            return None;
        }
        let axis = self.direction.map(|x| x / length(self.direction));
        let along = dot(self.up, axis);
        let across: [f64; 3] = std::array::from_fn(|i| self.up[i] - along * axis[i]);
        // An arc that points along the axis has no middle; it is as good as any.
        let across = if length(across) > 0.0 { across } else { cross(axis, [axis[1], axis[2], axis[0]]) };
        let half_arc = (0.5 * self.arc_angle).to_radians();
        Some(durer_scene::Rainbow {
            axis: vector(axis),
            up: vector(across.map(|x| x / length(across))),
            angle: self.angle.to_radians(),
            width: self.width.to_radians(),
            distance: self.distance,
            colours: colors
                .entries
                .iter()
                .map(|(at, c)| (*at, durer_scene::Colour::from_terms(*c)))
                .collect(),
            half_arc,
            half_full: (0.5 * self.falloff_angle).to_radians().min(half_arc),
        })
    }
}

impl Parser<'_> {
    /// Reads what stands in braces after `rainbow`.
    pub(crate) fn rainbow_block(&mut self) -> Result<Rc<Rainbow>> {
        self.expect(Mark::BraceOpen)?;
        let mut rainbow = Rainbow::default();
        loop {
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => return Ok(Rc::new(rainbow)),
                Item::Value(Value::Rainbow(known)) => rainbow = (**known).clone(),
                Item::Word(Keyword::Direction) => rainbow.direction = self.vector()?,
                Item::Word(Keyword::Up) => rainbow.up = self.vector()?,
                Item::Word(Keyword::Angle) => rainbow.angle = self.float()?,
                Item::Word(Keyword::Width) => rainbow.width = self.float()?,
                Item::Word(Keyword::Distance) => rainbow.distance = self.float()?,
                Item::Word(Keyword::ArcAngle) => rainbow.arc_angle = self.float()?,
                Item::Word(Keyword::FalloffAngle) => rainbow.falloff_angle = self.float()?,
                // Colours that are moved at random would make the picture grainy.
                Item::Word(Keyword::Jitter) => {
                    self.float()?;
                }
                Item::Word(Keyword::ColorMap) => {
                    rainbow.colors = Some(self.nested(Self::color_map_block)?);
                }
                _ => return Err(self.unexpected(&lexeme, "a part of a rainbow")),
            }
        }
    }

    /// Reads `rainbow` as a statement, after its word.
    pub(crate) fn rainbow_statement(&mut self) -> Result<()> {
        self.peek()?;
        let place = self.here();
        let rainbow = self.nested(Self::rainbow_block)?;
        if rainbow.colors.is_none() {
            return Err(Error::invalid(place, "this rainbow has no color_map"));
        }
        let made = rainbow.scene();
        if made.is_none() {
            self.notice(place, "this rainbow is not visible: it lacks a direction, a width or a distance");
        }
        let bytes = made.as_ref().map_or(0, |made| size_of_val(made.colours.as_slice()));
        crate::limits::charge_for_good(size_of::<durer_scene::Rainbow>() + bytes);
        self.scene.rainbows.extend(made);
        Ok(())
    }
}
