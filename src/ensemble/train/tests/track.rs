//! Trains on track: equilibrium, contact, windows.

use super::*;

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

/// Rail elements of half the size move no peak by half a per cent. (Unfiltered accelerations of rail and sleeper are
/// another matter: 1.9 % and 0.5 %.)
#[test]
fn one_element_a_bay_is_enough() {
    let names = [
        "bridge/midspan/displacement",
        "bridge/midspan/acceleration",
        "bridge/midspan/bending_moment",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/body/front/acceleration",
        "vehicle/car-1/bogie-1/acceleration",
        "vehicle/car-1/wheel-1/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
        "vehicle/car-1/wheel-4/contact_force",
        "track/midspan/rail/displacement",
        "track/midspan/sleeper/displacement",
    ];
    let sine = |x: f64| 0.5e-3 * (std::f64::consts::TAU * x / 3.0).sin();
    let [one, two] = [1, 2].map(|elements| {
        let mut case = on_track(HERTZ, 5e-4, 1, 200.0 / 3.6);
        let track = case.track.as_mut().unwrap();
        track.elements = elements;
        track.window = Some(8.0);
        histories(&case, &names, sine)
    });
    for (k, name) in names.iter().enumerate() {
        let off = peak(&two[k]) / peak(&one[k]) - 1.0;
        assert!(off.abs() < 5e-3, "{name} {off}");
    }
}
