//! A scene that was built: what rays meet, and what a picture needs.

use crate::batch::pool;
use crate::camera::Camera;
use crate::mesh::rows_of;
use crate::objects::{Object, point};
use crate::value_error;
use durer::geometry::Geometry;
use durer::mesh::Format;
use durer::pov::{Limits, ReadOptions};
use durer::render::film::Depth;
use durer::render::{AntiAliasing, Progress, Region, RenderSettings, World, render};
use durer::scene::{
    Background, Colour, Finish, Light, Object as SceneObject, Pigment, Rgb, Scene as SceneData, Shape,
    Texture,
};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// A built scene.
#[pyclass(frozen, module = "durer._native")]
pub(crate) struct Scene {
    data: SceneData,
    pub(crate) world: Arc<World>,
    warnings: Vec<String>,
    /// The texts that it was read from.
    files: Vec<PathBuf>,
}

/// Objects without a texture are light grey.
fn painted(mut object: SceneObject, grey: &Arc<Texture>) -> SceneObject {
    match &mut object.shape {
        Shape::Union(parts) if object.texture.is_none() => {
            let taken = std::mem::take(parts);
            *parts = taken.into_iter().map(|part| painted(part, grey)).collect();
        }
        _ if object.texture.is_none() => object.texture = Some(Arc::clone(grey)),
        _ => {}
    }
    object
}

fn build(py: Python<'_>, data: SceneData, mut warnings: Vec<String>) -> PyResult<Scene> {
    let pool = pool(0)?;
    let world = py.detach(|| pool.install(|| World::new(&data))).map_err(value_error)?;
    warnings.extend(world.warnings().iter().map(|(_, text)| text.clone()));
    Ok(Scene { data, world: Arc::new(world), warnings, files: Vec::new() })
}

/// A scene of objects. Lights: location and colour.
#[pyfunction]
fn scene(
    py: Python<'_>,
    objects: Vec<PyRef<'_, Object>>,
    camera: Option<PyRef<'_, Camera>>,
    lights: Vec<([f64; 3], [f64; 3])>,
    background: [f64; 3],
    max_trace_level: u32,
) -> PyResult<Scene> {
    let colour = Colour::opaque(Rgb::new(0.8, 0.8, 0.8));
    let grey = Arc::new(Texture::plain(Pigment::solid(colour), Finish::default()));
    let [r, g, b] = background;
    let mut data = SceneData {
        objects: objects.iter().map(|o| painted(o.0.clone(), &grey)).collect(),
        lights: lights
            .into_iter()
            .map(|(place, [r, g, b])| Light::point(point(place), Rgb::new(r, g, b)))
            .collect(),
        camera: camera.map(|c| c.data.clone()),
        background: Background(Colour::opaque(Rgb::new(r, g, b))),
        ..SceneData::default()
    };
    data.settings.max_trace_level = max_trace_level;
    build(py, data, Vec::new())
}

/// A scene in POV-Ray's language, or a mesh file with a camera that frames it and a light.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of a reader")]
fn load(
    py: Python<'_>,
    path: PathBuf,
    width: u32,
    height: u32,
    library_paths: Vec<PathBuf>,
    declares: Vec<(String, f64)>,
    clock: f64,
    limits: Vec<(String, u64)>,
) -> PyResult<Scene> {
    if Format::of(&path).is_some() {
        let model = py.detach(|| durer::mesh::read(&path)).map_err(value_error)?;
        let warnings = model.warnings.iter().map(ToString::to_string).collect();
        return Ok(Scene { files: vec![path], ..build(py, model.into_scene(width, height), warnings)? });
    }
    let mut known = Limits::default();
    for (name, value) in limits {
        if !known.set(&name, value) {
            let names = Limits::NAMES.join(", ");
            return Err(value_error(format!("limit '{name}': the limits are {names}")));
        }
    }
    let options = ReadOptions {
        library_paths,
        declares,
        clock,
        image_width: width,
        image_height: height,
        limits: known,
        ..ReadOptions::default()
    };
    let read = py.detach(|| durer::pov::read(&path, &options)).map_err(value_error)?;
    let warnings = read.messages.iter().map(|m| m.to_string().trim_end().to_owned()).collect();
    let pool = pool(0)?;
    let world = py.detach(|| pool.install(|| World::new(&read.scene)));
    let world = world.map_err(|e| match e {
        durer::render::WorldError::Lower(e) => value_error(read.sources.error(e.place, e.to_string())),
        other => value_error(other),
    })?;
    let files = read.sources.paths().map(Into::into).collect();
    let mut scene = Scene { data: read.scene, world: Arc::new(world), warnings, files };
    for (place, text) in scene.world.warnings() {
        scene.warnings.push(read.sources.error(*place, format!("warning: {text}")).to_string());
    }
    Ok(scene)
}

impl Scene {
    pub(crate) fn geometry(&self) -> &Geometry {
        self.world.geometry()
    }
}

#[pymethods]
impl Scene {
    #[getter]
    fn object_count(&self) -> usize {
        self.data.objects.len()
    }

