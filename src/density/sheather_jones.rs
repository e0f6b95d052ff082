//! The improved rule of Sheather and Jones for the smoothing width.
//!
//! Z. I. Botev, J. F. Grotowski, D. P. Kroese, Kernel density estimation via diffusion, Annals of
//! Statistics 38 (2010) 2916-2957, section 5. With values scaled to the unit interval, a_k the
//! coefficients of their cosine series and t = σ², the width is the smallest solution of
//!
//! ```text
//! t = [2 √π N f₂]^(−2/5),   f_s = ½ π^(2s) Σ_k k^(2s) a_k² exp(−k² π² t_s),   t₇ = t,
//! t_s = [ (1 + 2^(−s−1/2)) / 3 · 2 (1·3·5 ... (2s − 1)) / √(2π) / (N f_(s+1)) ]^(2/(3+2s)),  s = 6 ... 2,
//! ```
//!
//! f_s standing for the norm of the density's s-th derivative. No stage supposes a normal density, so
//! that separate peaks and edges keep their shape. N is N_eff.

use pulp::{Simd, WithSimd};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::PI;
use std::sync::{Arc, LazyLock};

/// Nodes of the unit interval: many, and few, which do for a width of some of their distances.
const MESH: usize = 2048;
const COARSE_MESH: usize = 512;
const ENOUGH: f64 = 8.0;
/// The values' range is widened by this share of it on either side.
const MARGIN: f64 = 0.1;
/// Stages, l in the paper.
const STAGES: i32 = 7;
/// The largest width, in units of the interval: t = 0.1 as in the paper's program.
const WIDEST: f64 = 0.316;
/// Steps of the search for the smallest solution.
const STEP: f64 = 2.0;

/// σ of values with their probabilities, between 1/2048 and 0.3 of their range, to a thousandth;
/// none where the equation has no solution there.
pub fn sheather_jones(pairs: &[(f64, f64)], effective_count: f64) -> Option<f64> {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (least, largest) = pairs
        .iter()
        .fold(ends, |(a, b), (x, _)| (a.min(*x), b.max(*x)));
    let length = (1.0 + 2.0 * MARGIN) * (largest - least);
    if length <= 0.0 {
        return None;
    }
    let start = least - MARGIN * (largest - least);
    let on = |transform: &Transform| on_mesh(pairs, effective_count, (start, length), transform);
    let coarse = on(&COARSE_TRANSFORM);
    let width = coarse.filter(|width| width * COARSE_MESH as f64 > ENOUGH);
    width.or_else(|| on(&TRANSFORM)).map(|width| width * length)
}

/// The width by the mesh of a transform over an interval, in units of its length.
fn on_mesh(
    pairs: &[(f64, f64)],
    effective_count: f64,
    (start, length): (f64, f64),
    transform: &Transform,
) -> Option<f64> {
    let mesh = transform.turns.len() as f64;
    let powers = cosine_powers(pairs, start, mesh / length, transform);
    smallest_width(&Series::new(&powers, effective_count), 1.0 / mesh)
}

/// The smallest solution from `least` on, in units of the interval.
fn smallest_width(series: &Series, least: f64) -> Option<f64> {
    let excess = |width: f64| width - series.next_width(width);
    let mut below = least;
    if excess(below) >= 0.0 {
        return Some(below);
    }
    while below < WIDEST {
        let above = STEP * below;
        if excess(above) >= 0.0 {
            return Some(root(excess, below, above));
        }
        below = above;
    }
    None
}

/// a_k² of the values, k = 1, 2, ..., from their shares among the mesh: the sharing's own, sinc⁴, is
/// divided out.
fn cosine_powers(pairs: &[(f64, f64)], start: f64, scale: f64, transform: &Transform) -> Vec<f64> {
    let mesh = transform.turns.len();
    let mut shares = vec![0.0; mesh];
    for (value, p) in pairs {
        // Cells have their middles at j + 1/2.
        let place = ((value - start) * scale - 0.5).max(0.0);
        let node = (place as usize).min(mesh - 2);
        let upper = p * (place - node as f64);
        shares[node] += p - upper;
        shares[node + 1] += upper;
    }
    let total: f64 = pairs.iter().map(|x| x.1).sum();
    // J. Makhoul's order (IEEE Trans. Acoust. Speech Signal Process. 28 (1980) 27-34): even ones
    // ascending, then odd ones descending; their Fourier transform, turned, is the cosine transform.
    let even = shares.iter().step_by(2);
    let odd = shares.iter().skip(1).step_by(2).rev();
    let mut line: Vec<Complex<f64>> = even
        .chain(odd)
        .map(|share| Complex::new(share / total, 0.0))
        .collect();
    transform.fourier.process(&mut line);
    let terms = line.iter().zip(&transform.turns).skip(1);
    terms
        .map(|(value, turn)| {
            let coefficient = value.re * turn.re - value.im * turn.im;
            coefficient * coefficient
        })
        .collect()
}

/// The Fourier transform of a mesh and 2 exp(−i π k / 2n) / sinc²(π k / 2n).
struct Transform {
    fourier: Arc<dyn Fft<f64>>,
    turns: Vec<Complex<f64>>,
}

impl Transform {
    fn new(mesh: usize) -> Self {
        let turn = |k: usize| {
            let angle = PI * k as f64 / (2 * mesh) as f64;
            let sinc = if k == 0 { 1.0 } else { angle.sin() / angle };
            Complex::from_polar(2.0 / (sinc * sinc), -angle)
        };
        Transform {
            fourier: FftPlanner::new().plan_fft_forward(mesh),
            turns: (0..mesh).map(turn).collect(),
        }
    }
}

