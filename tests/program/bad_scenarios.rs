//! Scenarios that are wrong: `tests/bad/` has them all; here a few through the program, and those that need files.

use crate::harness::{Folder, SCENARIO};

#[test]
fn keys_and_values() {
    let folder = Folder::new();
    let excite = |options: &str, message: &str| {
        folder.refuses(
            &format!("excite -s scenario.toml {options} -o out"),
            message,
        );
    };
    excite(
        "--set points.cuont=7",
        "--set: points.cuont: unknown key; did you mean count?",
    );
    excite(
        "--set points.count=many",
        "--set: points.count: expected a whole number of at least 1 and at most 100000000, found \"many\"",
    );
    excite(
        "--count 0",
        "--set: points.count: expected a whole number of at least 1 and at most 100000000, found 0",
    );
    excite(
        "--set irregularity.length=nan",
        "--set: irregularity.length: expected a finite number above 0 (m), found nan",
    );
    excite(
        "--set irregularity.spacing=inf",
        "--set: irregularity.spacing: expected a finite number above 0 (m), found inf",
    );
    excite(
        "--set irregularity.spacing=1e-9",
        "--set: irregularity.spacing: expected at most 1000000 positions on the length, \
         found 40000000001 (length 40 m, spacing 0.000000001 m); make the spacing larger",
    );
    excite(
        "--set points.rule=",
        "--set: points.rule: missing: rule by which the representative points are chosen; \
         one of \"monte-carlo\", \"latin-hypercube\", \"sobol\", \"lattice\", \"partially-stratified\", \
         \"latinized-partially-stratified\", \"gf-discrepancy\", \"grid\"",
    );
}

#[test]
fn bridge_and_vehicle() {
    let folder = Folder::with_points();
    let simulate = |options: &str, message: &str| {
        let line = format!("simulate -s scenario.toml points.parquet {options} -o out");
        folder.refuses(&line, message);
    };
    simulate(
        "--set bridge.span=-40",
        "--set: bridge.span: expected a number above 0 (m), found -40",
    );
    simulate(
        "--set vehicle.body_mass=-1.5",
        "--set: vehicle.body_mass: expected a number above 0 (kg), found -1.5",
    );
    simulate(
        "--set vehicle.tyre_stiffness=-156e3",
        "--set: vehicle.tyre_stiffness: expected a number above 0 (N/m), found -156e3",
    );
    simulate(
        "--set simulation.record.0=bridge/midspan/displacment",
        "--set: simulation.record: expected a known quantity, found \"bridge/midspan/displacment\"; \
         did you mean \"bridge/midspan/displacement\"?",
    );
    simulate(
        "--set simulation.time_step=1e-8",
        "--set: simulation.time_step: expected at most 10000000 steps in simulation.duration, \
         found 200000000; take a larger step",
    );
}

#[test]
fn an_error_names_the_line() {
    let folder = Folder::new();
    folder.write(
        "typo.toml",
        SCENARIO.replace("tyre_stiffness", "tire_stiffness"),
    );
    folder.refuses(
        "check -s typo.toml",
        "typo.toml:35: vehicle.tire_stiffness: unknown key; did you mean tyre_stiffness?",
    );
    folder.write("missing.toml", SCENARIO.replace("wheel_mass = 500.0\n", ""));
    folder.refuses(
        "check -s missing.toml",
        "missing.toml:29: vehicle.wheel_mass: missing: mass of the wheel (kg)",
    );
    folder.refuses(
        "check -s nowhere.toml",
        "nowhere.toml: expected a scenario (TOML), found no such file",
    );
    folder.refuses(
        "check -s .",
        ".: expected a scenario (TOML), found a folder",
    );
}

#[test]
fn a_step_that_is_not_stable() {
    let folder = Folder::with_points();
    let message = "--set: simulation.time_step: expected at most 0.00489 s, the largest stable step of explicit-newmark, \
                   found 0.005 s; take a smaller step (simulation.record_every thins the recording), fewer modes or \
                   another integrator";
    let options = "--set bridge.modes=10 --set simulation.time_step=0.005";
    let simulate = format!("simulate -s scenario.toml points.parquet {options}");
    folder.refuses(&format!("{simulate} -o out"), message);
    // `check` says so before the work, after all that it has to say.
    let check = folder.run(&format!("check -s scenario.toml {options}"));
    assert_eq!((check.code, check.error()), (2, message));
    check.says(&["  explicit-newmark  0.00489 s  <- given: 0.005 s, NOT STABLE"]);
    // The largest that was named is one.
    folder.done(&format!(
        "{simulate} --set simulation.time_step=0.00489 -o out"
    ));
    folder.done(&format!(
        "{simulate} --set simulation.integrator=exponential -o out"
    ));
}

