//! The energy of cars, track, bridge and contact together, without damping.

use super::*;
use crate::ensemble::train::shape::{COMPRESSION, OF_WHEEL, SOFTNESS};

/// A car that stands with one bogie on the bridge, nothing damped.
fn standing(contact: Contact, step: f64) -> TrainCrossing {
    let mut case = on_track(contact, step, 1, 1e-12);
    case.approach = -40.0;
    let Car::RailVehicle(vehicle) = &mut case.cars[0].car else {
        unreachable!("a rail vehicle")
    };
    vehicle.primary_damping = 0.0;
    vehicle.secondary_damping = 0.0;
    case.deck.as_mut().unwrap().damping = DeckDamping::Ratio(0.0);
    let mut track = ballasted(-30.0, 70.0);
    track.fastener.damping = 0.0;
    let Support::Ballasted(ballast) = &mut track.support else {
        unreachable!("ballasted track")
    };
    ballast.ballast.damping = 0.0;
    ballast.subgrade.damping = 0.0;
    ballast.on_bridge.bed.damping = 0.0;
    case.track = Some(track);
    // The irregularity presses wheel and rail together.
    case.initial_state = InitialState::Level;
    case
}

/// ½ v′Mv + ½ u′Ku, what the weights have in height, and what the contacts have taken up: relative to nothing in
/// particular. After a run of so many steps on rails raised by `height`.
fn energy(mut case: TrainCrossing, steps: usize, height: f64) -> f64 {
    case.steps = steps;
    let (start, count) = (-60.0, 3000);
    let row = vec![height; count];
    let trains = Trains::new(case, &[], (start, SPACING, count)).unwrap();
    let points = Points {
        excitation: &row,
        samples: count,
        parameters: &[],
        range: 0..1,
    };
    let mut stepper = TrainStepper::new(&trains);
    stepper
        .run_from(0, &points, &mut Strip::cut(&mut [], 1, 1)[0])
        .unwrap();
    let shape = &trains.shape;
    let of = |rows: &[f64]| -> Vec<f64> { rows.iter().step_by(TRAIN_LANES).copied().collect() };
    let u = of(stepper.state.displacement.values());
    let v = of(stepper.state.velocity.values());
    let assembly = shape.crossing.assembly();
    let lower = shape.pattern.collect(&assembly.matrices.values);
    let mut sum = 0.0;
    for row in 0..shape.size() {
        for (place, column) in shape.pattern.lower_row(row) {
            let share = if row == column { 0.5 } else { 1.0 };
            sum += share * lower.mass[place] * v[row] * v[column];
            sum += share * lower.stiffness[place] * u[row] * u[column];
        }
    }
    for (index, wheel) in shape.wheels.iter().enumerate() {
        let row = wheel.row.unwrap();
        let place = &shape.places[index];
        let rail: f64 = place.terms.iter().map(|(row, share)| share * u[*row]).sum();
        let own = shape.layout.wheels + OF_WHEEL * index;
        let [compression, softness] = [COMPRESSION, SOFTNESS].map(|k| trains.numbers[own + k]);
        let closed = compression + rail + height - u[row];
        sum += wheel.wheel.weight * u[row];
        // The rail between its nodes is a spring behind the contact.
        sum += match shape.laws[index] {
            Law::Linear => 0.5 * closed * closed / (softness + place.flexibility),
            Law::Hertz => {
                let force = |root: f64| root.powi(3);
                let root = (0..100).fold((closed / softness).sqrt(), |s, _| {
                    ((closed - place.flexibility * force(s)) / softness)
                        .max(0.0)
                        .sqrt()
                });
                let (force, own) = (force(root), softness * root * root);
                0.4 * force * own + 0.5 * place.flexibility * force * force
            }
            Law::Force => unreachable!("wheels with rows"),
        };
    }
    sum
}

/// The scheme keeps the energy of a linear system, but for rounding: of some thousand joules that swing between cars,
/// track, bridge and contact nothing is lost in two thousand steps.
#[test]
fn a_linear_system_keeps_its_energy() {
    let case = standing(Contact::Linear { stiffness: 2.8e9 }, 1e-3);
    // Pressed together by 1 mm, four contacts hold more than 2800 J beyond their rest.
    let swinging = 4.0 * 0.5 * 2.8e9 * 1e-6 / 2.0;
    let first = energy(case.clone(), 0, 1e-3);
    for steps in [10, 200, 2000] {
        let off = (energy(case.clone(), steps, 1e-3) - first) / swinging;
        assert!(off.abs() < 1e-9, "{steps} {off}");
    }
}

/// Hertz's law, taken in the middle of a step, keeps it to second order in the step, and without drift.
#[test]
fn hertz_keeps_energy_to_second_order() {
    // Raised by 0.02 mm: some joules, wheels stay on the rail.
    let off = |step: f64| -> f64 {
        let case = standing(HERTZ, step);
        let rest = energy(case.clone(), 0, 0.0);
        let first = energy(case.clone(), 0, 2e-5);
        let times = [0.05, 0.1, 0.2, 0.4, 0.8];
        let late = times.map(|t| energy(case.clone(), (t / step) as usize, 2e-5));
        let worst = late.iter().map(|e| (e - first).abs()).fold(0.0, f64::max);
        worst / (first - rest)
    };
    let [coarse, fine] = [2e-4, 5e-5].map(off);
    assert!(coarse < 1e-2, "{coarse}");
    // A sixteenth, but for where in their swing the times find it.
    assert!(fine < coarse / 8.0, "{coarse} {fine}");
}
