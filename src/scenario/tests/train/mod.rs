//! Trains, tracks and their bridges as scenarios give them.

mod random;

use super::*;
use crate::quantity::Quantity;
use crate::scenario::train::static_wheels;
use crate::system::InitialState as BuiltState;
use crate::system::train::{Car, Contact, DeckDamping, Spans, Support, WheelProfile};

/// A train with every key of trains but those in `TRAIN_KINDS`.
const TRAIN: &str = r#"
[vehicle]
kind = "train"
speed = 50
approach = 60

[[vehicle.car]]
preset = "zeng-2014-trailer"
count = 3

[[vehicle.car]]
kind = "rail-vehicle"
behind = 100
length = 25
body_mass = 44000
body_pitch_inertia = 2.7e6
bogie_mass = 2400
bogie_pitch_inertia = 2200
wheelset_mass = 2400
primary_stiffness = 1.4e6
primary_damping = 8e4
secondary_stiffness = 6e5
secondary_damping = 8e4
bogie_spacing = 17.375
wheelbase = 2.5
wheel_radius = 0.46

[[vehicle.car.wheel_defect]]
kind = "flat"
wheel = 1
length = 0.05
depth = 0.5e-3
phase = 1

[[vehicle.car.wheel_defect]]
kind = "out-of-roundness"
wheel = 2
order = 3
amplitude = 1e-4
phase = 0.5

[[vehicle.car]]
kind = "half-car"
count = 1
behind = 130
length = 10
body_mass = 2e4
body_pitch_inertia = 1e5
front = { distance = 2, wheel_mass = 500, suspension_stiffness = 1e6, suspension_damping = 1e4, tyre_stiffness = 2e6 }
rear = { distance = 3, wheel_mass = 500, suspension_stiffness = 1e6, suspension_damping = 1e4, tyre_stiffness = 2e6 }

[[vehicle.car]]
kind = "sprung-mass"
count = 2
behind = 150
length = 5
body_mass = 5750
wheel_mass = 10
stiffness = 1595e3
damping = 10

[[vehicle.car]]
kind = "moving-mass"
count = 1
behind = 170
length = 5
mass = 1000

[[vehicle.car]]
kind = "moving-forces"
count = 2
behind = 190
length = 10
axle = [{ behind = 0, force = 1e5 }, { behind = 3, force = 2e5 }]

[contact]
kind = "linear"
stiffness = 1.4e9

[track]
kind = "ballasted"
rail = { flexural_rigidity = 1.325e7, mass_per_length = 121.28 }
fastener = { spacing = 0.6, stiffness = 1.3e8, damping = 1.5e5 }
sleeper = { mass = 251.0 }
ballast = { mass = 1062.8, stiffness = 2.755e8, damping = 1.176e5 }
subgrade = { stiffness = 1.55e8, damping = 6.23e4 }
on_bridge = { stiffness = 1e8, damping = 1e5, mass = 500 }
before = 10
after = 5
elements_per_bay = 2

[bridge]
spans = [32.0, 40.0, 32.0]
kind = "continuous"
mass_per_length = 29720
flexural_rigidity = 4.4e11
shear_rigidity = 1e10
section_modulus = 5
damping_ratio = 0.02
damping = "rayleigh"
bearings = { stiffness = 6e9, damping = 2e6 }
modes = 10
section = [{ name = "quarter", position = 8 }]

[simulation]
integrator = "newmark"
time_step = 0.001
duration = 3
record = ["bridge/quarter/shear_force", "vehicle/car-1/body/acceleration", "track/midspan/sleeper/velocity"]
"#;

/// Overrides of `TRAIN` to kinds and keys that it has not.
pub(super) const TRAIN_KINDS: [&[&str]; 3] = [
    &[
        "vehicle.car.0.wheel_radius=0.43",
        r#"contact={ kind = "hertz", constant = 4e-8 }"#,
        r#"track={ kind = "slab", preset = "zeng-2014-slab", start = -300, fasteners = 1000, elements_per_bay = 1, rail = { mass_per_length = 120 }, fastener = { spacing = 0.65 }, slab = { flexural_rigidity = 1e7, mass_per_length = 1000, fasteners = 10, mortar = { stiffness = 1e9, damping = 1e5 } } }"#,
    ],
    &[
        r#"contact={ kind = "hertz", wheel_profile = "cone" }"#,
        r#"track={ kind = "ballasted", preset = "zhai-2004-ballasted", window = 10 }"#,
        r#"simulation={ integrator = "newmark", time_step = 1e-3, duration = 1, record = ["vehicle/car-1/body/acceleration"], solution = "stepping" }"#,
    ],
    &[
        r#"vehicle={ kind = "load-model", model = "hslm-a1", speed = 50, approach = 10 }"#,
        "contact=",
        r#"track={ kind = "none" }"#,
    ],
];

