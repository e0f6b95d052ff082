//! Images of the parts of a space, and their sum.
//!
//! Along an axis of half-width h a part has the response s h u + q h² u², −1 < u < 1, and the probability
//! (1 + τu)/2 of the space. Its image is about a box of half-width a with a density of tilt t,
//! (1 + t y/a)/2a, where
//!
//! ```text
//! e = |s| h,   f = |q| h²,   a = e,                t = sgn(s) τ − sgn(q) 2f/e       for 2f < e,
//!                            a = (e + 2f)²/8f,     t = sgn(s) τ e/2f − sgn(q)       where it folds,
//! ```
//!
//! so that its ends, its mean and, but for the fold, its density's slope are those of the image. Two axes make
//! the sum of two such boxes, a ≥ b. With its corners x = c + σa + ρb, σ, ρ = ∓1, and z = (y − x)₊,
//! its share below y is
//!
//! ```text
//! Σ σρ ((1 + σt_a + ρt_b) z² + (t_a/a + t_b/b) z³/3) / 8ab.
//! ```
//!
//! On evenly spaced places each corner is put down once, as the cubic that it adds from the first place beyond
//! it; one run over the places sums all cubics up.

use super::cumulative;
use super::parts::{Lanes, Parts, SIDE_BY_SIDE};
use super::quadratics::{PLANE_ROW, SPACE_ROW};
use crate::density::{Curve, Nodes};
use pulp::{Simd, WithSimd};

/// The half-widths a and b are at least this part of the distance of two places: what is finer makes no
/// difference there, and would be lost in rounding.
const LEAST: [f64; 2] = [0.125, 0.03125];
/// Below so many distances they have no tilt, for the same reason.
const TILTED: f64 = 1.5;

/// The images of all parts: of each the mean, a, t_a, b and t_b; up to whole lanes.
pub(super) struct Trapezoids<'a> {
    parts: &'a Parts,
    images: [Vec<f64>; VALUES],
}

/// The values of an image.
const VALUES: usize = 5;

/// Some images side by side.
type Image = [Lanes; VALUES];

impl<'a> Trapezoids<'a> {
    /// Of responses at the points and the quadratics' coefficients `[point][term]`.
    pub fn new(parts: &'a Parts, responses: &[f64], coefficients: &[f64]) -> Self {
        let arch = pulp::Arch::new();
        let images = match parts.half.len() {
            2 => arch.dispatch(Imaging::<2, PLANE_ROW> {
                parts,
                responses,
                coefficients,
            }),
            _ => arch.dispatch(Imaging::<3, SPACE_ROW> {
                parts,
                responses,
                coefficients,
            }),
        };
        Trapezoids { parts, images }
    }

    /// The least and the largest value.
    pub fn ends(&self) -> [f64; 2] {
        pulp::Arch::new().dispatch(Ends(self))
    }

    /// Their sum.
    pub fn curve(&self, nodes: Nodes) -> Curve {
        let sums = pulp::Arch::new().dispatch(Summing {
            images: self,
            places: cumulative::Places::new(nodes),
        });
        cumulative::curve(nodes, &sums)
    }
}

/// The work of [`Trapezoids::new`] in N dimensions with T terms, zeros among them, for the machine's vector units.
struct Imaging<'a, const N: usize, const T: usize> {
    parts: &'a Parts,
    responses: &'a [f64],
    coefficients: &'a [f64],
}

