//! An experiment for what a diagnosis leaves open, within what is allowed.

use std::path::Path;
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
use crate::diagnosis::experiment::inseparable::{FurtherSensor, Inseparable, inseparable};
use crate::diagnosis::experiment::limits::{Limits, Movable};
use crate::diagnosis::search::progress::Progress;
use crate::diagnosis::settings::Settings;
use crate::plant::{OperatingLimits, PlantInputs};
use crate::quantity::listed;
use crate::replay::LoadedCell;

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
    /// The arm of a cell, along the path of its recordings.
    #[value(name = "path")]
    Path,
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
    /// Programmes of three seconds that are looked at where six explanations are open; otherwise as
    /// many as take the same time.
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
            path: may(May::Path),
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
    /// What the recordings have been to, as a sentence.
    pub coverage: Option<String>,
    /// What the chosen one does, as the simulator takes it.
    pub inputs: PlantInputs,
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
        let mut stated = stated_limits(case)?;
        stated.force = force.or(stated.force);
        let open = diagnosis.open();
        let sensors = diagnosis.sensors();
        let limits = Limits::new(
            &diagnosis.evidence,
            &stated,
            allowed.movable(),
            (allowed.time.as_secs_f64(), case.arm_reach()),
        )
        .map_err(NextError::Limits)?;
        let settings = allowed.settings(seed);
        let chosen = choose(
            &open,
            (&sensors, &diagnosis.coverage),
            &limits,
            &settings,
            observer,
        )
        .map_err(NextError::Limits)?;
        let inputs = chosen.programme.inputs(&limits);
        let odds = &chosen.expected.odds;
        Ok(Self {
            none_of_these: diagnosis.none_of_these(),
            inseparable: inseparable(&open, (&sensors, odds), &inputs),
            coverage: diagnosis.coverage.words(),
            inputs,
            open,
            sensors,
            limits,
            chosen,
        })
    }

    /// A sentence on the explanations that it leaves open, for each sensor that would tell some of them apart.
    pub(super) fn left_open(&self) -> Vec<String> {
        // Two pairs are in one sentence where they share an explanation: of others nothing is said between them.
        let mut groups: Vec<(Option<FurtherSensor>, Vec<usize>)> = Vec::new();
        for Inseparable { places, sensor } in &self.inseparable {
            let is_joined = |(own, all): &(Option<FurtherSensor>, Vec<usize>)| {
                own == sensor && places.iter().any(|place| all.contains(place))
            };
            let (joined, apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_joined);
            let others = joined.into_iter().flat_map(|(_, all)| all);
            groups = apart;
            groups.push((*sensor, others.chain(*places).collect()));
        }
        let words = |(sensor, mut places): (Option<FurtherSensor>, Vec<usize>)| {
            places.sort_unstable();
            places.dedup();
            let names = places.iter().map(|place| self.open[*place].name.clone());
            let names = listed(&names.collect::<Vec<_>>());
            match sensor {
                Some(sensor) => format!(
                    "{names} would still be open after it; a sensor of {} would tell them apart.",
                    sensor.words()
                ),
                None => format!(
                    "{names} would still be open after it; nor would a sensor of a channel that is missing, or of the pressure in a chamber, tell them apart."
                ),
            }
        };
        groups.into_iter().map(words).collect()
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

/// Limits that the file of a bench or a cell states.
pub(super) fn stated_limits(case: &Case) -> Result<OperatingLimits, NextError> {
    let case_name = || case.name.clone();
    let stated = case.operating_limits();
    let stated = stated.ok_or_else(|| NextError::NoBench { case: case_name() })?;
    match case.cell().is_some() && case.arm_reach().is_none() {
        true => Err(NextError::NoCourse { case: case_name() }),
        false => Ok(stated),
    }
}

/// A case of a bench, or of a cell by its recordings alone.
pub(super) fn case_in(folder: &Path, cell: Option<&LoadedCell>) -> Result<Case, AppError> {
    Ok(match cell {
        Some(cell) => Case::of_cell(folder, cell, &[])?,
        None => Case::from_folder(folder)?,
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
