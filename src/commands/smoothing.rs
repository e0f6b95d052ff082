//! The rule of smoothing of a recording's densities, with the points that it knows.

use super::Context;
use crate::density::{
    CellKernel, KnownPoints, Smoother, Smoothing, SmoothingError, WidthRule, choose,
};
use crate::files::points::PointsReader;
use crate::files::recording::Recordings;
use crate::scenario::{Scenario, SmoothingSpec};
use crate::{BadInput, Result};
use std::path::Path;

/// The rule, prepared, the scenario with the rule that was taken, and the points' identity.
pub(super) struct Prepared {
    pub smoother: Smoother,
    pub scenario: Scenario,
    pub points: Option<String>,
}

/// Prepares the rule that the scenario asks for, or chooses one, and says which and why.
pub(super) fn prepare(
    context: &Context,
    recordings: &Recordings,
    mut scenario: Scenario,
    spec: SmoothingSpec,
    path: Option<&Path>,
) -> Result<Prepared> {
    let points = match path {
        Some(path) => Some(read(recordings, path)?),
        None => None,
    };
    let known = points.as_ref().map(|points| &points.known);
    let smoothing = match spec.build() {
        Some(smoothing) => smoothing,
        None => {
            let choice = choose(known);
            let more = match path {
                None => " (--points tells them)",
                Some(_) => "",
            };
            context.note(format!(
                "smoothing by {}: {}{more}",
                choice.smoothing.name(),
                choice.reason
            ));
            scenario = scenario.set(&[in_scenario(choice.smoothing)])?;
            choice.smoothing
        }
    };
    let smoother = Smoother::new(smoothing, known)
        .map_err(|error| refused(&scenario, smoothing, path, error))?;
    let used = points.filter(|_| smoothing.needs_variables());
    Ok(Prepared {
        smoother,
        scenario,
        points: used.map(|points| points.identity),
    })
}

/// A rule as an override of the scenario.
fn in_scenario(smoothing: Smoothing) -> String {
    let name = smoothing.name();
    let parameter = match smoothing {
        Smoothing::Width(WidthRule::Factor(factor)) => format!(", factor = {factor:?}"),
        Smoothing::Width(WidthRule::Fixed(width)) => format!(", width = {width:?}"),
        Smoothing::CellImage(CellKernel::Gaussian) => ", kernel = \"gaussian\"".to_owned(),
        Smoothing::Width(
            WidthRule::Silverman | WidthRule::NormalReference | WidthRule::SheatherJones,
        )
        | Smoothing::VarianceCorrected
        | Smoothing::Adaptive
        | Smoothing::CellImage(CellKernel::Quadratic)
        | Smoothing::ControlVariate => String::new(),
    };
    format!("density.smoothing={{ rule = \"{name}\"{parameter} }}")
}

fn refused(
    scenario: &Scenario,
    smoothing: Smoothing,
    path: Option<&Path>,
    error: SmoothingError,
) -> BadInput {
    let rule = smoothing.name();
    let Some(path) = path else {
        let expected = "the points file that was simulated (--points)";
        let found = format!("rule = \"{rule}\" without it");
        return scenario
            .bad("density.smoothing.rule", expected, found)
            .remedy("name it, or take a rule that does without");
    };
    let (at, expected) = match error {
        SmoothingError::Unknown => ("variables", "the points' own variables, a column of lists"),
        SmoothingError::Incomplete { .. } => ("variables", "all variables of the points"),
        SmoothingError::NumberUnknown => (
            "dimensions",
            "the number of the points' variables among the file's metadata",
        ),
        SmoothingError::TooManyVariables { .. } => ("variables", "a few variables"),
        SmoothingError::TooFewPoints { .. } => ("variables", "points enough for a quadratic"),
        SmoothingError::Regression(_) => ("variables", "points that bear a regression"),
    };
    let expected = format!("{expected}, as rule = \"{rule}\" needs");
    super::bad_file(path, at, expected, error.to_string())
        .remedy("take another rule (density.smoothing)")
}

struct Points {
    known: KnownPoints,
    identity: String,
}

/// The variables of the points that were simulated.
fn read(recordings: &Recordings, path: &Path) -> Result<Points> {
    let reader = PointsReader::open(path)?;
    let header = reader.header();
    let stamp = header.provenance.as_ref();
    let identity = stamp.map(|p| p.identity.clone()).unwrap_or_default();
    for member in recordings.members() {
        let inputs = member
            .provenance
            .map(|p| p.inputs.as_slice())
            .unwrap_or(&[]);
        let other =
            |input: &&String| !input.is_empty() && !identity.is_empty() && **input != identity;
        if let Some(input) = inputs.iter().find(other) {
            return Err(super::bad_file(
                path,
                "",
                format!("the points of {}, identity {input}", member.path.display()),
                format!("identity {identity}"),
            )
            .remedy("name the points file that was simulated")
            .into());
        }
    }
    let (here, there) = (&header.probability, recordings.probability());
    if here.len() != there.len() {
        let expected = format!("{} points, as in the recording", there.len());
        return Err(super::bad_file(path, "", expected, here.len().to_string()).into());
    }
    let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-6 * b.abs();
    if let Some(row) = here.iter().zip(there).position(differs) {
        return Err(super::bad_file(
            path,
            &format!("probability: row {row}"),
            format!("{}, as in the recording", there[row]),
            here[row].to_string(),
        )
        .remedy("name the points file that was simulated")
        .into());
    }
    Ok(Points {
        known: KnownPoints {
            variables: reader.variables()?,
            count: here.len(),
            probability: here.clone(),
            dimensions: header.variables,
            all: header.dimensions,
        },
        identity,
    })
}
