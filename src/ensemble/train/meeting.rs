//! How wheels meet rail or deck within one step.
//!
//! With the factor L D Lᵀ of the step's matrix A and Bᵢ as in [`crate::system::train`], each wheel has the column
//! gᵢ = L⁻¹ Bᵢ, short since it starts at the wheel and dies out along the rail, and the wheels yield to each
//! other's forces by cᵢⱼ = gᵢᵀ D⁻¹ gⱼ. Both are the same for all points that share their parameters.

use super::lanes::{Numbers, Row, TRAIN_LANES, each, load, store};
use super::shape::{HALF_STEP, Law, OF_WHEEL, RAIL_SOFTNESS, SOFTNESS, Shape};
use super::window::Window;
use crate::system::train::Place;
use pulp::Simd;
use std::ops::Range;

/// A column this much smaller than at the wheel has died out.
const GONE: f64 = 1e-13;

/// The columns of all wheels at one step, in numbers that lanes share or rows of lanes.
#[derive(Debug, Clone, Default)]
pub struct Meeting {
    pub reaches: Vec<Reach>,
    /// The values of g, wheel after wheel, in the order of the reach's ranges.
    pub columns: Vec<f64>,
    /// h/2 cᵢⱼ, `[i][j]`, with what the rail yields between its nodes on the diagonal.
    pub yielding: Vec<f64>,
    /// Where all wheels have linear laws: the factor of yielding + softness, by rows, the diagonal inverted.
    pub solved: Vec<f64>,
}

/// The rows that a wheel's column reaches.
#[derive(Debug, Clone, Default)]
pub struct Reach {
    pub car: Range<usize>,
    pub track: Range<usize>,
    pub modes: Range<usize>,
    /// The first of its values.
    pub first: usize,
}

impl Reach {
    /// Its ranges, each with the place of its first value.
    pub fn parts(&self) -> [(Range<usize>, usize); 3] {
        let track = self.first + self.car.len();
        [
            (self.car.clone(), self.first),
            (self.track.clone(), track),
            (self.modes.clone(), track + self.track.len()),
        ]
    }
}

/// What of a meeting is found: where only the cars differ between points, the two halves are kept apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    Both,
    /// Of track and deck.
    Structure,
    /// Of the cars, the same at every step.
    Cars,
}

/// Finds meetings, reusing its memory.
#[derive(Debug)]
pub struct Finder {
    /// A column over all rows, zero between uses.
    column: Vec<f64>,
}

impl Finder {
    /// `width` values a number: 1 for what lanes share.
    pub fn new(shape: &Shape, width: usize) -> Finder {
        Finder {
            column: vec![0.0; shape.size() * width],
        }
    }

    /// The meeting at a step.
    #[inline(always)]
    pub fn find<S: Simd, const W: usize, N: Numbers>(
        &mut self,
        simd: S,
        shape: &Shape,
        numbers: N,
        (window, half): (&Window, Half),
        step: usize,
        meeting: &mut Meeting,
    ) {
        let width = W * S::F64_LANES;
        debug_assert!(width == 1 || width == TRAIN_LANES);
        meeting.reaches.clear();
        meeting.columns.clear();
        for wheel in 0..shape.wheels.len() {
            self.column::<S, W, N>(simd, shape, numbers, (window, half), (step, wheel), meeting);
        }
        self.yielding::<S, W, N>(simd, shape, numbers, (step, half), meeting);
        if half == Half::Both && shape.laws.iter().all(|law| *law != Law::Hertz) {
            solve::<S, W, N>(simd, shape, numbers, meeting);
        }
    }

