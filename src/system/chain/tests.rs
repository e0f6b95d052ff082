//! A chain's frequencies, damping ratios and steps by their closed forms.

use super::*;

fn storey(mass: f64, stiffness: f64) -> Storey {
    Storey {
        mass,
        stiffness: Stiffness::Stiffness(stiffness),
        damping: Damping::Coefficient(0.0),
        cubic: Cubic::Stiffness(0.0),
        power_law: None,
        van_der_pol: None,
        bouc_wen: None,
        initial_displacement: 0.0,
        initial_velocity: 0.0,
    }
}

fn chain(storeys: Vec<Storey>) -> Chain {
    Chain {
        storeys,
        rayleigh: None,
        excitation: None,
        time_step: 0.01,
        steps: 10,
        record_every: 1,
    }
}

#[test]
fn equal_storeys_have_the_frequencies_of_a_chain_fixed_at_one_end() {
    let (mass, stiffness, count) = (8000.0, 1.0e7, 6);
    let chain = chain(vec![storey(mass, stiffness); count]);
    for (k, omega) in chain.modes().0.iter().enumerate() {
        let angle = (2 * k + 1) as f64 * std::f64::consts::PI / (4 * count + 2) as f64;
        let exact = 2.0 * (stiffness / mass).sqrt() * angle.sin();
        assert!((omega / exact - 1.0).abs() < 1e-12, "{k}: {omega} {exact}");
    }
}

#[test]
fn rayleigh_damping_meets_its_ratio_in_both_modes() {
    let mut chain = chain(vec![storey(8000.0, 1.0e7); 6]);
    chain.rayleigh = Some(Rayleigh {
        damping_ratio: 0.05,
        modes: [1, 6],
    });
    let ratios = chain.modal_damping_ratios();
    assert!((ratios[0] - 0.05).abs() < 1e-13 && (ratios[5] - 0.05).abs() < 1e-13);
    assert!(ratios[1..5].iter().all(|ratio| *ratio < 0.05));
}

#[test]
fn an_undamped_oscillator_stands_two_roots_of_two_radians_a_step() {
    let chain = chain(vec![storey(2.0, 50.0)]);
    let limit = 8f64.sqrt() / 5.0;
    let step = chain.largest_stable_step().unwrap();
    assert!(step <= limit && step > 0.99 * limit, "{step} {limit}");
}

#[test]
fn scalars_are_found_by_the_keys_they_are_given_with() {
    let mut chain = chain(vec![storey(1.0, 2.0), storey(3.0, 4.0)]);
    assert_eq!(chain.scalar_mut("storey.1.stiffness"), Some(&mut 4.0));
    for key in [
        "mass",
        "storey.2.mass",
        "storey.0.natural_frequency",
        "storey.1",
        "x.0.mass",
    ] {
        assert_eq!(chain.scalar_mut(key), None, "{key}");
    }
    chain.storeys.truncate(1);
    assert_eq!(chain.scalar_mut("mass"), Some(&mut 1.0));
}
