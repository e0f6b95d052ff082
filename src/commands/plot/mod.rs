//! `dpim plot`: figures from any of the files.

mod comparison;
mod density;
mod points;
mod recording;
mod reliability;
mod study;

use super::Context;
use crate::cli::{self, Figure};
use crate::files::output::write_error;
use crate::files::{Kind, OutputFile, Provenance, identify};
use crate::plot::{Image, Label, Page, ValueAxis};
use crate::quantity::Quantity;
use crate::scenario::Scenario;
use crate::{BadInput, Result};
use clap::ValueEnum;
use std::io::Write;

/// Pixels of a PNG for each of the SVG's.
const SCALE: f64 = 2.0;

pub(super) fn run(context: &Context, args: &cli::Plot) -> Result<()> {
    let format = Format::of(args)?;
    super::check_distinct(&[&args.input], &[("--output", &args.output.output)])?;
    let kind = identify(&args.input)?;
    let figure = figure(args, kind)?;
    let image = match figure {
        Figure::Samples => points::samples(args),
        Figure::Periodogram => points::periodogram(context, args),
        Figure::Fan => recording::fan(args),
        Figure::HeatMap => density::heat_map(args),
        Figure::Surface => density::surface(args),
        Figure::Slices => density::slices(args),
        Figure::Distances => comparison::distances(args),
        Figure::Convergence => study::convergence(args),
        Figure::Work => study::work(args),
        Figure::FailureProbability => reliability::failure_probability(args),
    }?;
    let bytes = match format {
        Format::Svg => image.svg.into_bytes(),
        Format::Png => image.to_png(SCALE)?,
    };
    let mut output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    output
        .write_all(&bytes)
        .map_err(|e| write_error(&args.output.output, e))?;
    output.commit()
}

enum Format {
    Svg,
    Png,
}

impl Format {
    fn of(args: &cli::Plot) -> Result<Self> {
        let path = &args.output.output;
        match path
            .extension()
            .and_then(|e| e.to_str())
            .map(str::to_ascii_lowercase)
            .as_deref()
        {
            Some("svg") => Ok(Format::Svg),
            Some("png") => Ok(Format::Png),
            _ => Err(BadInput::new(
                "--output",
                "",
                "a name that ends in .svg or .png",
                path.display().to_string(),
            )
            .into()),
        }
    }
}

/// The figures of a kind of file, the default first.
fn figures(kind: Kind) -> &'static [Figure] {
    match kind {
        Kind::Points => &[Figure::Samples, Figure::Periodogram],
        Kind::Recording => &[Figure::Fan],
        Kind::Density => &[Figure::HeatMap, Figure::Surface, Figure::Slices],
        Kind::Extremes => &[Figure::Slices],
        Kind::Reliability => &[Figure::FailureProbability],
        Kind::Comparison => &[Figure::Distances],
        Kind::Study => &[Figure::Convergence, Figure::Work],
        Kind::Moments => &[],
    }
}

fn figure(args: &cli::Plot, kind: Kind) -> Result<Figure> {
    let known = figures(kind);
    let name = |figure: &Figure| {
        figure
            .to_possible_value()
            .map_or(String::new(), |v| v.get_name().to_owned())
    };
    let wanted = match args.figure {
        // Times ask for slices where the kind has them.
        None if !args.at.is_empty() && known.contains(&Figure::Slices) => Some(Figure::Slices),
        None => known.first().copied(),
        Some(figure) => known.contains(&figure).then_some(figure),
    };
    wanted.ok_or_else(|| {
        let all = known.iter().map(name).collect::<Vec<_>>().join(", ");
        let expected = if all.is_empty() {
            "a points file, a recording, a table of densities, extremes or reliability, a comparison".to_owned()
        } else {
            format!("a figure of this kind of file: {all}")
        };
        let found = args.figure.as_ref().map_or_else(
            || kind.name().to_owned(),
            |f| format!("{} of {}", name(f), kind.name()),
        );
        super::bad_file(&args.input, "", expected, found).into()
    })
}

fn value_axis(args: &cli::Plot) -> ValueAxis {
    match args.axis {
        cli::ValueAxis::Auto => ValueAxis::Automatic,
        cli::ValueAxis::Value => ValueAxis::Value,
        cli::ValueAxis::Deviation => ValueAxis::DeviationFromMean,
    }
}

/// The quantity asked for, or the first one.
fn chosen<'a>(args: &cli::Plot, names: &[&'a str]) -> Result<&'a str> {
    let Some(wanted) = &args.quantity else {
        return names.first().copied().ok_or_else(|| {
            super::bad_file(&args.input, "", "at least one quantity", "none").into()
        });
    };
    let wanted = wanted.trim_start_matches('/');
    names.iter().copied().find(|n| *n == wanted).ok_or_else(|| {
        let error = BadInput::new(
            "--quantity",
            "",
            format!("one of {}", names.join(", ")),
            wanted,
        );
        match crate::scenario::nearest(wanted, names.iter().copied()) {
            Some(near) => error.remedy(format!("did you mean {near}?")).into(),
            None => error.into(),
        }
    })
}

/// Name, symbol and unit of a quantity for an axis.
struct Axis {
    name: String,
    symbol: String,
    unit: String,
}

impl Axis {
    fn of(name: &str, unit: &str) -> Self {
        let words = name.replace(['/', '_'], " ");
        let mut letters = words.chars();
        let name_in_words = letters
            .next()
            .map(|c| c.to_uppercase().chain(letters).collect())
            .unwrap_or_default();
        let symbol = Quantity::named(name.strip_suffix("/filtered").unwrap_or(name))
            .map(|q| q.symbol())
            .unwrap_or_default();
        Axis {
            name: name_in_words,
            symbol: symbol.replace('₁', "_{1}").replace('₂', "_{2}"),
            unit: unit.to_owned(),
        }
    }

    fn label(&self) -> Label<'_> {
        Label {
            name: &self.name,
            symbol: &self.symbol,
            unit: &self.unit,
        }
    }
}

/// A page with the case's title below the figure's.
fn page(title: String, provenance: Option<&Provenance>, remarks: &[String]) -> Page {
    let scenario = provenance
        .and_then(|p| p.scenario.as_deref())
        .and_then(|text| Scenario::from_text("scenario", text).ok());
    let case = scenario
        .as_ref()
        .and_then(Scenario::title)
        .map(str::to_owned);
    let said: Vec<String> = case.into_iter().chain(remarks.iter().cloned()).collect();
    Page::new(title, said.join(" · "))
}
