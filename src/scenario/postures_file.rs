//! The file of still postures of a wrench sensor, postures.toml: where their readings are, and sensor and tool by their nominal values, as far as they are
//! known. Strict SI but for readings in another unit that the file names.

mod improved;

use std::path::{Path, PathBuf};

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::toleranced::Toleranced;
use crate::keys::check::Section;
use crate::keys::declaration::{Plain, keys, of_file};
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;

pub use improved::improved_postures_text;

/// Version of the format.
const SCHEMA: u32 = 1;
/// What `kind` says.
pub const WRENCH_POSTURES: &str = "wrench_postures";
/// Ranges of numbers [SI].
const MASS: [f64; 2] = [0.0, 1e5];
const LENGTH: [f64; 2] = [-1e3, 1e3];
const FORCE: [f64; 2] = [-1e5, 1e5];
/// Gravity on Earth [m/s2].
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Kind of a file, whatever else stands in it.
#[derive(Deserialize)]
struct KindKeys {
    kind: Option<String>,
}

/// The one kind of such a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum FileKind {
    /// Still postures of a wrench sensor.
    WrenchPostures,
}

/// Axes that readings are given in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReadingAxes {
    /// The sensor's own.
    Sensor,
    /// The base's: something turns readings by the pose.
    Base,
}

/// What the pose in a row says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PoseOf {
    /// The sensor's link in the base's axes.
    SensorInBase,
    /// The base in those of the sensor's link.
    BaseInSensor,
}

/// What a reading is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReadingOf {
    /// What the tool does to the sensor.
    ToolOnSensor,
    /// What the sensor does to the tool.
    SensorOnTool,
}

/// Unit of forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
enum ForceUnit {
    #[serde(rename = "N")]
    Newton,
    #[serde(rename = "kN")]
    Kilonewton,
}

/// Unit of torques.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
enum TorqueUnit {
    #[serde(rename = "N m")]
    NewtonMetre,
    #[serde(rename = "N mm")]
    NewtonMillimetre,
}

impl Plain for FileKind {}
impl Plain for ReadingAxes {}
impl Plain for PoseOf {}
impl Plain for ReadingOf {}
impl Plain for ForceUnit {}
impl Plain for TorqueUnit {}

type Number = Toleranced<f64>;
type Vector = Toleranced<[f64; 3]>;

keys! {
    /// Still postures of a wrench sensor: their recordings, and sensor and tool by their nominal values.
    struct PosturesKeys {
        /// version of the format
        schema: u32 = "schema" in 1..=1;
        /// what the file is
        kind: FileKind = "kind";
        /// name for people
        title: Option<String> = "title";
        /// tables of postures, CSV with a header, a still posture a row
        recordings: StillsKeys = "recordings";
        /// columns that are called otherwise, and units of readings
        columns: ColumnsKeys = "columns";
        /// how the base stands
        base: BaseKeys = "base";
        /// the sensor and the tool beyond it
        wrench: WrenchKeys = "wrench_sensor";
        /// noise of the sensor
        sensors: NoiseKeys = "sensors";
    }

    /// `[recordings]`.
    struct StillsKeys {
        /// tables beside this file to diagnose from; a star stands for all that fit
        fit: Vec<String> = "fit" must stand, being "at least one";
        /// table that is kept back, to be predicted
        predict: Option<String> = "predict";
    }

    /// `[columns]`: names in the header where they are others than the usual ones.
    struct ColumnsKeys: Default {
        /// pose, a unit quaternion: x
        quaternion_x: Option<String> = "quaternion_x", shown "quaternion_x";
        /// y
        quaternion_y: Option<String> = "quaternion_y", shown "quaternion_y";
        /// z
        quaternion_z: Option<String> = "quaternion_z", shown "quaternion_z";
        /// w, its real part
        quaternion_w: Option<String> = "quaternion_w", shown "quaternion_w";
        /// force along x
        force_x: Option<String> = "force_x", shown "force_x_n";
        /// along y
        force_y: Option<String> = "force_y", shown "force_y_n";
        /// along z
        force_z: Option<String> = "force_z", shown "force_z_n";
        /// torque about x; without all three there are no torques
        torque_x: Option<String> = "torque_x", shown "torque_x_n_m";
        /// about y
        torque_y: Option<String> = "torque_y", shown "torque_y_n_m";
        /// about z
        torque_z: Option<String> = "torque_z", shown "torque_z_n_m";
        /// unit of the forces: "N" or "kN"
        force_unit: Option<ForceUnit> = "force_unit", shown "\"N\"";
        /// unit of the torques: "N m" or "N mm"
        torque_unit: Option<TorqueUnit> = "torque_unit", shown "\"N m\"";
    }

    /// `[base]`.
    struct BaseKeys {
        /// gravity in the axes of the base
        gravity: DVec3 = "gravity_m_per_s2", or vec![0.0, 0.0, -9.81];
        /// how far it may lie from that
        tilt: f64 = "tilt_tolerance_rad" in 1e-6..=1.0, or 0.035;
    }

    /// `[wrench_sensor]`: what readings are; of the numbers of sensor and tool those that are declared, the others are identified.
    struct WrenchKeys {
        /// axes of the readings: "sensor", or "base" where they are turned by the pose already
        axes: Option<ReadingAxes> = "axes", shown "\"sensor\"";
        /// what the pose says: "sensor_in_base" or "base_in_sensor"
        pose: Option<PoseOf> = "pose", shown "\"sensor_in_base\"";
        /// what a reading is: "tool_on_sensor" or "sensor_on_tool"
        reads: Option<ReadingOf> = "reads", shown "\"tool_on_sensor\"";
        /// roll, pitch and yaw of the readings' axes against those of the sensor's link, or the base's
        rotation: DVec3 = "rotation_rad", or vec![0.0; 3];
        /// how far they may be turned against that
        rotation_tolerance: f64 = "rotation_tolerance_rad" in 1e-6..=1.0, or 0.035;
        /// forces that it reads without a tool, in its own axes
        zero_force: Option<Vector> = "zero_force_n", shown "identified";
        /// torques that it reads without a tool
        zero_torque: Option<Vector> = "zero_torque_n_m", shown "identified";
        /// mass of all that is beyond it
        tool_mass: Option<Number> = "tool_mass_kg", shown "identified";
        /// centre of that from the sensor's origin, in the axes of its link
        tool_centre: Option<Vector> = "tool_centre_m", shown "identified";
    }

    /// `[sensors]`: one standard deviation of the sensor's white noise, as far as it is known.
    struct NoiseKeys: Default {
        /// of a force
        force: Option<f64> = "wrench_force_n" in 1e-9..=1e6;
        /// of a torque
        torque: Option<f64> = "wrench_torque_n_m" in 1e-9..=1e6;
    }
}

