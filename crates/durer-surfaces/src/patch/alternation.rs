//! A line enters and leaves a closed surface alternately.
//!
//! Where f64 leaves it open, this rule decides whether the line crosses or touches at an unproven
//! place, the order of crossings whose brackets overlap, and whether a crossing that is within its
//! error of the edge of its patch is on the patch. Next to a sharp edge its two patches are tested
//! independently, and a line that passes the edge within the errors may seem to meet one of them,
//! both, or none.

use super::line::Found;

/// The cost of two crossings in the same direction, as of a surface that crosses itself: more than
/// all candidates together.
const CONTRADICTION: u64 = 1 << 32;

fn touch(a: &Found, b: &Found) -> bool {
    (a.s - b.s).abs() <= a.s_err + b.s_err
}

/// Sorts crossings along the line. Returns whether the alternation of a closed surface has to decide
/// some of them: unproven ones, ones that may be beyond an edge, or the order of two whose brackets
/// overlap.
pub(super) fn is_in_doubt(found: &mut [Found], is_on_edge: impl Fn(&Found) -> bool) -> bool {
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    found.iter().any(|f| f.sign == 0 || is_on_edge(f))
        || found.windows(2).any(|pair| touch(&pair[0], &pair[1]))
}

/// Decides the kind of all crossings along a line; `outward` is -1 if normals point into the solid.
///
/// A crossing that may be beyond an edge is a candidate like the unproven ones, and is proven again
/// if it fits. If no choice alternates, as on a surface that crosses itself, nothing changes;
/// returns whether one does.
pub(super) fn decide(
    found: &mut Vec<Found>,
    outward: i8,
    is_on_edge: impl Fn(&Found) -> bool,
    room: impl Fn(&Found) -> f64,
) -> bool {
    let all = found.clone();
    for f in found.iter_mut().filter(|f| is_on_edge(f)) {
        (f.sign, f.alone) = (0, [0.0; 2]);
    }
    join_unproven(found, room);
    in_turn(found, outward);
    let turns: Vec<i8> = found.iter().map(|f| f.turn).collect();
    if !alternate(found, outward) {
        *found = all;
        return false;
    }
    // The proof holds for this direction only.
    for (f, _) in found.iter_mut().zip(turns).filter(|(f, turn)| f.is_zero && f.turn == *turn) {
        f.sign = f.turn;
    }
    true
}

/// Sorts along the line, and joins unproven candidates that may be at the same place: those nearer
/// to each other than their errors and their `room`. If their directions differ, the joined one has
/// none.
pub(super) fn join_unproven(found: &mut Vec<Found>, room: impl Fn(&Found) -> f64) {
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    let mut i = 0;
    while i < found.len() {
        let mut turns = [found[i].turn < 0, found[i].turn > 0];
        while let Some(&b) = found.get(i + 1) {
            let a = found[i];
            if a.sign != 0 || b.sign != 0 || b.s - a.s > a.s_err + b.s_err + room(&a) + room(&b) {
                break;
            }
            turns = [turns[0] || b.turn < 0, turns[1] || b.turn > 0];
            let turn = i8::from(turns[1]) - i8::from(turns[0]);
            found[i] = Found { turn, ..a.joined(&b) };
            found.remove(i + 1);
        }
        i += 1;
    }
}

/// Swaps neighbours along a whole line whose brackets overlap and which enter and leave a closed
/// surface in the wrong order.
pub(super) fn in_turn(found: &mut [Found], outward: i8) {
    let mut inside = false;
    for i in 0..found.len() {
        let enters = |f: &Found| f.turn * outward < 0;
        if let Some(next) = found.get(i + 1).copied()
            && [found[i], next].iter().all(|f| f.turn != 0)
            && touch(&found[i], &next)
            && enters(&found[i]) == inside
            && enters(&next) != inside
        {
            found.swap(i, i + 1);
        }
        // An unproven candidate counts if it fits.
        if found[i].turn != 0 && (found[i].sign != 0 || enters(&found[i]) != inside) {
            inside = enters(&found[i]);
        }
    }
}

/// One step of a choice for all crossings: the sign, and the side from which the line comes.
#[derive(Clone, Copy)]
struct Step {
    sign: i8,
    from_inside: bool,
}

/// Decides the directions of unproven candidates, which are sorted along a whole line: both ends of
/// the line are outside. Returns whether all crossings alternate then.
///
/// A candidate at a vertex represents the adjacent faces, whether the line meets the vertex or
/// passes it within the rounding; its direction is that in which the line crosses these faces. Of
/// all choices that alternate, this takes one of the least cost: a candidate loses its direction
/// (the line passes the vertex), or, at a higher cost, has another one. Proven crossings do not
/// change.
pub(super) fn alternate(found: &mut [Found], outward: i8) -> bool {
    // The least costs of being outside and inside, and the last steps to there.
    let mut costs = [0, CONTRADICTION << 20];
    let mut steps: Vec<[Step; 2]> = Vec::with_capacity(found.len());
    for crossing in &*found {
        let turn = crossing.turn * outward;
        let mut next = [u64::MAX; 2];
        let mut step = [Step { sign: 0, from_inside: false }; 2];
        for (from_inside, cost) in [(false, costs[0]), (true, costs[1])] {
            let mut reach = |sign: i8, price: u64| {
                let inside = if sign == 0 { from_inside } else { sign < 0 };
                if cost + price < next[usize::from(inside)] {
                    next[usize::from(inside)] = cost + price;
                    step[usize::from(inside)] = Step { sign, from_inside };
                }
            };
            let across = if from_inside { 1 } else { -1 };
            if crossing.sign != 0 {
                reach(turn, if turn == across { 0 } else { CONTRADICTION });
            } else {
                reach(0, u64::from(turn != 0));
                reach(across, if turn == across { 0 } else { 2 });
            }
        }
        // A proven crossing ends on one side only.
        costs = next.map(|cost| cost.min(CONTRADICTION << 20));
        steps.push(step);
    }
    let mut inside = false;
    for (crossing, step) in found.iter_mut().zip(&steps).rev() {
        let Step { sign, from_inside } = step[usize::from(inside)];
        if crossing.sign == 0 {
            crossing.turn = sign * outward;
        }
        inside = from_inside;
    }
    costs[0] < CONTRADICTION
}
