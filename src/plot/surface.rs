//! The density over time and value, as a surface in three dimensions.
//!
//! The box of the plot has the coordinates (time, value, density), each from 0 to 1. Floor and back
//! walls come first, then the surface from back to front ([`super::mesh`]), then the axes.

use super::axes::{Axis, LABEL_SIZE, NUMBER_SIZE};
use super::canvas::{Anchor, Canvas, Stroke, TextStyle};
use super::colour::{BLACK, Colour, LIGHT_GREY};
use super::density::{DensityAtTime, Evolution};
use super::density_scale::{DensityScale, density_axis};
use super::fan::value_label;
use super::heat_map::density_label;
use super::mesh::Mesh;
use super::page::Page;
use super::statistics::ValueAxis;
use super::text::{Weight, width};
use super::ticks::{Ticks, exponent_label, in_words};
use super::units::{Label, Unit};
use super::view::{FLOOR_COLOUR, View};
use super::{Image, TIME_LABEL};
use crate::Result;

const PICTURE: &str = "surface of the density";
/// The evolution of a density as a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface<'a> {
    pub label: Label<'a>,
    /// In the order of time; times without spread are left out.
    pub densities: &'a [DensityAtTime<'a>],
    pub value_axis: ValueAxis,
    /// Of the heights; [`DensityScale::Linear`] is what a surface usually has.
    pub density_scale: DensityScale,
}

impl Surface<'_> {
    /// Draws it.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there are fewer than two times or a density is none.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        let evolution = Evolution::new(PICTURE, self.densities)?;
        let deviates = evolution.statistics().deviates(self.value_axis);
        let (low, high) = evolution.value_range(deviates);
        let unit = Unit::suiting(self.label.unit, low.abs().max(high.abs()));
        let label = value_label(&self.label, &unit, deviates);
        let value = Axis::with_room(label, unit.factor * low, unit.factor * high);
        let (start, end) = evolution.time_range();
        let time = Axis::linear(TIME_LABEL, start, end);
        let mesh = Mesh::new(&evolution, &time, &value, unit.factor, deviates);
        let label = density_label(&self.label, &unit);
        let (density, cut) = density_axis(label, &mesh.peaks(), self.density_scale);
        let mut remarks = Vec::new();
        if deviates {
            remarks.push("measured from the mean, μ".to_owned());
        }
        if cut {
            let end = in_words(density.high);
            let unit = unit.inverse().text;
            remarks.push(format!("cut at\u{a0}{end}\u{a0}{unit}"));
        }
        let (mut canvas, room) = page.start(&remarks, &[]);
        let axes = [time, value, density];
        let view = View::new(room, widest(&axes[2].ticks(6)));
        draw_walls(&mut canvas, &view, &axes);
        mesh.draw(&mut canvas, &view, &axes[2]);
        draw_axes(&mut canvas, &view, &axes);
        Ok(canvas.finish())
    }
}

fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks
        .labels
        .iter()
        .map(|label| width(label, NUMBER_SIZE, Weight::Regular));
    widths.fold(0.0, f64::max)
}

/// Floor and back walls with their grid.
fn draw_walls(canvas: &mut Canvas, view: &View, axes: &[Axis; 3]) {
    let corner = |u: f64, v: f64, w: f64| view.point([u, v, w]);
    let floor = [
        corner(0.0, 0.0, 0.0),
        corner(1.0, 0.0, 0.0),
        corner(1.0, 1.0, 0.0),
        corner(0.0, 1.0, 0.0),
    ];
    let side = [
        corner(0.0, 0.0, 0.0),
        corner(0.0, 1.0, 0.0),
        corner(0.0, 1.0, 1.0),
        corner(0.0, 0.0, 1.0),
    ];
    let back = [
        corner(0.0, 1.0, 0.0),
        corner(1.0, 1.0, 0.0),
        corner(1.0, 1.0, 1.0),
        corner(0.0, 1.0, 1.0),
    ];
    for (wall, colour) in [(floor, FLOOR_COLOUR), (side, grey(250)), (back, grey(253))] {
        canvas.polygon(&wall, colour, 1.0);
    }
    let grid = Stroke::solid(LIGHT_GREY, 1.0);
    let place = |axis: usize| places(&axes[axis]);
    for u in place(0) {
        canvas.polyline(
            &[
                corner(u, 0.0, 0.0),
                corner(u, 1.0, 0.0),
                corner(u, 1.0, 1.0),
            ],
            grid,
        );
    }
    for v in place(1) {
        canvas.polyline(
            &[
                corner(1.0, v, 0.0),
                corner(0.0, v, 0.0),
                corner(0.0, v, 1.0),
            ],
            grid,
        );
    }
    for w in place(2) {
        canvas.polyline(
            &[
                corner(0.0, 0.0, w),
                corner(0.0, 1.0, w),
                corner(1.0, 1.0, w),
            ],
            grid,
        );
    }
    let edge = Stroke::solid(Colour(150, 150, 150), 1.0);
    for (from, to) in [
        ((0.0, 1.0, 0.0), (0.0, 1.0, 1.0)),
        ((0.0, 1.0, 0.0), (1.0, 1.0, 0.0)),
        ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0)),
        ((0.0, 0.0, 1.0), (0.0, 1.0, 1.0)),
        ((0.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
        ((1.0, 1.0, 0.0), (1.0, 1.0, 1.0)),
    ] {
        canvas.line(
            corner(from.0, from.1, from.2),
            corner(to.0, to.1, to.2),
            edge,
        );
    }
}

