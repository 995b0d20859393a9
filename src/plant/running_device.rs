//! One step of a device under its load and the terms of its rig's description, as bench, replay and cell take it.

use super::load::PistonLoad;
use super::moment::Moment;
use super::parameters::PlantParameters;
use super::port::Port;
use super::terms::ForceTerms;
use crate::device::{Device, DeviceParameters, DeviceState, PistonMotion};

/// A device that runs.
#[derive(Debug, Clone)]
pub struct RunningDevice<'a> {
    plant: &'a PlantParameters,
    /// The device.
    pub device: Device<&'a DeviceParameters>,
    /// Its state.
    pub state: DeviceState,
    /// Motion of its piston.
    pub motion: PistonMotion,
    /// Air that had come in when that was last looked at [kg].
    entered: f64,
    /// Air that came in since the time before [kg/s].
    pub mass_flow: f64,
}

/// A device that has stopped between two steps: what it needs to go on, apart from its description.
#[derive(Debug, Clone)]
pub struct PausedDevice {
    /// Its state.
    pub state: DeviceState,
    /// Motion of its piston.
    pub motion: PistonMotion,
    /// Air that had come in when that was last looked at [kg].
    entered: f64,
    /// Air that came in since the time before [kg/s].
    mass_flow: f64,
}

impl RunningDevice<'_> {
    /// What it needs to go on.
    pub fn pause(self) -> PausedDevice {
        PausedDevice {
            state: self.state,
            motion: self.motion,
            entered: self.entered,
            mass_flow: self.mass_flow,
        }
    }
}

impl<'a> RunningDevice<'a> {
    /// One that goes on, by a description that may have changed meanwhile.
    pub fn resumed(plant: &'a PlantParameters, paused: PausedDevice) -> Self {
        Self {
            plant,
            device: Device::new(&plant.device),
            state: paused.state,
            motion: paused.motion,
            entered: paused.entered,
            mass_flow: paused.mass_flow,
        }
    }

    /// As it starts.
    pub fn new(
        plant: &'a PlantParameters,
        device: Device<&'a DeviceParameters>,
        (motion, state): (PistonMotion, DeviceState),
    ) -> Self {
        Self {
            plant,
            device,
            state,
            motion,
            entered: 0.0,
            mass_flow: 0.0,
        }
    }

    /// Puts on a load what the terms do to it now; gives the moment that they depend on. None where there are no terms.
    pub fn meet_terms<'b>(
        &self,
        load: &mut PistonLoad<'b>,
        set_pressure: f64,
        surface: f64,
    ) -> Option<Moment>
    where
        'a: 'b,
    {
        let plant = self.plant;
        if !plant.has_terms() {
            return None;
        }
        let moment = Moment {
            time: load.start,
            stroke: self.motion.stroke,
            speed: self.motion.speed,
            pressures: self.device.pressures(&self.state, self.motion.stroke),
            mass_flow: self.mass_flow,
            set_pressure,
            surface,
            contact_force: load.contact_force(0.0, self.motion),
        };
        load.stroke.0[0] += plant.term(Port::Surface, &moment);
        load.added_stiffness = plant.term(Port::ContactStiffness, &moment);
        load.terms = ForceTerms::over(plant, &moment);
        Some(moment)
    }

    /// Takes the terms on to the middle of a step of `h` [s] that begins at a moment.
    pub fn face_terms(&mut self, load: &mut PistonLoad<'_>, moment: Option<&Moment>, h: f64) {
        if let Some(moment) = moment {
            let [now, middle] = [*moment, moment.ahead(0.5 * h)];
            load.stroke.0[0] +=
                self.plant.term(Port::Surface, &middle) - self.plant.term(Port::Surface, &now);
            self.state.disturbance = self.plant.disturbance(moment, h);
        }
    }

    /// Advances device and piston by `dt` [s] in at least so many sub-steps, with the ledger or without; gives the impulse as
    /// [`Device::advance_loaded`].
    pub fn advance<const LEDGER: bool>(
        &mut self,
        load: &PistonLoad<'_>,
        set_pressure: f64,
        (dt, substeps): (f64, usize),
    ) -> f64 {
        let (state, motion) = (&mut self.state, &mut self.motion);
        self.device
            .advance_loaded::<_, LEDGER>(state, motion, set_pressure, load, dt, substeps)
    }

    /// Force of the device on its piston along extension now [N].
    pub fn force(&self) -> f64 {
        self.device.piston_force(&self.state, self.motion)
    }

    /// Looks at the air that came in over a time [s].
    pub fn note_flow(&mut self, over: f64) {
        let entered = self.state.air.entered;
        self.mass_flow = (entered - self.entered) / over;
        self.entered = entered;
    }
}
