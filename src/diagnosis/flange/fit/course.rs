//! What a run tells its flange to do.
//!
//! The log of the desired force shows what is wanted of the contact, and nothing before it: a ramp from the force before contact is given beside the run.
//! Without one the flange comes with the whole desired force, which presses its slide on its stop.

use crate::diagnosis::flange::{ForceRamp, Run, RunMetrics};
use crate::flange::{FlangeCourse, Ripple, rippled, towards_part};

/// Seed of the ripple: another gives another course of the same size.
const SEED: u64 = 1;
/// Time in which an arm has begun to slide [s].
const STARTED: f64 = 0.2;
/// Speed from which the arm slides [m/s].
const SLIDES: f64 = 0.03;
/// Change of the desired force with which a run ends, by the force [1].
const ENDS: f64 = 0.1;

/// Course of a run with what is needed beside it.
#[derive(Debug, Clone)]
pub(super) struct RunCourse {
    /// From before contact to the end of contact.
    pub course: FlangeCourse,
    /// Time of contact [s].
    pub contact: f64,
    /// Speed at contact [m/s].
    pub speed: f64,
    /// When the arm slides off, and when it stands again [s].
    pub slides: Option<[f64; 2]>,
    /// Last time [s].
    pub end: f64,
    /// Speed along the surface [m/s], as the course's.
    along: Vec<f64>,
}

impl RunCourse {
    /// Of a run, from a time before contact [s] on.
    pub fn of(run: &Run, shown: &RunMetrics, lead: f64) -> Self {
        let contact = shown.contact;
        let first = run.time.partition_point(|t| *t < contact - lead);
        let wanted = |i: &usize| {
            run.time[*i] > contact + 0.3
                && (run.desired[*i] - shown.desired).abs() > ENDS * shown.desired.abs()
        };
        let last = (first..run.time.len())
            .find(wanted)
            .unwrap_or(run.time.len());
        let time = &run.time[first..last];
        let (logged, commanded) = (&run.speed[first..last], &run.commanded[first..last]);
        let (speed, slides) = towards_part(time, logged, commanded, contact);
        let count = time.len();
        let period = (time[count - 1] - time[0]) / (count - 1) as f64;
        let touches = time.partition_point(|t| *t < contact);
        let gap = speed[..touches].iter().sum::<f64>() * period;
        let ramp = run.force_ramp.unwrap_or(ForceRamp {
            before: shown.desired,
            time: 0.0,
        });
        let slid = slides.unwrap_or(f64::INFINITY);
        let along = time.iter().zip(logged).map(|(t, v)| match *t < slid {
            true => 0.0,
            false => v.abs(),
        });
        let along: Vec<f64> = along.collect();
        let stops = (0..count).find(|i| time[*i] > slid + STARTED && along[*i] < SLIDES);
        Self {
            along,
            contact,
            speed: speed[touches.min(count - 1)],
            slides: slides.map(|from| [from, stops.map_or(time[count - 1], |i| time[i])]),
            end: time[count - 1],
            course: FlangeCourse {
                start: time[0],
                period,
                speed,
                gap,
                before: ramp.before,
                after: shown.desired,
                ramp: ramp.time,
            },
        }
    }

    /// It with a touch that is later [s].
    pub fn later(&self, by: f64) -> FlangeCourse {
        let mut course = self.course.clone();
        course.gap += by * self.speed;
        course
    }

    /// It with a ripple of the arm while it slides.
    pub fn with_ripple(&self, ripple: Ripple) -> FlangeCourse {
        let mut course = self.course.clone();
        rippled(
            &mut course.speed,
            &self.along,
            self.course.period,
            ripple,
            SEED,
        );
        course
    }
}
