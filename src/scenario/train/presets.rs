//! Published values of cars and tracks, each with its source.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::system::train::{Ballast, Fastener, OnBridge, Rail, RailVehicle, Slab};

/// The radius of a wheel where none is given: that of a new wheel of the Velaro and CRH3 trains (m).
pub(super) const WHEEL_RADIUS: f64 = 0.46;

/// A published set of values of a railway vehicle in the vertical plane; suspensions are of an axle and of a bogie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum CarPreset {
    /// Trailer of the ICE3 and CRH3 type, 24.275 m long. Zeng et al. 2014, Shock and Vibration 304219, table 1.
    #[serde(rename = "zeng-2014-trailer")]
    Zeng2014Trailer,
    /// Motor car of the ICE3 and CRH3 type, 24.275 m long. Zeng et al. 2014, Shock and Vibration 304219, table 1.
    #[serde(rename = "zeng-2014-motor")]
    Zeng2014Motor,
    /// Coach of the Velaro E, 24.775 m long. Goicolea 2014, as in the program TTB-2D.
    #[serde(rename = "velaro-e-coach")]
    VelaroECoach,
    /// Coaches C4 and C5 of the Velaro E, 24.775 m long. Goicolea 2014, as in the program TTB-2D.
    #[serde(rename = "velaro-e-coach-c4-c5")]
    VelaroECoachC4C5,
    /// Shinkansen S300, 25 m long. Wu and Yang 2003, as in the program TTB-2D.
    #[serde(rename = "shinkansen-s300")]
    ShinkansenS300,
    /// Vehicle 1 of the Manchester benchmarks, without a length. Iwnicki 1998, as in the program TTB-2D.
    #[serde(rename = "manchester-benchmark")]
    ManchesterBenchmark,
    /// Power car of the China Star, without a length. Zhai et al. 2009, as in the program TTB-2D.
    #[serde(rename = "china-star-power-car")]
    ChinaStarPowerCar,
    /// Double-deck coach, without a length. Zhai et al. 2009, as in the program TTB-2D.
    #[serde(rename = "double-deck-coach")]
    DoubleDeckCoach,
    /// Motor car of the Pioneer, without a length. Antolin et al. 2013, as in the program TTB-2D.
    #[serde(rename = "pioneer-m")]
    PioneerM,
    /// Trailer of the Pioneer, without a length. Antolin et al. 2013, as in the program TTB-2D.
    #[serde(rename = "pioneer-r")]
    PioneerR,
}

/// A car, and its length over couplers where the source gives it (m).
pub(super) struct CarValues {
    pub car: RailVehicle,
    pub length: Option<f64>,
}

/// M_c, J_c, M_t, J_t, M_w, k_p, c_p, k_s, c_s, 2 l_c, 2 l_t and the length.
type Row = ([f64; 11], Option<f64>);

impl CarPreset {
    #[rustfmt::skip]
    const fn row(self) -> Row {
        match self {
            //                                M_c      J_c         M_t     J_t     M_w     k_p       c_p     k_s       c_s      2 l_c   2 l_t
            CarPreset::Zeng2014Trailer     => ([44000.0, 2.7e6,      2400.0, 2200.0, 2400.0, 1.40e6,   8.0e4,  6.0e5,    8.0e4,   17.375, 2.5], Some(24.275)),
            CarPreset::Zeng2014Motor       => ([48000.0, 2.7e6,      3200.0, 7200.0, 2400.0, 2.08e6,   6.0e4,  8.0e5,    9.0e4,   17.375, 2.5], Some(24.275)),
            CarPreset::VelaroECoach        => ([47800.0, 1.957888e6, 3500.0, 1715.0, 1800.0, 2.4e6,    2.0e4,  7.0e5,    4.0e4,   17.375, 2.5], Some(24.775)),
            CarPreset::VelaroECoachC4C5    => ([41200.0, 1.687552e6, 3500.0, 1372.0, 1800.0, 2.4e6,    2.0e4,  7.0e5,    4.0e4,   17.375, 2.5], Some(24.775)),
            CarPreset::ShinkansenS300      => ([41750.0, 2.08e6,     3040.0, 3930.0, 1780.0, 1.18e6,   3.92e4, 5.3e5,    9.02e4,  17.5,   2.5], Some(25.0)),
            CarPreset::ManchesterBenchmark => ([32000.0, 1.97e6,     2615.0, 1476.0, 1813.0, 2.4e6,    8.0e3,  8.6e5,    4.0e4,   19.0,   2.56], None),
            CarPreset::ChinaStarPowerCar   => ([59364.2, 1.723e6,    5630.8, 9487.0, 1843.5, 4.7992e6, 6.0e4,  1.7716e6, 9.0e4,   11.46,  3.0], None),
            CarPreset::DoubleDeckCoach     => ([29600.0, 2.139e6,    1700.0, 1700.0, 1900.0, 1.746e6,  6.0e4,  8.2e5,    2.174e5, 18.0,   2.4], None),
            CarPreset::PioneerM            => ([42400.0, 1.0644e6,   3400.0, 7200.0, 2200.0, 1.04e6,   3.0e4,  4.0e5,    3.3e4,   18.0,   2.5], None),
            CarPreset::PioneerR            => ([44000.0, 2.74e6,     1700.0, 1700.0, 1900.0, 7.0e5,    3.8e4,  3.5e5,    4.0e4,   18.0,   2.5], None),
        }
    }

