//! The probability of failure over time, for each limit and method.

use super::axes::{Axis, BOTTOM_MARGIN, Frame, NUMBER_SIZE, left_margin};
use super::canvas::{Anchor, Canvas, Rectangle, Stroke, TextStyle};
use super::check;
use super::colour::line_colour;
use super::lines::{band, thinned};
use super::page::{Entry, Page, plot_area};
use super::statistics::range;
use super::{Image, RIGHT_MARGIN, TIME_LABEL};
use crate::Result;

/// The probability of failure up to each time, by one method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailureCurve<'a> {
    pub limit: &'a str,
    pub method: &'a str,
    /// s, ascending; a single one for a limit on one value a point, drawn as a level line.
    pub times: &'a [f64],
    pub failure_probability: &'a [f64],
    /// Confidence bounds of `failure_probability`, one for each time; both empty for none.
    pub lower: &'a [f64],
    pub upper: &'a [f64],
}

/// Probabilities of failure over time: a plot for each limit, a line for each method.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureProbability<'a> {
    pub curves: &'a [FailureCurve<'a>],
}

const PICTURE: &str = "plot of the failure probability";
const DASHES: [&str; 4] = ["", "10 5", "2 4", "10 3 2 3"];
/// Of the area between the bounds.
const OPACITY: f64 = 0.15;
/// An axis that would span more than this factor is logarithmic.
const MOST_LINEAR: f64 = 3.0;
/// Smoothed probabilities have tails without end. A logarithmic axis ends at this part of the least
/// upper bound, about which the points know nothing more ...
const PART_OF_BOUND: f64 = 0.1;
/// ... or, without bounds, at this part of its top.
const PART_OF_TOP: f64 = 1e-8;
/// Above each plot, for the name of its limit.
const NAME: f64 = 30.0;
/// As much more above the first one.
const FIRST: f64 = 12.0;
/// What a plot needs at least.
const LEAST_HEIGHT: f64 = 160.0;

