//! The control variate as a rule of smoothing: where it has no control, the adaptive rule.

use super::control_variate::{ControlVariate, Controlled};
use super::gaussians::Adaptive;
use super::rule::{Extent, Fit, Rule, Sample, Smoothed};
use super::{Curve, Nodes, Spread, WidthRule};

/// Nodes of a controlled density, at least.
const LEAST_NODES: usize = 1024;

impl Rule for ControlVariate {
    fn needs_points(&self) -> bool {
        true
    }

    fn first_width(&self, spread: &Spread) -> f64 {
        WidthRule::Silverman.width(spread, &[])
    }

    fn fit<'a>(&'a self, sample: &'a Sample<'a>) -> Box<dyn Fit + 'a> {
        let values = sample.each();
        match self.estimate(values, LEAST_NODES) {
            Some(controlled) if controlled.features > 0 => Box::new(controlled),
            uncontrolled => Box::new(Uncontrolled {
                fit: Adaptive.fit(sample),
                residual: uncontrolled.map(|c| c.residual),
            }),
        }
    }
}

impl Fit for Controlled {
    fn width(&self) -> f64 {
        self.smoothing_width
    }

    fn extent(&self) -> Extent {
        let nodes = self.curve.nodes;
        Extent {
            least: nodes.start,
            largest: nodes.value(nodes.count - 1),
            spacing: nodes.spacing,
            edged: false,
        }
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        let curve = if nodes == self.curve.nodes {
            self.curve.clone()
        } else {
            on_other_nodes(&self.curve, nodes)
        };
        Smoothed {
            curve,
            width: self.smoothing_width,
        }
    }

    fn residual(&self) -> Option<f64> {
        Some(self.residual)
    }
}

/// F by cubics whose slopes are p, p by straight lines; outside 0 and what F ends with.
fn on_other_nodes(own: &Curve, nodes: Nodes) -> Curve {
    let last = own.nodes.count - 1;
    let at = |y: f64| {
        let place = (y - own.nodes.start) / own.nodes.spacing;
        if place < 0.0 || place > last as f64 {
            let end = if place < 0.0 {
                0.0
            } else {
                own.cumulative[last]
            };
            return (0.0, end);
        }
        let j = (place as usize).min(last - 1);
        let t = place - j as f64;
        let [p, q] = [own.density[j], own.density[j + 1]];
        let [a, b] = [own.cumulative[j], own.cumulative[j + 1]];
        let slopes = own.nodes.spacing * t * (1.0 - t) * ((1.0 - t) * p - t * q);
        let between = a + (b - a) * t * t * (3.0 - 2.0 * t) + slopes;
        (p + t * (q - p), between.clamp(a, b))
    };
    let (density, cumulative) = (0..nodes.count).map(|j| at(nodes.value(j))).unzip();
    Curve {
        nodes,
        density,
        cumulative,
    }
}

/// What the regression does not foretell.
struct Uncontrolled<'a> {
    fit: Box<dyn Fit + 'a>,
    residual: Option<f64>,
}

impl Fit for Uncontrolled<'_> {
    fn width(&self) -> f64 {
        self.fit.width()
    }

    fn extent(&self) -> Extent {
        self.fit.extent()
    }

    fn curve(&self, nodes: Nodes) -> Smoothed {
        self.fit.curve(nodes)
    }

    fn residual(&self) -> Option<f64> {
        self.residual
    }
}
