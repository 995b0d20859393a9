//! Where the recordings differ from the nominal model.

use super::super::finding::Diagnosis;
use super::super::words::{CHANNEL_WORDS, in_unit, listed};
use super::MOST_OTHERS;
use crate::diagnosis::difference::localise::{Misfit, NOISE_ALONE, misfits, root_mean_square};
use crate::plant::Channel;
use crate::quantity::significant;

impl Diagnosis {
    /// Channels in the order of their misfit, the largest first.
    pub(super) fn by_misfit(&self, residuals: &[f64]) -> Vec<Misfit> {
        let mut all = misfits(&self.evidence, residuals);
        all.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
        all
    }

    /// Root mean square of what the baseline leaves of a channel from a time to another, in its unit.
    fn baseline_rms(&self, misfit: &Misfit, [from, to]: [f64; 2]) -> String {
        let channel = misfit.channel as usize;
        let time = &self.evidence.recordings[misfit.recording].inputs.time;
        let of = |(recording, of, _): &(usize, Channel, &[f64])| {
            *recording == misfit.recording && *of == misfit.channel
        };
        let own = self.by_channel(&self.baseline.prediction.residuals);
        let own = own.filter(of).flat_map(|(.., residuals)| residuals);
        let within = own.zip(time).filter(|(_, t)| (from..=to).contains(*t));
        let sigmas = root_mean_square(within.map(|(r, _)| *r)).unwrap_or_default();
        in_unit(misfit.channel, sigmas * self.evidence.noise[channel])
    }

    pub(super) fn where_it_differs(&self) -> Vec<String> {
        if self.best().finds_nothing() {
            let count = self.evidence.recordings.len();
            let recordings = if count == 1 {
                "the recording".to_owned()
            } else {
                format!("all {count} recordings")
            };
            let worst = self.by_misfit(&self.best().fit.prediction.residuals);
            let Some(worst) = worst.first() else {
                return Vec::new();
            };
            let (verdict, but) = match worst.sigmas > NOISE_ALONE {
                true => ("No effect was found in", " but for more than noise"),
                false => (
                    "Nowhere. The nominal model, moved within its tolerances, explains",
                    "",
                ),
            };
            return vec![format!(
                "{verdict} {recordings}{but}: the worst channel, the {} of {}, departs by {} times {} (robust RMS).",
                CHANNEL_WORDS[worst.channel as usize],
                self.name(worst.recording),
                significant(worst.sigmas, 3),
                self.reference_noise()
            )];
        }
        let all = self.by_misfit(&self.baseline.prediction.residuals);
        let differing: Vec<&Misfit> = all.iter().filter(|m| self.span(m).is_some()).collect();
        let Some((worst, others)) = differing.split_first() else {
            return vec![
                "No short time stands out: the mismatch is spread over the recordings.".to_owned(),
            ];
        };
        let mut paragraphs = vec![self.worst_difference(worst)];
        let others: Vec<String> = others
            .iter()
            .filter(|m| m.sigmas > NOISE_ALONE)
            .take(MOST_OTHERS)
            .filter_map(|m| {
                let [from, to] = self.span(m)?;
                Some(format!(
                    "the {} of {} from {from:.2} to {to:.2} s ({} RMS)",
                    CHANNEL_WORDS[m.channel as usize],
                    self.name(m.recording),
                    self.baseline_rms(m, [from, to])
                ))
            })
            .collect();
        if !others.is_empty() {
            paragraphs.push(format!("So do {}.", listed(&others)));
        }
        paragraphs
    }

    /// From the first to the last time in which a channel differs from the baseline [s].
    fn span(&self, misfit: &Misfit) -> Option<[f64; 2]> {
        let spans = self.spans(misfit);
        Some([spans.first()?[0], spans.last()?[1]])
    }

    fn spans(&self, misfit: &Misfit) -> Vec<[f64; 2]> {
        let differences = self.baseline.differences.iter();
        let own =
            differences.filter(|p| p.recording == misfit.recording && p.channel == misfit.channel);
        own.map(|p| p.span).collect()
    }

    fn worst_difference(&self, worst: &Misfit) -> String {
        let spans = self.spans(worst);
        let [from, to] = self.span(worst).unwrap_or_default();
        let long: f64 = spans.iter().map(|span| span[1] - span[0]).sum();
        let times = match spans.len() {
            1 => String::new(),
            count => format!(", in {count} stretches that make {long:.1} s"),
        };
        format!(
            "Between {from:.2} and {to:.2} s of {} the {} differs from the nominal model, whatever its tolerances allow{times}: by {} RMS, where {} is {}.",
            self.name(worst.recording),
            CHANNEL_WORDS[worst.channel as usize],
            self.baseline_rms(worst, [from, to]),
            self.reference_noise(),
            in_unit(worst.channel, self.evidence.noise[worst.channel as usize]),
        )
    }
}
