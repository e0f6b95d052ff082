//! Filtered histories and values a point, from the scenario to limits on them.

use crate::harness::Folder;
use dpim::files::recording::{Axis, Recordings};
use dpim::files::tables::read_reliability;
use std::collections::BTreeMap;

const JUDGED: &str = r#"
[[simulation.filter]]
quantity = "vehicle/wheel/contact_force"
low_pass = 20.0

[[simulation.index]]
name = "peak"
kind = "absolute-maximum"
quantity = "bridge/midspan/displacement"

[[simulation.index]]
name = "body"
kind = "root-mean-square"
quantity = "vehicle/body/acceleration"
window = { from = 0.5, to = 1.5 }

[[simulation.index]]
name = "comfort"
kind = "sperling"
quantity = "vehicle/body/acceleration"

[[simulation.index]]
name = "unloading"
kind = "unloading-ratio"
quantity = "vehicle/wheel/contact_force"
static_force = 122625.0

[[reliability.limit]]
name = "peak"
quantity = "index/peak"
kind = "upper"
threshold = 0.095
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    let text = format!("{}{JUDGED}", crate::harness::SCENARIO);
    folder.write("judged.toml", text);
    folder.done("excite -s judged.toml --set points.count=144 -o points.parquet");
    folder
}

/// `[time][point]` of every quantity.
fn values(folder: &Folder, name: &str) -> BTreeMap<String, Vec<Vec<f64>>> {
    let recordings = Recordings::open(&[folder.path(name)]).unwrap();
    let points = recordings.points();
    let mut all = BTreeMap::new();
    for (k, quantity) in recordings.quantities().iter().enumerate() {
        let times = recordings.times_of(k).len();
        assert_eq!(quantity.axis == Axis::Point, times == 1, "{quantity:?}");
        let mut values = vec![vec![f64::NAN; points]; times];
        let take = |blocks: &[dpim::response::Block<'_>]| {
            for block in blocks {
                values[block.time][block.first_point..][..block.values.len()]
                    .copy_from_slice(block.values);
            }
            Ok(())
        };
        recordings.scan(&[k], take).unwrap();
        all.insert(quantity.name.clone(), values);
    }
    all
}

#[test]
fn values_a_point_are_those_of_the_histories() {
    let folder = folder();
    folder.done(
        "simulate -s judged.toml points.parquet -o all.mcap --set 'simulation.record=[\"bridge/midspan/displacement\", \
         \"vehicle/body/acceleration\", \"vehicle/wheel/contact_force\"]'",
    );
    folder.done(
        "simulate -s judged.toml points.parquet -o thin.mcap --set simulation.record_every=7",
    );
    let (all, thin) = (values(&folder, "all.mcap"), values(&folder, "thin.mcap"));
    let history = |name: &str, point: usize| -> Vec<f64> {
        all[name].iter().map(|values| values[point]).collect()
    };
    let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let peaks = &all["index/peak"][0];
    for (point, peak) in peaks.iter().enumerate() {
        let displacement = history("bridge/midspan/displacement", point);
        let deflection: Vec<f64> = displacement.iter().map(|y| y.abs()).collect();
        assert_eq!(*peak, largest(&deflection));
        let body = &history("vehicle/body/acceleration", point)[50..150];
        let mean = body.iter().map(|y| y * y).sum::<f64>() / 100.0;
        assert!((all["index/body"][0][point] - mean.sqrt()).abs() < 1e-14);
        let force = history("vehicle/wheel/contact_force", point);
        let away: Vec<f64> = force.iter().map(|p| (p - 122_625.0).abs()).collect();
        let ratio = largest(&away) / 122_625.0;
        assert!((all["index/unloading"][0][point] - ratio).abs() < 1e-15);
        // 20 Hz are far above what moves here; the filter takes little.
        let filtered = history("vehicle/wheel/contact_force/filtered", point);
        for (p, f) in force.iter().zip(&filtered) {
            assert!((p - f).abs() < 0.01 * p, "{p} {f}");
        }
        assert_ne!(force, filtered);
    }
    // A thin recording has the same judgements, and of the histories each seventh value.
    assert!(!thin.contains_key("vehicle/wheel/contact_force"));
    for (name, values) in &thin {
        let expected: Vec<&Vec<f64>> = if name.starts_with("index/") {
            all[name].iter().collect()
        } else {
            all[name].iter().step_by(7).collect()
        };
        assert!(values.iter().eq(expected), "{name}");
    }
}

#[test]
fn a_limit_on_the_peak_is_the_first_passage_of_its_history() {
    let folder = folder();
    for threads in [1, 2] {
        folder.done(&format!(
            "simulate -s judged.toml points.parquet -o {threads}.mcap --threads {threads}"
        ));
    }
    assert!(folder.read("1.mcap") == folder.read("2.mcap"));
    folder.done("reliability 1.mcap -o reliability.parquet --extremes extremes.parquet");
    folder.done("density 1.mcap -o density.parquet");
    folder.done("plot reliability.parquet -o reliability.svg");
    folder.done("plot density.parquet --quantity index/comfort -o comfort.svg");
    folder.done("plot extremes.parquet --quantity peak -o extremes.svg");
    let table = read_reliability(&folder.path("reliability.parquet")).unwrap();
    let last = |limit: &str| {
        let rows = table.rows.iter();
        let mut own = rows.filter(|row| row.limit == limit && row.method == "counting");
        own.next_back().unwrap().failure_probability
    };
    let failure = last("peak");
    assert!(failure > 0.0 && failure < 1.0, "{failure}");
    assert_eq!(failure, last("deflection"));
}

#[test]
fn an_unloading_ratio_needs_a_static_force() {
    let folder = folder();
    // A road so rough that some wheels start in the air.
    folder.done(
        "excite -s judged.toml --set points.count=144 --set irregularity.spectrum.gamma=1e4 -o rough.parquet",
    );
    folder.done("simulate -s judged.toml rough.parquet -o given.mcap");
    let outcome = folder.run_in_vain(
        "simulate -s judged.toml rough.parquet -o first.mcap --set simulation.index.3.static_force=",
        1,
    );
    let error = outcome.error();
    assert!(error.contains("give static_force"), "{error}");
}
