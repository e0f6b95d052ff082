//! Exact densities of linear systems from harmonics in place of representative points.

use crate::accuracy::{EXACT, folder, row};
use crate::foreign::Points;
use crate::harness::Folder;
use dpim::files::tables::{MomentsRow, read_density, read_moments};
use dpim::irregularity::{FilterForm, PowerSpectralDensity, SecondOrderFilter};
use dpim::probability;

/// The moments by pseudo-excitation after these overrides.
fn moments(folder: &Folder, options: &str) -> Vec<MomentsRow> {
    for line in [
        "excite --pseudo-excitation -s scenario.toml -o points.parquet",
        "simulate -s scenario.toml points.parquet -o responses.mcap",
        "density responses.mcap -o density.parquet --moments moments.parquet",
    ] {
        folder.done(&format!("{line} {options}"));
    }
    read_moments(&folder.path("moments.parquet")).unwrap().rows
}

fn assert_same(one: &[MomentsRow], other: &[MomentsRow], tolerance: f64) {
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(other) {
        assert_eq!((&a.quantity, a.time), (&b.quantity, b.time));
        let scale = a.std.max(b.std);
        for (x, y) in [(a.mean, b.mean), (a.std, b.std)] {
            assert!((x - y).abs() <= tolerance * scale, "{a:?} {b:?}");
        }
    }
}

#[test]
fn the_papers_standard_deviations() {
    let folder = folder();
    let options = "--set simulation.integrator=exponential --set simulation.time_step=2e-4 --set simulation.record_every=500";
    let spectral = moments(&folder, options);
    folder
        .done("inspect points.parquet")
        .says(&["1025 points, a pseudo-excitation: point 0 without, all others with one harmonic"]);
    let expansion = moments(
        &folder,
        &format!("{options} --set irregularity.field=karhunen-loeve"),
    );
    for (quantity, time, mean, deviation) in EXACT {
        for rows in [&spectral, &expansion] {
            let row = row(rows, quantity, time);
            let off = row.std / deviation - 1.0;
            println!(
                "{quantity} at {time} s: {:.7e}, off by {off:.1e}, {:.0} harmonics",
                row.std, row.effective_count
            );
            assert!(off.abs() < 1e-4, "{quantity} at {time} s: {}", row.std);
            assert!((row.mean - mean).abs() < 1e-2 * deviation, "{row:?}");
            assert_eq!(
                (row.skewness, row.kurtosis, row.smoothing_width),
                (0.0, 3.0, 0.0)
            );
        }
    }
    // Two expansions of one field: responses of the same law.
    assert_same(&spectral, &expansion, 1e-7);
}

#[test]
fn few_terms_carry_nearly_all_of_the_response() {
    let folder = folder();
    let variances = |terms: u32| -> Vec<(String, f64)> {
        let options = format!(
            "--set irregularity.field=karhunen-loeve --set irregularity.terms={terms} --set simulation.record_every=10"
        );
        let rows = moments(&folder, &options);
        let late = rows.into_iter().filter(|row| row.time > 0.29);
        late.map(|row| (row.quantity, row.std * row.std)).collect()
    };
    let whole = variances(1000);
    // Measured: 1.5e-4 and 1.9e-3 with 20 terms, 1e-6 and 6.1e-6 with 50.
    for (terms, displacement, acceleration) in [(20, 3e-4, 4e-3), (50, 4e-6, 2e-5)] {
        let part = variances(terms);
        for (quantity, allowed) in [
            ("bridge/midspan/displacement", displacement),
            ("vehicle/body/acceleration", acceleration),
        ] {
            let pairs = whole.iter().zip(&part);
            let of_quantity = pairs.filter(|(whole, _)| whole.0 == quantity);
            let lost = of_quantity.map(|(whole, part)| 1.0 - part.1 / whole.1);
            let most = lost.fold(0.0, f64::max);
            println!("{quantity}: {terms} terms lose {most:.1e} of the variance at most");
            assert!(most < allowed, "{quantity}: {terms} terms lose {most}");
        }
    }
}

#[test]
fn the_densities_are_normal() {
    let folder = Folder::new();
    let rows = moments(&folder, "--set density.points_per_time=2001");
    let table = read_density(&folder.path("density.parquet")).unwrap();
    assert!(table.slices.len() >= 2 * 198);
    for slice in &table.slices {
        let row = row(&rows, &slice.quantity, slice.time);
        assert_eq!(slice.value.len(), 2001);
        for (k, value) in slice.value.iter().enumerate() {
            let u = (value - row.mean) / row.std;
            // Values have the rounding of the mean.
            let tolerance = 1e-12 + 8.0 * f64::EPSILON * (row.mean / row.std).abs();
            let density = slice.density[k] * row.std;
            assert!((density - probability::density(u)).abs() < tolerance);
            assert!((slice.cumulative[k] - probability::cumulative(u)).abs() < tolerance);
        }
        assert!(slice.cumulative[0] < 1e-8 && slice.cumulative[2000] > 1.0 - 1e-8);
    }
}

