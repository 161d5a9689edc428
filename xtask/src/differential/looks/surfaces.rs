//! Normals, finishes and interiors.

use super::Maker;
use super::pigments::{Body, block};
use crate::differential::tree::Node;

impl Maker {
    /// A normal with at most `depth` others inside each other.
    pub(super) fn normal(&mut self, depth: usize) -> Node {
        let (words, said) = self.off_surface(|m| m.normal_body(depth));
        block("normal", "", &words, said)
    }

    fn normal_body(&mut self, depth: usize) -> Body {
        match self.r.below(12) {
            0 if depth > 0 => {
                let (words, said) = self.list(|m| {
                    let (words, said) = m.normal_body(depth - 1);
                    block("normal", "", &words, said)
                });
                (words, [said, self.places()].concat())
            }
            1 if depth > 0 => {
                let words = self.pattern(0);
                let map = self.map("normal_map {", |m| m.normal_body(depth - 1));
                (words, [vec![map], self.changes()].concat())
            }
            2 if depth > 0 => {
                let map = self.average("normal_map {", |m| m.normal_body(depth - 1));
                ("average".into(), vec![map])
            }
            3 => (
                format!("facets {} {}", self.r.choice(&["coords", "size"]), self.number(0.1, 0.9)),
                vec![Node::text(format!("scale {}", self.odd(0.3, 1.0)))],
            ),
            4..=6 => {
                let kind = self.r.choice(&["bumps", "dents", "wrinkles", "ripples", "waves", "quilted"]);
                let words = format!("{kind} {}", self.number(0.1, 0.8));
                (words, self.normal_changes())
            }
            _ => {
                let words = self.pattern(0);
                let mut said = Vec::new();
                if self.r.chance(30) {
                    said.push(self.slope_map());
                }
                said.push(Node::text(format!("bump_size {}", self.number(0.1, 1.2))));
                said.extend(self.normal_changes());
                (words, said)
            }
        }
    }

    fn normal_changes(&mut self) -> Vec<Node> {
        let mut all = self.changes();
        if self.r.chance(10) {
            all.push(Node::text("no_bump_scale"));
        }
        if self.r.chance(10) {
            all.push(Node::text(format!("accuracy {}", self.r.number(0.005, 0.05))));
        }
        all
    }

    fn slope_map(&mut self) -> Node {
        self.map("slope_map {", |m| {
            (format!("<{}, {}>", m.r.number(0.0, 1.0), m.r.number(-1.0, 1.0)), Vec::new())
        })
    }

    /// A finish.
    pub(super) fn finish(&mut self) -> Node {
        let mut words = Vec::new();
        let mut add = |m: &mut Self, percent: usize, make: &dyn Fn(&mut Self) -> String| {
            if m.r.chance(percent) {
                let word = make(m);
                words.push(word);
            }
        };
        add(self, 40, &|m| match m.r.below(3) {
            0 => format!("ambient rgb {}", m.vector(0.0, 0.4)),
            _ => format!("ambient {}", m.number(0.0, 0.4)),
        });
        add(self, 50, &|m| {
            let albedo = if m.r.chance(20) { "albedo " } else { "" };
            let behind = if m.r.chance(15) { format!(", {}", m.r.number(0.1, 0.6)) } else { String::new() };
            format!("diffuse {albedo}{}{behind}", m.number(0.2, 0.9))
        });
        add(self, 15, &|m| format!("brilliance {}", m.number(0.5, 4.0)));
        add(self, 12, &|m| format!("emission rgb {}", m.vector(0.0, 0.4)));
        add(self, 30, &|m| {
            let albedo = if m.r.chance(20) { "albedo " } else { "" };
            format!("phong {albedo}{} phong_size {}", m.number(0.2, 1.0), m.r.below(90) + 5)
        });
        add(self, 30, &|m| {
            let albedo = if m.r.chance(20) { "albedo " } else { "" };
            format!("specular {albedo}{} roughness {}", m.number(0.2, 1.0), m.number(0.01, 0.2))
        });
        add(self, 35, &Self::reflection);
        add(self, 15, &|m| {
            let amount = if m.r.chance(50) { m.r.number(0.2, 1.0).to_string() } else { String::new() };
            format!("metallic {amount}")
        });
        add(self, 12, &|m| {
            let turbulence =
                if m.r.chance(40) { format!(" turbulence {}", m.r.number(0.1, 0.8)) } else { String::new() };
            format!("irid {{ {} thickness {}{turbulence} }}", m.number(0.1, 0.6), m.number(0.2, 1.5))
        });
        add(self, 12, &|_| "conserve_energy".into());
        Node {
            open: "finish {".into(),
            parts: vec![],
            said: words.into_iter().map(Node::text).collect(),
            close: "}",
            least: 0,
        }
    }

    fn reflection(&mut self) -> String {
        let mut words = match self.r.below(3) {
            0 => self.number(0.1, 0.6),
            1 => format!("rgb {}", self.vector(0.0, 0.6)),
            _ => format!("rgb {}, rgb {}", self.r.vector(0.0, 0.3), self.r.vector(0.3, 0.8)),
        };
        if self.r.chance(25) {
            words += " fresnel on";
        }
        if self.r.chance(25) {
            words += &format!(" falloff {}", self.r.number(0.5, 4.0));
        }
        if self.r.chance(15) {
            words += &format!(" exponent {}", self.r.number(0.5, 1.5));
        }
        if self.r.chance(20) {
            words += &format!(" metallic {}", self.r.number(0.2, 1.0));
        }
        format!("reflection {{ {words} }}")
    }

    /// An interior.
    pub(super) fn interior(&mut self) -> Node {
        let mut words = vec![format!("ior {}", self.number(1.0, 1.6))];
        if self.r.chance(30) {
            words.push(format!(
                "fade_distance {} fade_power {}",
                self.number(0.3, 2.0),
                self.r.choice(&["1", "2", "1000"])
            ));
            if self.r.chance(60) {
                words.push(format!("fade_color rgb {}", self.r.vector(0.1, 0.9)));
            }
        }
        if self.r.chance(15) {
            words.push(format!("caustics {}", self.number(0.1, 1.0)));
        }
        Node {
            open: "interior {".into(),
            parts: vec![],
            said: words.into_iter().map(Node::text).collect(),
            close: "}",
            least: 0,
        }
    }
}
