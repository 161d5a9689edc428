//! Surfaces that POV-Ray's language lacks, by words that are free for its users' own names.
//!
//! `docs/language.md` describes the words. All blocks follow one form: the numbers that make the
//! surface, then settings of the kind `word value`, then the modifiers of any object.

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::interner::Name;
use crate::keywords::Keyword;
use crate::parser::{Item, Parser};
use crate::scene_builder::{point, vector};
use crate::value::Terms;
use durer_scene::{self as scene, FillRule, NamedQuadric, SweepSpline};

/// The words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Word {
    Ellipsoid,
    Spheroid,
    Paraboloid,
    HyperbolicParaboloid,
    Hyperboloid,
    EllipticCone,
    CircularCone,
    EllipticCylinder,
    CircularCylinder,
    HyperbolicCylinder,
    ParabolicCylinder,
    SphericalSector,
    Annulus,
    Parallelogram,
    Lemon,
    Deform,
    Capsule,
    Cyclide,
    Ifs,
    Terrain,
    Sweep,
    Bilinear,
    Patch,
    Nurbs,
    Sewn,
    Subdivision,
}

impl Word {
    fn from_text(text: &str) -> Option<Self> {
        Some(match text {
            "ellipsoid" => Self::Ellipsoid,
            "spheroid" => Self::Spheroid,
            "paraboloid" => Self::Paraboloid,
            "hyperbolic_paraboloid" => Self::HyperbolicParaboloid,
            "hyperboloid" => Self::Hyperboloid,
            "elliptic_cone" => Self::EllipticCone,
            "circular_cone" => Self::CircularCone,
            "elliptic_cylinder" => Self::EllipticCylinder,
            "circular_cylinder" => Self::CircularCylinder,
            "hyperbolic_cylinder" => Self::HyperbolicCylinder,
            "parabolic_cylinder" => Self::ParabolicCylinder,
            "spherical_sector" => Self::SphericalSector,
            "annulus" => Self::Annulus,
            "parallelogram" => Self::Parallelogram,
            "lemon" => Self::Lemon,
            "deform" => Self::Deform,
            "capsule" => Self::Capsule,
            "cyclide" => Self::Cyclide,
            "ifs" => Self::Ifs,
            "terrain" => Self::Terrain,
            "sweep" => Self::Sweep,
            "bilinear" => Self::Bilinear,
            "patch" => Self::Patch,
            "nurbs" => Self::Nurbs,
            "subdivision" => Self::Subdivision,
            "sewn" => Self::Sewn,
            _ => return None,
        })
    }

    /// How many semi-axes its vector has.
    fn semi_axes(self) -> usize {
        match self {
            Self::EllipticCylinder | Self::HyperbolicCylinder | Self::ParabolicCylinder => 2,
            Self::CircularCylinder => 1,
            _ => 3,
        }
    }
}

