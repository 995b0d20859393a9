//! Variables of a unit: inputs, outputs, and the numbers of the rig's description as tunable parameters, by the rig that there is.

use crate::physics::gas_process::GasProcess;
use crate::plant::{ContactLaw, MOST_CONSTANTS, Number, PlantParameters, Quantity, registry};
use crate::recording::schema;
use crate::unit::{Unit, column_name};

/// What a variable is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Time.
    Independent,
    /// Set by the importer before each step.
    Input,
    /// What the unit computes.
    Output,
    /// A number of the rig, which may change between steps.
    Tunable,
    /// A number that counts at the start alone.
    Fixed,
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number, which changes smoothly within steps or not.
    Real {
        /// Whether it does.
        smooth: bool,
    },
    /// True or false.
    Boolean,
}

/// A variable.
#[derive(Debug, Clone)]
pub struct Variable {
    /// Its name, with its unit.
    pub name: String,
    /// Its meaning, in a sentence.
    pub meaning: String,
    /// What it is for.
    pub causality: Causality,
    /// Its type.
    pub kind: Kind,
    /// Symbol of its unit; none for a pure number.
    pub unit: Option<&'static str>,
    /// Value at the start [SI], a Boolean's 0 or 1; of what the importer may set.
    pub start: Option<f64>,
    /// Least and largest value; infinite where there is none.
    pub range: [f64; 2],
    /// What is behind it.
    pub(super) role: Role,
}

/// What is behind a variable.
#[derive(Debug, Clone, Copy)]
pub(super) enum Role {
    Time,
    Input(Input),
    Output(Output),
    Number(Quantity),
    StartStroke,
}

/// What an importer says before each step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Input {
    SetPressure,
    Valve,
    SurfacePosition,
    SurfaceSpeed,
    SurfaceAcceleration,
    OutsideForce,
    OutsideForceRate,
}

/// What a unit computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Output {
    ContactForce,
    DeviceForce,
    SealForce,
    Stroke,
    Speed,
    Acceleration,
    RegulatorPressure,
    FirstPressure,
    SecondPressure,
    MeasuredForce,
    MeasuredForceUnfiltered,
    MeasuredStroke,
    MeasuredAcceleration,
    MeasuredRegulatorPressure,
}

impl Output {
    /// How many there are.
    pub(super) const COUNT: usize = OUTPUTS.len();
}

/// All outputs in their order, by the signals of a recording that they are.
const OUTPUTS: [(Output, &str); 14] = [
    (Output::ContactForce, schema::CONTACT_FORCE),
    (Output::DeviceForce, schema::DEVICE_FORCE),
    (Output::SealForce, schema::SEAL_FORCE),
    (Output::Stroke, schema::STROKE),
    (Output::Speed, schema::STROKE_VELOCITY),
    (Output::Acceleration, schema::ACCELERATION),
    (Output::RegulatorPressure, schema::REGULATOR_PRESSURE),
    (Output::FirstPressure, schema::CHAMBER_1_PRESSURE),
    (Output::SecondPressure, schema::CHAMBER_2_PRESSURE),
    (Output::MeasuredForce, schema::MEASURED_FORCE),
    (
        Output::MeasuredForceUnfiltered,
        schema::MEASURED_FORCE_UNFILTERED,
    ),
    (Output::MeasuredStroke, schema::MEASURED_STROKE),
    (Output::MeasuredAcceleration, schema::MEASURED_ACCELERATION),
    (
        Output::MeasuredRegulatorPressure,
        schema::MEASURED_REGULATOR_PRESSURE,
    ),
];

/// Inputs as they are before the importer says anything.
#[derive(Debug, Clone, Copy)]
pub(super) struct Starts {
    /// Where the surface stands [m]; none where nothing is met.
    pub surface: Option<f64>,
    /// Whether the valve extends.
    pub extends: bool,
    /// Stroke at the start [m].
    pub stroke: f64,
}

impl Variable {
    fn real(name: String, meaning: &str, causality: Causality, role: Role) -> Self {
        let unit = match Unit::of_key(&name) {
            unit if unit.is_one() => None,
            unit => Some(unit.si),
        };
        Self {
            unit,
            name,
            meaning: sentence(meaning),
            causality,
            kind: Kind::Real { smooth: true },
            start: None,
            range: [f64::NEG_INFINITY, f64::INFINITY],
            role,
        }
    }

    /// Whether the importer may set it before the initialization.
    #[must_use]
    pub fn is_settable(&self) -> bool {
        self.start.is_some()
    }
}

/// With a capital and a full stop.
fn sentence(text: &str) -> String {
    let text = text.trim_end_matches('.');
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first
        .into_iter()
        .flatten()
        .chain(letters)
        .collect::<String>()
        + "."
}

/// Variables of a rig, each at its value reference.
pub(super) fn variables(plant: &PlantParameters, starts: &Starts) -> Vec<Variable> {
    let time = Variable::real(
        "time".to_owned(),
        "time",
        Causality::Independent,
        Role::Time,
    );
    let mut all = vec![Variable {
        unit: Some("s"),
        ..time
    }];
    all.extend(inputs(starts));
    all.extend(OUTPUTS.map(|(output, signal)| {
        let known = schema::definition(signal).expect("every output is a signal of the schema");
        let name = column_name(signal, known.unit);
        Variable::real(name, known.meaning, Causality::Output, Role::Output(output))
    }));
    all.push(Variable {
        start: Some(starts.stroke),
        range: [0.0, plant.device.full_stroke],
        ..Variable::real(
            "bench.start_stroke_m".to_owned(),
            "stroke at the start; at 0 the tool rests on the inner stop",
            Causality::Fixed,
            Role::StartStroke,
        )
    });
    all.extend(numbers(plant, starts.surface.is_some()));
    all
}

