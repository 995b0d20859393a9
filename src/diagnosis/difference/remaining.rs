//! Remainder that no law explains of a rig with a part of the device, and how recordings are judged against it.
//!
//! ```text
//! t = 1 + 2 sum rho_k   up to the first rho_k < 0.05
//! ```
//!
//! rho_k correlation of what is left with itself k samples later, t samples that tell as much as one. A part on a laboratory's bench is seen through one good
//! sensor at close distances of samples: what the best laws leave is large beside its noise and alike for many samples, so that any effect would gain
//! something against noise alone. So effects are first taken in by greedy forward selection, to see what they leave; then the search is done with that as the noise, and t samples
//! count for one. The last fit is to all samples.

use crate::diagnosis::fit::autocorrelation::integrated_autocorrelation_time;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{Limit, Refit};
use crate::diagnosis::recordings::evidence::{Evidence, Measured, Prediction};
use crate::diagnosis::search::Search;
use crate::diagnosis::search::progress::{Observer, Step};
use crate::diagnosis::search::ruled_out::{exchanges, variant};
use crate::plant::{CHANNELS, Channel};

/// Samples that a search looks at, about; no more are left out than are alike.
const ENOUGH: usize = 6000;
/// Samples of all recordings that a first look takes, about.
const FIRST_LOOK: usize = 4000;
/// Multiple of the sensor's noise up to which a remainder counts as noise [1].
const LIKE_NOISE: f64 = 1.3;

/// Remainder of the best laws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remaining {
    /// The channel.
    pub channel: Channel,
    /// Its root mean square, in the channel's unit.
    pub size: f64,
    /// Standard deviation of the sensor's noise, in the channel's unit.
    pub noise: f64,
    /// Samples that tell as much as one [1].
    pub autocorrelation_samples: f64,
    /// The same as a time [s].
    pub time: f64,
}

impl Remaining {
    /// Remainder of the best laws that a search can find in its evidence at a first look, with those laws.
    pub fn of(
        search: &Search<'_>,
        channel: Channel,
        observer: &mut Observer<'_>,
    ) -> (Self, Hypothesis) {
        let evidence = search.evidence;
        let every = evidence.count().div_ceil(FIRST_LOOK);
        let first = thinned(evidence, every, evidence.noise);
        let best = greedy(
            &Search {
                evidence: &first,
                ..search.clone()
            },
            observer,
        );
        let prediction = evidence.predict(&best.fit.prediction.plant, true, None);
        (Self::left_by(&prediction, evidence, channel), best)
    }

    /// Remainder of a model.
    pub fn left_by(prediction: &Prediction, evidence: &Evidence, channel: Channel) -> Self {
        let index = channel as usize;
        let (mut squares, mut count, mut weighted, mut seconds) = (0.0, 0.0, 0.0, 0.0);
        for (measured, trajectory) in evidence.recordings.iter().zip(&prediction.trajectories) {
            let pairs = measured.readings[index]
                .iter()
                .zip(&trajectory.readings[index]);
            let left: Vec<f64> = pairs
                .map(|(m, p)| m - p)
                .filter(|r| r.is_finite())
                .collect();
            let own = left.len() as f64;
            squares += left.iter().map(|r| r * r).sum::<f64>();
            count += own;
            let time = &measured.inputs.time;
            let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
            let autocorrelation_samples = integrated_autocorrelation_time(&left);
            weighted += own * autocorrelation_samples;
            seconds += own * autocorrelation_samples * step;
        }
        Self {
            channel,
            size: (squares / count.max(1.0)).sqrt(),
            noise: evidence.noise[index],
            autocorrelation_samples: weighted / count.max(1.0),
            time: seconds / count.max(1.0),
        }
    }

    /// Share of it that is not the sensor's noise, in its square [1].
    pub fn beyond_noise(&self) -> f64 {
        (1.0 - (self.noise / self.size).powi(2)).max(0.0)
    }

    /// Whether it turns out to be clearly more than what was left in the end.
    pub fn is_more_than(&self, other: &Self) -> bool {
        self.size > LIKE_NOISE * other.size
    }

