//! The laws of elements, each by its exact answer.

use super::*;
use crate::system::{BoucWen, PowerLaw, VanDerPol};

/// cn(x, m) by the arithmetic-geometric mean (Abramowitz and Stegun 16.4).
fn jacobi_cn(x: f64, m: f64) -> f64 {
    let mut a = vec![1.0];
    let mut c = vec![m.sqrt()];
    let mut b = (1.0 - m).sqrt();
    while c[c.len() - 1].abs() > 1e-16 {
        let last = a[a.len() - 1];
        a.push(0.5 * (last + b));
        c.push(0.5 * (last - b));
        b = (last * b).sqrt();
    }
    let n = a.len() - 1;
    let mut phi = 2f64.powi(n as i32) * a[n] * x;
    for k in (1..=n).rev() {
        phi = 0.5 * (phi + (c[k] / a[k] * phi.sin()).asin());
    }
    phi.cos()
}

#[test]
fn duffings_free_vibration_is_an_elliptic_cosine() {
    let (omega, epsilon, start) = (2.0f64, 3.0f64, 0.8f64);
    let bent = (omega * omega * (1.0 + epsilon * start * start)).sqrt();
    let modulus = omega * omega * epsilon * start * start / (2.0 * bent * bent);
    let error = |step: f64| {
        let mut only = storey(omega);
        only.cubic = Cubic::Ratio(epsilon);
        only.initial_displacement = start;
        let chain = chain(vec![only], step, 10.0);
        let found = history(&chain, response(DISPLACEMENT));
        let times = chain.times();
        let exact = |t: f64| start * jacobi_cn(bent * t, modulus);
        let errors = found.iter().zip(times).map(|(u, t)| (u - exact(t)).abs());
        errors.fold(0.0, f64::max)
    };
    let errors = [0.02, 0.01, 0.0025].map(error);
    println!("Duffing: {errors:?}");
    assert!(
        (errors[0] / errors[1]).log2() > 3.8 && errors[2] < 1e-7,
        "{errors:?}"
    );
}

#[test]
fn van_der_pols_limit_cycle_has_twice_the_amplitude() {
    let mut only = storey(1.0);
    only.van_der_pol = Some(VanDerPol {
        coefficient: 0.05,
        amplitude: 0.3,
    });
    only.initial_displacement = 0.1;
    let mut given = chain(vec![only], 0.05, 400.0);
    given.record_every = 2;
    let found = history(&given, response(DISPLACEMENT));
    let peak = found[found.len() - 200..]
        .iter()
        .copied()
        .fold(0.0, f64::max);
    // 2 a (1 + μ²/96 ...); the samples are 0.1 rad apart.
    assert!(
        (peak / 0.6 - 1.0).abs() < 0.05f64.powi(2) / 2.0 + 1e-4,
        "{peak}"
    );
}

#[test]
fn power_law_damping_takes_the_energy_it_should() {
    // Without a spring: v' = −c |v|^p sgn v, so v^(1−p) = v₀^(1−p) − (1 − p) c t.
    for exponent in [0.3, 1.0, 2.0, 3.0] {
        let mut only = storey(0.0);
        only.power_law = Some(PowerLaw {
            coefficient: 0.4,
            exponent,
        });
        only.initial_velocity = -1.5;
        let found = history(&chain(vec![only], 0.005, 1.0), response(VELOCITY));
        let rest = 1.0 - exponent;
        let exact = if rest == 0.0 {
            1.5 * f64::exp(-0.4)
        } else {
            (1.5f64.powf(rest) - rest * 0.4).powf(1.0 / rest)
        };
        assert!(
            (found[200] + exact).abs() < 1e-10,
            "{exponent}: {} {exact}",
            found[200]
        );
    }
}

fn hysteretic(exponent: f64) -> Storey {
    let mut only = storey(2.0 * PI);
    only.bouc_wen = Some(BoucWen {
        yield_displacement: 0.01,
        post_yield_ratio: 0.1,
        amplitude: 1.0,
        beta: 0.7,
        gamma: 0.3,
        exponent,
    });
    only
}

#[test]
fn hysteresis_yields_at_its_displacement_and_dissipates_what_is_put_in() {
    for exponent in [1.0, 2.5] {
        let mut only = hysteretic(exponent);
        only.initial_velocity = 1.0;
        let given = chain(vec![only], 0.001, 3.0);
        let wanted = [
            response(DISPLACEMENT),
            response(VELOCITY),
            response(OscillatorResponse::HystereticVariable),
            response(OscillatorResponse::RestoringForce),
        ];
        let out = run(&given, &wanted, 1, &Input::default());
        let at = |q: usize, n: usize| out[q][n][0];
        let steps = given.steps;
        let largest = (0..=steps).map(|n| at(2, n).abs()).fold(0.0, f64::max);
        assert!(
            largest <= 1.0 + 1e-9 && largest > 0.99,
            "{exponent}: {largest}"
        );
        // Kinetic energy and the work done on the spring (Simpson) are what was there at the start.
        let work = |n: usize| at(3, n) * at(1, n);
        let sum: f64 = (0..steps / 2)
            .map(|k| work(2 * k) + 4.0 * work(2 * k + 1) + work(2 * k + 2))
            .sum();
        let energy = 0.5 * at(1, steps).powi(2) + sum * 0.001 / 3.0;
        assert!((energy - 0.5).abs() < 1e-5, "{exponent}: {energy}");
        for n in 0..=steps {
            let stiffness = 4.0 * PI * PI;
            let force = stiffness * (0.1 * at(0, n) + 0.9 * 0.01 * at(2, n));
            assert!((at(3, n) - force).abs() < 1e-12);
        }
    }
}

#[test]
fn slow_loading_follows_the_curve_of_first_yield() {
    // Monotonic loading with n = 1 and β + γ = 1: z = 1 − exp(−u/d_y).
    let mut only = hysteretic(1.0);
    only.initial_velocity = 0.05;
    let wanted = [
        response(DISPLACEMENT),
        response(OscillatorResponse::HystereticVariable),
    ];
    let out = run(
        &chain(vec![only], 0.001, 0.1),
        &wanted,
        1,
        &Input::default(),
    );
    for (u, z) in out[0].iter().zip(&out[1]) {
        assert!((z[0] - (1.0 - (-u[0] / 0.01).exp())).abs() < 1e-11);
    }
}
