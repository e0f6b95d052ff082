//! A simulation with filters and indices: the run that they need, and themselves.

use toml_edit::{Array, Item, value};

use super::judgement::ORDER;
use super::{FilterSpec, IndexSpec, Scenario, SimulationSpec};
use crate::Result;
use crate::ensemble::{FilteredHistory, JudgedValue, Judgements};
use crate::judgement::LowPass;
use crate::quantity::Quantity;

/// A simulation with filters or indices.
#[derive(Debug, Clone)]
pub struct JudgedSimulation {
    /// The same scenario, but the run records each step, and besides the quantities that are recorded, which
    /// come first, those that are filtered or judged.
    pub scenario: Scenario,
    /// The simulation as it is given.
    pub spec: SimulationSpec,
}

impl SimulationSpec {
    /// Quantities that are recorded, then those that are needed besides.
    fn needed(&self) -> Vec<&str> {
        let filtered = self.filter.iter().map(|filter| &filter.quantity);
        let judged = self.index.iter().map(|index| &index.quantity);
        let mut all: Vec<&str> = Vec::new();
        for name in self.record.iter().chain(filtered).chain(judged) {
            if !all.contains(&name.as_str()) {
                all.push(name);
            }
        }
        all
    }

    /// What filters and indices add to the quantities of `record`.
    pub(super) fn added(&self) -> Vec<String> {
        let filtered = self.filter.iter().map(FilterSpec::name);
        filtered
            .chain(self.index.iter().map(IndexSpec::topic))
            .collect()
    }
}

impl Scenario {
    /// The simulation with its filters and indices; none where there are none.
    pub fn judged(&self) -> Result<Option<JudgedSimulation>> {
        let spec = self.simulation()?;
        if spec.filter.is_empty() && spec.index.is_empty() {
            return Ok(None);
        }
        let mut scenario = self.clone();
        let table = scenario.effective.get_mut(Self::SIMULATION);
        if let Some(table) = table.and_then(Item::as_table_like_mut) {
            table.insert("record", value(Array::from_iter(spec.needed())));
            table.insert("record_every", value(1));
        }
        Ok(Some(JudgedSimulation { scenario, spec }))
    }

    /// The key that asks for a quantity of a run: of `simulation.record`, or of the first filter or index of it.
    pub(super) fn asking_key(&self, key: &str, quantity: &str) -> String {
        if key != "simulation.record" {
            return key.to_owned();
        }
        let Ok(spec) = self.simulation() else {
            return key.to_owned();
        };
        let filtered = spec.filter.iter().map(|filter| &filter.quantity);
        let judged = spec.index.iter().map(|index| &index.quantity);
        let lists = [
            ("filter", filtered.collect::<Vec<_>>()),
            ("index", judged.collect()),
        ];
        lists
            .into_iter()
            .find_map(|(list, names)| {
                let number = names.iter().position(|name| *name == quantity)?;
                Some(format!("simulation.{list}.{number}.quantity"))
            })
            .unwrap_or_else(|| key.to_owned())
    }

    const SIMULATION: &'static str = <SimulationSpec as super::Table>::NAME;
}

impl JudgedSimulation {
    /// The filters and indices of the run that computes `quantities`, those of its scenario.
    ///
    /// # Errors
    /// An index of a quantity with a unit that it can't have.
    pub fn build(&self, quantities: &[Quantity]) -> Result<Judgements> {
        let spec = &self.spec;
        let names: Vec<String> = quantities.iter().map(Quantity::name).collect();
        let place = |name: &String| {
            let place = names.iter().position(|known| known == name);
            place.expect("the run computes what is asked for")
        };
        let filter = |cutoff, order| LowPass::new(cutoff, order, spec.time_step);
        let mut values = Vec::new();
        for (number, index) in spec.index.iter().enumerate() {
            let quantity = place(&index.quantity);
            let built = index.build().expect("checked when it was read");
            let unit = quantities[quantity].unit();
            if let Some(needed) = built.needs_unit().filter(|needed| *needed != unit) {
                let key = format!("simulation.index.{number}.quantity");
                let kind = index.kind.name();
                let expected = format!("a quantity in {needed}, for kind = \"{kind}\"");
                let found = format!("{:?} in {unit}", index.quantity);
                return Err(self.scenario.bad(&key, expected, found).into());
            }
            values.push(JudgedValue {
                quantity,
                index: built,
                window: index.window(spec.time_step, spec.steps() as usize),
                low_pass: index.low_pass.map(|cutoff| filter(cutoff, ORDER)),
            });
        }
        let filtered = spec.filter.iter().map(|filtered| FilteredHistory {
            quantity: place(&filtered.quantity),
            filter: filter(filtered.low_pass, filtered.order),
        });
        Ok(Judgements {
            time_step: spec.time_step,
            record_every: spec.record_every as usize,
            recorded: spec.record.len(),
            filtered: filtered.collect(),
            values,
        })
    }
}
