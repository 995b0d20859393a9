//! Every number of a rig's or a cell's description, once: what it is, the range in which it is plausible, where it stands. Files, effects and diagnoses refer
//! to these. What a fit may say of a number that no file gives stands at its effect.

use super::quantity::Number;

mod air;
mod cell;
mod contact;
mod cylinder;
mod latent;
mod links;
mod parts;
mod regulator;
mod sensors;

pub use air::*;
pub use cell::*;
pub use contact::*;
pub use cylinder::*;
pub use latent::*;
pub use links::*;
pub use parts::*;
pub use regulator::*;
pub use sensors::*;

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
                default: [$(Some($default),)? None][0],
                get: numbers!(@get $access),
                set: numbers!(@set $access),
            };
        )+
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
        CYLINDER, AIR, REGULATOR, PARTS, CONTACT, CELL, SENSORS, LINKS, LATENT,
    ];
    parts.into_iter().flatten().copied()
}

/// The one of the device model file with this key.
pub fn of_device_key(key: &str) -> Option<&'static Number> {
    all().find(|number| number.device_key == Some(key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_and_keys_are_told_apart_and_ranges_are_some() {
        let mut names = BTreeSet::new();
        for number in all() {
            let [low, high] = number.range;
            assert!(low < high && !number.meaning.is_empty(), "{number:?}");
            assert!(names.insert(number.name), "{number:?}");
            assert!(
                number.device_key.is_none_or(|key| names.insert(key)),
                "{number:?}"
            );
            assert!(
                number
                    .default
                    .is_none_or(|value| low <= value && value <= high)
            );
        }
    }
}
