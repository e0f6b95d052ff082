//! A chain of oscillators: one mass, or the storeys of a shear building.
//!
//! Storey i has the displacement uᵢ (m) relative to the base, u₀ = 0. Its element stands between it and
//! the one below, with the drift dᵢ = uᵢ − uᵢ₋₁ and its rate ḋᵢ:
//!
//! ```text
//! mᵢ üᵢ = −fᵢ + fᵢ₊₁ − a₀ mᵢ u̇ᵢ − mᵢ a_g(t) + Fᵢ(t),        fᵢ = gᵢ(dᵢ, zᵢ) + hᵢ(dᵢ, ḋᵢ),
//! g = k d + k₃ d³                                                Duffing: k₃ = ε k
//! g = α k d + (1 − α) k d_y z + k₃ d³                            with hysteresis (Bouc, Wen)
//! d_y ż = A ḋ − β |ḋ| |z|ⁿ⁻¹ z − γ ḋ |z|ⁿ
//! h = (c + a₁ k) ḋ + c_p |ḋ|ᵖ sgn ḋ − μ (1 − (d/a)²) ḋ           linear, power law, van der Pol
//! ```
//!
//! a_g is the acceleration of the base (m/s²), F a force on the uppermost storey (N), a₀ and a₁ are
//! Rayleigh's. z has no unit; |z| ≤ (A/(β + γ))^(1/n) once it is there, which is 1 with A = 1 and
//! β + γ = 1: then d_y is the drift at which the element yields.
//!
//! Sources: B. van der Pol, Phil. Mag. 2 (1926) 978-992; Y.-K. Wen, J. Eng. Mech. Div. ASCE 102 (1976)
//! 249-263.

mod modes;
#[cfg(test)]
mod tests;

/// A chain and how its motion is integrated.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// From the base upward.
    pub storeys: Vec<Storey>,
    /// Damping of the whole chain besides its elements'.
    pub rayleigh: Option<Rayleigh>,
    /// What moves it.
    pub excitation: Option<Excitation>,
    /// h (s).
    pub time_step: f64,
    pub steps: usize,
    pub record_every: usize,
}

/// A mass and the element that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Storey {
    /// m (kg).
    pub mass: f64,
    pub stiffness: Stiffness,
    pub damping: Damping,
    pub cubic: Cubic,
    pub power_law: Option<PowerLaw>,
    pub van_der_pol: Option<VanDerPol>,
    pub bouc_wen: Option<BoucWen>,
    /// u(0) (m).
    pub initial_displacement: f64,
    /// u̇(0) (m/s).
    pub initial_velocity: f64,
}

/// k, as it is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffness {
    /// k (N/m).
    Stiffness(f64),
    /// ω₀ (rad/s): k = m ω₀².
    NaturalFrequency(f64),
}

/// c, as it is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// c (N s/m).
    Coefficient(f64),
    /// ζ: c = 2 ζ √(k m).
    Ratio(f64),
}

/// k₃, as it is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cubic {
    /// k₃ (N/m³).
    Stiffness(f64),
    /// ε (1/m²): k₃ = ε k.
    Ratio(f64),
}

/// c_p |ḋ|ᵖ sgn ḋ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    /// c_p (N (s/m)ᵖ).
    pub coefficient: f64,
    /// p.
    pub exponent: f64,
}

/// −μ (1 − (d/a)²) ḋ: feeds small motions, brakes large ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VanDerPol {
    /// μ (N s/m).
    pub coefficient: f64,
    /// a (m): the limit cycle of a weak one has the amplitude 2 a.
    pub amplitude: f64,
}

/// Smooth hysteresis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoucWen {
    /// d_y (m).
    pub yield_displacement: f64,
    /// α: stiffness far beyond yield, as a share of k.
    pub post_yield_ratio: f64,
    /// A.
    pub amplitude: f64,
    /// β.
    pub beta: f64,
    /// γ.
    pub gamma: f64,
    /// n.
    pub exponent: f64,
}

/// C = a₀ M + a₁ K, with the damping ratio asked for in two modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rayleigh {
    /// ζ in both.
    pub damping_ratio: f64,
    /// Which modes, counted from 1.
    pub modes: [usize; 2],
}

/// What moves a chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Excitation {
    pub load: Load,
    pub between: Interpolation,
}

/// Where the excitation acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// a_g.
    BaseAcceleration,
    /// F.
    Force,
}

/// The excitation between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// A cubic through the four nearest samples.
    Cubic,
    /// The last sample until the next one: white noise as a sequence of independent samples.
    Constant,
}

/// The constants of a storey as the equations of motion have them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// 1/m.
    pub flexibility: f64,
    /// k, or α k with hysteresis.
    pub stiffness: f64,
    /// c + a₁ k.
    pub damping: f64,
    /// a₀ (1/s).
    pub mass_damping: f64,
    /// k₃.
    pub cubic: f64,
    /// c_p, p.
    pub power_law: [f64; 2],
    /// μ, μ/a².
    pub van_der_pol: [f64; 2],
    /// (1 − α) k d_y; A, β, γ over d_y; n.
    pub hysteresis: [f64; 5],
}

