//! Cells in a space of a few random variables.

use super::cumulative::Cumulative;
use super::neighbours::Neighbours;
use super::quadratics::{Quadratics, neighbours_of, terms_of};
use crate::density::known::{KnownPoints, Scale};
use crate::density::rule::{Extent, Fit, Rule, Sample, Smoothed};
use crate::density::smoother::SmoothingError;
use crate::density::{Nodes, Spread};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The most variables.
const MOST_VARIABLES: usize = 3;
/// Parts of the space along one axis, for two and for three variables.
const PARTS: [usize; 2] = [128, 40];
/// A trapezoid's slopes take at least this part of its base.
const STEEPEST: f64 = 1e-4;

/// The cells of points in a space, on every choice of scales.
pub struct CellSpace {
    choices: Vec<OnScales>,
    /// The choice that was best last.
    likely: AtomicUsize,
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
        Ok(CellSpace {
            choices,
            likely: AtomicUsize::new(0),
        })
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
            .for_each_init(
                || 0,
                |guess, (part, ((nearest, mass), distance))| {
                    let mut rest = part;
                    for (place, axis) in distance.iter_mut().zip(&axes) {
                        *place = axis.means[rest % along];
                        *mass *= axis.masses[rest % along];
                        rest /= along;
                    }
                    *guess = search.nearest_one(distance, *guess);
                    *nearest = *guess;
                    let point = &coordinates[*nearest as usize * dimensions..];
                    for (d, coordinate) in distance.iter_mut().zip(point) {
                        *d -= coordinate;
                    }
                },
            );
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
        let arch = pulp::Arch::new();
        match self.dimensions {
            2 => arch.dispatch(Imaging::<2> {
                on: self,
                responses,
                coefficients,
            }),
            _ => arch.dispatch(Imaging::<3> {
                on: self,
                responses,
                coefficients,
            }),
        }
    }
}

/// The work of [`OnScales::images`] in N dimensions, for the machine's vector units.
struct Imaging<'a, const N: usize> {
    on: &'a OnScales,
    responses: &'a [f64],
    coefficients: &'a [f64],
}

impl<const N: usize> WithSimd for Imaging<'_, N> {
    type Output = Vec<Trapezoid>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Trapezoid> {
        let on = self.on;
        let terms = terms_of(N);
        let half: [f64; N] = std::array::from_fn(|axis| on.half[axis]);
        let parts = on.nearest.iter().zip(&on.mass);
        let mut images = Vec::with_capacity(on.nearest.len());
        for ((point, mass), distance) in parts.zip(on.distance.as_chunks::<N>().0) {
            let point = *point as usize;
            let own = &self.coefficients[point * terms..(point + 1) * terms];
            let (rise, slopes) = value_and_slopes(own, distance);
            let centre = self.responses[point] + rise;
            images.push(Trapezoid::new(centre, &slopes, &half, *mass));
        }
        images
    }
}

/// The quadratic less its constant, and its slopes.
#[inline(always)]
fn value_and_slopes<const N: usize>(terms: &[f64], distance: &[f64; N]) -> (f64, [f64; N]) {
    let (linear, bent) = terms.split_at(N);
    let mut slopes = [0.0; N];
    let mut value = 0.0;
    let mut at = 0;
    for i in 0..N {
        slopes[i] += linear[i];
        value += linear[i] * distance[i];
        for j in i..N {
            value += bent[at] * distance[i] * distance[j];
            slopes[i] += bent[at] * distance[j];
            slopes[j] += bent[at] * distance[i];
            at += 1;
        }
    }
    (value, slopes)
}

/// The sum of all images.
struct Summing<'a> {
    images: &'a [Trapezoid],
    sum: Cumulative,
}

impl WithSimd for Summing<'_> {
    type Output = Cumulative;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Cumulative {
        for image in self.images {
            let (least, largest) = (image.least(), image.largest());
            let below = image.below();
            self.sum.add(image.mass, least, largest, below);
        }
        self.sum
    }
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
    #[inline(always)]
    fn new(centre: f64, slopes: &[f64], half: &[f64], mass: f64) -> Self {
        let (mut a, mut b, mut rest) = (0.0f64, 0.0f64, 0.0);
        for (slope, half) in slopes.iter().zip(half) {
            let extent = (slope * half).abs();
            let (larger, extent) = if extent > a { (extent, a) } else { (a, extent) };
            let (middle, extent) = if extent > b { (extent, b) } else { (b, extent) };
            (a, b) = (larger, middle);
            rest += extent * extent;
        }
        let a = if slopes.len() > 2 {
            (a * a + rest).sqrt()
        } else {
            a
        };
        Trapezoid {
            centre,
            a,
            b: b.max(STEEPEST * a),
            mass,
        }
    }

    #[inline(always)]
    fn least(&self) -> f64 {
        self.centre - self.a - self.b
    }

    #[inline(always)]
    fn largest(&self) -> f64 {
        self.centre + self.a + self.b
    }

    /// The share below a value inside.
    #[inline(always)]
    fn below(&self) -> impl Fn(f64) -> f64 {
        let (centre, b, half) = (self.centre, self.b, self.a + self.b);
        let (per_linear, per_square) = (0.5 / self.a, 0.125 / (self.a * self.b));
        #[inline(always)]
        move |y: f64| {
            let from_end = half - (y - centre).abs();
            let (bent, straight) = (
                from_end * from_end * per_square,
                (from_end - b) * per_linear,
            );
            let tail = if from_end < 2.0 * b { bent } else { straight };
            if y < centre { tail } else { 1.0 - tail }
        }
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
        // The last one's choice is mostly the best again: the others are then soon given up. Which one is
        // looked at first makes no difference.
        let likely = self.likely.load(Ordering::Relaxed);
        let mut order: Vec<usize> = (0..self.choices.len()).collect();
        order.swap(0, likely);
        let mut best = (f64::INFINITY, usize::MAX, Vec::new());
        let mut coefficients = Vec::new();
        for number in order {
            let quadratics = &self.choices[number].quadratics;
            let missed = quadratics.coefficients(values, best.0, &mut coefficients);
            if best.1 == usize::MAX || (missed, number) < (best.0, best.1) {
                best = (missed, number, std::mem::take(&mut coefficients));
            }
        }
        let (_, number, coefficients) = best;
        self.likely.store(number, Ordering::Relaxed);
        Box::new(Images(self.choices[number].images(values, &coefficients)))
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
        let sum = pulp::Arch::new().dispatch(Summing {
            images: &self.0,
            sum: Cumulative::new(nodes),
        });
        Smoothed {
            curve: sum.curve(),
            width: 0.0,
        }
    }
}
