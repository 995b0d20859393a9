//! What is to be looked at: each recording as measured, as believed and with what was found; and what each link lacks, against the variable that says when.
//!
//! Plain data: the pictures, the recording for the viewer and the page are made of it, and it is what stands in comparison.parquet and balance.parquet.

use super::case::{Case, NamedRecording};
use super::clean::clean;
use super::diagnose::Diagnosis;
use super::flange::Run;
use super::links::{Link, left_by};
use super::regime::{regimes, values_of};
use crate::plant::{CHANNELS, Chain, Channel, PlantParameters, simulate};

/// Points of a balance at most: a cloud of more is a blot.
const MOST_POINTS: usize = 4000;

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
    /// What each link lacks.
    pub balances: Vec<Balance>,
}

/// A recording beside the models.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// File name.
    pub name: String,
    /// Was it kept from the fit?
    pub unseen: bool,
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Its channels, those that were measured or predicted.
    pub channels: Vec<ComparedChannel>,
}

/// A channel beside the models [SI], one value per sample; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedChannel {
    /// The channel.
    pub channel: Channel,
    /// Reading, without what was set aside.
    pub measured: Vec<f64>,
    /// By the model as it was believed; of a contact flange the desired force.
    pub believed: Vec<f64>,
    /// By the improved model; all NaN where it cannot be simulated.
    pub improved: Vec<f64>,
}

/// What a link lacks of closing its balance, against the variable that says when.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// `regulator`, `piston` or `contact`; of a part of the device `output`.
    pub link: String,
    /// The channel in whose unit it is lacking; force for piston and contact.
    pub channel: Channel,
    /// Name of the variable, as in [`super::regime::VARIABLES`].
    pub variable: String,
    /// Its values [SI], one per point.
    pub values: Vec<f64>,
    /// What the believed model lacks, moved within its tolerances [SI].
    pub before: Vec<f64>,
    /// What the improved one lacks [SI].
    pub after: Vec<f64>,
}

impl Diagnosis {
    /// The comparison, the improved model as its file says it.
    #[must_use]
    pub fn comparison(&self, case: &Case, improved: &PlantParameters) -> Comparison {
        let fitted = self.evidence.recordings.iter().map(|measured| {
            let inputs = &measured.inputs;
            let believed = simulate(&self.believed, inputs).readings;
            let improved = simulate(improved, inputs).readings;
            self.compared(
                &measured.name,
                false,
                &inputs.time,
                [measured.readings.clone(), believed, improved],
            )
        });
        let unseen = case.unseen.iter().map(|unseen| {
            let inputs = &unseen.recorded.inputs;
            let believed = simulate(&self.believed, inputs).readings;
            let improved = simulate(improved, inputs).readings;
            self.compared(
                &unseen.name,
                true,
                &inputs.time,
                [self.cleaned(case, unseen), believed, improved],
            )
        });
        Comparison {
            recordings: fitted.chain(unseen).collect(),
            balances: self.balances(improved),
        }
    }

    fn cleaned(&self, case: &Case, unseen: &NamedRecording) -> [Vec<f64>; CHANNELS.len()] {
        let mut readings = unseen.recorded.readings.clone();
        if readings.iter().flatten().any(|value| value.is_finite()) {
            let mass = self.believed.device.moving_mass;
            clean(
                &unseen.recorded.inputs.time,
                &mut readings,
                &case.noise,
                mass,
            );
        }
        readings
    }

    fn compared(
        &self,
        name: &str,
        unseen: bool,
        time: &[f64],
        [measured, believed, improved]: [[Vec<f64>; CHANNELS.len()]; 3],
    ) -> Compared {
        let output = self.believed.chain.output();
        let empty = measured.iter().flatten().all(|value| value.is_nan());
        let together = measured.into_iter().zip(believed).zip(improved);
        let channels = CHANNELS.into_iter().zip(together);
        Compared {
            name: name.to_owned(),
            unseen,
            time: time.to_vec(),
            channels: channels
                .filter(|(channel, _)| output.is_none_or(|output| output == *channel))
                .filter(|(channel, _)| self.evidence.noise[*channel as usize].is_finite())
                .filter(|(_, ((m, _), _))| empty || m.iter().any(|value| value.is_finite()))
                .map(
                    |(channel, ((measured, believed), improved))| ComparedChannel {
                        channel,
                        measured,
                        believed,
                        improved,
                    },
                )
                .collect(),
        }
    }

    fn balances(&self, improved: &PlantParameters) -> Vec<Balance> {
        match self.believed.chain.output() {
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
        let telling = regimes(&self.evidence, &best.plant, &best.courses, &before);
        // A slide that a motor drives has no air, whatever its numbers say.
        let airless = self.believed.chain == Chain::DrivenSlide;
        let mut known = telling.iter().map(|regime| regime.variable);
        let variable = known.find(|name| !airless || !OF_AIR.contains(name))?;
        let values = values_of(variable, &self.evidence, &best.plant, &best.courses)?;
        let noise = self.evidence.noise[channel as usize];
        let after = of(&best.residuals);
        Some(thinned(
            ("output", channel, variable),
            noise,
            &values,
            &before,
            &after,
        ))
    }

    fn balances_of_links(&self, improved: &PlantParameters) -> Vec<Balance> {
        let links = &self.baseline.links;
        if links.is_empty() {
            return Vec::new();
        }
        let held = self.evidence.predict(improved, true, None);
        let balance =
            |(link, regimes): &(super::links::LinkResidual, Vec<super::regime::Regime>)| {
                let variable = regimes.first()?.variable;
                let values = values_of(variable, &self.evidence, improved, &held.courses)?;
                let after = left_by(link.link, &self.evidence, &held, &self.believed);
                let channel = match link.link {
                    Link::Regulator => Channel::RegulatorPressure,
                    Link::Piston | Link::Contact => Channel::Force,
                };
                let shown = (link.link.name(), channel, variable);
                Some(thinned(shown, link.unit, &values, &link.sigmas, &after))
            };
        links.iter().filter_map(balance).collect()
    }
}

/// A balance with so many points as can be looked at, evenly over the samples.
fn thinned(
    (link, channel, variable): (&str, Channel, &str),
    unit: f64,
    values: &[f64],
    before: &[f64],
    after: &[f64],
) -> Balance {
    let known = |i: &usize| values[*i].is_finite() && before[*i].is_finite();
    let kept: Vec<usize> = (0..values.len()).filter(known).collect();
    let stride = kept.len().div_ceil(MOST_POINTS).max(1);
    let kept: Vec<usize> = kept.into_iter().step_by(stride).collect();
    let of = |all: &[f64], factor: f64| kept.iter().map(|i| factor * all[*i]).collect();
    Balance {
        link: link.to_owned(),
        channel,
        variable: variable.to_owned(),
        values: of(values, 1.0),
        before: of(before, unit),
        after: of(after, unit),
    }
}

/// Runs of a contact flange: what was measured beside what was desired.
#[must_use]
pub fn of_flange(runs: &[Run], unseen: Option<&Run>) -> Comparison {
    let compared = |run: &Run, unseen: bool| Compared {
        name: run.name.clone(),
        unseen,
        time: run.time.clone(),
        channels: vec![ComparedChannel {
            channel: Channel::Force,
            measured: run.force.clone(),
            believed: run.desired.clone(),
            improved: vec![f64::NAN; run.time.len()],
        }],
    };
    let runs = runs.iter().map(|run| compared(run, false));
    Comparison {
        recordings: runs.chain(unseen.map(|run| compared(run, true))).collect(),
        balances: Vec::new(),
    }
}
