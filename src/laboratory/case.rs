//! A concealed case: a device, what is at work in it, its recordings and the sealed truth.

use std::collections::BTreeMap;

use super::CHANNELS;
use super::concealed::Concealed;
use super::conditions::{Conditions, IMPERFECTIONS};
use super::draw::{NominalRig, TOLERANCES, stream, toleranced};
use super::effects::{LabEffect, Scene, effect};
use super::law::Law;
use super::programme::Programme;
use super::rig::LaboratoryRig;
use super::sealed::{Known, SealedCase, SealedEffect, SealedInterval};
use super::sensors::{measured, step_of};
use super::shown::intervals;
use super::trajectory::{LaboratoryError, LaboratoryTrajectory, run};
use super::visibility::Eye;

/// Recipe of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Name.
    pub name: String,
    /// Seed of device, programmes and noise.
    pub seed: u64,
    /// Effects by name, each with its share of the largest that is plausible [1].
    pub effects: Vec<(&'static str, f64)>,
    /// A law that no list holds, beside them.
    pub law: Option<Law>,
    /// Length of each recording [s].
    pub duration: f64,
    /// Conditions under which it is recorded.
    pub conditions: Conditions,
}

/// A case.
#[derive(Debug, Clone, PartialEq)]
pub struct LaboratoryCase {
    /// The nominal device.
    pub nominal: NominalRig,
    /// Programmes carried out; the last one is to be predicted.
    pub programmes: Vec<Programme>,
    /// Readings in each, in the order of [`CHANNELS`].
    pub measured: Vec<[Vec<f64>; 4]>,
    /// The truth.
    pub sealed: SealedCase,
}

/// A device recorded once, as of many times.
#[derive(Debug, Clone, PartialEq)]
pub struct Session {
    /// The nominal device: that of the type.
    pub nominal: NominalRig,
    /// Programmes carried out.
    pub programmes: Vec<Programme>,
    /// Readings in each, in the order of [`CHANNELS`].
    pub measured: Vec<[Vec<f64>; 4]>,
}

/// The device without what is concealed in it, and with it.
struct Pair {
    bare: LaboratoryRig,
    real: LaboratoryRig,
}

impl Pair {
    /// Numbers of the rig that are off stand in the real one; without the effect they are nominal.
    fn new(nominal: &LaboratoryRig, drawn: LaboratoryRig, concealed: &Concealed) -> Self {
        type Place = fn(&mut LaboratoryRig) -> &mut f64;
        let (mut bare, mut real) = (drawn.clone(), drawn);
        let places: [(Option<f64>, Place); 6] = [
            (concealed.mass, |r| &mut r.mass),
            (concealed.dead_volume, |r| &mut r.dead_volume),
            (concealed.supply_orifice, |r| &mut r.supply_orifice),
            (concealed.exhaust_orifice, |r| &mut r.exhaust_orifice),
            (concealed.gain, |r| &mut r.gain),
            (concealed.contact_stiffness, |r| &mut r.contact_stiffness),
        ];
        let mut nominal = nominal.clone();
        for (value, place) in places {
            if let Some(value) = value {
                *place(&mut real) = value;
                *place(&mut bare) = *place(&mut nominal);
            }
        }
        Self { bare, real }
    }
}

/// Result of a recipe before anything is measured.
struct Setting {
    nominal: NominalRig,
    programmes: Vec<Programme>,
    pair: Pair,
    concealed: Concealed,
    effects: Vec<SealedEffect>,
    conditions: Conditions,
    seed: u64,
}

impl Setting {
    /// True trajectories of the first recordings.
    fn run(&self, count: usize) -> Result<Vec<LaboratoryTrajectory>, LaboratoryError> {
        let programmes = self.programmes[..count].iter().enumerate();
        programmes
            .map(|(index, programme)| {
                let concealed = self
                    .conditions
                    .in_recording(&self.concealed, self.seed, index);
                run(&self.pair.real, &concealed, programme)
            })
            .collect()
    }
}

