//! Vertical track irregularities by the classes of the FRA and AAR (USA), in the form of Fryba.
//!
//! ```text
//! G(n) = A n₂² (n² + n₁²) / (n⁴ (n² + n₂²)),     n₁ = 0.0233,  n₂ = 0.131 1/m;  A by class, 1 (the worst) ... 6.
//! ```
//!
//! One-sided, in m³ over n in 1/m; usual band: wavelengths 1.524 ... 304.8 m. [`super::Fra`] is another form of the same
//! classes, and far rougher.
//!
//! Source: L. Fryba, Dynamics of Railway Bridges, Thomas Telford 1996; the values agree with a published program.

use super::{PowerSpectralDensity, of_one_sided_cycles};

const FIRST: f64 = 0.0233;
const SECOND: f64 = 0.131;
/// A (m) of the classes 1 to 6.
const CLASSES: [f64; 6] = [15.53e-8, 8.85e-8, 4.92e-8, 2.75e-8, 1.57e-8, 0.98e-8];

/// A track of a class, by Fryba's form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FraFryba {
    class: usize,
}

impl FraFryba {
    /// A track of class 1 (the worst) to 6.
    ///
    /// # Panics
    /// If there is no such class.
    pub fn new(class: usize) -> Self {
        assert!((1..=CLASSES.len()).contains(&class), "class {class}");
        FraFryba { class }
    }
}

impl PowerSpectralDensity for FraFryba {
    fn density(&self, wavenumber: f64) -> f64 {
        of_one_sided_cycles(wavenumber, |n| {
            let square = n * n;
            let (first, second) = (FIRST * FIRST, SECOND * SECOND);
            CLASSES[self.class - 1] * second * (square + first)
                / (square * square * (square + second))
        })
    }

    fn singularity(&self) -> Option<f64> {
        Some(0.0)
    }
}
