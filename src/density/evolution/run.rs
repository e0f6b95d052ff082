//! All points over all times, from a stream of blocks.

use super::scheme::{Parcel, Scratch, moments_of};
use super::survey::{Survey, points_of};
use super::{Mesh, Options, Transport};
use crate::density::{self, Curve, Grid, Nodes, Smoother, TimeDensity, WidthRule};
use crate::response::{Block, Responses};
use crate::{Result, interrupt};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Points whose probability is summed together, one after the other; these sums are then summed in order.
const STRIP: usize = 16;
/// Strips and times whose sums are held at a time.
const STRIPS: usize = 32;
const TIMES: usize = 32;
/// Nodes about the range of the responses at a time that may hold probability too.
const MARGIN: f64 = 64.0;

/// What a density evolution will do, before it is done.
pub struct Plan<'a> {
    source: &'a dyn Responses,
    transport: Transport,
    options: Options,
    survey: Survey,
    /// Between records (s).
    step: f64,
    /// `None` where nothing moves.
    pub mesh: Option<Mesh>,
}

impl<'a> Plan<'a> {
    /// Looks at the responses once. The times, two or more, are `step` (s) apart ([`super::even_step`]).
    pub fn new(
        source: &'a dyn Responses,
        transport: Transport,
        options: Options,
        step: f64,
    ) -> Result<Plan<'a>> {
        let survey = Survey::new(source, &transport, step)?;
        let mesh = Mesh::new(&survey.extent, &options, transport.safe);
        Ok(Plan {
            source,
            transport,
            options,
            survey,
            step,
            mesh,
        })
    }

    /// Nodes over the range of the responses at all times.
    pub fn nodes(&self) -> f64 {
        let extent = self.survey.extent;
        self.mesh
            .map_or(0.0, |mesh| (extent.largest - extent.least) / mesh.spacing)
    }

    /// The most steps between two records.
    pub fn steps(&self) -> f64 {
        let farthest = self.survey.extent.farthest;
        self.mesh.map_or(0.0, |mesh| {
            steps(farthest / mesh.spacing, self.options.courant)
        })
    }

    /// The memory that the densities of all times take (bytes).
    pub fn bytes(&self) -> f64 {
        let nodes = |mesh: Mesh| -> f64 {
            let of_time = |(least, largest): &(f64, f64)| (largest - least) / mesh.spacing + MARGIN;
            self.survey.ranges.iter().map(of_time).sum()
        };
        self.mesh.map_or(0.0, nodes) * size_of::<f64>() as f64
    }

    /// Moves the probability of all points through all times; `None` where nothing moves.
    pub fn run(&self) -> Result<Option<Evolved>> {
        let Some(mesh) = self.mesh else {
            return Ok(None);
        };
        let flow = Flow {
            plan: self,
            mesh,
            safe: mesh.within(self.transport.safe),
        };
        let mut travellers = vec![Traveller::default(); self.source.probability().len()];
        let mut rows = vec![Row::default(); self.source.times().len()];
        let moved = self.transport.velocity.unwrap_or(self.transport.quantity);
        self.source.scan(&[moved], &mut |blocks| {
            let groups = by_points(blocks);
            for strips in strips(&mut travellers, &groups).chunks_mut(STRIPS) {
                let most = strips.iter().map(|s| s.blocks.len()).max().unwrap_or(0);
                for part in 0..most.div_ceil(TIMES) {
                    interrupt::check()?;
                    let sums: Vec<Sums> = strips
                        .par_iter_mut()
                        .map(|strip| flow.advance(strip, part))
                        .collect();
                    add(&mut rows, &sums);
                }
            }
            Ok(())
        })?;
        Ok(Some(Evolved { mesh, rows }))
    }
}

/// The least number of equal steps for a motion of r nodes.
fn steps(r: f64, courant: f64) -> f64 {
    /// The mesh is made for one step of exactly the Courant number.
    const ROUNDING: f64 = 1e-9;
    (r.abs() / courant - ROUNDING).ceil().max(1.0)
}

/// A point on its way: its probability, and its response or velocity at the last time.
#[derive(Debug, Clone, Default)]
struct Traveller {
    parcel: Parcel,
    earlier: f64,
}

/// Consecutive points with their blocks, in which they start at `offset`.
struct Strip<'s, 'b> {
    first_point: usize,
    offset: usize,
    travellers: &'s mut [Traveller],
    blocks: &'s [&'b Block<'b>],
}

