//! Random scenes of solids, their combinations, placements and plain textures.

use super::random::Random;
use super::tree::{Node, Scene};

/// The kind of object that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// Any object.
    Any,
    /// An object with an inside.
    Solid,
}

/// Makes a scene.
pub(super) struct Maker {
    r: Random,
    /// The names of declared objects, and whether they are solids.
    names: Vec<(String, bool)>,
    /// The names of macros that take a size and a pigment.
    macros: Vec<String>,
    /// The number of objects that may still be made.
    budget: usize,
    /// Whether the scene has prisms and triangles but no interior textures. On prisms, POV-Ray
    /// shows these on the outside of one end; on triangles, on a side that depends on how they were
    /// rotated.
    prisms: bool,
}

/// Makes the scene with this number in a run.
pub(super) fn scene(seed: u64, number: u64) -> Scene {
    let mut maker = Maker {
        r: Random::new(seed, number),
        names: Vec::new(),
        macros: Vec::new(),
        budget: 24,
        prisms: false,
    };
    maker.scene()
}

impl Maker {
    fn scene(&mut self) -> Scene {
        self.prisms = self.r.chance(50);
        let mut declared = Vec::new();
        for number in 0..self.r.below(4) {
            let wanted = if self.r.chance(60) { Wanted::Solid } else { Wanted::Any };
            let name = format!("Thing{number}");
            let mut made = self.object(2, wanted);
            made.open = format!("#declare {name} = {}", made.open);
            declared.push(made);
            self.names.push((name, wanted == Wanted::Solid));
        }
        if self.r.chance(35) {
            let name = format!("Make{}", declared.len());
            let mut body = self.object(1, Wanted::Solid);
            body.said.push(Node::text("scale Size"));
            if self.r.chance(60) {
                body.said.push(Node::text("pigment { Paint }"));
            }
            declared.push(Node {
                open: format!("#macro {name}(Size, Paint)"),
                parts: vec![body],
                said: Vec::new(),
                close: "#end",
                least: 1,
            });
            self.macros.push(name);
        }
        let (camera, lights, mut objects) = self.view();
        self.budget = self.budget.max(6);
        for _ in 0..2 + self.r.below(4) {
            let mut made = self.top();
            if made.close == "}" && self.r.chance(70) {
                let at = self.r.vector(-2.0, 2.0);
                made.said.push(Node::text(format!("translate {at}")));
            }
            if made.close == "}" && self.r.chance(6) {
                let habit = self.r.choice(&["no_image", "no_reflection"]);
                made.said.push(Node::text(habit));
            }
            objects.push(made);
        }
        let mut settings = vec![Node::text("global_settings { assumed_gamma 1 }")];
        if self.r.chance(15) {
            let first = format!("max_trace_level {}", self.r.below(9) + 2);
            settings[0] = Node::text(format!("global_settings {{ assumed_gamma 1 {first} }}"));
        }
        if self.r.chance(50) {
            settings.push(Node::text(format!("background {{ rgb {} }}", self.r.vector(0.0, 0.6))));
        }
        if self.r.chance(20) {
            let what = match self.r.below(3) {
                0 => format!("texture {{ {} {} }}", self.pigment(), self.finish()),
                1 => self.pigment(),
                _ => self.finish(),
            };
            settings.push(Node::text(format!("#default {{ {what} }}")));
        }
        Scene { settings, camera, lights, declared, objects }
    }

