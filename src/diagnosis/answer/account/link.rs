//! Which link of the chain does not explain its own recording.

use super::super::finding::Diagnosis;
use super::super::words::listed;
use crate::diagnosis::difference::links::{Link, LinkResidual};
use crate::diagnosis::difference::localise::{NOISE_ALONE, root_mean_square};
use crate::diagnosis::difference::regime::Regime;
use crate::quantity::significant;

/// Share of a mismatch's variance from which a variable is worth a word [1].
pub(super) const EXPLAINING: f64 = 0.1;

impl Diagnosis {
    pub(super) fn which_link(&self) -> Vec<String> {
        if self.best().finds_nothing() {
            return Vec::new();
        }
        let links = self.baseline.links.iter();
        links
            .map(|(link, regimes)| link_words(link, regimes))
            .collect()
    }
}

fn link_words(link: &LinkResidual, regimes: &[Regime]) -> String {
    let size = significant(link.size, 3);
    let explained = link.size <= NOISE_ALONE;
    if explained {
        return match link.link {
            Link::Regulator => format!(
                "The regulator explains its own recording: {size} times its sensor's noise (robust RMS)."
            ),
            Link::Piston => format!(
                "Chambers and piston explain the measured motion: no force is lacking beyond {size} times the noise (robust RMS)."
            ),
            Link::Contact => format!(
                "The contact explains the force at the measured stroke: {size} times the noise (robust RMS)."
            ),
        };
    }
    let explaining: Vec<String> = regimes
        .iter()
        .filter(|r| r.correlation_ratio >= EXPLAINING)
        .take(3)
        .map(|r| {
            format!(
                "{} ({:.0} %)",
                r.variable.trim_end_matches("_m").replace('_', " "),
                100.0 * r.correlation_ratio
            )
        })
        .collect();
    let when = if explaining.is_empty() {
        "; no single variable explains it".to_owned()
    } else {
        format!("; explained variance by variable: {}", listed(&explaining))
    };
    let (unit, factor) = match link.link {
        Link::Regulator => ("mbar", 1e-2),
        Link::Piston | Link::Contact => ("N", 1.0),
    };
    let rms = root_mean_square(link.sigmas.iter().copied()).unwrap_or_default();
    let amount = format!("{} {unit}", significant(rms * link.unit * factor, 2));
    match link.link {
        Link::Regulator => format!(
            "The regulator does not explain its own recording: {amount} RMS; robust, {size} times its sensor's noise{when}."
        ),
        Link::Piston => format!(
            "Along its measured motion the piston lacks a force of {amount} RMS; robust, {size} times the noise{when}."
        ),
        Link::Contact => format!(
            "The contact does not explain the force at the measured stroke: {amount} RMS are left; robust, {size} times the noise{when}."
        ),
    }
}
