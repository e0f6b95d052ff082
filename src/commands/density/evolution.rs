//! Densities by probability density evolution.

use super::Tables;
use crate::commands::{Context, bad_file, responses::Source};
use crate::density::evolution::{Evolved, Interval, Plan, Transport, Uneven, even_step, moments};
use crate::density::{Grid, TimeDensity};
use crate::files::recording::{Axis, QuantityHeader, Recordings};
use crate::scenario::{DensitySpec, Scenario, VelocityKind};
use crate::{BadInput, Result};
use indicatif::ProgressBar;

/// Most memory that the densities of a quantity at all times may take (bytes).
const MOST_MEMORY: f64 = (1u64 << 30) as f64;
/// The mean of the density may wander by so many nodes before it is worth a word: the scheme itself stays
/// within one.
const WANDERING: f64 = 2.0;

/// What an evolution needs to know.
pub(super) struct Evolution<'a> {
    pub context: &'a Context,
    pub recordings: &'a Recordings,
    pub scenario: &'a Scenario,
    pub spec: &'a DensitySpec,
}

impl Evolution<'_> {
    /// Computes the densities of these quantities.
    pub fn run(&self, wanted: &[usize], tables: &mut Tables<'_>, bar: &ProgressBar) -> Result<()> {
        let wanted = self.over_time(wanted)?;
        let names: Vec<&str> = wanted.iter().map(|k| self.name(*k)).collect();
        let boundaries = &self.spec.evolution;
        boundaries.check_quantities(self.scenario, &names)?;
        let source = Source {
            recordings: self.recordings,
            times: self.recordings.times(),
        };
        let step = self.step()?;
        for quantity in wanted {
            let transport = Transport {
                quantity,
                velocity: self.velocity(quantity),
                safe: boundaries.safe(self.name(quantity)),
            };
            let plan = Plan::new(&source, transport, boundaries.build(), step)?;
            self.check_memory(&plan, quantity)?;
            let Some(evolved) = plan.run()? else {
                let name = self.name(quantity);
                self.context
                    .note(format!("{name}: no point moves: no density"));
                moments(&source, quantity, |result| {
                    bar.inc(1);
                    tables.append_moments(source.times[result.time], &result)
                })?;
                continue;
            };
            self.tell(&plan, transport);
            let grid = self.spec.grid.build();
            let take = |result: TimeDensity| {
                bar.inc(1);
                tables.append(source.times[result.time], &result)
            };
            self.hand_over(&evolved, &source, transport, grid, take)?;
        }
        Ok(())
    }

    fn hand_over(
        &self,
        evolved: &Evolved,
        source: &Source<'_>,
        transport: Transport,
        grid: Grid,
        take: impl FnMut(TimeDensity) -> Result<()>,
    ) -> Result<()> {
        let name = self.name(transport.quantity);
        let wandered = evolved.densities(source, transport.quantity, grid, take)?;
        if transport.safe.is_bounded() {
            let last = source.times.len() - 1;
            self.context.note(format!(
                "{name}: {:.3e} of the probability absorbed by {} s",
                1.0 - evolved.left(last),
                source.times[last]
            ));
        } else if let (Some(velocity), true) = (transport.velocity, wandered > WANDERING) {
            self.context.note(format!(
                "{name}: {} leads the mean of the density {wandered:.1} nodes away from that of the responses; \
                 record at a smaller step, or set density.evolution.velocity = \"differentiated\"",
                self.name(velocity)
            ));
        }
        Ok(())
    }

    /// Leaves out quantities with one value a point.
    ///
    /// # Errors
    /// One that the scenario names.
    fn over_time(&self, wanted: &[usize]) -> Result<Vec<usize>> {
        let (over_time, a_point): (Vec<usize>, Vec<usize>) = wanted
            .iter()
            .partition(|k| self.header(**k).axis == Axis::Time);
        if let (Some(first), true) = (a_point.first(), self.spec.quantities.is_some()) {
            let found = format!("{:?} with one value a point", self.name(*first));
            let expected = "quantities over time, since the method is density-evolution";
            return Err(self
                .scenario
                .bad("density.quantities", expected, found)
                .into());
        }
        for quantity in a_point {
            let name = self.name(quantity);
            self.context
                .note(format!("{name}: one value a point, which does not evolve"));
        }
        Ok(over_time)
    }

    /// The time between records.
    fn step(&self) -> Result<f64, BadInput> {
        let times = self.recordings.times();
        let refused = |expected: String, found: String| {
            let mut members = self.recordings.members();
            let path = members.next().map(|member| member.path);
            bad_file(path.unwrap_or("".as_ref()), "times", expected, found)
        };
        if times.len() < 2 {
            let expected = "two or more, since the method is density-evolution";
            return Err(refused(expected.to_owned(), times.len().to_string()));
        }
        even_step(times).map_err(|Uneven { step, from, to }| {
            refused(
                format!("one each {step} s, since the method is density-evolution"),
                format!("none between {from} s and {to} s"),
            )
            .remedy("record each step, or take --method direct-integral")
        })
    }

    /// The recorded velocity of a quantity, if that is wanted and there is one.
    fn velocity(&self, quantity: usize) -> Option<usize> {
        match self.spec.evolution.velocity {
            VelocityKind::Recorded => {}
            VelocityKind::Differentiated => return None,
        }
        let header = self.header(quantity);
        let velocity = self.recordings.quantity(&derivative(&header.name)?)?;
        let found = self.header(velocity);
        // A recording need not have units.
        let without_units = header.unit.is_empty() && found.unit.is_empty();
        let fits =
            found.axis == Axis::Time && (without_units || found.unit == per_second(&header.unit));
        if !fits {
            let (name, unit) = (&found.name, &found.unit);
            self.context.note(format!(
                "{name} is in {unit}: not taken for the velocity of {}",
                header.name
            ));
        }
        fits.then_some(velocity)
    }

    fn check_memory(&self, plan: &Plan<'_>, quantity: usize) -> Result<(), BadInput> {
        let bytes = plan.bytes();
        if bytes <= MOST_MEMORY {
            return Ok(());
        }
        let found = format!(
            "{:.1} GiB for the {:.0} nodes of {}",
            bytes / MOST_MEMORY,
            plan.nodes(),
            self.name(quantity)
        );
        Err(self
            .scenario
            .bad(
                "density.evolution.nodes",
                "a mesh whose densities at all times take at most 1 GiB",
                found,
            )
            .remedy("take fewer nodes, or fewer times"))
    }

    /// Where the velocity comes from, and the mesh.
    fn tell(&self, plan: &Plan<'_>, transport: Transport) {
        let velocity = match transport.velocity {
            Some(velocity) => format!("velocity recorded ({})", self.name(velocity)),
            None => "velocity differentiated from the record".to_owned(),
        };
        let spacing = plan.mesh.map_or(0.0, |mesh| mesh.spacing);
        let header = self.header(transport.quantity);
        self.context.note(format!(
            "{}: {velocity}; {:.0} nodes {spacing:.3e} {} apart over the range, {} step(s) a record at most",
            header.name,
            plan.nodes(),
            header.unit,
            plan.steps()
        ));
        let safe: Interval = transport.safe;
        if safe.is_bounded() {
            self.context.detail(format!(
                "{}: absorbing outside of {} ... {}",
                header.name, safe.least, safe.largest
            ));
        }
    }

    fn header(&self, quantity: usize) -> &QuantityHeader {
        &self.recordings.quantities()[quantity]
    }

    fn name(&self, quantity: usize) -> &str {
        &self.header(quantity).name
    }
}

/// The name of a motion's derivative.
fn derivative(name: &str) -> Option<String> {
    let (part, motion) = name.rsplit_once('/')?;
    match motion {
        "displacement" => Some(format!("{part}/velocity")),
        "velocity" => Some(format!("{part}/acceleration")),
        _ => None,
    }
}

/// The unit of a derivative in time.
fn per_second(unit: &str) -> String {
    match unit.strip_suffix("/s") {
        Some(before) => format!("{before}/s2"),
        None => format!("{unit}/s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_velocity_of_a_motion_has_its_name_and_unit() {
        let of = |name: &str| derivative(name).unwrap_or_default();
        assert_eq!(of("bridge/midspan/displacement"), "bridge/midspan/velocity");
        assert_eq!(of("vehicle/body/velocity"), "vehicle/body/acceleration");
        assert_eq!(of("vehicle/wheel/contact_force") + &of("displacement"), "");
        assert_eq!(
            (per_second("m"), per_second("m/s")),
            ("m/s".into(), "m/s2".into())
        );
    }
}
