//! How a density is shown by colour or height: its axis, and where it ends.

use super::axes::{Axis, Scale};

/// The scale of a density's colours or heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DensityScale {
    Linear,
    /// Shows the flanks beside the peak, and zero as zero.
    #[default]
    SquareRoot,
    /// Four powers of ten below the highest peak.
    Logarithmic,
}

/// Peaks above this many times the median peak (over time) share the end of a scale: a response that
/// starts without spread has peaks without bound, and all other times would lie in the dark.
const MOST_ABOVE_MEDIAN: f64 = 4.0;

/// The axis of densities whose highest values, time by time, are `peaks`; and whether it ends below
/// the highest of them.
pub(super) fn density_axis(label: String, peaks: &[f64], scale: DensityScale) -> (Axis, bool) {
    let mut sorted: Vec<f64> = peaks.iter().copied().filter(|&peak| peak > 0.0).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (highest, median) = match sorted.last() {
        Some(&highest) => (highest, sorted[sorted.len() / 2]),
        None => (1.0, 1.0),
    };
    let high = highest.min(MOST_ABOVE_MEDIAN * median);
    match scale {
        DensityScale::Linear => (Axis::linear(label, 0.0, high), high < highest),
        DensityScale::SquareRoot => {
            let linear = Axis::linear(label, 0.0, high);
            let scale = Scale::SquareRoot;
            (Axis { scale, ..linear }, high < highest)
        }
        DensityScale::Logarithmic => (Axis::logarithmic(label, 1e-4 * highest, highest), false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_towers_do_not_darken_the_rest() {
        let mut peaks = vec![1.0; 99];
        peaks.push(1000.0);
        for scale in [DensityScale::Linear, DensityScale::SquareRoot] {
            let (axis, cut) = density_axis(String::new(), &peaks, scale);
            assert_eq!((axis.low, axis.high, cut), (0.0, 4.0, true));
        }
        let (axis, cut) = density_axis(String::new(), &peaks, DensityScale::Logarithmic);
        assert_eq!((axis.low, axis.high, cut), (0.1, 1000.0, false));
    }

    #[test]
    fn peaks_of_one_size_end_the_scale() {
        let (axis, cut) = density_axis(String::new(), &[2.0, 3.0, 5.0], DensityScale::Linear);
        assert_eq!((axis.high, cut), (5.0, false));
    }
}
