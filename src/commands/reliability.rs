//! `dpim reliability`: first passage of every limit of the scenario.

use super::Context;
use super::responses::{self, Source};
use crate::Result;
use crate::cli;
use crate::files::recording::{Axis, Recordings};
use crate::files::tables::{DensityWriter, ReliabilityRow, ReliabilityWriter, Units};
use crate::files::{Kind, OutputFile};
use crate::reliability::{Limit, LimitResult, Method, Options, first_passage};
use crate::scenario::{ReliabilitySpec, Scenario};

pub(super) fn run(context: &Context, args: &cli::Reliability) -> Result<()> {
    let mut outputs = vec![("--output", args.output.output.as_path())];
    outputs.extend(
        args.extremes
            .iter()
            .map(|path| ("--extremes", path.as_path())),
    );
    super::check_distinct(&args.scenario.inputs(&args.recordings), &outputs)?;
    let (recordings, scenario) = responses::open(context, &args.recordings, &args.scenario)?;
    responses::check_representative(
        &recordings.place(),
        recordings.weights(),
        "for first passage excite without --pseudo-excitation",
    )?;
    let spec = scenario.reliability()?;
    let limits = limits(&recordings, &scenario, &spec)?;
    let options = Options {
        smoothing: spec.smoothing.build(),
        confidence: spec.confidence,
        points_per_time: scenario.density()?.points_per_time as usize,
    };
    let stamp = |kind| responses::stamp(kind, &recordings, &scenario, None);
    let units: Units = limits
        .iter()
        .map(|limit| {
            (
                limit.name.clone(),
                recordings.quantities()[limit.quantity].unit.clone(),
            )
        })
        .collect();
    let clobber = !args.output.no_clobber;
    let output = OutputFile::create(&args.output.output, clobber)?;
    let mut table = ReliabilityWriter::create(output, &units, &stamp(Kind::Reliability))?;
    let mut extremes = match &args.extremes {
        Some(path) => {
            let output = OutputFile::create(path, clobber)?;
            Some(DensityWriter::create(
                output,
                &units,
                &stamp(Kind::Extremes),
            )?)
        }
        None => None,
    };
    let results = all_passages(&recordings, &limits, options)?;
    for (limit, result) in limits.iter().zip(&results) {
        let times = recordings.times_of(limit.quantity);
        append(&mut table, limit, result, times)?;
        if let (Some(table), Some(curve), Some(end)) =
            (&mut extremes, &result.extreme, times.last())
        {
            let nodes: Vec<f64> = (0..curve.nodes.count)
                .map(|j| curve.nodes.value(j))
                .collect();
            table.append(&limit.name, *end, &nodes, &curve.density, &curve.cumulative)?;
        }
        summary(context, limit, result);
    }
    if let Some(extremes) = extremes {
        extremes.finish()?;
    }
    table.finish()
}

/// The results of all limits, in their order: those of values a point, such as indices, have a time of their own.
fn all_passages(
    recordings: &Recordings,
    limits: &[Limit],
    options: Options,
) -> Result<Vec<LimitResult>> {
    let mut results: Vec<Option<LimitResult>> = vec![None; limits.len()];
    let of_axis = |axis: Axis| {
        let is_of_axis = move |limit: &Limit| recordings.quantities()[limit.quantity].axis == axis;
        (0..limits.len()).filter(move |k| is_of_axis(&limits[*k]))
    };
    for axis in [Axis::Time, Axis::Point] {
        let places: Vec<usize> = of_axis(axis).collect();
        let Some(first) = places.first() else {
            continue;
        };
        let own: Vec<Limit> = places.iter().map(|k| limits[*k].clone()).collect();
        let source = Source {
            recordings,
            times: recordings.times_of(limits[*first].quantity),
        };
        for (place, result) in places.iter().zip(first_passage(&source, &own, options)?) {
            results[*place] = Some(result);
        }
    }
    Ok(results.into_iter().flatten().collect())
}

fn limits(
    recordings: &Recordings,
    scenario: &Scenario,
    spec: &ReliabilitySpec,
) -> Result<Vec<Limit>> {
    let names: Vec<&str> = recordings
        .quantities()
        .iter()
        .map(|q| q.name.as_str())
        .collect();
    let mut limits = Vec::new();
    for (number, limit) in spec.limit.iter().enumerate() {
        let key = format!("reliability.limit.{number}.quantity");
        let Some(quantity) = recordings.quantity(&limit.quantity) else {
            let expected = format!("a quantity of the recording ({})", names.join(", "));
            return Err(scenario
                .bad(&key, expected, format!("{:?}", limit.quantity))
                .remedy("record it (simulation.record) or take the limit out")
                .into());
        };
        limits.push(Limit {
            name: limit.name.clone(),
            quantity,
            side: limit.kind.build(),
            threshold: limit.threshold,
        });
    }
    Ok(limits)
}

fn append(
    table: &mut ReliabilityWriter,
    limit: &Limit,
    result: &LimitResult,
    times: &[f64],
) -> Result<()> {
    for (method, estimates) in Method::ALL.iter().zip(&result.estimates) {
        for (time, estimate) in times.iter().zip(estimates) {
            table.append(&ReliabilityRow {
                limit: limit.name.clone(),
                method: method.name().to_owned(),
                time: *time,
                reliability: estimate.reliability,
                failure_probability: estimate.failure,
                lower: estimate.lower,
                upper: estimate.upper,
                smoothing_width: estimate.width,
            })?;
        }
    }
    Ok(())
}

fn summary(context: &Context, limit: &Limit, result: &LimitResult) {
    for (method, estimates) in Method::ALL.iter().zip(&result.estimates) {
        if let Some(last) = estimates.last() {
            context.detail(format!(
                "{}: P_f = {:.4e} ({:.4e} to {:.4e}) by {}",
                limit.name,
                last.failure,
                last.lower,
                last.upper,
                method.name()
            ));
        }
    }
}
