//! Random scenes of textures, patterns, cameras, lights and atmosphere, written with variables,
//! functions, loops and macros. The shapes are plain, and stand apart.

mod numbers;
mod objects;
mod patterns;
mod pigments;
mod surfaces;
mod views;

use super::random::Random;
use super::tree::{Node, Scene};

/// Makes a scene.
struct Maker {
    r: Random,
    /// Whether numbers may be written with the variables, functions and macros of `numbers`.
    has_words: bool,
    /// Whether a surface has the look that is made. The sky and functions have no slope.
    is_on_surface: bool,
    /// Whether the look that is made may be shown at texture coordinates. There z is 0, the line of
    /// corners of `hexagon`, where the last digit decides which hexagon POV-Ray shows.
    is_at_uv: bool,
    /// Whether the surface that is made reaches far away. There the powers of the distance that shade
    /// the outside of fractals have no digits behind the point that are known.
    is_endless: bool,
    /// The names of declared pigments.
    pigments: Vec<String>,
    /// The number of the functions declared so far.
    functions: usize,
    /// What patterns and objects declare for their own use.
    declared: Vec<Node>,
}

/// Makes the scene with this number in a run.
pub(super) fn scene(seed: u64, number: u64) -> Scene {
    // Scenes of solids with the same numbers have other random numbers.
    let mut maker = Maker {
        r: Random::new(seed ^ 0x6C6F_6F6B_7300, number),
        has_words: false,
        is_on_surface: true,
        is_at_uv: false,
        is_endless: false,
        pigments: Vec::new(),
        functions: 0,
        declared: Vec::new(),
    };
    maker.scene()
}

impl Maker {
    fn scene(&mut self) -> Scene {
        let mut settings = vec![self.global_settings()];
        self.has_words = self.r.chance(60);
        if self.has_words {
            settings.extend(self.words());
        }
        let camera = self.camera();
        let lights = self.lights();
        for number in 0..self.r.below(3) {
            let mut made = self.off_surface(|m| m.at_uv(true, |m| m.pigment(2)));
            let name = format!("Paint{number}");
            made.open = format!("#declare {name} = {}", made.open);
            self.declared.push(made);
            self.pigments.push(name);
        }
        let mut later = self.sky();
        if self.r.chance(10) {
            let mut made = if self.r.chance(50) { self.finish() } else { self.pigment(1) };
            made.open = format!("#default {{ {}", made.open);
            made.close = "} }";
            // Lists of pigments would inherit these, and waves that blend them are not supported.
            made.said.retain(|node| {
                !["frequency", "phase"].iter().any(|word| node.open.starts_with(word))
                    && !node.open.contains("_wave")
            });
            later.push(made);
        }
        let mut objects = self.surroundings();
        for number in 0..2 + self.r.below(4) {
            objects.push(self.top(number));
        }
        let mut declared = std::mem::take(&mut self.declared);
        declared.extend(later);
        Scene { settings, camera, lights, declared, objects }
    }

    /// Makes a look for what is no surface.
    fn off_surface<T>(&mut self, make: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.is_on_surface, false);
        let made = make(self);
        self.is_on_surface = before;
        made
    }

    /// Makes a look that may be shown at texture coordinates.
    fn at_uv<T>(&mut self, may_be: bool, make: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.is_at_uv;
        self.is_at_uv |= may_be;
        let made = make(self);
        self.is_at_uv = before;
        made
    }

    fn global_settings(&mut self) -> Node {
        let mut words = vec!["assumed_gamma 1".to_owned()];
        if self.r.chance(15) {
            words.push(format!("max_trace_level {}", self.r.below(9) + 2));
        }
        if self.r.chance(8) {
            words.push(format!("ambient_light rgb {}", self.r.vector(0.2, 1.5)));
        }
        if self.r.chance(8) {
            words.push(format!("number_of_waves {}", self.r.below(12) + 1));
        }
        if self.r.chance(6) {
            words.push(format!("noise_generator {}", self.r.choice(&["1", "3"])));
        }
        Node::text(format!("global_settings {{ {} }}", words.join(" ")))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_parts_of_the_language_occur() {
        let all: Vec<String> = (0..1500).map(|n| super::scene(1, n).text()).collect();
        let words = "gradient radial onion leopard spherical cylindrical planar boxed spiral1 spiral2 quilted \
            mandel julia magnet square triangular hexagon brick checker cells crackle tiling function bozo \
            granite agate marble wood ripples waves wrinkles dents object slope aoi pigment_pattern average \
            color_map pigment_map texture_map normal_map slope_map bump_size facets turbulence black_hole \
            repeat toroidal planar cubic_wave poly_wave scallop_wave uv_mapping irid brilliance fresnel \
            conserve_energy metallic exponent emission albedo fisheye ultra_wide_angle omnimax panoramic \
            orthographic spherical spotlight parallel area_light circular orient adaptive looks_like \
            light_group projected_through fade_power background sky_sphere fog_type rainbow #macro #for \
            #while #switch #if array spline strlen substr val( str( concat rand( pigment { function";
        for word in words.split_whitespace() {
            let count = all.iter().filter(|text| text.contains(word)).count();
            assert!(count >= 5, "{word}: {count}");
        }
    }
}
