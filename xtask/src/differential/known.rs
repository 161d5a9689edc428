//! The differences that docs/differences.md lists and that can be removed from a scene. If the two
//! programs agree without them, they are the reason why the pictures differ.

use super::scene::{Node, Scene};

/// One entry of docs/differences.md.
pub(super) struct Known {
    /// The words in bold with which the entry begins.
    pub(super) entry: &'static str,
    /// The scene without what makes the difference. `None` if it has no such thing.
    pub(super) without: fn(&Scene) -> Option<Scene>,
}

/// All entries that a scene of the generator can have.
pub(super) const ALL: [Known; 4] = [
    Known { entry: "`no_shadow` holds for every part of a union.", without: without_no_shadow },
    Known { entry: "A camera exactly on a clear sphere", without: without_camera_on_a_surface },
    Known { entry: "A disc has no inside.", without: with_turned_discs },
    Known { entry: "Two surfaces at the same place.", without: without_second_ceiling },
];

/// Without `no_shadow` inside clipped unions. Declared objects may stand in one.
fn without_no_shadow(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    let mut is_clipped = false;
    for node in less.declared.iter_mut().chain(&mut less.objects) {
        node.each(&mut |node| {
            if node.open.contains("union {") && node.said.iter().any(|s| s.open == "clipped_by {") {
                is_clipped = true;
                node.parts.iter_mut().for_each(without_word);
            }
        });
    }
    if is_clipped {
        less.declared.iter_mut().for_each(without_word);
    }
    (less != *scene).then_some(less)
}

fn without_word(node: &mut Node) {
    node.each(&mut |node| node.said.retain(|said| said.open != "no_shadow"));
}

/// With the camera away from the surface on which it stands.
fn without_camera_on_a_surface(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    for (on, off) in [("<0, 0, -6>", "<-0.05, 0, -6.05>"), ("<0, 0.5, -6>", "<-0.05, 0.5, -6.05>")] {
        less.camera.open = less.camera.open.replacen(on, off, 1);
    }
    (less != *scene).then_some(less)
}

/// With one ceiling where two lights have one each.
fn without_second_ceiling(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    let mut ceilings = 0;
    less.objects.retain(|node| {
        ceilings += usize::from(node.open.contains("plane { y, 3"));
        ceilings < 2 || !node.open.contains("plane { y, 3")
    });
    (less != *scene).then_some(less)
}

/// With all discs turned round. The camera then sees them from the other side.
fn with_turned_discs(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    for node in less.declared.iter_mut().chain(&mut less.objects) {
        node.each(&mut |node| {
            // disc { <centre>, <normal>, radius
            if let Some(at) =
                node.open.find("disc { ").and_then(|d| Some(d + node.open[d..].find(">, <")? + 3))
            {
                node.open.insert(at, '-');
            }
        });
    }
    (less != *scene).then_some(less)
}

#[cfg(test)]
mod tests {
    use super::super::scene;
    use super::*;

    #[test]
    fn each_known_difference_occurs_and_is_removed() {
        for known in &ALL {
            let scenes = (0..400).map(|n| scene::scene(9, n));
            let found = scenes.filter(|s| (known.without)(s).is_some()).count();
            assert!((1..360).contains(&found), "{}: {found}", known.entry);
        }
    }

    #[test]
    fn each_known_difference_is_an_entry_of_the_document() {
        let path = crate::command::root().join("docs/differences.md");
        let text = std::fs::read_to_string(path).expect("the document exists");
        for known in &ALL {
            assert!(text.contains(&format!("**{}", known.entry)), "{}", known.entry);
        }
    }
}
