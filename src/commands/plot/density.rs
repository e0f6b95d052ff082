//! Figures of a density table: heat map, surface, slices.

use super::{Axis, Image, chosen, page, value_axis};
use crate::cli;
use crate::files::Kind;
use crate::files::tables::{DensitySlice, DensityTable, read_density};
use crate::plot::{DensityAtTime, DensityScale, HeatMap, Page, Slices, Statistics, Surface};
use crate::scenario::{Scenario, SmoothingSpec};
use crate::{BadInput, Result};

/// One quantity of a table.
struct Chosen {
    table: DensityTable,
    name: String,
}

impl Chosen {
    fn read(args: &cli::Plot) -> Result<Self> {
        let table = read_density(&args.input)?;
        let mut names: Vec<&str> = table.slices.iter().map(|s| s.quantity.as_str()).collect();
        names.dedup();
        let name = chosen(args, &names)?.to_owned();
        Ok(Chosen { table, name })
    }

    fn slices(&self) -> impl Iterator<Item = &DensitySlice> {
        self.table.slices.iter().filter(|s| s.quantity == self.name)
    }

    fn densities(&self) -> Vec<DensityAtTime<'_>> {
        self.slices()
            .map(|slice| DensityAtTime {
                time: slice.time,
                values: &slice.value,
                densities: &slice.density,
            })
            .collect()
    }

    fn axis(&self) -> Axis {
        Axis::of(
            &self.name,
            self.table.units.get(&self.name).map_or("", String::as_str),
        )
    }

    fn page(&self, what: &str) -> Page {
        let provenance = self.table.provenance.as_ref();
        let smoothing = provenance
            .and_then(|p| p.scenario.as_deref())
            .and_then(|text| Scenario::from_text("scenario", text).ok())
            .and_then(|scenario| {
                if self.of_extremes() {
                    scenario
                        .reliability()
                        .ok()
                        .map(|spec| spec.smoothing.into())
                } else {
                    scenario.density().ok().map(|spec| spec.smoothing)
                }
            });
        let remarks: Vec<String> = if self.is_exact() {
            vec!["exact".to_owned()]
        } else {
            smoothing.map(smoothing_in_words).into_iter().collect()
        };
        page(
            format!("{}: {what}", self.axis().name),
            provenance,
            &remarks,
        )
    }

    /// Whether the table was made from nothing but its scenario.
    fn is_exact(&self) -> bool {
        let provenance = self.table.provenance.as_ref();
        provenance.is_some_and(|p| p.inputs.is_empty())
    }

    /// Whether the table holds extreme values, one density a limit.
    fn of_extremes(&self) -> bool {
        let provenance = self.table.provenance.as_ref();
        provenance.is_some_and(|p| p.kind == Kind::Extremes)
    }
}

fn smoothing_in_words(spec: SmoothingSpec) -> String {
    match spec {
        SmoothingSpec::Automatic => "smoothed by a rule chosen automatically".to_owned(),
        SmoothingSpec::Silverman => "smoothed by Silverman's rule".to_owned(),
        SmoothingSpec::NormalReference => "smoothed by the normal reference rule".to_owned(),
        SmoothingSpec::Factor(spec) => format!("smoothed by the rule of factor {}", spec.factor),
        SmoothingSpec::Fixed(_) => "smoothed by a fixed width".to_owned(),
        SmoothingSpec::SheatherJones => "smoothed by the rule of Sheather and Jones".to_owned(),
        SmoothingSpec::VarianceCorrected => "smoothed by the variance-corrected kernel".to_owned(),
        SmoothingSpec::Adaptive => "smoothed as near to normal as the responses are".to_owned(),
        SmoothingSpec::CellImage(_) => "images of the points' cells".to_owned(),
        SmoothingSpec::ControlVariate => "by regression on the leading variables".to_owned(),
    }
}

pub(super) fn heat_map(args: &cli::Plot) -> Result<Image> {
    let chosen = Chosen::read(args)?;
    if args.figure.is_none() && chosen.slices().count() == 1 {
        // One value a point has one density.
        return slices(args);
    }
    HeatMap {
        label: chosen.axis().label(),
        densities: &chosen.densities(),
        statistics: Some(&statistics(&chosen)),
        value_axis: value_axis(args),
        density_scale: DensityScale::default(),
    }
    .draw(&chosen.page("evolution of the probability density"))
}

pub(super) fn surface(args: &cli::Plot) -> Result<Image> {
    let chosen = Chosen::read(args)?;
    Surface {
        label: chosen.axis().label(),
        densities: &chosen.densities(),
        value_axis: value_axis(args),
        density_scale: DensityScale::Linear,
    }
    .draw(&chosen.page("probability density surface"))
}

pub(super) fn slices(args: &cli::Plot) -> Result<Image> {
    let chosen = Chosen::read(args)?;
    let densities = chosen.densities();
    if let Some(bad) = args.at.iter().find(|t| !t.is_finite()) {
        return Err(BadInput::new("--at", "", "times (s)", bad.to_string()).into());
    }
    let times = if args.at.is_empty() {
        quarters(&densities)
    } else {
        args.at.clone()
    };
    Slices {
        label: chosen.axis().label(),
        densities: &densities,
        times: &times,
        reference: None,
        value_axis: value_axis(args),
    }
    .draw(&chosen.page(if chosen.of_extremes() {
        "probability density of the extreme value"
    } else {
        "probability density at given times"
    }))
}

/// A quarter, half and three quarters of the time.
fn quarters(densities: &[DensityAtTime<'_>]) -> Vec<f64> {
    let last = densities.len().saturating_sub(1);
    let mut times: Vec<f64> = [1, 2, 3]
        .iter()
        .filter_map(|k| densities.get(k * last / 4))
        .map(|d| d.time)
        .collect();
    times.dedup();
    times
}

/// Mean and quantiles from the cumulative columns.
fn statistics(chosen: &Chosen) -> Statistics {
    let column = |f: &dyn Fn(&DensitySlice) -> f64| chosen.slices().map(f).collect::<Vec<f64>>();
    Statistics {
        times: column(&|slice| slice.time),
        mean: column(&mean),
        quantile_05: column(&|slice| quantile(slice, 0.05)),
        quantile_25: column(&|slice| quantile(slice, 0.25)),
        quantile_75: column(&|slice| quantile(slice, 0.75)),
        quantile_95: column(&|slice| quantile(slice, 0.95)),
    }
}

/// Each cell's probability at its middle.
fn mean(slice: &DensitySlice) -> f64 {
    let cells = slice.value.windows(2).zip(slice.cumulative.windows(2));
    let (sum, mass) = cells.fold((0.0, 0.0), |(sum, mass), (y, f)| {
        let share = f[1] - f[0];
        (sum + 0.5 * (y[0] + y[1]) * share, mass + share)
    });
    sum / mass
}

fn quantile(slice: &DensitySlice, level: f64) -> f64 {
    let above = slice.cumulative.partition_point(|f| *f < level);
    let above = above.clamp(1, slice.value.len() - 1);
    let (f0, f1) = (slice.cumulative[above - 1], slice.cumulative[above]);
    let (y0, y1) = (slice.value[above - 1], slice.value[above]);
    if f1 > f0 {
        y0 + (y1 - y0) * ((level - f0) / (f1 - f0)).clamp(0.0, 1.0)
    } else {
        y0
    }
}