impl Parser<'_> {
    /// The surface that `name` stands for, if it is one of durer's words.
    pub(crate) fn extension(&self, name: Name) -> Option<Word> {
        Word::from_text(self.names.text(name))
    }

    /// Whether one of durer's own words comes next. A name that the scene has declared is not one.
    pub(crate) fn at_extension(&mut self) -> Result<bool> {
        let Item::Unknown(name) = self.peek()? else { return Ok(false) };
        let name = *name;
        Ok(self.extension(name).is_some())
    }

    /// Takes the small word `text`, if it comes next.
    pub(crate) fn small_word(&mut self, text: &str) -> Result<bool> {
        let Item::Unknown(name) = self.peek()? else { return Ok(false) };
        let name = *name;
        let here = self.names.text(name) == text;
        if here {
            self.next()?;
        }
        Ok(here)
    }

    /// The numbers and settings of `word`, after its opening brace.
    pub(crate) fn extension_shape(&mut self, word: Word, place: Place) -> Result<Shape> {
        use scene::QuadricKind;
        let kind = match word {
            Word::SphericalSector => {
                let centre = point(self.corner()?);
                let radius = self.radius("the sector's radius")?;
                self.skip_comma()?;
                let axis = vector(self.normal("the sector's axis")?);
                self.peek()?;
                let at = self.here();
                let degrees = self.float()?;
                if !(degrees > 0.0 && degrees < 180.0) {
                    return Err(Error::invalid(
                        at,
                        "the half angle of a sector is between 0 and 180 degrees",
                    ));
                }
                let half_angle = degrees.to_radians();
                return Ok(scene::Shape::SphericalSector { centre, radius, axis, half_angle }.into());
            }
            Word::Lemon => return self.lemon(place),
            Word::Deform => return self.deform(place),
            Word::Capsule => return self.capsule(),
            Word::Cyclide => return self.cyclide(),
            Word::Ifs => return self.ifs(place),
            Word::Terrain => return self.terrain(place),
            Word::Sweep => return self.sweep(place),
            Word::Bilinear => return self.bilinear(place),
            Word::Patch => return self.spline_patch(place),
            Word::Nurbs => return self.nurbs(place),
            Word::Subdivision => return self.subdivision(place),
            Word::Sewn => return self.sewn(place),
            Word::Annulus => return self.shape(Keyword::Disc, place),
            Word::Parallelogram => {
                let corner = point(self.corner()?);
                let (u, v) = (self.normal("the first edge")?, self.normal("the second edge")?);
                if crate::transform::cross(u, v) == [0.0; 3] {
                    return Err(Error::invalid(place, "the edges of this parallelogram are parallel"));
                }
                return Ok(scene::Shape::Parallelogram { corner, u: vector(u), v: vector(v) }.into());
            }
            Word::Ellipsoid | Word::Spheroid => QuadricKind::Ellipsoid,
            Word::Paraboloid => QuadricKind::EllipticParaboloid,
            Word::HyperbolicParaboloid => QuadricKind::HyperbolicParaboloid,
            Word::Hyperboloid => QuadricKind::HyperboloidOneSheet,
            Word::EllipticCone | Word::CircularCone => QuadricKind::EllipticCone,
            Word::EllipticCylinder | Word::CircularCylinder => QuadricKind::EllipticCylinder,
            Word::HyperbolicCylinder => QuadricKind::HyperbolicCylinder,
            Word::ParabolicCylinder => QuadricKind::ParabolicCylinder,
        };
        let mut named = NamedQuadric { kind, semi_axes: self.semi_axes(word)?, extent: None };
        let mut sheets = None;
        loop {
            self.skip_comma()?;
            if word == Word::Hyperboloid && self.small_word("sheets")? {
                let at = self.here();
                let given = self.float()?;
                named.kind = match given {
                    1.0 => QuadricKind::HyperboloidOneSheet,
                    2.0 => QuadricKind::HyperboloidTwoSheets,
                    _ => return Err(Error::invalid(at, "a hyperboloid has 1 or 2 sheets")),
                };
                sheets = Some(given);
            } else if self.small_word("from")? {
                named.extent = Some(self.extent()?);
            } else {
                break;
            }
        }
        if word == Word::Hyperboloid && sheets.is_none() {
            return Err(Error::invalid(
                place,
                "say how many sheets this hyperboloid has: `sheets 1` or `sheets 2`",
            ));
        }
        Ok(scene::Shape::Named(Box::new(named)).into())
    }

    /// Two points, and the distance of the surface from the line between them.
    fn capsule(&mut self) -> Result<Shape> {
        let ends = [self.corner()?, self.corner()?];
        let radius = self.radius("the radius of the capsule")?;
        let spheres = ends.map(|[x, y, z]| [x, y, z, radius]);
        Ok(scene::Shape::SphereSweep(SweepSpline::Linear, spheres.into()).into())
    }

    /// The semi-axis and the focal distance of a cyclide's ellipse, and the mean radius of its
    /// spheres.
    fn cyclide(&mut self) -> Result<Shape> {
        let a = self.radius("the semi-axis of the cyclide's ellipse")?;
        self.skip_comma()?;
        self.peek()?;
        let at = self.here();
        let c = self.float()?;
        if !(0.0..a).contains(&c) {
            let text = format!(
                "the focal distance of a cyclide's ellipse is at least 0 and less than its semi-axis {a}, not {c}"
            );
            return Err(Error::invalid(at, text));
        }
        self.skip_comma()?;
        let d = self.radius("the mean radius of the cyclide's spheres")?;
        Ok(scene::Shape::Cyclide { a, c, d }.into())
    }

    /// The rest of `from a to b`.
    pub(crate) fn extent(&mut self) -> Result<[f64; 2]> {
        let at = self.here();
        let from = self.float()?;
        if !self.small_word("to")? {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "`to`"));
        }
        let to = self.float()?;
        if from >= to {
            return Err(Error::invalid(at, "`from a to b` needs a below b"));
        }
        Ok([from, to])
    }

    /// `<a, b, c>`; `r, c` for a = b = r; `r` where there is no c.
    fn semi_axes(&mut self, word: Word) -> Result<[f64; 3]> {
        let wanted = word.semi_axes();
        self.peek()?;
        let place = self.here();
        let first = self.expression()?;
        let axes = match first.float() {
            Some(radius) if wanted == 3 => {
                self.skip_comma()?;
                [radius, radius, self.float()?]
            }
            Some(radius) => [radius, radius, 1.0],
            None => self.axes_of(first, wanted, place)?,
        };
        let round = matches!(word, Word::Spheroid | Word::CircularCone | Word::CircularCylinder);
        if round && axes[0] != axes[1] {
            return Err(Error::invalid(place, "the first two semi-axes of a round surface are equal"));
        }
        if axes.iter().any(|v| *v <= 0.0 || !v.is_finite()) {
            return Err(Error::invalid(place, "semi-axes are positive"));
        }
        Ok(axes)
    }

    fn axes_of(&self, terms: Terms, wanted: usize, place: Place) -> Result<[f64; 3]> {
        match *terms.as_slice() {
            [a, b] if wanted == 2 => Ok([a, b, 1.0]),
            [a, b, c] if wanted == 3 => Ok([a, b, c]),
            // x*2 + y*3 has three components, too.
            [a, b, 0.0] if wanted == 2 => Ok([a, b, 1.0]),
            _ => Err(Error::invalid(place, format!("expected {wanted} semi-axes"))),
        }
    }

    /// `fill_rule` of a polygon is written like durer's other settings.
    pub(crate) fn fill_rule(&mut self) -> Result<FillRule> {
        if !self.small_word("fill_rule")? || self.small_word("even_odd")? {
            return Ok(FillRule::EvenOdd);
        }
        if self.small_word("non_zero")? {
            return Ok(FillRule::NonZero);
        }
        self.next()?;
        Err(Error::invalid(self.here(), "a fill rule is even_odd or non_zero"))
    }
}
