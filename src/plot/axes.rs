//! Axes: the scale, the frame of a plot, its grid, ticks and labels.

use super::canvas::{Anchor, Canvas, Rectangle, Stroke, TextStyle};
use super::colour::{BLACK, LIGHT_GREY};
use super::text::{Weight, width, wrap};
use super::ticks::{Ticks, exponent_label, linear, logarithmic};

/// Sizes of letters, in pixels: a page of 1000 pixels in a column of 16 cm has 7-point numbers.
pub(super) const NUMBER_SIZE: f64 = 15.0;
pub(super) const LABEL_SIZE: f64 = 16.0;

/// Of wrapped labels, which may have superscripts.
const LINE_SPACING: f64 = 1.45;
const TICK_LENGTH: f64 = 5.0;
const MINOR_TICK_LENGTH: f64 = 3.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scale {
    Linear,
    SquareRoot,
    Logarithmic,
}

/// One axis, from `low` to `high` in the unit shown.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    pub label: String,
    pub low: f64,
    pub high: f64,
    pub scale: Scale,
}

impl Axis {
    /// A linear axis; where `low` and `high` are the same it is widened about them.
    pub(super) fn linear(label: impl Into<String>, low: f64, high: f64) -> Self {
        let (low, high) = if high > low {
            (low, high)
        } else {
            let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
            (low - half, high + half)
        };
        Axis {
            label: label.into(),
            low,
            high,
            scale: Scale::Linear,
        }
    }

    /// A linear axis with a little room beyond `low` and `high`.
    pub(super) fn with_room(label: impl Into<String>, low: f64, high: f64) -> Self {
        let exact = Axis::linear(label, low, high);
        let room = 0.05 * (exact.high - exact.low);
        Axis {
            low: exact.low - room,
            high: exact.high + room,
            ..exact
        }
    }

    /// A logarithmic axis between positive values; at least a tenth of a decade.
    pub(super) fn logarithmic(label: impl Into<String>, low: f64, high: f64) -> Self {
        Axis {
            label: label.into(),
            low,
            high: high.max(1.26 * low),
            scale: Scale::Logarithmic,
        }
    }

    /// Where `value` lies: 0 at `low`, 1 at `high`.
    pub(super) fn place(&self, value: f64) -> f64 {
        let (low, high) = (self.low, self.high);
        match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::SquareRoot => ((value - low) / (high - low)).max(0.0).sqrt(),
            // Nothing lies at minus infinity: far below is enough.
            Scale::Logarithmic => ((value.max(1e-300) / low).ln() / (high / low).ln()).max(-10.0),
        }
    }

    /// At most `most` ticks with numbers.
    pub(super) fn ticks(&self, most: usize) -> Ticks {
        match self.scale {
            Scale::Linear | Scale::SquareRoot => linear(self.low, self.high, most),
            Scale::Logarithmic => logarithmic(self.low, self.high, most),
        }
    }
}

/// The frame of a plot: where its axes lie on the page.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    pub area: Rectangle,
    pub x: Axis,
    pub y: Axis,
    x_ticks: Ticks,
    y_ticks: Ticks,
}

/// The room at the left of a plot of this height for the numbers and the label of its y axis.
pub(super) fn left_margin(y: &Axis, height: f64) -> f64 {
    let numbers = widest(&y.ticks(most_upward(height)));
    let lines = wrap(&y.label, LABEL_SIZE, Weight::Regular, upward_room(height)).len() as f64;
    14.0 + LINE_SPACING * LABEL_SIZE * lines + numbers + TICK_LENGTH + 6.0
}

/// How long a label beside a plot may be: a little longer than the plot.
fn upward_room(height: f64) -> f64 {
    height.max(60.0) + 12.0
}

/// The room below a plot for the numbers and the label of its x axis.
pub(super) const BOTTOM_MARGIN: f64 = 62.0;

fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks
        .labels
        .iter()
        .map(|label| width(label, NUMBER_SIZE, Weight::Regular));
    widths.fold(0.0, f64::max)
}

fn most_upward(height: f64) -> usize {
    (height / if height < 160.0 { 32.0 } else { 48.0 }) as usize
}

/// As many ticks as leave a gap of about two digits between their numbers.
fn sideways_ticks(axis: &Axis, length: f64) -> Ticks {
    let mut most = (length / 60.0) as usize;
    loop {
        let ticks = axis.ticks(most);
        let room = length / (ticks.labels.len().max(2) - 1) as f64;
        if most <= 3 || widest(&ticks) + 1.5 * NUMBER_SIZE <= room {
            return ticks;
        }
        most -= 1;
    }
}

impl Frame {
    pub(super) fn new(area: Rectangle, x: Axis, y: Axis) -> Self {
        let x_ticks = sideways_ticks(&x, area.width);
        let y_ticks = y.ticks(most_upward(area.height));
        Frame {
            area,
            x,
            y,
            x_ticks,
            y_ticks,
        }
    }

    /// The pixel column of `value` on the x axis.
    pub(super) fn column(&self, value: f64) -> f64 {
        self.area.left + self.area.width * self.x.place(value)
    }

    /// The pixel row of `value` on the y axis.
    pub(super) fn row(&self, value: f64) -> f64 {
        self.area.bottom() - self.area.height * self.y.place(value)
    }

    pub(super) fn point(&self, x: f64, y: f64) -> (f64, f64) {
        (self.column(x), self.row(y))
    }

