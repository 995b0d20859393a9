//! Runs in which effects show: short scenarios that come with the program, and parts of a device driven by simple inputs.

mod arm;

pub use arm::{ArmStage, arm_effects};

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use crate::cell::Cell;
use crate::effects::{Effect, LINK_EFFECTS, Subsystem};
use crate::plant::{
    Channel, DeviceParts, InitialState, MeasuredMotion, Nominal, PlantInputs, PlantParameters,
    simulate,
};
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{Recording, RecordingError};
use crate::rig::Rig;
use crate::run::{RunError, apply_effects, nominal_of};
use crate::scenario::{AnyScenario, EffectRequest, KeyValue, ScenarioTemplate};

/// A scenario that comes with the program.
#[derive(Debug, PartialEq, Eq)]
pub struct Shipped {
    /// Its path in the project.
    pub path: &'static str,
    text: &'static str,
}

macro_rules! shipped {
    ($name:literal) => {
        Shipped {
            path: concat!("assets/effects/", $name, ".toml"),
            text: include_str!(concat!("../../assets/effects/", $name, ".toml")),
        }
    };
}

static STEPS: Shipped = shipped!("steps");
static SWAY: Shipped = shipped!("sway");
static STROKES: Shipped = shipped!("strokes");
static EDGE: Shipped = shipped!("edge");
static DRAW: Shipped = shipped!("draw");

/// Subjects of the scenarios, with their paths in the project.
const BESIDE: [(&str, &[u8]); 3] = [
    (
        "models/arm/arm10.urdf",
        include_bytes!("../../models/arm/arm10.urdf"),
    ),
    (
        "models/device.toml",
        include_bytes!("../../models/device.toml"),
    ),
    ("assets/plate.stl", include_bytes!("../../assets/plate.stl")),
];

/// Where an effect is shown.
pub enum Scene {
    /// In a run of a scenario.
    Run(&'static Shipped),
    /// In a part of a device alone.
    Part(DeviceParts),
}

impl Scene {
    /// A name of its own.
    pub fn key(&self) -> String {
        match self {
            Self::Run(shipped) => shipped.path.to_owned(),
            Self::Part(parts) => parts.name().to_owned(),
        }
    }
}

/// Presentation of an effect.
pub struct Presentation {
    /// Where.
    pub scene: Scene,
    /// Between which times [s]; the whole run where there are none.
    pub window: Option<[f64; 2]>,
    /// Which signals, by their keys.
    pub signals: &'static [&'static str],
    /// One of its numbers where its usual size would not be seen there.
    pub size: Option<Size>,
}

/// A number of another size than the usual one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// As `--with` takes it.
    pub asked: &'static str,
    /// Its key in SI.
    pub key: &'static str,
    /// In SI.
    pub value: f64,
}

const fn size(asked: &'static str, key: &'static str, value: f64) -> Option<Size> {
    Some(Size { asked, key, value })
}

