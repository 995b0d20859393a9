//! The files of an experiment: inputs as a table, a bench that carries them out, next.json.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::super::error::AppError;
use super::super::files::REPORT;
use super::proposal::Proposal;
use crate::diagnosis::experiment::programme::HOLD;
use crate::recording::csv::columns_text;

pub(super) const INPUTS: &str = "inputs.csv";
pub(super) const BENCH: &str = "bench.toml";
/// The best explanation, which the bench takes as its device.
pub(super) const DEVICE: &str = "device.toml";
/// The best explanation as a recorded cell.
pub(super) const CELL: &str = "cell.toml";
pub(super) const INSTRUCTIONS: &str = "instructions.txt";
pub(super) const EXPECTED: &str = "expected.svg";
pub(super) const NEXT: &str = "next.json";
/// All of them.
pub(super) const NAMES: [&str; 8] = [
    INPUTS,
    BENCH,
    DEVICE,
    CELL,
    INSTRUCTIONS,
    EXPECTED,
    REPORT,
    NEXT,
];

/// A column of the inputs as a recording has it, and by how much a recording may differ there at least.
pub(super) struct InputColumn {
    pub name: String,
    pub values: Vec<f64>,
    pub slack: f64,
}

/// Columns of the inputs.
pub(super) fn columns(proposal: &Proposal) -> Vec<InputColumn> {
    let column = |name: &str, values: &[f64], slack| InputColumn {
        name: name.to_owned(),
        values: values.to_vec(),
        slack,
    };
    let inputs = &proposal.inputs;
    let pressure = column("set_pressure_pa", &inputs.set_pressure, 100.0);
    let commands = proposal.chosen.programme.arm_commands(&proposal.limits);
    if let Some(commands) = commands {
        let joint = |(place, values): (usize, &Vec<f64>)| {
            column(&format!("joint_{}_command_rad", place + 1), values, 1e-3)
        };
        let path = column("path_m", &commands.path, 1e-3);
        let joints = commands.joints.iter().enumerate().map(joint);
        return [path].into_iter().chain(joints).chain([pressure]).collect();
    }
    let valve: Vec<f64> = valve(&inputs.extends);
    vec![
        pressure,
        column("solenoid", &valve, 0.01),
        column("surface_m", &inputs.surface, 2e-4),
    ]
}

/// Whether a valve extends, as numbers.
pub(super) fn valve(extends: &[bool]) -> Vec<f64> {
    extends.iter().map(|e| f64::from(u8::from(*e))).collect()
}

/// Inputs with their times.
pub(super) fn inputs(proposal: &Proposal) -> Result<String, AppError> {
    // A clock's digits, not those of a sum.
    let time = proposal.inputs.time.iter();
    let time: Vec<f64> = time.map(|t| (t * 1e9).round() / 1e9).collect();
    let columns = columns(proposal);
    let columns: Vec<(&str, &[f64])> = (columns.iter())
        .map(|own| (own.name.as_str(), own.values.as_slice()))
        .collect();
    Ok(columns_text(&time, &columns)?)
}

/// A bench that carries the experiment out with the best explanation as its device.
pub(super) fn bench(proposal: &Proposal, case: &str) -> String {
    let programme = &proposal.chosen.programme;
    let plain = |letter: &char| letter.is_alphanumeric() || " _-.".contains(*letter);
    let name: String = case.chars().filter(plain).collect();
    let commands = programme.commands(&proposal.limits);
    let mut text = format!(
        "# Written by idc next: the experiment on a bench, its device the best explanation so far.\nschema = 2\nkind = \"bench\"\ntitle = \"Next experiment of {name}\"\n\n[device]\nmodel = \"{DEVICE}\"\n\n[bench]\nduration_s = {}\n",
        commands.len() as f64 * HOLD
    );
    // Writing into a text cannot fail.
    let _ = match programme.surface() {
        None => write!(text, "\n[load]\nkind = \"free\"\n"),
        Some(own) if own.peak_to_peak < 1e-6 => write!(
            text,
            "\n[load]\nkind = \"load_cell\"\nposition_mm = {:.4}\n",
            own.position * 1e3
        ),
        Some(own) => write!(
            text,
            "\n[load]\nkind = \"surface\"\nposition_mm = {:.4}\npeak_to_peak_mm = {:.4}\nfrequency_hz = {:.4}\nstart_s = {:.3}\n",
            own.position * 1e3,
            own.peak_to_peak * 1e3,
            own.frequency,
            own.start
        ),
    };
    // With the first sample of the inputs that holds it: between two of them a reversal would come 2 ms early, which a fast slide shows.
    let step = proposal.limits.step;
    let at = |index: usize| {
        let sample = (index as f64 * HOLD / step - 1e-6).ceil();
        (sample * step * 1e6).round() / 1e6
    };
    let mut last = None;
    for (index, (pressure, _)) in commands.iter().enumerate() {
        if last != Some(*pressure) {
            last = Some(*pressure);
            let _ = write!(
                text,
                "\n[[command]]\nat_s = {}\nset_pressure_bar_gauge = {:.5}\n",
                at(index),
                pressure * 1e-5
            );
        }
    }
    let mut extended = true;
    for (index, (_, extends)) in commands.iter().enumerate() {
        if *extends != extended {
            extended = *extends;
            let position = if *extends { "extend" } else { "retract" };
            let _ = write!(
                text,
                "\n[[valve]]\nat_s = {}\nposition = \"{position}\"\n",
                at(index)
            );
        }
    }
    text
}

/// next.json.
pub(super) fn json(proposal: &Proposal) -> Value {
    let Proposal {
        open,
        none_of_these,
        chosen,
        ..
    } = proposal;
    let share = chosen.extremes.torque_share;
    let explanations: Vec<Value> = (open.iter().zip(&chosen.expected.odds))
        .map(|(own, odds)| {
            let then = odds
                .iter()
                .zip(open)
                .map(|(p, other)| json!({ "effects": other.name, "probability": round(*p) }));
            json!({
                "effects": own.name,
                "probability": round(own.probability),
                "expected_if_true": then.collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({
        "duration_s": chosen.programme.duration(),
        "explanations": explanations,
        "none_of_these": round(*none_of_these),
        "expected_probability_if_one_of_these": proposal.expected_probability().map(round),
        "information_on_which_nat": round(chosen.expected.which),
        "information_on_laws_beyond_nat": round(chosen.beyond),
        "information_on_how_much_nat": round(chosen.expected.how_much),
        "largest_force_n": (chosen.extremes.force * 10.0).round() / 10.0,
        "largest_stroke_m": (chosen.extremes.stroke * 1e4).round() / 1e4,
        "largest_torque_share_percent": (share > 0.0).then(|| (share * 1e3).round() / 10.0),
        "instructions": chosen.programme.instructions(&proposal.limits),
        "left_open": proposal.left_open(),
    })
}

fn round(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
