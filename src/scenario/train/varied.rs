//! Trains whose parameters differ from point to point.

use serde_json::{Map, Value as Json};

use super::build::{Extent, Run, Specs};
use crate::Result;
use crate::ensemble::TrainCrossingOf;
use crate::scenario::Scenario;
use crate::system::train::TrainCrossing;

/// Whether the number at `key` says where something is, which all points share.
pub(in crate::scenario) fn is_geometry(key: &str) -> bool {
    let path: Vec<&str> = key.split('.').collect();
    match path.as_slice() {
        ["bridge", "span" | "spans" | "section", ..] => true,
        ["vehicle", "approach"] => true,
        ["vehicle", "car", _, rest @ ..] => matches!(
            rest,
            ["behind" | "length" | "bogie_spacing" | "wheelbase" | "wheel_radius"]
                | ["front" | "rear", "distance"]
                | ["axle", _, "behind"]
        ),
        ["track", "before" | "after" | "start" | "window"] | ["track", "fastener", "spacing"] => {
            true
        }
        _ => false,
    }
}

impl Scenario {
    /// The crossing of each point by its values of these keys, and the nominal one that goes with it: on the track that
    /// the fastest train needs. `fastest` (m/s) is the largest speed of all points, where it is random.
    ///
    /// # Errors
    /// Those of the tables; a train that runs off the track at its largest speed.
    pub fn varied_train(
        &self,
        nominal: &TrainCrossing,
        keys: &[String],
        fastest: Option<f64>,
    ) -> Result<(TrainCrossing, TrainCrossingOf)> {
        let specs = self.train_specs()?;
        let run = Run {
            gravity: nominal.gravity,
            time_step: nominal.time_step,
            steps: nominal.steps,
            record_every: nominal.record_every,
            initial_state: nominal.initial_state,
        };
        let speed = fastest.map_or(nominal.speed, |fastest| fastest.max(nominal.speed));
        let nominal = specs
            .build(&run, Extent::Speed(speed))
            .map_err(|misfit| misfit.in_scenario(self))?;
        let extent = match &nominal.track {
            Some(track) => Extent::Fixed {
                start: track.start,
                fasteners: track.fasteners,
            },
            None => Extent::Speed(speed),
        };
        let tables = serde_json::to_value(&specs).expect("specs are numbers and texts");
        let paths: Vec<Vec<String>> = keys
            .iter()
            .map(|key| key.split('.').map(str::to_owned).collect())
            .collect();
        let crossing_of: TrainCrossingOf = Box::new(move |values| {
            let mut tables = tables.clone();
            for (path, value) in paths.iter().zip(values) {
                set(&mut tables, path, *value);
            }
            let specs: Specs = serde_json::from_value(tables).expect("numbers for numbers");
            // What could be wrong is geometry, which does not vary.
            specs.build(&run, extent).expect("values within bounds")
        });
        Ok((nominal, crossing_of))
    }
}

/// Sets the number at `path`; tables on the way that are left out are made.
fn set(table: &mut Json, path: &[String], value: f64) {
    let Some((name, rest)) = path.split_first() else {
        *table = Json::from(value);
        return;
    };
    let entry = match table {
        Json::Array(list) => {
            let index: usize = name.parse().expect("an index into a list");
            &mut list[index]
        }
        other => {
            if other.is_null() {
                *other = Json::Object(Map::new());
            }
            let table = other.as_object_mut().expect("a table");
            table.entry(name.as_str()).or_insert(Json::Null)
        }
    };
    set(entry, rest, value);
}
