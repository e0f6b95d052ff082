//! Every scheme against the exact oscillator: order, stability limit, starting step.

use super::*;

/// q and q̇ at time t of q̈ + 2 a q̇ + ω² q = cos(p t) from q(0) = q0, q̇(0) = v0.
fn exact(o: Oscillator, p: f64, q0: f64, v0: f64, t: f64) -> (f64, f64) {
    let (re, im) = (o.frequency.powi(2) - p * p, 2.0 * o.decay * p);
    let size = re * re + im * im;
    let (c, s) = (re / size, im / size); // steady state: c cos(pt) + s sin(pt)
    let (a, b) = (q0 - c, v0 - s * p);
    let damped = (o.frequency.powi(2) - o.decay.powi(2)).sqrt();
    let e = (-o.decay * t).exp();
    let (cos, sin) = ((damped * t).cos(), (damped * t).sin());
    let free = e * (a * cos + (b + o.decay * a) / damped * sin);
    let slope = e * (b * cos - (o.frequency.powi(2) * a + o.decay * b) / damped * sin);
    (
        free + c * (p * t).cos() + s * (p * t).sin(),
        slope - c * p * (p * t).sin() + s * p * (p * t).cos(),
    )
}

fn errors(scheme: Integrator, o: Oscillator, steps: usize) -> (f64, f64) {
    let (p, q0, v0, end) = (3.0, 0.3, -0.5, 2.0);
    let h = end / steps as f64;
    let map = scheme.propagator(o, h);
    let mut x = map.initial(q0, v0, 1.0);
    let (mut worst_q, mut worst_v) = (0.0f64, 0.0f64);
    for n in 0..=steps {
        let t = n as f64 * h;
        let force = (p * t).cos();
        let (q, v) = exact(o, p, q0, v0, t);
        worst_q = worst_q.max((map.displacement_of(x, force) - q).abs());
        worst_v = worst_v.max((map.velocity_of(x, force) - v).abs());
        x = map.advance(x, force);
    }
    (worst_q, worst_v)
}

#[test]
fn every_scheme_is_of_second_order() {
    for scheme in Integrator::ALL {
        for decay in [0.0, 0.9] {
            let o = Oscillator {
                frequency: 8.0,
                decay,
            };
            let (coarse, fine) = (errors(scheme, o, 400), errors(scheme, o, 800));
            for (c, f) in [(coarse.0, fine.0), (coarse.1, fine.1)] {
                let order = (c / f).log2();
                assert!(
                    (1.85..2.2).contains(&order),
                    "{scheme:?} {decay}: order {order}"
                );
            }
        }
    }
}

#[test]
fn the_exponential_scheme_is_exact_on_the_free_oscillator() {
    for frequency in [0.0, 0.5, 70.0, std::f64::consts::PI / 0.01, 408.3] {
        for ratio in [0.0, 0.05, 1.0, 1.3] {
            let o = Oscillator {
                frequency,
                decay: ratio * frequency,
            };
            let map = Integrator::Exponential.propagator(o, 0.01);
            let once = Integrator::Exponential.propagator(o, 0.02);
            let two = map.advance(map.advance(map.initial(0.7, -0.4, 0.0), 0.0), 0.0);
            let one = once.advance(once.initial(0.7, -0.4, 0.0), 0.0);
            let scale = 1.0 + frequency;
            assert!((two[0] - one[0]).abs() < 1e-12, "{frequency} {ratio}");
            assert!(
                (two[2] - one[2]).abs() < 1e-12 * scale,
                "{frequency} {ratio}"
            );
        }
    }
}

#[test]
fn the_exponential_scheme_holds_a_static_load_at_any_step() {
    for frequency in [1e-3, 0.9, 1.1, 50.0, 408.3] {
        let o = Oscillator {
            frequency,
            decay: 0.02 * frequency,
        };
        let map = Integrator::Exponential.propagator(o, 0.01);
        let rest = 1.0 / (frequency * frequency);
        let mut x = map.initial(rest, 0.0, 1.0);
        for _ in 0..1000 {
            x = map.advance(x, 1.0);
        }
        assert!(
            (x[0] / rest - 1.0).abs() < 1e-6,
            "{frequency}: {}",
            x[0] / rest
        );
        assert!(map.velocity_of(x, 1.0).abs() < 1e-6 * rest * frequency);
    }
}

#[test]
fn central_differences_are_stable_up_to_two() {
    for (product, stable) in [(1.999, true), (2.001, false)] {
        let o = Oscillator {
            frequency: product / 0.01,
            decay: 0.0,
        };
        let map = Integrator::ExplicitNewmark.propagator(o, 0.01);
        let mut x = map.initial(1.0, 0.0, 0.0);
        for _ in 0..2000 {
            x = map.advance(x, 0.0);
        }
        assert_eq!(x[0].abs() < 100.0, stable, "{product}: {}", x[0]);
    }
}

#[test]
fn average_acceleration_conserves_energy() {
    let o = Oscillator {
        frequency: 30.0,
        decay: 0.0,
    };
    let map = Integrator::Newmark.propagator(o, 0.05);
    let energy = |x: [f64; 3]| 0.5 * x[1] * x[1] + 0.5 * (o.frequency * x[0]).powi(2);
    let mut x = map.initial(1.0, 2.0, 0.0);
    let start = energy(x);
    for _ in 0..1000 {
        x = map.advance(x, 0.0);
    }
    assert!((energy(x) / start - 1.0).abs() < 1e-12);
}
