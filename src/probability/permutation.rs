//! A random permutation of 0 .. n that can be evaluated at any place alone.
//!
//! A number is split into two digits, each of about √n values, and each round adds to one digit a
//! random function of the other: a Feistel network with truly random round functions (M. Luby,
//! C. Rackoff, SIAM J. Comput. 17 (1988)), kept as tables of some √n entries. Numbers that leave
//! 0 .. n are sent through again until they return (J. Black, P. Rogaway, CT-RSA 2002), so the map is
//! a permutation of exactly n numbers and needs memory for √n, not for n.

use rand::{Rng, RngExt};

/// Double rounds: four make a pseudo-random permutation, two more are margin.
const ROUNDS: usize = 3;

/// A permutation of 0 .. n.
#[derive(Debug, Clone)]
pub struct Permutation {
    count: u32,
    /// Values of the low and the high digit.
    low: u32,
    high: u32,
    /// Round functions: `high` entries below `low`, then `low` entries below `high`; `ROUNDS` times.
    tables: Vec<u32>,
}

impl Permutation {
    /// A permutation of 0 .. count drawn from the generator; `count` is at least 1.
    pub fn random(count: usize, generator: &mut impl Rng) -> Self {
        let count = count as u32;
        let low = (f64::from(count).sqrt().ceil() as u32).max(1);
        let high = count.div_ceil(low);
        let mut tables = Vec::with_capacity(ROUNDS * (low + high) as usize);
        for _ in 0..ROUNDS {
            tables.extend((0..high).map(|_| generator.random_range(0..low)));
            tables.extend((0..low).map(|_| generator.random_range(0..high)));
        }
        Permutation {
            count,
            low,
            high,
            tables,
        }
    }

    /// The image of every number of a range, in order.
    pub fn images(&self, range: std::ops::Range<usize>, mut take: impl FnMut(usize, usize)) {
        let (mut l, mut h) = (range.start as u32 % self.low, range.start as u32 / self.low);
        for (place, _) in range.enumerate() {
            let (mut image_l, mut image_h) = self.once(l, h);
            while image_h * self.low + image_l >= self.count {
                (image_l, image_h) = self.once(image_l, image_h);
            }
            take(place, (image_h * self.low + image_l) as usize);
            l += 1;
            if l == self.low {
                (l, h) = (0, h + 1);
            }
        }
    }

    #[inline]
    fn once(&self, mut l: u32, mut h: u32) -> (u32, u32) {
        let (low, high) = (self.low, self.high);
        for round in self.tables.chunks_exact((low + high) as usize) {
            let (of_high, of_low) = round.split_at(high as usize);
            l += of_high[h as usize];
            l -= if l >= low { low } else { 0 };
            h += of_low[l as usize];
            h -= if h >= high { high } else { 0 };
        }
        (l, h)
    }
}
