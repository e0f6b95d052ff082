//! Cars in a row.

use super::car::Spacing;
use super::{CarSpec, Misfit, statics};
use crate::system::train::{Car, PlacedCar};

/// Lengths that differ by less are the same (m): what rounding leaves of sums.
const ROUNDING: f64 = 1e-9;

/// What is known of the cars placed so far.
#[derive(Default)]
struct Row {
    cars: Vec<PlacedCar>,
    /// The last wheel (m behind the train's first).
    last_wheel: f64,
    /// The last car's rear end (m behind the train's first wheel), where its length is known.
    end: Option<f64>,
}

/// The cars in their places, from the front; a misfit's key is below `vehicle`.
pub(in crate::scenario) fn placed(specs: &[CarSpec]) -> Result<Vec<PlacedCar>, Misfit> {
    let mut row = Row::default();
    for (index, spec) in specs.iter().enumerate() {
        let below = |misfit: Misfit| misfit.below(&format!("car.{index}"));
        let car = spec.build().map_err(below)?;
        let spacing = spec.spacing();
        for copy in 0..spacing.count {
            row.add(&car, &spacing, copy)
                .map_err(|misfit| match misfit {
                    Unfit::Here(misfit) => below(misfit),
                    Unfit::Before => {
                        let before = if copy > 0 { index } else { index - 1 };
                        Misfit::missing(format!("car.{before}.length"))
                            .remedy("give it, or each car's place by behind")
                    }
                })?;
        }
    }
    Ok(row.cars)
}

/// Why a car can't be placed.
enum Unfit {
    /// By a key of its own.
    Here(Misfit),
    /// Since the length of the car before it is not known.
    Before,
}

impl Row {
    fn add(&mut self, car: &Car, spacing: &Spacing, copy: u32) -> Result<(), Unfit> {
        let extent = statics::extent(car);
        let overhang = match spacing.length {
            Some(length) if length < extent => {
                let expected = format!("at least {extent:?} (m), from the first wheel to the last");
                let misfit = Misfit::bad("length", expected, format!("{length:?}"));
                return Err(Unfit::Here(misfit));
            }
            length => length.map(|length| (length - extent) / 2.0),
        };
        let given = spacing.behind.filter(|_| copy == 0);
        let behind = match (given, self.cars.is_empty()) {
            (None, true) => 0.0,
            (Some(behind), true) => {
                if behind != 0.0 {
                    let expected = "0: the train's first wheel is its own";
                    let misfit = Misfit::bad("behind", expected, format!("{behind:?}"));
                    return Err(Unfit::Here(misfit));
                }
                0.0
            }
            (Some(behind), false) => self.free(behind, overhang).map_err(Unfit::Here)?,
            (None, false) => {
                let end = self.end.ok_or(Unfit::Before)?;
                let missing = || Misfit::missing("length").remedy("give it, or behind");
                end + overhang.ok_or_else(missing).map_err(Unfit::Here)?
            }
        };
        self.last_wheel = behind + extent;
        self.end = overhang.map(|overhang| self.last_wheel + overhang);
        self.cars.push(PlacedCar {
            car: car.clone(),
            behind,
        });
        Ok(())
    }

    /// The place `behind`, if it is free for a car with this overhang before its first wheel.
    fn free(&self, behind: f64, overhang: Option<f64>) -> Result<f64, Misfit> {
        let expected = match (self.end, overhang) {
            (Some(end), Some(overhang)) if behind - overhang < end - ROUNDING => {
                format!(
                    "at least {:.6} (m), where the ends of the two cars touch: they overlap",
                    end + overhang
                )
            }
            _ if behind <= self.last_wheel => format!(
                "more than {:?} (m), where the car before it has its last wheel: they overlap",
                self.last_wheel
            ),
            _ => return Ok(behind),
        };
        Err(Misfit::bad("behind", expected, format!("{behind:?}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn cars(json: serde_json::Value) -> Vec<CarSpec> {
        serde_json::from_value(json).unwrap()
    }

    #[test]
    fn ends_of_neighbours_touch() {
        let specs = cars(json!([
            { "kind": "rail-vehicle", "preset": "zeng-2014-trailer", "count": 3 },
            { "kind": "sprung-mass", "body_mass": 1, "wheel_mass": 1, "stiffness": 1, "length": 4 },
        ]));
        let places: Vec<f64> = placed(&specs)
            .unwrap()
            .iter()
            .map(|car| car.behind)
            .collect();
        // Overhang (24.275 - 17.375 - 2.5) / 2 = 2.2 m, and 2 m before and behind the sprung mass.
        let expected = [0.0, 24.275, 2.0 * 24.275, 3.0 * 24.275 - 2.2 + 2.0];
        for (place, expected) in places.iter().zip(expected) {
            assert!((place - expected).abs() < 1e-12, "{places:?}");
        }
    }

    #[test]
    fn a_given_place_goes_before() {
        let specs = cars(json!([
            { "kind": "moving-mass", "mass": 1 },
            { "kind": "moving-mass", "mass": 1, "behind": 3, "length": 2, "count": 2 },
        ]));
        let places: Vec<f64> = placed(&specs)
            .unwrap()
            .iter()
            .map(|car| car.behind)
            .collect();
        assert_eq!(places, [0.0, 3.0, 5.0]);
    }
}
