//! Chains against exact answers, identities and their order.

mod laws;

use super::*;
use crate::quantity::{Motion, OscillatorResponse};
use crate::system::{Cubic, Damping, Excitation, Load, Rayleigh, Stiffness, Storey};
use std::f64::consts::PI;

/// A mass of 1 kg on a spring of ω₀ (rad/s).
fn storey(frequency: f64) -> Storey {
    Storey {
        mass: 1.0,
        stiffness: Stiffness::NaturalFrequency(frequency),
        damping: Damping::Ratio(0.0),
        cubic: Cubic::Ratio(0.0),
        power_law: None,
        van_der_pol: None,
        bouc_wen: None,
        initial_displacement: 0.0,
        initial_velocity: 0.0,
    }
}

fn chain(storeys: Vec<Storey>, time_step: f64, duration: f64) -> Chain {
    Chain {
        storeys,
        rayleigh: None,
        excitation: None,
        time_step,
        steps: (duration / time_step).round() as usize,
        record_every: 1,
    }
}

fn excited(mut chain: Chain, load: Load, between: Interpolation) -> Chain {
    chain.excitation = Some(Excitation { load, between });
    chain
}

fn response(response: OscillatorResponse) -> Quantity {
    Quantity::Oscillator {
        storey: None,
        response,
    }
}

fn of_storey(storey: usize, response: OscillatorResponse) -> Quantity {
    Quantity::Oscillator {
        storey: Some(storey),
        response,
    }
}

const DISPLACEMENT: OscillatorResponse = OscillatorResponse::Motion(Motion::Displacement);
const VELOCITY: OscillatorResponse = OscillatorResponse::Motion(Motion::Velocity);
const ACCELERATION: OscillatorResponse = OscillatorResponse::Motion(Motion::Acceleration);

/// Excitation `[sample][point]` on the grid 0, step, ...; random keys and values a point.
#[derive(Default)]
struct Input<'a> {
    step: f64,
    samples: usize,
    excitation: Vec<f64>,
    random: &'a [(&'a str, &'a [f64])],
}

/// `[quantity][record][point]`.
fn run(chain: &Chain, quantities: &[Quantity], points: usize, input: &Input) -> Vec<Vec<Vec<f64>>> {
    let keys = input.random.iter().enumerate();
    let keys = keys.map(|(k, (key, _))| (k, (*key).to_owned())).collect();
    let values: Vec<Vec<f64>> = input
        .random
        .iter()
        .map(|(_, values)| values.to_vec())
        .collect();
    let grid = (0.0, input.step, input.samples);
    let chains = Chains::new(chain.clone(), quantities.to_vec(), keys, grid).unwrap();
    let all = Points {
        excitation: &input.excitation,
        samples: input.samples,
        parameters: &values,
        range: 0..points,
    };
    let records = chain.times().len();
    let mut block = vec![0.0; records * quantities.len() * points];
    let mut stepper = chains.stepper();
    for (k, mut strip) in Strip::cut(&mut block, points, LANES)
        .into_iter()
        .enumerate()
    {
        let part = all.part(k * LANES..k * LANES + strip.width());
        stepper.run(&part, &mut strip).unwrap();
    }
    let row = |q: usize, r: usize| {
        let row = r * quantities.len() + q;
        block[row * points..(row + 1) * points].to_vec()
    };
    (0..quantities.len())
        .map(|q| (0..records).map(|r| row(q, r)).collect())
        .collect()
}

/// The history of a quantity of a chain without excitation.
fn history(chain: &Chain, quantity: Quantity) -> Vec<f64> {
    let out = run(chain, &[quantity], 1, &Input::default());
    out[0].iter().map(|row| row[0]).collect()
}

#[test]
fn free_vibration_is_exact_to_the_fourth_order() {
    let (omega, ratio) = (1.5 * PI, 0.05);
    let damped = omega * f64::sqrt(1.0 - ratio * ratio);
    let exact = |t: f64| {
        let decay = (-ratio * omega * t).exp();
        let sine = (0.2 + ratio * omega * 0.1) / damped;
        decay * (0.1 * (damped * t).cos() + sine * (damped * t).sin())
    };
    let error = |step: f64| {
        let mut only = storey(omega);
        only.damping = Damping::Ratio(ratio);
        only.initial_displacement = 0.1;
        only.initial_velocity = 0.2;
        let chain = chain(vec![only], step, 2.0);
        let found = history(&chain, response(DISPLACEMENT));
        let times = chain.times();
        let errors = found.iter().zip(times).map(|(u, t)| (u - exact(t)).abs());
        errors.fold(0.0, f64::max)
    };
    let errors = [0.04, 0.02, 0.01, 0.0025].map(error);
    println!("free vibration: {errors:?}");
    for pair in errors[..3].windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.8, "{errors:?}");
    }
    // (ω h)⁴ ω T / 120 of the amplitude.
    let bound = (omega * 0.0025).powi(4) * omega * 2.0 / 120.0 * 0.11;
    assert!(errors[3] < 1.5 * bound && errors[3] < 1e-8, "{errors:?}");
}

