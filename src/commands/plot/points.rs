//! Figures of a points file: samples of the irregularity and their periodogram.

use super::{Axis, Image, page};
use crate::cli;
use crate::commands::responses::check_representative;
use crate::commands::source::{self, Target};
use crate::commands::{Context, bad_file};
use crate::files::points::{PointsReader, ReadHeader, component_unit, is_in_time};
use crate::plot::{IrregularitySamples, Periodogram, Spectrum};
use crate::scenario::Scenario;
use crate::{BadInput, Result};

/// Samples that are drawn.
const DRAWN: usize = 3;
/// Samples that a periodogram is averaged over, at most.
const AVERAGED: usize = 4096;

/// Every so-and-so-th row of the component, at most `most`.
fn rows(args: &cli::Plot, reader: &PointsReader, most: usize) -> Result<Vec<(u32, Vec<f64>)>> {
    let header = reader.header();
    let component = match &args.quantity {
        None if header.components.is_empty() => {
            let expected = "points with an irregularity or an excitation";
            return Err(bad_file(&args.input, "", expected, "parameters alone").into());
        }
        None => 0,
        Some(name) => header
            .components
            .iter()
            .position(|c| c == name)
            .ok_or_else(|| {
                BadInput::new(
                    "--quantity",
                    "",
                    format!("one of {}", header.components.join(", ")),
                    name,
                )
            })?,
    };
    let every = (header.count as usize).div_ceil(most).max(1);
    let mut kept = Vec::new();
    for batch in reader.batches(0..header.count, 256)? {
        let batch = batch?;
        for (k, row) in batch.irregularity[component]
            .chunks_exact(header.positions)
            .enumerate()
        {
            let point = batch.first_point + k as u32;
            if (point as usize).is_multiple_of(every) && kept.len() < most {
                kept.push((point, row.to_vec()));
            }
        }
    }
    Ok(kept)
}

fn remark(header: &ReadHeader) -> String {
    format!("{} points", header.count)
}

pub(super) fn samples(args: &cli::Plot) -> Result<Image> {
    let reader = PointsReader::open(&args.input)?;
    let header = reader.header();
    let kept = rows(args, &reader, DRAWN)?;
    let named: Vec<(String, &[f64])> = kept
        .iter()
        .map(|(point, row)| (format!("point {point}"), row.as_slice()))
        .collect();
    let name = args.quantity.as_ref().or(header.components.first());
    let component = name.map_or("", String::as_str);
    let (title, name, symbol) = match component {
        "base_acceleration" => ("excitation", "Base acceleration", "a_g"),
        "force" => ("excitation", "Force", "F"),
        _ => ("irregularity", "Irregularity", "η"),
    };
    let axis = Axis {
        name: name.to_owned(),
        symbol: symbol.to_owned(),
        unit: component_unit(component).to_owned(),
    };
    let place = if is_in_time(component) {
        "Time, t (s)"
    } else {
        "Position, x (m)"
    };
    let page = page(
        format!("Samples of the {title}"),
        header.provenance.as_ref(),
        &[remark(header)],
    );
    IrregularitySamples {
        label: axis.label(),
        place,
        position_start: header.position_start,
        position_step: header.position_step,
        samples: &named,
    }
    .draw(&page)
}

pub(super) fn periodogram(context: &Context, args: &cli::Plot) -> Result<Image> {
    let reader = PointsReader::open(&args.input)?;
    let header = reader.header();
    check_representative(
        &args.input.display().to_string(),
        header.weights,
        "for a periodogram excite without --pseudo-excitation",
    )?;
    let no_target = |found: &str| {
        bad_file(
            &args.input,
            "",
            "points of a scenario with a spectrum, the periodogram's target",
            found,
        )
    };
    let text = header
        .provenance
        .as_ref()
        .and_then(|p| p.scenario.as_deref());
    let text = text.ok_or_else(|| no_target("points without a scenario"))?;
    let name = format!("{} (its scenario)", args.input.display());
    let scenario = Scenario::from_text(name, text)?;
    if scenario.has("excitation") {
        return Err(no_target("an excitation in time").into());
    }
    let spec = scenario.irregularity()?;
    let Some(Target { spectrum, band }) = source::read_target(context, &scenario, &spec)? else {
        return Err(no_target("a deterministic irregularity").into());
    };
    let kept = rows(args, &reader, AVERAGED)?;
    let samples: Vec<&[f64]> = kept.iter().map(|(_, row)| row.as_slice()).collect();
    let weights: Vec<f64> = kept
        .iter()
        .map(|(point, _)| header.probability[*point as usize])
        .collect();
    let target = |wavenumber: f64| {
        if band.holds(wavenumber) {
            spectrum.density(wavenumber)
        } else {
            0.0
        }
    };
    let page = page(
        "Periodogram of the samples and target spectrum".to_owned(),
        header.provenance.as_ref(),
        &[format!(
            "{} of {} points averaged",
            kept.len(),
            header.count
        )],
    );
    Spectrum {
        periodogram: &Periodogram::estimate(&samples, &weights, header.position_step)?,
        target: &target,
        wavenumbers: (band.min + 0.5 * band.step(), band.max),
    }
    .draw(&page)
}