/// A declared value and the box in which the truth lies [SI].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeclaredValue<T> {
    /// The value.
    pub value: T,
    /// Least values.
    pub low: T,
    /// Largest values.
    pub high: T,
}

/// Sensor, tool and gravity as a file declares them [SI].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrenchValues {
    /// Gravity in the base's axes [m/s2].
    pub gravity: DVec3,
    /// Axes of the readings.
    pub axes: ReadingAxes,
    /// What the pose says.
    pub pose: PoseOf,
    /// What a reading is of.
    pub reads: ReadingOf,
    /// Roll, pitch and yaw of the readings' axes [rad].
    pub rotation: DVec3,
    /// Force that is read without a tool [N].
    pub zero_force: Option<DeclaredValue<[f64; 3]>>,
    /// Torque that is [N m].
    pub zero_torque: Option<DeclaredValue<[f64; 3]>>,
    /// Mass of all beyond the sensor [kg].
    pub tool_mass: Option<DeclaredValue<f64>>,
    /// Its centre [m].
    pub tool_centre: Option<DeclaredValue<[f64; 3]>>,
}

/// The file, checked.
#[derive(Debug, Clone)]
pub struct PosturesFile {
    /// Its path.
    pub path: PathBuf,
    text: String,
    /// Its title.
    pub title: String,
    /// Tables to diagnose from, as the file names them.
    pub fit: Vec<String>,
    /// Table to predict.
    pub predict: Option<String>,
    /// Columns of the quaternion, x to w.
    pub quaternion: [String; 4],
    /// Columns of the force.
    pub force: [String; 3],
    /// Columns of the torque.
    pub torque: [String; 3],
    /// Whether the file names columns of the torque.
    pub names_torque: bool,
    /// Units of readings in SI: of a force, of a torque.
    pub units: [f64; 2],
    /// Sensor and tool.
    pub values: WrenchValues,
    /// How far gravity may lie from where it is declared [rad].
    pub tilt_tolerance: f64,
    /// How far the readings' axes may be turned against what is declared [rad].
    pub rotation_tolerance: f64,
    /// Noise of a force [N] and a torque [N m].
    pub noise: [Option<f64>; 2],
}

/// Whether a file says that it is of still postures; not where it cannot be read.
#[must_use]
pub fn is_postures_file(path: &Path) -> bool {
    let Ok(text) = read_text(path) else {
        return false;
    };
    let kind =
        Document::new(path, &text, u32::MAX).and_then(|document| document.parse::<KindKeys>(&[]));
    kind.is_ok_and(|keys| keys.kind.as_deref() == Some(WRENCH_POSTURES))
}

