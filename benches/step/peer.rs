//! MuJoCo beside us: tests/reference/mujoco_peer.py, started once and driven over its standard input and output.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use glam::DVec3;
use idc_cell::arm::chain::MAX_JOINTS;
use idc_cell::arm::dynamics::gravity_torques;
use idc_cell::cell::Cell;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::job::{feed_forward, follow_span, servo_gains};

/// Share by which its static contact force may miss the desired one and still be the same job.
const FORCE_TOLERANCE: f64 = 1e-3;

/// Its report once it stands on the edge.
#[derive(Debug, Deserialize)]
pub struct Ready {
    /// MuJoCo's version.
    pub version: String,
    /// Contact force at rest [N].
    pub static_force: f64,
    /// Penetration at rest [m].
    pub penetration: f64,
}

/// Its report after following the edge once.
#[derive(Debug, Deserialize)]
pub struct Round {
    /// Time that it took [s].
    pub seconds: f64,
    /// Steps in that time.
    pub steps: usize,
    /// Mean contact force [N].
    pub force_mean: f64,
    /// Its standard deviation [N].
    pub force_deviation: f64,
}

/// Its error and cost by one of its integrators at one step.
#[derive(Debug, Deserialize)]
pub struct Precision {
    /// The integrator.
    pub integrator: String,
    /// Step [s].
    pub step: f64,
    /// Time that a simulated second takes [s].
    pub cost: f64,
    /// 90th percentile of the joints' errors [rad].
    pub joints: f64,
    /// The same of the ball's centre [m].
    pub tip: f64,
}

/// The running process.
pub struct Peer {
    child: Child,
    requests: ChildStdin,
    replies: BufReader<ChildStdout>,
    /// Where it stands before the first round.
    pub ready: Ready,
}

/// The interpreter with MuJoCo: `IDC_PYTHON`, else the one that .ci/install_references made.
fn interpreter() -> Option<PathBuf> {
    let made = || Path::new(env!("CARGO_MANIFEST_DIR")).join("build/references/venv/bin/python");
    let python = std::env::var_os("IDC_PYTHON").map_or_else(made, PathBuf::from);
    python.exists().then_some(python)
}

impl Peer {
    /// Starts it on the cell's following phase; `Err` says why there is none.
    pub fn start(cell: &Cell, steps: usize) -> Result<Self, String> {
        let (follow, step) = (follow_span(cell).0, cell.setup.scenario.simulation.step);
        let times: Vec<f64> = (1..=steps).map(|i| follow + i as f64 * step).collect();
        Self::on(cell, &scene(cell, &times, None)?)
    }

    /// The same with the slide's force as a record holds it [N], at times from the start of following on [s] so far apart.
    pub fn led(cell: &Cell, record: &[f64], apart: f64) -> Result<Self, String> {
        let follow = follow_span(cell).0;
        let times: Vec<f64> = (0..record.len())
            .map(|i| follow + i as f64 * apart)
            .collect();
        let mut scene = scene(cell, &times, Some(record))?;
        scene["step"] = json!(apart);
        Self::on(cell, &scene)
    }

    fn on(cell: &Cell, scene: &Value) -> Result<Self, String> {
        let python = interpreter()
            .ok_or("no Python with it: run .ci/install_references or set IDC_PYTHON to an interpreter that has the package mujoco")?;
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/mujoco_peer.py");
        let mut child = Command::new(&python)
            .arg(&script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("{}: {error}", python.display()))?;
        let (Some(mut requests), Some(replies)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("its standard input and output are not ours".to_owned());
        };
        let mut replies = BufReader::new(replies);
        writeln!(requests, "{scene}").map_err(|error| error.to_string())?;
        let ready: Ready = reply(&mut replies)?;
        let desired = cell.setup.scenario.process.force;
        if (ready.static_force / desired - 1.0).abs() > FORCE_TOLERANCE {
            let force = ready.static_force;
            return Err(format!(
                "it presses with {force:.3} N at rest instead of {desired} N, so it does another job"
            ));
        }
        Ok(Self {
            child,
            requests,
            replies,
            ready,
        })
    }

    /// Lets it follow the edge once.
    pub fn round(&mut self) -> Result<Round, String> {
        writeln!(self.requests, "round").map_err(|error| error.to_string())?;
        reply(&mut self.replies)
    }

    /// Lets it follow the edge by each of its integrators at steps [s], held against its own run at the finest one at times so far apart.
    pub fn precision(
        &mut self,
        steps: &[f64],
        finest: f64,
        apart: f64,
    ) -> Result<Vec<Precision>, String> {
        let request = json!({ "steps": steps, "finest": finest, "apart": apart });
        writeln!(self.requests, "{request}").map_err(|error| error.to_string())?;
        reply(&mut self.replies)
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // Any other line ends it.
        if writeln!(self.requests, "end").is_err() || self.child.wait().is_err() {
            eprintln!("mujoco_peer.py did not end by itself");
        }
    }
}

