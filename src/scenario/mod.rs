//! A scenario: what to simulate, in strict SI, checked. `file` mirrors the TOML file, `document` finds its way in it, `load` turns it into this.

mod any;
pub mod arm_file;
mod assumed;
pub mod bench;
mod bench_file;
mod cell;
mod cell_files;
mod cell_limits;
mod collision;
pub mod controller;
mod device;
mod effect_request;
pub mod effects;
mod estimator;
mod file;
mod load;
pub mod postures_file;
mod program;
pub mod recorded_cell;
pub mod removal_table;
mod rig_device;
pub mod rig_file;
pub mod schema;
pub(crate) mod sections;
mod sensing;
#[cfg(test)]
mod tests;
mod toleranced;
mod tool;
mod variation;
mod whole_cell;
mod workpiece;

pub use crate::keys::error::ScenarioError;
pub use any::{AnyScenario, keys_given, load, load_any, load_bench, location_of};
pub use assumed::AssumedValue;
pub use bench::BenchScenario;
pub use cell::{
    BurrScenario, ChamferScenario, CollisionScenario, DeviceScenario, Direction, DriveScenario,
    EdgeChoice, EdgeSelection, Expectation, FeedFollows, FeedMeasure, LimitOverride, Misplacement,
    Obstacle, ObstacleShape, PassScenario, ProcessScenario, RemovalScenario, ServoScenario,
    SimulationScenario, ToolScenario, WorkpieceScenario,
};
pub use cell_files::files_of_cell;
pub use controller::{ControllerScenario, ForceLaw, attainable_set_pressure};
pub use device::load_device;
pub use effect_request::EffectRequest;
pub use program::{ProgramScenario, RobotMaker};
pub use recorded_cell::{RecordedCell, load_recorded_cell};
pub use sensing::largest_set_pressure;
pub use variation::{KeyValue, ScenarioTemplate, led_to, listed};
pub use whole_cell::{ArmScenario, Scenario};
