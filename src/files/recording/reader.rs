//! Reads recordings: any number of files with disjoint points are one ensemble.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::mpsc::sync_channel;

use super::ensemble::{check_alike, ensemble_ranges, place_of, points_total};
use super::scan::{self, Batch, Plan};
use super::survey::{self, Survey, shown};
use super::{Axis, QuantityHeader};
use crate::files::weights::check_probabilities;
use crate::files::{Provenance, Weights};
use crate::response::Block;
use crate::{BadInput, Result, interrupt};

/// Batches under way between the reading thread and the visitor.
const BATCHES: usize = 3;

/// An ensemble of recordings.
#[derive(Debug)]
pub struct Recordings {
    members: Vec<Survey>,
    quantities: Vec<QuantityHeader>,
    times: Vec<f64>,
    end_time: f64,
    weights: Weights,
    probability: Vec<f64>,
    /// The points as ranges that do not touch, ascending, each with its place in the ensemble.
    ranges: Vec<(Range<u64>, usize)>,
    points_total: u64,
    notes: Vec<String>,
}

/// One file of an ensemble.
#[derive(Debug, Clone, Copy)]
pub struct Member<'a> {
    /// Its path.
    pub path: &'a Path,
    /// Its stamp; none for a file of another program.
    pub provenance: Option<&'a Provenance>,
    /// Its points, as ranges that do not touch.
    pub points: &'a [Range<u64>],
    /// Its number of chunks.
    pub chunks: usize,
}

impl Recordings {
    /// Opens recordings as one whole ensemble, in whatever order they are named.
    ///
    /// # Errors
    /// Files that are no recordings, are damaged, or lack a block; files that do not belong together
    /// (other quantities, times, points file) or overlap; points that are missing; probabilities that
    /// are not in order.
    pub fn open(paths: &[PathBuf]) -> Result<Recordings> {
        let recordings = Recordings::open_part(paths)?;
        recordings.check_complete()?;
        let place = recordings.place();
        check_probabilities(
            &place,
            super::PROBABILITY,
            recordings.weights,
            &recordings.probability,
        )?;
        Ok(recordings)
    }

    /// Opens recordings of which others may be missing, to look into them.
    pub fn open_part(paths: &[PathBuf]) -> Result<Recordings> {
        let mut members = paths
            .iter()
            .map(|path| survey::survey(path))
            .collect::<Result<Vec<_>>>()?;
        members.sort_by_key(|member| member.ranges[0].start);
        let Some(first) = members.first() else {
            return Err(BadInput::new("the command line", "", "a recording", "none").into());
        };
        for other in &members[1..] {
            check_alike(first, other)?;
        }
        let ranges = ensemble_ranges(&members)?;
        let mut recordings = Recordings {
            quantities: first
                .quantities()
                .map(|channel| channel.header.clone())
                .collect(),
            times: first.times.clone(),
            end_time: first.end_time().unwrap_or(0.0),
            weights: first.weights.unwrap_or(Weights::Assigned),
            probability: Vec::new(),
            points_total: points_total(first).unwrap_or(ranges.last().map_or(0, |(r, _)| r.end)),
            ranges,
            notes: members.iter().flat_map(notes).collect(),
            members,
        };
        recordings.gather_probability();
        Ok(recordings)
    }

    fn gather_probability(&mut self) {
        let mut probability = vec![
            0.0;
            self.ranges
                .iter()
                .map(|(range, _)| range.end - range.start)
                .sum::<u64>() as usize
        ];
        for member in &mut self.members {
            for (first, values) in std::mem::take(&mut member.probability) {
                let at = place_of(&self.ranges, u64::from(first));
                probability[at..at + values.len()].copy_from_slice(&values);
            }
        }
        self.probability = probability;
    }

    /// The quantities, in the order of the first file.
    pub fn quantities(&self) -> &[QuantityHeader] {
        &self.quantities
    }

    /// The index of the quantity called `name` (without a leading slash).
    pub fn quantity(&self, name: &str) -> Option<usize> {
        self.quantities
            .iter()
            .position(|quantity| quantity.name == name)
    }

    /// The times, s, ascending; empty if every quantity has one value a point.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The times of a quantity, s: all times, or the end of the run alone.
    pub fn times_of(&self, quantity: usize) -> &[f64] {
        match self.quantities[quantity].axis {
            Axis::Time => &self.times,
            Axis::Point => std::slice::from_ref(&self.end_time),
        }
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.probability.len()
    }

    /// The number of points of the whole ensemble; more than [`points`](Self::points) where a part is missing.
    pub fn points_total(&self) -> u64 {
        self.points_total
    }

    /// The points' probabilities, in the ensemble's order.
    pub fn probability(&self) -> &[f64] {
        &self.probability
    }

    /// What the probabilities are.
    pub fn weights(&self) -> Weights {
        self.weights
    }