#[test]
fn each_lane_has_its_own_parameters_and_neighbours_change_nothing() {
    let points = LANES + 3;
    let omega: Vec<f64> = (0..points)
        .map(|k| PI * (1.25 + 0.5 * k as f64 / 26.0))
        .collect();
    let start: Vec<f64> = (0..points).map(|k| 0.1 - 0.001 * k as f64).collect();
    let mut only = storey(1.0);
    only.initial_displacement = 0.5;
    let given = chain(vec![only], 0.005, 2.0);
    let input = Input {
        random: &[
            ("natural_frequency", &omega),
            ("initial_displacement", &start),
        ],
        ..Input::default()
    };
    let out = run(&given, &[response(DISPLACEMENT)], points, &input);
    for (time, row) in given.times().iter().zip(&out[0]) {
        for (k, u) in row.iter().enumerate() {
            assert!((u - start[k] * (omega[k] * time).cos()).abs() < 1e-8);
        }
    }
    // The scenario's own values come back after points that have theirs.
    let own = history(&given, response(DISPLACEMENT));
    assert!((own[400] - 0.5 * 2f64.cos()).abs() < 1e-8, "{}", own[400]);
    let alone = Input {
        random: &[
            ("natural_frequency", &omega[26..]),
            ("initial_displacement", &start[26..]),
        ],
        ..Input::default()
    };
    let alone = run(&given, &[response(DISPLACEMENT)], 1, &alone);
    assert!(alone[0].iter().zip(&out[0]).all(|(a, b)| a[0] == b[26]));
}

#[test]
fn storeys_move_in_their_modes() {
    let mut given = chain(vec![storey(1.0); 4], 0.002, 1.5);
    for (k, storey) in given.storeys.iter_mut().enumerate() {
        storey.mass = 1.0 + 0.3 * k as f64;
        storey.stiffness = Stiffness::Stiffness(400.0 - 50.0 * k as f64);
    }
    given.rayleigh = Some(Rayleigh {
        damping_ratio: 0.03,
        modes: [1, 3],
    });
    let (frequencies, shapes) = given.modes();
    let ratios = given.modal_damping_ratios();
    for mode in [0, 2, 3] {
        for (k, storey) in given.storeys.iter_mut().enumerate() {
            storey.initial_displacement = 0.01 * shapes[(k, mode)];
        }
        let (omega, ratio) = (frequencies[mode], ratios[mode]);
        let damped = omega * f64::sqrt(1.0 - ratio * ratio);
        let exact = |t: f64| {
            let turn = (damped * t).cos() + ratio * omega / damped * (damped * t).sin();
            0.01 * (-ratio * omega * t).exp() * turn
        };
        let wanted: Vec<Quantity> = (1..=4).map(|s| of_storey(s, DISPLACEMENT)).collect();
        let out = run(&given, &wanted, 1, &Input::default());
        for (n, t) in given.times().iter().enumerate() {
            for (k, rows) in out.iter().enumerate() {
                let error = (rows[n][0] - shapes[(k, mode)] * exact(*t)).abs();
                assert!(error < 1e-8, "mode {mode}, storey {k}: {error:e}");
            }
        }
    }
}

#[test]
fn recorded_responses_fit_each_other() {
    let mut given = chain(vec![storey(6.0), storey(9.0)], 0.01, 2.0);
    given.storeys[1].damping = Damping::Ratio(0.1);
    given.storeys[0].cubic = Cubic::Stiffness(500.0);
    let given = excited(given, Load::BaseAcceleration, Interpolation::Cubic);
    let (step, samples) = (0.02, 101);
    let ground: Vec<f64> = (0..samples)
        .map(|k| (7.0 * k as f64 * step).sin())
        .collect();
    let input = Input {
        step,
        samples,
        excitation: ground,
        ..Input::default()
    };
    let wanted: Vec<Quantity> = Quantity::available_of_chain(2);
    let out = run(&given, &wanted, 1, &input);
    let at = |storey: usize, wanted_response: OscillatorResponse| {
        let quantity = of_storey(storey, wanted_response);
        let q = wanted.iter().position(|w| *w == quantity).unwrap();
        out[q].iter().map(|row| row[0]).collect::<Vec<f64>>()
    };
    let ground = &out[wanted
        .iter()
        .position(|w| *w == Quantity::BaseAcceleration)
        .unwrap()];
    let (drift, rate) = (
        at(2, OscillatorResponse::Drift),
        at(2, OscillatorResponse::DriftVelocity),
    );
    let (lower, upper) = (at(1, DISPLACEMENT), at(2, DISPLACEMENT));
    let force = at(2, OscillatorResponse::RestoringForce);
    let (relative, absolute) = (
        at(2, ACCELERATION),
        at(2, OscillatorResponse::AbsoluteAcceleration),
    );
    for (n, drift) in drift.iter().enumerate() {
        assert!((drift - (upper[n] - lower[n])).abs() < 1e-15);
        assert!((absolute[n] - relative[n] - ground[n][0]).abs() < 1e-13);
        // Newton: the upper mass (1 kg) feels its spring and its damper alone.
        let damping = 2.0 * 0.1 * 9.0 * rate[n];
        assert!((absolute[n] + force[n] + damping).abs() < 1e-12);
    }
    let base = at(1, OscillatorResponse::RestoringForce);
    for (u, g) in lower.iter().zip(base) {
        assert!((g - 36.0 * u - 500.0 * u.powi(3)).abs() < 1e-12);
    }
}

