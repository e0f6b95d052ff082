//! Trains against closed forms and published figures.

mod energy;
mod points;
mod programs;
mod track;

use super::*;
use crate::ensemble::{Points, Strip, System};
use crate::system::InitialState;
use crate::system::train::*;

pub(super) const SPACING: f64 = 0.05;

/// A bridge without track.
pub(super) fn crossing(deck: Deck, cars: Vec<PlacedCar>, speed: f64, step: f64) -> TrainCrossing {
    let behind = cars.last().map_or(0.0, |car| {
        let wheels = car.car.multibody(9.81).wheels;
        car.behind + wheels.last().map_or(0.0, |wheel| wheel.behind)
    });
    let steps = ((deck.length() + behind) / speed / step).floor() as usize;
    TrainCrossing {
        cars,
        contact: Contact::Linear { stiffness: 2.5e9 },
        track: None,
        deck: Some(deck),
        speed,
        approach: 0.0,
        gravity: 9.81,
        time_step: step,
        steps,
        record_every: 1,
        initial_state: InitialState::Profile,
    }
}

pub(super) fn simple(span: f64, rigidity: f64, mass: f64, ratio: f64, modes: usize) -> Deck {
    Deck {
        spans: vec![span],
        kind: Spans::Simple,
        mass_per_length: mass,
        flexural_rigidity: rigidity,
        shear_rigidity: None,
        section_modulus: None,
        damping: DeckDamping::Ratio(ratio),
        modes,
        bearings: None,
        sections: Vec::new(),
    }
}

pub(super) fn trailer() -> RailVehicle {
    RailVehicle {
        body_mass: 44_000.0,
        body_pitch_inertia: 2.7e6,
        bogie_mass: 2400.0,
        bogie_pitch_inertia: 2200.0,
        wheelset_mass: 2400.0,
        primary_stiffness: 1.4e6,
        primary_damping: 8e4,
        secondary_stiffness: 6e5,
        secondary_damping: 8e4,
        bogie_spacing: 17.375,
        wheelbase: 2.5,
        wheel_radius: 0.46,
        wheel_defects: Vec::new(),
    }
}

pub(super) fn train(car: Car, count: usize, length: f64) -> Vec<PlacedCar> {
    (0..count)
        .map(|k| PlacedCar {
            car: car.clone(),
            behind: k as f64 * length,
        })
        .collect()
}

/// Zhai, Wang, Lin 2004, for both rails and both seats.
pub(super) fn ballasted(start: f64, end: f64) -> Track {
    let spacing = 0.6;
    let first = (start / spacing).floor();
    let ballast = Fastener {
        stiffness: 2.755e8,
        damping: 1.176e5,
    };
    Track {
        start: first * spacing,
        fasteners: ((end / spacing).ceil() - first) as usize + 1,
        spacing,
        elements: 1,
        rail: Rail {
            flexural_rigidity: 1.325e7,
            mass_per_length: 121.28,
        },
        fastener: Fastener {
            stiffness: 1.3e8,
            damping: 1.5e5,
        },
        support: Support::Ballasted(Ballast {
            sleeper_mass: 251.0,
            ballast_mass: 1062.8,
            ballast,
            subgrade: Fastener {
                stiffness: 1.55e8,
                damping: 6.23e4,
            },
            on_bridge: OnBridge {
                bed: ballast,
                mass: 1062.8,
            },
        }),
        window: None,
    }
}

/// The histories of quantities, by name, on a profile.
pub(super) fn histories(
    crossing: &TrainCrossing,
    names: &[&str],
    profile: impl Fn(f64) -> f64,
) -> Vec<Vec<f64>> {
    let quantities: Vec<Quantity> = names
        .iter()
        .map(|name| Quantity::named(name).expect(name))
        .collect();
    let start = -crossing.approach - 300.0;
    let end = crossing.middle(crossing.steps) + 10.0;
    let count = ((end - start) / SPACING).ceil() as usize + 1;
    let row: Vec<f64> = (0..count)
        .map(|k| profile(start + k as f64 * SPACING))
        .collect();
    let trains = Trains::new(crossing.clone(), &quantities, (start, SPACING, count)).unwrap();
    let points = Points {
        excitation: &row,
        samples: count,
        parameters: &[],
        range: 0..1,
    };
    let records = trains.times().len();
    let mut values = vec![0.0; records * quantities.len()];
    let mut strips = Strip::cut(&mut values, 1, 1);
    trains.stepper().run(&points, &mut strips[0]).unwrap();
    drop(strips);
    (0..quantities.len())
        .map(|k| {
            values
                .iter()
                .skip(k)
                .step_by(quantities.len())
                .copied()
                .collect()
        })
        .collect()
}

