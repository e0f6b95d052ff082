//! `dpim compare`: the distances between two tables of densities.

mod pairs;
mod report;

use super::Context;
use crate::cli;
use crate::comparison::{Distances, Tabulated, distances};
use crate::files::tables::{
    ComparisonRow, ComparisonWriter, DensitySlice, DensityTable, Units, read_density,
};
use crate::files::{Kind, OutputFile, Provenance, identify};
use crate::{BadInput, Result, interrupt};
use pairs::Pair;
use rayon::prelude::*;
use std::path::Path;

/// Pairs that are compared between two looks at whether to go on.
const TOGETHER: usize = 256;
/// A table whose probability differs from 1 by more is said to.
const MISSING: f64 = 1e-3;

pub(super) fn run(context: &Context, args: &cli::Compare) -> Result<()> {
    let output = args.output.as_deref().map(|path| ("--output", path));
    super::check_distinct(&[&args.first, &args.second], output.as_slice())?;
    check_levels(&args.quantiles)?;
    let first = Side::read(&args.first)?;
    let second = Side::read(&args.second)?;
    check_kinds(&first, &second)?;
    let pairs = pairs::matched(context, &first, &second, &args.times)?;
    let mut rows = Vec::with_capacity(pairs.len());
    for part in pairs.chunks(TOGETHER) {
        interrupt::check()?;
        let results: Result<Vec<ComparisonRow>> = part
            .par_iter()
            .map(|pair| compared(&first, &second, pair, &args.quantiles))
            .collect();
        rows.extend(results?);
    }
    for (side, of) in [(&first, Pair::first as Of<'_>), (&second, Pair::second)] {
        side.note_missing(context, pairs.iter().map(of));
    }
    let units = units(&first, &second, &pairs);
    if let Some(path) = &args.output {
        let output = OutputFile::create(path, !args.no_clobber)?;
        let stamp = stamp(&first, &second, args);
        let mut table = ComparisonWriter::create(output, &args.quantiles, &units, &stamp)?;
        rows.iter().try_for_each(|row| table.append(row))?;
        table.finish()?;
    }
    let report = report::Report {
        rows: &rows,
        levels: &args.quantiles,
        units: &units,
    };
    super::print(&if args.all {
        report.each_time()
    } else {
        report.summary()
    })
}

/// One of the densities of a pair.
type Of<'a> = fn(&Pair<'a>) -> &'a DensitySlice;

/// One of the two tables.
struct Side<'a> {
    path: &'a Path,
    kind: Kind,
    table: DensityTable,
}

impl<'a> Side<'a> {
    fn read(path: &'a Path) -> Result<Self> {
        let kind = identify(path)?;
        let remedy = match kind {
            Kind::Density | Kind::Extremes => {
                return Ok(Side {
                    path,
                    kind,
                    table: read_density(path)?,
                });
            }
            Kind::Moments => "moments say too little of a density: name the table beside them",
            Kind::Recording => "write its densities first (dpim density)",
            Kind::Points | Kind::Reliability | Kind::Comparison | Kind::Study => "",
        };
        let found = match kind {
            Kind::Points => "a points file",
            Kind::Recording => "a recording",
            Kind::Density | Kind::Extremes => "a table of densities",
            Kind::Moments => "a table of moments",
            Kind::Reliability => "a table of reliability",
            Kind::Comparison => "a comparison",
            Kind::Study => "a study",
        };
        Err(
            super::bad_file(path, "", "a table of densities or extremes", found)
                .remedy(remedy)
                .into(),
        )
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The names of its quantities, each once.
    fn quantities(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for slice in &self.table.slices {
            if !names.contains(&slice.quantity.as_str()) {
                names.push(&slice.quantity);
            }
        }
        names
    }

    /// The density of a slice.
    fn curve<'s>(&self, slice: &'s DensitySlice) -> Result<Tabulated<'s>, BadInput> {
        Tabulated::new(&slice.value, &slice.density, &slice.cumulative).map_err(|error| {
            let at = format!("{} at {} s", slice.quantity, slice.time);
            super::bad_file(self.path, &at, "a density", error.to_string())
        })
    }

    /// Says where the nodes hold less (or more) than all of the probability.
    fn note_missing<'s>(&self, context: &Context, slices: impl Iterator<Item = &'s DensitySlice>) {
        let held = slices.filter_map(|slice| {
            let probability = slice.cumulative.last()? - slice.cumulative.first()?;
            ((probability - 1.0).abs() > MISSING).then_some(probability)
        });
        let held: Vec<f64> = held.collect();
        if !held.is_empty() {
            let least = held.iter().copied().fold(f64::INFINITY, f64::min);
            let most = held.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            context.note(format!(
                "{}: {} of its densities have a probability between {least:.4} and {most:.4} instead of 1; \
                 the difference counts as distance",
                self.name(),
                held.len()
            ));
        }
    }
}

