//! `durer trace`: answers queries for an array of rays.

use crate::args::{Query, TraceArgs};
use crate::arrays::{NpzWriter, read_rays};
use crate::failure::Failure;
use crate::{input, output};
use durer::geometry::{Geometry, Hit, ObjectId, Ragged, Span};
use durer::math::Ray;
use durer::surfaces::{Need, SurfacePoint};
use rayon::prelude::*;

/// The number of rays in a step. The answers of one step are held in memory in addition to the
/// columns.
const STEP: usize = 1 << 16;
/// The value of `primitive` for a ray that misses.
const NO_PRIMITIVE: u32 = u32::MAX;
/// The value of `kind` for a ray that misses.
const NO_KIND: u8 = 255;

pub(crate) fn run(args: &TraceArgs) -> Result<(), Failure> {
    if args.output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("npz")) {
        return Err(Failure::Usage(format!("the output must end in .npz, got '{}'", args.output.display())));
    }
    input::with_threads(args.threads, || {
        // A scene may depend on the picture's size; this is the default size.
        let world = input::load(&args.scene, (800, 600))?.lower()?;
        let rays = read_rays(&args.rays).map_err(|e| Failure::file(&args.rays, e))?;
        let geometry = &world.geometry;
        output::write_whole(&args.output, |file| {
            let mut npz = NpzWriter::new(file);
            match args.query {
                Query::Closest => closest(geometry, &rays).write(&mut npz)?,
                Query::Any => npz.array("hit", None, geometry.batch(&rays).any())?,
                Query::All => all(geometry, &rays, &mut npz)?,
                Query::Spans => {
                    let found = spans(&rays, |step| geometry.batch(step).spans());
                    write_spans(&mut npz, &found, |span| *span)?;
                }
                Query::SpansByObject => {
                    let found = spans(&rays, |step| geometry.batch(step).spans_by_object());
                    write_spans(&mut npz, &found, |of| of.span)?;
                    npz.array("object", None, found.items.iter().map(|s| s.object.0 as i32).collect())?;
                }
            }
            npz.finish()
        })?;
        let invalid = rays.iter().filter(|ray| !ray.is_valid()).count();
        if invalid > 0 {
            eprintln!(
                "warning: {invalid} of {} rays are not finite, have no direction or an empty range: they miss",
                rays.len()
            );
        }
        Ok(())
    })
}

/// The answers of `closest` and `all`, one column for each.
#[derive(Default)]
struct Columns {
    t: Vec<f64>,
    t_lo: Vec<f64>,
    t_hi: Vec<f64>,
    object: Vec<i32>,
    primitive: Vec<u32>,
    uv: Vec<f64>,
    position: Vec<f64>,
    normal: Vec<f64>,
    kind: Vec<u8>,
}

impl Columns {
    fn push(&mut self, hit: Option<&(Hit, SurfacePoint)>) {
        let Some((hit, point)) = hit else {
            self.t.push(f64::INFINITY);
            self.t_lo.push(f64::INFINITY);
            self.t_hi.push(f64::INFINITY);
            self.object.push(-1);
            self.primitive.push(NO_PRIMITIVE);
            self.uv.extend([f64::NAN; 2]);
            self.position.extend([f64::NAN; 3]);
            self.normal.extend([f64::NAN; 3]);
            self.kind.push(NO_KIND);
            return;
        };
        self.t.push(hit.t);
        self.t_lo.push(hit.t_lo);
        self.t_hi.push(hit.t_hi);
        self.object.push(hit.object.0 as i32);
        self.primitive.push(hit.primitive.0);
        self.uv.extend(point.uv);
        self.position.extend(point.p.to_array());
        self.normal.extend(point.ng.to_array());
        self.kind.push(hit.kind as u8);
    }

    fn write(self, npz: &mut NpzWriter) -> std::io::Result<()> {
        npz.array("t", None, self.t)?;
        npz.array("t_lo", None, self.t_lo)?;
        npz.array("t_hi", None, self.t_hi)?;
        npz.array("object", None, self.object)?;
        npz.array("primitive", None, self.primitive)?;
        npz.array("uv", Some(2), self.uv)?;
        npz.array("position", Some(3), self.position)?;
        npz.array("normal", Some(3), self.normal)?;
        npz.array("kind", None, self.kind)
    }
}

/// The hit, together with its point.
fn resolved(geometry: &Geometry, ray: &Ray, hit: Hit) -> (Hit, SurfacePoint) {
    (hit, geometry.resolve_with(ray, &hit, Need::UV))
}

fn closest(geometry: &Geometry, rays: &[Ray]) -> Columns {
    let mut columns = Columns::default();
    for step in rays.chunks(STEP) {
        let hits = geometry.batch(step).closest();
        let points: Vec<_> = step
            .par_iter()
            .zip(hits)
            .with_min_len(256)
            .map(|(ray, hit)| hit.map(|hit| resolved(geometry, ray, hit)))
            .collect();
        points.iter().for_each(|hit| columns.push(hit.as_ref()));
    }
    columns
}

fn all(geometry: &Geometry, rays: &[Ray], npz: &mut NpzWriter) -> std::io::Result<()> {
    let (mut columns, mut sign, mut offsets) = (Columns::default(), Vec::new(), vec![0_u64]);
    for step in rays.chunks(STEP) {
        let hits = geometry.batch(step).all();
        let points: Vec<Vec<_>> = step
            .par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(i, ray)| hits.of(i).iter().map(|hit| resolved(geometry, ray, *hit)).collect())
            .collect();
        for of_ray in &points {
            for hit in of_ray {
                columns.push(Some(hit));
                sign.push(hit.0.sign);
            }
            offsets.push(sign.len() as u64);
        }
    }
    npz.array("offsets", None, offsets)?;
    columns.write(npz)?;
    npz.array("sign", None, sign)
}

/// The answers to all rays, asked step by step.
fn spans<T: Copy>(rays: &[Ray], ask: impl Fn(&[Ray]) -> Ragged<T>) -> Ragged<T> {
    let mut found = Ragged { offsets: vec![0], items: Vec::new() };
    for step in rays.chunks(STEP) {
        let spans = ask(step);
        for i in 0..step.len() {
            found.items.extend(spans.of(i));
            found.offsets.push(found.items.len() as u64);
        }
    }
    found
}

fn write_spans<T>(npz: &mut NpzWriter, found: &Ragged<T>, of: impl Fn(&T) -> Span) -> std::io::Result<()> {
    let spans = || found.items.iter().map(&of);
    let number = |id: Option<ObjectId>| id.map_or(-1, |id| id.0 as i32);
    npz.array("offsets", None, found.offsets.clone())?;
    npz.array("t_in", None, spans().map(|s| s.t_in).collect())?;
    npz.array("t_out", None, spans().map(|s| s.t_out).collect())?;
    npz.array("object_in", None, spans().map(|s| number(s.object_in)).collect())?;
    npz.array("object_out", None, spans().map(|s| number(s.object_out)).collect())
}
