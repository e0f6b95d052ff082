//! The periodogram of irregularity samples on their target spectrum.

use super::axes::{Axis, Frame, left_margin};
use super::canvas::Stroke;
use super::check;
use super::colour::{BLACK, BLUE, SKY, VERMILLION};
use super::lines::{band, thinned};
use super::page::{Entry, Page, Swatch, plot_area};
use super::periodogram::Periodogram;
use super::statistics::range;
use super::{Image, RIGHT_MARGIN};
use crate::Result;

/// An averaged periodogram and the spectrum that the samples were made for.
pub struct Spectrum<'a> {
    pub periodogram: &'a Periodogram,
    /// The two-sided target, m³/rad, of Ω > 0 in rad/m; zero beyond the last wavenumber of the samples.
    pub target: &'a dyn Fn(f64) -> f64,
    /// The wavenumbers to show, rad/m, positive: those of the spectral representation.
    pub wavenumbers: (f64, f64),
}

impl Spectrum<'_> {
    /// Draws both, and what the target looks like through the taper.
    ///
    /// # Errors
    /// [`crate::Error::Input`] where the wavenumbers are not positive and ascending, none of the
    /// periodogram's lies among them, or the target is zero there.
    pub fn draw(&self, page: &Page) -> Result<Image> {
        let picture = "plot of the periodogram";
        let (first, last) = self.wavenumbers;
        check::positive(picture, "smallest wavenumber", first)?;
        check::ascending(picture, "wavenumbers", &[first, last])?;
        // Behind the taper the first two wavenumbers show each other and the mean.
        let inside = |wave: f64| wave >= first && wave <= last;
        let waves = &self.periodogram.wavenumbers;
        let shown: Vec<usize> = (2..waves.len()).filter(|&m| inside(waves[m])).collect();
        check::at_least(
            picture,
            "wavenumbers of the samples in the target's range",
            2,
            shown.len(),
        )?;
        let target = self.target_points();
        check::at_least(picture, "positive values of the target", 2, target.len())?;
        let expected = self.periodogram.expected(self.target);

        let x = Axis::logarithmic("Wavenumber, Ω (rad/m)", first, last);
        let estimates = shown.iter().map(|&m| self.periodogram.density[m]);
        let estimates: Vec<f64> = estimates.filter(|&s| s > 0.0).collect();
        // Where the target is next to zero, as at the zeros of a mean, it needs no room.
        let least = estimates.iter().copied().fold(f64::INFINITY, f64::min);
        let seen = |s: &f64| least.is_infinite() || *s >= 0.01 * least;
        let wanted = target.iter().map(|p| p.1).filter(seen);
        let (low, high) = range(wanted.chain(estimates.iter().copied()));
        let label = "Two-sided power spectral density, S(Ω) (m^{3}/rad)";
        let y = Axis::logarithmic(label, low / 1.6, high * 1.6);

        let strokes = Strokes::new();
        let remark = format!(
            "Hann taper over {} positions, {} m apart",
            self.periodogram.position_count, self.periodogram.position_step
        );
        let (mut canvas, room) = page.start(&[remark], &strokes.legend());
        let margin = left_margin(&y, room.height);
        let frame = Frame::new(plot_area(room, margin, RIGHT_MARGIN), x, y);
        let line = |values: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            thinned(shown.iter().map(|&m| frame.point(waves[m], values(m))))
        };
        let (density, scatter) = (
            &self.periodogram.density,
            &self.periodogram.standard_deviation,
        );
        let floor = 0.5 * frame.y.low;
        frame.draw_grid(&mut canvas);
        canvas.clipped(frame.area, |canvas| {
            let lower: Vec<_> = shown
                .iter()
                .map(|&m| frame.point(waves[m], (density[m] - scatter[m]).max(floor)))
                .collect();
            let upper: Vec<_> = shown
                .iter()
                .map(|&m| frame.point(waves[m], density[m] + scatter[m]))
                .collect();
            canvas.polygon(&band(&lower, &upper), BLUE, strokes.opacity);
            canvas.polyline(&line(&|m| density[m]), strokes.estimate);
            let points = target.iter().map(|&(wave, s)| frame.point(wave, s));
            canvas.polyline(&thinned(points), strokes.target);
            canvas.polyline(&line(&|m| expected[m].max(floor)), strokes.expected);
        });
        frame.draw_axes(&mut canvas);
        Ok(canvas.finish())
    }

    /// The target over the whole range, evenly on the logarithmic axis.
    fn target_points(&self) -> Vec<(f64, f64)> {
        const POINTS: usize = 600;
        let (first, last) = self.wavenumbers;
        let wave = |i: usize| first * (last / first).powf(i as f64 / POINTS as f64);
        let points = (0..=POINTS).map(|i| (wave(i).min(last), (self.target)(wave(i).min(last))));
        points.filter(|&(_, s)| s > 0.0 && s.is_finite()).collect()
    }
}

struct Strokes {
    estimate: Stroke,
    target: Stroke,
    expected: Stroke,
    opacity: f64,
}

impl Strokes {
    fn new() -> Self {
        Strokes {
            // Thick and pale: seen beside the target that it lies on.
            estimate: Stroke::solid(SKY, 5.0),
            target: Stroke::solid(BLACK, 1.4),
            expected: Stroke::solid(VERMILLION, 1.8).dashed("6 6"),
            opacity: 0.25,
        }
    }

    fn legend(&self) -> [Entry; 3] {
        [
            Entry::line(self.target, "target"),
            Entry {
                swatch: Swatch::LineInBand(self.estimate, BLUE, self.opacity),
                name: "averaged periodogram ± standard deviation".to_owned(),
            },
            Entry::line(self.expected, "target through the taper"),
        ]
    }
}
