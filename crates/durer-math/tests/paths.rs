//! All instruction paths give the same bits, also when the environment variable selects one.
#![allow(missing_docs, reason = "a test program")]

use durer_math::kernels::Path;
use durer_math::{Affine, Dd, EFloat, EdgeRay, Interval, Isa, IsaError, Point3, Ring, U, Vec3};
use std::process::Command;

fn generator(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * U * 2.0 - 1.0
    }
}

/// Some of every kind of operation, folded into bits.
#[inline(always)]
fn work() -> Vec<u64> {
    let mut random = generator(5);
    let mut out = Vec::new();
    for _ in 0..500 {
        let x: [f64; 6] = core::array::from_fn(|_| random());
        let [a, b, c] = [x[0], x[1], x[2]].map(EFloat::<f64>::exact);
        let r = (a * b - c.square()) / (a + b + c) + a.abs().sqrt();
        let [a, b, c] = [x[0], x[1], x[2]].map(EFloat::<Dd>::exact);
        let s = (a * b - c.square()) / (a + b + c) + a.abs().sqrt();
        let i = Interval::from(x[0]) / Interval::from(x[1]) - Interval::from(x[2]).square();
        let (p, d) = (Point3::new(x[0], x[1], x[2]), Vec3::new(x[3], x[4], x[5]));
        let e = EdgeRay::new(p, d).edge(Point3::new(x[2], x[0], x[4]), Point3::new(x[5], x[1], x[3]));
        let m = Affine::new([[x[0], x[1], x[2]], [x[3], x[4], x[5]], [1.0, 0.0, x[1]]], p);
        let q = m.map_or(p, |m| m.inverse_point(p));
        let floats = [r.v, r.e, s.v.hi, s.v.lo, s.e, i.lo, i.hi, e.value, e.error, q.x, q.y, q.z];
        out.extend(floats.map(f64::to_bits));
        out.push(e.sign as u64);
    }
    out
}

#[test]
fn numbers_have_the_same_bits_on_every_path() {
    let definition = Isa::REFERENCE.run(work);
    for isa in Isa::available() {
        assert!(isa.run(work) == definition, "{isa:?} differs from the reference");
    }
}

/// Run again by the test below, in a process of its own, since the path is cached.
#[test]
fn tells_its_path() {
    println!(
        "path={} requested={:?}",
        Isa::detect().path().name(),
        Isa::requested().map(|x| x.map(Isa::path))
    );
}

fn child(value: Option<&str>) -> String {
    let mut command = Command::new(std::env::current_exe().expect("this program has a path"));
    command.args(["--exact", "tells_its_path", "--nocapture"]).env_remove("DURER_ISA");
    if let Some(value) = value {
        command.env("DURER_ISA", value);
    }
    String::from_utf8(command.output().expect("this program runs").stdout).expect("names are ASCII")
}

#[test]
fn the_environment_chooses_the_path() {
    for isa in Isa::available() {
        let name = isa.path().name();
        assert!(child(Some(name)).contains(&format!("path={name} ")), "{name}");
    }
    let best = Isa::available().map(Isa::path).max().expect("the reference is always there");
    let default = child(None);
    assert!(default.contains(&format!("path={} requested=Ok(None)", best.name())), "{default}");
    let unknown = child(Some("sse9"));
    assert!(unknown.contains(&format!("path={} requested=Err(Unknown(\"sse9\"))", best.name())), "{unknown}");
    assert!(IsaError::Unknown("sse9".into()).to_string().contains("reference, unfused, avx2 or avx512"));
    assert!(best >= Path::Reference);
}