impl Storey {
    /// k (N/m) of the undeformed element.
    pub fn stiffness(&self) -> f64 {
        match self.stiffness {
            Stiffness::Stiffness(k) => k,
            Stiffness::NaturalFrequency(omega) => self.mass * omega * omega,
        }
    }

    /// c (N s/m), without Rayleigh's.
    pub fn damping(&self) -> f64 {
        match self.damping {
            Damping::Coefficient(c) => c,
            Damping::Ratio(ratio) => 2.0 * ratio * (self.mass * self.stiffness()).sqrt(),
        }
    }

    /// The scalar that a scenario calls `key`, if it is given that way.
    pub fn scalar_mut(&mut self, key: &str) -> Option<&mut f64> {
        if let Some((table, key)) = key.split_once('.') {
            return match table {
                "power_law_damping" => match (key, self.power_law.as_mut()?) {
                    ("coefficient", law) => Some(&mut law.coefficient),
                    ("exponent", law) => Some(&mut law.exponent),
                    _ => None,
                },
                "van_der_pol" => match (key, self.van_der_pol.as_mut()?) {
                    ("coefficient", law) => Some(&mut law.coefficient),
                    ("amplitude", law) => Some(&mut law.amplitude),
                    _ => None,
                },
                "bouc_wen" => self.bouc_wen.as_mut()?.scalar_mut(key),
                _ => None,
            };
        }
        match (key, &mut self.stiffness, &mut self.damping, &mut self.cubic) {
            ("mass", ..) => Some(&mut self.mass),
            ("stiffness", Stiffness::Stiffness(k), ..) => Some(k),
            ("natural_frequency", Stiffness::NaturalFrequency(omega), ..) => Some(omega),
            ("damping", _, Damping::Coefficient(c), _) => Some(c),
            ("damping_ratio", _, Damping::Ratio(ratio), _) => Some(ratio),
            ("cubic_stiffness", .., Cubic::Stiffness(k)) => Some(k),
            ("cubic_ratio", .., Cubic::Ratio(ratio)) => Some(ratio),
            ("initial_displacement", ..) => Some(&mut self.initial_displacement),
            ("initial_velocity", ..) => Some(&mut self.initial_velocity),
            _ => None,
        }
    }

    /// Without Rayleigh damping.
    pub fn element(&self) -> Element {
        let k = self.stiffness();
        let hysteresis = self.bouc_wen.map(|law| {
            let y = law.yield_displacement;
            let share = (1.0 - law.post_yield_ratio) * k * y;
            let rates = [law.amplitude / y, law.beta / y, law.gamma / y];
            [share, rates[0], rates[1], rates[2], law.exponent]
        });
        Element {
            flexibility: 1.0 / self.mass,
            stiffness: self.bouc_wen.map_or(k, |law| law.post_yield_ratio * k),
            damping: self.damping(),
            mass_damping: 0.0,
            cubic: match self.cubic {
                Cubic::Stiffness(cubic) => cubic,
                Cubic::Ratio(ratio) => ratio * k,
            },
            power_law: self
                .power_law
                .map_or([0.0, 1.0], |law| [law.coefficient, law.exponent]),
            van_der_pol: self.van_der_pol.map_or([0.0; 2], |law| {
                [law.coefficient, law.coefficient / law.amplitude.powi(2)]
            }),
            hysteresis: hysteresis.unwrap_or([0.0, 0.0, 0.0, 0.0, 1.0]),
        }
    }
}

impl BoucWen {
    fn scalar_mut(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "yield_displacement" => Some(&mut self.yield_displacement),
            "post_yield_ratio" => Some(&mut self.post_yield_ratio),
            "amplitude" => Some(&mut self.amplitude),
            "beta" => Some(&mut self.beta),
            "gamma" => Some(&mut self.gamma),
            "exponent" => Some(&mut self.exponent),
            _ => None,
        }
    }
}

impl Chain {
    /// The recorded times (s).
    pub fn times(&self) -> Vec<f64> {
        (0..=self.steps)
            .step_by(self.record_every)
            .map(|n| n as f64 * self.time_step)
            .collect()
    }

    /// The scalar that a scenario calls `oscillator.` and `key`: `mass` of a single storey, `storey.0.mass`, or
    /// `rayleigh.damping_ratio`.
    pub fn scalar_mut(&mut self, key: &str) -> Option<&mut f64> {
        if key == "rayleigh.damping_ratio" {
            return self.rayleigh.as_mut().map(|r| &mut r.damping_ratio);
        }
        match key.strip_prefix("storey.") {
            Some(rest) => {
                let (index, key) = rest.split_once('.')?;
                let storey = self.storeys.get_mut(index.parse::<usize>().ok()?)?;
                storey.scalar_mut(key)
            }
            None => match self.storeys.as_mut_slice() {
                [only] => only.scalar_mut(key),
                _ => None,
            },
        }
    }

    /// The constants of each storey.
    pub fn elements(&self) -> Vec<Element> {
        let mut elements: Vec<Element> = self.storeys.iter().map(Storey::element).collect();
        if let Some(rayleigh) = self.rayleigh {
            let (mass, stiffness) = rayleigh.factors(&self.modes().0);
            for (element, storey) in elements.iter_mut().zip(&self.storeys) {
                element.mass_damping = mass;
                element.damping += stiffness * storey.stiffness();
            }
        }
        elements
    }
}