impl Recipe {
    /// Makes the case.
    ///
    /// # Errors
    /// The integrator cannot go on.
    ///
    /// # Panics
    /// An effect that does not exist.
    pub fn make(&self) -> Result<LaboratoryCase, LaboratoryError> {
        let setting = self.setting()?;
        let real = setting.run(setting.programmes.len())?;
        let (mismatch, shows) = self.shown(&setting, &real)?;
        let Setting {
            nominal,
            programmes,
            pair,
            effects,
            ..
        } = setting;
        let sheet = nominal.rig.noise;
        let noise = sheet.map(|sheet| self.conditions.noise * sheet);
        let measured = self.measure(noise, &real, 0);
        let mut rig = pair.real;
        let names = TOLERANCES.iter().map(|(name, _)| (*name).to_owned());
        let values = toleranced(&mut rig).map(|value| *value);
        let channels = CHANNELS.iter().map(|name| (*name).to_owned());
        Ok(LaboratoryCase {
            sealed: SealedCase {
                case: self.name.clone(),
                also_there: self.also_there(&effects),
                effects,
                noise: channels.zip(noise).collect(),
                mismatch,
                true_parameters: names.zip(values).collect(),
                shows,
                seed: self.seed,
            },
            nominal,
            programmes,
            measured,
        })
    }

    /// A device of the type, by its number, recorded once more: with noise of its own, by the turn. What it has to be predicted is left out.
    ///
    /// # Errors
    /// The integrator cannot go on.
    ///
    /// # Panics
    /// An effect that does not exist.
    pub fn session(&self, device: u64, turn: u64) -> Result<Session, LaboratoryError> {
        let mut setting = self.setting_of(device)?;
        let seen = setting.programmes.len() - 1;
        let real = setting.run(seen)?;
        let noise = (setting.nominal.rig.noise).map(|sheet| self.conditions.noise * sheet);
        setting.programmes.truncate(seen);
        Ok(Session {
            measured: self.measure(noise, &real, turn),
            nominal: setting.nominal,
            programmes: setting.programmes,
        })
    }

    /// Readings of the device in a programme, with noise of its own, by the turn.
    pub(super) fn record(
        &self,
        programme: &Programme,
        turn: u64,
    ) -> Result<[Vec<f64>; CHANNELS.len()], LaboratoryError> {
        let setting = self.setting()?;
        // What differs from recording to recording is drawn anew, beyond those that the case has.
        let place = setting.programmes.len() + turn as usize;
        let concealed = (setting.conditions).in_recording(&setting.concealed, setting.seed, place);
        let trajectory = run(&setting.pair.real, &concealed, programme)?;
        let noise = (setting.nominal.rig.noise).map(|sheet| self.conditions.noise * sheet);
        let mut measured = self.measure(noise, &[trajectory], turn);
        Ok(measured.swap_remove(0))
    }

    /// The device as it really is, what is concealed in it, and what is done with it.
    ///
    /// # Errors
    /// The integrator cannot go on.
    ///
    /// # Panics
    /// An effect that does not exist.
    pub fn reality(&self) -> Result<(LaboratoryRig, Concealed, Vec<Programme>), LaboratoryError> {
        let setting = self.setting()?;
        Ok((setting.pair.real, setting.concealed, setting.programmes))
    }

    /// Visibility of one effect at shares of its largest size, with what else is in the recipe left out.
    ///
    /// # Errors
    /// The integrator cannot go on.
    ///
    /// # Panics
    /// An effect that does not exist.
    pub(super) fn visibility(
        &self,
        effect: &'static str,
    ) -> Result<impl FnMut(f64) -> Result<f64, LaboratoryError>, LaboratoryError> {
        let mut recipe = Self {
            effects: vec![(effect, 1.0)],
            law: None,
            ..self.clone()
        };
        let setting = recipe.setting()?;
        let eye = Self::eye(&setting)?;
        let seen = setting.programmes.len() - 1;
        Ok(move |share: f64| {
            recipe.effects[0].1 = share;
            Ok(eye.visibility(&recipe.setting()?.run(seen)?))
        })
    }

