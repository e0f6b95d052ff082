//! Two-dimensional lattices of n points, centred in the unit square.
//!
//! ```text
//! u_k = ( (2k − 1) / 2n,  frac((2 h k − 1) / 2n) ),   k = 1 ... n,
//! ```
//!
//! each coordinate meeting every stratum's middle once. For a Fibonacci number n = F_m the generator
//! is h = F_{m−1} (L. K. Hua, Y. Wang, Applications of Number Theory to Numerical Analysis, 1981);
//! otherwise the best of all h: the one with the largest figure of merit
//!
//! ```text
//! ρ = min |m₁ m₂| over the dual vectors m₁ + h m₂ ≡ 0 (mod n), both not zero
//! ```
//!
//! (S. K. Zaremba, 1966; H. Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods,
//! 1992, ch. 5), which the convergents of h/n give in O(log n).

/// A lattice of n points with the generating vector (1, h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lattice {
    /// n.
    pub count: usize,
    /// h.
    pub generator: usize,
}

impl Lattice {
    /// The lattice of n ≥ 1 points.
    pub fn best(count: usize) -> Self {
        let generator = fibonacci_before(count).unwrap_or_else(|| best_generator(count));
        Lattice { count, generator }
    }

    /// u_k for k = index + 1.
    pub fn point(&self, index: usize) -> [f64; 2] {
        let n = self.count as u128;
        let k = index as u128 + 1;
        let second = (2 * self.generator as u128 * k + 2 * n - 1) % (2 * n);
        let unit = |numerator: u128| numerator as f64 / (2 * n) as f64;
        [unit(2 * k - 1), unit(second)]
    }
}

/// F_{m−1} where n is the Fibonacci number F_m.
fn fibonacci_before(count: usize) -> Option<usize> {
    let (mut before, mut now) = (1, 1);
    while now < count {
        (before, now) = (now, before + now);
    }
    (now == count).then_some(before)
}

/// The smallest generator with the largest figure of merit.
fn best_generator(count: usize) -> usize {
    let mut best = (0, 1);
    // h and n − h give mirror images.
    for generator in 1..=count / 2 {
        let merit = figure_of_merit(count, generator, best.0);
        if merit > best.0 {
            best = (merit, generator);
        }
    }
    best.1
}

/// ρ, or 0 where it is at most `beaten` or where h and n have a common divisor.
///
/// The smallest |m₁ m₂| is met at a convergent p/q of h/n: m₂ = q, m₁ = |q h − p n|.
fn figure_of_merit(count: usize, generator: usize, beaten: usize) -> usize {
    let (mut r0, mut r1) = (count, generator);
    let (mut q0, mut q1) = (0usize, 1usize);
    let mut merit = usize::MAX;
    while r1 != 0 {
        merit = merit.min(q1 * r1);
        if merit <= beaten {
            return 0;
        }
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (q0, q1) = (q1, q0 + quotient * q1);
    }
    if r0 == 1 { merit } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fibonacci_counts_take_the_number_before() {
        for (n, h) in [(377, 233), (610, 377), (987, 610), (2, 1), (1, 1)] {
            assert_eq!(
                Lattice::best(n),
                Lattice {
                    count: n,
                    generator: h
                }
            );
        }
    }

    #[test]
    fn the_figure_of_merit_is_the_smallest_product_of_the_dual() {
        for (n, h) in [(13usize, 8usize), (101, 40), (100, 27), (64, 19)] {
            let wanted = (1..n as i64)
                .map(|m2| {
                    let rest = (h as i64 * m2).rem_euclid(n as i64);
                    m2 * rest.min(n as i64 - rest)
                })
                .filter(|product| *product != 0)
                .min();
            assert_eq!(Some(figure_of_merit(n, h, 0) as i64), wanted, "{n} {h}");
        }
    }

    #[test]
    fn every_stratum_of_each_coordinate_holds_one_point() {
        for n in [1, 2, 7, 100, 374, 984, 987, 1024] {
            let lattice = Lattice::best(n);
            for coordinate in 0..2 {
                let mut strata: Vec<usize> = (0..n)
                    .map(|k| (lattice.point(k)[coordinate] * n as f64).floor() as usize)
                    .collect();
                strata.sort_unstable();
                assert!(
                    strata.iter().enumerate().all(|(i, s)| i == *s),
                    "{n} {coordinate}"
                );
            }
        }
    }
}
