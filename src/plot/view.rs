//! The view of a box in three dimensions: from above its corner (1, 0), without perspective.

use super::canvas::Rectangle;
use super::colour::Colour;

/// Lengths of the box along time, value and density.
pub(super) const BOX: [f64; 3] = [1.3, 0.85, 0.65];
/// How far the box is turned from the front, and how far above it the eye is, in degrees.
const TURN: f64 = 27.0;
const RISE: f64 = 27.0;
pub(super) const FLOOR_COLOUR: Colour = Colour(246, 246, 246);

/// The projection of the box on the page.
pub(super) struct View {
    /// Pixels of the corner (0, 0, 0).
    origin: (f64, f64),
    /// Pixels that the whole length of each edge adds.
    pub edges: [(f64, f64); 3],
    /// The last row that a label may use.
    pub lowest: f64,
}

impl View {
    /// Fits the box into `room`, with margins for numbers and labels;
    /// `numbers` is the width of those beside the upright edge.
    pub(super) fn new(room: Rectangle, numbers: f64) -> Self {
        let (turn, rise) = (TURN.to_radians(), RISE.to_radians());
        let [a, b, c] = BOX;
        let time = (a * turn.cos(), a * turn.sin() * rise.sin());
        let value = (b * turn.sin(), -b * turn.cos() * rise.sin());
        let density_up = (0.0, -c * rise.cos());
        let (wide, high) = (time.0 + value.0, time.1 - value.1 - density_up.1);
        let (left, right, below) = (numbers + 62.0, 90.0, 70.0);
        let available = (room.width - left - right, room.height - below - 10.0);
        let scale = (available.0 / wide).min(available.1 / high);
        // In the middle of the room.
        let x = room.left + left + 0.5 * (available.0 - scale * wide);
        let y = room.top + 0.5 * (available.1 - scale * high) - scale * (value.1 + density_up.1);
        let scaled = |edge: (f64, f64)| (scale * edge.0, scale * edge.1);
        View {
            origin: (x, y),
            edges: [scaled(time), scaled(value), scaled(density_up)],
            lowest: room.bottom() - 10.0,
        }
    }

    /// The pixel of a point of the box.
    pub(super) fn point(&self, place: [f64; 3]) -> (f64, f64) {
        let sum = |of: fn(&(f64, f64)) -> f64| -> f64 {
            self.edges
                .iter()
                .zip(place)
                .map(|(edge, part)| part * of(edge))
                .sum()
        };
        (
            self.origin.0 + sum(|edge| edge.0),
            self.origin.1 + sum(|edge| edge.1),
        )
    }
}
