use std::path::{Path, PathBuf};

use super::*;

mod bad;
mod oscillator;
mod overrides;
mod random;
mod schema;
mod spectrum;
mod train;

fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn sets(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| set.to_string()).collect()
}

/// The scenario with every key that `example` has not.
fn full() -> Scenario {
    Scenario::from_text("folder/full.toml", FULL).unwrap()
}

fn example() -> Scenario {
    Scenario::load(&repository().join("pipelines/quarter-car.toml"), &[]).unwrap()
}

/// A scenario that, with the example and what is in `KINDS`, has every key that there is.
const FULL: &str = r#"
title = "Every key"
points = { rule = "partially-stratified", count = 987, truncate_at = 3, moment_matching = 50, seed = 7, variables = 20 }

[irregularity]
spectrum = { kind = "table", file = "spectra/track.csv", sided = "one", unit = "cycles/m", wavenumber_column = "n", density_column = "G" }
wavenumber = { max = 10, count = 512 }
deterministic = { kind = "profile", file = "/measured.parquet", position_column = "x", height_column = "z", scale = 0.001 }
start = -12.5
length = 80
spacing = 0.05

[bridge]
span = 40
mass_per_length = 6067
flexural_rigidity = 2.658069e9
section_modulus = 0.5
damping_ratio = 0.02
modes = 512

[[bridge.section]]
name = "quarter"
position = 10

[[bridge.section]]
name = "third_1-3"
position = 40

[vehicle]
kind = "quarter-car"
body_mass = 12000
wheel_mass = 500
suspension_stiffness = 280e3
suspension_damping = 0
tyre_stiffness = 156e3
speed = 20
approach = 25
suspension_cubic_stiffness = 1e6
suspension_quadratic_damping = 1e3
bump_stop = { gap = 0.05, stiffness = 1e6 }

[simulation]
integrator = "exponential"
time_step = 0.01
duration = 4
record_every = 2
initial_state = "profile"
record = ["bridge/quarter/stress"]
filter = [{ quantity = "vehicle/wheel/contact_force", low_pass = 20, order = 2 }]
index = [
    { name = "comfort", kind = "sperling", quantity = "vehicle/body/acceleration", window = { from = 1, to = 3.5 }, low_pass = 40, direction = "lateral" },
    { name = "weighted", kind = "weighted-rms", quantity = "vehicle/body/acceleration", weighting = "w-d" },
    { name = "unloading", kind = "unloading-ratio", quantity = "vehicle/wheel/contact_force", static_force = 122625 },
    { name = "impact", kind = "impact-factor", quantity = "bridge/midspan/displacement", static_response = -0.06 },
]
gravity = 9.80665
precision = "f32"
compression = "zstd"

[density]
method = "density-evolution"
smoothing = { rule = "fixed", width = 1e-4 }
points_per_time = 16
grid = "common"
quantities = ["bridge/quarter/stress"]

[density.evolution]
nodes = 400
courant = 1
velocity = "differentiated"
absorbing = [{ quantity = "bridge/quarter/stress", kind = "absolute", threshold = 1e7 }]

[reliability]
smoothing = { rule = "factor" }
confidence = 0.9
limit = [{ name = "stress", quantity = "bridge/quarter/stress", kind = "lower", threshold = -1e6 }]

[exact]
quantity = "oscillator/position"
case = { kind = "free-vibration", frequency = { lower = 4, upper = 5 }, amplitude = { mean = 0.1, standard_deviation = 0.01 } }
times = { start = 0.5, step = 0.25, end = 1 }
points_per_time = 500

[study]
scenario = "other.toml"
set = ["bridge.span=30"]
quantity = "bridge/midspan/displacement"
reference = "exact"
start = 0.5
counts = [64, 128]
seeds = 3
seeds_above = { count = 64, seeds = 2 }
points = [{ name = "random", set = ["points.rule=monte-carlo"], counts = [100], seeds = 2 }]
density = [{ name = "kernel", set = ["density.points_per_time=100"], with = ["random"] }]

[[random]]
key = "bridge.flexural_rigidity"
distribution = { kind = "normal", mean = 2.6e9, standard_deviation = 1e8 }

[[random]]
key = "bridge.mass_per_length"
distribution = { kind = "truncated-normal", location = 6067, scale = 300, lower = 5000, upper = 7000 }

[[random]]
key = "vehicle.body_mass"
distribution = { kind = "lognormal", log_mean = 9.4, log_standard_deviation = 0.1 }

[[random]]
key = "vehicle.wheel_mass"
distribution = { kind = "uniform", lower = 450, upper = 550 }

[[random]]
key = "vehicle.suspension_stiffness"
distribution = { kind = "beta", alpha = 2, beta = 3.5, lower = 200e3, upper = 400e3 }

[[random]]
key = "vehicle.tyre_stiffness"
distribution = { kind = "gamma", shape = 100, scale = 1560 }

[[random]]
key = "vehicle.suspension_quadratic_damping"
distribution = { kind = "gumbel", mode = 20, scale = 0.5, extreme = "smallest" }

