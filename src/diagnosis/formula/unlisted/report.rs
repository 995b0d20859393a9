//! Part of diagnosis.json on a model discrepancy.

use serde::{Deserialize, Serialize};

use super::known::known;
use super::shape::ShapePoint;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::answer::words::in_si;
use crate::diagnosis::search::ranking::Ranked;
use crate::plant::Latent;

/// Known explanations named at most.
const MOST_NEAR: usize = 3;

/// All of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnlistedReport {
    /// Where the term enters.
    pub port: String,
    /// On what it depends.
    pub variable: String,
    /// Whether it turns with the direction of motion.
    pub directed: bool,
    /// `periodic`, `localised`, `odd`, `even`, `monotonic` or `broad`.
    pub form: String,
    /// The formula with the values of its constants, if one does all that the curve does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Unit of `at` in the shape, as a key ends with it.
    pub at_unit: String,
    /// Unit of `value` and `half_width`, as a key ends with it.
    pub value_unit: String,
    /// One period with the half width of its 95 % interval [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_s: Option<[f64; 2]>,
    /// Largest less smallest value.
    pub peak_to_peak: f64,
    /// The term against its variable, or over one period, linear between.
    pub shape: Vec<ShapeRow>,
    /// Share of the mismatch that is explained [1].
    pub share_explained: Option<f64>,
    /// Known physics.
    pub nearest: Nearest,
}

/// A value of the term.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ShapeRow {
    /// Value of the variable, or time within a period.
    pub at: f64,
    /// The term.
    pub value: f64,
    /// Half the width of its 95 % interval.
    pub half_width: f64,
}

/// Known physics beside it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nearest {
    /// Physics of such a shape.
    pub resembles: String,
    /// Thing to look at.
    pub check: String,
    /// Known effects that came nearest.
    pub effects: Vec<NearEffects>,
}

/// Known effects that explain a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NearEffects {
    /// Their names.
    pub effects: Vec<String>,
    /// Share of the mismatch that they explain [1].
    pub share_explained: Option<f64>,
    /// Distance behind the best: twice the logarithm of the odds against them [1].
    pub behind: f64,
}

impl Diagnosis {
    /// Words on a model discrepancy, if there is one.
    #[must_use]
    pub fn unlisted_report(&self) -> Option<UnlistedReport> {
        let shape = self.shape.as_ref()?;
        let latent = &shape.latent;
        let row = |row: &ShapePoint| ShapeRow {
            at: row.at,
            value: row.value,
            half_width: row.half_width,
        };
        let known = known(latent, shape.form);
        Some(UnlistedReport {
            port: latent.port.name().to_owned(),
            variable: latent.variable.name().to_owned(),
            directed: latent.directed,
            form: shape.form.name().to_owned(),
            formula: formula_text(latent),
            at_unit: latent.variable.suffix().to_owned(),
            value_unit: latent.port.suffix().to_owned(),
            period_s: shape.period,
            peak_to_peak: shape.peak_to_peak,
            shape: shape.knots.iter().map(row).collect(),
            share_explained: self.explained_share(),
            nearest: Nearest {
                resembles: known.resembles.to_owned(),
                check: known.check.to_owned(),
                effects: self.nearest_known(),
            },
        })
    }

    /// Known effects that came nearest to what a model discrepancy explains.
    #[must_use]
    pub fn nearest_known(&self) -> Vec<NearEffects> {
        let by_name =
            |r: &&Ranked| r.hypothesis.unlisted().is_none() && !r.hypothesis.effects.is_empty();
        let mut near: Vec<&Ranked> = self.ranked.iter().filter(by_name).collect();
        near.sort_by(|a, b| a.score.total_cmp(&b.score));
        near.into_iter()
            .take(MOST_NEAR)
            .map(|r| NearEffects {
                effects: r.hypothesis.effect_display_names(),
                share_explained: self.share_explained_by(&r.hypothesis),
                behind: r.score - self.ranked[0].score,
            })
            .collect()
    }
}

/// A formula with the values of its constants, in SI.
#[must_use]
pub fn formula_text(latent: &Latent) -> Option<String> {
    let law = &latent.formula()?.law;
    let values = (latent.coefficients.iter()).copied();
    let fixed = law.constants.iter().skip(latent.coefficients.len());
    let values = values.chain(fixed.map(|c| c.value));
    let constants = law.constants.iter().zip(values).map(|(constant, value)| {
        let unit = constant.unit.filter(|unit| *unit != "1");
        let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
        format!("{} = {}{unit}", constant.name, in_si(value, 5))
    });
    let constants: Vec<String> = constants.collect();
    let port = law.port.name();
    Some(format!(
        "{port} = {}, {}",
        law.expression.text(),
        constants.join(", ")
    ))
}

impl UnlistedReport {
    /// All numbers with their keys.
    #[must_use]
    pub fn numbers(&self) -> Vec<(String, f64)> {
        let mut numbers = vec![("peak_to_peak".to_owned(), self.peak_to_peak)];
        for row in &self.shape {
            numbers.push(("shape.at".to_owned(), row.at));
            numbers.push(("shape.value".to_owned(), row.value));
            numbers.push(("shape.half_width".to_owned(), row.half_width));
        }
        for value in self.period_s.iter().flatten() {
            numbers.push(("period_s".to_owned(), *value));
        }
        for near in &self.nearest.effects {
            numbers.push((
                format!("nearest.{}.behind", near.effects.join("+")),
                near.behind,
            ));
        }
        numbers
    }
}
