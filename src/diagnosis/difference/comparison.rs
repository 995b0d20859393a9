//! Comparison for the eye: each recording as measured, by the nominal and by the improved model; and what each link lacks, against the variable that explains it best.
//!
//! Plain data: the pictures, the recording for the viewer and the page are made of it, and it is what stands in comparison.parquet and balance.parquet.

use super::links::{Link, left_by};
use super::regime::{TIME, regimes, values_of};
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::flange::Run;
use crate::diagnosis::recordings::clean::clean;
use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{CHANNELS, Channel, DeviceParts, PlantInputs, PlantParameters, simulate};

/// Variables that are of the air in the chambers.
const OF_AIR: [&str; 5] = [
    "chamber_pressure",
    "pressure_difference",
    "pressure_rate",
    "mass_flow",
    "set_pressure",
];

/// All of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// The recordings that were diagnosed from, then the one that was to be predicted.
    pub recordings: Vec<Compared>,
    /// Residual of each link.
    pub balances: Vec<Balance>,
}

/// A recording beside the models.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// File name.
    pub name: String,
    /// Whether it was kept from the fit.
    pub unseen: bool,
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Its channels, those that were measured or predicted.
    pub channels: Vec<ComparedChannel>,
}

/// A channel beside the models [SI], one value per sample; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedChannel {
    /// Its column.
    pub column: String,
    /// Reading, without what was set aside.
    pub measured: Vec<f64>,
    /// By the nominal model; of a contact flange the desired force.
    pub nominal: Vec<f64>,
    /// By the nominal model moved within its tolerances; all NaN where it cannot be simulated.
    pub tolerated: Vec<f64>,
    /// By the improved model; all NaN where it cannot be simulated.
    pub improved: Vec<f64>,
    /// By the improved model fitted to the other recordings; all NaN where there are none.
    pub left_out: Vec<f64>,
}

/// Channels of a recording.
type Channels = [Vec<f64>; CHANNELS.len()];

/// Residual of a link's balance, against the variable that explains it.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// `regulator`, `piston` or `contact`; of a part of the device `output`.
    pub link: String,
    /// The channel in whose unit it is lacking; force for piston and contact.
    pub channel: Channel,
    /// Name of the variable, as in [`super::regime::VARIABLES`].
    pub variable: String,
    /// Its values [SI], one per sample; NaN where it is not known.
    pub values: Vec<f64>,
    /// Residual of the nominal model, moved within its tolerances [SI]; NaN where it does not show.
    pub before: Vec<f64>,
    /// Residual of the improved model [SI].
    pub after: Vec<f64>,
}

/// A recording as it is simulated.
struct Simulated {
    /// By the nominal model, by it within its tolerances, by the improved one.
    models: [Channels; 3],
    /// By a fit to the other recordings, where there is one.
    left_out: Option<Channels>,
}

impl Diagnosis {
    /// The comparison, the improved model as its file says it.
    #[must_use]
    pub fn comparison(&self, case: &DiagnosisInput, improved: &PlantParameters) -> Comparison {
        let models = [&self.nominal, &self.baseline.plant, improved];
        let simulated = |inputs: &PlantInputs, left_out: Option<Channels>| Simulated {
            models: models.map(|plant| simulate(plant, inputs).readings),
            left_out,
        };
        let recordings = self.evidence.recordings.iter().enumerate();
        let fitted = recordings.map(|(index, measured)| {
            let inputs = &measured.inputs;
            let left_out = self.left_out_of(index);
            let shown = (measured.name.as_str(), false, inputs.time.as_slice());
            self.compared(
                shown,
                measured.readings.clone(),
                &simulated(inputs, left_out),
            )
        });
        let unseen = case.unseen.iter().map(|unseen| {
            let inputs = &unseen.recorded.inputs;
            let shown = (unseen.name.as_str(), true, inputs.time.as_slice());
            let measured = self.cleaned(case, unseen);
            self.compared(shown, measured, &simulated(inputs, None))
        });
        Comparison {
            recordings: fitted.chain(unseen).collect(),
            balances: self.balances(improved),
        }
    }

    /// A recording as it is predicted by a fit to the others.
    fn left_out_of(&self, recording: usize) -> Option<Channels> {
        let left = &self.ranked[0].left_out.as_ref()?.residuals[recording];
        let measured = &self.evidence.recordings[recording].readings;
        Some(std::array::from_fn(|channel| {
            let noise = self.evidence.noise[channel];
            let pairs = measured[channel].iter().zip(&left[channel]);
            pairs.map(|(m, sigmas)| m - noise * sigmas).collect()
        }))
    }

    fn cleaned(&self, case: &DiagnosisInput, unseen: &NamedRecording) -> Channels {
        let mut readings = unseen.recorded.readings.clone();
        if readings.iter().flatten().any(|value| value.is_finite()) {
            let time = &unseen.recorded.inputs.time;
            clean::<Device>(time, &mut readings, &case.noise, &self.nominal);
        }
        readings
    }