fn reply<T: for<'a> Deserialize<'a>>(replies: &mut BufReader<ChildStdout>) -> Result<T, String> {
    let mut line = String::new();
    replies
        .read_line(&mut line)
        .map_err(|error| error.to_string())?;
    serde_json::from_str(&line).map_err(|_| format!("mujoco_peer.py said: {}", line.trim()))
}

/// The cell in the arm's base frame, as mujoco_peer.py reads it, its drives' inputs at times [s]; the slide's force [N] as a record holds it, if there is one.
fn scene(cell: &Cell, times: &[f64], record: Option<&[f64]>) -> Result<Value, String> {
    let scenario = &cell.setup.scenario;
    let nominal = &scenario.nominal;
    let base_from_world = scenario.arm.world_from_base.inverse();
    let (low, high) = cell.setup.part.mesh.bounds();
    let box_volume = (high - low).element_product();
    if (cell.setup.part.mesh.volume() / box_volume - 1.0).abs() > 1e-9 {
        return Err("only a part that is a box can be handed over".to_owned());
    }
    let base_from_part = base_from_world * cell.setup.part.world_from_part;
    let turned = base_from_part.rotation;
    let mass = nominal.device.moving_mass;
    let gains = servo_gains(cell);
    let follow = follow_span(cell).0;
    let step = scenario.simulation.step;
    let start = cell.plan.reference(follow);
    let count = cell.setup.arm_with_slide.len();
    let mut start_position = start.position[..count].to_vec();
    start_position[count - 1] = scenario.process.working_stroke;
    let row = |i: usize, time: f64| {
        let mut row = Row::at(cell, time, &gains);
        if let (Some(force), Some(slide)) = (record, row.applied.last_mut()) {
            *slide = force[i];
        }
        row
    };
    let rows: Vec<_> = times
        .iter()
        .enumerate()
        .map(|(i, time)| row(i, *time))
        .collect();
    let hold = row(0, follow);
    Ok(json!({
        "urdf": scenario.arm.urdf,
        "flange": scenario.arm.flange_link,
        "step": step,
        "gravity": list(base_from_world.rotation * scenario.simulation.gravity),
        "device": {
            "mass": mass,
            "centre_of_mass": nominal.mounting.moving_centre_of_mass,
            "inertia": mass * nominal.mounting.moving_radius_of_gyration.powi(2),
            "ball_centre": nominal.mounting.tool_centre,
            "ball_radius": nominal.mounting.tool_radius,
        },
        "part": {
            "centre": list(base_from_part.transform_point((low + high) / 2.0)),
            "half_size": list((high - low) / 2.0),
            "rotation": [turned.w, turned.x, turned.y, turned.z],
        },
        "contact": {
            "stiffness": nominal.contact.stiffness_at(0.0),
            "damping": nominal.contact.damping,
            "friction": nominal.cell.friction,
        },
        "servo": {
            "stiffness": gains.iter().map(|gain| gain.0).collect::<Vec<_>>(),
            "damping": gains.iter().map(|gain| gain.1).collect::<Vec<_>>(),
        },
        "start": {
            "position": start_position,
            "hold": { "position": hold.position, "applied": hold.applied },
        },
        "follow": {
            "position": rows.iter().map(|row| &row.position).collect::<Vec<_>>(),
            "applied": rows.iter().map(|row| &row.applied).collect::<Vec<_>>(),
        },
    }))
}

fn list(vector: DVec3) -> [f64; 3] {
    vector.to_array()
}

/// Inputs of the arm's drives in one step.
struct Row {
    /// References of the axes' servos [rad].
    position: Vec<f64>,
    /// Forces on axes and slide beside them [N m, N].
    applied: Vec<f64>,
}

impl Row {
    fn at(cell: &Cell, time: f64, gains: &[(f64, f64)]) -> Self {
        let reference = cell.plan.reference(time);
        let scenario = &cell.setup.scenario;
        let axes = gains.len();
        let mut applied = feed_forward(cell, &reference)[..=axes].to_vec();
        // MuJoCo compensates the arm's own weight itself.
        let mut weight = [0.0; MAX_JOINTS];
        let base = scenario.arm.world_from_base.rotation;
        let gravity = scenario.simulation.gravity;
        gravity_torques(
            &cell.setup.arm.chain,
            base,
            gravity,
            &reference.position[..axes],
            &mut weight[..axes],
        );
        for axis in 0..axes {
            applied[axis] += gains[axis].1 * reference.velocity[axis] - weight[axis];
        }
        Self {
            position: reference.position[..axes].to_vec(),
            applied,
        }
    }
}
