//! Cells' images as positive Gaussians.

use super::{Image, Quadratic};
use crate::density::Nodes;
use crate::density::cell_image::cumulative::Cumulative;
use crate::density::rule::{Extent, Fit, Smoothed};
use crate::probability::{cumulative, density};
use pulp::{Simd, WithSimd};
use std::sync::LazyLock;

/// Gaussians are at least this part of the responses' range wide.
const NARROWEST: f64 = 1e-9;
/// They are cut at this many widths.
const REACH: f64 = 8.0;

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
pub(super) struct CellGaussians(Vec<(f64, f64, f64)>);

impl CellGaussians {
    pub fn new(image: &Image<'_>, range: f64) -> Self {
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
