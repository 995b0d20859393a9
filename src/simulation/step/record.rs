//! What a step reads and records: sensors, a sample, and a frame of the picture.

use glam::DVec3;
use glamx::DPose3;

use super::{FRAME_INTERVAL, SIGNALS_OF_TURNING, Simulation};
use crate::arm::chain::MAX_JOINTS;
use crate::device::PistonMotion;
use crate::path::Reference;
use crate::plant::{Moment, PistonLoad, Port, SensorReadings};
use crate::recording::schema::JointSignal;
use crate::sensing::Truth;
use crate::simulation::error::SimulationError;

impl Simulation<'_> {
    /// Positions, references, speeds, drive torques and encoder readings of the axes.
    fn joint_signals(&self, reference: &Reference) -> [[f64; JointSignal::ALL.len()]; MAX_JOINTS] {
        let mut joints = [[0.0; JointSignal::ALL.len()]; MAX_JOINTS];
        for (axis, joint) in joints.iter_mut().enumerate().take(self.slide()) {
            *joint = [
                self.world.positions()[axis],
                reference.position[axis],
                self.world.velocities()[axis],
                self.torques[axis],
                self.encoders[axis],
            ];
        }
        joints
    }

    /// Reads the sensors.
    fn read_sensors(
        &mut self,
        time: f64,
        there: &SensorReadings,
        acceleration: f64,
        moment: Option<Moment>,
    ) {
        let mut read = self.errors.read(time, there, acceleration);
        if let Some(moment) = moment {
            read.add(self.cell.setup.actual.reading_terms(&moment));
        }
        self.readings = self.sensors.measure(
            time,
            &Truth {
                force: read.force,
                stroke: read.stroke,
                acceleration,
                regulator_pressure: read.regulator_pressure,
            },
        );
        if self.sensors.sampled() {
            self.read_encoders();
        }
    }

    /// Sum of the contact's normal forces [N], as a vector [N], and along the stroke [N].
    fn pressing(load: &PistonLoad<'_>, motion: PistonMotion) -> (f64, DVec3, f64) {
        let none = (0.0, DVec3::ZERO, 0.0);
        (load.touches().iter()).fold(none, |(sum, vector, along), touch| {
            let force = load.normal_force(touch, 0.0, motion);
            (
                sum + force,
                vector + touch.normal * force,
                along + touch.share * force,
            )
        })
    }

    pub(super) fn sample(
        &mut self,
        reference: &Reference,
        set_pressure: f64,
    ) -> Result<(), SimulationError> {
        let (cell, n) = (self.cell, self.slide());
        let actual = &cell.setup.actual;
        let time = self.steps as f64 * cell.setup.scenario.simulation.step;
        let motion = self.device.motion;
        let stroke = motion.stroke;
        let (load, moment) = self.load(time, &self.touches);
        let further = load.term_force(0.0, motion);
        let added_outlet = moment.map_or(0.0, |now| actual.term(Port::OutletPressure, &now));
        let (normal_force, normal, load) = Self::pressing(&load, motion);
        let cut = self.cutting.as_ref().map(|cutting| cutting.reading().force);
        let friction = self.world.contact().friction + cut.unwrap_or_default();
        let force_on_part = -(normal + friction);
        let normal = normal.normalize_or_zero();
        let gas = &actual.device.gas;
        let pressures = self.device.device.pressures(&self.device.state, stroke);
        let mass = actual.device.moving_mass;
        if !cell.setup.scenario.device.locked {
            self.slide_force = self.device.force() + further;
        }
        let acceleration = (self.slide_force - load) / mass + self.carried;
        let there = SensorReadings {
            force: force_on_part.dot(reference.axis),
            stroke,
            regulator_pressure: self.device.state.regulator.outlet + added_outlet,
        };
        self.read_sensors(time, &there, acceleration, moment);
        let off = self.world.tool_centre() - reference.centre;
        let axial = off.dot(reference.axis);
        let along = off.dot(reference.tangent);
        let aside = reference.normal.cross(reference.tangent);
        self.peak.set(self.peak.get().max(normal_force));
        self.touched |= self.peak.get() > 0.0;
        let signals = [
            reference.edge_length,
            normal_force,
            self.peak.get(),
            self.desired(reference),
            force_on_part.x,
            force_on_part.y,
            force_on_part.z,
            friction.length(),
            self.slide_force,
            stroke,
            motion.speed,
            pressures[0],
            pressures[1],
            gas.atmosphere + self.device.state.regulator.outlet,
            gas.atmosphere + set_pressure,
            self.device.state.air.masses[0],
            self.device.state.air.masses[1],
            self.device.state.air.line_mass(),
            self.device.state.air.entered,
            self.device.state.air.left,
            off.dot(aside),
            -along,
            axial - (stroke - cell.setup.scenario.process.working_stroke),
            reference.feed,
            gas.atmosphere + self.readings.regulator_pressure,
            self.readings.stroke,
            self.readings.force,
        ];
        let joints = self.joint_signals(reference);
        self.check_finite(&signals, &joints[..n], reference.phase, time)?;
        self.record(reference, time, &signals, &joints[..n], normal);
        if time >= self.next_frame {
            self.frame(time, reference, force_on_part, normal);
            self.next_frame += FRAME_INTERVAL;
            self.check_clearance(reference, time)?;
        }
        let across = off - reference.axis * axial - reference.tangent * along;
        self.check_on_edge(reference, across.length(), normal_force, time)?;
        self.check_spindle(reference, time)?;
        self.check_axes(&joints[..n], reference.phase, time)?;
        self.check_stroke(reference, (stroke, axial), time)
    }

    /// Adds a sample, of a tool that turns with what it did, and where it touches a part of this normal.
    fn record(
        &mut self,
        reference: &Reference,
        time: f64,
        signals: &[f64],
        joints: &[[f64; JointSignal::ALL.len()]],
        normal: DVec3,
    ) {
        let touching = self.touching(normal);
        if let Some(points) = &mut self.contact_points {
            points.push(touching);
        }
        let place = (reference.phase, reference.pass);
        match &self.cutting {
            None => self.log.push(time, place, signals, joints),
            Some(cutting) => {
                let mut all = [0.0; SIGNALS_OF_TURNING];
                all[..signals.len()].copy_from_slice(signals);
                all[signals.len()..].copy_from_slice(&cutting.signals());
                self.log.push(time, place, &all, joints);
            }
        }
    }

    fn read_encoders(&mut self) {
        let noise = self.cell.setup.scenario.arm.servo.encoder_noise;
        for axis in 0..self.slide() {
            let angle = match &self.motors[axis] {
                None => self.world.positions()[axis],
                Some(motor) => motor.angle,
            };
            let offset = self.cell.setup.actual.cell.encoder_offset[axis];
            self.encoders[axis] = angle + offset + noise * self.encoder_noise.normal();
        }
    }

    /// Where the tool touches a part of this normal [m].
    fn touching(&self, normal: DVec3) -> DVec3 {
        self.world.tool_centre() - normal * self.cell.setup.scenario.nominal.mounting.tool_radius
    }

    fn frame(&mut self, time: f64, reference: &Reference, force: DVec3, normal: DVec3) {
        self.frames.times.push(time);
        self.frames.path_lengths.push(reference.edge_length);
        let mut links = vec![DPose3::IDENTITY; self.laws.len()];
        self.world.link_poses(&mut links);
        self.frames.links.push(links);
        self.frames.contact_points.push(self.touching(normal));
        self.frames.contact_forces.push(force);
    }
}
