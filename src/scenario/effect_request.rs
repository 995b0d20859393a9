//! An effect asked for by name, as `--with` does: from its name and some of its numbers, in any unit of theirs, to the keys of a scenario file.

use super::arm_file::{ArmFile, further_numbers};
use super::variation::KeyValue;
use crate::effects::{Effect, every};
use crate::keys::suggestion::nearest;
use crate::plant::PlantParameters;
use crate::recorded_arm::usual::usual;
use crate::recorded_arm::vocabulary::{ARM_EFFECTS, ArmEffectName, Place, arm_effect};
use crate::unit::Unit;

/// Key of the joint that an effect is about.
const JOINT: &str = "joint";

/// An effect asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectRequest {
    /// Its name in the vocabulary.
    name: String,
    /// Joint, from 1.
    joint: Option<usize>,
    /// What else says where it is: key, text.
    places: Vec<(&'static str, String)>,
    /// Numbers that are given: key with its unit, value.
    numbers: Vec<(String, f64)>,
}

impl EffectRequest {
    /// `NAME` or `NAME:KEY=VALUE,..`, as in `tool_runout:amplitude_mm=0.1,frequency_hz=120`, `joint_friction:joint=3` or `wrench_drift:channel=force_x`.
    ///
    /// # Errors
    /// Its fault, for people.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (name, given) = text.split_once(':').unwrap_or((text, ""));
        let of_arm = ARM_EFFECTS.iter().map(|effect| effect.name);
        let names: Vec<&str> = every()
            .map(|effect| effect.vocabulary().0)
            .chain(of_arm)
            .collect();
        if !names.contains(&name) {
            let advice = nearest(name, &names);
            return Err(format!("there is no effect `{name}`{advice}"));
        }
        let mut request = Self {
            name: name.to_owned(),
            joint: None,
            places: Vec::new(),
            numbers: Vec::new(),
        };
        for pair in given.split(',').filter(|pair| !pair.is_empty()) {
            let expected =
                || format!("`{pair}` is not KEY=VALUE with a number, as in offset_mm=0.5");
            let (key, value) = pair.split_once('=').ok_or_else(expected)?;
            let is_text = |place: &&Place| **place != Place::Joint && place.key() == key;
            let mut places = request.of_arm().into_iter().flat_map(|own| own.places);
            if let Some(place) = places.find(is_text) {
                request.places.push((place.key(), value.trim().to_owned()));
                continue;
            }
            let value: f64 = value.trim().parse().map_err(|_| expected())?;
            if key == JOINT {
                let whole = value.fract() == 0.0 && (1.0..=64.0).contains(&value);
                if !whole || !request.is_of_joint() {
                    return Err(format!("`{pair}` says no joint of {name}"));
                }
                request.joint = Some(value as usize);
            } else {
                request.numbers.push((key.to_owned(), value));
            }
        }
        Ok(request)
    }

    fn is_of_joint(&self) -> bool {
        let of_arm = self.of_arm();
        let in_arm = of_arm.is_some_and(|effect| effect.places.contains(&Place::Joint));
        in_arm
            || every().any(|effect| {
                let (name, joint) = effect.vocabulary();
                name == self.name && joint.is_some()
            })
    }

    /// The effect of an arm file that it asks for; none of what a cell has by that name.
    #[must_use]
    pub fn of_arm(&self) -> Option<&'static ArmEffectName> {
        let of_cell = every().any(|effect| effect.vocabulary().0 == self.name);
        (!of_cell).then(|| arm_effect(&self.name)).flatten()
    }

    /// As [`Self::edits`], of an effect of an arm file that a scenario names.
    ///
    /// # Errors
    /// As of [`Self::edits`].
    pub fn arm_edits(
        &self,
        effect: &'static ArmEffectName,
        file: &ArmFile,
        most_observable_joint: usize,
    ) -> Result<Vec<KeyValue>, String> {
        let number = self.joint.unwrap_or(most_observable_joint);
        let joint = file.numbers.iter().position(|own| *own == number);
        let joint = joint.ok_or_else(|| self.no_joint(number))?;
        let given = |place: Place| {
            let given = self.places.iter().find(|(key, _)| *key == place.key());
            given.map(|(_, text)| text.clone())
        };
        let place_of = |place: &Place| match place {
            Place::Joint => Some(number.to_string()),
            Place::Link => given(*place).or_else(|| Some(file.links[joint].clone())),
            Place::Channel | Place::Source => given(*place).or_else(|| Some("force_z".to_owned())),
            Place::Target => given(*place).or_else(|| Some("force_x".to_owned())),
            Place::Recording => given(*place),
        };
        let link = given(Place::Link).and_then(|name| file.links.iter().position(|l| *l == name));
        let mut values = usual(effect, &file.nominal, link.unwrap_or(joint));
        let mut further: Vec<(&str, f64)> = Vec::new();
        for (key, value) in &self.numbers {
            let converted = |name: &&str| Unit::convert(key, *value, name);
            let mut own = effect.numbers.iter().enumerate();
            if let Some((place, value)) = own.find_map(|(i, name)| Some((i, converted(name)?))) {
                values[place] = value;
                continue;
            }
            let mut own = further_numbers(effect.name).iter();
            match own.find_map(|name| Some((*name, converted(name)?))) {
                Some(own) => further.push(own),
                None => return Err(self.no_number(key, effect.numbers)),
            }
        }
        let places = effect.places.iter().filter_map(|place| {
            let text = place_of(place)?;
            Some(format!(" {}={text}", place.key()))
        });
        let place: String = places.collect();
        let key = |name: &str| format!("arm.effect.\"{}{place}\".{name}", effect.name);
        let numbers = effect.numbers.iter().copied().zip(values);
        Ok(numbers
            .chain(further)
            .map(|(name, value)| KeyValue::number(key(name), value))
            .collect())
    }

    fn no_joint(&self, joint: usize) -> String {
        format!("there is no joint {joint} for {} to be of", self.name)
    }

    fn no_number(&self, key: &str, names: &[&str]) -> String {
        let all = names.join(", ");
        format!(
            "{} has no number `{key}`, expected some of {all}",
            self.name
        )
    }

    /// The scenario's keys, what is not given at its usual size beside the nominal values, of the most observable joint where it does not say which.
    ///
    /// # Errors
    /// A number or a joint that the effect does not have, for people.
    pub fn edits(
        &self,
        nominal: &PlantParameters,
        most_observable_joint: usize,
    ) -> Result<Vec<KeyValue>, String> {
        let wanted = self
            .is_of_joint()
            .then(|| self.joint.unwrap_or(most_observable_joint));
        let is_it = |effect: &&'static Effect| effect.vocabulary() == (&*self.name, wanted);
        let effect = every()
            .find(is_it)
            .ok_or_else(|| self.no_joint(wanted.unwrap_or_default()))?;
        let parameters = effect.parameters(nominal);
        let names: Vec<&str> = parameters.iter().map(|p| p.quantity.name).collect();
        let mut values = effect.usual(nominal);
        for (key, value) in &self.numbers {
            let converted = |name: &&str| Unit::convert(key, *value, name);
            if let Some((place, value)) = names
                .iter()
                .enumerate()
                .find_map(|(i, name)| Some((i, converted(name)?)))
            {
                values[place] = value;
                continue;
            }
            // A periodic effect's amplitude, all of it in its sine.
            let sine = names.iter().position(|name| *name == "sine_m");
            let amplitude = Unit::convert(key, *value, "amplitude_m");
            match (sine, amplitude) {
                (Some(sine), Some(amplitude)) => {
                    values[sine] = amplitude;
                    values[sine + 1] = 0.0;
                }
                _ => return Err(self.no_number(key, &names)),
            }
        }
        let pairs = names.iter().zip(values);
        let key = |name: &str| format!("effect.{}.{name}", effect.name);
        Ok(pairs
            .map(|(name, value)| KeyValue::number(key(name), value))
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edits(text: &str) -> Vec<(String, String)> {
        let request = EffectRequest::parse(text).unwrap();
        let edits = request.edits(&PlantParameters::default(), 2).unwrap();
        let shown = |edit: &KeyValue| (edit.key().to_owned(), edit.shown());
        edits.iter().map(shown).collect()
    }

    #[test]
    fn what_is_given_counts_in_any_unit_and_the_rest_is_usual() {
        let runout = edits("tool_runout:amplitude_mm=0.1,frequency_hz=120");
        let expected = [
            ("frequency_hz", "120"),
            ("sine_m", "0.0001"),
            ("cosine_m", "0"),
        ];
        let key = |name: &str| format!("effect.tool_runout.{name}");
        assert_eq!(runout, expected.map(|(n, v)| (key(n), v.to_owned())));
        assert_eq!(edits("joint_friction"), edits("joint_friction:joint=2"));
        let third = edits("joint_friction:joint=3,friction_n_m=7");
        assert_eq!(
            third,
            [(
                "effect.joint_friction_3.friction_n_m".to_owned(),
                "7".to_owned()
            )]
        );
        let friction = edits("coulomb_viscous_friction:presliding_displacement_um=40");
        assert_eq!(friction[0].1, "10");
        assert_eq!(friction[2].1, "0.00004");
    }

    #[test]
    fn what_an_effect_does_not_have_is_refused() {
        for (text, said) in [
            ("tool_runot", "did you mean `tool_runout`?"),
            ("tool_runout:joint=2", "says no joint"),
            ("tool_runout:frequency_hz", "is not KEY=VALUE"),
        ] {
            let error = EffectRequest::parse(text).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
        for (text, said) in [
            ("tool_runout:amplitude_ms=0.1", "no number `amplitude_ms`"),
            ("joint_friction:joint=9", "no joint 9"),
        ] {
            let request = EffectRequest::parse(text).unwrap();
            let error = request.edits(&PlantParameters::default(), 1).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn the_usual_size_of_every_effect_has_all_its_numbers_within_their_range() {
        let mut plant = PlantParameters::default();
        plant.cell.joint_stiffness = [1e6; crate::plant::MOST_JOINTS];
        plant.contact.law = crate::plant::ContactLaw::Linear { stiffness: 1.5e5 };
        for effect in every().chain(crate::effects::LINK_EFFECTS) {
            let parameters = effect.parameters(&plant);
            let usual = effect.usual(&plant);
            assert_eq!(parameters.len(), usual.len(), "{effect:?}");
            for (parameter, value) in parameters.iter().zip(usual) {
                let [low, high] = parameter.bounds;
                assert!((low..=high).contains(&value), "{effect:?}: {value}");
            }
        }
    }
}