impl FailureProbability<'_> {
    /// Draws them; many limits make the page higher.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there is no curve, lengths differ or a value is not finite.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        self.check()?;
        let limits = distinct(self.curves.iter().map(|curve| curve.limit));
        let plots: Vec<Plot<'_>> = limits.iter().map(|limit| self.plot(limit)).collect();
        let count = plots.len() as f64;
        let page = Page {
            height: page.height.max(LEAST_HEIGHT * (count + 1.0)),
            ..page.clone()
        };
        let times = self
            .curves
            .iter()
            .flat_map(|curve| curve.times.iter().copied());
        let (mut start, end) = range(times);
        if start == end {
            // No limit but on values a point: the run ends with them.
            start = f64::min(0.0, end - 1.0);
        }
        let (mut canvas, room) = page.start(&[], &self.legend());
        let height = (room.height - BOTTOM_MARGIN - (count - 1.0) * NAME) / count - FIRST;
        let margins = plots.iter().map(|plot| left_margin(&plot.axis, height));
        let area = plot_area(room, margins.fold(0.0, f64::max), RIGHT_MARGIN);
        for (index, plot) in plots.iter().enumerate() {
            let top = area.top + FIRST + index as f64 * (height + NAME);
            let area = Rectangle {
                top,
                height,
                ..area
            };
            let x = Axis::linear(TIME_LABEL, start, end);
            let frame = Frame::new(area, x, plot.axis.clone());
            self.draw_plot(&mut canvas, plot, &frame);
            if index + 1 == plots.len() {
                frame.draw_axes(&mut canvas);
            } else {
                frame.draw_axes_above(&mut canvas);
            }
        }
        Ok(canvas.finish())
    }

    fn draw_plot(&self, canvas: &mut Canvas, plot: &Plot<'_>, frame: &Frame) {
        let style = TextStyle::new(NUMBER_SIZE, Anchor::Start);
        canvas.text(frame.area.left, frame.area.top - 7.0, &plot.name, style);
        frame.draw_grid(canvas);
        canvas.clipped(frame.area, |canvas| {
            if let Some(curve) = plot.bounded() {
                let line = |values| points(frame, curve.times, values);
                let area = band(&line(curve.lower), &line(curve.upper));
                canvas.polygon(&area, self.stroke(curve).colour, OPACITY);
            }
            for curve in &plot.curves {
                let line = points(frame, curve.times, curve.failure_probability);
                canvas.polyline(&line, self.stroke(curve));
            }
        });
    }

    fn check(&self) -> Result<()> {
        check::at_least(PICTURE, "curves", 1, self.curves.len())?;
        for curve in self.curves {
            check::at_least(PICTURE, "times", 1, curve.times.len())?;
            check::ascending(PICTURE, "times", curve.times)?;
            let count = curve.times.len();
            check::same_length(
                PICTURE,
                "failure probabilities",
                count,
                curve.failure_probability.len(),
            )?;
            check::finite(PICTURE, "failure probabilities", curve.failure_probability)?;
            check::same_length(
                PICTURE,
                "upper bounds",
                curve.lower.len(),
                curve.upper.len(),
            )?;
            if !curve.lower.is_empty() {
                check::same_length(PICTURE, "confidence bounds", count, curve.lower.len())?;
                check::finite(PICTURE, "confidence bounds", curve.lower)?;
                check::finite(PICTURE, "confidence bounds", curve.upper)?;
            }
        }
        Ok(())
    }

    fn plot<'a>(&'a self, limit: &'a str) -> Plot<'a> {
        let curves: Vec<&FailureCurve<'_>> = self
            .curves
            .iter()
            .filter(|curve| curve.limit == limit)
            .collect();
        let safe = curves
            .iter()
            .all(|curve| curve.failure_probability.iter().all(|&p| p == 0.0));
        Plot {
            name: if safe {
                format!("{limit} (no failure at any time)")
            } else {
                limit.to_owned()
            },
            axis: axis(&curves),
            curves,
        }
    }

    /// The methods, and whose bounds are drawn.
    fn legend(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        let mut named = Vec::new();
        for curve in self.curves {
            if !named.contains(&curve.method) {
                named.push(curve.method);
                entries.push(Entry::line(self.stroke(curve), curve.method));
            }
        }
        let bounded = self.curves.iter().find(|curve| !curve.lower.is_empty());
        entries.extend(bounded.map(|curve| {
            let name = format!("confidence bounds of {}", curve.method);
            Entry::band(self.stroke(curve).colour, OPACITY, name)
        }));
        entries
    }

    fn stroke(&self, curve: &FailureCurve<'_>) -> Stroke {
        let methods = distinct(self.curves.iter().map(|curve| curve.method));
        let place = methods.iter().position(|name| *name == curve.method);
        let place = place.unwrap_or(0);
        Stroke::solid(line_colour(place), 2.2).dashed(DASHES[place % DASHES.len()])
    }
}

/// The plot of one limit.
struct Plot<'a> {
    name: String,
    axis: Axis,
    curves: Vec<&'a FailureCurve<'a>>,
}

impl Plot<'_> {
    /// The curve whose bounds are drawn: those of all methods would hide each other.
    fn bounded(&self) -> Option<&FailureCurve<'_>> {
        let mut curves = self.curves.iter().copied();
        curves.find(|curve| !curve.lower.is_empty())
    }
}

