//! The file of a recorded arm from its URDF and a log: what neither says is marked.

use std::fmt::Write as _;
use std::path::Path;

use super::super::error::AppError;
use crate::arm::{Arm, ArmOptions, JointKind, load_arm, mount_of_recorded};
use crate::case::usual_column;
use crate::cell::CellError;
use crate::recording::csv::Log;
use crate::recording::log::read_log;
use crate::shell::word;
use crate::stats::{median, median_step};

/// Mark of what is not known.
const NOT_KNOWN: &str = "NOT KNOWN";
/// Median size of normal noise over its standard deviation.
const MEDIAN_SIZE: f64 = 0.6745;

/// What a log shows.
struct Seen {
    log: Log,
    /// Its name in the file.
    name: String,
}

/// The file's text, and in words what was found.
pub(super) fn text(
    urdf: &Path,
    log: Option<&Path>,
    file: &Path,
) -> Result<(String, String), AppError> {
    let mount = mount_of_recorded(urdf).map_err(CellError::from)?;
    let options = ArmOptions {
        base_link: mount.base_link.clone(),
        tip_link: mount.flange_link.clone(),
        skip_visuals: true,
        is_recorded: true,
        ..ArmOptions::default()
    };
    let arm = load_arm(urdf, &options).map_err(CellError::from)?;
    let joints: Vec<&str> = arm.chain.joints.iter().map(|j| j.name.as_str()).collect();
    let seen = log.map(|path| seen(path, file, &joints)).transpose()?;
    let seen = seen.as_ref();
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut text = head(&arm, &named_from(folder, urdf), &mount.flange_link);
    if let Some(base) = &mount.base_link {
        text = text.replace("\ngravity", &format!("\nbase = {base:?}\ngravity"));
    }
    for (index, joint) in arm.chain.joints.iter().enumerate() {
        let torque = logs_torque(seen, index + 1);
        text += &drive(&joint.name, joint.kind, torque);
    }
    text += "\n[load]                                 # declared load, fixed to the flange, in its axes; not felt by a wrench sensor\nmass_kg = 0.0\n# centre_m = [0.0, 0.0, 0.05]\n";
    if seen.is_some_and(|seen| seen.has("wrench_force_x_n")) {
        text += &wrench();
    }
    text += &sensors(&arm, seen);
    let recordings = seen.map_or("recording.csv", |seen| seen.name.as_str());
    let _ = write!(
        text,
        "\n[recordings]\nfit = [{recordings:?}]             # a star stands for all that fit\n# predict = \"other.csv\"             # positions alone of another path, to be predicted\n"
    );
    let said = format!(
        "{} joints up to link {}; what is marked {NOT_KNOWN} is to be put in",
        arm.chain.len(),
        mount.flange_link
    );
    Ok((text, said))
}

/// A path as a file in a folder names it: its name where it lies there, otherwise the whole.
fn named_from(folder: &Path, path: &Path) -> String {
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let path = whole(path);
    let inside = path.strip_prefix(whole(folder)).ok().map(Path::to_owned);
    inside.unwrap_or(path).display().to_string()
}

/// Whether a log holds the torque of a joint's drive and not its current.
fn logs_torque(seen: Option<&Seen>, number: usize) -> bool {
    let has = |signal: &str| seen.is_some_and(|seen| seen.has(&format!("joint_{number}_{signal}")));
    !has("current_a") && (has("torque_n_m") || has("force_n"))
}

