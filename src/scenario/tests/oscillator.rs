//! Oscillators and excitations as scenarios give them.

use super::*;

/// A chain with every key of oscillators and excitations but those in `CHAIN_KINDS`.
const CHAIN: &str = r#"
[excitation]
component = "force"
spectrum = { kind = "clough-penzien", density = 5e-3, ground_frequency = 15, ground_damping_ratio = 0.6, filter_frequency = 1.5, filter_damping_ratio = 0.6 }
frequency = { max = 75, count = 500 }
field = "gaussian"
modulation = { kind = "jennings", rise = 2, end = 8, decay = 0.2 }
duration = 15
time_step = 0.02

[oscillator]
excitation = "force"
interpolation = "constant"
rayleigh = { damping_ratio = 0.05, first_mode = 1, second_mode = 2 }

[[oscillator.storey]]
mass = 8000
stiffness = 1e7
damping = 1e3
cubic_stiffness = 1e9
initial_displacement = 1e-3
initial_velocity = -0.1
bouc_wen = { yield_displacement = 1.25e-3, post_yield_ratio = 0.1, amplitude = 1, beta = 0.5, gamma = 0.5, exponent = 2 }
power_law_damping = { coefficient = 800, exponent = 0.3 }
van_der_pol = { coefficient = 10, amplitude = 0.1 }

[[oscillator.storey]]
natural_frequency = 30
damping_ratio = 0.02
cubic_ratio = 10
"#;

/// Overrides of `CHAIN` to kinds that it has not.
pub(super) const CHAIN_KINDS: [[&str; 2]; 2] = [
    [
        r#"excitation.spectrum={ kind = "table", file = "s.csv", sided = "one", unit = "Hz", frequency_column = "f", density_column = "G" }"#,
        r#"excitation.modulation={ kind = "exponential", decay = 0.1, rise = 0.5 }"#,
    ],
    [
        r#"excitation.spectrum={ kind = "white", density = 1 }"#,
        "excitation.modulation=",
    ],
];

pub(super) fn chain() -> Scenario {
    Scenario::from_text("chain.toml", CHAIN).unwrap()
}

/// A single oscillator with every key.
const SINGLE: &str = r#"
[oscillator]
mass = 2
stiffness = 50
damping_ratio = 0.05
cubic_ratio = 3
initial_displacement = 0.1
initial_velocity = 0.2
bouc_wen = { yield_displacement = 0.01, post_yield_ratio = 0.1 }
power_law_damping = { coefficient = 800, exponent = 0.3 }
van_der_pol = { coefficient = 10, amplitude = 0.1 }

[simulation]
integrator = "runge-kutta"
time_step = 0.01
duration = 1
record = ["oscillator/displacement", "oscillator/hysteretic_variable"]
"#;

/// Overrides of `SINGLE` to the other ways of giving the same.
pub(super) const SINGLE_OTHERWISE: [&str; 6] = [
    "oscillator.stiffness=",
    "oscillator.natural_frequency=5",
    "oscillator.damping_ratio=",
    "oscillator.damping=1",
    "oscillator.cubic_ratio=",
    "oscillator.cubic_stiffness=150",
];

pub(super) fn single() -> Scenario {
    Scenario::from_text("single.toml", SINGLE).unwrap()
}

#[test]
fn an_oscillator_is_built_as_it_is_given() {
    let (chain, quantities) = single().chain().unwrap();
    let names: Vec<String> = quantities.iter().map(|q| q.name()).collect();
    assert_eq!(
        names,
        ["oscillator/displacement", "oscillator/hysteretic_variable"]
    );
    let [storey] = chain.storeys.as_slice() else {
        panic!("one storey");
    };
    // c = 2 ζ √(k m), k₃ = ε k; α k and (1 − α) k d_y.
    let element = storey.element();
    assert_eq!((element.stiffness, element.cubic), (5.0, 150.0));
    assert!((element.damping - 1.0).abs() < 1e-15);
    assert!((element.hysteresis[0] - 0.45).abs() < 1e-15);
    assert_eq!(&element.hysteresis[1..], [100.0, 50.0, 50.0, 1.0]);
    let frequency = [
        "oscillator.stiffness=",
        "oscillator.mass=",
        "oscillator.natural_frequency=6",
    ];
    let frequency = single().set(&sets(&frequency)).unwrap();
    let (chain, _) = frequency.chain().unwrap();
    assert_eq!(
        (chain.storeys[0].mass, chain.storeys[0].stiffness()),
        (1.0, 36.0)
    );
}

#[test]
fn what_an_oscillator_cannot_do_is_refused() {
    let refused = |set: &str, message: &str| {
        let error = single().set(&sets(&[set])).unwrap().chain().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.to_string(), message);
    };
    refused(
        "simulation.integrator=\"newmark\"",
        "--set: simulation.integrator: expected \"runge-kutta\", the scheme of oscillators, found \"newmark\"",
    );
    refused(
        "simulation.initial_state=\"profile\"",
        "--set: simulation.initial_state: expected no such key beside [oscillator], whose storeys have initial states \
         of their own, found \"profile\"",
    );
    refused(
        "simulation.time_step=0.6",
        "--set: simulation.time_step: expected at most 0.581 s, the largest stable step of runge-kutta, found 0.6 s; \
         take a smaller step (simulation.record_every thins the recording)",
    );
    refused(
        "simulation.record=[\"oscillator/displacment\"]",
        "--set: simulation.record: expected a known quantity, found \"oscillator/displacment\"; \
         did you mean \"oscillator/displacement\"?",
    );
    let error = example().set(&sets(&["simulation.integrator=\"runge-kutta\""]));
    let error = error.unwrap().crossing().unwrap_err();
    assert!(
        error
            .to_string()
            .contains("a scheme of crossings, one of \"explicit-newmark\"")
    );
}

#[test]
fn values_from_elsewhere_are_held_to_the_bounds_of_their_key() {
    let scenario = chain();
    let bad = |key: &str, values: &[f64]| scenario.first_bad(key, values);
    assert_eq!(bad("oscillator.storey.1.mass", &[1.0, 2.0]), None);
    let found = bad("oscillator.storey.1.mass", &[1.0, -2.0, 0.0]);
    assert_eq!(found, Some((1, "a number above 0 (kg)".to_owned())));
    assert!(bad("oscillator.bouc_wen.post_yield_ratio", &[1.5]).is_some());
}
