//! Many points at once: superposition, parameters in the lanes.

use super::*;

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
