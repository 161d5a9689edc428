//! The tree of nodes: which meshes are shown, and their placements.

use super::{item, wrong};
use crate::Warning;
use crate::error::{ErrorKind, Location};
use durer_math::{Affine, AffineError, Point3};
use gltf::json::{Node, Root};

/// The transform of a node.
#[derive(Clone, Copy)]
enum Standing {
    /// From its frame to the world.
    Placed(Affine),
    /// The transform of this node, or of the given node above it, has no inverse, so the faces have
    /// no area. Animations hide nodes by a scale of 0.
    Flat(usize),
}

/// The meshes that the scene shows, each with its placement in the world, in the order of the tree.
pub(super) fn shown(root: &Root, warnings: &mut Vec<Warning>) -> Result<Vec<(usize, Affine)>, ErrorKind> {
    let (tops, asked) = tops(root)?;
    if root.nodes.is_empty() && tops.is_empty() {
        return Ok((0..root.meshes.len()).map(|mesh| (mesh, Affine::IDENTITY)).collect());
    }
    let mut shown = Vec::new();
    let mut seen = vec![false; root.nodes.len()];
    let mut parents = vec![None; root.nodes.len()];
    let mut warned = vec![false; root.nodes.len()];
    let mut open: Vec<(usize, Option<usize>, Standing)> =
        tops.into_iter().rev().map(|node| (node, None, Standing::Placed(Affine::IDENTITY))).collect();
    while let Some((number, parent, around)) = open.pop() {
        let spot = Location::Element("node", number);
        let node = item(&root.nodes, number, "node", parent.map_or(asked, |p| Location::Element("node", p)))?;
        if std::mem::replace(&mut seen[number], true) {
            let above = std::iter::successors(parent, |&p: &usize| parents[p]).any(|p| p == number);
            return wrong(
                spot,
                if above { "it is among its own descendants" } else { "it is in the tree twice" },
            );
        }
        parents[number] = parent;
        let local = local(node, spot)?;
        let place = match (around, local) {
            (Standing::Placed(around), Some(local)) => match local.then(&around) {
                Ok(place) => Standing::Placed(place),
                Err(AffineError::Singular(_) | AffineError::Inverse(_)) => Standing::Flat(number),
                Err(e) => return wrong(spot, e.to_string()),
            },
            (Standing::Placed(_), None) => Standing::Flat(number),
            (flat, _) => flat,
        };
        if let Some(mesh) = node.mesh {
            item(&root.meshes, mesh.value(), "mesh", spot)?;
            match place {
                Standing::Placed(place) => shown.push((mesh.value(), place)),
                Standing::Flat(at) => {
                    if !std::mem::replace(&mut warned[at], true) {
                        warnings.push(Warning::Flat { node: at, how: flattening(&root.nodes[at]) });
                    }
                }
            }
        }
        open.extend(node.children.iter().flatten().rev().map(|child| (child.value(), Some(number), place)));
    }
    Ok(shown)
}

/// The nodes at the top of the tree, and the place that lists them.
fn tops(root: &Root) -> Result<(Vec<usize>, Location), ErrorKind> {
    let number = root.scene.map_or(0, |s| s.value());
    if root.scene.is_some() || !root.scenes.is_empty() {
        let scene = item(&root.scenes, number, "scene", Location::Element("scene", number))?;
        return Ok((
            scene.nodes.iter().map(gltf::json::Index::value).collect(),
            Location::Element("scene", number),
        ));
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    let tops: Vec<usize> = (0..root.nodes.len()).filter(|&n| !is_child[n]).collect();
    match (tops.is_empty(), root.nodes.is_empty()) {
        (true, false) => wrong(Location::Element("node", 0), "all nodes are children of others"),
        _ => Ok((tops, Location::Element("scene", 0))),
    }
}

/// The reason why a node's transform has no inverse.
fn flattening(node: &Node) -> String {
    let scale = node.scale.filter(|_| node.matrix.is_none()).unwrap_or([1.0; 3]);
    let axes: Vec<&str> =
        ["x", "y", "z"].into_iter().zip(scale).filter(|(_, s)| *s == 0.0).map(|(a, _)| a).collect();
    match axes[..] {
        [] if node.matrix.is_some() => "a matrix with the determinant 0".into(),
        [] => "a transform too small for a number".into(),
        [a] => format!("a scale of 0 in {a}"),
        [a, b] => format!("a scale of 0 in {a} and {b}"),
        _ => "a scale of 0".into(),
    }
}

/// The map from a node's frame to its parent's: a matrix in column order, or a scale, then a
/// rotation, then a translation. `None` if it has no inverse.
fn local(node: &Node, spot: Location) -> Result<Option<Affine>, ErrorKind> {
    let wide = |x: f32| f64::from(x);
    let (rows, centre) = match node.matrix {
        Some(m) => {
            let m = m.map(wide);
            if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
                return wrong(spot, "the last row of its matrix must be 0 0 0 1");
            }
            (
                core::array::from_fn(|row| core::array::from_fn(|column| m[4 * column + row])),
                [m[12], m[13], m[14]],
            )
        }
        None => {
            let scale = node.scale.map_or([1.0; 3], |s| s.map(wide));
            let turn = rotation(node.rotation.unwrap_or_default().0.map(wide), spot)?;
            let rows = turn.map(|row: [f64; 3]| core::array::from_fn(|column| row[column] * scale[column]));
            (rows, node.translation.map_or([0.0; 3], |t| t.map(wide)))
        }
    };
    match Affine::new(rows, Point3::from(centre)) {
        Ok(place) => Ok(Some(place)),
        Err(AffineError::Singular(_) | AffineError::Inverse(_)) => Ok(None),
        Err(e) => wrong(spot, e.to_string()),
    }
}

/// The rotation of a quaternion `x y z w` of any length but zero. A unit quaternion with rounded
/// numbers still gives a rotation.
fn rotation(q: [f64; 4], spot: Location) -> Result<[[f64; 3]; 3], ErrorKind> {
    let [x, y, z, w] = q;
    let square: f64 = q.iter().map(|c| c * c).sum();
    // The squares of f32 numbers are normal f64 numbers.
    if !(square.is_finite() && square > 0.0) {
        return wrong(spot, "its rotation must be finite and not zero");
    }
    let s = 2.0 / square;
    Ok([
        [1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)],
    ])
}
