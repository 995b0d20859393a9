//! A run in which effects of an arm's drives, load and wrench sensor show: a scenario with an arm file that comes with the program, without noise.

use std::sync::OnceLock;

use super::{Shipped, Signal, Signals, put_down};
use crate::cell::Cell;
use crate::recorded_arm::vocabulary::{ARM_EFFECTS, ArmEffectName};
use crate::recording::{RecordedChannel, Recording, Unit};
use crate::run::{RunError, apply_effects, run_cell};
use crate::scenario::arm_file::ArmNoise;
use crate::scenario::{AnyScenario, EffectRequest, KeyValue, ScenarioTemplate};

static DRIVES: Shipped = Shipped {
    path: "scenarios/drives_and_wrench.toml",
    text: include_str!("../../scenarios/drives_and_wrench.toml"),
};
const ARM_FILE: (&str, &[u8]) = (
    "models/arm/arm10.toml",
    include_bytes!("../../models/arm/arm10.toml"),
);
/// Signals of a picture.
const SHOWN: usize = 2;

/// Effects that an arm file alone may hold: those that a cell has by the same name are left out.
pub fn arm_effects() -> impl Iterator<Item = &'static ArmEffectName> {
    ARM_EFFECTS.iter().filter(|effect| {
        EffectRequest::parse(effect.name).is_ok_and(|request| request.of_arm().is_some())
    })
}

/// The scenario, ready to be run.
pub struct ArmStage {
    template: ScenarioTemplate,
    unchanged: OnceLock<Signals>,
    /// Holds the template's files as long as it may be run.
    _folder: tempfile::TempDir,
}

impl ArmStage {
    /// Sets it up.
    ///
    /// # Errors
    /// The scenario's files cannot be put down or read.
    pub fn new() -> Result<Self, RunError> {
        let (folder, path) = put_down(&DRIVES, &[ARM_FILE])?;
        Ok(Self {
            template: ScenarioTemplate::read(&path)?,
            unchanged: OnceLock::new(),
            _folder: folder,
        })
    }

    /// Path of the scenario in the project.
    #[must_use]
    pub fn scenario(&self) -> &'static str {
        DRIVES.path
    }

    /// What a scenario gets by an effect of usual size: keys as [`KeyValue`] has them.
    ///
    /// # Errors
    /// The effect cannot be put in.
    pub fn edits(&self, effect: &ArmEffectName) -> Result<Vec<KeyValue>, RunError> {
        let asked = EffectRequest::parse(effect.name);
        let asked = asked.map_err(|reason| RunError::With { reason })?;
        apply_effects(&[asked], &self.template)
    }

    /// Readings without an effect and with one of usual size, those that it changes most.
    ///
    /// # Errors
    /// An effect that cannot be put in, or a run that cannot be recorded.
    pub fn runs(&self, effect: &ArmEffectName) -> Result<[Signals; 2], RunError> {
        let unchanged = match self.unchanged.get() {
            Some(unchanged) => unchanged,
            None => {
                let own = self.signals(&[])?;
                self.unchanged.get_or_init(|| own)
            }
        };
        let changed = self.signals(&self.edits(effect)?)?;
        let pairs = unchanged.signals.iter().zip(&changed.signals);
        let mut order: Vec<(usize, f64)> = pairs
            .map(|(one, other)| difference(&one.values, &other.values))
            .enumerate()
            .collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        order.truncate(SHOWN);
        order.sort_unstable_by_key(|(index, _)| *index);
        let of = |all: &Signals| Signals {
            time: all.time.clone(),
            signals: order.iter().map(|(i, _)| all.signals[*i].clone()).collect(),
            set: Vec::new(),
        };
        Ok([of(unchanged), of(&changed)])
    }

    fn signals(&self, edits: &[KeyValue]) -> Result<Signals, RunError> {
        let AnyScenario::Cell(mut cell) = self.template.with(edits)? else {
            unreachable!("the scenario is of a cell");
        };
        if let Some(file) = &mut cell.arm.recorded_arm {
            file.noise = without_noise(&file.noise);
        }
        let recording = run_cell(&Cell::new(*cell)?, &mut |_| ())?.recording;
        Ok(of_recording(&recording))
    }
}

fn without_noise(noise: &ArmNoise) -> ArmNoise {
    let none = |own: Option<f64>| own.map(|_| 0.0);
    ArmNoise {
        position: 0.0,
        drives: noise.drives.iter().copied().map(none).collect(),
        link: none(noise.link),
        force: none(noise.force),
        moment: none(noise.moment),
    }
}

/// Largest difference as a share of the range of both [1].
fn difference(one: &[f64], other: &[f64]) -> f64 {
    let all = || one.iter().chain(other).copied();
    let range = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
    let pairs = one.iter().zip(other);
    let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if range > 0.0 { most / range } else { 0.0 }
}

/// Currents and channels of the wrench sensor.
fn of_recording(recording: &Recording) -> Signals {
    let signal = |channel: &RecordedChannel| {
        let words = channel.quantity.replace('_', " ");
        let (title, key, axis) = match channel.unit {
            Unit::Ampere => (words, "current", "current"),
            unit if words.starts_with("wrench") => match unit {
                Unit::Newton => (words, "wrench", "force"),
                _ => (words, "wrench", "torque"),
            },
            _ => return None,
        };
        let mut letters = title.chars();
        let first = letters.next()?.to_uppercase();
        Some(Signal {
            key,
            title: first.chain(letters).collect(),
            axis,
            unit: channel.unit.symbol(),
            values: channel.values.clone(),
        })
    };
    Signals {
        time: recording.time().to_vec(),
        signals: recording.channels().iter().filter_map(signal).collect(),
        set: Vec::new(),
    }
}
