//! The scenario: one TOML file that says what every stage does.
//!
//! Text, then overrides (`--set bridge.span=32.0`), then specs that are checked and in SI. A stage reads its own
//! tables only, so that a scenario may hold just what its stages need:
//!
//! ```
//! use dpim::scenario::Scenario;
//!
//! let text = "[density]\npoints_per_time = 512\n";
//! let scenario = Scenario::from_text("scenario.toml", text)?;
//! assert_eq!(scenario.density()?.points_per_time, 512);
//! # Ok::<(), dpim::Error>(())
//! ```
//!
//! The specs are the one source of what a scenario may hold: their doc comments, units and bounds become the JSON
//! Schema ([`json_schema`]), the schema is what a scenario is checked against, and what the error messages say.
//! A new key is a new field; a new kind is a new variant. Conditions between keys are in each table's `check`.

mod bridge;
mod build;
mod chain;
mod check;
mod density;
mod evolution;
mod exact;
mod excitation;
mod irregularity;
mod judged;
mod judgement;
mod oscillator;
mod overrides;
mod place;
mod points;
mod random;
mod reliability;
mod schema;
mod shape;
mod simulation;
mod spectrum;
mod study;
mod suggestion;
#[cfg(test)]
mod tests;
pub mod train;
mod varied;
mod vehicle;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use toml_edit::{Document, DocumentMut};

use crate::{BadInput, Error, Result};

pub use bridge::{BearingsSpec, BridgeSpec, DeckDampingKind, SectionSpec, SpanSpec, SpansKind};
pub use density::{
    CellImageSpec, CellKernelKind, DensitySpec, FactorSpec, FixedSpec, GridKind, SmoothingSpec,
    WidthRuleSpec,
};
pub use evolution::{AbsorbingSpec, EvolutionSpec, MethodKind, VelocityKind};
pub use exact::{
    AmplitudeSpec, CaseSpec, DuffingSpec, ExactSpec, FreeVibrationSpec, TimesSpec,
    UniformFrequencySpec,
};
pub use excitation::{
    CloughPenzienSpec, ExcitationSpec, ExcitationSpectrumSpec, ExponentialModulationSpec,
    FrequencySpec, FrequencyTableSpec, FrequencyUnit, JenningsSpec, KanaiTajimiSpec,
    ModulationSpec, WhiteSpec,
};
pub use irregularity::{
    ContactPatchSpec, DeterministicSpec, FieldKind, IrregularitySpec, MeanSpec, MovingAverageSpec,
    ProfileSpec, SineSpec, WavelengthSpec, WavenumberSpec,
};
pub use judged::JudgedSimulation;
pub use judgement::{DirectionKind, FilterSpec, IndexKind, IndexSpec, WeightingKind, WindowSpec};
pub use oscillator::{
    BoucWenSpec, InterpolationKind, LoadKind, OscillatorSpec, PowerLawSpec, RayleighSpec,
    StoreySpec, VanDerPolSpec,
};
pub use points::{PointsSpec, RuleKind};
pub use random::{
    BetaSpec, CorrelationKind, CorrelationSpec, DistributionSpec, ExponentialSpec, ExtremeKind,
    GammaSpec, GumbelSpec, LognormalSpec, NormalSpec, RandomParameter, RandomParameters,
    RandomSpec, RowsKind, TableSpec, TruncatedNormalSpec, UniformSpec, WeibullSpec,
};
pub use reliability::{LimitKind, LimitSpec, ReliabilitySpec};
pub use schema::{ScenarioSpec, is_key, json_schema};
pub use simulation::{
    Compression, InitialState, IntegratorKind, Precision, SimulationSpec, SolutionKind,
};
pub use spectrum::{
    ChineseBallastlessSpec, ChineseMainLineSpec, DisturbanceKind, FilterForm, FraFrybaSpec,
    FraSpec, GermanSpec, Iso8608Spec, MainLineKind, RoadClassKind, RoadLevelKind,
    SecondOrderFilterSpec, Sided, SncfQualityKind, SncfSpec, SpectrumSource, SpectrumSpec,
    SpectrumTableSpec, TrackComponentKind, WavenumberUnit,
};
pub use study::{DensityVariantSpec, PointsVariantSpec, ReferenceKind, SeedsAboveSpec, StudySpec};
pub use suggestion::nearest;
pub use train::{ContactSpec, LoadModelSpec, TrackSpec, TrainSpec};
pub use varied::VARIED_KEYS;
pub use vehicle::{BumpStopSpec, QuarterCarSpec, VehicleSpec};

