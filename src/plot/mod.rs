//! The only room that draws. It takes plain numbers in SI units and gives pictures: SVG text, and PNG
//! bytes made from the same SVG, with a font that travels with the program.
//!
//! Each figure is a struct of what it shows, and `draw(&page)` gives its [`Image`]:
//!
//! | figure | shows |
//! |---|---|
//! | [`IrregularitySamples`] | irregularity samples over their positions |
//! | [`Spectrum`] | the averaged [`Periodogram`] of samples on their target spectrum |
//! | [`Fan`] | all representative responses, their mean and quantiles over time |
//! | [`HeatMap`] | the density over time and value, as colours |
//! | [`Surface`] | the same as a surface in three dimensions |
//! | [`Slices`] | the densities at given times |
//! | [`FailureProbability`] | the probability of failure over time |
//! | [`DistancesOverTime`] | the distances between two densities over time |
//! | [`Convergence`] | errors over the number of points or the work |
//!
//! The spread of a displacement is a hundredth of its travel. Figures of a response over time
//! therefore show it from its mean where that is needed to see anything ([`ValueAxis`]).
//!
//! The same input gives the same bytes.

mod axes;
mod canvas;
mod check;
mod colour;
mod convergence;
mod density;
mod density_scale;
mod distances;
mod failure_probability;
mod fan;
mod heat_map;
mod image;
mod irregularity_samples;
mod lines;
mod mesh;
mod page;
mod panels;
mod path;
mod periodogram;
mod slices;
mod spectrum;
mod statistics;
mod surface;
mod text;
mod ticks;
mod units;
mod view;

#[cfg(test)]
mod tests;

pub use convergence::{Convergence, ErrorCurve, ErrorPoint};
pub use density::DensityAtTime;
pub use density_scale::DensityScale;
pub use distances::{DistanceCurve, DistancesOverTime};
pub use failure_probability::{FailureCurve, FailureProbability};
pub use fan::Fan;
pub use heat_map::HeatMap;
pub use image::Image;
pub use irregularity_samples::IrregularitySamples;
pub use page::Page;
pub use periodogram::Periodogram;
pub use slices::{Reference, Slices};
pub use spectrum::Spectrum;
pub use statistics::{Statistics, ValueAxis};
pub use surface::Surface;
pub use units::{Label, with_unit};

const TIME_LABEL: &str = "Time, t (s)";
/// What is free at the right of a plot: room for half of the last number.
const RIGHT_MARGIN: f64 = 36.0;
