//! What a fleet's recordings say together: which effects appear where and since when, what drifts, which device is unlike the others, what could not be read.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::diagnosed::{Diagnosed, NumberFound, Started};
use super::{Change, ChangeKind, Layout, change, date_of_day, trend};
use crate::diagnosis::answer::words::display_name;
use crate::quantity::display_name::number;
use crate::quantity::{counted, listed};
use crate::recording::provenance::SourceFile;
use crate::stats::{NORMAL_MAD, median};

/// Recordings in which an effect must be found to be one of the device; of few recordings all.
const SEEN: usize = 3;
/// Probability at which all numbers of a fleet that do not change give an alarm, one or more [1].
const ALARM: f64 = 0.05;
/// The least probability that a series can show [1].
const LEAST: f64 = 1.0 / 2000.0;
/// Last recordings by which devices are compared, and devices at least.
const LATELY: usize = 7;
const ALIKE: usize = 4;
/// Spreads of the others by which a device is unlike them.
const UNLIKE: f64 = 6.0;

/// A recording with what it came to.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Its device.
    pub device: String,
    /// Its name, by its date.
    pub name: String,
    /// Its day [d].
    pub day: f64,
    /// Name of its task.
    pub id: String,
    /// What it came to.
    pub result: Diagnosed,
    /// Its numbers by the effects that its device has; its own where it has these.
    pub followed: Option<Diagnosed>,
}

impl Recording {
    fn numbers(&self) -> &Diagnosed {
        self.followed.as_ref().unwrap_or(&self.result)
    }
}

/// What a device has had for days.
pub struct Persistent {
    /// Its effects, with the values of the first recording that shows them: later ones change nothing of earlier fits.
    pub effects: Vec<Started>,
    /// Tasks whose recordings were explained otherwise.
    others: BTreeSet<String>,
}

impl Persistent {
    /// Whether the task of a name did not have these effects.
    pub fn lacks(&self, id: &str) -> bool {
        self.others.contains(id)
    }
}

/// Devices with what they have had for days: found in at least three recordings, and in half of those from the first on.
pub fn persistent(all: &[Recording]) -> BTreeMap<String, Persistent> {
    let mut devices: BTreeMap<String, Vec<&Recording>> = BTreeMap::new();
    for recording in all.iter().filter(|recording| recording.result.code == 0) {
        devices
            .entry(recording.device.clone())
            .or_default()
            .push(recording);
    }
    let of = |recordings: &Vec<&Recording>| {
        let mut effects: Vec<Started> = Vec::new();
        for (place, recording) in recordings.iter().enumerate() {
            for started in &recording.result.state {
                if effects.iter().any(|known| known.name == started.name) {
                    continue;
                }
                let has = |r: &&&Recording| r.result.state.iter().any(|s| s.name == started.name);
                let later = &recordings[place..];
                let seen = later.iter().filter(has).count();
                if seen >= SEEN.min(recordings.len()) && 2 * seen >= later.len() {
                    effects.push(started.clone());
                }
            }
        }
        let names: BTreeSet<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
        let otherwise = |recording: &&&Recording| {
            let own = recording
                .result
                .effects
                .iter()
                .map(|(name, _)| name.as_str());
            own.collect::<BTreeSet<&str>>() != names
        };
        let others = recordings
            .iter()
            .filter(otherwise)
            .map(|r| r.id.clone())
            .collect();
        Persistent { effects, others }
    };
    devices
        .iter()
        .map(|(name, recordings)| (name.clone(), of(recordings)))
        .collect()
}

/// A fleet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Version of this form.
    pub schema: u32,
    /// Number of recordings.
    pub recordings: usize,
    /// Recordings that took a search.
    pub searched: usize,
    /// Devices with a recording that could be read.
    pub devices: Vec<DeviceFound>,
    /// Recordings that could not be read, and what was passed over: where, and why.
    pub unread: Vec<(String, String)>,
    /// Devices that are unlike the others, and in what.
    pub unlike: Vec<(String, String)>,
    /// Who diagnosed them.
    pub program: String,
    /// Files that all diagnoses read.
    pub files: Vec<SourceFile>,
}

/// A device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeviceFound {
    /// Its name.
    pub name: String,
    /// Number of its recordings.
    pub recordings: usize,
    /// Dates of its first and last recording.
    pub first: String,
    /// See `first`.
    pub last: String,
    /// Effects that it has.
    pub effects: Vec<EffectFound>,
    /// Effects that single recordings showed, and in how many: no alarm.
    pub single: Vec<(String, usize)>,
    /// Numbers that changed, of effects and of nominal values with a tolerance.
    pub changed: Vec<NumberChanged>,
    /// All numbers over the days.
    pub series: Vec<NumberSeries>,
}

/// An effect of a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectFound {
    /// Its name.
    pub name: String,
    /// Recordings in which it was found, of those that could be read.
    pub seen: usize,
    /// See `seen`.
    pub of: usize,
    /// Date of the first recording in which it was found.
    pub first_seen: String,
    /// Since when it is there, by its numbers over the days; none where it is there from the first recording on.
    pub since: Option<Since>,
}

