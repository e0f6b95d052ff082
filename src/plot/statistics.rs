//! Mean and quantiles over time, and whether a picture measures values from the mean.

use super::check;
use crate::Result;

/// Mean and quantiles of a response at each time, in its SI unit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Statistics {
    /// s, ascending.
    pub times: Vec<f64>,
    pub mean: Vec<f64>,
    pub quantile_05: Vec<f64>,
    pub quantile_25: Vec<f64>,
    pub quantile_75: Vec<f64>,
    pub quantile_95: Vec<f64>,
}

/// What the value axis of a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ValueAxis {
    /// The deviation from the mean where the mean travels more than five times the widest range from
    /// the 5 % to the 95 % quantile: the value itself would be a hairline.
    #[default]
    Automatic,
    Value,
    DeviationFromMean,
}

impl Statistics {
    /// The weighted mean and quantiles of representative responses: `responses[point]` is a history
    /// over `times`, `probabilities` their assigned probabilities, of any sum.
    ///
    /// The quantile of `q` is interpolated between the sorted values at the middles of their
    /// probabilities.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where lengths differ, a value is not finite or nothing is there.
    pub fn from_responses(
        times: &[f64],
        responses: &[&[f64]],
        probabilities: &[f64],
    ) -> Result<Self> {
        let picture = "mean and quantiles";
        check::ascending(picture, "times", times)?;
        check::at_least(picture, "responses", 1, responses.len())?;
        check::same_length(
            picture,
            "probabilities",
            responses.len(),
            probabilities.len(),
        )?;
        check::positive(
            picture,
            "sum of the probabilities",
            probabilities.iter().sum(),
        )?;
        for response in responses {
            check::same_length(picture, "times of a response", times.len(), response.len())?;
            check::finite(picture, "responses", response)?;
        }
        let mut result = Statistics::default();
        let mut sorted = Vec::with_capacity(responses.len());
        for (index, &time) in times.iter().enumerate() {
            sorted.clear();
            let rows = responses.iter().zip(probabilities);
            let rows = rows.filter(|(_, probability)| **probability > 0.0);
            sorted.extend(rows.map(|(response, &p)| (response[index], p)));
            sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            result.push(time, weighted_mean(&sorted), |q| {
                weighted_quantile(&sorted, q)
            });
        }
        Ok(result)
    }

    /// Adds a time.
    pub(super) fn push(&mut self, time: f64, mean: f64, quantile: impl Fn(f64) -> f64) {
        self.times.push(time);
        self.mean.push(mean);
        self.quantile_05.push(quantile(0.05));
        self.quantile_25.push(quantile(0.25));
        self.quantile_75.push(quantile(0.75));
        self.quantile_95.push(quantile(0.95));
    }

    /// # Errors
    /// [`crate::Error::Input`] where lengths differ or a value is not finite.
    pub(super) fn check(&self, picture: &str) -> Result<()> {
        check::ascending(picture, "times", &self.times)?;
        check::at_least(picture, "times", 2, self.times.len())?;
        for values in [
            &self.mean,
            &self.quantile_05,
            &self.quantile_25,
            &self.quantile_75,
            &self.quantile_95,
        ] {
            check::same_length(
                picture,
                "values of mean and quantiles",
                self.times.len(),
                values.len(),
            )?;
            check::finite(picture, "mean and quantiles", values)?;
        }
        Ok(())
    }

    /// The mean at `time`, interpolated; constant beyond the ends.
    pub(super) fn mean_at(&self, time: f64) -> f64 {
        let right = self.times.partition_point(|&t| t <= time);
        if right == 0 {
            return self.mean[0];
        }
        if right == self.times.len() {
            return self.mean[right - 1];
        }
        let (t0, t1) = (self.times[right - 1], self.times[right]);
        let part = (time - t0) / (t1 - t0);
        self.mean[right - 1] + part * (self.mean[right] - self.mean[right - 1])
    }

    /// Whether values are measured from the mean.
    pub(super) fn deviates(&self, axis: ValueAxis) -> bool {
        match axis {
            ValueAxis::Value => false,
            ValueAxis::DeviationFromMean => true,
            ValueAxis::Automatic => {
                let (low, high) = range(self.mean.iter().copied());
                let widths = self
                    .quantile_95
                    .iter()
                    .zip(&self.quantile_05)
                    .map(|(b, a)| b - a);
                let widest = widths.fold(0.0, f64::max);
                widest > 0.0 && high - low > 5.0 * widest
            }
        }
    }
}

/// The smallest and the largest of `values`.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(start, |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

fn weighted_mean(sorted: &[(f64, f64)]) -> f64 {
    let total: f64 = sorted.iter().map(|(_, p)| p).sum();
    sorted.iter().map(|(value, p)| p / total * value).sum()
}

fn weighted_quantile(sorted: &[(f64, f64)], q: f64) -> f64 {
    let total: f64 = sorted.iter().map(|(_, p)| p).sum();
    let wanted = q * total;
    let mut below = 0.0;
    let mut last: Option<(f64, f64)> = None;
    for &(value, probability) in sorted {
        let middle = below + 0.5 * probability;
        below += probability;
        if middle >= wanted {
            return match last {
                Some((v, m)) if middle > m => v + (wanted - m) / (middle - m) * (value - v),
                Some(_) | None => value,
            };
        }
        last = Some((value, middle));
    }
    last.map_or(f64::NAN, |(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_a_staircase_are_exact() {
        // 100 values 0.005, 0.015, ... 0.995, equally probable: the quantile of q is q.
        let rows: Vec<[f64; 1]> = (0..100).map(|i| [(f64::from(i) + 0.5) / 100.0]).collect();
        let rows: Vec<&[f64]> = rows.iter().map(|row| row.as_slice()).collect();
        let found = Statistics::from_responses(&[0.0], &rows, &[0.01; 100]).unwrap();
        let of = [
            &found.quantile_05,
            &found.quantile_25,
            &found.mean,
            &found.quantile_75,
            &found.quantile_95,
        ];
        for (found, expected) in of.into_iter().zip([0.05, 0.25, 0.5, 0.75, 0.95]) {
            assert!(
                (found[0] - expected).abs() < 1e-14,
                "{} {expected}",
                found[0]
            );
        }
    }

    #[test]
    fn a_point_without_probability_counts_for_nothing() {
        let found =
            Statistics::from_responses(&[0.0, 1.0], &[&[1.0, 2.0], &[500.0, -500.0]], &[1.0, 0.0]);
        let found = found.unwrap();
        assert_eq!(
            (&found.mean, &found.quantile_95),
            (&vec![1.0, 2.0], &vec![1.0, 2.0])
        );
    }

    #[test]
    fn a_narrow_band_about_a_long_travel_is_measured_from_the_mean() {
        let statistics = |width: f64| {
            let mut result = Statistics::default();
            for i in 0..10 {
                let mean = f64::from(i);
                result.push(mean, mean, |q| mean + width * (q - 0.5) / 0.9);
            }
            result
        };
        assert!(statistics(1.0).deviates(ValueAxis::Automatic));
        assert!(!statistics(2.0).deviates(ValueAxis::Automatic));
        assert!(!statistics(0.0).deviates(ValueAxis::Automatic));
        assert!(!statistics(1.0).deviates(ValueAxis::Value));
        assert!(statistics(2.0).deviates(ValueAxis::DeviationFromMean));
        assert_eq!(statistics(1.0).mean_at(2.25), 2.25);
    }
}
