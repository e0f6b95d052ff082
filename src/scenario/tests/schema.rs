//! The schema says everything that the specs read, and nothing else.

use std::collections::BTreeSet;

use serde_json::Value as Json;

use super::oscillator::{CHAIN_KINDS, SINGLE_OTHERWISE, chain, single};
use super::train::{TRAIN_KINDS, train};
use super::*;
use crate::scenario::schema;
use crate::scenario::shape::Shape;
use crate::scenario::train::{
    BallastedPreset, CarPreset, LoadModelKind, SlabPreset, WheelProfileKind,
};

/// Every schema in the scenario's schema, with its key; an alternative of a kind has the kind's key.
fn walk<'s>(key: &str, schema: &'s Json, found: &mut Vec<(String, &'s Json)>) {
    found.push((key.to_owned(), schema));
    match Shape::of(schema) {
        Shape::Number(..) | Shape::Integer(_) | Shape::Text { .. } | Shape::Choice(_) => {}
        Shape::List { items, .. } => walk(key, items, found),
        Shape::Table => walk_keys(key, schema, found),
        Shape::Tagged { alternatives, .. } => {
            for (_, schema) in alternatives {
                walk_keys(key, schema, found);
            }
        }
    }
}

fn walk_keys<'s>(key: &str, schema: &'s Json, found: &mut Vec<(String, &'s Json)>) {
    assert_eq!(schema["additionalProperties"], false, "{key}");
    for (name, property) in schema["properties"].as_object().into_iter().flatten() {
        if !property["const"].is_string() {
            walk(&format!("{key}.{name}"), property, found);
        }
    }
}

/// The keys of everything in `json` but the tags of kinds; list entries have the key of the list.
fn keys(key: &str, json: &Json, found: &mut BTreeSet<String>) {
    match json {
        Json::Null => {}
        Json::Object(map) => {
            found.insert(key.to_owned());
            for (name, value) in map {
                keys(&format!("{key}.{name}"), value, found);
            }
        }
        Json::Array(list) => {
            found.insert(key.to_owned());
            list.iter().for_each(|value| keys(key, value, found));
        }
        Json::Bool(_) | Json::Number(_) | Json::String(_) => {
            found.insert(key.to_owned());
        }
    }
}

fn is_tag(key: &str) -> bool {
    let tags = [
        ".vehicle.kind",
        ".vehicle.car.kind",
        ".vehicle.car.wheel_defect.kind",
        ".contact.kind",
        ".track.kind",
        ".excitation.spectrum.kind",
        ".excitation.modulation.kind",
        ".irregularity.spectrum.kind",
        ".irregularity.deterministic.kind",
        ".irregularity.smoothing.kind",
        ".density.smoothing.rule",
        ".random.distribution.kind",
        ".exact.case.kind",
        ".reliability.smoothing.rule",
    ];
    tags.contains(&key)
}

#[test]
fn the_parts_are_those_of_the_whole() {
    let whole = schema::shared()["properties"].as_object().unwrap();
    let names: Vec<&str> = schema::top_names().collect();
    assert_eq!(names, whole.keys().map(String::as_str).collect::<Vec<_>>());
    // What the whole says of a part is about the scenario; what the part says of itself, about any.
    let bare = |schema: &Json| {
        let mut schema = schema.as_object().unwrap().clone();
        for key in ["$schema", "title", "description"] {
            schema.remove(key);
        }
        schema
    };
    for name in names {
        assert_eq!(bare(schema::part(name)), bare(&whole[name]), "{name}");
    }
}

