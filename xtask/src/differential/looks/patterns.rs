//! Patterns and what changes them.

use super::Maker;
use crate::differential::tree::Node;

impl Maker {
    /// The words of a pattern with values between 0 and 1.
    pub(super) fn pattern(&mut self, depth: usize) -> String {
        match self.r.below(34) {
            0 | 1 => format!("gradient {}", self.r.choice(&["x", "y", "z"])),
            2 => format!("gradient {}", self.vector(0.1, 1.0)),
            3 => "radial".into(),
            4 => "onion".into(),
            5 => "leopard".into(),
            6 => self.r.choice(&["spherical", "cylindrical", "planar", "boxed"]).into(),
            7 => self.r.choice(&["spherical", "cylindrical", "planar", "boxed"]).into(),
            8 => format!("{} {}", self.r.choice(&["spiral1", "spiral2"]), self.r.below(5) + 1),
            9 => format!("quilted control0 {} control1 {}", self.number(0.0, 1.0), self.number(0.0, 1.0)),
            10 | 11 => self.fractal(),
            12 => "cells".into(),
            13 | 14 => self.crackle(),
            15 => format!("tiling {}", 1 + self.r.below(27)),
            16..=18 => self.function(),
            19 if depth > 0 => {
                let inner = self.pigment(depth - 1);
                inner.line().replacen("pigment {", "pigment_pattern {", 1)
            }
            20 if self.is_on_surface => self.slope(),
            21 => "radial".into(),
            22 => "marble".into(),
            23 => "wood".into(),
            24 => "granite".into(),
            25 => "agate".into(),
            26 => format!("agate agate_turb {}", self.number(0.1, 1.0)),
            27 => self.r.choice(&["ripples", "waves"]).into(),
            28 => self.r.choice(&["wrinkles", "dents"]).into(),
            29 => self.r.choice(&["spotted", "bumps"]).into(),
            _ => "bozo".into(),
        }
    }

    fn fractal(&mut self) -> String {
        let r = &mut self.r;
        let times = r.below(25) + 2;
        let c = format!("<{}, {}>", r.number(-1.0, 0.4), r.number(-0.8, 0.8));
        let mut words = match r.below(6) {
            0 | 1 => format!("mandel {times}"),
            2 | 3 => format!("julia {c}, {times}"),
            4 => format!("magnet {} mandel {times}", r.below(2) + 1),
            _ => format!("magnet {} julia {c}, {times}", r.below(2) + 1),
        };
        if !words.starts_with("magnet") && r.chance(30) {
            words += &format!(" exponent {}", r.below(4) + 2);
        }
        if r.chance(40) {
            words += &format!(" interior {}, {}", r.below(7), r.number(0.3, 1.5));
        }
        if r.chance(40) {
            let kind = r.below(7);
            let kind = if self.is_endless { kind % 2 } else { kind };
            words += &format!(" exterior {kind}, {}", r.number(0.3, 1.5));
        }
        words
    }

    fn crackle(&mut self) -> String {
        let r = &mut self.r;
        let mut words = "crackle".to_owned();
        if r.chance(40) {
            words += &format!(" form {}", r.vector(-1.0, 1.0));
        }
        if r.chance(30) {
            words += &format!(" metric {}", r.choice(&["1", "2", "3", "1.5"]));
        }
        if r.chance(20) {
            words += &format!(" offset {}", r.number(0.0, 0.5));
        }
        if r.chance(25) {
            words += " solid";
        }
        words
    }

    fn slope(&mut self) -> String {
        let r = &mut self.r;
        match r.below(4) {
            0 => "aoi".into(),
            1 => {
                format!("slope {{ {}, {}, {} }}", r.vector(-1.0, 1.0), r.number(0.0, 0.3), r.number(0.6, 1.0))
            }
            2 => format!(
                "slope {{ {} altitude {}, {}, {} }}",
                r.vector(-1.0, 1.0),
                r.vector(-1.0, 1.0),
                r.number(-2.0, -0.5),
                r.number(0.5, 2.0)
            ),
            _ => format!("slope {{ {} }}", r.vector(-1.0, 1.0)),
        }
    }

