//! The page of a picture: title, subtitle, legend, and the room that is left.

use super::axes::BOTTOM_MARGIN;
use super::canvas::{Anchor, Canvas, Rectangle, Stroke, TextStyle};
use super::colour::{BLACK, Colour, DARK_GREY};
use super::text::{Weight, width, wrap};

const TITLE_SIZE: f64 = 20.0;
const SUBTITLE_SIZE: f64 = 15.0;
const LEGEND_SIZE: f64 = 15.0;
const SIDE: f64 = 24.0;
const SWATCH: f64 = 30.0;

/// What stands above a picture, and its size in pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    pub title: String,
    /// The case and the number of points; what a picture leaves out is added to it.
    pub subtitle: String,
    /// At least 400.
    pub width: f64,
    /// At least 300.
    pub height: f64,
}

impl Page {
    /// A page of 1000 by 650 pixels.
    pub fn new(title: impl Into<String>, subtitle: impl Into<String>) -> Self {
        Page {
            title: title.into(),
            subtitle: subtitle.into(),
            width: 1000.0,
            height: 650.0,
        }
    }

    /// Writes title, subtitle with `remarks`, and legend; gives the canvas and the room below them.
    pub(super) fn start(&self, remarks: &[String], legend: &[Entry]) -> (Canvas, Rectangle) {
        let (page_width, page_height) = (self.width.max(400.0), self.height.max(300.0));
        let mut canvas = Canvas::new(page_width, page_height);
        let room = page_width - 2.0 * SIDE;
        let mut y = 14.0;
        let title = TextStyle {
            weight: Weight::Bold,
            ..TextStyle::new(TITLE_SIZE, Anchor::Start)
        };
        y = write_lines(&mut canvas, &self.title, title, y, room);
        let subtitle = TextStyle {
            colour: DARK_GREY,
            ..TextStyle::new(SUBTITLE_SIZE, Anchor::Start)
        };
        let said = std::iter::once(&self.subtitle).chain(remarks);
        let said: Vec<&str> = said
            .map(String::as_str)
            .filter(|text| !text.is_empty())
            .collect();
        y = write_lines(&mut canvas, &said.join(" · "), subtitle, y + 2.0, room);
        y = draw_legend(&mut canvas, legend, y + 6.0, room);
        let (left, top) = (0.0, y + 16.0);
        let rest = Rectangle {
            left,
            top,
            width: page_width,
            height: (page_height - top).max(120.0),
        };
        (canvas, rest)
    }
}

/// The plot's own area in `room`, once its left margin is known; `right` px are kept free at the right.
pub(super) fn plot_area(room: Rectangle, left_margin: f64, right: f64) -> Rectangle {
    Rectangle {
        left: room.left + left_margin,
        top: room.top,
        width: room.width - left_margin - right,
        height: room.height - BOTTOM_MARGIN,
    }
}

fn write_lines(canvas: &mut Canvas, text: &str, style: TextStyle, top: f64, room: f64) -> f64 {
    let mut y = top;
    for line in wrap(text, style.size, style.weight, room) {
        y += 1.3 * style.size;
        canvas.text(SIDE, y - 0.25 * style.size, &line, style);
    }
    y
}

/// What stands before a name in the legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Swatch {
    Line(Stroke),
    /// A line with a band about it.
    LineInBand(Stroke, Colour, f64),
    Band(Colour, f64),
    /// A light line, on the dark that it is drawn on.
    LineOn(Stroke, Colour),
}

/// One name in the legend.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub swatch: Swatch,
    pub name: String,
}

impl Entry {
    pub(super) fn line(stroke: Stroke, name: impl Into<String>) -> Self {
        Entry {
            swatch: Swatch::Line(stroke),
            name: name.into(),
        }
    }

    pub(super) fn band(colour: Colour, opacity: f64, name: impl Into<String>) -> Self {
        Entry {
            swatch: Swatch::Band(colour, opacity),
            name: name.into(),
        }
    }
}

/// Draws the legend in rows, each as full as it gets; gives the row below it.
fn draw_legend(canvas: &mut Canvas, entries: &[Entry], top: f64, room: f64) -> f64 {
    if entries.is_empty() {
        return top - 6.0;
    }
    let (mut x, mut y) = (SIDE, top + 12.0);
    let style = TextStyle {
        colour: BLACK,
        ..TextStyle::new(LEGEND_SIZE, Anchor::Start)
    };
    for entry in entries {
        let name_width = width(&entry.name, LEGEND_SIZE, Weight::Regular);
        let entry_width = SWATCH + 8.0 + name_width;
        if x > SIDE && x + entry_width > SIDE + room {
            (x, y) = (SIDE, y + 1.5 * LEGEND_SIZE);
        }
        draw_swatch(canvas, entry.swatch, x, y);
        canvas.text(x + SWATCH + 8.0, y + 0.36 * LEGEND_SIZE, &entry.name, style);
        x += entry_width + 26.0;
    }
    y + 0.6 * LEGEND_SIZE
}

fn draw_swatch(canvas: &mut Canvas, swatch: Swatch, x: f64, y: f64) {
    let patch = Rectangle {
        left: x,
        top: y - 7.0,
        width: SWATCH,
        height: 14.0,
    };
    let ends = ((x, y), (x + SWATCH, y));
    match swatch {
        Swatch::Line(stroke) => canvas.line(ends.0, ends.1, stroke),
        Swatch::Band(colour, opacity) => canvas.fill_rectangle(patch, colour, opacity),
        Swatch::LineInBand(stroke, colour, opacity) => {
            canvas.fill_rectangle(patch, colour, opacity);
            canvas.line(ends.0, ends.1, stroke);
        }
        Swatch::LineOn(stroke, colour) => {
            canvas.fill_rectangle(patch, colour, 1.0);
            canvas.line(ends.0, ends.1, stroke);
        }
    }
}
