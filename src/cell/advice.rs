//! What would make a refused job possible, for people.

use glam::DVec3;

/// Changes to a scenario each of which alone makes its job possible.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Advice {
    /// Way of the part [m], and its position then [m].
    pub part: Option<(DVec3, DVec3)>,
    /// Lean of the tool [rad].
    pub lean: Option<f64>,
    /// Angle of the flange about the tool's axis [rad], where the scenario gives another.
    pub roll: Option<f64>,
    /// Whether nothing was found of what was tried.
    pub nothing: bool,
}

impl std::fmt::Display for Advice {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let mut ways = Vec::new();
        if let Some((way, position)) = self.part {
            let [way, position] = [way, position].map(|v| {
                let [x, y, z] = (v * 1e3).to_array().map(|x| (x * 1e3).round() / 1e3 + 0.0);
                format!("{x}, {y}, {z}")
            });
            ways.push(format!(
                "the part moved by ({way}) mm: workpiece.position_mm = [{position}]"
            ));
        }
        if let Some(lean) = self.lean {
            let degrees = lean.to_degrees().round() + 0.0;
            ways.push(format!("the tool leaned: process.lean_deg = {degrees}"));
        }
        if let Some(roll) = self.roll {
            let degrees = roll.to_degrees().round() + 0.0;
            ways.push(format!(
                "the flange turned about the tool's axis: process.roll_deg = {degrees}"
            ));
        }
        if ways.is_empty() && self.nothing {
            return write!(
                f,
                "; no place of the part within 3 m and no lean was found at which the job can be done"
            );
        }
        if !ways.is_empty() {
            write!(f, "; it can be done with {}", ways.join(", or with "))?;
        }
        Ok(())
    }
}
