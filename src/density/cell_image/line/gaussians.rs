//! Cells' images as positive Gaussians.

use super::{Image, Quadratic};
use crate::density::Nodes;
use crate::density::cell_image::cumulative::{Places, curve};
use crate::density::rule::{Extent, Fit, Smoothed};
use crate::probability::{cumulative, density};
use pulp::{Simd, WithSimd};
use std::sync::LazyLock;

/// Gaussians are at least this part of the responses' range wide.
const NARROWEST: f64 = 1e-9;
/// They are cut at this many widths: 1e-9 lies beyond at either side.
const REACH: f64 = 6.0;

/// Φ and φ at places over the reach of the Gaussians.
struct NormalTable {
    below: [f64; PLACES],
    density: [f64; PLACES],
}

/// Places of the table from 0 to 1: half a distance to the next place is 1/256, and the third order left
/// out 4e-9.
const TABLE_PER_UNIT: f64 = 128.0;
/// At least 2 [`REACH`] [`TABLE_PER_UNIT`] and one more, a power of two.
const PLACES: usize = 2048;
/// Where the whole numbers are a double's last bits.
const WHOLE: f64 = (1_u64 << 52) as f64;

static TABLE: LazyLock<Box<NormalTable>> = LazyLock::new(|| {
    let at = |k: usize| k as f64 / TABLE_PER_UNIT - REACH;
    Box::new(NormalTable {
        below: std::array::from_fn(|k| cumulative(at(k))),
        density: std::array::from_fn(|k| density(at(k))),
    })
});

impl NormalTable {
    /// Φ(x) of an x from -[`REACH`] on, to the second order about the place nearest to it.
    #[inline(always)]
    fn at(&self, x: f64) -> f64 {
        let x = x.min(REACH);
        let rounded = (x + REACH) * TABLE_PER_UNIT + WHOLE;
        let place = rounded.to_bits() as usize % PLACES;
        let nearest = (rounded - WHOLE) * (1.0 / TABLE_PER_UNIT) - REACH;
        let beyond = x - nearest;
        self.below[place] + self.density[place] * beyond * (1.0 - 0.5 * nearest * beyond)
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
        let places = Places::new(nodes);
        let sums = pulp::Arch::new().dispatch(Summing {
            gaussians: &self.0,
            table: &TABLE,
            places,
        });
        Smoothed {
            curve: curve(nodes, &sums),
            width: self.width(),
        }
    }
}

/// Places that are worked on side by side.
const TOGETHER: usize = 8;

/// F at the places, then the whole mass: the sum of all Gaussians, for the machine's vector units.
struct Summing<'a> {
    gaussians: &'a [(f64, f64, f64)],
    table: &'a NormalTable,
    places: Places,
}

impl WithSimd for Summing<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<f64> {
        let places = self.places;
        // Within the reach of a Gaussian, and what has come whole before a place.
        let mut within = vec![0.0; places.count + TOGETHER];
        let mut whole = vec![0.0; places.count + TOGETHER + 1];
        for (centre, width, mass) in self.gaussians {
            let first = places.from(centre - REACH * width);
            let last = places.from(centre + REACH * width);
            let per_value = width.recip();
            let mut x = (places.value(first) - centre) * per_value;
            let step = places.spacing * per_value;
            let chunks = (last - first).div_ceil(TOGETHER);
            let until = first + chunks * TOGETHER;
            for sums in within[first..until].as_chunks_mut::<TOGETHER>().0 {
                let below: [f64; TOGETHER] =
                    std::array::from_fn(|k| self.table.at(x + k as f64 * step));
                *sums = std::array::from_fn(|k| sums[k] + mass * below[k]);
                x += TOGETHER as f64 * step;
            }
            whole[until] += mass;
        }
        let mut before = 0.0;
        let mut below: f64 = 0.0;
        let sums = within[..places.count]
            .iter()
            .zip(&whole)
            .map(|(sum, whole)| {
                before += whole;
                below = below.max(before + sum);
                below
            });
        let mut sums: Vec<f64> = sums.collect();
        sums.push(self.gaussians.iter().map(|(.., mass)| mass).sum());
        sums
    }
}
