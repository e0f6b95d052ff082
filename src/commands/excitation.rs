//! Where an excitation in time comes from.

use super::Context;
use crate::Result;
use crate::files::tabulated;
use crate::irregularity::{
    Deterministic, Irregularity, PowerSpectralDensity, SpectralRepresentation, Tabulated,
};
use crate::scenario::{
    ExcitationSpec, ExcitationSpectrumSpec, FrequencyTableSpec, FrequencyUnit, ModulationSpec,
    Scenario, Sided,
};

/// The process of a scenario, and the column that holds it.
pub(super) fn process(
    context: &Context,
    scenario: &Scenario,
    spec: &ExcitationSpec,
) -> Result<(&'static str, Irregularity)> {
    let grid = scenario.excitation_grid(spec)?;
    let spectrum = read_spectrum(context, scenario, spec)?;
    let band = &spec.frequency;
    let spectrum = SpectralRepresentation::new(spectrum.as_ref(), band.max, band.count as usize);
    let field = scenario.random_field("excitation", spec.field, None, spectrum, grid)?;
    let mut process = Irregularity::new(grid, &Deterministic::Smooth, Some(field));
    if let Some(modulation) = spec.modulation.as_ref().map(ModulationSpec::build) {
        process = process.modulated(|time| modulation.at(time));
    }
    Ok((spec.component.component(), process))
}

/// The spectrum of an excitation, its table read where it has one.
pub(super) fn read_spectrum(
    context: &Context,
    scenario: &Scenario,
    spec: &ExcitationSpec,
) -> Result<Box<dyn PowerSpectralDensity>> {
    match &spec.spectrum {
        ExcitationSpectrumSpec::White(white) => Ok(Box::new(white.build())),
        ExcitationSpectrumSpec::KanaiTajimi(ground) => Ok(Box::new(ground.build())),
        ExcitationSpectrumSpec::CloughPenzien(ground) => Ok(Box::new(ground.build())),
        ExcitationSpectrumSpec::Table(table) => {
            let spectrum = read_table(scenario, table)?;
            let ((least, largest), highest) = (spectrum.band(), spec.frequency.max);
            if highest > largest * (1.0 + 1e-9) {
                context.note(format!(
                    "the spectrum's table covers {least:.6} to {largest:.6} rad/s; beyond it, up to {highest} rad/s, the density is zero"
                ));
            }
            Ok(Box::new(spectrum))
        }
    }
}

fn read_table(scenario: &Scenario, spec: &FrequencyTableSpec) -> Result<Tabulated> {
    let path = scenario.resolve(&spec.file);
    let columns = (
        spec.frequency_column.as_deref(),
        spec.density_column.as_deref(),
    );
    let (frequencies, densities) = tabulated::read_columns(&path, columns.0, columns.1)?;
    let cycles = match spec.unit {
        FrequencyUnit::Hertz => true,
        FrequencyUnit::RadianPerSecond => false,
    };
    let one_sided = match spec.sided {
        Sided::One => true,
        Sided::Two => false,
    };
    Tabulated::new(&frequencies, &densities, cycles, one_sided).map_err(|error| {
        super::bad_file(
            &path,
            "",
            "a spectrum: frequencies that increase, densities that are not negative",
            error.to_string().replace("wavenumber", "frequency"),
        )
        .into()
    })
}
