//! Cells on a line: one random variable.

mod gaussians;
mod pieces;

use crate::density::known::{KnownPoints, Scale};
use crate::density::rule::{Fit, Rule, Sample};
use crate::density::smoother::SmoothingError;
use crate::density::{CellKernel, Spread};
use crate::probability::cumulative;
use gaussians::CellGaussians;
use pieces::Pieces;

/// The least number of points: a quadratic, and one more to choose the scale by.
const LEAST_POINTS: usize = 4;

/// The cells of points on a line, in ascending order.
pub struct CellLine {
    kernel: CellKernel,
    /// The points' numbers.
    order: Vec<usize>,
    on_scale: Vec<OnScale>,
}

/// The cells on one scale.
struct OnScale {
    scale: Scale,
    /// Of each point.
    coordinate: Vec<f64>,
    /// Cell k lies between edges k and k + 1.
    edges: Vec<f64>,
    /// The probability below each edge.
    below: Vec<f64>,
}

impl CellLine {
    /// Points of the same variable are taken as one, the first.
    pub fn new(points: &KnownPoints, kernel: CellKernel) -> Result<Self, SmoothingError> {
        let variable = points.variable(0);
        let mut order: Vec<usize> = (0..points.count).collect();
        order.sort_by(|a, b| variable[*a].total_cmp(&variable[*b]));
        let apart = |a: f64, b: f64| Scale::ALL.iter().all(|s| s.coordinate(a) < s.coordinate(b));
        order.dedup_by(|b, a| !apart(variable[*a], variable[*b]));
        if order.len() < LEAST_POINTS {
            return Err(SmoothingError::TooFewPoints {
                points: order.len(),
                least: LEAST_POINTS,
            });
        }
        let sorted: Vec<f64> = order.iter().map(|k| variable[*k]).collect();
        let on_scale = Scale::ALL.map(|scale| OnScale::new(scale, &sorted)).into();
        Ok(CellLine {
            kernel,
            order,
            on_scale,
        })
    }
}

impl OnScale {
    fn new(scale: Scale, sorted: &[f64]) -> Self {
        let [start, end] = scale.ends();
        let uniform: Vec<f64> = sorted.iter().map(|x| cumulative(*x)).collect();
        let mut edges = vec![start];
        edges.extend(
            uniform
                .windows(2)
                .map(|u| scale.at_share(0.5 * (u[0] + u[1]))),
        );
        edges.push(end);
        let mut below: Vec<f64> = edges.iter().map(|edge| scale.share(*edge)).collect();
        // What lies beyond the ends of the scale belongs to the outer cells.
        below[0] = 0.0;
        below[sorted.len()] = 1.0;
        OnScale {
            scale,
            coordinate: sorted.iter().map(|x| scale.coordinate(*x)).collect(),
            edges,
            below,
        }
    }

    /// The quadratic about each point, through it and its neighbours; with the mean error of the value
    /// that it foretells beyond.
    fn quadratics(&self, responses: &[f64]) -> (Vec<Quadratic>, f64) {
        let (z, g) = (&self.coordinate, responses);
        let last = z.len() - 1;
        let inner = |k: usize| {
            let (before, after) = (z[k] - z[k - 1], z[k + 1] - z[k]);
            let slopes = [(g[k] - g[k - 1]) / before, (g[k + 1] - g[k]) / after];
            let bend = (slopes[1] - slopes[0]) / (before + after);
            Quadratic {
                value: g[k],
                slope: slopes[0] + bend * before,
                bend,
            }
        };
        let mut all = Vec::with_capacity(z.len());
        all.push(inner(1).about(z[0] - z[1]));
        all.extend((1..last).map(inner));
        all.push(inner(last - 1).about(z[last] - z[last - 1]));
        let errors = (1..last - 1).map(|k| (all[k].at(z[k + 2] - z[k]) - g[k + 2]).abs());
        let error = errors.sum();
        (all, error)
    }
}

/// A + B δ + C δ², δ a distance on the scale.
#[derive(Clone, Copy)]
struct Quadratic {
    value: f64,
    slope: f64,
    bend: f64,
}

impl Quadratic {
    #[inline(always)]
    fn at(self, distance: f64) -> f64 {
        self.value + distance * (self.slope + distance * self.bend)
    }

    /// The same about another place.
    fn about(self, distance: f64) -> Self {
        Quadratic {
            value: self.at(distance),
            slope: self.slope + 2.0 * self.bend * distance,
            bend: self.bend,
        }
    }

    /// Where y is met on the side where the quadratic rises (`side` 1) or falls (−1).
    #[inline(always)]
    fn meets(self, y: f64, side: f64) -> f64 {
        let above = y - self.value;
        let slope = (self.slope * self.slope + 4.0 * self.bend * above)
            .max(0.0)
            .sqrt();
        // Of the two forms the one in which nothing cancels.
        if above == 0.0 && slope == 0.0 {
            0.0
        } else if side * self.slope >= 0.0 {
            2.0 * above / (self.slope + side * slope)
        } else {
            (side * slope - self.slope) / (2.0 * self.bend)
        }
    }

    /// Where the quadratic turns, if between `from` and `to`.
    #[inline(always)]
    fn turn(self, from: f64, to: f64) -> Option<f64> {
        // Its slopes at the ends then differ in sign.
        let slope = |distance: f64| self.slope + 2.0 * self.bend * distance;
        if slope(from) * slope(to) >= 0.0 {
            return None;
        }
        let turn = -0.5 * self.slope / self.bend;
        (turn > from && turn < to).then_some(turn)
    }
}

impl Rule for CellLine {
    fn needs_points(&self) -> bool {
        true
    }

    fn first_width(&self, spread: &Spread) -> f64 {
        spread.deviation
    }

    fn fit<'a>(&'a self, sample: &'a Sample<'a>) -> Box<dyn Fit + 'a> {
        let values = sample.each();
        let responses: Vec<f64> = self.order.iter().map(|k| values[*k]).collect();
        let fits = self.on_scale.iter().map(|on| {
            let (quadratics, error) = on.quadratics(&responses);
            (on, quadratics, error)
        });
        let (on, quadratics, _) = fits
            .min_by(|a, b| a.2.total_cmp(&b.2))
            .expect("there are scales");
        let image = Image { on, quadratics };
        match self.kernel {
            CellKernel::Quadratic => Box::new(Pieces::new(&image)),
            CellKernel::Gaussian => {
                let range = sample.largest - sample.least;
                Box::new(CellGaussians::new(&image, range))
            }
        }
    }
}

/// The quadratics of all cells at one time.
struct Image<'a> {
    on: &'a OnScale,
    quadratics: Vec<Quadratic>,
}

impl Image<'_> {
    /// Each cell's quadratic, its ends from there, and the index.
    fn cells(&self) -> impl Iterator<Item = (Quadratic, f64, f64, usize)> + '_ {
        let OnScale {
            coordinate, edges, ..
        } = self.on;
        let quadratics = self.quadratics.iter().enumerate();
        quadratics.map(|(k, q)| {
            (
                *q,
                edges[k] - coordinate[k],
                edges[k + 1] - coordinate[k],
                k,
            )
        })
    }
}