/// Presentation of an effect: by its row, or as a step is.
#[rustfmt::skip] // A table: one effect a line.
pub fn of(effect: &Effect) -> Presentation {
    let whole = [0.0, f64::INFINITY];
    let (run, window, signals, size): (_, _, &[&str], _) = match effect.vocabulary().0 {
        "coulomb_viscous_friction" => (&SWAY, [1.0, 5.0], &["force", "stroke"], None),
        "stribeck_friction" => (&SWAY, [1.0, 5.0], &["force", "stroke"], None),
        "presliding_hysteresis" => (&SWAY, [1.0, 5.0], &["force", "stroke"], None),
        "pressure_dependent_friction" => (&SWAY, [1.0, 9.0], &["force", "stroke"], None),
        "return_spring_load" => (&SWAY, [1.0, 5.0], &["force", "stroke"], None),
        "axial_force_offset" => (&STEPS, [4.2, 8.0], &["force", "outlet"], None),
        "end_cushioning" => (&STROKES, [0.2, 0.7], &["stroke", "acceleration"], None),
        "moving_mass_error" => (&STROKES, [0.2, 0.42], &["acceleration", "stroke"], None),
        "cross_piston_leakage" => (&STEPS, [1.3, 4.5], &["chamber_2", "chamber_1"],
            size("orifice_area_mm2=0.8", "orifice_area_m2", 8e-7)),
        "external_leakage" => (&STEPS, [1.3, 4.5], &["chamber_1", "outlet"],
            size("orifice_area_mm2=0.8", "orifice_area_m2", 8e-7)),
        "supply_droop" => (&DRAW, whole, &["outlet", "stroke"], None),
        "heat_transfer" => (&STROKES, [1.4, 2.3], &["chamber_1", "stroke"], None),
        "exhaust_restriction" => (&STROKES, [0.2, 2.2], &["chamber_2", "stroke"], None),
        "supply_restriction" => (&STEPS, [1.4, 2.4], &["chamber_1", "outlet"], None),
        "extra_dead_volume" => (&STROKES, [1.4, 2.4], &["chamber_2", "chamber_1"], None),
        "hose_volume" => (&STEPS, [1.4, 2.4], &["chamber_1", "outlet"], None),
        "regulator_hysteresis" => (&STEPS, [4.2, 8.0], &["outlet", "force"], None),
        "regulator_rate_limit" => (&STEPS, [1.3, 6.0], &["outlet", "force"], None),
        "regulator_second_order" => (&STEPS, [1.3, 4.5], &["outlet", "force"], None),
        "solenoid_switching_delay" => (&STROKES, [1.4, 2.9], &["chamber_2", "stroke"], None),
        "transport_delay" => (&STEPS, [1.4, 2.4], &["outlet", "force"], None),
        "regulator_gain_error" => (&STEPS, [1.3, 4.5], &["outlet", "force"], None),
        "contact_stiffness_error" | "hertzian_contact" => (&STEPS, [1.0, 8.0], &["stroke", "force"], None),
        "tool_runout" => (&EDGE, [5.0, 5.15], &["force", "stroke"], None),
        "surface_waviness" => (&EDGE, [4.0, 7.0], &["stroke", "force"], None),
        "surface_offset" => (&EDGE, [3.0, 7.5], &["stroke"], None),
        "force_sensor_bias_drift" => (&STEPS, [4.2, 8.0], &["force"], None),
        "force_sensor_gain_error" => (&STEPS, [1.3, 4.5], &["force", "outlet"], None),
        "force_sensor_lag" | "channel_time_offset" => (&STEPS, [0.3, 0.5], &["force", "acceleration"], None),
        "force_sensor_saturation" => (&STEPS, [0.2, 4.5], &["force", "outlet"], None),
        "inertial_crosstalk" => (&STROKES, [0.2, 0.5], &["force", "acceleration"], None),
        "stroke_sensor_gain_error" => (&STROKES, [0.35, 0.6], &["stroke"], None),
        "part_misplaced" => (&EDGE, [3.0, 7.5], &["stroke"], None),
        "burr" => (&EDGE, [4.5, 6.5], &["stroke", "force"], size("position_mm=40", "position_m", 0.04)),
        "compliant_joint" => (&EDGE, [3.0, 7.5], &["stroke", "path"], None),
        "joint_encoder_offset" => (&EDGE, [3.0, 7.5], &["stroke", "path"], None),
        "joint_backlash" => (&EDGE, whole, &["path", "torque"], None),
        "joint_friction" => (&EDGE, whole, &["torque", "speed"], None),
        "servo_lag" => (&EDGE, whole, &["trail", "speed"], None),
        "load_behind_line" => return part(DeviceParts::Regulator, size("load_time_constant_s=1", "load_time_constant_s", 1.0)),
        "viscous_friction_by_direction" => return part(DeviceParts::DrivenSlide, None),
        _ if is_of_part(effect) => match effect.subsystem {
            Subsystem::Chambers => return part(DeviceParts::ClosedChamber, None),
            _ => return part(DeviceParts::Regulator, None),
        },
        _ => (&STEPS, whole, &["outlet", "force"], None),
    };
    Presentation { scene: Scene::Run(run), window: (window != whole).then_some(window), signals, size }
}

fn part(parts: DeviceParts, size: Option<Size>) -> Presentation {
    Presentation {
        scene: Scene::Part(parts),
        window: None,
        signals: &["read", "speed"],
        size,
    }
}

/// Argument of `--with` for it to be shown.
pub fn asked(effect: &Effect) -> String {
    let name = effect.vocabulary().0;
    let size = of(effect).size;
    size.map_or(name.to_owned(), |size| format!("{name}:{}", size.asked))
}

