//! The figure of a comparison: distances over time.

use super::{Axis, Image, chosen, page};
use crate::Result;
use crate::cli;
use crate::files::tables::{ComparisonRow, read_comparison};
use crate::plot::{DistanceCurve, DistancesOverTime};

/// A measure: its name in the picture, whether it is the error of a number, and its magnitude without unit.
type Measure = (&'static str, bool, fn(&ComparisonRow) -> f64);

const MEASURES: [Measure; 6] = [
    ("L_{1} distance", false, |row| row.l1),
    ("Hellinger", false, |row| row.hellinger),
    ("Kolmogorov–Smirnov", false, |row| row.kolmogorov_smirnov),
    ("Wasserstein-1 / σ", false, |row| {
        row.wasserstein_1 / row.std
    }),
    ("|mean error| / σ", true, |row| {
        (row.mean_error / row.std).abs()
    }),
    ("|σ error| / σ", true, |row| {
        (row.std_error / row.std).abs()
    }),
];

/// A quantity's times, and its values by each measure.
struct Columns {
    name: String,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
}

pub(super) fn distances(args: &cli::Plot) -> Result<Image> {
    let table = read_comparison(&args.input)?;
    let mut names: Vec<&str> = table.rows.iter().map(|row| row.quantity.as_str()).collect();
    names.dedup();
    if args.quantity.is_some() || names.is_empty() {
        names = vec![chosen(args, &names)?];
    }
    let columns: Vec<Columns> = names
        .iter()
        .map(|name| {
            let rows = || table.rows.iter().filter(|row| row.quantity == *name);
            Columns {
                name: Axis::of(name, "").name,
                times: rows().map(|row| row.time).collect(),
                values: MEASURES
                    .iter()
                    .map(|(_, _, value)| rows().map(value).collect())
                    .collect(),
            }
        })
        .collect();
    let curves: Vec<DistanceCurve<'_>> = columns
        .iter()
        .flat_map(|columns| {
            let measures = MEASURES.iter().zip(&columns.values);
            measures.map(|((measure, is_error, _), values)| DistanceCurve {
                quantity: &columns.name,
                measure,
                is_error: *is_error,
                times: &columns.times,
                values,
            })
        })
        .collect();
    let page = page(
        "Distances between two probability densities".to_owned(),
        table.provenance.as_ref(),
        &["σ is the standard deviation of the second".to_owned()],
    );
    DistancesOverTime { curves: &curves }.draw(&page)
}
