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
//!
//! Of N = rM places each r-th is a node, and beyond a small part of the frequencies the Gaussian leaves
//! nothing. So only short transforms are needed, of M places: of the values at each of the r offsets,
//! two of these at a time as real and imaginary part,
//!
//! ```text
//! Σ_n x_n e^{−2πi kn/N} = Σ_s e^{−2πi ks/N} Σ_j x_{rj+s} e^{−2πi kj/M},
//! ```
//!
//! and one back, of the frequencies folded to M.

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
    /// r.
    ratio: usize,
    /// M.
    nodes: usize,
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
        let least_nodes = (nodes.count - 1) as f64 + beyond + (4.0 / ratio).ceil();
        FineGrid {
            ratio: ratio as usize,
            nodes: quick_length(least_nodes as usize),
        }
    }

    /// N.
    fn places(&self) -> usize {
        self.ratio * self.nodes
    }

    /// About the work in products.
    pub fn work(&self, values: usize) -> usize {
        let transforms = self.ratio.div_ceil(2) + 1;
        transforms * self.nodes * self.nodes.ilog2() as usize + 2 * self.places() + 12 * values
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
        let values = self.spread(centres, nodes.start, spacing);
        let (forward, inverse) = PLANNER.with_borrow_mut(|planner| {
            (
                planner.plan_fft_forward(self.nodes),
                planner.plan_fft_inverse(self.nodes),
            )
        });
        let mut line = self.pairs(&values);
        let mut room = vec![
            Complex::new(0.0, 0.0);
            forward
                .get_inplace_scratch_len()
                .max(inverse.get_inplace_scratch_len())
        ];
        forward.process_with_scratch(&mut line, &mut room);
        let mut line = self.shape(&line, width / spacing);
        let total = line[0].re;
        inverse.process_with_scratch(&mut line, &mut room);
        let length = self.places() as f64 * spacing;
        // The imaginary part is the integral's periodic part, times 2π/L.
        let periodic = |j: usize| line[j].im / (2.0 * PI);
        let first = periodic(0);
        let mut below = 0.0f64;
        Curve {
            nodes,
            density: (0..nodes.count)
                .map(|j| (line[j].re / length).max(0.0))
                .collect(),
            cumulative: (0..nodes.count)
                .map(|j| {
                    let linear = total * j as f64 / self.nodes as f64;
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
    ) -> Vec<f64> {
        let (places, scale) = (self.places(), 1.0 / spacing);
        // The spline's four places follow each other; the last three stand for the first ones.
        let mut line = vec![0.0; places + 3];
        for (centre, p) in centres {
            let place = (centre - start) * scale;
            let node = place.floor();
            let f = place - node;
            let g = 1.0 - f;
            let p = p * (1.0 / 6.0);
            let shares = [
                p * (g * g * g),
                p * (4.0 - f * f * (6.0 - 3.0 * f)),
                p * (4.0 - g * g * (6.0 - 3.0 * g)),
                p * (f * f * f),
            ];
            let node = node as isize - 1;
            let from = if node < 0 {
                node + places as isize
            } else {
                node
            };
            for (place, share) in line[from as usize..].iter_mut().zip(shares) {
                *place += share;
            }
        }
        for k in 0..3 {
            line[k] += line[places + k];
        }
        line.truncate(places);
        line
    }

    /// The values at each two offsets as real and imaginary parts, `[pair][node]`.
    fn pairs(&self, values: &[f64]) -> Vec<Complex<f64>> {
        let mut line = Vec::with_capacity(self.ratio.div_ceil(2) * self.nodes);
        for offset in (0..self.ratio).step_by(2) {
            let rows = values.chunks_exact(self.ratio);
            if offset + 1 < self.ratio {
                line.extend(rows.map(|row| Complex::new(row[offset], row[offset + 1])));
            } else {
                line.extend(rows.map(|row| Complex::new(row[offset], 0.0)));
            }
        }
        line
    }

    /// From the transforms of the pairs that of the density, with the Gaussian's put in place of the
    /// spline's, folded to M frequencies; and the integral's beside: its transform, over iω, times i.
    fn shape(&self, pairs: &[Complex<f64>], width: f64) -> Vec<Complex<f64>> {
        let (places, nodes) = (self.places(), self.nodes);
        let turn = 2.0 * PI / places as f64;
        let last = ((2.0 * LAST_EXPONENT).sqrt() / (turn * width)) as usize;
        let last = last.min((places - 1) / 2);
        let mut line = vec![Complex::new(0.0, 0.0); nodes];
        let (mut ahead, mut behind) = (0, 0);
        for k in 0..=last {
            // e^{−iω/2}, whose square turns by one offset.
            let omega = turn * k as f64;
            let (sin, cos) = (0.5 * omega).sin_cos();
            let step = Complex::new(cos * cos - sin * sin, -2.0 * sin * cos);
            let mut turned = Complex::new(1.0, 0.0);
            let mut sum = Complex::new(0.0, 0.0);
            for pair in pairs.chunks_exact(nodes) {
                let (one, other) = (pair[ahead], pair[behind].conj());
                // Of x + iy: the transform of x, and of iy.
                let (of_real, of_imaginary) = (0.5 * (one + other), 0.5 * (one - other));
                let of_imaginary = Complex::new(of_imaginary.im, -of_imaginary.re);
                sum += turned * of_real;
                turned *= step;
                sum += turned * of_imaginary;
                turned *= step;
            }
            if k == 0 {
                line[0] += sum;
            } else {
                let sinc = sin / (0.5 * omega);
                let squared = sinc * sinc;
                let factor = (-0.5 * (omega * width).powi(2)).exp() / (squared * squared);
                let inverse = 1.0 / k as f64;
                line[ahead] += sum * (factor * (1.0 + inverse));
                line[behind] += sum.conj() * (factor * (1.0 - inverse));
            }
            ahead = if ahead + 1 == nodes { 0 } else { ahead + 1 };
            behind = if behind == 0 { nodes - 1 } else { behind - 1 };
        }
        line
    }
}

/// The least length of at least `count`, of factors two and three, that transforms are quick for.
fn quick_length(count: usize) -> usize {
    let above = count.max(16).next_power_of_two();
    [above / 16 * 9, above / 4 * 3, above / 32 * 27, above]
        .into_iter()
        .find(|length| *length >= count)
        .unwrap_or(above)
}
