//! Frequency weightings of ISO 2631-1 for accelerations.
//!
//! ```text
//! |W|² = f⁴/(f⁴ + f₁⁴) · f₂⁴/(f⁴ + f₂⁴)                                          band limits
//!      · (f² + f₃²)/f₃² · f₄⁴Q₄²/(f⁴Q₄² + f²f₄²(1 − 2Q₄²) + f₄⁴Q₄²)              transition
//!      · Q₆²/Q₅² (f⁴Q₅² + f²f₅²(1 − 2Q₅²) + f₅⁴Q₅²)/(f⁴Q₆² + f²f₆²(1 − 2Q₆²) + f₆⁴Q₆²)   upward step (W_k)
//! ```
//!
//! with f₁ = 0.4 Hz, f₂ = 100 Hz. The weighted root mean square is a_w = (Σ |W(f_k)|² A_k²/2)^(1/2).
//! Below 0.315 m/s² is not uncomfortable, to 0.63 a little, to 1 fairly, to 1.6 uncomfortable, to 2.5 very.
//!
//! Source: ISO 2631-1:1997, annex A, cited from memory of the literature; the tests compare with its table 3.

/// A weighting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weighting {
    /// Vertical, seated or standing: W_k.
    Wk,
    /// Horizontal: W_d.
    Wd,
}

impl Weighting {
    /// All of them.
    pub const ALL: [Weighting; 2] = [Weighting::Wk, Weighting::Wd];

    /// The name in scenarios.
    pub fn name(self) -> &'static str {
        match self {
            Weighting::Wk => "w-k",
            Weighting::Wd => "w-d",
        }
    }

    /// |W|² at the frequency (Hz).
    pub fn squared(self, frequency: f64) -> f64 {
        let square = frequency * frequency;
        let fourth = |f: f64| f.powi(4);
        let band = fourth(frequency) / (fourth(frequency) + fourth(0.4))
            * (fourth(100.0) / (fourth(frequency) + fourth(100.0)));
        // f⁴ + f²f₀²(1/Q² − 2) + f₀⁴
        let resonance =
            |f: f64, q: f64| fourth(frequency) + square * f * f * (1.0 / (q * q) - 2.0) + fourth(f);
        let (corner, step) = match self {
            Weighting::Wk => (12.5, resonance(2.37, 0.91) / resonance(3.35, 0.91)),
            Weighting::Wd => (2.0, 1.0),
        };
        let transition = (square / (corner * corner) + 1.0) * fourth(corner);
        band * transition / resonance(corner, 0.63) * step
    }
}
