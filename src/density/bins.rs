//! Probabilities shared among evenly spaced nodes.

/// Masses at x₀ + j δ. A value between two nodes is shared so that its mean is kept; on average that
/// adds δ²/6 to the variance.
#[derive(Debug, Clone, PartialEq)]
pub struct Bins {
    origin: f64,
    spacing: f64,
    masses: Vec<f64>,
}

impl Bins {
    /// Bins of at most the given spacing over least ... largest.
    pub fn new(least: f64, largest: f64, spacing: f64) -> Self {
        let count = ((largest - least) / spacing).ceil().max(1.0);
        Bins {
            origin: least,
            spacing: (largest - least) / count,
            masses: vec![0.0; count as usize + 2],
        }
    }

    /// The number of nodes that such bins need.
    pub fn count(least: f64, largest: f64, spacing: f64) -> usize {
        ((largest - least) / spacing).ceil().max(1.0) as usize + 2
    }

    /// δ.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Shares values, all between least and largest, among the nodes.
    pub fn add(&mut self, values: &[f64], probability: &[f64]) {
        let scale = 1.0 / self.spacing;
        let last = self.masses.len() - 2;
        for (value, p) in values.iter().zip(probability) {
            let place = (value - self.origin) * scale;
            let node = (place as usize).min(last);
            let upper = p * (place - node as f64);
            let pair = &mut self.masses[node..node + 2];
            pair[0] += p - upper;
            pair[1] += upper;
        }
    }

    /// (x_j, mass) of every node with a mass.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.masses
            .iter()
            .enumerate()
            .filter(|(_, mass)| **mass > 0.0)
            .map(|(j, mass)| (self.origin + j as f64 * self.spacing, *mass))
    }

    /// The same masses, their distances from a centre drawn in to a share of them.
    pub fn drawn_in(&self, centre: f64, share: f64) -> Self {
        Bins {
            origin: centre + share * (self.origin - centre),
            spacing: share * self.spacing,
            masses: self.masses.clone(),
        }
    }

    /// The kernel's width that, with the variance of the sharing, makes σ.
    pub fn kernel_width(&self, width: f64) -> f64 {
        let square = width * width - self.spacing * self.spacing / 6.0;
        square.max(0.25 * width * width).sqrt()
    }
}
