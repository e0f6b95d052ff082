//! Rigid bodies on springs and dashpots, as every car is.

/// Masses, springs and wheels of a car.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Multibody {
    /// The inertia of each coordinate (kg, kg m²): wheels first, then bogies, then the body.
    pub inertia: Vec<f64>,
    pub springs: Vec<Spring>,
    pub wheels: Vec<Wheel>,
    /// The named bodies that responses are recorded of.
    pub bodies: Vec<Body>,
}

/// Spring and dashpot on an elongation Σ aₖ uₖ.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// (coordinate, aₖ).
    pub elongation: Vec<(usize, f64)>,
    /// N/m, N s/m.
    pub stiffness: f64,
    pub damping: f64,
}

/// A wheel (or wheelset) in contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// From the car's first wheel (m).
    pub behind: f64,
    /// Its coordinate; none for a constant force.
    pub coordinate: Option<usize>,
    /// Static force (N, compression positive).
    pub weight: f64,
    /// A law of its own: the tyre's stiffness (N/m).
    pub tyre_stiffness: Option<f64>,
    /// R (m), where it is known.
    pub radius: Option<f64>,
}

/// A place whose motion is Σ aₖ uₖ.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub part: crate::quantity::CarPart,
    pub motion: Vec<(usize, f64)>,
}
