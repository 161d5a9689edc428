//! Reduction of scenes: everything is removed that can go while the two programs still differ.

use super::tree::{NEEDED, Node, Scene};

/// All scenes that are one step smaller, those with the most removed first.
pub(super) fn smaller(scene: &Scene) -> Vec<Scene> {
    let mut all = Vec::new();
    lists(scene, &mut all, |s| &s.objects, |s| &mut s.objects);
    lists(scene, &mut all, |s| &s.declared, |s| &mut s.declared);
    if scene.lights.len() > 1 {
        lists(scene, &mut all, |s| &s.lights, |s| &mut s.lights);
    } else {
        within(scene, &mut all, |s| &s.lights, |s| &mut s.lights);
    }
    for at in 1..scene.settings.len() {
        let mut less = scene.clone();
        less.settings.remove(at);
        all.push(less);
    }
    within(scene, &mut all, |s| &s.settings, |s| &mut s.settings);
    for camera in cut(&scene.camera) {
        all.push(Scene { camera, ..scene.clone() });
    }
    all.retain(|less| less != scene);
    all.sort_by_key(Scene::size);
    all
}

/// Scenes without one node of a list, or with a smaller version of the node.
fn lists(
    scene: &Scene,
    all: &mut Vec<Scene>,
    list: fn(&Scene) -> &Vec<Node>,
    list_mut: fn(&mut Scene) -> &mut Vec<Node>,
) {
    for at in 0..list(scene).len() {
        let mut less = scene.clone();
        list_mut(&mut less).remove(at);
        all.push(less);
    }
    within(scene, all, list, list_mut);
}

fn within(
    scene: &Scene,
    all: &mut Vec<Scene>,
    list: fn(&Scene) -> &Vec<Node>,
    list_mut: fn(&mut Scene) -> &mut Vec<Node>,
) {
    for (at, node) in list(scene).iter().enumerate() {
        for smaller in cut(node) {
            let mut less = scene.clone();
            list_mut(&mut less)[at] = smaller;
            all.push(less);
        }
    }
}

/// Smaller versions of a node: without a part, without a modifier, or with one part only.
fn cut(node: &Node) -> Vec<Node> {
    let mut all = Vec::new();
    for (word, plain) in [("pigment {", "pigment { rgb 0.6"), ("finish {", "finish {")] {
        if node.open.starts_with(word) && node.size() > 1 {
            all.push(Node::block(plain, Vec::new(), node.least));
        }
    }
    // A declaration keeps its name.
    let (name, _) =
        node.open.split_once(" = ").filter(|(n, _)| n.starts_with("#declare ")).unwrap_or_default();
    let renamed = |mut part: Node| {
        if !name.is_empty() {
            part.open = format!("{name} = {}", part.open);
        }
        part
    };
    if !node.open.contains("#macro") {
        for part in node.parts.iter().filter(|part| part.close == "}") {
            all.push(renamed(part.clone()));
            if node.close == "}" && part.close == "}" {
                let mut alone = part.clone();
                alone.said.extend(node.said.iter().cloned());
                all.push(renamed(alone));
            }
        }
    }
    for at in 0..node.parts.len() {
        if node.parts.len() > node.least {
            let mut less = node.clone();
            less.parts.remove(at);
            all.push(less);
        }
        for smaller in cut(&node.parts[at]) {
            let mut less = node.clone();
            less.parts[at] = smaller;
            all.push(less);
        }
    }
    // The step of a loop stays, or the loop would not end.
    let said = if node.close == "#end" { 0 } else { node.said.len() };
    for at in 0..said {
        if node.said[at].least != NEEDED {
            let mut less = node.clone();
            less.said.remove(at);
            all.push(less);
        }
        for smaller in cut(&node.said[at]) {
            let mut less = node.clone();
            less.said[at] = smaller;
            all.push(less);
        }
    }
    all
}
