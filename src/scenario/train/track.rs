//! The table `[track]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::presets::{BallastedPreset, SlabPreset};
use super::support::{
    self, BallastSpec, LineSpec, OnBridgeSpec, SlabSpec, SleeperSpec, SubgradeSpec,
};
use super::{Misfit, StaticWheel};
use crate::BadInput;
use crate::scenario::{Scenario, Table};
use crate::system::train::{Support, Track};

/// Track where `before` or `after` are not given (m).
const MARGIN: f64 = 20.0;

/// The window where it is not given (m).
const WINDOW: f64 = 8.0;

/// Fasteners, at most.
const MOST_FASTENERS: f64 = 1e6;

/// The track. All values are of the whole track: both rails, and both seats of a sleeper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum TrackSpec {
    /// Rail, pads, sleepers, ballast and subgrade.
    Ballasted(BallastedSpec),
    /// Rail, pads, slabs and mortar.
    Slab(SlabTrackSpec),
    /// Rail on pads on the ground or on the deck itself.
    Direct(DirectSpec),
    /// Wheels on the deck, and on rigid ground beside it.
    None,
}

/// A ballasted track. Every value that its preset has may be left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub struct BallastedSpec {
    /// Published values, where they are not given here.
    pub preset: Option<BallastedPreset>,
    #[serde(flatten)]
    pub line: LineSpec,
    /// Sleepers, one at each fastener.
    pub sleeper: Option<SleeperSpec>,
    /// Ballast, one block under each sleeper.
    pub ballast: Option<BallastSpec>,
    /// Subgrade under each block of ballast.
    pub subgrade: Option<SubgradeSpec>,
    /// Bed of the sleepers on the bridge: a spring, and ballast that moves with the deck.
    pub on_bridge: Option<OnBridgeSpec>,
}

/// A slab track. Every value that its preset has may be left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub struct SlabTrackSpec {
    /// Published values, where they are not given here.
    pub preset: Option<SlabPreset>,
    #[serde(flatten)]
    pub line: LineSpec,
    /// Slabs, the first of which begins at the track's start; one begins at the bridge's first end, unless `start` is given.
    pub slab: Option<SlabSpec>,
}

/// A rail on its pads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub struct DirectSpec {
    #[serde(flatten)]
    pub line: LineSpec,
}

/// What a track must reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// The train's last wheel at the start (m).
    pub first: f64,
    /// The train's first wheel at the end of the run (m).
    pub last: f64,
    /// The bridge's last end, where there is a bridge (m).
    pub bridge: Option<f64>,
}

impl Reach {
    /// That of a train of these wheels, whose first gets from `start` to `end` (m).
    pub fn new(wheels: &[StaticWheel], start: f64, end: f64, bridge: Option<f64>) -> Reach {
        let behind = wheels.last().map_or(0.0, |wheel| wheel.behind);
        Reach {
            first: start - behind,
            last: end,
            bridge,
        }
    }
}

impl TrackSpec {
    /// The track, where there is one; a misfit's key is below `track`.
    pub(super) fn build(&self, reach: &Reach) -> Result<Option<Track>, Misfit> {
        let (Some(track), Some(line)) = (self.values()?, self.line()) else {
            return Ok(None);
        };
        let group = match &track.support {
            Support::Direct | Support::Ballasted(_) => 1,
            Support::Slab(slab) => slab.fasteners,
        };
        let (start, fasteners) = line.extent(track.spacing, group, reach)?;
        Ok(Some(Track {
            start,
            fasteners,
            ..track
        }))
    }

    fn line(&self) -> Option<&LineSpec> {
        match self {
            TrackSpec::None => None,
            TrackSpec::Direct(spec) => Some(&spec.line),
            TrackSpec::Ballasted(spec) => Some(&spec.line),
            TrackSpec::Slab(spec) => Some(&spec.line),
        }
    }

