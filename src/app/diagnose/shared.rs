//! What the cases of `--all` know together of a part that their rig files state to be one: which member of a family is at work in all of them.

use std::fmt::Write as _;

use serde::Serialize;

use crate::diagnosis::answer::{Answer, Estimate};
use crate::diagnosis::details::{FamilyMember, FamilyReport};
use crate::diagnosis::family::{Scaling, scaling};
use crate::diagnosis::shared::{
    InAll, InCase, NOT_STATED, SAME_NOMINAL, STATED, common, not_shown, together,
};
use crate::diagnosis::statements::TRUSTED;
use crate::diagnosis::words::{capital, listed, percent};
use crate::quantity::{DIGITS, significant};
use crate::scenario::rig_file::Shares;

/// Standard deviations to either side in a 95 % interval [1].
const INTERVAL: f64 = 1.96;

/// A case that was diagnosed.
pub(super) struct SharingCase<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its answer.
    pub answer: &'a Answer,
    /// Parts that its rig file states.
    pub shares: Shares,
}

/// A family in several cases.
#[derive(Debug, Serialize)]
pub(super) struct SharedFamily {
    /// Its name.
    family: String,
    /// In words, with an article.
    words: String,
    /// Cases that name it with at least 50 %.
    cases: Vec<String>,
    /// Cases that share a part with them, name nothing, and would have shown it.
    not_shown_in: Vec<String>,
    /// Its members, the likeliest first; none where no part is stated to be shared.
    members: Vec<SharedMember>,
}

/// A member of it.
#[derive(Debug, Serialize)]
struct SharedMember {
    /// Name in the vocabulary.
    name: String,
    /// Key of the rig file's number that is off.
    #[serde(skip_serializing_if = "Option::is_none")]
    key: Option<String>,
    /// Part that it is of.
    part: &'static str,
    /// Probability, given that one and the same member is at work in all of the cases [1].
    probability: f64,
    /// Parts that cases share.
    shared: Vec<SharedPart>,
    /// Least and largest value that a case finds, over its nominal one [1].
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    /// Whether every case states which part it has.
    stated: bool,
}

/// A part of several cases.
#[derive(Debug, Serialize)]
struct SharedPart {
    /// Its identity.
    identity: String,
    /// Its cases.
    cases: Vec<String>,
    /// Its one value over the nominal one [1].
    factor: Estimate,
}

/// Each family that two cases at least name.
pub(super) fn shared(cases: &[SharingCase<'_>]) -> Vec<SharedFamily> {
    let mut found: Vec<SharedFamily> = Vec::new();
    for case in cases {
        for report in &case.answer.details.families {
            let scales = |m: &FamilyMember| scaling(&m.name, m.key.as_deref()).is_some();
            let known = found.iter().any(|f| f.family == report.name);
            if !known && report.members.iter().any(scales) {
                found.extend(Together::of(report, cases).map(|together| together.family()));
            }
        }
    }
    found
}

/// The report of a family in a case that names it.
fn named<'a>(case: &SharingCase<'a>, family: &str) -> Option<&'a FamilyReport> {
    let mut families = case.answer.details.families.iter();
    families.find(|f| f.name == family && f.probability >= TRUSTED)
}

/// A member by its name and key.
type Law<'a> = (&'a FamilyMember, &'static Scaling);

/// A family with the cases that tell of it.
struct Together<'a> {
    report: &'a FamilyReport,
    /// Those that name it first, `naming` of them, then those that would have shown it.
    cases: Vec<&'a SharingCase<'a>>,
    naming: usize,
    laws: Vec<Law<'a>>,
}

impl<'a> Together<'a> {
    /// None of a family that less than two cases name.
    fn of(report: &'a FamilyReport, all: &'a [SharingCase<'a>]) -> Option<Self> {
        let (naming, others): (Vec<_>, Vec<_>) =
            all.iter().partition(|c| named(c, &report.name).is_some());
        if naming.len() < 2 {
            return None;
        }
        let mut laws: Vec<Law<'a>> = Vec::new();
        for member in naming
            .iter()
            .filter_map(|c| named(c, &report.name))
            .flat_map(|f| &f.members)
        {
            let known = |(law, _): &Law<'_>| law.name == member.name && law.key == member.key;
            if let Some(scaling) = scaling(&member.name, member.key.as_deref())
                && !laws.iter().any(known)
            {
                laws.push((member, scaling));
            }
        }
        let tells = |case: &&SharingCase<'_>| {
            let mut laws = laws.iter();
            laws.any(|(law, scaling)| {
                let own = case.shares.of(scaling.part);
                let shares =
                    own.is_some() && naming.iter().any(|c| c.shares.of(scaling.part) == own);
                shares && least_shown(case.answer, law).is_some()
            })
        };
        let count = naming.len();
        let others: Vec<_> = others.into_iter().filter(tells).collect();
        Some(Self {
            report,
            cases: naming.into_iter().chain(others).collect(),
            naming: count,
            laws,
        })
    }

