//! The example of a surface of your own runs: it keeps the laws and shows in a picture.

#[path = "../examples/own_surface.rs"]
#[allow(dead_code, reason = "the example's main function")]
mod own_surface;

#[test]
fn a_surface_of_your_own_is_traced_and_keeps_the_laws_and_is_rendered() {
    let mut picture = Vec::new();
    own_surface::run(48, &mut picture).unwrap();
    assert!(picture.starts_with(b"\x89PNG") && picture.len() > 1000, "{} bytes", picture.len());
}