/// Linear or logarithmic, by the range of what is worth showing.
fn axis(curves: &[&FailureCurve<'_>]) -> Axis {
    let label = "Probability of failure, P_{f}(t)";
    let values = curves
        .iter()
        .flat_map(|curve| curve.failure_probability.iter().copied());
    let (least, most) = range(values.filter(|&p| p > 0.0));
    let bounds = || curves.iter().flat_map(|curve| curve.upper.iter().copied());
    let (least_bound, _) = range(bounds().filter(|&p| p > 0.0));
    let (_, top) = range(bounds().chain([most]).filter(|p| p.is_finite()));
    let low = if least_bound.is_finite() {
        PART_OF_BOUND * least_bound
    } else {
        PART_OF_TOP * most
    };
    let low = low.max(least);
    if most > MOST_LINEAR * low {
        return Axis::logarithmic(label, low, (1.5 * top).min(1.0).max(1.1 * most));
    }
    if top > 0.0 {
        Axis::linear(label, 0.0, 1.05 * top)
    } else {
        // Nothing fails: the line lies at zero.
        Axis::linear(label, -0.05, 1.0)
    }
}

fn points(frame: &Frame, times: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    if let ([time], [value]) = (times, values) {
        let (_, y) = frame.point(*time, *value);
        let Rectangle { left, width, .. } = frame.area;
        return vec![(left, y), (left + width, y)];
    }
    thinned(
        times
            .iter()
            .zip(values)
            .map(|(&time, &value)| frame.point(time, value)),
    )
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

    fn curve<'a>(limit: &'a str, values: &'a [f64], bounds: [&'a [f64]; 2]) -> FailureCurve<'a> {
        FailureCurve {
            limit,
            method: "counting",
            times: &[0.0, 1.0, 2.0],
            failure_probability: values,
            lower: bounds[0],
            upper: bounds[1],
        }
    }

    #[test]
    fn a_logarithmic_axis_ends_where_the_points_know_nothing() {
        let bounds: [&[f64]; 2] = [&[0.0, 0.0, 0.08], &[0.004, 0.004, 0.13]];
        let bounded = curve("a", &[0.0, 1e-20, 0.1], bounds);
        let with = axis(&[&bounded]);
        assert_eq!((with.scale, with.low), (Scale::Logarithmic, 0.1 * 0.004));
        assert!(with.high >= 0.13);
        let without = axis(&[&curve("a", &[0.0, 1e-20, 0.1], [&[], &[]])]);
        assert_eq!((without.scale, without.low), (Scale::Logarithmic, 1e-9));
    }

    #[test]
    fn what_never_fails_has_a_linear_axis_and_is_said() {
        let bounds: [&[f64]; 2] = [&[0.0; 3], &[0.004; 3]];
        let curves = [
            curve("a", &[0.0; 3], bounds),
            curve("b", &[0.0, 0.1, 0.1], [&[], &[]]),
        ];
        assert_eq!(axis(&[&curves[0]]).scale, Scale::Linear);
        let figure = FailureProbability { curves: &curves };
        let svg = figure.draw(&Page::new("", "")).unwrap().svg;
        assert!(svg.contains("a (no failure at any time)"));
        assert!(!svg.contains("b (no failure"));
    }

    #[test]
    fn a_limit_on_a_value_a_point_is_a_level_line() {
        let frame = |start, end| {
            let area = Rectangle {
                left: 10.0,
                top: 0.0,
                width: 100.0,
                height: 50.0,
            };
            let x = Axis::linear(TIME_LABEL, start, end);
            Frame::new(area, x, Axis::linear("P", 0.0, 1.0))
        };
        let level = points(&frame(0.0, 2.0), &[2.0], &[0.5]);
        assert_eq!(level, [(10.0, 25.0), (110.0, 25.0)]);
        // Alone and beside a limit on a history.
        let single = FailureCurve {
            times: &[2.0],
            ..curve("a", &[0.5], [&[0.4], &[0.6]])
        };
        let other = curve("b", &[0.0, 0.1, 0.2], [&[], &[]]);
        for curves in [vec![single], vec![single, other]] {
            let figure = FailureProbability { curves: &curves };
            let svg = figure.draw(&Page::new("", "")).unwrap().svg;
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }

    #[test]
    fn many_limits_make_the_page_higher() {
        let names = ["a", "b", "c", "d", "e"];
        let curves = names.map(|name| curve(name, &[0.0, 0.1, 0.2], [&[], &[]]));
        let figure = FailureProbability { curves: &curves };
        let svg = figure.draw(&Page::new("", "")).unwrap().svg;
        assert!(svg.contains(r#"height="960" viewBox"#));
    }
}