#[test]
fn a_run_that_ends_before_the_bridge_is_allowed_but_said() {
    let folder = Folder::new();
    let approach = "--set vehicle.approach=100";
    folder.done(&format!(
        "excite -s scenario.toml {approach} -o points.parquet"
    ));
    let simulate = format!("simulate -s scenario.toml {approach} points.parquet -o responses.mcap");
    let note = "the run ends 60.000 m before the bridge: simulation.duration is too short for vehicle.approach";
    assert_eq!(folder.done(&simulate).stderr, format!("note: {note}\n"));
    assert_eq!(folder.done(&format!("{simulate} -q")).stderr, "");
    folder
        .done(&format!("check -s scenario.toml {approach}"))
        .says(&[note]);
    // The bridge is still then, and only the vehicle has densities.
    let density = folder.done("density responses.mcap -o density.parquet");
    assert_eq!(
        density.stderr.lines().nth(1),
        Some(
            "note: bridge/midspan/displacement: no spread at 201 time(s) from 0 to 2 s: no density there"
        )
    );
}

#[test]
fn tables_of_spectra_and_profiles() {
    let folder = Folder::new();
    let spectrum = "--set 'irregularity.spectrum={ kind = \"table\", file = \"spectrum.csv\", sided = \"two\", \
                    unit = \"rad/m\" }'";
    let excite = |table: &str, message: &str| {
        folder.write("spectrum.csv", table);
        folder.refuses(
            &format!("excite -s scenario.toml {spectrum} -o out"),
            message,
        );
    };
    excite(
        "wavenumber,density\n0.1,1e-5\n0.3,1e-6\n0.2,1e-7\n",
        "spectrum.csv:4: wavenumber: expected a value above the one before, 0.3, found 0.2",
    );
    excite(
        "0.1,1e-5\n0.1,1e-6\n",
        "spectrum.csv:2: column 1: expected a value above the one before, 0.1, found 0.1",
    );
    excite(
        "0.1,1e-5\n0.2,-1e-6\n",
        "spectrum.csv: expected a spectrum: wavenumbers that increase, densities that are not negative, \
         found row 2: the density -0.000001 is negative",
    );
    excite(
        "0.1,1e-5\n0.2,nan\n",
        "spectrum.csv:2: column 2: expected a finite number, found NaN",
    );
    excite(
        "0.1,1e-5\n",
        "spectrum.csv: expected at least two rows, found 1",
    );
    std::fs::remove_file(folder.path("spectrum.csv")).unwrap();
    folder.refuses(
        &format!("excite -s scenario.toml {spectrum} -o out"),
        "spectrum.csv: expected a table (CSV or Parquet), found no such file",
    );
    folder.write("road.csv", "position,height\n0,0\n39,0.01\n");
    folder.refuses(
        "excite -s scenario.toml --set 'irregularity.deterministic={ kind = \"profile\", file = \"road.csv\" }' -o out",
        "road.csv: expected a profile from 0 to 40 m, as irregularity.start and irregularity.length ask, \
         found one from 0 to 39 m; shorten irregularity.length or measure further",
    );
}

#[test]
fn what_is_asked_for_must_be_recorded() {
    let folder = Folder::with_recording();
    let velocity = "--set reliability.limit.0.quantity=vehicle/body/velocity";
    folder.refuses(
        &format!("reliability responses.mcap {velocity} -o out --extremes extremes"),
        "--set: reliability.limit.0.quantity: expected a quantity of the recording (bridge/midspan/displacement, \
         vehicle/body/acceleration), found \"vehicle/body/velocity\"; record it (simulation.record) or take the limit out",
    );
    let check = folder.run(&format!("check -s scenario.toml {velocity}"));
    assert_eq!(
        (check.code, check.error()),
        (
            2,
            "--set: reliability.limit.0.quantity: expected a quantity of simulation.record, \
             found \"vehicle/body/velocity\"; record it or leave it out here"
        )
    );
    folder.refuses(
        "density responses.mcap --set 'density.quantities=[\"vehicle/body/velocity\"]' -o out --moments moments",
        "--set: density.quantities: expected a known quantity, found \"vehicle/body/velocity\"; \
         known are \"bridge/midspan/displacement\", \"vehicle/body/acceleration\"",
    );
    folder.refuses(
        "plot responses.mcap --quantity vehicle/body/aceleration -o out.svg",
        "--quantity: expected one of bridge/midspan/displacement, vehicle/body/acceleration, \
         found vehicle/body/aceleration; did you mean vehicle/body/acceleration?",
    );
}
