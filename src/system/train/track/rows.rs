//! A track's coordinates, from its start to its end, and their matrices.

use super::slab::SlabEnd;
use super::{Ballast, Support, Track};
use crate::system::train::{Bed, DeckModes, Matrices, Spring, TrackRows};

impl Track {
    /// What the deck carries as mass besides its own (kg/m).
    pub(in crate::system::train) fn mass_on_deck(&self) -> f64 {
        match &self.support {
            Support::Ballasted(ballast) => ballast.on_bridge.mass / self.spacing,
            Support::Direct | Support::Slab(_) => 0.0,
        }
    }

    /// The place of fastener k (m).
    pub fn position(&self, fastener: usize) -> f64 {
        self.start + fastener as f64 * self.spacing
    }

    pub(in crate::system::train) fn assemble(
        &self,
        matrices: &mut Matrices,
        deck: Option<&DeckModes>,
    ) -> TrackRows {
        let step = self.spacing / self.elements as f64;
        let mut rows = TrackRows {
            start: self.start,
            step,
            rigidity: self.rail.flexural_rigidity,
            firsts: Vec::new(),
            rail: Vec::new(),
            sleepers: Vec::new(),
            ballast: Vec::new(),
            slabs: Vec::new(),
            beds: Vec::new(),
        };
        let mut slab = SlabEnd::default();
        for fastener in 0..self.fasteners {
            let position = self.position(fastener);
            let on_deck = deck.is_some_and(|deck| deck.carries(position));
            rows.firsts.push(matrices.size);
            let below = match &self.support {
                Support::Direct => None,
                Support::Ballasted(ballast) => {
                    Some(ballast.assemble(matrices, &mut rows, on_deck, position))
                }
                Support::Slab(data) => {
                    Some(slab.next(data, matrices, &mut rows, self, on_deck, position))
                }
            };
            let rail = matrices.grow(2);
            rows.rail.push(rail);
            if below.is_none() && on_deck {
                rows.beds.push(Bed {
                    above: rail,
                    position,
                    stiffness: self.fastener.stiffness,
                    damping: self.fastener.damping,
                });
            } else {
                let elongation = [(rail, 1.0)]
                    .into_iter()
                    .chain(below.map(|below| (below, -1.0)));
                let spring = Spring {
                    elongation: elongation.collect(),
                    stiffness: self.fastener.stiffness,
                    damping: self.fastener.damping,
                };
                matrices.spring(0, &spring);
            }
            if fastener + 1 < self.fasteners {
                for _ in 1..self.elements {
                    rows.rail.push(matrices.grow(2));
                }
            }
        }
        if let Support::Slab(data) = &self.support {
            slab.end(data, self.spacing, matrices);
        }
        for pair in rows.rail.windows(2) {
            let at = [pair[0], pair[0] + 1, pair[1], pair[1] + 1];
            matrices.beam(
                at,
                self.rail.flexural_rigidity,
                self.rail.mass_per_length,
                step,
            );
        }
        rows
    }
}

impl Ballast {
    /// Sleeper and what is below it; the sleeper's row.
    fn assemble(
        &self,
        matrices: &mut Matrices,
        rows: &mut TrackRows,
        on_deck: bool,
        position: f64,
    ) -> usize {
        let block = (!on_deck).then(|| matrices.grow(1));
        let sleeper = matrices.grow(1);
        matrices.mass(sleeper, self.sleeper_mass);
        rows.sleepers.push(sleeper);
        rows.ballast.push(block);
        match block {
            Some(block) => {
                matrices.mass(block, self.ballast_mass);
                for (elongation, spring) in [
                    (vec![(block, 1.0)], self.subgrade),
                    (vec![(sleeper, 1.0), (block, -1.0)], self.ballast),
                ] {
                    let spring = Spring {
                        elongation,
                        stiffness: spring.stiffness,
                        damping: spring.damping,
                    };
                    matrices.spring(0, &spring);
                }
            }
            None => rows.beds.push(Bed {
                above: sleeper,
                position,
                stiffness: self.on_bridge.bed.stiffness,
                damping: self.on_bridge.bed.damping,
            }),
        }
        sleeper
    }
}
