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
    refused(by_argument(&error.to_string()), (file, key, line, column))
}

/// A message that names the program's options, with Python's arguments in their place.
fn by_argument(message: &str) -> String {
    const NAMES: [(&str, &str); 6] = [
        ("--set ", "set "),
        ("--with:", "effects:"),
        ("--force", "force=True"),
        ("(--out)", "(out=..)"),
        ("--out is", "out is"),
        ("--try:", "tried:"),
    ];
    let named = |text: String, (option, argument): (&str, &str)| text.replace(option, argument);
    NAMES.into_iter().fold(message.to_owned(), named)
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
