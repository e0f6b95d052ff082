//! From specs, as written, to the built values that the physics sees.

use super::{
    BridgeSpec, CellKernelKind, FieldKind, GridKind, InitialState, IntegratorKind,
    IrregularitySpec, LimitKind, PointsSpec, QuarterCarSpec, RuleKind, Scenario, SimulationSpec,
    SmoothingSpec, WidthRuleSpec,
};
use crate::density::{self, CellKernel, Smoothing, WidthRule};
use crate::integrate::Integrator;
use crate::irregularity::{
    GaussianField, Grid, KarhunenLoeve, KarhunenLoeveError, RandomField, RandomPhaseField,
    SpectralRepresentation,
};
use crate::probability::{
    GfDiscrepancy, LatinHypercube, LatinizedPartiallyStratified, MidpointGrid, MomentMatched,
    MonteCarlo, PartiallyStratified, PointRule, RankOneLattice, RuleError, Sobol,
};
use crate::quantity::{BridgeResponse, Quantity};
use crate::reliability::Side;
use crate::system::{self, Beam, BumpStop, Crossing, QuarterCar};
use crate::{BadInput, Result};

/// Positions of an irregularity, at most: rows of more would not fit in memory by the thousand.
pub(super) const MOST_POSITIONS: usize = 1_000_000;

/// Time steps of a run, at most: what all points share is kept for each of them.
const MOST_STEPS: f64 = 1e7;

impl PointsSpec {
    /// The points of `dimensions` random variables, in order of decreasing importance but for the leading
    /// `parameters`, which share no two-dimensional subspace with the others.
    ///
    /// # Errors
    /// A number of points or of variables that the rule can't have.
    pub fn build(
        &self,
        dimensions: usize,
        parameters: usize,
    ) -> Result<Box<dyn PointRule>, RuleError> {
        let rule = self.unmatched(dimensions, parameters)?;
        Ok(match self.moment_matching as usize {
            0 => rule,
            matched => Box::new(MomentMatched::new(rule, matched)?),
        })
    }

    /// The points before their moments are matched.
    pub(super) fn unmatched(
        &self,
        dimensions: usize,
        parameters: usize,
    ) -> Result<Box<dyn PointRule>, RuleError> {
        let (count, seed) = (self.count as usize, self.seed);
        Ok(match self.rule {
            RuleKind::MonteCarlo => Box::new(MonteCarlo::new(count, dimensions, seed)),
            RuleKind::LatinHypercube => Box::new(LatinHypercube::new(count, dimensions, seed)),
            RuleKind::Sobol => Box::new(Sobol::new(count, dimensions, seed)?),
            RuleKind::Lattice => Box::new(RankOneLattice::new(count, dimensions, seed)?),
            RuleKind::PartiallyStratified => Box::new(PartiallyStratified::new(
                count,
                self.truncate_at,
                dimensions,
                parameters,
                seed,
            )?),
            RuleKind::LatinizedPartiallyStratified => Box::new(LatinizedPartiallyStratified::new(
                count, dimensions, parameters, seed,
            )?),
            RuleKind::GfDiscrepancy => Box::new(GfDiscrepancy::new(count, dimensions)?),
            RuleKind::Grid => Box::new(MidpointGrid::new(count, dimensions)?),
        })
    }
}

impl BridgeSpec {
    pub fn build(&self) -> Beam {
        Beam {
            span: self.length(),
            mass_per_length: self.mass_per_length,
            flexural_rigidity: self.flexural_rigidity,
            section_modulus: self.section_modulus,
            damping_ratio: self.damping_ratio,
            modes: self.modes as usize,
            sections: self.sections(),
        }
    }
}

impl QuarterCarSpec {
    pub fn build(&self) -> QuarterCar {
        QuarterCar {
            body_mass: self.body_mass,
            wheel_mass: self.wheel_mass,
            suspension_stiffness: self.suspension_stiffness,
            suspension_damping: self.suspension_damping(),
            suspension_cubic_stiffness: self.suspension_cubic_stiffness,
            suspension_quadratic_damping: self.suspension_quadratic_damping,
            bump_stop: self.bump_stop.as_ref().map(|stop| BumpStop {
                gap: stop.gap,
                stiffness: stop.stiffness,
            }),
            tyre_stiffness: self.tyre_stiffness,
            speed: self.speed,
            approach: self.approach,
        }
    }
}