/// Reads and checks the file.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_postures_file(path: &Path) -> Result<PosturesFile, ScenarioError> {
    from_text(path, &read_text(path)?)
}

/// As [`load_postures_file`], of a text that stands, or could stand, in the file at `path`.
///
/// # Errors
/// As [`load_postures_file`].
pub fn from_text(path: &Path, text: &str) -> Result<PosturesFile, ScenarioError> {
    let document = Document::new(path, text, SCHEMA)?;
    let keys: PosturesKeys = document.read()?;
    let recordings = Section::new(&document, "recordings");
    if keys.recordings.fit.is_empty() {
        let expected = "the tables of postures to diagnose from".to_owned();
        return Err(recordings.refuse("fit", "empty".to_owned(), expected));
    }
    let values = values(&document, &keys)?;
    let columns = keys.columns;
    let names_torque = [&columns.torque_x, &columns.torque_y, &columns.torque_z];
    let names_torque = names_torque.iter().any(|name| name.is_some());
    let named = |name: Option<String>, usual: &str| name.unwrap_or_else(|| usual.to_owned());
    Ok(PosturesFile {
        path: path.to_owned(),
        text: text.to_owned(),
        title: keys.title.unwrap_or_default(),
        fit: keys.recordings.fit,
        predict: keys.recordings.predict,
        quaternion: [
            named(columns.quaternion_x, "quaternion_x"),
            named(columns.quaternion_y, "quaternion_y"),
            named(columns.quaternion_z, "quaternion_z"),
            named(columns.quaternion_w, "quaternion_w"),
        ],
        force: [
            named(columns.force_x, "force_x_n"),
            named(columns.force_y, "force_y_n"),
            named(columns.force_z, "force_z_n"),
        ],
        torque: [
            named(columns.torque_x, "torque_x_n_m"),
            named(columns.torque_y, "torque_y_n_m"),
            named(columns.torque_z, "torque_z_n_m"),
        ],
        names_torque,
        units: [
            match columns.force_unit {
                Some(ForceUnit::Kilonewton) => 1e3,
                _ => 1.0,
            },
            match columns.torque_unit {
                Some(TorqueUnit::NewtonMillimetre) => 1e-3,
                _ => 1.0,
            },
        ],
        values,
        tilt_tolerance: keys.base.tilt,
        rotation_tolerance: keys.wrench.rotation_tolerance,
        noise: [keys.sensors.force, keys.sensors.torque],
    })
}

/// Schema of the file.
#[must_use]
pub fn schema() -> Value {
    of_file::<PosturesKeys>("Still postures of idc")
}

fn values(document: &Document<'_>, keys: &PosturesKeys) -> Result<WrenchValues, ScenarioError> {
    let base = Section::new(document, "base");
    let gravity = keys.base.gravity;
    if !(1.0..100.0).contains(&gravity.length()) {
        let found = format!("{} m/s2 long", gravity.length());
        let expected = format!("1 to 100 m/s2, as {GRAVITY:?} of a base that stands");
        return Err(base.refuse("gravity_m_per_s2", found, expected));
    }
    let section = Section::new(document, "wrench_sensor");
    let wrench = &keys.wrench;
    let vector = |key: &str, value: &Option<Vector>, range| {
        let value = value.as_ref();
        value
            .map(|value| vector_of(&section, key, value, range))
            .transpose()
    };
    let mass = wrench.tool_mass.as_ref();
    let mass = mass.map(|mass| -> Result<_, ScenarioError> {
        let bounds = mass.bounds(&section, "tool_mass_kg", MASS)?;
        Ok(DeclaredValue {
            value: mass.value,
            low: bounds[0][0],
            high: bounds[0][1],
        })
    });
    Ok(WrenchValues {
        gravity,
        axes: wrench.axes.unwrap_or(ReadingAxes::Sensor),
        pose: wrench.pose.unwrap_or(PoseOf::SensorInBase),
        reads: wrench.reads.unwrap_or(ReadingOf::ToolOnSensor),
        rotation: wrench.rotation,
        zero_force: vector("zero_force_n", &wrench.zero_force, FORCE)?,
        zero_torque: vector("zero_torque_n_m", &wrench.zero_torque, FORCE)?,
        tool_mass: mass.transpose()?,
        tool_centre: vector("tool_centre_m", &wrench.tool_centre, LENGTH)?,
    })
}

fn vector_of(
    section: &Section<'_>,
    key: &str,
    value: &Vector,
    range: [f64; 2],
) -> Result<DeclaredValue<[f64; 3]>, ScenarioError> {
    let bounds = value.bounds(section, key, range)?;
    let of = |end: usize| std::array::from_fn(|axis| bounds[axis][end]);
    Ok(DeclaredValue {
        value: value.value,
        low: of(0),
        high: of(1),
    })
}
