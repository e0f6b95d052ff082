//! The figure of a reliability table: P_f over time.

use super::{Image, chosen, page};
use crate::Result;
use crate::cli;
use crate::files::tables::{ReliabilityRow, read_reliability};
use crate::plot::{FailureCurve, FailureProbability, with_unit};
use crate::scenario::{LimitKind, LimitSpec, ReliabilitySpec, Scenario};

/// A limit by a method, in columns.
struct Columns {
    limit: String,
    method: String,
    times: Vec<f64>,
    failure: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

pub(super) fn failure_probability(args: &cli::Plot) -> Result<Image> {
    let table = read_reliability(&args.input)?;
    let mut limits: Vec<&str> = table.rows.iter().map(|row| row.limit.as_str()).collect();
    limits.dedup();
    let only = args
        .quantity
        .as_ref()
        .map(|_| chosen(args, &limits))
        .transpose()?;
    let columns = columns(
        table
            .rows
            .iter()
            .filter(|row| only.is_none_or(|name| row.limit == name)),
    );
    let spec = table
        .provenance
        .as_ref()
        .and_then(|p| p.scenario.as_deref())
        .and_then(|text| Scenario::from_text("scenario", text).ok())
        .and_then(|scenario| scenario.reliability().ok());
    let unit = |limit: &str| table.units.get(limit).map_or("", String::as_str);
    let names: Vec<String> = columns
        .iter()
        .map(|c| in_words(&c.limit, unit(&c.limit), spec.as_ref()))
        .collect();
    let curves: Vec<FailureCurve<'_>> = columns
        .iter()
        .zip(&names)
        .map(|(c, name)| FailureCurve {
            limit: name,
            method: &c.method,
            times: &c.times,
            failure_probability: &c.failure,
            lower: &c.lower,
            upper: &c.upper,
        })
        .collect();
    let confidence: Vec<String> = spec
        .iter()
        .map(|spec| format!("bounds at {} confidence", percent(spec.confidence)))
        .collect();
    let page = page(
        "Probability of failure".to_owned(),
        table.provenance.as_ref(),
        &confidence,
    );
    FailureProbability { curves: &curves }.draw(&page)
}

/// A limit as `deflection: |bridge/midspan/displacement| > 95.5 mm`, where the scenario knows it.
fn in_words(name: &str, unit: &str, spec: Option<&ReliabilitySpec>) -> String {
    let limit = spec.and_then(|spec| spec.limit.iter().find(|limit| limit.name == name));
    let Some(LimitSpec {
        quantity,
        kind,
        threshold,
        ..
    }) = limit
    else {
        return name.to_owned();
    };
    let threshold = with_unit(*threshold, unit);
    match kind {
        LimitKind::Absolute => format!("{name}: |{quantity}| > {threshold}"),
        LimitKind::Upper => format!("{name}: {quantity} > {threshold}"),
        LimitKind::Lower => format!("{name}: {quantity} < {threshold}"),
    }
}

/// A fraction as `95 %`.
fn percent(fraction: f64) -> String {
    format!("{} %", with_unit(100.0 * fraction, ""))
}

fn columns<'a>(rows: impl Iterator<Item = &'a ReliabilityRow>) -> Vec<Columns> {
    let mut all: Vec<Columns> = Vec::new();
    for row in rows {
        let known = all
            .iter()
            .position(|c| c.limit == row.limit && c.method == row.method);
        let index = known.unwrap_or_else(|| {
            all.push(Columns {
                limit: row.limit.clone(),
                method: row.method.clone(),
                times: Vec::new(),
                failure: Vec::new(),
                lower: Vec::new(),
                upper: Vec::new(),
            });
            all.len() - 1
        });
        let columns = &mut all[index];
        columns.times.push(row.time);
        columns.failure.push(row.failure_probability);
        columns.lower.push(row.lower);
        columns.upper.push(row.upper);
    }
    all
}