[[random]]
key = "bridge.section_modulus"
distribution = { kind = "weibull", shape = 5, scale = 0.5 }

[[random]]
key = "bridge.damping_ratio"
distribution = { kind = "exponential", rate = 200, lower = 0.005 }

[[random]]
key = "vehicle.bump_stop.gap"
distribution = { kind = "table", file = "gap.csv", rows = "quantiles", value_column = "x", probability_column = "p" }

[[correlation]]
keys = ["bridge.flexural_rigidity", "bridge.mass_per_length"]
coefficient = 0.5
of = "parameters"
"#;

/// Overrides of `FULL` to the kinds that it has not.
const KINDS: [&str; 5] = [
    r#"irregularity.deterministic={ kind = "sine", amplitude = 0.001, wavelength = 10, phase = 0.5 }"#,
    r#"density.smoothing={ rule = "normal-reference" }"#,
    r#"exact.case={ kind = "duffing", natural_frequency = 2, damping_ratio = 0.05, cubic = 10, intensity = 0.01 }"#,
    "irregularity.field=karhunen-loeve",
    "irregularity.terms=50",
];

/// Overrides of `FULL` to spectra, bands and windows that it has not.
const TRACKS: [&[&str]; 8] = [
    &[
        r#"irregularity.spectrum={ kind = "iso-8608", class = "C", level = "upper-limit", waviness = 2.1 }"#,
        "irregularity.wavenumber=",
        "irregularity.wavelength={ min = 0.5, max = 90, count = 256 }",
        r#"irregularity.smoothing={ kind = "moving-average", length = 0.2 }"#,
    ],
    &[
        r#"irregularity.spectrum={ kind = "german", disturbance = "low", component = "cross-level" }"#,
        r#"irregularity.smoothing={ kind = "contact-patch", half_length = 0.006 }"#,
    ],
    &[r#"irregularity.spectrum={ kind = "erri-b176", disturbance = "high" }"#],
    &[r#"irregularity.spectrum={ kind = "sncf", quality = "good" }"#],
    &[
        r#"irregularity.spectrum={ kind = "fra", class = 6, component = "alignment" }"#,
        "irregularity.wavenumber.min=0.02",
    ],
    &[
        r#"irregularity.spectrum={ kind = "fra-fryba", class = 1 }"#,
        "irregularity.wavenumber.min=0.02",
    ],
    &[
        r#"irregularity.spectrum={ kind = "chinese-ballastless", component = "gauge", percentile = 90 }"#,
        "irregularity.wavenumber.min=0.02",
    ],
    &[
        r#"irregularity.spectrum={ kind = "chinese-main-line", set = "welded-right-alignment" }"#,
        "irregularity.wavenumber.min=0.15",
    ],
];

#[test]
fn the_example_is_the_papers_case() {
    let scenario = example();
    let all = scenario.check_all().unwrap();
    let points = all.points.unwrap();
    assert_eq!(
        (points.rule, points.count, points.truncate_at),
        (RuleKind::PartiallyStratified, 987, Some(3.0))
    );
    let car = scenario.quarter_car().unwrap();
    // 2 * 0.1 * sqrt(12000 * 280e3)
    assert!((car.suspension_damping() - 11_593.101_396_951_55).abs() < 1e-9);
    let bridge = all.bridge.unwrap();
    assert_eq!(
        (bridge.span, bridge.modes, bridge.section.len()),
        (Some(40.0), 5, 0)
    );
    assert_eq!(all.simulation.unwrap().gravity, 9.81);
    assert_eq!(all.reliability.unwrap().limit.len(), 2);
    let irregularity = all.irregularity.unwrap();
    let start = scenario.irregularity_start(&irregularity).unwrap();
    assert!(start == 0.0 && start.is_sign_positive());
}

#[test]
fn optional_keys_are_read() {
    let scenario = full();
    let mut irregularity = scenario.irregularity().unwrap();
    assert_eq!(scenario.irregularity_start(&irregularity).unwrap(), -12.5);
    irregularity.start = None;
    assert_eq!(scenario.irregularity_start(&irregularity).unwrap(), -25.0);
    assert_eq!(irregularity.field, FieldKind::Gaussian);
    let Some(SpectrumSpec::Table(table)) = irregularity.spectrum else {
        panic!("{irregularity:?}");
    };
    assert_eq!(
        (table.sided, table.unit),
        (Sided::One, WavenumberUnit::CyclePerMetre)
    );
    assert_eq!(
        scenario.resolve(&table.file),
        Path::new("folder/spectra/track.csv")
    );
    let Some(DeterministicSpec::Profile(profile)) = irregularity.deterministic else {
        panic!("a measured profile");
    };
    assert_eq!(
        scenario.resolve(&profile.file),
        Path::new("/measured.parquet")
    );
    assert_eq!(scenario.bridge().unwrap().section[1].name, "third_1-3");
    let car = scenario.quarter_car().unwrap();
    assert_eq!(car.suspension_damping(), 0.0);
    assert_eq!(
        car.bump_stop,
        Some(BumpStopSpec {
            gap: 0.05,
            stiffness: 1e6
        })
    );
    assert_eq!(
        scenario.density().unwrap().smoothing,
        SmoothingSpec::Fixed(FixedSpec { width: 1e-4 })
    );
    assert_eq!(
        scenario.reliability().unwrap().smoothing,
        WidthRuleSpec::Factor(FactorSpec { factor: 0.02 })
    );
    let kinds = scenario.set(&sets(&KINDS)).unwrap();
    assert_eq!(
        kinds.density().unwrap().smoothing,
        SmoothingSpec::NormalReference
    );
    assert!(matches!(
        kinds.irregularity().unwrap().deterministic,
        Some(DeterministicSpec::Sine(SineSpec {
            amplitude: 0.001,
            wavelength: 10.0,
            phase: 0.5
        }))
    ));
}

#[test]
fn exact_cases_have_their_times() {
    use crate::exact::{Case, Duffing, FreeVibration};
    let scenario = full();
    let spec = scenario.exact().unwrap();
    assert_eq!(scenario.exact_times(&spec).unwrap(), [0.5, 0.75, 1.0]);
    let vibration = FreeVibration {
        lowest_frequency: 4.0,
        highest_frequency: 5.0,
        amplitude: 0.1,
        amplitude_deviation: 0.01,
    };
    assert_eq!(spec.case.build(), Case::FreeVibration(vibration));
    let scenario = scenario.set(&sets(&KINDS)).unwrap();
    let duffing = Case::Duffing(Duffing::new(0.05, 2.0, 0.01, 10.0));
    assert_eq!(scenario.exact().unwrap().case.build(), duffing);
    // Without times those that are recorded.
    let options = [
        "exact.times=",
        "simulation.duration=0.07",
        "simulation.index=",
        "simulation.time_step=0.01",
    ];
    let scenario = scenario.set(&sets(&options)).unwrap();
    let times = scenario.exact_times(&scenario.exact().unwrap()).unwrap();
    assert_eq!(times, [0.0, 0.02, 0.04, 0.06]);
}

#[test]
fn a_stage_needs_its_own_tables_only() {
    let text = "[bridge]\nspan = -1\n\n[density]\ngrid = \"common\"\n";
    let scenario = Scenario::from_text("s.toml", text).unwrap();
    assert_eq!(scenario.density().unwrap().grid, GridKind::Common);
    assert!(scenario.bridge().is_err() && scenario.check_all().is_err());
    let nothing = Scenario::from_text("s.toml", "").unwrap();
    assert_eq!(nothing.density().unwrap(), DensitySpec::default());
    let start = nothing.irregularity_start(&example().irregularity().unwrap());
    assert_eq!(start.unwrap(), 0.0);
}

#[test]
fn a_key_has_a_place() {
    let text = "[bridge]\nspan = 40\n\n[simulation]\nrecord = [\n  \"a\",\n  \"b\",\n]\n\n[[reliability.limit]]\nname = \"x\"\n";
    let options = [
        "bridge.modes=5",
        "density.points_per_time=32",
        "reliability.limit.1.name=y",
    ];
    let scenario = Scenario::from_text("s.toml", text)
        .unwrap()
        .set(&sets(&options))
        .unwrap();
    for (key, place) in [
        ("bridge", "s.toml:1"),
        ("bridge.span", "s.toml:2"),
        ("bridge.damping_ratio", "s.toml:1"),
        ("bridge.modes", "--set"),
        ("simulation.record", "s.toml:5"),
        ("simulation.record.1", "s.toml:7"),
        ("reliability.limit.0", "s.toml:10"),
        ("reliability.limit.0.name", "s.toml:11"),
        ("reliability.limit.1.threshold", "--set"),
        ("density.smoothing.rule", "--set"),
        ("vehicle.speed", "s.toml"),
    ] {
        assert_eq!(scenario.place(key), place, "{key}");
    }
    let known = ["a", "bridge/midspan/displacement"];
    assert_eq!(
        scenario
            .unknown_quantity("simulation.record", "b", &known[1..])
            .to_string(),
        "s.toml:7: simulation.record: expected a known quantity, found \"b\"; known are \"bridge/midspan/displacement\""
    );
    assert_eq!(
        scenario
            .unknown_quantity("density.quantities", "bridge/midspan/displacment", &known)
            .to_string(),
        "--set: density.quantities: expected a known quantity, found \"bridge/midspan/displacment\"; \
         did you mean \"bridge/midspan/displacement\"?"
    );
}

#[test]
fn a_file_that_is_no_text_or_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.toml");
    let error = Scenario::load(&path, &[]).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert_eq!(
        error.to_string(),
        format!(
            "{}: expected a scenario (TOML), found no such file",
            path.display()
        )
    );
    std::fs::write(&path, b"title = \"\xff\"").unwrap();
    let error = Scenario::load(&path, &[]).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert_eq!(
        error.to_string(),
        format!("{}: expected UTF-8 text, found other bytes", path.display())
    );
}