    /// The track without its extent; a misfit's key is below `track`.
    pub(super) fn values(&self) -> Result<Option<Track>, Misfit> {
        let (line, values, support) = match self {
            TrackSpec::None => return Ok(None),
            TrackSpec::Direct(spec) => (&spec.line, spec.line.values(None)?, Support::Direct),
            TrackSpec::Ballasted(spec) => {
                let preset = spec.preset.map(BallastedPreset::values);
                let values = spec.line.values(preset.as_ref().map(|preset| &preset.0))?;
                let ballast = support::ballast(
                    &spec.sleeper.clone().unwrap_or_default(),
                    &spec.ballast.clone().unwrap_or_default(),
                    &spec.subgrade.clone().unwrap_or_default(),
                    &spec.on_bridge.clone().unwrap_or_default(),
                    preset.as_ref().map(|preset| &preset.1),
                )?;
                (&spec.line, values, Support::Ballasted(ballast))
            }
            TrackSpec::Slab(spec) => {
                let preset = spec.preset.map(SlabPreset::values);
                let values = spec.line.values(preset.as_ref().map(|preset| &preset.0))?;
                let slab = support::slab(
                    &spec.slab.clone().unwrap_or_default(),
                    preset.as_ref().map(|preset| &preset.1),
                )?;
                (&spec.line, values, Support::Slab(slab))
            }
        };
        Ok(Some(Track {
            start: 0.0,
            fasteners: 2,
            spacing: values.spacing,
            elements: line.elements_per_bay as usize,
            rail: values.rail,
            fastener: values.fastener,
            support,
            window: Some(line.window.unwrap_or(WINDOW)),
        }))
    }
}

impl LineSpec {
    /// The place of the first fastener (m), and the number of fasteners, a multiple of `group`.
    fn extent(&self, spacing: f64, group: usize, reach: &Reach) -> Result<(f64, usize), Misfit> {
        match (self.start, self.fasteners) {
            (Some(start), Some(fasteners)) => {
                let count = fasteners as usize;
                self.check_given(spacing, group, (start, count), reach)?;
                Ok((start, count))
            }
            (Some(_), None) => Err(Misfit::missing("fasteners").remedy("give it beside start")),
            (None, Some(_)) => Err(Misfit::missing("start").remedy("give it beside fasteners")),
            (None, None) => {
                let last = reach.bridge.unwrap_or(0.0).max(reach.last);
                let first = reach.first - self.before.unwrap_or(MARGIN);
                let last = last + self.after.unwrap_or(MARGIN);
                // A length that is a multiple of the spacing but for rounding is one.
                let group = group as f64;
                let first = (first / (spacing * group) + 1e-9).floor() * group;
                let last = (last / spacing - 1e-9).ceil();
                let count = ((last + 1.0 - first) / group).ceil() * group;
                if count > MOST_FASTENERS {
                    let expected = format!("at most {MOST_FASTENERS} fasteners on the train's way");
                    let found = format!("{count} ({spacing:?} m apart)");
                    return Err(Misfit::bad("fastener.spacing", expected, found));
                }
                // 0 + x, since minus zero would show.
                Ok((0.0 + first * spacing, count as usize))
            }
        }
    }

    fn check_given(
        &self,
        spacing: f64,
        group: usize,
        (start, count): (f64, usize),
        reach: &Reach,
    ) -> Result<(), Misfit> {
        for (key, given) in [("before", self.before), ("after", self.after)] {
            if let Some(given) = given {
                let expected = "no such key beside start and fasteners";
                return Err(Misfit::bad(key, expected, format!("{given:?}")));
            }
        }
        if !count.is_multiple_of(group) {
            let expected = format!("a multiple of the {group} fasteners of a slab");
            return Err(Misfit::bad("fasteners", expected, count.to_string()));
        }
        let end = start + (count - 1) as f64 * spacing;
        let off = "or leave start and fasteners out";
        if start > reach.first {
            let expected = format!(
                "at most {:?} (m), where the train's last wheel starts: it would be off the track",
                reach.first
            );
            return Err(Misfit::bad("start", expected, format!("{start:?}"))
                .remedy(format!("begin the track before, {off}")));
        }
        let needed = |to: f64| ((to - start) / spacing - 1e-9).ceil() + 1.0;
        if end < reach.last {
            let expected = format!(
                "at least {}, to {:.6} m, where the first wheel ends: it would run off the track",
                needed(reach.last),
                reach.last
            );
            let found = format!("{count}, to {end:.6} m");
            return Err(Misfit::bad("fasteners", expected, found)
                .remedy(format!("make the run shorter, {off}")));
        }
        if let Some(bridge) = reach.bridge
            && (start > 0.0 || end < bridge)
        {
            let expected = format!("a track over the whole bridge, from 0 to {bridge:?} (m)");
            let found = format!("one from {start:?} to {end:.6} m, which ends on it");
            return Err(Misfit::bad("fasteners", expected, found));
        }
        Ok(())
    }
}

impl Table for TrackSpec {
    const NAME: &'static str = "track";

    fn check(&self, _: &Scenario) -> Result<(), BadInput> {
        // Against the train's way: `Scenario::train`.
        Ok(())
    }
}