    /// Whether it is no more than the sensor's noise.
    pub fn is_noise(&self) -> bool {
        self.size < LIKE_NOISE * self.noise && self.autocorrelation_samples < 2.0
    }

    /// Noise of the channels where what is left counts as it.
    fn taken_as_noise(&self, evidence: &Evidence) -> [f64; CHANNELS.len()] {
        let mut noise = evidence.noise;
        noise[self.channel as usize] = self.size.max(self.noise);
        noise
    }

    /// The evidence against what is left, in which as many samples as are alike count for one.
    pub fn independent(&self, evidence: &Evidence) -> Evidence {
        let every =
            (evidence.count() / ENOUGH).clamp(1, self.autocorrelation_samples.ceil() as usize);
        let autocorrelation_samples = (self.autocorrelation_samples / every as f64).max(1.0);
        let mut noise = self.taken_as_noise(evidence);
        noise[self.channel as usize] *= autocorrelation_samples.sqrt();
        let mut thinned = thinned(evidence, every, noise);
        thinned.worth = 1.0 / autocorrelation_samples;
        thinned
    }

    /// The evidence with all samples, against what is left.
    pub fn whole(&self, evidence: &Evidence) -> Evidence {
        let mut whole = thinned(evidence, 1, self.taken_as_noise(evidence));
        whole.block = whole.block.max(2.0 * self.time);
        whole
    }
}

/// The evidence with every so many-th reading and another noise.
fn thinned(evidence: &Evidence, every: usize, noise: [f64; CHANNELS.len()]) -> Evidence {
    let thin = |measured: &Measured| {
        let mut kept = measured.clone();
        for readings in &mut kept.readings {
            for (i, reading) in readings.iter_mut().enumerate() {
                if i % every != every / 2 {
                    *reading = f64::NAN;
                }
            }
        }
        kept
    };
    let mut thinned = Evidence::new(evidence.recordings.iter().map(thin).collect(), noise);
    thinned.effort = evidence.effort.clone();
    thinned
}

/// Effect after effect, as long as one more explains a part of what is left.
fn greedy(search: &Search<'_>, observer: &mut Observer<'_>) -> Hypothesis {
    /// Share of what is left that one more must explain [1].
    const WORTH: f64 = 0.06;
    /// Candidates that are fitted with everything free.
    const TRIED: usize = 5;
    let stages = crate::diagnosis::fit::ROUGH;
    let mut best = search.baseline();
    loop {
        let exchanged = exchanged(search, &best);
        if let Some(other) = exchanged.filter(|h| h.fit.rough < (1.0 - WORTH) * best.fit.rough) {
            let detail = format!("exchanged {:.0}", other.fit.rough);
            observer(&Step::RoughFit.of(&other, detail));
            best = other;
        }
        if best.effects.len() == search.most_effects || search.is_spent() {
            break;
        }
        let candidates = search.screen(&best, stages, f64::INFINITY);
        let mut refined: Vec<Hypothesis> = (candidates.iter().take(TRIED))
            .map(|candidate| search.refit(candidate, Refit::ROUGH.until(Limit::of(30))))
            .collect();
        refined.sort_by(|a, b| a.fit.rough.total_cmp(&b.fit.rough));
        let Some(more) = refined.into_iter().next() else {
            break;
        };
        let detail = format!(
            "forward selection {:.0} -> {:.0}",
            best.fit.rough, more.fit.rough
        );
        observer(&Step::RoughFit.of(&more, detail));
        if more.fit.rough > (1.0 - WORTH) * best.fit.rough {
            break;
        }
        best = more;
    }
    best
}

/// The best explanation with another law in the place of one that it excludes.
fn exchanged(search: &Search<'_>, best: &Hypothesis) -> Option<Hypothesis> {
    let others = exchanges(search, best).into_iter();
    let fitted = others.filter_map(|effects| {
        let fit = variant(search, &effects, crate::diagnosis::fit::ROUGH)?;
        Some(Hypothesis {
            effects,
            fit,
            depends_on: Vec::new(),
        })
    });
    fitted.min_by(|a, b| a.fit.rough.total_cmp(&b.fit.rough))
}