impl<const N: usize, const T: usize> WithSimd for Imaging<'_, N, T> {
    type Output = [Vec<f64>; VALUES];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [Vec<f64>; VALUES] {
        let parts = self.parts;
        // Lanes are written whole: what is left over of them is written again, or is at the end.
        let room = (parts.mass.len() + 1) * SIDE_BY_SIDE;
        let mut images: [Vec<f64>; VALUES] = std::array::from_fn(|_| vec![0.0; room]);
        let half: [f64; N] = std::array::from_fn(|axis| parts.half[axis]);
        let distance = parts.distance.as_chunks::<N>().0;
        let tilt = parts.tilt.as_chunks::<N>().0;
        let terms = self.coefficients.as_chunks::<T>().0;
        for ((lanes, terms), response) in parts.of_points().zip(terms).zip(self.responses) {
            for k in lanes {
                let image = image(
                    terms,
                    *response,
                    &distance[k],
                    &tilt[k],
                    &parts.share[k],
                    &half,
                );
                let at = parts.before[k] as usize;
                for (values, lanes) in images.iter_mut().zip(image) {
                    values[at..at + SIDE_BY_SIDE].copy_from_slice(&lanes);
                }
            }
        }
        images
    }
}

/// The image of parts by the quadratic of their point.
#[inline(always)]
fn image<const N: usize, const T: usize>(
    terms: &[f64; T],
    response: f64,
    distance: &[Lanes; N],
    tilt: &[Lanes; N],
    share: &Lanes,
    half: &[f64; N],
) -> Image {
    let mut mean = [response; SIDE_BY_SIDE];
    let [mut a, mut a_tilt, mut b, mut b_tilt] = [[0.0; SIDE_BY_SIDE]; 4];
    for lane in 0..SIDE_BY_SIDE {
        let mut slopes = [0.0; N];
        let mut bends = [0.0; N];
        let mut at = N;
        for i in 0..N {
            slopes[i] += terms[i];
            mean[lane] += terms[i] * distance[i][lane];
            bends[i] = terms[at];
            for j in i..N {
                mean[lane] += terms[at] * distance[i][lane] * distance[j][lane];
                slopes[i] += terms[at] * distance[j][lane];
                slopes[j] += terms[at] * distance[i][lane];
                at += 1;
            }
        }
        let mut rest = 0.0;
        for i in 0..N {
            let h = half[i] * share[lane];
            let e = slopes[i].abs() * h;
            let bent = bends[i] * h * h;
            mean[lane] += bent / 3.0;
            let f = bent.abs().max(1e-300);
            let folds = 2.0 * f > e;
            let extent = if folds {
                (e + 2.0 * f) * (e + 2.0 * f) / (8.0 * f)
            } else {
                e
            };
            let ratio = if folds { 0.5 * e / f } else { 2.0 * f / e };
            let [own, by_bend] = if folds { [ratio, 1.0] } else { [1.0, ratio] };
            let tilt = (tilt[i][lane].copysign(tilt[i][lane] * slopes[i]) * own
                - by_bend.copysign(bent))
            .clamp(-1.0, 1.0);
            // The two largest extents; the others widen the largest, by variance.
            let own = (extent, tilt);
            let largest = (a[lane], a_tilt[lane]);
            let (larger, smaller) = if extent > a[lane] {
                (own, largest)
            } else {
                (largest, own)
            };
            let second = (b[lane], b_tilt[lane]);
            let (middle, smallest) = if smaller.0 > b[lane] {
                (smaller, second.0)
            } else {
                (second, smaller.0)
            };
            (a[lane], a_tilt[lane]) = larger;
            (b[lane], b_tilt[lane]) = middle;
            rest += smallest * smallest;
        }
        if N > 2 {
            a[lane] = (a[lane] * a[lane] + rest).sqrt();
        }
    }
    [mean, a, a_tilt, b, b_tilt]
}

/// The least and the largest value of all images.
struct Ends<'a, 'b>(&'b Trapezoids<'a>);