    /// A function of the point, plain or through declared functions.
    fn function(&mut self) -> String {
        let mut formula = self.formula();
        if self.r.chance(50) {
            let name = format!("F{}", self.functions);
            self.functions += 1;
            let (declared, call) = match self.r.below(5) {
                0 => {
                    let inner = self.off_surface(|m| m.pigment(0));
                    (format!("function {{ {} }}", inner.line()), format!("{name}(x, y, z).gray"))
                }
                1 => {
                    // POV-Ray takes no tilings here.
                    let inner = self.off_surface(|m| m.pattern(0));
                    let inner = if inner.starts_with("tiling") { "leopard".into() } else { inner };
                    let size = self.odd(0.2, 0.8);
                    (format!("function {{ pattern {{ {inner} scale {size} }} }}"), format!("{name}(x, y, z)"))
                }
                2 => {
                    let place = self.place();
                    (format!("function {{ transform {{ {place} }} }}"), format!("{name}(x, y, z).x"))
                }
                3 => (
                    format!(
                        "function(a, b) {{ a*{} + cos(b*{}) }}",
                        self.r.number(0.1, 2.0),
                        self.r.number(1.0, 5.0)
                    ),
                    format!("{name}(y, x*z)"),
                ),
                _ => (
                    format!("function {{ {formula} }}"),
                    format!("{name}(x, z, y)*{}", self.r.number(0.5, 2.0)),
                ),
            };
            self.declared.push(Node::text(format!("#declare {name} = {declared}")));
            formula = call;
        }
        format!("function {{ {formula} }}")
    }

    /// A formula in x, y and z.
    fn formula(&mut self) -> String {
        let r = &mut self.r;
        let (a, b) = (r.number(0.5, 3.0), r.number(0.5, 6.0));
        match r.below(9) {
            0 => format!("sin({a}*x)*cos({b}*y) + z"),
            1 => format!("sqrt(x*x + {a}*y*y + z*z)"),
            2 => format!("abs({a}*x) + abs(y - z)"),
            3 => format!("max(x, y, z)*{a} - min(x*y, z)"),
            4 => format!("pow(abs(x*{a}), {b}/4) + y"),
            5 => format!("atan2(y, x + {a})*{b} + exp(-z*z)"),
            6 => format!("select(x - y, {a}*z, {b}*y)"),
            7 => format!("sum(k, 1, 4, sin(k*x*{a})/k + y/k)"),
            _ => format!("(x > y & z < {a})*0.5 + {b}*x/10"),
        }
    }

    /// What changes a pattern: waves, turbulence, warps, a place.
    pub(super) fn changes(&mut self) -> Vec<Node> {
        let mut all = Vec::new();
        if self.r.chance(20) {
            all.push(format!("frequency {}", self.number(0.3, 4.0)));
        }
        if self.r.chance(15) {
            all.push(format!("phase {}", self.number(-1.0, 1.0)));
        }
        if self.r.chance(25) {
            let mut wave = self
                .r
                .choice(&[
                    "ramp_wave",
                    "triangle_wave",
                    "sine_wave",
                    "scallop_wave",
                    "cubic_wave",
                    "poly_wave",
                ])
                .to_owned();
            if wave == "poly_wave" {
                wave += &format!(" {}", self.number(0.4, 3.0));
            }
            all.push(wave);
        }
        if self.r.chance(18) {
            all.push(self.turbulence());
        }
        let mut all: Vec<Node> = all.into_iter().map(Node::text).collect();
        all.extend(self.places());
        all
    }

