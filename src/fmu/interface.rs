//! What both versions of the interface in C share: the component behind an importer's pointer, its arrays and texts, statuses, messages.
//!
//! An importer that keeps to the standard hands over pointers that are valid, or null where it has nothing; nothing here looks at a null one. A panic does not
//! get across: it becomes an error.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::error::FmuError;
use super::instance::{Instance, Snapshot};
use super::model::{Model, SCENARIO};

/// Status of a call, the same numbers in both versions.
pub(super) type Status = i32;
pub(super) const OK: Status = 0;
pub(super) const DISCARD: Status = 2;
pub(super) const ERROR: Status = 3;

/// An instance, and where its errors are reported.
pub(super) struct Component {
    pub instance: Instance,
    messages: Messages,
}

/// An importer's function for messages of version 2: environment, name of the instance, status, category, format and its arguments.
pub(super) type SecondLog =
    unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);
/// One of version 3: environment, status, category, message.
pub(super) type ThirdLog = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// The importer's function for messages.
#[derive(Clone, Copy)]
pub(super) enum Logger {
    /// None.
    Silent,
    /// Of version 2.
    Second(SecondLog),
    /// Of version 3.
    Third(ThirdLog),
}

/// Where messages go.
pub(super) struct Messages {
    logger: Logger,
    environment: *mut c_void,
    name: CString,
}

impl Messages {
    /// Of an instance's name, which may be null.
    pub(super) fn new(logger: Logger, environment: *mut c_void, name: *const c_char) -> Self {
        Self {
            logger,
            environment,
            name: CString::new(text(name).unwrap_or_default()).unwrap_or_default(),
        }
    }

    /// Reports an error.
    fn report(&self, status: Status, message: &str) {
        const CATEGORY: &CStr = c"error";
        let shown = match self.logger {
            // It is taken as a format.
            Logger::Second(_) => message.replace('%', "%%"),
            _ => message.to_owned(),
        };
        let Ok(shown) = CString::new(shown) else {
            return;
        };
        let (category, message) = (CATEGORY.as_ptr(), shown.as_ptr());
        match self.logger {
            Logger::Silent => (),
            // SAFETY: the importer gave the function for this, with its environment; the texts live until it returns, and the format asks for no arguments.
            Logger::Second(logger) => unsafe {
                logger(
                    self.environment,
                    self.name.as_ptr(),
                    status,
                    category,
                    message,
                );
            },
            // SAFETY: as above.
            Logger::Third(logger) => unsafe {
                logger(self.environment, status, category, message);
            },
        }
    }

    /// Does something that may be refused, and reports why it was.
    fn reported(&self, work: impl FnOnce() -> Result<(), FmuError>) -> Status {
        match catch_unwind(AssertUnwindSafe(work)) {
            Ok(Ok(())) => OK,
            Ok(Err(error)) => {
                let status = if error.is_discarded() { DISCARD } else { ERROR };
                self.report(status, &error.to_string());
                status
            }
            Err(_) => {
                self.report(ERROR, "a fault of the unit; please report it");
                ERROR
            }
        }
    }
}

/// Makes a component; null if that is refused.
pub(super) fn instantiate(
    messages: Messages,
    token: *const c_char,
    resources: Result<PathBuf, FmuError>,
) -> *mut c_void {
    let mut made = None;
    messages.reported(|| {
        let model = Model::load(&resources?.join(SCENARIO))?;
        model.check_token(&text(token).unwrap_or_default())?;
        made = Some(Instance::new(Arc::new(model)));
        Ok(())
    });
    let component = made.map(|instance| Component { instance, messages });
    component.map_or(std::ptr::null_mut(), |component| {
        Box::into_raw(Box::new(component)).cast()
    })
}

/// Frees a component.
pub(super) fn free(component: *mut c_void) {
    if !component.is_null() {
        // SAFETY: it was made by `instantiate`, and the importer does not use it again.
        drop(unsafe { Box::from_raw(component.cast::<Component>()) });
    }
}

/// Does something with a component.
pub(super) fn with(
    component: *mut c_void,
    work: impl FnOnce(&mut Instance) -> Result<(), FmuError>,
) -> Status {
    // SAFETY: it was made by `instantiate` and is not freed; the standard forbids calls of one instance side by side.
    let Some(component) = (unsafe { component.cast::<Component>().as_mut() }) else {
        return ERROR;
    };
    let Component { instance, messages } = component;
    messages.reported(|| work(instance))
}

/// A function that a unit does not have.
pub(super) fn without(component: *mut c_void, function: &'static str) -> Status {
    with(component, |_| Err(FmuError::NoFunction { function }))
}

/// An array of an importer.
fn given<'a, T>(values: *const T, count: usize) -> &'a [T] {
    if values.is_null() || count == 0 {
        return &[];
    }
    // SAFETY: the importer hands over as many values, which live until the call returns.
    unsafe { std::slice::from_raw_parts(values, count) }
}

/// An array of an importer that is filled.
fn filled<'a, T>(values: *mut T, count: usize) -> &'a mut [T] {
    if values.is_null() || count == 0 {
        return &mut [];
    }
    // SAFETY: as of `given`, and nobody else uses it meanwhile.
    unsafe { std::slice::from_raw_parts_mut(values, count) }
}

