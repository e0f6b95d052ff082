//! All coordinates of a crossing, and their matrices.
//!
//! Rows: the cars one after the other; then, from the track's start to its end, what each fastener rests on and
//! the rail above it (so that a factor of the matrices stays narrow); then the modes of the bridge.

use super::{DeckModes, Matrices, Multibody, Spring, Track, TrainCrossing, Wheel, hermite};

/// A crossing's coordinates.
#[derive(Debug, Clone)]
pub struct Assembly {
    pub matrices: Matrices,
    pub cars: Vec<CarRows>,
    pub track: Option<TrackRows>,
    pub deck: Option<DeckRows>,
}

/// Where a car's coordinates are.
#[derive(Debug, Clone)]
pub struct CarRows {
    pub first: usize,
    pub bodies: Multibody,
    /// From the train's first wheel back to the car's first wheel (m).
    pub behind: f64,
}

/// Where the track's are.
#[derive(Debug, Clone)]
pub struct TrackRows {
    /// Of the first node of the rail (m), between two nodes (m).
    pub start: f64,
    pub step: f64,
    /// EI (N m²) of the rail.
    pub rigidity: f64,
    /// Of each fastener, its first row.
    pub firsts: Vec<usize>,
    /// Of each node of the rail: the row of its deflection; the slope's is the next.
    pub rail: Vec<usize>,
    /// Of each fastener, where the track has them.
    pub sleepers: Vec<usize>,
    /// None on the bridge.
    pub ballast: Vec<Option<usize>>,
    pub slabs: Vec<usize>,
    /// What presses on the deck.
    pub beds: Vec<Bed>,
}

/// A spring between the row above and the deck at a place.
#[derive(Debug, Clone)]
pub struct Bed {
    pub above: usize,
    /// m from the bridge's first end.
    pub position: f64,
    /// N/m, N s/m.
    pub stiffness: f64,
    pub damping: f64,
}

/// Where the deck's modes are.
#[derive(Debug, Clone)]
pub struct DeckRows {
    pub first: usize,
    pub modes: DeckModes,
}

/// What carries a wheel at a place.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Place {
    /// (row, share) of the displacement there.
    pub terms: Vec<(usize, f64)>,
    /// What the rail yields between its nodes under a unit force, beyond these terms (m/N).
    pub flexibility: f64,
}

/// A wheel of the train.
#[derive(Debug, Clone)]
pub struct TrainWheel {
    /// Its car and its place in it, from 0.
    pub car: usize,
    pub number: usize,
    /// From the train's first wheel (m).
    pub behind: f64,
    /// The row of its coordinate.
    pub row: Option<usize>,
    pub wheel: Wheel,
}

impl TrainWheel {
    /// What the wheel itself adds to the irregularity under it after it has rolled x (m): m, upward positive.
    pub fn height(&self, rolled: f64) -> f64 {
        match self.wheel.radius {
            Some(radius) => self.wheel.irregularity.height(rolled, radius),
            None => 0.0,
        }
    }
}

impl TrainCrossing {
    /// Collects the matrices.
    pub fn assembly(&self) -> Assembly {
        let mut matrices = Matrices::default();
        let cars = self.cars.iter().map(|placed| {
            let bodies = placed.car.multibody(self.gravity);
            let first = matrices.grow(bodies.inertia.len());
            for (k, inertia) in bodies.inertia.iter().enumerate() {
                matrices.mass(first + k, *inertia);
            }
            for spring in &bodies.springs {
                matrices.spring(first, spring);
            }
            CarRows {
                first,
                bodies,
                behind: placed.behind,
            }
        });
        let cars = cars.collect();
        let modes = self.deck.as_ref().map(|deck| {
            let added = self.track.as_ref().map_or(0.0, Track::mass_on_deck);
            DeckModes::new(deck, added)
        });
        let track = self
            .track
            .as_ref()
            .map(|track| track.assemble(&mut matrices, modes.as_ref()));
        let deck = modes.map(|modes| {
            let first = matrices.grow(modes.count());
            for (i, j, value) in modes.matrices() {
                matrices
                    .places
                    .push(((first + i) as u32, (first + j) as u32));
                matrices.values.push(value);
            }
            DeckRows { first, modes }
        });
        if let (Some(track), Some(deck)) = (&track, &deck) {
            for bed in &track.beds {
                let shapes = deck.modes.shapes(bed.position);
                let shapes = shapes.into_iter().map(|(k, phi)| (deck.first + k, -phi));
                let spring = Spring {
                    elongation: [(bed.above, 1.0)].into_iter().chain(shapes).collect(),
                    stiffness: bed.stiffness,
                    damping: bed.damping,
                };
                matrices.spring(0, &spring);
            }
        }
        Assembly {
            matrices,
            cars,
            track,
            deck,
        }
    }
}

impl Assembly {
    /// The wheels, from the first car's first on.
    pub fn wheels(&self) -> Vec<TrainWheel> {
        let mut wheels = Vec::new();
        for (car, rows) in self.cars.iter().enumerate() {
            for (number, wheel) in rows.bodies.wheels.iter().enumerate() {
                wheels.push(TrainWheel {
                    car,
                    number,
                    behind: rows.behind + wheel.behind,
                    row: wheel.coordinate.map(|k| rows.first + k),
                    wheel: wheel.clone(),
                });
            }
        }
        wheels
    }

    /// What carries a wheel at x (m): the rail, or without a track the deck; rigid ground beside it. None
    /// beyond the ends of the rail.
    pub fn place(&self, x: f64) -> Option<Place> {
        if let Some(track) = &self.track {
            return track.place(x);
        }
        let terms = self.deck.as_ref().map_or_else(Vec::new, |deck| {
            let shapes = deck.modes.shapes(x).into_iter();
            shapes.map(|(k, phi)| (deck.first + k, phi)).collect()
        });
        Some(Place {
            terms,
            flexibility: 0.0,
        })
    }
}

impl TrackRows {
    /// What carries a wheel at x: Hermite's shares of the nodes beside it, and the deflection of the element as
    /// a beam with clamped ends, a³ b³ / (3 EI h³), which the shares can't follow.
    pub fn place(&self, x: f64) -> Option<Place> {
        let at = (x - self.start) / self.step;
        let last = self.rail.len() - 1;
        if !(-1e-9..=last as f64 + 1e-9).contains(&at) {
            return None;
        }
        let element = (at.max(0.0) as usize).min(last - 1);
        let s = (at - element as f64).clamp(0.0, 1.0);
        let n = hermite(s, self.step, 0);
        let (left, right) = (self.rail[element], self.rail[element + 1]);
        let terms = [
            (left, n[0]),
            (left + 1, n[1]),
            (right, n[2]),
            (right + 1, n[3]),
        ];
        Some(Place {
            terms: terms
                .into_iter()
                .filter(|(_, share)| *share != 0.0)
                .collect(),
            flexibility: (s * (1.0 - s) * self.step).powi(3) / (3.0 * self.rigidity),
        })
    }
}
