//! `dpim check`: what a scenario costs and whether its step is stable, before the work.

pub(super) mod train;

use super::Context;
use super::random::{Leading, warnings};
use super::source::Source;
use crate::Result;
use crate::cli;
use crate::ensemble::LANES;
use crate::files::recording::band_layout;
use crate::integrate::Integrator;
use crate::irregularity::Band;
use crate::probability::distribution::Tail;
use crate::scenario::{Precision, RandomParameters, Scenario, SimulationSpec, SpectrumSpec};
use crate::system::{Chain, Crossing, largest_stable_step};
use std::fmt::Write;

/// Point-steps a core does in a second, for an estimate only: with ten modes and AVX-512 one was
/// measured to take 3.2 to 5 ns.
const POINT_STEPS_PER_SECOND: f64 = 3e8;

pub(super) fn run(context: &Context, args: &cli::Check) -> Result<()> {
    let scenario = args.scenario.load()?;
    scenario.check_all()?;
    let mut text = String::new();
    let mut write = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    write(format!(
        "{}: {}",
        args.scenario.scenario.display(),
        scenario.title().unwrap_or("without a title")
    ));
    let random = super::random::read(&scenario)?;
    describe(&random, &mut write);
    let points = if scenario.has("points") {
        points(context, &scenario, random, &mut write)?
    } else {
        None
    };
    if scenario.has("simulation") {
        simulation(&scenario, points, &mut write)?;
    }
    super::print(&text)?;
    // Last, so that all of the above is seen before the verdict.
    if scenario.has("simulation") {
        let judged = scenario.judged()?;
        let simulated = super::judged::simulated(&scenario, judged.as_ref());
        let (_, quantities) = super::model::Model::read(simulated)?;
        super::judged::recorded(judged.as_ref(), &quantities)?;
    }
    Ok(())
}

/// Points, irregularity or excitation; returns the number of points, and of positions of each.
fn points(
    context: &Context,
    scenario: &Scenario,
    random: RandomParameters,
    write: &mut impl FnMut(String),
) -> Result<Option<(usize, usize)>> {
    let spec = scenario.points()?;
    if !["irregularity", "excitation", "oscillator"]
        .iter()
        .any(|table| scenario.has(table))
    {
        return Ok(None);
    }
    let source = Source::read(context, scenario, &spec)?;
    let own = source.irregularity.dimensions();
    let dimensions = random.dimensions() + own;
    let leading = Leading::new(random, &spec, own);
    let grid = source.irregularity.grid();
    let numbers = grid.count + leading.random.dimensions() + leading.variables;
    let count = scenario.point_count(&spec, dimensions, leading.random.dimensions())?;
    write(format!(
        "points: {count} by {} in {dimensions} standard normal variables",
        spec.rule.name()
    ));
    describe_source(scenario, &source, write)?;
    write(format!(
        "  points file: about {}",
        size(count * (8 * numbers + 8))
    ));
    Ok(Some((count, grid.count)))
}

