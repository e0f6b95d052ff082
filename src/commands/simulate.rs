//! `dpim simulate`: one deterministic run a point, in lockstep, band by band.

use super::Context;
use super::judged::{self, Recorded};
use super::model::Model;
use crate::cli;
use crate::ensemble::{Divergence, Judged, Points, Stepper, Strip, System};
use crate::files::points::{PointsReader, ReadBatch};
use crate::files::recording::{
    self, Band, QuantityHeader, RecordingHeader, RecordingWriter, band_layout,
};
use crate::files::{Kind, OutputFile, Provenance, Weights};
use crate::scenario::{
    self, Compression, ContactSpec, Precision, Scenario, SimulationSpec, VehicleSpec,
};
use crate::{BadInput, Error, Result, interrupt, memory};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

pub(super) fn run(context: &Context, args: &cli::Simulate) -> Result<()> {
    super::check_distinct(
        &[&args.scenario.scenario, &args.points],
        &[("--output", &args.output.output)],
    )?;
    let scenario = args.scenario.load()?;
    let simulation = scenario.simulation()?;
    let judged = scenario.judged()?;
    let simulated = judged::simulated(&scenario, judged.as_ref());
    let (model, quantities) = Model::read(simulated)?;
    let Recorded {
        headers,
        judgements,
    } = judged::recorded(judged.as_ref(), &quantities)?;
    if let Some(note) = model.note() {
        context.note(note);
    }
    let reader = PointsReader::open(&args.points)?;
    check_harmonics(args, &scenario, &reader)?;
    let range = checked_range(args, reader.header().count)?;
    let component = model.component(&reader)?;
    if let (None, Some(name)) = (component, reader.header().components.first()) {
        context.note(format!(
            "{}: {name} moves nothing: the scenario has no oscillator.excitation",
            args.points.display()
        ));
    }
    let mut system = model.system(simulated, &quantities, &args.points, &reader)?;
    if let Some(judgements) = judgements {
        system = Box::new(Judged::new(system, judgements));
    }
    let header = header(&scenario, &simulation, headers, &reader, &range, args);
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let writer = RecordingWriter::create(output, &header)?;
    let run = Run {
        context,
        times: system.times(),
        system,
        reader,
        component,
        range,
    };
    run.execute(writer)
}

/// A pseudo-excitation needs a linear system without random parameters.
fn check_harmonics(args: &cli::Simulate, scenario: &Scenario, reader: &PointsReader) -> Result<()> {
    let header = reader.header();
    match header.weights {
        Weights::Harmonics => {}
        Weights::Assigned | Weights::Importance => return Ok(()),
    }
    let file = args.points.display();
    let expected = format!("a linear system: {file} holds the harmonics of a pseudo-excitation");
    let nonlinear = match scenario.vehicle()? {
        VehicleSpec::QuarterCar(car) => car.nonlinear_key().map(|key| {
            scenario
                .bad(key, expected, "a nonlinear suspension")
                .remedy("leave the key out, or excite without --pseudo-excitation")
        }),
        VehicleSpec::Train(_) | VehicleSpec::LoadModel(_) => match scenario.contact()? {
            Some(ContactSpec::Hertz(_)) => Some(
                scenario
                    .bad("contact.kind", expected, "\"hertz\"")
                    .remedy("take the contact \"linear\", or excite without --pseudo-excitation"),
            ),
            Some(ContactSpec::Linear(_) | ContactSpec::Rigid) | None => None,
        },
    };
    if let Some(error) = nonlinear {
        return Err(error.into());
    }
    let parameter = header
        .parameters
        .iter()
        .find(|(key, _)| scenario::is_key(key));
    match parameter {
        None => Ok(()),
        Some((key, _)) => Err(super::bad_file(
            &args.points,
            key,
            "harmonics of a pseudo-excitation, the irregularity alone being random",
            "a random parameter",
        )
        .remedy("excite without --pseudo-excitation")
        .into()),
    }
}

fn checked_range(args: &cli::Simulate, count: u32) -> Result<Range<u32>> {
    let range = args.range.clone().unwrap_or(0..count);
    if range.end > count {
        let found = format!("{}..{}", range.start, range.end);
        let expected = format!(
            "a range within the {count} points of {}",
            args.points.display()
        );
        return Err(BadInput::new("--points", "", expected, found).into());
    }
    Ok(range)
}

