//! Direction numbers of Sobol sequences, and walks along them.
//!
//! ```text
//! v_b = m_b / 2^b,   m_b = 2 a₁ m_{b−1} ⊕ 4 a₂ m_{b−2} ⊕ ... ⊕ 2^s m_{b−s} ⊕ m_{b−s},   b > s
//! ```
//!
//! with a primitive polynomial x^s + a₁ x^{s−1} + ... + 1 and m₁ ... m_s for each dimension but the
//! first, whose m_b are 1. Polynomials and initial numbers: S. Joe, F. Y. Kuo, SIAM J. Sci. Comput. 30
//! (2008) 2635-2654, set new-joe-kuo-6.21201; its licence lies beside the data.

use std::ops::Range;

/// Dimensions in the data.
pub(super) const DIMENSIONS: usize = 4096;

/// For each dimension but the first: s, the number a₁ ... a_{s−1}, m₁ ... m_s, each in 16 bits, low byte first.
const DATA: &[u8] = include_bytes!("new-joe-kuo-6.bin");

/// One dimension of a digital sequence, its points as 32 binary digits, the first on top.
#[derive(Debug, Clone)]
pub struct Sequence {
    /// v₀ ⊕ ... ⊕ v_b.
    sums: [u32; 32],
    shift: u32,
}

impl Sequence {
    fn new(directions: [u32; 32]) -> Self {
        let mut sums = directions;
        for b in 1..32 {
            sums[b] ^= sums[b - 1];
        }
        Sequence { sums, shift: 0 }
    }

    /// Each point multiplied by a matrix of binary digits, given by its columns, and shifted.
    pub fn scrambled(mut self, columns: &[u32; 32], shift: u32) -> Self {
        for sum in &mut self.sums {
            *sum = (0..32)
                .filter(|digit| *sum >> (31 - digit) & 1 == 1)
                .fold(0, |product, digit| product ^ columns[digit]);
        }
        self.shift = shift;
        self
    }

    /// The digits of point q < 2³².
    pub fn point(&self, q: usize) -> u32 {
        let direction = |b: usize| self.sums[b] ^ if b > 0 { self.sums[b - 1] } else { 0 };
        (0..32)
            .filter(|b| q >> b & 1 == 1)
            .fold(self.shift, |digits, b| digits ^ direction(b))
    }

    /// Writes a function of each point's digits.
    pub fn walk<T>(&self, points: Range<usize>, out: &mut [T], value: impl Fn(u32) -> T) {
        let mut digits = self.point(points.start);
        for (q, out) in points.zip(out) {
            *out = value(digits);
            // From q to q + 1 the trailing ones and the zero before them change.
            digits ^= self.sums[(q.trailing_ones() & 31) as usize];
        }
    }
}

/// The sequences of the first dimensions, at most [`DIMENSIONS`].
pub fn sequences(dimensions: usize) -> impl Iterator<Item = Sequence> {
    let mut data = DATA
        .chunks_exact(2)
        .map(|bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])));
    let first = std::iter::once(std::array::from_fn(|b| 1 << (31 - b)));
    let others = std::iter::from_fn(move || {
        let degree = data.next()? as usize;
        let polynomial = data.next()?;
        let mut directions = [0; 32];
        for (b, v) in directions.iter_mut().take(degree).enumerate() {
            *v = data.next()? << (31 - b);
        }
        extend(&mut directions, degree, polynomial);
        Some(directions)
    });
    first.chain(others).take(dimensions).map(Sequence::new)
}

/// The recurrence, in terms of v_b = m_b 2^(32 − b).
fn extend(directions: &mut [u32; 32], degree: usize, polynomial: u32) {
    for b in degree..32 {
        let mut v = directions[b - degree] ^ (directions[b - degree] >> degree);
        for k in 1..degree {
            if polynomial >> (degree - 1 - k) & 1 == 1 {
                v ^= directions[b - k];
            }
        }
        directions[b] = v;
    }
}
