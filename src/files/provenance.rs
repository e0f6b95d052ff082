//! Where a file comes from: the stamp that each of our files carries.
//!
//! The identity of a file is the hexadecimal form of the first 16 bytes of SHA-256 over everything
//! that determines its content: kind, format version, tool version, scenario text, seed, the identities
//! of its inputs and whatever further options the stage names. A mix-up is seen by comparing
//! identities, without hashing gigabytes. Files of other programs have no stamp.

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};

use crate::{BadInput, Result};

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Representative points and their irregularity.
    Points,
    /// Responses of all points over time.
    Recording,
    /// Probability densities over time.
    Density,
    /// Moments and quantiles over time.
    Moments,
    /// Reliability over time.
    Reliability,
    /// Densities of the extreme values.
    Extremes,
    /// Distances between two tables of densities.
    Comparison,
    /// Errors over the number of points.
    Study,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 8] = [
        Kind::Points,
        Kind::Recording,
        Kind::Density,
        Kind::Moments,
        Kind::Reliability,
        Kind::Extremes,
        Kind::Comparison,
        Kind::Study,
    ];

    /// The kind's name in the files.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Points => "points",
            Kind::Recording => "recording",
            Kind::Density => "density",
            Kind::Moments => "moments",
            Kind::Reliability => "reliability",
            Kind::Extremes => "extremes",
            Kind::Comparison => "comparison",
            Kind::Study => "study",
        }
    }

    /// The version of the kind's format that this program reads and writes.
    pub fn format_version(self) -> u32 {
        match self {
            Kind::Points
            | Kind::Recording
            | Kind::Density
            | Kind::Moments
            | Kind::Reliability
            | Kind::Extremes
            | Kind::Comparison
            | Kind::Study => 1,
        }
    }

    fn from_name(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// The stamp of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// What the file is.
    pub kind: Kind,
    /// The version of the program that wrote it.
    pub tool_version: String,
    /// The whole text of the scenario.
    pub scenario: Option<String>,
    /// The seed of the random numbers.
    pub seed: Option<u64>,
    /// Identifies the file's content; see the module.
    pub identity: String,
    /// The identities of the files it was made from; empty text for one that has none.
    pub inputs: Vec<String>,
}

