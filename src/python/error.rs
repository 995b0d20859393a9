//! Errors as Python's exceptions: `idc.Error`, with the facts that the program's own errors carry.

use pyo3::prelude::*;

use crate::app::{AppError, Facts};

/// The exception of an error.
pub(super) fn raised(error: &AppError) -> PyErr {
    let Facts {
        file,
        position,
        key,
    } = Facts::of(error);
    let (line, column) = position.unzip();
    refused(error.to_string(), (file, key, line, column))
}

/// Where a fault is: file, key, line and column.
pub(super) type Place = (Option<String>, Option<String>, Option<u32>, Option<u32>);

/// An exception with this message.
pub(super) fn refused(message: String, (file, key, line, column): Place) -> PyErr {
    Python::attach(|py| {
        let made = (py.import("idc._error"))
            .and_then(|module| module.getattr("Error"))
            .and_then(|class| class.call1((message, file, key, line, column)));
        match made {
            Ok(error) => PyErr::from_value(error),
            Err(error) => error,
        }
    })
}

/// One about nothing in a file.
pub(super) fn plain(message: impl Into<String>) -> PyErr {
    refused(message.into(), (None, None, None, None))
}