fn grey(value: u8) -> Colour {
    Colour(value, value, value)
}

fn places(axis: &Axis) -> Vec<f64> {
    axis.ticks(6)
        .values
        .iter()
        .map(|&value| axis.place(value))
        .collect()
}

/// The three edges with ticks, numbers and labels.
fn draw_axes(canvas: &mut Canvas, view: &View, axes: &[Axis; 3]) {
    let [time, value, density] = axes;
    let toward = |edge: usize, sign: f64| {
        let (x, y) = view.edges[edge];
        let length = x.hypot(y);
        (sign * x / length, sign * y / length)
    };
    Edge {
        from: view.point([0.0, 0.0, 0.0]),
        to: view.point([1.0, 0.0, 0.0]),
        outward: toward(1, -1.0),
        anchor: Anchor::End,
        lowest: view.lowest,
    }
    .draw(canvas, time);
    Edge {
        from: view.point([1.0, 0.0, 0.0]),
        to: view.point([1.0, 1.0, 0.0]),
        outward: toward(0, 1.0),
        anchor: Anchor::Start,
        lowest: view.lowest,
    }
    .draw(canvas, value);
    draw_upright_edge(canvas, view, density);
}

/// An edge of the floor.
struct Edge {
    from: (f64, f64),
    to: (f64, f64),
    /// The direction in which its ticks point, of length 1.
    outward: (f64, f64),
    anchor: Anchor,
    /// The row above which its label has to end.
    lowest: f64,
}

impl Edge {
    fn draw(&self, canvas: &mut Canvas, axis: &Axis) {
        let stroke = Stroke::solid(BLACK, 1.0);
        canvas.line(self.from, self.to, stroke);
        let ticks = axis.ticks(6);
        let style = TextStyle::new(NUMBER_SIZE, self.anchor);
        for (&tick, label) in ticks.values.iter().zip(&ticks.labels) {
            let at = self.at(axis.place(tick));
            canvas.line(at, self.beyond(at, 6.0), stroke);
            let (x, y) = self.beyond(at, 11.0);
            canvas.text(x, y + 0.8 * NUMBER_SIZE, label, style);
        }
        let mut text = axis.label.clone();
        if ticks.exponent != 0 {
            text = format!("{text} {}", exponent_label(ticks.exponent));
        }
        // Along the edge, beyond the numbers.
        let slope = (self.to.1 - self.from.1).atan2(self.to.0 - self.from.0);
        let style = TextStyle {
            rotation: slope.to_degrees(),
            ..TextStyle::new(LABEL_SIZE, Anchor::Middle)
        };
        let (x, y) = self.at(0.5);
        let away = widest(&ticks) * slope.sin().abs() + NUMBER_SIZE * 2.4 + 14.0;
        // Perpendicular to the edge, downwards on the page.
        let (x, y) = (x - slope.sin() * away, y + slope.cos() * away);
        // A long label that rises to the right must not start below the page.
        let length = width(&text, LABEL_SIZE, Weight::Regular);
        let below = y - 0.5 * length * slope.sin() + 0.5 * LABEL_SIZE - self.lowest;
        let along = if slope < 0.0 {
            (below / slope.sin()).min(0.0)
        } else {
            0.0
        };
        let (x, y) = (x - along * slope.cos(), y - along * slope.sin());
        canvas.text(x, y, &text, style);
    }

    fn at(&self, part: f64) -> (f64, f64) {
        let mix = |a: f64, b: f64| a + part * (b - a);
        (mix(self.from.0, self.to.0), mix(self.from.1, self.to.1))
    }

    fn beyond(&self, at: (f64, f64), length: f64) -> (f64, f64) {
        (
            at.0 + length * self.outward.0,
            at.1 + length * self.outward.1,
        )
    }
}

fn draw_upright_edge(canvas: &mut Canvas, view: &View, axis: &Axis) {
    let stroke = Stroke::solid(BLACK, 1.0);
    let (bottom, top) = (view.point([0.0; 3]), view.point([0.0, 0.0, 1.0]));
    canvas.line(bottom, top, stroke);
    let ticks = axis.ticks(6);
    let style = TextStyle::new(NUMBER_SIZE, Anchor::End);
    for (&tick, label) in ticks.values.iter().zip(&ticks.labels) {
        let (x, y) = view.point([0.0, 0.0, axis.place(tick)]);
        canvas.line((x - 6.0, y), (x, y), stroke);
        canvas.text(x - 10.0, y + 0.36 * NUMBER_SIZE, label, style);
    }
    let mut text = axis.label.clone();
    if ticks.exponent != 0 {
        text = format!("{text} {}", exponent_label(ticks.exponent));
    }
    let style = TextStyle {
        rotation: -90.0,
        ..TextStyle::new(LABEL_SIZE, Anchor::Middle)
    };
    canvas.text(
        bottom.0 - widest(&ticks) - 28.0,
        0.5 * (bottom.1 + top.1),
        &text,
        style,
    );
}
