//! Systems whose response has a known density, to judge what is estimated.
//!
//! | case | response | known |
//! |---|---|---|
//! | [`FreeVibration`] | x₀ cos ω t, the frequency uniform, the amplitude given or normal | at each time |
//! | [`Duffing`] | hardening oscillator under white noise | in the stationary state |
//!
//! A density comes as a table of nodes with density and cumulative probability ([`ExactDensity`]). The
//! nodes crowd where the density has an edge or a pole, and the cumulative probability at each node is
//! exact: what lies between two nodes is known, however steep the density is there. At a pole, where the
//! density has no value, the table has the mean density of the cell beside it.

mod duffing;
mod free_vibration;
mod quadrature;
mod random_amplitude;

pub use duffing::Duffing;
pub use free_vibration::FreeVibration;

/// An exact density on nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactDensity {
    /// The nodes, ascending.
    pub value: Vec<f64>,
    /// p at each node.
    pub density: Vec<f64>,
    /// F at each node.
    pub cumulative: Vec<f64>,
}

/// A system with an exact density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Case {
    /// Free vibration of an undamped oscillator with random frequency.
    FreeVibration(FreeVibration),
    /// The stationary response of a Duffing oscillator to white noise.
    Duffing(Duffing),
}

impl Case {
    /// The density at `time` (s) on about `nodes` nodes; `None` where the response has no spread.
    pub fn density(&self, time: f64, nodes: usize) -> Option<ExactDensity> {
        match self {
            Case::FreeVibration(case) => case.density(time, nodes),
            Case::Duffing(case) => Some(case.density(nodes)),
        }
    }
}

#[cfg(test)]
mod tests;
