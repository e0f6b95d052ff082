//! Rows as plain structs.

/// The probabilities of the quantiles q001 ... q999 of a row of moments.
pub const QUANTILES: [f64; 9] = [0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999];

/// Moments and quantiles of a quantity at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct MomentsRow {
    /// The quantity.
    pub quantity: String,
    /// s
    pub time: f64,
    /// Weighted mean, in the quantity's unit.
    pub mean: f64,
    /// Weighted standard deviation, in the quantity's unit.
    pub std: f64,
    /// Third central moment over std^3; NaN without spread.
    pub skewness: f64,
    /// Fourth central moment over std^4 (3 for a normal); NaN without spread.
    pub kurtosis: f64,
    /// The quantiles of [`QUANTILES`], in the quantity's unit.
    pub quantiles: [f64; 9],
    /// Standard deviation of the smoothing kernel, in the quantity's unit.
    pub smoothing_width: f64,
    /// Effective number of points.
    pub effective_count: f64,
}

impl MomentsRow {
    pub(super) fn numbers(&self) -> [f64; 16] {
        let mut numbers = [0.0; 16];
        numbers[..5].copy_from_slice(&[
            self.time,
            self.mean,
            self.std,
            self.skewness,
            self.kurtosis,
        ]);
        numbers[5..14].copy_from_slice(&self.quantiles);
        numbers[14..].copy_from_slice(&[self.smoothing_width, self.effective_count]);
        numbers
    }

    pub(super) fn from_numbers(quantity: String, numbers: &[f64; 16]) -> MomentsRow {
        let [
            time,
            mean,
            std,
            skewness,
            kurtosis,
            quantiles @ ..,
            smoothing_width,
            effective_count,
        ] = *numbers;
        MomentsRow {
            quantity,
            time,
            mean,
            std,
            skewness,
            kurtosis,
            quantiles,
            smoothing_width,
            effective_count,
        }
    }
}

/// Reliability against a limit up to a time.
#[derive(Debug, Clone, PartialEq)]
pub struct ReliabilityRow {
    /// The limit's name.
    pub limit: String,
    /// How the reliability was found.
    pub method: String,
    /// s
    pub time: f64,
    /// Probability that the limit was not passed up to this time.
    pub reliability: f64,
    /// 1 - reliability, without the loss of digits.
    pub failure_probability: f64,
    /// Lower confidence bound of the failure probability.
    pub lower: f64,
    /// Upper confidence bound of the failure probability.
    pub upper: f64,
    /// Standard deviation of the smoothing kernel, in the unit of the limit's quantity; 0 without one.
    pub smoothing_width: f64,
}

impl ReliabilityRow {
    pub(super) fn numbers(&self) -> [f64; 6] {
        [
            self.time,
            self.reliability,
            self.failure_probability,
            self.lower,
            self.upper,
            self.smoothing_width,
        ]
    }

    pub(super) fn from_numbers(
        limit: String,
        method: String,
        numbers: &[f64; 6],
    ) -> ReliabilityRow {
        let [
            time,
            reliability,
            failure_probability,
            lower,
            upper,
            smoothing_width,
        ] = *numbers;
        ReliabilityRow {
            limit,
            method,
            time,
            reliability,
            failure_probability,
            lower,
            upper,
            smoothing_width,
        }
    }
}

/// The distances between two densities of a quantity at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonRow {
    /// The quantity (of two tables of extremes: the limit).
    pub quantity: String,
    /// s
    pub time: f64,
    /// L1 distance.
    pub l1: f64,
    /// Half the L1 distance.
    pub total_variation: f64,
    /// Largest difference of the cumulative probabilities.
    pub kolmogorov_smirnov: f64,
    /// Area between the cumulative probabilities, in the quantity's unit.
    pub wasserstein_1: f64,
    /// Hellinger distance.
    pub hellinger: f64,
    /// Mean of the first less that of the second, in the quantity's unit.
    pub mean_error: f64,
    /// The same of the standard deviations.
    pub std_error: f64,
    /// Standard deviation of the second, in the quantity's unit.
    pub std: f64,
    /// Quantiles of the first less those of the second, in the quantity's unit, in the table's order.
    pub quantile_errors: Vec<f64>,
}

impl ComparisonRow {
    pub(super) fn numbers(&self) -> Vec<f64> {
        let mut numbers = vec![
            self.time,
            self.l1,
            self.total_variation,
            self.kolmogorov_smirnov,
            self.wasserstein_1,
            self.hellinger,
            self.mean_error,
            self.std_error,
            self.std,
        ];
        numbers.extend_from_slice(&self.quantile_errors);
        numbers
    }

    pub(super) fn from_numbers(
        quantity: String,
        numbers: &[f64; 9],
        quantile_errors: Vec<f64>,
    ) -> ComparisonRow {
        let [
            time,
            l1,
            total_variation,
            kolmogorov_smirnov,
            wasserstein_1,
            hellinger,
            mean_error,
            std_error,
            std,
        ] = *numbers;
        ComparisonRow {
            quantity,
            time,
            l1,
            total_variation,
            kolmogorov_smirnov,
            wasserstein_1,
            hellinger,
            mean_error,
            std_error,
            std,
            quantile_errors,
        }
    }
}

/// The error of one density, over its times.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRow {
    /// The title of the scenario.
    pub case: String,
    /// The rule of points.
    pub points: String,
    /// The rule of smoothing.
    pub smoothing: String,
    /// Number of points.
    pub count: f64,
    /// Seed of the points.
    pub seed: f64,
    /// L1 distance from the reference, mean over time.
    pub l1: f64,
    /// Relative error of the standard deviation, root mean square over time.
    pub sigma_error: f64,
    /// Processor time of points, simulation and densities, s.
    pub cpu_time: f64,
}

impl StudyRow {
    pub(super) fn numbers(&self) -> [f64; 5] {
        [
            self.count,
            self.seed,
            self.l1,
            self.sigma_error,
            self.cpu_time,
        ]
    }

    pub(super) fn from_numbers(texts: [String; 3], numbers: &[f64; 5]) -> StudyRow {
        let [case, points, smoothing] = texts;
        let [count, seed, l1, sigma_error, cpu_time] = *numbers;
        StudyRow {
            case,
            points,
            smoothing,
            count,
            seed,
            l1,
            sigma_error,
            cpu_time,
        }
    }
}
