//! The functions that functions.inc gives names to, by their numbers.
//!
//! Each is written as on paper; `P0`, `P1`, ... are the parameters after `x`, `y`, `z`. The
//! formulas were found from the manual's descriptions, the surfaces' known equations and POV-Ray's
//! values (`tests/functions.rs` contains some of these). They agree with POV-Ray to 1e-9 (the
//! rounded box to 1e-6, by which POV-Ray's is larger than its description).

mod fractal;
mod pen;
pub(crate) mod pieces;

use durer_formula::noise::NoiseTable;
use durer_formula::{Formula, Op};
use durer_scene::NoiseGenerator;
use pen::Pen;

pub(crate) use fractal::PLAIN as PLAIN_NOISE;

/// Why a number has no formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lacking {
    /// There is no function with this number.
    Unknown,
    /// The formula of the function is not available, for this reason.
    NotYet(&'static str),
}

/// How a formula's value becomes the function's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kept {
    /// It is the function's value.
    Plain,
    /// It is a field: it is multiplied by the strength `P0` and clamped to `[-10, 10]`.
    Field,
    /// It is a field that is clamped to `[-P1, P1]`.
    Limited,
}
use Kept::{Field, Limited, Plain};

/// A row: the function's number, the number of its parameters after `x`, `y`, `z`, the use of its
/// value, and its formula.
type Row = (u32, u32, Kept, &'static str);

/// `u(switch, offset, angle)` and `v(switch, offset, angle)` are the coordinates of a plane curve:
/// `x` and `y`, or if the switch is above zero, those of a section through the y axis, shifted by
/// the offset and rotated by the angle, so that the curve is revolved. `section(a, b, type)` is the
/// distance from the axis of a tube with the given cross-section: 0 a square, 1 a circle, 2 a
/// diamond, 3 a star, and all shapes between.
const TABLE: &[Row] = &[
    // f_algbr_cyl1
    (0, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); b*b + cube(abs(a)) - a*a"),
    // f_algbr_cyl2
    (
        1,
        5,
        Limited,
        "a = u(P2, P3, P4); b = v(P2, P3, P4); -(2*sq(a*a) - 3*a*a*b + b*b - 2*cube(b) + sq(b*b))",
    ),
    // f_algbr_cyl3
    (2, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); -(sq(a*a) + a*a*b*b - 2*a*a*b - a*b*b + b*b)"),
    // f_algbr_cyl4
    (3, 5, Limited, "a = u(P2, P3, P4); b = v(P2, P3, P4); -(sq(a*a + b*b) + 3*a*a*b - cube(b))"),
    // f_bicorn
    (4, 2, Field, "-(sq(x*x + z*z + 2*P1*y - P1*P1) - y*y*(P1*P1 - x*x - z*z))"),
    // f_bifolia
    (5, 2, Field, "-(sq(x*x + y*y + z*z) - P1*(x*x + z*z)*y)"),
    // f_blob
    (
        6,
        5,
        Plain,
        "r = y*y + z*z; a = max(1 - sq(P2)*(sq(x + P0/2) + r), 0); b = max(1 - sq(P4)*(sq(x - P0/2) + r), 0); -(P1*a*a + P3*b*b)",
    ),
    // f_blob2
    (7, 4, Plain, "r = y*y + z*z; P3 - P2*(exp(-P1*(x*x + r)) + exp(-P1*(sq(x - P0) + r)))"),
    // f_boy_surface
    (
        8,
        2,
        Field,
        "w = 1 - z; r = x*x + y*y; k = sqrt(2); \
         P1*(64*cube(w)*cube(z) - 48*w*w*z*z*(3*r + 2*z*z) + 12*w*z*(27*r*r - 24*z*z*r + 36*k*y*z*(y*y - 3*x*x) + 4*sq(z*z)) + (9*r \
         - 2*z*z)*(-81*r*r - 72*z*z*r + 108*k*x*z*(x*x - 3*y*y) + 4*sq(z*z)))",
    ),
    // f_cross_ellipsoids
    (
        10,
        4,
        Plain,
        "P3 - P2*exp(max(-P1*(x*x + P0*(y*y + z*z)), -P1*(y*y + P0*(x*x + z*z)), -P1*(z*z + P0*(x*x + y*y))))",
    ),
    // f_crossed_trough
    (11, 1, Field, "x*x*z*z - y"),
    // f_cubic_saddle
    (12, 1, Field, "-(x*x*x - y*y*y - z)"),
    // f_cushion
    (13, 1, Field, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    // f_devils_curve
    (14, 1, Field, "-(sq(x*x + z*z) - 0.36*x*x - sq(y*y) + 0.25*y*y)"),
    // f_devils_curve_2d
    (15, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b*(P2*P2 - b*b) - a*a*(P1*P1 - a*a))"),
    // f_dupin_cyclid: as in POV-Ray, no longer a cyclide if displaced along y
    (
        16,
        6,
        Field,
        "k = P5*P5; s = x*x + y*y + z*z; m = P3*P3 + P4*P4 + P1*P1 - P2*P2; \
         -(sq(k*k - 2*k*(P3*x + P4*y) + m*s) - 4*P1*P1*(sq(k*x - P3*s) + sq(k*z)) \
         + 8*k*(P1*P1 - P2*P2)*P4*y*s)",
    ),
    // f_ellipsoid
    (17, 3, Plain, "sqrt(sq(x*P0) + sq(y*P1) + sq(z*P2))"),
    // f_enneper: the divisor is never near zero
    (
        18,
        1,
        Field,
        "w = select(abs(z) - 0.2, 0.2, z, z); d = y*y - x*x; -(cube(d/(2*w) + 2*z*z/9) - 6*sq(d/(4*w)))",
    ),
    // f_flange_cover
    (
        19,
        4,
        Plain,
        "P3 - P2*(exp(-P1*(x*x + P0*(y*y + z*z))) + exp(-P1*(y*y + P0*(x*x + z*z))) + exp(-P1*(z*z + P0*(x*x + y*y))))",
    ),
    // f_folium_surface
    (20, 3, Field, "(y*y + z*z)*(1 + x*(P2 - 4*P1)) + x*x*(1 + P2)"),
    // f_folium_surface_2d
    (21, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b*(1 + a*(P2 - 4*P1)) + a*a*(1 + P2))"),
    // f_glob
    (22, 1, Field, "-(y*y + z*z - 0.5*sq(x*x)*x - 0.5*sq(x*x))"),
    // f_heart
    (23, 1, Field, "-(cube(2*x*x + y*y + z*z - 1) - 0.1*x*x*cube(z) - y*y*cube(z))"),
    // f_helix1
    (
        25,
        7,
        Plain,
        "r = sqrt(x*x + z*z); t = (atan2(z, x) + P1*y)*P0/(2*pi); a = r - P3; b = (t - floor(t) - 0.5)*2*pi/(P0*P1*P4); \
         c = cos(P6*pi/180); s = sin(P6*pi/180); min(section(a*c - b*s, a*s + b*c, P5), r + P3) - P2",
    ),
    // f_helix2
    (26, 7, Plain, "a = P1*y; section(x*cos(a) + z*sin(a) - P3, z*cos(a) - x*sin(a), P5) - P2"),
    // f_hex_x
    (
        27,
        1,
        Plain,
        "h = sqrt(0.75); i = x - 2*h*floor(x/(2*h) + 0.5); j = y - 3*floor(y/3 + 0.5); k = x - h*(2*floor(x/(2*h)) + 1); \
         l = y - 3*floor(y/3) - 1.5; m = max(abs(i), abs(i)/2 + h*abs(j)); n = max(abs(k), abs(k)/2 + h*abs(l)); min(m, n)",
    ),
    // f_hex_y
    (
        28,
        1,
        Plain,
        "h = sqrt(0.75); i = x - 2*h*floor(x/(2*h) + 0.5); j = y - 3*floor(y/3 + 0.5); k = x - h*(2*floor(x/(2*h)) + 1); \
         l = y - 3*floor(y/3) - 1.5; m = max(abs(i), abs(i)/2 + h*abs(j)); n = max(abs(k), abs(k)/2 + h*abs(l)); \
         a = select(m - n, abs(i), abs(k), abs(k)); b = select(m - n, abs(j), abs(l), abs(l)); \
         select(a/2 - h*b, abs(h*a - b/2), b, b)",
    ),
    // f_hunt_surface
    (30, 1, Field, "-(4*cube(x*x + y*y + z*z - 13) + 27*sq(3*x*x + y*y - 4*z*z - 12))"),
    // f_hyperbolic_torus
    (31, 3, Field, "-(sq(x*x + y*y - z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x - z*z))"),
    // f_isect_ellipsoids
    (
        32,
        4,
        Plain,
        "P3 - P2*exp(min(-P1*(x*x + P0*(y*y + z*z)), -P1*(y*y + P0*(x*x + z*z)), -P1*(z*z + P0*(x*x + y*y))))",
    ),
    // f_kampyle_of_eudoxus
    (33, 3, Field, "-(y*y + z*z - P2*P2*sq(x*x) + P2*P2*P1*P1*x*x)"),
    // f_kampyle_of_eudoxus_2d
    (34, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(b*b - P2*P2*a*a*(a*a - P1*P2))"),
    // f_klein_bottle
    (
        35,
        1,
        Field,
        "-((x*x + y*y + z*z + 2*y - 1)*(sq(x*x + y*y + z*z - 2*y - 1) - 8*z*z) + 16*x*z*(x*x + y*y + z*z - 2*y - 1))",
    ),
    // f_kummer_surface_v1
    (36, 1, Field, "-(sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z - x*x*y*y - y*y*z*z - z*z*x*x + 1)"),
    // f_kummer_surface_v2
    (
        37,
        4,
        Field,
        "-(sq(x*x) + sq(y*y) + sq(z*z) + P1*(x*x + y*y + z*z) + P2*(x*x*y*y + x*x*z*z + y*y*z*z) + P3*x*y*z - 1)",
    ),
    // f_lemniscate_of_gerono
    (38, 1, Field, "-(sq(x*x) - x*x + y*y + z*z)"),
    // f_lemniscate_of_gerono_2d
    (39, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(P2*P2*a*a*(a*a - P1*P1) + b*b)"),
    // f_mesh1
    (
        40,
        5,
        Plain,
        "i = floor(x/P0); j = floor(z/P1); a = P3*cos(pi*z/P1)*cos(pi*i); b = P3*cos(pi*x/P0)*cos(pi*j); \
         sqrt(min(sq(P2*(x - i*P0)) + sq(P4*(y + a)), sq(P2*(x - (i + 1)*P0)) + sq(P4*(y - a)), sq(P2*(z - j*P1)) + sq(P4*(y - b)), \
         sq(P2*(z - (j + 1)*P1)) + sq(P4*(y + b))))",
    ),
    // f_mitre
    (41, 1, Field, "-(4*x*x*(x*x + y*y + z*z) - y*y*(1 - y*y - z*z))"),
    // f_nodal_cubic
    (42, 1, Field, "-(cube(y) + cube(z) - 6*y*z)"),
    // f_odd
    (43, 1, Field, "x*x + y*y - 2*z*z + 2*z*z*z - sq(z*z) + 2*y*y*z - y*y*z*z + x*x*z*z - sq(x*x + y*y)"),
    // f_ovals_of_cassini
    (44, 4, Field, "-(sq(x*x + y*y + z*z + P1*P1) - P3*P1*P1*(x*x + z*z) - P2*P2)"),
    // f_paraboloid
    (45, 1, Field, "y - x*x - z*z"),
    // f_parabolic_torus
    (46, 3, Field, "c = P1*P1 - P2*P2; -(sq(x*x + y*y - z) - (P1*P1 + P2*P2)*(x*x - z) + c*y*y + c*c)"),
    // f_ph
    (47, 0, Plain, "atan2(sqrt(x*x + z*z), y)"),
    // f_pillow
    (48, 1, Field, "sq(x*x) + sq(y*y) + sq(z*z) - x*x - y*y - z*z"),
    // f_piriform
    (49, 1, Field, "sq(x*x) - cube(x) + y*y + z*z"),
    // f_piriform_2d
    (50, 7, Field, "a = u(P4, P5, P6); b = v(P4, P5, P6); -(b*b - P3*P3*cube(a)*(P1 + P2*a))"),
    // f_poly4
    (51, 5, Plain, "sqrt(x*x + z*z) - (P0 + P1*y + P2*y*y + P3*cube(y) + P4*sq(y*y))"),
    // f_polytubes
    (
        52,
        6,
        Plain,
        "p = P1 + P2*y + P3*y*y + P4*cube(y) + P5*sq(y*y); t = (atan2(x, z) + select(p, pi, 0, 0))*P0/(2*pi); \
         d = (t - floor(t + 0.5))*2*pi/P0; r = sqrt(x*x + z*z); sqrt(max(sq(r - abs(p)) + 4*r*abs(p)*sq(sin(d/2)), 0))",
    ),
    // f_quantum
    (53, 1, Plain, "1.2 - 1.6*exp(-1.33333332*sqrt(x*x + y*y + z*z))*sq(2*y*y - x*x - z*z)"),
    // f_quartic_paraboloid
    (54, 1, Field, "y - sq(x*x) - sq(z*z)"),
    // f_quartic_saddle
    (55, 1, Field, "y - sq(x*x) + sq(z*z)"),
    // f_quartic_cylinder
    (56, 3, Field, "-((x*x + z*z)*y*y + P2*P2*(x*x + z*z) - P1*P1*P2*P2)"),
    // f_r
    (57, 0, Plain, "sqrt(x*x + y*y + z*z)"),
    // f_rounded_box
    (
        60,
        4,
        Plain,
        "sqrt(sq(max(abs(x) - (P1 - P0), 0)) + sq(max(abs(y) - (P2 - P0), 0)) + sq(max(abs(z) - (P3 - P0), 0))) - P0",
    ),
    // f_sphere
    (61, 1, Plain, "sqrt(x*x + y*y + z*z) - P0"),
    // f_spikes
    (
        62,
        5,
        Plain,
        "P2*(exp(-P1*(x*x + P0*(y*y + z*z))) + exp(-P1*(y*y + P0*(x*x + z*z))) + exp(-P1*(z*z + P0*(x*x + y*y))) - P4*exp(-P3*(x*x + y*y + z*z)))",
    ),
    // f_spikes_2d
    (63, 4, Plain, "y - P0*cos(P1*x)*cos(P2*z)*exp(-P3*(x*x + z*z))"),
    // f_spiral
    (
        64,
        6,
        Plain,
        "r = sqrt(x*x + z*z); m = sqrt(x*x + y*y + z*z); t = r/P0 + atan2(z, x)/(2*pi) + 0.5; d = (t - floor(t))*P0; \
         w = select(r - d, m, section(d, y, P5), section(d, y, P5)); max(min(m, section(P0 - d, y, P5), w) - P1, m - P2)",
    ),
    // f_steiners_roman
    (65, 1, Field, "-(x*x*y*y + x*x*z*z + y*y*z*z + x*y*z)"),
    // f_strophoid
    (66, 4, Field, "(x - P2)*(y*y + z*z) + P3*P3*x*x*(P1 + x)"),
    // f_strophoid_2d
    (67, 7, Field, "a = u(P4, P5, P6); b = v(P4, P5, P6); (a - P2)*b*b + P3*P3*a*a*(P1 + a)"),
    // f_superellipsoid
    (68, 2, Plain, "1 - pow(pow(pow(abs(x), 2/P0) + pow(abs(y), 2/P0), P0/P1) + pow(abs(z), 2/P1), P1/2)"),
    // f_th
    (69, 0, Plain, "atan2(x, z)"),
    // f_torus
    (70, 2, Plain, "sqrt(sq(sqrt(x*x + z*z) - P0) + y*y) - P1"),
    // f_torus2
    (71, 3, Field, "-(sq(x*x + y*y + z*z + P1*P1 - P2*P2) - 4*P1*P1*(x*x + z*z))"),
    // f_torus_gumdrop
    (72, 1, Field, "-(4*(sq(x*x) + sq(y*y + z*z)) + 17*x*x*(y*y + z*z) - 20*(x*x + y*y + z*z) + 17)"),
    // f_umbrella
    (73, 1, Field, "y*z*z - x*x"),
    // f_witch_of_agnesi
    (74, 2, Field, "-(P1*(y - 1) + (x*x + z*z)*y)"),
    // f_witch_of_agnesi_2d
    (75, 6, Field, "a = u(P3, P4, P5); b = v(P3, P4, P5); -(P1*P1*b + a*a*b - P2)"),
];

/// The number of a function that is made of noise. [`check`] checks its arguments.
pub(crate) type Noisy = u32;

/// Checks the arguments of a call of a noise function. `None` stands for an argument that the call
/// does not give as a number.
pub(crate) fn check(function: Noisy, arguments: &[Option<f64>]) -> Result<(), String> {
    fractal::check(function, arguments)
}

/// The formula of `internal(number)`. `generator` is for noise functions that do not state one, `rows`
/// the table of the third generator.
pub(crate) fn internal(
    number: f64,
    generator: NoiseGenerator,
    rows: &'static NoiseTable,
) -> Result<(Formula, Option<Noisy>), Lacking> {
    if let Some(formula) = fractal::internal(number, generator, rows) {
        let noisy = (number != PLAIN_NOISE).then_some(number as Noisy);
        return Ok((formula, noisy));
    }
    let Some(row) = TABLE.iter().find(|row| f64::from(row.0) == number) else {
        let known = number.fract() == 0.0 && (0.0..=78.0).contains(&number);
        return Err(if known { Lacking::NotYet("durer has no formula for it") } else { Lacking::Unknown });
    };
    let formula = written(row).ok_or(Lacking::NotYet("durer has no formula for it"))?;
    Ok((formula, None))
}

/// A formula as on paper, of `x`, `y`, `z` and this many parameters; `None` if it cannot be read.
pub(crate) fn on_paper(text: &'static str, parameters: u32) -> Option<Formula> {
    written(&(0, parameters, Plain, text))
}

fn written(&(_, parameters, kept, text): &Row) -> Option<Formula> {
    let mut pen = Pen::new(text);
    let mut root = pen.formula()?;
    if kept != Plain {
        let strength = pen.parameter(0)?;
        root = pen.push(Op::Mul(strength, root))?;
        let high = if kept == Field { pen.constant(10.0)? } else { pen.parameter(1)? };
        let low = pen.push(Op::Neg(high))?;
        root = pen.push(Op::Max(root, low))?;
        root = pen.push(Op::Min(root, high))?;
    }
    pen.finished(root, 3 + parameters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_can_be_read() {
        for row in TABLE {
            let formula = written(row).unwrap_or_else(|| panic!("{row:?}"));
            assert_eq!(formula.inputs(), 3 + row.1);
            let value = formula
                .value(&[0.3, 0.2, 0.4, 1.5, 0.7, 0.6, 0.5, 0.8, 0.9, 1.1][..formula.inputs() as usize]);
            assert!(value.is_finite(), "{row:?}");
        }
    }

    fn numbered(number: f64) -> Result<(Formula, Option<Noisy>), Lacking> {
        internal(number, NoiseGenerator::Second, NoiseTable::own_rows())
    }

    #[test]
    fn unknown_numbers_are_told_apart() {
        assert!(matches!(numbered(9.0), Err(Lacking::NotYet(why)) if why.contains("has no formula")));
        assert_eq!(numbered(79.0), Err(Lacking::Unknown));
        assert_eq!(numbered(1.5), Err(Lacking::Unknown));
    }

    #[test]
    fn functions_of_noise_have_their_parameters() {
        for (number, inputs) in [(76.0, 3), (78.0, 4), (29.0, 9), (58.0, 9), (59.0, 9)] {
            let (formula, noisy) = numbered(number).unwrap();
            assert_eq!((formula.inputs(), noisy.is_some()), (inputs, number != 76.0));
            let value = formula.value(&[0.3, 0.2, 0.4, 0.5, 2.0, 3.0, 0.6, 0.4, 2.0][..inputs as usize]);
            assert!(value.is_finite(), "{number}");
        }
    }
}