    /// Makes the camera, the lights, and the objects on whose surfaces these stand.
    fn view(&mut self) -> (Node, Vec<Node>, Vec<Node>) {
        let mut objects = Vec::new();
        if self.r.chance(70) {
            let paint = if self.r.chance(50) {
                format!(
                    "pigment {{ checker rgb {} rgb {} }}",
                    self.r.vector(0.2, 1.0),
                    self.r.vector(0.2, 1.0)
                )
            } else {
                self.pigment()
            };
            objects.push(Node::block(format!("plane {{ y, -2 {paint}"), Vec::new(), 0));
        }
        let mut location = format!(
            "<{}, {}, {}>",
            self.r.number(-3.0, 3.0),
            self.r.number(-1.0, 4.0),
            self.r.number(-8.0, -5.0)
        );
        match self.r.below(12) {
            // On a sphere, looking through it or away from it.
            0 => {
                location = "<0, 0, -6>".into();
                let middle = self.r.choice(&["<0, 0, -7>", "<0, 0, -5>", "<1, 0, -6>"]);
                objects.push(self.plain(format!("sphere {{ {middle}, 1")));
            }
            // On the face of a pane.
            1 => {
                location = "<0, 0.5, -6>".into();
                objects.push(self.plain("box { <-1, -1, -6>, <1, 1, -5.875>".into()));
            }
            // Inside a sphere.
            2 => {
                location = "<0, 0.25, -6>".into();
                objects.push(self.plain("sphere { <0, 0.25, -6>, 0.7".into()));
            }
            3 => objects.push(self.plain("sphere { 0, 20 hollow".into())),
            _ => {}
        }
        let lens = match self.r.below(5) {
            0 => "angle 70".to_owned(),
            // An orthographic camera stands on a plane, which would cross objects nearby.
            1 if objects.len() < 2 => "orthographic angle 45".to_owned(),
            _ => "angle 45".to_owned(),
        };
        let camera = Node::text(format!(
            "camera {{ {lens} location {location} right x*4/3 look_at <0, {}, 0> }}",
            self.r.number(-0.3, 0.3)
        ));
        let mut lights = Vec::new();
        for _ in 0..1 + self.r.below(2) {
            let mut at = format!(
                "<{}, {}, {}>",
                self.r.number(-6.0, 6.0),
                self.r.number(2.0, 7.0),
                self.r.number(-7.0, 3.0)
            );
            // On a ceiling. Lights on balls and boxes make speckles in POV-Ray.
            if self.r.below(10) == 0 {
                at = "<0, 3, -1>".into();
                objects.push(self.plain("plane { y, 3".into()));
            }
            let mut light =
                Node::block(format!("light_source {{ {at}, rgb {}", self.r.vector(0.3, 1.0)), vec![], 0);
            let beam = match self.r.below(9) {
                0 => "spotlight point_at 0 radius 12 falloff 25",
                1 => "parallel point_at 0",
                2 => "shadowless",
                3 => "fade_distance 6 fade_power 2",
                _ => "",
            };
            if !beam.is_empty() {
                light.said.push(Node::text(beam));
            }
            lights.push(light);
        }
        (camera, lights, objects)
    }

    /// Makes a shape with a look, without a transformation.
    fn plain(&mut self, open: String) -> Node {
        let mut made = Node::block(open, Vec::new(), 0);
        self.look(&mut made.said);
        made
    }

    /// Makes an object at the top level of the scene, or a loop of objects.
    fn top(&mut self) -> Node {
        match self.r.below(10) {
            0 if !self.names.is_empty() => {
                let mut each = self.instance(Wanted::Any).unwrap_or_else(|| self.leaf(Wanted::Any));
                let turn = self.r.number(20.0, 90.0);
                each.said.push(Node::text(format!("scale 0.5 translate <I - 1, 0, 0> rotate {turn}*I*z")));
                let last = 1 + self.r.below(3);
                let kind = self.r.below(2);
                if kind == 0 {
                    Node {
                        open: format!("#for (I, 0, {last})"),
                        parts: vec![each],
                        said: vec![],
                        close: "#end",
                        least: 1,
                    }
                } else {
                    Node {
                        open: format!("#declare I = 0; #while (I <= {last})"),
                        parts: vec![each],
                        said: vec![Node::text("#declare I = I + 1;")],
                        close: "#end",
                        least: 1,
                    }
                }
            }
            1 | 2 if !self.macros.is_empty() => self.call(),
            _ => self.object(3, Wanted::Any),
        }
    }

    fn call(&mut self) -> Node {
        let name = self.macros[self.r.below(self.macros.len())].clone();
        let size = self.r.number(0.4, 1.2);
        let paint = format!("rgb {}", self.r.vector(0.0, 1.0));
        let mut made = Node::block(format!("object {{ {name}({size}, pigment {{ {paint} }})"), vec![], 0);
        self.modifiers(&mut made.said);
        made
    }

