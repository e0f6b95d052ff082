//! `dpim excite`: representative points and their irregularities.

use super::{Context, excitation};
use crate::cli;
use crate::files::points::{PointsBatch, PointsHeader, PointsWriter, ROW_GROUP};
use crate::files::{Kind, OutputFile, Provenance, Weights, tabulated};
use crate::irregularity::{
    Deterministic, Grid, PowerSpectralDensity, SpectralRepresentation, Synthesis, Tabulated,
};
use crate::probability::PointRule;
use crate::scenario::{
    DeterministicSpec, IrregularitySpec, PointsSpec, ProfileSpec, Scenario, Sided, SpectrumSpec,
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
    let points = scenario.points()?;
    let source = Source::read(context, &scenario, &points)?;
    let dimensions = source
        .field
        .as_ref()
        .map_or(0, SpectralRepresentation::dimensions);
    let rule = points.build(dimensions);
    if rule.count() == 0 {
        let found = points.truncate_at.map_or_else(
            || "none".to_owned(),
            |at| format!("{at}, which leaves none"),
        );
        return Err(scenario
            .bad(
                "points.truncate_at",
                "a truncation that leaves points",
                found,
            )
            .into());
    }
    let header = PointsHeader {
        weights: Weights::Assigned,
        position_start: source.grid.start,
        position_step: source.grid.spacing,
        positions: source.grid.count,
        components: source.component.iter().map(|c| c.to_string()).collect(),
        parameters: Vec::new(),
        variables: 0,
        provenance: Provenance::stamp(
            Kind::Points,
            Some(scenario.text()),
            Some(points.seed),
            &[],
            &[],
        ),
    };
    context.detail(format!(
        "{} points by {}, {} variables, {} positions or times from {}, {}",
        rule.count(),
        points.rule.name(),
        dimensions,
        source.grid.count,
        source.grid.start,
        source.describe(),
    ));
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let writer = PointsWriter::create(output, &header)?;
    write(context, rule.as_ref(), &source, writer)
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
    source: &Source,
    mut writer: PointsWriter,
) -> Result<()> {
    struct Group {
        points: Range<usize>,
        rows: Vec<f64>,
    }
    let bar = context.progress("excite", rule.count() as u64);
    std::thread::scope(|scope| {
        let (full, groups) = sync_channel::<Group>(1);
        let (emptied, spare) = sync_channel::<Vec<f64>>(2);
        let written = scope.spawn(move || -> Result<PointsWriter> {
            for group in groups {
                let probability: Vec<f64> =
                    group.points.clone().map(|q| rule.probability(q)).collect();
                let rows = [group.rows.as_slice()];
                writer.write(&PointsBatch {
                    first_point: group.points.start as u32,
                    probability: &probability,
                    parameters: &[],
                    irregularity: if source.component.is_some() {
                        &rows
                    } else {
                        &[]
                    },
                    variables: &[],
                })?;
                // Memory that finds no room on its way back is let go.
                let _ = emptied.try_send(group.rows);
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
            let mut rows = spare.try_recv().unwrap_or_default();
            rows.resize(points.len() * source.grid.count, 0.0);
            source.fill(rule, points.start, &mut rows);
            bar.inc(points.len() as u64);
            if full.send(Group { points, rows }).is_err() {
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

/// Where the rows come from.
pub(super) struct Source {
    /// The column; none where nothing is given over positions or times.
    pub component: Option<&'static str>,
    pub grid: Grid,
    pub field: Option<SpectralRepresentation>,
    pub synthesis: Option<Synthesis>,
    /// The deterministic part at the positions.
    pub mean: Vec<f64>,
    /// A factor on everything, at each position.
    pub modulation: Option<Vec<f64>>,
}

impl Source {
    /// The irregularity or the excitation of a scenario; nothing for an oscillator that has none.
    fn read(context: &Context, scenario: &Scenario, points: &PointsSpec) -> Result<Self> {
        if scenario.has("excitation") {
            let spec = scenario.excitation()?;
            scenario.check_truncation(points, "excitation", spec.field)?;
            return excitation::source(context, scenario, &spec);
        }
        if scenario.has("oscillator") {
            return Ok(Source::none());
        }
        let spec = scenario.irregularity()?;
        scenario.check_truncation(points, "irregularity", spec.field)?;
        Source::new(context, scenario, &spec)
    }

    fn none() -> Self {
        Source {
            component: None,
            grid: Grid {
                start: 0.0,
                spacing: 1.0,
                count: 0,
            },
            field: None,
            synthesis: None,
            mean: Vec::new(),
            modulation: None,
        }
    }

    fn new(context: &Context, scenario: &Scenario, spec: &IrregularitySpec) -> Result<Self> {
        let grid = scenario.irregularity_grid(spec)?;
        let field = match (&spec.spectrum, &spec.wavenumber) {
            (Some(spectrum), Some(band)) => {
                let spectrum = read_spectrum(context, scenario, spectrum, band.max)?;
                let form = spec.field.build();
                Some(SpectralRepresentation::new(
                    spectrum.as_ref(),
                    form,
                    band.max,
                    band.count as usize,
                ))
            }
            _ => None,
        };
        let deterministic = match &spec.deterministic {
            Some(deterministic) => read_deterministic(context, scenario, deterministic, grid)?,
            None => Deterministic::Smooth,
        };
        Ok(Source {
            component: Some("vertical"),
            modulation: None,
            synthesis: field.as_ref().map(|field| Synthesis::new(field, grid)),
            mean: (0..grid.count)
                .map(|j| deterministic.height(grid.position(j)))
                .collect(),
            grid,
            field,
        })
    }

    fn describe(&self) -> String {
        match (&self.field, &self.synthesis) {
            (Some(field), Some(synthesis)) => format!(
                "standard deviation of the field {:.6e}, sums by {:?}",
                field.variance().sqrt(),
                synthesis.method()
            ),
            _ => "no random field".to_owned(),
        }
    }

    /// Fills `[point][position]` from the point `first` on.
    fn fill(&self, rule: &dyn PointRule, first: usize, rows: &mut [f64]) {
        let positions = self.grid.count;
        if positions == 0 {
            return;
        }
        rows.par_chunks_mut(PART * positions)
            .enumerate()
            .for_each_init(
                || (Vec::new(), Vec::new()),
                |(variables, coefficients), (part, rows)| {
                    for row in rows.chunks_exact_mut(positions) {
                        row.copy_from_slice(&self.mean);
                    }
                    let (Some(field), Some(synthesis)) = (&self.field, &self.synthesis) else {
                        return;
                    };
                    let count = rows.len() / positions;
                    let start = first + part * PART;
                    variables.resize(field.dimensions() * count, 0.0);
                    rule.standard_normals(start..start + count, variables);
                    if field.is_gaussian() {
                        synthesis.add(variables, count, rows);
                    } else {
                        coefficients.resize(2 * field.amplitudes().len() * count, 0.0);
                        field.coefficients(variables, count, coefficients);
                        synthesis.add(coefficients, count, rows);
                    }
                    let Some(modulation) = &self.modulation else {
                        return;
                    };
                    for row in rows.chunks_exact_mut(positions) {
                        row.iter_mut()
                            .zip(modulation)
                            .for_each(|(value, m)| *value *= m);
                    }
                },
            );
    }
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
