//! Cars, from a moving force to the railway vehicle with ten degrees of freedom.

/// A car; distances along it are measured from its first wheel backwards.
#[derive(Debug, Clone, PartialEq)]
pub enum Car {
    /// Constant forces.
    MovingForces(Vec<Axle>),
    /// A mass that follows the deck or rail (kg).
    MovingMass {
        mass: f64,
    },
    /// A mass on spring and dashpot over a wheel.
    SprungMass {
        body_mass: f64,
        wheel_mass: f64,
        stiffness: f64,
        damping: f64,
    },
    HalfCar(HalfCar),
    RailVehicle(RailVehicle),
}

/// A constant force at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axle {
    /// From the car's first axle (m).
    pub behind: f64,
    /// N, downward positive.
    pub force: f64,
}

/// A body with bounce and pitch on two axles (four degrees of freedom).
#[derive(Debug, Clone, PartialEq)]
pub struct HalfCar {
    /// kg, and kg m² about the centre of mass.
    pub body_mass: f64,
    pub body_pitch_inertia: f64,
    /// Of the axles, front and rear (kg).
    pub wheel_mass: [f64; 2],
    /// Of the suspensions (N/m, N s/m).
    pub suspension_stiffness: [f64; 2],
    pub suspension_damping: [f64; 2],
    /// Of the tyres (N/m); none where the contact's own law holds.
    pub tyre_stiffness: Option<[f64; 2]>,
    /// From the centre of mass to the axles, front and rear (m, both positive).
    pub centre_to_axle: [f64; 2],
}

/// Body, two bogies and four wheelsets in the vertical plane (ten degrees of freedom).
#[derive(Debug, Clone, PartialEq)]
pub struct RailVehicle {
    /// M_c (kg), J_c (kg m²).
    pub body_mass: f64,
    pub body_pitch_inertia: f64,
    /// M_t, J_t, of each bogie.
    pub bogie_mass: f64,
    pub bogie_pitch_inertia: f64,
    /// M_w, of each wheelset.
    pub wheelset_mass: f64,
    /// Of the primary suspension, an axle (N/m, N s/m).
    pub primary_stiffness: f64,
    pub primary_damping: f64,
    /// Of the secondary suspension, a bogie.
    pub secondary_stiffness: f64,
    pub secondary_damping: f64,
    /// 2 l_c, between the bogies' centres; 2 l_t, between a bogie's axles (m).
    pub bogie_spacing: f64,
    pub wheelbase: f64,
    /// R (m).
    pub wheel_radius: f64,
}
