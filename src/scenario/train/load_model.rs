//! The load models HSLM-A of EN 1991-2.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::system::train::Axle;

/// A load model of a standard: constant forces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadModelSpec {
    /// Load model.
    pub model: LoadModelKind,
    /// Speed along the track (m/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed: f64,
    /// Distance from the first force to the bridge's first end at the start (m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub approach: f64,
}

/// A universal train HSLM-A of EN 1991-2, 6.4.6.1.1: power car, end coach, N intermediate coaches of length D, end coach,
/// power car; all axles of a train have the same force P.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum LoadModelKind {
    /// N = 18, D = 18 m, d = 2 m, P = 170 kN.
    #[serde(rename = "hslm-a1")]
    HslmA1,
    /// N = 17, D = 19 m, d = 3.5 m, P = 200 kN.
    #[serde(rename = "hslm-a2")]
    HslmA2,
    /// N = 16, D = 20 m, d = 2 m, P = 180 kN.
    #[serde(rename = "hslm-a3")]
    HslmA3,
    /// N = 15, D = 21 m, d = 3 m, P = 190 kN.
    #[serde(rename = "hslm-a4")]
    HslmA4,
    /// N = 14, D = 22 m, d = 2 m, P = 170 kN.
    #[serde(rename = "hslm-a5")]
    HslmA5,
    /// N = 13, D = 23 m, d = 2 m, P = 180 kN.
    #[serde(rename = "hslm-a6")]
    HslmA6,
    /// N = 13, D = 24 m, d = 2 m, P = 190 kN.
    #[serde(rename = "hslm-a7")]
    HslmA7,
    /// N = 12, D = 25 m, d = 2.5 m, P = 190 kN.
    #[serde(rename = "hslm-a8")]
    HslmA8,
    /// N = 11, D = 26 m, d = 2 m, P = 210 kN.
    #[serde(rename = "hslm-a9")]
    HslmA9,
    /// N = 11, D = 27 m, d = 2 m, P = 210 kN.
    #[serde(rename = "hslm-a10")]
    HslmA10,
}

/// From the last axle of a power car to the first of the end coach (m); the coach begins halfway.
const GAP: f64 = 3.525;

impl LoadModelKind {
    /// N, D (m), d (m) and P (N) of EN 1991-2, table 6.3.
    const fn row(self) -> (usize, f64, f64, f64) {
        match self {
            LoadModelKind::HslmA1 => (18, 18.0, 2.0, 170e3),
            LoadModelKind::HslmA2 => (17, 19.0, 3.5, 200e3),
            LoadModelKind::HslmA3 => (16, 20.0, 2.0, 180e3),
            LoadModelKind::HslmA4 => (15, 21.0, 3.0, 190e3),
            LoadModelKind::HslmA5 => (14, 22.0, 2.0, 170e3),
            LoadModelKind::HslmA6 => (13, 23.0, 2.0, 180e3),
            LoadModelKind::HslmA7 => (13, 24.0, 2.0, 190e3),
            LoadModelKind::HslmA8 => (12, 25.0, 2.5, 190e3),
            LoadModelKind::HslmA9 => (11, 26.0, 2.0, 210e3),
            LoadModelKind::HslmA10 => (11, 27.0, 2.0, 210e3),
        }
    }

    /// The axles, from the first backwards (EN 1991-2, figure 6.12):
    ///
    /// ```text
    /// power car   0, 3, 14, 17 m; then 3.525 m, in whose middle the end coach begins
    /// end coach   a bogie (two axles d apart) at its outer end, its first axle 3.525/2 m from that end
    /// coaches     of length D; a bogie in the middle of each joint between neighbours, N + 1 of them
    /// ```
    ///
    /// and the same backwards. The spacings, D − 3d/2 − 3.525/2 between the end coach's own bogie and the first joint's
    /// among them, are also those of the public program BeamDyn of KTH (Andersson).
    pub fn axles(self) -> Vec<Axle> {
        let (coaches, length, base, force) = self.row();
        let end_coach = length - 1.5 * base - 0.5 * GAP;
        let mut spacings = vec![3.0, 11.0, 3.0, GAP, base, end_coach];
        for _ in 0..coaches {
            spacings.extend([base, length - base]);
        }
        spacings.extend([base, end_coach, base, GAP, 3.0, 11.0, 3.0]);
        let mut behind = 0.0;
        let mut axles = vec![Axle { behind, force }];
        for spacing in spacings {
            behind += spacing;
            axles.push(Axle { behind, force });
        }
        axles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [LoadModelKind; 10] = [
        LoadModelKind::HslmA1,
        LoadModelKind::HslmA2,
        LoadModelKind::HslmA3,
        LoadModelKind::HslmA4,
        LoadModelKind::HslmA5,
        LoadModelKind::HslmA6,
        LoadModelKind::HslmA7,
        LoadModelKind::HslmA8,
        LoadModelKind::HslmA9,
        LoadModelKind::HslmA10,
    ];

    #[test]
    fn the_universal_trains_are_symmetric_and_as_long_as_their_coaches() {
        for model in ALL {
            let (coaches, length, base, force) = model.row();
            let axles = model.axles();
            // 4 P, 3 P, N times 2 P, 3 P, 4 P.
            assert_eq!(axles.len(), 2 * (4 + 3 + coaches), "{model:?}");
            assert!(axles.iter().all(|axle| axle.force == force));
            // Two power cars with half a gap each, and N + 2 coaches.
            let total = 2.0 * (17.0 + 0.5 * 3.525) + (coaches + 2) as f64 * length;
            let last = axles[axles.len() - 1].behind;
            assert!((last - total).abs() < 1e-9, "{model:?}: {last}");
            for (front, rear) in axles.iter().zip(axles.iter().rev()) {
                assert!((front.behind + rear.behind - total).abs() < 1e-9);
            }
            // The joints' bogies are in the joints.
            for joint in 0..=coaches {
                let first = 6 + 2 * joint;
                let middle = 0.5 * (axles[first].behind + axles[first + 1].behind);
                let end = 17.0 + 0.5 * 3.525 + (joint + 1) as f64 * length;
                assert!((middle - end).abs() < 1e-9);
                let apart = axles[first + 1].behind - axles[first].behind;
                assert!((apart - base).abs() < 1e-9);
            }
        }
        // HSLM-A1 is 397.525 m long.
        let last = LoadModelKind::HslmA1.axles().pop().unwrap();
        assert!((last.behind - 397.525).abs() < 1e-9);
    }
}
