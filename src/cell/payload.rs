//! What the arm carries on its flange, and what it may.

use glam::{DMat3, DVec3};

use super::error::CellError;
use crate::arm::chain::{BodyInertia, KinematicChain};
use crate::arm::payload::of_maker;
use crate::arm::urdf::Arm;
use crate::plant::Mounting;
use crate::scenario::Scenario;

/// Standard gravity, by which a force is given as a mass [m/s2].
const GRAVITY: f64 = 9.80665;

/// The arm with the housing of a device on its flange, its mass without extent.
#[must_use]
pub fn with_housing(arm: &KinematicChain, mounting: &Mounting) -> KinematicChain {
    let mut chain = arm.clone();
    let housing = BodyInertia {
        mass: mounting.housing_mass,
        centre_of_mass: DVec3::Z * mounting.housing_centre_of_mass,
        inertia: DMat3::ZERO,
    };
    let tip = chain.tip_from_last;
    if let Some(last) = chain.joints.last_mut()
        && housing.mass > 0.0
    {
        last.body = last.body.welded_to(&housing.seen_from(&tip));
    }
    chain
}

/// The load on the flange.
#[derive(Debug, Clone, PartialEq)]
pub struct FlangeLoad {
    /// Mass of the device's housing [kg].
    pub housing: f64,
    /// Mass of its slide and tool [kg].
    pub moving: f64,
    /// Largest contact force of all passes [N].
    pub force: f64,
    /// Mass that the arm may carry [kg], with who says so; unknown where neither scenario nor maker does.
    pub payload: Option<(f64, String)>,
}

impl FlangeLoad {
    /// The load of a scenario on its arm.
    #[must_use]
    pub fn of(scenario: &Scenario, arm: &Arm) -> Self {
        let given = scenario.arm.payload;
        let given = given.map(|mass| (mass, "arm.payload_kg".to_owned()));
        let maker = of_maker(&arm.name);
        let maker = maker.map(|mass| (mass, format!("its maker, for the robot `{}`", arm.name)));
        let forces = scenario.passes.iter().filter_map(|pass| pass.force);
        let process = scenario.process.force;
        Self {
            housing: scenario.nominal.mounting.housing_mass,
            moving: scenario.nominal.device.moving_mass,
            force: forces.fold(process, f64::max),
            payload: given.or(maker),
        }
    }

    /// Mass on the flange [kg].
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.housing + self.moving
    }

    /// Refuses more mass than the arm may carry.
    pub(super) fn check(&self, scenario: &Scenario) -> Result<(), CellError> {
        match &self.payload {
            Some((payload, origin)) if self.mass() > *payload => Err(CellError::Payload {
                file: scenario.path.clone(),
                carried: self.mass(),
                housing: self.housing,
                moving: self.moving,
                payload: *payload,
                origin: origin.clone(),
            }),
            _ => Ok(()),
        }
    }

    /// What a user may not expect of it.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.housing == 0.0 {
            notes.push("the device's housing has no mass (housing_mass_kg of the device model or of [device.override]): joint torques and the load on the flange lack it".to_owned());
        }
        if let Some((payload, origin)) = &self.payload
            && self.force > payload * GRAVITY
        {
            notes.push(format!(
                "the contact force, {} N, is more than the weight of the {payload} kg that the arm may carry ({origin}): its drives are checked against their limits, not its structure",
                self.force
            ));
        }
        notes
    }
}
