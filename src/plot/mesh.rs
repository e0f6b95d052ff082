//! The surface of a density over time and value: its cells, their colours and their order.
//!
//! The cells follow the density: at each time their corners lie at the mean plus fixed numbers of
//! standard deviations, so that a ridge however narrow has as many cells as a wide one, and one that
//! moves does not cross them.
//!
//! The order is the painter's: what is drawn later covers what lies behind. A strip between two times
//! lies before all earlier ones. Within a strip the eye looks across the lines between the cells, and
//! `v' = v - v_j(u)` grows or falls along its way with the sign of `x_u + v_j' x_v` (`x_u`, `x_v`: the
//! screen's columns for the box's edges); that sign says which of two neighbours lies behind.

use super::axes::Axis;
use super::canvas::{Canvas, Stroke};
use super::colour::{BLACK, Colour, WHITE, viridis};
use super::density::{Column, Evolution};
use super::view::{BOX, FLOOR_COLOUR, View};

/// Most columns over time; cells over value.
const MOST_COLUMNS: usize = 121;
const CELLS: usize = 120;
/// A ridge whose standard deviation is below this part of the value axis, a pixel or so, is drawn as a
/// normal density of that width: its own shape would flicker from column to column.
const NARROWEST: f64 = 1.0 / 200.0;
/// Below this part of the height the surface lies on the floor, and the floor is drawn instead ...
const FLOOR: f64 = 0.002;
/// ... and up to this part it takes the colour of the floor, so that it has no edge there.
const FADED: f64 = 0.02;

/// The corners of the surface's cells at one time.
struct Corners {
    /// The time, 0 to 1 in the box.
    time: f64,
    /// The values, ascending, 0 to 1 in the box.
    values: Vec<f64>,
    /// In shown units.
    densities: Vec<f64>,
}

/// The surface of a density.
pub(super) struct Mesh {
    /// In the order of time; none where there is nothing to draw.
    columns: Vec<Option<Corners>>,
}

impl Mesh {
    /// The surface over the axes of time (s) and value (shown: `factor` times the SI value, measured
    /// from the mean where `deviates`).
    pub(super) fn new(
        evolution: &Evolution<'_>,
        time: &Axis,
        value: &Axis,
        factor: f64,
        deviates: bool,
    ) -> Self {
        let count = evolution.slices.len().clamp(2, MOST_COLUMNS);
        let (low, high) = evolution.standard_range();
        let narrowest = NARROWEST * (value.high - value.low) / factor;
        let corners = |part: f64, column: &Column<'_>| {
            let half = 0.5 * (high - low) / CELLS as f64;
            let deviation = column.standard_deviation.max(narrowest);
            let edge = |distance: f64| column.mean + distance * deviation;
            let distance = |j: usize| low + 2.0 * half * j as f64;
            let densities = if column.standard_deviation < narrowest {
                (0..=CELLS)
                    .map(|j| normal(distance(j)) / deviation)
                    .collect()
            } else {
                // The mean density of a cell about each corner.
                column.cells(edge(low - half), edge(high + half), CELLS + 1)
            };
            let origin = if deviates { column.mean } else { 0.0 };
            let shown = |j: usize| factor * (edge(distance(j)) - origin);
            Corners {
                time: part,
                values: (0..=CELLS)
                    .map(|j| value.place(shown(j)).clamp(0.0, 1.0))
                    .collect(),
                densities: densities
                    .into_iter()
                    .map(|density| density / factor)
                    .collect(),
            }
        };
        let column = |index: usize| {
            let part = index as f64 / (count - 1) as f64;
            let column = evolution.at(time.low + part * (time.high - time.low))?;
            Some(corners(part, &column))
        };
        Mesh {
            columns: (0..count).map(column).collect(),
        }
    }

    /// The highest density of each time, in shown units.
    pub(super) fn peaks(&self) -> Vec<f64> {
        let peak = |column: &Corners| column.densities.iter().copied().fold(0.0, f64::max);
        self.columns.iter().flatten().map(peak).collect()
    }

    /// Draws it, its heights on the axis `density`.
    pub(super) fn draw(&self, canvas: &mut Canvas, view: &View, density: &Axis) {
        let every = (self.columns.len() / 24).max(1);
        canvas.group(r#"stroke-width=".5""#, |canvas| {
            for (index, pair) in self.columns.windows(2).enumerate() {
                if let [Some(early), Some(late)] = pair {
                    draw_strip(canvas, view, density, (early, late), index % every == 0);
                }
            }
        });
    }
}

/// The standard normal density.
fn normal(distance: f64) -> f64 {
    (-0.5 * distance * distance).exp() / std::f64::consts::TAU.sqrt()
}