    fn instance(&mut self, wanted: Wanted) -> Option<Node> {
        let fits: Vec<_> =
            self.names.iter().filter(|(_, solid)| *solid || wanted == Wanted::Any).cloned().collect();
        if fits.is_empty() {
            return None;
        }
        let (name, _) = &fits[self.r.below(fits.len())];
        let mut made = Node::block(format!("object {{ {name}"), vec![], 0);
        self.modifiers(&mut made.said);
        Some(made)
    }

    /// Makes an object with at most `depth` nested combinations.
    fn object(&mut self, depth: usize, wanted: Wanted) -> Node {
        if self.r.chance(15)
            && let Some(known) = self.instance(wanted)
        {
            return known;
        }
        if depth == 0 || self.budget < 3 || self.r.chance(35) {
            return self.leaf(wanted);
        }
        // Inside a solid, a union loses its inner surfaces. `merge` is used there until that is
        // fixed.
        let words: &[&str] = match wanted {
            Wanted::Any => &["union", "union", "union", "merge", "difference", "intersection"],
            Wanted::Solid => &["merge", "merge", "difference", "intersection"],
        };
        let word = self.r.choice(words);
        let inner = if word == "union" { wanted } else { Wanted::Solid };
        let count = 2 + self.r.below(3);
        let mut parts: Vec<Node> = (0..count).map(|_| self.object(depth - 1, inner)).collect();
        if word == "intersection" {
            parts.truncate(3);
        }
        // In other places POV-Ray gives an inverse object a bounding box that does not contain it.
        if matches!(word, "intersection" | "difference")
            && self.r.chance(15)
            && let Some(part) = parts.get_mut(1)
        {
            part.said.push(Node::text("inverse"));
        }
        // The parts are near the middle, so that they overlap.
        for part in &mut parts {
            let at = self.r.vector(-0.6, 0.6);
            part.said.push(Node::text(format!("translate {at}")));
        }
        if word == "difference" && self.r.chance(30) || word == "intersection" && self.r.chance(30) {
            let n = self.r.vector(-1.0, 1.0);
            let mut half = Node::block(format!("plane {{ {n}, {}", self.r.number(-0.2, 0.5)), vec![], 0);
            if self.r.chance(40) {
                self.look(&mut half.said);
            }
            parts.push(half);
        }
        let least = if word == "union" { 1 } else { 2 };
        let mut made = Node::block(format!("{word} {{"), parts, least);
        self.modifiers(&mut made.said);
        made
    }

