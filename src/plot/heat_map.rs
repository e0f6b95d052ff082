//! The density over time and value, as colours.

use resvg::tiny_skia;

use super::axes::{Axis, Frame, NUMBER_SIZE, Scale, draw_upward_label, left_margin};
use super::canvas::{Anchor, Canvas, Rectangle, Stroke, TextStyle};
use super::colour::{BLACK, BLANK, WHITE, viridis};
use super::density::{DensityAtTime, Evolution};
use super::density_scale::{DensityScale, density_axis};
use super::fan::value_label;
use super::lines::thinned;
use super::page::{Entry, Page, Swatch, plot_area};
use super::panels::{draw_mean_panel, left_margin_of_both, split};
use super::statistics::{Statistics, ValueAxis};
use super::text::{Weight, width};
use super::ticks::{exponent_label, in_words};
use super::units::{Label, Unit, axis_label};
use super::{Image, TIME_LABEL};
use crate::{Error, Result};

const PICTURE: &str = "heat map of the density";
const BAR_SPACE: f64 = 22.0;
const BAR_WIDTH: f64 = 18.0;

/// The evolution of a density as a heat map.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap<'a> {
    pub label: Label<'a>,
    /// In the order of time; times without spread are left out.
    pub densities: &'a [DensityAtTime<'a>],
    /// Mean and quantiles for the lines; taken from the densities where there are none.
    pub statistics: Option<&'a Statistics>,
    pub value_axis: ValueAxis,
    pub density_scale: DensityScale,
}

impl HeatMap<'_> {
    /// Draws it; where values are measured from the mean, with the mean in a panel above.
    ///
    /// # Errors
    /// [`Error::Input`] where there are fewer than two times or a density is none.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        let evolution = Evolution::new(PICTURE, self.densities)?;
        let statistics = match self.statistics {
            Some(given) => given.clone(),
            None => evolution.statistics(),
        };
        statistics.check(PICTURE)?;
        let deviates = statistics.deviates(self.value_axis);
        let (low, high) = evolution.value_range(deviates);
        let unit = Unit::suiting(self.label.unit, low.abs().max(high.abs()));
        let label = value_label(&self.label, &unit, deviates);
        let y = Axis::with_room(label, unit.factor * low, unit.factor * high);
        let (start, end) = evolution.time_range();
        let last = statistics.times[statistics.times.len() - 1];
        let x = Axis::linear(TIME_LABEL, start.min(statistics.times[0]), end.max(last));

        // The remark on the scale may add a line above: colours first, in a page's usual size.
        let peaks = peaks(&evolution, &y, unit.factor, deviates);
        let (scale, cut) = density_axis(
            density_label(&self.label, &unit),
            &peaks,
            self.density_scale,
        );
        // Lines would cover a hairline.
        let with_lines = deviates || !statistics.deviates(ValueAxis::Automatic);
        let lines = legend();
        let remarks = remarks(&scale, &unit, cut);
        let (mut canvas, room) = page.start(&remarks, if with_lines { &lines } else { &[] });
        let right = bar_margin(&scale, room.height);
        let area = if deviates {
            let margin = left_margin_of_both(room, &y, &self.label, &statistics);
            let (above, below) = split(plot_area(room, margin, right));
            draw_mean_panel(&mut canvas, above, &x, &self.label, &statistics);
            below
        } else {
            plot_area(room, left_margin(&y, room.height), right)
        };
        let frame = Frame::new(area, x, y);
        let png = raster(&evolution, &frame, &scale, unit.factor, deviates)?;
        canvas.image(area, &png);
        if with_lines {
            canvas.clipped(area, |canvas| {
                draw_lines(canvas, &frame, &statistics, unit.factor, deviates);
            });
        }
        frame.draw_axes(&mut canvas);
        draw_bar(&mut canvas, area, &scale);
        Ok(canvas.finish())
    }
}

/// `Probability density, p(y, t) (mm^{−1})`.
pub(super) fn density_label(label: &Label<'_>, unit: &Unit) -> String {
    let symbol = match label.symbol.split('(').next() {
        None | Some("") => "p".to_owned(),
        Some(symbol) => format!("p({symbol}, t)"),
    };
    axis_label("Probability density", &symbol, &unit.inverse())
}

fn remarks(scale: &Axis, unit: &Unit, cut: bool) -> Vec<String> {
    let inverse = unit.inverse().text;
    let shown = |value| format!("{}\u{a0}{inverse}", in_words(value));
    let least = (scale.scale == Scale::Logarithmic)
        .then(|| format!("darkest colour: {} and less", shown(scale.low)));
    let most = cut.then(|| format!("brightest colour: {} and more", shown(scale.high)));
    least.into_iter().chain(most).collect()
}

/// The highest density of each time, as one of 500 cells of the axis shows it.
fn peaks(evolution: &Evolution<'_>, y: &Axis, factor: f64, deviates: bool) -> Vec<f64> {
    let peak = |time: f64| -> f64 {
        let cells = evolution.at(time).map(|column| {
            let origin = if deviates { column.mean } else { 0.0 };
            column.cells(origin + y.low / factor, origin + y.high / factor, 500)
        });
        cells.into_iter().flatten().fold(0.0, f64::max) / factor
    };
    evolution
        .slices
        .iter()
        .map(|slice| peak(slice.density.time))
        .collect()
}