/// Its numbers, as large as they are shown.
pub fn sizes(effect: &Effect, nominal: &PlantParameters) -> Vec<f64> {
    let usual = effect.usual(nominal);
    let size = of(effect).size;
    let own = |key: &str, usual: f64| match size {
        Some(size) if size.key == key => size.value,
        _ => usual,
    };
    let parameters = effect.parameters(nominal);
    let pairs = parameters.iter().zip(usual);
    pairs
        .map(|(parameter, usual)| own(parameter.quantity.name, usual))
        .collect()
}

/// Whether only a rig with a part of the device shows it.
pub fn is_of_part(effect: &Effect) -> bool {
    LINK_EFFECTS.iter().any(|own| own.name == effect.name)
}

/// A signal in the unit in which it is drawn.
#[derive(Debug, Clone)]
pub struct Signal {
    /// By which it is chosen.
    pub key: &'static str,
    /// Its title.
    pub title: String,
    /// The same on an axis.
    pub axis: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Its values.
    pub values: Vec<f64>,
}

/// Readings of a run's sensors.
#[derive(Debug, Clone)]
pub struct Signals {
    /// Times [s].
    pub time: Vec<f64>,
    /// Them.
    pub signals: Vec<Signal>,
    /// Set pressure [bar gauge].
    pub set: Vec<f64>,
}

/// A scene that is ready to be run.
pub struct Stage {
    kind: Kind,
    /// Nominal parameters there.
    pub nominal: Nominal<PlantParameters>,
    /// The joint that shows most, from 1.
    pub most_observable_joint: usize,
}

enum Kind {
    Run {
        template: ScenarioTemplate,
        /// Its run without an effect, once it is asked for.
        unchanged: OnceLock<Signals>,
        /// Holds the template's files as long as it may be run.
        _folder: tempfile::TempDir,
    },
    Part,
}

impl Stage {
    /// Sets a scene up.
    ///
    /// # Errors
    /// The scenario's files cannot be put down or read.
    pub fn new(scene: &Scene) -> Result<Self, RunError> {
        match scene {
            Scene::Run(shipped) => Self::of_run(shipped),
            Scene::Part(parts) => {
                let mut nominal = Self::of_run(&STEPS)?.nominal;
                nominal.parts = *parts;
                // Slow enough for what is put in to be seen beside it.
                nominal.device.regulator.time_constant = 0.3;
                nominal.device.regulator.dead_time = 0.0;
                if *parts == DeviceParts::DrivenSlide {
                    nominal.device.seal_friction.viscous = 60.0;
                }
                Ok(Self {
                    nominal,
                    kind: Kind::Part,
                    most_observable_joint: 1,
                })
            }
        }
    }

    fn of_run(shipped: &Shipped) -> Result<Self, RunError> {
        let (folder, path) = put_down(shipped, &[])?;
        let template = ScenarioTemplate::read(&path)?;
        let (nominal, most_observable_joint) = nominal_of(&template)?;
        Ok(Self {
            kind: Kind::Run {
                template,
                unchanged: OnceLock::new(),
                _folder: folder,
            },
            nominal,
            most_observable_joint,
        })
    }

    /// Its run without an effect, and with one of usual size.
    ///
    /// # Errors
    /// An effect that cannot be put in, or a run that cannot be recorded.
    pub fn runs(&self, effect: &Effect) -> Result<[Signals; 2], RunError> {
        match &self.kind {
            Kind::Part => Ok([false, true].map(|has| run_part(&self.nominal, effect, has))),
            Kind::Run {
                template,
                unchanged,
                ..
            } => {
                let unchanged = match unchanged.get() {
                    Some(unchanged) => unchanged,
                    None => {
                        let own = self.signals(template.with(&[])?)?;
                        unchanged.get_or_init(|| own)
                    }
                };
                let asked = EffectRequest::parse(&asked(effect));
                let asked = asked.map_err(|reason| RunError::With { reason })?;
                let edits: Vec<KeyValue> = apply_effects(&[asked], template)?;
                Ok([unchanged.clone(), self.signals(template.with(&edits)?)?])
            }
        }
    }

