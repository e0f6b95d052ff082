//! Trains against closed forms and published figures.

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

/// Three trailers on a span of 32.5 m without track: data of Zeng et al. 2014, figures computed independently.
#[test]
fn three_cars_without_track() {
    for (speed, midspan, bodies) in [
        (200.0 / 3.6, 0.8827e-3, Some([0.01291, 0.01162, 0.01296])),
        (350.0 / 3.6, 1.0073e-3, None),
    ] {
        let deck = simple(32.5, 3.45e10 * 12.744, 29_720.0, 0.05, 6);
        let cars = train(Car::RailVehicle(trailer()), 3, 24.275);
        let case = crossing(deck, cars, speed, 5e-4);
        let names = [
            "bridge/midspan/displacement",
            "vehicle/car-1/body/acceleration",
            "vehicle/car-2/body/acceleration",
            "vehicle/car-3/body/acceleration",
        ];
        let found = histories(&case, &names, |_| 0.0);
        let y = peak(&found[0]);
        assert!((y / midspan - 1.0).abs() < 1e-3, "{y}");
        for (k, expected) in bodies.into_iter().flatten().enumerate() {
            let a = peak(&found[k + 1]);
            assert!((a / expected - 1.0).abs() < 5e-3, "{k} {a}");
        }
    }
}

/// A car on ballasted track, 60 m of it before and after a bridge of 48 m.
fn on_track(contact: Contact, step: f64, cars: usize, speed: f64) -> TrainCrossing {
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

const HERTZ: Contact = Contact::Hertz {
    constant: 4.2206e-8,
};

/// A wheel that stands between and on fasteners so close that they are a bed: the beam on an elastic foundation
/// deflects by P λ / (2 k), λ⁴ = k / (4 EI); and every wheel carries its weight.
#[test]
fn standing_wheel_on_a_bed() {
    let (rigidity, bed, spacing) = (6.6e6, 5e7, 0.05);
    let track = Track {
        start: -10.0,
        fasteners: 401,
        spacing,
        elements: 1,
        rail: Rail {
            flexural_rigidity: rigidity,
            mass_per_length: 60.0,
        },
        fastener: Fastener {
            stiffness: bed * spacing,
            damping: 1e3,
        },
        support: Support::Direct,
        window: None,
    };
    let case = TrainCrossing {
        cars: train(Car::MovingMass { mass: 8000.0 }, 1, 0.0),
        contact: HERTZ,
        track: Some(track),
        deck: None,
        speed: 1e-9,
        approach: 0.02,
        gravity: 9.81,
        time_step: 1e-4,
        steps: 20,
        record_every: 1,
        initial_state: InitialState::Level,
    };
    let names = [
        "vehicle/car-1/wheel-1/contact_force",
        "vehicle/car-1/wheel-1/displacement",
    ];
    let found = histories(&case, &names, |_| 0.0);
    let weight = 8000.0 * 9.81;
    let root = (bed / (4.0 * rigidity)).powf(0.25);
    let exact = -weight * root / (2.0 * bed);
    for (force, y) in found[0].iter().zip(&found[1]) {
        assert!((force / weight - 1.0).abs() < 1e-9, "{force}");
        assert!((y / exact - 1.0).abs() < 2e-3, "{y} {exact}");
    }
}

/// At rest on track and bridge nothing moves, with every law and every support.
#[test]
fn a_train_at_rest_stays_at_rest() {
    let slab = Support::Slab(Slab {
        flexural_rigidity: 3.6e10 * 1.6e-3,
        mass_per_length: 1200.0,
        fasteners: 10,
        mortar: Fastener {
            stiffness: 3e9,
            damping: 1.66e5,
        },
    });
    let sprung = ballasted(0.0, 1.0).support;
    for contact in [Contact::Rigid, Contact::Linear { stiffness: 2.8e9 }, HERTZ] {
        for support in [sprung.clone(), slab.clone(), Support::Direct] {
            for approach in [40.0, -30.3] {
                let mut case = on_track(contact, 1e-3, 1, 1e-12);
                case.approach = approach;
                case.steps = 40;
                let track = case.track.as_mut().unwrap();
                track.start -= 30.0;
                track.fasteners += 50;
                track.support = support.clone();
                let names = [
                    "vehicle/car-1/wheel-2/contact_force",
                    "vehicle/car-1/body/acceleration",
                    "bridge/midspan/acceleration",
                ];
                let found = histories(&case, &names, |_| 0.0);
                let weight = trailer().axle_load(9.81);
                for force in &found[0] {
                    assert!((force / weight - 1.0).abs() < 1e-9, "{contact:?} {force}");
                }
                assert!(peak(&found[1]) < 1e-7 && peak(&found[2]) < 1e-7);
            }
        }
    }
}

/// What the track beyond the window would do is less than a thousandth of any peak.
#[test]
fn windows_agree_with_the_whole_track() {
    let names = [
        "bridge/midspan/displacement",
        "bridge/midspan/acceleration",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
        "track/midspan/rail/displacement",
    ];
    let sine = |x: f64| 0.5e-3 * (std::f64::consts::TAU * x / 3.0).sin();
    for speed in [200.0 / 3.6, 350.0 / 3.6] {
        let mut case = on_track(HERTZ, 1e-3, 2, speed);
        case.approach = 60.0;
        case.steps = (170.0 / speed / 1e-3) as usize;
        let whole = Track {
            window: None,
            ..ballasted(-160.0, 140.0)
        };
        case.track = Some(whole.clone());
        let exact = histories(&case, &names, sine);
        for margin in [8.0, 20.0] {
            case.track = Some(Track {
                window: Some(margin),
                ..whole.clone()
            });
            let found = histories(&case, &names, sine);
            for (k, (found, exact)) in found.iter().zip(&exact).enumerate() {
                let start = exact[0];
                let size = exact.iter().map(|y| (y - start).abs()).fold(0.0, f64::max);
                let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs());
                let off = off.fold(0.0, f64::max) / size;
                assert!(off < 1e-3 / margin, "{} {margin} {off}", names[k]);
            }
        }
    }
}

