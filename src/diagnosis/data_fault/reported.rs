//! An answer with the faults of its data.

use super::super::answer::Answer;
use super::fault::{DataFault, Kind};
use super::report::DataFaultReport;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::statements::TRUSTED;
use crate::diagnosis::answer::words::{CHANNEL_WORDS, listed};
use crate::plant::Channel;

/// An answer with the faults of its data: those taken off before the search, and those that the search names as an effect of the same meaning.
#[must_use]
pub fn reported(mut answer: Answer, faults: &[DataFault]) -> Answer {
    let mut all: Vec<DataFaultReport> = faults.iter().map(DataFault::report).collect();
    let mut late = answer.effects.iter();
    let late = late.find(|e| e.name == "channel_time_offset" && e.confidence >= TRUSTED);
    if let Some(late) = late
        && let Some((_, Estimate { value, .. })) = late.parameters.first()
    {
        let fault = DataFault {
            probability: late.confidence,
            ..DataFault::of(Kind::ClockOffset(*value), Channel::Force, None, 0.0)
        };
        all.push(DataFaultReport {
            words: format!("{}; named by the search", fault.sentence()),
            ..fault.report()
        });
    }
    if !faults.is_empty() {
        let mut kinds: Vec<String> = Vec::new();
        for fault in faults {
            let kind = fault.name().replace('_', " ");
            let of = match fault.channel {
                Some(channel) => format!("{kind} ({})", CHANNEL_WORDS[channel as usize]),
                None => format!("{kind} (whole log)"),
            };
            if !kinds.contains(&of) {
                kinds.push(of);
            }
        }
        let account = &mut answer.details.account;
        account.headline = format!(
            "fault of the data: {}; beside it {}",
            listed(&kinds),
            account.headline
        );
    }
    answer.details.data_faults = all;
    answer
}

#[cfg(test)]
mod tests {
    use super::super::super::answer::tests::answer;
    use super::*;

    /// An offset of the force's stamps that the search held for 16 % likely stood on the page as a fault that had been taken off.
    #[test]
    fn a_late_channel_that_the_search_names_is_a_fault_once_it_is_trusted() {
        let faults_at = |confidence: f64| {
            let mut answer = answer();
            let effect = &mut answer.effects[0];
            effect.name = "channel_time_offset".to_owned();
            effect.parameters =
                vec![("offset_s".to_owned(), Estimate::new(0.03, 0.02, 0.04))].into();
            effect.confidence = confidence;
            reported(answer, &[]).details.data_faults
        };
        assert!(faults_at(0.16).is_empty());
        let [fault] = &faults_at(0.98)[..] else {
            panic!("{:?}", faults_at(0.98));
        };
        assert_eq!(
            (fault.kind.as_str(), fault.value),
            ("clock_offset", Some(0.03))
        );
        assert!(!fault.words.contains("taken off"), "{}", fault.words);
    }
}
