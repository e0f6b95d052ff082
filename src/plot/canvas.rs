//! The SVG text: rectangles, lines, paths, text and images, coordinates to a tenth of a pixel.

use std::fmt::Write;

use super::colour::Colour;
use super::image::Image;
use super::path::{number, path_data};
use super::text::{FAMILY, Level, SMALL, Weight, runs};

/// A rectangle, in pixels from the top left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Rectangle {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub colour: Colour,
    pub width: f64,
    pub opacity: f64,
    /// Lengths of strokes and gaps in pixels; empty for a solid line.
    pub dashes: &'static str,
}

impl Stroke {
    pub(super) fn solid(colour: Colour, width: f64) -> Self {
        Stroke {
            colour,
            width,
            opacity: 1.0,
            dashes: "",
        }
    }

    pub(super) fn dashed(self, dashes: &'static str) -> Self {
        Stroke { dashes, ..self }
    }

    pub(super) fn opacity(self, opacity: f64) -> Self {
        Stroke { opacity, ..self }
    }
}

/// Where a text lies about its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is written; `rotation` in degrees, clockwise, about its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TextStyle {
    pub size: f64,
    pub weight: Weight,
    pub anchor: Anchor,
    pub colour: Colour,
    pub rotation: f64,
}

impl TextStyle {
    pub(super) fn new(size: f64, anchor: Anchor) -> Self {
        TextStyle {
            size,
            weight: Weight::Regular,
            anchor,
            colour: super::colour::BLACK,
            rotation: 0.0,
        }
    }
}

/// An SVG picture being written.
pub(super) struct Canvas {
    width: f64,
    height: f64,
    body: String,
    identities: usize,
}

impl Canvas {
    /// A white page of this many pixels.
    pub(super) fn new(width: f64, height: f64) -> Self {
        let body = String::new();
        let mut canvas = Canvas {
            width,
            height,
            body,
            identities: 0,
        };
        let (left, top) = (0.0, 0.0);
        let page = Rectangle {
            left,
            top,
            width,
            height,
        };
        canvas.fill_rectangle(page, super::colour::WHITE, 1.0);
        canvas
    }

    fn write(&mut self, text: std::fmt::Arguments<'_>) {
        self.body.write_fmt(text).expect("a string takes any text");
        self.body.push('\n');
    }

    fn identity(&mut self) -> usize {
        self.identities += 1;
        self.identities
    }

    pub(super) fn fill_rectangle(&mut self, area: Rectangle, colour: Colour, opacity: f64) {
        let (x, y, width, height) = corners(area);
        let opacity = opacity_attribute("fill-opacity", opacity);
        self.write(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="{colour}"{opacity}/>"#
        ));
    }

    pub(super) fn outline_rectangle(&mut self, area: Rectangle, stroke: Stroke) {
        let (x, y, width, height) = corners(area);
        let stroke = stroke_attributes(stroke);
        self.write(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="none"{stroke}/>"#
        ));
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
        self.polyline(&[from, to], stroke);
    }

    /// Lines through `points`; nothing for fewer than two.
    pub(super) fn polyline(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        if points.len() < 2 {
            return;
        }
        let (path, stroke) = (path_data(points), stroke_attributes(stroke));
        self.write(format_args!(r#"<path d="{path}" fill="none"{stroke}/>"#));
    }

    /// A filled polygon with an outline of its own.
    pub(super) fn polygon(&mut self, points: &[(f64, f64)], fill: Colour, opacity: f64) {
        let path = path_data(points);
        let opacity = opacity_attribute("fill-opacity", opacity);
        self.write(format_args!(
            r#"<path d="{path}z" fill="{fill}"{opacity}/>"#
        ));
    }

    /// A filled polygon whose outline has the same colour, so that neighbours leave no gap.
    pub(super) fn tile(&mut self, points: &[(f64, f64)], fill: Colour) {
        let path = path_data(points);
        self.write(format_args!(
            r#"<path d="{path}z" fill="{fill}" stroke="{fill}"/>"#
        ));
    }

    /// An image over `area`, from its PNG bytes.
    pub(super) fn image(&mut self, area: Rectangle, png: &[u8]) {
        use base64::Engine;
        let (x, y, width, height) = corners(area);
        let data = base64::engine::general_purpose::STANDARD.encode(png);
        self.write(format_args!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
             preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64,{data}\"/>"
        ));
    }

    /// A rectangle whose colour runs from `stops[0]` at the bottom to the last at the top.
    pub(super) fn upward_gradient(&mut self, area: Rectangle, stops: &[Colour]) {
        let name = self.identity();
        let last = (stops.len() - 1) as f64;
        self.write(format_args!(
            r#"<linearGradient id="gradient{name}" x1="0" y1="1" x2="0" y2="0">"#
        ));
        for (index, colour) in stops.iter().enumerate() {
            let offset = index as f64 / last;
            self.write(format_args!(
                r#"<stop offset="{offset:.4}" stop-color="{colour}"/>"#
            ));
        }
        self.write(format_args!("</linearGradient>"));
        let (x, y, width, height) = corners(area);
        self.write(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="url(#gradient{name})"/>"#
        ));
    }

    /// What `draw` writes is seen inside `area` only.
    pub(super) fn clipped(&mut self, area: Rectangle, draw: impl FnOnce(&mut Canvas)) {
        let name = self.identity();
        let (x, y, width, height) = corners(area);
        self.write(format_args!(
            "<clipPath id=\"clip{name}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" \
             height=\"{height}\"/></clipPath>\n<g clip-path=\"url(#clip{name})\">"
        ));
        draw(self);
        self.write(format_args!("</g>"));
    }

    /// What `draw` writes shares these attributes, unless it has its own.
    pub(super) fn group(&mut self, attributes: &str, draw: impl FnOnce(&mut Canvas)) {
        self.write(format_args!("<g {attributes}>"));
        draw(self);
        self.write(format_args!("</g>"));
    }

    /// Marked-up text (see [`super::text`]) with its baseline at `(x, y)`.
    pub(super) fn text(&mut self, x: f64, y: f64, text: &str, style: TextStyle) {
        let anchor = match style.anchor {
            Anchor::Start => "",
            Anchor::Middle => r#" text-anchor="middle""#,
            Anchor::End => r#" text-anchor="end""#,
        };
        let weight = match style.weight {
            Weight::Regular => "",
            Weight::Bold => r#" font-weight="bold""#,
        };
        let (x, y) = (number(x), number(y));
        let rotation = match style.rotation {
            0.0 => String::new(),
            angle => format!(r#" transform="rotate({} {x} {y})""#, number(angle)),
        };
        let (size, colour, spans) = (number(style.size), style.colour, spans(text, style.size));
        self.write(format_args!(
            r#"<text x="{x}" y="{y}" font-size="{size}" fill="{colour}"{anchor}{weight}{rotation}>{spans}</text>"#
        ));
    }

    /// The finished picture.
    pub(super) fn finish(self) -> Image {
        let (width, height) = (number(self.width), number(self.height));
        let body = self.body;
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" \
             xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FAMILY}\">\n{body}</svg>\n"
        );
        Image { svg }
    }
}

