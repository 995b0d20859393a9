//! The files of a diagnosis. All appear, or none; diagnosis.json is the last, so that where it stands the others do.

use std::path::Path;

use super::super::error::AppError;
use super::super::files::{BALANCE, BOARD, COMPARISON, DIAGNOSIS, OutputFolder, REPORT};
use super::board::board;
use super::comparison_files::{write_balances, write_recordings};
use crate::case::{DRIVES, EXPLANATIONS, IDENTIFIED, IMPROVED, IMPROVED_ARM};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::difference::comparison::Comparison;
use crate::document::{Document, Style, html, text};
use crate::recording::atomic::write_text;
use crate::recording::seal::{hashes, sealed};
use crate::report;
use crate::scene::Scene;
use crate::viewer::write_board;

const ACCOUNT: &str = "account.txt";
const PREDICTION: &str = "prediction.csv";
/// Shape of a model discrepancy, where there is such.
const PICTURE: &str = "unlisted.svg";
/// Before and after, of a part of the device.
const FIT_PICTURE: &str = "fit.svg";
/// All that a diagnosis may write.
pub(super) const NAMES: [&str; 14] = [
    ACCOUNT,
    EXPLANATIONS,
    IMPROVED,
    IMPROVED_ARM,
    PREDICTION,
    PICTURE,
    FIT_PICTURE,
    DRIVES,
    IDENTIFIED,
    COMPARISON,
    BALANCE,
    REPORT,
    BOARD,
    DIAGNOSIS,
];

/// Files with numbers to go on with, whose content diagnosis.json seals. (Others hold the time that it took.)
const SEALED: [&str; 6] = [
    IMPROVED,
    IMPROVED_ARM,
    PREDICTION,
    EXPLANATIONS,
    DRIVES,
    IDENTIFIED,
];

/// The first of the files of every diagnosis that a folder does not hold.
pub(super) fn lacking(folder: &Path) -> Option<&'static str> {
    let all = [ACCOUNT, IMPROVED, COMPARISON, BALANCE, BOARD, DIAGNOSIS];
    all.into_iter().find(|name| !folder.join(name).is_file())
}

/// Files of a diagnosis.
pub(super) struct Outputs<'a> {
    /// The finding.
    pub answer: Answer,
    /// improved.toml.
    pub improved: String,
    /// prediction.csv.
    pub prediction: Option<&'a str>,
    /// explanations.json.
    pub explanations: Option<&'a str>,
    /// drives.csv, identified.urdf, improved_arm.toml.
    pub beside: &'a [(&'static str, String)],
    /// unlisted.svg.
    pub picture: Option<&'a str>,
    /// fit.svg.
    pub fit_picture: Option<&'a str>,
    /// Recordings beside models.
    pub comparison: Comparison,
    /// Scene of a cell.
    pub scene: Option<Scene>,
}

/// A case that was diagnosed; its files are written, where there is a folder for them.
pub(super) struct Finished {
    /// The finding.
    pub answer: Answer,
    /// diagnosis.json.
    pub document: String,
    /// account.txt.
    pub account: String,
    /// improved.toml.
    pub improved: String,
    /// Recordings beside models.
    pub comparison: Comparison,
    /// Names of the files written.
    pub names: Vec<&'static str>,
}

impl Outputs<'_> {
    /// Writes all of it, sealed as what was asked for.
    pub(super) fn write(
        mut self,
        folder: Option<&OutputFolder>,
        asked: &str,
    ) -> Result<Finished, AppError> {
        self.answer.take_out_what_is_no_number();
        let mut document = self.answer.text()?;
        let report = report::diagnosis(&self.answer, &self.comparison);
        let account = text(&report, Style::Plain);
        let names = match folder {
            Some(folder) => self.write_into(folder, asked, (&mut document, &account, &report))?,
            None => Vec::new(),
        };
        Ok(Finished {
            answer: self.answer,
            document,
            account,
            improved: self.improved,
            comparison: self.comparison,
            names,
        })
    }

    fn write_into(
        &self,
        folder: &OutputFolder,
        asked: &str,
        (document, account, report): (&mut String, &str, &Document<'_>),
    ) -> Result<Vec<&'static str>, AppError> {
        let beside = |wanted: &str| {
            let own = self.beside.iter().find(|(name, _)| *name == wanted);
            own.map(|(_, text)| text.as_str())
        };
        let optional = [
            (IMPROVED_ARM, beside(IMPROVED_ARM)),
            (DRIVES, beside(DRIVES)),
            (IDENTIFIED, beside(IDENTIFIED)),
            (PREDICTION, self.prediction),
            (EXPLANATIONS, self.explanations),
            (PICTURE, self.picture),
            (FIT_PICTURE, self.fit_picture),
        ];
        let texts = [(ACCOUNT, account), (IMPROVED, self.improved.as_str())];
        let optional = optional
            .into_iter()
            .filter_map(|(name, text)| Some((name, text?)));
        let texts: Vec<(&'static str, &str)> = texts.into_iter().chain(optional).collect();
        folder.write_with(&NAMES, |unfinished| {
            for (name, text) in &texts {
                write_text(&unfinished.join(name), text)?;
            }
            write_recordings(&unfinished.join(COMPARISON), &self.comparison)?;
            write_balances(&unfinished.join(BALANCE), &self.comparison)?;
            write_text(&unfinished.join(REPORT), &html(report))?;
            let scene = self.scene.clone();
            let screen = board(&self.answer, &self.comparison, scene, report);
            write_board(&unfinished.join(BOARD), &screen)?;
            let own = SEALED.into_iter();
            let own = own.filter(|name| texts.iter().any(|(written, _)| written == name));
            *document = sealed(document, asked, hashes(unfinished, own)?);
            write_text(&unfinished.join(DIAGNOSIS), document)?;
            let names = texts.iter().map(|(name, _)| *name);
            Ok(names
                .chain([COMPARISON, BALANCE, REPORT, BOARD, DIAGNOSIS])
                .collect())
        })
    }
}