fn head(arm: &Arm, urdf: &str, flange: &str) -> String {
    format!(
        "# A recorded arm: {} as its maker describes it. Strict SI. What neither URDF nor log says is marked {NOT_KNOWN}.\n\
         #     key = 5.0                                        a number, taken to be exact\n\
         #     key = {{ value = 5.0, tolerance = 0.1 }}           lies within 10 % of it, anywhere\n\
         #     key = {{ value = 5.0, low = 2.0, high = 9.0 }}     lies between them\n\
         kind = \"recorded_arm\"\nschema = 1\n\n[arm]\nurdf = {urdf:?}\n\
         flange = {flange:?}                      # link that carries load and wrench sensor\n\
         gravity_m_per_s2 = [0, 0, -9.81]       # in the axes of the base link: another where the arm hangs or leans\n\
         link_mass_tolerance = 0.05             # {NOT_KNOWN}: how well the URDF's masses are known, a share of each\n\
         link_centre_tolerance_m = 0.01         # {NOT_KNOWN}: how well its centres of mass are known\n",
        arm.name
    )
}

fn drive(joint: &str, kind: JointKind, torque: bool) -> String {
    let unit = match kind {
        JointKind::Revolute => "",
        JointKind::Prismatic => "; prismatic: N for N m, m for rad",
    };
    let gain = match torque {
        true => {
            "# gain_n_m_per_a = 10.0                # left out: the log holds torques\n".to_owned()
        }
        false => format!(
            "gain_n_m_per_a = {{ value = 10.0, tolerance = 0.9 }}     # {NOT_KNOWN}: torque constant times gear ratio\n"
        ),
    };
    format!(
        "\n[[drive]]                              # columns count joints in this order{unit}\njoint = {joint:?}\n{gain}\
         motor_inertia_kg_m2 = {{ value = 0.5, low = 0.0, high = 20.0 }}    # {NOT_KNOWN}: of motor and gear, at the joint's side\n\
         # coulomb_friction_n_m = {{ value = 5.0, tolerance = 0.5 }}        # left out: a diagnosis names the friction that it finds\n\
         # viscous_friction_n_m_s_per_rad = {{ value = 5.0, tolerance = 0.5 }}\n"
    )
}

fn wrench() -> String {
    format!(
        "\n[wrench_sensor]                        # between flange and tool; it reads what the tool does to it, in its own axes\n\
         height_m = 0.0                         # {NOT_KNOWN}: its origin along the flange's z\n\
         rotation_z_rad = 0.0                   # {NOT_KNOWN}: its axes against the flange's, about z\n\
         zero_force_n = {{ value = [0.0, 0.0, 0.0], tolerance_n = 2.0 }}         # {NOT_KNOWN}\n\
         zero_torque_n_m = {{ value = [0.0, 0.0, 0.0], tolerance_n_m = 0.1 }}    # {NOT_KNOWN}\n\
         tool_mass_kg = {{ value = 1.0, low = 0.0, high = 20.0 }}                # {NOT_KNOWN}: all that is beyond it\n\
         tool_centre_m = {{ value = [0.0, 0.0, 0.05], tolerance_m = 0.3 }}       # {NOT_KNOWN}: from its origin, in the flange's axes\n"
    )
}

