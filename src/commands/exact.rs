//! `dpim exact`: the exact density of a system that has one.

use super::Context;
use crate::cli;
use crate::files::tables::{DensityWriter, Units};
use crate::files::{Kind, OutputFile, Provenance};
use crate::{Result, interrupt};
use rayon::prelude::*;

/// Densities that are held at a time.
const TOGETHER: usize = 64;

/// The unit of a displacement.
const UNIT: &str = "m";

pub(super) fn run(context: &Context, args: &cli::Exact) -> Result<()> {
    super::check_distinct(
        &[&args.scenario.scenario],
        &[("--output", &args.output.output)],
    )?;
    let scenario = args.scenario.load()?;
    let spec = scenario.exact()?;
    let times = scenario.exact_times(&spec)?;
    let (case, nodes) = (spec.case.build(), spec.points_per_time as usize);
    let units = Units::from([(spec.quantity.clone(), UNIT.to_owned())]);
    let stamp = Provenance::stamp(
        Kind::Density,
        Some(scenario.text()),
        None,
        &[],
        &["exact".to_owned()],
    );
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let mut table = DensityWriter::create(output, &units, &stamp)?;
    let bar = context.progress("exact", times.len() as u64);
    let mut still = Vec::new();
    for times in times.chunks(TOGETHER) {
        interrupt::check()?;
        let densities: Vec<_> = times
            .par_iter()
            .map(|time| (*time, case.density(*time, nodes)))
            .collect();
        for (time, density) in densities {
            bar.inc(1);
            match density {
                Some(d) => {
                    table.append(&spec.quantity, time, &d.value, &d.density, &d.cumulative)?;
                }
                None => still.push(time),
            }
        }
    }
    bar.finish_and_clear();
    if let (Some(first), Some(last)) = (still.first(), still.last()) {
        context.note(format!(
            "{}: no spread at {} time(s) from {first} to {last} s: no density there",
            spec.quantity,
            still.len()
        ));
    }
    table.finish()
}
