//! The distances between two densities over time, for each quantity.

use super::axes::{Axis, BOTTOM_MARGIN, Frame, NUMBER_SIZE, left_margin};
use super::canvas::{Anchor, Canvas, Rectangle, Stroke, TextStyle};
use super::check;
use super::colour::line_colour;
use super::lines::thinned;
use super::page::{Entry, Page, plot_area};
use super::statistics::range;
use super::text::Weight;
use super::{Image, RIGHT_MARGIN, TIME_LABEL};
use crate::Result;

/// One measure of the distance between two densities over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistanceCurve<'a> {
    /// Each quantity has a plot of its own.
    pub quantity: &'a str,
    /// Each measure has a line of its own, the same in all plots.
    pub measure: &'a str,
    /// Of a distance the line is solid, of the magnitude of an error dashed.
    pub is_error: bool,
    /// s, ascending.
    pub times: &'a [f64],
    /// At least 0, without unit.
    pub values: &'a [f64],
}

/// Distances over time: a plot for each quantity, a line for each measure.
#[derive(Debug, Clone, PartialEq)]
pub struct DistancesOverTime<'a> {
    pub curves: &'a [DistanceCurve<'a>],
}

const PICTURE: &str = "plot of the distances";
const LABEL: &str = "Distance, error";
/// An error passes through zero where it changes its sign: the axis leaves out this part of the values.
const LEFT_OUT: f64 = 0.02;
/// ... and ends at this part of its top.
const PART_OF_TOP: f64 = 1e-12;
/// Above each plot, for the name of its quantity.
const NAME: f64 = 34.0;
/// As much more above the first one.
const FIRST: f64 = 14.0;
/// What a plot needs at least.
const LEAST_HEIGHT: f64 = 190.0;

impl DistancesOverTime<'_> {
    /// Draws them; many quantities make the page higher.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there is no curve, lengths differ or a value is not finite.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        self.check()?;
        let quantities = distinct(self.curves.iter().map(|curve| curve.quantity));
        let axes: Vec<Axis> = quantities.iter().map(|name| self.axis(name)).collect();
        let count = quantities.len() as f64;
        let page = Page {
            height: page.height.max(LEAST_HEIGHT * (count + 1.0)),
            ..page.clone()
        };
        let times = self.curves.iter().flat_map(|curve| curve.times);
        let (start, end) = range(times.copied());
        let (mut canvas, room) = page.start(&[], &self.legend());
        let height = (room.height - BOTTOM_MARGIN - (count - 1.0) * NAME) / count - FIRST;
        let margins = axes.iter().map(|axis| left_margin(axis, height));
        let area = plot_area(room, margins.fold(0.0, f64::max), RIGHT_MARGIN);
        for (index, (quantity, axis)) in quantities.iter().zip(axes).enumerate() {
            let top = area.top + FIRST + index as f64 * (height + NAME);
            let area = Rectangle {
                top,
                height,
                ..area
            };
            let frame = Frame::new(area, Axis::linear(TIME_LABEL, start, end), axis);
            self.draw_plot(&mut canvas, quantity, &frame);
            if index + 1 == quantities.len() {
                frame.draw_axes(&mut canvas);
            } else {
                frame.draw_axes_above(&mut canvas);
            }
        }
        Ok(canvas.finish())
    }

    fn draw_plot(&self, canvas: &mut Canvas, quantity: &str, frame: &Frame) {
        let style = TextStyle {
            weight: Weight::Bold,
            ..TextStyle::new(NUMBER_SIZE, Anchor::Start)
        };
        canvas.text(frame.area.left, frame.area.top - 8.0, quantity, style);
        frame.draw_grid(canvas);
        canvas.clipped(frame.area, |canvas| {
            for curve in self.of(quantity) {
                let points = curve.times.iter().zip(curve.values);
                let points = points.map(|(time, value)| frame.point(*time, *value));
                canvas.polyline(&thinned(points), self.stroke(curve));
            }
        });
    }

    fn of<'a>(&'a self, quantity: &'a str) -> impl Iterator<Item = &'a DistanceCurve<'a>> {
        let all = self.curves.iter();
        all.filter(move |curve| curve.quantity == quantity)
    }

    /// Logarithmic, from the least that is worth showing to a little above the largest.
    fn axis(&self, quantity: &str) -> Axis {
        let values = self.of(quantity).flat_map(|curve| curve.values);
        let mut positive: Vec<f64> = values.copied().filter(|value| *value > 0.0).collect();
        positive.sort_unstable_by(f64::total_cmp);
        let Some(largest) = positive.last() else {
            // No distance at all: the lines lie at zero.
            return Axis::linear(LABEL, -0.05, 1.0);
        };
        let least = positive[(LEFT_OUT * positive.len() as f64) as usize];
        Axis::logarithmic(LABEL, 0.8 * least.max(PART_OF_TOP * largest), 1.3 * largest)
    }

    fn check(&self) -> Result<()> {
        check::at_least(PICTURE, "curves", 1, self.curves.len())?;
        for curve in self.curves {
            check::at_least(PICTURE, "times", 2, curve.times.len())?;
            check::ascending(PICTURE, "times", curve.times)?;
            check::same_length(PICTURE, "values", curve.times.len(), curve.values.len())?;
            check::finite(PICTURE, "values", curve.values)?;
        }
        Ok(())
    }

    fn legend(&self) -> Vec<Entry> {
        let mut named = Vec::new();
        let mut entries = Vec::new();
        for curve in self.curves {
            if !named.contains(&curve.measure) {
                named.push(curve.measure);
                entries.push(Entry::line(self.stroke(curve), curve.measure));
            }
        }
        entries
    }

    fn stroke(&self, curve: &DistanceCurve<'_>) -> Stroke {
        let measures = distinct(self.curves.iter().map(|curve| curve.measure));
        let place = measures.iter().position(|name| *name == curve.measure);
        let dash = if curve.is_error { "7 4" } else { "" };
        Stroke::solid(line_colour(place.unwrap_or(0)), 2.0).dashed(dash)
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

#[cfg(test)]
mod tests {
    use super::super::axes::Scale;
    use super::*;

    fn curve<'a>(quantity: &'a str, times: &'a [f64], values: &'a [f64]) -> DistanceCurve<'a> {
        DistanceCurve {
            quantity,
            measure: "L_{1} distance",
            is_error: false,
            times,
            values,
        }
    }

    #[test]
    fn a_change_of_sign_does_not_stretch_the_axis() {
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        let mut values: Vec<f64> = times.iter().map(|t| 0.01 + 1e-4 * t).collect();
        (values[40], values[41]) = (1e-15, 0.0);
        let curves = [curve("a", &times, &values)];
        let axis = DistancesOverTime { curves: &curves }.axis("a");
        assert_eq!(axis.scale, Scale::Logarithmic);
        assert!(axis.low > 0.005 && axis.low < 0.01 && axis.high > 0.0199);
    }

    #[test]
    fn identical_tables_lie_at_zero() {
        let curves = [curve("a", &[0.0, 1.0], &[0.0, 0.0])];
        let figure = DistancesOverTime { curves: &curves };
        assert_eq!(figure.axis("a").scale, Scale::Linear);
        assert!(figure.draw(&Page::new("", "")).is_ok());
    }

    #[test]
    fn one_time_is_no_line() {
        let curves = [curve("a", &[1.0], &[0.5])];
        let figure = DistancesOverTime { curves: &curves };
        let message = figure.draw(&Page::new("", "")).unwrap_err().to_string();
        assert_eq!(
            message,
            "plot of the distances: times: expected at least 2, found 1"
        );
    }
}
