//! The judgements, and one of them made ready for runs.

use super::sperling::{self, Direction, comfort_filter, line_weight, ride_quality_filter};
use super::{Lines, LowPass, Weighting};
use std::ops::Range;

/// One value of a series y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Index {
    /// Sperling's W by lines, as GB 5599 has it.
    Sperling(Direction),
    /// Sperling's Wz by the filter of comfort.
    SperlingComfort(Direction),
    /// Sperling's Wz by the filter of ride quality.
    SperlingRideQuality,
    /// a_w, the weighted root mean square of ISO 2631-1 (m/s²).
    WeightedRms(Weighting),
    /// max |P − P̄| / P̄ of a wheel's force P; its static force P̄ (N) is the run's first value where none is given.
    UnloadingRatio { static_force: Option<f64> },
    /// 1 + μ = max |y| / |y_static|.
    ImpactFactor { static_response: f64 },
    /// max y.
    Maximum,
    /// min y.
    Minimum,
    /// max |y|.
    AbsoluteMaximum,
    /// (mean y²)^(1/2).
    RootMeanSquare,
    /// The share of samples with a force P ≤ 0.
    ContactLoss,
}

impl Index {
    /// The unit, for a quantity of this unit.
    pub fn unit(self, quantity: &str) -> &str {
        match self {
            Index::Sperling(_)
            | Index::SperlingComfort(_)
            | Index::SperlingRideQuality
            | Index::UnloadingRatio { .. }
            | Index::ImpactFactor { .. }
            | Index::ContactLoss => "1",
            Index::WeightedRms(_)
            | Index::Maximum
            | Index::Minimum
            | Index::AbsoluteMaximum
            | Index::RootMeanSquare => quantity,
        }
    }

    /// The unit that the quantity must have; none where any does.
    pub fn needs_unit(self) -> Option<&'static str> {
        match self {
            Index::Sperling(_)
            | Index::SperlingComfort(_)
            | Index::SperlingRideQuality
            | Index::WeightedRms(_) => Some("m/s2"),
            Index::UnloadingRatio { .. } | Index::ContactLoss => Some("N"),
            Index::ImpactFactor { .. }
            | Index::Maximum
            | Index::Minimum
            | Index::AbsoluteMaximum
            | Index::RootMeanSquare => None,
        }
    }

    /// The shortest window (s): a period of 0.5 Hz, the lowest frequency of comfort.
    pub fn shortest_window(self) -> f64 {
        match self {
            Index::Sperling(_)
            | Index::SperlingComfort(_)
            | Index::SperlingRideQuality
            | Index::WeightedRms(_) => 1.0 / sperling::LOWEST,
            Index::UnloadingRatio { .. }
            | Index::ImpactFactor { .. }
            | Index::Maximum
            | Index::Minimum
            | Index::AbsoluteMaximum
            | Index::RootMeanSquare
            | Index::ContactLoss => 0.0,
        }
    }

    /// The symbol for axis labels.
    pub fn symbol(self) -> &'static str {
        match self {
            Index::Sperling(_) => "W",
            Index::SperlingComfort(_) | Index::SperlingRideQuality => "Wz",
            Index::WeightedRms(_) => "a_w",
            Index::UnloadingRatio { .. } => "ΔP/P",
            Index::ImpactFactor { .. } => "1 + μ",
            Index::Maximum => "max",
            Index::Minimum => "min",
            Index::AbsoluteMaximum => "max abs",
            Index::RootMeanSquare => "rms",
            Index::ContactLoss => "share",
        }
    }

    /// What it is, in words.
    pub fn description(self) -> String {
        match self {
            Index::Sperling(direction) => {
                format!("Sperling's index by lines, {}", direction.name())
            }
            Index::SperlingComfort(direction) => {
                format!("Sperling's index of comfort, {}", direction.name())
            }
            Index::SperlingRideQuality => "Sperling's index of ride quality".to_owned(),
            Index::WeightedRms(weighting) => format!(
                "root mean square weighted by {} of ISO 2631-1",
                weighting.name()
            ),
            Index::UnloadingRatio { .. } => {
                "largest deviation from the static force, over it".to_owned()
            }
            Index::ImpactFactor { static_response } => {
                format!("largest absolute value over the static {static_response:?}")
            }
            Index::Maximum => "largest value".to_owned(),
            Index::Minimum => "least value".to_owned(),
            Index::AbsoluteMaximum => "largest absolute value".to_owned(),
            Index::RootMeanSquare => "root mean square".to_owned(),
            Index::ContactLoss => "share of the time without contact".to_owned(),
        }
    }

    /// Whether it is a mean over time, from ≤ t < to.
    fn is_mean(self) -> bool {
        match self {
            Index::Sperling(_)
            | Index::SperlingComfort(_)
            | Index::SperlingRideQuality
            | Index::WeightedRms(_)
            | Index::RootMeanSquare
            | Index::ContactLoss => true,
            Index::UnloadingRatio { .. }
            | Index::ImpactFactor { .. }
            | Index::Maximum
            | Index::Minimum
            | Index::AbsoluteMaximum => false,
        }
    }
}