/// The probability on nodes at one time.
#[derive(Debug, Clone, Default, PartialEq)]
struct Row {
    first: i64,
    masses: Vec<f64>,
    /// Σ P_q times the variance of the point's own probability, in nodes².
    scatter: f64,
}

/// The rows of a strip, from a time on.
struct Sums {
    time: usize,
    rows: Vec<Row>,
}

/// The blocks by their points, times ascending.
fn by_points<'b>(blocks: &'b [Block<'b>]) -> Vec<Vec<&'b Block<'b>>> {
    let mut groups: BTreeMap<usize, Vec<&Block<'_>>> = BTreeMap::new();
    for block in blocks {
        groups.entry(block.first_point).or_default().push(block);
    }
    groups.into_values().collect()
}

fn strips<'s, 'b>(
    travellers: &'s mut [Traveller],
    groups: &'s [Vec<&'b Block<'b>>],
) -> Vec<Strip<'s, 'b>> {
    let mut strips = Vec::new();
    let mut rest = travellers;
    let mut before = 0;
    for blocks in groups {
        let points = points_of(blocks[0]);
        let (_, from) = rest.split_at_mut(points.start - before);
        let (these, after) = from.split_at_mut(points.len());
        (rest, before) = (after, points.end);
        for (k, travellers) in these.chunks_mut(STRIP).enumerate() {
            strips.push(Strip {
                first_point: points.start + k * STRIP,
                offset: k * STRIP,
                travellers,
                blocks,
            });
        }
    }
    strips
}

/// Adds the sums of strips, in their order, to the rows of all times.
fn add(rows: &mut [Row], sums: &[Sums]) {
    let filled = || sums.iter().filter(|sums| !sums.rows.is_empty());
    let first = filled().map(|sums| sums.time).min().unwrap_or(0);
    let end = filled().map(|sums| sums.time + sums.rows.len()).max();
    let rows = &mut rows[first..end.unwrap_or(first)];
    rows.par_iter_mut().enumerate().for_each(|(k, row)| {
        for sums in sums {
            let place = (first + k).checked_sub(sums.time);
            if let Some(part) = place.and_then(|place| sums.rows.get(place)) {
                row.add(part.first, &part.masses, 1.0);
                row.scatter += part.scatter;
            }
        }
    });
}

struct Flow<'a> {
    plan: &'a Plan<'a>,
    mesh: Mesh,
    /// The nodes that do not absorb.
    safe: (i64, i64),
}

impl Flow<'_> {
    /// Takes a strip through the times of a part of its blocks.
    fn advance(&self, strip: &mut Strip<'_, '_>, part: usize) -> Sums {
        let probability = &self.plan.source.probability()[strip.first_point..];
        let start = &self.plan.survey.start[strip.first_point..];
        let last = self.plan.source.times().len() - 1;
        let blocks = strip.blocks.chunks(TIMES).nth(part).unwrap_or(&[]);
        let mut scratch = Scratch::default();
        let mut rows = vec![Row::default(); blocks.len()];
        for (block, row) in blocks.iter().zip(&mut rows) {
            let values = &block.values[strip.offset..];
            for (k, traveller) in strip.travellers.iter_mut().enumerate() {
                if block.time == 0 {
                    traveller.parcel = Parcel::at(self.mesh.nearest(start[k]));
                    traveller.parcel.absorb(self.safe);
                    traveller.earlier = values[k];
                } else {
                    self.follow(traveller, values[k], &mut scratch);
                }
                let parcel = &mut traveller.parcel;
                row.add(parcel.first, &parcel.shares, probability[k]);
                let (left, _, variance) = moments_of(parcel.first, &parcel.shares);
                row.scatter += probability[k] * left * variance;
                if block.time == last {
                    *traveller = Traveller::default();
                }
            }
        }
        Sums {
            time: blocks.first().map_or(0, |block| block.time),
            rows,
        }
    }

    /// From the last time to that of `value`, a response or a velocity.
    fn follow(&self, traveller: &mut Traveller, value: f64, scratch: &mut Scratch) {
        let distance = match self.plan.transport.velocity {
            Some(_) => 0.5 * (traveller.earlier + value) * self.plan.step,
            None => value - traveller.earlier,
        };
        traveller.earlier = value;
        let r = distance / self.mesh.spacing;
        let count = steps(r, self.plan.options.courant);
        for _ in 0..count as usize {
            traveller.parcel.step(r / count, scratch);
            traveller.parcel.absorb(self.safe);
        }
    }
}

