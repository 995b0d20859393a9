//! Recordings made by formula, for tests with known answers.

use super::SummaryLimits;
use crate::recording::schema::{self, JointSignal};
use crate::recording::{PhaseSpan, RecordedChannel, Recording, Unit};

/// Limits of the made-up cell: 100 N, 50 mm, two joints.
pub(crate) fn limits() -> SummaryLimits {
    SummaryLimits {
        desired_force: 100.0,
        later_forces: Vec::new(),
        stroke_limits: (0.0, 0.05),
        joint_efforts: vec![200.0, 20.0],
        joint_names: vec!["base".into(), "wrist".into()],
    }
}

/// Asserts that a value is defined and within a relative distance of the expected one.
#[track_caller]
pub(crate) fn assert_near(value: Option<f64>, expected: f64, relative: f64) {
    let value = value.expect("a defined value");
    let error = (value - expected).abs();
    assert!(
        error <= relative * expected.abs(),
        "{value} instead of {expected}"
    );
}

/// A run in the making: approach to 1 s, engage to 2 s, follow to 6 s, retract to 7 s.
pub(crate) struct Builder {
    pub(crate) time: Vec<f64>,
    pub(crate) force: Vec<f64>,
    /// Largest since the sample before [N], where that is recorded.
    pub(crate) peaks: Option<Vec<f64>>,
    pub(crate) path: Vec<f64>,
    pub(crate) stroke: Vec<f64>,
    pub(crate) path_error: Vec<f64>,
    pub(crate) path_lag: Vec<f64>,
    pub(crate) torques: [Vec<f64>; 2],
    /// Chamber 1, chamber 2, entered, left.
    pub(crate) air: [Vec<f64>; 4],
    pub(crate) phases: Vec<PhaseSpan>,
}

impl Builder {
    /// Sample time [s]; a power of two, so that phases begin on samples.
    pub(crate) const STEP: f64 = 1.0 / 1024.0;
    const FOLLOW: std::ops::Range<usize> = 2048..6144;

    /// Desired force from touch to retract, 200 mm at constant feed, air flowing through.
    pub(crate) fn nominal() -> Self {
        let time: Vec<f64> = (0..=7 * 1024)
            .map(|index| f64::from(index) * Self::STEP)
            .collect();
        let constant = |value: f64| vec![value; time.len()];
        let by_time = |signal: fn(f64) -> f64| time.iter().map(|&t| signal(t)).collect::<Vec<_>>();
        let span = |name: &str, start, end| PhaseSpan {
            name: name.into(),
            start,
            end,
        };
        let mut builder = Self {
            force: by_time(|t| if (1.0..6.0).contains(&t) { 100.0 } else { 0.0 }),
            peaks: None,
            path: constant(0.0),
            stroke: constant(0.025),
            path_error: constant(10e-6),
            path_lag: constant(50e-6),
            torques: [constant(20.0), constant(2.0)],
            air: [
                by_time(|t| 1e-4 + 2e-5 * t),
                by_time(|t| 5e-5 + 1e-6 * t * t),
                by_time(|t| 5e-5 * t),
                by_time(|t| 3e-5 * t - 1e-6 * t * t),
            ],
            phases: vec![
                span("approach", 0.0, 1.0),
                span("engage", 1.0, 2.0),
                span("follow", 2.0, 6.0),
                span("retract", 6.0, 7.0),
            ],
            time,
        };
        builder.path_with(|share| {
            // The last sample of the phase is one step short of its end.
            share * 4096.0 / 4095.0
        });
        builder
    }

    /// Sets a signal over the following phase, as a function of the share of its time [0, 1).
    pub(crate) fn fill_follow(
        &mut self,
        signal: impl Fn(f64) -> f64,
        field: impl Fn(&mut Self) -> &mut Vec<f64>,
    ) {
        let count = Self::FOLLOW.len() as f64;
        for (index, value) in field(self)[Self::FOLLOW].iter_mut().enumerate() {
            *value = signal(index as f64 / count);
        }
    }

    /// Sets the force over the following phase.
    pub(crate) fn follow_with(&mut self, force: impl Fn(f64) -> f64) {
        self.fill_follow(force, |builder| &mut builder.force);
    }

    /// Sets the path over the following phase, as a share of 200 mm.
    pub(crate) fn path_with(&mut self, share: impl Fn(f64) -> f64) {
        self.fill_follow(|time| 0.2 * share(time), |builder| &mut builder.path);
    }

    /// Sets the force from a touch at `touch` [s] to the start of following.
    pub(crate) fn engage_with(&mut self, touch: f64, force: impl Fn(f64) -> f64) {
        for (time, value) in self
            .time
            .iter()
            .zip(&mut self.force)
            .take(Self::FOLLOW.start)
        {
            *value = if *time < touch {
                0.0
            } else {
                force(time - touch)
            };
        }
    }

    /// The recording.
    pub(crate) fn build(&self) -> Recording {
        let newton =
            |quantity, values: &[f64]| RecordedChannel::new(quantity, Unit::Newton, values.into());
        let metre =
            |quantity, values: &[f64]| RecordedChannel::new(quantity, Unit::Metre, values.into());
        let friction: Vec<f64> = self.force.iter().map(|force| 0.2 * force).collect();
        let mut channels = vec![
            metre(schema::PATH_LENGTH, &self.path),
            newton(schema::CONTACT_FORCE, &self.force),
            newton(schema::FRICTION_FORCE, &friction),
            metre(schema::STROKE, &self.stroke),
            metre(schema::PATH_ERROR, &self.path_error),
            metre(schema::PATH_LAG, &self.path_lag),
        ];
        let masses = [
            schema::CHAMBER_1_MASS,
            schema::CHAMBER_2_MASS,
            schema::MASS_ENTERED,
            schema::MASS_LEFT,
        ];
        for (quantity, mass) in masses.into_iter().zip(&self.air) {
            channels.push(RecordedChannel::new(quantity, Unit::Kilogram, mass.clone()));
        }
        if let Some(peaks) = &self.peaks {
            channels.push(newton(schema::CONTACT_FORCE_PEAK, peaks));
        }
        for (joint, torque) in (1..).zip(&self.torques) {
            let quantity = schema::joint_quantity(joint, JointSignal::Torque);
            channels.push(RecordedChannel::new(
                quantity,
                Unit::NewtonMetre,
                torque.clone(),
            ));
        }
        Recording::new(self.time.clone(), channels, self.phases.clone()).unwrap()
    }
}
