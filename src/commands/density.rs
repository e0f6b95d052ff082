//! `dpim density`: the probability density of every quantity at every time.

use super::Context;
use super::responses::{self, Source};
use super::smoothing::{self, Prepared};
use crate::Result;
use crate::cli;
use crate::density::{Moments, Options, TimeDensity, estimate};
use crate::files::recording::Recordings;
use crate::files::tables::{DensityWriter, MomentsRow, MomentsWriter};
use crate::files::{Kind, OutputFile};

pub(super) fn run(context: &Context, args: &cli::Density) -> Result<()> {
    let mut outputs = vec![("--output", args.output.output.as_path())];
    outputs.extend(
        args.moments
            .iter()
            .map(|path| ("--moments", path.as_path())),
    );
    let mut inputs = args.scenario.inputs(&args.recordings);
    inputs.extend(args.points.as_deref());
    super::check_distinct(&inputs, &outputs)?;
    let (recordings, scenario) = responses::open(context, &args.recordings, &args.scenario)?;
    let spec = scenario.density()?;
    let wanted = responses::chosen(&recordings, &scenario, spec.quantities.as_deref())?;
    let points = args.points.as_deref();
    let Prepared {
        smoother,
        scenario,
        points,
    } = smoothing::prepare(context, &recordings, scenario, spec.smoothing, points)?;
    let options = Options {
        points_per_time: spec.points_per_time as usize,
        grid: spec.grid.build(),
    };
    context.detail(format!(
        "{} points, {} times, smoothing by {}",
        recordings.points(),
        recordings.times().len(),
        smoother.smoothing().name()
    ));
    let stamp = |kind| responses::stamp(kind, &recordings, &scenario, points.clone());
    let clobber = !args.output.no_clobber;
    let units = responses::units(&recordings);
    let output = OutputFile::create(&args.output.output, clobber)?;
    let mut tables = Tables {
        recordings: &recordings,
        density: DensityWriter::create(output, &units, &stamp(Kind::Density))?,
        moments: match &args.moments {
            Some(path) => {
                let output = OutputFile::create(path, clobber)?;
                Some(MomentsWriter::create(
                    output,
                    &units,
                    &stamp(Kind::Moments),
                )?)
            }
            None => None,
        },
        still: Vec::new(),
        node: Vec::new(),
    };
    let bar = context.progress("density", (wanted.len() * recordings.times().len()) as u64);
    for quantities in responses::by_axis(&recordings, wanted) {
        let Some(first) = quantities.first() else {
            continue;
        };
        let source = Source {
            recordings: &recordings,
            times: recordings.times_of(*first),
        };
        estimate(&source, &quantities, &smoother, options, |result| {
            bar.inc(1);
            tables.append(source.times[result.time], &result)
        })?;
    }
    bar.finish_and_clear();
    tables.finish(context)
}

/// The outputs.
struct Tables<'a> {
    recordings: &'a Recordings,
    density: DensityWriter,
    moments: Option<MomentsWriter>,
    /// (quantity, time) without spread.
    still: Vec<(usize, f64)>,
    node: Vec<f64>,
}

impl Tables<'_> {
    fn append(&mut self, time: f64, result: &TimeDensity) -> Result<()> {
        let name = &self.recordings.quantities()[result.quantity].name;
        if let Some(moments) = &mut self.moments {
            moments.append(&row(name, time, &result.moments))?;
        }
        let Some(curve) = &result.curve else {
            self.still.push((result.quantity, time));
            return Ok(());
        };
        self.node.clear();
        self.node
            .extend((0..curve.nodes.count).map(|j| curve.nodes.value(j)));
        self.density
            .append(name, time, &self.node, &curve.density, &curve.cumulative)
    }

    fn finish(self, context: &Context) -> Result<()> {
        for (k, quantity) in self.recordings.quantities().iter().enumerate() {
            let times: Vec<f64> = self
                .still
                .iter()
                .filter(|s| s.0 == k)
                .map(|s| s.1)
                .collect();
            if let (Some(first), Some(last)) = (times.first(), times.last()) {
                context.note(format!(
                    "{}: no spread at {} time(s) from {first} to {last} s: no density there",
                    quantity.name,
                    times.len()
                ));
            }
        }
        if let Some(moments) = self.moments {
            moments.finish()?;
        }
        self.density.finish()
    }
}

fn row(quantity: &str, time: f64, moments: &Moments) -> MomentsRow {
    MomentsRow {
        quantity: quantity.to_owned(),
        time,
        mean: moments.mean,
        std: moments.deviation,
        skewness: moments.skewness,
        kurtosis: moments.kurtosis,
        quantiles: moments.quantiles,
        smoothing_width: moments.smoothing_width,
        effective_count: moments.effective_count,
    }
}
