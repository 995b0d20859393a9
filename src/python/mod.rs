//! The extension module of the Python package `idc`: the program's functions, called in the process of Python. The package's own sources, with what people read,
//! stand in `idc/` beside this file.
// What PyO3's and self_cell's macros make holds `unsafe` blocks: calls of Python's C interface, of which PyO3 guarantees that the interpreter is attached and
// that arguments are of the types declared; and a simulation's loan of the cell beside it, of which self_cell guarantees that it ends before the cell does. None
// is written by hand.
#![allow(unsafe_code)]
// Python's calling convention hands over owned values.
#![allow(clippy::needless_pass_by_value)]

mod call;
mod command;
mod error;
mod finding;
mod run;
mod scenario;
mod stepwise;
mod sweep;
mod table;

#[pyo3::pymodule(gil_used = false)]
mod _idc {
    #[pymodule_export]
    use crate::python::command::main;
    #[pymodule_export]
    use crate::python::finding::{Diagnosis, compare, diagnose, predict};
    #[pymodule_export]
    use crate::python::run::{Run, run};
    #[pymodule_export]
    use crate::python::scenario::{Scenario, check_file, check_scenario, load, of_json};
    #[pymodule_export]
    use crate::python::stepwise::{Observation, Steps};
    #[pymodule_export]
    use crate::python::sweep::{Sweep, vary};
    #[pymodule_export]
    use crate::python::table::Table;
}
