//! What all points of a train's crossing share: places, patterns, and where in the lists of numbers to find what.

use super::outputs::Outputs;
use super::sparse::{Factor, Lower, Pattern};
use crate::quantity::Quantity;
use crate::system::InitialState;
use crate::system::train::{Assembly, Contact, Place, TrainCrossing, TrainWheel};
use std::ops::Range;

/// The contact of one wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// A constant force.
    Force,
    /// F = δ / softness, rigid where that is zero.
    Linear,
    /// F = (δ/G)^(3/2), δ > 0.
    Hertz,
}

/// The shared part.
#[derive(Debug)]
pub struct Shape {
    pub crossing: TrainCrossing,
    pub pattern: Pattern,
    pub wheels: Vec<TrainWheel>,
    pub laws: Vec<Law>,
    /// Of each row of the cars, the number W of the wheel that is its coordinate.
    pub weights: Vec<Option<usize>>,
    /// Rows of each car, of the track, of the deck's modes.
    pub cars: Vec<Range<usize>>,
    pub track: Range<usize>,
    pub modes: Range<usize>,
    /// Rows of the track of which L has entries in all modes.
    pub full: Range<usize>,
    /// Of each fastener, its first row.
    pub fasteners: Vec<usize>,
    /// What carries each wheel in the middle of each step, `[step][wheel]`.
    pub places: Vec<Place>,
    pub outputs: Outputs,
    /// The rows whose rates or accelerations outputs take.
    pub moving: Vec<usize>,
    pub layout: Layout,
}

/// Where in a list of numbers the parts begin.
#[derive(Debug, Clone, Copy, Default)]
pub struct Layout {
    /// h, h/2, 1/h, and (1/3EI)/(1/3EI of the nominal rail).
    pub constants: usize,
    /// Of each wheel: W, δ_W, softness or G, 1/W.
    pub wheels: usize,
    /// 1/D; −L below its diagonal by rows, and by columns; whole rows of −K and of 2M/h.
    pub inverse: usize,
    pub forward: usize,
    pub backward: usize,
    pub stiffness: usize,
    pub mass: usize,
    pub outputs: usize,
    /// The static displacements at the start.
    pub start: usize,
    pub size: usize,
}

pub const STEP: usize = 0;
pub const HALF_STEP: usize = 1;
pub const INVERSE_STEP: usize = 2;
pub const RAIL_SOFTNESS: usize = 3;
const CONSTANTS: usize = 4;

pub const WEIGHT: usize = 0;
pub const COMPRESSION: usize = 1;
pub const SOFTNESS: usize = 2;
/// 1/W, of the nominal weight.
pub const LIGHTNESS: usize = 3;
pub const OF_WHEEL: usize = 4;

/// A wheel leaves the modelled rail: at this place (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffTrack {
    pub position: f64,
}

