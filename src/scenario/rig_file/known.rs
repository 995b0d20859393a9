//! `[known]` of an improved rig file: how sure a diagnosis is of its numbers and predictions, and what its recordings covered.
//!
//! ```text
//! numbers = ["regulator.gain", "unlisted.height"]   what was fitted; keys of this file, names of effects' numbers, or latent.K
//! deviations = [0.002, 1.3]                         one standard deviation of each, in its unit
//! correlations = [0.3]                              below the diagonal, row by row
//! noise = [400.0, 2e-5, 0.8, 0.15]                  of pressure, stroke, force, acceleration, one standard deviation
//! half_widths = [1.7, 1.6, 1.8, 1.6]                half of a 90 % band, in standard deviations of noise and numbers together
//!
//! [known.covered]                                   by name, in its unit: least and largest value; of one over another a pair for each part of its range
//! speed_m_per_s = [-0.2, 0.25]
//! ```

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use super::super::effects::as_written;
use super::latent::float;
use super::quantities::NUMBERS;
use crate::effects::PresentEffect;
use crate::keys::check::{Section, plain};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::plant::{Basis, CHANNELS, Latent, MOST_CONSTANTS, PlantParameters, Quantity, registry};

/// Name of the table.
pub(super) const TABLE: &str = "known";

/// How sure a diagnosis is of a model, and what its recordings covered.
#[derive(Debug, Clone, Default)]
pub struct Known {
    /// Numbers that were fitted: name, place in the description, standard deviation in its unit.
    pub numbers: Vec<(String, Quantity, f64)>,
    /// Their correlations below the diagonal, row by row [1].
    pub correlations: Vec<f64>,
    /// Standard deviation of each channel's noise, in the order of [`CHANNELS`].
    pub noise: [f64; CHANNELS.len()],
    /// Half of a 90 % band in standard deviations of noise and numbers together, of each channel [1].
    pub half_widths: [f64; CHANNELS.len()],
    /// What the recordings covered, by name.
    pub covered: BTreeMap<String, Vec<f64>>,
}

/// `[known]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KnownKeys {
    pub numbers: Vec<String>,
    pub deviations: Vec<f64>,
    pub correlations: Vec<f64>,
    pub noise: [f64; CHANNELS.len()],
    pub half_widths: [f64; CHANNELS.len()],
    #[serde(default)]
    pub covered: BTreeMap<String, Vec<f64>>,
}

/// Name of a coefficient of a model discrepancy.
#[must_use]
pub fn coefficient_name(index: usize) -> String {
    format!("latent.{index}")
}

/// Name of the frequency of a periodic one.
pub const FREQUENCY_NAME: &str = "latent.frequency";

/// The table of a file.
pub(super) fn known(
    document: &Document<'_>,
    keys: Option<KnownKeys>,
    plant: &PlantParameters,
    effects: &[PresentEffect],
) -> Result<Option<Known>, ScenarioError> {
    let Some(keys) = keys else { return Ok(None) };
    let section = Section::new(document, TABLE);
    let count = keys.numbers.len();
    for (key, found, expected) in [
        ("deviations", keys.deviations.len(), count),
        (
            "correlations",
            keys.correlations.len(),
            count * count.saturating_sub(1) / 2,
        ),
    ] {
        if found != expected {
            let expected = format!("a list of {expected}, as `numbers` has {count}");
            return Err(section.refuse(key, format!("a list of {found}"), expected));
        }
    }
    let bad = |values: &[f64], least: f64| values.iter().any(|v| !(least..1e15).contains(v));
    if bad(&keys.deviations, 0.0) {
        return Err(section.refuse(
            "deviations",
            "one that is none".to_owned(),
            "numbers of 0 or more".to_owned(),
        ));
    }
    if keys.correlations.iter().any(|c| !(-1.0..=1.0).contains(c)) {
        return Err(section.refuse(
            "correlations",
            "one beyond".to_owned(),
            "numbers from -1 to 1".to_owned(),
        ));
    }
    if bad(&keys.half_widths, 0.0) || keys.noise.iter().any(|noise| noise.is_nan()) {
        return Err(section.refuse(
            "half_widths",
            "one that is none".to_owned(),
            "numbers of 0 or more, and of noise".to_owned(),
        ));
    }
    let mut numbers = Vec::new();
    for (name, deviation) in keys.numbers.into_iter().zip(keys.deviations) {
        let Some(quantity) = quantity_of(&name, plant, effects) else {
            let expected = "a number of this file, by its key or as `effect.number`".to_owned();
            return Err(section.refuse("numbers", format!("{name:?}"), expected));
        };
        numbers.push((name, quantity, deviation));
    }
    Ok(Some(Known {
        numbers,
        correlations: keys.correlations,
        noise: keys.noise,
        half_widths: keys.half_widths,
        covered: keys.covered,
    }))
}