/// When something began.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Since {
    /// `step` or `growth`.
    pub kind: String,
    /// When.
    pub date: String,
    /// Dates between which it began, at 95 %.
    pub between: [String; 2],
    /// Probability that chance shows as much [1].
    pub probability: f64,
}

/// A number that changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NumberChanged {
    /// Its effect; empty where it is a nominal value.
    pub effect: String,
    /// Its name, with its unit.
    pub number: String,
    /// When.
    pub since: Since,
    /// Before, and at the end, in the number's unit.
    pub before: f64,
    /// See `before`.
    pub after: f64,
    /// Trend over all days, in its unit a day, with its interval at 95 %.
    pub per_day: Option<[f64; 3]>,
}

/// A number over the days.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NumberSeries {
    /// Its effect; empty where it is a nominal value.
    pub effect: String,
    /// Its name, with its unit.
    pub number: String,
    /// Days of the recordings [d].
    pub days: Vec<f64>,
    /// Its values on them.
    pub values: Vec<f64>,
}

impl Since {
    fn of(change: &Change) -> Self {
        let kind = match change.kind {
            ChangeKind::Step => "step",
            ChangeKind::Growth => "growth",
        };
        Self {
            kind: kind.to_owned(),
            date: date_of_day(change.day),
            between: change.interval.map(date_of_day),
            probability: change.probability,
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        let what = match self.kind.as_str() {
            "growth" => "grows since",
            _ => "there since",
        };
        let [first, last] = &self.between;
        match first == last {
            true => format!("{what} {}", self.date),
            false => format!("{what} {} ({first} to {last})", self.date),
        }
    }
}

impl Found {
    /// What the recordings say, which a program of this name diagnosed with these files.
    pub fn of(
        recordings: &[Recording],
        layout: &Layout,
        (program, files): (&str, &[SourceFile]),
    ) -> Self {
        let of = |name: &str| -> Vec<&Recording> {
            let own = recordings.iter().filter(|r| r.device == name);
            own.filter(|recording| recording.result.code == 0).collect()
        };
        let names: Vec<&str> = layout
            .devices
            .iter()
            .map(|device| device.name.as_str())
            .collect();
        let series: Vec<Vec<NumberSeries>> =
            names.iter().map(|name| all_series(&of(name))).collect();
        let tested: usize = series.iter().map(Vec::len).sum();
        let alarm = (ALARM / tested.max(1) as f64).max(LEAST);
        let devices = names.iter().zip(series);
        let devices: Vec<DeviceFound> = devices
            .filter(|(name, _)| !of(name).is_empty())
            .map(|(name, series)| device(name, &of(name), series, alarm))
            .collect();
        let unread = recordings.iter().filter(|r| r.result.code != 0);
        let unread = unread.map(|r| (format!("{}/{}", r.device, r.name), r.result.reason.clone()));
        let passed = layout.passed_over.iter();
        let passed = passed.map(|(path, why)| (path.display().to_string(), why.clone()));
        Self {
            schema: 1,
            recordings: recordings.len(),
            searched: recordings.iter().filter(|r| r.result.searched).count(),
            unlike: unlike(&devices),
            devices,
            unread: unread.chain(passed).collect(),
            program: program.to_owned(),
            files: files.to_vec(),
        }
    }

