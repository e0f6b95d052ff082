//! What the rows of the modes take from the rows above them in a sweep down: they reach over all of the bridge.

use super::shape::Shape;
use std::ops::Range;

/// Sums that are made side by side: they do not wait for each other.
pub(super) const SIDE_BY_SIDE: usize = 3;
/// Rows of track that the cache holds until all modes have taken their share.
const SHORT: usize = 64;

/// The products of some entries of L.
#[derive(Debug, Clone, PartialEq)]
pub enum Share {
    /// Of [`SIDE_BY_SIDE`] rows from this one on, that are full over these columns; where the entries begin.
    SideBySide(usize, Range<usize>, [usize; SIDE_BY_SIDE]),
    /// Of one row, at these places.
    Alone(usize, Range<usize>),
}

impl Share {
    /// All shares of the modes where these rows of the track move, in the order in which they are taken: first of the
    /// track, stretch by stretch, then mode by mode of the modes before.
    pub fn of_modes(shape: &Shape, track: &[Range<usize>]) -> Vec<Share> {
        let modes = shape.modes.clone();
        let mut all = Vec::new();
        for rows in track {
            for first in rows.clone().step_by(SHORT) {
                let columns = first..(first + SHORT).min(rows.end);
                let mut row = modes.start;
                while row < modes.end {
                    let group: [usize; SIDE_BY_SIDE] = std::array::from_fn(|k| row + k);
                    let places = group.map(|row| {
                        let row = row.min(modes.end - 1);
                        at(shape, row, columns.start)..at(shape, row, columns.end)
                    });
                    let is_full = |places: &Range<usize>| places.len() == columns.len();
                    if row + SIDE_BY_SIDE <= modes.end && places.iter().all(is_full) {
                        let starts = places.map(|places| places.start);
                        all.push(Share::SideBySide(row, columns.clone(), starts));
                        row += SIDE_BY_SIDE;
                    } else {
                        // Modes of other spans take nothing from this stretch.
                        let [places, ..] = places;
                        if !places.is_empty() {
                            all.push(Share::Alone(row, places));
                        }
                        row += 1;
                    }
                }
            }
        }
        all.extend(modes.clone().map(|row| {
            let end = shape.pattern.factor.range(row).end;
            Share::Alone(row, at(shape, row, modes.start)..end)
        }));
        all
    }
}

/// The place of a row's first entry of L from a column on.
fn at(shape: &Shape, row: usize, column: usize) -> usize {
    let factor = &shape.pattern.factor;
    let range = factor.range(row);
    let columns = &factor.columns[range.clone()];
    range.start + columns.partition_point(|c| (*c as usize) < column)
}