static TRANSFORM: LazyLock<Transform> = LazyLock::new(|| Transform::new(MESH));
static COARSE_TRANSFORM: LazyLock<Transform> = LazyLock::new(|| Transform::new(COARSE_MESH));

/// Terms that run side by side, for the vector units: n below.
const WIDE: usize = 8;

/// k^(2s) a_k² for each s, k = 1, 2, ...
struct Series {
    /// Of s = 2 ... 7.
    weighted: Vec<Vec<f64>>,
    count: f64,
}

impl Series {
    fn new(powers: &[f64], count: f64) -> Self {
        let squares: Vec<f64> = (1..=powers.len()).map(|k| (k * k) as f64).collect();
        let raised = |lower: &[f64]| -> Vec<f64> {
            lower.iter().zip(&squares).map(|(a, k)| a * k).collect()
        };
        let mut weighted = vec![raised(&raised(powers))];
        for _ in 3..=STAGES {
            weighted.push(raised(&weighted[weighted.len() - 1]));
        }
        Series { weighted, count }
    }

    /// The right side of the equation, as a width.
    fn next_width(&self, width: f64) -> f64 {
        let mut norm = self.derivative_norm(STAGES, width * width);
        for s in (2..STAGES).rev() {
            let odd: f64 = (1..=s).map(|k| f64::from(2 * k - 1)).product();
            let factor = (1.0 + 0.5f64.powf(f64::from(s) + 0.5)) / 3.0;
            let ratio = 2.0 * factor * odd / (2.0 * PI).sqrt() / (self.count * norm);
            let time = ratio.powf(2.0 / f64::from(3 + 2 * s));
            norm = self.derivative_norm(s, time);
        }
        (2.0 * self.count * PI.sqrt() * norm).powf(-0.2)
    }

    /// f_s at time t. The exponentials follow from each other,
    /// e^(−(k+n)² c) = e^(−k² c) e^(−(2kn + n²) c), n the terms side by side.
    fn derivative_norm(&self, order: i32, time: f64) -> f64 {
        pulp::Arch::new().dispatch(Norm {
            series: self,
            order,
            time,
        })
    }

    #[inline(always)]
    fn derivative_norm_wide(&self, order: i32, time: f64) -> f64 {
        let c = PI * PI * time;
        let weighted = &self.weighted[(order - 2) as usize];
        // Beyond it the terms are below 1e-30 of the largest.
        let terms =
            (((70.0 + 16.0 * f64::from(order)) / c).sqrt() as usize + 1).min(weighted.len());
        // All of them are powers of e^(−c).
        let one = (-c).exp();
        let square = one * one;
        let to_16 = square.powi(8);
        let to_64 = to_16.powi(4);
        let turn = to_64 * to_64;
        let (mut decay, mut factor) = ([one; WIDE], [to_64 * to_16; WIDE]);
        let mut ratio = square * one;
        for j in 1..WIDE {
            decay[j] = decay[j - 1] * ratio;
            factor[j] = factor[j - 1] * to_16;
            ratio *= square;
        }
        let mut sums = [0.0; WIDE];
        let (rows, rest) = weighted[..terms].as_chunks::<WIDE>();
        for row in rows {
            for j in 0..WIDE {
                sums[j] += row[j] * decay[j];
                decay[j] *= factor[j];
                factor[j] *= turn;
            }
        }
        let rest: f64 = rest.iter().zip(decay).map(|(a, decay)| a * decay).sum();
        0.5 * PI.powi(2 * order) * (sums.iter().sum::<f64>() + rest)
    }
}

/// The work of [`Series::derivative_norm`], for the machine's vector units.
struct Norm<'a> {
    series: &'a Series,
    order: i32,
    time: f64,
}

impl WithSimd for Norm<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        self.series.derivative_norm_wide(self.order, self.time)
    }
}

/// The zero between two widths, by regula falsi with halved ends (Illinois).
fn root(excess: impl Fn(f64) -> f64, below: f64, above: f64) -> f64 {
    let (mut a, mut b) = ((below, excess(below)), (above, excess(above)));
    for _ in 0..60 {
        let middle = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let value = excess(middle);
        if (middle - b.0).abs() < 1e-5 * middle || value == 0.0 {
            return middle;
        }
        if (value > 0.0) == (b.1 > 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (middle, value);
    }
    b.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::{MonteCarlo, PointRule};

    #[test]
    fn few_nodes_do_where_they_are_taken() {
        let count = 984;
        let mut normals = vec![0.0; count];
        MonteCarlo::new(count, 1, 3).standard_normals(0..count, &mut normals);
        let cases: [fn(f64) -> f64; 4] = [
            |x| x,
            |x| (0.3 * x).exp(),
            |x| x + x.signum(),
            |x| x * (1.0 - 0.05 * x.abs()),
        ];
        let mut taken = 0;
        for of in cases {
            let mut sorted: Vec<(f64, f64)> = normals
                .iter()
                .map(|x| (of(*x), 1.0 / count as f64))
                .collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let length = sorted[count - 1].0 - sorted[0].0;
            let over = (sorted[0].0 - 0.1 * length, 1.2 * length);
            let on = |transform| on_mesh(&sorted, count as f64, over, transform).unwrap();
            let (coarse, fine) = (on(&COARSE_TRANSFORM), on(&TRANSFORM));
            if coarse * COARSE_MESH as f64 > ENOUGH {
                assert!((coarse / fine - 1.0).abs() < 1e-3, "{coarse} {fine}");
                taken += 1;
            }
        }
        assert!(taken >= 2, "the few nodes were taken for {taken} cases");
    }
}
