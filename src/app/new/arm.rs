//! A cell with an arm of one's own: what its file lacks as arms of its size have it, a device that it can carry, and the part where it reaches, found by planning and run once.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use glam::{DQuat, DVec3};
use glamx::DPose3;
use rayon::prelude::*;

use super::super::error::AppError;
use super::super::progress;
use super::part::Files;
use crate::arm::{ArmDraft, draft_of};
use crate::cell::{Cell, CellError, Setup, Stance};
use crate::metrics;
use crate::quantity::significant;
use crate::run::{RunError, run_cell};
use crate::scenario::load;

/// Stretch of the plate's edge that is worked: its middle and the longest [mm], and the longest of the arm's reach [1].
const EDGE: [f64; 2] = [150.0, 280.0];
const EDGE_SHARE: f64 = 0.3;
/// Where the edge is looked for about the shoulder: distances, of the arm's reach [1], and directions [deg].
const DISTANCES: [f64; 5] = [0.65, 0.8, 0.5, 0.95, 0.38];
const ELEVATIONS: [f64; 6] = [-20.0, -45.0, 0.0, 20.0, -70.0, 45.0];
const AZIMUTHS: [f64; 8] = [0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0, 180.0];
/// How the part is turned about the vertical from where its edge faces the robot [deg].
const TURNS: [f64; 4] = [0.0, 180.0, 90.0, -90.0];
/// Places that are tried at a time, that are planned to their end, and that are run, of each device.
const AT_A_TIME: usize = 8;
const PLANS: usize = 16;
const RUNS: usize = 4;
/// Largest share of a drive's torque in a run [%].
const DRIVE_SHARE: f64 = 90.0;

/// A device that suits arms of some payload.
struct Size {
    /// Least payload [kg].
    payload: f64,
    /// Contact force [N].
    force: f64,
    /// Keys of `[device.override]`, none for the device model as it is.
    keys: &'static [(&'static str, f64)],
}

/// Devices, the largest first; smaller ones scale with their cylinders: judged.
const SIZES: [Size; 4] = [
    Size {
        payload: 16.0,
        force: 150.0,
        keys: &[],
    },
    Size {
        payload: 6.0,
        force: 50.0,
        keys: &[
            ("bore_mm", 20.0),
            ("rod_mm", 8.0),
            ("stroke_mm", 40.0),
            ("dead_volume_cm3", 8.0),
            ("moving_mass_kg", 1.5),
            ("housing_mass_kg", 1.0),
            ("housing_centre_of_mass_mm", 30.0),
            ("supply_orifice_mm2", 1.2),
            ("exhaust_orifice_mm2", 1.0),
            ("end_stop_stiffness_n_per_m", 4e5),
            ("end_stop_damping_n_s_per_m", 750.0),
            ("seal_coulomb_force_n", 6.0),
            ("seal_static_force_n", 8.5),
            ("seal_viscous_coefficient_n_s_per_m", 30.0),
        ],
    },
    Size {
        payload: 2.0,
        force: 18.0,
        keys: &[
            ("cylinder_count", 1.0),
            ("bore_mm", 16.0),
            ("rod_mm", 6.0),
            ("stroke_mm", 30.0),
            ("dead_volume_cm3", 3.0),
            ("moving_mass_kg", 0.5),
            ("housing_mass_kg", 0.4),
            ("housing_centre_of_mass_mm", 25.0),
            ("supply_orifice_mm2", 0.5),
            ("exhaust_orifice_mm2", 0.4),
            ("end_stop_stiffness_n_per_m", 1.5e5),
            ("end_stop_damping_n_s_per_m", 270.0),
            ("seal_coulomb_force_n", 2.5),
            ("seal_static_force_n", 3.5),
            ("seal_viscous_coefficient_n_s_per_m", 12.0),
            ("tool_centre_mm", 110.0),
            ("moving_centre_of_mass_mm", 70.0),
            ("moving_radius_of_gyration_mm", 35.0),
        ],
    },
    Size {
        payload: 0.0,
        force: 10.0,
        keys: &[
            ("cylinder_count", 1.0),
            ("bore_mm", 12.0),
            ("rod_mm", 5.0),
            ("stroke_mm", 20.0),
            ("dead_volume_cm3", 1.5),
            ("moving_mass_kg", 0.25),
            ("housing_mass_kg", 0.2),
            ("housing_centre_of_mass_mm", 20.0),
            ("supply_orifice_mm2", 0.3),
            ("exhaust_orifice_mm2", 0.25),
            ("end_stop_stiffness_n_per_m", 1e5),
            ("end_stop_damping_n_s_per_m", 150.0),
            ("seal_coulomb_force_n", 1.2),
            ("seal_static_force_n", 1.7),
            ("seal_viscous_coefficient_n_s_per_m", 6.0),
            ("tool_centre_mm", 100.0),
            ("moving_centre_of_mass_mm", 60.0),
            ("moving_radius_of_gyration_mm", 30.0),
        ],
    },
];