/// The colours as a PNG, one pixel for each of the page.
fn raster(
    evolution: &Evolution<'_>,
    frame: &Frame,
    scale: &Axis,
    factor: f64,
    deviates: bool,
) -> Result<Vec<u8>> {
    let (wide, high) = (
        frame.area.width.round() as usize,
        frame.area.height.round() as usize,
    );
    let mut pixels = vec![0; wide * high * 4];
    let (low_value, high_value) = (frame.y.low / factor, frame.y.high / factor);
    for x in 0..wide {
        let part = (x as f64 + 0.5) / wide as f64;
        let time = frame.x.low + part * (frame.x.high - frame.x.low);
        let column = evolution.at(time);
        let cells = column.map(|column| {
            let origin = if deviates { column.mean } else { 0.0 };
            column.cells(origin + low_value, origin + high_value, high)
        });
        for y in 0..high {
            let colour = match &cells {
                // The first row is at the top.
                Some(cells) => viridis(scale.place(cells[high - 1 - y] / factor)),
                None => BLANK,
            };
            let place = 4 * (y * wide + x);
            pixels[place..place + 4].copy_from_slice(&[colour.0, colour.1, colour.2, 255]);
        }
    }
    let size = tiny_skia::IntSize::from_wh(wide as u32, high as u32);
    let image = size.and_then(|size| tiny_skia::Pixmap::from_vec(pixels, size));
    let failed = |reason: String| Error::Numerical(format!("can't encode the heat map: {reason}"));
    let image = image.ok_or_else(|| failed(format!("{wide} by {high} pixels")))?;
    image
        .encode_png()
        .map_err(|error| failed(error.to_string()))
}

struct Strokes {
    mean: Stroke,
    outer: Stroke,
    inner: Stroke,
}

fn strokes() -> Strokes {
    Strokes {
        mean: Stroke::solid(WHITE, 1.8),
        inner: Stroke::solid(WHITE, 1.2).dashed("8 4"),
        outer: Stroke::solid(WHITE, 1.2).dashed("2 3"),
    }
}

fn legend() -> [Entry; 3] {
    let Strokes { mean, outer, inner } = strokes();
    [
        (mean, "mean, μ"),
        (inner, "25 % and 75 % quantiles"),
        (outer, "5 % and 95 % quantiles"),
    ]
    .map(|(stroke, name)| Entry {
        swatch: Swatch::LineOn(stroke, viridis(0.25)),
        name: name.to_owned(),
    })
}

fn draw_lines(canvas: &mut Canvas, frame: &Frame, of: &Statistics, factor: f64, deviates: bool) {
    let Strokes { mean, outer, inner } = strokes();
    for (values, stroke) in [
        (&of.quantile_05, outer),
        (&of.quantile_95, outer),
        (&of.quantile_25, inner),
        (&of.quantile_75, inner),
        (&of.mean, mean),
    ] {
        let rows = of.times.iter().zip(values).zip(&of.mean);
        let origin = |mean: f64| if deviates { mean } else { 0.0 };
        let points = rows.map(|((&t, v), &mean)| frame.point(t, factor * (v - origin(mean))));
        canvas.polyline(&thinned(points), stroke);
    }
}

/// The room at the right for the colour bar, its numbers and its label.
fn bar_margin(scale: &Axis, height: f64) -> f64 {
    let ticks = scale.ticks((height / 48.0) as usize);
    let numbers = ticks
        .labels
        .iter()
        .map(|label| width(label, NUMBER_SIZE, Weight::Regular));
    BAR_SPACE + BAR_WIDTH + 10.0 + numbers.fold(0.0, f64::max) + 48.0
}

fn draw_bar(canvas: &mut Canvas, area: Rectangle, scale: &Axis) {
    let bar = Rectangle {
        left: area.right() + BAR_SPACE,
        width: BAR_WIDTH,
        ..area
    };
    let stops: Vec<_> = (0..=32).map(|i| viridis(f64::from(i) / 32.0)).collect();
    canvas.upward_gradient(bar, &stops);
    canvas.outline_rectangle(bar, Stroke::solid(BLACK, 1.0));
    let ticks = scale.ticks((area.height / 48.0) as usize);
    let style = TextStyle::new(NUMBER_SIZE, Anchor::Start);
    let mut numbers: f64 = 0.0;
    let mut last = f64::INFINITY;
    for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
        let y = bar.bottom() - bar.height * scale.place(value);
        canvas.line(
            (bar.right(), y),
            (bar.right() + 5.0, y),
            Stroke::solid(BLACK, 1.0),
        );
        // A square root crowds the upper numbers.
        if last - y >= 1.3 * NUMBER_SIZE {
            canvas.text(bar.right() + 9.0, y + 0.36 * NUMBER_SIZE, label, style);
            last = y;
        }
        numbers = numbers.max(width(label, NUMBER_SIZE, Weight::Regular));
    }
    if ticks.exponent != 0 {
        canvas.text(
            bar.left,
            bar.top - 7.0,
            &exponent_label(ticks.exponent),
            style,
        );
    }
    draw_upward_label(
        canvas,
        &scale.label,
        bar,
        bar.right() + 10.0 + numbers + 24.0,
    );
}
