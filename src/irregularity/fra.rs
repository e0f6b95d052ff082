//! Track irregularities by the classes of the Federal Railroad Administration (USA), over the angular wavenumber.
//!
//! ```text
//! vertical, alignment:   G(Ω) = k A Ω_c² / (Ω² (Ω² + Ω_c²)),
//! cross level, gauge:    G(Ω) = 4 k A_v Ω_c² / ((Ω² + Ω_c²)(Ω² + Ω_s²)),
//! k = 0.25,  Ω_c = 0.8245 rad/m;  A_v, A_a and Ω_s by class, 1 (the worst) ... 6.
//! ```
//!
//! One-sided, A in cm²·rad/m and G in cm²·m/rad at the source, here in m³/rad; usual band: wavelengths 1.524 ... 304.8 m.
//! [`super::FraFryba`] is another form of the same classes, of the vertical profile only, and far smoother: at a
//! wavelength of 10 m its densities are 13 (class 6) to 74 (class 4) times smaller. Which one is meant must be known.
//!
//! Source: A. Hamid, T. L. Yang, Analytical descriptions of track geometry variations, Transp. Res. Rec. 838 (1981)
//! 19-26, in the form that Chinese textbooks give it. A_v was compared with a program; A_a and Ω_s are as the
//! literature quotes them.

use super::{PowerSpectralDensity, TrackComponent, of_one_sided};

const CUT_OFF: f64 = 0.8245;
const K: f64 = 0.25;
/// A_v, A_a (cm²·rad/m), Ω_s (rad/m) of the classes 1 to 6.
const CLASSES: [[f64; 3]; 6] = [
    [1.2107, 3.3634, 0.6046],
    [1.0181, 1.2107, 0.9308],
    [0.6816, 0.4128, 0.8520],
    [0.5376, 0.3027, 1.1312],
    [0.2095, 0.0762, 0.8209],
    [0.0339, 0.0339, 0.4380],
];

/// A track of a class, by its angular form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fra {
    class: usize,
    component: TrackComponent,
}

impl Fra {
    /// A track of class 1 (the worst) to 6.
    ///
    /// # Panics
    /// If there is no such class.
    pub fn new(class: usize, component: TrackComponent) -> Self {
        assert!((1..=CLASSES.len()).contains(&class), "class {class}");
        Fra { class, component }
    }
}

impl PowerSpectralDensity for Fra {
    fn density(&self, wavenumber: f64) -> f64 {
        let [vertical, alignment, second] = CLASSES[self.class - 1];
        let (square, cut_off) = (wavenumber * wavenumber, CUT_OFF * CUT_OFF);
        let profile = |roughness: f64| roughness * cut_off / (square * (square + cut_off));
        let difference =
            || 4.0 * vertical * cut_off / ((square + cut_off) * (square + second * second));
        let square_centimetres = match self.component {
            TrackComponent::Vertical => profile(vertical),
            TrackComponent::Alignment => profile(alignment),
            TrackComponent::CrossLevel | TrackComponent::Gauge => difference(),
        };
        of_one_sided(1e-4 * K * square_centimetres)
    }

    fn singularity(&self) -> Option<f64> {
        match self.component {
            TrackComponent::Vertical | TrackComponent::Alignment => Some(0.0),
            TrackComponent::CrossLevel | TrackComponent::Gauge => None,
        }
    }
}
