//! `ifs { LEAF map { TRANSFORM ... } map { ... } ... depth N }`, `ifs { menger N }` and
//! `ifs { sierpinski N }`, durer's own.

use durer_scene::{self as scene, Ifs, IfsError, IfsLeaf, MOST_LEVELS};

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::scene_builder::{affine, point};

/// About what a map takes.
const BYTES_A_MAP: usize = 512;

impl Parser<'_> {
    /// The items of an iterated function system, after its opening brace.
    pub(super) fn ifs(&mut self, place: Place) -> Result<Shape> {
        self.peek()?;
        let at = self.here();
        let made = if self.small_word("menger")? {
            Ifs::menger(self.levels()?)
        } else if self.small_word("sierpinski")? {
            Ifs::sierpinski(self.levels()?)
        } else {
            return self.ifs_of_maps(place);
        };
        Ok(scene::Shape::Ifs(made.map_err(|why| Error::invalid(at, why.to_string()))?).into())
    }

    fn ifs_of_maps(&mut self, place: Place) -> Result<Shape> {
        self.peek()?;
        let leaf_at = self.here();
        let leaf = self.ifs_leaf()?;
        let (mut maps, mut places, mut depth) = (vec![], vec![], None);
        loop {
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            if self.small_word("map")? {
                let matrix = self.nested(Self::transform_block)?;
                self.check_memory(maps.len() * BYTES_A_MAP, at)?;
                maps.push(affine(&matrix, at)?);
                places.push(at);
            } else if self.small_word("depth")? {
                depth = Some(self.levels()?);
            } else {
                break;
            }
        }
        if maps.is_empty() {
            return Err(Error::invalid(place, "this ifs has no map: say at least one `map { TRANSFORM }`"));
        }
        let Some(depth) = depth else {
            let text =
                format!("say how many maps of this ifs are multiplied: `depth 0` to `depth {MOST_LEVELS}`");
            return Err(Error::invalid(place, text));
        };
        let system = Ifs::new(leaf, &maps, depth).map_err(|why| {
            let at = match why {
                IfsError::Expands { map, .. } => places.get(map - 1).copied().unwrap_or(place),
                IfsError::Box(_) | IfsError::Sphere(_) | IfsError::Tetrahedron => leaf_at,
                _ => place,
            };
            Error::invalid(at, why.to_string())
        })?;
        Ok(scene::Shape::Ifs(system).into())
    }

    /// `box { A, B }`, `sphere { C, R }` or `tetrahedron { P, Q, R, S }`.
    fn ifs_leaf(&mut self) -> Result<IfsLeaf> {
        let leaf = if self.take_word(Keyword::Box)? {
            self.expect(Mark::BraceOpen)?;
            IfsLeaf::Box(point(self.corner()?), point(self.corner()?))
        } else if self.take_word(Keyword::Sphere)? {
            self.expect(Mark::BraceOpen)?;
            IfsLeaf::Sphere(point(self.corner()?), self.size()?)
        } else if self.small_word("tetrahedron")? {
            self.expect(Mark::BraceOpen)?;
            let mut corners = [[0.0; 3]; 4];
            for corner in &mut corners {
                *corner = self.corner()?;
            }
            IfsLeaf::Tetrahedron(corners.map(point))
        } else {
            let lexeme = self.next()?;
            let wanted = "a leaf (box, sphere or tetrahedron), `menger N` or `sierpinski N`";
            return Err(self.unexpected(&lexeme, wanted));
        };
        self.skip_comma()?;
        self.expect(Mark::BraceClose)?;
        Ok(leaf)
    }

    /// A depth.
    fn levels(&mut self) -> Result<u32> {
        self.need("an ifs needs a depth here")?;
        let at = self.here();
        let depth = self.float()?;
        if depth.fract() != 0.0 || !(0.0..=f64::from(MOST_LEVELS)).contains(&depth) {
            let text = format!("the depth of an ifs is a whole number from 0 to {MOST_LEVELS}, not {depth}");
            return Err(Error::invalid(at, text));
        }
        self.skip_comma()?;
        Ok(depth as u32)
    }
}
