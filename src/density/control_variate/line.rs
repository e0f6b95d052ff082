//! Densities on a line of nodes, by way of their Fourier transforms.

use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::PI;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Transforms of 2^LEAST ... 2^MOST nodes.
const LEAST: usize = 9;
const MOST: usize = 16;

/// Both directions of every length, made when first asked for.
#[derive(Default)]
pub(super) struct Transforms {
    plans: [OnceLock<Plans>; MOST - LEAST + 1],
}

type Plans = [Arc<dyn Fft<f64>>; 2];

impl fmt::Debug for Transforms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Transforms").finish_non_exhaustive()
    }
}

/// x_j = start + j spacing, j = 0 .. count, a power of two; periodic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub start: f64,
    pub spacing: f64,
    pub count: usize,
}

impl Line {
    /// Covers a range with at least `least_nodes` nodes, at most `spacing` apart where the longest
    /// transform allows.
    pub fn covering(range: (f64, f64), spacing: f64, least_nodes: usize) -> Self {
        let length = range.1 - range.0;
        let wanted = (length / spacing).ceil().max(least_nodes as f64);
        let count = (wanted.min((1 << MOST) as f64) as usize)
            .next_power_of_two()
            .clamp(1 << LEAST, 1 << MOST);
        Line {
            start: range.0,
            spacing: length / (count - 1) as f64,
            count,
        }
    }

    /// u_k, k = 0 ..= count/2.
    pub fn frequency(&self, index: usize) -> f64 {
        2.0 * PI * index as f64 / (self.count as f64 * self.spacing)
    }

    /// Shares weights between the two nodes next to each value; values outside go to the ends.
    pub fn share(&self, values: impl Iterator<Item = (f64, f64)>, mut add: impl FnMut(usize, f64)) {
        let scale = 1.0 / self.spacing;
        let last = (self.count - 1) as f64;
        for (value, weight) in values {
            let place = ((value - self.start) * scale).clamp(0.0, last);
            let node = (place as usize).min(self.count - 2);
            let upper = weight * (place - node as f64);
            add(node, weight - upper);
            add(node + 1, upper);
        }
    }

    /// What sharing does to a transform: (sin(uδ/2)/(uδ/2))².
    pub fn shared(&self, u: f64) -> f64 {
        let half = 0.5 * u * self.spacing;
        if half < 1e-8 {
            1.0
        } else {
            (half.sin() / half).powi(2)
        }
    }
}

impl Transforms {
    fn plans(&self, count: usize) -> &Plans {
        let cell = &self.plans[count.trailing_zeros() as usize - LEAST];
        cell.get_or_init(|| {
            let mut planner = FftPlanner::new();
            [
                planner.plan_fft_forward(count),
                planner.plan_fft_inverse(count),
            ]
        })
    }

    /// Σ_j (a_j + i b_j) e^{−i u_k x}, x from the start, in place; [`split`] takes the two apart.
    pub fn forward(&self, values: &mut [Complex64]) {
        self.plans(values.len())[0].process(values);
    }

    /// The real density at the nodes whose transform is given for k = 0 ..= count/2.
    pub fn density(&self, line: &Line, transform: &[Complex64]) -> Vec<f64> {
        let n = line.count;
        let mut values = vec![Complex64::ZERO; n];
        values[..=n / 2].copy_from_slice(transform);
        for k in 1..n / 2 {
            values[n - k] = transform[k].conj();
        }
        self.plans(n)[1].process(&mut values);
        let scale = 1.0 / (n as f64 * line.spacing);
        values.iter().map(|v| v.re * scale).collect()
    }
}

/// The transforms of a and b at k, from that of a + i b.
pub(super) fn split(both: &[Complex64], k: usize) -> (Complex64, Complex64) {
    let n = both.len();
    let (here, mirror) = (both[k], both[(n - k) % n].conj());
    let difference = here - mirror;
    (
        0.5 * (here + mirror),
        Complex64::new(0.5 * difference.im, -0.5 * difference.re),
    )
}

/// The transform of the normal kernel of width h, exp(−u²h²/2).
pub(super) fn gaussian(u: f64, width: f64) -> f64 {
    (-0.5 * (u * width).powi(2)).exp()
}

/// The transform of the kernel (3 − x²) φ(x)/2 of fourth order, scaled to the width h.
pub(super) fn fourth_order(u: f64, width: f64) -> f64 {
    let square = 0.5 * (u * width).powi(2);
    (1.0 + square) * (-square).exp()
}
