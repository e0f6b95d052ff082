//! The Foxglove layout beside the paper's scenario shows what that scenario records.

use std::collections::BTreeSet;
use std::path::Path;

use dpim::scenario::Scenario;
use serde_json::Value;

fn scenario() -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quarter-car.toml");
    Scenario::load(&path, &[]).unwrap()
}

fn layout() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quarter-car.foxglove.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The panels by their identity.
fn panels(layout: &Value) -> Vec<(&str, &Value)> {
    let panels = layout["configById"].as_object().unwrap();
    panels
        .iter()
        .map(|(id, panel)| (id.as_str(), panel))
        .collect()
}

/// The identities in the tree of the layout, each as often as it stands there.
fn leaves<'a>(node: &'a Value, found: &mut Vec<&'a str>) {
    if let Some(id) = node.as_str() {
        found.push(id);
        return;
    }
    assert!(["row", "column"].contains(&node["direction"].as_str().unwrap()));
    let share = node["splitPercentage"].as_f64().unwrap();
    assert!(share > 0.0 && share < 100.0, "{share}");
    leaves(&node["first"], found);
    leaves(&node["second"], found);
}

/// The message paths of a panel.
fn paths(panel: &Value) -> Vec<&str> {
    let series = panel["paths"].as_array().into_iter().flatten();
    let values = series.map(|path| &path["value"]);
    let single = panel.get("topicPath");
    values
        .chain(single)
        .map(|path| path.as_str().unwrap())
        .collect()
}

/// A path as topic, filter and slice: `/topic{filter}.values[slice]`.
fn parts(path: &str) -> (&str, &str, &str) {
    let (topic, rest) = path.split_once('{').unwrap();
    let (filter, rest) = rest.split_once('}').unwrap();
    let slice = rest.strip_prefix(".values[").unwrap();
    (topic, filter, slice.strip_suffix(']').unwrap())
}

#[test]
fn every_panel_is_placed_once_and_every_place_has_its_panel() {
    let layout = layout();
    let mut placed = Vec::new();
    leaves(&layout["layout"], &mut placed);
    let known: BTreeSet<&str> = panels(&layout).into_iter().map(|(id, _)| id).collect();
    assert_eq!(placed.iter().copied().collect::<BTreeSet<_>>(), known);
    assert_eq!(placed.len(), known.len());
    for id in known {
        let (kind, name) = id.split_once('!').unwrap();
        assert!(["Plot", "RawMessages", "GlobalVariableSliderPanel"].contains(&kind));
        assert!(!name.is_empty());
    }
}

#[test]
fn every_recorded_quantity_is_shown_for_a_point_and_for_all() {
    let layout = layout();
    let recorded = scenario().simulation().unwrap().record;
    let mut expected = BTreeSet::from([("/probability".to_owned(), "$lane", None)]);
    for quantity in &recorded {
        expected.insert((format!("/{quantity}"), "$lane", Some("timestamp")));
        expected.insert((format!("/{quantity}"), ":", Some("index")));
    }
    let mut shown = BTreeSet::new();
    for (_, panel) in panels(&layout) {
        for path in paths(panel) {
            let (topic, filter, slice) = parts(path);
            assert_eq!(filter, "first_point==$block", "{path}");
            shown.insert((topic.to_owned(), slice, panel["xAxisVal"].as_str()));
        }
    }
    assert_eq!(shown, expected);
}

#[test]
fn sliders_reach_every_point() {
    let layout = layout();
    let scenario = scenario();
    let waves = scenario.irregularity().unwrap().wavenumber.unwrap().count;
    let points = scenario
        .points()
        .unwrap()
        .build(2 * waves as usize, 0)
        .unwrap()
        .count();
    let mut variables = BTreeSet::new();
    for (id, panel) in panels(&layout) {
        if id.starts_with("GlobalVariableSliderPanel!") {
            let name = panel["globalVariableName"].as_str().unwrap();
            let range = &panel["sliderProps"];
            let value = |key: &str| range[key].as_u64().unwrap() as usize;
            assert_eq!(value("min"), 0);
            match name {
                "lane" => assert_eq!((value("step"), value("max")), (1, points - 1)),
                // Blocks of 4096 points, as `dpim check` says.
                "block" => assert!(value("step") == 4096 && value("max").is_multiple_of(4096)),
                other => panic!("{other}"),
            }
            variables.insert(name);
        }
    }
    let set = layout["globalVariables"].as_object().unwrap();
    assert_eq!(
        set.keys().map(String::as_str).collect::<BTreeSet<_>>(),
        variables
    );
    assert!(set.values().all(|value| value == 0));
}
