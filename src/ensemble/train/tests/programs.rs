//! Trains against the figures of independent programs.

use super::*;

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

/// The default case of TTB-2D (D. Cantero, SoftwareX 20 (2022) 101253), computed by an independent program: vehicle 1 of the
/// Manchester benchmarks at 120 km/h, smooth ballasted track, rigid contact, a bridge of 50.1 m.
#[test]
fn the_default_case_of_a_published_program() {
    let deck = Deck {
        damping: DeckDamping::Rayleigh(0.01),
        ..simple(50.1, 35e9 * 51.3, 69_000.0, 0.0, 10)
    };
    let car = RailVehicle {
        body_mass: 32_000.0,
        body_pitch_inertia: 1.97e6,
        bogie_mass: 2615.0,
        bogie_pitch_inertia: 1476.0,
        wheelset_mass: 1813.0,
        primary_stiffness: 2.4e6,
        primary_damping: 8e3,
        secondary_stiffness: 8.6e5,
        secondary_damping: 4e4,
        bogie_spacing: 19.0,
        wheelbase: 2.56,
        ..trailer()
    };
    let cars = train(Car::RailVehicle(car), 1, 0.0);
    let mut case = crossing(deck, cars, 120.0 / 3.6, 1e-3);
    case.contact = Contact::Rigid;
    case.approach = 24.0;
    case.steps = 2900;
    let bed = Fastener {
        stiffness: 137.75e6,
        damping: 5.88e4,
    };
    case.track = Some(Track {
        rail: Rail {
            flexural_rigidity: 2.059e11 * 6.434e-5,
            mass_per_length: 121.28,
        },
        fastener: Fastener {
            stiffness: 6.5e7,
            damping: 7.5e4,
        },
        support: Support::Ballasted(Ballast {
            sleeper_mass: 251.0,
            ballast_mass: 531.4,
            ballast: bed,
            subgrade: Fastener {
                stiffness: 77.5e6,
                damping: 3.115e4,
            },
            on_bridge: OnBridge { bed, mass: 531.4 },
        }),
        ..ballasted(-51.6, 114.0)
    });
    let names = [
        "bridge/midspan/displacement",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
        "vehicle/car-1/wheel-2/contact_force",
        "vehicle/car-1/wheel-3/contact_force",
        "vehicle/car-1/wheel-4/contact_force",
    ];
    let found = histories(&case, &names, |_| 0.0);
    let range = |history: &[f64]| {
        let low = history.iter().copied().fold(f64::INFINITY, f64::min);
        [
            low,
            history.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let near = |found: f64, expected: f64, allowed: f64| {
        assert!(
            (found / expected - 1.0).abs() < allowed,
            "{found} {expected}"
        );
    };
    near(peak(&found[0]), 0.541332e-3, 1e-3);
    let [low, high] = range(&found[1]);
    near(low, -0.009311, 1e-3);
    near(high, 0.008380, 1e-3);
    // Of all wheels while they are on the bridge.
    let forces: Vec<f64> = found[2..]
        .iter()
        .zip([0.0, 2.56, 19.0, 21.56])
        .flat_map(|(force, behind)| {
            let place = move |n: usize| 120.0 / 3.6 * n as f64 * 1e-3 - 24.0 - behind;
            let steps = force.iter().enumerate();
            steps.filter(move |(n, _)| (0.0..=50.1).contains(&place(*n)))
        })
        .map(|(_, force)| *force)
        .collect();
    let [low, high] = range(&forces);
    near(low, 107_947.0, 1e-3);
    near(high, 109_783.0, 1e-3);
}
