//! The evolution against exact densities and identities.

use super::*;
use crate::Result;
use crate::density::{Curve, Grid};
use crate::response::{Block, Responses};
use std::f64::consts::PI;

/// Responses and velocities in memory, `[time][point]`, handed over in blocks of points, each at all times.
struct Held {
    times: Vec<f64>,
    probability: Vec<f64>,
    values: [Vec<Vec<f64>>; 2],
    block: usize,
}

impl Responses for Held {
    fn times(&self) -> &[f64] {
        &self.times
    }

    fn probability(&self) -> &[f64] {
        &self.probability
    }

    fn scan(
        &self,
        quantities: &[usize],
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        for first_point in (0..self.probability.len()).step_by(self.block) {
            // Batches of an odd number of times.
            for first_time in (0..self.times.len()).step_by(37) {
                let times = first_time..(first_time + 37).min(self.times.len());
                let mut blocks = Vec::new();
                for time in times {
                    for quantity in quantities {
                        let all = &self.values[*quantity][time];
                        blocks.push(Block {
                            quantity: *quantity,
                            time,
                            first_point,
                            values: &all[first_point..(first_point + self.block).min(all.len())],
                        });
                    }
                }
                visit(&blocks)?;
            }
        }
        Ok(())
    }
}

impl Held {
    /// Points of the weights given, whose response and velocity are functions of the middle of their cell in
    /// (0, 1) and the time.
    fn new(
        probability: Vec<f64>,
        step: f64,
        end: f64,
        response: impl Fn(f64, f64) -> (f64, f64),
    ) -> Held {
        let count = probability.len();
        let times: Vec<f64> = (0..=(end / step).round() as usize)
            .map(|k| k as f64 * step)
            .collect();
        let points = || (0..count).map(|q| (q as f64 + 0.5) / count as f64);
        let of = |part: fn((f64, f64)) -> f64| {
            let at = |t: &f64| points().map(|u| part(response(u, *t))).collect();
            times.iter().map(at).collect()
        };
        let values = [of(|pair| pair.0), of(|pair| pair.1)];
        Held {
            times,
            probability,
            values,
            block: count,
        }
    }

    /// Free vibration 0.1 m cos ωt, ω uniform from 5π/4 to 7π/4 rad/s.
    fn free_vibration(count: usize, step: f64, end: f64) -> Held {
        Held::new(vec![1.0 / count as f64; count], step, end, |u, t| {
            let omega = PI * (1.25 + 0.5 * u);
            let phase = omega * t;
            (0.1 * phase.cos(), -0.1 * omega * phase.sin())
        })
    }

    fn run(&self, velocity: Option<usize>, options: Options, safe: Interval) -> Evolved {
        let transport = Transport {
            quantity: 0,
            velocity,
            safe,
        };
        let step = even_step(&self.times).unwrap();
        let plan = Plan::new(self, transport, options, step).unwrap();
        plan.run().unwrap().unwrap()
    }

    fn curve(&self, velocity: Option<usize>, options: Options) -> Curve {
        let evolved = self.run(velocity, options, Interval::ALL);
        evolved.curve(self.times.len() - 1, Grid::Own).unwrap()
    }
}

fn options(nodes: Option<usize>) -> Options {
    Options {
        nodes,
        courant: 0.95,
    }
}

/// The probability that free vibration with frequencies of this distribution is at most y at a time t within
/// the first period of all.
fn exact_cumulative(y: f64, t: f64, below: impl Fn(f64) -> f64) -> f64 {
    let angle = (y / 0.1).clamp(-1.0, 1.0).acos();
    let up_to = |phase: f64| below((phase / t / PI - 1.25) / 0.5);
    up_to(2.0 * PI - angle) - up_to(angle)
}

fn uniform(u: f64) -> f64 {
    u.clamp(0.0, 1.0)
}

/// ∫ |p − exact| dy, by the probabilities of the cells between nodes.
fn distance(curve: &Curve, t: f64, below: impl Fn(f64) -> f64) -> f64 {
    let at = |j: usize| curve.cumulative[j] - exact_cumulative(curve.nodes.value(j), t, &below);
    let cells = (1..curve.cumulative.len()).map(|j| (at(j) - at(j - 1)).abs());
    cells.sum::<f64>() + at(0).abs() + at(curve.cumulative.len() - 1).abs()
}