impl IntegratorKind {
    /// The scheme of a crossing; none for those that are not.
    pub fn build(self) -> Option<Integrator> {
        match self {
            IntegratorKind::ExplicitNewmark => Some(Integrator::ExplicitNewmark),
            IntegratorKind::Newmark => Some(Integrator::Newmark),
            IntegratorKind::Zhai => Some(Integrator::Zhai),
            IntegratorKind::Exponential => Some(Integrator::Exponential),
            IntegratorKind::RungeKutta => None,
        }
    }

    /// The scheme's name in a scenario.
    pub fn name(self) -> &'static str {
        self.build().map_or("runge-kutta", Integrator::name)
    }
}

impl InitialState {
    pub(super) fn build(self) -> system::InitialState {
        match self {
            InitialState::Level => system::InitialState::Level,
            InitialState::Profile => system::InitialState::Profile,
        }
    }
}

impl SmoothingSpec {
    /// The rule; none where it is to be chosen.
    pub fn build(&self) -> Option<Smoothing> {
        Some(match self {
            SmoothingSpec::Automatic => return None,
            SmoothingSpec::Silverman => Smoothing::Width(WidthRule::Silverman),
            SmoothingSpec::NormalReference => Smoothing::Width(WidthRule::NormalReference),
            SmoothingSpec::Factor(spec) => Smoothing::Width(WidthRule::Factor(spec.factor)),
            SmoothingSpec::Fixed(spec) => Smoothing::Width(WidthRule::Fixed(spec.width)),
            SmoothingSpec::SheatherJones => Smoothing::Width(WidthRule::SheatherJones),
            SmoothingSpec::VarianceCorrected => Smoothing::VarianceCorrected,
            SmoothingSpec::Adaptive => Smoothing::Adaptive,
            SmoothingSpec::CellImage(spec) => Smoothing::CellImage(match spec.kernel {
                CellKernelKind::Quadratic => CellKernel::Quadratic,
                CellKernelKind::Gaussian => CellKernel::Gaussian,
            }),
            SmoothingSpec::ControlVariate => Smoothing::ControlVariate,
        })
    }
}

impl WidthRuleSpec {
    pub fn build(&self) -> WidthRule {
        match self {
            WidthRuleSpec::Silverman => WidthRule::Silverman,
            WidthRuleSpec::NormalReference => WidthRule::NormalReference,
            WidthRuleSpec::Factor(spec) => WidthRule::Factor(spec.factor),
            WidthRuleSpec::Fixed(spec) => WidthRule::Fixed(spec.width),
            WidthRuleSpec::SheatherJones => WidthRule::SheatherJones,
        }
    }
}

impl GridKind {
    pub fn build(self) -> density::Grid {
        match self {
            GridKind::Own => density::Grid::Own,
            GridKind::Common => density::Grid::Common,
        }
    }
}

impl LimitKind {
    pub fn build(self) -> Side {
        match self {
            LimitKind::Absolute => Side::Absolute,
            LimitKind::Upper => Side::Upper,
            LimitKind::Lower => Side::Lower,
        }
    }
}

impl Scenario {
    /// The positions of the irregularity: from its start, at least over its length.
    ///
    /// # Errors
    /// Fewer than four positions: a cubic runs between them. More than a million.
    pub fn irregularity_grid(&self, spec: &IrregularitySpec) -> Result<Grid> {
        let intervals = spec.length / spec.spacing;
        // A length that is a multiple of the spacing but for rounding is one.
        let count = (intervals * (1.0 - 1e-12)).ceil() as usize + 1;
        if count < 4 {
            let found = format!(
                "{count} (length {} m, spacing {} m)",
                spec.length, spec.spacing
            );
            let error = self.bad(
                "irregularity.spacing",
                "at least four positions on the length",
                found,
            );
            return Err(error.remedy("make the spacing smaller").into());
        }
        if count > MOST_POSITIONS {
            let found = format!(
                "{count} (length {} m, spacing {} m)",
                spec.length, spec.spacing
            );
            let expected = format!("at most {MOST_POSITIONS} positions on the length");
            let error = self.bad("irregularity.spacing", expected, found);
            return Err(error.remedy("make the spacing larger").into());
        }
        Ok(Grid {
            start: self.irregularity_start(spec)?,
            spacing: spec.spacing,
            count,
        })
    }

    /// The random field of a spectrum on a grid.
    ///
    /// # Errors
    /// A Karhunen-Loeve expansion that takes too long, or of no variance.
    pub fn random_field(
        &self,
        table: &str,
        field: FieldKind,
        terms: Option<usize>,
        spectrum: SpectralRepresentation,
        grid: Grid,
    ) -> Result<Box<dyn RandomField>> {
        match field {
            FieldKind::Gaussian => Ok(Box::new(GaussianField::new(spectrum, grid))),
            FieldKind::RandomPhase => Ok(Box::new(RandomPhaseField::new(spectrum, grid))),
            FieldKind::KarhunenLoeve => match KarhunenLoeve::new(&spectrum, grid, terms) {
                Ok(field) => Ok(Box::new(field)),
                Err(error) => Err(self.no_expansion(table, error).into()),
            },
        }
    }

