//! What a recording says of filtered histories and of values a point.

use crate::files::recording::{Axis, QuantityHeader};
use crate::quantity::Quantity;
use crate::scenario::{JudgedSimulation, Scenario};
use crate::{Result, ensemble};

/// The quantities of a recording, and how they come from those that a run computes.
pub(super) struct Recorded {
    pub headers: Vec<QuantityHeader>,
    /// None where the run's quantities are recorded as they are.
    pub judgements: Option<ensemble::Judgements>,
}

/// The scenario of the run: the one that is given, unless there are filters or indices.
pub(super) fn simulated<'a>(
    scenario: &'a Scenario,
    judged: Option<&'a JudgedSimulation>,
) -> &'a Scenario {
    judged.map_or(scenario, |judged| &judged.scenario)
}

/// What is recorded of a run that computes `quantities`.
///
/// # Errors
/// An index of a quantity with a unit that it can't have.
pub(super) fn recorded(
    judged: Option<&JudgedSimulation>,
    quantities: &[Quantity],
) -> Result<Recorded> {
    let Some(judged) = judged else {
        return Ok(Recorded {
            headers: quantities.iter().map(as_computed).collect(),
            judgements: None,
        });
    };
    let judgements = judged.build(quantities)?;
    let spec = &judged.spec;
    let as_it_is = quantities[..judgements.recorded].iter().map(as_computed);
    let filtered = spec.filter.iter().zip(&judgements.filtered);
    let filtered = filtered.map(|(filter, built)| {
        let quantity = as_computed(&quantities[built.quantity]);
        QuantityHeader {
            name: filter.name(),
            description: format!(
                "{}; low-pass filter of {} Hz, order {} forward and backward",
                quantity.description, filter.low_pass, filter.order
            ),
            ..quantity
        }
    });
    let end = spec.duration;
    let values = spec.index.iter().zip(&judgements.values);
    let values = values.map(|(index, built)| {
        let quantity = &quantities[built.quantity];
        let (from, to) = (index.window.from, index.window.to.unwrap_or(end));
        let filter = index.low_pass;
        let filter = filter.map_or(String::new(), |cutoff| {
            format!(", after a low-pass filter of {cutoff} Hz")
        });
        QuantityHeader {
            name: index.topic(),
            unit: built.index.unit(quantity.unit()).to_owned(),
            description: format!(
                "{} of {}, {from} to {to} s{filter}",
                built.index.description(),
                quantity.name()
            ),
            symbol: built.index.symbol().to_owned(),
            axis: Axis::Point,
        }
    });
    let headers = as_it_is.chain(filtered).chain(values).collect();
    Ok(Recorded {
        headers,
        judgements: Some(judgements),
    })
}

fn as_computed(quantity: &Quantity) -> QuantityHeader {
    QuantityHeader {
        name: quantity.name(),
        unit: quantity.unit().to_owned(),
        description: quantity.description(),
        symbol: quantity.symbol(),
        axis: Axis::Time,
    }
}
