//! The memory of a batch from one chunk of steps to the next.

use super::lanes::{Aligned, LANES};

/// The states of a batch: modes, deck under the wheel, vehicle.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// Planes of `[mode][lane]`.
    pub modal: [Aligned; 3],
    /// Predicted displacement of the deck under the wheel.
    pub deck: Aligned,
    /// Heave's three states, travel's three, and N: `[7][lane]` (one row spare).
    pub vehicle: Aligned,
}

impl State {
    pub fn new(modes: usize) -> Self {
        let plane = || Aligned::new(modes * LANES);
        State {
            modal: [plane(), plane(), plane()],
            deck: Aligned::new(LANES),
            vehicle: Aligned::new(8 * LANES),
        }
    }

    pub fn copy_from(&mut self, other: &State) {
        let from = other.modal.iter().chain([&other.deck, &other.vehicle]);
        let to = self
            .modal
            .iter_mut()
            .chain([&mut self.deck, &mut self.vehicle]);
        for (to, from) in to.zip(from) {
            to.values_mut().copy_from_slice(from.values());
        }
    }
}
