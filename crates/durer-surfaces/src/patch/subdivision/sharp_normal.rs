//! The normal at a vertex where creases or a boundary meet as they do not in a B-spline.
//!
//! Deep at such a vertex each step takes the points round it, relative to it, to `D` times these. So
//! after many steps they are
//!
//! ```text
//!   P_n = D^n P_0 = Q_n T_n,    D Q_n = Q_(n+1) R,    T_(n+1) = R T_n
//! ```
//!
//! a matrix of a row for each point and three columns. Orthogonal iteration keeps the columns of `Q`
//! apart, so that no digit of the slower eigenvectors is lost; they come to span the eigenvectors of
//! the three largest eigenvalues. The normal of a face at the vertex is the cross product of its
//! rows there, which are those of `Q` in terms of the rows `t_i` of `T`; of these only the cross
//! products are needed, and their ratios stay or fall to zero.
//!
//! Where more than two sharp edges meet, or a crease has more than three faces on a side, a surface
//! by these rules has no tangent plane; then this is the normal that the faces' corners come to.
//!
//! Eigenvectors of the steps: D. Doo, M. Sabin, "Behaviour of recursive division surfaces near
//! extraordinary points", *Computer-Aided Design* 10 (1978) 356-360; sectors between creases:
//! H. Biermann, A. Levin, D. Zorin, "Piecewise smooth subdivision surfaces with normal control",
//! *SIGGRAPH* 2000; orthogonal iteration: G. Golub, C. Van Loan, *Matrix Computations*, section 8.2.

use super::limit::Node;
use super::plan::Plan;
use durer_math::Vec3;

/// So many steps are taken. What remains of the third eigenvalue is its ratio to the second to this
/// power: below 2^-53 where a crease has up to ten faces on one side, of which the ratio is 0.95.
const STEPS: usize = 800;
/// The plan of a corner repeats at once when nothing is sharp for some steps only; before that it
/// changes with each of ten steps at most.
const SETTLING: usize = 16;

/// The unit normal by the faces' winding that the corners of a face at its vertex come to; `None`
/// if they have none.
pub(super) fn sharp_normal(node: &Node, plans: &[Plan]) -> Option<Vec3> {
    let mut node = node.clone();
    let mut settling = 0..SETTLING;
    loop {
        let vertex = node.vertex(plans)?;
        let Plan::Split { quarters, .. } = &plans[node.plan as usize] else { return None };
        if quarters[vertex].plan == node.plan {
            return iterate(&node, plans, vertex);
        }
        settling.next()?;
        let [a, b, c, d] = node.quarters(plans)?;
        node = match vertex {
            0 => a,
            1 => b,
            2 => c,
            _ => d,
        };
    }
}

/// A column of numbers, one for each point.
type Column = Vec<f64>;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Makes three columns orthonormal, in place, and returns the upper triangular matrix by which
/// their product is the original. A column that depends on those before becomes zero.
fn orthonormal(columns: &mut [Column; 3]) -> [[f64; 3]; 3] {
    let mut r = [[0.0; 3]; 3];
    for k in 0..3 {
        let (before, rest) = columns.split_at_mut(k);
        let column = &mut rest[0];
        // Twice is enough (Kahan and Parlett).
        for _ in 0..2 {
            for (i, other) in before.iter().enumerate() {
                let part = dot(other, column);
                r[i][k] += part;
                column.iter_mut().zip(other).for_each(|(x, y)| *x -= part * y);
            }
        }
        let length = dot(column, column).sqrt();
        r[k][k] = length;
        let by = if length > 0.0 { 1.0 / length } else { 0.0 };
        column.iter_mut().for_each(|x| *x *= by);
    }
    r
}

fn iterate(node: &Node, plans: &[Plan], vertex: usize) -> Option<Vec3> {
    let Plan::Split { stencils, quarters, .. } = &plans[node.plan as usize] else { return None };
    let mut steps: Vec<Vec<(usize, f64)>> = quarters[vertex]
        .points
        .iter()
        .map(|p| stencils[*p as usize].iter().map(|(q, w)| (*q as usize, w.to_f64())).collect())
        .collect();
    let sides = if node.place.is_triangle { 3 } else { 4 };
    let [next, before] = [1, sides - 1].map(|k| (vertex + k) % sides);
    // Points beyond a crease have no part in it; their eigenvalues may be larger.
    let mut has_part = vec![false; steps.len()];
    let mut open = vec![vertex, next, before];
    while let Some(point) = open.pop() {
        if !core::mem::replace(&mut has_part[point], true) {
            open.extend(steps[point].iter().map(|(q, _)| *q));
        }
    }
    for (step, _) in steps.iter_mut().zip(&has_part).filter(|(_, has_part)| !**has_part) {
        step.clear();
    }
    let own = node.points[vertex];
    let largest = |columns: &[Column; 3]| columns.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut columns =
        [0, 1, 2].map(|c| node.points.iter().map(|p| (p[c] - own[c]).to_f64()).collect::<Column>());
    let size = largest(&columns);
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    columns.iter_mut().flatten().for_each(|x| *x /= size);
    // The cross products of the rows of T: of the first two, of the first and third, of the last two.
    let [t1, t2, t3] = orthonormal(&mut columns).map(Vec3::from);
    let mut pairs = [t1.cross(t2), t1.cross(t3), t2.cross(t3)];
    for _ in 0..STEPS {
        for column in &mut columns {
            let ahead: Column =
                steps.iter().map(|step| step.iter().map(|(q, w)| w * column[*q]).sum()).collect();
            let centre = ahead[vertex];
            *column =
                ahead.iter().zip(&has_part).map(|(x, has)| if *has { x - centre } else { 0.0 }).collect();
        }
        let [[a, b, c], [_, d, e], [_, _, f]] = orthonormal(&mut columns);
        let [p, q, r] = pairs;
        pairs = [p * (a * d) + q * (a * e) + r * (b * e - c * d), (q * a + r * b) * f, r * (d * f)];
        let most = pairs.iter().fold(0.0, |m: f64, p| m.max(p.max_abs()));
        if most == 0.0 || !most.is_finite() {
            return None;
        }
        pairs = pairs.map(|p| p * (1.0 / most));
    }
    let ([a, b, c], [d, e, f]) =
        (columns.each_ref().map(|column| column[next]), columns.each_ref().map(|column| column[before]));
    let n = pairs[0] * (a * e - b * d) + pairs[1] * (a * f - c * d) + pairs[2] * (b * f - c * e);
    let n = n * (1.0 / n.length());
    n.is_finite().then_some(n)
}