pub(super) fn peak(history: &[f64]) -> f64 {
    history.iter().map(|y| y.abs()).fold(0.0, f64::max)
}

/// Of a moving force on one mode: y = (2P/mL)/(ω²(1−S²)) [sin(πvt/L) − S sin ωt].
#[test]
fn moving_force() {
    let (force, span, rigidity, mass) = (2e5, 25.0, 2.87e9 * 2.9, 2303.0);
    let deck = simple(span, rigidity, mass, 0.0, 1);
    let frequency = (std::f64::consts::PI / span).powi(2) * (rigidity / mass).sqrt();
    let car = Car::MovingForces(vec![Axle { behind: 0.0, force }]);
    for ratio in [0.1, 0.3, 0.617] {
        let speed = ratio * frequency * span / std::f64::consts::PI;
        let case = crossing(
            deck.clone(),
            train(car.clone(), 1, 0.0),
            speed,
            span / speed / 4000.0,
        );
        let found = &histories(&case, &["bridge/midspan/displacement"], |_| 0.0)[0];
        let scale = 2.0 * force / (mass * span * frequency.powi(2) * (1.0 - ratio * ratio));
        for (n, y) in found.iter().enumerate() {
            let t = n as f64 * case.time_step;
            let exact = -scale
                * ((std::f64::consts::PI * speed * t / span).sin() - ratio * (frequency * t).sin());
            // The scheme's phase lags by ω³ h² t / 12; the start adds as much again at most.
            let lag = frequency.powi(3) * case.time_step.powi(2) * t / 12.0;
            let allowed = 2.0 * scale * (ratio * lag + (frequency * case.time_step).powi(2));
            assert!((y - exact).abs() < allowed, "{ratio} {n} {y} {exact}");
        }
    }
}

/// Yang and Yau 1997: largest mid-span displacement 2.38389 mm by one mode, computed independently.
#[test]
fn sprung_mass() {
    let deck = simple(25.0, 2.87e9 * 2.9, 2303.0, 0.0, 1);
    // The body on the spring, the spring on a wheel of hardly any mass.
    let car = Car::SprungMass {
        body_mass: 5750.0,
        wheel_mass: 1e-3,
        stiffness: 1595e3,
        damping: 0.0,
    };
    let mut case = crossing(deck, train(car, 1, 0.0), 100.0 / 3.6, 1e-4);
    case.contact = Contact::Rigid;
    let found = &histories(&case, &["bridge/midspan/displacement"], |_| 0.0)[0];
    assert!((peak(found) - 2.38389e-3).abs() < 2e-8, "{}", peak(found));
}

/// A car on ballasted track, 60 m of it before and after a bridge of 48 m.
pub(super) fn on_track(contact: Contact, step: f64, cars: usize, speed: f64) -> TrainCrossing {
    let deck = Deck {
        damping: DeckDamping::Rayleigh(0.01),
        ..simple(48.0, 1.5e12, 40_000.0, 0.0, 10)
    };
    let mut case = crossing(
        deck,
        train(Car::RailVehicle(trailer()), cars, 24.275),
        speed,
        step,
    );
    case.contact = contact;
    case.approach = 30.0;
    let behind = 24.275 * cars as f64;
    case.steps = ((30.0 + 48.0 + behind) / speed / step) as usize;
    case.track = Some(ballasted(-30.0 - behind - 20.0, 48.0 + behind + 20.0));
    case
}

pub(super) const HERTZ: Contact = Contact::Hertz {
    constant: 4.2206e-8,
};

/// The largest deviation from the first value, after a part of the run.
pub(super) fn swing(history: &[f64], from: usize) -> f64 {
    let first = history[0];
    history[from..]
        .iter()
        .map(|y| (y - first).abs())
        .fold(0.0, f64::max)
}