    fn compared(
        &self,
        (name, unseen, time): (&str, bool, &[f64]),
        measured: Channels,
        simulated: &Simulated,
    ) -> Compared {
        let [nominal, tolerated, improved] = &simulated.models;
        let output = self.nominal.parts.output();
        let empty = measured.iter().flatten().all(|value| value.is_nan());
        let own = |all: &Channels, channel: Channel| all[channel as usize].clone();
        let nothing = || vec![f64::NAN; time.len()];
        let channels = CHANNELS.into_iter();
        Compared {
            name: name.to_owned(),
            unseen,
            time: time.to_vec(),
            channels: channels
                .filter(|channel| output.is_none_or(|output| output == *channel))
                .filter(|channel| self.evidence.noise[*channel as usize].is_finite())
                .filter(|channel| {
                    empty || measured[*channel as usize].iter().any(|v| v.is_finite())
                })
                .map(|channel| ComparedChannel {
                    column: COLUMNS[channel as usize].to_owned(),
                    measured: own(&measured, channel),
                    nominal: own(nominal, channel),
                    tolerated: own(tolerated, channel),
                    improved: own(improved, channel),
                    left_out: (simulated.left_out.as_ref())
                        .map_or_else(nothing, |all| own(all, channel)),
                })
                .collect(),
        }
    }

    fn balances(&self, improved: &PlantParameters) -> Vec<Balance> {
        match self.nominal.parts.output() {
            Some(channel) => self.balance_of_output(channel).into_iter().collect(),
            None => self.balances_of_links(improved),
        }
    }

    /// Of a part of the device there is its output alone.
    fn balance_of_output(&self, channel: Channel) -> Option<Balance> {
        let of = |residuals: &[f64]| -> Vec<f64> {
            let own = self.by_channel(residuals);
            let own = own.filter(|(_, of, _)| *of == channel);
            own.flat_map(|(_, _, residuals)| residuals.to_vec())
                .collect()
        };
        let best = &self.best().fit.prediction;
        let before = of(&self.baseline.prediction.residuals);
        let explaining = regimes(&self.evidence, &best.plant, &best.trajectories, &before);
        // A slide that a motor drives has no air, whatever its numbers say.
        let airless = self.nominal.parts == DeviceParts::DrivenSlide;
        let mut known = explaining.iter().map(|regime| regime.variable);
        let known = known.find(|name| !airless || !OF_AIR.contains(name));
        let variable = known.unwrap_or(TIME);
        let values = values_of(variable, &self.evidence, &best.plant, &best.trajectories)?;
        let noise = self.evidence.noise[channel as usize];
        let after = of(&best.residuals);
        let shown = ("output", channel, variable);
        Some(in_unit(shown, noise, values, &before, &after))
    }

    fn balances_of_links(&self, improved: &PlantParameters) -> Vec<Balance> {
        let links = &self.baseline.links;
        if links.is_empty() {
            return Vec::new();
        }
        let held = self.evidence.predict(improved, true, None);
        let balance =
            |(link, regimes): &(super::links::LinkResidual, Vec<super::regime::Regime>)| {
                // A link that no variable tells of is shown over time, so that every number said of it is in the file.
                let variable = regimes.first().map_or(TIME, |regime| regime.variable);
                let values = values_of(variable, &self.evidence, improved, &held.trajectories)?;
                let after = left_by(link.link, &self.evidence, &held, &self.nominal);
                let channel = match link.link {
                    Link::Regulator => Channel::RegulatorPressure,
                    Link::Piston | Link::Contact => Channel::Force,
                };
                let shown = (link.link.name(), channel, variable);
                Some(in_unit(shown, link.unit, values, &link.sigmas, &after))
            };
        links.iter().filter_map(balance).collect()
    }
}

/// A balance in the unit of its channel.
fn in_unit(
    (link, channel, variable): (&str, Channel, &str),
    unit: f64,
    values: Vec<f64>,
    before: &[f64],
    after: &[f64],
) -> Balance {
    let of = |all: &[f64]| all.iter().map(|sigmas| unit * sigmas).collect();
    Balance {
        link: link.to_owned(),
        channel,
        variable: variable.to_owned(),
        values,
        before: of(before),
        after: of(after),
    }
}

/// Runs of a contact flange: what was measured beside what was desired and what is simulated, from a sample on, in the order of the runs.
#[must_use]
pub fn of_flange(
    runs: &[Run],
    unseen: Option<&Run>,
    simulated: &[Option<(usize, Vec<f64>)>],
) -> Comparison {
    let compared = |index: usize, run: &Run| {
        let mut improved = vec![f64::NAN; run.time.len()];
        if let Some(Some((first, force))) = simulated.get(index) {
            let part = improved.iter_mut().skip(*first);
            part.zip(force).for_each(|(to, from)| *to = *from);
        }
        Compared {
            name: run.name.clone(),
            unseen: index >= runs.len(),
            time: run.time.clone(),
            channels: vec![ComparedChannel {
                column: COLUMNS[Channel::Force as usize].to_owned(),
                measured: run.force.clone(),
                nominal: run.desired.clone(),
                tolerated: vec![f64::NAN; run.time.len()],
                improved,
                left_out: vec![f64::NAN; run.time.len()],
            }],
        }
    };
    let all = runs.iter().chain(unseen).enumerate();
    Comparison {
        recordings: all.map(|(index, run)| compared(index, run)).collect(),
        balances: Vec::new(),
    }
}
