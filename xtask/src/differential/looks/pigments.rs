//! Pigments and textures: lists, maps, layers.

use super::Maker;
use crate::differential::tree::{NEEDED, Node};

/// The words of an item and what follows them.
pub(super) type Body = (String, Vec<Node>);

impl Maker {
    /// A pigment with at most `depth` others inside each other.
    pub(super) fn pigment(&mut self, depth: usize) -> Node {
        let (words, said) = self.pigment_body(depth, false);
        block("pigment", "", &words, said)
    }

    /// A pigment that lets light pass in part.
    fn clear_pigment(&mut self) -> Node {
        let (words, said) = self.pigment_body(1, true);
        block("pigment", "", &words, said)
    }

    fn paint(&mut self, is_clear: bool) -> String {
        if is_clear && self.r.chance(65) { self.clear() } else { self.colour() }
    }

    fn pigment_body(&mut self, depth: usize, is_clear: bool) -> Body {
        match self.r.below(20) {
            0..=3 => (self.paint(is_clear), Vec::new()),
            4..=6 => {
                // Waves that blend the pigments of a list are not supported.
                let is_deep = depth > 0 && self.r.chance(50);
                let (words, said) = self.list(|m| {
                    if is_deep {
                        let (words, said) = m.pigment_body(depth - 1, is_clear);
                        block("pigment", "", &words, said)
                    } else {
                        Node::text(m.paint(is_clear))
                    }
                });
                (words, [said, if is_deep { self.places() } else { self.changes() }].concat())
            }
            7 if depth > 0 => {
                let map = self.average("pigment_map {", |m| m.pigment_body(depth - 1, is_clear));
                let place = Node::text(self.place());
                ("average".into(), vec![map, place])
            }
            8 if !self.pigments.is_empty() => {
                let name = self.pigments[self.r.below(self.pigments.len())].clone();
                (name, vec![Node::text(self.place())])
            }
            9..=11 if depth > 0 => {
                let words = self.pattern(depth);
                let map = self.map("pigment_map {", |m| m.pigment_body(depth - 1, is_clear));
                (words, [vec![map], self.changes()].concat())
            }
            _ => {
                let words = self.pattern(depth);
                let name = self.r.choice(&["color_map {", "color_map {", "colour_map {"]);
                let map = self.map(name, |m| (m.paint(is_clear), Vec::new()));
                (words, [vec![map], self.changes()].concat())
            }
        }
    }

    /// A pattern with a list of items: its words and what follows them.
    pub(super) fn list(&mut self, mut item: impl FnMut(&mut Self) -> Node) -> Body {
        let mut item = |m: &mut Self| Node { least: NEEDED, ..item(m) };
        let (words, count) = match self.r.below(7) {
            0 => {
                let mut size = format!("brick_size <{}, 0.6, 0.8>", self.odd(0.6, 1.5));
                size += &format!(" mortar {}", self.r.number(0.03, 0.15));
                return ("brick".into(), vec![item(self), item(self), Node::text(size)]);
            }
            1 if !self.is_at_uv => ("hexagon", 3),
            2 => ("triangular", 6),
            3 => ("square", 4),
            4 => {
                let mut shape = Node::block(format!("object {{ {}", self.shape(true).line()), Vec::new(), 0);
                shape.said = vec![item(self), item(self)];
                return (String::new(), vec![shape]);
            }
            _ => ("checker", 2),
        };
        (words.into(), (0..count).map(|_| item(self)).collect())
    }

    /// A map of two to four entries.
    pub(super) fn map(&mut self, open: &str, mut body: impl FnMut(&mut Self) -> Body) -> Node {
        self.map_of(open, false, &mut body)
    }

    /// An average: a map whose numbers are weights.
    pub(super) fn average(&mut self, open: &str, mut body: impl FnMut(&mut Self) -> Body) -> Node {
        self.map_of(open, true, &mut body)
    }

