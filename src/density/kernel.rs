//! The Gaussian sum on evenly spaced nodes.

use pulp::{Simd, WithSimd};
use std::f64::consts::PI;

/// Evenly spaced values y₀ + j Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nodes {
    /// y₀.
    pub start: f64,
    /// Δ.
    pub spacing: f64,
    pub count: usize,
}

impl Nodes {
    /// Kernels are cut this many widths from their centre (1.5e-8 of their peak).
    pub(super) const REACH: f64 = 6.0;

    /// At least `count` nodes over the values and the kernels' reach beyond, at most half a width
    /// apart.
    pub fn covering(least: f64, largest: f64, width: f64, count: usize) -> Self {
        let reach = Nodes::REACH * width;
        Nodes::over(least - reach, largest + reach, 0.5 * width, count)
    }

    /// At least `count` nodes from least to largest, at most `spacing` apart.
    pub fn over(least: f64, largest: f64, spacing: f64, count: usize) -> Self {
        let length = largest - least;
        let intervals = (length / spacing).ceil().max((count.max(2) - 1) as f64);
        Nodes {
            start: least,
            spacing: length / intervals,
            count: intervals as usize + 1,
        }
    }

    /// y_j.
    pub fn value(&self, index: usize) -> f64 {
        self.start + index as f64 * self.spacing
    }
}

/// A density and its integral on nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub nodes: Nodes,
    /// p(y_j).
    pub density: Vec<f64>,
    /// F(y_j).
    pub cumulative: Vec<f64>,
}

/// Nodes that are worked on side by side.
const TOGETHER: usize = 8;

/// Σ weight φ((y − value)/σ)/σ and its integral on the nodes.
///
/// On nodes at most half a width apart a kernel falls apart, exp(−(d + mΔ)²/2σ²) = e^{−d²/2σ²} (e^{−dΔ/σ²})^m
/// e^{−m²Δ²/2σ²}, so that each node costs two products. The integral is the trapezoidal rule with the end correction
/// Δ² (p′_j − p′_{j+1})/12, p′ from the same sum.
pub fn smooth(values: impl Iterator<Item = (f64, f64)>, width: f64, nodes: Nodes) -> Curve {
    let Nodes { spacing, count, .. } = nodes;
    let reach = (Nodes::REACH * width / spacing).ceil() as usize + 1;
    let Sums { density, slope, .. } = pulp::Arch::new().dispatch(Summing {
        values,
        width,
        nodes,
        sums: Sums::new(reach, spacing / width, count),
    });
    let scale = 1.0 / (width * (2.0 * PI).sqrt());
    let ours = |sums: Vec<f64>, scale: f64| -> Vec<f64> {
        let sums = sums[reach..reach + count].iter();
        sums.map(|sum| scale * sum).collect()
    };
    let density = ours(density, scale);
    let cumulative = integrate(&density, &ours(slope, scale / width), spacing);
    Curve {
        nodes,
        density,
        cumulative,
    }
}

/// Sums on the nodes and as far as a kernel reaches beyond at either side.
struct Sums {
    reach: usize,
    /// mΔ/σ from one end of a kernel to the other and on to the next whole vector.
    distance: Vec<f64>,
    /// exp(−m²Δ²/2σ²); nothing beyond the end.
    shape: Vec<f64>,
    /// σ p.
    density: Vec<f64>,
    /// σ² p′.
    slope: Vec<f64>,
}

impl Sums {
    fn new(reach: usize, step: f64, count: usize) -> Self {
        let across = (2 * reach + 1).next_multiple_of(TOGETHER);
        let distance: Vec<f64> = (0..across)
            .map(|k| (k as f64 - reach as f64) * step)
            .collect();
        let mut shape: Vec<f64> = distance.iter().map(|m| (-0.5 * m * m).exp()).collect();
        shape[2 * reach + 1..].fill(0.0);
        Sums {
            reach,
            distance,
            shape,
            density: vec![0.0; count + across],
            slope: vec![0.0; count + across],
        }
    }

    /// Adds a kernel of this weight at a distance d before the node `nearest`, node by node.
    fn add_each(&mut self, nearest: usize, d: f64, weight: f64) {
        let nodes = nearest..nearest + self.shape.len();
        let density = &mut self.density[nodes.clone()];
        for ((p, s), distance) in density
            .iter_mut()
            .zip(&mut self.slope[nodes])
            .zip(&self.distance)
        {
            let off = d + distance;
            let kernel = weight * (-0.5 * off * off).exp();
            *p += kernel;
            *s -= off * kernel;
        }
    }