    fn signals(&self, scenario: AnyScenario) -> Result<Signals, RunError> {
        let atmosphere = self.nominal.device.gas.atmosphere;
        match scenario {
            AnyScenario::Bench(bench) => {
                let (recording, _) = Rig::new(*bench)?.run(&mut |_| ())?;
                Ok(of_recording(&recording, atmosphere))
            }
            AnyScenario::Cell(cell) => {
                let cell = Cell::new(*cell)?;
                let recording = cell.run(&mut |_| ())?.recording;
                let mut signals = of_recording(&recording, atmosphere);
                signals
                    .signals
                    .extend(of_joint(&recording, self.most_observable_joint));
                Ok(signals)
            }
        }
    }
}

/// Writes a scenario and the files that it names into a folder.
fn put_down(
    shipped: &Shipped,
    further: &[(&'static str, &'static [u8])],
) -> Result<(tempfile::TempDir, PathBuf), RunError> {
    let folder =
        tempfile::tempdir().map_err(|error| RecordingError::write(Path::new("."), error))?;
    let scenario = (shipped.path, shipped.text.as_bytes());
    let files = BESIDE.into_iter().chain([scenario]);
    for (path, content) in files.chain(further.iter().copied()) {
        let path = folder.path().join(path);
        let written = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        written
            .and_then(|()| std::fs::write(&path, content))
            .map_err(|error| RecordingError::write(&path, error))?;
    }
    let path = folder.path().join(shipped.path);
    Ok((folder, path))
}

/// A signal of a recording: quantity, key, name, name on an axis, unit, and what a value in SI is multiplied by.
type Read = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    f64,
);

const GAUGE: &str = "bar gauge";

#[rustfmt::skip] // A table: one signal a line.
const READ: [Read; 7] = [
    (schema::MEASURED_REGULATOR_PRESSURE, "outlet", "Regulator, read", "pressure", GAUGE, 1e-5),
    (schema::MEASURED_FORCE, "force", "Force, read", "force", "N", 1.0),
    (schema::MEASURED_STROKE, "stroke", "Stroke, read", "stroke", "mm", 1e3),
    (schema::CHAMBER_1_PRESSURE, "chamber_1", "Chamber 1", "pressure", GAUGE, 1e-5),
    (schema::CHAMBER_2_PRESSURE, "chamber_2", "Chamber 2", "pressure", GAUGE, 1e-5),
    (schema::MEASURED_ACCELERATION, "acceleration", "Acceleration, read", "acceleration", "m/s2", 1.0),
    (schema::PATH_ERROR_AXIAL, "path", "Path error, axial", "error", "µm", 1e6),
];

fn of_recording(recording: &Recording, atmosphere: f64) -> Signals {
    let scaled = |quantity: &str, factor: f64, zero: f64| -> Option<Vec<f64>> {
        let values = &recording.channel(quantity)?.values;
        Some(values.iter().map(|value| factor * (value - zero)).collect())
    };
    let signal = |&(quantity, key, title, axis, unit, factor): &Read| {
        let zero = if unit == GAUGE { atmosphere } else { 0.0 };
        Some(Signal {
            key,
            title: title.to_owned(),
            axis,
            unit,
            values: scaled(quantity, factor, zero)?,
        })
    };
    Signals {
        time: recording.time().to_vec(),
        signals: READ.iter().filter_map(signal).collect(),
        set: scaled(schema::SET_PRESSURE, 1e-5, atmosphere).unwrap_or_default(),
    }
}

