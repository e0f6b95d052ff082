//! The stationary Duffing oscillator.

use super::ExactDensity;
use super::quadrature::integrate;
use std::f64::consts::PI;

/// ẍ + 2 ζ ω₀ ẋ + ω₀² (x + ε x³) = w, w white noise of the two-sided spectral density S₀ over the angular
/// frequency. Its stationary displacement has the density
///
/// ```text
/// p(x) ∝ exp(−(x²/2 + ε x⁴/4) / s₀²),     s₀² = π S₀ / (2 ζ ω₀³).
/// ```
///
/// Source: T. K. Caughey, Derivation and application of the Fokker-Planck equation to discrete nonlinear
/// dynamic systems subjected to white random excitation, J. Acoust. Soc. Am. 35 (1963) 1683-1692.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Duffing {
    /// s₀, the standard deviation without the cubic stiffness (m), above 0.
    pub linear_deviation: f64,
    /// ε (1/m²), at least 0.
    pub cubic: f64,
}

/// Beyond the ends the density is less than e⁻⁴⁰ of its peak.
const EXPONENT: f64 = 40.0;

impl Duffing {
    /// From ζ, ω₀ (rad/s), S₀ (m²/s³) and ε (1/m²).
    pub fn new(damping_ratio: f64, frequency: f64, intensity: f64, cubic: f64) -> Self {
        let variance = PI * intensity / (2.0 * damping_ratio * frequency.powi(3));
        Duffing {
            linear_deviation: variance.sqrt(),
            cubic,
        }
    }

    /// ε s₀²: all that the shape depends on.
    fn shape(&self) -> f64 {
        self.cubic * self.linear_deviation.powi(2)
    }

    /// exp(−z²/2 − ε s₀² z⁴/4), z = x/s₀.
    fn weight(&self, z: f64) -> f64 {
        (-0.5 * z * z * (1.0 + 0.5 * self.shape() * z * z)).exp()
    }

    /// Where the exponent is 40, in parts of s₀.
    fn end(&self) -> f64 {
        // z² = 2 E · 2 / (1 + √(1 + 4 ε s₀² E)), the root without a difference.
        let root = (1.0 + 4.0 * self.shape() * EXPONENT).sqrt();
        (4.0 * EXPONENT / (1.0 + root)).sqrt()
    }

    /// The density on `nodes` nodes, evenly spaced.
    pub fn density(&self, nodes: usize) -> ExactDensity {
        let (end, last) = (self.end(), nodes.max(3) - 1);
        let node = |j: usize| end * (2.0 * j as f64 / last as f64 - 1.0);
        let mut sum = 0.0;
        let mut cumulative = vec![0.0];
        for j in 0..last {
            let [cell] = integrate(node(j), node(j + 1), |z| [self.weight(z)]);
            sum += cell;
            cumulative.push(sum);
        }
        cumulative.iter_mut().for_each(|f| *f /= sum);
        let scale = self.linear_deviation;
        ExactDensity {
            value: (0..=last).map(|j| scale * node(j)).collect(),
            density: (0..=last)
                .map(|j| self.weight(node(j)) / (sum * scale))
                .collect(),
            cumulative,
        }
    }

    /// Variance (m²) and kurtosis (3 for a normal).
    pub fn variance_and_kurtosis(&self) -> (f64, f64) {
        const CELLS: usize = 64;
        let width = self.end() / CELLS as f64;
        let mut sums = [0.0; 3];
        for j in 0..CELLS {
            let moments = |z: f64| [0, 2, 4].map(|power| z.powi(power) * self.weight(z));
            let cell = integrate(j as f64 * width, (j + 1) as f64 * width, moments);
            sums.iter_mut().zip(cell).for_each(|(sum, c)| *sum += c);
        }
        let [mass, second, fourth] = sums;
        let variance = second / mass;
        (
            variance * self.linear_deviation.powi(2),
            fourth / mass / variance.powi(2),
        )
    }
}
