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
    let bench = files::bench(proposal, case);
    let picture = page::picture(proposal)?;
    let page = crate::document::html(&page::of_proposal(proposal, case));
    let inputs = files::inputs(proposal)?;
    let instructions = proposal.chosen.programme.instructions().join("\n") + "\n";
    let texts = [
        (files::INPUTS, inputs.as_str()),
        (files::BENCH, &bench),
        (files::DEVICE, improved),
        (files::INSTRUCTIONS, &instructions),
        (files::EXPECTED, &picture),
        (REPORT, &page),
        (files::NEXT, &document),
    ];
    folder.write_texts(&NAMES, &texts)?;
    Ok(document)
}
