//! How strong a process is over time: m(t), at most 1.
//!
//! ```text
//! exponential:  m = (e^(−a t) − e^(−b t)) / largest,     b > a > 0;
//! Jennings:     m = (t/t₁)² before t₁,   1 up to t₂,   e^(−c (t − t₂)) after.
//! ```
//!
//! Sources: M. Shinozuka, Y. Sato, J. Eng. Mech. Div. ASCE 93 (1967) 11-40; P. C. Jennings,
//! G. W. Housner, N. C. Tsai, Simulated Earthquake Motions, California Institute of Technology, 1968.

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Modulation {
    Exponential {
        /// a (1/s).
        decay: f64,
        /// b (1/s).
        rise: f64,
    },
    Jennings {
        /// t₁ (s).
        rise: f64,
        /// t₂ (s).
        end: f64,
        /// c (1/s).
        decay: f64,
    },
}

impl Modulation {
    /// m at t ≥ 0 (s).
    pub fn at(&self, time: f64) -> f64 {
        match *self {
            Modulation::Exponential { decay, rise } => {
                let shape = |t: f64| (-decay * t).exp() - (-rise * t).exp();
                shape(time) / shape((rise / decay).ln() / (rise - decay))
            }
            Modulation::Jennings { rise, end, decay } => {
                if time < rise {
                    (time / rise).powi(2)
                } else if time <= end {
                    1.0
                } else {
                    (-decay * (time - end)).exp()
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_modulation_reaches_one_and_no_more() {
        let shapes = [
            (
                Modulation::Exponential {
                    decay: 0.1,
                    rise: 0.5,
                },
                0.0,
            ),
            (
                Modulation::Jennings {
                    rise: 2.0,
                    end: 8.0,
                    decay: 0.2,
                },
                6.0,
            ),
        ];
        for (shape, plateau) in shapes {
            let values: Vec<f64> = (0..20_000).map(|k| shape.at(0.001 * k as f64)).collect();
            let largest = values.iter().copied().fold(0.0, f64::max);
            assert!(
                (largest - 1.0).abs() < 1e-6 && values[0] == 0.0,
                "{largest}"
            );
            let full = values.iter().filter(|m| **m >= 1.0).count() as f64 * 0.001;
            assert!((full - plateau).abs() < 0.002, "{full}");
            assert!(
                values
                    .windows(2)
                    .all(|pair| (pair[1] - pair[0]).abs() < 2e-3)
            );
        }
    }
}
