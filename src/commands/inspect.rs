//! `dpim inspect`: what a file is.

use crate::Result;
use crate::cli;
use crate::files::points::{PointsReader, component_unit, is_in_time};
use crate::files::recording::{Axis, Recordings};
use crate::files::tables::{
    StudyRow, Units, read_comparison, read_density, read_moments, read_reliability, read_study,
};
use crate::files::{Kind, Provenance, Weights, identify};
use crate::response::effective_count;
use std::fmt::Write;
use std::path::Path;

pub(super) fn run(args: &cli::Inspect) -> Result<()> {
    let path = &args.file;
    let kind = identify(path)?;
    let mut text = String::new();
    match kind {
        Kind::Points => points(path, &mut text)?,
        Kind::Recording => recording(path, &mut text)?,
        Kind::Density | Kind::Extremes => density(path, &mut text)?,
        Kind::Moments => moments(path, &mut text)?,
        Kind::Reliability => reliability(path, &mut text)?,
        Kind::Comparison => comparison(path, &mut text)?,
        Kind::Study => study(path, &mut text)?,
    }
    super::print(&text)
}

/// A line; writing to a text can't fail.
macro_rules! line {
    ($text:expr, $($part:tt)*) => {{
        let _ = writeln!($text, $($part)*);
    }};
}

fn stamp(path: &Path, kind: Kind, provenance: Option<&Provenance>, text: &mut String) {
    line!(text, "{}: {}", path.display(), kind.name());
    let Some(stamp) = provenance else {
        line!(text, "no stamp: written by another program");
        return;
    };
    line!(
        text,
        "format version {}, dpim {}",
        stamp.kind.format_version(),
        stamp.tool_version
    );
    line!(text, "identity {}", stamp.identity);
    for input in stamp.inputs.iter().filter(|input| !input.is_empty()) {
        line!(text, "made from {input}");
    }
    if let Some(seed) = stamp.seed {
        line!(text, "seed {seed}");
    }
    if let Some(scenario) = &stamp.scenario {
        let title = crate::scenario::Scenario::from_text("scenario", scenario).ok();
        let title = title
            .as_ref()
            .and_then(|s| s.title())
            .unwrap_or("without a title");
        line!(
            text,
            "scenario: {title} ({} lines)",
            scenario.lines().count()
        );
    }
}

/// Least and largest of numbers.
#[derive(Clone, Copy)]
struct Span(f64, f64);

impl Span {
    const NONE: Span = Span(f64::INFINITY, f64::NEG_INFINITY);

    fn add(&mut self, values: &[f64]) {
        for value in values {
            self.0 = self.0.min(*value);
            self.1 = self.1.max(*value);
        }
    }
}

impl std::fmt::Display for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.6e} ... {:.6e}", self.0, self.1)
    }
}

/// What the points are, and their probabilities.
fn weights(weights: Weights, probability: &[f64]) -> String {
    match weights {
        Weights::Assigned | Weights::Importance => {
            let sum: f64 = probability.iter().sum();
            format!("{} probabilities, sum {sum:.12}", weights.name())
        }
        Weights::Harmonics => {
            "a pseudo-excitation: point 0 without, all others with one harmonic".to_owned()
        }
    }
}

fn points(path: &Path, text: &mut String) -> Result<()> {
    let reader = PointsReader::open(path)?;
    let header = reader.header();
    stamp(path, Kind::Points, header.provenance.as_ref(), text);
    line!(
        text,
        "{} points, {}{}",
        header.count,
        weights(header.weights, &header.probability),
        match header.weights {
            Weights::Assigned | Weights::Importance => {
                let count = effective_count(&header.probability);
                format!(", effective number {count:.1}")
            }
            Weights::Harmonics => String::new(),
        }
    );
    if header.variables > 0 {
        line!(text, "{} leading variables a point", header.variables);
    }
    let in_time = header.components.iter().any(|name| is_in_time(name));
    let (places, unit) = if in_time {
        ("times", "s")
    } else {
        ("positions", "m")
    };
    if header.positions > 0 {
        line!(
            text,
            "{} {places} from {} {unit}, {} {unit} apart, to {} {unit}",
            header.positions,
            header.position_start,
            header.position_step,
            header.position_start + (header.positions as f64 - 1.0) * header.position_step
        );
    }
    let mut spans = vec![Span::NONE; header.components.len()];
    let mut parameters = vec![Span::NONE; header.parameters.len()];
    let mut batch = Default::default();
    let mut batches = reader.batches(0..header.count, 1024)?;
    while batches.read_into(&mut batch)? {
        spans
            .iter_mut()
            .zip(&batch.irregularity)
            .for_each(|(span, values)| span.add(values));
        parameters
            .iter_mut()
            .zip(&batch.parameters)
            .for_each(|(span, values)| span.add(values));
    }
    for ((name, unit), span) in header.parameters.iter().zip(parameters) {
        line!(text, "  {name} [{unit}] {span}");
    }
    for (name, span) in header.components.iter().zip(spans) {
        line!(text, "  {name} [{}] {span}", component_unit(name));
    }
    Ok(())
}

