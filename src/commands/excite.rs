//! `dpim excite`: representative points and their irregularities.

use super::Context;
use super::random::{Drawn, Leading};
use crate::cli;
use crate::files::points::{PointsBatch, PointsHeader, PointsWriter, ROW_GROUP};
use crate::files::{Kind, OutputFile, Provenance, Weights, tabulated};
use crate::irregularity::{
    Deterministic, Grid, Irregularity, PowerSpectralDensity, RandomField, SpectralRepresentation,
    Tabulated,
};
use crate::probability::discrepancy::Quality;
use crate::probability::{PointRule, UnitVectors};
use crate::scenario::{
    DeterministicSpec, IrregularitySpec, ProfileSpec, Scenario, Sided, SpectrumSpec,
    SpectrumTableSpec, WavenumberUnit,
};
use crate::{Result, interrupt};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::mpsc::sync_channel;

/// Points whose variables a thread draws together.
const PART: usize = 512;

pub(super) fn run(context: &Context, args: &cli::Excite) -> Result<()> {
    super::check_distinct(
        &[&args.scenario.scenario],
        &[("--output", &args.output.output)],
    )?;
    let scenario = load(args)?;
    let spec = scenario.irregularity()?;
    let irregularity = read_irregularity(context, &scenario, &spec)?;
    let chosen = if args.pseudo_excitation {
        harmonics(&scenario, &spec, &irregularity)?
    } else {
        representative_points(context, &scenario, &spec, &irregularity)?
    };
    let rule = chosen.rule.as_ref();
    let grid = irregularity.grid();
    let header = PointsHeader {
        weights: chosen.weights,
        position_start: grid.start,
        position_step: grid.spacing,
        positions: grid.count,
        components: vec!["vertical".to_owned()],
        parameters: chosen.leading.columns(),
        variables: chosen.leading.variables,
        dimensions: Some(rule.dimensions()),
        provenance: Provenance::stamp(
            Kind::Points,
            Some(scenario.text()),
            chosen.seed,
            &[],
            &chosen.options,
        ),
    };
    context.detail(format!(
        "{} points by {}, {} variables, {} positions from {} m, {}",
        rule.count(),
        chosen.name,
        rule.dimensions(),
        grid.count,
        grid.start,
        irregularity.describe(),
    ));
    if !args.pseudo_excitation {
        report(context, rule);
    }
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let writer = PointsWriter::create(output, &header)?;
    write(context, rule, &chosen.leading, &irregularity, writer)
}

/// What is to know about the points: their figures of merit where details are asked for.
fn report(context: &Context, rule: &dyn PointRule) {
    if let Some(note) = rule.note() {
        context.note(note);
    }
    if context.general.verbose {
        let quality = Quality::of(rule);
        let over = match quality.dimensions {
            leading if leading < rule.dimensions() => {
                format!(" over the leading {leading} variables")
            }
            _ => String::new(),
        };
        context.detail(format!(
            "generalised F-discrepancy {:.3e}{over}, effective number of points {:.1}",
            quality.discrepancy, quality.effective_count
        ));
    }
}

/// Points, and what the file says of them.
struct Chosen {
    rule: Box<dyn PointRule>,
    /// Random parameters, and the variables that are kept.
    leading: Leading,
    weights: Weights,
    name: &'static str,
    seed: Option<u64>,
    /// What determines the points beside the scenario.
    options: Vec<String>,
}

fn representative_points(
    context: &Context,
    scenario: &Scenario,
    spec: &IrregularitySpec,
    irregularity: &Irregularity,
) -> Result<Chosen> {
    let points = scenario.points()?;
    scenario.check_truncation(&points, spec)?;
    let leading = Leading::read(context, scenario, &points, irregularity.dimensions())?;
    let parameters = leading.random.dimensions();
    let dimensions = parameters + irregularity.dimensions();
    let rule = scenario.point_rule(&points, dimensions, parameters)?;
    Ok(Chosen {
        rule,
        leading,
        weights: Weights::Assigned,
        name: points.rule.name(),
        seed: Some(points.seed),
        options: Vec::new(),
    })
}

