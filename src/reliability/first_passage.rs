//! R(t) of every limit, from two passes over the responses.
//!
//! The first pass finds sums and ranges of responses and running extremes at each time, the second
//! shares both among bins, from which quartiles, widths and the smoothed probabilities follow.
//! Memory: a running extreme a point and limit, and bins for each time and limit.

use super::{Limit, Side, confidence_bounds};
use crate::Result;
use crate::density::{Bins, Curve, Nodes, PowerSums, Weighted, WidthRule, smooth};
use crate::probability::cumulative;
use crate::response::{Block, Responses, effective_count};
use rayon::prelude::*;

/// Bins over the range of a response or extreme at one time.
const BINS: f64 = 512.0;
/// Bins that are held at a time (bytes): more times take further passes.
const MEMORY: usize = 192 << 20;

/// What is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    pub smoothing: WidthRule,
    /// Of the two-sided bounds.
    pub confidence: f64,
    /// The least number of nodes of an extreme value's density.
    pub points_per_time: usize,
}

/// How R was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    Counting,
    ExtremeValue,
    AbsorbingCondition,
}

impl Method {
    /// All of them, in the order of results.
    pub const ALL: [Method; 3] = [
        Method::Counting,
        Method::ExtremeValue,
        Method::AbsorbingCondition,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Method::Counting => "counting",
            Method::ExtremeValue => "extreme-value",
            Method::AbsorbingCondition => "absorbing-condition",
        }
    }
}

/// R(t) with its bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// R.
    pub reliability: f64,
    /// P_f = 1 − R.
    pub failure: f64,
    /// Bounds of P_f.
    pub lower: f64,
    pub upper: f64,
    /// σ; 0 where nothing was smoothed.
    pub width: f64,
}

/// A limit's result.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitResult {
    /// `[method of Method::ALL][time]`.
    pub estimates: [Vec<Estimate>; 3],
    /// The density of the demand's extreme over the whole time; none without spread.
    pub extreme: Option<Curve>,
}

/// First passage of all limits, in their order.
pub fn first_passage(
    source: &dyn Responses,
    limits: &[Limit],
    options: Options,
) -> Result<Vec<LimitResult>> {
    let times = source.times().len();
    let mut passages: Vec<Passage> = limits
        .iter()
        .map(|limit| Passage::new(source, limit))
        .collect();
    scan(source, limits, &mut passages, |passage, block| {
        passage.first(block)
    })?;
    let per_time = (3.0 * (BINS + 2.0) * 8.0) as usize * limits.len().max(1);
    let window = (MEMORY / per_time).max(1);
    for first in (0..times).step_by(window) {
        let range = first..(first + window).min(times);
        for passage in &mut passages {
            passage.open(range.clone());
        }
        scan(source, limits, &mut passages, |passage, block| {
            passage.second(block)
        })?;
        passages
            .par_iter_mut()
            .for_each(|passage| passage.close(options));
    }
    Ok(passages.into_iter().map(Passage::result).collect())
}

/// Hands every limit its blocks in order, the limits in parallel.
fn scan(
    source: &dyn Responses,
    limits: &[Limit],
    passages: &mut [Passage<'_>],
    feed: impl Fn(&mut Passage<'_>, &Block<'_>) + Sync,
) -> Result<()> {
    let mut wanted: Vec<usize> = limits.iter().map(|limit| limit.quantity).collect();
    wanted.sort_unstable();
    wanted.dedup();
    source.scan(&wanted, &mut |blocks| {
        passages.par_iter_mut().for_each(|passage| {
            let own = blocks
                .iter()
                .filter(|b| b.quantity == passage.limit.quantity);
            own.for_each(|block| feed(passage, block));
        });
        Ok(())
    })
}

/// One limit's passage: state of each point, sums and bins of each time.
struct Passage<'a> {
    limit: &'a Limit,
    probability: &'a [f64],
    effective_count: f64,
    /// z_q of each point so far.
    extremes: Vec<f64>,
    /// Of responses and of extremes, at each time.
    sums: Vec<[PowerSums; 2]>,
    /// Σ P of the points that are safe, at each time.
    safe: Vec<f64>,
    /// The first time of the bins that are open, and the bins.
    first_open: usize,
    open: Vec<Open>,
    estimates: [Vec<Estimate>; 3],
    extreme: Option<Curve>,
}

/// Bins of one time: responses, those of failed points only, extremes.
struct Open {
    responses: Option<Bins>,
    failed: Option<Bins>,
    extremes: Option<Bins>,
}

impl<'a> Passage<'a> {
    fn new(source: &'a dyn Responses, limit: &'a Limit) -> Self {
        let times = source.times().len();
        Passage {
            limit,
            probability: source.probability(),
            effective_count: effective_count(source.probability()),
            extremes: vec![f64::NEG_INFINITY; source.probability().len()],
            sums: vec![[PowerSums::default(); 2]; times],
            safe: vec![0.0; times],
            first_open: 0,
            open: Vec::new(),
            estimates: std::array::from_fn(|_| Vec::with_capacity(times)),
            extreme: None,
        }
    }

    /// Brings the running extremes of a block's points up to its time.
    fn follow(&mut self, block: &Block<'_>) -> std::ops::Range<usize> {
        let points = block.first_point..block.first_point + block.values.len();
        for (extreme, value) in self.extremes[points.clone()].iter_mut().zip(block.values) {
            let demand = self.limit.demand(*value);
            *extreme = if demand > *extreme { demand } else { *extreme };
        }
        points
    }