    /// Whether anything was found.
    pub fn verdict(&self) -> String {
        let with = |d: &&DeviceFound| !d.effects.is_empty() || !d.changed.is_empty();
        let found: Vec<String> = (self.devices.iter().filter(with))
            .map(|device| device.name.clone())
            .collect();
        let (count, of) = (found.len(), counted(self.devices.len(), "device"));
        match count {
            0 => format!("Nothing was found in {of}."),
            _ => format!(
                "Something was found in {count} of {of}: {}.",
                listed(&found)
            ),
        }
    }
}

impl DeviceFound {
    /// What there is to tell of it, a line each.
    pub fn lines(&self) -> Vec<String> {
        let effects = self.effects.iter().map(|effect| {
            let since = match &effect.since {
                Some(since) => since.words(),
                None if effect.first_seen == self.first => {
                    "there from the first recording on".to_owned()
                }
                None => format!("first seen {}", effect.first_seen),
            };
            format!(
                "{}: {since}; found in {} of {} recordings",
                words(&effect.name),
                effect.seen,
                effect.of
            )
        });
        let changed = self.changed.iter().map(|changed| {
            let (name, unit, factor) = display_name(&changed.number);
            let of = match changed.effect.as_str() {
                "" => String::new(),
                effect => format!(" of {}", words(effect)),
            };
            format!(
                "{name}{of}: {} to {} {unit}, {}",
                number(factor * changed.before),
                number(factor * changed.after),
                changed.since.words()
            )
        });
        effects.chain(changed).collect()
    }
}

/// An effect's name in words.
pub fn words(effect: &str) -> String {
    effect.replace('_', " ")
}

/// Numbers of a device over the days: the first ones of its effects, and all nominal values with a tolerance.
fn all_series(recordings: &[&Recording]) -> Vec<NumberSeries> {
    let mut found: BTreeMap<(String, String), (Vec<f64>, Vec<f64>)> = BTreeMap::new();
    for recording in recordings {
        let result = recording.numbers();
        let effects = result.effects.iter();
        let effects =
            effects.filter_map(|(effect, numbers)| Some((effect.as_str(), numbers.first()?)));
        let tolerated = result.tolerated.iter().map(|number| ("", number));
        for (effect, NumberFound { name, value, .. }) in effects.chain(tolerated) {
            let own = found.entry((effect.to_owned(), name.clone())).or_default();
            own.0.push(recording.day);
            own.1.push(*value);
        }
    }
    let series = found
        .into_iter()
        .map(|((effect, number), (days, values))| NumberSeries {
            effect,
            number,
            days,
            values,
        });
    // What single recordings show has no course.
    series
        .filter(|series| 2 * series.days.len() > recordings.len())
        .collect()
}

fn device(
    name: &str,
    recordings: &[&Recording],
    series: Vec<NumberSeries>,
    alarm: f64,
) -> DeviceFound {
    let date =
        |recording: Option<&&Recording>| recording.map_or(String::new(), |r| date_of_day(r.day));
    let changes: Vec<Option<Change>> = (series.iter().enumerate())
        .map(|(place, series)| change(&series.days, &series.values, place as u64))
        .map(|change| change.filter(|change| change.probability <= alarm))
        .collect();
    let has = |recording: &Recording, effect: &str| {
        recording
            .result
            .effects
            .iter()
            .any(|(name, _)| name == effect)
    };
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in recordings
        .iter()
        .flat_map(|recording| &recording.result.effects)
    {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let (mut effects, mut single) = (Vec::new(), Vec::new());
    for effect in names {
        let seen = recordings.iter().filter(|r| has(r, effect)).count();
        let first = recordings.iter().position(|r| has(r, effect)).unwrap_or(0);
        let later = recordings.len() - first;
        if seen < SEEN.min(recordings.len()) || 2 * seen < later {
            single.push((effect.to_owned(), seen));
            continue;
        }
        let own = series.iter().position(|series| series.effect == effect);
        effects.push(EffectFound {
            name: effect.to_owned(),
            seen,
            of: recordings.len(),
            first_seen: date(recordings.get(first)),
            since: own.and_then(|own| changes[own].as_ref().map(Since::of)),
        });
    }
    let changed = series.iter().zip(&changes).filter_map(|(series, change)| {
        let change = change.as_ref()?;
        let trend = trend(&series.days, &series.values);
        Some(NumberChanged {
            effect: series.effect.clone(),
            number: series.number.clone(),
            since: Since::of(change),
            before: change.before,
            after: change.after,
            per_day: trend.map(|t| [t.slope, t.interval[0], t.interval[1]]),
        })
    });
    DeviceFound {
        name: name.to_owned(),
        recordings: recordings.len(),
        first: date(recordings.first()),
        last: date(recordings.last()),
        effects,
        single,
        changed: changed.collect(),
        series,
    }
}

/// Devices whose numbers lately lie far from those of the others, or that alone have an effect.
fn unlike(devices: &[DeviceFound]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    if devices.len() < ALIKE {
        return found;
    }
    for device in devices {
        for effect in &device.effects {
            let has = |other: &&DeviceFound| other.effects.iter().any(|e| e.name == effect.name);
            if devices.iter().filter(has).count() == 1 {
                let what = format!("it alone has {}", words(&effect.name));
                found.push((device.name.clone(), what));
            }
        }
        for series in device
            .series
            .iter()
            .filter(|series| series.effect.is_empty())
        {
            let lately = |device: &DeviceFound| {
                let own = device
                    .series
                    .iter()
                    .find(|s| s.effect.is_empty() && s.number == series.number)?;
                let last = &own.values[own.values.len().saturating_sub(LATELY)..];
                let middle = median(last.iter().copied())?;
                let off: Vec<f64> = last.iter().map(|value| (value - middle).abs()).collect();
                Some((middle, NORMAL_MAD * median(off)?))
            };
            let others = devices.iter().filter(|other| other.name != device.name);
            let others: Vec<(f64, f64)> = others.filter_map(lately).collect();
            let Some((own, _)) = lately(device).filter(|_| others.len() + 1 >= ALIKE) else {
                continue;
            };
            let middles: Vec<f64> = others.iter().map(|other| other.0).collect();
            let middle = median(middles.iter().copied()).unwrap_or(own);
            let off: Vec<f64> = middles.iter().map(|value| (value - middle).abs()).collect();
            let scatter: Vec<f64> = others.iter().map(|other| other.1).collect();
            let spread = NORMAL_MAD * median(off).unwrap_or(0.0);
            let spread = spread.max(median(scatter).unwrap_or(0.0));
            if spread > 0.0 && (own - middle).abs() > UNLIKE * spread {
                let (name, unit, factor) = display_name(&series.number);
                let [own, middle] = [own, middle].map(|value| number(factor * value));
                let what = format!("{name} {own} {unit}, the others {middle}");
                found.push((device.name.clone(), what));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests;