fn recording(path: &Path, text: &mut String) -> Result<()> {
    let recording = Recordings::open_part(&[path.to_owned()])?;
    let member = recording.members().next();
    stamp(
        path,
        Kind::Recording,
        member.and_then(|m| m.provenance),
        text,
    );
    let ranges: Vec<String> = member
        .iter()
        .flat_map(|m| m.points.iter().map(|r| format!("{}..{}", r.start, r.end)))
        .collect();
    line!(
        text,
        "{} of {} points ({}), {}",
        recording.points(),
        recording.points_total(),
        ranges.join(", "),
        weights(recording.weights(), recording.probability())
    );
    if let (Some(first), Some(last)) = (recording.times().first(), recording.times().last()) {
        line!(
            text,
            "{} times from {first} to {last} s",
            recording.times().len()
        );
    }
    let count = recording.quantities().len();
    let mut spans = vec![Span::NONE; count];
    recording.scan(&(0..count).collect::<Vec<_>>(), |blocks| {
        blocks
            .iter()
            .for_each(|block| spans[block.quantity].add(block.values));
        Ok(())
    })?;
    for (quantity, span) in recording.quantities().iter().zip(spans) {
        let axis = match quantity.axis {
            Axis::Time => "",
            Axis::Point => " (one value a point)",
        };
        line!(
            text,
            "  /{} [{}]{axis} {span}",
            quantity.name,
            quantity.unit
        );
    }
    recording
        .notes()
        .iter()
        .for_each(|note| line!(text, "note: {note}"));
    Ok(())
}

/// Groups in their first order, and a text for each.
fn groups<T>(rows: &[T], name: impl Fn(&T) -> String, mut each: impl FnMut(&str, &[&T])) {
    let mut order: Vec<String> = Vec::new();
    rows.iter().map(&name).for_each(|n| {
        if !order.contains(&n) {
            order.push(n);
        }
    });
    for group in order {
        let members: Vec<&T> = rows.iter().filter(|row| name(row) == group).collect();
        each(&group, &members);
    }
}

fn unit<'a>(units: &'a Units, name: &str) -> &'a str {
    units.get(name).map_or("?", String::as_str)
}

fn density(path: &Path, text: &mut String) -> Result<()> {
    let table = read_density(path)?;
    stamp(path, identify(path)?, table.provenance.as_ref(), text);
    groups(
        &table.slices,
        |s| s.quantity.clone(),
        |name, slices| {
            let (mut times, mut values, mut peaks) = (Span::NONE, Span::NONE, Span::NONE);
            for slice in slices {
                times.add(&[slice.time]);
                values.add(&slice.value);
                peaks.add(&[slice.density.iter().copied().fold(0.0, f64::max)]);
            }
            let unit = unit(&table.units, name);
            line!(
                text,
                "  {name} [{unit}] {} times from {} to {} s",
                slices.len(),
                times.0,
                times.1
            );
            line!(text, "    values {values}, peaks of the density {peaks}");
        },
    );
    Ok(())
}

fn moments(path: &Path, text: &mut String) -> Result<()> {
    let table = read_moments(path)?;
    stamp(path, Kind::Moments, table.provenance.as_ref(), text);
    groups(
        &table.rows,
        |r| r.quantity.clone(),
        |name, rows| {
            let (mut mean, mut deviation) = (Span::NONE, Span::NONE);
            for row in rows {
                mean.add(&[row.mean]);
                deviation.add(&[row.std]);
            }
            let unit = unit(&table.units, name);
            line!(text, "  {name} [{unit}] {} times", rows.len());
            line!(text, "    mean {mean}, standard deviation {deviation}");
        },
    );
    Ok(())
}

fn reliability(path: &Path, text: &mut String) -> Result<()> {
    let table = read_reliability(path)?;
    stamp(path, Kind::Reliability, table.provenance.as_ref(), text);
    groups(
        &table.rows,
        |r| format!("{} by {}", r.limit, r.method),
        |name, rows| {
            if let Some(row) = rows.last() {
                line!(
                    text,
                    "  {name}: P_f({} s) = {:.6e} ({:.3e} to {:.3e})",
                    row.time,
                    row.failure_probability,
                    row.lower,
                    row.upper
                );
            }
        },
    );
    Ok(())
}

fn study(path: &Path, text: &mut String) -> Result<()> {
    let table = read_study(path)?;
    stamp(path, Kind::Study, table.provenance.as_ref(), text);
    groups(
        &table.rows,
        |r| format!("{} + {}, {} points", r.points, r.smoothing, r.count),
        |name, rows| {
            let mean = |value: fn(&StudyRow) -> f64| {
                rows.iter().map(|row| value(row)).sum::<f64>() / rows.len() as f64
            };
            line!(
                text,
                "  {name}: {} seed(s), means: L1 {:.3e}, error of sigma {:.3e}, {:.3} s",
                rows.len(),
                mean(|row| row.l1),
                mean(|row| row.sigma_error),
                mean(|row| row.cpu_time)
            );
        },
    );
    Ok(())
}

fn comparison(path: &Path, text: &mut String) -> Result<()> {
    let table = read_comparison(path)?;
    stamp(path, Kind::Comparison, table.provenance.as_ref(), text);
    groups(
        &table.rows,
        |r| r.quantity.clone(),
        |name, rows| {
            let (mut times, mut l1, mut deviation) = (Span::NONE, Span::NONE, Span::NONE);
            for row in rows {
                times.add(&[row.time]);
                l1.add(&[row.l1]);
                deviation.add(&[row.std_error / row.std]);
            }
            let unit = unit(&table.units, name);
            line!(
                text,
                "  {name} [{unit}] {} times from {} to {} s",
                rows.len(),
                times.0,
                times.1
            );
            line!(
                text,
                "    L1 distances {l1}, relative errors of the standard deviation {deviation}"
            );
        },
    );
    Ok(())
}
