//! The ranks of a Sobol sequence's points among each other, without sorting.
//!
//! The first 2^m points of one dimension are the multiples of 2^−m, each once. So one bit for each
//! multiple says whether a point of the range lies there, and a point's rank is the number of ones
//! before its own.

use crate::probability::sobol::Sequence;
use std::ops::Range;

/// Ranks in one dimension.
#[derive(Debug, Clone)]
pub struct Ranks {
    sequence: Sequence,
    first: usize,
    /// Digits of the multiples to leave out.
    unused: u32,
    words: Vec<Word>,
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
        let unused = 32 - digits;
        let mut words = vec![Word::default(); 1 << (digits - 5)];
        let mut cells = vec![0; points.len()];
        sequence.walk(points.clone(), &mut cells, |x| x >> unused);
        for cell in cells {
            words[(cell >> 5) as usize].taken |= 1 << (cell & 31);
        }
        let mut ones = 0;
        for word in &mut words {
            word.before = ones;
            ones += word.taken.count_ones();
        }
        Ranks {
            sequence: sequence.clone(),
            first: points.start,
            unused,
            words,
        }
    }

    /// Writes a function of each point's rank: how many points of the range are smaller.
    pub fn each<T>(&self, points: Range<usize>, out: &mut [T], value: impl Fn(usize) -> T) {
        let points = self.first + points.start..self.first + points.end;
        self.sequence.walk(points, out, |x| {
            let cell = x >> self.unused;
            let word = self.words[(cell >> 5) as usize];
            let smaller = word.taken & ((1 << (cell & 31)) - 1);
            value((word.before + smaller.count_ones()) as usize)
        });
    }
}
