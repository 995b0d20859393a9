//! Every number of a rig's or a cell's description, once: what it is, the range in which it is plausible, where it stands. Files, effects and diagnoses refer
//! to these. What a fit may say of a number that no file gives stands at its effect.

use super::PlantParameters;

mod air;
mod cell;
mod contact;
mod cylinder;
mod ideal;
mod latent;
mod links;
mod mounting;
mod own;
mod parts;
mod regulator;
mod sensors;

pub use air::*;
pub use cell::*;
pub use contact::*;
pub use cylinder::*;
pub use latent::*;
pub use links::*;
pub use mounting::*;
pub use own::*;
pub use parts::*;
pub use regulator::*;
pub use sensors::*;

/// A number of the description. Only this module makes one.
#[derive(Debug)]
pub struct Number {
    /// Name with its SI unit; of a number of the rig file its dotted key there.
    pub name: &'static str,
    /// Its meaning, in a few words.
    pub meaning: &'static str,
    /// Key of the device model file, which ends with the unit there.
    pub device_key: Option<&'static str>,
    /// Least and largest plausible value; infinite where none is known.
    pub range: [f64; 2],
    /// Value where a file gives none; not a number where it must.
    pub default: f64,
    get: fn(&PlantParameters, usize) -> f64,
    set: fn(&mut PlantParameters, usize, f64),
}

impl Number {
    /// By a name of its own, as an answer has it.
    pub const fn named(&'static self, name: &'static str) -> Quantity {
        Quantity {
            name,
            index: 0,
            number: self,
        }
    }

    /// By its own name.
    pub const fn quantity(&'static self) -> Quantity {
        self.named(self.name)
    }
}

/// A number of the description under a name: how to read it, how to change it.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Name with its unit, as in an answer: `coulomb_force_n`.
    pub name: &'static str,
    /// Which of several alike: joint, coefficient; from 0.
    pub index: usize,
    /// Which.
    pub number: &'static Number,
}

impl std::fmt::Debug for Quantity {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Quantity {
    /// The one of several alike.
    #[must_use]
    pub const fn of(self, index: usize) -> Self {
        Self { index, ..self }
    }

    /// Whether it is the same number of a description, by whatever name.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        std::ptr::eq(self.number, other.number) && self.index == other.index
    }

    /// Its value.
    pub fn get(&self, plant: &PlantParameters) -> f64 {
        (self.number.get)(plant, self.index)
    }

    /// Changes it.
    pub fn set(&self, plant: &mut PlantParameters, value: f64) {
        (self.number.set)(plant, self.index, value);
    }
}

/// The range of what may be anything.
const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Numbers of a part, one each: what it is; its name here and in SI, in the device model file; its range; its place (of one of several alike by its index)
/// or how to read and change it; its default.
macro_rules! numbers {
    ($list:ident: $(
        #[doc = $meaning:literal]
        $id:ident = $name:literal $(as $device_key:literal)?, $range:expr, $access:tt $(, $default:expr)?;
    )+) => {
        $(
            #[doc = $meaning]
            pub static $id: Number = Number {
                name: $name,
                meaning: $meaning.trim_ascii(),
                device_key: [$(Some($device_key),)? None][0],
                range: $range,
                default: [$($default,)? f64::NAN][0],
                get: numbers!(@get $access),
                set: numbers!(@set $access),
            };
        )+
        /// All of them, in this order.
        pub static $list: &[&Number] = &[$(&$id),+];
    };
    (@get ($p:ident => $($place:tt)+)) => { |$p, _| $($place)+ };
    (@set ($p:ident => $($place:tt)+)) => { |$p, _, value| $($place)+ = value };
    (@get ($p:ident, $i:ident => $($place:tt)+)) => { |$p, $i| $($place)+ };
    (@set ($p:ident, $i:ident => $($place:tt)+)) => { |$p, $i, value| $($place)+ = value };
    (@get ($get:expr, $set:expr)) => { $get };
    (@set ($get:expr, $set:expr)) => { $set };
}
use numbers;

/// All of them.
pub fn all() -> impl Iterator<Item = &'static Number> {
    let parts = [
        CYLINDER, AIR, REGULATOR, PARTS, MOUNTING, CONTACT, CELL, SENSORS, LINKS, LATENT, OWN,
    ];
    parts.into_iter().flatten().copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_and_keys_are_unique_and_ranges_are_some() {
        let mut names = BTreeSet::new();
        for number in all() {
            let [low, high] = number.range;
            assert!(low < high && !number.meaning.is_empty(), "{number:?}");
            assert!(names.insert(number.name), "{number:?}");
            assert!(
                number.device_key.is_none_or(|key| names.insert(key)),
                "{number:?}"
            );
            let default = number.default;
            assert!(default.is_nan() || (low <= default && default <= high));
        }
    }
}