    /// The lines of the grid: below everything else.
    pub(super) fn draw_grid(&self, canvas: &mut Canvas) {
        let strong = Stroke::solid(LIGHT_GREY, 1.0);
        let faint = Stroke::solid(LIGHT_GREY, 0.5);
        let area = self.area;
        for (values, stroke) in [(&self.x_ticks.minor, faint), (&self.x_ticks.values, strong)] {
            for &value in values {
                let x = self.column(value);
                canvas.line((x, area.top), (x, area.bottom()), stroke);
            }
        }
        for (values, stroke) in [(&self.y_ticks.minor, faint), (&self.y_ticks.values, strong)] {
            for &value in values {
                let y = self.row(value);
                canvas.line((area.left, y), (area.right(), y), stroke);
            }
        }
    }

    /// The border, the ticks, their numbers and the labels: above everything else.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas) {
        canvas.outline_rectangle(self.area, Stroke::solid(BLACK, 1.0));
        self.draw_x_ticks(canvas, true);
        let style = TextStyle::new(LABEL_SIZE, Anchor::Middle);
        let middle = self.area.left + 0.5 * self.area.width;
        canvas.text(middle, self.area.bottom() + 50.0, &self.x.label, style);
        self.draw_y_axis(canvas);
    }

    /// As [`Frame::draw_axes`], for a plot above another one that has the same x axis.
    pub(super) fn draw_axes_above(&self, canvas: &mut Canvas) {
        canvas.outline_rectangle(self.area, Stroke::solid(BLACK, 1.0));
        self.draw_x_ticks(canvas, false);
        self.draw_y_axis(canvas);
    }

    fn draw_x_ticks(&self, canvas: &mut Canvas, numbers: bool) {
        let bottom = self.area.bottom();
        let stroke = Stroke::solid(BLACK, 1.0);
        for &value in &self.x_ticks.minor {
            let x = self.column(value);
            canvas.line((x, bottom), (x, bottom + MINOR_TICK_LENGTH), stroke);
        }
        let style = TextStyle::new(NUMBER_SIZE, Anchor::Middle);
        for (&value, label) in self.x_ticks.values.iter().zip(&self.x_ticks.labels) {
            let x = self.column(value);
            canvas.line((x, bottom), (x, bottom + TICK_LENGTH), stroke);
            if numbers {
                canvas.text(x, bottom + TICK_LENGTH + 17.0, label, style);
            }
        }
        if numbers && self.x_ticks.exponent != 0 {
            let style = TextStyle::new(NUMBER_SIZE, Anchor::End);
            let label = exponent_label(self.x_ticks.exponent);
            canvas.text(self.area.right(), bottom + 50.0, &label, style);
        }
    }

    fn draw_y_axis(&self, canvas: &mut Canvas) {
        let left = self.area.left;
        let stroke = Stroke::solid(BLACK, 1.0);
        for &value in &self.y_ticks.minor {
            let y = self.row(value);
            canvas.line((left - MINOR_TICK_LENGTH, y), (left, y), stroke);
        }
        let style = TextStyle::new(NUMBER_SIZE, Anchor::End);
        for (&value, label) in self.y_ticks.values.iter().zip(&self.y_ticks.labels) {
            let y = self.row(value);
            canvas.line((left - TICK_LENGTH, y), (left, y), stroke);
            canvas.text(
                left - TICK_LENGTH - 4.0,
                y + 0.36 * NUMBER_SIZE,
                label,
                style,
            );
        }
        if self.y_ticks.exponent != 0 {
            let style = TextStyle::new(NUMBER_SIZE, Anchor::Start);
            let label = exponent_label(self.y_ticks.exponent);
            canvas.text(left, self.area.top - 7.0, &label, style);
        }
        let numbers = widest(&self.y_ticks) + TICK_LENGTH + 14.0;
        draw_upward_label(canvas, &self.y.label, self.area, left - numbers);
    }
}

/// A label that reads upwards beside `area`, its last line at the column `x`.
pub(super) fn draw_upward_label(canvas: &mut Canvas, label: &str, area: Rectangle, x: f64) {
    let lines = wrap(label, LABEL_SIZE, Weight::Regular, upward_room(area.height));
    let style = TextStyle {
        rotation: -90.0,
        ..TextStyle::new(LABEL_SIZE, Anchor::Middle)
    };
    for (index, line) in lines.iter().enumerate() {
        let back = (lines.len() - 1 - index) as f64 * LINE_SPACING * LABEL_SIZE;
        canvas.text(x - back, area.top + 0.5 * area.height, line, style);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_each_scale() {
        let axis = |scale, low, high| Axis {
            label: String::new(),
            low,
            high,
            scale,
        };
        assert_eq!(axis(Scale::Linear, -1.0, 3.0).place(1.0), 0.5);
        assert_eq!(axis(Scale::SquareRoot, 0.0, 4.0).place(1.0), 0.5);
        let decades = axis(Scale::Logarithmic, 1e-6, 1e-2);
        assert!((decades.place(1e-4) - 0.5).abs() < 1e-12);
        assert_eq!(decades.place(0.0), -10.0);
    }

    #[test]
    fn a_frame_maps_its_corners() {
        let (left, top, width, height) = (100.0, 50.0, 800.0, 400.0);
        let area = Rectangle {
            left,
            top,
            width,
            height,
        };
        let frame = Frame::new(
            area,
            Axis::linear("x", 0.0, 2.0),
            Axis::linear("y", -1.0, 1.0),
        );
        assert_eq!(frame.point(0.0, -1.0), (100.0, 450.0));
        assert_eq!(frame.point(2.0, 1.0), (900.0, 50.0));
    }

    #[test]
    fn an_axis_of_one_value_has_width() {
        for value in [0.0, 3.0, -3.0] {
            let axis = Axis::with_room("", value, value);
            assert!(axis.low < value && value < axis.high);
        }
    }
}