#[test]
fn parts_threads_and_forms_change_nothing() {
    let folder = Folder::new();
    let whole = moments(&folder, "--threads 1");
    let bytes = folder.read("density.parquet");
    moments(&folder, "--threads 7");
    assert!(folder.read("density.parquet") == bytes);
    for (name, range) in [
        ("a.mcap", "0..1"),
        ("b.mcap", "1..40"),
        ("c.mcap", "40..65"),
    ] {
        folder.done(&format!(
            "simulate -s scenario.toml points.parquet --points {range} -o {name}"
        ));
    }
    folder.done("density c.mcap a.mcap b.mcap -o parts.parquet --moments parts-moments.parquet");
    let parts = read_moments(&folder.path("parts-moments.parquet")).unwrap();
    assert_same(&whole, &parts.rows, 1e-13);
    folder.refuses(
        "density c.mcap b.mcap -o parts.parquet",
        "b.mcap, c.mcap: expected all 65 points (counted from 0), found none of 0..1; \
         name the recordings of the other parts too",
    );
    // A common grid for all times.
    folder.done("density responses.mcap --set density.grid=common -o common.parquet");
    let table = read_density(&folder.path("common.parquet")).unwrap();
    let first = &table.slices[0];
    let of_quantity = table.slices.iter().filter(|s| s.quantity == first.quantity);
    assert!(of_quantity.clone().count() > 190);
    assert!(of_quantity.clone().all(|s| s.value == first.value));
}

/// Harmonics of unit amplitude, the spectrum in their weights, as another program may write them.
fn unit_harmonics() -> Points {
    let spectrum = SecondOrderFilter {
        alpha: 0.1,
        beta: 0.1,
        gamma: 1e-4,
        form: FilterForm::Corrected,
    };
    let (count, step) = (32, 4.0 / 32.0);
    let mut points = Points::new(1 + 2 * count);
    let mut weights = vec![0.0];
    for k in 0..count {
        let wavenumber = (k as f64 + 0.5) * step;
        weights.extend([2.0 * spectrum.density(wavenumber) * step; 2]);
        let rows = &mut points.heights[(1 + 2 * k) * 81..(3 + 2 * k) * 81];
        let (cosine, sine) = rows.split_at_mut(81);
        for j in 0..81 {
            (sine[j], cosine[j]) = (wavenumber * 0.5 * j as f64).sin_cos();
        }
    }
    points.probability = Some(weights);
    points.attributes =
        r#"{"position_start": 0.0, "position_step": 0.5, "weights": "harmonics"}"#.to_owned();
    points
}

#[test]
fn harmonics_of_another_program() {
    let folder = Folder::new();
    let ours = moments(&folder, "");
    unit_harmonics().write(&folder.path("foreign.parquet"));
    folder.done("simulate -s scenario.toml foreign.parquet -o foreign.mcap");
    folder
        .done("density foreign.mcap -o foreign-density.parquet --moments foreign-moments.parquet");
    let theirs = read_moments(&folder.path("foreign-moments.parquet")).unwrap();
    // A response to a unit harmonic is a thousand times the mean, whose digits it costs.
    assert_same(&ours, &theirs.rows, 1e-9);
}

#[test]
fn what_does_not_follow_from_harmonics_is_refused() {
    let folder = Folder::new();
    let excite = |options: &str, message: &str| {
        let line = format!("excite --pseudo-excitation -s scenario.toml {options} -o out");
        folder.refuses(&line, message);
    };
    excite(
        "--set irregularity.field=random-phase",
        "--set: irregularity.field: expected \"gaussian\" or \"karhunen-loeve\", a sum of harmonics with normal \
         amplitudes, for --pseudo-excitation, found \"random-phase\"; \
         add --set irregularity.field=gaussian, of the same covariance",
    );
    excite(
        "--set irregularity.spectrum= --set irregularity.wavenumber= --set irregularity.deterministic={kind=\"smooth\"}",
        "--set: irregularity.spectrum: expected a spectrum, whose harmonics --pseudo-excitation writes, \
         found none",
    );
    excite(
        "--set irregularity.field=karhunen-loeve --set irregularity.spacing=1e-4 --set irregularity.wavenumber.count=10000",
        "--set: irregularity.field: expected an expansion that takes some seconds, \
         found 400001 positions with 10000 wavenumbers; make the length or the band smaller or the \
         spacing larger, or take the field \"gaussian\"",
    );
    let outcome = folder.run_in_vain(
        "excite --pseudo-excitation --seed 3 -s scenario.toml -o out",
        2,
    );
    assert!(outcome.error().contains("cannot be used with"));

    folder.done("excite --pseudo-excitation -s scenario.toml -o points.parquet");
    for (key, value) in [
        ("suspension_cubic_stiffness", "1e6"),
        ("suspension_quadratic_damping", "1e3"),
        ("bump_stop", "{gap=0.01,stiffness=1e6}"),
    ] {
        folder.refuses(
            &format!("simulate -s scenario.toml --set vehicle.{key}={value} points.parquet -o out"),
            &format!(
                "--set: vehicle.{key}: expected a linear system: points.parquet holds the harmonics of a \
                 pseudo-excitation, found a nonlinear suspension; leave the key out, or excite without --pseudo-excitation"
            ),
        );
    }
    let mut points = unit_harmonics();
    points.parameter = "vehicle.body_mass";
    points.write(&folder.path("random.parquet"));
    folder.refuses(
        "simulate -s scenario.toml random.parquet -o out",
        "random.parquet: vehicle.body_mass: expected harmonics of a pseudo-excitation, the irregularity alone being \
         random, found a random parameter; excite without --pseudo-excitation",
    );

    folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
    for (line, remedy) in [
        (
            "reliability responses.mcap -o out",
            "for first passage excite without --pseudo-excitation",
        ),
        (
            "plot responses.mcap -o out.svg",
            "make a density table of it and draw that",
        ),
    ] {
        folder.refuses(
            line,
            &format!(
                "responses.mcap: weights: expected `assigned` or `importance`: representative points, \
                 found `harmonics`: a pseudo-excitation; {remedy}"
            ),
        );
    }
    folder.refuses(
        "plot points.parquet --figure periodogram -o out.svg",
        "points.parquet: weights: expected `assigned` or `importance`: representative points, \
         found `harmonics`: a pseudo-excitation; for a periodogram excite without --pseudo-excitation",
    );
}