#[test]
fn a_whole_courant_number_translates_exactly() {
    // All points at one velocity, from one place: a Dirac function moves by a node a record.
    let held = Held::new(vec![0.25; 4], 0.1, 2.0, |_, t| (1.0 + 0.5 * t, 0.5));
    let whole = Options {
        nodes: None,
        courant: 1.0,
    };
    for velocity in [None, Some(1)] {
        let evolved = held.run(velocity, whole, Interval::ALL);
        let mesh = evolved.mesh;
        assert!((mesh.spacing - 0.05).abs() < 1e-14 && mesh.origin == 1.0);
        for (time, t) in held.times.iter().enumerate() {
            let curve = evolved.curve(time, Grid::Own).unwrap();
            // A difference of responses near 2 loses 4 ε of its 0.05: 20 steps leave 20 * 80 ε behind.
            let mut masses = curve.density.iter().map(|p| p * mesh.spacing);
            let node = masses.position(|mass| (mass - 1.0).abs() < 1e-12);
            let value = curve.nodes.value(node.unwrap());
            assert!((value - (1.0 + 0.5 * t)).abs() < 1e-12, "{t}: {value}");
            assert!(evolved.width(time) < 1e-6);
        }
    }
}

#[test]
fn probability_is_kept_and_positive() {
    let mut held = Held::free_vibration(101, 0.01, 2.0);
    held.probability = (0..101).map(|q| (1.0 + (q % 7) as f64) / 400.0).collect();
    let total: f64 = held.probability.iter().sum();
    for (velocity, nodes) in [(None, None), (Some(1), Some(300)), (None, Some(1200))] {
        let evolved = held.run(velocity, options(nodes), Interval::ALL);
        let common = evolved.curve(0, Grid::Common).unwrap().nodes;
        for time in 0..held.times.len() {
            let curve = evolved.curve(time, Grid::Own).unwrap();
            assert!((evolved.left(time) - total).abs() < 1e-12);
            assert!((curve.cumulative.last().unwrap() - total).abs() < 1e-12);
            assert!(curve.density.iter().all(|p| *p >= 0.0));
            assert!(curve.cumulative.is_sorted());
            let (first, .., last) = (curve.density[0], curve.density[curve.density.len() - 1]);
            assert_eq!((first, last), (0.0, 0.0));
            assert_eq!(evolved.curve(time, Grid::Common).unwrap().nodes, common);
        }
    }
}

#[test]
fn a_mirrored_motion_has_the_mirrored_density() {
    let held = Held::free_vibration(31, 0.01, 1.3);
    let mut mirrored = Held::free_vibration(31, 0.01, 1.3);
    let numbers = mirrored.values.iter_mut().flatten().flatten();
    numbers.for_each(|value| *value = -*value);
    for velocity in [None, Some(1)] {
        let one = held.curve(velocity, options(Some(200)));
        let other = mirrored.curve(velocity, options(Some(200)));
        let backwards: Vec<f64> = other.density.iter().rev().copied().collect();
        assert_eq!(one.density, backwards);
    }
}

#[test]
fn a_hundred_points_of_free_vibration_come_as_near_as_the_published_code() {
    // Its 0.037 at 1.1 s. 400 nodes over the range: neighbours are two nodes apart there, and a point's
    // probability two nodes wide.
    let held = Held::free_vibration(101, 0.01, 1.1);
    for velocity in [None, Some(1)] {
        let curve = held.curve(velocity, options(Some(400)));
        let error = distance(&curve, 1.1, uniform);
        assert!(error < 0.037, "{error}");
    }
}

/// Assigned probabilities of equal cells under a smooth distribution, 1 − cos 2πu.
fn smooth(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u - (2.0 * PI * u).sin() / (2.0 * PI)
}

#[test]
fn the_error_decays_between_first_and_second_order() {
    // Mesh, step and points together, on the mesh of the record; a density without edges.
    let errors = [1, 2, 4, 8].map(|k| {
        let count = 25 * k;
        let mut held = Held::free_vibration(count, 0.01 / k as f64, 1.1);
        let edge = |q: usize| smooth(q as f64 / count as f64);
        held.probability = (0..count).map(|q| edge(q + 1) - edge(q)).collect();
        distance(&held.curve(None, options(None)), 1.1, smooth)
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.0..2.0).contains(&order), "{errors:?}");
    }
}