fn header(
    scenario: &Scenario,
    simulation: &SimulationSpec,
    quantities: Vec<QuantityHeader>,
    reader: &PointsReader,
    range: &Range<u32>,
    args: &cli::Simulate,
) -> RecordingHeader {
    let points = reader.header();
    let stamp = points.provenance.as_ref();
    let options: Vec<String> = args
        .range
        .iter()
        .map(|r| format!("points {}..{}", r.start, r.end))
        .collect();
    RecordingHeader {
        quantities,
        weights: points.weights,
        points_total: points.count,
        first_point: range.start,
        count: range.end - range.start,
        provenance: Provenance::stamp(
            Kind::Recording,
            Some(scenario.text()),
            stamp.and_then(|s| s.seed),
            &[stamp.map(|s| s.identity.clone()).unwrap_or_default()],
            &options,
        ),
        compression: match simulation.compression {
            Compression::None => recording::Compression::None,
            Compression::Zstd => recording::Compression::Zstd,
            Compression::Lz4 => recording::Compression::Lz4,
        },
        precision: match simulation.precision {
            Precision::F64 => recording::Precision::F64,
            Precision::F32 => recording::Precision::F32,
        },
    }
}

/// Everything but the output.
struct Run<'a> {
    context: &'a Context,
    system: Box<dyn System>,
    times: Vec<f64>,
    reader: PointsReader,
    /// The column of irregularity or excitation, where the system needs one.
    component: Option<usize>,
    range: Range<u32>,
}

/// A band under way.
struct Filled {
    points: Range<u32>,
    values: Vec<f64>,
    /// `[block][value a point][point]`.
    point_values: Vec<f64>,
}