    pub(super) fn values(self) -> CarValues {
        let (row, length) = self.row();
        let [
            body_mass,
            body_pitch_inertia,
            bogie_mass,
            bogie_pitch_inertia,
            wheelset_mass,
            primary_stiffness,
            primary_damping,
            secondary_stiffness,
            secondary_damping,
            bogie_spacing,
            wheelbase,
        ] = row;
        CarValues {
            car: RailVehicle {
                body_mass,
                body_pitch_inertia,
                bogie_mass,
                bogie_pitch_inertia,
                wheelset_mass,
                primary_stiffness,
                primary_damping,
                secondary_stiffness,
                secondary_damping,
                bogie_spacing,
                wheelbase,
                // Not in the sources.
                wheel_radius: WHEEL_RADIUS,
                wheel_defects: Vec::new(),
            },
            length,
        }
    }
}

/// A published ballasted track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum BallastedPreset {
    /// Zhai, Wang and Lin 2004, Journal of Sound and Vibration 270: pad, ballast and subgrade of a seat, here doubled for
    /// the whole track, under two CHN60 rails, sleepers 0.6 m apart.
    #[serde(rename = "zhai-2004-ballasted")]
    Zhai2004Ballasted,
}

/// A published slab track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum SlabPreset {
    /// Zeng et al. 2014, Shock and Vibration 304219, table 2: pads and mortar of a rail, here doubled for the whole track,
    /// under two CHN60 rails; spacing and slabs as in CRTS I, 8 fasteners 0.629 m apart on each.
    #[serde(rename = "zeng-2014-slab")]
    Zeng2014Slab,
}

/// Rail and fasteners of a whole track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineValues {
    pub rail: Rail,
    /// Between fasteners (m).
    pub spacing: f64,
    pub fastener: Fastener,
}

/// Two CHN60 rails: E = 2.06e11 N/m2, I = 3.217e-5 m4, 60.64 kg/m each.
const CHN60: Rail = Rail {
    flexural_rigidity: 2.0 * 2.06e11 * 3.217e-5,
    mass_per_length: 2.0 * 60.64,
};

const fn spring(stiffness: f64, damping: f64) -> Fastener {
    Fastener { stiffness, damping }
}

impl BallastedPreset {
    pub(super) const fn values(self) -> (LineValues, Ballast) {
        match self {
            BallastedPreset::Zhai2004Ballasted => {
                let line = LineValues {
                    rail: CHN60,
                    spacing: 0.6,
                    fastener: spring(2.0 * 6.5e7, 2.0 * 7.5e4),
                };
                let (ballast, mass) = (spring(2.0 * 137.75e6, 2.0 * 5.88e4), 2.0 * 531.4);
                let support = Ballast {
                    sleeper_mass: 251.0,
                    ballast_mass: mass,
                    ballast,
                    subgrade: spring(2.0 * 77.5e6, 2.0 * 3.115e4),
                    on_bridge: OnBridge { bed: ballast, mass },
                };
                (line, support)
            }
        }
    }
}

impl SlabPreset {
    pub(super) const fn values(self) -> (LineValues, Slab) {
        match self {
            SlabPreset::Zeng2014Slab => {
                let line = LineValues {
                    rail: CHN60,
                    spacing: 0.629,
                    fastener: spring(2.0 * 5.0e7, 2.0 * 3.625e4),
                };
                let slab = Slab {
                    flexural_rigidity: 3.6e10 * 1.6e-3,
                    mass_per_length: 1200.0,
                    fasteners: 8,
                    mortar: spring(2.0 * 1.5e9, 2.0 * 8.3e4),
                };
                (line, slab)
            }
        }
    }
}
