//! Errors over the number of points or the work, a plot for each measure, a line for each rule.

use super::axes::{Axis, BOTTOM_MARGIN, Frame, left_margin};
use super::canvas::{Canvas, Rectangle, Stroke};
use super::check;
use super::colour::{Colour, line_colour};
use super::lines::band;
use super::page::{Entry, Page, plot_area};
use super::statistics::range;
use super::{Image, RIGHT_MARGIN};
use crate::Result;

/// The error of a rule at one count: median and quartiles over the seeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorPoint {
    /// Number of points, or processor time (s).
    pub x: f64,
    /// First quartile.
    pub lower: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub upper: f64,
}

/// The errors of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorCurve<'a> {
    /// The rule: the same line in all plots.
    pub name: String,
    /// Each measure has a plot of its own.
    pub measure: &'a str,
    /// Ascending.
    pub points: Vec<ErrorPoint>,
}

/// Errors of rules, both axes logarithmic.
#[derive(Debug, Clone, PartialEq)]
pub struct Convergence<'a> {
    /// What the errors are drawn over.
    pub label: &'a str,
    pub curves: &'a [ErrorCurve<'a>],
}

const PICTURE: &str = "plot of a study";
/// Between two plots.
const SPACE: f64 = 22.0;
/// Colours of lines before they start again, dashed.
const COLOURS: usize = 7;
/// Half of a mark's width.
const MARK: f64 = 2.8;
/// No axis goes lower: below there is rounding.
const LEAST: f64 = 1e-12;

impl Convergence<'_> {
    /// Draws them; what is not positive is not there on a logarithmic axis.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there is no curve, or a value is not finite.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        check::at_least(PICTURE, "curves", 1, self.curves.len())?;
        for curve in self.curves {
            check::at_least(PICTURE, "points", 1, curve.points.len())?;
            let values = curve.points.iter();
            let values: Vec<f64> = values
                .flat_map(|p| [p.x, p.lower, p.median, p.upper])
                .collect();
            check::finite(PICTURE, "errors", &values)?;
        }
        let measures = distinct(self.curves.iter().map(|curve| curve.measure));
        let (mut canvas, room) = page.start(&[], &self.legend());
        let count = measures.len() as f64;
        let height = (room.height - BOTTOM_MARGIN - (count - 1.0) * SPACE) / count;
        let axes: Vec<Axis> = measures.iter().map(|name| self.axis(name)).collect();
        let margins = axes.iter().map(|axis| left_margin(axis, height));
        let area = plot_area(room, margins.fold(0.0, f64::max), RIGHT_MARGIN);
        let (low, high) = range(self.positive(|_| true, |p| p.x));
        let x = Axis::logarithmic(self.label, 0.9 * low, 1.1 * high);
        for (index, (measure, axis)) in measures.iter().zip(axes).enumerate() {
            let top = area.top + index as f64 * (height + SPACE);
            let area = Rectangle {
                top,
                height,
                ..area
            };
            let frame = Frame::new(area, x.clone(), axis);
            frame.draw_grid(&mut canvas);
            canvas.clipped(area, |canvas| self.draw_curves(canvas, measure, &frame));
            if index + 1 == measures.len() {
                frame.draw_axes(&mut canvas);
            } else {
                frame.draw_axes_above(&mut canvas);
            }
        }
        Ok(canvas.finish())
    }

    fn draw_curves(&self, canvas: &mut Canvas, measure: &str, frame: &Frame) {
        let of = || self.curves.iter().filter(|curve| curve.measure == measure);
        let line = |curve: &ErrorCurve<'_>, value: fn(&ErrorPoint) -> f64| -> Vec<(f64, f64)> {
            let points = curve.points.iter();
            points.map(|p| frame.point(p.x, value(p))).collect()
        };
        for curve in of() {
            let (lower, upper) = (line(curve, |p| p.lower), line(curve, |p| p.upper));
            canvas.polygon(&band(&lower, &upper), self.style(curve).0, 0.14);
        }
        for curve in of() {
            let (colour, stroke) = self.style(curve);
            let median = line(curve, |p| p.median);
            canvas.polyline(&median, stroke);
            for (x, y) in median {
                let mark = Rectangle {
                    left: x - MARK,
                    top: y - MARK,
                    width: 2.0 * MARK,
                    height: 2.0 * MARK,
                };
                canvas.fill_rectangle(mark, colour, 1.0);
            }
        }
    }

    fn axis(&self, measure: &str) -> Axis {
        let of = |curve: &ErrorCurve<'_>| curve.measure == measure;
        let (low, high) = range(self.positive(of, |p| p.median));
        if high > 0.0 && high.is_finite() {
            Axis::logarithmic(measure, 0.6 * low.max(LEAST), 1.6 * high)
        } else {
            Axis::linear(measure, -0.05, 1.0)
        }
    }

    fn positive<'s>(
        &'s self,
        of: impl Fn(&ErrorCurve<'_>) -> bool + 's,
        value: fn(&ErrorPoint) -> f64,
    ) -> impl Iterator<Item = f64> + 's {
        let curves = self.curves.iter().filter(move |curve| of(curve));
        let values = curves.flat_map(move |curve| curve.points.iter().map(value));
        values.filter(|value| *value > 0.0)
    }

    fn style(&self, curve: &ErrorCurve<'_>) -> (Colour, Stroke) {
        let names = distinct(self.curves.iter().map(|curve| curve.name.as_str()));
        let place = names.iter().position(|name| *name == curve.name);
        let place = place.unwrap_or(0);
        let dashes = if place < COLOURS { "" } else { "7 4" };
        let colour = line_colour(place);
        (colour, Stroke::solid(colour, 2.0).dashed(dashes))
    }

    fn legend(&self) -> Vec<Entry> {
        let mut named: Vec<&str> = Vec::new();
        let mut entries = Vec::new();
        for curve in self.curves {
            if !named.contains(&curve.name.as_str()) {
                named.push(&curve.name);
                entries.push(Entry::line(self.style(curve).1, &*curve.name));
            }
        }
        entries
    }
}

/// Each name once, in order.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut result = Vec::new();
    for name in names {
        if !result.contains(&name) {
            result.push(name);
        }
    }
    result
}
