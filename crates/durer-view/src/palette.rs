//! Colours for numbers.

/// The colour of pixels whose ray hits nothing.
pub(crate) const NOTHING: [u8; 3] = [38, 42, 50];

/// Colours from dark to light for numbers from 0 to 1: nine equidistant colours of the map
/// *viridis* (S. van der Walt and N. Smith, 2015), in order of lightness for every kind of vision.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// The colour for a number from 0 to 1.
pub(crate) fn heat(x: f64) -> [u8; 3] {
    let x = if x > 0.0 { x.min(1.0) } else { 0.0 } * (VIRIDIS.len() - 1) as f64;
    let i = (x as usize).min(VIRIDIS.len() - 2);
    let part = x - i as f64;
    core::array::from_fn(|k| (VIRIDIS[i][k] + (VIRIDIS[i + 1][k] - VIRIDIS[i][k]) * part + 0.5) as u8)
}

/// The grey for a number from 0 (light, near) to 1 (dark, far).
pub(crate) fn grey(x: f64) -> [u8; 3] {
    let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
    [(245.0 - 205.0 * x + 0.5) as u8; 3]
}

/// A colour for an integer; neighbours differ clearly.
pub(crate) fn distinct(n: u32) -> [u8; 3] {
    // Steps by the golden angle spread the hues evenly, however many there are.
    let hue = (f64::from(n) * 0.618_033_988_749_895) % 1.0 * 6.0;
    let value = 0.95 - 0.12 * f64::from(n / 7 % 3);
    let saturation = 0.52 + 0.1 * f64::from(n / 3 % 3);
    let channel = |shift: f64| {
        let k = (shift + hue) % 6.0;
        let v = value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0);
        (v * 255.0 + 0.5) as u8
    };
    [channel(5.0), channel(3.0), channel(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_outside_the_range_have_the_colours_at_its_ends() {
        assert_eq!(heat(-1.0), heat(0.0));
        assert_eq!(heat(f64::NAN), heat(0.0));
        assert_eq!(heat(f64::INFINITY), [253, 231, 37]);
        assert_eq!((grey(-3.0), grey(9.0)), ([245; 3], [40; 3]));
    }

    #[test]
    fn neighbours_differ() {
        for n in 0..100 {
            let (a, b) = (distinct(n), distinct(n + 1));
            let apart: u32 = a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum();
            assert!(apart > 60, "{n}: {a:?} {b:?}");
        }
    }
}