/// The deterministic profile, then one harmonic a point: what each variable of the field adds to it.
fn harmonics(
    scenario: &Scenario,
    spec: &IrregularitySpec,
    irregularity: &Irregularity,
) -> Result<Chosen> {
    let Some(field) = irregularity.field() else {
        let expected = "a spectrum, whose harmonics --pseudo-excitation writes";
        return Err(scenario
            .bad("irregularity.spectrum", expected, "none")
            .into());
    };
    if !field.is_linear() {
        let expected = "\"gaussian\" or \"karhunen-loeve\", a sum of harmonics with normal amplitudes, for --pseudo-excitation";
        let found = format!("\"{}\"", spec.field.name());
        return Err(scenario
            .bad("irregularity.field", expected, found)
            .remedy("add --set irregularity.field=gaussian, of the same covariance")
            .into());
    }
    let random = super::random::read(scenario)?;
    if let Some(parameter) = random.iter().next() {
        let expected =
            "no random parameters: --pseudo-excitation is for a random irregularity alone";
        return Err(scenario
            .bad("random", expected, parameter.key.as_str())
            .remedy("add --set random=")
            .into());
    }
    Ok(Chosen {
        leading: Leading {
            random,
            variables: 0,
        },
        rule: Box::new(UnitVectors::new(field.dimensions())),
        weights: Weights::Harmonics,
        name: "pseudo-excitation",
        seed: None,
        options: vec!["pseudo-excitation".to_owned()],
    })
}

fn load(args: &cli::Excite) -> Result<Scenario> {
    let mut given = args.scenario.clone();
    given
        .sets
        .extend(args.seed.map(|seed| format!("points.seed={seed}")));
    given
        .sets
        .extend(args.count.map(|count| format!("points.count={count}")));
    given.load()
}

/// Row groups, drawn by all threads and written by one more.
fn write(
    context: &Context,
    rule: &dyn PointRule,
    leading: &Leading,
    irregularity: &Irregularity,
    mut writer: PointsWriter,
) -> Result<()> {
    struct Group {
        points: Range<usize>,
        rows: Vec<f64>,
        drawn: Drawn,
    }
    let bar = context.progress("excite", rule.count() as u64);
    std::thread::scope(|scope| {
        let (full, groups) = sync_channel::<Group>(1);
        let (emptied, spare) = sync_channel::<(Vec<f64>, Drawn)>(2);
        let written = scope.spawn(move || -> Result<PointsWriter> {
            for group in groups {
                let probability: Vec<f64> =
                    group.points.clone().map(|q| rule.probability(q)).collect();
                writer.write(&PointsBatch {
                    first_point: group.points.start as u32,
                    probability: &probability,
                    parameters: &group.drawn.parameters,
                    irregularity: &[&group.rows],
                    variables: &group.drawn.variables,
                })?;
                // Memory that finds no room on its way back is let go.
                let _ = emptied.try_send((group.rows, group.drawn));
            }
            Ok(writer)
        });
        let mut filled = Ok(());
        for first in (0..rule.count()).step_by(ROW_GROUP) {
            filled = interrupt::check();
            if filled.is_err() {
                break;
            }
            let points = first..(first + ROW_GROUP).min(rule.count());
            let (mut rows, mut drawn) = spare.try_recv().unwrap_or_default();
            rows.resize(points.len() * irregularity.grid().count, 0.0);
            fill(
                rule,
                leading,
                irregularity,
                points.start,
                &mut rows,
                &mut drawn,
            );
            filled = leading.check(points.start, &drawn);
            if filled.is_err() {
                break;
            }
            bar.inc(points.len() as u64);
            let group = Group {
                points,
                rows,
                drawn,
            };
            if full.send(group).is_err() {
                break;
            }
        }
        drop(full);
        bar.finish_and_clear();
        let writer = written
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // Only with all groups may the file take its place.
        filled?;
        writer?.finish()
    })
}

/// Fills `[point][position]` from the point `first` on, and what is drawn beside.
fn fill(
    rule: &dyn PointRule,
    leading: &Leading,
    irregularity: &Irregularity,
    first: usize,
    rows: &mut [f64],
    drawn: &mut Drawn,
) {
    let positions = irregularity.grid().count;
    let pieces = drawn.pieces(leading, rows.len() / positions, PART);
    rows.par_chunks_mut(PART * positions)
        .zip(pieces)
        .enumerate()
        .for_each_init(Vec::new, |variables, (part, (rows, piece))| {
            let count = rows.len() / positions;
            let start = first + part * PART;
            variables.resize(rule.dimensions() * count, 0.0);
            rule.standard_normals(start..start + count, variables);
            irregularity.fill(piece.take(variables), count, rows);
        });
}

/// The irregularity of a scenario, its files read.
pub(super) fn read_irregularity(
    context: &Context,
    scenario: &Scenario,
    spec: &IrregularitySpec,
) -> Result<Irregularity> {
    let grid = scenario.irregularity_grid(spec)?;
    let field = read_field(context, scenario, spec, grid)?;
    let deterministic = match &spec.deterministic {
        Some(deterministic) => read_deterministic(context, scenario, deterministic, grid)?,
        None => Deterministic::Smooth,
    };
    Ok(Irregularity::new(grid, &deterministic, field))
}

