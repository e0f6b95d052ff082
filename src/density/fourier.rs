//! The Gaussian sum by Fourier transform, for kernels that reach over many nodes.
//!
//! The values are spread over a fine grid by a cubic B-spline, M_j; with its transform divided out and
//! the Gaussian's put in,
//!
//! ```text
//! p(y) = 1/L Σ_k e^{iω_k y} exp(−ω_k²σ²/2) / sinc⁴(ω_k δ/2) Σ_j M_j e^{−iω_k y_j},   ω_k = 2πk/L.
//! ```
//!
//! With σ/16 between the grid's nodes, what the spline folds back is below 1e-6 of the peak. The integral has
//! p's transform over iω: both come out of one transform, as its real and its imaginary part.

use super::{Curve, Nodes};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::cell::RefCell;
use std::f64::consts::PI;

/// Nodes of the fine grid in a width.
const NODES_PER_WIDTH: f64 = 16.0;
/// e^(−38) is below rounding.
const LAST_EXPONENT: f64 = 38.0;

/// A fine grid over the nodes: each `ratio`-th of its places is a node.
pub(super) struct FineGrid {
    ratio: usize,
    places: usize,
}

impl FineGrid {
    /// The grid for Gaussians about values between least and largest. What they lay beyond the nodes
    /// must not come in at the other end.
    pub fn new(least: f64, largest: f64, width: f64, nodes: Nodes) -> Self {
        let ratio = (nodes.spacing * NODES_PER_WIDTH / width).ceil().max(1.0);
        let end = nodes.value(nodes.count - 1);
        let reach = Nodes::REACH * width;
        let beyond = (reach - (least - nodes.start)).max(0.0) + (largest + reach - end).max(0.0);
        let beyond = (beyond / nodes.spacing).ceil();
        let places = ((nodes.count - 1) as f64 + beyond) * ratio + 4.0;
        FineGrid {
            ratio: ratio as usize,
            places: (places as usize).next_power_of_two(),
        }
    }

    /// About the work in products.
    pub fn work(&self, values: usize) -> usize {
        2 * self.places * self.places.ilog2() as usize + 12 * values
    }

    /// Σ P φ((y − centre)/σ)/σ and its integral on the nodes.
    pub fn smooth(
        &self,
        centres: impl Iterator<Item = (f64, f64)>,
        width: f64,
        nodes: Nodes,
    ) -> Curve {
        thread_local! {
            static PLANNER: RefCell<FftPlanner<f64>> = RefCell::new(FftPlanner::new());
        }
        let spacing = nodes.spacing / self.ratio as f64;
        let mut line = self.spread(centres, nodes.start, spacing);
        let (forward, inverse) = PLANNER.with_borrow_mut(|planner| {
            (
                planner.plan_fft_forward(self.places),
                planner.plan_fft_inverse(self.places),
            )
        });
        forward.process(&mut line);
        let total = line[0].re;
        self.shape(&mut line, width / spacing);
        inverse.process(&mut line);
        let length = self.places as f64 * spacing;
        // The imaginary part is the integral's periodic part, times 2π/L.
        let periodic = |j: usize| line[j * self.ratio].im / (2.0 * PI);
        let first = periodic(0);
        let mut below = 0.0f64;
        Curve {
            nodes,
            density: (0..nodes.count)
                .map(|j| (line[j * self.ratio].re / length).max(0.0))
                .collect(),
            cumulative: (0..nodes.count)
                .map(|j| {
                    let linear = total * (j * self.ratio) as f64 / self.places as f64;
                    below = below.max(linear + periodic(j) - first);
                    below
                })
                .collect(),
        }
    }

    /// M_j; what lies before the first place comes last.
    fn spread(
        &self,
        centres: impl Iterator<Item = (f64, f64)>,
        start: f64,
        spacing: f64,
    ) -> Vec<Complex<f64>> {
        let mut line = vec![Complex::new(0.0, 0.0); self.places];
        let (last, scale) = (self.places - 1, 1.0 / spacing);
        for (centre, p) in centres {
            let place = (centre - start) * scale;
            let node = place.floor();
            let f = place - node;
            let g = 1.0 - f;
            let p = p * (1.0 / 6.0);
            let shares = [
                g * g * g,
                4.0 - f * f * (6.0 - 3.0 * f),
                4.0 - g * g * (6.0 - 3.0 * g),
                f * f * f,
            ];
            let node = node as isize - 1;
            for (k, share) in shares.into_iter().enumerate() {
                // The number of places is a power of two: this is the remainder, of negative ones too.
                line[(node + k as isize) as usize & last].re += p * share;
            }
        }
        line
    }

    /// Multiplies by the Gaussian's transform over the spline's, and puts the integral beside: its
    /// transform, over iω, times i.
    fn shape(&self, line: &mut [Complex<f64>], width: f64) {
        let places = self.places as f64;
        let half = self.places / 2;
        let turn = 2.0 * PI / places;
        let last = ((2.0 * LAST_EXPONENT).sqrt() / (turn * width)) as usize;
        let last = last.min(half - 1);
        for k in 1..=last {
            let omega = turn * k as f64;
            let sinc = (0.5 * omega).sin() / (0.5 * omega);
            let factor = (-0.5 * (omega * width).powi(2)).exp() / sinc.powi(4);
            let inverse = 1.0 / k as f64;
            line[k] *= factor * (1.0 + inverse);
            line[self.places - k] *= factor * (1.0 - inverse);
        }
        line[last + 1..self.places - last].fill(Complex::new(0.0, 0.0));
    }
}
