//! Random parameters: read with their tables, and drawn with the leading variables beside the irregularities.

use super::Context;
use crate::Result;
use crate::files::tabulated;
use crate::probability::distribution;
use crate::scenario::{PointsSpec, RandomParameters, RowsKind, Scenario, TableSpec};

/// Probabilities of impossible values below this are not worth a word.
const NEGLIGIBLE: f64 = 1e-12;

/// Leading variables of the irregularity that are kept for each point, unless the scenario says otherwise.
const LEADING: usize = 64;

/// The random parameters of the scenario.
pub(super) fn read(scenario: &Scenario) -> Result<RandomParameters> {
    scenario.random(|spec| read_table(scenario, spec))
}

fn read_table(scenario: &Scenario, spec: &TableSpec) -> Result<distribution::Table> {
    let path = scenario.resolve(&spec.file);
    let values = spec.value_column.as_deref();
    let table = match spec.rows {
        RowsKind::Samples => {
            distribution::Table::from_samples(&tabulated::read_column(&path, values)?)
        }
        RowsKind::Quantiles => {
            let probabilities = spec.probability_column.as_deref();
            let (p, x) = tabulated::read_columns(&path, probabilities, values)?;
            distribution::Table::from_quantiles(&p, &x)
        }
    };
    table.map_err(|error| {
        let expected = "a distribution: samples, or probabilities and values that ascend";
        super::bad_file(&path, "", expected, error.to_string()).into()
    })
}

/// What the user should know of the random parameters before any is drawn.
pub(super) fn warnings(random: &RandomParameters) -> impl Iterator<Item = String> {
    let risky = random
        .iter()
        .map(|parameter| (parameter, parameter.outside()))
        .filter(|(_, outside)| *outside > NEGLIGIBLE);
    risky.map(|(parameter, outside)| {
        format!(
            "{}: the probability is {outside:.2e} that it is not {}; a lognormal or a truncated-normal distribution \
             has no such values",
            parameter.key, parameter.range
        )
    })
}

/// The random parameters of a run and how many leading variables it keeps.
pub(super) struct Leading {
    pub random: RandomParameters,
    /// Standard normals that are kept for each point.
    pub variables: usize,
}

impl Leading {
    /// For `field` variables behind those of the random parameters.
    pub fn new(random: RandomParameters, spec: &PointsSpec, field: usize) -> Self {
        let all = random.dimensions() + field;
        let asked = spec.variables.map(|count| count as usize);
        Leading {
            variables: asked
                .unwrap_or(random.dimensions() + LEADING.min(field))
                .min(all),
            random,
        }
    }

    /// Those of the scenario; what the user should know of them is said.
    pub fn read(
        context: &Context,
        scenario: &Scenario,
        spec: &PointsSpec,
        field: usize,
    ) -> Result<Self> {
        let random = read(scenario)?;
        warnings(&random).for_each(|warning| context.note(warning));
        if let (Some(at), 1..) = (spec.truncate_at, random.dimensions()) {
            context.note(format!(
                "points.truncate_at cuts the normals of the random parameters too, at {at} standard deviations"
            ));
        }
        Ok(Leading::new(random, spec, field))
    }

    /// Keys and units, as the points file has them.
    pub fn columns(&self) -> Vec<(String, String)> {
        let parameters = self.random.iter();
        parameters
            .map(|parameter| (parameter.key.clone(), parameter.unit.clone()))
            .collect()
    }

    /// Checks the parameters of consecutive points.
    ///
    /// # Errors
    /// The first value that its key may not have, parameter by parameter.
    pub fn check(&self, first_point: usize, drawn: &Drawn) -> Result<()> {
        for (parameter, values) in self.random.iter().zip(&drawn.parameters) {
            parameter.check(first_point, values)?;
        }
        Ok(())
    }
}

/// Parameters and leading variables of consecutive points.
#[derive(Default)]
pub(super) struct Drawn {
    /// For each random parameter the points' values.
    pub parameters: Vec<Vec<f64>>,
    /// `[point][variable]`.
    pub variables: Vec<f64>,
}

impl Drawn {
    /// Room for so many points, cut into pieces of `size` points that threads fill.
    pub fn pieces<'a>(
        &'a mut self,
        leading: &'a Leading,
        points: usize,
        size: usize,
    ) -> Vec<Piece<'a>> {
        let width = leading.variables;
        self.parameters
            .resize_with(leading.random.dimensions(), Vec::new);
        self.parameters
            .iter_mut()
            .for_each(|column| column.resize(points, 0.0));
        self.variables.resize(points * width, 0.0);
        let mut columns: Vec<_> = self
            .parameters
            .iter_mut()
            .map(|column| column.chunks_mut(size))
            .collect();
        let mut rest = self.variables.as_mut_slice();
        let mut pieces = Vec::with_capacity(points.div_ceil(size));
        for first in (0..points).step_by(size) {
            let count = size.min(points - first);
            let (variables, behind) = std::mem::take(&mut rest).split_at_mut(count * width);
            rest = behind;
            pieces.push(Piece {
                leading,
                parameters: columns.iter_mut().filter_map(Iterator::next).collect(),
                variables,
                count,
            });
        }
        pieces
    }
}

/// The part of some points that one thread fills.
pub(super) struct Piece<'a> {
    leading: &'a Leading,
    parameters: Vec<&'a mut [f64]>,
    variables: &'a mut [f64],
    count: usize,
}

impl Piece<'_> {
    /// Takes what it keeps of the standard normals `[dimension][point]`; returns those behind the random
    /// parameters', which are the irregularity's.
    pub fn take(self, normals: &[f64]) -> &[f64] {
        let (count, width) = (self.count, self.leading.variables);
        for (variable, row) in normals.chunks_exact(count).take(width).enumerate() {
            let column = self.variables[variable..].iter_mut().step_by(width);
            column.zip(row).for_each(|(kept, normal)| *kept = *normal);
        }
        let random = &self.leading.random;
        let (own, behind) = normals.split_at(random.dimensions() * count);
        let mut values = vec![0.0; own.len()];
        random.values(own, &mut values);
        for (column, row) in self.parameters.into_iter().zip(values.chunks_exact(count)) {
            column.copy_from_slice(row);
        }
        behind
    }
}
