//! `dpim study`: the error of densities over the number of points, for rules of points and of smoothing.
//!
//! Each point set goes through the stages as the user would run them, in a folder beside the output that
//! is gone at the end.

use super::{Context, density, exact, excite, simulate};
use crate::cli::{self, General, OptionalScenarioArgs, OutputArgs, ScenarioArgs};
use crate::comparison::{Tabulated, distances};
use crate::files::points::PointsReader;
use crate::files::tables::{DensitySlice, StudyRow, StudyWriter, read_density, read_moments};
use crate::files::{Kind, OutputFile, Provenance};
use crate::scenario::{DensityVariantSpec, PointsVariantSpec, ReferenceKind, Scenario, StudySpec};
use crate::{BadInput, Error, Result, interrupt};
use cpu_time::ProcessTime;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Times are the same within this part: rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn run(context: &Context, args: &cli::Study) -> Result<()> {
    let given = &args.scenario;
    super::check_distinct(&[&given.scenario], &[("--output", &args.output.output)])?;
    let scenario = given.load()?;
    let spec = scenario.study()?;
    let studied = spec.scenario.as_ref().map(|path| scenario.resolve(path));
    let (path, first) = match studied {
        Some(path) => (path, Vec::new()),
        None => (given.scenario.clone(), given.sets.clone()),
    };
    let base = ScenarioArgs {
        scenario: path,
        sets: [first, spec.set.clone()].concat(),
    };
    let title = base.load()?.title().unwrap_or_default().to_owned();
    let output = OutputFile::create(&args.output.output, !args.output.no_clobber)?;
    let stamp = Provenance::stamp(
        Kind::Study,
        Some(scenario.text()),
        None,
        &[],
        &["study".to_owned()],
    );
    let table = StudyWriter::create(output, &stamp)?;
    let folder = args.output.output.parent();
    let folder = folder.filter(|path| !path.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let work = TempDir::new_in(folder).map_err(|e| Error::io(folder, "can't write", e))?;
    let mut study = Study {
        context,
        quiet: Context {
            general: General {
                threads: None,
                quiet: true,
                verbose: false,
            },
        },
        spec: &spec,
        base,
        title,
        folder: work.path().to_owned(),
        reference: Vec::new(),
    };
    study.reference = study.reference(&scenario)?;
    study.write(&scenario, table)
}

/// The true density at a time, and its standard deviation.
struct Truth {
    slice: DensitySlice,
    deviation: f64,
}

struct Study<'a> {
    context: &'a Context,
    /// For the stages, which have nothing to say here.
    quiet: Context,
    spec: &'a StudySpec,
    base: ScenarioArgs,
    title: String,
    folder: PathBuf,
    reference: Vec<Truth>,
}

