//! An answer with the faults of its data.

use super::super::answer::{Answer, Estimate};
use super::super::words::{CHANNEL_WORDS, listed};
use super::fault::{DataFault, Kind};
use super::report::DataFaultReport;
use crate::plant::Channel;

/// An answer with the faults of its data: those taken off before the search, and those that the search names as an effect of the same meaning.
#[must_use]
pub fn reported(mut answer: Answer, faults: &[DataFault]) -> Answer {
    let mut all: Vec<DataFaultReport> = faults.iter().map(DataFault::report).collect();
    let late = answer
        .effects
        .iter()
        .find(|e| e.name == "channel_time_offset");
    if let Some(late) = late
        && let Some((_, Estimate { value, .. })) = late.parameters.first()
    {
        let fault = DataFault {
            probability: late.confidence,
            ..DataFault::of(Kind::ClockOffset(*value), Channel::Force, None, 0.0)
        };
        all.push(fault.report());
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