impl WithSimd for Ends<'_, '_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; 2] {
        let images = &self.0.images;
        let images = images
            .each_ref()
            .map(|values| values.as_chunks::<SIDE_BY_SIDE>().0);
        let mut least = [f64::INFINITY; SIDE_BY_SIDE];
        let mut largest = [f64::NEG_INFINITY; SIDE_BY_SIDE];
        for row in 0..self.0.parts.mass.len() {
            let [mean, a, a_tilt, b, b_tilt] = images.map(|values| &values[row]);
            // Of what stands for no part nothing is left.
            let part = &self.0.parts.mass[row];
            for lane in 0..SIDE_BY_SIDE {
                let centre = mean[lane] - (a[lane] * a_tilt[lane] + b[lane] * b_tilt[lane]) / 3.0;
                let reach = a[lane] + b[lane];
                let (from, to) = (centre - reach, centre + reach);
                let is_part = part[lane] > 0.0;
                least[lane] = least[lane].min(if is_part { from } else { f64::INFINITY });
                largest[lane] = largest[lane].max(if is_part { to } else { f64::NEG_INFINITY });
            }
        }
        [
            least.into_iter().fold(f64::INFINITY, f64::min),
            largest.into_iter().fold(f64::NEG_INFINITY, f64::max),
        ]
    }
}

/// F at each place, then 1.
struct Summing<'a, 'b> {
    images: &'b Trapezoids<'a>,
    places: cumulative::Places,
}

impl WithSimd for Summing<'_, '_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<f64> {
        let Trapezoids { parts, images } = self.images;
        let places = self.places;
        // The coefficients of the cubic t³, t², t, 1 that starts at each place, in units of the distance of two;
        // what lies above all places comes last.
        let mut cubics = vec![[0.0f64; 4]; places.count + 1];
        let last = places.count as f64;
        let images = images
            .each_ref()
            .map(|values| values.as_chunks::<SIDE_BY_SIDE>().0);
        for (row, mass) in parts.mass.iter().enumerate() {
            let [mean, a, a_tilt, b, b_tilt] = images.map(|values| &values[row]);
            let [mut place, mut beyond, mut square, mut cube] = [[[0.0; SIDE_BY_SIDE]; 4]; 4];
            for lane in 0..SIDE_BY_SIDE {
                let in_places = |half: f64, tilt: f64, least: f64| {
                    let half = half * places.per_value;
                    (half.max(least), if half > TILTED { tilt } else { 0.0 })
                };
                let (a, t_a) = in_places(a[lane], a_tilt[lane], LEAST[0]);
                let (b, t_b) = in_places(b[lane], b_tilt[lane], LEAST[1]);
                let mean = (mean[lane] - places.start) * places.per_value;
                let centre = mean - (a * t_a + b * t_b) / 3.0;
                let weight = 0.125 * mass[lane] / (a * b);
                let cubic = weight * (t_a / a + t_b / b) / 3.0;
                let signs = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                for (k, (of_a, of_b)) in signs.into_iter().enumerate() {
                    let corner = centre + of_a * a + of_b * b;
                    place[k][lane] = corner.ceil().max(0.0).min(last);
                    beyond[k][lane] = place[k][lane] - corner;
                    square[k][lane] = of_a * of_b * weight * (1.0 + of_a * t_a + of_b * t_b);
                    cube[k][lane] = of_a * of_b * cubic;
                }
            }
            for lane in 0..SIDE_BY_SIDE {
                for k in 0..4 {
                    let (r, two, three) = (beyond[k][lane], square[k][lane], cube[k][lane]);
                    let added = [
                        three,
                        two + 3.0 * three * r,
                        (2.0 * two + 3.0 * three * r) * r,
                        (two + three * r) * r * r,
                    ];
                    let cubic = &mut cubics[place[k][lane] as usize];
                    for (sum, added) in cubic.iter_mut().zip(added) {
                        *sum += added;
                    }
                }
            }
        }
        let [mut three, mut two, mut one, mut own, mut below] = [0.0f64; 5];
        let mut sums: Vec<f64> = cubics[..places.count]
            .iter()
            .map(|cubic| {
                own += one + two + three + cubic[3];
                one += 2.0 * two + 3.0 * three + cubic[2];
                two += 3.0 * three + cubic[1];
                three += cubic[0];
                below = below.max(own).min(1.0);
                below
            })
            .collect();
        sums.push(1.0);
        sums
    }
}
