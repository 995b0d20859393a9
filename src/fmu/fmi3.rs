//! FMI 3.0, co-simulation: its functions in C (<https://fmi-standard.org>, FMI 3.0.2, chapters 2 and 4).
//!
//! Those that a unit does not have declare their first argument alone: on x86-64 Linux the caller passes and removes the others.
#![allow(unsafe_code)]
// The standard's arguments.
#![allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)]

use std::ffi::{c_char, c_void};

use super::instance::Instance;
use super::interface::{
    Logger, Messages, Status, ThirdLog, free, free_state, get, instantiate, put, resources_at,
    restore, save, set, with, without,
};

// SAFETY, of each `no_mangle` below: the name is the standard's, and no other function of the program has it.

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(component: *mut c_void) -> Status {
    // Errors are reported anyway, and there is nothing else to report.
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
    log: Option<ThirdLog>,
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
    get(
        component,
        (references, count),
        (values, value_count),
        Instance::real,
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetFloat64(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    set(
        component,
        (references, count),
        (values, value_count),
        Instance::set_real,
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut bool,
    value_count: usize,
) -> Status {
    get(
        component,
        (references, count),
        (values, value_count),
        Instance::boolean,
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetBoolean(
    component: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const u8,
    value_count: usize,
) -> Status {
    set(
        component,
        (references, count),
        (values, value_count),
        |instance, reference, value| instance.set_boolean(reference, value != 0),
    )
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

#[cfg(test)]
mod tests {
    use std::ffi::{CStr, CString};
    use std::path::Path;
    use std::ptr::null_mut;
    use std::sync::Mutex;

    use super::super::interface::{DISCARD, ERROR, OK};
    use super::super::model::Model;
    use super::*;

    static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

    unsafe extern "C" fn log(
        _: *mut c_void,
        status: Status,
        _: *const c_char,
        message: *const c_char,
    ) {
        // SAFETY: a text of the unit, which ends with a zero.
        let message = unsafe { CStr::from_ptr(message) }.to_string_lossy();
        MESSAGES.lock().unwrap().push(format!("{status} {message}"));
    }

    fn last_message() -> String {
        MESSAGES.lock().unwrap().last().cloned().unwrap_or_default()
    }

    fn made(token: &str, resources: &Path) -> *mut c_void {
        let text = |text: &str| CString::new(text).unwrap();
        let (token, resources) = (text(token), text(resources.to_str().unwrap()));
        fmi3InstantiateCoSimulation(
            c"unit".as_ptr(),
            token.as_ptr(),
            resources.as_ptr(),
            false,
            false,
            false,
            false,
            null_mut(),
            0,
            null_mut(),
            Some(log),
            null_mut(),
        )
    }

    fn real(unit: *mut c_void, reference: u32) -> f64 {
        let mut value = f64::NAN;
        assert_eq!(
            fmi3GetFloat64(unit, &raw const reference, 1, &raw mut value, 1),
            OK
        );
        value
    }

    /// As an importer in C goes through a unit, with what it may do wrong.
    #[test]
    #[expect(
        clippy::too_many_lines,
        reason = "one unit's life, call by call in the order of the standard"
    )]
    fn an_importer_in_c_steps_saves_restores_and_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let project = Path::new(env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(project.join("scenarios/paper_step.toml")).unwrap();
        let text = text.replace("../models/device.toml", "device.toml");
        std::fs::write(folder.path().join("scenario.toml"), text).unwrap();
        std::fs::copy(
            project.join("models/device.toml"),
            folder.path().join("device.toml"),
        )
        .unwrap();
        let model = Model::load(&folder.path().join("scenario.toml")).unwrap();
        let at = |name: &str| model.variables.iter().position(|v| v.name == name).unwrap() as u32;

        assert!(made("another", folder.path()).is_null());
        assert!(
            last_message().starts_with("3 this library"),
            "{}",
            last_message()
        );
        assert!(made(&model.token, &folder.path().join("absent")).is_null());
        assert!(
            last_message().contains("scenario.toml"),
            "{}",
            last_message()
        );

        let unit = made(&model.token, folder.path());
        assert!(!unit.is_null());
        let (pressure, force, bore) = (
            at("set_pressure_gauge_pa"),
            at("contact_force_n"),
            at("cylinder.bore_m"),
        );
        let set = |reference: u32, value: f64| {
            fmi3SetFloat64(unit, &raw const reference, 1, &raw const value, 1)
        };
        let step = |point: f64, length: f64| {
            let mut flags = [true; 3];
            let mut last = f64::NAN;
            let [event, terminate, early] = &mut flags;
            let status = fmi3DoStep(
                unit,
                point,
                length,
                true,
                event,
                terminate,
                early,
                &raw mut last,
            );
            assert_eq!(flags, [false; 3]);
            (status, last)
        };
        assert_eq!(step(0.0, 1e-3), (ERROR, 0.0));
        assert_eq!(
            fmi3EnterInitializationMode(unit, false, 0.0, 0.0, false, 0.0),
            OK
        );
        assert_eq!(fmi3ExitInitializationMode(unit), OK);
        assert_eq!(set(pressure, 1.8e5), OK);
        assert_eq!(step(0.0, 3.0), (OK, 3.0));
        // 1.8 bar on two pistons of 32 mm.
        let expected = 1.8e5 * std::f64::consts::PI * 0.016 * 0.016 * 2.0;
        assert!(
            (real(unit, force) / expected - 1.0).abs() < 0.02,
            "{}",
            real(unit, force)
        );

        let mut state = null_mut();
        assert_eq!(fmi3GetFMUState(unit, &raw mut state), OK);
        assert_eq!(set(pressure, 0.5e5), OK);
        assert_eq!(step(3.0, 1.0), (OK, 4.0));
        let lower = real(unit, force).to_bits();
        assert_eq!(step(7.0, 1.0), (ERROR, 4.0));
        assert!(
            last_message().contains("expected 4 s"),
            "{}",
            last_message()
        );
        assert_eq!(fmi3SetFMUState(unit, state), OK);
        assert_eq!(set(pressure, 0.5e5), OK);
        assert_eq!(step(3.0, 1.0), (OK, 4.0));
        assert_eq!(real(unit, force).to_bits(), lower);
        assert_eq!(fmi3FreeFMUState(unit, &raw mut state), OK);
        assert!(state.is_null());
        assert_eq!(fmi3SetFMUState(unit, state), ERROR);

        assert_eq!(set(bore, 1.0), DISCARD);
        assert!(
            last_message().contains("0.002 to 0.3 m"),
            "{}",
            last_message()
        );
        assert_eq!(real(unit, bore), 0.032);
        assert_eq!(fmi3GetString(unit), ERROR);
        assert!(
            last_message().contains("fmi3GetString"),
            "{}",
            last_message()
        );
        let valve = at("valve_extends");
        let (mut extends, retract) = (false, 0u8);
        assert_eq!(
            fmi3GetBoolean(unit, &raw const valve, 1, &raw mut extends, 1),
            OK
        );
        assert!(extends);
        assert_eq!(
            fmi3SetBoolean(unit, &raw const valve, 1, &raw const retract, 1),
            OK
        );
        assert_eq!(step(4.0, 1.0), (OK, 5.0));
        assert_eq!(real(unit, force), 0.0);
        assert_eq!(fmi3Reset(unit), OK);
        assert_eq!(real(unit, 0), 0.0);
        fmi3FreeInstance(unit);
        assert_eq!(fmi3Terminate(null_mut()), ERROR);
    }
}
