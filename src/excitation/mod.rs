//! Excitation in time: spectra of ground motion, and the modulation that makes it grow and fade.
//!
//! A process is m(t) s(t): a stationary one, s, by the spectral representation of
//! [`crate::irregularity`] with the time t (s) in place of the position and the angular frequency ω
//! (rad/s) in place of the wavenumber, times a modulation m. Spectra are two-sided over ω, for a base
//! acceleration in m²/s³:
//!
//! ```text
//! R(τ) = ∫ S(ω) cos(ω τ) dω over −∞ ... ∞,    σ² = 2 ∫ S dω over 0 ... ∞.
//! ```
//!
//! White noise of the level S₀ is flat up to the largest frequency of the representation; with that
//! frequency well above an oscillator's own, the response is that to white noise with
//! E[w(t) w(t + τ)] = 2π S₀ δ(τ).

mod clough_penzien;
mod kanai_tajimi;
mod modulation;
mod white;

pub use clough_penzien::CloughPenzien;
pub use kanai_tajimi::KanaiTajimi;
pub use modulation::Modulation;
pub use white::White;

/// White noise through an oscillator, as its base moves: |H|² of its absolute acceleration.
fn transmitted(frequency: f64, own: f64, damping_ratio: f64) -> f64 {
    let damping = (2.0 * damping_ratio * own * frequency).powi(2);
    let distance = own * own - frequency * frequency;
    (own.powi(4) + damping) / (distance * distance + damping)
}

/// |H|² of its relative acceleration: ω⁴ over the same denominator.
fn filtered(frequency: f64, own: f64, damping_ratio: f64) -> f64 {
    let damping = (2.0 * damping_ratio * own * frequency).powi(2);
    let distance = own * own - frequency * frequency;
    frequency.powi(4) / (distance * distance + damping)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::irregularity::PowerSpectralDensity;
    use std::f64::consts::PI;

    #[test]
    fn kanai_and_tajimis_variance_is_that_of_the_filtered_noise() {
        let spectrum = KanaiTajimi {
            level: 2e-3,
            ground_frequency: 15.0,
            ground_damping_ratio: 0.6,
        };
        // σ² = π S₀ ω_g (1 + 4 ζ²)/(2 ζ), by the midpoint rule up to 3000 rad/s and the tail 4 ζ² ω_g² S₀/ω².
        let (step, count) = (0.02, 150_000);
        let sum: f64 = (0..count)
            .map(|k| 2.0 * step * spectrum.density((k as f64 + 0.5) * step))
            .sum();
        let tail = 2.0 * 4.0 * 0.36 * 225.0 * 2e-3 / 3000.0;
        let exact = PI * 2e-3 * 15.0 * (1.0 + 4.0 * 0.36) / 1.2;
        assert!(((sum + tail) / exact - 1.0).abs() < 1e-6, "{sum} {exact}");
        assert_eq!(spectrum.density(0.0), 2e-3);
    }

    #[test]
    fn clough_and_penzien_leave_out_the_long_periods_only() {
        let ground = KanaiTajimi {
            level: 1.0,
            ground_frequency: 15.0,
            ground_damping_ratio: 0.6,
        };
        let spectrum = CloughPenzien {
            ground,
            filter_frequency: 1.5,
            filter_damping_ratio: 0.6,
        };
        assert_eq!(spectrum.density(0.0), 0.0);
        let share = |frequency: f64| spectrum.density(frequency) / ground.density(frequency);
        assert!((share(1.5) - 1.0 / (4.0 * 0.36)).abs() < 1e-14);
        assert!((share(1e3) - 1.0).abs() < 1e-5);
    }
}