    fn first(&mut self, block: &Block<'_>) {
        let points = self.follow(block);
        let probability = &self.probability[points.clone()];
        let extremes = &self.extremes[points];
        let [responses, running] = &mut self.sums[block.time];
        responses.add(block.values, probability);
        running.add(extremes, probability);
        let level = self.limit.level();
        let safe = extremes
            .iter()
            .zip(probability)
            .map(|(z, p)| if *z <= level { *p } else { 0.0 });
        self.safe[block.time] += safe.sum::<f64>();
    }

    /// Starts the bins of some times, and the points' extremes anew.
    fn open(&mut self, times: std::ops::Range<usize>) {
        self.extremes.fill(f64::NEG_INFINITY);
        self.first_open = times.start;
        let bins = |sums: &PowerSums| {
            let spacing = (sums.largest - sums.least) / BINS;
            sums.has_spread()
                .then(|| Bins::new(sums.least, sums.largest, spacing))
        };
        self.open = self.sums[times]
            .iter()
            .map(|[responses, extremes]| Open {
                responses: bins(responses),
                failed: bins(responses),
                extremes: bins(extremes),
            })
            .collect();
    }

    fn second(&mut self, block: &Block<'_>) {
        let points = self.follow(block);
        let Some(open) = block
            .time
            .checked_sub(self.first_open)
            .and_then(|k| self.open.get_mut(k))
        else {
            return;
        };
        let probability = &self.probability[points.clone()];
        let extremes = &self.extremes[points];
        let level = self.limit.level();
        if let Some(bins) = &mut open.responses {
            bins.add(block.values, probability);
        }
        if let Some(bins) = &mut open.failed {
            let all = block.values.iter().zip(extremes).zip(probability);
            for ((value, _), p) in all.filter(|((_, extreme), _)| **extreme > level) {
                bins.add(&[*value], &[*p]);
            }
        }
        if let Some(bins) = &mut open.extremes {
            bins.add(extremes, probability);
        }
    }

    /// Turns the open bins into estimates.
    fn close(&mut self, options: Options) {
        for (k, open) in std::mem::take(&mut self.open).into_iter().enumerate() {
            let time = self.first_open + k;
            let [responses, extremes] = &self.sums[time];
            let counted = self.safe[time];
            let width = |bins: &Option<Bins>, sums: &PowerSums| {
                bins.as_ref()
                    .map(|bins| self.width(bins, sums, options.smoothing))
            };
            let extreme_width = width(&open.extremes, extremes);
            let by_extreme = match (&open.extremes, extreme_width) {
                (Some(bins), Some(width)) => self.below(bins, width, self.limit.level()),
                _ => counted,
            };
            let response_width = width(&open.responses, responses);
            let by_absorption = match (&open.responses, &open.failed, response_width) {
                (Some(all), Some(failed), Some(width)) => {
                    self.inside(all, width) - self.inside(failed, width)
                }
                _ => counted,
            };
            let least = self.estimates[2]
                .last()
                .map_or(1.0, |e: &Estimate| e.reliability);
            let found = [
                (counted, 0.0),
                (by_extreme, extreme_width.unwrap_or(0.0)),
                (by_absorption.min(least), response_width.unwrap_or(0.0)),
            ];
            for (list, (reliability, width)) in self.estimates.iter_mut().zip(found) {
                list.push(estimate(
                    reliability,
                    width,
                    self.effective_count,
                    options.confidence,
                ));
            }
            if time + 1 == self.sums.len()
                && let (Some(bins), Some(width)) = (&open.extremes, extreme_width)
            {
                let count = options.points_per_time;
                let nodes = Nodes::covering(extremes.least, extremes.largest, width, count);
                self.extreme = Some(smooth(bins.nodes(), bins.kernel_width(width), nodes));
            }
        }
    }

    fn width(&self, bins: &Bins, sums: &PowerSums, rule: WidthRule) -> f64 {
        let mut pairs: Vec<(f64, f64)> = bins.nodes().collect();
        let [lower, upper] = Weighted::group(&mut pairs).quantiles([0.25, 0.75]);
        let spread = sums.spread(upper - lower, self.effective_count);
        rule.width(&spread, &pairs)
    }

    /// Σ mass Φ((b − x)/σ).
    fn below(&self, bins: &Bins, width: f64, level: f64) -> f64 {
        let width = bins.kernel_width(width);
        bins.nodes()
            .map(|(x, mass)| mass * cumulative((level - x) / width))
            .sum()
    }

    /// The smoothed probability between the thresholds.
    fn inside(&self, bins: &Bins, width: f64) -> f64 {
        let threshold = self.limit.threshold;
        let total: f64 = bins.nodes().map(|x| x.1).sum();
        match self.limit.side {
            Side::Absolute => {
                self.below(bins, width, threshold) - self.below(bins, width, -threshold)
            }
            Side::Upper => self.below(bins, width, threshold),
            Side::Lower => total - self.below(bins, width, threshold),
        }
    }

    fn result(self) -> LimitResult {
        LimitResult {
            estimates: self.estimates,
            extreme: self.extreme,
        }
    }
}

fn estimate(reliability: f64, width: f64, effective_count: f64, confidence: f64) -> Estimate {
    // Σ P is 1 to rounding only.
    let reliability = if reliability > 1.0 - 1e-12 {
        1.0
    } else {
        reliability.max(0.0)
    };
    let failure = 1.0 - reliability;
    let (lower, upper) = confidence_bounds(failure, effective_count, confidence);
    Estimate {
        reliability,
        failure,
        lower,
        upper,
        width,
    }
}
