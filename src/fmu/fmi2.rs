//! FMI 2.0, co-simulation: its functions in C (<https://fmi-standard.org>, FMI 2.0.5, chapters 2 and 4).
//!
//! Those that a unit does not have declare their first argument alone: on x86-64 Linux the caller passes and removes the others.
#![allow(unsafe_code)]
// The standard's arguments and fields.
#![allow(clippy::too_many_arguments, dead_code)]

use std::ffi::{c_char, c_void};

use super::instance::Instance;
use super::interface::{
    ERROR, Logger, Messages, SecondLog, Status, free, free_state, get, instantiate, put,
    resources_of_uri, restore, save, set, with, without,
};

/// Functions of an importer. What is behind the logger is not called: memory is this library's own, and a step ends before it returns.
#[repr(C)]
struct Callbacks {
    logger: Option<SecondLog>,
    allocate: *const c_void,
    free: *const c_void,
    finished: *const c_void,
    environment: *mut c_void,
}

/// Co-simulation, of the kinds of a unit.
const CO_SIMULATION: i32 = 1;

// SAFETY, of each `no_mangle` below: the name is the standard's, and no other function of the program has it.

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetDebugLogging(component: *mut c_void) -> Status {
    // Errors are reported anyway, and there is nothing else to report.
    with(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: i32,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: i32,
    _logging: i32,
) -> *mut c_void {
    // SAFETY: callbacks that are not null live as long as the instance.
    let callbacks = unsafe { callbacks.as_ref() };
    let logger = callbacks.and_then(|callbacks| callbacks.logger);
    let environment = callbacks.map_or(std::ptr::null_mut(), |c| c.environment);
    let logger = logger.map_or(Logger::Silent, Logger::Second);
    let messages = Messages::new(logger, environment, name);
    match kind {
        CO_SIMULATION => instantiate(messages, guid, resources_of_uri(resources)),
        _ => std::ptr::null_mut(),
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    free(component);
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    component: *mut c_void,
    _tolerance_defined: i32,
    _tolerance: f64,
    start: f64,
    _stop_defined: i32,
    _stop: f64,
) -> Status {
    with(component, |instance| instance.start_at(start))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> Status {
    with(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2ExitInitializationMode(component: *mut c_void) -> Status {
    with(component, |instance| {
        instance.initialize();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Terminate(component: *mut c_void) -> Status {
    with(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Reset(component: *mut c_void) -> Status {
    with(component, |instance| {
        instance.reset();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetReal(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> Status {
    get(
        component,
        (references, count),
        (values, count),
        Instance::real,
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetReal(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> Status {
    set(
        component,
        (references, count),
        (values, count),
        Instance::set_real,
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut i32,
) -> Status {
    get(
        component,
        (references, count),
        (values, count),
        |instance, reference| Ok(i32::from(instance.boolean(reference)?)),
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const i32,
) -> Status {
    set(
        component,
        (references, count),
        (values, count),
        |instance, reference, value| instance.set_boolean(reference, value != 0),
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetFMUstate(component: *mut c_void, state: *mut *mut c_void) -> Status {
    save(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetFMUstate(component: *mut c_void, state: *mut c_void) -> Status {
    restore(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeFMUstate(component: *mut c_void, state: *mut *mut c_void) -> Status {
    free_state(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(
    component: *mut c_void,
    point: f64,
    length: f64,
    _never_back: i32,
) -> Status {
    with(component, |instance| instance.step(point, length))
}

/// `fmi2GetRealStatus`: the time that the last step came to, of the kinds of status.
const LAST_SUCCESSFUL_TIME: i32 = 2;

#[unsafe(no_mangle)]
extern "C" fn fmi2GetRealStatus(component: *mut c_void, kind: i32, value: *mut f64) -> Status {
    match kind {
        LAST_SUCCESSFUL_TIME => with(component, |instance| {
            put(value, instance.time());
            Ok(())
        }),
        _ => ERROR,
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetBooleanStatus(component: *mut c_void, _kind: i32, value: *mut i32) -> Status {
    // Whether it wants to end: never.
    with(component, |_| {
        put(value, 0);
        Ok(())
    })
}

/// Functions that a unit does not have.
macro_rules! without {
    ($($name:ident)+) => { $(
        #[unsafe(no_mangle)]
        extern "C" fn $name(component: *mut c_void) -> Status {
            without(component, stringify!($name))
        }
    )+ };
}
without! {
    fmi2GetInteger fmi2SetInteger fmi2GetString fmi2SetString
    fmi2SerializedFMUstateSize fmi2SerializeFMUstate fmi2DeSerializeFMUstate
    fmi2GetDirectionalDerivative fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives
    fmi2CancelStep fmi2GetStatus fmi2GetIntegerStatus fmi2GetStringStatus
}