/// Rate and noise, as the log shows them.
fn sensors(arm: &Arm, seen: Option<&Seen>) -> String {
    let shown = |value: f64| format!("{value:.1e}").parse::<f64>().unwrap_or(value);
    let of = |column: &str| seen.and_then(|seen| seen.noise(column)).map(shown);
    let from_log = "# from the log, by how its samples scatter";
    let mut text = String::from(
        "\n[sensors]                              # one standard deviation of white noise\n",
    );
    let mut line = |key: &str, value: Option<f64>, usual: f64| {
        let (value, said) = match value {
            Some(value) => (value, from_log.to_owned()),
            None => (usual, format!("# {NOT_KNOWN}")),
        };
        let pair = format!("{key} = {value:?}");
        // Writing into a text cannot fail.
        let _ = writeln!(text, "{pair:<38} {said}");
    };
    line("rate_hz", seen.and_then(Seen::rate), 100.0);
    line("joint_rad", of("joint_1_rad"), 1e-5);
    let list = |signals: &[&str], usual: f64| {
        let all = (1..=arm.chain.len()).map(|number| {
            let mut all = signals.iter();
            all.find_map(|signal| of(&format!("joint_{number}_{signal}")))
        });
        let values: Vec<String> = all.map(|v| format!("{:?}", v.unwrap_or(usual))).collect();
        format!("[{}]", values.join(", "))
    };
    let said = match seen {
        Some(_) => from_log.to_owned(),
        None => format!("# {NOT_KNOWN}"),
    };
    let torques = (1..=arm.chain.len()).filter(|number| logs_torque(seen, *number));
    let torques = torques.count();
    if torques < arm.chain.len() {
        let list = list(&["current_a"], 0.05);
        let _ = writeln!(text, "current_a = {list} {said}, one a drive");
    }
    if torques > 0 {
        let list = list(&["torque_n_m", "force_n"], 0.5);
        let _ = writeln!(text, "torque_n_m = {list} {said}, one a drive");
    }
    if let Some(noise) = of("joint_1_link_rad") {
        let _ = writeln!(text, "link_rad = {noise:?} {from_log}");
    }
    if seen.is_some_and(|seen| seen.has("wrench_force_x_n")) {
        let force = of("wrench_force_x_n").unwrap_or(0.2);
        let torque = of("wrench_torque_x_n_m").unwrap_or(0.01);
        let _ = writeln!(text, "wrench_force_n = {force:?} {from_log}");
        let _ = writeln!(text, "wrench_torque_n_m = {torque:?} {from_log}");
    }
    text
}

fn seen(path: &Path, file: &Path, joints: &[&str]) -> Result<Seen, AppError> {
    let usual = |name: &str| usual_column(joints, name);
    let mut log = read_log(path, |name| {
        usual(name).is_some() || name.starts_with("wrench_")
    })?;
    for (name, _) in &mut log.columns {
        if let Some(usual) = usual(name) {
            *name = usual;
        }
    }
    if !log
        .columns
        .iter()
        .any(|(name, _)| name == "joint_1_rad" || name == "joint_1_m")
    {
        let names: Vec<&str> = log.ignored.iter().map(String::as_str).collect();
        return Err(AppError::NoJoints {
            file: path.display().to_string(),
            columns: names.join(", "),
            import: format!("idc new import --from {}", word(path)),
        });
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    Ok(Seen {
        log,
        name: named_from(folder, path),
    })
}

impl Seen {
    fn values(&self, column: &str) -> Option<&[f64]> {
        let own = self.log.columns.iter().find(|(name, _)| name == column);
        own.map(|(_, values)| values.as_slice())
    }

    fn has(&self, column: &str) -> bool {
        let values = self.values(column);
        values.is_some_and(|values| values.iter().any(|value| value.is_finite()))
    }

    /// Samples per second, rounded.
    fn rate(&self) -> Option<f64> {
        let step = median_step(&self.log.time);
        (step > 0.0).then(|| (10.0 / step).round() / 10.0)
    }

    /// Noise of a column by what each sample differs from a cubic through its four neighbours, whatever their stamps: motion hardly shows in it, and the
    /// median is robust against where it does.
    fn noise(&self, column: &str) -> Option<f64> {
        let values = self.values(column)?;
        let samples = self.log.time.windows(5).zip(values.windows(5));
        let sizes = samples.map(|(time, values)| {
            let others = [0, 1, 3, 4];
            let weight = |own: usize| -> f64 {
                let rest = others.into_iter().filter(|other| *other != own);
                rest.map(|other| (time[2] - time[other]) / (time[own] - time[other]))
                    .product()
            };
            let weights = others.map(weight);
            let pairs = weights.iter().zip(others);
            let between: f64 = pairs.map(|(weight, other)| weight * values[other]).sum();
            let spread = 1.0 + weights.iter().map(|weight| weight * weight).sum::<f64>();
            (values[2] - between).abs() / spread.sqrt()
        });
        let noise = median(sizes.filter(|size| size.is_finite()))? / MEDIAN_SIZE;
        (noise > 0.0).then_some(noise)
    }
}
