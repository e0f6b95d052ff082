use super::*;
use std::f64::consts::PI;

fn deck(spans: &[f64], kind: Spans) -> Deck {
    Deck {
        spans: spans.to_vec(),
        kind,
        mass_per_length: 29_720.0,
        flexural_rigidity: 3.45e10 * 12.744,
        shear_rigidity: None,
        section_modulus: None,
        damping: DeckDamping::Ratio(0.05),
        modes: 6,
        bearings: None,
        sections: Vec::new(),
    }
}

/// A single span by elements, its bearings so stiff that they are rigid.
fn by_elements() -> (Deck, Deck) {
    let sines = deck(&[32.5], Spans::Simple);
    let elements = Deck {
        bearings: Some(Bearings {
            stiffness: 1e18,
            damping: 0.0,
        }),
        ..sines.clone()
    };
    (sines, elements)
}

/// Zeng et al. 2014: 5.72 and 22.89 Hz.
#[test]
fn published_frequencies() {
    let modes = DeckModes::new(&deck(&[32.5], Spans::Simple), 0.0);
    let found: Vec<f64> = modes.frequencies().iter().map(|w| w / (2.0 * PI)).collect();
    assert!((found[0] - 5.7199).abs() < 5e-5 && (found[1] / found[0] - 4.0).abs() < 1e-12);
}

#[test]
fn elements_agree_with_sines() {
    for shear in [None, Some(1e11)] {
        let (sines, elements) = by_elements();
        let of = |deck: &Deck| {
            DeckModes::new(
                &Deck {
                    shear_rigidity: shear,
                    ..deck.clone()
                },
                1771.0,
            )
        };
        let (exact, found) = (of(&sines), of(&elements));
        for (k, (a, b)) in exact
            .frequencies()
            .iter()
            .zip(found.frequencies())
            .enumerate()
        {
            // (βh)⁴/1440 of Hermite elements, 24 on the span; with shear a share of h².
            let of_shear = shear.map_or(0.0, |_| 5e-5 * ((k + 1) as f64).powi(3));
            let allowed = 2.0 * ((k + 1) as f64 * PI / 24.0).powi(4) / 1440.0 + 1e-7 + of_shear;
            assert!((b / a - 1.0).abs() < allowed, "{k} {a} {b}");
        }
        // Response of moment and displacement to a force, mode by mode: independent of the modes' scale.
        for (x, at) in [(16.25, 10.0), (5.0, 21.3), (30.1, 30.1)] {
            // Of Timoshenko's beam the elements are coarser.
            let slack = shear.map_or(1.0, |_| 20.0);
            for what in [Inner::BendingMoment, Inner::ShearForce] {
                let scale = match what {
                    Inner::BendingMoment => 8.0,
                    Inner::ShearForce => 1.0,
                };
                let flexibility = |modes: &DeckModes, mode: usize| {
                    let k = modes.matrices();
                    let stiffness = k.iter().find(|(i, j, _)| i == j && *i == mode).unwrap();
                    modes.inner(what, x)[mode].1 * modes.shapes(at)[mode].1 / stiffness.2[2]
                };
                for mode in 0..4 {
                    let (a, b) = (flexibility(&exact, mode), flexibility(&found, mode));
                    assert!((a - b).abs() < 2e-3 * scale * slack, "{mode} {a} {b}");
                }
                if what == Inner::BendingMoment {
                    let (a, b) = (exact.truncated(what, x, at), found.truncated(what, x, at));
                    // Elements can't follow the kink under the force: h/8.
                    assert!((a - b).abs() < 32.5 / 24.0 / 8.0, "{x} {at} {a} {b}");
                }
            }
        }
    }
}

/// Two equal spans: the first mode is that of a single span, the second that of a span clamped at one end,
/// with (βL)² = 15.4182.
#[test]
fn two_continuous_spans() {
    let one = DeckModes::new(&deck(&[30.0], Spans::Simple), 0.0).frequencies();
    let two = DeckModes::new(&deck(&[30.0, 30.0], Spans::Continuous), 0.0).frequencies();
    assert!((two[0] / one[0] - 1.0).abs() < 1e-5);
    assert!((two[1] / one[0] - 15.4182 / (PI * PI)).abs() < 1e-4);
}

/// The moment over the middle support of two spans under a force at the middle of one: 3/32 P L.
#[test]
fn moment_over_a_support() {
    let modes = DeckModes::new(&deck(&[30.0, 30.0], Spans::Continuous), 0.0);
    let mut moment = modes.truncated(Inner::BendingMoment, 30.0, 15.0);
    let matrices = modes.matrices();
    for (mode, share) in modes.inner(Inner::BendingMoment, 30.0) {
        let (_, _, value) = matrices
            .iter()
            .find(|(i, j, _)| i == j && *i == mode)
            .unwrap();
        moment += share * modes.shapes(15.0)[mode].1 / value[2];
    }
    // An upward force: sagging over the support.
    assert!((moment - 3.0 / 32.0 * 30.0).abs() < 0.02, "{moment}");
}

/// A rigid mode on soft bearings: ω² = 2 k / (ρA L), its damping from the bearings.
#[test]
fn soft_bearings() {
    let soft = Deck {
        bearings: Some(Bearings {
            stiffness: 1e4,
            damping: 500.0,
        }),
        damping: DeckDamping::Ratio(0.0),
        ..deck(&[20.0], Spans::Simple)
    };
    let modes = DeckModes::new(&soft, 0.0);
    let mass = 20.0 * soft.mass_per_length;
    let expected = (2.0 * 1e4 / mass).sqrt();
    assert!((modes.frequencies()[0] / expected - 1.0).abs() < 1e-4);
    let (_, _, first) = modes.matrices()[0];
    assert!((first[1] / (2.0 * 500.0 / mass) - 1.0).abs() < 1e-4);
}

#[test]
fn spans_in_a_row_move_alone() {
    let modes = DeckModes::new(&deck(&[32.0, 24.0], Spans::Simple), 0.0);
    assert_eq!(modes.count(), 12);
    let there = modes.shapes(44.0);
    assert_eq!(
        there.iter().map(|(k, _)| *k).collect::<Vec<_>>(),
        (6..12).collect::<Vec<_>>()
    );
    assert!((there[0].1 - 2f64.sqrt()).abs() < 1e-12);
    assert!(modes.shapes(-0.1).is_empty() && modes.shapes(56.1).is_empty());
    assert_eq!(modes.truncated(Inner::BendingMoment, 16.0, 40.0), 0.0);
}