#[test]
fn the_mesh_smooths_by_two_to_three_nodes_and_moves_no_mean() {
    let held = Held::free_vibration(51, 0.001, 1.1);
    let evolved = held.run(None, options(None), Interval::ALL);
    let last = held.times.len() - 1;
    let width = evolved.width(last) / evolved.mesh.spacing;
    assert!((2.0..3.0).contains(&width), "{width}");
    let mean: f64 = held.values[0][last].iter().sum::<f64>() / 51.0;
    let wandered = (evolved.mean(last) - mean).abs() / evolved.mesh.spacing;
    assert!(wandered < 0.5, "{wandered}");
    // The first steps, of first order, do most of it.
    let early = evolved.width(110) / evolved.mesh.spacing;
    assert!(early > 0.5 * width, "{early} {width}");
}

#[test]
fn nothing_comes_back_from_an_absorbing_boundary() {
    // Velocities uniform in 0 ... 1 m/s, there and back within 2 s: the largest reach 0.5 m.
    let held = Held::new(vec![1.0 / 200.0; 200], 0.01, 2.0, |u, t| {
        (
            u * (0.5 - 0.5 * (PI * t).cos()),
            0.5 * PI * u * (PI * t).sin(),
        )
    });
    for (safe, beyond) in [
        (
            Interval {
                least: -1.0,
                largest: 0.6,
            },
            0.4,
        ),
        (
            Interval {
                least: f64::NEG_INFINITY,
                largest: 0.25,
            },
            0.75,
        ),
    ] {
        for velocity in [None, Some(1)] {
            let evolved = held.run(velocity, options(Some(500)), safe);
            let nodes = evolved.mesh.within(safe);
            let edge = evolved.mesh.value(nodes.1) + 0.5 * evolved.mesh.spacing;
            assert!((edge - safe.largest).abs() < 1e-12);
            let left: Vec<f64> = (0..201).map(|time| evolved.left(time)).collect();
            assert!(left.is_sorted_by(|a, b| a + 1e-14 >= *b));
            // Half a cell of the points, and the width of a point's probability.
            let error = left[200] - (1.0 - beyond);
            assert!(
                error.abs() < 0.5 / 200.0 + 3.0 * evolved.mesh.spacing,
                "{error}"
            );
            for time in 0..=200 {
                let curve = evolved.curve(time, Grid::Own).unwrap();
                let end = curve.nodes.value(curve.nodes.count - 2);
                assert!(end < safe.largest);
            }
        }
    }
    let below_all = Interval {
        least: -1.0,
        largest: -0.5,
    };
    let nothing = held.run(None, options(Some(500)), below_all);
    assert!(nothing.left(0) == 0.0 && nothing.curve(200, Grid::Own).is_none());
}

#[test]
fn blocks_and_threads_make_no_difference() {
    let mut held = Held::free_vibration(101, 0.01, 1.1);
    let threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| held.curve(Some(1), options(Some(300))))
    };
    let one = threads(1);
    assert_eq!(one, threads(3));
    held.block = 7;
    let blocks = held.curve(Some(1), options(Some(300)));
    // Another order of sums.
    assert_eq!(one.nodes, blocks.nodes);
    for (a, b) in one.density.iter().zip(&blocks.density) {
        assert!((a - b).abs() <= 101.0 * f64::EPSILON * a);
    }
}

#[test]
fn what_does_not_move_has_no_mesh() {
    let held = Held::new(vec![0.5; 2], 0.1, 1.0, |u, _| (u, 0.0));
    let transport = Transport {
        quantity: 0,
        velocity: None,
        safe: Interval::ALL,
    };
    let plan = Plan::new(&held, transport, options(Some(100)), 0.1).unwrap();
    assert!(plan.mesh.is_none() && plan.run().unwrap().is_none());
}

#[test]
fn times_are_even_or_not() {
    assert_eq!(even_step(&[0.0, 0.3333, 0.6667, 1.0]), Ok(1.0 / 3.0));
    let gap = Uneven {
        step: 0.5,
        from: 1.0,
        to: 2.0,
    };
    assert_eq!(even_step(&[0.0, 0.5, 1.0, 2.0]), Err(gap));
}
