//! FMI 3.0, co-simulation: its functions in C (<https://fmi-standard.org>, FMI 3.0.2, chapters 2 and 4).
//!
//! Those that a unit does not have declare their first argument alone: on x86-64 Linux the caller passes and removes the others.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_void};

use super::interface::{
    Logger, Messages, Status, as_many, filled, free, free_state, given, instantiate, put,
    resources_at, restore, save, with, without,
};

/// An importer's function for messages.
type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

// SAFETY, of each `no_mangle` below: the name is the standard's, and no other function of the program has it.

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(component: *mut c_void) -> Status {
    // Errors are told anyway, and there is nothing else to tell.
    with(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _event_mode: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _update: *const c_void,
) -> *mut c_void {
    let logger = log.map_or(Logger::Silent, Logger::Third);
    let messages = Messages::new(logger, environment, name);
    instantiate(messages, token, resources_at(resources))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange() -> *mut c_void {
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution() -> *mut c_void {
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeInstance(component: *mut c_void) {
    free(component);
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    component: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> Status {
    with(component, |instance| instance.start_at(start))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3ExitInitializationMode(component: *mut c_void) -> Status {
    with(component, |instance| {
        instance.initialize();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Terminate(component: *mut c_void) -> Status {
    with(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Reset(component: *mut c_void) -> Status {
    with(component, |instance| {
        instance.reset();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetFloat64(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let references = given(references, count);
        for (value, reference) in filled(values, count).iter_mut().zip(references) {
            *value = instance.real(*reference)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetFloat64(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let values = given(values, count);
        for (reference, value) in given(references, count).iter().zip(values) {
            instance.set_real(*reference, *value)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut bool,
    value_count: usize,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let references = given(references, count);
        for (value, reference) in filled(values, count).iter_mut().zip(references) {
            *value = instance.boolean(*reference)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const u8,
    value_count: usize,
) -> Status {
    with(component, |instance| {
        as_many(count, value_count)?;
        let values = given(values, count);
        for (reference, value) in given(references, count).iter().zip(values) {
            instance.set_boolean(*reference, *value != 0)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetFMUState(component: *mut c_void, state: *mut *mut c_void) -> Status {
    save(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetFMUState(component: *mut c_void, state: *mut c_void) -> Status {
    restore(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeFMUState(component: *mut c_void, state: *mut *mut c_void) -> Status {
    free_state(component, state)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3DoStep(
    component: *mut c_void,
    point: f64,
    length: f64,
    _never_back: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last_time: *mut f64,
) -> Status {
    with(component, |instance| {
        for flag in [event, terminate, early] {
            put(flag, false);
        }
        let done = instance.step(point, length);
        put(last_time, instance.time());
        done
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
    fmi3EnterEventMode fmi3EnterStepMode fmi3UpdateDiscreteStates fmi3EvaluateDiscreteStates
    fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3ActivateModelPartition
    fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32
    fmi3GetInt64 fmi3GetUInt64 fmi3GetString fmi3GetBinary fmi3GetClock
    fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetInt32 fmi3SetUInt32
    fmi3SetInt64 fmi3SetUInt64 fmi3SetString fmi3SetBinary fmi3SetClock
    fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies
    fmi3SerializedFMUStateSize fmi3SerializeFMUState fmi3DeserializeFMUState
    fmi3GetDirectionalDerivative fmi3GetAdjointDerivative fmi3GetOutputDerivatives
    fmi3GetIntervalDecimal fmi3GetIntervalFraction fmi3GetShiftDecimal fmi3GetShiftFraction
    fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal fmi3SetShiftFraction
    fmi3EnterContinuousTimeMode fmi3CompletedIntegratorStep fmi3SetTime fmi3SetContinuousStates
    fmi3GetContinuousStateDerivatives fmi3GetEventIndicators fmi3GetContinuousStates
    fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates
}