fn inputs(starts: &Starts) -> Vec<Variable> {
    let input = |name: &str, meaning: &str, input: Input, start: f64| Variable {
        start: Some(start),
        ..Variable::real(
            name.to_owned(),
            meaning,
            Causality::Input,
            Role::Input(input),
        )
    };
    let held = |variable: Variable| Variable {
        kind: Kind::Real { smooth: false },
        ..variable
    };
    let mut all = vec![
        held(input(
            "set_pressure_gauge_pa",
            "set pressure of the regulator, gauge, held over the step",
            Input::SetPressure,
            0.0,
        )),
        Variable {
            kind: Kind::Boolean,
            ..input(
                schema::VALVE_EXTENDS,
                "true while the 5/2 valve joins chamber 1 to the regulator, false while it joins chamber 2 to it, held over the step",
                Input::Valve,
                f64::from(u8::from(starts.extends)),
            )
        },
    ];
    if let Some(surface) = starts.surface {
        all.extend([
            input(
                "surface_position_m",
                "where the surface stands along the stroke at the start of the step",
                Input::SurfacePosition,
                surface,
            ),
            input(
                "surface_speed_m_per_s",
                "its speed along extension then; within the step it goes on by it",
                Input::SurfaceSpeed,
                0.0,
            ),
            input(
                "surface_acceleration_m_per_s2",
                "its acceleration along extension, held over the step",
                Input::SurfaceAcceleration,
                0.0,
            ),
        ]);
    }
    all.extend([
        input(
            "outside_force_n",
            "force on the slide along extension from outside, beside weight and contact, at the start of the step",
            Input::OutsideForce,
            0.0,
        ),
        input(
            "outside_force_rate_n_per_s",
            "its rate, held over the step",
            Input::OutsideForceRate,
            0.0,
        ),
    ]);
    all
}

/// Numbers of the description that act in a rig, in the order of the registry.
fn numbers(plant: &PlantParameters, meets: bool) -> Vec<Variable> {
    let own = registry::all().filter(|number| acts(number, plant, meets));
    let mut all: Vec<Variable> = own
        .map(|number| {
            number_variable(
                number.name.to_owned(),
                number.meaning,
                number.quantity(),
                plant,
            )
        })
        .collect();
    let coefficients = plant.latent.as_ref().map_or(0, |l| l.coefficients.len());
    for index in 0..coefficients {
        let quantity = registry::LATENT_COEFFICIENT.quantity().of(index);
        let name = format!("latent.coefficient[{}]", index + 1);
        all.push(number_variable(
            name,
            "coefficient of the model discrepancy, in the unit of the rig file",
            quantity,
            plant,
        ));
    }
    for (place, law) in plant.own.iter().enumerate() {
        for (index, constant) in law.text.constants.iter().enumerate() {
            let quantity = (registry::OWN_CONSTANT.quantity()).of(place * MOST_CONSTANTS + index);
            let name = format!("{}.{}", law.text.name, constant.name);
            let unit = constant.unit.unwrap_or("its own unit");
            let meaning = format!("constant of the law {} [{unit}]", law.text.name);
            all.push(Variable {
                unit: None,
                ..number_variable(name, &meaning, quantity, plant)
            });
        }
    }
    all
}

fn number_variable(
    name: String,
    meaning: &str,
    quantity: Quantity,
    plant: &PlantParameters,
) -> Variable {
    let value = quantity.get(plant);
    Variable {
        kind: Kind::Real { smooth: false },
        start: Some(value),
        range: quantity.number.range,
        ..Variable::real(name, meaning, Causality::Tunable, Role::Number(quantity))
    }
}

/// Whether a number of the registry acts in a rig, that meets something or nothing.
fn acts(number: &'static Number, plant: &PlantParameters, meets: bool) -> bool {
    let is = |others: &[&'static Number]| others.iter().any(|other| std::ptr::eq(*other, number));
    let of = |list: &[&'static Number]| list.iter().any(|one| std::ptr::eq(*one, number));
    let device = &plant.device;
    // A bench has no locked device and no tool that turns by itself; phases are of recordings.
    let none = [
        &registry::LOCK_STIFFNESS,
        &registry::SPINDLE_FREQUENCY,
        &registry::LAW_STIFFNESS,
        &registry::RUNOUT_PHASE,
        &registry::WAVINESS_PHASE,
    ];
    if is(&none) {
        return false;
    }
    if is(&[&registry::NATURAL_FREQUENCY, &registry::DAMPING_RATIO]) {
        return device.regulator.second_order.is_some();
    }
    let reservoir = [
        &registry::RESERVOIR_VOLUME,
        &registry::RESERVOIR_PRESSURE,
        &registry::COMPRESSOR_FLOW,
    ];
    if is(&reservoir) {
        return device.supply_reservoir.is_some();
    }
    if is(&[&registry::WALL_CONDUCTANCE]) {
        return matches!(device.gas_process, GasProcess::WallHeat { .. });
    }
    let hertz = matches!(plant.contact.law, ContactLaw::Hertz { .. });
    if is(&[&registry::CONTACT_STIFFNESS]) {
        return meets && !hertz;
    }
    if is(&[&registry::HERTZ_STIFFNESS]) {
        return meets && hertz;
    }
    let parts = [
        registry::CYLINDER,
        registry::AIR,
        registry::REGULATOR,
        registry::SENSORS,
    ];
    parts.into_iter().any(of) || (meets && of(registry::CONTACT))
}
