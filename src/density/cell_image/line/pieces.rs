//! Cells' images by their quadratics: pieces that rise or fall all the way.

use super::{Image, OnScale, Quadratic};
use crate::density::Nodes;
use crate::density::cell_image::cumulative::Cumulative;
use crate::density::known::Scale;
use crate::density::rule::{Extent, Fit, Smoothed};
use pulp::{Simd, WithSimd};

/// A part of a cell in which its quadratic rises or falls all the way.
struct Piece {
    quadratic: Quadratic,
    origin: f64,
    /// Its ends from there, and the response at each.
    ends: [f64; 2],
    responses: [f64; 2],
    /// The probability below each end.
    below: [f64; 2],
}

/// The pieces of all cells at one time.
pub(super) struct Pieces {
    scale: Scale,
    pieces: Vec<Piece>,
}

impl Pieces {
    pub fn new(image: &Image<'_>) -> Self {
        let OnScale {
            scale,
            coordinate,
            below,
            ..
        } = image.on;
        let mut pieces = Vec::with_capacity(coordinate.len() + 16);
        for (q, from, to, k) in image.cells() {
            let origin = coordinate[k];
            let mut push = |ends: [f64; 2], below: [f64; 2]| {
                pieces.push(Piece {
                    quadratic: q,
                    origin,
                    ends,
                    responses: ends.map(|end| q.at(end)),
                    below,
                });
            };
            match q.turn(from, to) {
                Some(turn) => {
                    let at_turn = scale.share(origin + turn);
                    push([from, turn], [below[k], at_turn]);
                    push([turn, to], [at_turn, below[k + 1]]);
                }
                None => push([from, to], [below[k], below[k + 1]]),
            }
        }
        Pieces {
            scale: *scale,
            pieces,
        }
    }
}

impl Fit for Pieces {
    fn width(&self) -> f64 {
        0.0
    }

    fn extent(&self) -> Extent {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, largest) = self.pieces.iter().fold(none, |(least, largest), piece| {
            let [a, b] = piece.responses;
            (least.min(a).min(b), largest.max(a).max(b))
        });
        Extent {
            least,
            largest,
            spacing: f64::INFINITY,
            edged: true,
        }
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        let sum = pulp::Arch::new().dispatch(Summing {
            pieces: self,
            sum: Cumulative::new(nodes),
        });
        Smoothed {
            curve: sum.curve(),
            width: 0.0,
        }
    }
}

/// The sum of all pieces' images, for the machine's vector units.
struct Summing<'a> {
    pieces: &'a Pieces,
    sum: Cumulative,
}

impl WithSimd for Summing<'_> {
    type Output = Cumulative;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Cumulative {
        let Pieces { scale, pieces } = self.pieces;
        for piece in pieces {
            let [below, until] = piece.below;
            let mass = until - below;
            if mass <= 0.0 {
                continue;
            }
            let ([a, b], [at_a, at_b]) = (piece.ends, piece.responses);
            let side = if at_b >= at_a { 1.0 } else { -1.0 };
            let per_mass = 1.0 / mass;
            self.sum.add(mass, at_a.min(at_b), at_a.max(at_b), |y| {
                let place = piece.quadratic.meets(y, side).clamp(a, b);
                let share = scale.share(piece.origin + place);
                (if side > 0.0 {
                    share - below
                } else {
                    until - share
                }) * per_mass
            });
        }
        self.sum
    }
}