/// The random field of a scenario, where it has a spectrum.
pub(super) fn read_field(
    context: &Context,
    scenario: &Scenario,
    spec: &IrregularitySpec,
    grid: Grid,
) -> Result<Option<Box<dyn RandomField>>> {
    let (Some(spectrum), Some(band)) = (&spec.spectrum, &spec.wavenumber) else {
        return Ok(None);
    };
    let spectrum = read_spectrum(context, scenario, spectrum, band.max)?;
    let spectrum = SpectralRepresentation::new(spectrum.as_ref(), band.max, band.count as usize);
    scenario.random_field(spec, spectrum, grid).map(Some)
}

/// The spectrum of a scenario, its table read where it has one.
pub(super) fn read_spectrum(
    context: &Context,
    scenario: &Scenario,
    spec: &SpectrumSpec,
    highest: f64,
) -> Result<Box<dyn PowerSpectralDensity>> {
    match spec {
        SpectrumSpec::SecondOrderFilter(filter) => Ok(Box::new(filter.build())),
        SpectrumSpec::Table(table) => {
            let spectrum = read_table(scenario, table)?;
            let (least, largest) = spectrum.band();
            if highest > largest * (1.0 + 1e-9) {
                context.note(format!(
                    "the spectrum's table covers {least:.6} to {largest:.6} rad/m; beyond it, up to {highest} rad/m, the density is zero"
                ));
            }
            Ok(Box::new(spectrum))
        }
    }
}

fn read_table(scenario: &Scenario, spec: &SpectrumTableSpec) -> Result<Tabulated> {
    let path = scenario.resolve(&spec.file);
    let columns = (
        spec.wavenumber_column.as_deref(),
        spec.density_column.as_deref(),
    );
    let (wavenumbers, densities) = tabulated::read_columns(&path, columns.0, columns.1)?;
    let cycles = match spec.unit {
        WavenumberUnit::CyclePerMetre => true,
        WavenumberUnit::RadianPerMetre => false,
    };
    let one_sided = match spec.sided {
        Sided::One => true,
        Sided::Two => false,
    };
    Tabulated::new(&wavenumbers, &densities, cycles, one_sided).map_err(|error| {
        super::bad_file(
            &path,
            "",
            "a spectrum: wavenumbers that increase, densities that are not negative",
            error.to_string(),
        )
        .into()
    })
}

fn read_deterministic(
    context: &Context,
    scenario: &Scenario,
    spec: &DeterministicSpec,
    grid: Grid,
) -> Result<Deterministic> {
    match spec {
        DeterministicSpec::Smooth {} => Ok(Deterministic::Smooth),
        DeterministicSpec::Sine(sine) => Ok(Deterministic::Sine {
            amplitude: sine.amplitude,
            wavelength: sine.wavelength,
            phase: sine.phase,
        }),
        DeterministicSpec::Profile(profile) => read_profile(context, scenario, profile, grid),
    }
}

/// A measured profile; how it was resampled is said.
fn read_profile(
    context: &Context,
    scenario: &Scenario,
    spec: &ProfileSpec,
    grid: Grid,
) -> Result<Deterministic> {
    let path = scenario.resolve(&spec.file);
    let columns = (
        spec.position_column.as_deref(),
        spec.height_column.as_deref(),
    );
    let (positions, mut heights) = tabulated::read_columns(&path, columns.0, columns.1)?;
    let (first, last) = (positions[0], positions[positions.len() - 1]);
    let (start, end) = (grid.position(0), grid.position(grid.count - 1));
    let margin = 1e-9 * (1.0 + end.abs());
    if first > start + margin || last < end - margin {
        let expected = format!(
            "a profile from {start} to {end} m, as irregularity.start and irregularity.length ask"
        );
        let error = super::bad_file(&path, "", expected, format!("one from {first} to {last} m"));
        return Err(error
            .remedy("shorten irregularity.length or measure further")
            .into());
    }
    context.note(format!(
        "{}: {} positions, {:.4} m apart on average, resampled to {} m by straight lines",
        path.display(),
        positions.len(),
        (last - first) / (positions.len() - 1) as f64,
        grid.spacing
    ));
    heights.iter_mut().for_each(|h| *h *= spec.scale);
    Ok(Deterministic::Profile { positions, heights })
}
