//! Made-up but realistic data, and a picture of every figure from it.

use super::super::*;
use super::errors;

const TIMES: usize = 201;
const NODES: usize = 256;
const POINTS: usize = 984;

/// A response whose mean and standard deviation are known functions of time.
pub(super) struct Made {
    pub label: Label<'static>,
    mean: fn(f64) -> f64,
    standard_deviation: fn(f64) -> f64,
    pub times: Vec<f64>,
    values: Vec<Vec<f64>>,
    densities: Vec<Vec<f64>>,
}

impl Made {
    pub(super) fn deflection() -> Self {
        let label = Label {
            name: "Displacement at midspan",
            symbol: "y",
            unit: "m",
        };
        let mean = |t: f64| -0.0945 * (0.5 * t * std::f64::consts::PI).sin().powf(1.3);
        Made::new(label, mean, |t| 1e-4 + 2.5e-4 * t)
    }

    pub(super) fn acceleration() -> Self {
        let label = Label {
            name: "Acceleration of the body",
            symbol: "a_{body}",
            unit: "m/s2",
        };
        Made::new(
            label,
            |t| 0.04 * (9.0 * t).sin(),
            |t| 0.05 * (1.0 - (-3.0 * t).exp()) + 1e-4,
        )
    }

    fn new(
        label: Label<'static>,
        mean: fn(f64) -> f64,
        standard_deviation: fn(f64) -> f64,
    ) -> Self {
        let times: Vec<f64> = (0..TIMES).map(|i| 0.01 * i as f64).collect();
        let node = |t: f64, j: usize| {
            mean(t) + standard_deviation(t) * (10.0 * j as f64 / (NODES - 1) as f64 - 5.0)
        };
        let density = |t: f64, j: usize| {
            let z: f64 = 10.0 * j as f64 / (NODES - 1) as f64 - 5.0;
            (-0.5 * z * z).exp() / (standard_deviation(t) * std::f64::consts::TAU.sqrt())
        };
        let table = |of: &dyn Fn(f64, usize) -> f64| -> Vec<Vec<f64>> {
            times
                .iter()
                .map(|&t| (0..NODES).map(|j| of(t, j)).collect())
                .collect()
        };
        let (values, densities) = (table(&node), table(&density));
        Made {
            label,
            mean,
            standard_deviation,
            times,
            values,
            densities,
        }
    }

    pub(super) fn densities(&self) -> Vec<DensityAtTime<'_>> {
        let rows = self.times.iter().zip(&self.values).zip(&self.densities);
        rows.map(|((&time, values), densities)| DensityAtTime {
            time,
            values,
            densities,
        })
        .collect()
    }

    /// Of evenly spread values.
    pub(super) fn statistics(&self) -> Statistics {
        let mut result = Statistics::default();
        for &time in &self.times {
            let (mean, deviation) = ((self.mean)(time), (self.standard_deviation)(time));
            result.push(time, mean, |q| mean + deviation * 3.3 * (q - 0.5));
        }
        result
    }

    /// Smooth histories: three waves a point, with amplitudes that vary from point to point.
    pub(super) fn responses(&self) -> Vec<Vec<f64>> {
        let normal = |point: usize, wave: usize| {
            // The sum of three evenly spread numbers is close to normal.
            let even = |k: usize| ((point * (2 * k + 7) * (wave + 3)) as f64 * 0.618_034).fract();
            2.0 * (even(1) + even(2) + even(3) - 1.5)
        };
        let history = |point: usize| {
            self.times
                .iter()
                .map(|&t| {
                    let waves = (0..3).map(|k| {
                        let rate = 4.0 + 5.0 * k as f64;
                        normal(point, 2 * k) * (rate * t).sin()
                            + normal(point, 2 * k + 1) * (rate * t).cos()
                    });
                    (self.mean)(t)
                        + (self.standard_deviation)(t) * waves.sum::<f64>() / 3_f64.sqrt()
                })
                .collect()
        };
        (0..POINTS).map(history).collect()
    }
}

