//! The contact of wheel and rail.

/// A contact law, of a whole axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact {
    /// The wheel follows the rail, in tension as well.
    Rigid,
    /// F = k δ, in tension as well; k (N/m) of an axle.
    Linear { stiffness: f64 },
    /// F = n (δ/G)^(3/2) for δ > 0, else 0, over the axle's n = 2 wheels; G (m/N^(2/3)) of one wheel.
    Hertz { constant: f64 },
}

/// The tread of a wheel, for Hertz's constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WheelProfile {
    Worn,
    Cone,
}

impl WheelProfile {
    /// G (m/N^(2/3)) of a wheel of radius R (m): 3.86e-8 R^(−0.115) worn, 4.57e-8 R^(−0.149) coned; Zhai,
    /// Vehicle-track coupled dynamics (from memory of the literature).
    pub fn constant(self, radius: f64) -> f64 {
        match self {
            WheelProfile::Worn => 3.86e-8 * radius.powf(-0.115),
            WheelProfile::Cone => 4.57e-8 * radius.powf(-0.149),
        }
    }
}

impl Contact {
    /// The stiffness of Hertz's law of an axle about its static force W (N): dF/dδ = 3/2 n (W/n)^(1/3) / G.
    pub fn linearised(constant: f64, weight: f64) -> f64 {
        1.5 * 2.0 * (weight / 2.0).cbrt() / constant
    }
}
