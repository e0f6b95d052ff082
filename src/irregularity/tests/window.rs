//! Means over a window: transfer functions by quadrature, profiles by their own integrals.

use super::*;
use crate::irregularity::{Smoothed, Window};
use std::f64::consts::PI;

const WINDOWS: [Window; 2] = [
    Window::MovingAverage { length: 0.4 },
    Window::ContactPatch { half_length: 0.3 },
];

/// ∫ w(u) f(u) du: midpoints of the angle u = a sin φ, which smooth the ends of the ellipse.
fn quadrature(window: &Window, f: impl Fn(f64) -> f64) -> f64 {
    let count = 4000;
    let step = PI / count as f64;
    let angles = (0..count).map(|i| (i as f64 + 0.5) * step - 0.5 * PI);
    angles
        .map(|angle| {
            let (sin, cos) = angle.sin_cos();
            match window {
                Window::MovingAverage { length } => 0.5 * cos * f(0.5 * length * sin),
                Window::ContactPatch { half_length } => 2.0 / PI * cos * cos * f(half_length * sin),
            }
        })
        .sum::<f64>()
        * step
}

#[test]
fn transfer_functions_are_those_of_the_weights() {
    for window in WINDOWS {
        assert_eq!(window.transfer(0.0), 1.0);
        for wavenumber in [1e-9, 0.5, 3.0, 17.0, 60.0] {
            let exact = quadrature(&window, |u| (wavenumber * u).cos());
            let found = window.transfer(wavenumber);
            assert!(
                (found - exact).abs() < 1e-6,
                "{window:?} {wavenumber}: {found} {exact}"
            );
        }
    }
    // Zeros: of a wave as long as the window, and of J₁.
    assert!(WINDOWS[0].transfer(2.0 * PI / 0.4).abs() < 1e-15);
    assert!(WINDOWS[1].transfer(3.831_705_970_207_512 / 0.3).abs() < 1e-15);
}

#[test]
fn means_of_profiles_are_integrals() {
    let positions = [0.0, 0.1, 0.7, 0.75, 2.0];
    let heights = [0.3, -1.0, 2.0, 0.5, 0.5];
    let profile = Deterministic::Profile {
        positions: positions.to_vec(),
        heights: heights.to_vec(),
    };
    let grid = Grid {
        start: -0.5,
        spacing: 0.13,
        count: 21,
    };
    for window in WINDOWS {
        let mean = profile.smoothed(&window, grid);
        for j in 0..grid.count {
            let x = grid.position(j);
            let exact = quadrature(&window, |u| profile.height(x + u));
            let found = mean.height(x);
            assert!(
                (found - exact).abs() < 1e-5,
                "{window:?} {x}: {found} {exact}"
            );
        }
        // A straight profile is its own mean, away from its ends.
        let straight = Deterministic::Profile {
            positions: vec![-1.0, 0.2, 0.9, 3.0],
            heights: vec![-2.0, 0.4, 1.8, 6.0],
        };
        let mean = straight.smoothed(&window, grid);
        for j in 0..grid.count {
            let x = grid.position(j);
            assert!((mean.height(x) - 2.0 * x).abs() < 1e-14);
        }
        // A sine keeps wavelength and phase.
        let sine = Deterministic::Sine {
            amplitude: 0.02,
            wavelength: 0.5,
            phase: 0.7,
        };
        let mean = sine.smoothed(&window, grid);
        for x in [-0.2, 0.3, 5.0] {
            let exact = quadrature(&window, |u| sine.height(x + u));
            assert!((mean.height(x) - exact).abs() < 1e-8, "{window:?} {x}");
        }
        assert_eq!(
            Deterministic::Smooth.smoothed(&window, grid),
            Deterministic::Smooth
        );
    }
}

#[test]
fn a_field_of_the_smoothed_spectrum_is_the_mean_of_the_field() {
    let grid = Grid {
        start: 0.0,
        spacing: 0.1,
        count: 60,
    };
    // Positions ten times as dense, and some more on both sides.
    let fine = Grid {
        start: -1.0,
        spacing: 0.001,
        count: 8000,
    };
    for window in WINDOWS {
        let smoothed = Smoothed {
            spectrum: Box::new(filter(FilterForm::Corrected)),
            window,
        };
        let before = SpectralRepresentation::new(smoothed.spectrum.as_ref(), 10.0, 8);
        let after = SpectralRepresentation::new(&smoothed, 10.0, 8);
        let mut variables = [0.0; 16];
        MonteCarlo::new(1, 16, 3).standard_normals(0..1, &mut variables);
        // The largest amplitude may be another one after smoothing: variables go with their wavenumber.
        assert_eq!(before.order(), after.order());
        let rows = |field: SpectralRepresentation, grid: Grid| {
            let mut rows = vec![0.0; grid.count];
            GaussianField::new(field, grid).add(&variables, 1, &mut rows);
            rows
        };
        let profile = Deterministic::Profile {
            positions: (0..fine.count).map(|j| fine.position(j)).collect(),
            heights: rows(before, fine),
        };
        let mean = profile.smoothed(&window, grid);
        // Straight lines between 1 mm lie off by r″ h²/8; H > 0 for these waves.
        for (j, found) in rows(after, grid).iter().enumerate() {
            let exact = mean.height(grid.position(j));
            assert!(
                (found - exact).abs() < 1e-7,
                "{window:?} {j}: {found} {exact}"
            );
        }
    }
}
