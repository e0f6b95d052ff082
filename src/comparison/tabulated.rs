//! A density given by a table, as a curve.

/// What a table can't be a density for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BadTable {
    #[error("{0} node(s) where at least two are needed")]
    TooFewNodes(usize),
    #[error("{column} of {value} at node {node}")]
    NotFinite {
        column: &'static str,
        value: f64,
        node: usize,
    },
    #[error("a node of {next} after {node}")]
    NotAscending { node: f64, next: f64 },
    #[error("a density of {density} at {node}")]
    Negative { node: f64, density: f64 },
    #[error("a cumulative probability that falls by {by:.1e} before the node {node}")]
    Falling { node: f64, by: f64 },
    #[error("no probability between the first and the last node")]
    Empty,
}

/// The rounding that a cumulative probability or a density (in parts of its peak) may have below zero.
const ROUNDING: f64 = 1e-9;

/// A density given by a table; its probability is that between the first and the last node.
#[derive(Debug, Clone, Copy)]
pub struct Tabulated<'a> {
    value: &'a [f64],
    density: &'a [f64],
    cumulative: &'a [f64],
}

/// A cell: the density times the cell's width is a + b u + c u², u from −1/2 to 1/2.
#[derive(Debug, Clone, Copy)]
struct Cell {
    a: f64,
    b: f64,
    c: f64,
}

impl Cell {
    /// The parabola that has the cell's probability and meets the densities at its ends (times the
    /// cell's width); where that would be negative somewhere, the constant.
    fn new(probability: f64, left: f64, right: f64) -> Cell {
        let probability = probability.max(0.0);
        let (left, right) = (left.max(0.0), right.max(0.0));
        let b = right - left;
        let c = 3.0 * (left + right) - 6.0 * probability;
        let a = probability - c / 12.0;
        let dips = c > 0.0 && b.abs() < c && a - b * b / (4.0 * c) < 0.0;
        if dips {
            let (a, b, c) = (probability, 0.0, 0.0);
            return Cell { a, b, c };
        }
        Cell { a, b, c }
    }

    /// The probability from the cell's left end to u.
    fn up_to(&self, u: f64) -> f64 {
        let (v, w) = (u + 0.5, u * u);
        // (u² − 1/4)/2 and (u³ + 1/8)/3 with their root at −1/2 taken out.
        v * (self.a + 0.5 * self.b * (u - 0.5) + self.c * (w - 0.5 * u + 0.25) / 3.0)
    }
}

impl<'a> Tabulated<'a> {
    /// A table of nodes, densities and cumulative probabilities of equal length.
    ///
    /// # Errors
    /// Fewer than two nodes, numbers that are not finite, nodes that don't ascend, negative densities,
    /// probabilities that fall (beyond rounding), no probability at all.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn new(
        value: &'a [f64],
        density: &'a [f64],
        cumulative: &'a [f64],
    ) -> Result<Self, BadTable> {
        assert!(
            value.len() == density.len() && value.len() == cumulative.len(),
            "columns of a table"
        );
        if value.len() < 2 {
            return Err(BadTable::TooFewNodes(value.len()));
        }
        for (column, numbers) in [
            ("value", value),
            ("density", density),
            ("cumulative", cumulative),
        ] {
            if let Some(node) = numbers.iter().position(|number| !number.is_finite()) {
                let value = numbers[node];
                return Err(BadTable::NotFinite {
                    column,
                    value,
                    node,
                });
            }
        }
        if let Some(pair) = value.windows(2).find(|pair| pair[1] <= pair[0]) {
            let (node, next) = (pair[0], pair[1]);
            return Err(BadTable::NotAscending { node, next });
        }
        let peak = density.iter().copied().fold(0.0, f64::max);
        if let Some(node) = density.iter().position(|p| *p < -ROUNDING * peak) {
            let (node, density) = (value[node], density[node]);
            return Err(BadTable::Negative { node, density });
        }
        let falls = |pair: &[f64]| pair[1] < pair[0] - ROUNDING;
        if let Some(node) = cumulative.windows(2).position(falls) {
            let by = cumulative[node] - cumulative[node + 1];
            let node = value[node + 1];
            return Err(BadTable::Falling { node, by });
        }
        let table = Tabulated {
            value,
            density,
            cumulative,
        };
        if table.probability() <= ROUNDING {
            return Err(BadTable::Empty);
        }
        Ok(table)
    }

    /// The nodes.
    pub fn nodes(&self) -> &'a [f64] {
        self.value
    }

    /// The probability between the first and the last node.
    pub fn probability(&self) -> f64 {
        self.cumulative[self.cumulative.len() - 1] - self.cumulative[0]
    }

    /// F(y): the column at a node, between nodes the integral of the cell's parabola, beyond the ends
    /// the column's end.
    pub fn cumulative_at(&self, y: f64) -> f64 {
        let above = self.value.partition_point(|node| *node <= y);
        if above == 0 {
            return self.cumulative[0];
        }
        let left = above - 1;
        if above == self.value.len() || self.value[left] == y {
            return self.cumulative[left];
        }
        let u = (y - self.value[left]) / self.width(left) - 0.5;
        self.cumulative[left] + self.cell(left).up_to(u)
    }

    fn width(&self, left: usize) -> f64 {
        self.value[left + 1] - self.value[left]
    }

    fn cell(&self, left: usize) -> Cell {
        let width = self.width(left);
        Cell::new(
            self.cumulative[left + 1] - self.cumulative[left],
            width * self.density[left],
            width * self.density[left + 1],
        )
    }

    /// Mean and standard deviation of what lies between the ends: the exact integrals of the cells'
    /// parabolas.
    pub fn mean_and_deviation(&self) -> (f64, f64) {
        // About the middle node first, for the digits.
        let centre = self.value[self.value.len() / 2];
        let cells = || {
            (0..self.value.len() - 1).map(|left| {
                let (width, cell) = (self.width(left), self.cell(left));
                let middle = self.value[left] - centre + 0.5 * width;
                (width, middle, cell)
            })
        };
        let probability: f64 = cells().map(|(_, _, cell)| cell.up_to(0.5)).sum();
        let first = |(width, middle, cell): (f64, f64, Cell)| {
            middle * cell.up_to(0.5) + width * cell.b / 12.0
        };
        let mean = cells().map(first).sum::<f64>() / probability;
        let second = |(width, middle, cell): (f64, f64, Cell)| {
            let d = middle - mean;
            d * d * cell.up_to(0.5)
                + d * width * cell.b / 6.0
                + width * width * (cell.a / 12.0 + cell.c / 80.0)
        };
        let variance = cells().map(second).sum::<f64>() / probability;
        (centre + mean, variance.max(0.0).sqrt())
    }

    /// The quantile of what lies between the ends, level from 0 to 1.
    pub fn quantile(&self, level: f64) -> f64 {
        let wanted = self.cumulative[0] + level * self.probability();
        let above = self.cumulative.partition_point(|f| *f < wanted);
        let left = above.clamp(1, self.value.len() - 1) - 1;
        let cell = self.cell(left);
        let missing = wanted - self.cumulative[left];
        let (mut low, mut high) = (-0.5, 0.5);
        // The cell's integral ascends: each step halves the interval, to a double's last digit.
        for _ in 0..54 {
            let middle = 0.5 * (low + high);
            if cell.up_to(middle) < missing {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.value[left] + self.width(left) * (high + 0.5)
    }
}
