//! Checks of single values: a number in its range and unit, a list of the right length, a path that exists.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::document::Document;
use super::error::ScenarioError;
use super::suggestion::join;
use super::units::{Unit, look_alike};
use crate::plant::Number;

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
        self.number_of(Unit::of_key(key), key, value, range)
    }

    fn number_of(
        &self,
        unit: Unit,
        key: &str,
        value: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, ScenarioError> {
        if range.contains(&value) {
            return Ok(unit.to_si(value));
        }
        let expected = if range.end().is_finite() {
            format!("{} to {}", range.start(), unit.show(*range.end()))
        } else {
            format!("at least {}", unit.show(*range.start()))
        };
        Err(self.refuse(key, unit.show(value), expected))
    }

    /// A number of the description within its range, in SI.
    pub fn known(&self, number: &Number, key: &str, value: f64) -> Result<f64, ScenarioError> {
        self.number(key, value, Unit::of_key(key).range(number.range))
    }

    /// As `known`, or another value [SI] if the file gives none.
    pub fn known_or(
        &self,
        number: &Number,
        key: &str,
        given: Option<f64>,
        default: f64,
    ) -> Result<f64, ScenarioError> {
        given.map_or(Ok(default), |value| self.known(number, key, value))
    }

    /// As `known`, or its default if the file gives none.
    pub fn known_or_default(
        &self,
        number: &Number,
        key: &str,
        given: Option<f64>,
    ) -> Result<f64, ScenarioError> {
        self.known_or(number, key, given, number.default)
    }

    /// As `number`, or the default [SI] if the file gives none.
    pub fn number_or(
        &self,
        key: &str,
        given: Option<f64>,
        default: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, ScenarioError> {
        given.map_or(Ok(default), |value| self.number(key, value, range))
    }

    /// A whole number within a range.
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

    /// Numbers that each lie within a range, in SI.
    pub fn numbers(
        &self,
        key: &str,
        values: &[f64],
        range: RangeInclusive<f64>,
    ) -> Result<Vec<f64>, ScenarioError> {
        let unit = Unit::of_key(key);
        let element = |(index, value): (usize, &f64)| {
            self.number_of(unit, &format!("{key}[{index}]"), *value, range.clone())
        };
        values.iter().enumerate().map(element).collect()
    }

    /// Several of a number of the description, each within its range, in SI.
    pub fn known_numbers(
        &self,
        number: &Number,
        key: &str,
        values: &[f64],
    ) -> Result<Vec<f64>, ScenarioError> {
        self.numbers(key, values, Unit::of_key(key).range(number.range))
    }

    /// Three numbers, x, y and z, or the default if there are none.
    pub fn vector(
        &self,
        key: &str,
        values: Option<&[f64]>,
        default: DVec3,
        range: RangeInclusive<f64>,
    ) -> Result<DVec3, ScenarioError> {
        let Some(values) = values else {
            return Ok(default);
        };
        match self.numbers(key, values, range)?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => {
                let found = format!("a list of {}", values.len());
                Err(self.refuse(key, found, "a list of 3".to_owned()))
            }
        }
    }

    /// A pose from its position and its rotation: roll, pitch, yaw about fixed axes x, y, z, as in URDF.
    pub fn pose(
        &self,
        (position_key, position): (&str, Option<&[f64]>),
        (rotation_key, rotation): (&str, Option<&[f64]>),
    ) -> Result<DPose3, ScenarioError> {
        let translation = self.vector(position_key, position, DVec3::ZERO, -1e4..=1e4)?;
        let angles = self.vector(rotation_key, rotation, DVec3::ZERO, -360.0..=360.0)?;
        Ok(DPose3 {
            rotation: DQuat::from_rotation_z(angles.z)
                * DQuat::from_rotation_y(angles.y)
                * DQuat::from_rotation_x(angles.x),
            translation,
        })
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
            place: self.document.place(&key),
            key,
            found,
            expected,
        }
    }

    /// Refuses a number as the file gives it, in its key's unit.
    pub fn refuse_number(&self, key: &str, value: f64, expected: String) -> ScenarioError {
        self.refuse(key, Unit::of_key(key).show(value), expected)
    }

    /// Refuses that a key is absent.
    pub fn missing(&self, key: &str, expected: &str) -> ScenarioError {
        ScenarioError::MissingKey {
            place: self.document.place(&self.table),
            key: join(&self.table, key),
            expected: expected.to_owned(),
        }
    }

    /// Refuses that the table itself, or the key it stands for, is present.
    pub fn misplaced_itself(&self, reason: String) -> ScenarioError {
        ScenarioError::Misplaced {
            place: self.document.place(&self.table),
            key: self.table.clone(),
            reason,
        }
    }

    /// Refuses that a key is present.
    pub fn misplaced(&self, key: &str, reason: String) -> ScenarioError {
        let key = join(&self.table, key);
        ScenarioError::Misplaced {
            place: self.document.place(&key),
            key,
            reason,
        }
    }
}

/// A value that is plausible in the unit of its key.
pub(super) fn checked(
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
pub(super) fn plain(value: f64) -> String {
    let usual = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if usual || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
