//! The lines of a window's spectrum.

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::fmt;
use std::sync::Arc;

/// Lines of a series of N values with the step h: the sines of f_k = k/(N h) that it is the sum of.
///
/// Line k has the amplitude A_k = 2|X_k|/N, X the series' discrete Fourier transform, and the mean square A_k²/2.
/// The mean (k = 0) is none of them. At the Nyquist frequency (N even) the amplitude is √2 |X|/N, which has the right
/// mean square. So Σ A_k²/2 is the variance of the series (Parseval).
pub struct Lines {
    transform: Arc<dyn Fft<f64>>,
    values: Vec<Complex<f64>>,
    work: Vec<Complex<f64>>,
    /// 1/(N h) (Hz).
    spacing: f64,
}

impl Lines {
    /// For series of so many values, one at least, with the step h (s).
    pub fn new(count: usize, step: f64) -> Lines {
        let transform = FftPlanner::new().plan_fft_forward(count);
        let zero = Complex::new(0.0, 0.0);
        Lines {
            values: vec![zero; count],
            work: vec![zero; transform.get_inplace_scratch_len()],
            transform,
            spacing: 1.0 / (count as f64 * step),
        }
    }

    /// The frequencies (Hz) of the lines, ascending.
    pub fn frequencies(&self) -> impl ExactSizeIterator<Item = f64> + use<> {
        let spacing = self.spacing;
        (1..self.values.len() / 2 + 1).map(move |k| k as f64 * spacing)
    }

    /// The mean squares A_k²/2 of the lines of a series, in the order of the frequencies.
    ///
    /// # Panics
    /// If the series has another length.
    pub fn mean_squares(&mut self, series: &[f64]) -> impl Iterator<Item = f64> {
        assert_eq!(series.len(), self.values.len());
        let count = series.len();
        // Less the mean, whose rounding would be felt in all lines.
        let mean = series.iter().sum::<f64>() / count as f64;
        for (value, y) in self.values.iter_mut().zip(series) {
            *value = Complex::new(y - mean, 0.0);
        }
        self.transform
            .process_with_scratch(&mut self.values, &mut self.work);
        let scale = 1.0 / (count as f64 * count as f64);
        (1..count / 2 + 1).map(move |k| {
            let sides = if 2 * k == count { 1.0 } else { 2.0 };
            sides * scale * self.values[k].norm_sqr()
        })
    }
}

impl fmt::Debug for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.values.len();
        write!(f, "Lines of {count} values, {} Hz apart", self.spacing)
    }
}
