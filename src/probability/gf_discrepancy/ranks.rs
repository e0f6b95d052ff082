//! The ranks of a Sobol sequence's points among each other, without sorting.
//!
//! The first 2^m points of one dimension are the multiples of 2^−m, each once. So one bit for each
//! multiple says whether a point of the range lies there, and a point's rank is the number of ones
//! before its own. It differs from the share of multiples before its own times N by less than the sequence's
//! discrepancy, some log₂ N (H. Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods,
//! 1992, ch. 4): one byte a point keeps the difference.

use crate::probability::sobol::Sequence;
use std::ops::Range;

/// Ranks in one dimension.
#[derive(Debug, Clone)]
pub struct Ranks {
    sequence: Sequence,
    first: usize,
    /// m, at least 5.
    digits: u32,
    /// Rank less the whole part of N times the point's multiple of 2^−m.
    differences: Vec<i8>,
}

/// 32 multiples.
#[derive(Debug, Clone, Copy, Default)]
struct Word {
    taken: u32,
    /// Ones before this word.
    before: u32,
}

impl Ranks {
    /// Of the points of a range.
    pub fn new(sequence: &Sequence, points: Range<usize>) -> Self {
        let digits = points.end.next_power_of_two().trailing_zeros().max(5);
        let mut ranks = Ranks {
            sequence: sequence.clone(),
            first: points.start,
            digits,
            differences: vec![0; points.len()],
        };
        let multiples = ranks.multiples(0..points.len());
        let mut words = vec![Word::default(); 1 << (digits - 5)];
        for multiple in &multiples {
            words[(multiple >> 5) as usize].taken |= 1 << (multiple & 31);
        }
        let mut ones = 0;
        for word in &mut words {
            word.before = ones;
            ones += word.taken.count_ones();
        }
        for (q, multiple) in multiples.into_iter().enumerate() {
            let word = words[(multiple >> 5) as usize];
            let smaller = word.taken & ((1 << (multiple & 31)) - 1);
            let rank = i64::from(word.before + smaller.count_ones());
            ranks.differences[q] = (rank - ranks.share(multiple)) as i8;
        }
        ranks
    }

    /// Writes a function of each point's rank: how many points of the range are smaller.
    pub fn each<T>(&self, points: Range<usize>, out: &mut [T], value: impl Fn(usize) -> T) {
        let multiples = self.multiples(points.clone());
        let differences = &self.differences[points];
        for ((out, multiple), difference) in out.iter_mut().zip(multiples).zip(differences) {
            *out = value((self.share(multiple) + i64::from(*difference)) as usize);
        }
    }

    /// The points as multiples of 2^−m.
    fn multiples(&self, points: Range<usize>) -> Vec<u32> {
        let mut multiples = vec![0; points.len()];
        let points = self.first + points.start..self.first + points.end;
        let unused = 32 - self.digits;
        self.sequence.walk(points, &mut multiples, |x| x >> unused);
        multiples
    }

    /// The whole part of N times a multiple of 2^−m.
    fn share(&self, multiple: u32) -> i64 {
        ((u64::from(multiple) * self.differences.len() as u64) >> self.digits) as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::sobol::sequences;

    #[test]
    fn ranks_are_those_of_a_sort() {
        for (n, dimension) in [(1, 0), (24, 1), (1000, 7), (100_000, 1000)] {
            let sequence = sequences(dimension + 1).last().unwrap();
            let mut ranks = vec![0; n];
            Ranks::new(&sequence, 8..8 + n).each(0..n, &mut ranks, |rank| rank);
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_unstable_by_key(|q| sequence.point(8 + q));
            assert!(order.iter().enumerate().all(|(rank, q)| ranks[*q] == rank));
        }
    }
}
