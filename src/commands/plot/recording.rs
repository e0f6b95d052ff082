//! The figure of a recording: all responses with mean and quantiles.

use super::{Axis, Image, chosen, page, value_axis};
use crate::Result;
use crate::cli;
use crate::commands::responses::{Source, check_representative};
use crate::density::{Grid, Options, Smoother, WidthRule, estimate};
use crate::files::recording::Recordings;
use crate::plot::{Fan, Statistics};

/// Responses that are drawn, at most.
const DRAWN: usize = 1000;

pub(super) fn fan(args: &cli::Plot) -> Result<Image> {
    let recordings = Recordings::open(std::slice::from_ref(&args.input))?;
    check_representative(
        &recordings.place(),
        recordings.weights(),
        "make a density table of it and draw that",
    )?;
    let names: Vec<&str> = recordings
        .quantities()
        .iter()
        .map(|q| q.name.as_str())
        .collect();
    let name = chosen(args, &names)?;
    let quantity = recordings.quantity(name).unwrap_or(0);
    let header = &recordings.quantities()[quantity];
    let points = recordings.points();
    let every = points.div_ceil(DRAWN).max(1);
    let times = recordings.times_of(quantity);
    let mut drawn = vec![vec![0.0; times.len()]; points.div_ceil(every)];
    recordings.scan(&[quantity], |blocks| {
        for block in blocks {
            for (k, value) in block.values.iter().enumerate() {
                let point = block.first_point + k;
                if point.is_multiple_of(every) {
                    drawn[point / every][block.time] = *value;
                }
            }
        }
        Ok(())
    })?;
    let responses: Vec<&[f64]> = drawn.iter().map(Vec::as_slice).collect();
    let axis = Axis::of(name, &header.unit);
    let provenance = recordings
        .members()
        .next()
        .and_then(|member| member.provenance);
    let page = page(
        format!("{}: representative responses", axis.name),
        provenance,
        &[format!("{points} points")],
    );
    Fan {
        label: axis.label(),
        times,
        responses: &responses,
        point_count: points,
        statistics: &statistics(&recordings, quantity)?,
        value_axis: value_axis(args),
    }
    .draw(&page)
}

/// Mean and quantiles at every time.
fn statistics(recordings: &Recordings, quantity: usize) -> Result<Statistics> {
    let source = Source {
        recordings,
        times: recordings.times_of(quantity),
    };
    let options = Options {
        points_per_time: 2,
        grid: Grid::Own,
    };
    let mut statistics = Statistics {
        times: source.times.to_vec(),
        mean: Vec::new(),
        quantile_05: Vec::new(),
        quantile_25: Vec::new(),
        quantile_75: Vec::new(),
        quantile_95: Vec::new(),
    };
    let smoother = Smoother::by_width(WidthRule::Silverman);
    estimate(&source, &[quantity], &smoother, options, |result| {
        let [_, _, q05, q25, _, q75, q95, _, _] = result.moments.quantiles;
        statistics.mean.push(result.moments.mean);
        statistics.quantile_05.push(q05);
        statistics.quantile_25.push(q25);
        statistics.quantile_75.push(q75);
        statistics.quantile_95.push(q95);
        Ok(())
    })?;
    Ok(statistics)
}
