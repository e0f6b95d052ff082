//! What is recorded: linear in displacements, rates and accelerations of the coordinates, and in the contact forces.

use crate::quantity::{BridgeResponse, Motion, Quantity, TrackLayer, TrainQuantity, WheelResponse};
use crate::system::train::{Assembly, DeckRows, Inner, TrainCrossing, TrainWheel};

/// The rows of every output; their coefficients are numbers of a point.
#[derive(Debug)]
pub struct Outputs {
    pub all: Vec<Output>,
    quantities: Vec<Quantity>,
}

/// One output.
#[derive(Debug)]
pub enum Output {
    /// Σ c u, Σ c u̇ and Σ c ü: rows, and the first of their numbers (counted from the outputs' first).
    Motion {
        planes: [Vec<usize>; 3],
        first: usize,
    },
    /// The same, and of each wheel's force −F the share `[step][wheel]`.
    Fed {
        planes: [Vec<usize>; 3],
        first: usize,
        shares: Vec<f64>,
    },
    Contact(usize),
    Unloading(usize),
    Irregularity(usize),
}

/// Rows and coefficients in the three planes.
type Terms = [Vec<(usize, f64)>; 3];

impl Outputs {
    pub fn new(
        crossing: &TrainCrossing,
        assembly: &Assembly,
        wheels: &[TrainWheel],
        quantities: &[Quantity],
    ) -> Outputs {
        let mut first = 0;
        let all = quantities
            .iter()
            .map(|quantity| {
                if let Some(output) = at_wheel(quantity, wheels) {
                    return output;
                }
                let terms = terms(crossing, assembly, quantity);
                let planes = terms.map(|plane| plane.into_iter().map(|(row, _)| row).collect());
                let start = first;
                first += planes.iter().map(Vec::len).sum::<usize>();
                let planes: [Vec<usize>; 3] = planes;
                match shares(crossing, assembly, wheels, quantity) {
                    Some(shares) => Output::Fed {
                        planes,
                        first: start,
                        shares,
                    },
                    None => Output::Motion {
                        planes,
                        first: start,
                    },
                }
            })
            .collect();
        Outputs {
            all,
            quantities: quantities.to_vec(),
        }
    }

    /// The rows whose rates or accelerations are taken.
    pub fn moving_rows(&self) -> Vec<usize> {
        let planes = self.all.iter().flat_map(|output| match output {
            Output::Motion { planes, .. } | Output::Fed { planes, .. } => &planes[1..],
            Output::Contact(_) | Output::Unloading(_) | Output::Irregularity(_) => &[],
        });
        let mut rows: Vec<usize> = planes.flatten().copied().collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    }

    /// How many numbers the outputs have.
    pub fn numbers(&self) -> usize {
        let of = |output: &Output| match output {
            Output::Motion { planes, .. } | Output::Fed { planes, .. } => {
                planes.iter().map(Vec::len).sum()
            }
            Output::Contact(_) | Output::Unloading(_) | Output::Irregularity(_) => 0,
        };
        self.all.iter().map(of).sum()
    }

    /// Appends the numbers of a crossing.
    pub fn collect(
        &self,
        crossing: &TrainCrossing,
        assembly: &Assembly,
        wheels: &[TrainWheel],
        list: &mut Vec<f64>,
    ) {
        for quantity in &self.quantities {
            if at_wheel(quantity, wheels).is_none() {
                for plane in terms(crossing, assembly, quantity) {
                    list.extend(plane.into_iter().map(|(_, c)| c));
                }
            }
        }
    }
}

/// The output of a wheel's force or irregularity.
fn at_wheel(quantity: &Quantity, wheels: &[TrainWheel]) -> Option<Output> {
    let Quantity::Train(TrainQuantity::Wheel {
        car,
        wheel,
        response,
    }) = quantity
    else {
        return None;
    };
    let index = wheels
        .iter()
        .position(|w| w.car + 1 == *car && w.number + 1 == *wheel)?;
    Some(match response {
        WheelResponse::ContactForce => Output::Contact(index),
        WheelResponse::UnloadingRatio => Output::Unloading(index),
        WheelResponse::Irregularity => Output::Irregularity(index),
    })
}

fn plane(motion: Motion) -> usize {
    match motion {
        Motion::Displacement => 0,
        Motion::Velocity => 1,
        Motion::Acceleration => 2,
    }
}

fn of_motion(motion: Motion, terms: Vec<(usize, f64)>) -> Terms {
    let mut all = Terms::default();
    all[plane(motion)] = terms;
    all
}

fn terms(crossing: &TrainCrossing, assembly: &Assembly, quantity: &Quantity) -> Terms {
    match quantity {
        Quantity::Bridge { section, response } => bridge(crossing, assembly, section, *response),
        Quantity::Train(TrainQuantity::ShearForce { section }) => {
            let (deck, x) = section_of(crossing, assembly, section);
            inner(assembly, deck, Inner::ShearForce, x, 1.0)
        }
        Quantity::Train(TrainQuantity::Car { car, part, motion }) => {
            let rows = &assembly.cars[car - 1];
            let bodies = &rows.bodies.bodies;
            let body = bodies.iter().find(|body| body.part == *part);
            let body = body.expect("a part of the car");
            let moved = body.motion.iter().map(|(k, a)| (rows.first + k, *a));
            of_motion(*motion, moved.collect())
        }
        Quantity::Train(TrainQuantity::Track {
            section,
            layer,
            motion,
        }) => of_motion(*motion, layer_at(crossing, assembly, section, *layer)),
        Quantity::Train(TrainQuantity::Wheel { .. })
        | Quantity::Vehicle { .. }
        | Quantity::ContactForce
        | Quantity::Irregularity
        | Quantity::Oscillator { .. }
        | Quantity::BaseAcceleration
        | Quantity::Force => unreachable!("no motion of a train"),
    }
}

