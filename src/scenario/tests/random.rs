//! Random parameters.

use super::*;
use crate::probability::distribution::{self, Distribution, Tail};

/// The example with random parameters.
fn with(tables: &str) -> Scenario {
    let text = format!("{}\n{tables}", example().text());
    Scenario::from_text("s.toml", &text).unwrap()
}

fn read(scenario: &Scenario) -> RandomParameters {
    scenario.random(|_| panic!("no table")).unwrap()
}

const STIFFNESSES: &str = r#"
[[random]]
key = "vehicle.suspension_stiffness"
distribution = { kind = "lognormal", mean = 280e3, coefficient_of_variation = 0.1 }

[[random]]
key = "vehicle.tyre_stiffness"
distribution = { kind = "truncated-normal", mean = 156e3, standard_deviation = 20e3, lower = 0 }

[[random]]
key = "bridge.damping_ratio"
distribution = { kind = "beta", mean = 0.02, standard_deviation = 0.01, lower = 0, upper = 0.1 }

[[correlation]]
keys = ["vehicle.tyre_stiffness", "vehicle.suspension_stiffness"]
coefficient = 0.6
"#;

#[test]
fn parameters_have_their_units_and_ranges() {
    let scenario = with(STIFFNESSES);
    scenario.check_all().unwrap();
    let random = read(&scenario);
    let described: Vec<_> = random
        .iter()
        .map(|p| (p.key.as_str(), p.unit.as_str(), p.range.as_str()))
        .collect();
    assert_eq!(
        described,
        [
            (
                "vehicle.suspension_stiffness",
                "N/m",
                "a number above 0 (N/m)"
            ),
            ("vehicle.tyre_stiffness", "N/m", "a number above 0 (N/m)"),
            (
                "bridge.damping_ratio",
                "1",
                "a number of at least 0 and below 1"
            ),
        ]
    );
    assert!(random.iter().all(|parameter| parameter.outside() == 0.0));
    assert_eq!(read(&example()).dimensions(), 0);
}

#[test]
fn values_are_those_of_correlated_normals() {
    let random = read(&with(STIFFNESSES));
    // Two points: the normals of each parameter beside each other.
    let normals = [1.0, -2.0, 0.5, 3.0, -1.0, 0.0];
    let mut values = [0.0; 6];
    random.values(&normals, &mut values);
    let laws: Vec<&dyn Distribution> = random.iter().map(|p| p.distribution.as_ref()).collect();
    for point in 0..2 {
        let x = |k: usize| normals[2 * k + point];
        let z = [x(0), 0.6 * x(0) + 0.8 * x(1), x(2)];
        for (k, z) in z.into_iter().enumerate() {
            let exact = laws[k].at_normal(z);
            assert!((values[2 * k + point] / exact - 1.0).abs() < 1e-14);
        }
    }
    read(&example()).values(&[], &mut []);
}

#[test]
fn pearsons_correlation_of_lognormal_parameters_has_a_formula() {
    let tables = STIFFNESSES
        .replace(
            "truncated-normal\", mean = 156e3, standard_deviation = 20e3, lower = 0",
            "lognormal\", mean = 1, standard_deviation = 0.1",
        )
        .replace(
            "coefficient = 0.6",
            "coefficient = 0.6\nof = \"parameters\"",
        );
    let random = read(&with(&tables));
    let mut values = [0.0; 3];
    random.values(&[1.0, 0.0, 0.0], &mut values);
    let law = &random.iter().nth(1).unwrap().distribution;
    // ln(1 + 0.6 V²)/ln(1 + V²) with the coefficient of variation V = 0.1 of both.
    let normals = 0.006f64.ln_1p() / 0.01f64.ln_1p();
    assert!((values[1] / law.at_normal(normals) - 1.0).abs() < 1e-13);
}

#[test]
fn a_number_that_is_random_may_be_left_out() {
    let scenario = with(STIFFNESSES);
    let options = [
        "vehicle.suspension_stiffness=",
        "vehicle.tyre_stiffness=150e3",
        "bridge.damping_ratio=",
    ];
    let scenario = scenario.set(&sets(&options)).unwrap();
    let text = scenario.text().to_owned();
    let car = scenario.quarter_car().unwrap();
    assert!((car.suspension_stiffness / 280e3 - 1.0).abs() < 1e-15);
    assert_eq!(car.tyre_stiffness, 150e3);
    assert!((scenario.bridge().unwrap().damping_ratio - 0.02).abs() < 1e-16);
    scenario.check_all().unwrap();
    assert_eq!(scenario.text(), text);
    // In a table of the table too; one that is missing stays so.
    let gap = "[[random]]\nkey = \"vehicle.bump_stop.gap\"\ndistribution = { kind = \"uniform\", lower = 0.01, upper = 0.03 }\n";
    let scenario = with(gap)
        .set(&sets(&["vehicle.bump_stop.stiffness=1e6"]))
        .unwrap();
    let car = scenario.quarter_car().unwrap();
    assert!((car.bump_stop.unwrap().gap - 0.02).abs() < 1e-16);
    let message = with(gap).vehicle().unwrap_err().to_string();
    assert!(
        message.contains("vehicle.bump_stop.stiffness: missing"),
        "{message}"
    );
}

#[test]
fn tables_come_from_the_reader() {
    let scenario = full();
    let random = scenario.random(|spec| {
        assert_eq!(spec.file, Path::new("gap.csv"));
        assert_eq!(spec.rows, RowsKind::Quantiles);
        Ok(distribution::Table::from_quantiles(&[0.0, 1.0], &[0.04, 0.06]).unwrap())
    });
    let random = random.unwrap();
    assert_eq!(random.dimensions(), 10);
    let kinds: Vec<&str> = random.iter().map(|p| p.distribution.kind()).collect();
    assert_eq!(
        kinds.join(" "),
        "normal truncated-normal lognormal uniform beta gamma gumbel weibull exponential table"
    );
    let gap = random.iter().last().unwrap();
    assert!((gap.distribution.value(Tail::Below(0.25)) - 0.045).abs() < 1e-16);
    let negative =
        scenario.random(|_| Ok(distribution::Table::from_samples(&[-1.0, 0.5]).unwrap()));
    assert!(
        negative
            .unwrap_err()
            .to_string()
            .contains("expected a mean that is a number above 0 (m), found -0.25")
    );
}

#[test]
fn values_out_of_range_are_counted_and_named() {
    let tables = STIFFNESSES.replace(
        "kind = \"lognormal\", mean = 280e3, coefficient_of_variation = 0.1",
        "kind = \"normal\", mean = 280e3, coefficient_of_variation = 0.5",
    );
    let random = read(&with(&tables));
    let stiffness = random.iter().next().unwrap();
    // Φ(−2)
    assert!((stiffness.outside() - 0.022_750_131_948_179_2).abs() < 1e-15);
    assert!(stiffness.check(7, &[1.0, 2.0]).is_ok());
    let message = stiffness
        .check(7, &[1.0, 2.0, 0.0])
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("s.toml:"), "{message}");
    assert!(
        message.ends_with(
            ": vehicle.suspension_stiffness: expected a number above 0 (N/m) at every point, found 0.0 at point 9; \
             take a distribution without such values, lognormal or truncated-normal"
        ),
        "{message}"
    );
}
