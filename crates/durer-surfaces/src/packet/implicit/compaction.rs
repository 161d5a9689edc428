//! Many eights of rays at one level set.
//!
//! Some rays are through after one stretch and others after thirty. Eight rays look together as
//! long as most of them go on; who is left over then goes on beside those of other eights: as soon
//! as one is through, the next one takes its lane.

use super::ImplicitKernel;
use super::rays::{ImplicitScratch, MOST, conclude, look, prepare};
use crate::packet::closest::PacketQuery;
use crate::packet::convex::Hull;
use crate::packet::local_frame::Own;
use crate::packet::quadric::Start;
use crate::packet::rays::Nearest;
use durer_math::lanes::LANES;

/// Eights in which fewer rays go on are left to be filled.
const DENSE: usize = 6;

/// Memory for the eights on the way, and for those rays that go on beside others.
#[derive(Debug, Default)]
pub(in crate::packet) struct Stream {
    eights: Vec<ImplicitScratch>,
    /// Which of the caller's eights they are.
    numbers: Vec<usize>,
    beside: ImplicitScratch,
}

/// A lane of an eight, and how often it has been looked at.
#[derive(Clone, Copy)]
struct LaneSlot {
    eight: usize,
    lane: usize,
    looks: u32,
}

impl Stream {
    /// Forgets the rays.
    pub(in crate::packet) fn clear(&mut self) {
        self.numbers.clear();
    }

    /// Adds eight rays, those with this number; of a solid in a container that is a cell. It is
    /// said whether the surface is turned round.
    pub(in crate::packet) fn add(
        &mut self,
        number: usize,
        (level, own, turned): (&dyn ImplicitKernel, &Own, bool),
        asked: &PacketQuery<'_>,
        held: (&Start, Option<&Hull>),
        nearest: &mut Nearest,
    ) {
        let place = self.numbers.len();
        self.numbers.push(number);
        if self.eights.len() <= place {
            self.eights.push(ImplicitScratch::default());
        }
        prepare(level, own, (asked, turned), held, nearest, &mut self.eights[place]);
    }

    /// Looks along all of them until nothing is left to be seen, and offers the first crossing of
    /// each ray to what is nearest so far.
    pub(in crate::packet) fn meet(
        &mut self,
        level: &dyn ImplicitKernel,
        asked: &[PacketQuery<'_>],
        nearest: &mut [Nearest],
    ) {
        let Self { eights, numbers, beside } = self;
        let eights = &mut eights[..numbers.len()];
        search(eights, beside, level);
        for (eight, &i) in eights.iter_mut().zip(&*numbers) {
            conclude(level, &asked[i], &mut nearest[i], eight);
        }
    }
}

/// Looks along some eights until nothing is left to be seen.
fn search(eights: &mut [ImplicitScratch], beside: &mut ImplicitScratch, level: &dyn ImplicitKernel) {
    // One eight has nobody to be filled up with.
    let dense = if eights.len() > 1 { DENSE } else { 1 };
    let mut left = 0;
    for eight in &mut *eights {
        let goes_on = |eight: &ImplicitScratch| match eight.looks() {
            0 => eight.open().any(),
            looks => looks < MOST && eight.open().count() >= dense,
        };
        while goes_on(eight) {
            look(level, eight);
        }
        left += eight.open().count();
    }
    if left > 0 && dense > 1 {
        go_on_beside_others(eights, beside, level);
    }
}

/// The same of the rays that are left over, each beside those of other eights.
fn go_on_beside_others(
    eights: &mut [ImplicitScratch],
    beside: &mut ImplicitScratch,
    level: &dyn ImplicitKernel,
) {
    let mut places: [Option<LaneSlot>; LANES] = [None; LANES];
    let (mut eight, mut open) = (0, eights[0].open().bits());
    beside.clear(eights[0].isa());
    loop {
        let mut is_new = false;
        for i in (!beside.open()).lanes() {
            if let Some(LaneSlot { eight, lane, .. }) = places[i].take() {
                beside.give_back(i, &mut eights[eight], lane);
            }
            while open == 0 && eight + 1 < eights.len() {
                eight += 1;
                open = eights[eight].open().bits();
            }
            if open != 0 {
                let lane = open.trailing_zeros() as usize;
                open &= open - 1;
                beside.take_over(i, &eights[eight], lane);
                places[i] = Some(LaneSlot { eight, lane, looks: eights[eight].looks() });
                is_new = true;
            }
        }
        if !beside.open().any() {
            return;
        }
        if is_new {
            beside.ask_all();
        }
        look(level, beside);
        for (i, place) in places.iter_mut().enumerate() {
            if let Some(place) = place {
                place.looks += 1;
                if place.looks >= MOST && beside.open().lane(i) {
                    beside.give_up(i);
                }
            }
        }
    }
}
