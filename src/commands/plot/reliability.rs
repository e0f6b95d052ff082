//! The figure of a reliability table: P_f over time.

use super::{Image, chosen, page};
use crate::Result;
use crate::cli;
use crate::files::tables::{ReliabilityRow, read_reliability};
use crate::plot::{FailureCurve, FailureProbability};

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
    let curves: Vec<FailureCurve<'_>> = columns
        .iter()
        .map(|c| FailureCurve {
            limit: &c.limit,
            method: &c.method,
            times: &c.times,
            failure_probability: &c.failure,
            lower: &c.lower,
            upper: &c.upper,
        })
        .collect();
    let page = page(
        "Probability of failure".to_owned(),
        table.provenance.as_ref(),
        &[],
    );
    FailureProbability { curves: &curves }.draw(&page)
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
