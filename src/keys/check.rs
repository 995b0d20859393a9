//! Checks of single values: a number in its range and unit, a list of the right length, a path that exists.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::declaration::{Key, Table};
use super::document::Document;
use super::error::ScenarioError;
use super::suggestion::join;
use crate::plant::Number;
use crate::unit::{Unit, look_alike};

/// A table of a file, whose values are checked key by key.
#[derive(Debug, Clone)]
pub(crate) struct Section<'a> {
    document: &'a Document<'a>,
    table: String,
}

impl<'a> Section<'a> {
    /// The table of this dotted name; empty for the top of the file.
    pub fn new(document: &'a Document<'a>, table: impl Into<String>) -> Self {
        Self {
            document,
            table: table.into(),
        }
    }

    /// Its file.
    pub fn document(&self) -> &'a Document<'a> {
        self.document
    }

    /// Dotted name of one of its keys.
    pub fn dotted(&self, key: &str) -> String {
        join(&self.table, key)
    }

    /// Keys that the file gives in it.
    pub fn given(&self) -> impl Iterator<Item = &str> {
        self.document.keys_in(&self.table)
    }

    /// A number within a range, both in the key's unit; returns it in SI.
    pub fn number(
        &self,
        key: &str,
        value: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, ScenarioError> {
        let unit = Unit::of_key(key);
        match range.contains(&value) {
            true => Ok(unit.to_si(value)),
            false => Err(self.refuse(key, unit.show(value), unit.show_range(range))),
        }
    }

    /// A number of the description within its range, in SI.
    pub fn known(&self, number: &Number, key: &str, value: f64) -> Result<f64, ScenarioError> {
        self.number(key, value, Unit::of_key(key).range(number.range))
    }

    /// A whole number within a range.
    #[cfg(feature = "import")]
    pub fn count<T: PartialOrd + Copy + std::fmt::Display>(
        &self,
        key: &str,
        value: T,
        range: RangeInclusive<T>,
    ) -> Result<T, ScenarioError> {
        if range.contains(&value) {
            return Ok(value);
        }
        let expected = format!("{} to {}", range.start(), range.end());
        Err(self.refuse(key, value.to_string(), expected))
    }

    /// A text that is not empty.
    pub fn text(&self, key: &str, value: &str) -> Result<String, ScenarioError> {
        if value.trim().is_empty() {
            return Err(self.refuse(key, format!("{value:?}"), "a text".to_owned()));
        }
        Ok(value.to_owned())
    }

    /// An existing file, from the folder of the file that names it.
    pub fn file(&self, key: &str, path: &Path) -> Result<PathBuf, ScenarioError> {
        let full = self.document.folder().join(path);
        if full.is_file() {
            return Ok(full);
        }
        Err(self.no_such(key, path, "an existing file", &full))
    }

    /// An existing folder, from the folder of the file that names it.
    pub fn directory(&self, key: &str, path: &Path) -> Result<PathBuf, ScenarioError> {
        let full = self.document.folder().join(path);
        if full.is_dir() {
            return Ok(full);
        }
        Err(self.no_such(key, path, "an existing folder", &full))
    }

    fn no_such(&self, key: &str, path: &Path, expected: &str, full: &Path) -> ScenarioError {
        let expected = format!("{expected} (there is no {})", full.display());
        self.refuse(key, format!("\"{}\"", path.display()), expected)
    }

    /// Refuses a value.
    pub fn refuse(&self, key: &str, found: String, expected: String) -> ScenarioError {
        let key = join(&self.table, key);
        ScenarioError::Value {
            location: self.document.location(&key),
            key,
            found,
            expected,
        }
    }

    /// Refuses a number as the file gives it, in its key's unit.
    pub fn refuse_number(&self, key: &str, value: f64, expected: String) -> ScenarioError {
        self.refuse(key, Unit::of_key(key).show(value), expected)
    }

    /// Refuses a number [SI], in its key's unit.
    pub fn refuse_si(&self, key: &str, value: f64, expected: String) -> ScenarioError {
        self.refuse_number(key, Unit::of_key(key).of_si(value), expected)
    }

    /// Refuses keys that the table's kind does not have, and asks for those that it needs. The kind is what its first key says, or else what `other` says it is.
    pub fn of_kind<T: Table>(&self, other: Option<&str>) -> Result<(), ScenarioError> {
        let keys = T::keys();
        let selector = &keys[0];
        let written = self.document.text_at(&self.dotted(selector.name));
        let origin = match (written, other) {
            (None, Some(_)) => ", the preset's,",
            _ => "",
        };
        let kind = written.or(other).or(selector.default_text());
        let kind = kind.unwrap_or_default();
        let named = format!("{} = \"{kind}\"", selector.name);
        let own = || keys[1..].iter().filter(|key| key.is_of(kind));
        let is_other = |given: &&str| {
            let mut others = keys.iter().filter(|key| !key.is_of(kind));
            others.any(|key| key.name == *given)
        };
        if let Some(given) = self.given().find(is_other) {
            let names: Vec<&str> = own().map(|key| key.name).collect();
            let others = match names.is_empty() {
                true => "no other key".to_owned(),
                false => names.join(", "),
            };
            return Err(self.misplaced(given, format!("{named}{origin} has {others}")));
        }
        let is_given = |key: &Key| self.given().any(|given| given == key.name);
        match own().find(|key| key.is_required() && !is_given(key)) {
            Some(key) => Err(self.missing(key.name, &format!("it to be given with {named}"))),
            None => Ok(()),
        }
    }

    /// Refuses that a key is absent.
    pub fn missing(&self, key: &str, expected: &str) -> ScenarioError {
        let location = self.document.location(&self.table);
        let (above, _) = self.table.rsplit_once('.').unwrap_or_default();
        ScenarioError::MissingKey {
            location: match location.position {
                Some(_) => location,
                None => self.document.location(above),
            },
            key: join(&self.table, key),
            expected: expected.to_owned(),
        }
    }

    /// Refuses that the table itself, or the key it stands for, is present.
    pub fn misplaced_itself(&self, reason: String) -> ScenarioError {
        ScenarioError::Misplaced {
            location: self.document.location(&self.table),
            key: self.table.clone(),
            reason,
        }
    }

    /// Refuses that a key is present.
    pub fn misplaced(&self, key: &str, reason: String) -> ScenarioError {
        let key = join(&self.table, key);
        ScenarioError::Misplaced {
            location: self.document.location(&key),
            key,
            reason,
        }
    }
}

/// A pose from its position and its rotation: roll, pitch, yaw about fixed axes x, y, z, as in URDF.
pub(crate) fn pose(position: DVec3, rotation: DVec3) -> DPose3 {
    DPose3 {
        rotation: DQuat::from_rotation_z(rotation.z)
            * DQuat::from_rotation_y(rotation.y)
            * DQuat::from_rotation_x(rotation.x),
        translation: position,
    }
}

/// A value that is plausible in the unit of its key.
pub(crate) fn checked(
    section: &Section<'_>,
    key: &str,
    value: f64,
    range: [f64; 2],
) -> Result<f64, ScenarioError> {
    if range[0] <= value && value <= range[1] {
        return Ok(value);
    }
    let unit = Unit::of_key(key);
    let with_unit = |value: f64| {
        format!("{} {}", plain(value), unit.symbol)
            .trim_end()
            .to_owned()
    };
    let mut expected = format!("{} to {}", plain(range[0]), with_unit(range[1]));
    if let Some(other) = look_alike(unit.symbol, value, range) {
        expected += &format!(" (it looks like {other}; a rig file is in SI)");
    }
    Err(section.refuse(key, with_unit(value), expected))
}

/// A number in the shorter of its usual forms.
pub(crate) fn plain(value: f64) -> String {
    let usual = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if usual || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
