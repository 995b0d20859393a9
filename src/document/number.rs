//! A number as a reader sees it.

use crate::quantity;

/// A number with its key, unit and the digits that it deserves.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Number {
    /// Key of the file that holds every digit of it; may be empty.
    pub key: String,
    /// The number, without its unit.
    pub text: String,
    /// Unit as it is printed; empty for a pure number.
    pub unit: String,
    /// Whether the unit stands beside it, or once for all in a heading.
    pub is_labelled: bool,
}

impl Number {
    /// By the one rule of [`crate::quantity`], with its unit.
    #[must_use]
    pub fn new(key: &str, value: Option<f64>, unit: &str) -> Self {
        Self {
            key: key.to_owned(),
            text: quantity::metric(value, unit),
            unit: unit.to_owned(),
            is_labelled: true,
        }
    }

    /// The same below a heading, or beside a cell, that has the unit.
    #[must_use]
    pub fn bare(key: &str, value: Option<f64>, unit: &str) -> Self {
        Self {
            is_labelled: false,
            ..Self::new(key, value, unit)
        }
    }

    /// Another text for the same number.
    #[must_use]
    pub fn written(mut self, text: impl Into<String>) -> Self {
        self.text = text.into();
        self
    }

    /// Number and unit.
    #[must_use]
    pub fn with_unit(&self) -> String {
        match self.is_labelled && !self.unit.is_empty() {
            true => format!("{} {}", self.text, self.unit),
            false => self.text.clone(),
        }
    }
}