/// Readings of a joint's drive and encoder.
fn of_joint(recording: &Recording, joint: usize) -> Vec<Signal> {
    let values = |signal| {
        let channel = recording.channel(&joint_quantity(joint, signal));
        channel.map(|channel| channel.values.clone())
    };
    let signal = |key, title, axis, unit, values| Signal {
        key,
        title: format!("{title}, joint {joint}"),
        axis,
        unit,
        values,
    };
    let torque = values(JointSignal::Torque);
    let scaled = |values: Vec<f64>| values.iter().map(|value| 1e3 * value).collect();
    let speed = values(JointSignal::Velocity).map(scaled);
    let pair = values(JointSignal::Encoder).zip(values(JointSignal::Reference));
    let trail = pair.map(|(read, commanded)| {
        let pairs = read.iter().zip(&commanded);
        pairs
            .map(|(read, commanded)| 1e3 * (read - commanded))
            .collect()
    });
    [
        torque.map(|values| signal("torque", "Torque", "torque", "N m", values)),
        speed.map(|values| signal("speed", "Speed", "speed", "mrad/s", values)),
        trail.map(|values| signal("trail", "Encoder error", "angle", "mrad", values)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Its inputs.
fn inputs_of(parts: DeviceParts, name: &str) -> PlantInputs {
    let times = |duration: f64| -> Vec<f64> {
        let count = (duration / 0.01).round() as usize;
        (0..=count).map(|index| 0.01 * index as f64).collect()
    };
    let (time, set): (Vec<f64>, fn(f64) -> f64) = match (parts, name) {
        (_, "pressure_sensor_offset") => (times(3.5), |t| match t {
            t if t < 1.0 => 0.0,
            _ => 5e3,
        }),
        (DeviceParts::Regulator, _) => (times(8.0), |t| match t {
            t if t < 0.5 => 1e5,
            t if t < 2.5 => 3e5,
            t if t < 5.0 => 1e5,
            _ => 0.0,
        }),
        (DeviceParts::ClosedChamber, "chamber_shut_later") => (times(5.0), |_| 3e5),
        (DeviceParts::ClosedChamber, "chamber_cooling") => (times(30.0), |_| 3e5),
        (DeviceParts::ClosedChamber, _) => (times(300.0), |_| 3e5),
        _ => (times(6.0), |_| 0.0),
    };
    // To and fro at rising speeds.
    let motion = (parts == DeviceParts::DrivenSlide).then(|| {
        const SWING: f64 = 0.02;
        let phase = |t: f64| 0.5 * std::f64::consts::PI * t * t / 3.0;
        let rate = |t: f64| std::f64::consts::PI * t / 3.0;
        Arc::new(MeasuredMotion {
            stroke: time
                .iter()
                .map(|t| SWING * (1.0 - phase(*t).cos()))
                .collect(),
            speed: (time.iter())
                .map(|t| SWING * rate(*t) * phase(*t).sin())
                .collect(),
            acceleration: (time.iter())
                .map(|t| {
                    let swing = rate(*t).powi(2) * phase(*t).cos();
                    SWING * (swing + std::f64::consts::PI / 3.0 * phase(*t).sin())
                })
                .collect(),
        })
    });
    PlantInputs {
        set_pressure: time.iter().map(|t| set(*t)).collect(),
        extends: vec![true; time.len()],
        surface: vec![f64::NAN; time.len()],
        cell: None,
        motion,
        time,
        initial: InitialState::AtRest,
        place: 0,
    }
}

/// The run of a part on the inputs that show an effect, with the effect or without.
fn run_part(nominal: &PlantParameters, effect: &Effect, has: bool) -> Signals {
    let inputs = inputs_of(nominal.parts, effect.name);
    let mut plant = nominal.clone();
    if effect.name == "chamber_shut_later" {
        // On a chamber that holds nothing would show it.
        plant.links.leak.proportional = 0.1;
    }
    if has {
        let sizes = sizes(effect, &plant);
        for (parameter, value) in effect.parameters(&plant).iter().zip(sizes) {
            parameter.quantity.set(&mut plant, value);
        }
    }
    let trajectory = simulate(&plant, &inputs);
    let (channel, title, axis, unit, factor) = match nominal.parts {
        DeviceParts::ClosedChamber => (
            Channel::RegulatorPressure,
            "Chamber, read",
            "pressure",
            GAUGE,
            1e-5,
        ),
        DeviceParts::Regulator => (
            Channel::RegulatorPressure,
            "Regulator, read",
            "pressure",
            GAUGE,
            1e-5,
        ),
        _ => (Channel::Force, "Drive, read", "force", "N", 1.0),
    };
    let scaled = |values: &[f64], factor: f64| values.iter().map(|value| factor * value).collect();
    let mut signals = vec![Signal {
        key: "read",
        title: title.to_owned(),
        axis,
        unit,
        values: scaled(&trajectory.readings[channel as usize], factor),
    }];
    if let Some(motion) = &inputs.motion {
        signals.push(Signal {
            key: "speed",
            title: "Speed".to_owned(),
            axis: "speed",
            unit: "mm/s",
            values: scaled(&motion.speed, 1e3),
        });
    }
    Signals {
        signals,
        set: match nominal.parts {
            DeviceParts::Regulator => inputs.set_pressure.iter().map(|p| 1e-5 * p).collect(),
            _ => Vec::new(),
        },
        time: inputs.time,
    }
}