/// Linear contact: superposition is what stepping gives, but for rounding.
#[test]
fn superposition_is_stepping() {
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
        "vehicle/car-1/wheel-2/unloading_ratio",
        "vehicle/car-1/wheel-3/irregularity",
    ];
    let quantities: Vec<Quantity> = names.iter().map(|n| Quantity::named(n).unwrap()).collect();
    for (contact, initial_state) in [
        (Contact::Rigid, InitialState::Profile),
        (Contact::Linear { stiffness: 2.8e9 }, InitialState::Level),
    ] {
        let mut case = on_track(contact, 1e-3, 1, 300.0 / 3.6);
        case.initial_state = initial_state;
        case.record_every = 10;
        case.track.as_mut().unwrap().window = Some(12.0);
        let (start, spacing, count) = (-60.0, 0.5, 400);
        let points = 21;
        let rows: Vec<f64> = (0..count * points)
            .map(|k| 1e-3 * (1.7 * k as f64).sin())
            .collect();
        let trains = Trains::new(case, &quantities, (start, spacing, count)).unwrap();
        let run = |system: &dyn System| {
            let size = system.times().len() * system.outputs();
            let mut values = vec![0.0; size * points];
            for (number, strip) in Strip::cut(&mut values, points, system.lanes())
                .iter_mut()
                .enumerate()
            {
                let first = number * system.lanes();
                let range = first..(first + system.lanes()).min(points);
                let some = Points {
                    excitation: &rows[range.start * count..range.end * count],
                    samples: count,
                    parameters: &[],
                    range,
                };
                system.stepper().run(&some, strip).unwrap();
            }
            values
        };
        let stepped = run(&trains);
        let summed = run(&trains.superpose().unwrap());
        for k in 0..names.len() {
            let of = |values: &[f64]| -> Vec<f64> {
                let rows = values.chunks_exact(points).skip(k).step_by(names.len());
                rows.flatten().copied().collect()
            };
            let (a, b) = (of(&stepped), of(&summed));
            let size = peak(&a);
            for (a, b) in a.iter().zip(&b) {
                assert!((a - b).abs() < 1e-7 * size, "{} {a} {b}", names[k]);
            }
        }
    }
}

