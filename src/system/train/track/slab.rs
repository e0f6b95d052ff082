//! Slabs as they are laid, fastener by fastener.

use super::{Slab, Track};
use crate::system::train::{Bed, Matrices, Spring, TrackRows};

/// The slab that is being laid.
#[derive(Default)]
pub(super) struct SlabEnd {
    last: Option<usize>,
    fasteners: usize,
    on_deck: bool,
}

impl SlabEnd {
    /// The slab's node under the next fastener: a slab ends with its last fastener, and at an end of the bridge.
    /// Half a bay overhangs at both ends: its mass and mortar count at the end nodes.
    pub fn next(
        &mut self,
        slab: &Slab,
        matrices: &mut Matrices,
        rows: &mut TrackRows,
        track: &Track,
        on_deck: bool,
        position: f64,
    ) -> usize {
        let row = matrices.grow(2);
        let bay = track.spacing;
        let begins = self.fasteners == slab.fasteners || self.on_deck != on_deck;
        match self.last {
            Some(last) if !begins => {
                let at = [last, last + 1, row, row + 1];
                matrices.beam(at, slab.flexural_rigidity, slab.mass_per_length, bay);
                self.fasteners += 1;
            }
            _ => {
                self.end(slab, bay, matrices);
                overhang(row, slab, bay, matrices);
                self.fasteners = 1;
            }
        }
        self.last = Some(row);
        self.on_deck = on_deck;
        rows.slabs.push(row);
        let (stiffness, damping) = (bay * slab.mortar.stiffness, bay * slab.mortar.damping);
        if on_deck {
            rows.beds.push(Bed {
                above: row,
                position,
                stiffness,
                damping,
            });
        } else {
            let spring = Spring {
                elongation: vec![(row, 1.0)],
                stiffness,
                damping,
            };
            matrices.spring(0, &spring);
        }
        // The mortar of a bay also resists its turning, about the ground or the deck's chord.
        let turn = bay * bay / 12.0;
        let spring = Spring {
            elongation: vec![(row + 1, 1.0)],
            stiffness: stiffness * turn,
            damping: damping * turn,
        };
        matrices.spring(0, &spring);
        row
    }

    /// Ends the last slab.
    pub fn end(&self, slab: &Slab, bay: f64, matrices: &mut Matrices) {
        if let Some(last) = self.last {
            overhang(last, slab, bay, matrices);
        }
    }
}

/// Half a bay of slab beyond its last node.
fn overhang(node: usize, slab: &Slab, bay: f64, matrices: &mut Matrices) {
    matrices.mass(node, 0.5 * bay * slab.mass_per_length);
    matrices.mass(node + 1, bay.powi(3) / 24.0 * slab.mass_per_length);
}
