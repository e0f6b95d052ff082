//! A density over time, each time with nodes of its own, read at any time and value.

use super::check;
use super::statistics::Statistics;
use crate::Result;

/// The probability density of a response at one time: linear between its nodes, zero outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DensityAtTime<'a> {
    /// s.
    pub time: f64,
    /// Ascending, in the SI unit of the response.
    pub values: &'a [f64],
    /// One for each value, in the inverse unit.
    pub densities: &'a [f64],
}

/// A density with its cumulative probability, mean and standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slice<'a> {
    pub density: DensityAtTime<'a>,
    cumulative: Vec<f64>,
    pub mean: f64,
    pub standard_deviation: f64,
}

impl<'a> Slice<'a> {
    pub(super) fn new(picture: &str, density: &DensityAtTime<'a>) -> Result<Self> {
        let (v, p) = (density.values, density.densities);
        check::at_least(picture, "values of a density", 2, v.len())?;
        check::same_length(picture, "densities of a time", v.len(), p.len())?;
        check::ascending(picture, "values of a density", v)?;
        check::finite(picture, "densities", p)?;
        let mut cumulative = vec![0.0];
        let mut first = 0.0;
        for i in 1..v.len() {
            let h = v[i] - v[i - 1];
            cumulative.push(cumulative[i - 1] + 0.5 * h * (p[i] + p[i - 1]));
            // About the first node: values far from zero would lose digits.
            let (a, b) = (v[i - 1] - v[0], v[i] - v[0]);
            first += h / 6.0 * (p[i - 1] * (2.0 * a + b) + p[i] * (a + 2.0 * b));
        }
        let total = cumulative[v.len() - 1];
        check::positive(picture, "integral of a density", total)?;
        let mean = v[0] + first / total;
        let mut second = 0.0;
        for i in 1..v.len() {
            let (a, b) = (v[i - 1] - mean, v[i] - mean);
            let (left, right) = (
                3.0 * a * a + 2.0 * a * b + b * b,
                a * a + 2.0 * a * b + 3.0 * b * b,
            );
            second += (b - a) / 12.0 * (p[i - 1] * left + p[i] * right);
        }
        Ok(Slice {
            density: *density,
            cumulative,
            mean,
            standard_deviation: (second / total).sqrt(),
        })
    }

    /// The probability of a response below `value`.
    pub(super) fn probability_below(&self, value: f64) -> f64 {
        let (v, p) = (self.density.values, self.density.densities);
        let right = v.partition_point(|&node| node <= value);
        if right == 0 {
            return 0.0;
        }
        if right == v.len() {
            return self.cumulative[right - 1];
        }
        let (x, h) = (value - v[right - 1], v[right] - v[right - 1]);
        let here = p[right - 1] + (p[right] - p[right - 1]) * x / h;
        self.cumulative[right - 1] + 0.5 * x * (p[right - 1] + here)
    }

    /// The value that a response is below with the probability `q`, relative to the density's integral.
    pub(super) fn quantile(&self, q: f64) -> f64 {
        let (v, p) = (self.density.values, self.density.densities);
        let wanted = q * self.cumulative[v.len() - 1];
        let right = self
            .cumulative
            .partition_point(|&c| c < wanted)
            .clamp(1, v.len() - 1);
        let (h, missing) = (v[right] - v[right - 1], wanted - self.cumulative[right - 1]);
        // The root of p0 x + (p1 - p0) x² / (2 h) = missing that does not cancel.
        let (p0, slope) = (p[right - 1], (p[right] - p[right - 1]) / h);
        let denominator = p0 + (p0 * p0 + 2.0 * slope * missing).max(0.0).sqrt();
        let x = if denominator > 0.0 {
            2.0 * missing / denominator
        } else {
            0.0
        };
        v[right - 1] + x.clamp(0.0, h)
    }
}

/// Densities over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Evolution<'a> {
    pub slices: Vec<Slice<'a>>,
    /// Two neighbours further apart than this (s) have nothing between them.
    gap: f64,
}

