//! Spectra by their closed forms; the fast sums by the direct sum; the field by its covariance.

mod karhunen_loeve;
mod spectra;
mod wheel;
mod window;

use super::*;
use crate::probability::{self, MonteCarlo, PointRule};

fn filter(form: FilterForm) -> SecondOrderFilter {
    SecondOrderFilter {
        alpha: 0.1,
        beta: 0.1,
        gamma: 1e-4,
        form,
    }
}

#[test]
fn the_target_variance_is_met() {
    for (form, exact) in [
        (FilterForm::Corrected, 0.2000e-4),
        (FilterForm::Printed, 0.219737e-4),
    ] {
        let spectrum = filter(form);
        assert!(
            (spectrum.variance() / exact - 1.0).abs() < 2e-6,
            "{form:?}: {}",
            spectrum.variance()
        );
        let field = SpectralRepresentation::new(&spectrum, 10.0, 512);
        // 1.7e-7 cm² lies beyond 10 rad/m; the midpoint rule is exact to e^(−2πα/ΔΩ).
        assert!(
            (field.variance() - spectrum.variance()).abs() < 2e-11,
            "{form:?}: {}",
            field.variance()
        );
    }
}

#[test]
fn the_corrected_form_has_its_autocorrelation() {
    let (alpha, beta, gamma) = (0.1, 0.3, 1e-4);
    let spectrum = SecondOrderFilter {
        alpha,
        beta,
        gamma,
        form: FilterForm::Corrected,
    };
    let (step, count) = (1e-3, 400_000);
    for x in [0.0f64, 1.0, 7.0, 20.0] {
        let sum: f64 = (0..count)
            .map(|k| (k as f64 + 0.5) * step)
            .map(|w| 2.0 * spectrum.density(w) * (w * x).cos() * step)
            .sum();
        let exact = 2.0
            * beta
            * gamma
            * (-alpha * x).exp()
            * ((beta * x).cos() + alpha / beta * (beta * x).sin());
        assert!((sum - exact).abs() < 1e-10, "{x}: {sum} {exact}");
    }
}

#[test]
fn a_table_of_any_convention_is_the_same_spectrum() {
    let spectrum = filter(FilterForm::Corrected);
    let wavenumbers: Vec<f64> = (1..400).map(|k| k as f64 * 0.025).collect();
    let two: Vec<f64> = wavenumbers.iter().map(|w| spectrum.density(*w)).collect();
    let cycles: Vec<f64> = wavenumbers
        .iter()
        .map(|w| w / std::f64::consts::TAU)
        .collect();
    let one: Vec<f64> = two
        .iter()
        .map(|s| 2.0 * s * std::f64::consts::TAU)
        .collect();
    let a = Tabulated::new(&wavenumbers, &two, false, false).unwrap();
    let b = Tabulated::new(&cycles, &one, true, true).unwrap();
    for w in [0.03, 0.1, 0.777, 5.0, 9.9] {
        assert!((a.density(w) / b.density(w) - 1.0).abs() < 1e-12);
        assert!(
            (a.density(w) / spectrum.density(w) - 1.0).abs() < 5e-3,
            "{w}"
        );
    }
    assert_eq!(a.density(0.01), 0.0);
    assert_eq!(a.density(10.1), 0.0);
    let falling = Tabulated::new(&[1.0, 2.0, 2.0], &[1.0; 3], false, false);
    assert_eq!(
        falling.unwrap_err().to_string(),
        "row 3: the wavenumber 2 does not exceed the one before, 2"
    );
}

fn direct(
    field: &SpectralRepresentation,
    x: f64,
    coefficients: &[f64],
    points: usize,
    point: usize,
) -> f64 {
    field
        .amplitudes()
        .iter()
        .enumerate()
        .map(|(k, a)| {
            let phase = field.wavenumber(k) * x;
            let place = field.order().iter().position(|index| *index == k).unwrap();
            let (c, s) = (
                coefficients[2 * place * points + point],
                coefficients[(2 * place + 1) * points + point],
            );
            a * (c * phase.cos() + s * phase.sin())
        })
        .sum()
}

#[test]
fn fast_sums_are_the_direct_sum() {
    let spectrum = filter(FilterForm::Corrected);
    for (count, grid) in [
        (
            512,
            Grid {
                start: 0.0,
                spacing: 0.05,
                count: 801,
            },
        ),
        (
            512,
            Grid {
                start: 0.0,
                spacing: 0.2,
                count: 200,
            },
        ),
        (
            37,
            Grid {
                start: -12.3,
                spacing: 0.31,
                count: 78,
            },
        ),
        (
            1,
            Grid {
                start: 3.0,
                spacing: 0.1,
                count: 4,
            },
        ),
    ] {
        let field = SpectralRepresentation::new(&spectrum, 10.0, count);
        let points = 67;
        let rule = MonteCarlo::new(points, 2 * count, 5);
        let mut coefficients = vec![0.0; 2 * count * points];
        rule.standard_normals(0..points, &mut coefficients);
        let band = Band {
            min: 0.37,
            max: 9.0,
            count,
        };
        let above_zero = SpectralRepresentation::on(&spectrum, band);
        let methods = [Method::MatrixProduct, Method::ChirpTransform];
        for (field, method) in [&field, &above_zero]
            .into_iter()
            .flat_map(|field| methods.map(|method| (field, method)))
        {
            let mut out = vec![0.0; points * grid.count];
            Synthesis::by(method, field, grid).add(&coefficients, points, &mut out);
            for (point, j) in [
                (0, 0),
                (1, grid.count - 1),
                (66, grid.count / 2),
                (64, 1),
                (13, 3),
            ] {
                let exact = direct(field, grid.position(j), &coefficients, points, point);
                let got = out[point * grid.count + j];
                assert!(
                    (got - exact).abs() < 1e-15 * (count as f64).sqrt(),
                    "{method:?} {point} {j}: {got} {exact}"
                );
            }
        }
    }
}

