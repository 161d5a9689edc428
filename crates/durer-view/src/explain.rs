//! The ray of one pixel, as data for the page.

use crate::load::Stage;
use crate::session::Session;
use crate::source;
use durer_geometry::{Event, Explanation, Hit, Span};
use durer_math::{Point3, Ray, Vec3};
use durer_render::film::Encoding;
use durer_render::{PixelTracer, Progress, RayKind, RayTree, TracedRay};
use durer_scene::{Lowered, Place, Rgb};
use durer_surfaces::RootKind;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::time::Duration;

/// The most crossings that are listed.
const MOST_CROSSINGS: usize = 2000;
/// The maximum size of the explanation's text, in bytes.
const MOST_WORDS: usize = 200_000;

/// The most attempts for a ray, each cut short by a change of the picture.
const TRIALS: u32 = 20;

/// Everything about the ray through the middle of a pixel.
pub(crate) fn pixel(session: &Session, pixel: (u32, u32)) -> Result<Value, String> {
    for _ in 0..TRIALS {
        if let Some(value) = attempt(session, pixel)? {
            return Ok(value);
        }
        std::thread::sleep(Duration::from_millis(30));
    }
    Err("the picture changes all the time".to_owned())
}

/// One attempt of [`pixel`]; `None` if the picture changed meanwhile.
fn attempt(session: &Session, pixel: (u32, u32)) -> Result<Option<Value>, String> {
    let stage = &*session.stage();
    let ray = session.ray(&stage.world, pixel).ok_or("the scene has no camera")?;
    let lowered = stage.queries()?;
    let geometry = &lowered.geometry;
    let explanation = geometry.explain(&ray);
    let names = names(&explanation);
    let mut crossings = Vec::new();
    let has_more = geometry.masked(durer_geometry::EVERYTHING).any_where(&ray, |hit| {
        crossings.push(*hit);
        crossings.len() >= MOST_CROSSINGS
    });
    crossings.sort_by(Hit::order);
    let spans = if has_more { Vec::new() } else { geometry.spans(&ray) };
    // The only step that may take long: a change of the picture ends it.
    let stop = Progress::none().cancelled_by(&session.cancel);
    let tracer = PixelTracer::new(&stage.world, session.file.size(), stop);
    let Some(tree) = tracer.map_err(|e| e.to_string())?.ray_tree(pixel) else { return Ok(None) };
    let encoding = stage.world.encoding();
    let place = |hit: &Hit| source::place(&stage.scene, lowered, hit.object.0, hit.primitive.0);
    Ok(Some(json!({
        "pixel": [pixel.0, pixel.1],
        "ray": { "origin": point(ray.origin), "direction": vector(ray.direction), "length": ray.direction.length() },
        "hit": explanation.closest.as_ref().map(|hit| first_hit(stage, lowered, &ray, hit, &names)),
        "source": explanation.closest.as_ref().map_or(Value::Null, |hit| source::excerpt(stage, place(hit))),
        "crossings": crossings.iter().map(|hit| crossing(stage, hit, &names, place(hit))).collect::<Vec<_>>(),
        "more": has_more,
        "spans": spans.iter().map(span).collect::<Vec<_>>(),
        "tree": rays(stage, lowered, &tree, encoding),
        "words": words(&explanation),
    })))
}

/// The type of each surface that the search tested.
fn names(explanation: &Explanation) -> HashMap<(u32, u32), &'static str> {
    let tested = explanation.events.iter().filter_map(|event| match event {
        Event::Tested { surface, object, primitive, .. } => Some(((object.0, *primitive), *surface)),
        _ => None,
    });
    tested.collect()
}

fn words(explanation: &Explanation) -> String {
    let mut words = explanation.to_string();
    if words.len() > MOST_WORDS {
        let end = (0..=MOST_WORDS).rev().find(|i| words.is_char_boundary(*i)).unwrap_or(0);
        words.truncate(end);
        words.push_str("\n... `durer explain` prints the rest\n");
    }
    words
}