/// A judgement with its memory, for any number of series of one run.
#[derive(Debug)]
pub struct Judge {
    index: Index,
    samples: Range<usize>,
    low_pass: Option<LowPass>,
    /// The lines of the window and their weights, where the index is a spectral one.
    spectrum: Option<(Lines, Vec<f64>)>,
    filtered: Vec<f64>,
    work: Vec<f64>,
}

impl Judge {
    /// Judges the samples `window.0 ..= window.1` (two at least) of series with the step h (s), after a filter
    /// of the whole series where there is one.
    pub fn new(
        index: Index,
        window: (usize, usize),
        low_pass: Option<LowPass>,
        step: f64,
    ) -> Judge {
        let (first, last) = window;
        let end = if index.is_mean() { last } else { last + 1 };
        let samples = first..end;
        Judge {
            spectrum: spectrum(index, samples.len(), step),
            index,
            samples,
            low_pass,
            filtered: Vec::new(),
            work: Vec::new(),
        }
    }

    /// The value of a run's whole series; not a number where an unloading ratio's static force is not above 0.
    pub fn value(&mut self, series: &[f64]) -> f64 {
        let start = series[0];
        let window = match &self.low_pass {
            None => &series[self.samples.clone()],
            Some(filter) => {
                self.filtered.clear();
                self.filtered.extend_from_slice(series);
                filter.apply(&mut self.filtered, &mut self.work);
                &self.filtered[self.samples.clone()]
            }
        };
        let largest = |of: &dyn Fn(f64) -> f64| {
            let values = window.iter().map(|y| of(*y));
            values.fold(f64::NEG_INFINITY, f64::max)
        };
        let mean = |of: &dyn Fn(f64) -> f64| {
            window.iter().map(|y| of(*y)).sum::<f64>() / window.len() as f64
        };
        match self.index {
            Index::Sperling(_) => {
                let (lines, weights) = self.spectrum.as_mut().expect("made with the index");
                let cubes = lines.mean_squares(window).zip(&*weights);
                sperling::of_lines(cubes.map(|(ms, w)| w * (2.0 * ms).powf(1.5)).sum())
            }
            Index::SperlingComfort(_) | Index::SperlingRideQuality => {
                sperling::of_filtered(weighted(&mut self.spectrum, window))
            }
            Index::WeightedRms(_) => weighted(&mut self.spectrum, window).sqrt(),
            Index::UnloadingRatio { static_force } => {
                let force = static_force.unwrap_or(start);
                if force <= 0.0 {
                    return f64::NAN;
                }
                largest(&|p| (p - force).abs()) / force
            }
            Index::ImpactFactor { static_response } => largest(&f64::abs) / static_response.abs(),
            Index::Maximum => largest(&|y| y),
            Index::Minimum => -largest(&|y| -y),
            Index::AbsoluteMaximum => largest(&f64::abs),
            Index::RootMeanSquare => mean(&|y| y * y).sqrt(),
            Index::ContactLoss => mean(&|p| f64::from(u8::from(p <= 0.0))),
        }
    }
}

/// Lines of a window and their weights.
fn spectrum(index: Index, count: usize, step: f64) -> Option<(Lines, Vec<f64>)> {
    let weight: Box<dyn Fn(f64) -> f64> = match index {
        Index::Sperling(direction) => Box::new(move |f| line_weight(direction, f) / f),
        Index::SperlingComfort(direction) => {
            Box::new(move |f| comfort_filter(direction, f).powi(2))
        }
        Index::SperlingRideQuality => Box::new(|f| ride_quality_filter(f).powi(2)),
        Index::WeightedRms(weighting) => Box::new(move |f| weighting.squared(f)),
        Index::UnloadingRatio { .. }
        | Index::ImpactFactor { .. }
        | Index::Maximum
        | Index::Minimum
        | Index::AbsoluteMaximum
        | Index::RootMeanSquare
        | Index::ContactLoss => return None,
    };
    let lines = Lines::new(count, step);
    let weights = lines.frequencies().map(weight).collect();
    Some((lines, weights))
}

/// The weighted mean square.
fn weighted(spectrum: &mut Option<(Lines, Vec<f64>)>, window: &[f64]) -> f64 {
    let (lines, weights) = spectrum.as_mut().expect("made with the index");
    let squares = lines.mean_squares(window).zip(&*weights);
    squares.map(|(square, weight)| weight * square).sum()
}
