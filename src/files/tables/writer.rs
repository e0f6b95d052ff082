//! Writes result tables, row by row.

use std::collections::BTreeMap;

use super::long::LongTable;
use super::rows::{ComparisonRow, MomentsRow, ReliabilityRow, StudyRow};
use super::{Table, quantile_column};
use crate::Result;
use crate::files::output::OutputFile;
use crate::files::{Kind, Provenance};

/// The unit of each quantity (in tables of reliability and extremes: of each limit).
pub type Units = BTreeMap<String, String>;

fn table_of(kind: Kind) -> Table {
    Table::of(kind).expect("the kinds below are tables")
}

/// Writes a density table, or one of extremes. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct DensityWriter(LongTable);

impl DensityWriter {
    /// Starts a table; the stamp's kind says whether of densities or of extremes.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<DensityWriter> {
        let table = match provenance.kind {
            Kind::Extremes => table_of(Kind::Extremes),
            Kind::Density
            | Kind::Moments
            | Kind::Reliability
            | Kind::Comparison
            | Kind::Study
            | Kind::Points
            | Kind::Recording => table_of(Kind::Density),
        };
        LongTable::create(output, &table, units, provenance).map(DensityWriter)
    }

    /// Appends the density of `quantity` at `time` (s): nodes ascending, in the quantity's unit, with
    /// density and cumulative probability at each.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn append(
        &mut self,
        quantity: &str,
        time: f64,
        value: &[f64],
        density: &[f64],
        cumulative: &[f64],
    ) -> Result<()> {
        assert!(
            value.len() == density.len() && value.len() == cumulative.len(),
            "nodes of a density"
        );
        self.0
            .push_many(&[quantity], &[time], &[value, density, cumulative])
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a table of moments. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct MomentsWriter(LongTable);

impl MomentsWriter {
    /// Starts a table.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<MomentsWriter> {
        LongTable::create(output, &table_of(Kind::Moments), units, provenance).map(MomentsWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &MomentsRow) -> Result<()> {
        self.0.push(&[&row.quantity], &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a table of reliability. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct ReliabilityWriter(LongTable);

impl ReliabilityWriter {
    /// Starts a table; `units` has the unit of each limit's quantity.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<ReliabilityWriter> {
        LongTable::create(output, &table_of(Kind::Reliability), units, provenance)
            .map(ReliabilityWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &ReliabilityRow) -> Result<()> {
        self.0.push(&[&row.limit, &row.method], &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a comparison. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct ComparisonWriter(LongTable);

impl ComparisonWriter {
    /// Starts a table with a column for the error of each quantile in `levels`.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        levels: &[f64],
        units: &Units,
        provenance: &Provenance,
    ) -> Result<ComparisonWriter> {
        let quantiles: Vec<String> = levels.iter().map(|level| quantile_column(*level)).collect();
        let table = table_of(Kind::Comparison);
        LongTable::create_with(output, &table, &quantiles, units, provenance).map(ComparisonWriter)
    }

    /// Appends a row.
    ///
    /// # Panics
    /// If it has another number of quantiles.
    pub fn append(&mut self, row: &ComparisonRow) -> Result<()> {
        let numbers = row.numbers();
        self.0.push(&[&row.quantity], &numbers)
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a study. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct StudyWriter(LongTable);

impl StudyWriter {
    /// Starts a table.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(output: OutputFile, provenance: &Provenance) -> Result<StudyWriter> {
        let table = table_of(Kind::Study);
        LongTable::create(output, &table, &Units::new(), provenance).map(StudyWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &StudyRow) -> Result<()> {
        let texts = [&*row.case, &*row.points, &*row.smoothing];
        self.0.push(&texts, &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}