    fn map_of(&mut self, open: &str, is_average: bool, body: &mut dyn FnMut(&mut Self) -> Body) -> Node {
        let count = 2 + self.r.below(3);
        if is_average {
            let entries = (0..count).map(|_| {
                let (words, said) = body(self);
                Node::entry(format!("[{} {words}", self.r.number(0.3, 2.0)), said)
            });
            return Node::block(open, entries.collect(), 1);
        }
        let mut at: Vec<f64> = (0..count).map(|_| self.r.number(0.0, 1.0)).collect();
        at.sort_by(f64::total_cmp);
        if self.r.chance(60) {
            (at[0], at[count - 1]) = (0.0, 1.0);
        }
        // A step.
        if self.r.chance(20) {
            at[1] = at[0];
        }
        let entries = at.into_iter().map(|at| {
            let (words, said) = body(self);
            Node::entry(format!("[{at} {words}"), said)
        });
        Node::block(open, entries.collect(), 1)
    }

    /// One or more textures, and the interior of what is clear. `has_uv` says that the shape has
    /// coordinates of its own.
    pub(super) fn look(&mut self, has_uv: bool) -> Vec<Node> {
        match self.r.below(20) {
            0..=5 => {
                let uv = self.uv(has_uv);
                let depth = 1 + usize::from(self.r.chance(30));
                let (words, said) = self.at_uv(!uv.is_empty(), |m| m.pigment_body(depth, false));
                let mut all = vec![block("pigment", uv, &words, said)];
                if self.r.chance(50) {
                    all.push(self.normal(1));
                }
                if self.r.chance(60) {
                    all.push(self.finish());
                }
                all
            }
            6..=8 => {
                let mut all = vec![self.clear_pigment()];
                if self.r.chance(40) {
                    all.push(self.normal(0));
                }
                if self.r.chance(60) {
                    all.push(self.finish());
                }
                all.push(self.interior());
                all
            }
            9..=11 => {
                // POV-Ray lays nothing over a texture with `uv_mapping`.
                let mut all = vec![self.texture(0, false)];
                for _ in 0..1 + self.r.below(2) {
                    let mut said = vec![self.clear_pigment()];
                    if self.r.chance(30) {
                        said.push(self.normal(0));
                    }
                    if self.r.chance(50) {
                        said.push(self.finish());
                    }
                    all.push(block("texture", "", "", said));
                }
                all
            }
            _ => {
                let depth = 1 + usize::from(self.r.chance(25));
                vec![self.texture(depth, has_uv)]
            }
        }
    }

    fn uv(&mut self, has_uv: bool) -> &'static str {
        if has_uv && self.r.chance(40) { "uv_mapping " } else { "" }
    }

    /// A texture with at most `depth` others inside each other.
    pub(super) fn texture(&mut self, depth: usize, has_uv: bool) -> Node {
        let uv = self.uv(has_uv);
        let (words, mut said) = self.at_uv(!uv.is_empty(), |m| m.texture_body(depth));
        if self.r.chance(25) {
            said.push(Node::text(self.place()));
        }
        block("texture", uv, &words, said)
    }

    fn texture_body(&mut self, depth: usize) -> Body {
        match self.r.below(10) {
            0 | 1 if depth > 0 => {
                let (words, said) = self.list(|m| {
                    let (words, said) = m.texture_body(depth - 1);
                    block("texture", "", &words, said)
                });
                (words, [said, self.places()].concat())
            }
            2..=4 if depth > 0 => {
                if self.r.chance(15) {
                    let map = self.average("texture_map {", |m| m.texture_body(depth - 1));
                    return ("average".into(), vec![map]);
                }
                let words = self.pattern(0);
                let map = self.map("texture_map {", |m| m.texture_body(depth - 1));
                (words, [vec![map], self.changes()].concat())
            }
            _ => {
                let mut said = vec![self.pigment(1)];
                if self.r.chance(40) {
                    said.push(self.normal(1));
                }
                if self.r.chance(60) {
                    said.push(self.finish());
                }
                (String::new(), said)
            }
        }
    }
}

/// A block of this kind.
pub(super) fn block(kind: &str, uv: &str, words: &str, said: Vec<Node>) -> Node {
    let mut made = Node::block(format!("{kind} {{ {uv}{words}"), Vec::new(), 0);
    made.said = said;
    made
}
