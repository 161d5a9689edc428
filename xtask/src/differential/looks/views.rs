//! Cameras, lights and what surrounds the objects.

use super::Maker;
use super::pigments::block;
use crate::differential::tree::Node;

impl Maker {
    pub(super) fn camera(&mut self) -> Node {
        let (lens, is_wide) = match self.r.below(18) {
            0 => (format!("orthographic angle {}", self.r.number(35.0, 50.0)), false),
            1 => ("orthographic up 5*y".to_owned(), false),
            2 => (format!("fisheye angle {}", self.r.number(90.0, 220.0)), true),
            3 => (format!("ultra_wide_angle angle {}", self.r.number(90.0, 170.0)), true),
            4 => (format!("omnimax angle {}", self.r.number(90.0, 170.0)), true),
            5 => (format!("panoramic angle {}", self.r.number(90.0, 170.0)), true),
            6 => (
                format!("spherical angle {} {}", self.r.number(120.0, 350.0), self.r.number(60.0, 170.0)),
                true,
            ),
            7 | 8 => (format!("cylinder {} angle {}", self.r.below(4) + 1, self.r.number(90.0, 170.0)), true),
            9 => (format!("angle {}", self.r.number(60.0, 100.0)), false),
            10 => ("direction 1.5*z".into(), false),
            _ => ("angle 45".into(), false),
        };
        // A wide view stands nearer, but in front of all objects.
        let far = if is_wide { self.r.number(-4.0, -2.7) } else { self.r.number(-8.0, -5.0) };
        let location = format!("<{}, {}, {far}>", self.r.number(-2.0, 2.0), self.r.number(-1.0, 3.0));
        let right = if lens == "orthographic up 5*y" { "20/3*x" } else { "x*4/3" };
        let mut said = vec![Node::text(format!("look_at <0, {}, 0>", self.r.number(-0.4, 0.4)))];
        if self.r.chance(15) {
            said.push(Node::text(format!("sky <{}, 1, 0.1>", self.r.number(-0.6, 0.6))));
        }
        if self.r.chance(12) {
            let amount = self.r.number(0.02, 0.3);
            let size = self.odd(0.2, 0.8);
            let kind = self.r.choice(&["bumps", "ripples", "waves", "dents", "wrinkles", "leopard", "onion"]);
            said.push(Node::text(format!("normal {{ {kind} {amount} scale {size} }}")));
        }
        if self.r.chance(10) {
            said.push(Node::text(format!("rotate {}", self.r.vector(-8.0, 8.0))));
        }
        let mut made =
            Node::block(format!("camera {{ {lens} location {location} right {right}"), Vec::new(), 0);
        made.said = said;
        made
    }

    pub(super) fn lights(&mut self) -> Vec<Node> {
        (0..1 + self.r.below(2)).map(|_| self.light()).collect()
    }

    /// A light above all objects.
    pub(super) fn light(&mut self) -> Node {
        let at = [self.r.number(-5.0, 5.0), self.r.number(4.0, 8.0), self.r.number(-7.0, 3.0)];
        let paint = self.colour();
        // The programs read a colour without a keyword as a part of the location.
        let paint = if paint.starts_with("Tints") { format!("color {paint}") } else { paint };
        let mut made =
            Node::block(format!("light_source {{ <{}, {}, {}> {paint}", at[0], at[1], at[2]), vec![], 0);
        let beam = match self.r.below(11) {
            0 | 1 => format!(
                "spotlight point_at {} radius {} falloff {} tightness {}",
                self.r.vector(-1.0, 1.0),
                self.r.number(3.0, 12.0),
                self.r.number(13.0, 30.0),
                self.r.below(20)
            ),
            2 => format!(
                "cylinder point_at {} radius {} falloff {} tightness {}",
                self.r.vector(-1.0, 1.0),
                self.r.number(0.5, 1.5),
                self.r.number(1.6, 3.0),
                self.r.below(5)
            ),
            3 => format!("parallel point_at {}", self.r.vector(-1.0, 1.0)),
            4 => "shadowless".into(),
            _ => String::new(),
        };
        if !beam.is_empty() {
            made.said.push(Node::text(beam));
        }
        if self.r.chance(25) {
            made.said.push(Node::text(format!(
                "fade_distance {} fade_power {}",
                self.number(3.0, 9.0),
                self.r.choice(&["1", "2", "3"])
            )));
        }
        if self.r.chance(25) {
            let area = self.area();
            made.said.push(area);
        }
        if self.r.chance(8) {
            let ball = Node::block(
                format!(
                    "looks_like {{ sphere {{ 0, {} pigment {{ rgb 1 }} finish {{ emission 0.8 }} }}",
                    self.r.number(0.2, 0.6)
                ),
                vec![],
                0,
            );
            made.said.push(ball);
        }
        if self.r.chance(8) {
            // Between the light and the objects.
            let [x, y, z] = at.map(|c| c * 0.6);
            let window = match self.r.below(3) {
                0 => format!("sphere {{ <{x:.3}, {y:.3}, {z:.3}>, {}", self.r.number(0.3, 1.0)),
                1 => format!("box {{ -0.6, 0.6 scale <1, 0.1, 1> translate <{x:.3}, {y:.3}, {z:.3}>"),
                _ => format!("disc {{ <{x:.3}, {y:.3}, {z:.3}>, y, {}, 0.2", self.r.number(0.5, 1.0)),
            };
            made.said.push(Node::text(format!("projected_through {{ {window} }} }}")));
        }
        made
    }