    #[getter]
    fn primitive_count(&self) -> u64 {
        u64::try_from(self.geometry().inventory().placed).unwrap_or(u64::MAX)
    }

    #[getter]
    fn byte_count(&self) -> usize {
        self.geometry().inventory().bytes
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The texts that the scene was read from, in the order in which they were opened.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.files.clone()
    }

    /// The least and the greatest corner of a box around all that is bounded.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let bounds = self.geometry().bounds();
        rows_of(py, vec![bounds.min.to_array(), bounds.max.to_array()])
    }

    #[getter]
    fn camera(&self) -> Option<Camera> {
        self.data.camera.clone().map(|data| Camera { data })
    }

    #[getter]
    fn has_lights(&self) -> bool {
        !self.data.lights.is_empty()
    }

    /// The scene with another camera and more lights.
    fn seen_by(&self, py: Python<'_>, camera: &Camera, lights: Vec<([f64; 3], [f64; 3])>) -> PyResult<Self> {
        let mut data = self.data.clone();
        data.camera = Some(camera.data.clone());
        let more = lights.into_iter();
        data.lights.extend(more.map(|(at, [r, g, b])| Light::point(point(at), Rgb::new(r, g, b))));
        build(py, data, self.warnings.clone())
    }

    /// The colours of a picture as light, row by row.
    #[expect(clippy::too_many_arguments, reason = "the options of a picture")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        width: u32,
        height: u32,
        anti_aliasing: (String, f64, u32),
        region: Option<[u32; 4]>,
        threads: usize,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (name, threshold, depth) = anti_aliasing;
        let anti_aliasing = match &*name {
            "off" => AntiAliasing::Off,
            "method1" => AntiAliasing::Method1 { threshold, depth },
            "method2" => AntiAliasing::Method2 { threshold, depth },
            other => {
                return Err(value_error(format!(
                    "anti_aliasing must be 'off', 'method1' or 'method2', got '{other}'"
                )));
            }
        };
        let settings = RenderSettings {
            width,
            height,
            anti_aliasing,
            region: region.map(|[x0, y0, x1, y1]| Region { x0, y0, x1, y1 }),
            depth: Depth::Numbers,
            threads: None,
        };
        let pool = pool(threads)?;
        let cancel = AtomicBool::new(false);
        let raised: OnceLock<PyErr> = OnceLock::new();
        let progress = progress.map(Bound::unbind);
        let report = |status: &durer::render::Status| {
            Python::attach(|py| {
                let told = match &progress {
                    Some(f) => f.call1(py, (status.pixels_done, status.pixels)).map(|_| ()),
                    None => Ok(()),
                };
                if let Err(error) = told {
                    let _ = raised.set(error);
                    cancel.store(true, Ordering::Relaxed);
                }
            });
        };
        let world = &self.world;
        let rendered = py.detach(|| {
            let done = AtomicBool::new(false);
            std::thread::scope(|scope| {
                let (settings, cancel_ref, report, done_ref) = (&settings, &cancel, &report, &done);
                let has_progress = progress.is_some();
                let work = scope.spawn(move || {
                    let watch = Progress::none().cancelled_by(cancel_ref);
                    let watch = if has_progress { watch.reporting(report) } else { watch };
                    let rendered = pool.install(|| render(world, settings, &watch));
                    done_ref.store(true, Ordering::Release);
                    rendered
                });
                // Signals come to this thread.
                while !done.load(Ordering::Acquire) && !work.is_finished() {
                    std::thread::sleep(std::time::Duration::from_millis(5));
                    let signalled = Python::attach(|py| py.check_signals().err());
                    if let Some(error) = signalled {
                        let _ = raised.set(error);
                        cancel.store(true, Ordering::Relaxed);
                    }
                }
                work.join()
            })
        });
        if let Some(error) = raised.into_inner() {
            return Err(error);
        }
        let rendered = rendered.map_err(|_| value_error("the renderer stopped"))?.map_err(value_error)?;
        let film = rendered.film;
        let encoding = film.encoding();
        let light = film.pixels().map(|p| [p.rgb.r, p.rgb.g, p.rgb.b].map(|v| encoding.light(v))).collect();
        rows_of(py, light)
    }

    /// The bytes of the pixels of a picture as an 8-bit file holds them.
    #[staticmethod]
    fn bytes_of<'py>(
        py: Python<'py>,
        light: numpy::PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let bytes = light.as_array().iter().map(|&v| srgb_byte(v)).collect::<Vec<u8>>();
        let rows = light.as_array().nrows();
        numpy::PyArray1::from_vec(py, bytes).reshape([rows, 3])
    }
}

/// Light as the byte of an sRGB file.
fn srgb_byte(v: f64) -> u8 {
    let encoded = durer::render::film::Encoding::Linear.file(v.clamp(0.0, 1.0));
    (encoded * 255.0 + 0.5).floor().clamp(0.0, 255.0) as u8
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Scene>()?;
    module.add_function(wrap_pyfunction!(scene, module)?)?;
    module.add_function(wrap_pyfunction!(load, module)?)
}
