//! Masses of the arm that are estimated, and what that leaves open.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::arm::EstimatedMass;
use crate::path::torques::ranges;
use crate::path::{Plan, PlanRequest, TorqueRange};

/// Interval at which the range of torques is looked for [s].
const INTERVAL: f64 = 2e-2;

/// An arm some of whose masses are estimated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedArm {
    /// How far each mass may be off, in per cent of it.
    pub mass_spread_percent: f64,
    /// The masses.
    pub links: Vec<EstimatedLink>,
    /// Torques that the drives need along the planned motion.
    pub joints: Vec<EstimatedTorque>,
}

/// A link with an estimated mass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedLink {
    /// Its name.
    pub link: String,
    /// Its mass with all that is fixed to it [kg].
    pub mass_kg: f64,
    /// What of it is estimated.
    pub estimated: Cow<'static, str>,
}

/// The largest torque of a drive along the planned motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedTorque {
    /// Joint.
    pub joint: String,
    /// By the masses as estimated [N m].
    pub largest_n_m: f64,
    /// Least that it may be if masses are off by the spread [N m].
    pub least_n_m: f64,
    /// Greatest that it may be [N m].
    pub greatest_n_m: f64,
    /// The drive's limit [N m].
    pub limit_n_m: f64,
}

impl EstimatedArm {
    /// What estimated masses leave open of a plan; none where none is estimated.
    pub(super) fn of(
        masses: &[EstimatedMass],
        spread: f64,
        request: &PlanRequest,
        plan: &Plan,
    ) -> Option<Self> {
        if masses.is_empty() {
            return None;
        }
        let link = |mass: &EstimatedMass| EstimatedLink {
            link: mass.link.clone(),
            mass_kg: mass.mass,
            estimated: match mass.by_volume {
                true => "mass, centre and inertia".into(),
                false => "centre and inertia".into(),
            },
        };
        // Where a mass lies is as open as how much it is.
        let uncertain: Vec<usize> = masses.iter().map(|mass| mass.joint).collect();
        let torque = |range: TorqueRange| EstimatedTorque {
            joint: range.joint,
            largest_n_m: range.largest,
            least_n_m: range.range[0],
            greatest_n_m: range.range[1],
            limit_n_m: range.limit,
        };
        let count = (plan.duration() / INTERVAL).ceil() as usize;
        let references = (0..=count).map(|i| plan.reference(i as f64 * INTERVAL));
        let ranges = ranges(request, references, &uncertain, spread);
        Some(Self {
            mass_spread_percent: 100.0 * spread,
            links: masses.iter().map(link).collect(),
            joints: ranges.into_iter().map(torque).collect(),
        })
    }

    /// One sentence on it.
    #[must_use]
    pub fn note(&self) -> String {
        let links: Vec<String> = (self.links.iter())
            .map(|link| format!("{} {:.2} kg", link.link, link.mass_kg))
            .collect();
        let over: Vec<&str> = (self.joints.iter())
            .filter(|joint| joint.greatest_n_m > joint.limit_n_m)
            .map(|joint| joint.joint.as_str())
            .collect();
        let spread = self.mass_spread_percent;
        let drives = match over.is_empty() {
            true => "no drive is then over its limit".to_owned(),
            false => format!(
                "the drives of {} might then be over their limits",
                over.join(", ")
            ),
        };
        format!(
            "masses of links are estimated from their shapes, not known: {}; joint torques are as uncertain, and if each is off by {spread:.0} %, {drives}",
            links.join(", ")
        )
    }
}