    /// The files, in the order of their first points.
    pub fn members(&self) -> impl Iterator<Item = Member<'_>> {
        self.members.iter().map(|member| Member {
            path: &member.path,
            provenance: member.provenance.as_ref(),
            points: &member.ranges,
            chunks: member.chunks.len(),
        })
    }

    /// The text of the scenario that made the recordings, if one is attached.
    pub fn scenario(&self) -> Option<&str> {
        self.members
            .iter()
            .find_map(|member| member.metadata.get("scenario"))
            .map(String::as_str)
    }

    /// What a user may want to know: topics that were left aside.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The files, as errors show them.
    pub fn place(&self) -> String {
        let names: Vec<String> = self
            .members
            .iter()
            .map(|m| m.path.display().to_string())
            .collect();
        names.join(", ")
    }

    fn check_complete(&self) -> Result<()> {
        let mut missing = Vec::new();
        let mut next = 0;
        for (range, _) in &self.ranges {
            if range.start > next {
                missing.push(next..range.start);
            }
            next = range.end;
        }
        if next < self.points_total {
            missing.push(next..self.points_total);
        }
        if missing.is_empty() {
            return Ok(());
        }
        Err(BadInput::new(
            self.place(),
            "",
            format!(
                "all {} points (counted from 0)",
                self.points_total.max(next)
            ),
            format!("none of {}", shown(&missing)),
        )
        .remedy("name the recordings of the other parts too")
        .into())
    }

    /// Streams the values of the `wanted` quantities in file order, for a block ascending in time.
    ///
    /// `visit` gets batches of about 4 MiB while the next one is read on another thread; or where there is one
    /// thread, smaller ones from it. The blocks are always the same for the same files. Every chunk's CRC has been checked and every value is finite.
    ///
    /// # Errors
    /// Names the damaged chunk, or topic, time and point of a value that is not finite; or whatever `visit` returns.
    pub fn scan(
        &self,
        wanted: &[usize],
        mut visit: impl FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        let place_of = |point: u64| place_of(&self.ranges, point);
        if rayon::current_num_threads() == 1 {
            return self.scan_alone(wanted, &place_of, &mut visit);
        }
        std::thread::scope(|scope| {
            let (full, batches) = sync_channel::<Batch>(BATCHES);
            let (emptied, spare) = sync_channel::<Batch>(BATCHES);
            for _ in 0..BATCHES {
                // The channel has room for all of them.
                let _ = emptied.send(Batch::default());
            }
            let reader = scope.spawn({
                let place_of = &place_of;
                move || -> Result<()> {
                    let Ok(mut batch) = spare.recv() else {
                        return Ok(());
                    };
                    let mut give = |batch| {
                        full.send(batch).ok()?;
                        spare.recv().ok()
                    };
                    for member in &self.members {
                        let plan = Plan {
                            survey: member,
                            wanted: self.wanted(member, wanted),
                            place_of,
                            batch_values: scan::BATCH_VALUES,
                        };
                        match scan::read(&plan, batch, &mut give)? {
                            Some(next) => batch = next,
                            None => return Ok(()),
                        }
                    }
                    if !batch.is_empty() {
                        give(batch);
                    }
                    Ok(())
                }
            });
            let mut visited = Ok(());
            for batch in &batches {
                visited = interrupt::check().and_then(|()| visit(&batch.blocks()));
                if visited.is_err() {
                    break;
                }
                // The reader has ended when it does not take the batch back.
                let _ = emptied.send(scan::emptied(batch));
            }
            drop((batches, emptied));
            let read = reader
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            visited.and(read)
        })
    }

    /// The same on this thread alone, in smaller batches.
    fn scan_alone(
        &self,
        wanted: &[usize],
        place_of: &(dyn Fn(u64) -> usize + Sync),
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        let mut batch = Batch::default();
        let mut visited = Ok(());
        for member in &self.members {
            let plan = Plan {
                survey: member,
                wanted: self.wanted(member, wanted),
                place_of,
                batch_values: scan::OWN_BATCH_VALUES,
            };
            let mut give = |batch: Batch| {
                visited = visit(&batch.blocks());
                visited.is_ok().then(|| scan::emptied(batch))
            };
            match scan::read(&plan, batch, &mut give)? {
                Some(next) => batch = next,
                None => return visited,
            }
        }
        if batch.is_empty() {
            Ok(())
        } else {
            visit(&batch.blocks())
        }
    }

    /// For each channel of a member the quantity's index, if it is wanted.
    fn wanted(&self, member: &Survey, wanted: &[usize]) -> Vec<Option<usize>> {
        let index = |name: &str| self.quantity(name).filter(|index| wanted.contains(index));
        member
            .channels
            .iter()
            .map(|channel| index(&channel.header.name))
            .collect()
    }
}

fn notes(survey: &Survey) -> Vec<String> {
    let note = |(topic, schema): &(String, String)| {
        format!(
            "{}: {topic} is ignored: it has {schema}",
            survey.path.display()
        )
    };
    survey.ignored().iter().map(note).collect()
}
