//! A distribution by a table: samples, or values at given probabilities.

use super::{Distribution, Tail};

/// Values at ascending probabilities, with straight lines between them and the ends' values beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// P(X ≤ x) and P(X > x) at each value.
    below: Vec<f64>,
    above: Vec<f64>,
    /// Ascending; equal ones have a probability of their own.
    values: Vec<f64>,
    mean: f64,
    deviation: f64,
}

/// Why a table is no distribution. Rows count from 1.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    #[error("fewer than two rows")]
    TooShort,
    #[error("row {row}: the value {value} is not finite")]
    NotFinite { row: usize, value: f64 },
    #[error("the value {value} in all rows")]
    NoSpread { value: f64 },
    #[error("row {row}: the probability {probability} is not in 0 ... 1")]
    NoProbability { row: usize, probability: f64 },
    #[error("row {row}: the probability {probability} does not exceed the one before, {before}")]
    ProbabilityNotIncreasing {
        row: usize,
        probability: f64,
        before: f64,
    },
    #[error("row {row}: the value {value} is below the one before, {before}")]
    ValueDecreasing { row: usize, value: f64, before: f64 },
}

impl Table {
    /// The empirical quantiles of n samples in any order: the i-th smallest at the probability (i − 1/2)/n. The mean
    /// is exactly the samples' mean.
    pub fn from_samples(samples: &[f64]) -> Result<Self, TableError> {
        check_finite(samples)?;
        let mut values = samples.to_vec();
        values.sort_unstable_by(f64::total_cmp);
        let n = values.len() as f64;
        let below: Vec<f64> = (0..values.len()).map(|i| (i as f64 + 0.5) / n).collect();
        let above = below.iter().rev().copied().collect();
        Table::new(below, above, values)
    }

    /// Values, ascending, at the probabilities P(X ≤ x) in [0, 1], ascending. Where the first one is above 0, or the
    /// last one below 1, the value at that end has the rest.
    pub fn from_quantiles(probabilities: &[f64], values: &[f64]) -> Result<Self, TableError> {
        check_finite(values)?;
        for (k, (p, value)) in probabilities.iter().zip(values).enumerate() {
            let (row, probability, value) = (k + 1, *p, *value);
            if !(0.0..=1.0).contains(&probability) {
                return Err(TableError::NoProbability { row, probability });
            }
            if k == 0 {
                continue;
            }
            if probability <= probabilities[k - 1] {
                let before = probabilities[k - 1];
                return Err(TableError::ProbabilityNotIncreasing {
                    row,
                    probability,
                    before,
                });
            }
            if value < values[k - 1] {
                let before = values[k - 1];
                return Err(TableError::ValueDecreasing { row, value, before });
            }
        }
        let above = probabilities.iter().map(|p| 1.0 - p).collect();
        Table::new(probabilities.to_vec(), above, values.to_vec())
    }

    fn new(below: Vec<f64>, above: Vec<f64>, values: Vec<f64>) -> Result<Self, TableError> {
        let last = values.len() - 1;
        if values[0] == values[last] {
            return Err(TableError::NoSpread { value: values[0] });
        }
        let mut table = Table {
            below,
            above,
            values,
            mean: 0.0,
            deviation: 0.0,
        };
        // Exact integrals of the straight lines, the second one about the mean.
        table.mean = table.integral(|a, b| 0.5 * (a + b));
        let mean = table.mean;
        let square = |a: f64, b: f64| (a * a + a * b + b * b) / 3.0;
        table.deviation = table.integral(|a, b| square(a - mean, b - mean)).sqrt();
        Ok(table)
    }

    /// The integral over the probability of a function whose mean on a line from a to b is `mean(a, b)`.
    fn integral(&self, mean: impl Fn(f64, f64) -> f64) -> f64 {
        let (values, last) = (&self.values, self.values.len() - 1);
        let cells = (1..=last)
            .map(|i| mean(values[i - 1], values[i]) * (self.below[i] - self.below[i - 1]));
        cells.sum::<f64>()
            + mean(values[0], values[0]) * self.below[0]
            + mean(values[last], values[last]) * self.above[last]
    }

    /// The probabilities `side` at x, where x is within the values.
    fn interpolated(&self, side: &[f64], x: f64) -> f64 {
        let i = self.values.partition_point(|value| *value <= x);
        let (Some(high), Some(low)) = (self.values.get(i), self.values.get(i.wrapping_sub(1)))
        else {
            return side[i.saturating_sub(1)];
        };
        side[i - 1] + (side[i] - side[i - 1]) * ((x - low) / (high - low))
    }

    /// The value at p, given that p lies between `side[i − 1]` and `side[i]`.
    fn between(&self, side: &[f64], i: usize, p: f64) -> f64 {
        if i == 0 {
            return self.values[0];
        }
        if i == self.values.len() {
            return self.values[i - 1];
        }
        let share = (p - side[i - 1]) / (side[i] - side[i - 1]);
        self.values[i - 1] + share * (self.values[i] - self.values[i - 1])
    }
}