    #[inline(always)]
    fn column<S: Simd, const W: usize, N: Numbers>(
        &mut self,
        simd: S,
        shape: &Shape,
        numbers: N,
        (window, half): (&Window, Half),
        (step, wheel): (usize, usize),
        meeting: &mut Meeting,
    ) {
        let width = W * S::F64_LANES;
        let lower = numbers.from(shape.layout.forward);
        let of_rail = &shape.places[step * shape.wheels.len() + wheel];
        let nothing = Place::default();
        let place = if half == Half::Cars {
            &nothing
        } else {
            of_rail
        };
        let factor = &shape.pattern.factor;
        let mut reach = Reach {
            first: meeting.columns.len() / width,
            ..Reach::default()
        };
        let own = shape.wheels[wheel].row.filter(|_| half != Half::Structure);
        if let Some(row) = own {
            reach.car = row..shape.cars[shape.wheels[wheel].car].end;
            store(
                simd,
                &mut self.column[row * width..],
                &[simd.splat_f64s(-1.0); W],
            );
            for row in row + 1..reach.car.end {
                self.eliminate::<S, W, N>(simd, row, factor.range(row), shape, lower);
            }
        }
        for (row, share) in &place.terms {
            store(
                simd,
                &mut self.column[row * width..],
                &[simd.splat_f64s(*share); W],
            );
        }
        let on_track = |row: &usize| shape.track.contains(row);
        let first = place.terms.iter().map(|(row, _)| *row).find(on_track);
        let last = place.terms.iter().map(|(row, _)| *row).rfind(on_track);
        if let (Some(first), Some(last)) = (first, last) {
            let mut row = first;
            let mut quiet = 0;
            let within = window.track.iter().find(|part| part.rows.contains(&first));
            let end = within.map_or(first, |part| part.rows.end);
            while row < end {
                self.eliminate::<S, W, N>(simd, row, factor.range(row), shape, lower);
                let value = &self.column[row * width..(row + 1) * width];
                quiet = if value.iter().all(|g| g.abs() < GONE) {
                    quiet + 1
                } else {
                    0
                };
                row += 1;
                if row > last && quiet >= 8 {
                    break;
                }
            }
            reach.track = first..row;
        }
        let reaches_modes = window.modes.is_some()
            && !shape.modes.is_empty()
            && (!reach.track.is_empty()
                || place.terms.iter().any(|(r, _)| shape.modes.contains(r)));
        if reaches_modes {
            for row in shape.modes.clone() {
                let range = factor.range(row);
                let columns = &factor.columns[range.clone()];
                let at = |row: usize| columns.partition_point(|c| (*c as usize) < row);
                let near = range.start + at(reach.track.start)..range.start + at(reach.track.end);
                let modes = range.start + at(shape.modes.start)..range.end;
                if !reach.track.is_empty() {
                    self.eliminate::<S, W, N>(simd, row, near, shape, lower);
                }
                self.eliminate::<S, W, N>(simd, row, modes, shape, lower);
            }
            reach.modes = shape.modes.clone();
        }
        for (range, _) in reach.parts() {
            let values = &mut self.column[range.start * width..range.end * width];
            meeting.columns.extend_from_slice(values);
            values.fill(0.0);
        }
        meeting.reaches.push(reach);
    }

    /// g of a row less what earlier rows take.
    #[inline(always)]
    fn eliminate<S: Simd, const W: usize, N: Numbers>(
        &mut self,
        simd: S,
        row: usize,
        places: Range<usize>,
        shape: &Shape,
        lower: N,
    ) {
        let width = W * S::F64_LANES;
        let mut sum: Row<S, W> = load(simd, &self.column[row * width..]);
        for place in places {
            let column = shape.pattern.factor.columns[place] as usize;
            // −L.
            let l: Row<S, W> = lower.row(simd, place);
            let g: Row<S, W> = load(simd, &self.column[column * width..]);
            sum = each!(simd, j => simd.add_f64s(sum[j], simd.mul_f64s(l[j], g[j])));
        }
        store(simd, &mut self.column[row * width..], &sum);
    }