pub(super) fn train() -> Scenario {
    Scenario::from_text("train.toml", TRAIN).unwrap()
}

fn with(options: &[&str]) -> Scenario {
    train().set(&sets(options)).unwrap()
}

/// The train of its first car table alone.
const TRAILERS: [&str; 5] = [
    "vehicle.car.5=",
    "vehicle.car.4=",
    "vehicle.car.3=",
    "vehicle.car.2=",
    "vehicle.car.1=",
];

fn trailers(options: &[&str]) -> Scenario {
    with(&[&TRAILERS, options].concat())
}

#[test]
fn a_train_is_built_as_it_is_given() {
    let (crossing, quantities) = train().train().unwrap();
    let names: Vec<String> = quantities.iter().map(Quantity::name).collect();
    assert_eq!(names, train().simulation().unwrap().record);
    assert_eq!(crossing.cars.len(), 10);
    assert_eq!(crossing.contact, Contact::Linear { stiffness: 1.4e9 });
    assert_eq!(
        (crossing.steps, crossing.initial_state),
        (3000, BuiltState::Profile)
    );
    let track = crossing.track.unwrap();
    // From 10 m behind the last force, at 60 + 190 + 10 + 3 m, to 5 m beyond 150 - 60 m.
    let (first, last) = (-263.0 - 10.0, 90.0 + 5.0_f64);
    let first_fastener = (first / 0.6_f64).floor() * 0.6;
    assert!(
        (track.start - first_fastener).abs() < 1e-9,
        "{}",
        track.start
    );
    let end = track.start + (track.fasteners - 1) as f64 * track.spacing;
    // ... but at least 5 m beyond the bridge.
    assert!(
        (104.0 + 5.0..104.0 + 5.6).contains(&end) && last < end,
        "{end}"
    );
    let whole = track.start / track.spacing;
    assert!((whole - whole.round()).abs() < 1e-9);
    assert_eq!(track.elements, 2);
    let Support::Ballasted(ballast) = track.support else {
        panic!("ballasted");
    };
    assert_eq!(
        (ballast.on_bridge.mass, ballast.on_bridge.bed.stiffness),
        (500.0, 1e8)
    );
    let deck = crossing.deck.unwrap();
    assert_eq!(deck.spans, [32.0, 40.0, 32.0]);
    assert_eq!(
        (deck.kind, deck.damping),
        (Spans::Continuous, DeckDamping::Rayleigh(0.02))
    );
}

#[test]
fn presets_have_their_values_unless_overridden() {
    let scenario = trailers(&[
        "vehicle.car.0.body_mass=50e3",
        r#"track={ kind = "ballasted", preset = "zhai-2004-ballasted", sleeper = { mass = 300 } }"#,
        r#"contact={ kind = "hertz" }"#,
    ]);
    let (crossing, _) = scenario.train().unwrap();
    let Car::RailVehicle(car) = &crossing.cars[0].car else {
        panic!("a rail vehicle");
    };
    assert_eq!((car.body_mass, car.secondary_stiffness), (50e3, 6e5));
    let constant = WheelProfile::Worn.constant(0.46);
    assert_eq!(crossing.contact, Contact::Hertz { constant });
    let Some(Support::Ballasted(ballast)) = crossing.track.map(|track| track.support) else {
        panic!("ballasted");
    };
    assert_eq!(
        (ballast.sleeper_mass, ballast.ballast_mass),
        (300.0, 1062.8)
    );
    // By default the bridge's ballast is that of the track, and moves with the deck.
    assert_eq!(ballast.on_bridge.bed, ballast.ballast);
    assert_eq!(ballast.on_bridge.mass, 1062.8);
}

