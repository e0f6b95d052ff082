//! Rank-1 lattices with a random shift.
//!
//! ```text
//! u_qj = frac( q z_j / N + Δ_j ),   q = 0 ... N − 1
//! ```
//!
//! for the leading variables, at most 64. Each z_j is prime to N, so that each variable has one point in each of N
//! strata, all at the same place in their strata. Each point alone is uniform, so that weighted means
//! are unbiased.
//!
//! The generating vector is built for N itself, component by component: z_j makes
//!
//! ```text
//! e² = −1 + (1/N) Σ_q Π_j (1 + γ ω(frac(q z_j / N))),   ω(x) = 2π² (x² − x + 1/6),   γ = 0.1
//! ```
//!
//! smallest, given those before it: the mean square worst-case error of shifted lattices in a weighted
//! Sobolev space, for any N. With this small weight pairs of variables count most, and those taken
//! first, the most important, fare best. Sources: I. H. Sloan, F. Y. Kuo, S. Joe, SIAM J. Numer. Anal.
//! 40 (2002) 1650-1665; D. Nuyens, R. Cools, Math. Comput. 75 (2006) 903-920. All candidates are
//! tried where N is small, a random part of them beyond.
//!
//! Further variables take their strata in random order, as in a Latin hypercube. In many variables a
//! lattice runs out of numbers that are prime to N and unlike the others, and variables with the same one
//! depend on each other. So the lattice has at most half as many variables as there are such numbers
//! below N/2: 8 for N = 64, 40 for N = 374, 64 from N = 512 on where N is a power of two.

use super::{Permutation, PointRule, Purpose, RuleError, in_stratum, open_unit, quantile, stream};
use rand::{Rng, RngExt};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// Variables on the lattice, at most.
const SEARCHED: usize = 64;

/// Candidates tried for each of them, at least.
const CANDIDATES: usize = 64;

/// More are tried as long as candidates times points stay below this.
const EFFORT: usize = 1 << 19;

/// γ.
const WEIGHT: f64 = 0.1;

/// A randomly shifted rank-1 lattice.
#[derive(Debug, Clone)]
pub struct RankOneLattice {
    count: usize,
    variables: Vec<Variable>,
}

/// What one variable needs.
#[derive(Debug, Clone)]
struct Variable {
    strata: Strata,
    /// The place of all points in their strata.
    place: f64,
}

/// The stratum of each point.
#[derive(Debug, Clone)]
enum Strata {
    /// (q z_j + shift) modulo N.
    Lattice {
        generator: usize,
        shift: usize,
    },
    Random(Permutation),
}

impl RankOneLattice {
    /// Most points.
    pub const MOST_POINTS: usize = 1 << 20;

    /// The lattice of `count` points; its generating vector depends on nothing else, its shift and the random orders
    /// on `seed`.
    ///
    /// # Errors
    /// More than 2²⁰ points, for which the search would take too long.
    pub fn new(count: usize, dimensions: usize, seed: u64) -> Result<Self, RuleError> {
        RuleError::check_count("at most 1048576", Self::MOST_POINTS, count)?;
        let vector = generating_vector(count, dimensions.min(most_components(count)));
        let variables = (0..dimensions)
            .map(|dimension| {
                let mut random = stream(seed, Purpose::Shift, dimension);
                let place = open_unit(random.next_u64());
                let strata = match vector.get(dimension) {
                    Some(generator) => Strata::Lattice {
                        generator: *generator,
                        shift: random.random_range(0..count as u64) as usize,
                    },
                    None => Strata::Random(Permutation::random(count, &mut random)),
                };
                Variable { strata, place }
            })
            .collect();
        Ok(RankOneLattice { count, variables })
    }
}

impl PointRule for RankOneLattice {
    fn count(&self) -> usize {
        self.count
    }

    fn dimensions(&self) -> usize {
        self.variables.len()
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let mut strata = vec![0; points.len()];
        let rows = out.chunks_exact_mut(points.len());
        for (variable, row) in self.variables.iter().zip(rows) {
            match &variable.strata {
                Strata::Lattice { generator, shift } => {
                    let first = (points.start * generator + shift) % self.count;
                    let multiples = multiples(first, *generator, self.count);
                    for (stratum, multiple) in strata.iter_mut().zip(multiples) {
                        *stratum = multiple as u32;
                    }
                }
                Strata::Random(order) => order.images(points.clone(), &mut strata),
            }
            for (x, stratum) in row.iter_mut().zip(&strata) {
                *x = quantile(in_stratum(*stratum, variable.place, self.count));
            }
        }
    }
}

/// z₁ ... z_s for N points.
fn generating_vector(count: usize, dimensions: usize) -> Vec<usize> {
    let mut search = Search::new(count);
    (0..dimensions)
        .map(|dimension| match dimension {
            0 => search.take(vec![1]),
            _ => search.take(candidates(count, dimension)),
        })
        .collect()
}

/// Half as many as there are numbers prime to N up to N/2, at least one.
fn most_components(count: usize) -> usize {
    let units = (1..=count / 2).filter(|z| is_prime_to(*z, count));
    (units.take(2 * SEARCHED).count() / 2).max(1)
}

/// Numbers prime to N up to N/2 (z and N − z give mirror images): all, or a random choice.
fn candidates(count: usize, dimension: usize) -> Vec<usize> {
    let most = CANDIDATES.max(EFFORT / count);
    if count / 2 <= most {
        let all = 1..=(count / 2).max(1);
        return all.filter(|z| is_prime_to(*z, count)).collect();
    }
    let mut random = stream(count as u64, Purpose::Generator, dimension);
    (0..most).map(|_| random_unit(count, &mut random)).collect()
}