    #[inline(always)]
    fn yielding<S: Simd, const W: usize, N: Numbers>(
        &mut self,
        simd: S,
        shape: &Shape,
        numbers: N,
        (step, half): (usize, Half),
        meeting: &mut Meeting,
    ) {
        let width = W * S::F64_LANES;
        let wheels = shape.wheels.len();
        meeting.yielding.clear();
        meeting.yielding.resize(wheels * wheels * width, 0.0);
        let inverse = numbers.from(shape.layout.inverse);
        let half_step: Row<S, W> = numbers.row(simd, shape.layout.constants + HALF_STEP);
        let softness: Row<S, W> = numbers.row(simd, shape.layout.constants + RAIL_SOFTNESS);
        for i in 0..wheels {
            for j in 0..=i {
                let mut sum = [simd.splat_f64s(0.0); W];
                let (a, b) = (&meeting.reaches[i], &meeting.reaches[j]);
                for ((mine, at), (other, from)) in a.parts().into_iter().zip(b.parts()) {
                    let common = mine.start.max(other.start)..mine.end.min(other.end);
                    for row in common {
                        let g: Row<S, W> =
                            load(simd, &meeting.columns[(at + row - mine.start) * width..]);
                        let f: Row<S, W> =
                            load(simd, &meeting.columns[(from + row - other.start) * width..]);
                        let d: Row<S, W> = inverse.row(simd, row);
                        sum = each!(simd, j => {
                            let gd = simd.mul_f64s(g[j], d[j]);
                            simd.add_f64s(sum[j], simd.mul_f64s(gd, f[j]))
                        });
                    }
                }
                let mut value = each!(simd, j => simd.mul_f64s(half_step[j], sum[j]));
                if i == j && half != Half::Cars {
                    let place = &shape.places[step * wheels + i];
                    let own = simd.splat_f64s(place.flexibility);
                    value = each!(simd, j => simd.add_f64s(
                        value[j],
                        simd.mul_f64s(own, softness[j])
                    ));
                }
                for at in [i * wheels + j, j * wheels + i] {
                    store(simd, &mut meeting.yielding[at * width..], &value);
                }
            }
        }
    }
}

/// The factor of yielding + softness over the wheels that are not constant forces.
#[inline(always)]
fn solve<S: Simd, const W: usize, N: Numbers>(
    simd: S,
    shape: &Shape,
    numbers: N,
    meeting: &mut Meeting,
) {
    let width = W * S::F64_LANES;
    let wheels = shape.wheels.len();
    meeting.solved.clear();
    meeting.solved.resize(wheels * wheels * width, 0.0);
    let at = |i: usize, j: usize| (i * wheels + j) * width;
    let unit = simd.splat_f64s(1.0);
    for i in 0..wheels {
        if shape.laws[i] == Law::Force {
            store(simd, &mut meeting.solved[at(i, i)..], &[unit; W]);
            continue;
        }
        let own = shape.layout.wheels + OF_WHEEL * i + SOFTNESS;
        let softness: Row<S, W> = numbers.row(simd, own);
        let first: Row<S, W> = load(simd, &meeting.yielding[at(i, i)..]);
        let mut pivot = each!(simd, j => simd.add_f64s(first[j], softness[j]));
        for j in 0..i {
            if shape.laws[j] == Law::Force {
                continue;
            }
            let mut sum: Row<S, W> = load(simd, &meeting.yielding[at(i, j)..]);
            for k in 0..j {
                // Row i holds L D while it is made.
                let ld: Row<S, W> = load(simd, &meeting.solved[at(i, k)..]);
                let l: Row<S, W> = load(simd, &meeting.solved[at(j, k)..]);
                sum = each!(simd, v => simd.sub_f64s(sum[v], simd.mul_f64s(ld[v], l[v])));
            }
            store(simd, &mut meeting.solved[at(i, j)..], &sum);
        }
        for j in 0..i {
            let ld: Row<S, W> = load(simd, &meeting.solved[at(i, j)..]);
            let inverse: Row<S, W> = load(simd, &meeting.solved[at(j, j)..]);
            let l = each!(simd, v => simd.mul_f64s(ld[v], inverse[v]));
            pivot = each!(simd, v => simd.sub_f64s(pivot[v], simd.mul_f64s(ld[v], l[v])));
            store(simd, &mut meeting.solved[at(i, j)..], &l);
        }
        let inverse = each!(simd, v => simd.div_f64s(unit, pivot[v]));
        store(simd, &mut meeting.solved[at(i, i)..], &inverse);
    }
}