fn check_levels(levels: &[f64]) -> Result<()> {
    for (index, level) in levels.iter().enumerate() {
        if !(*level > 0.0 && *level < 1.0) {
            let expected = "probabilities above 0 and below 1";
            return Err(BadInput::new("--quantile", "", expected, level.to_string()).into());
        }
        if levels[..index].contains(level) {
            let found = format!("{level} a second time");
            return Err(BadInput::new("--quantile", "", "each quantile once", found).into());
        }
    }
    Ok(())
}

/// Densities and extremes are not the same quantities, even of one name.
fn check_kinds(first: &Side<'_>, second: &Side<'_>) -> Result<()> {
    if first.kind == second.kind {
        return Ok(());
    }
    let expected = format!("a table of {}, as {} is", first.kind.name(), first.name());
    let found = format!("a table of {}", second.kind.name());
    Err(super::bad_file(second.path, "", expected, found).into())
}

fn compared(
    first: &Side<'_>,
    second: &Side<'_>,
    pair: &Pair<'_>,
    levels: &[f64],
) -> Result<ComparisonRow> {
    let (ours, theirs) = (first.curve(pair.first)?, second.curve(pair.second)?);
    let apart = distances(&ours, &theirs);
    let (moments, exact) = (ours.mean_and_deviation(), theirs.mean_and_deviation());
    let Distances {
        l1,
        kolmogorov_smirnov,
        wasserstein_1,
        hellinger,
    } = apart;
    Ok(ComparisonRow {
        quantity: pair.first.quantity.clone(),
        time: pair.first.time,
        l1,
        total_variation: apart.total_variation(),
        kolmogorov_smirnov,
        wasserstein_1,
        hellinger,
        mean_error: moments.0 - exact.0,
        std_error: moments.1 - exact.1,
        std: exact.1,
        quantile_errors: levels
            .iter()
            .map(|level| ours.quantile(*level) - theirs.quantile(*level))
            .collect(),
    })
}

/// The units of what was compared, from whichever table knows them.
fn units(first: &Side<'_>, second: &Side<'_>, pairs: &[Pair<'_>]) -> Units {
    let known = |name: &str| {
        let tables = [&first.table.units, &second.table.units];
        let mut units = tables.iter().filter_map(|units| units.get(name));
        units.find(|unit| !unit.is_empty()).cloned()
    };
    let names = pairs.iter().map(|pair| &pair.first.quantity);
    names
        .filter_map(|name| Some((name.clone(), known(name)?)))
        .collect()
}

fn stamp(first: &Side<'_>, second: &Side<'_>, args: &cli::Compare) -> Provenance {
    let identity = |side: &Side<'_>| {
        let stamp = side.table.provenance.as_ref();
        stamp.map(|p| p.identity.clone()).unwrap_or_default()
    };
    let list = |option: &str, numbers: &[f64]| format!("{option} {numbers:?}");
    let ours = first.table.provenance.as_ref();
    Provenance::stamp(
        Kind::Comparison,
        ours.and_then(|p| p.scenario.as_deref()),
        ours.and_then(|p| p.seed),
        &[identity(first), identity(second)],
        &[
            list("--quantile", &args.quantiles),
            list("--times", &args.times),
        ],
    )
}
