//! What is printed of a comparison.

use crate::files::tables::{ComparisonRow, Units};
use std::fmt::Write;

pub(super) struct Report<'a> {
    pub rows: &'a [ComparisonRow],
    pub levels: &'a [f64],
    pub units: &'a Units,
}

/// A measure: its name, with the unit after it, and its value in a row.
struct Measure {
    name: String,
    value: Box<dyn Fn(&ComparisonRow) -> f64>,
}

/// A time without the digits of its rounding: 0.7 for 0.7000000000000001.
pub(super) fn seconds(time: f64) -> String {
    let digits = format!("{time:.10e}");
    digits.parse::<f64>().unwrap_or(time).to_string()
}

/// A line; writing to a text can't fail.
macro_rules! line {
    ($text:expr, $($part:tt)*) => {{
        let _ = writeln!($text, $($part)*);
    }};
}

impl Report<'_> {
    /// For each quantity and measure the mean, the root of the mean square and the largest magnitude over the times.
    pub(super) fn summary(&self) -> String {
        let mut text = String::new();
        for rows in self.quantities() {
            self.head(&mut text, rows);
            line!(
                text,
                "  {:<36} {:>11} {:>11} {:>11}   at time (s)",
                "magnitude over the times",
                "mean",
                "r.m.s.",
                "largest"
            );
            for measure in self.measures(&rows[0].quantity) {
                let count = rows.len() as f64;
                let sizes = || rows.iter().map(|row| (measure.value)(row).abs());
                let mean = sizes().sum::<f64>() / count;
                let root = (sizes().map(|x| x * x).sum::<f64>() / count).sqrt();
                let (at, largest) = sizes()
                    .enumerate()
                    .reduce(|a, b| if b.1 > a.1 { b } else { a })
                    .unwrap_or_default();
                line!(
                    text,
                    "  {:<36} {mean:>11.3e} {root:>11.3e} {largest:>11.3e}   {}",
                    measure.name,
                    seconds(rows[at].time)
                );
            }
        }
        text
    }

    /// A line for each quantity and time.
    pub(super) fn each_time(&self) -> String {
        let mut text = String::new();
        for rows in self.quantities() {
            self.head(&mut text, rows);
            let measures = self.measures(&rows[0].quantity);
            for (number, measure) in measures.iter().enumerate() {
                line!(text, "  {:>3}  {}", number + 1, measure.name);
            }
            let mut titles = format!("  {:>12}", "time (s)");
            (1..=measures.len()).for_each(|number| titles += &format!(" {number:>11}"));
            line!(text, "{titles}");
            for row in rows {
                let mut values = format!("  {:>12}", seconds(row.time));
                for measure in &measures {
                    values += &format!(" {:>11.3e}", (measure.value)(row));
                }
                line!(text, "{values}");
            }
        }
        text
    }

    /// The rows of each quantity.
    fn quantities(&self) -> impl Iterator<Item = &[ComparisonRow]> {
        self.rows.chunk_by(|a, b| a.quantity == b.quantity)
    }

    fn head(&self, text: &mut String, rows: &[ComparisonRow]) {
        let [first, .., last] = rows else {
            line!(text, "{} at {} s", rows[0].quantity, seconds(rows[0].time));
            return;
        };
        let count = rows.len();
        let (from, to) = (seconds(first.time), seconds(last.time));
        line!(
            text,
            "{}, {count} times from {from} to {to} s",
            first.quantity
        );
    }

    fn measures(&self, quantity: &str) -> Vec<Measure> {
        let unit = match self.units.get(quantity).map(String::as_str) {
            Some("1") | None => String::new(),
            Some(unit) => format!(" ({unit})"),
        };
        let mut all: Vec<Measure> = Vec::new();
        let mut add = |name: String, value: Box<dyn Fn(&ComparisonRow) -> f64>| {
            all.push(Measure { name, value });
        };
        add("L1 distance".into(), Box::new(|row| row.l1));
        add(
            "total variation".into(),
            Box::new(|row| row.total_variation),
        );
        add(
            "Kolmogorov-Smirnov".into(),
            Box::new(|row| row.kolmogorov_smirnov),
        );
        add(
            format!("Wasserstein-1{unit}"),
            Box::new(|row| row.wasserstein_1),
        );
        add("Hellinger".into(), Box::new(|row| row.hellinger));
        add(
            format!("error of the mean{unit}"),
            Box::new(|row| row.mean_error),
        );
        add(
            "error of the mean / deviation".into(),
            Box::new(|row| row.mean_error / row.std),
        );
        add(
            format!("error of the deviation{unit}"),
            Box::new(|row| row.std_error),
        );
        add(
            "relative error of the deviation".into(),
            Box::new(|row| row.std_error / row.std),
        );
        for (index, level) in self.levels.iter().enumerate() {
            add(
                format!("error of the {level} quantile{unit}"),
                Box::new(move |row| row.quantile_errors[index]),
            );
        }
        all
    }
}