impl Row {
    /// Adds `weight` times these shares.
    fn add(&mut self, first: i64, shares: &[f64], weight: f64) {
        if shares.is_empty() {
            return;
        }
        if self.masses.is_empty() {
            self.first = first;
        }
        if first < self.first {
            let more = (self.first - first) as usize;
            self.masses.splice(..0, std::iter::repeat_n(0.0, more));
            self.first = first;
        }
        let offset = (first - self.first) as usize;
        if self.masses.len() < offset + shares.len() {
            self.masses.resize(offset + shares.len(), 0.0);
        }
        for (mass, share) in self.masses[offset..].iter_mut().zip(shares) {
            *mass += weight * share;
        }
    }

    fn total(&self) -> f64 {
        self.masses.iter().sum()
    }

    fn end(&self) -> i64 {
        self.first + self.masses.len() as i64
    }

    /// Density and integral on these nodes, a straight line between each two.
    fn curve(&self, mesh: Mesh, first: i64, count: usize) -> Curve {
        let mass = |j: usize| {
            let place = first + j as i64 - self.first;
            let mass = usize::try_from(place).ok().and_then(|k| self.masses.get(k));
            mass.copied().unwrap_or(0.0)
        };
        let mut below = 0.0;
        let mut cumulative = Vec::with_capacity(count);
        for j in 0..count {
            cumulative.push(below + 0.5 * mass(j));
            below += mass(j);
        }
        Curve {
            nodes: Nodes {
                start: mesh.value(first),
                spacing: mesh.spacing,
                count,
            },
            density: (0..count).map(|j| mass(j) / mesh.spacing).collect(),
            cumulative,
        }
    }
}

/// The density of a quantity at all times.
pub struct Evolved {
    pub mesh: Mesh,
    rows: Vec<Row>,
}

impl Evolved {
    /// The probability that no boundary has absorbed up to a time.
    pub fn left(&self, time: usize) -> f64 {
        self.rows[time].total()
    }

    /// The standard deviation that the mesh gives to a point's probability, in the quadratic mean over the
    /// points: what stands here for a smoothing width.
    pub fn width(&self, time: usize) -> f64 {
        let row = &self.rows[time];
        let left = row.total();
        if left > 0.0 {
            self.mesh.spacing * (row.scatter / left).sqrt()
        } else {
            0.0
        }
    }

    /// The mean of what is left.
    pub fn mean(&self, time: usize) -> f64 {
        let row = &self.rows[time];
        let (_, node, _) = moments_of(row.first, &row.masses);
        self.mesh.origin + node * self.mesh.spacing
    }

    /// The density with a node without probability at either end; `None` where nothing is left.
    pub fn curve(&self, time: usize, grid: Grid) -> Option<Curve> {
        let filled = || self.rows.iter().filter(|row| !row.masses.is_empty());
        let row = &self.rows[time];
        if row.masses.is_empty() {
            return None;
        }
        let (first, end) = match grid {
            Grid::Own => (row.first, row.end()),
            Grid::Common => (
                filled().map(|row| row.first).min()?,
                filled().map(Row::end).max()?,
            ),
        };
        Some(row.curve(self.mesh, first - 1, (end - first) as usize + 2))
    }

    /// Hands over the densities with the moments of the points, and returns the largest distance between the
    /// mean of the density and that of the points, in nodes.
    pub fn densities(
        &self,
        source: &dyn Responses,
        quantity: usize,
        grid: Grid,
        mut take: impl FnMut(TimeDensity) -> Result<()>,
    ) -> Result<f64> {
        let mut farthest = 0.0f64;
        moments(source, quantity, |mut result| {
            let time = result.time;
            let distance = (self.mean(time) - result.moments.mean) / self.mesh.spacing;
            farthest = farthest.max(distance.abs());
            result.curve = self.curve(time, grid);
            result.moments.smoothing_width = self.width(time);
            take(result)
        })?;
        Ok(farthest)
    }
}

/// The moments of the points at all times, without densities.
pub fn moments(
    source: &dyn Responses,
    quantity: usize,
    mut take: impl FnMut(TimeDensity) -> Result<()>,
) -> Result<()> {
    let options = density::Options {
        points_per_time: 16,
        grid: Grid::Own,
    };
    let smoother = Smoother::by_width(WidthRule::Silverman);
    density::estimate(source, &[quantity], &smoother, options, |mut result| {
        result.curve = None;
        result.moments.smoothing_width = 0.0;
        take(result)
    })
}