/// Irregularity or excitation, where there is one.
fn describe_source(
    scenario: &Scenario,
    source: &Source,
    write: &mut impl FnMut(String),
) -> Result<()> {
    let grid = source.irregularity.grid();
    if grid.count == 0 {
        return Ok(());
    }
    let in_time = scenario.has("excitation");
    let (what, places, unit) = if in_time {
        ("excitation", "times", "s")
    } else {
        ("irregularity", "positions", "m")
    };
    let end = grid.position(grid.count - 1);
    write(format!(
        "{what}: {} {places} from {} to {end} {unit}, {} {unit} apart",
        grid.count, grid.start, grid.spacing
    ));
    let Some(field) = source.irregularity.field() else {
        return Ok(());
    };
    write(format!("  {}", field.describe()));
    let deviation = field.variance().sqrt();
    let (band, whole) = if in_time {
        let band = scenario.excitation()?.frequency;
        let (min, count) = (0.0, band.count as usize);
        let max = band.max;
        (Some(Band { min, max, count }), None)
    } else {
        let spec = scenario.irregularity()?;
        let smoothed = spec.smoothing.is_some();
        let spectrum = spec.spectrum.as_ref().filter(|_| !smoothed);
        (
            spec.band(),
            spectrum.and_then(SpectrumSpec::whole_deviation),
        )
    };
    let whole = whole.map_or(String::new(), |deviation| {
        format!(" (of the whole spectrum: {deviation:.6e} m)")
    });
    let measure = if in_time { "m/s2 or N" } else { "m" };
    write(format!(
        "  standard deviation {deviation:.6e} {measure}{whole}"
    ));
    let period = band.map_or(f64::INFINITY, |band| {
        2.0 * std::f64::consts::PI / band.step()
    });
    if end - grid.start > 0.5 * period {
        let up_to = if band.is_some_and(|band| band.min > 0.0) {
            "phases"
        } else {
            "the sign"
        };
        write(format!(
            "  note: it repeats after {period:.1} {unit} (up to {up_to}): take more of the band"
        ));
    }
    Ok(())
}

/// The random parameters, with the values that one point in a thousand is below or above.
fn describe(random: &RandomParameters, write: &mut impl FnMut(String)) {
    if random.dimensions() > 0 {
        write("random parameters:".to_owned());
    }
    for parameter in random.iter() {
        let law = &parameter.distribution;
        write(format!(
            "  {} [{}]: {}, mean {:.6e}, standard deviation {:.6e}",
            parameter.key,
            parameter.unit,
            law.kind(),
            law.mean(),
            law.deviation()
        ));
        write(format!(
            "    0.1 % below {:.6e}, 0.1 % above {:.6e}",
            law.value(Tail::Below(0.001)),
            law.value(Tail::Above(0.001))
        ));
    }
    for warning in warnings(random) {
        write(format!("  note: {warning}"));
    }
}

/// Frequencies, steps and sizes of the simulation.
fn simulation(
    scenario: &Scenario,
    points: Option<(usize, usize)>,
    write: &mut impl FnMut(String),
) -> Result<()> {
    let spec = scenario.simulation()?;
    if scenario.has("oscillator") {
        let chain = scenario.chain_at_any_step(&spec)?;
        oscillator(&chain, write);
        let times = chain.times().len();
        let work = (chain.steps, POINT_STEPS_PER_SECOND);
        recording(&spec, times, work, points, write);
        return Ok(());
    }
    if scenario.is_train() {
        let crossing = scenario.train_crossing(&spec)?;
        train::describe(&crossing, write);
        let times = crossing.steps / crossing.record_every + 1;
        let work = (crossing.steps, train::point_steps_per_second(&crossing));
        recording(&spec, times, work, points, write);
        return Ok(());
    }
    let crossing = scenario.crossing_at_any_step(&spec)?;
    frequencies(&crossing, write);
    let position = crossing.positions();
    write(format!(
        "path: from {} to {} m at {} m/s, the bridge from 0 to {} m",
        position[0],
        position[position.len() - 1],
        crossing.car.speed,
        crossing.beam.span
    ));
    if let Some(note) = super::model::ends_before_the_bridge(&crossing) {
        write(format!("  note: {note}"));
    }
    write("largest stable step:".to_owned());
    for integrator in Integrator::ALL {
        let mut trial = crossing.clone();
        trial.integrator = integrator;
        let given = trial.time_step;
        trial.time_step = given.max(1.0);
        let largest = largest_stable_step(&trial);
        let bound = if largest >= trial.time_step {
            format!("over {} s", trial.time_step)
        } else {
            format!("{largest} s")
        };
        let mark = match (integrator == crossing.integrator, largest >= given) {
            (true, true) => format!("  <- given: {given} s"),
            (true, false) => format!("  <- given: {given} s, NOT STABLE"),
            (false, _) => String::new(),
        };
        write(format!("  {:<17} {bound}{mark}", integrator.name()));
    }
    let work = (crossing.steps, POINT_STEPS_PER_SECOND);
    recording(&spec, crossing.times().len(), work, points, write);
    Ok(())
}