    /// Adds a kernel about the node `nearest` at a distance d before it: its value at its first node, and the
    /// ratio of what is left without its shape from node to node.
    #[inline(always)]
    fn add(&mut self, nearest: usize, d: f64, mut first: f64, ratio: f64) {
        let mut powers = [1.0; TOGETHER];
        for k in 1..TOGETHER {
            powers[k] = powers[k - 1] * ratio;
        }
        let across = powers[TOGETHER - 1] * ratio;
        let nodes = nearest..nearest + self.shape.len();
        let density = self.density[nodes.clone()].as_chunks_mut::<TOGETHER>().0;
        let slope = self.slope[nodes].as_chunks_mut::<TOGETHER>().0;
        let shape = self.shape.as_chunks::<TOGETHER>().0;
        let distance = self.distance.as_chunks::<TOGETHER>().0;
        for (((p, s), shape), distance) in density.iter_mut().zip(slope).zip(shape).zip(distance) {
            let kernel: [f64; TOGETHER] = std::array::from_fn(|k| first * powers[k] * shape[k]);
            *p = std::array::from_fn(|k| p[k] + kernel[k]);
            *s = std::array::from_fn(|k| s[k] - (d + distance[k]) * kernel[k]);
            first *= across;
        }
    }
}

/// e^x of an |x| ≤ 1/8, to rounding: its Taylor sum to x⁹.
#[inline(always)]
fn near_one(x: f64) -> f64 {
    let mut sum = 1.0 + x * (1.0 / 9.0);
    for k in [8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        sum = 1.0 + sum * x * (1.0 / k);
    }
    sum
}

/// The sum of all kernels, for the machine's vector units.
struct Summing<I> {
    values: I,
    width: f64,
    nodes: Nodes,
    sums: Sums,
}

impl<I: Iterator<Item = (f64, f64)>> WithSimd for Summing<I> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sums {
        let Summing {
            values,
            width,
            nodes:
                Nodes {
                    start,
                    spacing,
                    count,
                },
            mut sums,
        } = self;
        // In units of the width.
        let step = spacing / width;
        let [per_spacing, per_width] = [spacing, width].map(f64::recip);
        let mut values = values.fuse();
        loop {
            let mut count_now = 0;
            let some: [(f64, f64); TOGETHER] = std::array::from_fn(|_| match values.next() {
                Some(value) => {
                    count_now += 1;
                    value
                }
                None => (start, 0.0),
            });
            // Loops over arrays: the vector units take them where they do not take closures.
            let [mut nearest, mut d, mut first, mut ratio] = [[0.0; TOGETHER]; 4];
            let mut is_near = step <= 0.5;
            for k in 0..TOGETHER {
                let (value, weight) = some[k];
                let place = ((value - start) * per_spacing + 0.5).floor();
                nearest[k] = place.max(0.0).min((count - 1) as f64);
                d[k] = (start + nearest[k] * spacing - value) * per_width;
                is_near &= d[k].abs() <= 0.26;
                first[k] = weight;
            }
            if !is_near {
                for k in 0..count_now {
                    sums.add_each(nearest[k] as usize, d[k], first[k]);
                }
            } else {
                // At the first node of each kernel, and from node to node.
                let mut growth = [0.0; TOGETHER];
                for k in 0..TOGETHER {
                    growth[k] = near_one(d[k] * step);
                    ratio[k] = near_one(-d[k] * step);
                    first[k] *= near_one(-0.5 * d[k] * d[k]);
                }
                let mut exponent = sums.reach;
                while exponent > 0 {
                    for k in 0..TOGETHER {
                        first[k] *= if exponent % 2 == 1 { growth[k] } else { 1.0 };
                        growth[k] *= growth[k];
                    }
                    exponent /= 2;
                }
                for k in 0..count_now {
                    sums.add(nearest[k] as usize, d[k], first[k], ratio[k]);
                }
            }
            if count_now < TOGETHER {
                break;
            }
        }
        sums
    }
}

/// The running integral of p with slopes p′.
fn integrate(density: &[f64], slope: &[f64], spacing: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut out = Vec::with_capacity(density.len());
    out.push(0.0);
    for (p, s) in density.windows(2).zip(slope.windows(2)) {
        let area = 0.5 * spacing * (p[0] + p[1]) + spacing * spacing / 12.0 * (s[0] - s[1]);
        sum += area.max(0.0);
        out.push(sum);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::{MonteCarlo, PointRule};

    #[test]
    fn the_sum_is_that_of_all_kernels() {
        let mut values = vec![0.0; 101];
        MonteCarlo::new(101, 1, 1).standard_normals(0..101, &mut values);
        let pairs = || {
            let all = values.iter().enumerate();
            all.map(|(k, x)| (*x, f64::from(k as u32 % 3 + 1) / 200.0))
        };
        // Fine and coarse nodes, and such that leave values out.
        for (width, spacing, count) in [
            (0.1, 0.05, 200),
            (0.5, 0.01, 900),
            (0.1, 0.3, 30),
            (0.01, 0.005, 100),
        ] {
            let nodes = Nodes {
                start: -4.0,
                spacing,
                count,
            };
            let curve = smooth(pairs(), width, nodes);
            for (j, p) in curve.density.iter().enumerate() {
                let kernel = |(x, weight): (f64, f64)| {
                    let z = (nodes.value(j) - x) / width;
                    weight * (-0.5 * z * z).exp() / (width * (2.0 * PI).sqrt())
                };
                let exact: f64 = pairs().map(kernel).sum();
                assert!(
                    (p - exact).abs() < 1e-7,
                    "{width} {spacing} {j}: {p} {exact}"
                );
            }
        }
    }
}
