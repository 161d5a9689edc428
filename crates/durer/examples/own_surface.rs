//! A surface of your own: a quartic by É. Goursat, rendered, traced and held to the laws.
//!
//! ```text
//! cargo run --release -p durer --example own_surface [-- PICTURE.png]
//! ```

use durer::geometry::Geometry;
use durer::math::{Aabb, Point3, Ray, Ring, Vec3};
use durer::render::film::Bits;
use durer::render::{Progress, RenderSettings, World, render};
use durer::scene::{Camera, Colour, Finish, Light, Object, Pigment, Rgb, Scene, Shape, Texture};
use durer::surfaces::laws::{Exact, Feature, ZeroOracle, check_many};
use durer::surfaces::{DynSurface, Polynomial, ZeroSet, ZeroSetError};
use std::error::Error;
use std::fs::File;

/// `x⁴ + y⁴ + z⁴ - 5 (x² + y² + z²) + c = 0`, a frame of tubes: É. Goursat, "Étude des surfaces qui
/// admettent tous les plans de symétrie d'un polyèdre régulier", *Annales scientifiques de l'École
/// Normale Supérieure* 4, 1887.
#[derive(Clone, Copy, Debug)]
struct Goursat {
    c: f64,
}

impl Polynomial<5> for Goursat {
    /// `x⁴ - 5 x² + c - 12.5 <= 0`, since `t² - 5 t >= -6.25`. That is false beyond 2.27 if `c >= 11.8`.
    fn bounds(&self) -> Aabb {
        Aabb::centred(Point3::ORIGIN, Vec3::new(2.27, 2.27, 2.27))
    }

    fn value<T: Ring>(&self, p: [T; 3], w: T) -> T {
        let [x, y, z] = p.map(T::square);
        let w = w.square();
        let fourth = x.clone().square() + y.clone().square() + z.clone().square();
        fourth - T::exact(5.0) * (x + y + z) * w.clone() + T::exact(self.c) * w.square()
    }

    fn name(&self) -> &'static str {
        "goursat"
    }
}

fn surface() -> Result<ZeroSet<Goursat, 5>, ZeroSetError> {
    ZeroSet::new(Goursat { c: 11.8 })
}

/// Traces a ray, tests the laws and renders a picture, of this width, as a PNG file.
pub(crate) fn run(width: u32, picture: &mut impl std::io::Write) -> Result<(), Box<dyn Error>> {
    // Traced: every crossing, each in its proven bracket.
    let mut builder = Geometry::builder();
    builder.add(surface()?);
    let geometry = builder.build()?;
    let ray = Ray::new(Point3::new(-5.0, 1.5, 1.25), Vec3::X);
    for hit in &geometry.all(&ray) {
        println!("{} in [{}, {}]", hit.t, hit.t_lo, hit.t_hi);
    }
    let spans = geometry.spans(&ray);
    println!("inside from {} to {}", spans[0].t_in, spans[0].t_out);

    // Held to the laws: rays at points where errors are likely, compared with exact arithmetic.
    let square = |k: usize, n: usize, c: f64| {
        let mut powers = [0; 3];
        powers[k] = n;
        (Exact::from(c), powers)
    };
    let mut terms: Vec<_> = (0..3).flat_map(|k| [square(k, 4, 1.0), square(k, 2, -5.0)]).collect();
    terms.push(square(0, 0, 11.8));
    let features =
        [[1.5, 1.5, 1.5], [1.5, 1.5, 0.0], [1.0, 1.0, 1.0]].map(|p| Feature::new(p, [0.0, 1.0, 1.0]));
    let tally = check_many(&surface()?, &ZeroOracle { terms, size: 2.0 }, &features, 1, 300);
    println!("{} rays keep the laws, with {} crossings", tally.rays, tally.roots);

    // Rendered.
    let red = Pigment::solid(Colour::opaque(Rgb::new(0.9, 0.3, 0.2)));
    let finish = Finish { specular: 0.5, ..Finish::default() };
    let shape = Shape::Own(DynSurface::new(surface()?));
    let scene = Scene {
        objects: vec![Object::new(shape).with_texture(Texture::plain(red, finish))],
        lights: vec![Light::point(Point3::new(-20.0, 30.0, -40.0), Rgb::WHITE)],
        camera: Some(Camera {
            location: Point3::new(4.0, 3.0, -7.0),
            direction: Vec3::new(-4.0, -3.0, 7.0),
            right: Vec3::new(7.0, 0.0, 4.0),
            up: Vec3::new(-12.0, 65.0, 21.0) * 0.116,
            ..Camera::default()
        }),
        ..Scene::default()
    };
    let settings = RenderSettings { width, height: width, ..RenderSettings::default() };
    let film = render(&World::new(&scene)?, &settings, &Progress::none())?.film;
    film.write_png(picture, Bits::Eight)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "own_surface.png".into());
    run(400, &mut File::create(path)?)
}
