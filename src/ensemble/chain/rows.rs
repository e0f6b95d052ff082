//! The constants of elements as rows of lanes, and which laws a chain has at all.

use crate::system::{BoucWen, Chain, Cubic, Element};

/// Rows of a storey's constants, in the order of [`constants`].
pub(super) const CONSTANTS: usize = 14;

/// Places in a storey's constants.
pub(super) mod at {
    pub const FLEXIBILITY: usize = 0;
    pub const STIFFNESS: usize = 1;
    pub const DAMPING: usize = 2;
    pub const MASS_DAMPING: usize = 3;
    pub const CUBIC: usize = 4;
    pub const POWER_LAW: usize = 5;
    pub const VAN_DER_POL: usize = 7;
    pub const HYSTERESIS: usize = 9;
}

pub(super) fn constants(element: &Element) -> [f64; CONSTANTS] {
    let ([power, exponent], [feed, brake]) = (element.power_law, element.van_der_pol);
    let [share, rise, one, other, sharpness] = element.hysteresis;
    [
        element.flexibility,
        element.stiffness,
        element.damping,
        element.mass_damping,
        element.cubic,
        power,
        exponent,
        feed,
        brake,
        share,
        rise,
        one,
        other,
        sharpness,
    ]
}

/// Which laws any storey of any point has: the others cost nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Laws {
    pub cubic: bool,
    pub power_law: bool,
    pub van_der_pol: bool,
    pub hysteresis: Option<Sharpness>,
}

/// The exponent n of hysteresis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sharpness {
    /// n = 1 everywhere: |z|ⁿ⁻¹ z and |z|ⁿ need no power.
    One,
    Any,
}

impl Laws {
    pub fn new<'k>(chain: &Chain, mut random: impl Iterator<Item = &'k str>) -> Self {
        let laws: Vec<&BoucWen> = chain
            .storeys
            .iter()
            .filter_map(|s| s.bouc_wen.as_ref())
            .collect();
        let (mut cubic, mut exponent) = (false, false);
        random.by_ref().for_each(|key| {
            cubic |= key.ends_with("cubic_stiffness") || key.ends_with("cubic_ratio");
            exponent |= key.ends_with("bouc_wen.exponent");
        });
        let is_straight = |cubic: &Cubic| match cubic {
            Cubic::Stiffness(value) | Cubic::Ratio(value) => *value == 0.0,
        };
        let sharpness = if exponent || laws.iter().any(|law| law.exponent != 1.0) {
            Sharpness::Any
        } else {
            Sharpness::One
        };
        Laws {
            cubic: cubic || !chain.storeys.iter().all(|s| is_straight(&s.cubic)),
            power_law: chain.storeys.iter().any(|s| s.power_law.is_some()),
            van_der_pol: chain.storeys.iter().any(|s| s.van_der_pol.is_some()),
            hysteresis: (!laws.is_empty()).then_some(sharpness),
        }
    }
}