/// A cell's text that is edited line by line.
pub(super) struct Lines(Vec<String>);

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        Self(text.lines().map(str::to_owned).collect())
    }

    fn of_key(&self, key: &str) -> Option<usize> {
        let is = |line: &String| line.split_once(" = ").is_some_and(|(own, _)| own == key);
        self.0.iter().position(is)
    }

    /// Gives a key that stands there another value.
    pub(super) fn put(&mut self, key: &str, value: &str) {
        if let Some(at) = self.of_key(key) {
            self.0[at] = format!("{key} = {value}");
        }
    }

    /// Puts lines behind that of a key.
    fn behind(&mut self, key: &str, lines: Vec<String>) {
        if let Some(at) = self.of_key(key) {
            self.0.splice(at + 1..=at, lines);
        }
    }

    pub(super) fn text(&self) -> String {
        self.0.iter().map(|line| format!("{line}\n")).collect()
    }
}

/// The cell's text with an arm of one's own, and what was found of it.
pub(super) fn with_arm(text: &str, urdf: &Path) -> Result<(String, ArmDraft), AppError> {
    let draft = draft_of(urdf).map_err(CellError::from)?;
    let mut lines = Lines::of(&without_drives(text));
    lines.put("urdf", &format!("{:?}", urdf.display().to_string()));
    lines.put("flange_link", &format!("{:?}", draft.mount.flange_link));
    let mut own = Vec::new();
    if let Some(base) = &draft.mount.base_link {
        own.push(format!("base_link = {base:?}"));
    }
    let [roll, pitch, yaw] = (draft.mount.rotation).map(|angle| thousandth(angle.to_degrees()));
    if [roll, pitch, yaw] != [0.0; 3] {
        own.push(format!(
            "flange_rotation_deg = [{roll}, {pitch}, {yaw}]   # turns z out of the flange, along the last joint's axis"
        ));
    }
    let reach = significant(draft.reach, 3);
    if let Some(mass) = draft.whole_mass {
        own.push(format!(
            "mass_kg = {mass}                         # estimated: links have no masses in the URDF, and robots of {reach} m reach weigh so; its data sheet says better"
        ));
    }
    lines.behind("flange_link", own);
    if !draft.limits.is_empty() {
        let mut limits = vec![
            String::new(),
            format!(
                "# Limits that the URDF does not give, estimated as robots of {reach} m reach have them; data sheets say better."
            ),
        ];
        for (index, (joint, effort, velocity)) in draft.limits.iter().enumerate() {
            if index > 0 {
                limits.push(String::new());
            }
            limits.push("[[arm.limit_overrides]]".to_owned());
            limits.push(format!("joint = {joint:?}"));
            limits.extend(effort.map(|torque| format!("effort_n_m = {torque}")));
            let speed = velocity.map(|speed| speed.to_degrees().round());
            limits.extend(speed.map(|speed| format!("velocity_deg_per_s = {speed}")));
        }
        lines.behind("encoder_noise_rad", limits);
    }
    Ok((lines.text(), draft))
}

/// A cell's text without the springs of the arm that comes with the program: another arm's joints have other names.
fn without_drives(text: &str) -> String {
    let tables = text.split("\n\n");
    let kept: Vec<&str> = tables
        .filter(|table| !table.starts_with("[[arm.drives]]"))
        .collect();
    kept.join("\n\n")
}

