//! Frequencies, modes and damping ratios of an undeformed chain, and the steps that it stands.

use super::{Chain, Element, Rayleigh};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

impl Chain {
    /// Natural frequencies (rad/s) of the undeformed, undamped chain, lowest first, and its modes.
    pub fn modes(&self) -> (Vec<f64>, DMatrix<f64>) {
        let count = self.storeys.len();
        let root: Vec<f64> = self.storeys.iter().map(|s| s.mass.sqrt()).collect();
        let tied = tied(count, |i| self.storeys[i].stiffness());
        let scaled = DMatrix::from_fn(count, count, |i, j| tied[(i, j)] / (root[i] * root[j]));
        let eigen = SymmetricEigen::new(scaled);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let frequencies = order
            .iter()
            .map(|k| eigen.eigenvalues[*k].max(0.0).sqrt())
            .collect();
        let shapes = DMatrix::from_fn(count, count, |i, j| {
            eigen.eigenvectors[(i, order[j])] / root[i]
        });
        (frequencies, shapes)
    }

    /// Damping ratio of each mode, φᵀ C φ / 2ω, by linear and Rayleigh damping; 0 where ω is 0.
    pub fn modal_damping_ratios(&self) -> Vec<f64> {
        let (frequencies, shapes) = self.modes();
        let elements = self.elements();
        let damping = self.damping_matrix(&elements);
        let ratio = |(k, omega): (usize, &f64)| {
            let shape: DVector<f64> = shapes.column(k).into_owned();
            let ratio = shape.dot(&(&damping * &shape)) / (2.0 * omega);
            if ratio.is_finite() { ratio } else { 0.0 }
        };
        frequencies.iter().enumerate().map(ratio).collect()
    }

    fn damping_matrix(&self, elements: &[Element]) -> DMatrix<f64> {
        let mut damping = tied(elements.len(), |i| elements[i].damping);
        for (i, storey) in self.storeys.iter().enumerate() {
            damping[(i, i)] += elements[i].mass_damping * storey.mass;
        }
        damping
    }

    /// The largest step (s) at which the classical Runge-Kutta scheme lets nothing of the undeformed chain
    /// grow, its linear and Rayleigh damping included, to three digits and rounded down; `None` where
    /// every step will do.
    pub fn largest_stable_step(&self) -> Option<f64> {
        let rates = self.rates();
        let stable = |h: f64| {
            rates
                .iter()
                .all(|(re, im)| amplification(re * h, im * h) <= 1.0 + 1e-9)
        };
        let fastest = rates
            .iter()
            .map(|(re, im)| re.hypot(*im))
            .fold(0.0, f64::max);
        if fastest == 0.0 {
            return None;
        }
        // The region of stability is within |z| < 3; on a ray through it the steps are stable up to its edge.
        let (mut low, mut high) = (0.0, 3.0 / fastest);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if stable(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let units = 10f64.powf(2.0 - low.log10().floor());
        Some((low * units * (1.0 + 1e-12)).floor() / units)
    }

    /// Eigenvalues (1/s) of the linear equations of motion: real and imaginary parts.
    fn rates(&self) -> Vec<(f64, f64)> {
        let count = self.storeys.len();
        let elements = self.elements();
        let stiffness = tied(count, |i| self.storeys[i].stiffness());
        let damping = self.damping_matrix(&elements);
        let matrix = DMatrix::from_fn(2 * count, 2 * count, |i, j| match (i < count, j < count) {
            (true, _) => f64::from(u8::from(j == i + count)),
            (false, true) => -stiffness[(i - count, j)] * elements[i - count].flexibility,
            (false, false) => -damping[(i - count, j - count)] * elements[i - count].flexibility,
        });
        let rates = matrix.complex_eigenvalues();
        rates.iter().map(|z| (z.re.min(0.0), z.im)).collect()
    }
}

impl Rayleigh {
    /// a₀ (1/s) and a₁ (s) from the chain's frequencies: ζ = a₀/2ω + a₁ ω/2 in both modes.
    pub(super) fn factors(&self, frequencies: &[f64]) -> (f64, f64) {
        let [one, other] = self.modes.map(|mode| frequencies[mode - 1]);
        let sum = one + other;
        if sum == 0.0 {
            return (0.0, 0.0);
        }
        (
            2.0 * self.damping_ratio * one * other / sum,
            2.0 * self.damping_ratio / sum,
        )
    }
}

/// The tridiagonal matrix of elements of these constants, one below each storey.
fn tied(count: usize, constant: impl Fn(usize) -> f64) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(count, count);
    for i in 0..count {
        let k = constant(i);
        matrix[(i, i)] += k;
        if i > 0 {
            matrix[(i - 1, i - 1)] += k;
            matrix[(i, i - 1)] -= k;
            matrix[(i - 1, i)] -= k;
        }
    }
    matrix
}

/// |1 + z + z²/2 + z³/6 + z⁴/24|.
fn amplification(re: f64, im: f64) -> f64 {
    let (mut a, mut b) = (1.0, 0.0);
    for k in [4.0, 3.0, 2.0, 1.0] {
        (a, b) = (1.0 + (a * re - b * im) / k, (a * im + b * re) / k);
    }
    f64::hypot(a, b)
}
