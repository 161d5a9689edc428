//! `durer check`: reads a scene, builds it, and says what it is.

use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::input;

pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let loaded = input::load(&args.scene, (800, 600))?;
    let lowered = loaded.lower()?;
    let (scene, geometry) = (loaded.scene(), &lowered.geometry);
    let stats = geometry.stats();
    println!("{}", args.scene.scene.display());
    println!("  objects     {}", scene.objects.len());
    println!("  primitives  {}", stats.primitives);
    for (kind, count) in stats.kinds.iter().filter(|kind| kind.1 > 0) {
        println!("    {count:>8}  {}", short(kind));
    }
    println!("  lights      {}", scene.lights.len());
    println!(
        "  camera      {}",
        if scene.camera.is_some() { "yes" } else { "none: rays can be traced, pictures need one" }
    );
    let bounds = geometry.bounds();
    if bounds.is_bounded() {
        let (a, b) = (bounds.min, bounds.max);
        println!("  bounds      <{}, {}, {}> to <{}, {}, {}>", a.x, a.y, a.z, b.x, b.y, b.z);
    } else if scene.objects.is_empty() {
        println!("  bounds      none: the scene is empty");
    } else {
        println!("  bounds      endless");
    }
    println!(
        "  tree        {} nodes, {} leaves, depth {}",
        stats.tree.nodes, stats.tree.leaves, stats.tree.depth
    );
    println!("  memory      {} bytes", stats.bytes);
    Ok(())
}

/// A type's name without the path to it.
fn short(name: &str) -> String {
    name.split('<').map(|part| part.rsplit("::").next().unwrap_or(part)).collect::<Vec<_>>().join("<")
}
