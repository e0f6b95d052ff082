//! The modes of a deck: of each simply supported span by sines, of other decks by finite elements.

use super::elements::ElementModes;
use super::{Deck, DeckDamping, Spans};
use std::f64::consts::{PI, SQRT_2};

/// The modes of a deck, span after span.
///
/// ```text
/// y(x, t) = Σ φᵢ(x) qᵢ(t),   mᵢ q̈ᵢ + Σⱼ cᵢⱼ q̇ⱼ + kᵢ qᵢ = φᵢ(ξ) F,   mᵢ = ∫ (ρA + added) φᵢ² dx,
/// ```
///
/// F (N) an upward force at ξ. Bending moments (N m, positive in sagging) are Σ Mᵢ(x) qᵢ and what the truncated
/// modes carry, quasi-statically; shear forces are their derivative.
#[derive(Debug, Clone)]
pub struct DeckModes {
    parts: Vec<Part>,
    count: usize,
}

#[derive(Debug, Clone)]
struct Part {
    /// m.
    start: f64,
    length: f64,
    first: usize,
    modes: Modes,
}

#[derive(Debug, Clone)]
enum Modes {
    Sines(Sines),
    Elements(ElementModes),
}

/// φᵢ = √2 sin(iπx/L).
#[derive(Debug, Clone)]
struct Sines {
    length: f64,
    /// mᵢ, all the same.
    mass: f64,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

/// What a section's forces are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inner {
    BendingMoment,
    ShearForce,
}

/// A place this close to an end (m) is the end.
const TOLERANCE: f64 = 1e-9;

impl DeckModes {
    /// The modes of a deck that carries `added` kg/m besides its own mass; its damping is that of the bare deck.
    pub fn new(deck: &Deck, added: f64) -> DeckModes {
        let mut parts = Vec::new();
        let (mut start, mut first) = (0.0, 0);
        let whole = match deck.kind {
            Spans::Simple => deck.spans.iter().map(|span| vec![*span]).collect(),
            Spans::Continuous => vec![deck.spans.clone()],
        };
        for spans in whole {
            let length = spans.iter().sum();
            let modes = match (deck.bearings, spans.len()) {
                (None, 1) => Modes::Sines(Sines::new(deck, length, added)),
                _ => Modes::Elements(ElementModes::new(deck, &spans, added)),
            };
            let count = modes.count();
            parts.push(Part {
                start,
                length,
                first,
                modes,
            });
            start += length;
            first += count;
        }
        DeckModes {
            parts,
            count: first,
        }
    }

    /// The number of modes.
    pub fn count(&self) -> usize {
        self.count
    }

    /// m.
    pub fn length(&self) -> f64 {
        self.parts.iter().map(|part| part.length).sum()
    }

    /// Whether x (m) lies on the deck, its ends included.
    pub fn carries(&self, x: f64) -> bool {
        (-TOLERANCE..=self.length() + TOLERANCE).contains(&x)
    }

    /// Angular frequencies (rad/s), undamped.
    pub fn frequencies(&self) -> Vec<f64> {
        let of = |part: &Part| -> Vec<f64> {
            match &part.modes {
                Modes::Sines(s) => s.stiffness.iter().map(|k| (k / s.mass).sqrt()).collect(),
                Modes::Elements(e) => e.kept().map(|k| e.stiffness(k).sqrt()).collect(),
            }
        };
        self.parts.iter().flat_map(of).collect()
    }

    /// All (i, j ≤ i, [mᵢⱼ, cᵢⱼ, kᵢⱼ]).
    pub fn matrices(&self) -> Vec<(usize, usize, [f64; 3])> {
        let mut all = Vec::new();
        for part in &self.parts {
            match &part.modes {
                Modes::Sines(sines) => {
                    for (k, (stiffness, damping)) in
                        sines.stiffness.iter().zip(&sines.damping).enumerate()
                    {
                        let at = part.first + k;
                        all.push((at, at, [sines.mass, *damping, *stiffness]));
                    }
                }
                Modes::Elements(elements) => {
                    for i in elements.kept() {
                        for j in 0..=i {
                            let damping = elements.damping(i, j);
                            let value = match i == j {
                                true => [1.0, damping, elements.stiffness(i)],
                                false => [0.0, damping, 0.0],
                            };
                            all.push((part.first + i, part.first + j, value));
                        }
                    }
                }
            }
        }
        all
    }

    /// φᵢ(x) of the modes there; none off the deck.
    pub fn shapes(&self, x: f64) -> Vec<(usize, f64)> {
        self.at(x, |part, x| match &part.modes {
            Modes::Sines(sines) => (0..sines.stiffness.len())
                .map(|k| sines.shape(k, x))
                .collect(),
            Modes::Elements(elements) => elements.kept().map(|k| elements.shape(k, x)).collect(),
        })
    }