impl Shape {
    /// `shared` says whether all points share track and deck, whose factor is then that of the crossing.
    ///
    /// # Errors
    /// A wheel that leaves the rail.
    pub fn new(
        crossing: TrainCrossing,
        quantities: &[Quantity],
        shared: bool,
    ) -> Result<Shape, OffTrack> {
        let assembly = crossing.assembly();
        let matrices = &assembly.matrices;
        let massive = |piece: usize| matrices.values[piece][0] != 0.0;
        let mut pattern = Pattern::new(matrices.size, &matrices.places, massive);
        let first_mode = assembly.deck.as_ref().map_or(matrices.size, |d| d.first);
        if shared {
            let lower = dynamic(&pattern.collect(&matrices.values), crossing.time_step);
            if let Some(factor) = pattern.factorise(&lower) {
                pattern.prune(&factor, first_mode..matrices.size);
            }
        }
        let wheels = assembly.wheels();
        let laws = wheels.iter().map(|wheel| law(&crossing, wheel)).collect();
        let mut places = Vec::with_capacity((crossing.steps + 1) * wheels.len());
        for step in 0..=crossing.steps {
            for wheel in &wheels {
                let position = crossing.middle(step) - wheel.behind;
                places.push(assembly.place(position).ok_or(OffTrack { position })?);
            }
        }
        let cars: Vec<Range<usize>> = assembly
            .cars
            .iter()
            .map(|car| car.first..car.first + car.bodies.inertia.len())
            .collect();
        let after_cars = cars.last().map_or(0, |car| car.end);
        let modes = first_mode..matrices.size;
        let is_full = |row: &usize| {
            let columns = &pattern.factor_columns;
            let columns = &columns.columns[columns.range(*row)];
            modes.len() <= columns.len()
                && columns[columns.len() - modes.len()..]
                    .iter()
                    .map(|column| *column as usize)
                    .eq(modes.clone())
        };
        let mut track = after_cars..first_mode;
        let first_full = track.find(is_full).unwrap_or(first_mode);
        let full = first_full..track.find(|row| !is_full(row)).unwrap_or(first_mode);
        let outputs = Outputs::new(&crossing, &assembly, &wheels, quantities);
        let mut layout = Layout::default();
        let mut size = 0;
        let mut take = |count: usize| {
            size += count;
            size - count
        };
        layout.constants = take(CONSTANTS);
        layout.wheels = take(OF_WHEEL * wheels.len());
        layout.inverse = take(pattern.size);
        layout.forward = take(pattern.factor.columns.len());
        layout.backward = take(pattern.factor.columns.len());
        layout.stiffness = take(pattern.stiffness.columns.len());
        layout.mass = take(pattern.mass.columns.len());
        layout.outputs = take(outputs.numbers());
        layout.start = take(pattern.size);
        layout.size = size;
        let mut weights = vec![None; after_cars];
        for (index, wheel) in wheels.iter().enumerate() {
            if let Some(row) = wheel.row {
                weights[row] = Some(layout.wheels + OF_WHEEL * index + WEIGHT);
            }
        }
        Ok(Shape {
            laws,
            weights,
            cars,
            track: after_cars..first_mode,
            modes,
            full,
            fasteners: assembly.track.map_or_else(Vec::new, |track| track.firsts),
            places,
            moving: outputs.moving_rows(),
            outputs,
            layout,
            wheels,
            pattern,
            crossing,
        })
    }

    /// The number of coordinates.
    pub fn size(&self) -> usize {
        self.pattern.size
    }

    /// The list of numbers of a crossing of this shape; it may differ from the shape's in its values. A step
    /// takes the train as far as one of the shape's, so that all points share the wheels' places: where the speed
    /// differs so does h.
    ///
    /// # Errors
    /// Matrices that are not positive definite: values that no structure has.
    pub fn numbers(&self, crossing: &TrainCrossing) -> Option<Vec<f64>> {
        let assembly = crossing.assembly();
        let h = self.step(crossing);
        let lower = self.pattern.collect(&assembly.matrices.values);
        let (m, k) = (&lower.mass, &lower.stiffness);
        let dynamic = dynamic(&lower, h);
        let factor = self.pattern.factorise(&dynamic)?;
        let mut list = Vec::with_capacity(self.layout.size);
        let rigidity = |crossing: &TrainCrossing| {
            crossing
                .track
                .as_ref()
                .map_or(1.0, |track| track.rail.flexural_rigidity)
        };
        let softness = rigidity(&self.crossing) / rigidity(crossing);
        list.extend([h, 0.5 * h, 1.0 / h, softness]);
        let wheels = assembly.wheels();
        for (wheel, law) in wheels.iter().zip(&self.laws) {
            list.extend(wheel_numbers(crossing, wheel, *law));
        }
        list.extend(&factor.inverse);
        list.extend(factor.lower.iter().map(|l| -l));
        list.extend(self.pattern.by_columns(&factor, 0..self.size()).map(|l| -l));
        list.extend(self.pattern.whole_stiffness(k).map(|k| -k));
        list.extend(self.pattern.whole_mass(m).map(|m| 2.0 / h * m));
        self.outputs
            .collect(crossing, &assembly, &wheels, &mut list);
        list.extend(self.start(crossing, &assembly, &lower)?);
        debug_assert_eq!(list.len(), self.layout.size);
        Some(list)
    }

    /// h of a crossing (s).
    fn step(&self, crossing: &TrainCrossing) -> f64 {
        self.crossing.time_step * self.crossing.speed / crossing.speed
    }

