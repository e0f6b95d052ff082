//! Sperling's ride index of an acceleration, in its two forms.
//!
//! By lines, with A_k the amplitude (m/s²) of the line at f_k (Hz), from 0.5 Hz to the Nyquist frequency:
//!
//! ```text
//! W_k = 3.57 (A_k³ F(f_k) / f_k)^(1/10),    W = (Σ W_k^10)^(1/10).
//! ```
//!
//! 3.57 goes with m/s²; with cm/s² it is 0.896, with parts of g 7.08. A broad band's W depends on the window, since N
//! lines of it each have an amplitude of order N^(−1/2): compare windows of one length (GB 5599 takes some 18 s).
//! Below 2.5 is excellent, 2.75 good, 3.0 fair.
//!
//! By filters, with G the one-sided spectral density of the acceleration in (cm/s²)²/Hz:
//!
//! ```text
//! Wz = (∫ B²(f) G(f) df)^(1/6.67),    0.5 Hz ≤ f ≤ 30 Hz.
//! ```
//!
//! Source of the first: GB 5599-85, cited from memory of the literature. Source of the filters: the public Matlab
//! function sperling.m of janiex.

/// Along which axis the acceleration is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    Vertical,
    Lateral,
}

impl Direction {
    /// Both.
    pub const ALL: [Direction; 2] = [Direction::Vertical, Direction::Lateral];

    /// The name in scenarios.
    pub fn name(self) -> &'static str {
        match self {
            Direction::Vertical => "vertical",
            Direction::Lateral => "lateral",
        }
    }
}

/// The lowest frequency of both forms (Hz).
pub(super) const LOWEST: f64 = 0.5;

/// The highest frequency of the form with filters (Hz).
pub(super) const HIGHEST: f64 = 30.0;

/// F(f) of the form by lines; 0 below 0.5 Hz.
///
/// ```text
/// vertical  0.325 f² (f < 5.9 Hz),  400/f² (f < 20 Hz),  1
/// lateral   0.8 f²   (f < 5.4 Hz),  650/f² (f < 26 Hz),  1
/// ```
pub fn line_weight(direction: Direction, frequency: f64) -> f64 {
    let f = frequency;
    let ([rise, fall], [peak, end]) = match direction {
        Direction::Vertical => ([0.325, 400.0], [5.9, 20.0]),
        Direction::Lateral => ([0.8, 650.0], [5.4, 26.0]),
    };
    match f {
        f if is_below(f, LOWEST) => 0.0,
        f if f < peak => rise * f * f,
        f if f < end => fall / (f * f),
        _ => 1.0,
    }
}

/// B(f) of comfort; 0 outside of 0.5 to 30 Hz.
///
/// ```text
/// B = b ((1.911 f² + (0.25 f²)²) / ((1 − 0.277 f²)² + (1.563 f − 0.0368 f³)²))^(1/2),
/// b = 0.737 lateral, 0.588 vertical
/// ```
pub fn comfort_filter(direction: Direction, frequency: f64) -> f64 {
    let scale = match direction {
        Direction::Vertical => 0.588,
        Direction::Lateral => 0.737,
    };
    let (f, square) = (frequency, frequency * frequency);
    let above = 1.911 * square + (0.25 * square).powi(2);
    let below = (1.0 - 0.277 * square).powi(2) + (1.563 * f - 0.0368 * f * square).powi(2);
    within_band(f) * scale * (above / below).sqrt()
}

/// B(f) of ride quality, of both axes; 0 outside of 0.5 to 30 Hz.
///
/// ```text
/// B = 1.14 (((1 − 0.056 f²)² + (0.645 f)² 3.55 f²)
///          / (((1 − 0.252 f²)² + (1.547 f − 0.00444 f³)²) (1 + 3.55 f²)))^(1/2)
/// ```
pub fn ride_quality_filter(frequency: f64) -> f64 {
    let (f, square) = (frequency, frequency * frequency);
    let above = (1.0 - 0.056 * square).powi(2) + (0.645 * f).powi(2) * 3.55 * square;
    let below = (1.0 - 0.252 * square).powi(2) + (1.547 * f - 0.00444 * f * square).powi(2);
    within_band(f) * 1.14 * (above / (below * (1.0 + 3.55 * square))).sqrt()
}

/// W from the sum Σ A_k³ F_k/f_k.
pub(super) fn of_lines(sum: f64) -> f64 {
    3.57 * sum.powf(0.1)
}

/// Wz from the mean square of the filtered acceleration, (m/s²)².
pub(super) fn of_filtered(mean_square: f64) -> f64 {
    (1e4 * mean_square).powf(1.0 / 6.67)
}

fn within_band(frequency: f64) -> f64 {
    let is_within = !is_below(frequency, LOWEST) && !is_below(HIGHEST, frequency);
    f64::from(u8::from(is_within))
}

/// Below by more than rounding.
fn is_below(a: f64, b: f64) -> bool {
    a < b * (1.0 - 1e-9)
}