pub(super) fn page(title: &str) -> Page {
    Page::new(
        title,
        "Quarter car on a simply supported beam · 984 representative points",
    )
}

fn roughness(wave: f64) -> f64 {
    if wave > 10.0 {
        return 0.0;
    }
    // The second-order filter, α = β = 0.1, γ = 1e-4.
    let square = 0.02;
    let below = (square - wave * wave).powi(2) + 4.0 * 0.01 * wave * wave;
    4.0 * 1e-4 * 0.1 * 0.1 * square / std::f64::consts::PI / below
}

fn field() -> Vec<Vec<f64>> {
    let spacing = 10.0 / 512.0;
    let sample = |point: usize| -> Vec<f64> {
        let wave = |k: usize| (k as f64 + 0.5) * spacing;
        let phase = |k: usize| {
            std::f64::consts::TAU
                * ((point * 769 + k * k * 37 + k * point) as f64 * 0.618_034).fract()
        };
        let amplitude = |k: usize| 2.0 * (roughness(wave(k)) * spacing).sqrt();
        let value = |x: f64| {
            (0..512)
                .map(|k| amplitude(k) * (wave(k) * x + phase(k)).cos())
                .sum()
        };
        (0..401).map(|j| value(0.1 * j as f64)).collect()
    };
    (0..60).map(sample).collect()
}

fn samples_image(field: &[Vec<f64>]) -> Image {
    let samples: Vec<(String, &[f64])> = (0..3)
        .map(|i| (format!("point {}", 7 * i), field[7 * i].as_slice()))
        .collect();
    let label = Label {
        name: "Vertical irregularity",
        symbol: "r(x)",
        unit: "m",
    };
    let figure = IrregularitySamples {
        label,
        place: "Position, x (m)",
        position_start: 0.0,
        position_step: 0.1,
        samples: &samples,
    };
    figure.draw(&page("Irregularity samples")).unwrap()
}

fn spectrum_image(field: &[Vec<f64>]) -> Image {
    let rows: Vec<&[f64]> = field.iter().map(Vec::as_slice).collect();
    let periodogram = Periodogram::estimate(&rows, &vec![1.0; rows.len()], 0.1).unwrap();
    let figure = Spectrum {
        periodogram: &periodogram,
        target: &roughness,
        wavenumbers: (10.0 / 1024.0, 10.0),
    };
    figure
        .draw(&page("Power spectral density of the irregularity"))
        .unwrap()
}

fn fan_image(made: &Made, value_axis: ValueAxis) -> Image {
    let responses = made.responses();
    let responses: Vec<&[f64]> = responses.iter().map(Vec::as_slice).collect();
    let weights = vec![1.0 / POINTS as f64; POINTS];
    let statistics = Statistics::from_responses(&made.times, &responses, &weights).unwrap();
    let figure = Fan {
        label: made.label,
        times: &made.times,
        responses: &responses,
        point_count: POINTS,
        statistics: &statistics,
        value_axis,
    };
    figure
        .draw(&page(&format!(
            "Representative responses: {}",
            made.label.name
        )))
        .unwrap()
}

pub(super) fn heat_map_image(
    made: &Made,
    value_axis: ValueAxis,
    density_scale: DensityScale,
) -> Image {
    let figure = HeatMap {
        label: made.label,
        densities: &made.densities(),
        statistics: None,
        value_axis,
        density_scale,
    };
    figure
        .draw(&page(&format!("Density evolution: {}", made.label.name)))
        .unwrap()
}

fn surface_image(made: &Made, value_axis: ValueAxis, density_scale: DensityScale) -> Image {
    let figure = Surface {
        label: made.label,
        densities: &made.densities(),
        value_axis,
        density_scale,
    };
    figure
        .draw(&page(&format!("Density evolution: {}", made.label.name)))
        .unwrap()
}

