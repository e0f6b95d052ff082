//! Which time steps a scheme can take: the spectral radius of one coupled step, wheel held.

use super::{Crossing, CrossingTables, QuarterCar};
use nalgebra::DMatrix;

/// Wheel places along the span at which the coupled step is examined.
const PLACES: usize = 8;
/// A radius above this is growth: rounding of a double unit root is some 1e-8.
const GROWTH: f64 = 1e-6;

/// The largest spectral radius of one coupled step of the crossing, over places of the wheel (and
/// off the bridge), the vehicle linear: as it is, and with its bump stops engaged.
pub fn spectral_radius(crossing: &Crossing) -> f64 {
    let cars = [Some(crossing.car.clone()), crossing.car.on_its_stops()];
    cars.into_iter()
        .flatten()
        .map(|car| {
            (0..=PLACES)
                .map(|k| radius_at(crossing, &car, k as f64 / PLACES as f64))
                .fold(0.0, f64::max)
        })
        .fold(0.0, f64::max)
}

/// The largest step at which nothing grows (s), to three digits and rounded down; the step given
/// where that one is stable.
pub fn largest_stable_step(crossing: &Crossing) -> f64 {
    let stable = |step: f64| {
        let mut trial = crossing.clone();
        trial.time_step = step;
        spectral_radius(&trial) <= 1.0 + GROWTH
    };
    let mut high = crossing.time_step;
    if stable(high) {
        return high;
    }
    let mut low = high;
    while !stable(low) && low > 1e-12 {
        low *= 0.5;
    }
    while high / low > 1.0005 {
        let middle = (low * high).sqrt();
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let unit = 10f64.powf(low.log10().floor() - 2.0);
    (low / unit).floor() * unit
}

/// One step is probed column by column through the tables of a crossing that stands still there.
fn radius_at(crossing: &Crossing, car: &QuarterCar, place: f64) -> f64 {
    let still = Crossing {
        car: QuarterCar {
            speed: 0.0,
            // Irrational-like places, so that no mode has its node there.
            approach: -(0.031 + 0.937 * place) * crossing.beam.span,
            ..car.clone()
        },
        steps: 1,
        record_every: 1,
        ..crossing.clone()
    };
    let tables = still.tables(&[]);
    let modes = tables.maps.modal.len();
    let states = 3 * (modes + 2);
    let mut map = DMatrix::zeros(states, states);
    for column in 0..states {
        let mut x = vec![[0.0; 3]; modes + 2];
        x[column / 3][column % 3] = 1.0;
        for (row, value) in step(&tables, &x).iter().flatten().enumerate() {
            map[(row, column)] = *value;
        }
    }
    map.complex_eigenvalues()
        .iter()
        .map(|z| z.norm())
        .fold(0.0, f64::max)
}

/// One linear step of modes, heave and travel, without weight and irregularity.
fn step(tables: &CrossingTables, x: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let maps = &tables.maps;
    let modes = maps.modal.len();
    let (heave, travel) = (x[modes], x[modes + 1]);
    let car = &maps.crossing.car;
    let deck: f64 = (0..modes).map(|i| tables.shape[i] * x[i][0]).sum();
    let gap = deck - (heave[0] - car.wheel_share() * travel[0]);
    let p = tables.contact_stiffness[0] * gap;
    (0..modes)
        .map(|i| maps.modal[i].advance(x[i], tables.load[i] * p))
        .chain([
            maps.heave.advance(heave, p / car.mass()),
            maps.travel.advance(travel, -p / car.wheel_mass),
        ])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::paper_case;
    use super::*;
    use crate::integrate::Integrator;

    #[test]
    fn central_differences_take_six_modes_of_the_paper_at_ten_milliseconds() {
        for (modes, stable) in [(6, true), (7, false), (10, false)] {
            let mut crossing = paper_case(Integrator::ExplicitNewmark, 0.01);
            crossing.beam.modes = modes;
            assert_eq!(
                spectral_radius(&crossing) <= 1.0 + GROWTH,
                stable,
                "{modes}"
            );
        }
    }

    #[test]
    fn the_largest_step_is_two_over_the_highest_frequency() {
        let mut crossing = paper_case(Integrator::ExplicitNewmark, 0.05);
        crossing.beam.modes = 10;
        let step = largest_stable_step(&crossing);
        let limit = 2.0 / crossing.beam.frequency(10);
        // The tyre stiffens the highest mode a little.
        assert!(step < limit && step > 0.99 * limit, "{step} {limit}");
    }

    #[test]
    fn ten_modes_are_stable_at_any_step_by_the_others() {
        for integrator in [Integrator::Exponential, Integrator::Newmark] {
            let mut crossing = paper_case(integrator, 0.01);
            crossing.beam.modes = 10;
            assert!(spectral_radius(&crossing) <= 1.0 + GROWTH, "{integrator:?}");
        }
    }
}
