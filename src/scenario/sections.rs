//! Which keys each table of a file has, read off the types in `file`, so that a message can point to the right table.

use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

use super::sensing::keys as sensing;
use super::{bench_file, controller, device, estimator, file, recorded_cell};

/// A table and its keys.
type Table = (&'static str, &'static [&'static str]);

/// Tables of a scenario file with their keys; `*` stands for a name that the user gives.
pub(crate) fn scenario_sections() -> Vec<Table> {
    let mut sections = vec![
        ("", keys::<file::ScenarioFile>()),
        ("arm", keys::<file::ArmKeys>()),
        ("arm.link_masses", keys::<file::LinkMassKeys>()),
        ("arm.limit_overrides", keys::<file::LimitKeys>()),
        ("arm.drives", keys::<file::DriveKeys>()),
        ("arm.servo", keys::<file::ServoKeys>()),
        ("device", keys::<file::DeviceKeys>()),
        ("device.override", keys::<device::ModelKeys>()),
        ("workpiece", keys::<file::WorkpieceKeys>()),
        ("workpiece.edge", keys::<file::EdgeKeys>()),
        ("workpiece.misplacement", keys::<file::MisplacementKeys>()),
        ("workpiece.burr", keys::<file::BurrKeys>()),
        ("contact", keys::<file::ContactKeys>()),
        ("workpiece.chamfer", keys::<file::ChamferKeys>()),
        ("process", keys::<file::ProcessKeys>()),
        ("process.feed_follows", keys::<file::FeedFollowsKeys>()),
        ("pass", keys::<file::PassKeys>()),
        ("tool", keys::<file::ToolKeys>()),
        ("removal", keys::<file::RemovalKeys>()),
        ("collision", keys::<file::CollisionKeys>()),
        ("obstacle", keys::<file::ObstacleKeys>()),
        ("simulation", keys::<file::SimulationKeys>()),
        ("controller", keys::<controller::ControllerKeys>()),
        ("expect.*", keys::<file::BoundKeys>()),
    ];
    sections.extend(sensing_sections());
    sections
}

/// Tables of a recorded cell's scenario file with their keys.
pub(crate) fn recorded_cell_sections() -> Vec<Table> {
    let own = [
        "arm",
        "device",
        "device.override",
        "workpiece",
        "workpiece.edge",
        "contact",
    ];
    let mut sections: Vec<Table> = scenario_sections()
        .into_iter()
        .filter(|(table, _)| own.contains(table))
        .collect();
    sections.extend([
        ("", keys::<recorded_cell::RecordedCellFile>()),
        ("joints", keys::<recorded_cell::JointsKeys>()),
        ("sensors", keys::<recorded_cell::SensorsKeys>()),
        ("belief", keys::<recorded_cell::BeliefKeys>()),
    ]);
    sections
}

/// Tables of a bench scenario file with their keys.
pub(crate) fn bench_sections() -> Vec<Table> {
    let mut sections = vec![
        ("", keys::<bench_file::BenchFile>()),
        ("device", keys::<file::DeviceKeys>()),
        ("device.override", keys::<device::ModelKeys>()),
        ("bench", keys::<bench_file::BenchKeys>()),
        ("load", keys::<bench_file::LoadKeys>()),
        ("hand", keys::<bench_file::HandKeys>()),
        ("command", keys::<bench_file::CommandKeys>()),
        ("valve", keys::<bench_file::ValveKeys>()),
        ("simulation", keys::<bench_file::BenchSimulationKeys>()),
        ("controller", keys::<controller::ControllerKeys>()),
        ("estimator", keys::<estimator::EstimatorKeys>()),
        ("expect.*", keys::<file::BoundKeys>()),
    ];
    sections.extend(sensing_sections());
    sections
}

/// Tables that a scenario of either kind may have for its sensing.
fn sensing_sections() -> [Table; 8] {
    [
        ("sensing", keys::<sensing::SensingKeys>()),
        ("sensing.command", keys::<sensing::CommandChainKeys>()),
        (
            "sensing.regulator_pressure",
            keys::<sensing::RegulatorPressureKeys>(),
        ),
        ("sensing.force", keys::<sensing::ForceKeys>()),
        ("sensing.stroke", keys::<sensing::StrokeKeys>()),
        ("sensing.acceleration", keys::<sensing::AccelerationKeys>()),
        ("sensing.adc", keys::<sensing::AdcKeys>()),
        ("sensing.filter", keys::<sensing::FilterKeys>()),
    ]
}

/// Tables of a device model file with their keys.
pub(crate) fn model_sections() -> Vec<Table> {
    vec![
        ("", keys::<file::ModelFile>()),
        ("device", keys::<device::ModelKeys>()),
    ]
}

/// Keys of one table: the derived code hands its field names to the deserializer, which keeps them and stops.
pub(crate) fn keys<T: for<'de> Deserialize<'de>>() -> &'static [&'static str] {
    let mut names: &'static [&'static str] = &[];
    // The probe always stops with an error; the names are what was wanted of it.
    let _ = T::deserialize(Probe(&mut names));
    names
}

struct Probe<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        _visitor: V,
    ) -> Result<V::Value, Self::Error> {
        *self.0 = fields;
        Err(Self::Error::custom("names taken"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Self::Error> {
        Err(Self::Error::custom("not a table"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}
