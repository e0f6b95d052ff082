//! Two plots of one time axis: the mean above, deviations from it below.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::{Canvas, Rectangle, Stroke};
use super::colour::VERMILLION;
use super::lines::thinned;
use super::statistics::{Statistics, range};
use super::units::{Label, Unit, axis_label};

/// A small plot above and a large one below it.
pub(super) fn split(area: Rectangle) -> (Rectangle, Rectangle) {
    const SPACE: f64 = 24.0;
    let above = (0.24 * area.height).round();
    let lower = Rectangle {
        top: area.top + above + SPACE,
        height: area.height - above - SPACE,
        ..area
    };
    let height = above;
    (Rectangle { height, ..area }, lower)
}

/// The axis of the mean: it may travel far more than the response spreads, in a unit of its own.
pub(super) fn mean_axis(label: &Label<'_>, statistics: &Statistics) -> (Axis, Unit) {
    let (low, high) = range(statistics.mean.iter().copied());
    let unit = Unit::suiting(label.unit, low.abs().max(high.abs()));
    let text = axis_label("Mean", "μ", &unit);
    (
        Axis::with_room(text, unit.factor * low, unit.factor * high),
        unit,
    )
}

/// The mean over time.
pub(super) fn draw_mean_panel(
    canvas: &mut Canvas,
    area: Rectangle,
    x: &Axis,
    label: &Label<'_>,
    statistics: &Statistics,
) {
    let (y, unit) = mean_axis(label, statistics);
    let frame = Frame::new(area, x.clone(), y);
    frame.draw_grid(canvas);
    canvas.clipped(area, |canvas| {
        let points = statistics.times.iter().zip(&statistics.mean);
        let points = points.map(|(&time, mean)| frame.point(time, unit.factor * mean));
        canvas.polyline(&thinned(points), Stroke::solid(VERMILLION, 2.2));
    });
    frame.draw_axes_above(canvas);
}

/// The room at the left of both plots.
pub(super) fn left_margin_of_both(
    room: Rectangle,
    y: &Axis,
    label: &Label<'_>,
    statistics: &Statistics,
) -> f64 {
    let (above, below) = split(room);
    let mean = left_margin(&mean_axis(label, statistics).0, above.height);
    mean.max(left_margin(y, below.height))
}
