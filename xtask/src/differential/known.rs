//! The differences that docs/differences.md lists and that can be removed from a scene. If the two
//! programs agree without them, they are the reason why the pictures differ.
//!
//! Best is a scene with the same surfaces in other words: if POV-Ray draws these as durer draws the
//! scene itself, POV-Ray contradicts itself, and no fault of durer is hidden.

use super::tree::{Node, Scene};

/// An entry of docs/differences.md about surfaces that POV-Ray draws right in other words.
pub(super) struct Reworded {
    /// The words in bold with which the entry begins.
    pub(super) entry: &'static str,
    /// Rewrites the surfaces of a scene with other words of the language. `None` if the scene has none
    /// of them.
    pub(super) reworded: fn(&Scene) -> Option<Scene>,
}

/// All entries of this kind.
pub(super) const REWORDED: [Reworded; 6] = [
    Reworded { entry: "`interior_texture` stays inside.", reworded: with_polys },
    Reworded { entry: "A mesh in a clipped union", reworded: without_hierarchy },
    Reworded { entry: "Superellipsoids keep their far side.", reworded: with_isosurfaces },
    Reworded { entry: "A disc has no inside.", reworded: with_polygons },
    Reworded { entry: "Surfaces of revolution have no false shadows.", reworded: with_sturm },
    Reworded { entry: "A pigment in place of a blob's own", reworded: with_patterned_blobs },
];

/// One entry of docs/differences.md.
pub(super) struct Known {
    /// The words in bold with which the entry begins.
    pub(super) entry: &'static str,
    /// The scene without what makes the difference. `None` if it has no such thing.
    pub(super) without: fn(&Scene) -> Option<Scene>,
}

/// All entries that a scene of the generator can have.
pub(super) const ALL: [Known; 8] = [
    Known { entry: "`no_shadow` holds for every part of a union.", without: without_no_shadow },
    Known { entry: "A camera exactly on a clear sphere", without: without_camera_on_a_surface },
    Known { entry: "Two surfaces at the same place.", without: without_second_ceiling },
    Known { entry: "Two surfaces at the same place.", without: with_things_apart },
    Known { entry: "`slope` and `aoi` on bumps", without: without_slopes },
    Known { entry: "Bumps after a turned pattern of textures.", without: without_turns },
    Known { entry: "Fractals far away.", without: without_far_fractals },
    Known { entry: "`tiling` at `z = 0`", without: without_borders_of_tilings },
];

/// With all `Reworded` at once, and their entries.
pub(super) fn all_reworded(scene: &Scene) -> Option<(Scene, Vec<&'static str>)> {
    let (mut said, mut entries) = (scene.clone(), Vec::new());
    for words in &REWORDED {
        if let Some(other) = (words.reworded)(&said) {
            said = other;
            entries.push(words.entry);
        }
    }
    (!entries.is_empty()).then_some((said, entries))
}

/// The scene with some nodes written anew; `None` if no node changes.
fn rewritten(scene: &Scene, words: impl Fn(&str) -> Option<String>) -> Option<Scene> {
    let mut other = scene.clone();
    for node in other.declared.iter_mut().chain(&mut other.objects) {
        node.each(&mut |node| {
            if let Some(open) = words(&node.open) {
                node.open = open;
            }
        });
    }
    (other != *scene).then_some(other)
}

/// The numbers after `keyword` in the text of a node, and the text around them.
fn numbers<'t, const N: usize>(text: &'t str, keyword: &str) -> Option<(&'t str, [&'t str; N], &'t str)> {
    let start = text.find(keyword)?;
    let mut rest = &text[start + keyword.len()..];
    let mut all = [""; N];
    for number in &mut all {
        let is_number = |c: char| c.is_ascii_digit() || c == '-' || c == '.';
        rest = &rest[rest.find(is_number)?..];
        let end = rest.find(|c| !is_number(c)).unwrap_or(rest.len());
        (*number, rest) = rest.split_at(end);
    }
    Some((&text[..start], all, rest.strip_prefix('>').unwrap_or(rest)))
}

/// With a `poly` of order 2 for each quadric, if the scene has interior textures.
fn with_polys(scene: &Scene) -> Option<Scene> {
    if !scene.text().contains("interior_texture") {
        return None;
    }
    rewritten(scene, |open| {
        let (before, [xx, yy, zz, xy, xz, yz, x, y, z, one], after) = numbers(open, "quadric {")?;
        Some(format!("{before}poly {{ 2, <{xx}, {xy}, {xz}, {x}, {yy}, {yz}, {y}, {zz}, {z}, {one}>{after}"))
    })
}