impl Run<'_> {
    /// Rows of a point: times and quantities.
    fn rows(&self) -> usize {
        self.times.len() * self.system.outputs()
    }

    /// Values a point at the end of its run.
    fn point_rows(&self) -> usize {
        self.system.point_outputs()
    }

    /// Reads on one thread, steps on all, writes on another.
    fn execute(&self, writer: RecordingWriter) -> Result<()> {
        let (band, block) = band_layout(
            self.times.len(),
            self.system.outputs(),
            self.reader.header().positions,
        );
        let bar = self.context.progress("simulate", self.range.len() as u64);
        std::thread::scope(|scope| {
            // Each side waits for the other to take what it has: two batches and two bands are in memory.
            let (read, batches) = sync_channel::<Result<ReadBatch>>(0);
            let (used, spare_batches) = sync_channel::<ReadBatch>(2);
            scope.spawn(move || self.read(block, &read, &spare_batches));
            let (full, bands) = sync_channel::<Filled>(0);
            let (emptied, spare_bands) = sync_channel::<Vec<f64>>(2);
            let written = scope.spawn(move || self.write(writer, block, bands, &emptied));
            let mut stepped: Result<()> = Ok(());
            for first in self.range.clone().step_by(band) {
                let points = first..self.range.end.min(first.saturating_add(band as u32));
                let size = points.len() * self.rows();
                // A second band in memory lets one be written while the next is stepped: of no use to
                // one thread.
                let spare = if rayon::current_num_threads() == 1 && first > self.range.start {
                    spare_bands.recv().ok()
                } else {
                    spare_bands.try_recv().ok()
                };
                let mut values = spare.unwrap_or_else(|| memory::zeros(size));
                values.resize(size, 0.0);
                let mut point_values = vec![0.0; points.len() * self.point_rows()];
                let mut rest = point_values.as_mut_slice();
                stepped = values
                    .chunks_mut(block * self.rows())
                    .try_for_each(|values| {
                        interrupt::check()?;
                        let batch = batches.recv().unwrap_or(Err(Error::Interrupted))?;
                        let own = batch.count * self.point_rows();
                        let a_point = rest.split_off_mut(..own).expect("a value for each");
                        self.step(&batch, values, a_point)?;
                        bar.inc(batch.count as u64);
                        let _ = used.try_send(batch);
                        Ok(())
                    });
                let filled = Filled {
                    points,
                    values,
                    point_values,
                };
                if stepped.is_err() || full.send(filled).is_err() {
                    break;
                }
            }
            drop((batches, used));
            bar.finish_and_clear();
            let complete = stepped.is_ok();
            drop(full);
            let writer = written
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            stepped?;
            let writer = writer?;
            if complete { writer.finish() } else { Ok(()) }
        })
    }

    fn read(
        &self,
        block: usize,
        full: &SyncSender<Result<ReadBatch>>,
        spare: &Receiver<ReadBatch>,
    ) {
        let mut batches = match self.reader.batches(self.range.clone(), block) {
            Ok(batches) => batches,
            Err(error) => {
                let _ = full.send(Err(error));
                return;
            }
        };
        loop {
            let mut batch = spare.try_recv().unwrap_or_default();
            let message = match batches.read_into(&mut batch) {
                Ok(true) => Ok(batch),
                Ok(false) => return,
                Err(error) => Err(error),
            };
            if full.send(message).is_err() {
                return;
            }
        }
    }

    /// Writes bands as they come and gives the writer back, for the end.
    fn write(
        &self,
        mut writer: RecordingWriter,
        block: usize,
        bands: Receiver<Filled>,
        emptied: &SyncSender<Vec<f64>>,
    ) -> Result<RecordingWriter> {
        let probability = &self.reader.header().probability;
        for filled in bands {
            let Filled {
                points,
                values,
                point_values,
            } = filled;
            writer.write_band(&Band {
                first_point: points.start,
                block,
                times: &self.times,
                probability: &probability[points.start as usize..points.end as usize],
                values: &values,
                point_values: &point_values,
            })?;
            // Never wait for the other side to take the memory back: at the end it does not.
            let _ = emptied.try_send(values);
        }
        Ok(writer)
    }

    /// One block: `[time][quantity][point]` of its points, and their values `[value][point]` at the end.
    fn step(&self, batch: &ReadBatch, values: &mut [f64], a_point: &mut [f64]) -> Result<()> {
        let (excitation, samples): (&[f64], usize) = match self.component {
            Some(component) => (
                &batch.irregularity[component],
                self.reader.header().positions,
            ),
            None => (&[], 0),
        };
        let points = Points {
            excitation,
            samples,
            parameters: &batch.parameters,
            range: 0..batch.count,
        };
        let outcomes: Vec<Result<(), (usize, Divergence)>> =
            Strip::cut_both(values, a_point, batch.count, self.system.group())
                .into_par_iter()
                .enumerate()
                .map_init(
                    || (self.system.stepper(), Vec::new()),
                    |(stepper, scratch), (number, mut strip)| {
                        if interrupt::check().is_err() {
                            return Ok(());
                        }
                        let first = number * self.system.group();
                        let group = points.part(first..first + strip.width());
                        self.step_group(stepper.as_mut(), scratch, &group, &mut strip)
                    },
                )
                .collect();
        interrupt::check()?;
        for (number, outcome) in outcomes.into_iter().enumerate() {
            outcome.map_err(|(lane, divergence)| {
                let point = batch.first_point as usize + number * self.system.group() + lane;
                let explained = self.system.explain(divergence);
                Error::Numerical(format!("point {point}: {explained}"))
            })?;
        }
        Ok(())
    }

    /// A group's batches side by side in memory that the cache holds, then the whole rows at once: a
    /// block's rows lie a power of two apart, and narrow columns of them would throw each other out.
    fn step_group(
        &self,
        stepper: &mut dyn Stepper,
        scratch: &mut Vec<f64>,
        points: &Points<'_>,
        strip: &mut Strip<'_>,
    ) -> Result<(), (usize, Divergence)> {
        let width = strip.width();
        let rows = self.rows();
        scratch.resize((rows + self.point_rows()) * width, 0.0);
        let (over_time, a_point) = scratch.split_at_mut(rows * width);
        let batches = Strip::cut_both(over_time, a_point, width, self.system.lanes()).into_iter();
        for (number, mut part) in batches.enumerate() {
            let first = number * self.system.lanes();
            let lanes = points.part(first..first + part.width());
            stepper
                .run(&lanes, &mut part)
                .map_err(|divergence| (first + divergence.lane, divergence))?;
        }
        for (row, values) in scratch.chunks_exact(width).enumerate() {
            let whole = match row.checked_sub(rows) {
                None => strip.row(row),
                Some(row) => strip.point_row(row),
            };
            whole.copy_from_slice(values);
        }
        Ok(())
    }
}
