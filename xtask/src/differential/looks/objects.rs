//! Objects, loops and macros that make objects, and light groups.

use super::Maker;
use crate::differential::tree::Node;

impl Maker {
    /// An object at the top level, a loop of objects or a light group.
    pub(super) fn top(&mut self, number: usize) -> Node {
        let at = format!(
            "translate <{}, {}, {}>",
            self.r.number(-2.2, 2.2),
            self.r.number(-1.0, 1.3),
            self.r.number(-0.6, 3.0)
        );
        match self.r.below(12) {
            0 => self.loop_of_objects(number),
            1 => {
                let macro_name = format!("Ball{number}");
                let look = self.finish().line();
                let pattern = self.off_surface(|m| m.pattern(0));
                self.declared.push(Node::text(format!(
                    "#macro {macro_name}(Size, A, B) #local Half = Size/2; sphere {{ <0.1, 0, 0.05>, Half + 0.3 pigment {{ {pattern} color_map {{ [0 A] [1 B] }} scale Half }} {look} }} #end"
                )));
                let (a, b) = (self.colour(), self.colour());
                // A macro's argument is an expression.
                let [a, b] = [a, b].map(|c| {
                    if c.starts_with("red") || c.starts_with("color") { "rgb 0.4".into() } else { c }
                });
                let mut made = Node::block(
                    format!("object {{ {macro_name}({}, {a}, {b})", self.r.number(0.4, 1.2)),
                    vec![],
                    0,
                );
                made.said.push(Node::text(at));
                made
            }
            2 => {
                let mut group = Node::block("light_group {", vec![self.light(), self.object()], 1);
                group.said.push(Node::text(if self.r.chance(50) {
                    "global_lights on"
                } else {
                    "global_lights off"
                }));
                group.said.push(Node::text(at));
                group
            }
            3 => {
                let word = self.r.choice(&["union {", "difference {", "intersection {", "merge {"]);
                let mut parts = vec![self.shape(true), self.shape(true)];
                for part in &mut parts {
                    if self.r.chance(50) {
                        part.said = self.look(false);
                    }
                    part.said.push(Node::text(format!("translate {}", self.r.vector(-0.4, 0.4))));
                }
                let mut made = Node::block(word, parts, 2);
                made.said = self.look(false);
                made.said.push(Node::text(at));
                made
            }
            _ => {
                let mut made = self.object();
                made.said.push(Node::text(at));
                made
            }
        }
    }

    fn loop_of_objects(&mut self, number: usize) -> Node {
        let mut each = self.object();
        let turn = self.r.number(20.0, 90.0);
        let place = if self.has_words {
            format!(
                "scale 0.3 + 0.2*Table[I] translate <I - 1.5, Swing(I, 1) - 0.5, 2*Table[mod(I, 5)]> rotate {turn}*z*I"
            )
        } else {
            // Behind each other, so that no two faces of boxes are at the same place.
            format!("scale 0.5 translate <I - 1, 0, 0.0371*I> rotate {turn}*I*z")
        };
        each.said.push(Node::text(place));
        let last = 1 + self.r.below(3);
        let (open, step) = if self.r.chance(50) {
            (format!("#for (I, 0, {last})"), String::new())
        } else {
            (
                format!("#declare I = 0; #declare End{number} = {last}; #while (I <= End{number})"),
                "#declare I = I + 1;".into(),
            )
        };
        let said = if step.is_empty() { vec![] } else { vec![Node::text(step)] };
        Node { open, parts: vec![each], said, close: "#end", least: 1 }
    }

    fn object(&mut self) -> Node {
        let mut made = self.shape(false);
        let has_uv = ["sphere", "box", "torus", "mesh2", "sor"].iter().any(|w| made.open.starts_with(w));
        made.said = self.look(has_uv);
        for _ in 0..self.r.below(3) {
            made.said.push(Node::text(self.place()));
        }
        if self.r.chance(6) {
            let flag =
                self.r.choice(&["no_shadow", "no_image", "no_reflection", "hollow", "double_illuminate"]);
            made.said.push(Node::text(flag));
        }
        made
    }

    /// A shape without a look. None has its middle at the origin, since there the patterns around
    /// the origin jump on the whole surface.
    pub(super) fn shape(&mut self, is_solid: bool) -> Node {
        let r = &mut self.r;
        let open = match r.below(if is_solid { 6 } else { 12 }) {
            0 | 1 | 10 => format!("sphere {{ {}, {}", r.vector(-0.3, 0.3), r.number(0.5, 1.0)),
            2 | 11 => format!("box {{ {}, {}", r.vector(-0.9, -0.3), r.vector(0.3, 0.9)),
            3 => format!(
                "cylinder {{ {}, {}, {}",
                r.vector(-0.8, -0.2),
                r.vector(0.2, 0.8),
                r.number(0.3, 0.7)
            ),
            4 => format!(
                "cone {{ {}, {}, {}, {}",
                r.vector(-0.8, -0.2),
                r.number(0.4, 0.8),
                r.vector(0.2, 0.8),
                r.number(0.0, 0.3)
            ),
            5 | 6 => format!("torus {{ {}, {}", r.number(0.5, 0.9), r.number(0.15, 0.4)),
            7 => format!(
                "disc {{ {}, {}, {}, {}",
                r.vector(-0.3, 0.3),
                r.vector(-1.0, 1.0),
                r.number(0.5, 1.0),
                r.number(0.1, 0.3)
            ),
            8 => {
                let apex = r.vector(-0.2, 0.8);
                format!(
                    "mesh2 {{ vertex_vectors {{ 4, <-0.8, -0.6, -0.5>, <0.9, -0.5, -0.4>, <0.1, -0.4, 0.9>, {apex} }} \
                     uv_vectors {{ 4, <0, 0>, <1, 0>, <{}, 1>, <0.4, {}> }} face_indices {{ 4, <0, 1, 3>, <1, 2, 3>, <2, 0, 3>, <0, 1, 2> }}",
                    r.number(0.0, 1.0),
                    r.number(0.2, 0.8)
                )
            }
            _ => format!(
                "sor {{ 5, <0.6, -1.3>, <{}, -0.7>, <{}, 0.1>, <{}, 0.7>, <0.2, 1.2>",
                r.number(0.3, 0.7),
                r.number(0.3, 0.9),
                r.number(0.2, 0.6)
            ),
        };
        Node::block(open, Vec::new(), 0)
    }
}