/// With `hierarchy off` in all meshes, if the scene has clipped unions.
fn without_hierarchy(scene: &Scene) -> Option<Scene> {
    let mut has_clipped_union = false;
    each_clipped_union(&mut scene.clone(), |_| has_clipped_union = true);
    let faces = "<0, 1, 2> }";
    let off = |open: &str| {
        open.contains("mesh2 {").then(|| open.replacen(faces, &format!("{faces} hierarchy off"), 1))
    };
    has_clipped_union.then(|| rewritten(scene, off)).flatten()
}

/// With an isosurface for each superellipsoid.
///
/// A superellipsoid is where N(p) = 1 for N(p) = ((|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n))^(n/2).
/// For e, n at most 1, N is a norm that is nowhere greater than the length of p, so that no
/// difference of values of N is greater than the distance of the points: `max_gradient` 1 is enough.
fn with_isosurfaces(scene: &Scene) -> Option<Scene> {
    rewritten(scene, |open| {
        let (before, [e, n], after) = numbers(open, "superellipsoid {")?;
        let norm =
            format!("pow(pow(pow(abs(x), 2/{e}) + pow(abs(y), 2/{e}), {e}/{n}) + pow(abs(z), 2/{n}), {n}/2)");
        let within = "contained_by { box { -1.01, 1.01 } } max_gradient 1 accuracy 1e-7 all_intersections";
        Some(format!("{before}isosurface {{ function {{ {norm} - 1 }} {within}{after}"))
    })
}

/// With `sturm` for each surface of revolution.
fn with_sturm(scene: &Scene) -> Option<Scene> {
    rewritten(scene, |open| {
        let start = open.find("sor {")? + "sor {".len();
        let (count, points) = open[start..].split_once(',')?;
        let count: usize = count.trim().parse().ok()?;
        let (last, _) = points.match_indices('>').nth(count.checked_sub(1)?)?;
        let (before, after) = open.split_at(open.len() - points.len() + last + 1);
        Some(format!("{before} sturm{after}"))
    })
}

/// With a pattern of one colour for each plain colour of a blob.
fn with_patterned_blobs(scene: &Scene) -> Option<Scene> {
    let mut other = scene.clone();
    for node in other.declared.iter_mut().chain(&mut other.objects) {
        node.each(&mut |node| {
            let modifiers = if node.open.contains("blob {") { node.said.as_mut_slice() } else { &mut [] };
            for modifier in modifiers {
                let inner = modifier.open.strip_prefix("pigment {").and_then(|rest| rest.strip_suffix('}'));
                if let Some(colour) = inner.filter(|inner| inner.trim_start().starts_with("rgb")) {
                    modifier.open =
                        format!("pigment {{ gradient x color_map {{ [0 {colour}] [1 {colour}] }} }}");
                }
            }
        });
    }
    (other != *scene).then_some(other)
}

/// With a square for each disc, clipped by a ball with the disc's centre and radius.
fn with_polygons(scene: &Scene) -> Option<Scene> {
    rewritten(scene, |open| {
        let (before, all, after) = numbers::<7>(open, "disc {")?;
        let [cx, cy, cz, nx, ny, nz, radius] = all.map(|number| number.parse::<f64>().unwrap_or(f64::NAN));
        // Two vectors across the normal n, such that n points where u x v does.
        let scaled = |v: [f64; 3]| {
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            v.map(|c| c * 1.2 * radius / length)
        };
        let u = scaled(if nx.abs() > nz.abs() { [-ny, nx, 0.0] } else { [0.0, -nz, ny] });
        let n = [nx, ny, nz];
        let v = scaled([0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            n[j] * u[k] - n[k] * u[j]
        }));
        let corner = |a: f64, b: f64| {
            format!(
                "<{:?}, {:?}, {:?}>",
                cx + a * u[0] + b * v[0],
                cy + a * u[1] + b * v[1],
                cz + a * u[2] + b * v[2]
            )
        };
        let corners =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(a, b)| corner(a, b));
        let clip = format!("clipped_by {{ sphere {{ <{cx:?}, {cy:?}, {cz:?}>, {radius:?} }} }}");
        Some(format!("{before}polygon {{ 5, {} {clip}{after}", corners.join(", ")))
    })
}

