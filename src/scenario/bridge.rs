//! The table `[bridge]`: a simply supported beam, or spans in a row for trains, and its named sections.

use std::collections::HashSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::BadInput;
use crate::system::Section;
use crate::system::train::{Bearings, Deck, DeckDamping, Spans};

/// A simply supported Euler-Bernoulli beam in its first modes; for trains also several spans.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BridgeSpec {
    /// Distance between the supports (m). For trains either this or `spans`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub span: Option<f64>,
    /// Lengths of spans in a row (m). For trains only; either this or `span`.
    #[schemars(length(min = 1, max = 1000))]
    pub spans: Option<Vec<SpanSpec>>,
    /// How spans are joined, for trains only; by default `simple`.
    pub kind: Option<SpansKind>,
    /// Mass of a unit of length (kg/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_per_length: f64,
    /// Flexural rigidity: modulus of elasticity times second moment of area (N m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub flexural_rigidity: f64,
    /// Shear rigidity of Timoshenko's beam: shear coefficient times shear modulus times area (N). For trains only; by
    /// default there is no shear deformation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub shear_rigidity: Option<f64>,
    /// Section modulus, only where stress is asked for (m3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub section_modulus: Option<f64>,
    /// Damping ratio of every mode.
    #[serde(default)]
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1))]
    pub damping_ratio: f64,
    /// What has the damping ratio, for trains only; by default `modal`.
    pub damping: Option<DeckDampingKind>,
    /// Elastic bearings at both ends of each span, for trains only; by default they are rigid.
    pub bearings: Option<BearingsSpec>,
    /// Number of modes, of each span or of a whole continuous beam.
    #[schemars(range(min = 1, max = 512))]
    pub modes: u32,
    /// Named sections, besides `midspan`, the middle of the span or of the middle one.
    #[serde(default)]
    pub section: Vec<SectionSpec>,
}

/// Length of a span (m).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(extend("exclusiveMinimum" = 0))]
pub struct SpanSpec(pub f64);

/// How spans are joined.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpansKind {
    /// Each for itself, simply supported.
    #[default]
    Simple,
    /// One beam over all supports.
    Continuous,
}

/// What has the damping ratio.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeckDampingKind {
    /// Every mode.
    #[default]
    Modal,
    /// The first two modes of a span, or of a continuous beam; the others by shares of mass and stiffness.
    Rayleigh,
}

/// Spring and dashpot of the bearings at an end of a span.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BearingsSpec {
    /// Stiffness (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: f64,
    /// Damping (N s/m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
}

/// The keys that only trains know.
const OF_TRAINS: [&str; 5] = ["spans", "kind", "shear_rigidity", "damping", "bearings"];

impl BridgeSpec {
    /// The lengths of all spans (m).
    pub fn spans(&self) -> Vec<f64> {
        match &self.spans {
            Some(spans) => spans.iter().map(|span| span.0).collect(),
            None => self.span.into_iter().collect(),
        }
    }

    /// From the first end to the last (m).
    pub fn length(&self) -> f64 {
        self.spans().iter().sum()
    }

    pub(super) fn sections(&self) -> Vec<Section> {
        let sections = self.section.iter().map(|section| Section {
            name: section.name.clone(),
            position: section.position,
        });
        sections.collect()
    }

    /// The bridge under a train.
    pub fn deck(&self) -> Deck {
        Deck {
            spans: self.spans(),
            kind: match self.kind.unwrap_or_default() {
                SpansKind::Simple => Spans::Simple,
                SpansKind::Continuous => Spans::Continuous,
            },
            mass_per_length: self.mass_per_length,
            flexural_rigidity: self.flexural_rigidity,
            shear_rigidity: self.shear_rigidity,
            section_modulus: self.section_modulus,
            damping: match self.damping.unwrap_or_default() {
                DeckDampingKind::Modal => DeckDamping::Ratio(self.damping_ratio),
                DeckDampingKind::Rayleigh => DeckDamping::Rayleigh(self.damping_ratio),
            },
            modes: self.modes as usize,
            bearings: self.bearings.as_ref().map(|bearings| Bearings {
                stiffness: bearings.stiffness,
                damping: bearings.damping,
            }),
            sections: self.sections(),
        }
    }

    fn check_spans(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let is_train = scenario.is_train();
        if scenario.has("vehicle") && !is_train {
            let given = OF_TRAINS
                .into_iter()
                .find(|key| scenario.item(&format!("bridge.{key}")).is_some());
            if let Some(key) = given {
                let expected = "no such key, but with vehicle.kind = \"train\" or \"load-model\"";
                let kind = scenario.item("vehicle.kind").and_then(|kind| kind.as_str());
                let found = format!("vehicle.kind = {:?}", kind.unwrap_or_default());
                return Err(scenario.bad(&format!("bridge.{key}"), expected, found));
            }
        }
        match (self.span, &self.spans) {
            (Some(_), Some(_)) => Err(scenario.bad("bridge.spans", "either span or spans", "both")),
            (None, None) if is_train => Err(scenario
                .missing("bridge.span")
                .remedy("or give spans, for spans in a row")),
            (None, None) => Err(scenario.missing("bridge.span")),
            (Some(_), None) | (None, Some(_)) => Ok(()),
        }
    }
}

/// A named section of the bridge, whose responses can be recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionSpec {
    /// Name in the quantities `bridge/NAME/...`: lower-case letters, digits, `-` and `_`.
    #[schemars(extend("pattern" = "^[a-z0-9_-]+$"))]
    pub name: String,
    /// Distance from the bridge's first end (m).
    #[schemars(range(min = 0))]
    pub position: f64,
}

impl Table for BridgeSpec {
    const NAME: &'static str = "bridge";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        self.check_spans(scenario)?;
        let length = self.length();
        let mut names = HashSet::new();
        for (index, section) in self.section.iter().enumerate() {
            let at = |key: &str| format!("bridge.section.{index}.{key}");
            let is_allowed =
                |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
            if section.name.is_empty() || !section.name.chars().all(is_allowed) {
                return Err(scenario.bad(
                    &at("name"),
                    "a name of lower-case letters, digits, `-` and `_`",
                    format!("{:?}", section.name),
                ));
            }
            if section.name == "midspan" {
                return Err(scenario
                    .bad(&at("name"), "a name other than \"midspan\"", "\"midspan\"")
                    .remedy("that section is always there"));
            }
            if !names.insert(&section.name) {
                return Err(scenario.bad(
                    &at("name"),
                    "a name of its own for each section",
                    format!("{:?} a second time", section.name),
                ));
            }
            if section.position > length {
                return Err(scenario.bad(
                    &at("position"),
                    match self.spans {
                        None => format!("a position on the span, from 0 to {length:?} (m)"),
                        Some(_) => format!("a position on the spans, from 0 to {length:?} (m)"),
                    },
                    format!("{:?}", section.position),
                ));
            }
        }
        Ok(())
    }
}
