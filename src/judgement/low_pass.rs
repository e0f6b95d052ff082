//! A low-pass filter without phase: Butterworth's, forward and backward.
//!
//! Each of the two passes has order n, by the bilinear transform of the analogue filter. Together they have no
//! phase and, at the frequency f, the gain
//!
//! ```text
//! G(f) = 1 / (1 + (√2 − 1) (tan(π f h) / tan(π f_c h))^2n),
//! ```
//!
//! so G(0) = 1 and G(f_c) = 1/√2: −3 dB at the cutoff f_c in all, not in each pass (for which a pass is designed for
//! the cutoff f_c (√2 − 1)^(−1/2n)). Far above the cutoff both together fall by 12 n dB an octave.
//!
//! Ends: the series goes on beyond each end as its image through the end's point, 2 y_0 − y_k, until what the
//! start of a pass leaves behind has fallen to 1e-8, or for the series' own length; each pass starts in
//! the steady state of its first value. So a constant stays as it is, exactly, and a straight line almost.
//!
//! Source: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed. (2010), §7.2 and exercise 5.53.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Orders of a pass.
pub const ORDERS: RangeInclusive<u32> = 1..=8;

/// What is left of a pass's start.
const LEFT_BEHIND: f64 = 1e-8;

/// The filter for one step.
#[derive(Debug, Clone, PartialEq)]
pub struct LowPass {
    sections: Vec<Section>,
    /// Samples that the series goes on beyond each end.
    beyond: usize,
}

/// y_n = b₀x_n + b₁x_{n−1} + b₂x_{n−2} − a₁y_{n−1} − a₂y_{n−2}; its gain at 0 is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Whether a series with the step h (s) can be filtered at this cutoff (Hz): it is below 1/(2h), the
    /// Nyquist frequency.
    pub fn is_possible(cutoff: f64, step: f64) -> bool {
        cutoff > 0.0 && 2.0 * cutoff * step < 1.0
    }

    /// The filter with this cutoff (Hz) for a step (s), each pass of this order.
    ///
    /// # Panics
    /// Where the cutoff is not possible or the order is 0.
    pub fn new(cutoff: f64, order: u32, step: f64) -> LowPass {
        assert!(Self::is_possible(cutoff, step) && order > 0);
        let n = f64::from(order);
        let widened = (2f64.sqrt() - 1.0).powf(-0.5 / n);
        let k = (PI * cutoff * step).tan() * widened;
        let pairs = (0..order / 2).map(|pair| {
            let damping = 2.0 * (f64::from(2 * pair + 1) * PI / (2.0 * n)).sin();
            Section::second_order(k, damping)
        });
        let single = (order % 2 == 1).then(|| Section::first_order(k));
        let sections: Vec<Section> = pairs.chain(single).collect();
        let slowest = sections.iter().map(Section::largest_pole);
        let left_a_sample = slowest.fold(f64::MIN_POSITIVE, f64::max);
        LowPass {
            sections,
            beyond: (LEFT_BEHIND.ln() / left_a_sample.ln()).ceil() as usize,
        }
    }

    /// Filters a series in place; `work` is memory to reuse.
    pub fn apply(&self, series: &mut [f64], work: &mut Vec<f64>) {
        let count = series.len();
        let (Some(first), Some(last)) = (series.first().copied(), series.last().copied()) else {
            return;
        };
        let beyond = self.beyond.min(count - 1);
        work.clear();
        work.extend((1..=beyond).rev().map(|k| 2.0 * first - series[k]));
        work.extend_from_slice(series);
        work.extend((1..=beyond).map(|k| 2.0 * last - series[count - 1 - k]));
        for section in &self.sections {
            section.pass(work.iter_mut());
        }
        for section in &self.sections {
            section.pass(work.iter_mut().rev());
        }
        series.copy_from_slice(&work[beyond..beyond + count]);
    }
}

impl Section {
    /// 1 / (1 + 2ζ s + s²) with s = (1 − z⁻¹)/(k (1 + z⁻¹)); `damping` is 2ζ.
    fn second_order(k: f64, damping: f64) -> Section {
        let scale = 1.0 / (1.0 + damping * k + k * k);
        let b = k * k * scale;
        Section {
            b: [b, 2.0 * b, b],
            a: [
                2.0 * (k * k - 1.0) * scale,
                (1.0 - damping * k + k * k) * scale,
            ],
        }
    }

    /// 1 / (1 + s).
    fn first_order(k: f64) -> Section {
        let b = k / (1.0 + k);
        Section {
            b: [b, b, 0.0],
            a: [(k - 1.0) / (k + 1.0), 0.0],
        }
    }

    /// The larger absolute value of its two poles: what a sample leaves of the state.
    fn largest_pole(&self) -> f64 {
        let [a1, a2] = self.a;
        let apart = 0.25 * a1 * a1 - a2;
        if apart < 0.0 {
            a2.sqrt()
        } else {
            0.5 * a1.abs() + apart.sqrt()
        }
    }

    fn pass<'a>(&self, values: impl Iterator<Item = &'a mut f64>) {
        let Section {
            b: [b0, b1, b2],
            a: [a1, a2],
        } = *self;
        let mut values = values.peekable();
        let first = values.peek().map_or(0.0, |value| **value);
        // The steady state of the first value, measured from it: a constant stays exactly.
        let (mut z1, mut z2) = (0.0, 0.0);
        for value in values {
            let x = *value - first;
            let y = b0 * x + z1;
            z1 = b1 * x - a1 * y + z2;
            z2 = b2 * x - a2 * y;
            *value = y + first;
        }
    }
}
