//! `warp { }`: maps of the point at which a pattern is evaluated.

use durer_math::{Point3, Vec3};
use durer_scene::{Around, BlackHole, PointWarp, Wrap};

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::noise_pattern::Turbulence;
use crate::parser::{Item, Parser};

fn vec3(v: [f64; 3]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

impl Parser<'_> {
    /// Reads `warp { ... }` of a pattern; the word comes next.
    pub(super) fn pattern_warp(&mut self) -> Result<PointWarp> {
        self.next()?;
        self.expect(Mark::BraceOpen)?;
        let warp = self.warp_items()?;
        self.expect(Mark::BraceClose)?;
        Ok(warp)
    }

    /// Reads what stands in the braces of a `warp`.
    fn warp_items(&mut self) -> Result<PointWarp> {
        let lexeme = self.next()?;
        match lexeme.item {
            Item::Word(Keyword::Repeat) => self.repeat_warp(),
            Item::Word(Keyword::BlackHole) => self.black_hole_warp(),
            Item::Word(Keyword::Turbulence) => self.turbulence_warp(),
            Item::Word(Keyword::Cylindrical) => self.wrap(Around::Cylinder),
            Item::Word(Keyword::Spherical) => self.wrap(Around::Sphere),
            Item::Word(Keyword::Toroidal) => self.wrap(Around::Torus(1.0)),
            Item::Word(Keyword::Planar) => self.planar_warp(),
            Item::Word(Keyword::Cubic) => Ok(PointWarp::Cubic),
            _ => Err(self.unexpected(&lexeme, "the kind of a warp")),
        }
    }

    fn repeat_warp(&mut self) -> Result<PointWarp> {
        let place = self.here();
        let along = self.vector()?;
        let axes: Vec<usize> = (0..3).filter(|&axis| along[axis] != 0.0).collect();
        let &[axis] = &axes[..] else {
            return Err(Error::invalid(place, "a repeat warp needs a direction along one axis"));
        };
        let (mut offset, mut flip) = (Vec3::ZERO, [false; 3]);
        loop {
            if self.take_word(Keyword::Offset)? {
                offset = vec3(self.vector()?);
            } else if self.take_word(Keyword::Flip)? {
                flip = self.vector()?.map(|part| part != 0.0);
            } else {
                return Ok(PointWarp::Repeat { axis, width: along[axis], offset, flip });
            }
        }
    }

    fn black_hole_warp(&mut self) -> Result<PointWarp> {
        let [x, y, z] = self.vector()?;
        self.skip_comma()?;
        let radius = self.float()?;
        let mut hole = BlackHole {
            centre: Point3::new(x, y, z),
            radius,
            strength: 1.0,
            falloff: 2.0,
            inverse: false,
            repeat: Vec3::ZERO,
            scatter: Vec3::ZERO,
        };
        loop {
            match self.peek_word()? {
                Some(Keyword::Strength) => {
                    self.next()?;
                    hole.strength = self.float()?;
                }
                Some(Keyword::Falloff) => {
                    self.next()?;
                    hole.falloff = self.float()?;
                }
                Some(Keyword::Inverse) => {
                    self.next()?;
                    hole.inverse = true;
                }
                Some(Keyword::Type) => {
                    self.next()?;
                    self.float()?;
                }
                Some(Keyword::Repeat) => {
                    self.next()?;
                    hole.repeat = vec3(self.vector()?);
                }
                Some(Keyword::Turbulence) => {
                    self.next()?;
                    hole.scatter = vec3(self.vector()?);
                }
                _ => return Ok(PointWarp::BlackHole(hole)),
            }
        }
    }

    fn turbulence_warp(&mut self) -> Result<PointWarp> {
        let mut turbulence = Turbulence { amount: self.vector()?, ..Turbulence::default() };
        loop {
            let part = match self.peek_word()? {
                Some(Keyword::Octaves) => &mut turbulence.octaves,
                Some(Keyword::Omega) => &mut turbulence.omega,
                Some(Keyword::Lambda) => &mut turbulence.lambda,
                _ => return Ok(PointWarp::Turbulence(turbulence.scene())),
            };
            self.next()?;
            *part = self.float()?;
        }
    }

    fn wrap(&mut self, mut around: Around) -> Result<PointWarp> {
        let (mut orientation, mut growth) = (Vec3::Z, 0.0);
        loop {
            let place = {
                self.peek()?;
                self.here()
            };
            if self.take_word(Keyword::Orientation)? {
                orientation = vec3(self.vector()?);
                if orientation == Vec3::ZERO {
                    return Err(Error::invalid(place, "the orientation of a warp cannot be zero"));
                }
            } else if self.take_word(Keyword::DistExp)? {
                growth = self.float()?;
            } else if self.take_word(Keyword::MajorRadius)? {
                let radius = self.float()?;
                match &mut around {
                    Around::Torus(major) => *major = radius,
                    _ => return Err(Error::invalid(place, "major_radius belongs to toroidal")),
                }
            } else {
                return Ok(PointWarp::Wrapped(Wrap { around, orientation, growth }));
            }
        }
    }

    fn planar_warp(&mut self) -> Result<PointWarp> {
        if !self.starts_number()? {
            return Ok(PointWarp::Planar { normal: Vec3::Z, distance: 0.0 });
        }
        let place = self.here();
        let normal = vec3(self.vector()?);
        if normal == Vec3::ZERO {
            return Err(Error::invalid(place, "the normal of a planar warp cannot be zero"));
        }
        self.skip_comma()?;
        Ok(PointWarp::Planar { normal, distance: self.float()? })
    }
}
