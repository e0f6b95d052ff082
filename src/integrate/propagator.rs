//! What a scheme does to one oscillator in one step.

/// q̈ + 2 a q̇ + ω² q = f.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// Undamped circular frequency ω (rad/s); zero for a rigid motion.
    pub frequency: f64,
    /// Decay rate a = ζ ω (1/s).
    pub decay: f64,
}

/// Which entries of A can differ from zero: the lockstep kernel has a loop for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// x = (q, q before): q⁺ = τ q − δ q⁻ + b f.
    TwoStep,
    /// x = (q, q before, q̇): as `TwoStep`, and q̇ from q, q̇ and f.
    TwoStepVelocity,
    /// x = (q, q̇), all entries.
    Dense2,
    /// x = (q, q̇, q̈ before), all entries.
    Dense3,
}

impl Pattern {
    /// The number of states of an oscillator.
    pub const fn states(self) -> usize {
        match self {
            Pattern::TwoStep | Pattern::Dense2 => 2,
            Pattern::TwoStepVelocity | Pattern::Dense3 => 3,
        }
    }
}

/// The map of one step; rows and columns beyond the pattern's states are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propagator {
    pub pattern: Pattern,
    /// A.
    pub transition: [[f64; 3]; 3],
    /// b: the share of the force f(n) in x(n+1).
    pub push: [f64; 3],
    /// c: q(n) = x₀(n) + c f(n) (s²).
    pub compliance: f64,
    /// w: q̇(n) = w·x(n) + d f(n).
    pub velocity: [f64; 3],
    /// d (s).
    pub velocity_push: f64,
    /// Columns: the shares of q(0), q̇(0) and f(0) in x(0).
    pub start: [[f64; 3]; 3],
}

impl Propagator {
    /// x(0) for given q(0), q̇(0) and f(0).
    pub fn initial(&self, q: f64, velocity: f64, force: f64) -> [f64; 3] {
        self.start
            .map(|row| row[0] * q + row[1] * velocity + row[2] * force)
    }

    /// x(n+1) from x(n) and f(n).
    pub fn advance(&self, x: [f64; 3], force: f64) -> [f64; 3] {
        std::array::from_fn(|i| {
            let row = self.transition[i];
            row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + self.push[i] * force
        })
    }

    /// q(n) from x(n) and f(n).
    pub fn displacement_of(&self, x: [f64; 3], force: f64) -> f64 {
        x[0] + self.compliance * force
    }

    /// q̇(n) from x(n) and f(n).
    pub fn velocity_of(&self, x: [f64; 3], force: f64) -> f64 {
        let w = self.velocity;
        w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + self.velocity_push * force
    }

    /// The same scheme without its velocity, where the displacement can do without it: cheaper.
    pub fn without_velocity(self) -> Propagator {
        match self.pattern {
            Pattern::TwoStepVelocity => Propagator {
                pattern: Pattern::TwoStep,
                transition: [self.transition[0], self.transition[1], [0.0; 3]],
                push: [self.push[0], 0.0, 0.0],
                velocity: [f64::NAN; 3],
                velocity_push: f64::NAN,
                start: [self.start[0], self.start[1], [0.0; 3]],
                ..self
            },
            Pattern::TwoStep | Pattern::Dense2 | Pattern::Dense3 => self,
        }
    }

    /// The same map for the coordinate q' = q / unit under the same force.
    pub fn scaled(self, unit: f64) -> Propagator {
        Propagator {
            push: self.push.map(|b| b / unit),
            compliance: self.compliance / unit,
            velocity_push: self.velocity_push / unit,
            start: self.start.map(|[q, v, f]| [q, v, f / unit]),
            ..self
        }
    }

    /// The map of a scheme that is given as x' = A s + b f(n) + c f(n+1) on the full state
    /// s = x + c f: in terms of x alone, b becomes A c + b.
    pub(super) fn from_full_state(
        pattern: Pattern,
        transition: [[f64; 3]; 3],
        push: [f64; 3],
        correction: [f64; 3],
        start: [[f64; 3]; 3],
    ) -> Propagator {
        let merged = std::array::from_fn(|i| {
            push[i]
                + (0..3)
                    .map(|j| transition[i][j] * correction[j])
                    .sum::<f64>()
        });
        let start = std::array::from_fn(|i| {
            let [q, v, f] = start[i];
            [q, v, f - correction[i]]
        });
        Propagator {
            pattern,
            transition,
            push: merged,
            compliance: correction[0],
            velocity: [0.0, 1.0, 0.0],
            velocity_push: correction[1],
            start,
        }
    }
}
