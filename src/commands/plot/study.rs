//! The figures of a study: the error over the number of points, and over the processor time.

use super::{Image, page};
use crate::Result;
use crate::cli;
use crate::files::tables::{StudyRow, read_study};
use crate::plot::{Convergence, ErrorCurve, ErrorPoint};

/// The number that a curve is drawn over.
type Abscissa = fn(&StudyRow) -> f64;

pub(super) fn convergence(args: &cli::Plot) -> Result<Image> {
    draw(
        args,
        "Error over the number of points",
        "Points, N",
        |row| row.count,
    )
}

pub(super) fn work(args: &cli::Plot) -> Result<Image> {
    let label = "Processor time of points, runs and densities (s)";
    draw(args, "Error over the processor time", label, |row| {
        row.cpu_time
    })
}

fn draw(args: &cli::Plot, title: &str, label: &str, abscissa: Abscissa) -> Result<Image> {
    let table = read_study(&args.input)?;
    let mut names: Vec<(&str, &str)> = Vec::new();
    for row in &table.rows {
        let name = (row.points.as_str(), row.smoothing.as_str());
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let l1: fn(&StudyRow) -> f64 = |row| row.l1;
    let sigma: fn(&StudyRow) -> f64 = |row| row.sigma_error;
    let mut curves = Vec::new();
    for (points, smoothing) in names {
        let rows = table.rows.iter();
        let rows: Vec<&StudyRow> = rows
            .filter(|row| row.points == points && row.smoothing == smoothing)
            .collect();
        curves.push(ErrorCurve {
            name: format!("{points} + {smoothing}"),
            measure: "L_{1} distance",
            points: medians(&rows, abscissa, l1),
        });
        curves.push(ErrorCurve {
            name: format!("{points} + {smoothing}"),
            measure: "Error of σ / σ",
            points: medians(&rows, abscissa, sigma),
        });
    }
    let case = table.rows.first().map(|row| row.case.clone());
    let remarks: Vec<String> = case
        .into_iter()
        .chain(["medians and quartiles over the seeds".to_owned()])
        .collect();
    let page = page(title.to_owned(), None, &remarks);
    Convergence {
        label,
        curves: &curves,
    }
    .draw(&page)
}

/// At each count the median and the quartiles of the error, over the median abscissa.
fn medians(rows: &[&StudyRow], abscissa: Abscissa, error: Abscissa) -> Vec<ErrorPoint> {
    let mut counts: Vec<f64> = rows.iter().map(|row| row.count).collect();
    counts.sort_by(f64::total_cmp);
    counts.dedup();
    let at = |count: f64| {
        let of = |value: Abscissa| {
            let rows = rows.iter().filter(|row| row.count == count);
            let mut values: Vec<f64> = rows.map(|row| value(row)).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let errors = of(error);
        ErrorPoint {
            x: quantile(&of(abscissa), 0.5),
            lower: quantile(&errors, 0.25),
            median: quantile(&errors, 0.5),
            upper: quantile(&errors, 0.75),
        }
    };
    let mut points: Vec<ErrorPoint> = counts.into_iter().map(at).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    points
}

/// A quantile of ascending values, straight lines between them.
fn quantile(values: &[f64], level: f64) -> f64 {
    let place = level * (values.len() - 1) as f64;
    let (left, part) = (place.floor() as usize, place.fract());
    let right = (left + 1).min(values.len() - 1);
    values[left] + part * (values[right] - values[left])
}
