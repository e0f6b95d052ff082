//! A system whose histories are filtered and judged, point by point, as its batches end.

use super::{Divergence, Points, Stepper, Strip, System};
use crate::judgement::{Index, Judge, LowPass};

/// What is made of the histories of a run that records each step.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgements {
    /// h (s).
    pub time_step: f64,
    /// Every so many steps are passed on, from the first on.
    pub record_every: usize,
    /// So many of the first quantities are passed on; the others are there to be filtered or judged.
    pub recorded: usize,
    /// Passed on after them.
    pub filtered: Vec<FilteredHistory>,
    /// The values a point.
    pub values: Vec<JudgedValue>,
}

/// A filtered history.
#[derive(Debug, Clone, PartialEq)]
pub struct FilteredHistory {
    /// Which of the run's quantities.
    pub quantity: usize,
    pub filter: LowPass,
}

/// One value a point.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedValue {
    /// Which of the run's quantities.
    pub quantity: usize,
    pub index: Index,
    /// The first and the last step that are judged.
    pub window: (usize, usize),
    /// Before the index.
    pub low_pass: Option<LowPass>,
}

/// The system that runs another one, which records each step, and judges it.
///
/// A thread holds the histories of one batch: `8 (steps + 1) quantities lanes` bytes.
pub struct Judged {
    inner: Box<dyn System>,
    judgements: Judgements,
    /// Of the inner system.
    times: Vec<f64>,
}

impl Judged {
    pub fn new(inner: Box<dyn System>, judgements: Judgements) -> Judged {
        Judged {
            times: inner.times(),
            inner,
            judgements,
        }
    }
}

impl System for Judged {
    fn times(&self) -> Vec<f64> {
        let every = self.judgements.record_every;
        self.times.iter().copied().step_by(every).collect()
    }

    fn outputs(&self) -> usize {
        self.judgements.recorded + self.judgements.filtered.len()
    }

    fn point_outputs(&self) -> usize {
        self.judgements.values.len()
    }

    fn lanes(&self) -> usize {
        self.inner.lanes()
    }

    fn group(&self) -> usize {
        self.inner.group()
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        let judge = |value: &JudgedValue| {
            Judge::new(
                value.index,
                value.window,
                value.low_pass.clone(),
                self.judgements.time_step,
            )
        };
        Box::new(JudgedStepper {
            inner: self.inner.stepper(),
            judged: self,
            judges: self.judgements.values.iter().map(judge).collect(),
            histories: Vec::new(),
            history: Vec::new(),
            filtered: Vec::new(),
            work: Vec::new(),
        })
    }

    fn explain(&self, divergence: Divergence) -> String {
        if divergence.step < self.times.len() {
            return self.inner.explain(divergence);
        }
        "the unloading ratio has no static force, since the force at the start is not above 0; \
         give static_force in simulation.index"
            .to_owned()
    }
}

struct JudgedStepper<'a> {
    inner: Box<dyn Stepper + 'a>,
    judged: &'a Judged,
    judges: Vec<Judge>,
    /// `[step][quantity][lane]`.
    histories: Vec<f64>,
    /// Of one quantity and lane.
    history: Vec<f64>,
    filtered: Vec<f64>,
    work: Vec<f64>,
}

impl Stepper for JudgedStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        let width = strip.width();
        let steps = self.judged.times.len();
        let quantities = self.judged.inner.outputs();
        self.histories.resize(steps * quantities * width, 0.0);
        for mut all in Strip::cut(&mut self.histories, width, width) {
            self.inner.run(points, &mut all)?;
        }
        self.pass_on(strip);
        for quantity in 0..quantities {
            for lane in 0..width {
                self.judge(quantity, lane, strip)?;
            }
        }
        Ok(())
    }
}

impl JudgedStepper<'_> {
    /// The recorded quantities at the recorded times.
    fn pass_on(&self, strip: &mut Strip<'_>) {
        let Judgements {
            record_every,
            recorded,
            ..
        } = self.judged.judgements;
        let (outputs, width) = (self.judged.outputs(), strip.width());
        let step = self.judged.inner.outputs() * width;
        let records = self.histories.chunks_exact(step).step_by(record_every);
        for (record, histories) in records.enumerate() {
            let rows = histories.chunks_exact(width).take(recorded);
            for (quantity, values) in rows.enumerate() {
                strip
                    .row(record * outputs + quantity)
                    .copy_from_slice(values);
            }
        }
    }

    /// Whatever is made of one quantity of one lane.
    fn judge(
        &mut self,
        quantity: usize,
        lane: usize,
        strip: &mut Strip<'_>,
    ) -> Result<(), Divergence> {
        let judgements = &self.judged.judgements;
        let is_needed = judgements.filtered.iter().any(|f| f.quantity == quantity)
            || judgements.values.iter().any(|v| v.quantity == quantity);
        if !is_needed {
            return Ok(());
        }
        let (outputs, width) = (self.judged.outputs(), strip.width());
        let column = self.histories.iter().skip(quantity * width + lane);
        self.history.clear();
        self.history
            .extend(column.step_by(self.judged.inner.outputs() * width));
        for (number, filtered) in judgements.filtered.iter().enumerate() {
            if filtered.quantity != quantity {
                continue;
            }
            self.filtered.clear();
            self.filtered.extend_from_slice(&self.history);
            filtered.filter.apply(&mut self.filtered, &mut self.work);
            let records = self.filtered.iter().step_by(judgements.record_every);
            for (record, value) in records.enumerate() {
                strip.row(record * outputs + judgements.recorded + number)[lane] = *value;
            }
        }
        for (number, (value, judge)) in judgements.values.iter().zip(&mut self.judges).enumerate() {
            if value.quantity != quantity {
                continue;
            }
            let judged = judge.value(&self.history);
            if !judged.is_finite() {
                let step = self.judged.times.len();
                return Err(Divergence { lane, step });
            }
            strip.point_row(number)[lane] = judged;
        }
        Ok(())
    }
}