/// Writes a value where an importer wants one; it may want none.
pub(super) fn put<T>(place: *mut T, value: T) {
    if !place.is_null() {
        // SAFETY: a place that is not null is one for such a value.
        unsafe { place.write(value) };
    }
}

/// A text of an importer; none for a null one.
pub(super) fn text(text: *const c_char) -> Option<String> {
    if text.is_null() {
        return None;
    }
    // SAFETY: texts of the interface end with a zero.
    let text = unsafe { CStr::from_ptr(text) };
    Some(text.to_string_lossy().into_owned())
}

/// Reads variables: references and values, each with its number.
pub(super) fn get<T>(
    component: *mut c_void,
    (references, count): (*const u32, usize),
    (values, value_count): (*mut T, usize),
    read: impl Fn(&mut Instance, u32) -> Result<T, FmuError>,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let references = given(references, count);
        for (value, reference) in filled(values, count).iter_mut().zip(references) {
            *value = read(instance, *reference)?;
        }
        Ok(())
    })
}

/// Sets variables: references and values, each with its number.
pub(super) fn set<T: Copy>(
    component: *mut c_void,
    (references, count): (*const u32, usize),
    (values, value_count): (*const T, usize),
    write: impl Fn(&mut Instance, u32, T) -> Result<(), FmuError>,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let values = given(values, count);
        for (reference, value) in given(references, count).iter().zip(values) {
            write(instance, *reference, *value)?;
        }
        Ok(())
    })
}

/// Saves the state of an instance where the importer wants it, in place of one that is there.
pub(super) fn save(component: *mut c_void, place: *mut *mut c_void) -> Status {
    with(component, |instance| {
        // SAFETY: a place that is not null holds null or a state that was saved.
        let Some(place) = (unsafe { place.as_mut() }) else {
            return Err(no_place());
        };
        // SAFETY: as above.
        match unsafe { place.cast::<Snapshot>().as_mut() } {
            Some(old) => *old = instance.save(),
            None => *place = Box::into_raw(Box::new(instance.save())).cast(),
        }
        Ok(())
    })
}

/// Goes back to a state.
pub(super) fn restore(component: *mut c_void, state: *mut c_void) -> Status {
    with(component, |instance| {
        // SAFETY: a state that is not null was saved and is not freed.
        let state = unsafe { state.cast::<Snapshot>().as_ref() };
        instance.restore(state.ok_or_else(no_place)?);
        Ok(())
    })
}

/// Frees a state.
pub(super) fn free_state(component: *mut c_void, place: *mut *mut c_void) -> Status {
    with(component, |_| {
        // SAFETY: a place that is not null holds null or a state that was saved.
        let Some(place) = (unsafe { place.as_mut() }) else {
            return Ok(());
        };
        if !place.is_null() {
            // SAFETY: it was made by `save`, and is forgotten here.
            drop(unsafe { Box::from_raw(place.cast::<Snapshot>()) });
            *place = std::ptr::null_mut();
        }
        Ok(())
    })
}

fn no_place() -> FmuError {
    FmuError::Argument {
        what: "the pointer to a saved state is null, expected one".to_owned(),
    }
}

/// Values in as great a number as their references.
fn as_many(references: usize, values: usize) -> Result<(), FmuError> {
    match references == values {
        true => Ok(()),
        false => Err(FmuError::Argument {
            what: format!("{references} value references and {values} values, expected as many"),
        }),
    }
}

/// Resources by their path.
pub(super) fn resources_at(path: *const c_char) -> Result<PathBuf, FmuError> {
    match text(path) {
        Some(path) if !path.is_empty() => Ok(PathBuf::from(path)),
        other => Err(FmuError::Resources {
            given: other.unwrap_or_else(|| "nowhere".to_owned()),
            expected: "the path of the unit's folder resources",
        }),
    }
}

/// Resources by their URI, as version 2 has them.
pub(super) fn resources_of_uri(uri: *const c_char) -> Result<PathBuf, FmuError> {
    let uri = text(uri).unwrap_or_default();
    let path = uri.strip_prefix("file:").map(|rest| {
        let local = rest.strip_prefix("//localhost").or(rest.strip_prefix("//"));
        percent_encoding::percent_decode_str(local.unwrap_or(rest)).decode_utf8_lossy()
    });
    match path {
        Some(path) if Path::new(path.as_ref()).is_absolute() => Ok(PathBuf::from(path.as_ref())),
        _ => Err(FmuError::Resources {
            given: uri,
            expected: "a URI of scheme file, file:///path/to/resources",
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uri_of_a_file_is_its_path() {
        let path = |uri: &CStr| resources_of_uri(uri.as_ptr());
        for (uri, expected) in [
            (c"file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            (c"file:/tmp/resources", "/tmp/resources"),
            (c"file://localhost/tmp/resources/", "/tmp/resources/"),
        ] {
            assert_eq!(path(uri).unwrap(), PathBuf::from(expected));
        }
        for uri in [
            c"https://example.org/resources",
            c"/tmp/resources",
            c"file:resources",
        ] {
            assert!(path(uri).unwrap_err().to_string().contains("file:///"));
        }
        assert!(resources_of_uri(std::ptr::null()).is_err());
        assert!(resources_at(std::ptr::null()).is_err());
    }
}
