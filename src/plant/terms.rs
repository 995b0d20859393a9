//! Terms at the ports of a rig beside its device, contact and sensors: a model discrepancy, and laws of a user's own.

use std::borrow::Cow;

use super::latent::Latent;
use super::moment::{Moment, Variable};
use super::own_law::{LawText, OwnLaw};
use super::parameters::PlantParameters;
use super::port::Port;
use crate::device::{DeviceParameters, Disturbance, PistonMotion};

/// Further forces on the piston over a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct ForceTerms<'a> {
    /// The description that has them, with the moment at the start of the step; none where there are none.
    of: Option<(&'a PlantParameters, Moment)>,
}

impl<'a> ForceTerms<'a> {
    /// Those of a description over a step that starts at a moment.
    pub fn over(plant: &'a PlantParameters, moment: &Moment) -> Self {
        Self {
            of: plant.acts_at(Port::PistonForce).then_some((plant, *moment)),
        }
    }

    /// Their sum along extension [N] at a time [s] and a motion; what else they depend on is held.
    #[inline]
    pub fn force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.of.map_or(0.0, |(plant, held)| {
            let moment = Moment {
                time,
                stroke: motion.stroke,
                speed: motion.speed,
                ..held
            };
            plant.term(Port::PistonForce, &moment)
        })
    }
}

impl PlantParameters {
    /// Whether anything acts there.
    pub fn acts_at(&self, port: Port) -> bool {
        let latent = self.latent.as_ref().is_some_and(|l| l.port == port);
        latent || self.own.iter().any(|law| law.acts && law.text.port == port)
    }

    /// Whether anything acts at any port.
    pub fn has_terms(&self) -> bool {
        self.latent.is_some() || self.own.iter().any(|law| law.acts)
    }

    /// Whether a term depends on what changes within milliseconds, and is held over a step: what it says in the middle of one is known of time, inputs and stroke alone. Of a
    /// force on the piston the speed is followed too; what is added to a reading acts on nothing.
    pub fn has_fast_terms(&self) -> bool {
        let acts = |port: Port| {
            ![
                Port::PressureReading,
                Port::StrokeReading,
                Port::ForceReading,
            ]
            .contains(&port)
        };
        let fast = |port: Port, variable: Variable| match variable {
            Variable::Time | Variable::Stroke | Variable::SetPressure | Variable::Surface => false,
            Variable::Velocity => port != Port::PistonForce,
            Variable::ChamberPressure
            | Variable::PressureDifference
            | Variable::MassFlow
            | Variable::ContactForce => true,
        };
        let of_law = |law: &LawText| {
            let mut all = Variable::ALL.into_iter();
            acts(law.port) && all.any(|variable| fast(law.port, variable) && law.uses(variable))
        };
        let latent = self.latent.iter().any(|latent| match latent.formula() {
            Some(formula) => of_law(&formula.law),
            None => acts(latent.port) && fast(latent.port, latent.variable),
        });
        latent || self.own.iter().any(|own| own.acts && of_law(&own.text))
    }

    /// Sum of the terms at a port at a moment, in the port's unit.
    pub fn term(&self, port: Port, moment: &Moment) -> f64 {
        let latent = self.latent.iter().filter(|latent| latent.port == port);
        let own = self.own.iter().filter(|law| law.text.port == port);
        latent.map(|latent| latent.at(moment)).sum::<f64>()
            + own.map(|law| law.at(moment)).sum::<f64>()
    }

    /// Sum of the terms on the device over a step, held at its value in the middle; `moment` is the step's start and `step` its length [s].
    pub fn disturbance(&self, moment: &Moment, step: f64) -> Disturbance {
        let middle = moment.ahead(0.5 * step);
        Disturbance {
            set_pressure: self.term(Port::SetPressure, moment),
            outlet: self.term(Port::OutletPressure, &middle),
            mass_flows: [Port::FirstChamberFlow, Port::SecondChamberFlow]
                .map(|port| self.term(port, &middle)),
            // Nothing flows through an opening of less than no area.
            leaks: [Port::FirstChamberLeak, Port::SecondChamberLeak]
                .map(|port| self.term(port, &middle).max(0.0)),
            orifices: [Port::SupplyOrifice, Port::ExhaustOrifice]
                .map(|port| self.term(port, &middle)),
            friction: self.term(Port::Friction, &middle),
        }
    }

    /// The device, with seals that the terms' friction may press.
    pub fn device_under_terms(&self) -> Cow<'_, DeviceParameters> {
        if !self.acts_at(Port::Friction) {
            return Cow::Borrowed(&self.device);
        }
        let latent = self.latent.iter().find_map(Latent::bristle_stiffness);
        let mut own = self.own.iter().filter(|law| law.acts);
        let stiffness = latent.or_else(|| own.find_map(OwnLaw::bristle_stiffness));
        Cow::Owned(DeviceParameters {
            seal_friction: self.device.seal_friction.pressed(stiffness),
            ..self.device.clone()
        })
    }

    /// Its additions to the readings of pressure, stroke and force at a moment.
    pub fn reading_terms(&self, moment: &Moment) -> [f64; 3] {
        [
            Port::PressureReading,
            Port::StrokeReading,
            Port::ForceReading,
        ]
        .map(|port| self.term(port, moment))
    }
}
