//! The bridge: spans in a row, by their modes.

mod elements;
mod modes;
#[cfg(test)]
mod tests;

pub use modes::{DeckModes, Inner};

use crate::system::Section;

/// Spans of one cross section.
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// Lengths (m), from the first end on.
    pub spans: Vec<f64>,
    pub kind: Spans,
    /// ρA (kg/m).
    pub mass_per_length: f64,
    /// EI (N m²).
    pub flexural_rigidity: f64,
    /// κ G A (N) of Timoshenko's beam; none: no shear deformation.
    pub shear_rigidity: Option<f64>,
    /// W (m³), where stress is asked for.
    pub section_modulus: Option<f64>,
    pub damping: DeckDamping,
    /// Modes of each span, or of the whole continuous beam.
    pub modes: usize,
    /// Elastic bearings; none: rigid ones.
    pub bearings: Option<Bearings>,
    /// Named places besides `midspan`, from the bridge's first end (m).
    pub sections: Vec<Section>,
}

/// How spans are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spans {
    /// Each for itself, simply supported.
    Simple,
    /// One beam over all supports.
    Continuous,
}

/// Damping of the modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DeckDamping {
    /// ζ of every mode.
    Ratio(f64),
    /// C = a M + b K with ζ at the first and the second mode of a span (or of the continuous beam).
    Rayleigh(f64),
}

/// Spring and dashpot of the bearings at each end of a span (N/m, N s/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearings {
    pub stiffness: f64,
    pub damping: f64,
}

impl Deck {
    /// From the first to the last end (m).
    pub fn length(&self) -> f64 {
        self.spans.iter().sum()
    }

    /// The place of a named section (m); `midspan` is the middle of the middle span.
    pub fn section(&self, name: &str) -> Option<f64> {
        if name == "midspan" {
            let middle = (self.spans.len() - 1) / 2;
            let before: f64 = self.spans[..middle].iter().sum();
            return Some(before + 0.5 * self.spans[middle]);
        }
        let found = self.sections.iter().find(|section| section.name == name)?;
        Some(found.position)
    }
}
