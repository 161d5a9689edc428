//! What a pixel can show besides its colour: measurements of the ray through its middle.

use crate::palette::{NOTHING, distinct, grey, heat};
use durer_geometry::{Event, Geometry};
use durer_math::{Ray, elementary};
use durer_surfaces::Need;

/// The quantity that the pixels show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Channel {
    /// The picture itself.
    #[default]
    Picture,
    /// The distance of the first hit.
    Depth,
    /// The normal of the first hit.
    Normal,
    /// The object of the first hit.
    Object,
    /// The texture coordinates of the first hit.
    Uv,
    /// The length of the bracket of the first hit.
    Bound,
    /// The steps that the search for the first hit takes.
    Steps,
    /// The number of separate intervals of the ray inside solids.
    Inside,
}

impl Channel {
    /// All channels, with their names in URLs.
    pub(crate) const ALL: [(Self, &str); 8] = [
        (Self::Picture, "picture"),
        (Self::Depth, "depth"),
        (Self::Normal, "normal"),
        (Self::Object, "object"),
        (Self::Uv, "uv"),
        (Self::Bound, "bound"),
        (Self::Steps, "steps"),
        (Self::Inside, "inside"),
    ];

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, n)| *n == name).map(|(channel, _)| *channel)
    }

    pub(crate) fn name(self) -> &'static str {
        Self::ALL.iter().find(|(c, _)| *c == self).map_or("picture", |(_, name)| name)
    }

    /// Measures a ray. Not for [`Channel::Picture`].
    pub(crate) fn measure(self, geometry: &Geometry, ray: &Ray) -> Measure {
        match self {
            Self::Steps => {
                let work = |e: &&Event| matches!(e, Event::Node { .. } | Event::Tested { .. });
                Measure::Number(geometry.explain(ray).events.iter().filter(work).count() as f64)
            }
            Self::Inside => Measure::Number(geometry.spans(ray).len() as f64),
            _ => self.first_hit(geometry, ray).unwrap_or(Measure::Nothing),
        }
    }

    fn first_hit(self, geometry: &Geometry, ray: &Ray) -> Option<Measure> {
        let hit = geometry.closest(ray)?;
        let length = ray.direction.length();
        let byte = |x: f64| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        Some(match self {
            Self::Depth => Measure::Number(hit.t * length),
            Self::Object => Measure::Values([f64::from(hit.object.0); 3], distinct(hit.object.0)),
            Self::Bound => Measure::Number((hit.t_hi - hit.t_lo) * length),
            Self::Normal => {
                let n = geometry.resolve(ray, &hit).ns.to_vec();
                let values = [n.x, n.y, n.z];
                Measure::Values(values, values.map(|c| byte(0.5 + 0.5 * c)))
            }
            _ => {
                let [u, v] = geometry.resolve_with(ray, &hit, Need::UV).uv;
                let part = |x: f64| if (0.0..=1.0).contains(&x) { x } else { x - x.floor() };
                Measure::Values([u, v, 0.0], [byte(part(u)), byte(part(v)), 64])
            }
        })
    }
}

/// A measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measure {
    /// The ray hits nothing.
    Nothing,
    /// A number, to be shown on a scale.
    Number(f64),
    /// Values, and the colour that shows them.
    Values([f64; 3], [u8; 3]),
}

impl Measure {
    /// The values for a file; `None` where nothing is hit.
    pub(crate) fn values(self) -> Option<[f64; 3]> {
        match self {
            Self::Nothing => None,
            Self::Number(x) => Some([x; 3]),
            Self::Values(values, _) => Some(values),
        }
    }
}

/// A number on the scale of its channel: logarithmic for bounds. An exact hit has a bracket of
/// length 0, which counts as a very small one.
fn on_scale(channel: Channel, x: f64) -> f64 {
    if channel == Channel::Bound { elementary::log10(x.max(1e-20)) } else { x }
}

/// The numbers at the two ends of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Scale {
    /// A scale for some measurements, without the most extreme hundredth at either end; `None` if
    /// there are no numbers among them.
    pub(crate) fn of(channel: Channel, measures: &[Measure]) -> Option<Self> {
        let number = |m: &Measure| match m {
            Measure::Number(x) => Some(on_scale(channel, *x)).filter(|x| x.is_finite()),
            _ => None,
        };
        let mut numbers: Vec<f64> = measures.iter().filter_map(number).collect();
        numbers.sort_by(f64::total_cmp);
        let at = |i: usize| numbers.get(i).copied();
        let cut = numbers.len() / 100;
        let (low, high) = (at(cut)?, at(numbers.len() - 1 - cut)?);
        Some(match channel {
            // Counts begin at zero.
            Channel::Steps | Channel::Inside => Self { low: 0.0, high: at(numbers.len() - 1)?.max(1.0) },
            _ => Self { low, high },
        })
    }

    /// The colour of a measurement.
    pub(crate) fn colour(this: Option<Self>, channel: Channel, measure: Measure) -> [u8; 3] {
        match measure {
            Measure::Nothing => NOTHING,
            Measure::Values(_, colour) => colour,
            Measure::Number(x) => {
                let at = on_scale(channel, x);
                let part = this.map_or(0.0, |s| (at - s.low) / (s.high - s.low).max(f64::MIN_POSITIVE));
                match channel {
                    Channel::Depth => grey(part),
                    Channel::Inside if x == 0.0 => NOTHING,
                    _ => heat(part),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::{Point3, Vec3};
    use durer_surfaces::Sphere;

    #[test]
    fn a_ray_through_two_balls_is_measured() {
        let mut builder = Geometry::builder();
        for z in [5.0, 9.0] {
            builder.add(Sphere::new(Point3::new(0.0, 0.0, z), 1.0).unwrap());
        }
        let geometry = builder.build().unwrap();
        let ray = Ray::new(Point3::ORIGIN, Vec3::new(0.0, 0.0, 2.0));
        let measure = |channel: Channel| channel.measure(&geometry, &ray);
        assert_eq!(measure(Channel::Depth), Measure::Number(4.0));
        assert_eq!(measure(Channel::Inside), Measure::Number(2.0));
        assert_eq!(measure(Channel::Object), Measure::Values([0.0; 3], distinct(0)));
        assert_eq!(measure(Channel::Normal), Measure::Values([0.0, 0.0, -1.0], [128, 128, 0]));
        assert!(matches!(measure(Channel::Bound), Measure::Number(x) if x < 1e-12));
        assert!(matches!(measure(Channel::Steps), Measure::Number(x) if x >= 2.0));
        let away = Ray::new(Point3::ORIGIN, Vec3::new(0.0, 0.0, -1.0));
        assert_eq!(Channel::Depth.measure(&geometry, &away), Measure::Nothing);
    }

    #[test]
    fn extremes_do_not_stretch_a_scale() {
        let mut measures: Vec<_> = (0..200).map(|i| Measure::Number(f64::from(i))).collect();
        measures.push(Measure::Number(1e300));
        measures.push(Measure::Nothing);
        let scale = Scale::of(Channel::Depth, &measures).unwrap();
        assert!(scale.high < 300.0);
        assert_eq!(Scale::of(Channel::Normal, &[Measure::Values([0.0; 3], [0; 3])]), None);
        assert_eq!(
            Scale::of(Channel::Bound, &[Measure::Number(1e-9)]),
            Some(Scale { low: -9.0, high: -9.0 })
        );
    }
}
