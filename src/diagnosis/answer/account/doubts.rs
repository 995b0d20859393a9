//! Words on how sure an effect is: what is doubted of it, and the family of which it is.

use super::super::details::FamilyReport;
use super::super::doubt::Doubt;
use super::super::finding::Diagnosis;
use super::super::statements::{TRUSTED, in_headline};
use super::super::words::{capital, listed};
use super::missing::probability;
use crate::diagnosis::fit::hypothesis::effect_display_name;
use crate::effects::{Effect, UNLISTED};

/// Odds from which one law of a family is distinguished from another (Kass and Raftery, Journal of the American Statistical Association 90, 1995) [1].
const CLEAR: f64 = 3.0;

impl Diagnosis {
    /// Names in the headline: of effects that are sure, of the family where its law is open, and of what may be; none of what is only doubted.
    pub(super) fn headline_names(&self) -> Vec<String> {
        let families = self.families();
        let mut names: Vec<String> = Vec::new();
        for effect in &self.best().effects {
            let name = effect_display_name(effect.name);
            let confidence = self.confidence(effect.name);
            let family = families
                .iter()
                .find(|f| has(f, effect.vocabulary().0, effect.number_key()));
            let may_stand = in_headline(confidence, &self.doubts(effect.name));
            let open = family.is_some_and(|f| is_open(f, effect, confidence));
            let said = match family.filter(|f| f.probability >= TRUSTED) {
                _ if confidence >= TRUSTED && may_stand && !open => name,
                Some(family) => format!("{} (which law is open)", family.words),
                None if may_stand => format!("perhaps {name}"),
                None => continue,
            };
            if !names.contains(&said) {
                names.push(said);
            }
        }
        let unlisted = self.best().unlisted().is_some()
            && in_headline(self.confidence(UNLISTED), &self.doubts(UNLISTED));
        if unlisted || self.leaves_model_discrepancy() {
            names.push("physics that no known effect explains".to_owned());
        }
        names
    }

    /// What is doubted of an effect, as sentences after its probability.
    pub(super) fn doubt_words(&self, name: &str) -> String {
        let doubts = self.doubts(name);
        let forbidding = doubts.iter().filter(|d| d.forbids());
        let forbidding: Vec<String> = forbidding.map(|d| d.words().to_owned()).collect();
        let mut words = String::new();
        if !forbidding.is_empty() {
            words += &format!(" Not to be trusted: {}.", listed(&forbidding));
        } else if self.confidence(name) < TRUSTED {
            words += " Not to be trusted: another explanation is as likely, or it gains less than what all of them leave and may stand in for what another law gets slightly wrong.";
        }
        if doubts.contains(&Doubt::NotTriedBeyond) {
            let untried: Vec<String> = self.untried().into_iter().map(str::to_owned).collect();
            words += &format!(
                " Stated at no more than 90 %: {} {} at the end of the tolerance, and nothing beyond it was tried.",
                listed(&untried),
                if untried.len() == 1 {
                    "stands"
                } else {
                    "stand"
                }
            );
        }
        if doubts.contains(&Doubt::LeavesMuch) {
            words += " Stated at no more than 90 %, for a channel is left far above its noise.";
        }
        words
    }

    /// Families of which more than one law may be at work, or that are surer than their law, a sentence each.
    pub(super) fn family_words(&self) -> Vec<String> {
        let surer = |f: &FamilyReport| f.members.iter().all(|m| m.probability < f.probability);
        let families = self.families().into_iter();
        let families = families.filter(|f| f.members.len() > 1 || surer(f));
        let words = families.map(|family| {
            let laws = family.members.iter().map(|m| {
                let name = match &m.key {
                    Some(key) => format!("{} ({key})", m.name),
                    None => m.name.clone(),
                };
                format!("{name} {}", probability(m.probability))
            });
            let laws: Vec<String> = laws.collect();
            format!(
                "{}: probability {}, whichever of its laws it is; of these {}.",
                capital(&family.words),
                probability(family.probability),
                listed(&laws)
            )
        });
        words.collect()
    }
}

/// Whether another law of a family is nearly as likely as one of it.
fn is_open(family: &FamilyReport, own: &Effect, confidence: f64) -> bool {
    let mut members = family.members.iter();
    members.any(|m| {
        let other = m.name != own.vocabulary().0 || m.key.as_deref() != own.number_key();
        other && CLEAR * m.probability > confidence
    })
}

/// Whether a law is of a family.
fn has(family: &FamilyReport, name: &str, key: Option<&str>) -> bool {
    let mut members = family.members.iter();
    members.any(|m| m.name == name && m.key.as_deref() == key)
}
