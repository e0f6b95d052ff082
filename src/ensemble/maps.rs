//! The coefficients of a step as the lanes load them: one list, shared by all lanes or a row for each
//! coefficient, and where in it to find what.

use super::lanes::{Dense2, Dense3, LANES, Step, TwoStep, TwoStepVelocity};
use crate::integrate::{Pattern, Propagator};
use crate::system::{CrossingMaps, OutputMap};

pub(super) const WHEEL_SHARE: usize = 0;
/// W.
pub(super) const WEIGHT: usize = 1;
/// K where the deck's compliance is zero.
pub(super) const STIFFNESS: usize = 2;
/// 1/k₂ + C_v.
pub(super) const SOFTNESS: usize = 3;
/// The share of P in the heave's and the travel's push.
pub(super) const LIFT: usize = 4;
pub(super) const SQUEEZE: usize = 5;
/// m₂/μ.
pub(super) const RATIO: usize = 6;
/// C_N.
pub(super) const TRAVEL_COMPLIANCE: usize = 7;
/// k₃, c₂, and the stop's gap and stiffness.
pub(super) const CUBIC: usize = 8;
pub(super) const QUADRATIC: usize = 9;
pub(super) const GAP: usize = 10;
pub(super) const STOP: usize = 11;
/// Travel and its rate: three states, P and N.
pub(super) const TRAVEL: usize = 12;
pub(super) const RATE: usize = 17;
/// The maps of heave and travel.
pub(super) const HEAVE_MAP: usize = 22;
pub(super) const TRAVEL_MAP: usize = HEAVE_MAP + MOST;
/// The modes: of each the map, the share of the shared load in its push, its compliance.
const MODES: usize = TRAVEL_MAP + MOST;
const MODE: usize = MOST + 2;
/// The most coefficients of a pattern.
const MOST: usize = 12;

/// The map of a mode.
pub(super) const fn mode_map(mode: usize) -> usize {
    MODES + mode * MODE
}

/// The share of the shared load in a mode's push.
pub(super) const fn mode_gain(mode: usize) -> usize {
    mode_map(mode) + MOST
}

/// A mode's displacement under a unit of the shared load within the step.
pub(super) const fn mode_compliance(mode: usize) -> usize {
    mode_map(mode) + MOST + 1
}

/// How an output is made of rows.
#[derive(Debug, Clone)]
pub(super) enum Output {
    Bridge {
        /// (mode, coefficient) in each plane.
        terms: [Vec<(usize, usize)>; 3],
        /// (mode, coefficient) of the shared loads.
        forces: Vec<(usize, usize)>,
        /// The coefficient of the truncated modes' static share.
        statics: usize,
    },
    Vehicle {
        /// (row, coefficient) of the vehicle's states.
        terms: Vec<(usize, usize)>,
        p: usize,
        n: usize,
    },
    ContactForce,
    Irregularity,
}

/// Where the outputs find their coefficients.
#[derive(Debug, Clone)]
pub(super) struct Program {
    pub outputs: Vec<Output>,
}

impl Program {
    /// Coefficients that are zero are left out: where parameters vary, of modes that have no others.
    pub fn new(maps: &CrossingMaps, varied: bool) -> Self {
        let modes = maps.modal.len();
        let mut at = mode_map(modes);
        let mut outputs = Vec::new();
        for output in &maps.outputs {
            let first = at;
            at += size(output, modes);
            outputs.push(match output {
                OutputMap::Bridge { terms, forces, .. } => {
                    let all = || terms.iter().chain([forces]);
                    let moves =
                        |mode: usize| all().any(|row| row.get(mode).is_some_and(|c| *c != 0.0));
                    let used = |plane: usize, values: &[f64]| {
                        let used = values.iter().enumerate();
                        used.filter(|(mode, c)| **c != 0.0 || varied && moves(*mode))
                            .map(|(mode, _)| (mode, first + plane * modes + mode))
                            .collect::<Vec<_>>()
                    };
                    Output::Bridge {
                        terms: [used(0, &terms[0]), used(1, &terms[1]), used(2, &terms[2])],
                        forces: used(3, forces),
                        statics: first + 4 * modes,
                    }
                }
                OutputMap::Vehicle { heave, travel, .. } => Output::Vehicle {
                    terms: heave
                        .iter()
                        .chain(travel)
                        .enumerate()
                        .filter(|(_, c)| **c != 0.0)
                        .map(|(row, _)| (row, first + row))
                        .collect(),
                    p: first + 6,
                    n: first + 7,
                },
                OutputMap::ContactForce => Output::ContactForce,
                OutputMap::Irregularity => Output::Irregularity,
            });
        }
        Program { outputs }
    }
}

