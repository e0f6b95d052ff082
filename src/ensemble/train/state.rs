//! The memory of a batch from one chunk of steps to the next, rows of lanes.

use super::lanes::TRAIN_LANES;
use super::shape::{OF_WHEEL, Shape, WEIGHT};
use crate::ensemble::lanes::Aligned;

/// See [`super::kernel`] for the symbols.
#[derive(Debug)]
pub(super) struct State {
    /// u and v at the start of a step and, when its w is found, at its end.
    pub displacement: Aligned,
    pub velocity: Aligned,
    /// y and then w of a step.
    pub middle: Aligned,
    /// w of the step before, of the rows of outputs.
    pub before: Aligned,
    /// F of each wheel in the step before and in this one.
    pub force: Aligned,
    pub force_next: Aligned,
    /// The compression of each wheel without this step's forces.
    pub gap: Aligned,
    /// F^(1/3) of each wheel under Hertz's law.
    pub root: Aligned,
}

impl State {
    pub fn new(shape: &Shape) -> State {
        let rows = |count: usize| Aligned::new(count.max(1) * TRAIN_LANES);
        let (size, wheels) = (shape.size(), shape.wheels.len());
        State {
            displacement: rows(size),
            velocity: rows(size),
            middle: rows(size),
            before: rows(size),
            force: rows(wheels),
            force_next: rows(wheels),
            gap: rows(wheels),
            root: rows(wheels),
        }
    }

    /// At rest under the train; `number(index, lane)` are the points' numbers, `heights` `[wheel][lane]` the
    /// irregularity that the cars stand on.
    pub fn start(
        &mut self,
        shape: &Shape,
        number: impl Fn(usize, usize) -> f64,
        lifted: &[Vec<Vec<f64>>],
        heights: &[f64],
    ) {
        let layout = &shape.layout;
        for plane in [&mut self.velocity, &mut self.middle, &mut self.before] {
            plane.values_mut().fill(0.0);
        }
        for lane in 0..TRAIN_LANES {
            let u = self.displacement.values_mut();
            for row in 0..shape.size() {
                u[row * TRAIN_LANES + lane] = number(layout.start + row, lane);
            }
            for (car, carried) in lifted.iter().enumerate() {
                let wheels = shape.wheels.iter().enumerate();
                let own = wheels.filter(|(_, wheel)| wheel.car == car && wheel.row.is_some());
                let own: Vec<f64> = own.map(|(k, _)| heights[k * TRAIN_LANES + lane]).collect();
                for (row, shares) in shape.cars[car].clone().zip(carried) {
                    let lift: f64 = shares.iter().zip(&own).map(|(a, b)| a * b).sum();
                    u[row * TRAIN_LANES + lane] += lift;
                }
            }
            for index in 0..shape.wheels.len() {
                let weight = number(layout.wheels + OF_WHEEL * index + WEIGHT, lane);
                let at = index * TRAIN_LANES + lane;
                self.force.values_mut()[at] = weight;
                self.force_next.values_mut()[at] = weight;
                self.root.values_mut()[at] = weight.cbrt();
            }
        }
    }

    /// The first lane that left all bounds: a coordinate beyond `bound` or not a number.
    pub fn unbounded(&self, bound: f64) -> Option<usize> {
        let values = self.displacement.values();
        (0..TRAIN_LANES).find(|lane| {
            let mut lane = values[*lane..].iter().step_by(TRAIN_LANES);
            lane.any(|u| u.is_nan() || u.abs() >= bound)
        })
    }
}
