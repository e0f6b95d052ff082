//! The Gaussian sum on evenly spaced nodes.

use pulp::{Simd, WithSimd};
use std::f64::consts::PI;

/// Evenly spaced values y₀ + j Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nodes {
    /// y₀.
    pub start: f64,
    /// Δ.
    pub spacing: f64,
    pub count: usize,
}

impl Nodes {
    /// Kernels are cut this many widths from their centre (1.5e-8 of their peak).
    pub(super) const REACH: f64 = 6.0;

    /// At least `count` nodes over the values and the kernels' reach beyond, at most half a width
    /// apart.
    pub fn covering(least: f64, largest: f64, width: f64, count: usize) -> Self {
        let reach = Nodes::REACH * width;
        Nodes::over(least - reach, largest + reach, 0.5 * width, count)
    }

    /// At least `count` nodes from least to largest, at most `spacing` apart.
    pub fn over(least: f64, largest: f64, spacing: f64, count: usize) -> Self {
        let length = largest - least;
        let intervals = (length / spacing).ceil().max((count.max(2) - 1) as f64);
        Nodes {
            start: least,
            spacing: length / intervals,
            count: intervals as usize + 1,
        }
    }

    /// y_j.
    pub fn value(&self, index: usize) -> f64 {
        self.start + index as f64 * self.spacing
    }
}

/// A density and its integral on nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub nodes: Nodes,
    /// p(y_j).
    pub density: Vec<f64>,
    /// F(y_j).
    pub cumulative: Vec<f64>,
}

/// Nodes that are worked on side by side.
const TOGETHER: usize = 8;

/// Σ weight φ((y − value)/σ)/σ and its integral on the nodes.
///
/// A kernel on nodes falls apart, exp(−(d + mΔ)²/2σ²) = e^{−d²/2σ²} (e^{−dΔ/σ²})^m e^{−m²Δ²/2σ²}, so
/// that each node costs two products. The integral is the trapezoidal rule with the end correction
/// Δ² (p′_j − p′_{j+1})/12, p′ from the same sum.
pub fn smooth(values: impl Iterator<Item = (f64, f64)>, width: f64, nodes: Nodes) -> Curve {
    let Nodes { spacing, count, .. } = nodes;
    let reach = (Nodes::REACH * width / spacing).ceil() as usize + 1;
    let Sums { density, slope, .. } = pulp::Arch::new().dispatch(Summing {
        values,
        width,
        nodes,
        sums: Sums::new(reach, spacing / width, count),
    });
    let scale = 1.0 / (width * (2.0 * PI).sqrt());
    let ours = |sums: Vec<f64>, scale: f64| -> Vec<f64> {
        let sums = sums[reach..reach + count].iter();
        sums.map(|sum| scale * sum).collect()
    };
    let density = ours(density, scale);
    let cumulative = integrate(&density, &ours(slope, scale / width), spacing);
    Curve {
        nodes,
        density,
        cumulative,
    }
}

/// Sums on the nodes and as far as a kernel reaches beyond at either side.
struct Sums {
    reach: usize,
    /// mΔ/σ from one end of a kernel to the other and on to the next whole vector.
    distance: Vec<f64>,
    /// exp(−m²Δ²/2σ²); nothing beyond the end.
    shape: Vec<f64>,
    /// σ p.
    density: Vec<f64>,
    /// σ² p′.
    slope: Vec<f64>,
}

impl Sums {
    fn new(reach: usize, step: f64, count: usize) -> Self {
        let across = (2 * reach + 1).next_multiple_of(TOGETHER);
        let distance: Vec<f64> = (0..across)
            .map(|k| (k as f64 - reach as f64) * step)
            .collect();
        let mut shape: Vec<f64> = distance.iter().map(|m| (-0.5 * m * m).exp()).collect();
        shape[2 * reach + 1..].fill(0.0);
        Sums {
            reach,
            distance,
            shape,
            density: vec![0.0; count + across],
            slope: vec![0.0; count + across],
        }
    }
}

/// The sum of all kernels, for the machine's vector units.
struct Summing<I> {
    values: I,
    width: f64,
    nodes: Nodes,
    sums: Sums,
}

impl<I: Iterator<Item = (f64, f64)>> WithSimd for Summing<I> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sums {
        let Summing {
            values,
            width,
            nodes:
                Nodes {
                    start,
                    spacing,
                    count,
                },
            mut sums,
        } = self;
        // In units of the width.
        let step = spacing / width;
        let end = sums.reach as f64 * step;
        for (value, weight) in values {
            let nearest = ((value - start) / spacing)
                .round()
                .clamp(0.0, (count - 1) as f64) as usize;
            let d = (start + nearest as f64 * spacing - value) / width;
            let mut factor = weight * (d * (end - 0.5 * d)).exp();
            let ratio = (-d * step).exp();
            let mut powers = [1.0; TOGETHER];
            for k in 1..TOGETHER {
                powers[k] = powers[k - 1] * ratio;
            }
            let across = powers[TOGETHER - 1] * ratio;
            let nodes = nearest..nearest + sums.shape.len();
            let density = sums.density[nodes.clone()].as_chunks_mut::<TOGETHER>().0;
            let slope = sums.slope[nodes].as_chunks_mut::<TOGETHER>().0;
            let shape = sums.shape.as_chunks::<TOGETHER>().0;
            let distance = sums.distance.as_chunks::<TOGETHER>().0;
            for (((p, s), shape), distance) in
                density.iter_mut().zip(slope).zip(shape).zip(distance)
            {
                let kernel: [f64; TOGETHER] =
                    std::array::from_fn(|k| factor * powers[k] * shape[k]);
                *p = std::array::from_fn(|k| p[k] + kernel[k]);
                *s = std::array::from_fn(|k| s[k] - (d + distance[k]) * kernel[k]);
                factor *= across;
            }
        }
        sums
    }
}

/// The running integral of p with slopes p′.
fn integrate(density: &[f64], slope: &[f64], spacing: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut out = Vec::with_capacity(density.len());
    out.push(0.0);
    for (p, s) in density.windows(2).zip(slope.windows(2)) {
        let area = 0.5 * spacing * (p[0] + p[1]) + spacing * spacing / 12.0 * (s[0] - s[1]);
        sum += area.max(0.0);
        out.push(sum);
    }
    out
}