    /// Identities of a part that more than one of the cases state, each with the first of them.
    fn groups(&self, scaling: &Scaling) -> Vec<(&'a str, usize)> {
        let identity = |i: usize| self.cases[i].shares.of(scaling.part);
        let mut groups: Vec<(&str, usize)> = Vec::new();
        for first in 0..self.cases.len() {
            let again = |i: usize| identity(i) == identity(first);
            if let Some(own) = identity(first)
                && !(0..first).any(again)
                && (first + 1..self.cases.len()).any(again)
            {
                groups.push((own, first));
            }
        }
        groups
    }

    /// The number of a law in a case that names the family.
    fn number(&self, index: usize, law: &FamilyMember) -> Option<Estimate> {
        let report = named(self.cases[index], &self.report.name)?;
        let number = member(report, law)?.number?;
        number.at_limit.is_none().then_some(number)
    }

    /// A law in all cases.
    fn in_all(&self, (law, scaling): &Law<'_>) -> InAll {
        let groups = self.groups(scaling);
        let numbers = (0..self.cases.len()).map(|i| self.number(i, law));
        let numbers: Vec<Option<Estimate>> = numbers.collect();
        let of_case = |index: usize| {
            let case = self.cases[index];
            let own = case.shares.of(scaling.part);
            let part = groups.iter().find(|(identity, _)| Some(*identity) == own);
            // One part has one number, whatever its files take for the nominal one.
            let part = part.map_or(index, |(_, first)| *first);
            let nominal = numbers[part].or(numbers[index]).and_then(|n| n.without);
            let scale = match (numbers[index], nominal) {
                (Some(number), Some(nominal)) => of_number(&number, nominal, scaling.power),
                _ if index >= self.naming => {
                    let least = least_shown(case.answer, law);
                    least.map(|least| not_shown(scaling.power * least.ln()))
                }
                _ => None,
            };
            let report = named(case, &self.report.name);
            InCase {
                // What is not named says nothing of what it is not.
                probability: report.map_or(1.0, |report| {
                    member(report, law).map_or(0.0, |m| m.probability)
                }),
                scale,
                part,
            }
        };
        let nominals = numbers.iter().flatten().filter_map(|n| n.without);
        let nominals: Vec<f64> = nominals.collect();
        let differ = nominals
            .iter()
            .any(|n| (n / nominals[0] - 1.0).abs() > 1e-9);
        let doubt = match (groups.is_empty() && !differ, self.stated(scaling)) {
            (true, false) => NOT_STATED,
            (true, true) => SAME_NOMINAL,
            (false, _) => STATED,
        };
        InAll {
            cases: (0..self.cases.len()).map(of_case).collect(),
            doubt,
        }
    }

    /// Whether every case that names the family states which part it has.
    fn stated(&self, scaling: &Scaling) -> bool {
        let mut naming = self.cases[..self.naming].iter();
        naming.all(|c| c.shares.of(scaling.part).is_some())
    }

    fn family(&self) -> SharedFamily {
        let shares = |(_, scaling): &Law<'_>| !self.groups(scaling).is_empty();
        let decided = self.laws.iter().any(shares);
        let all: Vec<InAll> = self.laws.iter().map(|law| self.in_all(law)).collect();
        let members = self.laws.iter().zip(&all).zip(together(&all));
        let mut members: Vec<SharedMember> = members
            .filter(|_| decided)
            .map(|((law, all), probability)| self.member(law, all, probability))
            .collect();
        members.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let (naming, others) = self.cases.split_at(self.naming);
        let names = |cases: &[&SharingCase<'_>]| cases.iter().map(|c| c.name.to_owned()).collect();
        SharedFamily {
            family: self.report.name.clone(),
            words: self.report.words.clone(),
            cases: names(naming),
            not_shown_in: names(others),
            members,
        }
    }

    fn member(&self, (law, scaling): &Law<'_>, all: &InAll, probability: f64) -> SharedMember {
        let factor = |logarithm: f64| (logarithm / scaling.power).exp();
        let part = |(identity, first): (&str, usize)| {
            let own = (0..self.cases.len()).filter(|i| all.cases[*i].part == first);
            let [at, deviation] = common(&all.scales(first));
            let [low, high] = [-INTERVAL, INTERVAL].map(|z| factor(at + z * deviation));
            SharedPart {
                identity: identity.to_owned(),
                cases: own.map(|i| self.cases[i].name.to_owned()).collect(),
                factor: Estimate::new(factor(at), low, high),
            }
        };
        let scales = all.cases[..self.naming].iter().filter_map(|c| c.scale);
        let factors: Vec<f64> = scales.map(|[at, _]| factor(at)).collect();
        let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
        let most = factors.iter().copied().fold(0.0, f64::max);
        SharedMember {
            name: law.name.clone(),
            key: law.key.clone(),
            part: scaling.part,
            probability,
            shared: self.groups(scaling).into_iter().map(part).collect(),
            range: (!factors.is_empty()).then_some([least, most]),
            stated: self.stated(scaling),
        }
    }
}

/// A law in the report of its family.
fn member<'a>(report: &'a FamilyReport, law: &FamilyMember) -> Option<&'a FamilyMember> {
    let mut members = report.members.iter();
    members.find(|m| m.name == law.name && m.key == law.key)
}