    /// The displacements at rest under the train at its first place, on a smooth track.
    fn start(
        &self,
        crossing: &TrainCrossing,
        assembly: &Assembly,
        lower: &Lower,
    ) -> Option<Vec<f64>> {
        let after_cars = self.track.start;
        let mut rigid = lower.stiffness.clone();
        for row in 0..after_cars {
            for (place, column) in self.pattern.lower_row(row) {
                rigid[place] = if column == row { 1.0 } else { 0.0 };
            }
        }
        let factor: Factor = self.pattern.factorise(&rigid)?;
        let wheels = assembly.wheels();
        let places: Vec<Place> = wheels
            .iter()
            .map(|wheel| assembly.place(-crossing.approach - wheel.behind))
            .collect::<Option<_>>()?;
        let mut u = vec![0.0; self.size()];
        for (wheel, place) in wheels.iter().zip(&places) {
            for (row, share) in &place.terms {
                u[*row] -= share * wheel.wheel.weight;
            }
        }
        self.pattern.solve(&factor, &mut u);
        for (index, car) in assembly.cars.iter().enumerate() {
            let heights: Vec<f64> = wheels
                .iter()
                .zip(&places)
                .filter(|(wheel, _)| wheel.car == index && wheel.row.is_some())
                .map(|(wheel, place)| {
                    let rail: f64 = place.terms.iter().map(|(row, share)| share * u[*row]).sum();
                    rail - place.flexibility * wheel.wheel.weight
                })
                .collect();
            for (k, row) in car.bodies.carried().iter().enumerate() {
                u[car.first + k] = row.iter().zip(&heights).map(|(a, b)| a * b).sum();
            }
        }
        Some(u)
    }

    /// How a car's coordinates follow the irregularity under its wheels at the start, `[row][wheel of the car]`;
    /// nothing where the train starts level.
    pub fn lifted(&self) -> Vec<Vec<Vec<f64>>> {
        match self.crossing.initial_state {
            InitialState::Level => Vec::new(),
            InitialState::Profile => self
                .crossing
                .cars
                .iter()
                .map(|placed| placed.car.multibody(self.crossing.gravity).carried())
                .collect(),
        }
    }
}

impl TrainCrossing {
    /// The first wheel's place in the middle of step n (m); of the step that serves the last time only, its start.
    pub fn middle(&self, step: usize) -> f64 {
        let half = if step < self.steps { 0.5 } else { 0.0 };
        self.speed * self.time_step * (step as f64 + half) - self.approach
    }

    /// The recorded times (s).
    pub fn times(&self) -> Vec<f64> {
        (0..=self.steps)
            .step_by(self.record_every)
            .map(|n| n as f64 * self.time_step)
            .collect()
    }
}

/// A = 2M/h + C + h K/2.
pub(super) fn dynamic(lower: &Lower, h: f64) -> Vec<f64> {
    let parts = lower.mass.iter().zip(&lower.damping).zip(&lower.stiffness);
    parts
        .map(|((m, c), k)| 2.0 / h * m + c + 0.5 * h * k)
        .collect()
}

fn law(crossing: &TrainCrossing, wheel: &TrainWheel) -> Law {
    if wheel.row.is_none() {
        return Law::Force;
    }
    match (wheel.wheel.tyre_stiffness, crossing.contact) {
        (Some(_), _) | (None, Contact::Rigid | Contact::Linear { .. }) => Law::Linear,
        (None, Contact::Hertz { .. }) => Law::Hertz,
    }
}

/// W, δ_W, softness or G of the whole axle, 1/W.
fn wheel_numbers(crossing: &TrainCrossing, wheel: &TrainWheel, law: Law) -> [f64; OF_WHEEL] {
    let weight = wheel.wheel.weight;
    let [compression, softness] = match law {
        Law::Force => [0.0, 0.0],
        Law::Linear => {
            let softness = match (wheel.wheel.tyre_stiffness, crossing.contact) {
                (Some(stiffness), _) | (None, Contact::Linear { stiffness }) => 1.0 / stiffness,
                (None, Contact::Rigid | Contact::Hertz { .. }) => 0.0,
            };
            [weight * softness, softness]
        }
        Law::Hertz => {
            let Contact::Hertz { constant } = crossing.contact else {
                unreachable!("points differ in numbers, not in laws")
            };
            // F = 2 (δ/G)^(3/2).
            let axle = constant / 2f64.cbrt().powi(2);
            [axle * weight.cbrt().powi(2), axle]
        }
    };
    [weight, compression, softness, 1.0 / weight]
}
