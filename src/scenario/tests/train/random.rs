//! Random numbers of trains.

use super::*;

#[test]
fn any_scalar_of_a_train_may_vary_but_for_places() {
    let keys = [
        "vehicle.speed",
        "vehicle.car.0.secondary_stiffness",
        "contact.stiffness",
        "track.rail.mass_per_length",
        "track.on_bridge.stiffness",
        "bridge.damping_ratio",
        "bridge.bearings.stiffness",
    ];
    let scenario = trailers(&[
        r#"track={ kind = "ballasted", preset = "zhai-2004-ballasted" }"#,
        r#"contact={ kind = "linear" }"#,
    ]);
    let (nominal, _) = scenario.train().unwrap();
    let names = keys.map(str::to_owned);
    let (widest, crossing_of) = scenario.varied_train(&nominal, &names, Some(60.0)).unwrap();
    let track = widest.track.as_ref().unwrap();
    assert!(track.fasteners > nominal.track.as_ref().unwrap().fasteners);
    let varied = crossing_of(&[55.0, 7e5, 1.5e9, 130.0, 2e8, 0.03, 5e9]);
    assert_eq!(varied.speed, 55.0);
    for placed in &varied.cars {
        let Car::RailVehicle(car) = &placed.car else {
            panic!("a rail vehicle");
        };
        assert_eq!(car.secondary_stiffness, 7e5);
    }
    assert_eq!(varied.contact, Contact::Linear { stiffness: 1.5e9 });
    let of_point = varied.track.as_ref().unwrap();
    assert_eq!(
        (of_point.start, of_point.fasteners),
        (track.start, track.fasteners)
    );
    assert_eq!(of_point.rail.mass_per_length, 130.0);
    let deck = varied.deck.as_ref().unwrap();
    assert_eq!(deck.damping, DeckDamping::Rayleigh(0.03));
    assert_eq!(deck.bearings.unwrap().stiffness, 5e9);
    // With the nominal values it is the nominal one.
    let (_, same) = scenario.varied_train(&nominal, &names[..2], None).unwrap();
    assert_eq!(same(&[50.0, 6e5]), nominal);
    let random = |key: &str| {
        let text = format!(
            "{}\n[[random]]\nkey = \"{key}\"\ndistribution = {{ kind = \"uniform\", lower = 1, upper = 2 }}\n",
            scenario.text()
        );
        Scenario::from_text("train.toml", &text)
            .unwrap()
            .check_all()
    };
    for key in &keys[..5] {
        random(key).unwrap();
    }
    for key in [
        "vehicle.approach",
        "vehicle.car.0.wheelbase",
        "bridge.spans.0",
        "bridge.section.0.position",
        "track.fastener.spacing",
    ] {
        let message = random(key).unwrap_err().to_string();
        assert!(
            message.contains("which all points of a crossing share"),
            "{message}"
        );
    }
    let message = random("vehicle.car.0.body_mas").unwrap_err().to_string();
    assert!(
        message.contains("did you mean \"vehicle.car.0.body_mass\"?"),
        "{message}"
    );
}

#[test]
fn values_of_points_are_held_to_the_bounds_of_a_trains_keys() {
    let scenario = trailers(&[r#"track={ kind = "ballasted", preset = "zhai-2004-ballasted" }"#]);
    let above = Some((1, "a number above 0 (kg)".to_owned()));
    for key in ["vehicle.car.0.body_mass", "track.sleeper.mass"] {
        assert!(scenario.can_be_random(key), "{key}");
        assert_eq!(scenario.first_bad(key, &[1.0, -1.0]), above, "{key}");
    }
    // There is but one table of cars, and no slab.
    for key in [
        "vehicle.car.1.body_mass",
        "track.slab.mass_per_length",
        "vehicle.approach",
    ] {
        assert!(!scenario.can_be_random(key), "{key}");
    }
}
