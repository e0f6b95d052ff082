//! The distances, from cumulative probabilities at common nodes.

use super::Tabulated;

/// How far two densities lie apart; see the room for what each is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distances {
    /// 0 to 2.
    pub l1: f64,
    /// 0 to 1.
    pub kolmogorov_smirnov: f64,
    /// In the unit of the values.
    pub wasserstein_1: f64,
    /// 0 to 1.
    pub hellinger: f64,
}

impl Distances {
    /// Half the L1 distance, 0 to 1.
    pub fn total_variation(&self) -> f64 {
        0.5 * self.l1
    }
}

/// Nodes such that each cell between two of them holds no less than a cell of each table: where both
/// tables have nodes those of the coarser one, elsewhere those of the one that is there.
pub fn common_nodes(first: &[f64], second: &[f64]) -> Vec<f64> {
    let mut y = first[0].min(second[0]);
    let mut nodes = vec![y];
    loop {
        let beyond = |table: &[f64]| table.get(table.partition_point(|node| *node <= y)).copied();
        y = match (beyond(first), beyond(second)) {
            // A table that starts later has no cell here.
            (Some(_), Some(b)) if y < first[0] => b,
            (Some(a), Some(_)) if y < second[0] => a,
            (Some(a), Some(b)) => a.max(b),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => return nodes,
        };
        nodes.push(y);
    }
}

/// The distances between two densities; the same in either order.
pub fn distances(first: &Tabulated<'_>, second: &Tabulated<'_>) -> Distances {
    let nodes = common_nodes(first.nodes(), second.nodes());
    let at = |y: &f64| (first.cumulative_at(*y), second.cumulative_at(*y));
    let cumulative: Vec<(f64, f64)> = nodes.iter().map(at).collect();
    let apart = |f: (f64, f64)| f.0 - f.1;
    let mut result = Distances {
        l1: 0.0,
        kolmogorov_smirnov: apart(cumulative[0]).abs(),
        wasserstein_1: 0.0,
        hellinger: 0.0,
    };
    let mut squares = 0.0;
    for (y, f) in nodes.windows(2).zip(cumulative.windows(2)) {
        let (left, right) = (apart(f[0]), apart(f[1]));
        let roots = [f[1].0 - f[0].0, f[1].1 - f[0].1].map(|p| p.max(0.0).sqrt());
        result.l1 += (right - left).abs();
        result.kolmogorov_smirnov = result.kolmogorov_smirnov.max(right.abs());
        result.wasserstein_1 += (y[1] - y[0]) * mean_magnitude(left, right);
        squares += (roots[0] - roots[1]).powi(2);
    }
    result.hellinger = (0.5 * squares).sqrt();
    result
}

/// ∫ |l + (r − l) s| ds from 0 to 1.
fn mean_magnitude(left: f64, right: f64) -> f64 {
    if left * right >= 0.0 {
        return 0.5 * (left.abs() + right.abs());
    }
    0.5 * (left * left + right * right) / (left.abs() + right.abs())
}
