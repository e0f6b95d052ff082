//! Rigid bodies on springs and dashpots, as every car is.

/// Masses, springs and wheels of a car.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Multibody {
    /// The inertia of each coordinate (kg, kg m²): wheels first, then bogies, then the body.
    pub inertia: Vec<f64>,
    pub springs: Vec<Spring>,
    pub wheels: Vec<Wheel>,
    /// The named bodies that responses are recorded of.
    pub bodies: Vec<Body>,
}

/// Spring and dashpot on an elongation Σ aₖ uₖ.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// (coordinate, aₖ).
    pub elongation: Vec<(usize, f64)>,
    /// N/m, N s/m.
    pub stiffness: f64,
    pub damping: f64,
}

/// A wheel (or wheelset) in contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// From the car's first wheel (m).
    pub behind: f64,
    /// Its coordinate; none for a constant force.
    pub coordinate: Option<usize>,
    /// Static force (N, compression positive).
    pub weight: f64,
    /// A law of its own: the tyre's stiffness (N/m).
    pub tyre_stiffness: Option<f64>,
    /// R (m), where it is known.
    pub radius: Option<f64>,
    /// What is not round at it.
    pub irregularity: crate::irregularity::WheelIrregularity,
}

/// A place whose motion is Σ aₖ uₖ.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub part: crate::quantity::CarPart,
    pub motion: Vec<(usize, f64)>,
}

impl Multibody {
    /// Angular frequencies (rad/s, ascending) of the free vibration with the wheels held, undamped.
    pub fn frequencies(&self) -> Vec<f64> {
        let held: Vec<usize> = self.wheels.iter().filter_map(|w| w.coordinate).collect();
        let free: Vec<usize> = (0..self.inertia.len())
            .filter(|k| !held.contains(k))
            .collect();
        let root = |k: usize| self.inertia[k].sqrt();
        let mut scaled = nalgebra::DMatrix::zeros(free.len(), free.len());
        for (row, i) in free.iter().enumerate() {
            for (column, j) in free.iter().enumerate() {
                let stiffness: f64 = self.springs.iter().map(|s| s.stiffness_of(*i, *j)).sum();
                scaled[(row, column)] = stiffness / (root(*i) * root(*j));
            }
        }
        let mut squares: Vec<f64> = scaled.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        squares.into_iter().map(|s| s.max(0.0).sqrt()).collect()
    }

    /// The static displacements of all coordinates over those of the wheels, `[coordinate][wheel]`: where the
    /// wheels stand without a change of their forces.
    pub fn carried(&self) -> Vec<Vec<f64>> {
        let held: Vec<usize> = self.wheels.iter().filter_map(|w| w.coordinate).collect();
        let free: Vec<usize> = (0..self.inertia.len())
            .filter(|k| !held.contains(k))
            .collect();
        if free.is_empty() {
            let own = |row: usize| (0..held.len()).map(move |k| if k == row { 1.0 } else { 0.0 });
            return (0..held.len()).map(|row| own(row).collect()).collect();
        }
        let stiffness =
            |i: usize, j: usize| -> f64 { self.springs.iter().map(|s| s.stiffness_of(i, j)).sum() };
        let inner =
            nalgebra::DMatrix::from_fn(free.len(), free.len(), |r, c| stiffness(free[r], free[c]));
        let outer =
            nalgebra::DMatrix::from_fn(free.len(), held.len(), |r, c| -stiffness(free[r], held[c]));
        let moved = inner
            .lu()
            .solve(&outer)
            .unwrap_or_else(|| nalgebra::DMatrix::zeros(free.len(), held.len()));
        let mut rows = vec![vec![0.0; held.len()]; self.inertia.len()];
        for (wheel, coordinate) in held.iter().enumerate() {
            rows[*coordinate][wheel] = 1.0;
        }
        for (row, coordinate) in free.iter().enumerate() {
            rows[*coordinate] = moved.row(row).iter().copied().collect();
        }
        rows
    }
}

impl Spring {
    /// Its share of the stiffness matrix.
    fn stiffness_of(&self, row: usize, column: usize) -> f64 {
        let of = |k: usize| {
            let terms = self.elongation.iter().filter(|(at, _)| *at == k);
            terms.map(|(_, a)| a).sum::<f64>()
        };
        self.stiffness * of(row) * of(column)
    }
}

#[cfg(test)]
mod tests {
    use crate::system::train::{Car, RailVehicle};
    use std::f64::consts::TAU;

    fn vehicle(motor: bool) -> RailVehicle {
        let pick = |motor_car: f64, trailer: f64| if motor { motor_car } else { trailer };
        RailVehicle {
            body_mass: pick(48_000.0, 44_000.0),
            body_pitch_inertia: 2.7e6,
            bogie_mass: pick(3200.0, 2400.0),
            bogie_pitch_inertia: pick(7200.0, 2200.0),
            wheelset_mass: 2400.0,
            primary_stiffness: pick(2.08e6, 1.4e6),
            primary_damping: pick(6e4, 8e4),
            secondary_stiffness: pick(8e5, 6e5),
            secondary_damping: pick(9e4, 8e4),
            bogie_spacing: 17.375,
            wheelbase: 2.5,
            wheel_radius: 0.46,
            wheel_defects: Vec::new(),
        }
    }

    /// Zeng et al. 2014, Shock and Vibration 304219, Table 1: the frequencies of its values, computed
    /// independently; it prints .75, .84, 7.10 and .84, .97, 4.78 Hz.
    #[test]
    fn frequencies_of_published_vehicles() {
        for (motor, bounce, pitch, bogie_pitch) in [
            (false, 0.752967, 0.834718, 7.097376),
            (true, 0.840039, 0.972447, 4.782011),
        ] {
            let found: Vec<f64> = Car::RailVehicle(vehicle(motor))
                .multibody(9.81)
                .frequencies()
                .iter()
                .map(|w| w / TAU)
                .collect();
            assert_eq!(found.len(), 6);
            for expected in [bounce, pitch, bogie_pitch] {
                let near = found.iter().map(|f| (f - expected).abs());
                assert!(near.fold(f64::MAX, f64::min) < 5e-7, "{expected} {found:?}");
            }
        }
    }

    #[test]
    fn the_wheels_carry_the_weight_and_a_lifted_rail_lifts_the_car() {
        let vehicle = vehicle(false);
        let mass = 44_000.0 + 2.0 * 2400.0 + 4.0 * 2400.0;
        let bodies = Car::RailVehicle(vehicle).multibody(9.81);
        let weight: f64 = bodies.wheels.iter().map(|w| w.weight).sum();
        assert!((weight / (mass * 9.81) - 1.0).abs() < 1e-15);
        let carried = bodies.carried();
        // All wheels up by one: everything up by one, without pitch.
        let up: Vec<f64> = carried.iter().map(|row| row.iter().sum()).collect();
        for (k, expected) in [1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]
            .into_iter()
            .enumerate()
        {
            assert!((up[k] - expected).abs() < 1e-12, "{k} {up:?}");
        }
    }
}
