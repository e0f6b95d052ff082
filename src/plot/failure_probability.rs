//! The probability of failure over time, for each limit and method.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::Stroke;
use super::check;
use super::colour::line_colour;
use super::lines::{band, thinned};
use super::page::{Entry, Page, Swatch, plot_area};
use super::statistics::range;
use super::{Image, RIGHT_MARGIN, TIME_LABEL};
use crate::Result;

/// The probability of failure up to each time, by one method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailureCurve<'a> {
    pub limit: &'a str,
    pub method: &'a str,
    /// s, ascending.
    pub times: &'a [f64],
    pub failure_probability: &'a [f64],
    /// Confidence bounds of `failure_probability`, one for each time; both empty for none.
    pub lower: &'a [f64],
    pub upper: &'a [f64],
}

/// Probabilities of failure over time: a colour for each limit, a dash for each method.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureProbability<'a> {
    pub curves: &'a [FailureCurve<'a>],
}

const PICTURE: &str = "plot of the failure probability";
const DASHES: [&str; 4] = ["", "8 4", "2 3", "10 3 2 3"];
/// An axis that would span more than this factor is logarithmic.
const MOST_LINEAR: f64 = 100.0;
/// Smoothed probabilities have tails without end: a logarithmic axis shows this much below its top.
const LEAST_SHOWN: f64 = 1e-8;

impl FailureProbability<'_> {
    /// Draws them.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there is no curve, lengths differ or a value is not finite.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        self.check()?;
        let y = self.axis();
        let times = self
            .curves
            .iter()
            .flat_map(|curve| curve.times.iter().copied());
        let (start, end) = range(times);
        let x = Axis::linear(TIME_LABEL, start, end);
        let legend: Vec<Entry> = self.curves.iter().map(|curve| self.entry(curve)).collect();
        let (mut canvas, room) = page.start(&self.remarks(), &legend);
        let frame = Frame::new(
            plot_area(room, left_margin(&y, room.height), RIGHT_MARGIN),
            x,
            y,
        );
        frame.draw_grid(&mut canvas);
        canvas.clipped(frame.area, |canvas| {
            for curve in self.curves.iter().filter(|curve| !curve.lower.is_empty()) {
                let line = |values| points(&frame, curve.times, values);
                let area = band(&line(curve.lower), &line(curve.upper));
                canvas.polygon(&area, self.stroke(curve).colour, 0.15);
            }
            for curve in self.curves {
                let line = points(&frame, curve.times, curve.failure_probability);
                canvas.polyline(&line, self.stroke(curve));
            }
        });
        frame.draw_axes(&mut canvas);
        Ok(canvas.finish())
    }

    fn check(&self) -> Result<()> {
        check::at_least(PICTURE, "curves", 1, self.curves.len())?;
        for curve in self.curves {
            check::at_least(PICTURE, "times", 2, curve.times.len())?;
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

    fn remarks(&self) -> Vec<String> {
        let mut values = self
            .curves
            .iter()
            .flat_map(|curve| curve.failure_probability);
        if values.all(|&p| p == 0.0) {
            vec!["no failure at any time".to_owned()]
        } else {
            Vec::new()
        }
    }

    /// Linear or logarithmic, by the range of what is not zero.
    fn axis(&self) -> Axis {
        let label = "Probability of failure, P_{f}(t)";
        let values = self
            .curves
            .iter()
            .flat_map(|curve| curve.failure_probability.iter().copied());
        let (least, most) = range(values.filter(|&p| p > 0.0));
        let bounds = self
            .curves
            .iter()
            .flat_map(|curve| curve.upper.iter().copied());
        let (_, top) = range(bounds.chain([most]).filter(|p| p.is_finite()));
        if most > MOST_LINEAR * least {
            let low = least.max(LEAST_SHOWN * most);
            return Axis::logarithmic(label, low / 1.5, (1.5 * top).min(1.0).max(1.1 * most));
        }
        if top > 0.0 {
            Axis::linear(label, 0.0, 1.05 * top)
        } else {
            // Nothing fails: the line lies at zero.
            Axis::linear(label, -0.05, 1.0)
        }
    }

    fn entry(&self, curve: &FailureCurve<'_>) -> Entry {
        let stroke = self.stroke(curve);
        let swatch = if curve.lower.is_empty() {
            Swatch::Line(stroke)
        } else {
            Swatch::LineInBand(stroke, stroke.colour, 0.15)
        };
        let name = format!("{}, {}", curve.limit, curve.method);
        Entry { swatch, name }
    }

    fn stroke(&self, curve: &FailureCurve<'_>) -> Stroke {
        let limits = distinct(self.curves.iter().map(|curve| curve.limit));
        let methods = distinct(self.curves.iter().map(|curve| curve.method));
        let place = |names: &[&str], name: &str| names.iter().position(|n| *n == name).unwrap_or(0);
        let colour = line_colour(place(&limits, curve.limit));
        let dashes = DASHES[place(&methods, curve.method) % DASHES.len()];
        Stroke::solid(colour, 2.2).dashed(dashes)
    }
}

fn points(frame: &Frame, times: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
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
