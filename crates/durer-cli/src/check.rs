//! `durer check`: reads a scene, builds it, and reports its contents.

use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::input;
use durer::mesh::Topology;

pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let loaded = input::load(&args.scene, (800, 600))?;
    let lowered = loaded.lower()?;
    let (scene, geometry) = (loaded.scene(), &lowered.geometry);
    let (stats, inventory) = (geometry.stats(), geometry.inventory());
    let held: u64 = inventory.kinds.0.iter().map(|kind| kind.1).sum();
    println!("{}", args.scene.scene.display());
    println!("  objects     {}", scene.objects.len());
    println!("  primitives  {held}");
    for (kind, count) in inventory.kinds.0.iter().filter(|kind| kind.1 > 0) {
        println!("    {count:>8}  {kind}");
    }
    if stats.instances > 0 {
        println!("  instances   {}: with them there are {} primitives", stats.instances, inventory.placed);
    }
    for (faces, topology) in loaded.topologies() {
        report(faces, &topology);
    }
    println!("  lights      {}", scene.lights.len());
    println!(
        "  camera      {}",
        if scene.camera.is_some() { "yes" } else { "none: pictures need one, traced rays do not" }
    );
    let learned = crate::noise::chosen(args.scene.noise)?;
    let noise =
        learned.map_or_else(|| "durer's own".to_owned(), |(_, from)| format!("that of POV-Ray {from}"));
    println!("  noise       {noise}");
    let bounds = geometry.bounds();
    if bounds.is_bounded() {
        let (a, b) = (bounds.min, bounds.max);
        println!("  bounds      <{}, {}, {}> to <{}, {}, {}>", a.x, a.y, a.z, b.x, b.y, b.z);
    } else if scene.objects.is_empty() {
        println!("  bounds      none: the scene is empty");
    } else {
        println!("  bounds      unbounded");
    }
    println!(
        "  tree        {} nodes, {} leaves, depth {}",
        stats.tree.nodes, stats.tree.leaves, stats.tree.depth
    );
    println!("  memory      {} bytes", inventory.bytes);
    Ok(())
}

/// Reports how the triangles of a mesh are connected.
fn report(faces: usize, topology: &Topology) {
    let Topology { degenerate, duplicates, open_edges, turned_edges, shared_edges, is_closed } = *topology;
    println!("  mesh        {faces} faces, {}", if is_closed { "closed: a solid" } else { "open: a sheet" });
    let lines = [
        (open_edges, "open edges"),
        (turned_edges, "edges between two faces of opposite orientation"),
        (shared_edges, "edges of more than two faces"),
        (degenerate, "faces without area or with coordinates that are not finite, left out"),
        (duplicates, "faces over the same corners as another"),
    ];
    for (count, what) in lines.into_iter().filter(|line| line.0 > 0) {
        println!("    {count:>8}  {what}");
    }
}
