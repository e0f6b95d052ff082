//! The lockstep kernel against exact answers and against itself.

use super::*;
use crate::integrate::Integrator;
use crate::quantity::{BridgeResponse, Motion, Quantity, VehiclePart};
use crate::system::tests::paper_case;
use crate::system::{Beam, BumpStop, Crossing, CrossingMaps, InitialState};

fn midspan(response: BridgeResponse) -> Quantity {
    Quantity::Bridge {
        section: "midspan".to_owned(),
        response,
    }
}

fn deflection() -> Quantity {
    midspan(BridgeResponse::Motion(Motion::Displacement))
}

fn body(motion: Motion) -> Quantity {
    Quantity::Vehicle {
        part: VehiclePart::Body,
        motion,
    }
}

/// `[quantity][record][lane]`, with the irregularity η(x) times lane/(LANES − 1).
fn run(
    crossing: &Crossing,
    quantities: &[Quantity],
    eta: impl Fn(f64) -> f64,
) -> Vec<Vec<[f64; LANES]>> {
    let tables = crossing.tables(quantities);
    run_batch(&mut Batch::new(&tables), crossing, quantities, eta)
}

fn run_batch(
    batch: &mut Batch<'_>,
    crossing: &Crossing,
    quantities: &[Quantity],
    eta: impl Fn(f64) -> f64,
) -> Vec<Vec<[f64; LANES]>> {
    let positions = crossing.positions();
    let records = crossing.times().len();
    let mut block = vec![0.0; records * quantities.len() * LANES];
    let mut strips = Strip::cut(&mut block, LANES, LANES);
    batch
        .run(
            |steps, rows| {
                for (n, row) in steps.zip(rows.chunks_exact_mut(LANES)) {
                    for (lane, value) in row.iter_mut().enumerate() {
                        *value = eta(positions[n]) * lane as f64 / (LANES - 1) as f64;
                    }
                }
            },
            &mut strips[0],
        )
        .unwrap();
    let row = |k: usize| std::array::from_fn(|lane| block[k * LANES + lane]);
    (0..quantities.len())
        .map(|q| {
            (0..records)
                .map(|r| row(r * quantities.len() + q))
                .collect()
        })
        .collect()
}

/// Data sheet 2.3, five modes, DOP853.
const DEFLECTION: [(f64, f64); 3] = [
    (0.7, -55.166318e-3),
    (1.1, -94.491213e-3),
    (1.5, -54.104794e-3),
];
const ACCELERATION: [(f64, f64); 3] = [(0.8, -0.38425957), (1.1, -0.15807291), (1.4, 0.62728726)];

/// Largest relative error at the reference instants of deflection and body acceleration.
fn smooth_errors(integrator: Integrator, step: f64) -> (f64, f64) {
    let crossing = paper_case(integrator, step);
    let out = run(
        &crossing,
        &[deflection(), body(Motion::Acceleration)],
        |_| 0.0,
    );
    let worst = |rows: &[[f64; LANES]], wanted: &[(f64, f64)]| {
        wanted
            .iter()
            .map(|(t, y)| (rows[(t / step).round() as usize][0] / y - 1.0).abs())
            .fold(0.0, f64::max)
    };
    (worst(&out[0], &DEFLECTION), worst(&out[1], &ACCELERATION))
}

#[test]
fn every_scheme_meets_the_smooth_deck_at_a_tenth_of_a_millisecond() {
    for integrator in Integrator::ALL {
        let (y, a) = smooth_errors(integrator, 1e-4);
        println!("{:<17} 0.1 ms: {y:.1e} {a:.1e}", integrator.name());
        assert!(y < 1e-5 && a < 1e-5, "{integrator:?}: {y:e} {a:e}");
    }
}

