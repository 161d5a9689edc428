//! Numbers, vectors and colours, plain or written with variables, functions and macros.

use super::Maker;
use crate::differential::tree::Node;

impl Maker {
    /// Declares what the other functions of this file name.
    pub(super) fn words(&mut self) -> Vec<Node> {
        let mut units = |count: usize| {
            let all: Vec<String> = (0..count).map(|_| self.r.number(0.0, 1.0).to_string()).collect();
            all.join(", ")
        };
        let table = format!("#declare Table = array[5] {{ {} }}", units(5));
        let grid = format!("#declare Grid = array[2][3] {{ {{ {} }}, {{ {} }} }}", units(3), units(3));
        let kind = self.r.choice(&["linear_spline", "quadratic_spline", "cubic_spline", "natural_spline"]);
        let mut knots = || {
            let all: Vec<String> = (0..5)
                .map(|k| format!("{:.1}, {}", 0.4 * f64::from(k - 1), self.r.vector(0.25, 0.75)))
                .collect();
            all.join(", ")
        };
        let way = format!("#declare Way = spline {{ {kind} {} }}", knots());
        let tints: Vec<String> = (0..4).map(|_| format!("rgb {}", self.r.vector(0.0, 1.0))).collect();
        let frequency = self.r.number(1.0, 7.0);
        let lines = [
            table,
            grid,
            way,
            format!("#declare Tints = array[4] {{ {} }}", tints.join(", ")),
            format!("#declare Swing = function(a, b) {{ 0.5 + 0.5*sin({frequency}*a + b) }}"),
            "#macro Between(A, B, T) (A + (B - A)*(T)) #end".into(),
            "#macro Fade(N) #if (N > 0) (0.5*Fade(N - 1) + 0.25*Table[mod(N, 5)]) #else 0.3 #end #end".into(),
            "#macro Pick(N) #if (N > 3) 0.8 #else #if (N > 0) Table[N] #else 0.2 #end #end #end".into(),
            format!(
                "#switch ({}) #case (0) #declare Picked = 0.2; #break #range (1, 2) #declare Picked = 0.7; #break \
                 #else #declare Picked = 0.9; #end",
                self.r.below(4)
            ),
            format!("#declare Dice = seed({});", self.r.below(1000)),
            "#declare Total = 0; #for (K, 0, 4) #declare Total = Total + Table[K]/5; #end".into(),
            "#declare Count = 0; #while (Count < 9) #declare Count = Count + 1; #if (Table[mod(Count, 5)] > 0.6) #break #end #end"
                .into(),
        ];
        lines.into_iter().map(Node::text).collect()
    }

    /// An expression between 0 and 1 with variables, functions and macros.
    fn unit(&mut self) -> String {
        let r = &mut self.r;
        match r.below(24) {
            0 => format!("Table[{}]", r.below(5)),
            1 => format!("Grid[{}][{}]", r.below(2), r.below(3)),
            2 => format!("Way({}).{}", r.number(0.0, 0.8), r.choice(&["x", "y", "z"])),
            3 => format!("Swing({}, Table[{}])", r.number(-1.0, 1.0), r.below(5)),
            4 | 5 => "rand(Dice)".into(),
            6 => "Total".into(),
            7 => "Picked".into(),
            8 => format!("abs(vcross({}, y).z)", r.vector(-1.0, 1.0)),
            9 => format!("val(\"{}\")", r.number(0.0, 1.0)),
            10 => format!("strlen(concat(\"durer\", str({}, 0, 3)))/20", r.number(0.0, 99.0)),
            11 => format!("asc(substr(\"kaleidoscope\", {}, 1))/150", r.below(12) + 1),
            12 => format!("val(concat(\"0.\", chr({})))", r.below(10) + 48),
            13 => format!("mod({}, 1)", r.number(0.0, 9.0)),
            14 => format!("abs(sin({}))", r.number(-9.0, 9.0)),
            15 => format!("vlength(<{}, {}, 0>)/2", r.number(-1.0, 1.0), r.number(-1.0, 1.0)),
            16 => format!("abs(vrotate(x, {}).{})", r.vector(-180.0, 180.0), r.choice(&["x", "y", "z"])),
            17 => format!("(Table[{}] < Table[{}] ? 0.2 : 0.7)", r.below(5), r.below(5)),
            18 => format!("bitwise_xor({}, {})/31", r.below(32), r.below(32)),
            19 => format!("div({}, 7)/10", r.below(70)),
            20 => format!("min(max(ln({}), 0), 1)", r.number(0.5, 3.0)),
            21 => format!("select({}, 0.3, 0.5, 0.8)", r.below(3) as i32 - 1),
            22 => format!(
                "(strcmp(strupr(\"ink\"), \"I{}\") > 0 ? 0.4 : 0.9)",
                r.choice(&["M", "N", "NK", "O"])
            ),
            _ => format!("Tints[{}].{}", r.below(4), r.choice(&["red", "green", "blue", "gray"])),
        }
    }

