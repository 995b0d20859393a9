//! What the cases of `--all` know together of a part that their rig files state to be one: which member of a family is at work in all of them.

use serde::Serialize;

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::details::{FamilyMember, FamilyReport};
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::family::{Scaling, scaling};
use crate::diagnosis::answer::shared::{
    InAll, InCase, NOT_STATED, SAME_NOMINAL, STATED, not_shown, together,
};
use crate::diagnosis::answer::statements::TRUSTED;
use crate::diagnosis::answer::words::{capital, listed, percent};
use crate::document::{Block, Section};
use crate::effects::{Effect, candidates, numbers_off};
use crate::plant::DeviceParts;
use crate::quantity::{DIGITS, significant, with_unit};
use crate::scenario::rig_file::RigFile;
use crate::stats::NORMAL_95;

/// Probability from which a case names a family [1]: as likely as not, which a doubt leaves of one that the evidence is sure of.
const NAMED: f64 = 0.99 * TRUSTED;
/// Share by which two nominal values differ that are one [1].
const SAME: f64 = 1e-9;

/// A case that was diagnosed.
pub(super) struct SharingCase<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its answer.
    pub answer: &'a Answer,
    /// Its rig file.
    pub rig: RigFile,
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
    key: Option<&'static str>,
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
    /// Those that have one value; none where each has its own.
    agreeing: Vec<String>,
    /// That value over the nominal one [1].
    #[serde(skip_serializing_if = "Option::is_none")]
    factor: Option<Estimate>,
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
    families.find(|f| f.name == family && f.probability >= NAMED)
}

/// A law that scales what its family scales.
#[derive(Clone, Copy)]
struct Law {
    effect: &'static Effect,
    scaling: &'static Scaling,
}

impl Law {
    /// Those of a family that a diagnosis of a rig looks at.
    fn of(rig: &RigFile, family: &str) -> Vec<Self> {
        let parts = rig.plant.parts;
        let all = candidates(parts).into_iter().chain(numbers_off(parts));
        let laws = all.filter_map(|effect| {
            let scaling = scaling(effect.vocabulary().0, effect.number_key())?;
            (scaling.family == family).then_some(Self { effect, scaling })
        });
        laws.collect()
    }

    /// Its number in a rig, as the file has it.
    fn nominal(&self, rig: &RigFile) -> f64 {
        let mut numbers = self.effect.parameters(&rig.plant).into_iter();
        numbers
            .next()
            .map_or(f64::NAN, |n| n.quantity.get(&rig.plant))
    }

    /// Identity of its part in a case.
    fn part<'b>(&self, case: &'b SharingCase<'_>) -> Option<&'b str> {
        case.rig.shares.of(self.scaling.part)
    }

    fn is(&self, member: &FamilyMember) -> bool {
        self.effect.vocabulary().0 == member.name
            && self.effect.number_key() == member.key.as_deref()
    }

    /// Least size of the scale's logarithm with which it would have been named in a case that names nothing [1].
    fn least_shown(&self, answer: &Answer) -> Option<f64> {
        let mut detectable = answer.details.detectable.iter();
        let name = self.effect.vocabulary().0;
        let own = detectable.find(|d| self.effect.number_key().is_none() && d.effect == name)?;
        let number = own.parameters.first()?;
        let least = self.scaling.power * (number.value / number.without?).ln();
        least.is_finite().then_some(least)
    }
}

/// A family with the cases that tell of it.
struct Together<'a> {
    report: &'a FamilyReport,
    /// Those that name it first, `naming` of them, then those that would have shown it.
    cases: Vec<&'a SharingCase<'a>>,
    naming: usize,
    laws: Vec<Law>,
}