#[test]
fn the_static_axle_load_and_the_linearised_contact_are_those_of_the_trailer() {
    let (crossing, _) = trailers(&["contact={ kind = \"linear\" }"])
        .train()
        .unwrap();
    let wheels = static_wheels(&crossing);
    assert_eq!(wheels.len(), 12);
    // (M_c/4 + M_t/2 + M_w) g = 143226 N.
    assert!(
        wheels
            .iter()
            .all(|wheel| (wheel.force - 143_226.0).abs() < 1e-6)
    );
    let Contact::Linear { stiffness } = crossing.contact else {
        panic!("linear");
    };
    // Two wheels of 1.4759e9 N/m each.
    assert!(
        (stiffness / (2.0 * 1.4759e9) - 1.0).abs() < 1e-4,
        "{stiffness}"
    );
}

#[test]
fn a_slab_track_begins_a_slab_at_the_bridge() {
    let slab = r#"track={ kind = "slab", preset = "zeng-2014-slab" }"#;
    let options = [
        slab,
        "simulation.record=[\"track/midspan/slab/displacement\"]",
    ];
    let (crossing, _) = trailers(&options).train().unwrap();
    let track = crossing.track.unwrap();
    let slabs = track.start / (8.0 * 0.629);
    assert!((slabs - slabs.round()).abs() < 1e-9);
    assert_eq!(track.fasteners % 8, 0);
    let end = track.start + (track.fasteners - 1) as f64 * track.spacing;
    assert!(end >= 104.0 + 20.0);
}

#[test]
fn a_train_needs_no_bridge_or_no_track() {
    let rail = [
        "bridge=",
        "simulation.record=[\"vehicle/car-3/wheel-4/contact_force\"]",
    ];
    assert!(trailers(&rail).train().unwrap().0.deck.is_none());
    let message = trailers(&[&rail[..], &["track="]].concat())
        .train()
        .unwrap_err()
        .to_string();
    assert!(message.contains("bridge: missing"), "{message}");
    let bridge = ["track=", "simulation.record=[\"bridge/midspan/stress\"]"];
    assert!(trailers(&bridge).train().unwrap().0.track.is_none());
}

#[test]
fn what_a_train_cannot_have_is_refused() {
    let refused = |options: &[&str], message: &str| {
        let error = trailers(options).train().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.to_string(), message);
    };
    refused(
        &["simulation.integrator=zhai"],
        "--set: simulation.integrator: expected \"newmark\", the scheme of trains: an explicit one would need a step \
         below 2.619e-3 s, 2/omega of a wheel on its contact stiffness, found \"zhai\"",
    );
    refused(
        &["simulation.integrator=zhai", "contact={ kind = \"rigid\" }"],
        "--set: simulation.integrator: expected \"newmark\", the scheme of trains: an explicit one can't take a rigid \
         contact at any step, found \"zhai\"",
    );
    refused(
        &["simulation.record.0=vehicle/car-1/body/aceleration"],
        "--set: simulation.record: expected a known quantity, found \"vehicle/car-1/body/aceleration\"; \
         did you mean \"vehicle/car-1/body/acceleration\"?",
    );
    let error = example()
        .set(&sets(&["bridge.kind=simple"]))
        .unwrap()
        .bridge();
    assert_eq!(
        error.unwrap_err().to_string(),
        "--set: bridge.kind: expected no such key, but with vehicle.kind = \"train\" or \"load-model\", found \
         vehicle.kind = \"quarter-car\"",
    );
}

#[test]
fn the_irregularity_starts_at_the_last_wheel() {
    let text = format!(
        "{TRAIN}\n[irregularity]\nlength = 400\nspacing = 0.1\ndeterministic = {{ kind = \"sine\", amplitude = 1e-3, wavelength = 5 }}\n"
    );
    let scenario = Scenario::from_text("train.toml", &text).unwrap();
    let irregularity = scenario.irregularity().unwrap();
    assert_eq!(scenario.irregularity_start(&irregularity).unwrap(), -263.0);
}

#[test]
fn of_many_cars_the_names_of_the_first_are_shown() {
    let options = ["simulation.record=[\"nonsense\"]"];
    let message = trailers(&options).train().unwrap_err().to_string();
    assert!(
        message.contains("\"vehicle/car-1/bogie-2/pitch/velocity\""),
        "{message}"
    );
    assert!(
        message.ends_with("and those of the other cars"),
        "{message}"
    );
    assert!(!message.contains("car-2"), "{message}");
}
