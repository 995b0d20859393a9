//! All files of an experiment, written at once.

use super::super::error::AppError;
use super::super::files::{OutputFolder, REPORT};
use super::files::{self, NAMES};
use super::page;
use super::proposal::Proposal;

/// Writes all files of an experiment; gives next.json.
pub(super) fn write(
    folder: &OutputFolder,
    proposal: &Proposal,
    improved: &str,
    case: &str,
) -> Result<String, AppError> {
    let document = format!("{:#}\n", files::json(proposal));
    let picture = page::picture(proposal)?;
    let page = crate::document::html(&page::of_proposal(proposal, case));
    let inputs = files::inputs(proposal)?;
    let instructions = proposal.chosen.programme.instructions(&proposal.limits);
    let instructions = instructions.join("\n") + "\n";
    let bench = files::bench(proposal, case);
    let model = match proposal.limits.arm.is_some() {
        true => vec![(files::CELL, improved)],
        false => vec![(files::BENCH, bench.as_str()), (files::DEVICE, improved)],
    };
    let others = [
        (files::INPUTS, inputs.as_str()),
        (files::INSTRUCTIONS, &instructions),
        (files::EXPECTED, &picture),
        (REPORT, &page),
        (files::NEXT, &document),
    ];
    let texts: Vec<(&str, &str)> = model.into_iter().chain(others).collect();
    folder.write_texts(&NAMES, &texts)?;
    Ok(document)
}
