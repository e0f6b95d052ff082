//! Cells in a space of a few random variables.

use super::cumulative::Cumulative;
use super::neighbours::Neighbours;
use super::quadratics::{Quadratics, neighbours_of, terms_of};
use crate::density::known::{KnownPoints, Scale};
use crate::density::rule::{Extent, Fit, Rule, Sample, Smoothed};
use crate::density::smoother::SmoothingError;
use crate::density::{Nodes, Spread};
use rayon::prelude::*;

/// The most variables.
const MOST_VARIABLES: usize = 3;
/// Parts of the space along one axis, for two and for three variables.
const PARTS: [usize; 2] = [128, 40];
/// A trapezoid's slopes take at least this part of its base.
const STEEPEST: f64 = 1e-4;

/// The cells of points in a space, on every choice of scales.
pub struct CellSpace {
    choices: Vec<OnScales>,
}

/// The cells where each variable has its scale.
struct OnScales {
    dimensions: usize,
    quadratics: Quadratics,
    /// Half a part's extent on each axis.
    half: Vec<f64>,
    /// Of each part the nearest point, the distance of the part's mean from it, the probability.
    nearest: Vec<u32>,
    distance: Vec<f64>,
    mass: Vec<f64>,
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
                OnScales::new(points, &scales)
            })
            .collect();
        Ok(CellSpace { choices })
    }
}

impl OnScales {
    fn new(points: &KnownPoints, scales: &[Scale]) -> Self {
        let dimensions = scales.len();
        let coordinates: Vec<f64> = points
            .variables
            .chunks_exact(dimensions)
            .flat_map(|point| point.iter().zip(scales).map(|(x, s)| s.coordinate(*x)))
            .collect();
        let search = Neighbours::new(&coordinates, dimensions);
        let along = PARTS[dimensions - 2];
        let axes: Vec<Axis> = scales
            .iter()
            .map(|scale| Axis::new(*scale, along))
            .collect();
        let parts = along.pow(dimensions as u32);
        let (mut nearest, mut mass) = (vec![0; parts], vec![1.0; parts]);
        let mut distance = vec![0.0; parts * dimensions];
        nearest
            .par_iter_mut()
            .zip(&mut mass)
            .zip(distance.par_chunks_mut(dimensions))
            .enumerate()
            .for_each_init(Vec::new, |found, (part, ((nearest, mass), distance))| {
                let mut rest = part;
                for (place, axis) in distance.iter_mut().zip(&axes) {
                    *place = axis.means[rest % along];
                    *mass *= axis.masses[rest % along];
                    rest /= along;
                }
                search.nearest(distance, 1, found);
                *nearest = found[0].1;
                let point = &coordinates[*nearest as usize * dimensions..];
                for (d, coordinate) in distance.iter_mut().zip(point) {
                    *d -= coordinate;
                }
            });
        OnScales {
            dimensions,
            quadratics: Quadratics::new(&coordinates, dimensions),
            half: axes.iter().map(|axis| 0.5 * axis.spacing).collect(),
            nearest,
            distance,
            mass,
        }
    }

    /// The image of every part.
    fn images(&self, responses: &[f64], coefficients: &[f64]) -> Vec<Trapezoid> {
        let terms = terms_of(self.dimensions);
        let parts = self.nearest.iter().zip(&self.mass);
        parts
            .zip(self.distance.chunks_exact(self.dimensions))
            .map(|((point, mass), distance)| {
                let point = *point as usize;
                let own = &coefficients[point * terms..(point + 1) * terms];
                let (bent, half) = (&own[self.dimensions..], &self.half);
                let (rise, slopes) = value_and_slopes(own, bent, distance);
                Trapezoid::new(responses[point] + rise, &slopes, half, *mass)
            })
            .collect()
    }
}

