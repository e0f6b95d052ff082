//! A spectrum by its values at given wavenumbers.
//!
//! Between them log S is linear in log Ω (power laws are met exactly), or S in Ω where a value or
//! wavenumber is zero; outside the table S is zero.

use super::PowerSpectralDensity;
use std::f64::consts::PI;

/// S (m³/rad, two-sided) at increasing Ω (rad/m).
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    wavenumbers: Vec<f64>,
    densities: Vec<f64>,
}

/// Why a table is no spectrum.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TabulatedError {
    #[error("fewer than two rows")]
    TooShort,
    #[error("row {row}: the wavenumber {wavenumber} does not exceed the one before, {before}")]
    NotIncreasing {
        row: usize,
        wavenumber: f64,
        before: f64,
    },
    #[error("row {row}: the wavenumber {wavenumber} is negative")]
    NegativeWavenumber { row: usize, wavenumber: f64 },
    #[error("row {row}: the density {density} is negative")]
    NegativeDensity { row: usize, density: f64 },
}

impl Tabulated {
    /// A table as measured: over rad/m or cycles/m, one-sided or two-sided. Rows count from 1.
    pub fn new(
        wavenumbers: &[f64],
        densities: &[f64],
        cycles: bool,
        one_sided: bool,
    ) -> Result<Self, TabulatedError> {
        if wavenumbers.len() < 2 {
            return Err(TabulatedError::TooShort);
        }
        for (k, (wavenumber, density)) in wavenumbers.iter().zip(densities).enumerate() {
            let (row, wavenumber, density) = (k + 1, *wavenumber, *density);
            if wavenumber < 0.0 {
                return Err(TabulatedError::NegativeWavenumber { row, wavenumber });
            }
            if density < 0.0 {
                return Err(TabulatedError::NegativeDensity { row, density });
            }
            if k > 0 && wavenumber <= wavenumbers[k - 1] {
                let before = wavenumbers[k - 1];
                return Err(TabulatedError::NotIncreasing {
                    row,
                    wavenumber,
                    before,
                });
            }
        }
        let unit = if cycles { 2.0 * PI } else { 1.0 };
        let sides = if one_sided { 2.0 } else { 1.0 };
        Ok(Tabulated {
            wavenumbers: wavenumbers.iter().map(|n| n * unit).collect(),
            densities: densities.iter().map(|g| g / (unit * sides)).collect(),
        })
    }

    /// The first and the last wavenumber (rad/m).
    pub fn band(&self) -> (f64, f64) {
        (
            self.wavenumbers[0],
            self.wavenumbers[self.wavenumbers.len() - 1],
        )
    }
}

impl PowerSpectralDensity for Tabulated {
    fn density(&self, wavenumber: f64) -> f64 {
        let (first, last) = self.band();
        if !(first..=last).contains(&wavenumber) {
            return 0.0;
        }
        let above = self.wavenumbers.partition_point(|w| *w < wavenumber).max(1);
        let (x0, x1) = (self.wavenumbers[above - 1], self.wavenumbers[above]);
        let (y0, y1) = (self.densities[above - 1], self.densities[above]);
        if x0 > 0.0 && y0 > 0.0 && y1 > 0.0 {
            let share = (wavenumber / x0).ln() / (x1 / x0).ln();
            y0 * (share * (y1 / y0).ln()).exp()
        } else {
            y0 + (y1 - y0) * (wavenumber - x0) / (x1 - x0)
        }
    }
}
