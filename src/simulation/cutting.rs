//! The turning tool over one step of the cell: what it takes off, the force that this needs, its spindle's speed and its wear.
//!
//! ```text
//! Q = Q(F, v, w),   F_t = (u Q/v + mu F) along w x n,   T = F_t r,   omega = omega_0 (1 - T/T_0),   dw/dt = F v
//! ```
//!
//! Q volume removed per time [m3/s] (`physics::removal_law`), F normal force, v speed of the tool's surface against the part [m/s], w its wear [J], F_t tangential force [N]
//! (`physics::cutting_force`), T torque of the spindle [N m], r radius of the contact [m], omega its speed [rad/s] (`physics::spindle`), that of the torque a step before.

use glam::DVec3;

use crate::cell::Cell;
use crate::path::{Phase, Reference};
use crate::physics::cutting_force::CuttingForce;
use crate::removal::{EdgeState, Ride};
use crate::scenario::{FeedMeasure, RemovalScenario, ToolScenario};

/// The tool over the last step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CuttingReading {
    /// Speed of its surface against the part [m/s].
    pub speed: f64,
    /// Volume taken per time [m3/s].
    pub rate: f64,
    /// Force on it along its surface [N].
    pub force: DVec3,
    /// Torque on its spindle [N m].
    pub torque: f64,
    /// Power at the tool [W].
    pub power: f64,
}

/// A turning tool and the edge under it.
pub struct Cutting {
    tool: ToolScenario,
    removal: Option<RemovalScenario>,
    /// Tangential force.
    cutting: CuttingForce,
    edge: EdgeState,
    ball_radius: f64,
    /// Place of the ball along the edge [m], and how it rides there.
    place: f64,
    ride: Ride,
    /// Work of force and speed so far [J].
    wear: f64,
    reading: CuttingReading,
}

impl Cutting {
    /// The tool, as worn as it comes, on the edge as it comes to the cell; none of a tool that does not turn.
    pub fn new(cell: &Cell) -> Option<Self> {
        let scenario = &cell.setup.scenario;
        let tool = scenario.tool?;
        let rubbing = CuttingForce {
            specific_energy: 0.0,
            friction: cell.setup.actual.cell.friction,
        };
        Some(Self {
            tool,
            removal: scenario.removal,
            cutting: scenario.removal.map_or(rubbing, |removal| removal.cutting),
            edge: cell.setup.part.edge_state.clone(),
            ball_radius: scenario.nominal.mounting.tool_radius,
            place: 0.0,
            ride: cell
                .setup
                .part
                .edge_state
                .ride(0.0, scenario.nominal.mounting.tool_radius),
            wear: (scenario.removal).map_or(0.0, |removal| removal.wear_at_start),
            reading: CuttingReading::default(),
        })
    }

    /// How the ball rides at a place of the edge [m] after a step of `dt` [s]: lift [m], its slope [1], and the rate at which the cut lowers it [m/s], as far as the ball
    /// climbs from what is cut to what is not. Without that it would press too hard in each step, by half of what it climbs.
    pub fn ride(&mut self, place: f64, dt: f64) -> (f64, f64, f64) {
        let ride = self.edge.ride(place, self.ball_radius);
        let climbed = 0.5 * (ride.slope + self.ride.slope) * (place - self.place);
        let lowered = (climbed - (ride.lift - self.ride.lift)).clamp(0.0, climbed.max(0.0));
        (self.place, self.ride) = (place, ride);
        (ride.lift, ride.slope, -lowered / dt)
    }

    /// Takes off what a step of `dt` [s] does, the tool pressed with mean forces [N] along normals; returns the force on the tool [N] and a normal to apply it at.
    pub fn advance(
        &mut self,
        reference: &Reference,
        pressed: &[(DVec3, f64)],
        dt: f64,
    ) -> (DVec3, DVec3) {
        let normal = pressed.iter().map(|(normal, force)| *normal * *force);
        let pressing = normal.fold(DVec3::ZERO, |sum, part| sum + part);
        let force = pressing.length();
        let turns = !self.tool.while_following || reference.phase == Phase::Follow;
        self.reading = CuttingReading {
            // The spindle's speed is that under the torque of the step before.
            torque: self.reading.torque,
            ..CuttingReading::default()
        };
        if !turns || force <= 0.0 {
            self.reading.torque = 0.0;
            return (DVec3::ZERO, DVec3::ZERO);
        }
        let normal = pressing / force;
        let ToolScenario { tool, spindle, .. } = self.tool;
        let axis = tool.spindle_axis(reference.axis, normal, reference.tangent);
        let radius = tool.contact_radius(axis, normal);
        let turning = spindle.speed(self.reading.torque) * radius;
        let slip =
            tool.surface_direction(axis, normal) * turning + reference.tangent * reference.feed;
        let speed = slip.length();
        let rate = self.take(force, speed, dt);
        let tangential = self.cutting.tangential(rate, speed, force);
        let along = slip.normalize_or_zero() * tangential;
        let torque = -along.dot(tool.surface_direction(axis, normal)) * radius;
        self.wear += force * speed * dt;
        self.reading = CuttingReading {
            speed,
            rate,
            force: -along,
            torque: torque.abs(),
            power: torque.abs() * spindle.speed(torque.abs()),
        };
        (-along, normal)
    }

    /// Removes material under the tool, and returns how fast [m3/s].
    fn take(&mut self, force: f64, speed: f64, dt: f64) -> f64 {
        let Some(removal) = &self.removal else {
            return 0.0;
        };
        let rate = (removal.law).removal_rate(force, speed, removal.contact_area, self.wear);
        let half = 0.5 * removal.contact_length;
        let [from, to] = [self.place - half, self.place + half];
        let taken = self.edge.remove(from, to, rate * dt);
        if taken { rate } else { 0.0 }
    }

    /// Whether its spindle stands under the torque of the last step.
    pub fn stalled(&self) -> bool {
        self.reading.torque >= self.tool.spindle.stall_torque
    }

    /// Torque at which it stalls [N m].
    pub fn stall_torque(&self) -> f64 {
        self.tool.spindle.stall_torque
    }

    /// What it did over the last step.
    pub fn reading(&self) -> &CuttingReading {
        &self.reading
    }

    /// Values of `schema::CUTTING_SIGNALS`.
    pub fn signals(&self) -> [f64; 5] {
        let reading = &self.reading;
        [
            reading.speed,
            reading.rate,
            reading.torque,
            reading.power,
            self.wear,
        ]
    }

    /// What a feed follows [N or W].
    pub fn measured(&self, by: FeedMeasure) -> f64 {
        match by {
            FeedMeasure::Force => self.reading.force.length(),
            FeedMeasure::Power => self.reading.power,
        }
    }

    /// The edge as it is left.
    pub fn into_edge(self) -> EdgeState {
        self.edge
    }
}
