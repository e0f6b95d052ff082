//! The track: rail, fasteners and what carries them. All values are of the whole track: both rails, and both
//! seats of a sleeper.

mod rows;
mod slab;

/// A straight track on equally spaced fasteners.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Of the first fastener (m; 0 is the bridge's first end).
    pub start: f64,
    /// Number of fasteners.
    pub fasteners: usize,
    /// Between fasteners (m).
    pub spacing: f64,
    /// Beam elements of the rail between two fasteners.
    pub elements: usize,
    pub rail: Rail,
    pub fastener: Fastener,
    pub support: Support,
    /// The track is solved for so far about the train and the bridge only (m); none: all of it.
    pub window: Option<f64>,
}

/// Both rails as an Euler-Bernoulli beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rail {
    /// EI (N m²).
    pub flexural_rigidity: f64,
    /// kg/m.
    pub mass_per_length: f64,
}

/// Spring and dashpot (N/m, N s/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fastener {
    pub stiffness: f64,
    pub damping: f64,
}

/// What a fastener rests on.
#[derive(Debug, Clone, PartialEq)]
pub enum Support {
    /// Ground or deck itself.
    Direct,
    Ballasted(Ballast),
    Slab(Slab),
}

/// Sleeper, ballast block and subgrade under each fastener.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ballast {
    /// kg.
    pub sleeper_mass: f64,
    pub ballast_mass: f64,
    /// Between sleeper and ballast block.
    pub ballast: Fastener,
    /// Between ballast block and ground.
    pub subgrade: Fastener,
    pub on_bridge: OnBridge,
}

/// What lies between sleeper and deck, on the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnBridge {
    /// Between sleeper and deck.
    pub bed: Fastener,
    /// Ballast that moves with the deck (kg a sleeper).
    pub mass: f64,
}

/// Slabs in a row, each a beam with free ends on a layer of mortar, on ground or deck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// EI (N m²).
    pub flexural_rigidity: f64,
    /// kg/m.
    pub mass_per_length: f64,
    /// Fasteners on a slab.
    pub fasteners: usize,
    /// Of the mortar, a metre of track (N/m², N s/m²).
    pub mortar: Fastener,
}
