//! Cells in a space of a few random variables.

use super::parts::{FINENESS, Parts};
use super::quadratics::{Quadratics, neighbours_of};
use super::trapezoids::Trapezoids;
use crate::density::known::{KnownPoints, Scale};
use crate::density::rule::{Extent, Fit, Rule, Sample, Smoothed};
use crate::density::smoother::SmoothingError;
use crate::density::{Nodes, Spread};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The most variables.
const MOST_VARIABLES: usize = 3;
/// About so many points are looked at to choose the scales.
const LOOKED_AT: usize = 128;

/// The cells of points in a space, on every choice of scales.
pub struct CellSpace {
    choices: Vec<Choice>,
    /// The choice that was best last.
    likely: AtomicUsize,
}

/// A scale for each variable.
struct Choice {
    scales: Vec<Scale>,
    /// `[point][variable]`.
    coordinates: Vec<f64>,
    /// Of some points, to compare the choices by.
    some: Quadratics,
    /// Made when the choice is first taken.
    cells: OnceLock<Cells>,
}

/// Every point's quadratic, and the parts of its cell.
struct Cells {
    quadratics: Quadratics,
    parts: Parts,
}

impl CellSpace {
    pub fn new(points: &KnownPoints) -> Result<Self, SmoothingError> {
        let variables = points.dimensions;
        if variables > MOST_VARIABLES {
            return Err(SmoothingError::TooManyVariables {
                variables,
                most: MOST_VARIABLES,
            });
        }
        let least = neighbours_of(variables) + 1;
        if points.count < least {
            return Err(SmoothingError::TooFewPoints {
                points: points.count,
                least,
            });
        }
        let choices = (0..1usize << variables)
            .map(|choice| {
                let scales: Vec<Scale> = (0..variables)
                    .map(|axis| Scale::ALL[choice >> axis & 1])
                    .collect();
                Choice::new(points, scales)
            })
            .collect();
        Ok(CellSpace {
            choices,
            likely: AtomicUsize::new(0),
        })
    }

    /// The choice of scales whose quadratics miss least at the neighbours of their points.
    fn choose(&self, responses: &[f64]) -> &Choice {
        // The last one's choice is mostly the best again: the others are then soon given up. Which one is
        // looked at first makes no difference.
        let likely = self.likely.load(Ordering::Relaxed);
        let mut order: Vec<usize> = (0..self.choices.len()).collect();
        order.swap(0, likely);
        let mut best = (f64::INFINITY, usize::MAX);
        for number in order {
            let missed = self.choices[number].some.missed(responses, best.0);
            if best.1 == usize::MAX || (missed, number) < best {
                best = (missed, number);
            }
        }
        self.likely.store(best.1, Ordering::Relaxed);
        &self.choices[best.1]
    }
}

impl Choice {
    fn new(points: &KnownPoints, scales: Vec<Scale>) -> Self {
        let dimensions = scales.len();
        let coordinates: Vec<f64> = points
            .variables
            .chunks_exact(dimensions)
            .flat_map(|point| point.iter().zip(&scales).map(|(x, s)| s.coordinate(*x)))
            .collect();
        let each = points.count.div_ceil(LOOKED_AT);
        Choice {
            some: Quadratics::new(&coordinates, dimensions, each),
            scales,
            coordinates,
            cells: OnceLock::new(),
        }
    }

    fn cells(&self) -> &Cells {
        self.cells.get_or_init(|| {
            let dimensions = self.scales.len();
            let fineness = FINENESS[dimensions - 2];
            Cells {
                quadratics: Quadratics::new(&self.coordinates, dimensions, 1),
                parts: Parts::new(&self.coordinates, &self.scales, fineness),
            }
        })
    }
}

impl Rule for CellSpace {
    fn needs_points(&self) -> bool {
        true
    }

    fn first_width(&self, spread: &Spread) -> f64 {
        spread.deviation
    }

    fn fit<'a>(&'a self, sample: &'a Sample<'a>) -> Box<dyn Fit + 'a> {
        let responses = sample.each();
        let cells = self.choose(responses).cells();
        let coefficients = cells.quadratics.coefficients(responses);
        Box::new(Images(Trapezoids::new(
            &cells.parts,
            responses,
            &coefficients,
        )))
    }
}

struct Images<'a>(Trapezoids<'a>);

impl Fit for Images<'_> {
    fn width(&self) -> f64 {
        0.0
    }

    fn extent(&self) -> Extent {
        let [least, largest] = self.0.ends();
        Extent {
            least,
            largest,
            spacing: f64::INFINITY,
            edged: true,
        }
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        Smoothed {
            curve: self.0.curve(nodes),
            width: 0.0,
        }
    }
}