/// A scenario: its text after the overrides, and where each key came from.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// The file, as errors show it.
    name: String,
    /// The text as read, which knows the line of each key.
    original: Document<String>,
    /// The same after the overrides.
    effective: DocumentMut,
    /// `effective` as text; exactly the text as read where nothing is overridden.
    text: String,
    /// The paths of the keys that came from `--set`.
    overridden: Vec<Vec<String>>,
}

/// A table of the scenario, and the conditions between its keys.
trait Table: DeserializeOwned {
    const NAME: &'static str;

    /// What the schema can't say.
    fn check(&self, scenario: &Scenario) -> Result<(), BadInput>;
}

impl Scenario {
    /// Reads the scenario in the file `path` and applies the overrides `sets`, each `key.path=value`, or `key.path=` to
    /// remove a key.
    ///
    /// # Errors
    /// A file that is not there, can't be read or is no TOML, an override that can't be applied, an unknown table.
    pub fn load(path: &Path, sets: &[String]) -> Result<Scenario> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|e| unreadable(path, e))?;
        let text = String::from_utf8(bytes)
            .map_err(|_| BadInput::new(&name, "", "UTF-8 text", "other bytes"))?;
        Scenario::parse(name, &text)?.set(sets)
    }

    /// The scenario in `text`; errors call it `name`. Paths of files in it are relative to the folder of `name`.
    ///
    /// # Errors
    /// Text that is no TOML, an unknown table.
    pub fn from_text(name: impl Into<String>, text: &str) -> Result<Scenario> {
        Scenario::parse(name.into(), text)?.set(&[])
    }

    /// Applies further overrides, each `key.path=value` or `key.path=`.
    ///
    /// # Errors
    /// An override that can't be applied, an unknown table.
    pub fn set(mut self, sets: &[String]) -> Result<Scenario> {
        for set in sets {
            let path = overrides::apply(&mut self.effective, set)?;
            self.overridden.push(path);
        }
        if !sets.is_empty() {
            self.text = self.effective.to_string();
        }
        check::top_level(&self)?;
        Ok(self)
    }

    fn parse(name: String, text: &str) -> Result<Scenario, BadInput> {
        let original =
            Document::parse(text.to_owned()).map_err(|e| place::not_toml(&name, text, &e))?;
        Ok(Scenario {
            effective: original.clone().into_mut(),
            original,
            text: text.to_owned(),
            name,
            overridden: Vec::new(),
        })
    }

    /// The effective text: the file's with the overrides in it. The output files carry it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The scenario's file, as errors show it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The title, where there is one.
    pub fn title(&self) -> Option<&str> {
        self.effective.get("title")?.as_str()
    }

    /// A file named in the scenario: relative to the scenario's folder, unless absolute.
    pub fn resolve(&self, file: &Path) -> PathBuf {
        match Path::new(&self.name).parent() {
            Some(folder) => folder.join(file),
            None => file.to_owned(),
        }
    }

    /// Whether the scenario has the table `name`.
    pub fn has(&self, name: &str) -> bool {
        self.effective.contains_key(name)
    }

    /// The table `[points]`.
    pub fn points(&self) -> Result<PointsSpec> {
        self.required()
    }

    /// The table `[irregularity]`.
    pub fn irregularity(&self) -> Result<IrregularitySpec> {
        self.required()
    }

    /// The table `[excitation]`.
    pub fn excitation(&self) -> Result<ExcitationSpec> {
        self.required()
    }

    /// The table `[oscillator]`.
    pub fn oscillator(&self) -> Result<OscillatorSpec> {
        self.required()
    }

    /// The table `[bridge]`.
    pub fn bridge(&self) -> Result<BridgeSpec> {
        self.required()
    }

    /// The table `[vehicle]`.
    pub fn vehicle(&self) -> Result<VehicleSpec> {
        self.required()
    }

    /// The table `[contact]`, where there is one.
    pub fn contact(&self) -> Result<Option<ContactSpec>> {
        self.optional()
    }

    /// The table `[track]`, where there is one.
    pub fn track(&self) -> Result<Option<TrackSpec>> {
        self.optional()
    }

    /// The table `[simulation]`.
    pub fn simulation(&self) -> Result<SimulationSpec> {
        self.required()
    }

    /// The table `[density]`; where it is missing, its defaults.
    pub fn density(&self) -> Result<DensitySpec> {
        Ok(self.optional()?.unwrap_or_default())
    }

    /// The table `[reliability]`.
    pub fn reliability(&self) -> Result<ReliabilitySpec> {
        self.required()
    }

    /// The table `[exact]`.
    pub fn exact(&self) -> Result<ExactSpec> {
        self.required()
    }

    /// The table `[study]`.
    pub fn study(&self) -> Result<StudySpec> {
        self.required()
    }

    /// Checks every table that is there, and the conditions between them.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn check_all(&self) -> Result<ScenarioSpec> {
        let all = ScenarioSpec {
            title: self.title().map(str::to_owned),
            points: self.optional()?,
            irregularity: self.optional()?,
            excitation: self.optional()?,
            oscillator: self.optional()?,
            bridge: self.optional()?,
            vehicle: self.optional()?,
            contact: self.optional()?,
            track: self.optional()?,
            random: self.optional()?,
            correlation: self.optional()?,
            simulation: self.optional()?,
            density: self.optional()?,
            reliability: self.optional()?,
            exact: self.optional()?,
            study: self.optional()?,
        };
        if let (Some(points), Some(irregularity)) = (&all.points, &all.irregularity) {
            self.check_truncation(points, "irregularity", irregularity.field)?;
        }
        if let (Some(points), Some(excitation)) = (&all.points, &all.excitation) {
            self.check_truncation(points, "excitation", excitation.field)?;
        }
        self.check_random(
            all.random.as_deref().unwrap_or_default(),
            all.correlation.as_deref().unwrap_or_default(),
        )?;
        self.check_recorded(&all)?;
        Ok(all)
    }

    fn required<T: Table>(&self) -> Result<T> {
        match self.optional()? {
            Some(table) => Ok(table),
            None => Err(self
                .missing(T::NAME)
                .remedy(format!("add a table [{}]", T::NAME))
                .into()),
        }
    }

    fn optional<T: Table>(&self) -> Result<Option<T>> {
        let Some(item) = self.effective.get(T::NAME) else {
            return Ok(None);
        };
        let item = self.with_means(T::NAME, item)?;
        let value = check::top_table(self, T::NAME, &item)?;
        // The check leaves nothing to refuse here; should it ever, the path is still in the message.
        let table: T = serde_path_to_error::deserialize(value).map_err(|e| {
            let key = format!("{}.{}", T::NAME, e.path());
            self.bad(&key, "", e.inner().to_string())
        })?;
        table.check(self)?;
        Ok(Some(table))
    }
}

/// The error of a scenario that can't be read: bad input where there is no such file.
fn unreadable(path: &Path, error: std::io::Error) -> Error {
    let found = match error.kind() {
        ErrorKind::NotFound => "no such file",
        ErrorKind::IsADirectory => "a folder",
        _ => return Error::io(path, "can't read", error),
    };
    BadInput::new(path.display().to_string(), "", "a scenario (TOML)", found).into()
}