impl<'a> Evolution<'a> {
    /// # Errors
    /// [`crate::Error::Input`] where there are fewer than two times or a density is none.
    pub(super) fn new(picture: &str, densities: &[DensityAtTime<'a>]) -> Result<Self> {
        check::at_least(picture, "times", 2, densities.len())?;
        let times: Vec<f64> = densities.iter().map(|density| density.time).collect();
        check::ascending(picture, "times", &times)?;
        let slices = densities.iter().map(|density| Slice::new(picture, density));
        let slices = slices.collect::<Result<Vec<_>>>()?;
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_unstable_by(f64::total_cmp);
        // Times without spread have no density: don't paint over many of them.
        let gap = 3.5 * steps[steps.len() / 2];
        Ok(Evolution { slices, gap })
    }

    /// First and last time.
    pub(super) fn time_range(&self) -> (f64, f64) {
        let last = self.slices.len() - 1;
        (self.slices[0].density.time, self.slices[last].density.time)
    }

    pub(super) fn statistics(&self) -> Statistics {
        let mut result = Statistics::default();
        for slice in &self.slices {
            result.push(slice.density.time, slice.mean, |q| slice.quantile(q));
        }
        result
    }

    /// The values that hold all but a thousandth of the probability on either side at every time,
    /// measured from the mean where `deviates`.
    pub(super) fn value_range(&self, deviates: bool) -> (f64, f64) {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for slice in &self.slices {
            let origin = if deviates { slice.mean } else { 0.0 };
            range.0 = range.0.min(slice.quantile(0.001) - origin);
            range.1 = range.1.max(slice.quantile(0.999) - origin);
        }
        range
    }

    /// As [`Evolution::value_range`], measured from the mean in standard deviations, and half as much
    /// again: where a square root of the density ends as well.
    pub(super) fn standard_range(&self) -> (f64, f64) {
        let distance =
            |slice: &Slice<'_>, q| (slice.quantile(q) - slice.mean) / slice.standard_deviation;
        let lowest = self.slices.iter().map(|slice| distance(slice, 0.001));
        let highest = self.slices.iter().map(|slice| distance(slice, 0.999));
        (
            1.5 * lowest.fold(0.0, f64::min),
            1.5 * highest.fold(0.0, f64::max),
        )
    }

    /// The density at `time`, none outside of all times or in a gap.
    pub(super) fn at(&self, time: f64) -> Option<Column<'_>> {
        let times = |slice: &Slice<'_>| slice.density.time;
        let right = self.slices.partition_point(|slice| times(slice) < time);
        let right = right.clamp(1, self.slices.len() - 1);
        let (left, right) = (&self.slices[right - 1], &self.slices[right]);
        let step = times(right) - times(left);
        let part = (time - times(left)) / step;
        // A rounding error beyond the first or last time still belongs to it.
        let inside = (-1e-9..=1.0 + 1e-9).contains(&part);
        (inside && step <= self.gap).then(|| Column::between(left, right, part.clamp(0.0, 1.0)))
    }
}

/// A density between two times: both, moved and stretched to the mean and the standard deviation of
/// the time between them, so that a ridge that moves stays one ridge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column<'a> {
    left: &'a Slice<'a>,
    right: &'a Slice<'a>,
    part: f64,
    pub mean: f64,
    pub standard_deviation: f64,
}

impl<'a> Column<'a> {
    fn between(left: &'a Slice<'a>, right: &'a Slice<'a>, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Column {
            left,
            right,
            part,
            mean: mix(left.mean, right.mean),
            standard_deviation: mix(left.standard_deviation, right.standard_deviation),
        }
    }