impl Provenance {
    /// Stamps a file that this program is about to write.
    ///
    /// `options` are further settings that determine the content (`--points`, `--set`), as text.
    pub fn stamp(
        kind: Kind,
        scenario: Option<&str>,
        seed: Option<u64>,
        inputs: &[String],
        options: &[String],
    ) -> Provenance {
        let tool_version = env!("CARGO_PKG_VERSION");
        let mut hasher = Sha256::new();
        // Each text is preceded by its length, each list by its number of texts: no two contents agree.
        let mut text = |text: &str| {
            hasher.update((text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        };
        text(kind.name());
        text(&kind.format_version().to_string());
        text(tool_version);
        text(&scenario.map_or(String::new(), |scenario| format!("scenario {scenario}")));
        text(&seed.map_or(String::new(), |seed| seed.to_string()));
        for list in [inputs, options] {
            text(&list.len().to_string());
            list.iter().for_each(|item| text(item));
        }
        let identity = hasher.finalize()[..16]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect();
        Provenance {
            kind,
            tool_version: tool_version.to_owned(),
            scenario: scenario.map(str::to_owned),
            seed,
            identity,
            inputs: inputs.to_owned(),
        }
    }

    /// The stamp as keys and values, in a fixed order. `scenario` is left out where there is none.
    pub fn to_pairs(&self) -> Vec<(&'static str, String)> {
        let mut pairs = vec![
            ("kind", self.kind.name().to_owned()),
            ("format_version", self.kind.format_version().to_string()),
            ("tool_version", self.tool_version.clone()),
            ("identity", self.identity.clone()),
            ("inputs", serde_json::json!(self.inputs).to_string()),
        ];
        if let Some(seed) = self.seed {
            pairs.push(("seed", seed.to_string()));
        }
        if let Some(scenario) = &self.scenario {
            pairs.push(("scenario", scenario.clone()));
        }
        pairs
    }

    /// Reads the stamp of the file `place` from its keys and values; `None` for a file without one.
    ///
    /// # Errors
    /// Names a kind that is unknown or not among `expected`, and a version that is not ours.
    pub fn from_pairs(
        place: &str,
        pairs: &BTreeMap<String, String>,
        expected: &[Kind],
    ) -> Result<Option<Provenance>> {
        let get = |key: &str| pairs.get(key).map(String::as_str);
        let Some(name) = get("kind") else {
            return Ok(None);
        };
        let kind = expected_kind(place, name, expected)?;
        let version = get("format_version").unwrap_or("none");
        if version != kind.format_version().to_string() {
            return Err(BadInput::new(
                place,
                "format_version",
                format!(
                    "version {} of kind `{}`",
                    kind.format_version(),
                    kind.name()
                ),
                format!(
                    "version {version}, written by dpim {}",
                    get("tool_version").unwrap_or("unknown")
                ),
            )
            .remedy("read it with a dpim of that version, or write it anew with this one")
            .into());
        }
        let text = |key: &str| get(key).unwrap_or_default().to_owned();
        Ok(Some(Provenance {
            kind,
            tool_version: text("tool_version"),
            scenario: get("scenario").map(str::to_owned),
            seed: parsed(place, "seed", get("seed"), |s| s.parse().ok())?,
            identity: text("identity"),
            inputs: parsed(place, "inputs", get("inputs"), |s| {
                serde_json::from_str(s).ok()
            })?
            .unwrap_or_default(),
        }))
    }
}

/// The kind called `name`, which must be one of `expected`.
fn expected_kind(place: &str, name: &str, expected: &[Kind]) -> Result<Kind> {
    if let Some(kind) = Kind::from_name(name)
        && expected.contains(&kind)
    {
        return Ok(kind);
    }
    let wanted: Vec<String> = expected
        .iter()
        .map(|kind| format!("`{}`", kind.name()))
        .collect();
    let found = match Kind::from_name(name) {
        Some(_) => format!("a file of kind `{name}`"),
        None => format!("a file of the unknown kind `{name}`"),
    };
    let wanted = format!("a file of kind {}", wanted.join(" or "));
    Err(BadInput::new(place, "", wanted, found).into())
}

fn parsed<T>(
    place: &str,
    key: &str,
    value: Option<&str>,
    parse: impl Fn(&str) -> Option<T>,
) -> Result<Option<T>> {
    let Some(value) = value else { return Ok(None) };
    match parse(value) {
        Some(parsed) => Ok(Some(parsed)),
        None => {
            Err(BadInput::new(place, key, "what dpim writes there", format!("`{value}`")).into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(provenance: &Provenance) -> BTreeMap<String, String> {
        provenance
            .to_pairs()
            .into_iter()
            .map(|(k, v)| (k.to_owned(), v))
            .collect()
    }

    fn texts(texts: &[&str]) -> Vec<String> {
        texts.iter().map(|t| t.to_string()).collect()
    }

    #[test]
    fn round_trip() {
        for kind in Kind::ALL {
            for (scenario, seed) in [(None, None), (Some("a = 1\n"), Some(u64::MAX))] {
                let stamp = Provenance::stamp(kind, scenario, seed, &texts(&["ab", ""]), &[]);
                let read = Provenance::from_pairs("f", &pairs(&stamp), &Kind::ALL).unwrap();
                assert_eq!(read, Some(stamp));
            }
        }
        assert_eq!(
            Provenance::from_pairs("f", &BTreeMap::new(), &Kind::ALL).unwrap(),
            None
        );
    }

    #[test]
    fn identities_differ_wherever_the_content_may() {
        let one = |scenario, seed, inputs: &[&str], options: &[&str]| {
            Provenance::stamp(
                Kind::Density,
                scenario,
                seed,
                &texts(inputs),
                &texts(options),
            )
            .identity
        };
        let identities = [
            one(None, None, &[], &[]),
            one(Some(""), None, &[], &[]),
            one(Some("a"), None, &[], &[]),
            one(None, Some(0), &[], &[]),
            one(None, None, &["a"], &[]),
            one(None, None, &[], &["a"]),
            one(None, None, &["a", "b"], &[]),
            one(None, None, &["ab"], &[]),
            one(None, None, &["b", "a"], &[]),
        ];
        let different: std::collections::BTreeSet<_> = identities.iter().collect();
        assert_eq!(different.len(), identities.len());
        assert!(identities.iter().all(|i| i.len() == 32));
        assert_eq!(identities[4], one(None, None, &["a"], &[]));
    }

    #[test]
    fn unknown_kinds_and_versions_are_refused_by_name() {
        let mut found = pairs(&Provenance::stamp(Kind::Moments, None, None, &[], &[]));
        let message = |found: &BTreeMap<String, String>| {
            Provenance::from_pairs("f", found, &[Kind::Density, Kind::Extremes])
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            message(&found),
            "f: expected a file of kind `density` or `extremes`, found a file of kind `moments`"
        );
        found.insert("kind".into(), "weather".into());
        assert!(message(&found).ends_with("found a file of the unknown kind `weather`"));
        found.insert("kind".into(), "density".into());
        found.insert("format_version".into(), "9".into());
        assert!(message(&found).contains("expected version 1 of kind `density`, found version 9"));
        found.insert("format_version".into(), "1".into());
        found.insert("seed".into(), "-1".into());
        assert!(message(&found).contains("seed"));
    }
}
