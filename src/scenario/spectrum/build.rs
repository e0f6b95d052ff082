//! From the specs of spectra to the models, and what is to know of them before a table is read.

use super::{
    ChineseBallastlessSpec, DisturbanceKind, FilterForm, GermanSpec, Iso8608Spec, MainLineKind,
    RoadClassKind, RoadLevelKind, SecondOrderFilterSpec, SncfQualityKind, SpectrumSpec,
    SpectrumTableSpec, TrackComponentKind,
};
use crate::BadInput;
use crate::irregularity::{
    self as model, ChineseBallastless, ChineseMainLine, Disturbance, Fra, FraFryba, German,
    Iso8608, PowerSpectralDensity, SecondOrderFilter, Sncf, SncfQuality, TrackComponent,
};
use crate::scenario::Scenario;

/// A spectrum of a scenario.
pub enum SpectrumSource<'a> {
    Model(Box<dyn PowerSpectralDensity>),
    /// A file that has it.
    Table(&'a SpectrumTableSpec),
}

impl SpectrumSpec {
    /// The model, or the table that is to be read.
    pub fn source(&self) -> SpectrumSource<'_> {
        SpectrumSource::Model(match self {
            SpectrumSpec::SecondOrderFilter(filter) => Box::new(filter.build()),
            SpectrumSpec::Iso8608(road) => Box::new(road.build()),
            SpectrumSpec::German(track) | SpectrumSpec::ErriB176(track) => Box::new(track.build()),
            SpectrumSpec::Fra(track) => {
                Box::new(Fra::new(track.class as usize, track.component.build()))
            }
            SpectrumSpec::FraFryba(track) => Box::new(FraFryba::new(track.class as usize)),
            SpectrumSpec::Sncf(track) => Box::new(Sncf {
                quality: match track.quality {
                    SncfQualityKind::Good => SncfQuality::Good,
                    SncfQualityKind::Poor => SncfQuality::Poor,
                },
            }),
            SpectrumSpec::ChineseBallastless(track) => Box::new(track.build()),
            SpectrumSpec::ChineseMainLine(track) => Box::new(track.set.build()),
            SpectrumSpec::Table(table) => return SpectrumSource::Table(table),
        })
    }

    /// The largest wavenumber (rad/m) at which the density is infinite, where there is one.
    pub fn singularity(&self) -> Option<f64> {
        match self.source() {
            SpectrumSource::Model(model) => model.singularity(),
            SpectrumSource::Table(_) => None,
        }
    }

    /// The kind's name in a scenario.
    pub fn kind(&self) -> &'static str {
        match self {
            SpectrumSpec::SecondOrderFilter(_) => "second-order-filter",
            SpectrumSpec::Iso8608(_) => "iso-8608",
            SpectrumSpec::German(_) => "german",
            SpectrumSpec::ErriB176(_) => "erri-b176",
            SpectrumSpec::Fra(_) => "fra",
            SpectrumSpec::FraFryba(_) => "fra-fryba",
            SpectrumSpec::Sncf(_) => "sncf",
            SpectrumSpec::ChineseBallastless(_) => "chinese-ballastless",
            SpectrumSpec::ChineseMainLine(_) => "chinese-main-line",
            SpectrumSpec::Table(_) => "table",
        }
    }

    /// What of road or track it is a spectrum of.
    pub fn component(&self) -> TrackComponent {
        match self {
            SpectrumSpec::German(track) | SpectrumSpec::ErriB176(track) => track.component.build(),
            SpectrumSpec::Fra(track) => track.component.build(),
            SpectrumSpec::ChineseBallastless(track) => track.component.build(),
            SpectrumSpec::ChineseMainLine(track) => track.set.build().component(),
            SpectrumSpec::SecondOrderFilter(_)
            | SpectrumSpec::Iso8608(_)
            | SpectrumSpec::FraFryba(_)
            | SpectrumSpec::Sncf(_)
            | SpectrumSpec::Table(_) => TrackComponent::Vertical,
        }
    }

    /// The standard deviation (m) over all wavenumbers, where a closed form of it is known.
    pub fn whole_deviation(&self) -> Option<f64> {
        match self {
            SpectrumSpec::SecondOrderFilter(filter) => Some(filter.build().variance().sqrt()),
            SpectrumSpec::Iso8608(_)
            | SpectrumSpec::German(_)
            | SpectrumSpec::ErriB176(_)
            | SpectrumSpec::Fra(_)
            | SpectrumSpec::FraFryba(_)
            | SpectrumSpec::Sncf(_)
            | SpectrumSpec::ChineseBallastless(_)
            | SpectrumSpec::ChineseMainLine(_)
            | SpectrumSpec::Table(_) => None,
        }
    }

    /// Classes that there are not.
    pub(in crate::scenario) fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let SpectrumSpec::Iso8608(road) = self else {
            return Ok(());
        };
        if road.class == RoadClassKind::H && road.level == RoadLevelKind::UpperLimit {
            return Err(scenario.bad(
                "irregularity.spectrum.level",
                "\"mean\": class H has no upper limit",
                "\"upper-limit\"",
            ));
        }
        Ok(())
    }
}