/// Coefficients of an output.
fn size(output: &OutputMap, modes: usize) -> usize {
    match output {
        OutputMap::Bridge { .. } => 4 * modes + 1,
        OutputMap::Vehicle { .. } => 8,
        OutputMap::ContactForce | OutputMap::Irregularity => 0,
    }
}

/// The list of one set of maps.
pub(super) fn flatten(maps: &CrossingMaps) -> Vec<f64> {
    let (car, vehicle) = (&maps.crossing.car, maps.vehicle());
    let softness = 1.0 / car.tyre_stiffness + maps.wheel_compliance;
    let (gap, stop) = car.bump_stop.map_or((0.0, 0.0), |s| (s.gap, s.stiffness));
    let mut list = vec![
        maps.wheel_share,
        maps.weight,
        1.0 / softness,
        softness,
        maps.heave_load * left_over(&maps.heave),
        maps.travel_load * left_over(&maps.travel),
        car.wheel_mass / car.reduced_mass(),
        maps.travel_compliance,
        car.suspension_cubic_stiffness,
        car.suspension_quadratic_damping,
        gap,
        stop,
    ];
    for (states, p, n) in [vehicle.travel(), vehicle.travel_rate()] {
        list.extend(states);
        list.extend([p, n]);
    }
    pack(&maps.heave, &mut list);
    pack(&maps.travel, &mut list);
    for map in &maps.modal {
        pack(map, &mut list);
        list.push(maps.lightness * left_over(map));
        list.push(maps.lightness * map.compliance);
    }
    let modes = maps.modal.len();
    for output in &maps.outputs {
        match output {
            OutputMap::Bridge {
                terms,
                forces,
                statics,
            } => {
                for plane in terms {
                    list.extend((0..modes).map(|i| plane.get(i).copied().unwrap_or(0.0)));
                }
                list.extend(forces.iter().map(|f| maps.lightness * f));
                list.push(statics.map_or(0.0, |(_, factor)| factor));
            }
            OutputMap::Vehicle {
                heave,
                travel,
                p,
                n,
            } => {
                list.extend(heave.iter().chain(travel));
                list.extend([*p, *n]);
            }
            OutputMap::ContactForce | OutputMap::Irregularity => {}
        }
    }
    list
}

/// The lists of `lanes` points (the last one repeated) as rows `[coefficient][lane]`.
pub(super) fn rows(lanes: &[CrossingMaps], out: &mut Vec<f64>) {
    for lane in 0..LANES {
        let list = flatten(&lanes[lane.min(lanes.len() - 1)]);
        out.resize(list.len() * LANES, 0.0);
        for (value, row) in list.iter().zip(out.chunks_exact_mut(LANES)) {
            row[lane] = *value;
        }
    }
}

/// What a push leaves to its factor: b₀ of a two-step map, or 1.
fn left_over(map: &Propagator) -> f64 {
    match map.pattern {
        Pattern::TwoStep => map.push[0],
        Pattern::TwoStepVelocity | Pattern::Dense2 | Pattern::Dense3 => 1.0,
    }
}

/// A map, filled up with zeros.
fn pack(map: &Propagator, list: &mut Vec<f64>) {
    let end = list.len() + MOST;
    match map.pattern {
        Pattern::TwoStep => TwoStep::<true>::pack(map, list),
        Pattern::TwoStepVelocity => TwoStepVelocity::pack(map, list),
        Pattern::Dense2 => Dense2::pack(map, list),
        Pattern::Dense3 => Dense3::pack(map, list),
    }
    list.resize(end, 0.0);
}