pub(super) fn slices_image(made: &Made, times: &[f64], reference: Option<Reference<'_>>) -> Image {
    let figure = Slices {
        label: made.label,
        densities: &made.densities(),
        times,
        reference,
        value_axis: ValueAxis::Automatic,
    };
    figure
        .draw(&page(&format!("Density: {}", made.label.name)))
        .unwrap()
}

pub(super) fn failure_image(scale: f64) -> Image {
    let times: Vec<f64> = (0..TIMES).map(|i| 0.01 * i as f64).collect();
    let rise = |t: f64| scale / (1.0 + (-12.0 * (t - 1.0)).exp());
    let curve = |factor: f64| -> Vec<f64> { times.iter().map(|&t| factor * rise(t)).collect() };
    let (middle, lower, upper) = (curve(1.0), curve(0.8), curve(1.25));
    let other = curve(0.3);
    let bounded = FailureCurve {
        limit: "deflection",
        method: "extreme value",
        times: &times,
        failure_probability: &middle,
        lower: &lower,
        upper: &upper,
    };
    let without = FailureCurve {
        method: "absorbing condition",
        failure_probability: &other,
        lower: &[],
        upper: &[],
        ..bounded
    };
    let comfort = FailureCurve {
        limit: "comfort",
        ..without
    };
    let figure = FailureProbability {
        curves: &[bounded, without, comfort],
    };
    figure.draw(&page("Probability of failure")).unwrap()
}

/// A name and a picture for every figure and option.
pub(super) fn gallery() -> Vec<(&'static str, Image)> {
    use DensityScale::{Linear, Logarithmic, SquareRoot};
    use ValueAxis::{Automatic, DeviationFromMean, Value};
    let (deflection, acceleration, field) = (Made::deflection(), Made::acceleration(), field());
    let exact = |t: f64, value: f64| {
        let z = (value - (acceleration.mean)(t)) / (acceleration.standard_deviation)(t);
        (-0.5 * z * z).exp() / (acceleration.standard_deviation)(t) / std::f64::consts::TAU.sqrt()
    };
    let given = Reference::Given {
        name: "exact, pseudo-excitation",
        density: &exact,
    };
    let many: Vec<f64> = (1..=9).map(|i| 0.2 * f64::from(i)).collect();
    vec![
        ("samples", samples_image(&field)),
        ("spectrum", spectrum_image(&field)),
        ("fan-deflection", fan_image(&deflection, Automatic)),
        ("fan-deflection-value", fan_image(&deflection, Value)),
        ("fan-acceleration", fan_image(&acceleration, Automatic)),
        (
            "heat-deflection",
            heat_map_image(&deflection, Automatic, SquareRoot),
        ),
        (
            "heat-deflection-value",
            heat_map_image(&deflection, Value, SquareRoot),
        ),
        (
            "heat-deflection-log",
            heat_map_image(&deflection, Automatic, Logarithmic),
        ),
        (
            "heat-acceleration",
            heat_map_image(&acceleration, Automatic, SquareRoot),
        ),
        (
            "heat-acceleration-linear",
            heat_map_image(&acceleration, DeviationFromMean, Linear),
        ),
        (
            "surface-deflection",
            surface_image(&deflection, Automatic, Linear),
        ),
        (
            "surface-deflection-value",
            surface_image(&deflection, Value, Linear),
        ),
        (
            "surface-acceleration",
            surface_image(&acceleration, Automatic, Linear),
        ),
        (
            "surface-acceleration-root",
            surface_image(&acceleration, Automatic, SquareRoot),
        ),
        (
            "slices-deflection",
            slices_image(&deflection, &[0.7, 1.1, 1.5], Some(Reference::Normal)),
        ),
        (
            "slices-acceleration",
            slices_image(&acceleration, &[0.803, 1.4], Some(given)),
        ),
        ("slices-many", slices_image(&acceleration, &many, None)),
        ("distances", errors::distances_image()),
        ("convergence", errors::convergence_image()),
        ("failure", failure_image(0.4)),
        ("failure-rare", failure_image(1e-6)),
        ("failure-none", failure_image(0.0)),
    ]
}
