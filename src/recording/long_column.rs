//! A column of a long table.

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub enum LongColumn {
    /// Names.
    Names(Vec<String>),
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
}