    fn area(&mut self) -> Node {
        let (a, b) = (self.r.number(0.5, 2.0), self.r.number(0.5, 2.0));
        let count = self.r.below(4) + 2;
        let other = if self.r.chance(60) { count } else { self.r.below(5) + 1 };
        let mut words = format!("area_light {a}*x, {b}*z, {count}, {other}");
        if self.r.chance(40) {
            words += &format!(" adaptive {}", self.r.below(3));
        }
        // A row cannot be bent to a disc.
        if other > 1 && self.r.chance(40) {
            words += " circular";
        }
        if self.r.chance(30) {
            words += " orient";
        }
        if self.r.chance(25) {
            words += " area_illumination on";
        }
        Node::text(words)
    }

    /// What has no surface: the background, the sky, fog, rainbows.
    pub(super) fn sky(&mut self) -> Vec<Node> {
        let mut all = Vec::new();
        if self.r.chance(40) {
            all.push(Node::text(format!("background {{ rgb {} }}", self.vector(0.0, 0.6))));
        }
        if self.r.chance(40) {
            let mut said = vec![self.off_surface(|m| m.pigment(1))];
            if self.r.chance(25) {
                let clear = format!(
                    "pigment {{ {} color_map {{ [0.3 rgbt 1] [0.8 {}] }} scale {} }}",
                    self.r.choice(&["bozo", "gradient y", "leopard", "granite"]),
                    self.clear(),
                    self.odd(0.2, 0.6)
                );
                said.push(Node::text(clear));
            }
            if self.r.chance(30) {
                said.push(Node::text(self.place()));
            }
            let mut made = block("sky_sphere", "", "", said);
            made.least = 1;
            all.push(made);
        }
        for _ in 0..self.r.below(3).saturating_sub(1) + usize::from(self.r.chance(20)) {
            let fog = self.fog();
            all.push(fog);
        }
        if self.r.chance(15) {
            let rainbow = self.rainbow();
            all.push(rainbow);
        }
        all
    }

    fn fog(&mut self) -> Node {
        let paint = match self.r.below(3) {
            0 => format!("rgb {}", self.vector(0.2, 0.9)),
            1 => format!("rgbt <0.5, {}, 0.7, {}>", self.number(0.3, 0.9), self.r.number(0.0, 0.5)),
            _ => format!("rgbft <{}, 0.6, 0.5, {}, 0.1>", self.number(0.3, 0.9), self.r.number(0.0, 0.5)),
        };
        let mut said = vec![Node::text(format!("distance {}", self.number(4.0, 40.0))), Node::text(paint)];
        if self.r.chance(50) {
            said.push(Node::text(format!(
                "fog_type 2 fog_offset {} fog_alt {}",
                self.r.number(-2.0, 0.5),
                self.r.number(0.2, 2.0)
            )));
            if self.r.chance(30) {
                said.push(Node::text(format!(
                    "up <{}, 1, {}>",
                    self.r.number(-0.5, 0.5),
                    self.r.number(-0.5, 0.5)
                )));
            }
        }
        if self.r.chance(15) {
            said.push(Node::text(format!(
                "turbulence {} turb_depth {}",
                self.r.number(0.1, 0.6),
                self.r.number(0.2, 0.8)
            )));
        }
        block("fog", "", "", said)
    }

    fn rainbow(&mut self) -> Node {
        let mut said = vec![
            Node::text(format!("direction <{}, {}, 1>", self.r.number(-0.3, 0.3), self.r.number(-0.2, 0.3))),
            Node::text(format!("angle {} width {}", self.r.number(8.0, 25.0), self.r.number(2.0, 8.0))),
            Node::text(format!("distance {}", self.number(5.0, 60.0))),
        ];
        let map = self.map("color_map {", |m| {
            (
                format!(
                    "rgbt <{}, {}, 0.4, {}>",
                    m.r.number(0.0, 1.0),
                    m.r.number(0.0, 1.0),
                    m.r.number(0.2, 0.9)
                ),
                Vec::new(),
            )
        });
        said.push(map);
        if self.r.chance(40) {
            said.push(Node::text(format!(
                "arc_angle {} falloff_angle {}",
                self.r.number(120.0, 300.0),
                self.r.number(30.0, 110.0)
            )));
        }
        if self.r.chance(30) {
            said.push(Node::text(format!("up <{}, 1, 0>", self.r.number(-0.5, 0.5))));
        }
        block("rainbow", "", "", said)
    }

    /// The ground and a shell around all.
    pub(super) fn surroundings(&mut self) -> Vec<Node> {
        let mut all = Vec::new();
        if self.r.chance(70) {
            // Unlike y = -2, this height is the border of no pattern.
            let mut ground = Node::block("plane { y, -2.0137", Vec::new(), 0);
            self.is_endless = true;
            ground.said = self.look(false);
            self.is_endless = false;
            all.push(ground);
        }
        if self.r.chance(12) {
            let mut shell = Node::block("sphere { <0.1, 0.2, 0.3>, 23 hollow", Vec::new(), 0);
            shell.said = self.look(false);
            all.push(shell);
        }
        all
    }
}