impl SecondOrderFilterSpec {
    pub fn build(&self) -> SecondOrderFilter {
        SecondOrderFilter {
            alpha: self.alpha,
            beta: self.beta,
            gamma: self.gamma,
            form: match self.form {
                FilterForm::Corrected => model::FilterForm::Corrected,
                FilterForm::Printed => model::FilterForm::Printed,
            },
        }
    }
}

impl Iso8608Spec {
    pub fn build(&self) -> Iso8608 {
        let class = match self.class {
            RoadClassKind::A => 0,
            RoadClassKind::B => 1,
            RoadClassKind::C => 2,
            RoadClassKind::D => 3,
            RoadClassKind::E => 4,
            RoadClassKind::F => 5,
            RoadClassKind::G => 6,
            RoadClassKind::H => 7,
        };
        match self.level {
            RoadLevelKind::Mean => Iso8608::mean(class, self.waviness),
            RoadLevelKind::UpperLimit => Iso8608::upper_limit(class, self.waviness),
        }
    }
}

impl GermanSpec {
    pub fn build(&self) -> German {
        German {
            disturbance: match self.disturbance {
                DisturbanceKind::Low => Disturbance::Low,
                DisturbanceKind::High => Disturbance::High,
            },
            component: self.component.build(),
        }
    }
}

impl TrackComponentKind {
    pub fn build(self) -> TrackComponent {
        match self {
            TrackComponentKind::Vertical => TrackComponent::Vertical,
            TrackComponentKind::Alignment => TrackComponent::Alignment,
            TrackComponentKind::CrossLevel => TrackComponent::CrossLevel,
            TrackComponentKind::Gauge => TrackComponent::Gauge,
        }
    }
}

impl ChineseBallastlessSpec {
    pub fn build(&self) -> ChineseBallastless {
        let quantile = |percent: f64| ChineseBallastless::quantile_factor(percent / 100.0);
        ChineseBallastless {
            component: self.component.build(),
            factor: self.percentile.map_or(1.0, quantile),
        }
    }
}

impl MainLineKind {
    pub fn build(self) -> ChineseMainLine {
        match self {
            MainLineKind::WeldedLeftVertical => ChineseMainLine::WeldedLeftVertical,
            MainLineKind::WeldedRightVertical => ChineseMainLine::WeldedRightVertical,
            MainLineKind::WeldedLeftAlignment => ChineseMainLine::WeldedLeftAlignment,
            MainLineKind::WeldedRightAlignment => ChineseMainLine::WeldedRightAlignment,
            MainLineKind::WeldedCentreVertical => ChineseMainLine::WeldedCentreVertical,
            MainLineKind::SpeedRaisedLeftVertical => ChineseMainLine::SpeedRaisedLeftVertical,
            MainLineKind::SpeedRaisedRightVertical => ChineseMainLine::SpeedRaisedRightVertical,
            MainLineKind::SpeedRaisedLeftAlignment => ChineseMainLine::SpeedRaisedLeftAlignment,
            MainLineKind::SpeedRaisedRightAlignment => ChineseMainLine::SpeedRaisedRightAlignment,
            MainLineKind::SpeedRaisedCrossLevel => ChineseMainLine::SpeedRaisedCrossLevel,
        }
    }
}
