//! The camera and its moves.
//!
//! The camera turns about a *pivot*, a point of the scene, and about a fixed axis, the coordinate
//! axis nearest to the first camera's upward direction. So the horizon stays level. Moves keep the
//! lengths and the handedness of the camera's vectors.

use durer_math::{Affine, Point3, Vec3, elementary};
use durer_scene::{Camera, Projection};
use serde_json::Value;
use std::fmt::Write;

/// A move of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Move {
    /// Turns about the pivot: to the right and upwards, in radians.
    Orbit(f64, f64),
    /// Shifts the scene in the picture: to the right and downwards, in widths and heights of the
    /// picture.
    Pan(f64, f64),
    /// Changes the distance to the pivot by this factor.
    Zoom(f64),
    /// Turns towards the surface at a pixel, which becomes the pivot.
    LookAt(u32, u32),
    /// Goes back to the scene's own camera.
    Reset,
}

impl Move {
    /// Reads a move that a page sends.
    pub(crate) fn read(value: &Value) -> Option<Self> {
        let number = |name: &str, most: f64| {
            value.get(name)?.as_f64().filter(|x| x.is_finite()).map(|x| x.clamp(-most, most))
        };
        let pixel = |name: &str| u32::try_from(value.get(name)?.as_u64()?).ok();
        Some(match value.get("move")?.as_str()? {
            "orbit" => Self::Orbit(number("x", 7.0)?, number("y", 7.0)?),
            "pan" => Self::Pan(number("x", 10.0)?, number("y", 10.0)?),
            "zoom" => Self::Zoom(number("by", 100.0)?.max(0.01)),
            "look" => Self::LookAt(pixel("x")?, pixel("y")?),
            "reset" => Self::Reset,
            _ => return None,
        })
    }
}

/// A camera that turns about a point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rig {
    pub(crate) camera: Camera,
    pub(crate) pivot: Point3,
    axis: Vec3,
}

/// The view stays this far from the axis, in radians.
const POLE: f64 = 0.02;