    fn no_expansion(&self, table: &str, error: KarhunenLoeveError) -> BadInput {
        let found = error.to_string();
        match error {
            KarhunenLoeveError::NoVariance => self.bad(
                &format!("{table}.spectrum"),
                "a density above zero somewhere in its band",
                found,
            ),
            KarhunenLoeveError::TooManyTerms { .. }
            | KarhunenLoeveError::TooManyPositions { .. } => self
                .bad(
                    &format!("{table}.field"),
                    "an expansion that takes some seconds",
                    found,
                )
                .remedy(
                    "make the length or the band smaller or the spacing larger, or take the field \"gaussian\"",
                ),
        }
    }

    /// Bridge, vehicle and simulation as one crossing, and the quantities to record.
    ///
    /// # Errors
    /// Names of quantities that the system does not have; stress without a section modulus; a time
    /// step at which the scheme is not stable.
    pub fn crossing(&self) -> Result<(Crossing, Vec<Quantity>)> {
        let simulation = self.simulation()?;
        let crossing = self.crossing_at_any_step(&simulation)?;
        let sections: Vec<String> = crossing.beam.all_sections().map(|s| s.name).collect();
        let available = Quantity::available(sections.iter().map(String::as_str));
        let modulus = crossing.beam.section_modulus;
        let quantities = self.recorded(&available, modulus, &simulation)?;
        let largest = system::largest_stable_step(&crossing);
        if largest < crossing.time_step {
            let expected = format!(
                "at most {largest} s, the largest stable step of {}",
                crossing.integrator.name()
            );
            let found = format!("{} s", crossing.time_step);
            return Err(self
                .bad("simulation.time_step", expected, found)
                .remedy("take a smaller step (simulation.record_every thins the recording), fewer modes or another integrator")
                .into());
        }
        Ok((crossing, quantities))
    }

    /// The crossing; whether its step is stable is not examined.
    ///
    /// # Errors
    /// A table that is missing or wrong; more than ten million steps.
    pub fn crossing_at_any_step(&self, simulation: &SimulationSpec) -> Result<Crossing> {
        let car = self.quarter_car()?;
        let Some(integrator) = simulation.integrator.build() else {
            let names = Integrator::ALL.map(|integrator| format!("{:?}", integrator.name()));
            let expected = format!("a scheme of crossings, one of {}", names.join(", "));
            let found = format!("{:?}", simulation.integrator.name());
            return Err(self.bad("simulation.integrator", expected, found).into());
        };
        Ok(Crossing {
            beam: self.bridge()?.build(),
            car: car.build(),
            integrator,
            time_step: simulation.time_step,
            steps: self.steps(simulation)?,
            record_every: simulation.record_every as usize,
            initial_state: simulation
                .initial_state
                .unwrap_or(InitialState::Level)
                .build(),
            gravity: simulation.gravity,
        })
    }

    /// The number of steps of a run.
    pub(super) fn steps(&self, simulation: &SimulationSpec) -> Result<usize> {
        let steps = simulation.steps();
        if steps > MOST_STEPS {
            let expected = format!("at most {MOST_STEPS} steps in simulation.duration");
            let error = self.bad("simulation.time_step", expected, steps.to_string());
            return Err(error.remedy("take a larger step").into());
        }
        Ok(steps as usize)
    }

    /// The quantities to record, which are among those available.
    pub(super) fn recorded(
        &self,
        available: &[Quantity],
        section_modulus: Option<f64>,
        simulation: &SimulationSpec,
    ) -> Result<Vec<Quantity>> {
        let names: Vec<String> = available.iter().map(Quantity::name).collect();
        let mut wanted = Vec::new();
        for name in &simulation.record {
            let Some(index) = names.iter().position(|n| n == name) else {
                return Err(self
                    .unknown_quantity("simulation.record", name, &names)
                    .into());
            };
            let quantity = available[index].clone();
            let stress = matches!(
                quantity,
                Quantity::Bridge {
                    response: BridgeResponse::Stress,
                    ..
                }
            );
            if stress && section_modulus.is_none() {
                return Err(BadInput::new(
                    self.place("bridge"),
                    "bridge.section_modulus",
                    format!("a section modulus (m3), since {name} is recorded"),
                    "none",
                )
                .into());
            }
            wanted.push(quantity);
        }
        Ok(wanted)
    }
}
