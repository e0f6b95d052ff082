//! Published spectra by the variances over their bands, their asymptotes and each other.

use super::*;
use crate::irregularity::{
    Band, ChineseBallastless, ChineseMainLine, Disturbance, Fra, FraFryba, German, Iso8608,
    PowerSpectralDensity, Sncf, SncfQuality, TrackComponent,
};
use std::f64::consts::{PI, TAU};

const COMPONENTS: [TrackComponent; 4] = [
    TrackComponent::Vertical,
    TrackComponent::Alignment,
    TrackComponent::CrossLevel,
    TrackComponent::Gauge,
];

/// 2 ∫ S dΩ by Simpson's rule over log Ω: the standard deviation (m) over a band of wavenumbers (rad/m).
fn deviation(spectrum: &dyn PowerSpectralDensity, min: f64, max: f64) -> f64 {
    let intervals = 20_000;
    let step = (max / min).ln() / intervals as f64;
    let at = |i: usize| {
        let wavenumber = min * (i as f64 * step).exp();
        spectrum.density(wavenumber) * wavenumber
    };
    let sum: f64 = (0..=intervals)
        .map(|i| match i {
            0 => at(i),
            _ if i == intervals => at(i),
            _ if i % 2 == 1 => 4.0 * at(i),
            _ => 2.0 * at(i),
        })
        .sum();
    (2.0 * sum * step / 3.0).sqrt()
}

fn over_wavelengths(spectrum: &dyn PowerSpectralDensity, shortest: f64, longest: f64) -> f64 {
    deviation(spectrum, TAU / longest, TAU / shortest)
}

fn german(disturbance: Disturbance, component: TrackComponent) -> German {
    German {
        disturbance,
        component,
    }
}

fn ballastless(component: TrackComponent) -> ChineseBallastless {
    ChineseBallastless {
        component,
        factor: 1.0,
    }
}

#[test]
fn roads_have_the_rms_of_their_class() {
    let rms = |road: Iso8608| deviation(&road, TAU * 0.011, TAU * 2.83);
    let a = rms(Iso8608::mean(0, 2.0));
    // G(n₀) n₀² (1/n_min − 1/n_max).
    let exact = (16e-6 * 0.01 * (1.0 / 0.011 - 1.0 / 2.83_f64)).sqrt();
    assert!(
        (a / exact - 1.0).abs() < 1e-9 && (a - 3.81e-3).abs() < 0.005e-3,
        "{a}"
    );
    for class in 1..8u8 {
        let doubled = 2f64.powi(i32::from(class)) * a;
        assert!((rms(Iso8608::mean(class, 2.0)) / doubled - 1.0).abs() < 1e-12);
    }
    assert!((rms(Iso8608::upper_limit(0, 2.0)) / (2f64.sqrt() * a) - 1.0).abs() < 1e-12);
    // The angular form at 1 rad/m, one-sided: 1.0053e-6 m³/rad.
    let angular = 2.0 * Iso8608::mean(0, 2.0).density(1.0);
    assert!((angular / (16e-8 * TAU) - 1.0).abs() < 1e-14 && (angular - 1.0053e-6).abs() < 1e-10);
    // Whatever the waviness, the roughness is that at n₀.
    for waviness in [1.5, 2.0, 2.5] {
        let density = Iso8608::mean(2, waviness).density(TAU * 0.1);
        assert!(
            (density * 4.0 * PI / 256e-6 - 1.0).abs() < 1e-14,
            "{waviness}"
        );
    }
}