/// The deck and the place of a section.
fn section_of<'a>(
    crossing: &TrainCrossing,
    assembly: &'a Assembly,
    section: &str,
) -> (&'a DeckRows, f64) {
    let deck = assembly.deck.as_ref().expect("a bridge");
    let place = crossing
        .deck
        .as_ref()
        .and_then(|deck| deck.section(section));
    (deck, place.expect("a section of the bridge"))
}

/// The layer at the fastener nearest to the section; of the rail, the place itself.
fn layer_at(
    crossing: &TrainCrossing,
    assembly: &Assembly,
    section: &str,
    layer: TrackLayer,
) -> Vec<(usize, f64)> {
    let rows = assembly.track.as_ref().expect("a track");
    let track = crossing.track.as_ref().expect("a track");
    let x = match &crossing.deck {
        Some(deck) => deck.section(section).expect("a section of the bridge"),
        None => 0.0,
    };
    let nearest = ((x - track.start) / track.spacing).round().max(0.0) as usize;
    let nearest = nearest.min(track.fasteners - 1);
    match layer {
        TrackLayer::Rail => rows.place(x).expect("a place on the rail").terms,
        TrackLayer::Sleeper => vec![(rows.sleepers[nearest], 1.0)],
        TrackLayer::Ballast => match rows.ballast[nearest] {
            Some(row) => vec![(row, 1.0)],
            None => assembly.deck.as_ref().map_or_else(Vec::new, |deck| {
                let shapes = deck.modes.shapes(track.position(nearest)).into_iter();
                shapes.map(|(k, phi)| (deck.first + k, phi)).collect()
            }),
        },
        TrackLayer::Slab => vec![(rows.slabs[nearest], 1.0)],
    }
}

fn bridge(
    crossing: &TrainCrossing,
    assembly: &Assembly,
    section: &str,
    response: BridgeResponse,
) -> Terms {
    let (deck, x) = section_of(crossing, assembly, section);
    match response {
        BridgeResponse::Motion(motion) => {
            let shapes = deck.modes.shapes(x).into_iter();
            of_motion(
                motion,
                shapes.map(|(k, phi)| (deck.first + k, phi)).collect(),
            )
        }
        BridgeResponse::BendingMoment => inner(assembly, deck, Inner::BendingMoment, x, 1.0),
        BridgeResponse::Stress => {
            let modulus = crossing.deck.as_ref().and_then(|deck| deck.section_modulus);
            let factor = 1.0 / modulus.unwrap_or(f64::NAN);
            inner(assembly, deck, Inner::BendingMoment, x, factor)
        }
    }
}

/// The modes' share, and what the track's forces on the deck add through the truncated modes.
fn inner(assembly: &Assembly, deck: &DeckRows, what: Inner, x: f64, factor: f64) -> Terms {
    let of_modes = deck.modes.inner(what, x);
    let mut shares = vec![0.0; deck.modes.count()];
    for (k, value) in of_modes {
        shares[k] += factor * value;
    }
    let mut rates = vec![0.0; deck.modes.count()];
    let mut terms = Terms::default();
    for bed in assembly.track.iter().flat_map(|track| &track.beds) {
        // The bed pulls the deck up by its elongation.
        let share = factor * deck.modes.truncated(what, x, bed.position);
        terms[0].push((bed.above, share * bed.stiffness));
        terms[1].push((bed.above, share * bed.damping));
        for (k, phi) in deck.modes.shapes(bed.position) {
            shares[k] -= share * bed.stiffness * phi;
            rates[k] -= share * bed.damping * phi;
        }
    }
    let row = |(k, value): (usize, f64)| (deck.first + k, value);
    terms[0].extend(shares.into_iter().enumerate().map(row));
    if assembly.track.is_some() {
        terms[1].extend(rates.into_iter().enumerate().map(row));
    }
    terms
}

/// Where wheels run on the deck itself: the shares of their upward forces −F at every step through the
/// truncated modes.
fn shares(
    crossing: &TrainCrossing,
    assembly: &Assembly,
    wheels: &[TrainWheel],
    quantity: &Quantity,
) -> Option<Vec<f64>> {
    if assembly.track.is_some() {
        return None;
    }
    let modulus = || crossing.deck.as_ref().and_then(|deck| deck.section_modulus);
    let (section, what, factor) = match quantity {
        Quantity::Bridge {
            section,
            response: BridgeResponse::BendingMoment,
        } => (section, Inner::BendingMoment, 1.0),
        Quantity::Bridge {
            section,
            response: BridgeResponse::Stress,
        } => (
            section,
            Inner::BendingMoment,
            1.0 / modulus().unwrap_or(f64::NAN),
        ),
        Quantity::Train(TrainQuantity::ShearForce { section }) => (section, Inner::ShearForce, 1.0),
        Quantity::Bridge {
            response: BridgeResponse::Motion(_),
            ..
        }
        | Quantity::Train(_)
        | Quantity::Vehicle { .. }
        | Quantity::ContactForce
        | Quantity::Irregularity
        | Quantity::Oscillator { .. }
        | Quantity::BaseAcceleration
        | Quantity::Force => return None,
    };
    let (deck, x) = section_of(crossing, assembly, section);
    let mut shares = Vec::with_capacity((crossing.steps + 1) * wheels.len());
    for step in 0..=crossing.steps {
        let first = crossing.speed * crossing.time_step * step as f64 - crossing.approach;
        for wheel in wheels {
            shares.push(factor * deck.modes.truncated(what, x, first - wheel.behind));
        }
    }
    Some(shares)
}
