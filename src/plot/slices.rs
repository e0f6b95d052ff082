//! Densities at given times, as curves.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::Stroke;
use super::check;
use super::colour::{BLACK, ordered_colour};
use super::density::{DensityAtTime, Slice};
use super::fan::value_label;
use super::heat_map::density_label;
use super::lines::thinned;
use super::page::{Entry, Page, plot_area};
use super::statistics::{Statistics, ValueAxis, range};
use super::ticks::in_words;
use super::units::{Label, Unit};
use super::{Image, RIGHT_MARGIN};
use crate::Result;

/// A curve to compare each density with, dashed.
#[derive(Clone, Copy)]
pub enum Reference<'a> {
    /// The normal density of the same mean and standard deviation.
    Normal,
    /// A density of (time in s, value), both in SI units.
    Given {
        name: &'a str,
        density: &'a dyn Fn(f64, f64) -> f64,
    },
}

/// Densities at some times.
#[derive(Clone)]
pub struct Slices<'a> {
    pub label: Label<'a>,
    /// All times, ascending: the nearest to each of `times` is drawn.
    pub densities: &'a [DensityAtTime<'a>],
    /// The times asked for, s.
    pub times: &'a [f64],
    pub reference: Option<Reference<'a>>,
    pub value_axis: ValueAxis,
}

const PICTURE: &str = "plot of the densities";
/// A density of more than so many times what half of the probability does not exceed has a pole, which would
/// leave nothing else to see: the axis then ends ...
const POLE: f64 = 25.0;
/// ... at so many times that.
const CUT: f64 = 4.0;

impl Slices<'_> {
    /// Draws them.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where no time is asked for, none is there, or a density is none.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        let slices = self.nearest()?;
        let mut statistics = Statistics::default();
        for slice in &slices {
            statistics.push(slice.density.time, slice.mean, |q| slice.quantile(q));
        }
        let deviates = statistics.deviates(self.value_axis);
        let origin = |slice: &Slice<'_>| if deviates { slice.mean } else { 0.0 };
        let edges = |slice: &Slice<'_>| [0.0005, 0.9995].map(|q| slice.quantile(q) - origin(slice));
        let (low, high) = range(slices.iter().flat_map(edges));
        let unit = Unit::suiting(self.label.unit, low.abs().max(high.abs()));
        let x = Axis::with_room(
            value_label(&self.label, &unit, deviates),
            unit.factor * low,
            unit.factor * high,
        );
        let curves: Vec<Curves> = slices
            .iter()
            .map(|s| self.curves(s, origin(s), &x, &unit))
            .collect();
        let drawn = curves
            .iter()
            .flat_map(|c| c.density.iter().chain(&c.reference));
        let (_, highest) = range(drawn.map(|point| point.1));
        let (_, usual) = range(curves.iter().map(|c| usual(&c.density)));
        let has_pole = highest > POLE * usual;
        let remark = has_pole.then(|| "peaks are cut".to_owned());
        let top = if has_pole {
            CUT * usual
        } else {
            1.06 * highest
        };
        let y = Axis::linear(density_label(&self.label, &unit), 0.0, top);

        let stroke = |index| Stroke::solid(ordered_colour(index, slices.len()), 2.4);
        let legend = self.legend(&slices, deviates, &unit, stroke);
        let (mut canvas, room) = page.start(remark.as_slice(), &legend);
        let frame = Frame::new(
            plot_area(room, left_margin(&y, room.height), RIGHT_MARGIN),
            x,
            y,
        );
        frame.draw_grid(&mut canvas);
        canvas.clipped(frame.area, |canvas| {
            for (index, curves) in curves.iter().enumerate() {
                let place = |points: &[(f64, f64)]| {
                    thinned(points.iter().map(|&(value, p)| frame.point(value, p)))
                };
                canvas.polyline(&place(&curves.density), stroke(index));
                canvas.polyline(&place(&curves.reference), reference_stroke());
            }
        });
        frame.draw_axes(&mut canvas);
        Ok(canvas.finish())
    }

    /// The densities nearest to the times asked for, each once, in the order asked.
    fn nearest(&self) -> Result<Vec<Slice<'_>>> {
        check::at_least(PICTURE, "times asked for", 1, self.times.len())?;
        check::at_least(PICTURE, "times", 1, self.densities.len())?;
        check::finite(PICTURE, "times asked for", self.times)?;
        let mut slices: Vec<Slice<'_>> = Vec::new();
        for &time in self.times {
            let distance = |of: &DensityAtTime<'_>| (of.time - time).abs();
            let nearest = self
                .densities
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let taken =
                |density: &DensityAtTime<'_>| slices.iter().any(|s| s.density.time == density.time);
            if let Some(density) = nearest.filter(|density| !taken(density)) {
                slices.push(Slice::new(PICTURE, density)?);
            }
        }
        Ok(slices)
    }

    fn curves(&self, slice: &Slice<'_>, origin: f64, x: &Axis, unit: &Unit) -> Curves {
        let DensityAtTime {
            time,
            values,
            densities,
        } = slice.density;
        let shown = |value: f64, p: f64| (unit.factor * (value - origin), p / unit.factor);
        let nodes = values.iter().zip(densities).map(|(&v, &p)| shown(v, p));
        // A density that ends at an edge falls to zero there.
        let ends = [values.first(), values.last()].map(|v| v.map(|&v| shown(v, 0.0)));
        let density = ends[0].into_iter().chain(nodes).chain(ends[1]).collect();
        let points = |of: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            let value =
                |i: usize| origin + (x.low + (x.high - x.low) * i as f64 / 400.0) / unit.factor;
            (0..=400).map(|i| shown(value(i), of(value(i)))).collect()
        };
        let reference = match self.reference {
            None => Vec::new(),
            Some(Reference::Normal) => points(&|value| normal(slice, value)),
            Some(Reference::Given { density, .. }) => points(&|value| density(time, value)),
        };
        Curves { density, reference }
    }

    fn legend(
        &self,
        slices: &[Slice<'_>],
        deviates: bool,
        unit: &Unit,
        stroke: impl Fn(usize) -> Stroke,
    ) -> Vec<Entry> {
        let named = slices.iter().enumerate().map(|(index, slice)| {
            let mut name = format!("t = {} s", time_text(slice.density.time));
            if deviates {
                let mean = format!("{:.3}", unit.factor * slice.mean).replace('-', "−");
                name = format!("{name}, μ = {mean} {}", unit.text);
            }
            Entry::line(stroke(index), name)
        });
        let reference = match self.reference {
            None => None,
            Some(Reference::Normal) => Some("normal, same mean and standard deviation"),
            Some(Reference::Given { name, .. }) => Some(name),
        };
        named
            .chain(reference.map(|name| Entry::line(reference_stroke(), name)))
            .collect()
    }
}

