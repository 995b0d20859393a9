//! Keys of a bench scenario, as `file` has those of a cell.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::controller::ControllerKeys;
use super::effects::EffectKeys;
use super::estimator::EstimatorKeys;
use super::file::{BoundKeys, DeviceKeys, Kind};
use super::sensing::keys::SensingKeys;
use crate::keys::declaration::{Plain, keys};
use crate::physics::valve::ValvePosition;
use crate::plant::registry;

keys! {
    /// A bench scenario file.
    pub(super) struct BenchFile {
        /// version of this format
        schema: u32 = "schema" in 1..=2;
        /// "bench"
        kind: Kind = "kind", being "\"cell\" or \"bench\"";
        /// name for people, also the recording's title
        title: String = "title", being "not empty";
        device: DeviceKeys = "device";
        bench: BenchKeys = "bench";
        load: LoadKeys = "load";
        hand: Option<HandScenario> = "hand";
        /// physics beyond the nominal device: [`[[effect]]`](#effect)
        effect: EffectKeys = "effect", shown "none";
        command: Vec<CommandKeys> = "command";
        valve: Vec<ValveKeys> = "valve";
        simulation: BenchSimulationKeys = "simulation";
        sensing: SensingKeys = "sensing";
        estimator: Option<EstimatorKeys> = "estimator";
        controller: ControllerKeys = "controller";
        /// bounds that the results must keep: [`[expect]`](#expect)
        expect: BTreeMap<String, BoundKeys> = "expect", shown "none";
    }

    /// `[bench]`.
    pub(super) struct BenchKeys {
        /// length of the run
        duration: f64 = "duration_s" in 0.01..=3600.0;
        /// component of gravity along extension; 0 for a level device, 9.81 for one that presses down
        gravity: Option<f64> = "gravity_along_extension_m_per_s2", of registry::GRAVITY, shown "0";
        /// stroke at the start, at most the device's; at 0 the tool rests on the inner stop
        start_stroke: f64 = "start_stroke_mm" in 0..=500, or 0.0;
    }

    /// `[hand]`: a hand that pushes against extension: peak_force/2 (1 - cos(2 pi frequency (t - start))).
    pub struct HandScenario: Copy {
        /// largest force
        peak_force: f64 = "peak_force_n" in 0..=5000;
        /// frequency of the force
        frequency: f64 = "frequency_hz" in 0.001..=100.0;
        /// when it starts
        start: f64 = "start_s" in 0..=3600, or 0.0;
    }

    /// `[load]`.
    pub(super) struct LoadKeys {
        /// nothing, something that stands still, or something that moves: which of the keys below there are
        kind: LoadKind = "kind";
        /// stroke at which the tool meets it, at most `stroke_mm`; of a surface its farthest
        position: Option<f64> = "position_mm" for "load_cell" | "surface" in 0..=500;
        /// contact stiffness
        stiffness: Option<f64> = "stiffness_n_per_m" for "load_cell" | "surface", of registry::CONTACT_STIFFNESS, shown "850000";
        /// contact damping
        damping: Option<f64> = "damping_n_s_per_m" for "load_cell" | "surface", of registry::CONTACT_DAMPING, shown "200";
        /// travel, towards the device and back again as a cosine
        peak_to_peak: Option<f64> = "peak_to_peak_mm" for "surface" in 0..=500;
        /// frequency of the travel
        frequency: Option<f64> = "frequency_hz" for "surface" in 0.001..=100.0;
        /// when it starts to move
        start: f64 = "start_s" for "surface" in 0..=3600, or 0.0;
    }

    /// `[[command]]`.
    pub(super) struct CommandKeys {
        /// when, later than the entry ahead of it
        at: f64 = "at_s", being "within the run";
        /// set pressure of the regulator; at most what a real `[sensing.command]` can give
        set_pressure: Option<f64> = "set_pressure_bar_gauge" in 0..=16, shown "one of the two";
        /// contact force, for the `[controller]`; within what the regulator can be set to
        force: Option<f64> = "force_n" in 0..=5000, shown "one of the two";
    }

    /// `[[valve]]`.
    pub(super) struct ValveKeys {
        /// when, later than the entry ahead of it
        at: f64 = "at_s", being "within the run";
        /// chamber 1 on the regulator, or chamber 2
        position: PositionWord = "position";
    }

    /// `[simulation]` of a bench.
    pub(super) struct BenchSimulationKeys {
        /// time step of control and recording
        step: f64 = "step_ms" in 0.01..=20.0, or 1.0;
        /// least number of integration sub-steps in it
        substeps: usize = "device_substeps" in 1..=1000, or 2;
        /// seed of all noise
        seed: u64 = "seed", or 1;
    }
}

impl Plain for LoadKind {}
impl Plain for PositionWord {}

/// Load that the tool meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum LoadKind {
    /// Nothing.
    Free,
    /// A load cell that stands still.
    LoadCell,
    /// A surface that moves.
    Surface,
}

/// Position of the 5/2 valve as a file has it.
#[derive(Debug, Clone, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(transparent)]
pub(super) struct PositionWord(
    #[schemars(with = "String", extend("enum" = ["extend", "retract"]))] pub ValvePosition,
);