    fn probability_below(&self, value: f64) -> f64 {
        let distance = (value - self.mean) / self.standard_deviation;
        let of = |slice: &Slice<'_>| {
            slice.probability_below(slice.mean + distance * slice.standard_deviation)
        };
        match self.part {
            0.0 => of(self.left),
            1.0 => of(self.right),
            part => (1.0 - part) * of(self.left) + part * of(self.right),
        }
    }

    /// The mean density in each of `count` equal cells from `low` to `high`.
    pub(super) fn cells(&self, low: f64, high: f64, count: usize) -> Vec<f64> {
        let width = (high - low) / count as f64;
        let mut below = self.probability_below(low);
        let cell = |index: usize| {
            let next = self.probability_below(low + (index + 1) as f64 * width);
            ((next - std::mem::replace(&mut below, next)) / width).max(0.0)
        };
        (0..count).map(cell).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of half width `w` about `m`: mean m, variance w²/6, median m.
    fn triangle(mean: f64, w: f64) -> ([f64; 3], [f64; 3]) {
        ([mean - w, mean, mean + w], [0.0, 1.0 / w, 0.0])
    }

    fn at<'a>(time: f64, of: &'a ([f64; 3], [f64; 3])) -> DensityAtTime<'a> {
        DensityAtTime {
            time,
            values: &of.0,
            densities: &of.1,
        }
    }

    #[test]
    fn a_triangle_has_its_exact_moments_and_quantiles() {
        let data = triangle(-94.0, 0.5);
        let slice = Slice::new("test", &at(0.0, &data)).unwrap();
        assert!((slice.mean + 94.0).abs() < 1e-13);
        assert!((slice.standard_deviation - (0.25_f64 / 6.0).sqrt()).abs() < 1e-12);
        // F(m - w + x) = x² / (2 w²).
        for q in [0.001_f64, 0.05, 0.3, 0.5] {
            let expected = -94.5 + 0.5 * (2.0 * q).sqrt();
            assert!((slice.quantile(q) - expected).abs() < 1e-12, "{q}");
            assert!((slice.probability_below(expected) - q).abs() < 1e-12, "{q}");
        }
    }

    #[test]
    fn between_two_times_a_moving_ridge_stays_one() {
        let (a, b) = (triangle(0.0, 1.0), triangle(10.0, 3.0));
        let evolution = Evolution::new("test", &[at(0.0, &a), at(1.0, &b)]).unwrap();
        let middle = evolution.at(0.5).unwrap();
        let expected = triangle(5.0, 2.0);
        let exact = Slice::new("test", &at(0.5, &expected)).unwrap();
        for value in [2.9, 3.5, 5.0, 6.2, 7.1] {
            let difference = middle.probability_below(value) - exact.probability_below(value);
            assert!(difference.abs() < 1e-12);
        }
        let cells = middle.cells(0.0, 10.0, 57);
        assert!((cells.iter().sum::<f64>() * 10.0 / 57.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_is_painted_outside_or_in_a_gap() {
        let data = triangle(0.0, 1.0);
        let times = [0.0, 1.0, 2.0, 3.0, 10.0, 11.0, 12.0];
        let densities: Vec<DensityAtTime<'_>> = times.iter().map(|&t| at(t, &data)).collect();
        let evolution = Evolution::new("test", &densities).unwrap();
        let painted = |time| evolution.at(time).is_some();
        assert!(painted(0.0) && painted(2.5) && painted(12.0));
        assert!(!painted(-0.1) && !painted(5.0) && !painted(12.1));
    }

    #[test]
    fn what_is_no_density_is_refused() {
        let descending = ([1.0, 0.0, 2.0], [0.0, 1.0, 0.0]);
        let nothing = ([0.0, 1.0, 2.0], [0.0, 0.0, 0.0]);
        for (data, expected) in [
            (
                descending,
                "test: values of a density: expected ascending numbers, found 0 after 1",
            ),
            (
                nothing,
                "test: integral of a density: expected a positive number, found 0",
            ),
        ] {
            let error = Slice::new("test", &at(0.0, &data)).unwrap_err();
            assert_eq!(error.to_string(), expected);
        }
    }
}
