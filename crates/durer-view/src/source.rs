//! The place in the scene's text that a primitive comes from.

use crate::load::Stage;
use durer_scene::{Lowered, Object, Place, Scene, Shape};
use serde_json::{Value, json};

/// The most lines that are shown around the place.
const AROUND: usize = 4;
/// The most characters of a line that are shown.
const MOST_CHARS: usize = 400;

/// The place of an object's primitive: that of its own statement within a union or other solid
/// where it is known, and otherwise that of the object.
pub(crate) fn place(scene: &Scene, lowered: &Lowered, object: u32, primitive: u32) -> Option<Place> {
    let whole = scene.objects.get(object as usize)?;
    let mut search = Search { wanted: u64::from(primitive), count: 0, found: None };
    search.walk(whole, whole.place);
    // Primitives are numbered in the order of the text. If some shape has another number of
    // primitives than counted here, nothing is known about its neighbours.
    if search.count == u64::from(lowered.primitives(object)) { search.found } else { None }.or(whole.place)
}

/// The line of a place and the lines around it, with the word to underline; null if the scene is no
/// text.
pub(crate) fn excerpt(stage: &Stage, place: Option<Place>) -> Value {
    let located = place.and_then(|place| stage.origin.text.as_ref()?.locate(place));
    let Some(at) = located else { return Value::Null };
    let first = at.line.saturating_sub(AROUND).max(1);
    let lines = at.text.lines().skip(first - 1).take(at.line - first + 1 + AROUND);
    let lines: Vec<String> = lines.map(|line| line.chars().take(MOST_CHARS).collect()).collect();
    let name = at.path.file_name().unwrap_or_default().to_string_lossy();
    json!({
        "file": name, "line": at.line, "column": at.column, "length": at.length.max(1),
        "first": first, "lines": lines,
    })
}

/// The line of a place, counted from 1; with the file's name if that is an included one:
/// `shapes.inc:12`.
pub(crate) fn line(stage: &Stage, place: Option<Place>) -> Option<String> {
    let at = stage.origin.text.as_ref()?.locate(place?)?;
    if at.path == stage.origin.path {
        return Some(at.line.to_string());
    }
    let name = at.path.file_name().unwrap_or_default().to_string_lossy();
    Some(format!("{name}:{}", at.line))
}

/// The word at a place.
pub(crate) fn word(stage: &Stage, place: Option<Place>) -> Option<String> {
    let at = stage.origin.text.as_ref()?.locate(place?)?;
    let line = at.text.lines().nth(at.line - 1)?;
    Some(line.chars().skip(at.column - 1).take(at.length.min(MOST_CHARS)).collect())
}

struct Search {
    wanted: u64,
    count: u64,
    found: Option<Place>,
}

impl Search {
    fn walk(&mut self, object: &Object, around: Option<Place>) {
        let place = object.place.or(around);
        match &object.shape {
            Shape::Union(parts) | Shape::Csg(_, parts) => {
                for part in parts {
                    self.walk(part, place);
                }
            }
            Shape::Mesh(mesh) => self.take(mesh.faces.len() as u64, place),
            _ => self.take(1, place),
        }
    }

    fn take(&mut self, primitives: u64, place: Option<Place>) {
        if (self.count..self.count + primitives).contains(&self.wanted) {
            self.found = place;
        }
        self.count += primitives;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Point3;
    use durer_scene::Operation;

    #[test]
    fn the_parts_of_a_solid_have_their_own_places() {
        let ball = |x: f64, start: u32| {
            let centre = Point3::new(x, 0.0, 0.0);
            let mut object = Object::new(Shape::Sphere { centre, radius: 1.0 });
            object.place = Some(Place { file: 0, start });
            object
        };
        let inner = Object::new(Shape::Csg(Operation::Difference, vec![ball(0.0, 20), ball(0.5, 30)]));
        let mut whole = Object::new(Shape::Union(vec![inner, ball(5.0, 40)]));
        whole.place = Some(Place { file: 0, start: 10 });
        let scene = Scene { objects: vec![whole], ..Scene::default() };
        let lowered = scene.lower().unwrap();
        let start = |primitive| place(&scene, &lowered, 0, primitive).map(|p| p.start);
        assert_eq!([0, 1, 2, 3].map(start), [Some(20), Some(30), Some(40), Some(10)]);
        assert_eq!(place(&scene, &lowered, 1, 0), None);
    }

    #[test]
    fn the_word_of_a_place_is_shown_in_its_line() {
        let path = std::env::temp_dir().join(format!("durer-view-source-{}.pov", std::process::id()));
        let text = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\nunion {\n  sphere { 0, 1 }\n  box { -1, 1 translate 5*x }\n}\n";
        std::fs::write(&path, text).unwrap();
        let stage = crate::SceneFile::new(&path, durer_pov::ReadOptions::default()).load().unwrap();
        std::fs::remove_file(&path).unwrap();
        let lowered = stage.queries().unwrap();
        let place = place(&stage.scene, lowered, 0, 1);
        let shown = excerpt(&stage, place);
        assert_eq!((&shown["line"], &shown["column"], &shown["length"]), (&json!(5), &json!(3), &json!(3)));
        assert_eq!(
            shown["lines"][(5 - shown["first"].as_u64().unwrap()) as usize],
            "  box { -1, 1 translate 5*x }"
        );
        assert_eq!((word(&stage, place).as_deref(), line(&stage, place)), (Some("box"), Some("5".into())));
        assert_eq!(excerpt(&stage, None), Value::Null);
    }

    #[test]
    fn a_line_of_an_included_file_has_its_name() {
        let folder = std::env::temp_dir().join(format!("durer-view-lines-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("ball.inc"), "// A ball.\nsphere { 0, 1 }\n").unwrap();
        let text =
            "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#include \"ball.inc\"\nbox { 2, 3 }\n";
        let path = folder.join("scene.pov");
        std::fs::write(&path, text).unwrap();
        let stage = crate::SceneFile::new(&path, durer_pov::ReadOptions::default()).load().unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        let lowered = stage.queries().unwrap();
        let lines = [0, 1].map(|object| line(&stage, place(&stage.scene, lowered, object, 0)).unwrap());
        assert_eq!(lines, ["ball.inc:2", "4"]);
    }
}