impl<'a> Together<'a> {
    /// None of a family that less than two cases name.
    fn of(report: &'a FamilyReport, all: &'a [SharingCase<'a>]) -> Option<Self> {
        let (naming, others): (Vec<_>, Vec<_>) =
            all.iter().partition(|c| named(c, &report.name).is_some());
        if naming.len() < 2 {
            return None;
        }
        let mut laws: Vec<Law> = Vec::new();
        for law in naming.iter().flat_map(|c| Law::of(&c.rig, &report.name)) {
            if !laws
                .iter()
                .any(|known| known.effect.name == law.effect.name)
            {
                laws.push(law);
            }
        }
        let tells = |case: &&SharingCase<'_>| {
            laws.iter().any(|law| {
                let own = law.part(case);
                let shares = own.is_some() && naming.iter().any(|c| law.part(c) == own);
                shares && law.least_shown(case.answer).is_some()
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

    /// Identities of a law's part that more than one of the cases state, each with the first of them.
    fn groups(&self, law: &Law) -> Vec<(&'a str, usize)> {
        let identity = |i: usize| law.part(self.cases[i]);
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

    /// Scale in a case by a member's number, over the nominal one: its logarithm, and its standard deviation [1].
    fn scale_by(&self, index: usize, member: &FamilyMember) -> Option<[f64; 2]> {
        let law = self.laws.iter().find(|law| law.is(member))?;
        let number = member.number.filter(|n| n.at_limit.is_none())?;
        let nominal = law.nominal(&self.cases[index].rig);
        let at = |value: f64| law.scaling.power * (value / nominal).ln();
        let deviation = (at(number.high) - at(number.low)).abs() / (2.0 * NORMAL_95);
        let scale = [at(number.value), deviation];
        scale.iter().all(|v| v.is_finite()).then_some(scale)
    }

    /// A law in a case: its probability there, and the scale.
    fn in_case(&self, index: usize, law: &Law) -> (f64, Option<[f64; 2]>) {
        let case = self.cases[index];
        let Some(report) = named(case, &self.report.name) else {
            // What is not named says nothing of what it is not.
            return (1.0, law.least_shown(case.answer).map(not_shown));
        };
        let own = report.members.iter().find(|m| law.is(m));
        let listed: f64 = report.members.iter().map(|m| m.probability).sum();
        let likeliest = report
            .members
            .iter()
            .map(|m| m.probability)
            .fold(0.0, f64::max);
        let absent = |law: &&Law| !report.members.iter().any(|m| law.is(m));
        let of_rig = Law::of(&case.rig, &self.report.name);
        let absent = of_rig.iter().filter(absent).count().max(1) as f64;
        // Laws that act alike are not all fitted: those that were not share what is left of the family.
        let left = (report.probability - listed).max(0.0) / absent;
        // All of them scale one and the same, so that another's number tells it too.
        let others = own.into_iter().chain(&report.members);
        let mut scales = others.filter_map(|m| self.scale_by(index, m));
        // By the evidence none is likelier than that of the answer, whatever doubts leave of it.
        let of_answer = |m: &FamilyMember| {
            let mut effects = case.answer.effects.iter();
            effects.any(|e| e.name == m.name && e.key == m.key)
        };
        let probability = match own {
            // Where a piston is moved, force by pressure is all that is seen: whichever was fitted, the others do as well.
            _ if case.rig.plant.parts == DeviceParts::MovedPiston => 1.0,
            Some(member) if of_answer(member) => likeliest,
            Some(member) => member.probability,
            None => left,
        };
        (probability, scales.next())
    }

    /// A law in all cases.
    fn in_all(&self, law: &Law) -> InAll {
        let groups = self.groups(law);
        let nominal = |index: usize| law.nominal(&self.cases[index].rig);
        let of_case = |index: usize| {
            let own = law.part(self.cases[index]);
            let part = groups.iter().find(|(identity, _)| Some(*identity) == own);
            let part = part.map_or(index, |(_, first)| *first);
            let (probability, scale) = self.in_case(index, law);
            // One part has one number, whatever its files take for the nominal one.
            let shift = law.scaling.power * (nominal(index) / nominal(part)).ln();
            InCase {
                probability,
                scale: scale.map(|[at, deviation]| [at + shift, deviation]),
                part,
            }
        };
        let differ = (1..self.naming).any(|i| (nominal(i) / nominal(0) - 1.0).abs() > SAME);
        let doubt = match (groups.is_empty() && !differ, self.stated(law)) {
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
    fn stated(&self, law: &Law) -> bool {
        let mut naming = self.cases[..self.naming].iter();
        naming.all(|c| law.part(c).is_some())
    }

    fn family(&self) -> SharedFamily {
        let decided = self.laws.iter().any(|law| !self.groups(law).is_empty());
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

    fn member(&self, law: &Law, all: &InAll, probability: f64) -> SharedMember {
        let factor = |logarithm: f64| (logarithm / law.scaling.power).exp();
        let names = |cases: &[usize]| {
            cases
                .iter()
                .map(|i| self.cases[*i].name.to_owned())
                .collect()
        };
        let part = |(identity, first): (&str, usize)| {
            let of_it = |i: &usize| all.cases[*i].part == first;
            let own: Vec<usize> = (0..self.cases.len()).filter(of_it).collect();
            let one = all.one_value(first);
            let value = one.as_ref().map(|(_, [at, deviation])| {
                let [low, high] = [-NORMAL_95, NORMAL_95].map(|z| factor(at + z * deviation));
                Estimate::new(factor(*at), low, high)
            });
            SharedPart {
                identity: identity.to_owned(),
                cases: names(&own),
                agreeing: one.map_or_else(Vec::new, |(agreeing, _)| names(&agreeing)),
                factor: value,
            }
        };
        let scales = all.cases[..self.naming].iter().filter_map(|c| c.scale);
        let factors: Vec<f64> = scales.map(|[at, _]| factor(at)).collect();
        let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
        let most = factors.iter().copied().fold(0.0, f64::max);
        SharedMember {
            name: law.effect.vocabulary().0.to_owned(),
            key: law.effect.number_key(),
            part: law.scaling.part,
            probability,
            shared: self.groups(law).into_iter().map(part).collect(),
            range: (!factors.is_empty()).then_some([least, most]),
            stated: self.stated(law),
        }
    }
}

impl SharedFamily {
    /// It in words; without shared parts what would let the cases decide.
    pub(super) fn section(&self) -> Section<'static> {
        let title = format!("{} in {} cases", capital(&self.words), self.cases.len());
        let Some(first) = self.members.first() else {
            let words = "Where they have a part in common, [shares] in their rig.toml says so, and they decide together which it is.";
            return Section::new(&title, vec![Block::Paragraph(words.to_owned())]);
        };
        let mut said = vec!["Where it is the same in all:".to_owned()];
        said.extend(self.members.iter().map(SharedMember::words));
        if !self.not_shown_in.is_empty() {
            let names = listed(&self.not_shown_in);
            said.push(format!(
                "With a part of these, and nothing of it to be seen: {names}."
            ));
        }
        let open = self.members.iter();
        let open = open.filter(|m| m.shared.is_empty() && !m.stated);
        let open: Vec<String> = open.map(|m| m.part.replace('_', " ")).collect();
        if first.probability < 1.0 - SAME_NOMINAL && !open.is_empty() {
            let open = listed(&open);
            said.push(format!(
                "Not stated in [shares]: which {open} each case has."
            ));
        }
        Section::new(&title, said.into_iter().map(Block::Paragraph).collect())
    }
}

impl SharedMember {
    /// What the cases find of it, or would have to.
    fn words(&self) -> String {
        let shown = |value: f64| significant(value, DIGITS);
        let part = self.part.replace('_', " ");
        let of_part = |shared: &SharedPart| {
            let identity = &shared.identity;
            let Some(factor) = shared.factor else {
                let count = shared.cases.len();
                return format!("no one value of {part} {identity} in its {count} cases");
            };
            let others = shared.cases.iter().filter(|c| !shared.agreeing.contains(c));
            let others: Vec<String> = others.cloned().collect();
            let but = match others.is_empty() {
                true => String::new(),
                false => format!(" (not in {})", listed(&others)),
            };
            format!(
                "{} ({} to {}) of nominal in {} cases with {part} {identity}{but}",
                shown(factor.value),
                shown(factor.low),
                shown(factor.high),
                shared.agreeing.len(),
            )
        };
        let shared: Vec<String> = self.shared.iter().map(of_part).collect();
        let what = match (shared.is_empty(), self.stated) {
            (true, true) => format!("each {part} its own"),
            (true, false) => format!("{part}s of which nothing is stated"),
            (false, _) => listed(&shared),
        };
        let range = self.range.map(|[least, most]| {
            let apart = with_unit(100.0 * (most / least - 1.0), "%");
            let [least, most] = [shown(least), shown(most)];
            format!("; each alone from {least} to {most}, {apart} apart")
        });
        let name = match self.key {
            Some(key) => format!("{} ({key})", self.name),
            None => self.name.clone(),
        };
        let probability = percent(self.probability);
        let range = range.unwrap_or_default();
        format!("{name} {probability}: {what}{range}.")
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scenario::rig_file::from_text;

    /// Bore of the rig file to start from [m].
    const BORE: f64 = 0.0211;

    /// That rig with another bore, and parts that it states.
    fn rig(bore: f64, shares: &str) -> RigFile {
        let text = include_str!("../../../assets/new/rig.toml");
        let text = text.replace("bore_m = 0.0211 ", &format!("bore_m = {bore} "));
        let text = format!("{text}\n[shares]\n{shares}\n");
        from_text(Path::new("rig.toml"), &text).unwrap()
    }

    fn answer(details: &str) -> Answer {
        let text = format!(
            r#"{{"schema":1,"verdict":"nothing_missing","effects":[],"mismatch":[],"seconds":0.0,"alternatives":[],{details}}}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    /// A case that names the family: probability of its members, a gain and a bore [m], each to 0.2 %.
    fn naming([gain, bore]: [f64; 2], of_gain: f64, value: f64) -> Answer {
        let number = |value: f64| {
            let [low, high] = [0.998 * value, 1.002 * value];
            format!(r#"{{"value":{value},"low":{low},"high":{high}}}"#)
        };
        answer(&format!(
            r#""families":[{{"name":"force_by_pressure","words":"another scale of force by pressure","probability":{value},"members":[
                {{"name":"force_sensor_gain_error","probability":{of_gain},"number":{}}},
                {{"name":"number_off","key":"cylinder.bore_m","probability":{},"number":{}}}]}}]"#,
            number(gain),
            value - of_gain,
            number(bore)
        ))
    }

    const SHOWN: &str = r#""detectable":[{"effect":"force_sensor_gain_error","parameters":[{"name":"gain","value":1.004,"without":1.0}]}]"#;

    /// The family by cases, each with its bore [m], what it shares and its answer.
    fn of(cases: &[(f64, &str, Answer)]) -> Option<SharedFamily> {
        let names: Vec<String> = (0..cases.len()).map(|i| format!("case-{i}")).collect();
        let cases = cases.iter().zip(&names);
        let cases: Vec<SharingCase<'_>> = cases
            .map(|((bore, shares, answer), name)| SharingCase {
                name,
                answer,
                rig: rig(*bore, shares),
            })
            .collect();
        shared(&cases).pop()
    }

    const LC_7: &str = "force_sensor = \"LC-7\"";

    #[test]
    fn a_case_that_would_have_shown_it_counts_against_those_that_agree() {
        let named = || naming([1.03, BORE * 1.015], 0.5, 1.0);
        let all = [(BORE, LC_7, named()), (BORE, LC_7, named())];
        let two = of(&all).unwrap();
        let three = [&all[..], &[(BORE, LC_7, answer(SHOWN))]].concat();
        let found = of(&three).unwrap();
        assert_eq!(found.not_shown_in, ["case-2"]);
        let gain = |f: &SharedFamily| {
            let mut members = f.members.iter();
            let own = members.find(|m| m.part == "force_sensor").unwrap();
            (own.probability, own.shared[0].agreeing.len())
        };
        assert_eq!(gain(&two).1, 2);
        assert!(gain(&found).0 < 0.2 * gain(&two).0, "{found:?}");
        let said = format!("{:?}", found.section());
        assert!(said.contains("case-2"), "{said}");
        // One with another load cell says nothing of this one.
        let other = [
            &all[..],
            &[(BORE, "force_sensor = \"LC-8\"", answer(SHOWN))],
        ]
        .concat();
        assert!(of(&other).unwrap().not_shown_in.is_empty());
    }

    #[test]
    fn a_bore_of_one_cylinder_is_one_whatever_its_files_say_of_it() {
        let same = "cylinder = \"C-1\"";
        let cases = [
            (BORE, same, naming([1.03, 0.0214], 0.2, 1.0)),
            (0.0207, same, naming([1.06, 0.0214], 0.2, 1.0)),
        ];
        let found = of(&cases).unwrap();
        let bore = found.members.iter().find(|m| m.part == "cylinder").unwrap();
        let part = &bore.shared[0];
        assert_eq!((part.identity.as_str(), part.agreeing.len()), ("C-1", 2));
        // Over the first file's.
        let factor = part.factor.unwrap().value;
        assert!((factor - 0.0214 / BORE).abs() < 1e-4, "{factor}");
        assert!(bore.probability > 0.5, "{found:?}");
    }

    #[test]
    fn nothing_is_stated_of_one_case_or_of_a_family_that_few_name() {
        let named = |value: f64| naming([1.03, BORE * 1.015], 0.5 * value, value);
        assert!(of(&[(BORE, LC_7, named(1.0)), (BORE, LC_7, answer(SHOWN))]).is_none());
        assert!(of(&[(BORE, LC_7, named(1.0)), (BORE, LC_7, named(0.4))]).is_none());
        let apart = [(BORE, LC_7, named(1.0)), (BORE, "", named(1.0))];
        let found = of(&apart).unwrap();
        assert!(found.members.is_empty());
        let said = format!("{:?}", found.section());
        assert!(said.contains("[shares]"), "{said}");
    }
}