#[test]
fn the_coupled_schemes_are_of_second_order() {
    for integrator in Integrator::ALL {
        let errors: Vec<_> = [0.01, 0.005, 0.001]
            .map(|h| smooth_errors(integrator, h))
            .into();
        for (h, (y, a)) in [10, 5, 1].iter().zip(&errors) {
            println!("{:<17} {h} ms: {y:.1e} {a:.1e}", integrator.name());
        }
        assert!(
            errors[2].0 < errors[0].0 / 50.0 && errors[2].1 < errors[0].1 / 50.0,
            "{integrator:?} {errors:?}"
        );
    }
}

#[test]
fn the_crossing_is_linear_in_the_irregularity() {
    for integrator in Integrator::ALL {
        let crossing = paper_case(integrator, 0.005);
        let out = run(&crossing, &[deflection(), body(Motion::Velocity)], |x| {
            1e-3 * (1.3 * x).cos()
        });
        for rows in &out {
            for row in rows {
                let slope = row[LANES - 1] - row[0];
                let middle = row[0] + slope * 5.0 / (LANES - 1) as f64;
                assert!((row[5] - middle).abs() < 1e-11 * (1.0 + row[0].abs()));
            }
        }
    }
}

#[test]
fn velocities_and_accelerations_are_derivatives() {
    let quantities: Vec<Quantity> = Motion::ALL
        .iter()
        .flat_map(|m| {
            let wheel = Quantity::Vehicle {
                part: VehiclePart::Wheel,
                motion: *m,
            };
            [midspan(BridgeResponse::Motion(*m)), body(*m), wheel]
        })
        .collect();
    for integrator in Integrator::ALL {
        let mut crossing = paper_case(integrator, 1e-4);
        crossing.beam.damping_ratio = 0.02;
        let out = run(&crossing, &quantities, |x| 1e-3 * (0.9 * x).sin());
        for (k, motion) in (0..6).map(|k| (k, &out[k])) {
            let rate = &out[k + 3];
            let scale = rate.iter().map(|r| r[9].abs()).fold(0.0, f64::max);
            for n in 2000..motion.len() - 1 {
                let slope = (motion[n + 1][9] - motion[n - 1][9]) / 2e-4;
                assert!(
                    (slope - rate[n][9]).abs() < 1e-3 * scale,
                    "{integrator:?} {k} {n}"
                );
            }
        }
    }
}

#[test]
fn the_recorded_forces_obey_newton() {
    let wheel = Quantity::Vehicle {
        part: VehiclePart::Wheel,
        motion: Motion::Acceleration,
    };
    for integrator in Integrator::ALL {
        let crossing = paper_case(integrator, 0.002);
        let quantities = [
            Quantity::ContactForce,
            body(Motion::Acceleration),
            wheel.clone(),
        ];
        let out = run(&crossing, &quantities, |x| 1e-3 * (0.9 * x).sin());
        for ((force, upper), lower) in out[0].iter().zip(&out[1]).zip(&out[2]) {
            let inertia = crossing.weight() + 12000.0 * upper[7] + 500.0 * lower[7];
            assert!((force[7] - inertia).abs() < 1e-9 * crossing.weight());
        }
    }
}

#[test]
fn a_crawling_load_bends_the_beam_statically() {
    let mut crossing = paper_case(Integrator::Exponential, 0.05);
    crossing.beam.damping_ratio = 0.05;
    crossing.car.speed = 0.2;
    crossing.steps = 4000;
    let out = run(&crossing, &[midspan(BridgeResponse::BendingMoment)], |_| {
        0.0
    });
    let middle = out[0][2000][0];
    let exact = crossing.weight() * 40.0 / 4.0;
    assert!((middle / exact - 1.0).abs() < 5e-3, "{middle} {exact}");
}

#[test]
fn a_vehicle_that_starts_on_the_profile_starts_at_rest() {
    let mut crossing = paper_case(Integrator::Newmark, 0.001);
    crossing.initial_state = InitialState::Profile;
    crossing.car.approach = 5.0;
    let out = run(
        &crossing,
        &[Quantity::ContactForce, body(Motion::Displacement)],
        |_| 2e-3,
    );
    // A level step of the road under the whole run: nothing happens before the bridge.
    for (force, body) in out[0].iter().zip(&out[1]).take(240) {
        assert!((force[LANES - 1] / crossing.weight() - 1.0).abs() < 1e-10);
        assert!((body[LANES - 1] - 2e-3).abs() < 1e-12);
    }
}

