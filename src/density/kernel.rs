//! The Gaussian sum on evenly spaced nodes.

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

/// Σ weight φ((y − value)/σ)/σ and its integral on the nodes.
///
/// A kernel on nodes falls apart, exp(−(d + mΔ)²/2σ²) = e^{−d²/2σ²} (e^{−dΔ/σ²})^m e^{−m²Δ²/2σ²}, so
/// that each node costs two products. The integral is the trapezoidal rule with the end correction
/// Δ² (p′_j − p′_{j+1})/12, p′ from the same sum.
pub fn smooth(values: impl Iterator<Item = (f64, f64)>, width: f64, nodes: Nodes) -> Curve {
    let Nodes {
        start,
        spacing,
        count,
    } = nodes;
    let reach = (Nodes::REACH * width / spacing).ceil() as usize + 1;
    let shape: Vec<f64> = (0..=reach)
        .map(|m| (-0.5 * (m as f64 * spacing / width).powi(2)).exp())
        .collect();
    let mut density = vec![0.0; count];
    let mut moment = vec![0.0; count];
    for (value, weight) in values {
        let nearest = ((value - start) / spacing)
            .round()
            .clamp(0.0, (count - 1) as f64) as usize;
        // In units of the width: d = (y − value)/σ at the nearest node, Δ/σ.
        let d = (start + nearest as f64 * spacing - value) / width;
        let step = spacing / width;
        let peak = weight * (-0.5 * d * d).exp();
        let ratio = (-d * step).exp();
        let mut factor = peak;
        let upper = (nearest + reach).min(count - 1);
        let up = density[nearest..=upper]
            .iter_mut()
            .zip(&mut moment[nearest..=upper]);
        for (m, ((p, s), shape)) in up.zip(&shape).enumerate() {
            let kernel = factor * shape;
            *p += kernel;
            *s -= (d + m as f64 * step) * kernel;
            factor *= ratio;
        }
        let inverse = ratio.recip();
        factor = peak * inverse;
        let lower = nearest.saturating_sub(reach);
        let down = density[lower..nearest]
            .iter_mut()
            .zip(&mut moment[lower..nearest])
            .rev();
        for (m, ((p, s), shape)) in down.zip(&shape[1..]).enumerate() {
            let kernel = factor * shape;
            *p += kernel;
            *s -= (d - (m + 1) as f64 * step) * kernel;
            factor *= inverse;
        }
    }
    let scale = 1.0 / (width * (2.0 * PI).sqrt());
    density.iter_mut().for_each(|p| *p *= scale);
    moment.iter_mut().for_each(|s| *s *= scale / width);
    let cumulative = integrate(&density, &moment, spacing);
    Curve {
        nodes,
        density,
        cumulative,
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