    /// A number, sometimes as an expression.
    pub(super) fn number(&mut self, low: f64, high: f64) -> String {
        if self.has_words && self.r.chance(20) {
            if self.r.chance(20) {
                let (one, other) = (self.r.number(low, high), self.r.number(low, high));
                return format!("#if ({} < 0.5 & Count != 3) {one} #else {other} #end", self.unit());
            }
            // A macro with directives in it is no argument of another one in POV-Ray.
            if self.r.chance(30) {
                let inner = match self.r.below(2) {
                    0 => format!("Pick({})", self.r.below(5)),
                    _ => format!("Fade({})", self.r.below(4)),
                };
                return format!("({low} + {:.3}*{inner})", high - low);
            }
            return format!("Between({low}, {high}, {})", self.unit());
        }
        self.r.number(low, high).to_string()
    }

    /// The size or place of a pattern: a number with more digits than those of objects, so that no
    /// pattern jumps along the face of a box, where the last digit would decide.
    pub(super) fn odd(&mut self, low: f64, high: f64) -> String {
        format!("{:.5}", self.r.number(low, high) + 0.000_37 + 0.000_01 * self.r.below(9) as f64)
    }

    /// A vector, sometimes as an expression.
    pub(super) fn vector(&mut self, low: f64, high: f64) -> String {
        if self.has_words && self.r.chance(15) {
            return match self.r.below(3) {
                0 => format!(
                    "Between({}, {}, {})",
                    self.r.vector(low, high),
                    self.r.vector(low, high),
                    self.unit()
                ),
                1 => format!("({low} + {:.3}*Way({}))", high - low, self.r.number(0.0, 0.8)),
                _ => format!(
                    "<{}, {}, {}>",
                    self.number(low, high),
                    self.number(low, high),
                    self.number(low, high)
                ),
            };
        }
        self.r.vector(low, high)
    }

    /// An opaque colour.
    pub(super) fn colour(&mut self) -> String {
        if self.has_words && self.r.chance(20) {
            return match self.r.below(4) {
                0 => format!("Tints[{}]", self.r.below(4)),
                1 => format!("color 0.5*Tints[{}] + 0.5*Tints[{}]", self.r.below(4), self.r.below(4)),
                2 => format!("rgb Way({})", self.r.number(0.0, 0.8)),
                _ => format!("rgb <{}, {}, {}>", self.unit(), self.unit(), self.unit()),
            };
        }
        let r = &mut self.r;
        match r.below(10) {
            0 => format!("srgb {}", r.vector(0.0, 1.0)),
            1 => format!("red {} green {}", r.number(0.0, 1.0), r.number(0.0, 1.0)),
            2 => format!("color rgb {}", r.number(0.0, 1.0)),
            _ => format!("rgb {}", r.vector(0.0, 1.0)),
        }
    }

    /// A colour that lets light pass.
    pub(super) fn clear(&mut self) -> String {
        let kind = self.r.choice(&["rgbf", "rgbt"]);
        let [red, green, blue] = [(); 3].map(|()| self.r.number(0.3, 1.0));
        match self.r.below(4) {
            0 => format!(
                "rgbft <{red}, {green}, {blue}, {}, {}>",
                self.r.number(0.1, 0.5),
                self.r.number(0.1, 0.5)
            ),
            1 => format!("{kind} 1"),
            _ => format!("{kind} <{red}, {green}, {blue}, {}>", self.r.number(0.4, 0.95)),
        }
    }
}
