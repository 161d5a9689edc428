//! `function { }`: what may be written in it, what it gives, what is wrong with it; and the isosurfaces made of it.

mod support;

use durer_scene::{Container, Shape};
use support::{debug, fault, float, scene};

fn value(declarations: &str, expression: &str) -> String {
    debug(&format!("{declarations} #debug str({expression}, 0, 9)"))
}

#[test]
fn functions_are_called_like_floats() {
    assert_eq!(value("#declare F = function { x + y*z };", "F(1, 2, 3)"), "7.000000000");
    // x, y and z are also u, v.
    assert_eq!(value("#declare F = function { x + u + v + clock };", "F(10, 2, 3)"), "22.000000000");
    assert_eq!(value("#declare F = function(a, b) { a - b };", "2*F(1, 3) + 1"), "-3.000000000");
    // A parameter hides what is declared by its name.
    assert_eq!(value("#declare R = 7; #declare F = function(R, q) { R*q };", "F(2, 3)"), "6.000000000");
    assert_eq!(value("#declare R = 7; #declare F = function(q) { R*q };", "F(2)"), "14.000000000");
    assert_eq!(value("#declare F = function(q) { q*q }; #declare G = F;", "G(3)"), "9.000000000");
    // What stands where a function is declared counts, not where it is called.
    let redeclared = "#declare F = function(q) { q + 1 }; #declare G = function(q) { F(q) * 2 }; #declare F = function(q) { 0*q };";
    assert_eq!(value(redeclared, "G(4)"), "10.000000000");
    let twice = "#declare F = function(q) { q + 1 } #declare F = function(q) { F(F(q)) }";
    assert_eq!(value(twice, "F(4)"), "6.000000000");
}

/// Values that POV-Ray 3.7 gives.
#[test]
fn operators_are_those_of_povray() {
    let f = |body: &str, arguments: &str| {
        let names = &"x, y, z"[..3 * arguments.split(',').count() - 2];
        value(&format!("#declare F = function({names}) {{ {body} }};"), &format!("F({arguments})"))
    };
    assert_eq!(f("-x*2-3-4/2/2", "10"), "-24.000000000");
    assert_eq!(f("mod(x, y)", "-7, 2"), "-1.000000000");
    assert_eq!(f("mod(x, y)", "7.5, -2"), "1.500000000");
    assert_eq!(f("div(x, y)", "-7, 2"), "-3.000000000");
    assert_eq!(f("int(x) + 10*floor(x) + 100*ceil(x)", "-1.5"), "-121.000000000");
    assert_eq!(f("select(x, 1, 2)", "-1.5"), "1.000000000");
    assert_eq!(f("select(x, 1, 2)", "0"), "2.000000000");
    assert_eq!(f("select(x, 1, 2, 3)", "0"), "2.000000000");
    assert_eq!(f("select(x, 1, 2, 3)", "1"), "3.000000000");
    // Comparisons are exact, unlike those outside of functions.
    assert_eq!(f("(x<y) + 2*(x=y) + 4*(x>=y)", "3, 3 + 1e-12"), "1.000000000");
    assert_eq!(f("(x<y) + 2*(x=y) + 4*(x>=y)", "3, 3"), "6.000000000");
    assert_eq!(f("x < y", "3, 4"), "1.000000000");
    assert_eq!(f("sum(i, 1, 4, x*i) + prod(i, 1, 3, i)", "1"), "16.000000000");
    assert_eq!(f("min(x, y, 2) + max(x, y) + abs(-x) + sqrt(y) + pow(x, 3)", "2, 9"), "24.000000000");
    assert_eq!(f("log(x) + ln(exp(y)) + atan2(z, z)*4/pi", "10, 2, 3"), "4.000000000");
}