impl Rig {
    /// The scene's camera, about `pivot`.
    pub(crate) fn new(camera: Camera, pivot: Point3) -> Self {
        let up = camera.up.to_array();
        let nearest = (0..3).max_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs())).unwrap_or(1);
        let mut axis = [0.0; 3];
        axis[nearest] = if up[nearest] < 0.0 { -1.0 } else { 1.0 };
        Self { camera, pivot, axis: Vec3::new(axis[0], axis[1], axis[2]) }
    }

    /// Applies a move that needs nothing but the camera. A move that would leave the numbers'
    /// range does nothing.
    pub(crate) fn apply(&mut self, how: Move) {
        let before = self.clone();
        match how {
            Move::Orbit(x, y) => self.orbit(x, y),
            Move::Pan(x, y) => self.pan(x, y),
            Move::Zoom(by) => self.zoom(by),
            Move::LookAt(..) | Move::Reset => {}
        }
        if !self.is_usable() {
            *self = before;
        }
    }

    fn is_usable(&self) -> bool {
        let c = &self.camera;
        let volume = c.direction.cross(c.up).dot(c.right);
        c.location.is_finite() && self.pivot.is_finite() && volume.is_finite() && volume != 0.0
    }

    /// Rotates the camera about the pivot.
    fn rotate(&mut self, axis: Vec3, angle: f64) {
        let Ok(turn) = Affine::rotation(axis, angle) else { return };
        self.camera.location = self.pivot + turn.vector(self.camera.location - self.pivot);
        for v in [&mut self.camera.direction, &mut self.camera.right, &mut self.camera.up] {
            *v = turn.vector(*v);
        }
    }

    /// The sign of the camera's handedness: +1 if right x up points away from the direction.
    fn hand(&self) -> f64 {
        let c = &self.camera;
        if c.right.cross(c.up).dot(c.direction) < 0.0 { 1.0 } else { -1.0 }
    }

    fn orbit(&mut self, x: f64, y: f64) {
        let hand = self.hand();
        self.rotate(self.axis, -x * hand);
        // The angle between the view and the axis changes by `y`, and stays off both poles.
        let d = self.camera.direction;
        let now = elementary::acos((d.dot(self.axis) / d.length()).clamp(-1.0, 1.0));
        let wanted = (now + y).clamp(POLE.min(now), (std::f64::consts::PI - POLE).max(now));
        self.rotate(self.camera.right, (now - wanted) * hand);
    }

    /// The distance of the pivot in units of the direction; 1 if it is not in front.
    fn depth(&self) -> f64 {
        let d = self.camera.direction;
        let t = (self.pivot - self.camera.location).dot(d) / d.dot(d);
        if t > 0.0 && t.is_finite() { t } else { 1.0 }
    }

    fn pan(&mut self, x: f64, y: f64) {
        let size = match self.camera.projection {
            Projection::Orthographic => 1.0,
            _ => self.depth(),
        };
        let by = self.camera.right * (-x * size) + self.camera.up * (y * size);
        self.camera.location = self.camera.location + by;
        self.pivot = self.pivot + by;
    }

    fn zoom(&mut self, by: f64) {
        match self.camera.projection {
            Projection::Orthographic => {
                self.camera.right = self.camera.right * by;
                self.camera.up = self.camera.up * by;
            }
            _ => self.camera.location = self.pivot + (self.camera.location - self.pivot) * by,
        }
    }

    /// Turns the camera towards `target`, which becomes the pivot.
    pub(crate) fn look_at(&mut self, target: Point3) {
        let before = self.clone();
        let c = &mut self.camera;
        self.pivot = target;
        match c.projection {
            Projection::Orthographic => {
                let away = target - c.location;
                let along = c.direction * (away.dot(c.direction) / c.direction.dot(c.direction));
                c.location = c.location + (away - along);
            }
            _ => {
                let hand = if c.right.cross(c.up).dot(c.direction) < 0.0 { 1.0 } else { -1.0 };
                let (long, wide, high) = (c.direction.length(), c.right.length(), c.up.length());
                let ahead = target - c.location;
                let side = ahead.cross(self.axis) * hand;
                if side.length() > 1e-9 * ahead.length() {
                    c.direction = ahead * (long / ahead.length());
                    c.right = side * (wide / side.length());
                    let up = c.right.cross(c.direction) * hand;
                    c.up = up * (high / up.length());
                }
            }
        }
        if !self.is_usable() {
            *self = before;
        }
    }

    /// The camera in the scene's language, with all digits.
    pub(crate) fn text(&self) -> String {
        let c = &self.camera;
        let kind = match &c.projection {
            Projection::Perspective => "perspective".to_owned(),
            Projection::Orthographic => "orthographic".to_owned(),
            Projection::Fisheye(angle) => format!("fisheye angle {}", angle.to_degrees()),
            Projection::UltraWideAngle(angle) => format!("ultra_wide_angle angle {}", angle.to_degrees()),
            Projection::Panoramic => "panoramic".to_owned(),
            Projection::Omnimax => "omnimax".to_owned(),
            Projection::Mesh(_) => "// mesh_camera, with the meshes of the scene".to_owned(),
            Projection::Spherical(across, high) => {
                format!("spherical angle {}, {}", across.to_degrees(), high.to_degrees())
            }
            Projection::Cylinder { angle, vertical, moving } => {
                let number = 1 + u32::from(!*vertical) + 2 * u32::from(*moving);
                format!("cylinder {number} angle {}", angle.to_degrees())
            }
        };
        let mut text = format!("camera {{\n  {kind}\n");
        let vectors =
            [("location", c.location.to_vec()), ("direction", c.direction), ("right", c.right), ("up", c.up)];
        for (name, v) in vectors {
            // Without negative zeros.
            let [x, y, z] = v.to_array().map(|c| if c == 0.0 { 0.0 } else { c });
            let _ = writeln!(text, "  {name} <{x}, {y}, {z}>");
        }
        if let Some(lens) = &c.lens {
            let focal_point = c.location + c.direction * (lens.focus / c.direction.length());
            let [x, y, z] = focal_point.to_array();
            let [fewest, most] = lens.samples;
            let _ = writeln!(text, "  aperture {} focal_point <{x}, {y}, {z}>", lens.aperture);
            let _ = writeln!(text, "  blur_samples {fewest}, {most}");
            let _ = writeln!(text, "  confidence {} variance {}", lens.confidence, lens.variance);
        }
        if c.normal.is_some() || c.lens.as_ref().is_some_and(|lens| lens.bokeh.is_some()) {
            text.push_str("  // with the normal and the bokeh of the scene's camera\n");
        }
        text.push('}');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig(projection: Projection) -> Rig {
        let location = Point3::new(0.0, 0.0, -5.0);
        Rig::new(Camera { projection, location, ..Camera::default() }, Point3::ORIGIN)
    }

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-12
    }

    #[test]
    fn orbiting_keeps_the_distance_and_the_pivot_in_the_middle() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut rig = rig(projection);
            for (x, y) in [(0.3, 0.2), (-1.0, 2.0), (0.1, -4.0), (2.0, 0.01)] {
                rig.apply(Move::Orbit(x, y));
                let to_pivot = rig.pivot - rig.camera.location;
                assert!((to_pivot.length() - 5.0).abs() < 1e-12);
                let ahead = rig.camera.direction * 5.0;
                assert!(near(to_pivot, ahead), "{to_pivot:?} {ahead:?}");
                assert!(rig.camera.right.y.abs() < 1e-12, "the horizon is level");
            }
        }
    }

    #[test]
    fn dragging_to_the_right_turns_the_scene_to_the_right() {
        let mut rig = rig(Projection::Perspective);
        rig.apply(Move::Orbit(0.1, 0.0));
        // A point in front of the pivot moves to the right in the picture.
        let p = Point3::new(0.0, 0.0, -1.0) - rig.camera.location;
        assert!(p.dot(rig.camera.right) > 0.0);
        rig.apply(Move::Orbit(0.0, 0.1));
        let p = Point3::new(0.0, 0.0, -1.0) - rig.camera.location;
        assert!(p.dot(rig.camera.up) < 0.0, "and dragging down turns its top towards the viewer");
        assert!(rig.camera.location.y > 0.0);
    }

    #[test]
    fn panning_by_the_whole_width_moves_the_pivot_to_the_side() {
        let mut rig = rig(Projection::Perspective);
        rig.apply(Move::Pan(0.5, 0.0));
        let away = Point3::ORIGIN - rig.camera.location;
        let depth = away.dot(rig.camera.direction);
        let px = away.dot(rig.camera.right) / rig.camera.right.dot(rig.camera.right) / depth;
        assert!((px - 0.5).abs() < 1e-12);
    }

    #[test]
    fn looking_at_a_point_puts_it_into_the_middle() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for mirrored in [false, true] {
                let projection = projection.clone();
                let mut rig = rig(projection);
                if mirrored {
                    rig.camera.right = -rig.camera.right;
                }
                let right = rig.camera.right;
                let target = Point3::new(1.0, 0.5, 2.0);
                rig.look_at(target);
                let away = target - rig.camera.location;
                assert!(near(away.cross(rig.camera.direction), Vec3::ZERO));
                assert!(rig.camera.right.dot(right) > 0.0, "it is not mirrored");
                assert!(rig.camera.up.y > 0.0);
            }
        }
    }

    #[test]
    fn wild_moves_leave_a_usable_camera() {
        let mut rig = rig(Projection::Perspective);
        for _ in 0..400 {
            rig.apply(Move::Zoom(100.0));
            rig.apply(Move::Pan(10.0, 10.0));
        }
        assert!(rig.is_usable());
        rig.look_at(rig.camera.location);
        assert!(rig.is_usable());
    }

    #[test]
    fn nonsense_is_no_move() {
        for text in
            ["{}", r#"{"move":"fly"}"#, r#"{"move":"orbit","x":1}"#, r#"{"move":"look","x":-1,"y":2}"#]
        {
            assert_eq!(Move::read(&serde_json::from_str(text).unwrap()), None, "{text}");
        }
    }

    #[test]
    fn the_text_gives_the_same_camera() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut rig = rig(projection);
            rig.apply(Move::Orbit(0.3, 0.2));
            rig.apply(Move::Zoom(0.7));
            let path = std::env::temp_dir().join(format!("durer-view-{}.pov", std::process::id()));
            let text = format!("#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\n{}\n", rig.text());
            std::fs::write(&path, text).unwrap();
            let read = durer_pov::read(&path, &durer_pov::ReadOptions::default()).unwrap();
            std::fs::remove_file(&path).unwrap();
            assert_eq!(read.scene.camera, Some(rig.camera));
        }
    }
}