/// Random parameters in the lanes, the speed among them, against each by itself.
#[test]
fn lanes_with_parameters_of_their_own() {
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
    ];
    let quantities: Vec<Quantity> = names.iter().map(|n| Quantity::named(n).unwrap()).collect();
    let of = |mass: f64, rigidity: f64, speed: f64| {
        let mut case = on_track(HERTZ, 5e-4, 1, 200.0 / 3.6);
        let Car::RailVehicle(vehicle) = &mut case.cars[0].car else {
            unreachable!("a rail vehicle")
        };
        vehicle.body_mass = mass;
        case.deck.as_mut().unwrap().flexural_rigidity = rigidity;
        case.speed = speed;
        case.record_every = 4;
        case.steps = 2000;
        case.track = Some(ballasted(-80.0, 60.0));
        case
    };
    let values = [
        [44e3, 1.5e12, 200.0 / 3.6],
        [40e3, 1.2e12, 180.0 / 3.6],
        [50e3, 1.7e12, 230.0 / 3.6],
    ];
    let row: Vec<f64> = (0..4000).map(|k| 5e-4 * (0.02 * k as f64).sin()).collect();
    let (start, spacing, count) = (-80.0, 0.05, 4000);
    let rows = [row.clone(), row.clone(), row.clone()].concat();
    let parameters: Vec<Vec<f64>> = (0..3)
        .map(|k| values.iter().map(|point| point[k]).collect())
        .collect();
    let trains = Trains::varied(
        of(44e3, 1.5e12, 200.0 / 3.6),
        &quantities,
        (start, spacing, count),
        Some(230.0 / 3.6),
        (vec![0, 1, 2], true),
        Box::new(move |v| of(v[0], v[1], v[2])),
    )
    .unwrap();
    let records = trains.times().len();
    let mut together = vec![0.0; records * 3 * 3];
    let points = Points {
        excitation: &rows,
        samples: count,
        parameters: &parameters,
        range: 0..3,
    };
    trains
        .stepper()
        .run(&points, &mut Strip::cut(&mut together, 3, 3)[0])
        .unwrap();
    for (lane, v) in values.iter().enumerate() {
        let alone = Trains::new(of(v[0], v[1], v[2]), &quantities, (start, spacing, count));
        let alone = alone.unwrap();
        let mut own = vec![0.0; records * 3];
        let point = Points {
            excitation: &row,
            samples: count,
            parameters: &[],
            range: 0..1,
        };
        alone
            .stepper()
            .run(&point, &mut Strip::cut(&mut own, 1, 1)[0])
            .unwrap();
        for (k, name) in names.iter().enumerate() {
            let found: Vec<f64> = together
                .iter()
                .skip(3 * k + lane)
                .step_by(9)
                .copied()
                .collect();
            let exact: Vec<f64> = own.iter().skip(k).step_by(3).copied().collect();
            let size = exact
                .iter()
                .map(|y| (y - exact[0]).abs())
                .fold(0.0, f64::max);
            let off = found
                .iter()
                .zip(&exact)
                .skip(20)
                // The last step of a run is half as long.
                .take(records - 21)
                .map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max) / size;
            // Lanes of another speed differ by their step in time.
            assert!(
                off < if lane == 0 { 1e-9 } else { 1e-2 },
                "{} {lane} {off}",
                name
            );
        }
    }
}

