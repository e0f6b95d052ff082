//! `dpim excite`: representative points and their irregularities.

use super::Context;
use super::random::{Drawn, Leading};
use super::source::Source;
use crate::cli;
use crate::files::points::{PointsBatch, PointsHeader, PointsWriter, ROW_GROUP};
use crate::files::{Kind, OutputFile, Provenance, Weights};
use crate::irregularity::Irregularity;
use crate::probability::discrepancy::Quality;
use crate::probability::{PointRule, UnitVectors};
use crate::scenario::{IrregularitySpec, PointsSpec, Scenario};
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
    let (source, chosen) = if args.pseudo_excitation {
        let spec = scenario.irregularity()?;
        let source = Source::irregularity(context, &scenario, &spec)?;
        let chosen = harmonics(&scenario, &spec, &source.irregularity)?;
        (source, chosen)
    } else {
        let points = scenario.points()?;
        let source = Source::read(context, &scenario, &points)?;
        let chosen = representative_points(context, &scenario, &points, &source.irregularity)?;
        (source, chosen)
    };
    let rule = chosen.rule.as_ref();
    let grid = source.irregularity.grid();
    let header = PointsHeader {
        weights: chosen.weights,
        position_start: grid.start,
        position_step: grid.spacing,
        positions: grid.count,
        components: source.component.iter().map(|c| c.to_string()).collect(),
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
        "{} points by {}, {} variables, {} positions or times from {}, {}",
        rule.count(),
        chosen.name,
        rule.dimensions(),
        grid.count,
        grid.start,
        source.irregularity.describe(),
    ));
    if !args.pseudo_excitation {
        report(context, rule);
    }
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let writer = PointsWriter::create(output, &header)?;
    write(context, rule, &chosen.leading, &source, writer)
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
    points: &PointsSpec,
    irregularity: &Irregularity,
) -> Result<Chosen> {
    let leading = Leading::read(context, scenario, points, irregularity.dimensions())?;
    let parameters = leading.random.dimensions();
    let dimensions = parameters + irregularity.dimensions();
    let rule = scenario.point_rule(points, dimensions, parameters)?;
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
    source: &Source,
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
                let rows = [group.rows.as_slice()];
                writer.write(&PointsBatch {
                    first_point: group.points.start as u32,
                    probability: &probability,
                    parameters: &group.drawn.parameters,
                    irregularity: &rows[..usize::from(source.component.is_some())],
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
            rows.resize(points.len() * source.irregularity.grid().count, 0.0);
            let irregularity = &source.irregularity;
            fill(
                rule,
                leading,
                irregularity,
                points.clone(),
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

/// Fills `[point][position]` of these points, and what is drawn beside.
fn fill(
    rule: &dyn PointRule,
    leading: &Leading,
    irregularity: &Irregularity,
    points: Range<usize>,
    rows: &mut [f64],
    drawn: &mut Drawn,
) {
    let positions = irregularity.grid().count;
    let pieces = drawn.pieces(leading, points.len(), PART);
    let mut rest = rows;
    let parts: Vec<_> = points
        .clone()
        .step_by(PART)
        .zip(pieces)
        .map(|(first, piece)| {
            let part = first..(first + PART).min(points.end);
            let (rows, behind) = std::mem::take(&mut rest).split_at_mut(part.len() * positions);
            rest = behind;
            (part, piece, rows)
        })
        .collect();
    parts
        .into_par_iter()
        .for_each_init(Vec::new, |variables, (part, piece, rows)| {
            let count = part.len();
            variables.resize(rule.dimensions() * count, 0.0);
            rule.standard_normals(part, variables);
            irregularity.fill(piece.take(variables), count, rows);
        });
}