    /// Mᵢ(x) or its derivative of the modes there.
    pub fn inner(&self, what: Inner, x: f64) -> Vec<(usize, f64)> {
        self.at(x, |part, x| match &part.modes {
            Modes::Sines(sines) => (0..sines.stiffness.len())
                .map(|k| sines.inner(what, k, x))
                .collect(),
            Modes::Elements(elements) => elements
                .kept()
                .map(|k| elements.inner(what, k, x))
                .collect(),
        })
    }

    /// The static moment or shear force at x under an upward unit force at ξ that the truncated modes carry.
    pub fn truncated(&self, what: Inner, x: f64, position: f64) -> f64 {
        let (Some(part), Some(loaded)) = (self.part(x), self.part(position)) else {
            return 0.0;
        };
        if part.first != loaded.first {
            return 0.0;
        }
        let (x, position) = (x - part.start, position - part.start);
        match &part.modes {
            Modes::Sines(sines) => sines.truncated(what, x, position),
            Modes::Elements(elements) => elements.truncated(what, x, position),
        }
    }

    /// The part that x lies on: at a joint the one before.
    fn part(&self, x: f64) -> Option<&Part> {
        if x < -TOLERANCE {
            return None;
        }
        let within = |part: &&Part| x <= part.start + part.length + TOLERANCE;
        self.parts.iter().find(within)
    }

    fn at(&self, x: f64, of: impl Fn(&Part, f64) -> Vec<f64>) -> Vec<(usize, f64)> {
        let Some(part) = self.part(x) else {
            return Vec::new();
        };
        let values = of(part, (x - part.start).clamp(0.0, part.length));
        values
            .into_iter()
            .enumerate()
            .map(|(k, value)| (part.first + k, value))
            .collect()
    }
}

impl Modes {
    fn count(&self) -> usize {
        match self {
            Modes::Sines(sines) => sines.stiffness.len(),
            Modes::Elements(elements) => elements.kept().len(),
        }
    }
}

impl Sines {
    fn new(deck: &Deck, length: f64, added: f64) -> Sines {
        let stiffness: Vec<f64> = (1..=deck.modes)
            .map(|i| {
                let wavenumber = i as f64 * PI / length;
                let bending = deck.flexural_rigidity * wavenumber.powi(2);
                let shear = deck.shear_rigidity.map_or(0.0, |shear| bending / shear);
                bending * wavenumber.powi(2) * length / (1.0 + shear)
            })
            .collect();
        let bare = deck.mass_per_length * length;
        let frequency = |i: usize| {
            let wavenumber = i as f64 * PI / length;
            let bending = deck.flexural_rigidity * wavenumber.powi(2);
            let shear = deck.shear_rigidity.map_or(0.0, |shear| bending / shear);
            (bending * wavenumber.powi(2) / ((1.0 + shear) * deck.mass_per_length)).sqrt()
        };
        let damping = deck
            .damping
            .of_modes(&stiffness, bare, [frequency(1), frequency(2)]);
        Sines {
            length,
            mass: bare + added * length,
            stiffness,
            damping,
        }
    }

    fn shape(&self, mode: usize, x: f64) -> f64 {
        SQRT_2 * ((mode + 1) as f64 * PI * x / self.length).sin()
    }

    fn inner(&self, what: Inner, mode: usize, x: f64) -> f64 {
        let wavenumber = (mode + 1) as f64 * PI / self.length;
        let load = self.stiffness[mode] / self.length;
        match what {
            Inner::BendingMoment => -load / wavenumber.powi(2) * self.shape(mode, x),
            Inner::ShearForce => -load / wavenumber * SQRT_2 * (wavenumber * x).cos(),
        }
    }

    fn truncated(&self, what: Inner, x: f64, position: f64) -> f64 {
        let length = self.length;
        let exact = match what {
            Inner::BendingMoment => -x.min(position) * (length - x.max(position)) / length,
            Inner::ShearForce if x < position => -(length - position) / length,
            Inner::ShearForce if x > position => position / length,
            Inner::ShearForce => position / length - 0.5,
        };
        let kept: f64 = (0..self.stiffness.len())
            .map(|k| self.inner(what, k, x) * self.shape(k, position) / self.stiffness[k])
            .sum();
        exact - kept
    }
}

impl DeckDamping {
    /// cᵢ of modes with kᵢ and one mass, by the first two angular frequencies.
    pub(super) fn of_modes(self, stiffness: &[f64], mass: f64, first: [f64; 2]) -> Vec<f64> {
        let of = |k: &f64| match self {
            DeckDamping::Ratio(ratio) => 2.0 * ratio * (k * mass).sqrt(),
            DeckDamping::Rayleigh(ratio) => {
                let [a, b] = first;
                2.0 * ratio / (a + b) * (a * b * mass + k)
            }
        };
        stiffness.iter().map(of).collect()
    }
}