#[test]
fn a_random_phase_field_is_its_sum_of_waves() {
    let field = SpectralRepresentation::new(&filter(FilterForm::Corrected), 10.0, 40);
    let grid = Grid {
        start: -3.0,
        spacing: 0.25,
        count: 33,
    };
    let points = 5;
    let waves = RandomPhaseField::new(field.clone(), grid);
    assert_eq!((waves.dimensions(), waves.is_linear()), (40, false));
    let mut variables = vec![0.0; 40 * points];
    MonteCarlo::new(points, 40, 5).standard_normals(0..points, &mut variables);
    let mut rows = vec![0.0; points * grid.count];
    waves.add(&variables, points, &mut rows);
    for (point, j) in [(0, 0), (4, 32), (2, 16)] {
        let waves = field.order().iter().enumerate().map(|(d, k)| {
            let phase =
                std::f64::consts::TAU * probability::cumulative(variables[d * points + point]);
            let angle = field.wavenumber(*k) * grid.position(j) + phase;
            2f64.sqrt() * field.amplitudes()[*k] * angle.cos()
        });
        let exact: f64 = waves.sum();
        assert!((rows[point * grid.count + j] - exact).abs() < 1e-15 * 40f64.sqrt());
    }
}

/// What each variable of a linear field adds: `[dimension][position]`.
fn functions(field: &dyn RandomField, grid: Grid) -> Vec<f64> {
    let dimensions = field.dimensions();
    let mut variables = vec![0.0; dimensions * dimensions];
    (0..dimensions).for_each(|d| variables[d * (dimensions + 1)] = 1.0);
    let mut rows = vec![0.0; dimensions * grid.count];
    field.add(&variables, dimensions, &mut rows);
    rows
}

#[test]
fn the_first_variables_carry_the_most() {
    let grid = Grid {
        start: 0.0,
        spacing: 0.25,
        count: 161,
    };
    // The largest amplitude is not the first one here.
    let peak = SecondOrderFilter {
        alpha: 0.05,
        beta: 0.8,
        gamma: 1e-4,
        form: FilterForm::Corrected,
    };
    let field = SpectralRepresentation::new(&peak, 4.0, 64);
    assert!(field.order()[0] > 5);
    let rows = functions(&GaussianField::new(field.clone(), grid), grid);
    let mut before = f64::INFINITY;
    for (pair, k) in rows.chunks_exact(2 * grid.count).zip(field.order()) {
        let (amplitude, wavenumber) = (field.amplitudes()[*k], field.wavenumber(*k));
        assert!(amplitude <= before);
        before = amplitude;
        for j in [0, 80, 160] {
            let (sin, cos) = (wavenumber * grid.position(j)).sin_cos();
            assert!((pair[j] - amplitude * cos).abs() < 1e-15);
            assert!((pair[grid.count + j] - amplitude * sin).abs() < 1e-15);
        }
    }
    // Equal amplitudes keep the order of their wavenumbers.
    let flat = Tabulated::new(&[0.0, 10.0], &[1.0, 1.0], false, false).unwrap();
    let field = SpectralRepresentation::new(&flat, 10.0, 30);
    assert!(field.order().iter().copied().eq(0..30));
}

/// The fields of a family on one grid.
fn fields(grid: Grid) -> [Box<dyn RandomField>; 3] {
    let spectrum = SpectralRepresentation::new(&filter(FilterForm::Corrected), 10.0, 64);
    [
        Box::new(GaussianField::new(spectrum.clone(), grid)),
        Box::new(RandomPhaseField::new(spectrum.clone(), grid)),
        Box::new(KarhunenLoeve::new(&spectrum, grid, None).unwrap()),
    ]
}

#[test]
fn a_point_does_not_depend_on_its_group() {
    let grid = Grid {
        start: 0.0,
        spacing: 0.2,
        count: 51,
    };
    for field in fields(grid) {
        let name = field.describe();
        let rule = MonteCarlo::new(300, field.dimensions(), 5);
        let sine = Deterministic::Sine {
            amplitude: 1e-3,
            wavelength: 4.0,
            phase: 0.0,
        };
        let irregularity = Irregularity::new(grid, &sine, Some(field));
        let rows = |range: std::ops::Range<usize>| {
            let mut variables = vec![0.0; irregularity.dimensions() * range.len()];
            rule.standard_normals(range.clone(), &mut variables);
            let mut out = vec![7.0; range.len() * grid.count];
            irregularity.fill(&variables, range.len(), &mut out);
            out
        };
        let whole = rows(0..300);
        assert_eq!(rows(117..240), whole[117 * 51..240 * 51], "{name}");
        assert_eq!(rows(299..300), whole[299 * 51..], "{name}");
    }
}

#[test]
fn deterministic_profiles() {
    let profile = Deterministic::Profile {
        positions: vec![0.0, 1.0, 3.0],
        heights: vec![0.0, 2.0, -2.0],
    };
    for (x, y) in [
        (-1.0, 0.0),
        (0.5, 1.0),
        (2.0, 0.0),
        (3.0, -2.0),
        (9.0, -2.0),
    ] {
        assert!((profile.height(x) - y).abs() < 1e-15);
    }
    let sine = Deterministic::Sine {
        amplitude: 2.0,
        wavelength: 4.0,
        phase: 0.0,
    };
    assert!((sine.height(1.0) - 2.0).abs() < 1e-15);
}