    fn leaf(&mut self, wanted: Wanted) -> Node {
        self.budget = self.budget.saturating_sub(1);
        let r = &mut self.r;
        let kinds = if wanted == Wanted::Solid { 8 } else { 13 };
        let open = match r.below(kinds) {
            0 => format!("sphere {{ {}, {}", r.vector(-0.3, 0.3), r.number(0.3, 1.0)),
            1 => format!("box {{ {}, {}", r.vector(-0.9, -0.2), r.vector(0.2, 0.9)),
            2 => {
                let open = if r.chance(25) { " open" } else { "" };
                format!(
                    "cylinder {{ {}, {}, {}{open}",
                    r.vector(-0.8, -0.1),
                    r.vector(0.1, 0.8),
                    r.number(0.2, 0.6)
                )
            }
            3 => {
                let open = if r.chance(25) { " open" } else { "" };
                format!(
                    "cone {{ {}, {}, {}, {}{open}",
                    r.vector(-0.8, -0.1),
                    r.number(0.3, 0.8),
                    r.vector(0.1, 0.8),
                    r.number(0.0, 0.3)
                )
            }
            4 => format!("torus {{ {}, {}", r.number(0.5, 0.9), r.number(0.1, 0.4)),
            5 => format!(
                "quadric {{ {}, {}, {}, {}",
                r.vector(1.0, 4.0),
                r.vector(-0.5, 0.5),
                r.vector(-0.3, 0.3),
                r.number(-1.0, -0.4)
            ),
            6 if self.prisms => format!(
                "prism {{ {}, {}, 5, <-0.7, -0.6>, <0.8, {}>, <{}, 0.7>, <-0.5, {}>, <-0.7, -0.6>",
                r.number(-0.7, -0.1),
                r.number(0.1, 0.7),
                r.number(-0.7, -0.2),
                r.number(0.2, 0.7),
                r.number(0.1, 0.6)
            ),
            7 => format!("superellipsoid {{ <{}, {}>", r.number(0.3, 1.0), r.number(0.3, 1.0)),
            8 => format!("disc {{ {}, {}, {}", r.vector(-0.3, 0.3), r.vector(-1.0, 1.0), r.number(0.4, 1.0)),
            9 if self.prisms => format!(
                "triangle {{ {}, {}, {}",
                r.vector(-1.0, 1.0),
                r.vector(-1.0, 1.0),
                r.vector(-1.0, 1.0)
            ),
            10 => format!(
                "polygon {{ 5, <-0.8, -0.7>, <0.9, {}>, <{}, 0.8>, <-0.7, {}>, <-0.8, -0.7>",
                r.number(-0.9, 0.0),
                r.number(0.0, 0.9),
                r.number(0.2, 0.8)
            ),
            11 => {
                let apex = r.vector(-0.2, 0.8);
                let base = "<-0.7, -0.5, -0.4>, <0.7, -0.5, -0.4>, <0, -0.5, 0.8>";
                format!(
                    "mesh2 {{ vertex_vectors {{ 4, {base}, {apex} }} face_indices {{ 4, <0, 1, 3>, <1, 2, 3>, <2, 0, 3>, <0, 1, 2> }}"
                )
            }
            12 => format!(
                "blob {{ threshold 0.5 sphere {{ {}, 0.9, 1.2 }} sphere {{ {}, 0.8, 1 }}",
                r.vector(-0.4, 0.4),
                r.vector(-0.4, 0.4)
            ),
            _ => format!("sphere {{ 0, {}", r.number(0.3, 1.0)),
        };
        let mut made = Node::block(open, Vec::new(), 0);
        self.modifiers(&mut made.said);
        made
    }

    /// Adds a look, a transformation, flags and clips, in random order.
    fn modifiers(&mut self, said: &mut Vec<Node>) {
        if self.r.chance(55) {
            self.look(said);
        }
        for _ in 0..self.r.below(3) {
            let place = self.place();
            said.push(Node::text(place));
        }
        if self.r.chance(8) {
            said.push(Node::text("no_shadow"));
        }
        if self.r.chance(4) {
            let habit = self.r.choice(&["hollow", "double_illuminate"]);
            said.push(Node::text(habit));
        }
        if self.r.chance(10) {
            let clip = self.clip();
            let mut block = Node::block("clipped_by {", vec![clip], 1);
            block.least = 1;
            said.push(block);
        }
        self.r.shuffle(said);
    }

    fn clip(&mut self) -> Node {
        let r = &mut self.r;
        let open = match r.below(4) {
            0 => format!("plane {{ {}, {}", r.vector(-1.0, 1.0), r.number(-0.2, 0.4)),
            1 => format!("sphere {{ {}, {}", r.vector(-0.4, 0.4), r.number(0.4, 1.0)),
            2 => format!("box {{ {}, {}", r.vector(-0.9, -0.1), r.vector(0.1, 0.9)),
            _ => format!(
                "cylinder {{ {}, {}, {}",
                r.vector(-1.5, -0.5),
                r.vector(0.5, 1.5),
                r.number(0.2, 0.6)
            ),
        };
        let mut made = Node::block(open, Vec::new(), 0);
        if r.chance(20) {
            made.said.push(Node::text("inverse"));
        }
        made
    }

    fn place(&mut self) -> String {
        let r = &mut self.r;
        match r.below(6) {
            0 | 1 => format!("rotate {}", r.vector(-180.0, 180.0)),
            2 => format!("scale {}", r.number(0.6, 1.4)),
            3 => format!("scale {}", r.vector(0.5, 1.5)),
            4 => format!("translate {}", r.vector(-0.5, 0.5)),
            _ => {
                let v: [f64; 3] = std::array::from_fn(|_| r.number(-0.4, 0.4));
                format!("matrix <1, {}, 0, 0, 1, {}, {}, 0, 1, 0, 0, 0>", v[0], v[1], v[2])
            }
        }
    }

