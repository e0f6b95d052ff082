//! The rows that move: the track about the train and on the bridge.
//!
//! Rail waves hardly leave the train, so that a step solves only for the track from some metres behind the last wheel to
//! as many before the first, and, from when the train comes to it, for the bridge and the track on it. A principal block of
//! A has a factor of its own; but it differs from that of the whole in the first rows only, some metres at its left end.

use super::shape::{Shape, dynamic};
use super::shares::Share;
use super::sparse::Factor;
use std::ops::Range;

/// The rows that move at every step.
#[derive(Debug, Clone, Default)]
pub struct Windows {
    /// Of each step, which of the windows.
    of_step: Vec<u32>,
    windows: Vec<Window>,
    edges: Vec<Edge>,
}

/// Rows that move together: ascending, apart from each other; cars and modes besides.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Window {
    pub track: Vec<Part>,
    /// The bridge's modes move: what they take in a sweep down.
    pub modes: Option<Vec<Share>>,
}

/// A range of rows, of which the first ones have a factor of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    pub rows: Range<usize>,
    /// Which of the edges; none where the block begins with the track.
    pub edge: Option<usize>,
}

/// The factor at the left end of a block: 1/D, −L by rows and by columns, of its rows.
#[derive(Debug, Clone)]
pub struct Edge {
    pub rows: Range<usize>,
    pub inverse: Vec<f64>,
    pub forward: Vec<f64>,
    pub backward: Vec<f64>,
}

impl Shape {
    /// The rows that move at each step of the shape's own crossing.
    pub fn windows(&self) -> Option<Windows> {
        let Some(margin) = self.crossing.track.as_ref().and_then(|track| track.window) else {
            return Some(Windows::whole(self));
        };
        let values = self.crossing.assembly().matrices.values;
        let lower = dynamic(&self.pattern.collect(&values), self.crossing.time_step);
        let factor = self.pattern.factorise(&lower)?;
        Some(Windows::about_train(self, margin, &lower, &factor))
    }
}

impl Windows {
    /// All rows at every step.
    pub fn whole(shape: &Shape) -> Windows {
        let whole = Part {
            rows: shape.track.clone(),
            edge: None,
        };
        Windows {
            of_step: vec![0; shape.crossing.steps + 1],
            windows: vec![Window {
                modes: Some(Share::of_modes(shape, std::slice::from_ref(&shape.track))),
                track: vec![whole],
            }],
            edges: Vec::new(),
        }
    }

    /// The track within `margin` (m) of the train and of the bridge; `lower` is the matrix A, `factor` its factor.
    pub fn about_train(shape: &Shape, margin: f64, lower: &[f64], factor: &Factor) -> Windows {
        let Some(track) = &shape.crossing.track else {
            return Windows::whole(shape);
        };
        let last = shape
            .wheels
            .iter()
            .map(|wheel| wheel.behind)
            .fold(0.0, f64::max);
        // The first row of each fastener, and the end of the track.
        let firsts = &shape.fasteners;
        let fastener = |x: f64| {
            let at = ((x - track.start) / track.spacing).floor().max(0.0) as usize;
            at.min(track.fasteners - 1)
        };
        let rows = |from: f64, to: f64| {
            let end = fastener(to) + 1;
            let end = firsts.get(end + 1).copied().unwrap_or(shape.track.end);
            firsts[fastener(from)]..end
        };
        let bridge = shape
            .crossing
            .deck
            .as_ref()
            .map(|deck| rows(-margin, deck.length() + margin));
        let mut all = Windows::default();
        let mut work = factor.clone();
        let mut scaled = vec![0.0; shape.size()];
        let mut reached = false;
        for step in 0..=shape.crossing.steps {
            let first = shape.crossing.middle(step);
            let train = rows(first - last - margin, first + margin);
            let mut ranges = Vec::from([train.clone()]);
            if let Some(bridge) = &bridge {
                reached |= train.end >= bridge.start;
                if reached && train.start <= bridge.end {
                    ranges[0] = train.start.min(bridge.start)..train.end.max(bridge.end);
                } else if reached {
                    ranges = vec![bridge.clone(), train];
                }
            }
            let known = all.windows.last().is_some_and(|window| {
                let same = window.track.iter().map(|part| &part.rows).eq(&ranges);
                same && window.modes.is_some() == reached
            });
            if !known {
                let modes = reached.then(|| Share::of_modes(shape, &ranges));
                let track = ranges.into_iter().map(|rows| {
                    let edge = all.edge(shape, &rows, lower, factor, &mut work, &mut scaled);
                    Part { rows, edge }
                });
                let track = track.collect();
                all.windows.push(Window { track, modes });
            }
            all.of_step.push(all.windows.len() as u32 - 1);
        }
        all
    }

    /// The window of a step.
    pub fn at(&self, step: usize) -> &Window {
        &self.windows[self.of_step[step] as usize]
    }

    /// The edge of a part.
    pub fn edge_of(&self, part: &Part) -> Option<&Edge> {
        part.edge.map(|edge| &self.edges[edge])
    }

    /// The rows that moved in the step before and stop now.
    pub fn left(&self, step: usize) -> Vec<usize> {
        let (Some(before), now) = (step.checked_sub(1), self.of_step[step]) else {
            return Vec::new();
        };
        if self.of_step[before] == now {
            return Vec::new();
        }
        let moves = |row: &usize| {
            self.at(step)
                .track
                .iter()
                .any(|part| part.rows.contains(row))
        };
        let before = self.at(before).track.iter();
        before
            .flat_map(|part| part.rows.clone())
            .filter(|row| !moves(row))
            .collect()
    }

    fn edge(
        &mut self,
        shape: &Shape,
        rows: &Range<usize>,
        lower: &[f64],
        factor: &Factor,
        work: &mut Factor,
        scaled: &mut [f64],
    ) -> Option<usize> {
        if rows.start == shape.track.start {
            return None;
        }
        if let Some(known) = self
            .edges
            .iter()
            .rposition(|edge| edge.rows.start == rows.start)
        {
            return Some(known);
        }
        let pattern = &shape.pattern;
        let end = pattern.factorise_from(lower, rows.start, shape.track.end, work, scaled);
        let own = rows.start..end;
        let places =
            pattern.factor.starts[own.start] as usize..pattern.factor.starts[own.end] as usize;
        self.edges.push(Edge {
            inverse: work.inverse[own.clone()].to_vec(),
            forward: work.lower[places.clone()].iter().map(|l| -l).collect(),
            backward: pattern.by_columns(work, own.clone()).map(|l| -l).collect(),
            rows: own.clone(),
        });
        work.lower[places.clone()].copy_from_slice(&factor.lower[places]);
        work.inverse[own.clone()].copy_from_slice(&factor.inverse[own]);
        Some(self.edges.len() - 1)
    }
}
