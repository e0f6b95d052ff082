//! A random permutation of 0 .. n that can be evaluated at any place alone.
//!
//! A number is split into two digits, each of about √n values, and each round adds to one digit a
//! random function of the other: a Feistel network of four rounds with truly random round functions
//! (M. Luby, C. Rackoff, SIAM J. Comput. 17 (1988)), kept as tables of some √n entries. Numbers that leave
//! 0 .. n are sent through again until they return (J. Black, P. Rogaway, CT-RSA 2002), so the map is
//! a permutation of exactly n numbers and needs memory for √n, not for n.

use rand::{Rng, RngExt};
use std::ops::Range;

/// Double rounds; two make a strong pseudo-random permutation.
const DOUBLE_ROUNDS: usize = 2;

/// A permutation of 0 .. n, n below 2³².
#[derive(Debug, Clone)]
pub struct Permutation {
    count: u32,
    /// Values of the low and the high digit.
    low: u32,
    high: u32,
    rounds: [DoubleRound; DOUBLE_ROUNDS],
}

/// What is added to each digit for every value of the other.
#[derive(Debug, Clone)]
struct DoubleRound {
    to_low: Vec<u16>,
    to_high: Vec<u16>,
}

impl Permutation {
    /// A permutation of 0 .. count drawn from the generator; `count` is at least 1.
    pub fn random(count: usize, generator: &mut impl Rng) -> Self {
        let count = count as u32;
        let low = (f64::from(count).sqrt().ceil() as u32).max(1);
        let high = count.div_ceil(low);
        let mut draw = |length: u32, values: u32| -> Vec<u16> {
            (0..length)
                .map(|_| generator.random_range(0..values) as u16)
                .collect()
        };
        let rounds = std::array::from_fn(|_| DoubleRound {
            to_low: draw(high, low),
            to_high: draw(low, high),
        });
        Permutation {
            count,
            low,
            high,
            rounds,
        }
    }

    /// Writes the image of every number of a range, in order.
    pub fn images(&self, range: Range<usize>, out: &mut [u32]) {
        let (mut l, mut h) = (range.start as u32 % self.low, range.start as u32 / self.low);
        for (_, out) in range.zip(out) {
            let mut image = self.once(l, h);
            while image >= self.count {
                image = self.once(image % self.low, image / self.low);
            }
            *out = image;
            l += 1;
            if l == self.low {
                (l, h) = (0, h + 1);
            }
        }
    }

    #[inline(always)]
    fn once(&self, mut l: u32, mut h: u32) -> u32 {
        let (low, high) = (self.low, self.high);
        for round in &self.rounds {
            l += u32::from(round.to_low[h as usize]);
            l = if l >= low { l - low } else { l };
            h += u32::from(round.to_high[l as usize]);
            h = if h >= high { h - high } else { h };
        }
        h * low + l
    }
}