fn random_unit(count: usize, random: &mut impl Rng) -> usize {
    loop {
        let z = random.random_range(1..=(count as u64 / 2).max(1)) as usize;
        if is_prime_to(z, count) {
            return z;
        }
    }
}

fn is_prime_to(mut a: usize, mut b: usize) -> bool {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// The products over the components so far, of half the points: q and N − q are alike.
struct Search {
    count: usize,
    /// ω(r / N).
    kernel: Vec<f64>,
    /// Π (1 + γ ω(frac(q z_j / N))), twice where there are two such points.
    products: Vec<f64>,
}

impl Search {
    fn new(count: usize) -> Self {
        let kernel = |r: usize| {
            let x = r as f64 / count as f64;
            2.0 * PI * PI * (x * x - x + 1.0 / 6.0)
        };
        let alike = |q: usize| if q == 0 || 2 * q == count { 1.0 } else { 2.0 };
        Search {
            count,
            kernel: (0..count).map(kernel).collect(),
            products: (0..=count / 2).map(alike).collect(),
        }
    }

    /// The candidate with the least error, of equals the smallest; it becomes the next component.
    fn take(&mut self, candidates: Vec<usize>) -> usize {
        let error = |z: usize| -> f64 {
            let terms = self.products.iter().zip(multiples(0, z, self.count));
            terms.map(|(product, r)| product * self.kernel[r]).sum()
        };
        let best = candidates
            .into_par_iter()
            .map(|z| (error(z), z))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map_or(1, |(_, z)| z);
        let terms = self.products.iter_mut().zip(multiples(0, best, self.count));
        for (product, r) in terms {
            *product *= 1.0 + WEIGHT * self.kernel[r];
        }
        best
    }
}

/// (first + q z) modulo N for q = 0, 1, ..., where first < N and 0 < z <= N.
fn multiples(first: usize, z: usize, count: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(first), move |r| {
        let next = r + z;
        Some(if next >= count { next - count } else { next })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::cumulative;

    /// The mean of exp(2πi h·u) has modulus 1 for the dual vectors h·z ≡ 0 (mod N), and is 0 for others.
    #[test]
    fn the_dual_is_that_of_the_generating_vector() {
        for n in [64, 101, 374] {
            let z = generating_vector(n, 3);
            let rule = RankOneLattice::new(n, 3, 5).unwrap();
            let mut x = vec![0.0; 3 * n];
            rule.standard_normals(0..n, &mut x);
            let mut dual = 0;
            for h in 0..1000i64 {
                let h = [h % 10 - 5, h / 10 % 10 - 5, h / 100 - 5];
                let inner: i64 = h.iter().zip(&z).map(|(h, z)| h * *z as i64).sum();
                let is_dual = inner.rem_euclid(n as i64) == 0;
                dual += usize::from(is_dual);
                let (mut cosine, mut sine) = (0.0, 0.0);
                for q in 0..n {
                    let angle: f64 = (0..3)
                        .map(|d| 2.0 * PI * h[d] as f64 * cumulative(x[d * n + q]))
                        .sum();
                    cosine += angle.cos() / n as f64;
                    sine += angle.sin() / n as f64;
                }
                // Angles of at most 30π, each to a few units of rounding.
                let modulus = cosine.hypot(sine);
                assert!((modulus - f64::from(is_dual)).abs() < 1e-13, "{n} {h:?}");
            }
            // Besides h = 0: about 1000 / N.
            assert!(dual > 1 || n > 101, "{n} {dual}");
        }
    }

    /// e² of a generating vector.
    fn squared_error(n: usize, z: &[usize]) -> f64 {
        let mean: f64 = (0..n)
            .map(|q| {
                z.iter()
                    .map(|z| {
                        let x = (q * z % n) as f64 / n as f64;
                        1.0 + WEIGHT * 2.0 * PI * PI * (x * x - x + 1.0 / 6.0)
                    })
                    .product::<f64>()
            })
            .sum();
        mean / n as f64 - 1.0
    }

    #[test]
    fn components_are_the_best_where_all_are_tried() {
        for n in [55, 128] {
            let z = generating_vector(n, 4);
            let wanted = (1..n)
                .filter(|z| is_prime_to(*z, n))
                .map(|last| squared_error(n, &[z[0], z[1], z[2], last]))
                .fold(f64::INFINITY, f64::min);
            // The products are of some units, their rounding of some units of the last place.
            assert!((squared_error(n, &z) - wanted).abs() < 1e-13, "{n}");
        }
    }

    /// Of 4093 points a small part of the candidates is tried. In 16 variables e² is well below that of the median
    /// random vector, which is where it would be without a search.
    #[test]
    fn a_search_among_few_candidates_finds_good_ones() {
        let n = 4093;
        let searched = squared_error(n, &generating_vector(n, 16));
        let mut random = stream(1, Purpose::Generator, 0);
        let mut others: Vec<f64> = (0..51)
            .map(|_| {
                let z: Vec<usize> = (0..16).map(|_| random_unit(n, &mut random)).collect();
                squared_error(n, &z)
            })
            .collect();
        others.sort_unstable_by(f64::total_cmp);
        assert!(searched < 0.8 * others[25], "{searched} {}", others[25]);
    }

    #[test]
    fn components_are_prime_to_the_number_of_points() {
        for n in [1, 2, 3, 4, 6, 374, 984, 1 << 12, 30_030] {
            let z = generating_vector(n, 80);
            assert!(z.iter().all(|z| is_prime_to(*z, n)), "{n}");
        }
        for (n, most) in [(1, 1), (2, 1), (64, 8), (374, 40), (512, 64), (984, 64)] {
            assert_eq!(most_components(n), most, "{n}");
        }
    }
}
