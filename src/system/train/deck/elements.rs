//! Modes of a deck by finite elements: continuous beams, elastic bearings.

use super::modes::Inner;
use super::{Deck, DeckDamping};
use crate::system::train::matrices::{consistent_mass, hermite, stiffness};
use nalgebra::{DMatrix, DVector};

/// All modes of a finite-element beam, of unit modal mass; the first ones are kept, the others serve the
/// quasi-static correction.
#[derive(Debug, Clone)]
pub struct ElementModes {
    kept: usize,
    /// Places of the nodes (m), and of each element its two nodes are neighbours.
    nodes: Vec<f64>,
    /// ωᵢ².
    squares: Vec<f64>,
    /// Deflection and slope of each node, by mode.
    shapes: Vec<Vec<[f64; 2]>>,
    /// Moment and shear force at both ends of each element, by mode.
    inner: Vec<Vec<[[f64; 2]; 2]>>,
    /// Of the kept modes, row by row.
    damping: DMatrix<f64>,
}

/// Elements of a span for each of its modes, and at least; the moments of the highest kept mode are then true to
/// about a thousandth.
const ELEMENTS_A_MODE: usize = 4;
const FEWEST: usize = 16;

impl ElementModes {
    pub fn new(deck: &Deck, spans: &[f64], added: f64) -> ElementModes {
        let a_span = (ELEMENTS_A_MODE * deck.modes.div_ceil(spans.len())).max(FEWEST);
        let mut nodes = vec![0.0];
        let mut start = 0.0;
        let mut supports = vec![0];
        for span in spans {
            nodes.extend((1..=a_span).map(|k| start + span * k as f64 / a_span as f64));
            start += span;
            supports.push(nodes.len() - 1);
        }
        let size = 2 * nodes.len();
        let (mut mass, mut bare, mut rigid) = (
            DMatrix::zeros(size, size),
            DMatrix::zeros(size, size),
            DMatrix::zeros(size, size),
        );
        let total = deck.mass_per_length + added;
        let lengths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
        for (element, h) in lengths.iter().enumerate() {
            let k = deck.element(*h);
            let m = consistent_mass(1.0, *h);
            for row in 0..4 {
                for column in 0..4 {
                    let at = (2 * element + row, 2 * element + column);
                    mass[at] += total * m[row][column];
                    bare[at] += deck.mass_per_length * m[row][column];
                    rigid[at] += k[row][column];
                }
            }
        }
        let mut dashpots = DMatrix::zeros(size, size);
        let mut free: Vec<usize> = (0..size).collect();
        match deck.bearings {
            None => free.retain(|k| !(k.is_multiple_of(2) && supports.contains(&(k / 2)))),
            Some(bearings) => {
                for node in &supports {
                    rigid[(2 * node, 2 * node)] += bearings.stiffness;
                    dashpots[(2 * node, 2 * node)] += bearings.damping;
                }
            }
        }
        let pick = |of: &DMatrix<f64>| {
            DMatrix::from_fn(free.len(), free.len(), |r, c| of[(free[r], free[c])])
        };
        let (squares, vectors) = modes(&pick(&mass), &pick(&rigid));
        let (bare_squares, _) = modes(&pick(&bare), &pick(&rigid));
        let first = [bare_squares[0].sqrt(), bare_squares[1].sqrt()];
        let kept = deck.modes.min(squares.len());
        let leading = vectors.columns(0, kept);
        let modal_bare = leading.transpose() * pick(&bare) * leading;
        let mut damping = leading.transpose() * pick(&dashpots) * leading;
        for i in 0..kept {
            let of = deck
                .damping
                .of_modes(&squares[i..=i], modal_bare[(i, i)], first);
            damping[(i, i)] += of[0];
        }
        let mut shapes = Vec::new();
        let mut inner = Vec::new();
        for (mode, square) in squares.iter().enumerate() {
            let mut whole = DVector::zeros(size);
            for (row, at) in free.iter().enumerate() {
                whole[*at] = vectors[(row, mode)];
            }
            let forces = lengths.iter().enumerate().map(|(element, h)| {
                let k = deck.element(*h);
                let m = consistent_mass(total, *h);
                let force = |row: usize| -> f64 {
                    (0..4)
                        .map(|c| (k[row][c] - square * m[row][c]) * whole[2 * element + c])
                        .sum()
                };
                [[-force(1), force(0)], [force(3), -force(2)]]
            });
            inner.push(forces.collect());
            shapes.push(
                (0..nodes.len())
                    .map(|n| [whole[2 * n], whole[2 * n + 1]])
                    .collect(),
            );
        }
        ElementModes {
            kept,
            nodes,
            squares,
            shapes,
            inner,
            damping,
        }
    }

