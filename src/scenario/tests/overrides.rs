//! What overrides make of the text.

use super::*;

#[test]
fn without_overrides_the_text_is_the_files() {
    let text = "# title\r\n[density]   # smoothing\r\n points_per_time  =  512";
    assert_eq!(Scenario::from_text("s.toml", text).unwrap().text(), text);
}

/// The text of `text` after `options`; it reads back as the same scenario.
fn after(text: &str, options: &[&str]) -> String {
    let scenario = Scenario::from_text("s.toml", text)
        .unwrap()
        .set(&sets(options))
        .unwrap();
    let again = Scenario::from_text("s.toml", scenario.text()).unwrap();
    let without_places = |s: &Scenario| {
        s.check_all()
            .map_err(|e| e.to_string().split_once(": ").unwrap().1.to_owned())
    };
    assert_eq!(without_places(&again), without_places(&scenario));
    scenario.text().to_owned()
}

#[test]
fn overrides_keep_the_comments() {
    let text =
        "# a\n[bridge] # b\nspan = 40.0   # m\nsection = [{ name = \"q\", position = 1 }] # c\n";
    assert_eq!(
        after(
            text,
            &[
                "bridge.span=32",
                "bridge.section.0.position = 8.5",
                "bridge.section.1.name=end"
            ]
        ),
        "# a\n[bridge] # b\nspan = 32   # m\n\
         section = [{ name = \"q\", position = 8.5 }, { name = \"end\" }] # c\n"
    );
    let points = "# a\n[points]\nrule = \"monte-carlo\"\n\n# b\n[bridge]\nspan = 1.0\n";
    assert_eq!(
        after(
            points,
            &[
                r#"points={ rule = "latin-hypercube", count = 9 }"#,
                "title=Two words"
            ]
        ),
        "title = \"Two words\"\n# a\n[points]\nrule = \"latin-hypercube\"\ncount = 9\n\n# b\n[bridge]\nspan = 1.0\n"
    );
}

#[test]
fn overrides_reach_lists_and_make_tables() {
    let limit = "[[reliability.limit]]\nname = \"a\"\nthreshold = 1.0\n";
    assert_eq!(
        after(
            limit,
            &[
                "reliability.limit.0.threshold=0.1",
                "reliability.limit.1.name=b"
            ]
        ),
        "[[reliability.limit]]\nname = \"a\"\nthreshold = 0.1\n\n[[reliability.limit]]\nname = \"b\"\n"
    );
    assert_eq!(
        after(
            limit,
            &[
                r#"reliability.limit.0={ name = "c" }"#,
                "reliability.confidence=0.9"
            ]
        ),
        "[reliability]\nconfidence = 0.9\n[[reliability.limit]]\nname = \"c\"\n"
    );
    assert_eq!(
        after(
            "",
            &[
                "reliability.limit.0.name=a",
                "density.smoothing.rule=silverman",
                "simulation.record.0=x"
            ]
        ),
        "[reliability]\n\n[[reliability.limit]]\nname = \"a\"\n\n[density]\n\n[density.smoothing]\n\
         rule = \"silverman\"\n\n[simulation]\nrecord = [\"x\"]\n"
    );
    let scenario = example().set(&sets(&[
        "simulation.record.1=bridge/midspan/velocity",
        "points.seed=2",
        "points.seed=3",
    ]));
    let scenario = scenario.unwrap();
    let record = scenario.simulation().unwrap().record;
    assert_eq!(
        record,
        ["bridge/midspan/displacement", "bridge/midspan/velocity"]
    );
    assert_eq!(scenario.points().unwrap().seed, 3);
}

#[test]
fn overrides_of_other_ways_to_write_a_table() {
    let dotted = "vehicle.kind = \"quarter-car\"\nvehicle.speed = 20 # m/s\n";
    let options = [
        "vehicle.speed=30",
        "vehicle.body_mass=1e4",
        "vehicle.bump_stop.gap=0.1",
    ];
    let text = after(dotted, &options);
    let vehicle: toml::Table = text.parse().unwrap();
    let expected: toml::Table =
        "kind = \"quarter-car\"\nspeed = 30\nbody_mass = 1e4\nbump_stop.gap = 0.1"
            .parse()
            .unwrap();
    assert_eq!(vehicle["vehicle"], toml::Value::Table(expected), "{text}");
    assert!(text.contains("vehicle.speed = 30 # m/s"), "{text}");

    let limits = "[reliability]\nconfidence = 0.9\n\n[[reliability.limit]]\nname = \"a\"\n";
    assert_eq!(
        after(limits, &[r#"reliability.limit=[{ name = "b" }]"#]),
        "[reliability]\nconfidence = 0.9\nlimit = [{ name = \"b\" }]\n"
    );
}

#[test]
fn an_override_without_a_value_removes() {
    let text = "# a\n[points]\nrule = \"monte-carlo\" # b\ntruncate_at = 3.0 # c\nseed = 1\n\n# d\n[density]\n";
    let removed = |options: &[&str]| after(text, options);
    assert_eq!(
        removed(&["points.truncate_at=", "density = "]),
        "# a\n[points]\nrule = \"monte-carlo\" # b\nseed = 1\n"
    );
    assert_eq!(removed(&["density.x=1", "density.x="]), text);
    let lists = "[bridge]\nsection = [{ name = \"q\", position = 1 }]\n\n[[reliability.limit]]\nname = \"a\"\n\n\
                 [[reliability.limit]]\nname = \"b\"\n";
    assert_eq!(
        after(
            lists,
            &["reliability.limit.0=", "bridge.section.0.position="]
        ),
        "[bridge]\nsection = [{ name = \"q\"}]\n\n[[reliability.limit]]\nname = \"b\"\n"
    );
    let scenario = example().set(&sets(&["simulation.record.0="])).unwrap();
    let record = scenario.simulation().unwrap().record;
    assert_eq!(record, ["vehicle/body/acceleration"]);
    // Entries after it have moved: the file's lines would be others.
    assert_eq!(scenario.place("simulation.record.0"), "--set");
    let missing = example().set(&sets(&["bridge.span="])).unwrap().bridge();
    assert_eq!(
        missing.unwrap_err().to_string(),
        "--set: bridge.span: missing: distance between the supports (m)"
    );
    // What is not there may be removed where it could be.
    let absent = [
        "bridge.section=",
        "bridge.section.0.name=",
        "irregularity.deterministic.amplitude=",
    ];
    assert_eq!(removed(&absent), text);
    for unknown in [
        "points.truncate=",
        "bridge.section.first=",
        "title.x=",
        "a=",
    ] {
        let key = unknown.trim_end_matches('=');
        assert_eq!(
            example().set(&sets(&[unknown])).unwrap_err().to_string(),
            format!("--set: {key}: expected a known key, to remove it, found an unknown one")
        );
    }
}
