//! One point's probability on the nodes, and one step of the scheme.

/// Below this share of the point's probability an end of its window is not worth a node of its own: it is
/// added to the next node, so that nothing is lost.
const TAIL: f64 = f64::EPSILON;

/// The probability of one representative point, as shares of P_q: node by node where there is any.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Parcel {
    /// The first node.
    pub first: i64,
    /// From the first node on; empty once all is absorbed.
    pub shares: Vec<f64>,
}

/// Buffers of a step, for any number of parcels.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    old: Vec<f64>,
    flux: Vec<f64>,
}

impl Parcel {
    /// δ(y − y₀): all in one node.
    pub fn at(node: i64) -> Self {
        Parcel {
            first: node,
            shares: vec![1.0],
        }
    }

    /// One step of the total variation diminishing scheme with the Courant number r = v Δt/Δy, |r| ≤ 1:
    /// with Δ(j+½) = p(j+1) − p(j),
    ///
    /// ```text
    /// p(j) ← p(j) − ½ (r − |r|) Δ(j+½) − ½ (r + |r|) Δ(j−½) − ½ (|r| − r²) [φ(j+½) Δ(j+½) − φ(j−½) Δ(j−½)],
    /// φ(s) = max(0, min(2 s, 1), min(s, 2)),   s(j+½) = Δ(j−½)/Δ(j+½) for r > 0,  Δ(j+3/2)/Δ(j+½) for r < 0.
    /// ```
    ///
    /// It is written by what flows from each node to the next one downstream, so that what leaves one arrives
    /// at the other and a mirrored velocity mirrors each bit of the result.
    pub fn step(&mut self, r: f64, scratch: &mut Scratch) {
        let count = self.shares.len();
        if r == 0.0 || count == 0 {
            return;
        }
        let Scratch { old, flux } = scratch;
        old.clear();
        old.push(0.0);
        old.extend_from_slice(&self.shares);
        old.push(0.0);
        let (left, here, right) = (&old[..count], &old[1..=count], &old[2..]);
        let (up, down) = if r > 0.0 {
            (left, right)
        } else {
            (right, left)
        };
        let speed = r.abs();
        let correction = 0.5 * (speed - speed * speed);
        flux.clear();
        flux.resize(count, 0.0);
        for (flux, ((p, up), down)) in flux.iter_mut().zip(here.iter().zip(up).zip(down)) {
            *flux = speed * p + correction * superbee(down - p, p - up);
        }
        self.shares.push(0.0);
        if r > 0.0 {
            for (share, (p, flux)) in self.shares.iter_mut().zip(here.iter().zip(&*flux)) {
                *share = p - flux;
            }
            for (share, flux) in self.shares[1..].iter_mut().zip(&*flux) {
                *share = larger(*share + flux, 0.0);
            }
            self.shares[0] = larger(self.shares[0], 0.0);
        } else {
            self.first -= 1;
            for (share, (p, flux)) in self.shares[1..].iter_mut().zip(here.iter().zip(&*flux)) {
                *share = p - flux;
            }
            self.shares[0] = 0.0;
            for (share, flux) in self.shares.iter_mut().zip(&*flux) {
                *share = larger(*share + flux, 0.0);
            }
            self.shares[count] = larger(self.shares[count], 0.0);
        }
        self.trim();
    }

    /// Leaves nothing outside of these nodes: absorbed.
    pub fn absorb(&mut self, (least, largest): (i64, i64)) {
        let above = (largest - self.first + 1).clamp(0, self.shares.len() as i64);
        self.shares.truncate(above as usize);
        let below = (least - self.first).clamp(0, self.shares.len() as i64);
        self.shares.drain(..below as usize);
        self.first += below;
    }

    fn trim(&mut self) {
        while let [.., next, last] = self.shares.as_mut_slice()
            && *last < TAIL
        {
            *next += *last;
            self.shares.pop();
        }
        let mut skipped = 0;
        while let [first, next, ..] = &mut self.shares[skipped..]
            && *first < TAIL
        {
            *next += *first;
            skipped += 1;
        }
        self.shares.drain(..skipped);
        self.first += skipped as i64;
    }
}

/// The sum of probabilities on nodes, its mean node, and its variance about that in nodes².
pub(super) fn moments_of(first: i64, masses: &[f64]) -> (f64, f64, f64) {
    let (mut zeroth, mut one, mut two) = (0.0, 0.0, 0.0);
    let middle = (masses.len() / 2) as f64;
    for (j, mass) in masses.iter().enumerate() {
        let d = j as f64 - middle;
        zeroth += mass;
        one += mass * d;
        two += mass * d * d;
    }
    if zeroth == 0.0 {
        return (0.0, 0.0, 0.0);
    }
    let mean = one / zeroth;
    let variance = larger(two / zeroth - mean * mean, 0.0);
    (zeroth, first as f64 + middle + mean, variance)
}

