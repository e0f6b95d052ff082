//! What `dpim check` says of trains.

use crate::scenario::train::{StaticWheel, mass, static_wheels};
use crate::system::train::{Car, Contact, Deck, PlacedCar, Spans, Support, Track, TrainCrossing};

/// Unknowns that a core steps in a second, for an estimate only: a crossing of three cars, 2,224 unknowns and 4,200 steps,
/// takes about 23 ms in an ensemble, with the track solved for about the train and the bridge; several times as long where
/// track, bridge or speed are random, and less by superposition.
const UNKNOWN_STEPS_PER_SECOND: f64 = 4e8;

/// Train, contact, track, bridge and path.
pub(super) fn describe(crossing: &TrainCrossing, write: &mut impl FnMut(String)) {
    let wheels = static_wheels(crossing);
    let behind = wheels.last().map_or(0.0, |wheel| wheel.behind);
    let total: f64 = crossing.cars.iter().map(|placed| mass(&placed.car)).sum();
    let total = match total {
        0.0 => String::new(),
        _ => format!(", {total} kg"),
    };
    write(format!(
        "train: {} cars, {} wheels over {behind:.3} m{total}",
        crossing.cars.len(),
        wheels.len()
    ));
    cars(crossing, write);
    write(match crossing.contact {
        _ if !wheels.iter().any(|wheel| wheel.in_contact) => {
            "contact: none, but by forces or tyres".to_owned()
        }
        Contact::Rigid => "contact: rigid".to_owned(),
        Contact::Linear { stiffness } => {
            format!("contact: linear, {stiffness:.6e} N/m of a wheelset")
        }
        Contact::Hertz { constant } => format!(
            "contact: Hertz, G = {constant:.6e} m/N^(2/3) of a wheel, {:.6e} N/m of the first wheelset about its static force",
            Contact::linearised(constant, wheels[0].force)
        ),
    });
    match &crossing.track {
        Some(track) => write(line(track)),
        None => write("track: none, wheels on the deck and on rigid ground beside it".to_owned()),
    }
    match &crossing.deck {
        Some(deck) => write(spans(deck)),
        None => write("bridge: none".to_owned()),
    }
    write(format!(
        "degrees of freedom: about {}",
        degrees_of_freedom(crossing)
    ));
    let start = 0.0 - crossing.approach;
    let way = crossing.speed * crossing.steps as f64 * crossing.time_step;
    write(format!(
        "path: first wheel from {start} to {:.3} m at {} m/s, last wheel from {:.3} to {:.3} m",
        start + way,
        crossing.speed,
        start - behind,
        start + way - behind
    ));
    if let Some(note) = ends_before_the_bridge(crossing) {
        write(format!("  note: {note}"));
    }
}

/// What is said where the train never gets to the bridge.
pub(in crate::commands) fn ends_before_the_bridge(crossing: &TrainCrossing) -> Option<String> {
    let way = crossing.speed * crossing.steps as f64 * crossing.time_step;
    let left = crossing.approach - way;
    (crossing.deck.is_some() && left >= 0.0).then(|| {
        format!(
            "the run ends {left:.3} m before the bridge: simulation.duration is too short for vehicle.approach"
        )
    })
}

/// Point-steps that a core does in a second.
pub(super) fn point_steps_per_second(crossing: &TrainCrossing) -> f64 {
    UNKNOWN_STEPS_PER_SECOND / degrees_of_freedom(crossing).max(1) as f64
}

/// Cars, those that are alike together.
fn cars(crossing: &TrainCrossing, write: &mut impl FnMut(String)) {
    let alike = |a: &PlacedCar, b: &PlacedCar| a.car == b.car;
    let mut first = 1;
    for group in crossing.cars.chunk_by(alike) {
        let last = first + group.len() - 1;
        let which = match group.len() {
            1 => format!("car {first}"),
            _ => format!("cars {first} to {last}"),
        };
        let kind = match &group[0].car {
            Car::MovingForces(_) => "moving forces",
            Car::MovingMass { .. } => "moving mass",
            Car::SprungMass { .. } => "sprung mass",
            Car::HalfCar(_) => "half car",
            Car::RailVehicle(_) => "rail vehicle",
        };
        let mass = match mass(&group[0].car) {
            0.0 => String::new(),
            mass => format!(" of {mass} kg"),
        };
        let alone = TrainCrossing {
            cars: group[..1].to_vec(),
            ..crossing.clone()
        };
        write(format!(
            "  {which}: {kind}{mass}, static axle loads {}",
            loads(&static_wheels(&alone))
        ));
        first = last + 1;
    }
}

/// Static forces, equal neighbours together.
fn loads(wheels: &[StaticWheel]) -> String {
    let equal = |a: &StaticWheel, b: &StaticWheel| a.force == b.force;
    let groups: Vec<String> = wheels
        .chunk_by(equal)
        .map(|group| format!("{} x {:.1} N", group.len(), group[0].force))
        .collect();
    groups.join(", ")
}

fn line(track: &Track) -> String {
    let kind = match track.support {
        Support::Direct => "direct",
        Support::Ballasted(_) => "ballasted",
        Support::Slab(_) => "slab",
    };
    let end = track.start + (track.fasteners - 1) as f64 * track.spacing;
    format!(
        "track: {kind}, {} fasteners {} m apart from {:.3} to {end:.3} m",
        track.fasteners, track.spacing, track.start
    )
}

fn spans(deck: &Deck) -> String {
    let kind = match deck.kind {
        Spans::Simple => "simple",
        Spans::Continuous => "continuous",
    };
    let lengths: Vec<String> = deck.spans.iter().map(f64::to_string).collect();
    let end: f64 = deck.spans.iter().sum();
    format!(
        "bridge: {kind}, spans of {} m from 0 to {end} m, {} modes of each{}",
        lengths.join(", "),
        deck.modes,
        match deck.kind {
            Spans::Simple => "",
            Spans::Continuous => " beam",
        }
    )
}

/// Of cars, rail, what carries it, and the bridge's modes.
fn degrees_of_freedom(crossing: &TrainCrossing) -> usize {
    let cars = crossing.cars.iter().map(|placed| match &placed.car {
        Car::MovingForces(_) => 0,
        Car::MovingMass { .. } => 1,
        Car::SprungMass { .. } => 2,
        Car::HalfCar(_) => 4,
        Car::RailVehicle(_) => 10,
    });
    let track = crossing.track.as_ref().map_or(0, |track| {
        let rail = 2 * ((track.fasteners - 1) * track.elements + 1);
        let support = match track.support {
            Support::Direct => 0,
            Support::Ballasted(_) | Support::Slab(_) => 2 * track.fasteners,
        };
        rail + support
    });
    let modes = crossing.deck.as_ref().map_or(0, |deck| match deck.kind {
        Spans::Simple => deck.modes * deck.spans.len(),
        Spans::Continuous => deck.modes,
    });
    cars.sum::<usize>() + track + modes
}
