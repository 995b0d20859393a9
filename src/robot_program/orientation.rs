//! Orientations as makers write them.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

/// Yaw, pitch and roll of a rotation [rad]: turns about z, then the new y, then the new x. In a singular posture yaw is what it happens to be, and roll makes up for it.
pub(super) fn yaw_pitch_roll(rotation: DQuat) -> [f64; 3] {
    let matrix = DMat3::from_quat(rotation);
    let (x, y, z) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
    let across = x.x.hypot(x.y);
    let yaw = if across < 1e-9 { 0.0 } else { x.y.atan2(x.x) };
    let (sine, cosine) = yaw.sin_cos();
    let roll = (sine * z.x - cosine * z.y).atan2(cosine * y.y - sine * y.x);
    [yaw, (-x.z).atan2(across), roll]
}

/// The rotation of yaw, pitch and roll [rad].
pub(super) fn of_yaw_pitch_roll([yaw, pitch, roll]: [f64; 3]) -> DQuat {
    DQuat::from_rotation_z(yaw) * DQuat::from_rotation_y(pitch) * DQuat::from_rotation_x(roll)
}

/// Position [mm], then yaw, pitch and roll [degrees].
pub(super) fn millimetres_and_degrees(pose: &DPose3) -> [f64; 6] {
    let [x, y, z] = (pose.translation * 1e3).to_array();
    let [yaw, pitch, roll] = yaw_pitch_roll(pose.rotation).map(f64::to_degrees);
    [x, y, z, yaw, pitch, roll]
}

/// The pose of position [mm], yaw, pitch and roll [degrees].
pub(super) fn of_millimetres_and_degrees([x, y, z, yaw, pitch, roll]: [f64; 6]) -> DPose3 {
    let angles = [yaw, pitch, roll].map(f64::to_radians);
    DPose3::from_parts(DVec3::new(x, y, z) * 1e-3, of_yaw_pitch_roll(angles))
}

/// A number with so many digits behind the point, never as minus zero.
pub(super) fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// Numbers with so many digits, and commas between them.
pub(super) fn list(values: &[f64], digits: usize) -> String {
    let values: Vec<String> = values.iter().map(|value| fixed(*value, digits)).collect();
    values.join(",")
}
