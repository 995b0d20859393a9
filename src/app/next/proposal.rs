//! An experiment for what a diagnosis leaves open, within what is allowed.

use std::time::Duration;

use clap::{Args, ValueEnum};

use super::super::error::AppError;
use super::super::progress::StagedLine;
use super::super::terminal::say_aside;
use super::error::NextError;
use crate::case::{Case, Diagnosed, diagnose};
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::experiment::choice::{ChoiceSettings, Chosen, choose};
use crate::diagnosis::experiment::information::{Open, Sensors};
use crate::diagnosis::experiment::inseparable::{Inseparable, inseparable};
use crate::diagnosis::experiment::limits::{Limits, Movable};
use crate::diagnosis::search::progress::Progress;
use crate::diagnosis::settings::Settings;
use crate::scenario::rig_file::RigFile;

/// What may be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum May {
    /// The set pressure.
    #[value(name = "set_pressure")]
    SetPressure,
    /// The 5/2 valve.
    Solenoid,
    /// The surface, and whether there is one.
    Surface,
}

/// What an experiment may be.
#[derive(Debug, Args)]
pub(super) struct Allowed {
    /// Longest recording.
    #[arg(long, value_name = "TIME", default_value = "15s", value_parser = super::super::diagnose::duration)]
    time: Duration,
    /// What may be moved [default: all].
    #[arg(long, value_delimiter = ',', value_name = "INPUTS")]
    may: Vec<May>,
    /// Cost of preparing a recording, as seconds of recording.
    #[arg(long, value_name = "SECONDS", default_value_t = 15.0, value_parser = seconds)]
    cost: f64,
    /// Programmes that are looked at.
    #[arg(long, value_name = "COUNT", default_value_t = 240, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    programmes: u32,
    /// Seed of what is drawn.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Print on stderr what the diagnosis tries, and what each explanation would cost.
    #[arg(long, conflicts_with = "quiet")]
    pub verbose: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|value| (0.0..=1e5).contains(value));
    value.ok_or_else(|| "expected 0 to 100000 seconds".to_owned())
}

impl Allowed {
    fn movable(&self) -> Movable {
        let may = |input: May| self.may.is_empty() || self.may.contains(&input);
        Movable {
            set_pressure: may(May::SetPressure),
            solenoid: may(May::Solenoid),
            surface: may(May::Surface),
        }
    }

    fn settings(&self, seed: u64) -> ChoiceSettings {
        ChoiceSettings {
            programmes: self.programmes as usize,
            seed,
            preparation: self.cost,
        }
    }
}

/// An experiment for what a diagnosis leaves open.
pub(super) struct Proposal {
    pub open: Vec<Open>,
    /// Probability that none of them holds [1].
    pub none_of_these: f64,
    pub sensors: Sensors,
    pub limits: Limits,
    pub chosen: Chosen,
    /// Pairs of explanations that it leaves open.
    pub inseparable: Vec<Inseparable>,
}

impl Proposal {
    /// Of a diagnosis.
    pub(super) fn of(
        case: &Case,
        diagnosis: &Diagnosis,
        (allowed, seed, force): (&Allowed, u64, Option<f64>),
        observer: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, AppError> {
        let rig = bench_rig(case)?;
        let mut stated = rig.limits;
        stated.force = force.or(stated.force);
        let open = diagnosis.open();
        let sensors = diagnosis.sensors();
        let limits = Limits::new(
            &diagnosis.evidence,
            &stated,
            allowed.movable(),
            allowed.time.as_secs_f64(),
        )
        .map_err(NextError::Limits)?;
        let settings = allowed.settings(seed);
        let chosen =
            choose(&open, &sensors, &limits, &settings, observer).map_err(NextError::Limits)?;
        let inputs = chosen.programme.inputs(&limits);
        let odds = &chosen.expected.odds;
        Ok(Self {
            none_of_these: diagnosis.none_of_these(),
            inseparable: inseparable(&open, (&sensors, odds), &inputs),
            open,
            sensors,
            limits,
            chosen,
        })
    }

    /// A sentence on each pair that it leaves open.
    pub(super) fn left_open(&self) -> Vec<String> {
        let words = |own: &Inseparable| {
            let [one, other] = own.places.map(|place| &self.open[place].name);
            let by = match own.sensor {
                Some(sensor) => format!("a sensor of {} would tell them apart", sensor.words()),
                None => "nor would a sensor of a channel that is missing, or of the pressure in a chamber".to_owned(),
            };
            format!("{one} and {other} would still be open after it; {by}.")
        };
        self.inseparable.iter().map(words).collect()
    }

    /// Probability that is expected of the true explanation afterwards, if it is one of these [1]; none where only one is open, which a recording may deny.
    pub(super) fn expected_probability(&self) -> Option<f64> {
        if self.open.len() < 2 {
            return None;
        }
        let own = self.open.iter().zip(&self.chosen.expected.odds).enumerate();
        let sum: f64 = self.open.iter().map(|own| own.probability).sum();
        let right = own.map(|(place, (open, odds))| open.probability * odds[place]);
        Some(right.sum::<f64>() / sum)
    }
}

/// The rig file of a bench.
pub(super) fn bench_rig(case: &Case) -> Result<&RigFile, NextError> {
    case.bench_rig().ok_or_else(|| NextError::NoBench {
        case: case.name.clone(),
    })
}

/// Diagnoses a case of a rig, with its progress.
pub(super) fn diagnosed(
    case: &Case,
    (silent, verbose): (bool, bool),
) -> Result<Diagnosed, AppError> {
    let line = StagedLine::new(&super::super::diagnose::stages::first(), silent || verbose);
    let mut stages = super::super::diagnose::stages::Stages::default();
    let settings = Settings {
        rivals: true,
        ..Settings::default()
    };
    let found = diagnose(case, &settings, &mut |now: &Progress<'_>| {
        if verbose {
            say_aside(&now.to_string());
        }
        let (words, share) = stages.shown(now);
        line.tell(words, share);
    });
    line.end();
    Ok(found?)
}