/// The scale's logarithm that a number comes to, and its standard deviation; none where it is not above zero.
fn of_number(number: &Estimate, nominal: f64, power: f64) -> Option<[f64; 2]> {
    let at = |value: f64| power * (value / nominal).ln();
    let scale = [
        at(number.value),
        (at(number.high) - at(number.low)).abs() / (2.0 * INTERVAL),
    ];
    scale.iter().all(|v| v.is_finite()).then_some(scale)
}

/// Least number over the nominal one with which a law would have been named in a case that names nothing [1].
fn least_shown(answer: &Answer, law: &FamilyMember) -> Option<f64> {
    let mut detectable = answer.details.detectable.iter();
    let own = detectable.find(|d| law.key.is_none() && d.effect == law.name)?;
    let number = own.parameters.first()?;
    let factor = number.value / number.without?;
    (factor > 0.0 && factor.is_finite()).then_some(factor)
}

impl SharedFamily {
    /// It in words, a line each; without shared parts what would let the cases decide.
    pub(super) fn text(&self) -> String {
        let words = capital(&self.words);
        let count = self.cases.len();
        if self.members.is_empty() {
            return format!(
                "{words} in {count} cases: where they have a part in common, [shares] in their rig.toml says so, and they decide together which it is\n"
            );
        }
        let mut text = format!("{words} in {count} cases, together:\n");
        let name = |m: &SharedMember| match &m.key {
            Some(key) => format!("{} ({key})", m.name),
            None => m.name.clone(),
        };
        let wide = self.members.iter().map(|m| name(m).chars().count()).max();
        let wide = wide.unwrap_or_default();
        for member in &self.members {
            let (name, probability) = (name(member), percent(member.probability));
            let what = member.what();
            // Writing into a text cannot fail.
            let _ = writeln!(text, "  {name:<wide$}  {probability:>7}  {what}");
        }
        if !self.not_shown_in.is_empty() {
            let names = listed(&self.not_shown_in);
            let _ = writeln!(
                text,
                "  with a part of these, and nothing of it to be seen: {names}"
            );
        }
        let open = self
            .members
            .iter()
            .filter(|m| m.shared.is_empty() && !m.stated);
        let open: Vec<String> = open.map(|m| m.part.replace('_', " ")).collect();
        if self.members[0].probability < 1.0 - SAME_NOMINAL && !open.is_empty() {
            let _ = writeln!(
                text,
                "  what [shares] does not say: which {} each case has",
                listed(&open)
            );
        }
        text
    }
}

impl SharedMember {
    /// What the cases find of it, or would have to.
    fn what(&self) -> String {
        let shown = |value: f64| significant(value, DIGITS);
        let part = self.part.replace('_', " ");
        let range = self.range.map(|[least, most]| {
            format!("between {} and {} of nominal", shown(least), shown(most))
        });
        let range = range.unwrap_or_else(|| "not known".to_owned());
        let of_part = |shared: &SharedPart| {
            let Estimate {
                value, low, high, ..
            } = shared.factor;
            format!(
                "{} ({} to {}) of nominal in {} cases with {part} {}",
                shown(value),
                shown(low),
                shown(high),
                shared.cases.len(),
                shared.identity
            )
        };
        let shared: Vec<String> = self.shared.iter().map(of_part).collect();
        match shared.is_empty() {
            true => format!("each {part} its own, all {range}"),
            false => format!("{}; the cases alone: {range}", listed(&shared)),
        }
    }
}
