//! Cells on a line: one random variable.

use super::cumulative::Cumulative;
use crate::density::known::{KnownPoints, Scale};
use crate::density::rule::{Extent, Fit, Rule, Sample, Smoothed};
use crate::density::smoother::SmoothingError;
use crate::density::{CellKernel, Nodes, Spread};
use crate::probability::{cumulative, density};
use pulp::{Simd, WithSimd};
use std::sync::LazyLock;

/// The least number of points: a quadratic, and one more to choose the scale by.
const LEAST_POINTS: usize = 4;
/// Gaussians are at least this part of the responses' range wide.
const NARROWEST: f64 = 1e-9;
/// They are cut at this many widths.
const REACH: f64 = 8.0;

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
struct Pieces {
    scale: Scale,
    pieces: Vec<Piece>,
}

impl Pieces {
    fn new(image: &Image<'_>) -> Self {
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

/// Φ from a table over the reach of the Gaussians, by cubics with its slopes: to 2e-11.
struct NormalTable(Vec<[f64; 2]>);

/// Places of the table from 0 to 1.
const TABLE_PER_UNIT: f64 = 128.0;

static TABLE: LazyLock<NormalTable> = LazyLock::new(|| {
    let places = (2.0 * REACH * TABLE_PER_UNIT) as usize;
    let at = |k: usize| k as f64 / TABLE_PER_UNIT - REACH;
    let row = |x: f64| [cumulative(x), density(x) / TABLE_PER_UNIT];
    NormalTable((0..=places).map(|k| row(at(k))).collect())
});

impl NormalTable {
    #[inline(always)]
    fn at(&self, x: f64) -> f64 {
        let place = ((x + REACH) * TABLE_PER_UNIT).max(0.0);
        let below = (place as usize).min(self.0.len() - 2);
        let t = (place - below as f64).min(1.0);
        let ([a, slope_a], [b, slope_b]) = (self.0[below], self.0[below + 1]);
        let rise = b - a;
        let bend = 3.0 * rise - 2.0 * slope_a - slope_b;
        a + t * (slope_a + t * (bend + t * (slope_a + slope_b - 2.0 * rise)))
    }
}

/// (centre, width, mass) of each cell.
struct CellGaussians(Vec<(f64, f64, f64)>);

impl CellGaussians {
    fn new(image: &Image<'_>, range: f64) -> Self {
        let gaussian = |(q, from, to, k): (Quadratic, f64, f64, usize)| {
            let across = to - from;
            let width = 0.6
                * (q.slope * across)
                    .abs()
                    .max((q.bend * across * across).abs());
            let mass = image.on.below[k + 1] - image.on.below[k];
            (q.value, width.max(NARROWEST * range), mass)
        };
        CellGaussians(image.cells().map(gaussian).collect())
    }
}

impl Fit for CellGaussians {
    /// The widths' mean by the cells' probabilities.
    fn width(&self) -> f64 {
        self.0.iter().map(|(_, width, mass)| width * mass).sum()
    }

    fn extent(&self) -> Extent {
        let ends = self
            .0
            .iter()
            .map(|(g, h, _)| (g - REACH * h, g + REACH * h));
        let (least, largest) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), end| {
            (a.min(end.0), b.max(end.1))
        });
        Extent {
            least,
            largest,
            spacing: f64::INFINITY,
            edged: true,
        }
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        let sum = pulp::Arch::new().dispatch(SummingGaussians {
            gaussians: &self.0,
            table: &TABLE,
            sum: Cumulative::new(nodes),
        });
        Smoothed {
            curve: sum.curve(),
            width: self.width(),
        }
    }
}

/// The sum of all Gaussians, for the machine's vector units.
struct SummingGaussians<'a> {
    gaussians: &'a [(f64, f64, f64)],
    table: &'a NormalTable,
    sum: Cumulative,
}

impl WithSimd for SummingGaussians<'_> {
    type Output = Cumulative;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Cumulative {
        for (centre, width, mass) in self.gaussians {
            let (least, largest) = (centre - REACH * width, centre + REACH * width);
            let per_value = width.recip();
            let below = |y: f64| self.table.at((y - centre) * per_value);
            self.sum.add(*mass, least, largest, below);
        }
        self.sum
    }
}
