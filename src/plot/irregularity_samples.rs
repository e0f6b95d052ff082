//! Samples of an irregularity over positions, or of an excitation over times.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::Stroke;
use super::check;
use super::colour::line_colour;
use super::lines::thinned;
use super::page::{Entry, Page, plot_area};
use super::statistics::range;
use super::units::{Label, Unit, axis_label};
use super::{Image, RIGHT_MARGIN};
use crate::Result;

/// Samples of an irregularity or an excitation, one line each.
#[derive(Debug, Clone, PartialEq)]
pub struct IrregularitySamples<'a> {
    /// The irregularity and its unit, such as `r(x)` and `m`.
    pub label: Label<'a>,
    /// What it is given over, such as `Position, x (m)`.
    pub place: &'a str,
    /// m or s.
    pub position_start: f64,
    /// m or s, positive.
    pub position_step: f64,
    /// Name (`point 17`) and values of each sample.
    pub samples: &'a [(String, &'a [f64])],
}

impl IrregularitySamples<'_> {
    /// Draws them.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where there is no sample, fewer than two positions, or a value is not
    /// finite.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        let picture = "plot of irregularity samples";
        check::at_least(picture, "samples", 1, self.samples.len())?;
        check::positive(picture, "position step", self.position_step)?;
        for (_, values) in self.samples {
            check::at_least(picture, "positions", 2, values.len())?;
            check::finite(picture, "irregularity", values)?;
        }
        let (low, high) = range(
            self.samples
                .iter()
                .flat_map(|(_, values)| values.iter().copied()),
        );
        let unit = Unit::suiting(self.label.unit, low.abs().max(high.abs()));
        let label = axis_label(self.label.name, self.label.symbol, &unit);
        let y = Axis::with_room(label, unit.factor * low, unit.factor * high);
        let longest = self
            .samples
            .iter()
            .map(|(_, values)| values.len())
            .max()
            .unwrap_or(2);
        let position = |index: usize| self.position_start + index as f64 * self.position_step;
        let x = Axis::linear(self.place, position(0), position(longest - 1));

        let few = self.samples.len() <= 4;
        let stroke = |index| Stroke::solid(line_colour(index), if few { 1.6 } else { 1.1 });
        let named = self.samples.iter().enumerate();
        let legend: Vec<Entry> = named
            .map(|(i, (name, _))| Entry::line(stroke(i), name))
            .collect();
        let (mut canvas, room) = page.start(&[], &legend);
        let margin = left_margin(&y, room.height);
        let frame = Frame::new(plot_area(room, margin, RIGHT_MARGIN), x, y);
        frame.draw_grid(&mut canvas);
        canvas.clipped(frame.area, |canvas| {
            for (line, (_, values)) in self.samples.iter().enumerate() {
                let points = values.iter().enumerate();
                let points = points.map(|(i, r)| frame.point(position(i), unit.factor * r));
                canvas.polyline(&thinned(points), stroke(line));
            }
        });
        frame.draw_axes(&mut canvas);
        Ok(canvas.finish())
    }
}