    /// The kept modes.
    pub fn kept(&self) -> std::ops::Range<usize> {
        0..self.kept
    }

    /// kᵢ = ωᵢ², of unit modal mass.
    pub fn stiffness(&self, mode: usize) -> f64 {
        self.squares[mode]
    }

    /// cᵢⱼ.
    pub fn damping(&self, i: usize, j: usize) -> f64 {
        self.damping[(i, j)]
    }

    /// φᵢ(x).
    pub fn shape(&self, mode: usize, x: f64) -> f64 {
        let (element, s, h) = self.element(x);
        let shape = &self.shapes[mode];
        let ends = [shape[element], shape[element + 1]];
        let n = hermite(s, h, 0);
        n[0] * ends[0][0] + n[1] * ends[0][1] + n[2] * ends[1][0] + n[3] * ends[1][1]
    }

    /// Moment or shear force of a mode: between the element's ends a cubic through moments and shear forces.
    pub fn inner(&self, what: Inner, mode: usize, x: f64) -> f64 {
        let (element, s, h) = self.element(x);
        let ends = self.inner[mode][element];
        let n = match what {
            Inner::BendingMoment => hermite(s, h, 0),
            Inner::ShearForce => hermite(s, h, 1),
        };
        n[0] * ends[0][0] + n[1] * ends[0][1] + n[2] * ends[1][0] + n[3] * ends[1][1]
    }

    /// By the modes that are not kept, under an upward unit force.
    pub fn truncated(&self, what: Inner, x: f64, position: f64) -> f64 {
        (self.kept..self.squares.len())
            .map(|k| self.inner(what, k, x) * self.shape(k, position) / self.squares[k])
            .sum()
    }

    /// The element at x, the place in it (0 to 1), its length.
    fn element(&self, x: f64) -> (usize, f64, f64) {
        let next = self.nodes.partition_point(|node| *node <= x);
        let element = next.clamp(1, self.nodes.len() - 1) - 1;
        let h = self.nodes[element + 1] - self.nodes[element];
        (element, ((x - self.nodes[element]) / h).clamp(0.0, 1.0), h)
    }
}

impl Deck {
    /// The stiffness of an element, shear deformation included: Φ = 12 EI / (κGA h²).
    fn element(&self, length: f64) -> [[f64; 4]; 4] {
        let bending = stiffness(self.flexural_rigidity, length);
        let Some(shear) = self.shear_rigidity else {
            return bending;
        };
        let phi = 12.0 * self.flexural_rigidity / (shear * length * length);
        let share = self.flexural_rigidity / length * phi;
        let mut all = bending;
        for (row, column, sign) in [(1, 1, 1.0), (3, 3, 1.0), (1, 3, -1.0), (3, 1, -1.0)] {
            all[row][column] += sign * share;
        }
        all.map(|row| row.map(|x| x / (1.0 + phi)))
    }
}

impl DeckDamping {
    /// ζ.
    pub fn ratio(self) -> f64 {
        match self {
            DeckDamping::Ratio(ratio) | DeckDamping::Rayleigh(ratio) => ratio,
        }
    }
}

/// ω² ascending and the modes with Φᵀ M Φ = 1, each with its largest component positive.
fn modes(mass: &DMatrix<f64>, rigid: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let size = mass.nrows();
    let lower = mass
        .clone()
        .cholesky()
        .expect("a consistent mass matrix is positive definite")
        .l();
    let half = lower
        .solve_lower_triangular(rigid)
        .expect("a triangular factor");
    let whole = lower
        .solve_lower_triangular(&half.transpose())
        .expect("a triangular factor");
    let symmetric = 0.5 * (&whole + whole.transpose());
    let eigen = symmetric.symmetric_eigen();
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let back = lower
        .transpose()
        .solve_upper_triangular(&eigen.eigenvectors)
        .expect("a triangular factor");
    let squares = order.iter().map(|k| eigen.eigenvalues[*k]).collect();
    let vectors = DMatrix::from_fn(size, size, |row, k| {
        let column = back.column(order[k]);
        let largest = column.iamax();
        column[row] * column[largest].signum()
    });
    (squares, vectors)
}