/// Cars of their own on a track that all lanes share, against each by itself: with linear contact and with Hertz's.
#[test]
fn lanes_with_cars_of_their_own() {
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
    ];
    let quantities: Vec<Quantity> = names.iter().map(|n| Quantity::named(n).unwrap()).collect();
    let grid = (-100.0, 0.1, 2000);
    let row: Vec<f64> = (0..2000).map(|k| 5e-4 * (0.04 * k as f64).sin()).collect();
    for contact in [HERTZ, Contact::Rigid] {
        let of = move |mass: f64, stiffness: f64| {
            let mut case = on_track(contact, 1e-3, 1, 200.0 / 3.6);
            let Car::RailVehicle(vehicle) = &mut case.cars[0].car else {
                unreachable!("a rail vehicle")
            };
            vehicle.body_mass = mass;
            vehicle.primary_stiffness = stiffness;
            case.track.as_mut().unwrap().window = Some(8.0);
            case
        };
        let values = [[44e3, 1.4e6], [36e3, 1.6e6]];
        let parameters = vec![vec![44e3, 36e3], vec![1.4e6, 1.6e6]];
        let trains = Trains::varied(
            of(44e3, 1.4e6),
            &quantities,
            grid,
            None,
            (vec![0, 1], false),
            Box::new(move |v| of(v[0], v[1])),
        )
        .unwrap();
        let run = |trains: &Trains, parameters: &[Vec<f64>], points: usize| {
            let rows = row.repeat(points);
            let mut values = vec![0.0; trains.times().len() * names.len() * points];
            let some = Points {
                excitation: &rows,
                samples: row.len(),
                parameters,
                range: 0..points,
            };
            let mut strips = Strip::cut(&mut values, points, points);
            trains.stepper().run(&some, &mut strips[0]).unwrap();
            drop(strips);
            values
        };
        let together = run(&trains, &parameters, 2);
        for (lane, v) in values.iter().enumerate() {
            let alone = Trains::new(of(v[0], v[1]), &quantities, grid).unwrap();
            let own = run(&alone, &[], 1);
            for (k, name) in names.iter().enumerate() {
                let size = own
                    .iter()
                    .skip(k)
                    .step_by(3)
                    .map(|y| y.abs())
                    .fold(0.0, f64::max);
                let found = together.iter().skip(2 * k + lane).step_by(6);
                for (a, b) in found.zip(own.iter().skip(k).step_by(3)) {
                    assert!((a - b).abs() < 1e-8 * size, "{contact:?} {name} {a} {b}");
                }
            }
        }
    }
}

/// The largest deviation from the first value, after a part of the run.
fn swing(history: &[f64], from: usize) -> f64 {
    let first = history[0];
    history[from..]
        .iter()
        .map(|y| (y - first).abs())
        .fold(0.0, f64::max)
}

/// A car over ballasted track and a bridge against an independent program (finite elements of a quarter bay, steps of 0.125 ms,
/// contact forces as unknowns of one constant matrix): smooth with rigid contact, and a sine of 0.5 mm and 3 m with Hertz's.
#[test]
fn one_car_over_track_and_bridge() {
    let names = [
        "bridge/midspan/displacement",
        "bridge/midspan/bending_moment",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/body/front/acceleration",
        "vehicle/car-1/body/rear/acceleration",
    ];
    let sine = |x: f64| 0.5e-3 * (std::f64::consts::TAU * x / 3.0).sin();
    for (contact, rough, expected) in [
        (
            Contact::Rigid,
            false,
            [0.749772e-3, 4.8938e6, 0.016706, 0.01926, 0.02095],
        ),
        (
            HERTZ,
            false,
            [0.749773e-3, 4.8936e6, 0.016697, 0.01944, 0.02112],
        ),
        (
            HERTZ,
            true,
            [0.748123e-3, 4.9198e6, 0.103047, 0.15210, 0.14073],
        ),
    ] {
        let mut case = on_track(contact, 5e-4, 1, 200.0 / 3.6);
        case.steps = 4320;
        case.track = Some(Track {
            window: Some(8.0),
            ..ballasted(-60.0, 102.0)
        });
        let found = if rough {
            histories(&case, &names, sine)
        } else {
            histories(&case, &names, |_| 0.0)
        };
        for (k, expected) in expected.into_iter().enumerate() {
            let off = peak(&found[k]) / expected - 1.0;
            assert!(off.abs() < 3e-3, "{contact:?} {} {off}", names[k]);
        }
    }
}

/// A spring of 1e12 N/m is rigid; at 0.01 mm Hertz's law is its tangent.
#[test]
fn contact_laws_agree_where_they_should() {
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
        "track/midspan/rail/displacement",
    ];
    let weight = trailer().axle_load(9.81);
    let tangent = Contact::linearised(4.2206e-8, weight);
    for (one, other, amplitude, allowed, dynamic) in [
        (
            Contact::Rigid,
            Contact::Linear { stiffness: 1e12 },
            0.5e-3,
            1e-3,
            false,
        ),
        (
            HERTZ,
            Contact::Linear { stiffness: tangent },
            1e-5,
            1e-2,
            true,
        ),
    ] {
        let sine = |x: f64| amplitude * (std::f64::consts::TAU * x / 3.0).sin();
        let run = |contact| histories(&on_track(contact, 1e-3, 1, 200.0 / 3.6), &names, sine);
        let (a, b) = (run(one), run(other));
        for (k, (a, b)) in a.iter().zip(&b).enumerate() {
            let size = if dynamic { swing(a, 100) } else { peak(a) };
            let off = a
                .iter()
                .zip(b)
                .skip(100)
                .map(|(x, y)| (x - y).abs())
                .fold(0.0, f64::max);
            assert!(off < allowed * size, "{} {}", names[k], off / size);
        }
    }
}