#[test]
fn german_tracks_have_their_rms() {
    let low = german(Disturbance::Low, TrackComponent::Vertical);
    let high = german(Disturbance::High, TrackComponent::Vertical);
    for (rms, exact) in [
        (over_wavelengths(&low, 1.0, 80.0), 2.074e-3),
        (over_wavelengths(&high, 1.0, 80.0), 3.394e-3),
        (over_wavelengths(&low, 3.0, 150.0), 2.863e-3),
    ] {
        assert!((rms - exact).abs() < 0.0006e-3, "{rms} {exact}");
    }
    // ∫ G dΩ over 0 ... ∞ by partial fractions: π A_v Ω_c / (2 Ω_r (Ω_c + Ω_r)).
    let exact = PI * 4.032e-7 * 0.8246 / (2.0 * 0.0206 * (0.8246 + 0.0206));
    assert!((deviation(&low, 1e-7, 1e5).powi(2) / exact - 1.0).abs() < 1e-5);
    // Cross level and gauge are the vertical spectrum's with 4 and A_g/A_v times Ω²/(Ω² + Ω_s²).
    for wavenumber in [0.03, 0.4, 2.0] {
        let of = |component| german(Disturbance::Low, component).density(wavenumber);
        let second = wavenumber * wavenumber / (wavenumber * wavenumber + 0.438 * 0.438);
        let vertical = of(TrackComponent::Vertical);
        for (found, exact) in [
            (of(TrackComponent::Alignment), 2.119 / 4.032),
            (of(TrackComponent::CrossLevel), 4.0 * second),
            (of(TrackComponent::Gauge), 0.532 / 4.032 * second),
        ] {
            assert!((found / (exact * vertical) - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn american_tracks_by_both_forms() {
    // Short waves: k A_v Ω_c² / Ω⁴ and A n₂² / n⁴; long ones: k A_v / Ω² and A n₁² / n⁴.
    let (short, long) = (1e4f64, 1e-6f64);
    let spectrum = Fra::new(6, TrackComponent::Vertical);
    let exact = 0.5 * 0.25 * 0.0339e-4 * 0.8245f64.powi(2) / short.powi(4);
    assert!((spectrum.density(short) / exact - 1.0).abs() < 1e-6);
    let exact = 0.5 * 0.25 * 0.0339e-4 / (long * long);
    assert!((spectrum.density(long) / exact - 1.0).abs() < 1e-6);
    let fryba = FraFryba::new(1);
    let of_cycles = |n: f64| 4.0 * PI * fryba.density(TAU * n);
    let exact = 15.53e-8 * 0.131f64.powi(2) / short.powi(4);
    assert!((of_cycles(short) * short.powi(2) / exact / short.powi(2) - 1.0).abs() < 1e-6);
    let exact = 15.53e-8 * 0.0233f64.powi(2) / long.powi(4);
    assert!((of_cycles(long) / exact - 1.0).abs() < 1e-6);
    // At 10 m; a better class is a smoother track, by either form.
    let ratios: Vec<f64> = (1..=6)
        .map(|class| {
            let angular = Fra::new(class, TrackComponent::Vertical).density(TAU * 0.1);
            angular / FraFryba::new(class).density(TAU * 0.1)
        })
        .collect();
    for (ratio, exact) in ratios
        .iter()
        .zip([29.45, 43.46, 52.34, 73.86, 50.42, 13.07])
    {
        assert!((ratio / exact - 1.0).abs() < 2e-3, "{ratio} {exact}");
    }
    for class in 2..=6 {
        let vertical = |class| Fra::new(class, TrackComponent::Vertical).density(0.5);
        let alignment = |class| Fra::new(class, TrackComponent::Alignment).density(0.5);
        let fryba = |class| FraFryba::new(class).density(0.5);
        assert!(vertical(class) < vertical(class - 1));
        assert!(alignment(class) < alignment(class - 1));
        assert!(fryba(class) < fryba(class - 1));
    }
    // Finite at 0: 4 k A_v / Ω_s².
    let exact = 0.5 * 0.25 * 4.0 * 1.2107e-4 / 0.6046f64.powi(2);
    for component in [TrackComponent::CrossLevel, TrackComponent::Gauge] {
        let spectrum = Fra::new(1, component);
        assert!((spectrum.density(0.0) / exact - 1.0).abs() < 1e-12);
        assert_eq!(spectrum.singularity(), None);
    }
}

#[test]
fn french_tracks_have_their_variance() {
    // ∫ A (1 + n/n₀)^−3 dn = A n₀/2 [(1 + n/n₀)^−2] over the band.
    for (quality, level) in [(SncfQuality::Good, 0.509), (SncfQuality::Poor, 1.790)] {
        let at = |wavelength: f64| (1.0 + 1.0 / (0.0489 * wavelength)).powi(-2);
        let exact = 0.5 * 308e-6 * level * 0.0489 * (at(40.0) - at(2.0));
        let found = over_wavelengths(&Sncf { quality }, 2.0, 40.0);
        assert!((found.powi(2) / exact - 1.0).abs() < 1e-9, "{found}");
    }
}

#[test]
fn chinese_ballastless_tracks_have_their_rms() {
    for (component, exact) in COMPONENTS
        .iter()
        .zip([1.220e-3, 0.668e-3, 0.524e-3, 0.344e-3])
    {
        let rms = over_wavelengths(&ballastless(*component), 2.0, 200.0);
        assert!((rms - exact).abs() < 0.0006e-3, "{component:?}: {rms}");
    }
    let rms = over_wavelengths(&ballastless(TrackComponent::Vertical), 2.0, 120.0);
    assert!((rms - 0.715e-3).abs() < 0.0006e-3, "{rms}");
}

#[test]
fn chinese_segments_meet() {
    for component in COMPONENTS {
        let segments = ballastless(component).segments();
        assert!(segments.is_sorted_by(|a, b| a.end < b.end));
        for pair in segments.windows(2) {
            let (before, after) = (pair[0].density(pair[0].end), pair[1].density(pair[0].end));
            assert!(
                (after / before - 1.0).abs() < 5e-3,
                "{component:?}: {before} {after}"
            );
        }
    }
}

#[test]
fn quantiles_of_ballastless_tracks() {
    for (probability, exact) in [
        (0.1, 0.105),
        (0.25, 0.288),
        (0.5, 0.693),
        (0.75, 1.386),
        (0.9, 2.303),
    ] {
        let factor = ChineseBallastless::quantile_factor(probability);
        assert!((factor - exact).abs() < 6e-4, "{factor} {exact}");
    }
    let mean = ballastless(TrackComponent::Gauge);
    let high = ChineseBallastless {
        factor: ChineseBallastless::quantile_factor(0.9),
        ..mean
    };
    let ratio = high.density(0.7) / mean.density(0.7);
    assert!((ratio - 10f64.ln()).abs() < 1e-14, "{ratio}");
}

#[test]
fn chinese_main_lines_are_spectra_beside_their_poles() {
    use ChineseMainLine::*;
    for (line, pole) in [
        (WeldedLeftVertical, None),
        (WeldedRightVertical, Some(66.1)),
        (WeldedLeftAlignment, Some(66.4)),
        (WeldedRightAlignment, Some(61.0)),
        (WeldedCentreVertical, Some(41.6)),
        (SpeedRaisedLeftVertical, None),
        (SpeedRaisedRightVertical, None),
        (SpeedRaisedLeftAlignment, None),
        (SpeedRaisedRightAlignment, None),
        (SpeedRaisedCrossLevel, None),
    ] {
        let singularity = line.singularity();
        let wavelength = singularity.map(|wavenumber| TAU / wavenumber);
        match (wavelength, pole) {
            (Some(found), Some(pole)) => assert!((found - pole).abs() < 0.06, "{line:?}: {found}"),
            (found, pole) => assert_eq!(found, pole, "{line:?}"),
        }
        let least = singularity.unwrap_or(0.0);
        // Positive and finite above, without another pole.
        for i in 0..5000 {
            let wavenumber = least * 1.001 + 20.0 * (i as f64 / 5000.0).powi(3);
            let density = line.density(wavenumber);
            assert!(
                density > 0.0 && density < 1.0,
                "{line:?} {wavenumber}: {density}"
            );
        }
        if least > 0.0 {
            assert!(line.density(0.999 * least) < 0.0);
        }
    }
    // One value by hand, of the left rail at n = 0.1 1/m.
    let (n, d) = (0.1f64, 4.0 * PI * WeldedLeftVertical.density(TAU * 0.1));
    let exact =
        0.1270 * (n * n - 0.21531 + 1.5503) / (1e-4 + 4.9835e-3 + 1.3891e-2 - 0.00327 + 0.0018);
    assert!((d / (1e-6 * exact) - 1.0).abs() < 1e-12);
}

#[test]
fn a_band_from_above_zero_has_its_share_of_the_variance() {
    let track = ballastless(TrackComponent::Vertical);
    let band = Band {
        min: TAU / 200.0,
        max: TAU / 2.0,
        count: 20_000,
    };
    let field = SpectralRepresentation::on(&track, band);
    assert!((field.variance().sqrt() - over_wavelengths(&track, 2.0, 200.0)).abs() < 1e-8);
    assert_eq!(field.wavenumber(0), band.min + 0.5 * band.step());
    assert!(band.holds(band.min) && !band.holds(0.99 * band.min) && !band.holds(1.01 * band.max));
    // From 0 on it is the band of before, to the last bit.
    let filter = filter(FilterForm::Corrected);
    let min = 0.0;
    let (max, count) = (10.0, 77);
    let same = SpectralRepresentation::on(&filter, Band { min, max, count });
    assert_eq!(same, SpectralRepresentation::new(&filter, 10.0, 77));
}