    /// The device with the listed effects but without the law, as its owner sees it in the recordings to diagnose from.
    pub(super) fn eye_beside(&self) -> Result<Eye, LaboratoryError> {
        let law = None;
        let setting = Self {
            law,
            ..self.clone()
        }
        .setting()?;
        let NominalRig { rig, tolerances } = &setting.nominal;
        let seen = &setting.programmes[..setting.programmes.len() - 1];
        Eye::new(
            &setting.pair.real,
            &setting.concealed,
            rig,
            tolerances,
            seen,
        )
    }

    /// True trajectories of the recordings to diagnose from.
    pub(super) fn real_trajectories(&self) -> Result<Vec<LaboratoryTrajectory>, LaboratoryError> {
        let setting = self.setting()?;
        setting.run(setting.programmes.len() - 1)
    }

    /// The nominal device.
    pub(super) fn rig(&self) -> LaboratoryRig {
        NominalRig::draw(self.seed).rig
    }

    fn setting(&self) -> Result<Setting, LaboratoryError> {
        self.setting_of(0)
    }

    /// The same of another device of the type: its numbers lie elsewhere within their tolerances.
    fn setting_of(&self, device: u64) -> Result<Setting, LaboratoryError> {
        let mut nominal = NominalRig::draw(self.seed);
        self.conditions.on_nominal(&mut nominal);
        let drawn = nominal.real(self.seed + device);
        let mut programmes = nominal.programmes(self.seed, self.duration).to_vec();
        if let Some(dirt) = &self.conditions.dirt {
            let rng = &mut stream(self.seed, 4);
            for programme in &mut programmes {
                dirt.on_times(programme, rng);
            }
        }
        self.conditions.on_programmes(&mut programmes);
        let peak_force = self.peak_force(&drawn, &programmes)?;
        let mut concealed = Concealed::default();
        let rng = &mut stream(self.seed, 5);
        let mut effects = Vec::new();
        for (name, share) in &self.effects {
            let effect = effect(name).expect("an effect of the catalogue");
            let numbers = (effect.conceal)(&mut Scene {
                rng,
                nominal: &nominal.rig,
                peak_force,
                share: *share,
                concealed: &mut concealed,
            });
            effects.push(sealed_effect(effect, numbers));
        }
        concealed.law.clone_from(&self.law);
        effects.extend(self.law.as_ref().map(sealed_law));
        self.conditions.on_device(&mut concealed, &drawn, self.seed);
        Ok(Setting {
            conditions: self.conditions,
            seed: self.seed,
            pair: Pair::new(&nominal.rig, drawn, &concealed),
            nominal,
            programmes,
            concealed,
            effects,
        })
    }

    /// Largest force in the recordings to diagnose from, with nothing concealed [N].
    fn peak_force(
        &self,
        rig: &LaboratoryRig,
        programmes: &[Programme],
    ) -> Result<f64, LaboratoryError> {
        let clips = |(name, _): &(&str, f64)| *name == "force_sensor_saturation";
        if !self.effects.iter().any(clips) {
            return Ok(0.0);
        }
        let mut all: Vec<f64> = Vec::new();
        for programme in &programmes[..programmes.len() - 1] {
            let trajectory = run(rig, &Concealed::default(), programme)?;
            all.extend(&trajectory.readings[2]);
        }
        all.sort_by(f64::total_cmp);
        // Impacts reach higher for a moment.
        Ok(all[all.len() * 99 / 100])
    }

    /// The device without the effects, as its owner sees it in the recordings to diagnose from.
    fn eye(setting: &Setting) -> Result<Eye, LaboratoryError> {
        let NominalRig { rig, tolerances } = &setting.nominal;
        let seen = &setting.programmes[..setting.programmes.len() - 1];
        let nothing = Concealed::default();
        Eye::new(&setting.pair.bare, &nothing, rig, tolerances, seen)
    }