fn first_hit(
    stage: &Stage,
    lowered: &Lowered,
    ray: &Ray,
    hit: &Hit,
    names: &HashMap<(u32, u32), &'static str>,
) -> Value {
    let at = lowered.geometry.resolve(ray, hit);
    let place = source::place(&stage.scene, lowered, hit.object.0, hit.primitive.0);
    let mut value = crossing(stage, hit, names, place);
    let more = json!({
        "face": hit.face, "instance": hit.instance,
        "position": point(at.p), "bound": vector(at.dp),
        "normal": vector(at.ng.to_vec()), "shading": vector(at.ns.to_vec()), "uv": at.uv,
    });
    if let (Value::Object(value), Value::Object(more)) = (&mut value, more) {
        value.extend(more);
    }
    value
}

fn crossing(
    stage: &Stage,
    hit: &Hit,
    names: &HashMap<(u32, u32), &'static str>,
    place: Option<Place>,
) -> Value {
    // The parts of a compound solid are named by their keywords in the text.
    let name = names.get(&(hit.object.0, hit.primitive.0)).filter(|name| **name != "Compound");
    let name = name.map(|name| (*name).to_owned()).or_else(|| source::word(stage, place));
    let kind = match hit.kind {
        RootKind::Simple => "simple",
        RootKind::Grazing => "grazing",
        RootKind::Cluster => "cluster",
    };
    json!({
        "t": hit.t, "lo": hit.t_lo, "hi": hit.t_hi, "object": hit.object.0, "primitive": hit.primitive.0,
        "sign": hit.sign, "kind": kind, "surface": name, "line": source::line(stage, place),
    })
}

/// An end that is null lies at infinity.
fn span(span: &Span) -> Value {
    json!({
        "from": span.t_in, "to": span.t_out.is_finite().then_some(span.t_out),
        "entered": span.object_in.map(|o| o.0), "left": span.object_out.map(|o| o.0),
    })
}

fn rays(stage: &Stage, lowered: &Lowered, tree: &RayTree, encoding: Encoding) -> Value {
    let one = |ray: &TracedRay| {
        let kind = match ray.kind {
            RayKind::Camera => "camera",
            RayKind::Transmitted => "transmitted",
            RayKind::TotallyReflected => "totally reflected",
            RayKind::Reflected => "reflected",
        };
        // The surface's light without the part that comes from lights, up to rounding.
        let scattered = ray.shadows.iter().fold(Rgb::BLACK, |sum, s| sum + s.arrived);
        let own = (ray.light + scattered * -1.0).map(|x| if x.abs() < 1e-14 { 0.0 } else { x });
        let shadows = ray.shadows.iter().map(|s| {
            json!({
                "light": s.light, "target": point(s.target),
                "unblocked": colour(s.unblocked, encoding), "arrived": colour(s.arrived, encoding),
            })
        });
        json!({
            "parent": ray.parent, "kind": kind, "level": ray.level,
            "origin": point(ray.ray.origin), "direction": vector(ray.ray.direction),
            "hit": ray.hit.map(|(object, primitive, t, p)| json!({
                "object": object, "primitive": primitive, "t": t, "position": point(p),
                "distance": t * ray.ray.direction.length(),
                "line": source::line(stage, source::place(&stage.scene, lowered, object, primitive)),
            })),
            "factor": [ray.factor.r, ray.factor.g, ray.factor.b],
            "own": colour(own, encoding), "total": colour(ray.total, encoding),
            "shadows": shadows.collect::<Vec<_>>(),
        })
    };
    json!({
        "rays": tree.rays.iter().map(one).collect::<Vec<_>>(),
        "more": tree.has_more,
        "colour": colour(tree.colour, encoding),
    })
}

/// A colour in the scene's values, and as displayed.
fn colour(rgb: Rgb, encoding: Encoding) -> Value {
    let channels = [rgb.r, rgb.g, rgb.b];
    let [r, g, b] = channels.map(|v| (encoding.file(v) * 255.0 + 0.5) as u8);
    json!({ "rgb": channels, "hex": format!("#{r:02x}{g:02x}{b:02x}") })
}

fn point(p: Point3) -> Value {
    json!(p.to_array())
}

fn vector(v: Vec3) -> Value {
    json!(v.to_array())
}
