//! Each bad scenario in `tests/bad/` and the exact message beside it.

use super::*;

/// Everything that can be wrong with a scenario, as the stages would meet it.
fn read_all(name: &str, text: &str) -> Result<()> {
    let options = text
        .lines()
        .filter_map(|line| line.strip_prefix("# --set "));
    let scenario = Scenario::from_text(name, text)?.set(&sets(&options.collect::<Vec<_>>()))?;
    scenario.check_all()?;
    if scenario.is_train() {
        return scenario.train().map(|_| ());
    }
    let points = scenario.points()?;
    if let Some(band) = scenario.irregularity()?.wavenumber {
        scenario.point_count(&points, 2 * band.count as usize, 0)?;
    }
    scenario.bridge()?;
    scenario.vehicle()?;
    scenario.simulation()?;
    if let Some(judged) = scenario.judged()? {
        let (_, quantities) = judged.scenario.crossing()?;
        judged.build(&quantities)?;
    }
    scenario.density()?;
    scenario.reliability()?;
    scenario.exact()?;
    Ok(())
}

#[test]
fn each_bad_scenario_gives_its_exact_message() {
    let mut count = 0;
    let mut wrong = Vec::new();
    for entry in std::fs::read_dir(repository().join("tests/bad")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        count += 1;
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let expected = std::fs::read_to_string(path.with_extension("txt")).unwrap_or_default();
        let found = match read_all(name, &text) {
            Ok(()) => "no error".to_owned(),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "{name}");
                error.to_string()
            }
        };
        if found != expected.trim_end() {
            wrong.push(format!("{name}\n  found    {found}\n  expected {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count >= 25, "{count} bad scenarios");
}