/// The quadratic less its constant, and its slopes.
fn value_and_slopes(
    linear: &[f64],
    bent: &[f64],
    distance: &[f64],
) -> (f64, [f64; MOST_VARIABLES]) {
    let mut slopes = [0.0; MOST_VARIABLES];
    let mut value = 0.0;
    let mut at = 0;
    for i in 0..distance.len() {
        slopes[i] += linear[i];
        value += linear[i] * distance[i];
        for j in i..distance.len() {
            value += bent[at] * distance[i] * distance[j];
            slopes[i] += bent[at] * distance[j];
            slopes[j] += bent[at] * distance[i];
            at += 1;
        }
    }
    (value, slopes)
}

/// An axis in equal parts on its scale: of each the mean coordinate and the probability.
struct Axis {
    spacing: f64,
    means: Vec<f64>,
    masses: Vec<f64>,
}

impl Axis {
    fn new(scale: Scale, parts: usize) -> Self {
        let [start, end] = scale.ends();
        let spacing = (end - start) / parts as f64;
        let edge = |part: usize| start + part as f64 * spacing;
        let below = |part: usize| scale.share(edge(part));
        let total = below(parts) - below(0);
        Axis {
            spacing,
            means: (0..parts)
                .map(|part| scale.mean_between(edge(part), edge(part + 1)))
                .collect(),
            masses: (0..parts)
                .map(|part| (below(part + 1) - below(part)) / total)
                .collect(),
        }
    }
}

/// The sum of two uniform variables of half-widths a ≥ b about a centre.
struct Trapezoid {
    centre: f64,
    a: f64,
    b: f64,
    mass: f64,
}

impl Trapezoid {
    /// The image of a part by its slopes. Of more than two axes the smaller ones widen the largest, by
    /// variance.
    fn new(centre: f64, slopes: &[f64], half: &[f64], mass: f64) -> Self {
        let (mut a, mut b, mut rest) = (0.0f64, 0.0f64, 0.0);
        for (slope, half) in slopes.iter().zip(half) {
            let mut extent = (slope * half).abs();
            if extent > a {
                std::mem::swap(&mut a, &mut extent);
            }
            if extent > b {
                std::mem::swap(&mut b, &mut extent);
            }
            rest += extent * extent;
        }
        let a = (a * a + rest).sqrt();
        Trapezoid {
            centre,
            a,
            b: b.max(STEEPEST * a),
            mass,
        }
    }

    fn least(&self) -> f64 {
        self.centre - self.a - self.b
    }

    fn largest(&self) -> f64 {
        self.centre + self.a + self.b
    }

    /// The share below y, for a y inside.
    fn below(&self, y: f64) -> f64 {
        let (a, b) = (self.a, self.b);
        let from_end = a + b - (y - self.centre).abs();
        let tail = if from_end < 2.0 * b {
            from_end * from_end / (8.0 * a * b)
        } else {
            (from_end - b) / (2.0 * a)
        };
        if y < self.centre { tail } else { 1.0 - tail }
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
        let values = sample.each();
        let mut best = (f64::INFINITY, &self.choices[0], Vec::new());
        let mut coefficients = Vec::new();
        for choice in &self.choices {
            let missed = choice.quadratics.coefficients(values, &mut coefficients);
            if missed < best.0 || best.2.is_empty() {
                best = (missed, choice, std::mem::take(&mut coefficients));
            }
        }
        Box::new(Images(best.1.images(values, &best.2)))
    }
}

struct Images(Vec<Trapezoid>);

impl Fit for Images {
    fn width(&self) -> f64 {
        0.0
    }

    fn extent(&self) -> Extent {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, largest) = self.0.iter().fold(none, |(least, largest), image| {
            (least.min(image.least()), largest.max(image.largest()))
        });
        Extent {
            least,
            largest,
            spacing: f64::INFINITY,
            edged: true,
        }
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        let mut sum = Cumulative::new(nodes);
        for image in &self.0 {
            let (least, largest) = (image.least(), image.largest());
            sum.add(image.mass, least, largest, |y| image.below(y));
        }
        Smoothed {
            curve: sum.curve(),
            width: 0.0,
        }
    }
}