fn check_finite(values: &[f64]) -> Result<(), TableError> {
    if values.len() < 2 {
        return Err(TableError::TooShort);
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(k) => Err(TableError::NotFinite {
            row: k + 1,
            value: values[k],
        }),
        None => Ok(()),
    }
}

impl Distribution for Table {
    fn kind(&self) -> &'static str {
        "table"
    }

    fn cumulative(&self, x: f64) -> f64 {
        if x < self.values[0] {
            0.0
        } else if x >= self.values[self.values.len() - 1] {
            1.0
        } else {
            self.interpolated(&self.below, x)
        }
    }

    fn exceedance(&self, x: f64) -> f64 {
        if x < self.values[0] {
            1.0
        } else if x >= self.values[self.values.len() - 1] {
            0.0
        } else {
            self.interpolated(&self.above, x)
        }
    }

    /// That between the values; equal values are not in it.
    fn density(&self, x: f64) -> f64 {
        let i = self.values.partition_point(|value| *value <= x);
        if i == 0 || i == self.values.len() {
            return 0.0;
        }
        (self.below[i] - self.below[i - 1]) / (self.values[i] - self.values[i - 1])
    }

    fn value(&self, tail: Tail) -> f64 {
        match tail {
            Tail::Below(p) => {
                let i = self.below.partition_point(|below| *below < p);
                self.between(&self.below, i, p)
            }
            Tail::Above(p) => {
                let i = self.above.partition_point(|above| *above > p);
                self.between(&self.above, i, p)
            }
        }
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn deviation(&self) -> f64 {
        self.deviation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_have_their_mean_and_come_back() {
        let samples = [3.0, -1.0, 7.0, 2.0, 2.0];
        let table = Table::from_samples(&samples).unwrap();
        assert!((table.mean() - 2.6).abs() < 1e-15);
        for (i, x) in [-1.0, 2.0, 2.0, 3.0, 7.0].into_iter().enumerate() {
            let p = (i as f64 + 0.5) / 5.0;
            assert!((table.value(Tail::Below(p)) - x).abs() < 1e-14, "{p}");
            assert!((table.value(Tail::Above(1.0 - p)) - x).abs() < 1e-14, "{p}");
        }
        // Beyond the outer samples and between the equal ones.
        assert_eq!(table.value(Tail::Below(1e-12)), -1.0);
        assert_eq!(table.value(Tail::Above(1e-12)), 7.0);
        assert_eq!(table.value(Tail::Below(0.4)), 2.0);
        assert_eq!((table.cumulative(-1.1), table.exceedance(-1.1)), (0.0, 1.0));
        assert_eq!((table.cumulative(7.0), table.exceedance(7.0)), (1.0, 0.0));
    }

    #[test]
    fn quantile_and_probability_are_inverse() {
        let values: Vec<f64> = (0..500).map(|k| f64::from(k).sqrt()).collect();
        let probabilities: Vec<f64> = (0..500).map(|k| f64::from(k * k) / 250e3).collect();
        for table in [
            Table::from_samples(&values).unwrap(),
            Table::from_quantiles(&probabilities, &values).unwrap(),
        ] {
            for k in 10..=1000 {
                let p = 0.5 * f64::from(k) / 1000.0;
                let x = table.value(Tail::Below(p));
                assert!((table.cumulative(x) - p).abs() < 1e-13 * p, "{p}");
                let x = table.value(Tail::Above(p));
                assert!((table.exceedance(x) - p).abs() < 1e-13 * p, "{p}");
            }
        }
    }

    #[test]
    fn moments_of_straight_lines() {
        // Uniform on 0 ... 2, in two pieces; then with an end that has a quarter of the probability.
        let table = Table::from_quantiles(&[0.0, 0.25, 1.0], &[0.0, 0.5, 2.0]).unwrap();
        assert!((table.mean() - 1.0).abs() < 1e-15);
        assert!((table.deviation() - 2.0 / 12f64.sqrt()).abs() < 1e-15);
        let table = Table::from_quantiles(&[0.25, 1.0], &[0.0, 1.0]).unwrap();
        assert!((table.mean() - 0.375).abs() < 1e-15);
        assert!((table.deviation().powi(2) - (0.25 - 0.375f64.powi(2))).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_distribution() {
        let message = |p: &[f64], x: &[f64]| Table::from_quantiles(p, x).unwrap_err().to_string();
        assert_eq!(message(&[0.5], &[1.0]), "fewer than two rows");
        assert_eq!(
            message(&[0.1, 1.1], &[1.0, 2.0]),
            "row 2: the probability 1.1 is not in 0 ... 1"
        );
        assert_eq!(
            message(&[0.1, 0.1], &[1.0, 2.0]),
            "row 2: the probability 0.1 does not exceed the one before, 0.1"
        );
        assert_eq!(
            message(&[0.1, 0.2], &[1.0, 0.5]),
            "row 2: the value 0.5 is below the one before, 1"
        );
        let samples = |x: &[f64]| Table::from_samples(x).unwrap_err().to_string();
        assert_eq!(samples(&[1.0, 1.0]), "the value 1 in all rows");
        assert_eq!(
            samples(&[1.0, f64::NAN]),
            "row 2: the value NaN is not finite"
        );
    }
}