impl Study<'_> {
    fn write(&self, scenario: &Scenario, mut table: StudyWriter) -> Result<()> {
        let spec = self.spec;
        let bar = self.context.progress("study", self.work());
        let mut rows = 0;
        for points in &spec.points {
            for &count in spec.counts(points) {
                for seed in 1..=spec.seeds(points, count) {
                    interrupt::check()?;
                    let Some(results) = self.one(points, count, seed)? else {
                        break;
                    };
                    bar.inc(u64::from(count));
                    rows += results.len();
                    results.iter().try_for_each(|row| table.append(row))?;
                }
            }
        }
        bar.finish_and_clear();
        if rows == 0 {
            let expected = "a rule of points for one of the counts";
            return Err(scenario.bad("study.points", expected, "none").into());
        }
        table.finish()
    }

    /// All points of all sets.
    fn work(&self) -> u64 {
        let of = |points: &PointsVariantSpec| -> u64 {
            let counts = self.spec.counts(points).iter();
            counts
                .map(|count| u64::from(*count) * u64::from(self.spec.seeds(points, *count)))
                .sum()
        };
        self.spec.points.iter().map(of).sum()
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn output(&self, name: &str) -> OutputArgs {
        OutputArgs {
            output: self.file(name),
            no_clobber: false,
        }
    }

    fn with(&self, sets: &[String]) -> ScenarioArgs {
        ScenarioArgs {
            scenario: self.base.scenario.clone(),
            sets: [&self.base.sets, sets].concat(),
        }
    }

    /// One set of points through all rules of smoothing; `None`, and a note, where it can't be had.
    fn one(
        &self,
        points: &PointsVariantSpec,
        count: u32,
        seed: u32,
    ) -> Result<Option<Vec<StudyRow>>> {
        let start = ProcessTime::now();
        let excited = excite::run(
            &self.quiet,
            &cli::Excite {
                scenario: self.with(&points.set),
                output: self.output("points.parquet"),
                pseudo_excitation: false,
                seed: Some(u64::from(seed)),
                count: Some(count),
            },
        );
        match excited {
            Err(Error::Input(bad)) if is_not_for_it(&bad) => {
                self.context.note(format!(
                    "{} with {count} points is left out: expected {}, found {}",
                    points.name, bad.expected, bad.found
                ));
                return Ok(None);
            }
            other => other?,
        }
        self.simulate(&points.set)?;
        let before = start.elapsed().as_secs_f64();
        let count = PointsReader::open(&self.file("points.parquet"))?
            .header()
            .count;
        let densities = self.spec.density.iter().filter(|d| d.goes_with(points));
        let row = |density: &DensityVariantSpec| -> Result<StudyRow> {
            let sets = [&points.set[..], &density.set[..]].concat();
            let start = ProcessTime::now();
            self.density(&sets)?;
            let cpu_time = before + start.elapsed().as_secs_f64();
            let (l1, sigma_error) = self.errors()?;
            Ok(StudyRow {
                case: self.title.clone(),
                points: points.name.clone(),
                smoothing: density.name.clone(),
                count: f64::from(count),
                seed: f64::from(seed),
                l1,
                sigma_error,
                cpu_time,
            })
        };
        densities.map(row).collect::<Result<_>>().map(Some)
    }

    fn simulate(&self, sets: &[String]) -> Result<()> {
        simulate::run(
            &self.quiet,
            &cli::Simulate {
                scenario: self.with(sets),
                points: self.file("points.parquet"),
                output: self.output("responses.mcap"),
                range: None,
            },
        )
    }

    fn density(&self, sets: &[String]) -> Result<()> {
        let ScenarioArgs { scenario, sets } = self.with(sets);
        let smoothing = Scenario::load(&scenario, &sets)?.density()?.smoothing;
        let knows = smoothing.build().is_none_or(|s| s.needs_variables());
        density::run(
            &self.quiet,
            &cli::Density {
                scenario: OptionalScenarioArgs {
                    scenario: Some(scenario),
                    sets,
                },
                recordings: vec![self.file("responses.mcap")],
                output: self.output("density.parquet"),
                points: knows.then(|| self.file("points.parquet")),
                moments: Some(self.file("moments.parquet")),
                method: None,
            },
        )
    }

    /// L1 distance, mean over time, and relative error of the standard deviation, r.m.s. over time.
    fn errors(&self) -> Result<(f64, f64)> {
        let path = self.file("density.parquet");
        let slices = read_density(&path)?.slices;
        let moments = read_moments(&self.file("moments.parquet"))?.rows;
        let (mut l1, mut squares) = (0.0, 0.0);
        for truth in &self.reference {
            let time = truth.slice.time;
            let slice = slices
                .iter()
                .find(|s| s.quantity == self.spec.quantity && same(s.time, time))
                .ok_or_else(|| self.no_time(time))?;
            let row = moments
                .iter()
                .find(|m| m.quantity == self.spec.quantity && same(m.time, time))
                .ok_or_else(|| self.no_time(time))?;
            l1 += distances(&self.curve(slice)?, &self.curve(&truth.slice)?).l1;
            squares += (row.std / truth.deviation - 1.0).powi(2);
        }
        let times = self.reference.len() as f64;
        Ok((l1 / times, (squares / times).sqrt()))
    }

    fn no_time(&self, time: f64) -> Error {
        let place = self.base.scenario.display().to_string();
        let expected = format!("a density of {} at {time} s", self.spec.quantity);
        BadInput::new(place, "simulation", expected, "none")
            .remedy("record the times of the reference")
            .into()
    }

    fn curve<'s>(&self, slice: &'s DensitySlice) -> Result<Tabulated<'s>> {
        Tabulated::new(&slice.value, &slice.density, &slice.cumulative).map_err(|error| {
            let (quantity, time) = (&slice.quantity, slice.time);
            Error::Numerical(format!("the density of {quantity} at {time} s: {error}"))
        })
    }

    /// The densities that are held true, at the times of the study.
    fn reference(&self, scenario: &Scenario) -> Result<Vec<Truth>> {
        match self.spec.reference {
            ReferenceKind::PseudoExcitation => {
                excite::run(
                    &self.quiet,
                    &cli::Excite {
                        scenario: self.with(&[]),
                        output: self.output("points.parquet"),
                        pseudo_excitation: true,
                        seed: None,
                        count: None,
                    },
                )?;
                self.simulate(&[])?;
                self.density(&[])?;
            }
            ReferenceKind::Exact => exact::run(
                &self.quiet,
                &cli::Exact {
                    scenario: self.with(&[]),
                    output: self.output("density.parquet"),
                },
            )?,
        }
        let slices = read_density(&self.file("density.parquet"))?.slices;
        let moments = match self.spec.reference {
            ReferenceKind::PseudoExcitation => read_moments(&self.file("moments.parquet"))?.rows,
            ReferenceKind::Exact => Vec::new(),
        };
        let wanted = slices.into_iter().filter(|slice| {
            slice.quantity == self.spec.quantity && slice.time >= self.spec.start - ROUNDING
        });
        let truth = |slice: DensitySlice| {
            let is_its =
                |quantity: &str, time| quantity == slice.quantity && same(time, slice.time);
            let row = moments.iter().find(|m| is_its(&m.quantity, m.time));
            let deviation = match row {
                Some(row) => row.std,
                None => self.curve(&slice)?.mean_and_deviation().1,
            };
            Ok(Truth { slice, deviation })
        };
        let reference: Vec<Truth> = wanted.map(truth).collect::<Result<_>>()?;
        if reference.is_empty() {
            let expected = format!(
                "a quantity of the reference with densities from study.start = {} s on",
                self.spec.start
            );
            let found = format!("{:?}", self.spec.quantity);
            return Err(scenario.bad("study.quantity", expected, found).into());
        }
        Ok(reference)
    }
}

/// Whether a rule of points does not have such a count or so many variables.
fn is_not_for_it(bad: &BadInput) -> bool {
    ["points.count", "points.rule"].contains(&bad.at.as_str())
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(1.0)
}