fn quantity_of(name: &str, plant: &PlantParameters, effects: &[PresentEffect]) -> Option<Quantity> {
    if let Some(number) = NUMBERS.iter().find(|number| number.name == name) {
        return Some(number.quantity());
    }
    if name == FREQUENCY_NAME {
        return Some(registry::LATENT_FREQUENCY.quantity());
    }
    let (owner, own) = name.rsplit_once('.')?;
    if owner == "latent" {
        let index: usize = own.parse().ok()?;
        let latent = plant
            .latent
            .as_ref()
            .filter(|l| index < l.coefficients.len())?;
        return Some(of_term(latent, index));
    }
    // Of a law, constants that are exact for a diagnosis of this file are among them too.
    let law = plant.own.iter().position(|law| law.text.name == owner);
    if let Some(place) = law {
        let constants = plant.own[place].text.constants.iter();
        let index = constants.map(|c| c.name).position(|name| name == own)?;
        let number = registry::OWN_CONSTANT.quantity();
        return Some(number.of(place * MOST_CONSTANTS + index));
    }
    let effect = effects
        .iter()
        .find(|present| present.effect.name == owner)?
        .effect;
    let mut parameters = effect.parameters(plant).into_iter();
    Some(parameters.find(|p| p.quantity.name == own)?.quantity)
}

/// The number of a model discrepancy that a fit moves.
#[must_use]
pub fn of_term(latent: &Latent, index: usize) -> Quantity {
    match latent.basis {
        Basis::Hats { .. } => registry::LATENT_RISE.quantity().of(index),
        _ => registry::LATENT_COEFFICIENT.quantity().of(index),
    }
}

/// It as a table of a file.
pub(super) fn text(known: &Known) -> String {
    let mut text = format!(
        "\n# How sure the numbers and predictions are, and what the recordings covered: `idc predict` states its bands by it.\n[{TABLE}]\n"
    );
    let list = |values: &mut dyn Iterator<Item = f64>| {
        let values: Vec<String> = values.map(|v| float(&plain(as_written(v)))).collect();
        format!("[{}]", values.join(", "))
    };
    let names: Vec<String> = known
        .numbers
        .iter()
        .map(|(name, ..)| format!("{name:?}"))
        .collect();
    let rounded = known.correlations.iter().map(|c| (c * 1e4).round() / 1e4);
    // Writing into a text cannot fail.
    let _ = writeln!(text, "numbers = [{}]", names.join(", "));
    let _ = writeln!(
        text,
        "deviations = {}",
        list(&mut known.numbers.iter().map(|(.., d)| *d))
    );
    let _ = writeln!(text, "correlations = {}", list(&mut rounded.into_iter()));
    let noise = known.noise.map(|noise| {
        if noise.is_finite() {
            float(&plain(as_written(noise)))
        } else {
            "inf".to_owned()
        }
    });
    let _ = writeln!(
        text,
        "noise = [{}]   # pressure, stroke, force, acceleration",
        noise.join(", ")
    );
    let _ = writeln!(
        text,
        "half_widths = {}",
        list(&mut known.half_widths.iter().copied())
    );
    if !known.covered.is_empty() {
        let _ = writeln!(text, "\n[{TABLE}.covered]");
        for (name, values) in &known.covered {
            let _ = writeln!(text, "{name} = {}", list(&mut values.iter().copied()));
        }
    }
    text
}