/// The `tspan`s of marked-up text. A shift of the baseline holds until it is taken back.
fn spans(text: &str, size: f64) -> String {
    let mut result = String::new();
    let mut below = 0.0;
    for run in runs(text) {
        let shift = number(size * (run.level.drop() - below));
        below = run.level.drop();
        let content = escape(run.text);
        let span = match (run.level, shift.as_str()) {
            (Level::Base, "0") => content,
            (Level::Base, _) => format!(r#"<tspan dy="{shift}">{content}</tspan>"#),
            (Level::Superscript | Level::Subscript, _) => {
                let small = number(size * SMALL);
                format!(r#"<tspan dy="{shift}" font-size="{small}">{content}</tspan>"#)
            }
        };
        result.push_str(&span);
    }
    result
}

/// Text without the characters that mean something in XML, or nothing at all there.
fn escape(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => result.push_str("&amp;"),
            '<' => result.push_str("&lt;"),
            '>' => result.push_str("&gt;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => result.push(' '),
            c => result.push(c),
        }
    }
    result
}

fn corners(area: Rectangle) -> (String, String, String, String) {
    let (width, height) = (number(area.width), number(area.height));
    (number(area.left), number(area.top), width, height)
}

fn opacity_attribute(name: &str, opacity: f64) -> String {
    if opacity < 1.0 {
        format!(r#" {name}="{opacity:.3}""#)
    } else {
        String::new()
    }
}

fn stroke_attributes(stroke: Stroke) -> String {
    let Stroke { colour, width, .. } = stroke;
    let opacity = opacity_attribute("stroke-opacity", stroke.opacity);
    let dashes = match stroke.dashes {
        "" => String::new(),
        dashes => format!(r#" stroke-dasharray="{dashes}""#),
    };
    // A hundredth of a pixel is visible in the width of a thin line.
    let width = (width * 100.0).round() / 100.0;
    format!(r#" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{opacity}{dashes}"#)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_its_baseline_comes_back() {
        let written = spans("a<b & P_{f} = 10^{−3} m", 10.0);
        assert_eq!(
            written,
            "a&lt;b &amp; P<tspan dy=\"2\" font-size=\"7.2\">f</tspan><tspan dy=\"-2\"> = 10</tspan>\
             <tspan dy=\"-3.8\" font-size=\"7.2\">−3</tspan><tspan dy=\"3.8\"> m</tspan>"
        );
    }
}
