//! A space of a few random variables in parts that follow its probability.

use super::neighbours::Neighbours;
use crate::density::known::Scale;

/// Parts that are worked on side by side.
pub(super) const SIDE_BY_SIDE: usize = 4;
/// A value for each of them.
pub(super) type Lanes = [f64; SIDE_BY_SIDE];

/// How finely a space is divided: halvings of an axis at most, and the probability above which a part is
/// halved on all axes.
#[derive(Clone, Copy)]
pub(super) struct Fineness {
    halvings: usize,
    probability: f64,
}

/// For two and for three variables.
pub(super) const FINENESS: [Fineness; 2] = [
    Fineness {
        halvings: 6,
        probability: 1.01 / 4096.0,
    },
    Fineness {
        halvings: 6,
        probability: 1.01 / 32768.0,
    },
];

/// The parts, each belonging to the point nearest to its mean, in the order of the points. Those of a point
/// are filled up to whole lanes by parts without probability.
pub(super) struct Parts {
    /// The number of lanes before each point's, and of all.
    starts: Vec<u32>,
    /// `[lanes][axis]`: the distance of a part's mean from the point.
    pub distance: Vec<Lanes>,
    /// `[lanes][axis]`: the tilt of a part's density along the axis, as a share of its mean: 1 where it falls to
    /// zero at the lower end.
    pub tilt: Vec<Lanes>,
    /// Half a part's extent beside that of the whole space.
    pub share: Vec<Lanes>,
    /// The number of parts before each lanes', and of all.
    pub before: Vec<u32>,
    /// The probability of each part, with zeros at the end up to whole lanes.
    pub mass: Vec<Lanes>,
    /// Half the space's extent on each axis.
    pub half: Vec<f64>,
}

/// One of them.
#[derive(Clone)]
struct Part {
    distance: Vec<f64>,
    tilt: Vec<f64>,
    share: f64,
    mass: f64,
}

impl Parts {
    /// `points` are coordinates `[point][axis]` on the scales of the axes.
    pub fn new(points: &[f64], scales: &[Scale], fineness: Fineness) -> Self {
        let dimensions = scales.len();
        let axes: Vec<Axis> = scales
            .iter()
            .map(|scale| Axis::new(*scale, fineness.halvings))
            .collect();
        let search = Neighbours::new(points, dimensions);
        let mut of_point: Vec<Vec<Part>> = vec![Vec::new(); points.len() / dimensions];
        let mut place = vec![0.0; dimensions];
        let mut guess = 0;
        divide(&axes, fineness, &mut |level, index, mass| {
            for ((place, axis), index) in place.iter_mut().zip(&axes).zip(index) {
                *place = axis.levels[level].means[*index];
            }
            guess = search.nearest_one(&place, guess);
            let point = &points[guess as usize * dimensions..][..dimensions];
            let tilts = axes.iter().zip(index);
            of_point[guess as usize].push(Part {
                distance: place.iter().zip(point).map(|(a, b)| a - b).collect(),
                tilt: tilts.map(|(a, k)| a.levels[level].tilts[*k]).collect(),
                share: 1.0 / (1u64 << level) as f64,
                mass,
            });
        });
        let mut parts = Parts {
            starts: vec![0],
            distance: Vec::new(),
            tilt: Vec::new(),
            share: Vec::new(),
            before: vec![0],
            mass: Vec::new(),
            half: axes.iter().map(|axis| axis.half).collect(),
        };
        for of_point in &of_point {
            for side_by_side in of_point.chunks(SIDE_BY_SIDE) {
                parts.push(side_by_side, dimensions);
            }
            parts.starts.push(parts.share.len() as u32);
        }
        let masses: Vec<f64> = of_point.iter().flatten().map(|part| part.mass).collect();
        parts.mass = masses.chunks(SIDE_BY_SIDE).map(filled).collect();
        parts
    }

    fn push(&mut self, side_by_side: &[Part], dimensions: usize) {
        let lanes =
            |of: &dyn Fn(&Part) -> f64| filled(&side_by_side.iter().map(of).collect::<Vec<_>>());
        for axis in 0..dimensions {
            self.distance.push(lanes(&|part| part.distance[axis]));
            self.tilt.push(lanes(&|part| part.tilt[axis]));
        }
        self.share.push(lanes(&|part| part.share));
        let before = self.before.last().copied().unwrap_or(0);
        self.before.push(before + side_by_side.len() as u32);
    }

    /// The lanes of each point.
    pub fn of_points(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        self.starts
            .windows(2)
            .map(|ends| ends[0] as usize..ends[1] as usize)
    }
}

/// Some values, with zeros at the end.
fn filled(values: &[f64]) -> Lanes {
    std::array::from_fn(|lane| values.get(lane).copied().unwrap_or(0.0))
}

/// Hands over every part: its level, its place on each axis, its probability.
fn divide(axes: &[Axis], fineness: Fineness, take: &mut impl FnMut(usize, &[usize], f64)) {
    // Depth first: parts that follow each other are near each other.
    let mut open = vec![(0, vec![0; axes.len()])];
    while let Some((level, index)) = open.pop() {
        let shares = axes.iter().zip(&index);
        let mass: f64 = shares.map(|(a, k)| a.levels[level].shares[*k]).product();
        if level == fineness.halvings || mass <= fineness.probability {
            take(level, &index, mass);
            continue;
        }
        for corner in 0..1usize << axes.len() {
            let half = |(axis, k): (usize, &usize)| 2 * k + (corner >> axis & 1);
            open.push((level + 1, index.iter().enumerate().map(half).collect()));
        }
    }
}

/// An axis on its scale, halved again and again.
struct Axis {
    half: f64,
    levels: Vec<Level>,
}

/// Equal parts of an axis: of each the mean coordinate, the density's tilt that makes it, and the probability.
struct Level {
    means: Vec<f64>,
    tilts: Vec<f64>,
    shares: Vec<f64>,
}

impl Axis {
    fn new(scale: Scale, halvings: usize) -> Self {
        let [start, end] = scale.ends();
        let level = |level: usize| {
            let parts = 1usize << level;
            let edge = |part: usize| start + (end - start) * part as f64 / parts as f64;
            let below: Vec<f64> = (0..=parts).map(|part| scale.share(edge(part))).collect();
            let total = below[parts] - below[0];
            let mean = |part| scale.mean_between(edge(part), edge(part + 1));
            // The mean of 1 + τu over −1 < u < 1 is τ/3.
            let tilt = |part| {
                let [from, to] = [edge(part), edge(part + 1)];
                let off = (mean(part) - 0.5 * (from + to)) / (0.5 * (to - from));
                (3.0 * off).clamp(-1.0, 1.0)
            };
            Level {
                means: (0..parts).map(mean).collect(),
                tilts: (0..parts).map(tilt).collect(),
                shares: below.windows(2).map(|b| (b[1] - b[0]) / total).collect(),
            }
        };
        Axis {
            half: 0.5 * (end - start),
            levels: (0..=halvings).map(level).collect(),
        }
    }
}