    /// Warps and a place of a pattern.
    pub(super) fn places(&mut self) -> Vec<Node> {
        let mut all = Vec::new();
        all.push(format!("scale {}", self.odd(0.2, 1.0)));
        if self.r.chance(15) {
            all.push(self.warp());
        }
        if self.r.chance(50) {
            all.push(format!(
                "translate <{}, {}, {}>",
                self.odd(-1.0, 1.0),
                self.odd(-1.0, 1.0),
                self.odd(-1.0, 1.0)
            ));
        }
        if self.r.chance(40) {
            all.push(format!("rotate {}", self.vector(-180.0, 180.0)));
        }
        if self.r.chance(15) {
            all.push(format!("scale {}", self.vector(0.5, 1.5)));
        }
        all.into_iter().map(Node::text).collect()
    }

    fn turbulence(&mut self) -> String {
        let amount = if self.r.chance(70) { self.number(0.05, 0.8) } else { self.vector(0.0, 0.8) };
        let mut words = format!("turbulence {amount}");
        if self.r.chance(40) {
            words += &format!(" octaves {}", self.r.below(6) + 1);
        }
        if self.r.chance(30) {
            words += &format!(" omega {}", self.r.number(0.2, 0.7));
        }
        if self.r.chance(30) {
            words += &format!(" lambda {}", self.r.number(1.5, 3.0));
        }
        words
    }

    fn warp(&mut self) -> String {
        match self.r.below(9) {
            0 => format!("warp {{ {} }}", self.turbulence()),
            1 | 2 => {
                let mut words = format!("repeat {}*{}", self.odd(0.4, 1.5), self.r.choice(&["x", "y", "z"]));
                if self.r.chance(40) {
                    words += &format!(" offset {}", self.r.vector(-0.4, 0.4));
                }
                if self.r.chance(40) {
                    words += &format!(" flip {}", self.r.choice(&["x", "y", "<1, 1, 0>", "<1, 1, 1>"]));
                }
                format!("warp {{ {words} }}")
            }
            3 => {
                let mut words = format!("black_hole {}, {}", self.r.vector(-0.6, 0.6), self.number(0.4, 1.2));
                if self.r.chance(60) {
                    words +=
                        &format!(" strength {} falloff {}", self.r.number(0.5, 2.0), self.r.number(0.5, 3.0));
                }
                if self.r.chance(20) {
                    words += " inverse";
                }
                if self.r.chance(30) {
                    words += &format!(" repeat <{}, {}, 2>", self.odd(1.0, 2.0), self.odd(1.0, 2.0));
                }
                format!("warp {{ {words} }}")
            }
            4 => "warp { cubic }".into(),
            5 => format!("warp {{ toroidal major_radius {} }}", self.r.number(0.4, 1.0)),
            kind => {
                let mut words = ["cylindrical", "spherical", "planar"][kind - 6].to_owned();
                if words == "planar" {
                    // Without a distance z is 0, the line of corners of `hexagon`, where the last
                    // digit decides which hexagon POV-Ray shows.
                    words += &if self.r.chance(60) {
                        format!(" {}, {}", self.r.vector(-1.0, 1.0), self.odd(-0.5, 0.5))
                    } else {
                        " z, 0.23417".to_owned()
                    };
                } else {
                    if self.r.chance(40) {
                        words += &format!(" orientation {}", self.r.choice(&["x", "y", "z", "-z"]));
                    }
                    if self.r.chance(40) {
                        words += &format!(" dist_exp {}", self.r.number(0.0, 1.0));
                    }
                }
                format!("warp {{ {words} }}")
            }
        }
    }

    /// A transformation of a texture or an object.
    pub(super) fn place(&mut self) -> String {
        match self.r.below(6) {
            0 | 1 => format!("rotate {}", self.vector(-180.0, 180.0)),
            2 => format!("scale {}", self.number(0.6, 1.4)),
            3 => format!("scale {}", self.vector(0.5, 1.5)),
            4 => format!("translate {}", self.vector(-0.5, 0.5)),
            _ => {
                let v: [f64; 3] = std::array::from_fn(|_| self.r.number(-0.4, 0.4));
                format!("matrix <1, {}, 0, 0, 1, {}, {}, 0, 1, 0, 0, 0>", v[0], v[1], v[2])
            }
        }
    }
}