#[test]
fn the_specs_and_the_schema_have_the_same_keys() {
    let schema = json_schema();
    let mut all = Vec::new();
    walk("", &schema, &mut all);
    let in_schema: BTreeSet<String> = all.into_iter().map(|(key, _)| key).collect();

    let kinds = |more: &[&str]| full().set(&sets(&[&KINDS[..], more].concat())).unwrap();
    let mut in_specs = BTreeSet::new();
    for scenario in [
        example(),
        full(),
        kinds(&[]),
        single(),
        single().set(&sets(&SINGLE_OTHERWISE)).unwrap(),
        chain(),
        chain().set(&sets(&CHAIN_KINDS[0])).unwrap(),
        chain().set(&sets(&CHAIN_KINDS[1])).unwrap(),
        train(),
        train().set(&sets(TRAIN_KINDS[0])).unwrap(),
        train().set(&sets(TRAIN_KINDS[1])).unwrap(),
        train().set(&sets(TRAIN_KINDS[2])).unwrap(),
        kinds(&[
            r#"density.smoothing={ rule = "factor" }"#,
            r#"reliability.smoothing={ rule = "fixed", width = 1 }"#,
            r#"random.0.distribution={ kind = "gamma", mean = 2.6e9, coefficient_of_variation = 0.1 }"#,
        ]),
        kinds(&[r#"density.smoothing={ rule = "cell-image" }"#]),
    ]
    .into_iter()
    .chain(TRACKS.iter().map(|track| kinds(track)))
    {
        let specs = serde_json::to_value(scenario.check_all().unwrap()).unwrap();
        keys("", &specs, &mut in_specs);
    }
    in_specs.retain(|key| !is_tag(key));
    assert_eq!(in_specs, in_schema);
}

#[test]
fn every_key_is_described_and_every_number_has_its_unit() {
    let schema = json_schema();
    let mut all = Vec::new();
    walk("", &schema, &mut all);
    assert!(all.len() > 60);
    let without_unit = [
        ".bridge.damping_ratio",
        ".density.evolution.absorbing.threshold",
        ".density.evolution.courant",
        ".excitation.spectrum.ground_damping_ratio",
        ".excitation.spectrum.filter_damping_ratio",
        ".oscillator.rayleigh.damping_ratio",
        ".oscillator.damping_ratio",
        ".oscillator.power_law_damping.exponent",
        ".oscillator.bouc_wen.post_yield_ratio",
        ".oscillator.bouc_wen.amplitude",
        ".oscillator.bouc_wen.beta",
        ".oscillator.bouc_wen.gamma",
        ".oscillator.bouc_wen.exponent",
        ".oscillator.storey.damping_ratio",
        ".oscillator.storey.power_law_damping.exponent",
        ".oscillator.storey.bouc_wen.post_yield_ratio",
        ".oscillator.storey.bouc_wen.amplitude",
        ".oscillator.storey.bouc_wen.beta",
        ".oscillator.storey.bouc_wen.gamma",
        ".oscillator.storey.bouc_wen.exponent",
        ".density.smoothing.factor",
        ".density.smoothing.width",
        ".exact.case.damping_ratio",
        ".irregularity.deterministic.scale",
        ".irregularity.spectrum.waviness",
        ".reliability.confidence",
        ".reliability.limit.threshold",
        ".reliability.smoothing.factor",
        ".reliability.smoothing.width",
        ".correlation.coefficient",
        ".vehicle.suspension_damping_ratio",
        ".simulation.index.static_response",
    ];
    // These have the unit of the random parameter.
    let of_any_unit = ".random.distribution.";
    let lists_of_names = [
        ".correlation.keys",
        ".density.quantities",
        ".simulation.record",
        ".study.set",
        ".study.counts",
        ".study.points.set",
        ".study.points.counts",
        ".study.density.set",
        ".study.density.with",
    ];
    for (key, schema) in all {
        let is_entry = lists_of_names.contains(&key.as_str());
        let is_described = schema["description"].is_string();
        assert!(is_described || is_entry, "{key}");
        if let Shape::Number(_, unit) = Shape::of(schema) {
            assert_eq!(
                unit.is_none(),
                without_unit.contains(&key.as_str()) || key.starts_with(of_any_unit),
                "{key}"
            );
        }
    }
}

#[test]
fn every_choice_is_one_that_serde_knows() {
    fn read<T: serde::de::DeserializeOwned>(json: Json) {
        serde_json::from_value::<T>(json).unwrap();
    }
    let schema = json_schema();
    let mut all = Vec::new();
    walk("", &schema, &mut all);
    let mut count = 0;
    for (key, schema) in all {
        let Shape::Choice(choices) = Shape::of(schema) else {
            continue;
        };
        for choice in choices {
            count += 1;
            let json = Json::from(choice);
            match key.as_str() {
                ".points.rule" => {
                    read::<RuleKind>(json.clone());
                    let rule: RuleKind = serde_json::from_value(json).unwrap();
                    assert_eq!(rule.name(), choice);
                }
                ".irregularity.field" | ".excitation.field" => {
                    read::<FieldKind>(json.clone());
                    let field: FieldKind = serde_json::from_value(json).unwrap();
                    assert_eq!(field.name(), choice);
                }
                ".excitation.component" | ".oscillator.excitation" => read::<LoadKind>(json),
                ".excitation.spectrum.sided" => read::<Sided>(json),
                ".excitation.spectrum.unit" => read::<FrequencyUnit>(json),
                ".oscillator.interpolation" => read::<InterpolationKind>(json),
                ".irregularity.spectrum.form" => read::<FilterForm>(json),
                ".irregularity.spectrum.sided" => read::<Sided>(json),
                ".irregularity.spectrum.unit" => read::<WavenumberUnit>(json),
                ".irregularity.spectrum.class" => read::<RoadClassKind>(json),
                ".irregularity.spectrum.level" => read::<RoadLevelKind>(json),
                ".irregularity.spectrum.disturbance" => read::<DisturbanceKind>(json),
                ".irregularity.spectrum.component" => read::<TrackComponentKind>(json),
                ".irregularity.spectrum.quality" => read::<SncfQualityKind>(json),
                ".irregularity.spectrum.set" => read::<MainLineKind>(json),
                ".simulation.integrator" => read::<IntegratorKind>(json),
                ".simulation.initial_state" => read::<InitialState>(json),
                ".simulation.solution" => read::<SolutionKind>(json),
                ".simulation.precision" => read::<Precision>(json),
                ".simulation.compression" => read::<Compression>(json),
                ".simulation.index.kind" => {
                    read::<IndexKind>(json.clone());
                    let kind: IndexKind = serde_json::from_value(json).unwrap();
                    assert_eq!(kind.name(), choice);
                }
                ".simulation.index.direction" => read::<DirectionKind>(json),
                ".simulation.index.weighting" => read::<WeightingKind>(json),
                ".random.distribution.extreme" => read::<ExtremeKind>(json),
                ".random.distribution.rows" => read::<RowsKind>(json),
                ".correlation.of" => read::<CorrelationKind>(json),
                ".density.method" => read::<MethodKind>(json),
                ".density.evolution.velocity" => read::<VelocityKind>(json),
                ".density.evolution.absorbing.kind" => read::<LimitKind>(json),
                ".density.smoothing.kernel" => read::<CellKernelKind>(json),
                ".density.grid" => read::<GridKind>(json),
                ".reliability.limit.kind" => read::<LimitKind>(json),
                ".bridge.kind" => read::<SpansKind>(json),
                ".bridge.damping" => read::<DeckDampingKind>(json),
                ".vehicle.model" => read::<LoadModelKind>(json),
                ".vehicle.car.preset" => read::<CarPreset>(json),
                ".contact.wheel_profile" => read::<WheelProfileKind>(json),
                ".track.preset" => match choice {
                    "zhai-2004-ballasted" => read::<BallastedPreset>(json),
                    _ => read::<SlabPreset>(json),
                },
                ".study.reference" => read::<ReferenceKind>(json),
                other => panic!("{other} is not tested here"),
            }
        }
    }
    assert_eq!(count, 151);
}
