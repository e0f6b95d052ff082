//! All representative responses over time, with their mean and quantiles.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::{Canvas, Stroke};
use super::check;
use super::colour::{BLACK, BLUE, VERMILLION};
use super::lines::{band, thinned};
use super::page::{Entry, Page, plot_area};
use super::panels::{draw_mean_panel, left_margin_of_both, split};
use super::statistics::{Statistics, ValueAxis, range};
use super::units::{Label, Unit, axis_label};
use super::{Image, RIGHT_MARGIN, TIME_LABEL};
use crate::Result;

/// More lines than this would cover each other, and fill the file.
const MOST_LINES: usize = 1000;
/// Points of all lines: 2 MB of SVG.
const MOST_POINTS: usize = 250_000;

const OUTER_OPACITY: f64 = 0.20;
const INNER_OPACITY: f64 = 0.35;

/// Representative responses over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Fan<'a> {
    pub label: Label<'a>,
    /// s, ascending.
    pub times: &'a [f64],
    /// The history of each point, in its SI unit; all of them, or some of them evenly taken.
    pub responses: &'a [&'a [f64]],
    /// Number of representative points in the ensemble, at least those given here.
    pub point_count: usize,
    /// Of the whole ensemble.
    pub statistics: &'a Statistics,
    pub value_axis: ValueAxis,
}

impl Fan<'_> {
    /// Draws them; where values are measured from the mean, with the mean in a panel above.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where lengths differ, a value is not finite or nothing is there.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        self.check()?;
        let deviates = self.statistics.deviates(self.value_axis);
        let lines = self.lines();
        let drawn: Vec<Vec<f64>> = lines
            .iter()
            .map(|line| self.measured(line, deviates))
            .collect();
        let (low, high) = self.value_range(&drawn, deviates);
        let unit = Unit::suiting(self.label.unit, low.abs().max(high.abs()));
        let label = value_label(&self.label, &unit, deviates);
        let y = Axis::with_room(label, unit.factor * low, unit.factor * high);
        let x = Axis::linear(TIME_LABEL, self.times[0], self.times[self.times.len() - 1]);

        let (mut canvas, room) = page.start(&self.remarks(lines.len()), &legend());
        let area = if deviates {
            let margin = left_margin_of_both(room, &y, &self.label, self.statistics);
            let (above, below) = split(plot_area(room, margin, RIGHT_MARGIN));
            draw_mean_panel(&mut canvas, above, &x, &self.label, self.statistics);
            below
        } else {
            plot_area(room, left_margin(&y, room.height), RIGHT_MARGIN)
        };
        let frame = Frame::new(area, x, y);
        frame.draw_grid(&mut canvas);
        canvas.clipped(area, |canvas| {
            self.draw_lines(canvas, &frame, &drawn, unit.factor);
            draw_bands(canvas, &frame, self.statistics, unit.factor, deviates);
        });
        frame.draw_axes(&mut canvas);
        Ok(canvas.finish())
    }

    fn check(&self) -> Result<()> {
        let picture = "plot of the responses";
        check::at_least(picture, "times", 2, self.times.len())?;
        check::ascending(picture, "times", self.times)?;
        check::at_least(picture, "responses", 1, self.responses.len())?;
        for response in self.responses {
            check::same_length(
                picture,
                "times of a response",
                self.times.len(),
                response.len(),
            )?;
            check::finite(picture, "responses", response)?;
        }
        self.statistics.check(picture)
    }

    /// Of the responses given, those that are drawn.
    fn lines(&self) -> Vec<&[f64]> {
        let most = (MOST_POINTS / self.times.len().min(4000)).clamp(20, MOST_LINES);
        let given = self.responses.len();
        let count = given.min(most);
        // Evenly over all of them, so that no part of the points is left out.
        (0..count)
            .map(|i| self.responses[i * given / count])
            .collect()
    }

    fn measured(&self, response: &[f64], deviates: bool) -> Vec<f64> {
        if !deviates {
            return response.to_vec();
        }
        let means = self.times.iter().map(|&time| self.statistics.mean_at(time));
        response
            .iter()
            .zip(means)
            .map(|(value, mean)| value - mean)
            .collect()
    }

    fn value_range(&self, drawn: &[Vec<f64>], deviates: bool) -> (f64, f64) {
        let lines = drawn.iter().flatten().copied();
        let of = &self.statistics;
        let edges = of
            .quantile_05
            .iter()
            .chain(&of.quantile_95)
            .zip(of.mean.iter().cycle());
        let edges = edges.map(|(edge, mean)| if deviates { edge - mean } else { *edge });
        range(lines.chain(edges))
    }

    fn remarks(&self, lines: usize) -> Vec<String> {
        if lines < self.point_count {
            vec![format!("{lines} of {} responses drawn", self.point_count)]
        } else {
            Vec::new()
        }
    }

    fn draw_lines(&self, canvas: &mut Canvas, frame: &Frame, drawn: &[Vec<f64>], factor: f64) {
        // Many lines cover each other: the more there are, the fainter each.
        let opacity = (6.0 / (drawn.len() as f64).sqrt()).clamp(0.15, 0.8);
        let stroke = Stroke::solid(BLACK, 0.5).opacity(0.6 * opacity);
        for values in drawn {
            let points = self.times.iter().zip(values);
            let points = points.map(|(&time, value)| frame.point(time, factor * value));
            canvas.polyline(&thinned(points), stroke);
        }
    }
}

/// The label of an axis of values or of their deviations from the mean.
pub(super) fn value_label(label: &Label<'_>, unit: &Unit, deviates: bool) -> String {
    if !deviates {
        return axis_label(label.name, label.symbol, unit);
    }
    match label.symbol {
        "" => axis_label("Deviation from the mean", "", unit),
        symbol => axis_label("Deviation from the mean", &format!("{symbol} − μ"), unit),
    }
}

fn mean_stroke() -> Stroke {
    Stroke::solid(VERMILLION, 2.2)
}

fn legend() -> [Entry; 4] {
    [
        Entry::line(
            Stroke::solid(BLACK, 0.7).opacity(0.6),
            "representative responses",
        ),
        Entry::line(mean_stroke(), "mean, μ"),
        Entry::band(BLUE, INNER_OPACITY + OUTER_OPACITY, "25–75 %"),
        Entry::band(BLUE, OUTER_OPACITY, "5–95 %"),
    ]
}

fn draw_bands(canvas: &mut Canvas, frame: &Frame, of: &Statistics, factor: f64, deviates: bool) {
    let line = |values: &[f64]| -> Vec<(f64, f64)> {
        let rows = of.times.iter().zip(values).zip(&of.mean);
        let origin = |mean: f64| if deviates { mean } else { 0.0 };
        let points = rows.map(|((&t, v), &mean)| frame.point(t, factor * (v - origin(mean))));
        thinned(points)
    };
    let outer = band(&line(&of.quantile_05), &line(&of.quantile_95));
    let inner = band(&line(&of.quantile_25), &line(&of.quantile_75));
    canvas.polygon(&outer, BLUE, OUTER_OPACITY);
    canvas.polygon(&inner, BLUE, INNER_OPACITY);
    for edge in [&of.quantile_05, &of.quantile_95] {
        canvas.polyline(&line(edge), Stroke::solid(BLUE, 1.2));
    }
    canvas.polyline(&line(&of.mean), mean_stroke());
}