/// With another pattern for `slope` and `aoi`, if the scene has bumps and textures of textures.
fn without_slopes(scene: &Scene) -> Option<Scene> {
    let text = scene.text();
    if !text.contains("normal {") || !["texture {", "no_bump_scale"].iter().any(|word| text.contains(word)) {
        return None;
    }
    rewritten(scene, |open| {
        if let Some(at) = open.find("slope {") {
            let end = at + open[at..].find('}')? + 1;
            return Some(format!("{}leopard{}", &open[..at], &open[end..]));
        }
        let (before, word) = open.rsplit_once(' ')?;
        (word == "aoi").then(|| format!("{before} leopard"))
    })
}

/// With fractals whose outside is no power of the distance.
fn without_far_fractals(scene: &Scene) -> Option<Scene> {
    rewritten(scene, |open| {
        let (before, outside) = open.split_once(" exterior ")?;
        let (kind, factor) = outside.split_once(',')?;
        (2..=6).contains(&kind.parse::<u32>().ok()?).then(|| format!("{before} exterior 1,{factor}"))
    })
}

/// The tilings with a border at `z = 0`.
const WITH_BORDER: [u32; 7] = [5, 12, 13, 14, 19, 20, 21];

/// With another tiling in place of those with a border at `z = 0`, if the scene shows charts.
fn without_borders_of_tilings(scene: &Scene) -> Option<Scene> {
    if !scene.text().contains("uv_mapping") {
        return None;
    }
    rewritten(scene, |open| {
        let (before, after) = open.split_once("tiling ")?;
        let end = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        let is_listed = WITH_BORDER.contains(&after[..end].parse().ok()?);
        is_listed.then(|| format!("{before}tiling 1{}", &after[end..]))
    })
}

/// With the declared objects apart that the scene shows more than once.
fn with_things_apart(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    let mut seen: Vec<String> = Vec::new();
    for node in &mut less.objects {
        let node = if node.close == "#end" { &mut node.parts[0] } else { node };
        let Some(name) = node.open.strip_prefix("object { ").filter(|n| n.starts_with("Thing")) else {
            continue;
        };
        let name = name.to_owned();
        let times = seen.iter().filter(|n| **n == name).count();
        if times > 0 {
            let by = 0.01 * times as f64;
            node.said.push(Node::text(format!("translate <{by}, {}, {}>", 1.3 * by, 1.7 * by)));
        }
        seen.push(name);
    }
    (less != *scene).then_some(less)
}

/// Without what turns or stretches the patterns of textures that stand in other such patterns, if the
/// scene has bumps.
fn without_turns(scene: &Scene) -> Option<Scene> {
    if !scene.text().contains("normal {") {
        return None;
    }
    let mut less = scene.clone();
    less.objects.iter_mut().for_each(|object| turn_back(object, false));
    (less != *scene).then_some(less)
}

/// Removes what turns or stretches patterns of textures. `is_inner` says that the node stands in such
/// a pattern.
fn turn_back(node: &mut Node, is_inner: bool) {
    let has_textures = |node: &Node| {
        node.said.iter().any(|said| ["texture {", "texture_map {"].iter().any(|w| said.open.starts_with(w)))
    };
    let is_texture = is_inner || node.open.starts_with("texture {");
    let is_pattern = is_texture && (has_textures(node) || node.said.iter().any(has_textures));
    if is_inner && is_pattern {
        let is_even = |size: &str| {
            size.strip_prefix("scale ").is_some_and(|s| s.starts_with(|c: char| c.is_ascii_digit()))
        };
        let turns = |open: &str| ["rotate ", "matrix ", "scale "].iter().any(|w| open.starts_with(w));
        node.said.retain(|said| !turns(&said.open) || is_even(&said.open));
    }
    for inner in node.parts.iter_mut().chain(&mut node.said) {
        turn_back(inner, is_inner || is_pattern);
    }
}

/// Without `no_shadow` inside clipped unions. Declared objects may stand in one.
fn without_no_shadow(scene: &Scene) -> Option<Scene> {
    let mut less = scene.clone();
    let mut has_clipped_union = false;
    each_clipped_union(&mut less, |node| {
        has_clipped_union = true;
        node.parts.iter_mut().for_each(without_word);
    });
    if has_clipped_union {
        less.declared.iter_mut().for_each(without_word);
    }
    (less != *scene).then_some(less)
}