    /// Adds a texture in one of the language's forms, and what belongs to it.
    fn look(&mut self, said: &mut Vec<Node>) {
        match self.r.below(12) {
            0 | 1 => {
                // Glass.
                let kind = self.r.choice(&["rgbf", "rgbt"]);
                let clear = self.r.number(0.4, 0.95);
                let colour = format!(
                    "{kind} <{}, {}, {}, {clear}>",
                    self.r.number(0.5, 1.0),
                    self.r.number(0.5, 1.0),
                    self.r.number(0.5, 1.0)
                );
                said.push(Node::text(format!("pigment {{ {colour} }}")));
                if self.r.chance(60) {
                    said.push(Node::text(format!("interior {{ ior {} }}", self.r.number(1.0, 1.6))));
                }
                if self.r.chance(40) {
                    said.push(Node::text("finish { specular 0.4 reflection 0.1 }"));
                }
            }
            2 | 3 => {
                let finish = if self.r.chance(60) { self.finish() } else { String::new() };
                let place = if self.r.chance(40) { self.place() } else { String::new() };
                said.push(Node::text(format!("texture {{ {} {finish} {place} }}", self.pigment())));
            }
            4 => {
                said.push(Node::text(format!("texture {{ {} }}", self.pigment())));
                let clear = format!(
                    "gradient y color_map {{ [0 rgbt 1] [1 rgbt <{}, 0.2, 0.3, 0.3>] }} scale {}",
                    self.r.number(0.0, 1.0),
                    self.r.number(0.3, 0.9)
                );
                // Both layers stay together when the modifiers are shuffled.
                if let Some(last) = said.last_mut() {
                    last.open = format!("{} texture {{ pigment {{ {clear} }} }}", last.open);
                }
            }
            5 if !self.prisms => {
                let (a, b) = (self.pigment(), self.pigment());
                said.push(Node::text(format!("texture {{ {a} }} interior_texture {{ {b} }}")));
            }
            6 => said.push(Node::text(self.finish())),
            7 => {
                said.push(Node::text(self.pigment()));
                said.push(Node::text(self.finish()));
            }
            _ => said.push(Node::text(self.pigment())),
        }
    }

    fn pigment(&mut self) -> String {
        let r = &mut self.r;
        match r.below(10) {
            0 => {
                let (a, b) = (r.vector(0.0, 1.0), r.vector(0.0, 1.0));
                let size = r.number(0.15, 0.6);
                format!("pigment {{ checker rgb {a} rgb {b} scale {size} }}")
            }
            1 => {
                let (a, b) = (r.vector(0.0, 1.0), r.vector(0.0, 1.0));
                let (along, size, place) = (r.vector(0.1, 1.0), r.number(0.3, 1.2), r.vector(-90.0, 90.0));
                format!(
                    "pigment {{ gradient {along} color_map {{ [0 rgb {a}] [1 rgb {b}] }} scale {size} rotate {place} }}"
                )
            }
            2 => {
                let (a, b) = (r.vector(0.0, 1.0), r.vector(0.0, 1.0));
                format!("pigment {{ brick rgb {a} rgb {b} scale {} }}", r.number(0.04, 0.1))
            }
            _ => format!("pigment {{ rgb {} }}", r.vector(0.0, 1.0)),
        }
    }

    fn finish(&mut self) -> String {
        let r = &mut self.r;
        let mut words = Vec::new();
        if r.chance(50) {
            words.push(format!("ambient {}", r.number(0.0, 0.4)));
        }
        if r.chance(50) {
            words.push(format!("diffuse {}", r.number(0.2, 0.9)));
        }
        if r.chance(30) {
            words.push(format!("phong {} phong_size {}", r.number(0.2, 1.0), r.below(90) + 5));
        }
        if r.chance(30) {
            words.push(format!("specular {} roughness {}", r.number(0.2, 1.0), r.number(0.01, 0.1)));
        }
        if r.chance(25) {
            words.push(format!("reflection {}", r.number(0.1, 0.6)));
        }
        if r.chance(15) {
            words.push("metallic".into());
        }
        format!("finish {{ {} }}", words.join(" "))
    }
}