fn reference_stroke() -> Stroke {
    Stroke::solid(BLACK, 1.3).dashed("5 5")
}

/// A density and its reference, in shown units.
struct Curves {
    density: Vec<(f64, f64)>,
    reference: Vec<(f64, f64)>,
}

/// The density that half of the probability does not exceed, of a curve's nodes.
fn usual(curve: &[(f64, f64)]) -> f64 {
    let cells = curve.windows(2).map(|pair| {
        let density = 0.5 * (pair[0].1 + pair[1].1);
        (density, density * (pair[1].0 - pair[0].0))
    });
    let mut cells: Vec<(f64, f64)> = cells.collect();
    cells.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let wanted = 0.5 * cells.iter().map(|cell| cell.1).sum::<f64>();
    let mut below = 0.0;
    let found = cells.iter().find(|cell| {
        below += cell.1;
        below >= wanted
    });
    found.map_or(f64::INFINITY, |cell| cell.0)
}

fn normal(slice: &Slice<'_>, value: f64) -> f64 {
    let distance = (value - slice.mean) / slice.standard_deviation;
    (-0.5 * distance * distance).exp() / (slice.standard_deviation * std::f64::consts::TAU.sqrt())
}

/// A time to a tenth of a millisecond, without zeros at the end.
fn time_text(time: f64) -> String {
    let text = format!("{time:.4}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short.trim_start_matches('-') == "0" && time != 0.0 {
        return in_words(time);
    }
    short.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_is_cut_and_a_peak_is_not() {
        let curve = |density: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            let nodes = (1..4000).map(|j| f64::from(j) / 1000.0);
            nodes.map(|y| (y, density(y))).collect()
        };
        let peak = curve(&|y| (-20.0 * (y - 2.0).powi(2)).exp());
        assert!(POLE * usual(&peak) > 10.0);
        // Half of ∫ 1/√y from 0 to 4 lies below y = 1.
        let pole = usual(&curve(&|y| y.powf(-0.5)));
        assert!((0.95..1.05).contains(&pole), "{pole}");
    }
}