#[test]
fn a_smooth_excitation_is_met_to_the_fourth_order() {
    // ü + ω² u = −cos(ν t), from rest: u = (cos ω t − cos ν t)/(ω² − ν²).
    let (omega, nu) = (3.0f64, 5.0f64);
    let error = |step: f64| {
        let given = chain(vec![storey(omega)], step, 4.0);
        let samples = (4.0 / (2.0 * step)).round() as usize + 1;
        let input = Input {
            step: 2.0 * step,
            samples,
            excitation: (0..samples)
                .map(|k| (nu * 2.0 * step * k as f64).cos())
                .collect(),
            ..Input::default()
        };
        let by = |load| {
            let given = excited(given.clone(), load, Interpolation::Cubic);
            run(&given, &[response(DISPLACEMENT)], 1, &input)[0].clone()
        };
        let (base, force) = (by(Load::BaseAcceleration), by(Load::Force));
        let exact = |t: f64| ((omega * t).cos() - (nu * t).cos()) / (omega * omega - nu * nu);
        let times = given.times();
        assert!(base.iter().zip(&force).all(|(a, b)| a[0] == -b[0]));
        let errors = base.iter().zip(times).map(|(u, t)| (u[0] - exact(t)).abs());
        errors.fold(0.0, f64::max)
    };
    let errors = [0.04, 0.02, 0.01].map(error);
    println!("excited: {errors:?}");
    assert!(
        (errors[1] / errors[2]).log2() > 3.7 && errors[2] < 1e-5,
        "{errors:?}"
    );
}

#[test]
fn constant_samples_hold_from_one_to_the_next() {
    let omega = 2.0;
    let given = excited(
        chain(vec![storey(omega)], 0.005, 1.0),
        Load::Force,
        Interpolation::Constant,
    );
    let input = Input {
        step: 0.25,
        samples: 4,
        excitation: vec![1.0, -2.0, 0.5, 3.0],
        ..Input::default()
    };
    let wanted = [response(DISPLACEMENT), Quantity::Force];
    let out = run(&given, &wanted, 1, &input);
    // Duhamel's integral, sample by sample.
    let (mut u, mut v) = (0.0, 0.0);
    for (k, force) in [1.0, -2.0, 0.5, 3.0].into_iter().enumerate() {
        assert_eq!(out[1][50 * k][0], force);
        let (c, s) = ((omega * 0.25f64).cos(), (omega * 0.25f64).sin());
        let rest = force / (omega * omega);
        (u, v) = (
            rest + (u - rest) * c + v / omega * s,
            v * c - (u - rest) * omega * s,
        );
        let found = out[0][50 * (k + 1)][0];
        assert!((found - u).abs() < 1e-9, "{k}: {found} {u}");
    }
}

#[test]
fn a_run_without_bound_is_named() {
    let mut only = storey(1.0);
    only.initial_velocity = 1.0;
    let given = chain(vec![only], 3.0, 600.0);
    let chains = Chains::new(
        given,
        vec![response(DISPLACEMENT)],
        Vec::new(),
        (0.0, 0.0, 0),
    )
    .unwrap();
    let mut block = vec![0.0; 201 * 2];
    let mut strips = Strip::cut(&mut block, 2, LANES);
    let points = Points {
        excitation: &[],
        samples: 0,
        parameters: &[],
        range: 0..2,
    };
    let divergence = chains.stepper().run(&points, &mut strips[0]).unwrap_err();
    assert!(
        divergence.lane == 0 && divergence.step > 10 && divergence.step < 200,
        "{divergence:?}"
    );
    assert!(chains.explain(divergence).contains("simulation.time_step"));
}
