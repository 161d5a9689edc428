//! The volume of an object as a pattern.

use std::sync::Arc;

use durer_math::Point3;
use durer_scene::{Lowered, Object, Scene};

/// The volume of an object.
#[derive(Clone)]
pub(crate) struct Volume(Option<Arc<Lowered>>);

impl core::fmt::Debug for Volume {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Volume")
    }
}

impl PartialEq for Volume {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

impl Volume {
    /// The volume of an object; that of one which cannot be built is empty.
    pub(super) fn new(object: &Object) -> Self {
        let alone = Scene { objects: vec![object.clone()], ..Scene::default() };
        Self(alone.lower().ok().map(Arc::new))
    }

    /// 1 in the object or on it, 0 elsewhere.
    pub(super) fn value(&self, p: Point3) -> f64 {
        let holds = self.0.as_ref().is_some_and(|lowered| p.is_finite() && lowered.geometry.contains(p));
        f64::from(u8::from(holds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Shape;

    #[test]
    fn points_in_a_ball_have_the_value_one() {
        let ball = Object::new(Shape::Sphere { centre: Point3::new(1.0, 0.0, 0.0), radius: 0.5 });
        let volume = Volume::new(&ball);
        let at = |x: f64| volume.value(Point3::new(x, 0.0, 0.0));
        assert_eq!([0.0, 0.5, 1.2, 1.5, 1.6, f64::NAN].map(at), [0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    }
}