/// Draws the cells between two times, with a line along the first of them where `lined`.
fn draw_strip(
    canvas: &mut Canvas,
    view: &View,
    density: &Axis,
    (early, late): (&Corners, &Corners),
    lined: bool,
) {
    let line = Stroke::solid(BLACK, 0.6).opacity(0.35);
    let corner = |of: &Corners, j: usize| {
        let height = density.place(of.densities[j]).clamp(0.0, 1.0);
        [of.time, of.values[j], height]
    };
    let place = |index: usize| view.edges[index].0;
    let towards_back = |j: usize| {
        let slope = (late.values[j] - early.values[j]) / (late.time - early.time);
        place(0) + slope * place(1) > 0.0
    };
    for j in from_back_to_front(CELLS, towards_back) {
        let corners = [
            corner(early, j),
            corner(late, j),
            corner(late, j + 1),
            corner(early, j + 1),
        ];
        if corners.iter().all(|corner| corner[2] < FLOOR) {
            continue;
        }
        let points = corners.map(|corner| view.point(corner));
        canvas.tile(&points, shaded(&corners));
        if lined && corners[0][2].max(corners[3][2]) > 0.5 * FADED {
            canvas.line(points[0], points[3], line);
        }
    }
}

/// The cells of a strip, those behind first. `towards_back(j)` says for the line `j`, between the
/// cells `j - 1` and `j`, whether cell `j` is the one behind.
fn from_back_to_front(count: usize, towards_back: impl Fn(usize) -> bool) -> Vec<usize> {
    // Each cell is one step behind or before its neighbour: sorting by steps keeps every pair.
    let mut depths = vec![0_i64; count];
    for j in 1..count {
        depths[j] = depths[j - 1] + if towards_back(j) { 1 } else { -1 };
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&j| std::cmp::Reverse(depths[j]));
    order
}

/// The colour of a cell: viridis by its height, lighter where it faces the light.
fn shaded(corners: &[[f64; 3]; 4]) -> Colour {
    let height = 0.25 * corners.iter().map(|corner| corner[2]).sum::<f64>();
    let part = (height / FADED).min(1.0);
    // Smooth at both ends.
    let colour = FLOOR_COLOUR.mix(viridis(height), part * part * (3.0 - 2.0 * part));
    let diagonal = |from: usize, to: usize| -> [f64; 3] {
        std::array::from_fn(|k| BOX[k] * (corners[to][k] - corners[from][k]))
    };
    let (a, b) = (diagonal(0, 2), diagonal(1, 3));
    let normal = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    // From the left front, from above; of length 1.
    let light = [-0.35, -0.45, 0.82];
    let along: f64 = normal.iter().zip(light).map(|(n, l)| n * l).sum();
    let facing = if length > 0.0 { along / length } else { 0.5 };
    if facing > 0.5 {
        colour.mix(WHITE, 0.25 * (facing - 0.5))
    } else {
        colour.mix(BLACK, 0.30 * (0.5 - facing).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_neighbours_the_one_behind_comes_first() {
        // The sign changes where the lines of a spreading ridge turn from the eye's way.
        for change in 0..20 {
            for first in [true, false] {
                let towards_back = |j: usize| (j < change) == first;
                let order = from_back_to_front(20, towards_back);
                let turn = |cell: usize| order.iter().position(|&j| j == cell).unwrap();
                for j in 1..20 {
                    assert_eq!(
                        turn(j) < turn(j - 1),
                        towards_back(j),
                        "{change} {first} {j}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_hairline_is_as_wide_as_a_pixel() {
        let density = |time, width: f64| {
            let values = [-width, 0.0, width];
            (time, values, [0.0, 1.0 / width, 0.0])
        };
        let made = [density(0.0, 1e-9), density(1.0, 1.0)];
        let densities =
            made.each_ref()
                .map(|(time, values, densities)| crate::plot::DensityAtTime {
                    time: *time,
                    values,
                    densities,
                });
        let evolution = Evolution::new("test", &densities).unwrap();
        let (time, value) = (Axis::linear("", 0.0, 1.0), Axis::linear("", -1.0, 1.0));
        let mesh = Mesh::new(&evolution, &time, &value, 1.0, true);
        // The normal density of the width 1/200 of the axis has the height 200 / (2 sqrt(2 pi)).
        let expected = 100.0 / std::f64::consts::TAU.sqrt();
        let peak = mesh.peaks()[0];
        assert!((peak / expected - 1.0).abs() < 1e-2, "{peak}");
        assert!(mesh.peaks()[1] < 1.0);
    }

    #[test]
    fn a_slope_towards_the_light_is_lighter() {
        let cell = |rise: f64| {
            shaded(&[
                [0.0, 0.0, 0.5],
                [0.1, 0.0, 0.5],
                [0.1, 0.1, 0.5 + rise],
                [0.0, 0.1, 0.5 + rise],
            ])
        };
        let sum = |c: Colour| u32::from(c.0) + u32::from(c.1) + u32::from(c.2);
        // The light comes from small values: it falls on what rises with the value.
        assert!(sum(cell(0.05)) > sum(cell(-0.05)));
    }
}