fn thousandth(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

/// The cell's text with a device of some size.
fn with_device(text: &str, size: &Size, draft: &ArmDraft) -> String {
    let mut lines = Lines::of(text);
    if size.keys.is_empty() {
        return lines.text();
    }
    let mut keys = vec![
        String::new(),
        format!(
            "# A smaller device than the model's: an arm of {} m reach carries some {} kg (estimated). Judged.",
            significant(draft.reach, 3),
            significant(draft.payload, 2)
        ),
        "[device.override]".to_owned(),
    ];
    keys.extend(
        size.keys
            .iter()
            .map(|(key, value)| format!("{key} = {value}")),
    );
    lines.behind("model", keys);
    let force = size.force;
    lines.put(
        "force_n",
        &format!("{force}                             # contact force along the contact normal"),
    );
    let noise = thousandth(0.8 * force / SIZES[0].force);
    lines.put("standard_deviation_n", &noise.to_string());
    lines.put("coefficient_of_variation_percent", "{ max = 4.0 }");
    let [low, high] = [0.97, 1.03].map(|share| thousandth(share * force));
    lines.put("force_mean_n", &format!("{{ min = {low}, max = {high} }}"));
    lines.text()
}

/// The cell's text with the plate at a place.
fn with_place(text: &str, stance: &Stance, [start, end]: [f64; 2]) -> String {
    let mut lines = Lines::of(text);
    let [x, y, z] = (stance.world_from_part.translation * 1e3)
        .to_array()
        .map(thousandth);
    lines.put(
        "position_mm",
        &format!("[{x}, {y}, {z}]             # the part's origin in the world, found where the arm reaches it"),
    );
    let (_, _, yaw) = stance
        .world_from_part
        .rotation
        .to_euler(glam::EulerRot::XYZ);
    lines.put(
        "rotation_deg",
        &format!("[0, 0, {}]", thousandth(yaw.to_degrees())),
    );
    lines.put(
        "start_mm",
        &format!("{start}                           # from the edge's first point"),
    );
    lines.put("end_mm", &end.to_string());
    lines.text()
}

/// The files with a device that the arm can carry and the plate where it reaches; and in words what was chosen.
pub(super) fn placed(
    mut files: Files,
    file: &Path,
    draft: &ArmDraft,
    quiet: bool,
) -> Result<(Files, String), AppError> {
    let trouble = |reason: std::io::Error| AppError::OutputFile {
        file: file.display().to_string(),
        option: "--out",
        reason: reason.to_string(),
    };
    // The search reads what is not written yet.
    let folder = tempfile::tempdir().map_err(trouble)?;
    let own = file.parent().unwrap_or(Path::new(""));
    for (path, content) in &files[1..] {
        let there = folder.path().join(path.strip_prefix(own).unwrap_or(path));
        std::fs::create_dir_all(there.parent().unwrap_or(folder.path()))
            .and_then(|()| std::fs::write(&there, content))
            .map_err(trouble)?;
    }
    let text = String::from_utf8_lossy(&files[0].1).into_owned();
    let line = progress::spinner("looking where the arm reaches the part", quiet);
    let suits = |size: &&Size| draft.payload >= size.payload;
    let mut reason = None;
    let mut found = None;
    for size in SIZES.iter().skip_while(|size| !suits(size)) {
        let text = with_device(&text, size, draft);
        match search(&text, &folder.path().join("cell.toml"), draft)? {
            Ok(text) => {
                found = Some((text, size));
                break;
            }
            Err(why) => drop(reason.get_or_insert(why)),
        }
    }
    line.finish_and_clear();
    let Some((text, size)) = found else {
        return Err(AppError::NoPlace {
            arm: draft.mount.flange_link.clone(),
            reason: reason.unwrap_or_default(),
        });
    };
    files[0].1 = text.into_bytes();
    let note = format!(
        "device on `{}`, {} N on an arm of {} m reach{}{}",
        draft.mount.flange_link,
        size.force,
        significant(draft.reach, 3),
        match draft.whole_mass {
            Some(mass) => format!(", its mass of {mass} kg estimated"),
            None => String::new(),
        },
        match draft.limits.len() {
            0 => "",
            _ => ", its drives' limits estimated",
        }
    );
    Ok((files, note))
}

/// The text with a place of the part at which the job runs within its bounds; or why there is none, by the first place that was tried.
fn search(text: &str, file: &Path, draft: &ArmDraft) -> Result<Result<String, String>, AppError> {
    let length = EDGE[1].min(10.0 * (100.0 * EDGE_SHARE * draft.reach).round());
    let stretch = [EDGE[0] - 0.5 * length, EDGE[0] + 0.5 * length];
    let write = |text: &str| {
        std::fs::write(file, text).map_err(|error| AppError::OutputFile {
            file: file.display().to_string(),
            option: "--out",
            reason: error.to_string(),
        })
    };
    let mut lines = Lines::of(text);
    lines.put("start_mm", &stretch[0].to_string());
    lines.put("end_mm", &stretch[1].to_string());
    write(&lines.text())?;
    let setup = Setup::load(load(file)?)?;
    let mut reason = None;
    let (mut plans, mut runs) = (0, 0);
    for some in stances(&setup, draft.reach).chunks(AT_A_TIME) {
        let outlined: Vec<Result<&Stance, String>> = some
            .par_iter()
            .map(|there| match setup.outline(there) {
                Ok(_) => Ok(there),
                Err(error) => Err(error.to_string()),
            })
            .collect();
        for there in outlined {
            let there = match there {
                Ok(there) => there,
                Err(error) => {
                    reason.get_or_insert(error);
                    continue;
                }
            };
            plans += 1;
            if setup.is_possible(there) {
                let text = with_place(text, there, stretch);
                write(&text)?;
                match run_once(file)? {
                    None => return Ok(Ok(text)),
                    Some(why) => reason = Some(why),
                }
                runs += 1;
            }
            if plans == PLANS || runs == RUNS {
                return Ok(Err(reason.unwrap_or_default()));
            }
        }
    }
    Ok(Err(
        reason.unwrap_or_else(|| "nothing is in reach".to_owned())
    ))
}

/// Why a cell is not one to hand out; none if it runs to its end within its bounds, no drive near its limit.
fn run_once(file: &Path) -> Result<Option<String>, AppError> {
    let cell = match Cell::new(load(file)?) {
        Ok(cell) => cell,
        Err(error) => return Ok(Some(error.to_string())),
    };
    let finished = run_cell(&cell, &mut |_| ())?;
    if let Some(stop) = finished.stop {
        return Ok(Some(stop.to_string()));
    }
    let share = finished.summary.joint_torque_share_percent;
    if let Some(share) = share.filter(|share| *share > DRIVE_SHARE) {
        return Ok(Some(format!(
            "a drive is at {share:.0} % of its limit in a run"
        )));
    }
    let verdicts = metrics::check(
        metrics::METRICS,
        &finished.summary,
        &cell.setup.scenario.expect,
    );
    let verdicts = verdicts.map_err(RunError::metrics(file))?;
    let outside = verdicts.iter().find(|verdict| !verdict.kept);
    Ok(outside.map(|verdict| format!("{} is out of its bounds in a run", verdict.metric)))
}

/// Places about the arm's shoulder, the likeliest first.
fn stances(setup: &Setup, reach: f64) -> Vec<Stance> {
    let own = setup.stance();
    let arm = &setup.scenario.arm;
    let joints = &setup.arm.chain.joints;
    let first = arm.world_from_base * joints[0].parent_from_joint;
    let axis = first.rotation * joints[0].axis;
    let shoulder = first.transform_point(joints[1].parent_from_joint.translation);
    // A joint of the shoulder may lie off the first axis.
    let shoulder = first.translation + axis * axis.dot(shoulder - first.translation);
    let up = -setup.scenario.simulation.gravity.normalize_or(-DVec3::Z);
    let upright = axis.dot(up).abs() > 0.9 && shoulder.dot(up) > first.translation.dot(up) - 0.05;
    let ahead = arm.world_from_base.rotation * DVec3::X;
    let azimuth = match ahead.x.hypot(ahead.y) > 0.1 {
        true => ahead.y.atan2(ahead.x),
        false => 0.0,
    };
    let edge = &setup.part.edge;
    let middle = edge.at(0.5 * edge.length).point;
    let [low, _] = <[DVec3; 2]>::from(setup.part.mesh.bounds());
    let mut found = Vec::new();
    for turn in TURNS {
        for aside in AZIMUTHS {
            for elevation in ELEVATIONS {
                for distance in DISTANCES {
                    let level = azimuth + aside.to_radians();
                    let steep = elevation.to_radians();
                    let direction = DVec3::new(
                        level.cos() * steep.cos(),
                        level.sin() * steep.cos(),
                        steep.sin(),
                    );
                    let target = shoulder + direction * (distance * reach);
                    let yaw = level + turn.to_radians() - FRAC_PI_2;
                    let degrees = thousandth(yaw.to_degrees());
                    let rotation = DQuat::from_rotation_z(degrees.to_radians());
                    let origin = target - rotation * middle;
                    // To a millimetre, as it is written.
                    let origin = (origin * 1e3).round() * 1e-3;
                    if upright && origin.z + low.z < 0.02 {
                        continue;
                    }
                    found.push(Stance {
                        world_from_part: DPose3::from_parts(origin, rotation),
                        ..own
                    });
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_written_to_their_tables_and_the_rest_stays() {
        let text = "[arm]\nurdf = \"a\"\nflange_link = \"b\"\n\n[arm.servo]\nencoder_noise_rad = 1\n\n[[arm.drives]]\njoint = \"x\"\n\n[device]\nmodel = \"m\"\n";
        let mut lines = Lines::of(&without_drives(text));
        lines.put("urdf", "\"c\"");
        lines.behind("flange_link", vec!["mass_kg = 3".to_owned()]);
        assert_eq!(
            lines.text(),
            "[arm]\nurdf = \"c\"\nflange_link = \"b\"\nmass_kg = 3\n\n[arm.servo]\nencoder_noise_rad = 1\n\n[device]\nmodel = \"m\"\n"
        );
    }

    #[test]
    fn smaller_devices_suit_smaller_arms() {
        /// Standard gravity [m/s2].
        const GRAVITY: f64 = 9.80665;
        for pair in SIZES.windows(2) {
            assert!(pair[0].payload > pair[1].payload && pair[0].force > pair[1].force);
        }
        // What is pressed with is no more than what may be carried.
        for size in SIZES.iter().filter(|size| size.payload > 0.0) {
            assert!(size.force <= size.payload * GRAVITY, "{} N", size.force);
        }
    }
}