/// Calls a function with all clipped unions, and with all clipped copies of declared ones.
fn each_clipped_union(scene: &mut Scene, mut call: impl FnMut(&mut Node)) {
    let mut unions = vec!["union {".to_owned()];
    for node in &scene.declared {
        let declared = node.open.strip_prefix("#declare ").and_then(|open| open.split_once(" = "));
        if let Some((name, object)) = declared
            && unions.iter().any(|u| object.starts_with(u))
        {
            unions.push(format!("object {{ {name}"));
        }
    }
    for node in scene.declared.iter_mut().chain(&mut scene.objects) {
        node.each(&mut |node| {
            let is_union = unions.iter().any(|u| node.open.contains(u));
            if is_union && node.said.iter().any(|s| s.open == "clipped_by {") {
                call(node);
            }
        });
    }
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

#[cfg(test)]
mod tests {
    use super::super::{looks, solids};
    use super::*;

    #[test]
    fn each_known_difference_occurs_and_is_removed() {
        for known in &ALL {
            let scenes = (0..400).flat_map(|n| [solids::scene(9, n), looks::scene(9, n)]);
            let found = scenes.filter(|s| (known.without)(s).is_some()).count();
            assert!((1..360).contains(&found), "{}: {found}", known.entry);
        }
    }

    #[test]
    fn each_surface_in_other_words_occurs() {
        for known in &REWORDED {
            let scenes = (0..400).flat_map(|n| [solids::scene(9, n), looks::scene(9, n)]);
            let found = scenes.filter(|s| (known.reworded)(s).is_some()).count();
            assert!((1..360).contains(&found), "{}: {found}", known.entry);
        }
    }

    #[test]
    fn inner_patterns_of_textures_are_turned_back() {
        let turned = |open: &str, mut said: Vec<Node>| {
            said.extend(["scale 0.3", "scale <1, 2, 1>", "rotate 30*y", "translate x"].map(Node::text));
            Node { said, ..Node::block(open, Vec::new(), 0) }
        };
        let plain =
            || Node { said: vec![Node::text("normal { bumps }")], ..Node::block("texture {", vec![], 0) };
        let entry = Node { close: "]", ..turned("[1 checker", vec![plain(), plain()]) };
        let map = Node::block("texture_map {", vec![entry], 1);
        let mut sphere = turned("sphere { 0, 1", vec![turned("texture { gradient x", vec![map])]);
        let before = sphere.line();
        turn_back(&mut sphere, false);
        let inner = "scale 0.3 scale <1, 2, 1> rotate 30*y translate x ]";
        assert!(before.contains(inner), "{before}");
        assert_eq!(sphere.line(), before.replace(inner, "scale 0.3 translate x ]"));
    }

    #[test]
    fn a_quadric_is_a_poly_of_order_2() {
        let open = "quadric { <1, 2, 3>, <-0.4, 5, 6>, <7, 8, 9>, -10";
        let all = numbers(open, "quadric {").unwrap();
        assert_eq!(all, ("", ["1", "2", "3", "-0.4", "5", "6", "7", "8", "9", "-10"], ""));
        let sor = Node::block("sor { 3, <0.6, -1>, <0.5, 0>, <0.2, 1>", Vec::new(), 0);
        let mut scene = solids::scene(9, 0);
        scene.objects = vec![sor];
        let sturm = with_sturm(&scene).unwrap().objects.remove(0);
        assert_eq!(sturm.open, "sor { 3, <0.6, -1>, <0.5, 0>, <0.2, 1> sturm");
        let (_, [e, n], rest) = numbers("superellipsoid { <0.5, 1> pigment", "superellipsoid {").unwrap();
        assert_eq!((e, n, rest), ("0.5", "1", " pigment"));
    }

    #[test]
    fn each_known_difference_is_an_entry_of_the_document() {
        let path = crate::command::root().join("docs/differences.md");
        let text = std::fs::read_to_string(path).expect("the document exists");
        for entry in ALL.iter().map(|known| known.entry).chain(REWORDED.iter().map(|known| known.entry)) {
            assert!(text.contains(&format!("**{entry}")), "{entry}");
        }
    }
}
