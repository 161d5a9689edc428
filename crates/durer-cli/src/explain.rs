//! `durer explain`: reports in words what happens to one ray.

use crate::args::ExplainArgs;
use crate::failure::Failure;
use crate::input;
use durer::math::Ray;
use durer::render::camera::Camera;
use durer::scene::Scene;
use std::path::Path;

pub(crate) fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let (width, height) = args.size.size();
    let loaded = input::load(&args.scene, (width, height))?;
    let ray = match (args.which.pixel, args.which.ray) {
        (Some((x, y)), _) if x >= width || y >= height => {
            return Err(Failure::Usage(format!("pixel {x},{y} is outside the picture of {width}x{height}")));
        }
        (Some((x, y)), _) => through_pixel(&args.scene.scene, loaded.scene(), (x, y), (width, height))?,
        (None, Some(ray)) => ray,
        (None, None) => return Err(Failure::Usage("either --pixel or --ray is needed".to_owned())),
    };
    let explanation = loaded.lower()?.geometry.explain(&ray);
    println!("{}", explanation.with_places(|object| loaded.place_of(object)));
    Ok(())
}

/// The ray through the centre of a pixel.
fn through_pixel(
    path: &Path,
    scene: &Scene,
    (x, y): (u32, u32),
    (width, height): (u32, u32),
) -> Result<Ray, Failure> {
    let camera = scene.camera.as_ref().ok_or_else(|| Failure::file(path, "the scene has no camera"))?;
    let camera = Camera::new(camera).map_err(|e| Failure::file(path, e))?;
    Ok(camera.pixel(x, y, width, height))
}
