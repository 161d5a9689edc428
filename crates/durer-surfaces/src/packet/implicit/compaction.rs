//! Many packets of eight rays against one level set.
//!
//! Some rays are finished after one segment and others after thirty. A packet is advanced as long
//! as most of its rays are active. The remaining rays of all packets are then gathered into one
//! packet: as soon as one of its rays is finished, the next one takes its lane.

use super::ImplicitKernel;
use super::rays::{ImplicitScratch, MOST, conclude, look, prepare};
use crate::packet::closest::PacketQuery;
use crate::packet::convex::Hull;
use crate::packet::local_frame::Own;
use crate::packet::quadric::Start;
use crate::packet::rays::Nearest;
use durer_math::lanes::LANES;

/// Packets with fewer active rays wait for the gathered packet.
const DENSE: usize = 6;

/// Working memory for all packets, and for the gathered packet.
#[derive(Debug, Default)]
pub(in crate::packet) struct Stream {
    eights: Vec<ImplicitScratch>,
    /// The caller's number of each packet.
    numbers: Vec<usize>,
    beside: ImplicitScratch,
}

/// A lane of a packet, and how many segments of its ray were examined.
#[derive(Clone, Copy)]
struct LaneSlot {
    eight: usize,
    lane: usize,
    looks: u32,
}

impl Stream {
    /// Removes all packets.
    pub(in crate::packet) fn clear(&mut self) {
        self.numbers.clear();
    }

    /// Adds the packet with this number. `turned` is whether the surface is turned; `held` contains
    /// the container's cell if the solid has a container.
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

    /// Advances all packets until every ray is finished, and passes the first crossing of each ray
    /// to its `nearest`.
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

/// Advances packets until every ray is finished.
fn search(eights: &mut [ImplicitScratch], beside: &mut ImplicitScratch, level: &dyn ImplicitKernel) {
    // A single packet has no others to be gathered with.
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

/// Advances the remaining rays of all packets in the gathered packet `beside`.
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