/// φ(upstream/change) · change of P. L. Roe's limiter superbee, without the division: the larger of the two
/// smaller-of-double-and-single where both have one sign, else 0.
fn superbee(change: f64, upstream: f64) -> f64 {
    let (double, twice) = (2.0 * upstream, 2.0 * change);
    let rising = larger(
        0.0,
        larger(smaller(double, change), smaller(upstream, twice)),
    );
    let falling = smaller(
        0.0,
        smaller(larger(double, change), larger(upstream, twice)),
    );
    rising + falling
}

/// Without the care for what is no number that `f64::max` takes: one instruction.
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limiter(s: f64) -> f64 {
        0f64.max((2.0 * s).min(1.0)).max(s.min(2.0))
    }

    #[test]
    fn the_limiter_is_the_one_in_the_books() {
        for k in -40..=40 {
            for change in [-3.0, -0.25, 0.5, 2.0] {
                let s = 0.1 * f64::from(k);
                let direct = limiter(s) * change;
                assert!((superbee(change, s * change) - direct).abs() < 1e-15, "{s}");
            }
        }
        assert_eq!((superbee(0.0, 1.0), superbee(0.0, -1.0)), (0.0, 0.0));
    }

    /// The scheme as it is written in the equation, on a fixed row of nodes.
    fn as_written(p: &[f64], r: f64) -> Vec<f64> {
        let at = |j: i64| p.get(j as usize).copied().unwrap_or(0.0);
        let delta = |j: i64| at(j + 1) - at(j);
        let limited = |j: i64| {
            let upwind = if r > 0.0 { delta(j - 1) } else { delta(j + 1) };
            if delta(j) == 0.0 {
                0.0
            } else {
                limiter(upwind / delta(j)) * delta(j)
            }
        };
        (0..p.len() as i64)
            .map(|j| {
                at(j)
                    - 0.5 * (r - r.abs()) * delta(j)
                    - 0.5 * (r + r.abs()) * delta(j - 1)
                    - 0.5 * (r.abs() - r * r) * (limited(j) - limited(j - 1))
            })
            .collect()
    }

    #[test]
    fn a_step_is_the_equation_and_keeps_its_promises() {
        let mut parcel = Parcel::at(60);
        let mut row = vec![0.0; 121];
        row[60] = 1.0;
        let mut scratch = Scratch::default();
        let variation = |p: &[f64]| {
            let inside: f64 = p.windows(2).map(|p| (p[1] - p[0]).abs()).sum();
            p[0] + p[p.len() - 1] + inside
        };
        for k in 0..100 {
            let before = variation(&parcel.shares);
            let r = 0.95 * (0.37 * f64::from(k)).sin();
            parcel.step(r, &mut scratch);
            row = as_written(&row, r);
            assert!(parcel.shares.iter().all(|p| *p >= 0.0));
            assert!(variation(&parcel.shares) <= before + 16.0 * f64::EPSILON);
            let (total, ..) = moments_of(parcel.first, &parcel.shares);
            assert!((total - 1.0).abs() < 4.0 * f64::EPSILON * f64::from(k + 1));
            for (j, p) in row.iter().enumerate() {
                let share = parcel.shares.get((j as i64 - parcel.first) as usize);
                let share = share.copied().unwrap_or(0.0);
                assert!((share - p).abs() < 1e-14, "{k} {j}: {share} {p}");
            }
        }
    }

    #[test]
    fn a_whole_courant_number_moves_by_a_node() {
        let mut parcel = Parcel {
            first: -3,
            shares: vec![0.25, 0.5, 0.25],
        };
        let mut scratch = Scratch::default();
        for _ in 0..5 {
            parcel.step(1.0, &mut scratch);
        }
        assert_eq!(
            (parcel.first, &parcel.shares[..]),
            (2, &[0.25, 0.5, 0.25][..])
        );
        for _ in 0..9 {
            parcel.step(-1.0, &mut scratch);
        }
        assert_eq!(
            (parcel.first, &parcel.shares[..]),
            (-7, &[0.25, 0.5, 0.25][..])
        );
    }

    #[test]
    fn absorbing_cuts_and_counts() {
        let full = Parcel {
            first: -1,
            shares: vec![0.25, 0.5, 0.125, 0.125],
        };
        let cut = |safe| {
            let mut parcel = full.clone();
            parcel.absorb(safe);
            parcel
        };
        assert_eq!(cut((-9, 9)), full);
        assert_eq!(cut((0, 1)).shares.iter().sum::<f64>(), 0.625);
        assert_eq!(cut((0, 1)).first, 0);
        assert!(cut((3, 9)).shares.is_empty() && cut((-9, -2)).shares.is_empty());
    }
}