/// What is recorded, and what that takes.
fn recording(
    spec: &SimulationSpec,
    times: usize,
    (steps, per_second): (usize, f64),
    points: Option<(usize, usize)>,
    write: &mut impl FnMut(String),
) {
    let quantities = spec.record.len() + spec.filter.len();
    let bytes = match spec.precision {
        Precision::F64 => 8,
        Precision::F32 => 4,
    };
    let positions = points.map_or(0, |(_, positions)| positions);
    let (band, block) = band_layout(times, quantities, positions);
    write(format!(
        "recording: {quantities} quantities at {times} times, blocks of {block} points, bands of {band}"
    ));
    if !spec.index.is_empty() {
        write(format!("  and {} values a point", spec.index.len()));
    }
    if let Some((points, _)) = points {
        let steps = points as f64 * (steps + 1) as f64;
        let seconds = steps / per_second;
        let held = points.next_multiple_of(LANES);
        let held = held.min(band) * times * quantities + held.min(block) * positions;
        write(format!(
            "  file: about {}",
            size(points * times * quantities * bytes)
        ));
        write(format!(
            "  work: {steps:.3e} point-steps, some {seconds:.2} s of one core; memory: some {}",
            size(2 * held * size_of::<f64>())
        ));
    }
}

/// Frequencies of the undeformed chain, and its largest step.
fn oscillator(chain: &Chain, write: &mut impl FnMut(String)) {
    write("oscillator, undeformed:".to_owned());
    let ratios = chain.modal_damping_ratios();
    for (k, (omega, ratio)) in chain.modes().0.iter().zip(ratios).enumerate().take(10) {
        write(format!(
            "  mode {:>2}: {:>10.4} Hz, {omega:>10.4} rad/s, damping ratio {ratio:.4}",
            k + 1,
            omega / (2.0 * std::f64::consts::PI)
        ));
    }
    let given = chain.time_step;
    write(match chain.largest_stable_step() {
        None => format!("largest stable step: any, given: {given} s"),
        Some(largest) if largest < given => {
            format!("largest stable step: {largest} s, given: {given} s, NOT STABLE")
        }
        Some(largest) => format!("largest stable step: {largest} s, given: {given} s"),
    });
}

fn frequencies(crossing: &Crossing, write: &mut impl FnMut(String)) {
    let hertz = |omega: f64| omega / (2.0 * std::f64::consts::PI);
    write("bridge:".to_owned());
    for mode in 1..=crossing.beam.modes.min(10) {
        let omega = crossing.beam.frequency(mode);
        write(format!(
            "  mode {mode:>2}: {:>10.4} Hz, {omega:>10.4} rad/s, damping ratio {}",
            hertz(omega),
            crossing.beam.damping_ratio
        ));
    }
    if crossing.beam.modes > 10 {
        let omega = crossing.beam.frequency(crossing.beam.modes);
        write(format!(
            "  mode {:>2}: {:>10.4} Hz, {omega:>10.4} rad/s",
            crossing.beam.modes,
            hertz(omega)
        ));
    }
    let car = &crossing.car;
    let body = (car.suspension_stiffness / car.body_mass).sqrt();
    let wheel = ((car.suspension_stiffness + car.tyre_stiffness) / car.wheel_mass).sqrt();
    write(format!(
        "vehicle: body on its suspension {:.4} Hz, wheel between suspension and tyre {:.4} Hz",
        hertz(body),
        hertz(wheel)
    ));
    let sag = crossing.weight() / car.tyre_stiffness;
    write(format!(
        "  weight {:.1} N, static deflection of the tyre {:.4} m",
        crossing.weight(),
        sag
    ));
}

/// Bytes for people.
fn size(bytes: usize) -> String {
    let bytes = bytes as f64;
    match bytes {
        b if b < 1e6 => format!("{:.1} kB", b / 1e3),
        b if b < 1e9 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.2} GB", b / 1e9),
    }
}