#[test]
fn named_functions_have_povrays_values() {
    let rows: &[(u32, &[f64], f64)] = &[
        (4, &[-0.07, -0.23, -0.65, 1.25, 0.31], -0.066416825),
        (5, &[0.01, 0.72, -0.75, 0.91, 0.98], -0.7021473004),
        (11, &[-0.83, -0.22, 0.37, 0.8], 0.251448328),
        (12, &[0.41, -0.62, -0.47, 0.42], -0.32644458),
        (13, &[0.01, 0.76, 0.16, 1.15], 0.4258994525),
        (14, &[-0.21, 0.44, -0.72, 0.62], -0.1930985598),
        (17, &[0.31, 0.41, -0.14, 0.4, 0.59, 0.53], 0.281775176337),
        (22, &[-0.39, 0.56, -0.54, 1.28], -0.765624326336),
        (23, &[0.68, -0.8, -0.22, 0.84], -0.19981837301),
        (31, &[-0.86, -0.14, 0.73, 0.42, 0.96, 0.43], -0.0694638504),
        (33, &[0.14, 0.71, -0.53, 0.31, 0.39, 0.89], -0.243987695947),
        (35, &[-0.87, -0.75, -0.01, 1.31], 4.786636752514),
        (36, &[-0.14, -0.18, 0.25, 0.4], -0.354782052),
        (38, &[0.14, -0.59, 0.2, 1.35], -0.497993616),
        (41, &[-0.8, 0.1, 0.19, 0.46], -0.80356342),
        (42, &[-0.42, 0.89, 0.9, 0.43], 1.44997333),
        (43, &[0.37, 0.81, -0.47, 0.97], -1.2275515773),
        (44, &[-0.82, -0.24, 0.31, 0.95, 1.15, 0.4, 0.68], -3.5771014145),
        (45, &[0.66, 0.15, -0.09, 0.74], -0.217338),
        (47, &[0.87, 0.13, -0.87], 1.465527273138),
        (48, &[0.54, -0.31, -0.12, 0.53], -0.1630422411),
        (49, &[-0.1, -0.32, -0.74, 0.99], 0.644589),
        (51, &[-0.71, 0.51, -0.85, 1.16, 1.19, 0.85, 1.08, 0.57], -1.062289974183),
        (54, &[0.43, -0.13, -0.48, 1.36], -0.2954901512),
        (55, &[-0.18, -0.23, 0.65, 0.71], -0.0373058921),
        (56, &[0.3, -0.59, 0.62, 0.58, 0.36, 1.37], -0.4711303808),
        (57, &[-0.59, 0.8, 0.88], 1.327591804735),
        (60, &[0.19, -0.88, -0.79, 0.53, 0.73, 0.97, 1.36], -0.090001),
        (61, &[-0.26, -0.65, 0.11, 0.45], 0.258660708661),
        (63, &[-0.74, 0.1, 0.35, 0.37, 0.8, 1.07, 1.14], -0.033116113438),
        (65, &[-0.21, 0.7, -0.6, 1.09], -0.32927265),
        (68, &[0.49, 0.68, -0.01, 0.41, 0.35], 0.293837773805),
        (69, &[0.05, -0.59, 0.23], 0.214060683564),
        (70, &[-0.75, 0.5, -0.5, 0.31, 0.49], 0.284428532728),
        (71, &[-0.08, 0.11, -0.2, 0.49, 0.83, 1.34], -0.475723066),
        (73, &[0.06, 0.79, -0.85, 1.39], 0.78837325),
        (74, &[0.7, 0.08, 0.04, 0.89, 1.3], 1.02943808),
    ];
    for (number, arguments, expected) in rows {
        let names: Vec<String> = arguments.iter().map(ToString::to_string).collect();
        let said = value(
            &format!("#declare F = function {{ internal({number}) }}"),
            &format!("F({})", names.join(", ")),
        );
        let found: f64 = said.parse().unwrap();
        // POV-Ray's rounded box is larger than it should be by 1e-6.
        let tolerance = if *number == 60 { 1.1e-6 } else { 2e-9 };
        assert!((found - expected).abs() < tolerance, "internal({number}): {found}, POV-Ray has {expected}");
    }
}

#[test]
fn what_is_wrong_with_a_function_is_said_once_and_where() {
    let says = |text: &str, column: usize, expected: &str| {
        let (line, at, said) = fault(text);
        assert!(said.contains(expected) && (line, at) == (1, column), "{text}: {line}:{at} {said}");
    };
    says("#declare F = function(a, b) { a + b }; #declare A = F(1);", 53, "takes 2 arguments, found 1");
    says("#declare F = function(a) { a + q };", 32, "undeclared `q`");
    says("#declare F = function(a) { G(a) };", 28, "undeclared `G`");
    says("#declare F = function(a) { F(a) };", 28, "undeclared `F`");
    says("#declare F = function(a, a) { a };", 26, "two parameters of the same name");
    says("#declare F = function(a) { sin(a, 2) };", 28, "takes 1 argument, found 2");
    says("#declare F = function(a) { select(a, 2) };", 28, "three or four");
    says("#declare V = <1, 2, 3>; #declare F = function(a) { a*V };", 54, "made of floats");
    says("#declare F = function(a) { sqrt(a) }; #declare A = F(-1);", 52, "undefined here");
    says("#declare F = function { internal(99) };", 25, "no internal function 99");
    says("#declare F = function { pattern { bozo } }; sphere { 0, F(1, 2, 3) }", 57, "no bound");
    says("#declare F = function { internal(76) }; sphere { 0, F(1, 2, 3) }", 53, "noise");
    says("isosurface { threshold 1 }", 1, "no function");
    says("isosurface { function(a, b) { a } }", 14, "three parameters, this one has 2");
    says("isosurface { function { x } contained_by { box { 0, <1, 0, 1> } } }", 44, "no thickness");
    says("isosurface { function { x } contained_by { sphere { 0, 0 } } }", 56, "radius is zero");
    says("isosurface { function { x } contained_by { cone { } } }", 44, "`box` or `sphere`");
}

#[test]
fn an_isosurface_says_what_povrays_says() {
    let read = scene(
        "isosurface { function { sqrt(x*x + y*y + z*z) } contained_by { sphere { <1, 2, 3>, -4 } } threshold 0.5
         accuracy 0.01 max_gradient 2 evaluate 1, 2, 0.5 max_trace 3 all_intersections open pigment { rgb 1 } }
         isosurface { function { x } }",
    );
    let Shape::Isosurface(first) = &read.objects[0].shape else { panic!() };
    assert_eq!((first.threshold, read.objects[0].flags.open), (0.5, true));
    assert!(matches!(first.container, Container::Ball(_, 4.0)));
    assert_eq!(first.function.value(&[2.0, 3.0, 6.0]), 7.0);
    let Shape::Isosurface(second) = &read.objects[1].shape else { panic!() };
    assert!(matches!(second.container, Container::Box(..)) && !read.objects[1].flags.open);
}

#[test]
fn functions_that_grow_without_end_are_stopped() {
    let mut text = String::from("#declare F0 = function(a) { sin(a) };");
    for i in 1..40 {
        text += &format!("#declare F{i} = function(a) {{ F{}(a + {i}.5) + F{}(a * 1.{i}) }};", i - 1, i - 1);
    }
    let (_, _, said) = fault(&text);
    assert!(said.contains("steps"), "{said}");
    assert_eq!(float("1", 0), "1");
}
