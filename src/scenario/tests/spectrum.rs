//! Spectra, bands and windows as scenarios give them.

use super::*;
use crate::irregularity::{
    Band, ChineseBallastless, ChineseMainLine, Disturbance, Fra, FraFryba, German, Iso8608,
    PowerSpectralDensity, Sncf, SncfQuality, TrackComponent, Window,
};
use std::f64::consts::TAU;

fn irregularity(text: &str) -> IrregularitySpec {
    let text = format!("[irregularity]\nlength = 40\nspacing = 0.1\n{text}");
    let scenario = Scenario::from_text("s.toml", &text).unwrap();
    scenario.irregularity().unwrap()
}

#[test]
fn each_kind_is_its_model() {
    let wavelengths = "wavelength = { min = 1, max = 40, count = 8 }";
    let (low, vertical) = (Disturbance::Low, TrackComponent::Vertical);
    let german = |disturbance, component| German {
        disturbance,
        component,
    };
    let cases: [(&str, TrackComponent, &dyn PowerSpectralDensity); 12] = [
        (
            r#"kind = "iso-8608", class = "A""#,
            vertical,
            &Iso8608::mean(0, 2.0),
        ),
        (
            r#"kind = "iso-8608", class = "D", level = "upper-limit", waviness = 2.5"#,
            vertical,
            &Iso8608::upper_limit(3, 2.5),
        ),
        (
            r#"kind = "german", disturbance = "low""#,
            vertical,
            &german(low, vertical),
        ),
        (
            r#"kind = "german", disturbance = "high", component = "cross-level""#,
            TrackComponent::CrossLevel,
            &german(Disturbance::High, TrackComponent::CrossLevel),
        ),
        (
            r#"kind = "erri-b176", disturbance = "low""#,
            vertical,
            &german(low, vertical),
        ),
        (
            r#"kind = "fra", class = 4"#,
            vertical,
            &Fra::new(4, vertical),
        ),
        (
            r#"kind = "fra", class = 6, component = "gauge""#,
            TrackComponent::Gauge,
            &Fra::new(6, TrackComponent::Gauge),
        ),
        (
            r#"kind = "fra-fryba", class = 2"#,
            vertical,
            &FraFryba::new(2),
        ),
        (
            r#"kind = "sncf", quality = "poor""#,
            vertical,
            &Sncf {
                quality: SncfQuality::Poor,
            },
        ),
        (
            r#"kind = "chinese-ballastless", component = "alignment""#,
            TrackComponent::Alignment,
            &ChineseBallastless {
                component: TrackComponent::Alignment,
                factor: 1.0,
            },
        ),
        (
            r#"kind = "chinese-ballastless", percentile = 50"#,
            vertical,
            &ChineseBallastless {
                component: vertical,
                factor: 2f64.ln(),
            },
        ),
        (
            r#"kind = "chinese-main-line", set = "speed-raised-cross-level""#,
            TrackComponent::CrossLevel,
            &ChineseMainLine::SpeedRaisedCrossLevel,
        ),
    ];
    for (text, component, model) in cases {
        let spec = irregularity(&format!("spectrum = {{ {text} }}\n{wavelengths}"));
        let spectrum = spec.spectrum.unwrap();
        assert!(text.contains(&format!("{:?}", spectrum.kind())), "{text}");
        assert_eq!(spectrum.component(), component, "{text}");
        let SpectrumSource::Model(found) = spectrum.source() else {
            panic!("{text} is no table");
        };
        for wavenumber in [0.2, 1.0, 5.0] {
            let (found, exact) = (found.density(wavenumber), model.density(wavenumber));
            assert!((found / exact - 1.0).abs() < 1e-14, "{text}");
        }
        assert_eq!(spectrum.singularity(), model.singularity(), "{text}");
    }
}

#[test]
fn a_band_by_wavelengths_is_one_by_wavenumbers() {
    let german = "spectrum = { kind = \"german\", disturbance = \"low\" }\n";
    let of = |band: &str| irregularity(&format!("{german}{band}")).band();
    let count = 9;
    let (min, max) = (TAU / 80.0, TAU);
    assert_eq!(
        of("wavelength = { min = 1, max = 80, count = 9 }"),
        Some(Band { min, max, count })
    );
    let min = 0.0;
    assert_eq!(
        of("wavelength = { min = 1, count = 9 }"),
        Some(Band { min, max, count })
    );
    let (min, max) = (0.5, 2.0);
    assert_eq!(
        of("wavenumber = { min = 0.5, max = 2, count = 9 }"),
        Some(Band { min, max, count })
    );
    assert_eq!(
        irregularity("deterministic = { kind = \"smooth\" }").band(),
        None
    );
}

#[test]
fn windows_are_built() {
    let window = |text: &str| {
        let smooth = "deterministic = { kind = \"smooth\" }";
        irregularity(&format!("{smooth}\nsmoothing = {{ {text} }}"))
            .smoothing
            .map(|spec| spec.build())
    };
    assert_eq!(
        window(r#"kind = "moving-average", length = 0.2"#),
        Some(Window::MovingAverage { length: 0.2 })
    );
    assert_eq!(
        window(r#"kind = "contact-patch", half_length = 0.006"#),
        Some(Window::ContactPatch { half_length: 0.006 })
    );
}
