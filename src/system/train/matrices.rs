//! Sparse symmetric matrices of mass, damping and stiffness, collected piece by piece.

use super::Spring;

/// M, C and K of some pieces: the places of their entries, lower triangle, and their values. Two systems of
/// one shape have the same places in the same order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Matrices {
    pub size: usize,
    /// (row, column), column ≤ row; a place may come several times.
    pub places: Vec<(u32, u32)>,
    /// M (kg), C (N s/m), K (N/m).
    pub values: Vec<[f64; 3]>,
}

impl Matrices {
    /// `count` further coordinates; the first of them.
    pub fn grow(&mut self, count: usize) -> usize {
        let first = self.size;
        self.size += count;
        first
    }

    fn add(&mut self, row: usize, column: usize, value: [f64; 3]) {
        let (row, column) = (row.max(column), row.min(column));
        self.places.push((row as u32, column as u32));
        self.values.push(value);
    }

    /// Inertia of a coordinate.
    pub fn mass(&mut self, at: usize, mass: f64) {
        self.add(at, at, [mass, 0.0, 0.0]);
    }

    /// A spring and dashpot whose coordinates count from `first`.
    pub fn spring(&mut self, first: usize, spring: &Spring) {
        for (k, (i, a)) in spring.elongation.iter().enumerate() {
            for (j, b) in &spring.elongation[..=k] {
                let ab = a * b;
                let value = [0.0, spring.damping * ab, spring.stiffness * ab];
                self.add(first + i, first + j, value);
            }
        }
    }

    /// An Euler-Bernoulli beam element of length h between coordinates (deflection, slope) at both ends, with
    /// its consistent mass: EI (N m²), ρA (kg/m), h (m).
    pub fn beam(&mut self, at: [usize; 4], rigidity: f64, mass: f64, length: f64) {
        let (k, m) = (stiffness(rigidity, length), consistent_mass(mass, length));
        for row in 0..4 {
            for column in 0..=row {
                self.add(at[row], at[column], [m[row][column], 0.0, k[row][column]]);
            }
        }
    }
}

/// The stiffness matrix of a beam element: end forces and moments over deflections (m) and slopes.
pub fn stiffness(rigidity: f64, length: f64) -> [[f64; 4]; 4] {
    let h = length;
    let c = rigidity / h.powi(3);
    [
        [12.0, 6.0 * h, -12.0, 6.0 * h],
        [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
        [-12.0, -6.0 * h, 12.0, -6.0 * h],
        [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
    ]
    .map(|row| row.map(|x| c * x))
}

/// The consistent mass matrix of a beam element.
pub fn consistent_mass(mass: f64, length: f64) -> [[f64; 4]; 4] {
    let h = length;
    let c = mass * h / 420.0;
    [
        [156.0, 22.0 * h, 54.0, -13.0 * h],
        [22.0 * h, 4.0 * h * h, 13.0 * h, -3.0 * h * h],
        [54.0, 13.0 * h, 156.0, -22.0 * h],
        [-13.0 * h, -3.0 * h * h, -22.0 * h, 4.0 * h * h],
    ]
    .map(|row| row.map(|x| c * x))
}

/// Hermite's shape functions (deflection and slope at the ends) or their derivative of that order at s = x/h.
pub fn hermite(s: f64, length: f64, derivative: usize) -> [f64; 4] {
    let h = length;
    match derivative {
        0 => [
            1.0 - 3.0 * s * s + 2.0 * s.powi(3),
            h * (s - 2.0 * s * s + s.powi(3)),
            3.0 * s * s - 2.0 * s.powi(3),
            h * (s.powi(3) - s * s),
        ],
        1 => [
            (-6.0 * s + 6.0 * s * s) / h,
            1.0 - 4.0 * s + 3.0 * s * s,
            (6.0 * s - 6.0 * s * s) / h,
            3.0 * s * s - 2.0 * s,
        ],
        _ => unreachable!("the deflection or the slope"),
    }
}
