//! The expansion by its covariance, orthogonality and end.

use super::*;

#[test]
fn the_expansion_has_the_covariance_of_the_spectral_representation() {
    // An even and an odd number of positions, few and many wavenumbers, a start of its own.
    for (count, wavenumbers, max) in [(100, 128, 10.0), (81, 256, 4.0), (40, 64, 30.0)] {
        let grid = Grid {
            start: -7.0,
            spacing: 0.2,
            count,
        };
        let spectrum =
            SpectralRepresentation::new(&filter(FilterForm::Corrected), max, wavenumbers);
        let variance = spectrum.variance();
        let field = KarhunenLoeve::new(&spectrum, grid, None).unwrap();
        assert!(field.lost() <= 1e-12 && field.is_linear());
        assert!((field.variance() / variance - 1.0).abs() < 2e-12);
        assert!(field.variances().is_sorted_by(|a, b| a >= b));
        let terms = functions(&field, grid);
        let waves = functions(&GaussianField::new(spectrum.clone(), grid), grid);
        let covariance = |rows: &[f64], i: usize, j: usize| -> f64 {
            let rows = rows.chunks_exact(count);
            rows.map(|row| row[i] * row[j]).sum()
        };
        // What is lost is a covariance too: no element exceeds its trace.
        let tolerance = (1e-12 + 4.0 * f64::EPSILON) * count as f64 * variance;
        for (i, j) in [(0, 0), (0, count - 1), (7, 8), (count / 2, 3), (20, 20)] {
            let distance = grid.position(i) - grid.position(j);
            let exact = spectrum.covariance(distance);
            for rows in [&terms, &waves] {
                let found = covariance(rows, i, j);
                assert!(
                    (found - exact).abs() < tolerance,
                    "{i} {j}: {found} {exact}"
                );
            }
        }
        // Orthogonal, with squares that sum to the term's variance; the largest value is positive.
        let eps = 100.0 * f64::EPSILON;
        let rows: Vec<&[f64]> = terms.chunks_exact(count).collect();
        for (m, (row, variance)) in rows.iter().zip(field.variances()).enumerate() {
            for (n, other) in rows.iter().enumerate().take(m + 1) {
                let product: f64 = row.iter().zip(*other).map(|(a, b)| a * b).sum();
                let scale = (variance * field.variances()[n]).sqrt();
                let exact = if m == n { scale } else { 0.0 };
                assert!(
                    (product - exact).abs() < eps * scale,
                    "{m} {n}: {product} {scale}"
                );
            }
        }
    }
}

#[test]
fn the_expansion_ends_where_it_is_told() {
    let spectrum = SpectralRepresentation::new(&filter(FilterForm::Corrected), 10.0, 512);
    let grid = Grid {
        start: 0.0,
        spacing: 0.05,
        count: 801,
    };
    let whole = KarhunenLoeve::new(&spectrum, grid, None).unwrap();
    // Somewhat beyond Ω_max L/π = 127, however close the positions are.
    let coarse = Grid {
        spacing: 0.2,
        count: 201,
        ..grid
    };
    let coarse = KarhunenLoeve::new(&spectrum, coarse, None).unwrap();
    assert_eq!((whole.dimensions(), coarse.dimensions()), (136, 135));
    let part = KarhunenLoeve::new(&spectrum, grid, Some(20)).unwrap();
    assert_eq!(part.dimensions(), 20);
    assert_eq!(part.variances(), &whole.variances()[..20]);
    let kept: f64 = part.variances().iter().sum();
    let total = 801.0 * spectrum.variance();
    assert!((part.lost() - (1.0 - kept / total)).abs() < 1e-12);
    let one = KarhunenLoeve::new(&spectrum, grid, Some(1)).unwrap();
    let mut rows = vec![0.0; 2 * 801];
    one.add(&[1.0, -2.0], 2, &mut rows);
    assert!(rows[400] > 0.0 && (rows[801 + 400] + 2.0 * rows[400]).abs() < 1e-16);
}

#[test]
fn expansions_that_take_too_long_are_refused() {
    let grid = |count, spacing| Grid {
        start: 0.0,
        spacing,
        count,
    };
    let flat = Tabulated::new(&[0.0, 1e3], &[1.0, 1.0], false, false).unwrap();
    // One wavenumber has two terms, whatever the number of positions.
    let one = SpectralRepresentation::new(&flat, 1.0, 1);
    let field = KarhunenLoeve::new(&one, grid(3000, 0.01), None).unwrap();
    assert_eq!(field.dimensions(), 2);
    assert_eq!(
        KarhunenLoeve::new(&one, grid(300_000_000, 0.1), None).unwrap_err(),
        KarhunenLoeveError::TooManyPositions {
            positions: 300_000_000,
            wavenumbers: 1
        }
    );
    // White noise on these positions: as many terms as positions.
    let white = SpectralRepresentation::new(&flat, 1000.0, 4000);
    let error = KarhunenLoeve::new(&white, grid(3000, 0.003), None).unwrap_err();
    assert!(
        matches!(error, KarhunenLoeveError::TooManyTerms { positions: 3000, terms } if terms < 3000),
        "{error}"
    );
    let none = Tabulated::new(&[5.0, 6.0], &[1.0, 1.0], false, false).unwrap();
    let none = SpectralRepresentation::new(&none, 4.0, 10);
    let error = KarhunenLoeve::new(&none, grid(100, 0.1), None).unwrap_err();
    assert_eq!(error, KarhunenLoeveError::NoVariance);
}