/// Second order in time.
#[test]
fn order_of_the_scheme() {
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
    ];
    let bump = |x: f64| {
        if (-8.0..12.0).contains(&x) {
            5e-4 * (1.0 - (std::f64::consts::TAU * (x + 8.0) / 20.0).cos())
        } else {
            0.0
        }
    };
    let at = |step: f64| {
        let mut case = on_track(Contact::Linear { stiffness: 2.8e9 }, step, 1, 200.0 / 3.6);
        case.steps = (1.0 / step).round() as usize + 1;
        let every = (0.02 / step).round() as usize;
        let found = histories(&case, &names, bump);
        found
            .into_iter()
            .map(|h| h.into_iter().step_by(every).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    let runs = [2e-3, 1e-3, 5e-4].map(at);
    for k in 0..names.len() {
        let off = |a: usize, b: usize| -> f64 {
            let pairs = runs[a][k].iter().zip(&runs[b][k]).skip(10);
            pairs.map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
        };
        let order = (off(0, 1) / off(1, 2)).log2();
        assert!((order - 2.0).abs() < 0.3, "{} {order}", names[k]);
    }
}

/// A wheel dropped off a step of 3 mm leaves the rail and comes back; undamped, it rises no higher than it fell from.
#[test]
fn a_wheel_leaves_the_rail_and_returns() {
    let track = Track {
        fastener: Fastener {
            stiffness: 1e8,
            damping: 0.0,
        },
        support: Support::Direct,
        ..ballasted(-10.0, 40.0)
    };
    let case = TrainCrossing {
        cars: train(Car::MovingMass { mass: 1000.0 }, 1, 0.0),
        contact: HERTZ,
        track: Some(track),
        deck: None,
        speed: 20.0,
        approach: 0.0,
        gravity: 9.81,
        time_step: 1e-4,
        steps: 10_000,
        record_every: 1,
        initial_state: InitialState::Profile,
    };
    let names = [
        "vehicle/car-1/wheel-1/contact_force",
        "vehicle/car-1/wheel-1/displacement",
    ];
    let found = histories(&case, &names, |x| if x < 5.0 { 3e-3 } else { 0.0 });
    let lifted = found[0].iter().filter(|force| **force == 0.0).count();
    assert!(lifted > 50, "{lifted}");
    let fell = found[1][0];
    let after = found[1].iter().skip(2600).copied();
    assert!(after.clone().fold(f64::MIN, f64::max) < fell);
    let last = &found[0][9000..];
    assert!(last.iter().any(|force| *force > 0.0));
}

/// Waves on a wheel act as the rail's waves of the same length would, under that wheel alone.
#[test]
fn waves_on_a_wheel() {
    let names = [
        "vehicle/car-1/wheel-2/irregularity",
        "vehicle/car-1/wheel-1/irregularity",
        "vehicle/car-1/wheel-2/contact_force",
    ];
    let mut case = on_track(HERTZ, 1e-3, 1, 200.0 / 3.6);
    let Car::RailVehicle(vehicle) = &mut case.cars[0].car else {
        unreachable!("a rail vehicle")
    };
    let waves = crate::irregularity::WheelDefect::OutOfRoundness {
        order: 2,
        amplitude: 1e-4,
        phase: 0.3,
    };
    vehicle.wheel_defects.push((1, waves));
    let found = histories(&case, &names, |_| 0.0);
    for (n, height) in found[0].iter().enumerate().take(case.steps) {
        let rolled = case.speed * (n as f64 + 0.5) * case.time_step;
        assert!((height - 1e-4 * (2.0 * rolled / 0.46 + 0.3).sin()).abs() < 1e-15);
    }
    assert_eq!(peak(&found[1]), 0.0);
    assert!(swing(&found[2], 100) > 1e3);
}
