//! What `dpim excite` gives the points: the irregularity of road or track, or an excitation in time.

use super::{Context, excitation};
use crate::Result;
use crate::files::tabulated;
use crate::irregularity::{
    Band, Deterministic, Grid, Irregularity, PowerSpectralDensity, RandomField, Smoothed,
    SpectralRepresentation, Tabulated, TrackComponent,
};
use crate::scenario::{
    DeterministicSpec, IrregularitySpec, PointsSpec, ProfileSpec, Scenario, Sided, SpectrumSource,
    SpectrumSpec, SpectrumTableSpec, WavenumberUnit,
};

/// What the points are given over positions or times.
pub(super) struct Source {
    /// The column; none where there is nothing.
    pub component: Option<&'static str>,
    pub irregularity: Irregularity,
}

impl Source {
    /// The irregularity or the excitation of a scenario; nothing for an oscillator that has none.
    pub fn read(context: &Context, scenario: &Scenario, points: &PointsSpec) -> Result<Self> {
        if scenario.has("excitation") {
            let spec = scenario.excitation()?;
            scenario.check_truncation(points, "excitation", spec.field)?;
            let (component, irregularity) = excitation::process(context, scenario, &spec)?;
            return Ok(Source {
                component: Some(component),
                irregularity,
            });
        }
        if scenario.has("oscillator") {
            let grid = Grid {
                start: 0.0,
                spacing: 1.0,
                count: 0,
            };
            return Ok(Source {
                component: None,
                irregularity: Irregularity::new(grid, &Deterministic::Smooth, None),
            });
        }
        let spec = scenario.irregularity()?;
        scenario.check_truncation(points, "irregularity", spec.field)?;
        Source::irregularity(context, scenario, &spec)
    }

    /// The irregularity of road or track, its files read.
    pub fn irregularity(
        context: &Context,
        scenario: &Scenario,
        spec: &IrregularitySpec,
    ) -> Result<Self> {
        let grid = scenario.irregularity_grid(spec)?;
        let field = read_field(context, scenario, spec, grid)?;
        let deterministic = match &spec.deterministic {
            Some(deterministic) => read_deterministic(context, scenario, deterministic, grid)?,
            None => Deterministic::Smooth,
        };
        let deterministic = match &spec.smoothing {
            Some(smoothing) => deterministic.smoothed(&smoothing.build(), grid),
            None => deterministic,
        };
        let component = spec.spectrum.as_ref().map(SpectrumSpec::component);
        Ok(Source {
            component: Some(match component.unwrap_or(TrackComponent::Vertical) {
                TrackComponent::Vertical => "vertical",
                TrackComponent::Alignment => "alignment",
                TrackComponent::CrossLevel => "cross_level",
                TrackComponent::Gauge => "gauge",
            }),
            irregularity: Irregularity::new(grid, &deterministic, field),
        })
    }
}

/// The random field of a scenario, where it has a spectrum.
fn read_field(
    context: &Context,
    scenario: &Scenario,
    spec: &IrregularitySpec,
    grid: Grid,
) -> Result<Option<Box<dyn RandomField>>> {
    let Some(target) = read_target(context, scenario, spec)? else {
        return Ok(None);
    };
    let spectrum = SpectralRepresentation::on(target.spectrum.as_ref(), target.band);
    let terms = spec.terms.map(|terms| terms as usize);
    scenario
        .random_field("irregularity", spec.field, terms, spectrum, grid)
        .map(Some)
}

/// The spectrum that the irregularities are made for, zero outside its band.
pub(super) struct Target {
    pub spectrum: Box<dyn PowerSpectralDensity>,
    pub band: Band,
}

/// The spectrum of a scenario where it has one: its table read where it is one, smoothed where that is asked for.
pub(super) fn read_target(
    context: &Context,
    scenario: &Scenario,
    spec: &IrregularitySpec,
) -> Result<Option<Target>> {
    let (Some(spectrum), Some(band)) = (&spec.spectrum, spec.band()) else {
        return Ok(None);
    };
    let spectrum = match spectrum.source() {
        SpectrumSource::Model(model) => model,
        SpectrumSource::Table(table) => {
            let spectrum = read_table(scenario, table)?;
            let ((least, largest), highest) = (spectrum.band(), band.max);
            if highest > largest * (1.0 + 1e-9) {
                context.note(format!(
                    "the spectrum's table covers {least:.6} to {largest:.6} rad/m; beyond it, up to {highest} rad/m, the density is zero"
                ));
            }
            Box::new(spectrum)
        }
    };
    let spectrum = match &spec.smoothing {
        Some(smoothing) => Box::new(Smoothed {
            spectrum,
            window: smoothing.build(),
        }),
        None => spectrum,
    };
    Ok(Some(Target { spectrum, band }))
}

fn read_table(scenario: &Scenario, spec: &SpectrumTableSpec) -> Result<Tabulated> {
    let path = scenario.resolve(&spec.file);
    let columns = (
        spec.wavenumber_column.as_deref(),
        spec.density_column.as_deref(),
    );
    let (wavenumbers, densities) = tabulated::read_columns(&path, columns.0, columns.1)?;
    let cycles = match spec.unit {
        WavenumberUnit::CyclePerMetre => true,
        WavenumberUnit::RadianPerMetre => false,
    };
    let one_sided = match spec.sided {
        Sided::One => true,
        Sided::Two => false,
    };
    Tabulated::new(&wavenumbers, &densities, cycles, one_sided).map_err(|error| {
        super::bad_file(
            &path,
            "",
            "a spectrum: wavenumbers that increase, densities that are not negative",
            error.to_string(),
        )
        .into()
    })
}

fn read_deterministic(
    context: &Context,
    scenario: &Scenario,
    spec: &DeterministicSpec,
    grid: Grid,
) -> Result<Deterministic> {
    match spec {
        DeterministicSpec::Smooth {} => Ok(Deterministic::Smooth),
        DeterministicSpec::Sine(sine) => Ok(Deterministic::Sine {
            amplitude: sine.amplitude,
            wavelength: sine.wavelength,
            phase: sine.phase,
        }),
        DeterministicSpec::Profile(profile) => read_profile(context, scenario, profile, grid),
    }
}

/// A measured profile; how it was resampled is said.
fn read_profile(
    context: &Context,
    scenario: &Scenario,
    spec: &ProfileSpec,
    grid: Grid,
) -> Result<Deterministic> {
    let path = scenario.resolve(&spec.file);
    let columns = (
        spec.position_column.as_deref(),
        spec.height_column.as_deref(),
    );
    let (positions, mut heights) = tabulated::read_columns(&path, columns.0, columns.1)?;
    let (first, last) = (positions[0], positions[positions.len() - 1]);
    let (start, end) = (grid.position(0), grid.position(grid.count - 1));
    let margin = 1e-9 * (1.0 + end.abs());
    if first > start + margin || last < end - margin {
        let expected = format!(
            "a profile from {start} to {end} m, as irregularity.start and irregularity.length ask"
        );
        let error = super::bad_file(&path, "", expected, format!("one from {first} to {last} m"));
        return Err(error
            .remedy("shorten irregularity.length or measure further")
            .into());
    }
    context.note(format!(
        "{}: {} positions, {:.4} m apart on average, resampled to {} m by straight lines",
        path.display(),
        positions.len(),
        (last - first) / (positions.len() - 1) as f64,
        grid.spacing
    ));
    heights.iter_mut().for_each(|h| *h *= spec.scale);
    Ok(Deterministic::Profile { positions, heights })
}
