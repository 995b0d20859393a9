//! What a run is measured against.

use super::error::MetricsError;

/// Name of the phase over which uniformity is judged.
pub const FOLLOW_PHASE: &str = "follow";
/// Half width of the narrow band about the desired force, as a share of it [1].
pub const NARROW_BAND: f64 = 0.05;
/// Half width of the wide band about the desired force, as a share of it [1].
pub const WIDE_BAND: f64 = 0.10;
/// Force from which the tool counts as touching, as a share of the desired force [1].
pub const TOUCH_SHARE: f64 = 0.01;

/// Limits against which a run is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryLimits {
    /// Desired contact force [N].
    pub desired_force: f64,
    /// Those of the passes after the first [N].
    pub later_forces: Vec<f64>,
    /// Lower and upper end of the stroke [m].
    pub stroke_limits: (f64, f64),
    /// Effort limit of each joint, base first [N m]; infinite if it has none.
    pub joint_efforts: Vec<f64>,
    /// Name of each joint, base first.
    pub joint_names: Vec<String>,
}

impl SummaryLimits {
    pub(super) fn check(&self) -> Result<(), MetricsError> {
        let limit = |what: String, value: String, expected| {
            Err(MetricsError::Limit {
                what,
                value,
                expected,
            })
        };
        for force in std::iter::once(&self.desired_force).chain(&self.later_forces) {
            if !(force.is_finite() && *force > 0.0) {
                let value = format!("{force} N");
                return limit("the desired force".into(), value, "a positive number");
            }
        }
        let (lower, upper) = self.stroke_limits;
        if !(lower.is_finite() && upper.is_finite() && lower < upper) {
            let value = format!("{lower} m to {upper} m");
            return limit("the stroke".into(), value, "a lower end below an upper end");
        }
        if self.joint_names.len() != self.joint_efforts.len() {
            let value = self.joint_efforts.len().to_string();
            let what = format!("number of efforts of {} joints", self.joint_names.len());
            return limit(what, value, "one for each joint");
        }
        for (name, &effort) in self.joint_names.iter().zip(&self.joint_efforts) {
            // Also refuses NaN.
            if effort.is_nan() || effort <= 0.0 {
                let what = format!("the effort limit of joint `{name}`");
                return limit(what, format!("{effort} N m"), "a positive number");
            }
        }
        Ok(())
    }
}