    /// Where the effects show in the recordings to diagnose from, and how strongly in all.
    fn shown(
        &self,
        setting: &Setting,
        real: &[LaboratoryTrajectory],
    ) -> Result<(Vec<SealedInterval>, f64), LaboratoryError> {
        if self.effects.is_empty() && self.law.is_none() {
            return Ok((Vec::new(), 0.0));
        }
        let eye = Self::eye(setting)?;
        let mut found = Vec::new();
        for ((programme, with), without) in
            setting.programmes.iter().zip(real).zip(eye.trajectories())
        {
            for (channel, name) in CHANNELS.iter().enumerate() {
                let noise = setting.pair.real.noise[channel];
                let readings = [with, without].map(|trajectory| &trajectory.readings[channel]);
                let runs = intervals(&programme.times, readings[0], readings[1], noise);
                found.extend(runs.into_iter().map(|[start_s, end_s]| SealedInterval {
                    recording: programme.name.clone(),
                    channel: (*name).to_owned(),
                    start_s,
                    end_s,
                }));
            }
        }
        let seen = eye.trajectories().len();
        Ok((found, eye.visibility(&real[..seen])))
    }

    /// Effects that are there beside those concealed, of a size that may be seen.
    fn also_there(&self, effects: &[SealedEffect]) -> Vec<String> {
        let concealed = |name: &str| effects.iter().any(|effect| effect.name == name);
        let others = IMPERFECTIONS.iter().filter(|name| !concealed(name));
        let there = others.filter(|name| self.conditions.has(name));
        there.map(|name| (*name).to_owned()).collect()
    }

    fn measure(
        &self,
        noise: [f64; CHANNELS.len()],
        trajectories: &[LaboratoryTrajectory],
        turn: u64,
    ) -> Vec<[Vec<f64>; 4]> {
        // Purposes beyond those of a recipe, two for each turn.
        let purpose = |own: u64| {
            if turn == 0 {
                own
            } else {
                100 + 2 * turn + own % 2
            }
        };
        let (random, spoil) = (
            &mut stream(self.seed, purpose(6)),
            &mut stream(self.seed, purpose(7)),
        );
        let last = trajectories.len() - 1;
        let of = |(index, trajectory): (usize, &LaboratoryTrajectory)| {
            [0, 1, 2, 3].map(|channel| {
                let deviation = noise[channel];
                let step = self.conditions.coarseness * step_of(deviation);
                let mut values = measured(&trajectory.readings[channel], deviation, step, random);
                if self.conditions.missing == Some(channel) {
                    values.fill(f64::NAN);
                }
                if let Some(dirt) = self.conditions.dirt.filter(|_| index < last) {
                    dirt.on_values(&mut values, deviation, spoil);
                }
                values
            })
        };
        trajectories.iter().enumerate().map(of).collect()
    }
}

fn sealed_effect(effect: &LabEffect, numbers: Vec<(&'static str, f64)>) -> SealedEffect {
    let numbers = numbers.into_iter();
    let mut parameters: BTreeMap<String, Known> = numbers
        .map(|(name, value)| (name.to_owned(), Known::Number(value)))
        .collect();
    let unlisted = !effect.depends_on.is_empty();
    if unlisted {
        let names = effect.depends_on.iter().map(|name| (*name).to_owned());
        parameters.insert("depends_on".to_owned(), Known::Names(names.collect()));
    }
    SealedEffect {
        name: if unlisted { "unlisted" } else { effect.name }.to_owned(),
        truth: effect.name.to_owned(),
        subsystem: effect.subsystem.to_owned(),
        parameters,
        formula: None,
    }
}

fn sealed_law(law: &Law) -> SealedEffect {
    let names = law.depends_on().into_iter().map(str::to_owned).collect();
    SealedEffect {
        name: "unlisted".to_owned(),
        truth: "law".to_owned(),
        subsystem: law.place.subsystem().to_owned(),
        parameters: [("depends_on".to_owned(), Known::Names(names))].into(),
        formula: Some(law.formula()),
    }
}
