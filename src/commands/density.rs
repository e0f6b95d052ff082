//! `dpim density`: the probability density of every quantity at every time.

mod evolution;

use super::Context;
use super::responses::{self, Source};
use super::smoothing;
use crate::cli;
use crate::density::{Moments, Options, Smoother, TimeDensity, estimate, pseudo_excitation};
use crate::files::recording::{Axis, Recordings};
use crate::files::tables::{DensityWriter, MomentsRow, MomentsWriter};
use crate::files::{Kind, OutputFile, Weights};
use crate::scenario::{DensitySpec, MethodKind};
use crate::{BadInput, Result, memory};

pub(super) fn run(context: &Context, args: &cli::Density) -> Result<()> {
    memory::keep_freed();
    let mut outputs = vec![("--output", args.output.output.as_path())];
    outputs.extend(
        args.moments
            .iter()
            .map(|path| ("--moments", path.as_path())),
    );
    let mut inputs = args.scenario.inputs(&args.recordings);
    inputs.extend(args.points.as_deref());
    super::check_distinct(&inputs, &outputs)?;
    let (recordings, mut scenario) = responses::open(context, &args.recordings, &args.scenario)?;
    if let Some(method) = args.method {
        // In the scenario, so that the outputs tell it.
        scenario = scenario.set(&[DensitySpec::choose(method.into())])?;
    }
    let spec = scenario.density()?;
    let wanted = responses::chosen(&recordings, &scenario, spec.quantities.as_deref())?;
    let options = Options {
        points_per_time: spec.points_per_time as usize,
        grid: spec.grid.build(),
    };
    let mut points = None;
    let how = match (recordings.weights(), spec.method) {
        (Weights::Harmonics, MethodKind::DirectIntegral) => {
            check_linear(&recordings, &wanted)?;
            How::Normal
        }
        (Weights::Harmonics, MethodKind::DensityEvolution) => {
            return Err(harmonics_have_their_own(&recordings).into());
        }
        (Weights::Assigned | Weights::Importance, MethodKind::DirectIntegral) => {
            let path = args.points.as_deref();
            let prepared =
                smoothing::prepare(context, &recordings, scenario, spec.smoothing, path)?;
            scenario = prepared.scenario;
            points = prepared.points;
            How::Smoothed(prepared.smoother)
        }
        (Weights::Assigned | Weights::Importance, MethodKind::DensityEvolution) => How::Evolution,
    };
    context.detail(format!(
        "{} points, {} times, {}",
        recordings.points(),
        recordings.times().len(),
        how.describe(),
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
        residuals: Vec::new(),
        node: Vec::new(),
    };
    let bar = context.progress("density", (wanted.len() * recordings.times().len()) as u64);
    if let How::Evolution = how {
        let evolution = evolution::Evolution {
            context,
            recordings: &recordings,
            scenario: &scenario,
            spec: &spec,
        };
        evolution.run(&wanted, &mut tables, &bar)?;
        bar.finish_and_clear();
        return tables.finish(context);
    }
    for quantities in responses::by_axis(&recordings, wanted) {
        let Some(first) = quantities.first() else {
            continue;
        };
        let source = Source {
            recordings: &recordings,
            times: recordings.times_of(*first),
        };
        let take = |result: TimeDensity| {
            bar.inc(1);
            tables.append(source.times[result.time], &result)
        };
        match &how {
            How::Smoothed(smoother) => estimate(&source, &quantities, smoother, options, take)?,
            How::Normal => {
                let (nodes, grid) = (options.points_per_time, options.grid);
                pseudo_excitation(&source, &quantities, nodes, grid, take)?;
            }
            How::Evolution => {}
        }
    }
    bar.finish_and_clear();
    tables.finish(context)
}

/// Refuses quantities that are no linear function of the irregularity: values a point, such as an
/// index of comfort.
fn check_linear(recordings: &Recordings, wanted: &[usize]) -> Result<()> {
    let quantities = recordings.quantities();
    match wanted.iter().find(|k| quantities[**k].axis == Axis::Point) {
        None => Ok(()),
        Some(k) => Err(BadInput::new(
            recordings.place(),
            quantities[*k].topic(),
            "a quantity over time: these are the harmonics of a pseudo-excitation",
            "one value a point, no linear function of the irregularity",
        )
        .remedy("name others in density.quantities, or excite without --pseudo-excitation")
        .into()),
    }
}

/// How densities are made.
enum How {
    /// A smoothed sum over the points.
    Smoothed(Smoother),
    /// Normal densities from the responses to harmonics.
    Normal,
    Evolution,
}

impl How {
    fn describe(&self) -> String {
        match self {
            How::Smoothed(smoother) => format!("smoothing by {}", smoother.smoothing().name()),
            How::Normal => "exact normal densities by pseudo-excitation".to_owned(),
            How::Evolution => "density evolution".to_owned(),
        }
    }
}

fn harmonics_have_their_own(recordings: &Recordings) -> BadInput {
    let path = recordings
        .members()
        .next()
        .map(|member| member.path.to_owned());
    super::bad_file(
        &path.unwrap_or_default(),
        "",
        "responses of representative points, for density evolution",
        "harmonics of a pseudo-excitation",
    )
    .remedy("use the method direct-integral, which gives their normal densities")
}

/// The outputs.
struct Tables<'a> {
    recordings: &'a Recordings,
    density: DensityWriter,
    moments: Option<MomentsWriter>,
    /// (quantity, time) without spread.
    still: Vec<(usize, f64)>,
    /// The residuals of control variates: (quantity, time, residual).
    residuals: Vec<(usize, f64, f64)>,
    node: Vec<f64>,
}

impl Tables<'_> {
    fn append(&mut self, time: f64, result: &TimeDensity) -> Result<()> {
        self.append_moments(time, result)?;
        let residual = result.residual.map(|r| (result.quantity, time, r));
        self.residuals.extend(residual);
        let name = &self.recordings.quantities()[result.quantity].name;
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

    fn append_moments(&mut self, time: f64, result: &TimeDensity) -> Result<()> {
        let name = &self.recordings.quantities()[result.quantity].name;
        match &mut self.moments {
            Some(moments) => moments.append(&row(name, time, &result.moments)),
            None => Ok(()),
        }
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
            let residuals = self.residuals.iter().filter(|r| r.0 == k);
            if let Some((_, time, worst)) = residuals.max_by(|a, b| a.2.total_cmp(&b.2)) {
                context.note(format!(
                    "{}: the regression leaves at most {worst:.1e} of the variance, at {time} s",
                    quantity.name
                ));
            }
        }
        if let Some(moments) = self.moments {
            moments.finish()?;
        }
        self.density.finish()
    }
}

impl From<cli::DensityMethod> for MethodKind {
    fn from(method: cli::DensityMethod) -> Self {
        match method {
            cli::DensityMethod::DirectIntegral => MethodKind::DirectIntegral,
            cli::DensityMethod::DensityEvolution => MethodKind::DensityEvolution,
        }
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