fn nonlinear(integrator: Integrator, step: f64) -> Crossing {
    let mut crossing = paper_case(integrator, step);
    crossing.car.suspension_cubic_stiffness = 7.0e8;
    crossing.car.suspension_quadratic_damping = 38_644.0;
    crossing.car.bump_stop = Some(BumpStop {
        gap: 0.02,
        stiffness: 9.0 * 280e3,
    });
    crossing
}

/// Classical Runge-Kutta on the equations of motion as the data sheet prints them.
fn runge_kutta(crossing: &Crossing, eta: impl Fn(f64) -> f64, steps: usize) -> Vec<(f64, f64)> {
    let (beam, car) = (&crossing.beam, &crossing.car);
    let modes = beam.modes;
    let h = crossing.time_step * crossing.steps as f64 / steps as f64;
    let rates = |t: f64, s: &[f64]| -> Vec<f64> {
        let x = car.position(t);
        let (y1, y2, v1, v2) = (
            s[2 * modes],
            s[2 * modes + 1],
            s[2 * modes + 2],
            s[2 * modes + 3],
        );
        let deck: f64 = (0..modes).map(|i| beam.shape(i + 1, x) * s[i]).sum();
        let p = car.tyre_stiffness * (deck + eta(x) - y2);
        let (d, r) = (y1 - y2, v1 - v2);
        let stop = car.bump_stop.map_or(0.0, |b| {
            b.stiffness * ((d - b.gap).max(0.0) + (d + b.gap).min(0.0))
        });
        let force = car.suspension_stiffness * d
            + car.suspension_damping * r
            + car.suspension_cubic_stiffness * d.powi(3)
            + car.suspension_quadratic_damping * r.abs() * r
            + stop;
        let mut out = s[modes..2 * modes].to_vec();
        for (i, q) in s[..modes].iter().enumerate() {
            let load = -beam.shape(i + 1, x) * (crossing.weight() + p) / beam.mass();
            out.push(load - beam.frequency(i + 1).powi(2) * q);
        }
        out.extend([v1, v2, -force / car.body_mass, (force + p) / car.wheel_mass]);
        out
    };
    let mut s = vec![0.0; 2 * modes + 4];
    let mut history = vec![(0.0, rates(0.0, &s)[2 * modes + 2])];
    let moved = |s: &[f64], k: &[f64], f: f64| -> Vec<f64> {
        s.iter().zip(k).map(|(a, b)| a + f * b).collect()
    };
    for n in 0..steps {
        let t = n as f64 * h;
        let k1 = rates(t, &s);
        let k2 = rates(t + h / 2.0, &moved(&s, &k1, h / 2.0));
        let k3 = rates(t + h / 2.0, &moved(&s, &k2, h / 2.0));
        let k4 = rates(t + h, &moved(&s, &k3, h));
        for i in 0..s.len() {
            s[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        let deck: f64 = (0..modes).map(|i| beam.shape(i + 1, 20.0) * s[i]).sum();
        history.push((deck, rates(t + h, &s)[2 * modes + 2]));
    }
    history
}

#[test]
fn the_nonlinear_suspension_agrees_with_runge_kutta() {
    let eta = |x: f64| 0.02 * (0.9 * x).sin();
    for integrator in Integrator::ALL {
        let mut errors = Vec::new();
        for step in [1e-3, 2.5e-4] {
            let crossing = nonlinear(integrator, step);
            let truth = runge_kutta(&crossing, eta, 16_000);
            let out = run(&crossing, &[deflection(), body(Motion::Acceleration)], eta);
            let every = 16_000 / crossing.steps;
            let largest = truth.iter().map(|t| t.1.abs()).fold(0.0, f64::max);
            let error = (0..=crossing.steps)
                .map(|n| {
                    let (y, a) = truth[n * every];
                    let dy = (out[0][n][LANES - 1] - y).abs() / 0.1;
                    dy.max((out[1][n][LANES - 1] - a).abs() / largest)
                })
                .fold(0.0, f64::max);
            errors.push(error);
        }
        println!(
            "{:<17} nonlinear, 1 and 0.25 ms: {errors:?}",
            integrator.name()
        );
        assert!(
            errors[1] < 2e-3 && errors[1] < errors[0] / 8.0,
            "{integrator:?} {errors:?}"
        );
    }
}

#[test]
fn a_run_without_bound_is_named() {
    let mut crossing = paper_case(Integrator::ExplicitNewmark, 0.01);
    crossing.beam = Beam {
        modes: 8,
        ..crossing.beam
    };
    let tables = crossing.tables(&[deflection()]);
    let mut block = vec![0.0; 201 * LANES];
    let mut strips = Strip::cut(&mut block, LANES, LANES);
    let result = Batch::new(&tables).run(|_, rows| rows.fill(0.0), &mut strips[0]);
    let divergence = result.unwrap_err();
    assert!(
        divergence.step > 10 && divergence.step < 200,
        "{divergence:?}"
    );
}

/// Parameters that differ from lane to lane, every one of bridge and vehicle.
fn varied(nominal: &Crossing, lane: usize) -> Crossing {
    let mut crossing = nominal.clone();
    let factor = |k: usize| 1.0 + 0.2 * ((7 * lane + 3 * k) as f64).sin();
    let (beam, car) = (&mut crossing.beam, &mut crossing.car);
    beam.mass_per_length *= factor(1);
    beam.flexural_rigidity *= factor(2);
    beam.damping_ratio = 0.02 * (factor(3) - 0.7);
    car.body_mass *= factor(4);
    car.wheel_mass *= factor(5);
    car.suspension_stiffness *= factor(6);
    car.suspension_damping *= factor(7);
    car.suspension_cubic_stiffness *= factor(8);
    car.suspension_quadratic_damping *= factor(9);
    car.tyre_stiffness *= factor(10);
    if let Some(stop) = &mut car.bump_stop {
        stop.gap *= factor(11);
        stop.stiffness *= factor(12);
    }
    crossing
}

#[test]
fn a_lane_with_parameters_of_its_own_runs_as_it_would_alone() {
    let quantities = [
        deflection(),
        midspan(BridgeResponse::Motion(Motion::Acceleration)),
        midspan(BridgeResponse::BendingMoment),
        body(Motion::Velocity),
        body(Motion::Acceleration),
        Quantity::ContactForce,
    ];
    let eta = |x: f64| 5e-3 * (0.9 * x).cos();
    for integrator in Integrator::ALL {
        let mut linear = paper_case(integrator, 0.005);
        linear.beam.damping_ratio = 0.01;
        for nominal in [linear, nonlinear(integrator, 0.005)] {
            let tables = nominal.varied_tables(&quantities);
            // Fewer than there are lanes: the rest repeats the last one.
            let lanes = LANES - 3;
            let maps = (0..lanes)
                .map(|lane| CrossingMaps::new(varied(&nominal, lane), &tables.frame))
                .collect();
            let mut batch = Batch::new(&tables);
            batch.vary(maps);
            let together = run_batch(&mut batch, &nominal, &quantities, eta);
            for lane in [0, 1, lanes - 1, LANES - 1] {
                let alone = varied(&nominal, lane.min(lanes - 1));
                let tables = alone.varied_tables(&quantities);
                let single = run_batch(&mut Batch::new(&tables), &alone, &quantities, eta);
                for (k, (rows, expected)) in together.iter().zip(&single).enumerate() {
                    let size = expected.iter().map(|r| r[lane].abs()).fold(0.0, f64::max);
                    for (row, wanted) in rows.iter().zip(expected) {
                        let error = (row[lane] - wanted[lane]).abs();
                        assert!(error < 1e-9 * size, "{integrator:?} {k} {lane}: {error:e}");
                    }
                }
            }
        }
    }
}
