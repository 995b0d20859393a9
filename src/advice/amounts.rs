//! Changes of single numbers: forces, speeds, masses, pressures, strokes.

use super::kind::Kind;
use super::remedy::Remedy;
use super::trial::Trial;
use crate::cell::CellError;
use crate::path::{Obstacle, PlanError};
use crate::scenario::{ForceLaw, KeyValue, Scenario};

/// What of a largest speed is aimed at [1].
const BELOW: f64 = 0.97;
/// Shares of what just can be that are tried, the largest first [1].
const LESS: [f64; 6] = [0.97, 0.85, 0.7, 0.5, 0.3, 0.15];
/// Multiples of what is just needed, the smallest first [1].
const MORE: [f64; 4] = [1.03, 1.15, 1.4, 2.0];
/// Phases that may each be too fast.
const PHASES: usize = 8;

/// Rounds to three digits, towards zero.
fn down(value: f64) -> f64 {
    rounded(value, f64::floor)
}

/// Rounds to three digits, away from zero.
fn up(value: f64) -> f64 {
    rounded(value, f64::ceil)
}

fn rounded(value: f64, to: impl Fn(f64) -> f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let digits = 2 - value.abs().log10().floor() as i32;
    let unit = 10f64.powi(digits);
    // What is whole but for rounding stays so.
    let scaled = to((value * unit * 1e6).round() / 1e6);
    // Divided by whole powers of ten, which are exact: 0.3 and not 0.30000000000000004.
    if digits >= 0 {
        scaled / unit
    } else {
        scaled * 10f64.powi(-digits)
    }
}

/// The first change of a kind that passes check and run.
pub(super) fn remedy(
    kind: Kind,
    trial: &Trial<'_>,
    scenario: &Scenario,
    refusal: &CellError,
) -> Option<Remedy> {
    let parameters = &scenario.nominal.device;
    match kind {
        Kind::Feed => feed(trial, scenario, refusal),
        Kind::Acceleration => acceleration(trial, scenario),
        Kind::LessForce => less_force(trial, scenario, refusal),
        Kind::MoreForce => {
            let CellError::Weight { pressing, .. } = refusal else {
                return None;
            };
            let friction = parameters.seal_friction.static_force;
            let forces = MORE.map(|times| up(times * pressing + (times - MORE[0]) * friction));
            let forces = forces.map(|force| force_edits(scenario, &|own| own.max(force)));
            first(trial, kind, "more force", forces.to_vec(), 0.0)
        }
        Kind::Mass | Kind::OpposingPressure => weight(kind, trial, scenario, refusal),
        Kind::SupplyPressure | Kind::Bore => supply(kind, trial, scenario, refusal),
        Kind::WorkingStroke => working_stroke(trial, scenario, refusal),
        Kind::Ball => ball(trial, scenario, refusal),
        Kind::Margin => margin(trial, refusal),
        Kind::Approach => {
            let own = 1e3 * scenario.process.approach_distance;
            let tried = [0.5, 0.25, 0.1].map(|share| down(share * own).max(1.0));
            let key = "process.approach_distance_mm";
            single(trial, kind, "a shorter approach", key, &tried)
        }
        Kind::Spindle => {
            let tried = ["tool.spindle_lead_deg", "tool.spindle_lean_deg"];
            let angles = spindle_angles(refusal);
            let tried = tried.iter().flat_map(|key| {
                angles
                    .iter()
                    .map(|angle| vec![KeyValue::number(*key, *angle)])
            });
            let friction = held_back(scenario);
            first(trial, kind, "the spindle leaned", tried.collect(), friction)
        }
        Kind::SpindleTorque => {
            let torque = match refusal {
                CellError::SpindleStalls { torque, .. } => 1e3 * torque,
                _ => return None,
            };
            let tried = MORE.map(|times| up(times * torque));
            let key = "tool.stall_torque_n_mm";
            single(trial, kind, "a stronger spindle", key, &tried)
        }
        _ => None,
    }
}

/// Force that the seals may hold back of what a controller without a load cell sets [N]; one with a load cell takes it out.
pub(super) fn held_back(scenario: &Scenario) -> f64 {
    match scenario.controller.law {
        ForceLaw::OpenLoop => scenario.nominal.device.seal_friction.static_force,
        _ => 0.0,
    }
}

/// The first of several changes that passes.
pub(super) fn first(
    trial: &Trial<'_>,
    kind: Kind,
    words: &str,
    tried: Vec<Vec<KeyValue>>,
    friction: f64,
) -> Option<Remedy> {
    let mut tried = tried.into_iter().filter(|edits| !edits.is_empty());
    let edits = tried.find(|edits| trial.passes(edits, friction))?;
    Some(Remedy {
        kind: kind.name(),
        words: words.to_owned(),
        edits,
    })
}

/// The first of several values of a key that passes.
fn single(trial: &Trial<'_>, kind: Kind, words: &str, key: &str, values: &[f64]) -> Option<Remedy> {
    let tried = values
        .iter()
        .map(|&value| vec![KeyValue::number(key, value)]);
    let friction = trial.scenario(&[]).map_or(0.0, |own| held_back(&own));
    first(trial, kind, words, tried.collect(), friction)
}

/// Force of the process and of those passes that have their own, as `new` makes it of the old [N].
fn force_edits(scenario: &Scenario, new: &dyn Fn(f64) -> f64) -> Vec<KeyValue> {
    let own = scenario.process.force;
    let mut edits = Vec::new();
    let mut change = |key: String, old: f64| {
        if (new(old) - old).abs() > 0.0 {
            edits.push(KeyValue::number(key, new(old)));
        }
    };
    change("process.force_n".to_owned(), own);
    for (index, pass) in scenario.passes.iter().enumerate() {
        if let Some(force) = pass.force {
            change(format!("pass[{index}].force_n"), force);
        }
    }
    edits
}

fn less_force(trial: &Trial<'_>, scenario: &Scenario, refusal: &CellError) -> Option<Remedy> {
    let most = match refusal {
        CellError::Supply { attainable, .. } => attainable[1],
        CellError::SpindleStalls {
            force,
            torque,
            stall_torque,
            ..
        } => force * stall_torque / torque,
        _ => scenario.process.force,
    };
    // What just can be is near to a limit; from there down.
    let tried = LESS.map(|share| down(share * most));
    let tried = tried.into_iter().filter(|force| *force >= 0.1);
    let tried = tried.map(|force| force_edits(scenario, &|own| own.min(force)));
    first(trial, Kind::LessForce, "less force", tried.collect(), 0.0)
}

/// Less mass, or a pressure that carries it; the seals hold back as much as they do at rest.
fn weight(
    kind: Kind,
    trial: &Trial<'_>,
    scenario: &Scenario,
    refusal: &CellError,
) -> Option<Remedy> {
    let CellError::Weight {
        mass,
        most_mass,
        least_opposing,
        ..
    } = refusal
    else {
        return None;
    };
    let parameters = &scenario.nominal.device;
    let friction = parameters.seal_friction.static_force;
    if kind == Kind::Mass {
        // By the share that the tool's axis has of gravity the force along it is most_mass times that.
        let gravity = scenario.simulation.gravity.length();
        let least = most_mass - friction / gravity;
        let masses = [*most_mass, least].into_iter().filter(|mass| *mass > 0.0);
        let tried = masses.flat_map(|most| LESS.map(|share| down(share * most)));
        let tried = tried.filter(|tried| *tried >= 0.05 && tried < mass);
        let key = "device.override.moving_mass_kg";
        let tried = tried.map(|mass| vec![KeyValue::number(key, mass)]);
        return first(trial, kind, "a lighter slide", tried.collect(), 0.0);
    }
    let area = parameters.areas().retracting;
    let pressures = [*least_opposing, least_opposing + friction / area];
    let tried = pressures
        .iter()
        .flat_map(|least| MORE.map(|times| (1e-3 * times * least).ceil() / 100.0));
    let key = "device.override.opposing_pressure_bar_gauge";
    let tried = tried.map(|pressure| vec![KeyValue::number(key, pressure)]);
    let words = "a second regulator that carries the weight";
    first(trial, kind, words, tried.collect(), 0.0)
}

fn supply(
    kind: Kind,
    trial: &Trial<'_>,
    scenario: &Scenario,
    refusal: &CellError,
) -> Option<Remedy> {
    let CellError::Supply { needed, supply, .. } = refusal else {
        return None;
    };
    if kind == Kind::SupplyPressure {
        let tried = MORE.map(|times| (1e-4 * times * needed).ceil() / 10.0);
        let tried = tried.into_iter().filter(|pressure| *pressure <= 16.0);
        let key = "device.override.supply_pressure_bar_gauge";
        let tried: Vec<f64> = tried.collect();
        return single(trial, kind, "a higher supply pressure", key, &tried);
    }
    // The force grows with the square of the bore.
    let least = 1e3 * scenario.nominal.device.bore * (needed / supply).sqrt();
    let tried: Vec<f64> = MORE
        .map(|times| (times * least).ceil())
        .into_iter()
        .filter(|bore| *bore <= 300.0)
        .collect();
    single(
        trial,
        kind,
        "larger pistons",
        "device.override.bore_mm",
        &tried,
    )
}

fn working_stroke(trial: &Trial<'_>, scenario: &Scenario, refusal: &CellError) -> Option<Remedy> {
    let full = 1e3 * scenario.nominal.device.full_stroke;
    let tenth = |value: f64| (10.0 * value).round() / 10.0;
    let CellError::ShiftBeyondStroke { from, to, .. } = refusal else {
        return None;
    };
    // Both ends of the way as far from the ends of the stroke.
    let now = 1e3 * scenario.process.working_stroke;
    let tried = [tenth(now + 0.5 * full - 500.0 * (from + to))];
    let inside = |stroke: &f64| *stroke >= 0.1 && *stroke < full;
    let tried: Vec<f64> = tried.into_iter().filter(inside).collect();
    let key = "process.working_stroke_mm";
    single(
        trial,
        Kind::WorkingStroke,
        "another working stroke",
        key,
        &tried,
    )
}

fn ball(trial: &Trial<'_>, scenario: &Scenario, refusal: &CellError) -> Option<Remedy> {
    let own = 1e3 * scenario.nominal.mounting.tool_radius;
    let tried = match refusal {
        CellError::BallTooLarge { largest, .. } => {
            [0.97, 0.9, 0.8, 0.65].map(|share| 1e3 * share * largest)
        }
        _ => [0.8, 0.6, 0.4, 0.2].map(|share| share * own),
    };
    let tried = tried.map(|radius| (10.0 * radius).floor() / 10.0);
    let tried: Vec<f64> = tried.into_iter().filter(|radius| *radius >= 0.5).collect();
    let key = "device.override.tool_ball_radius_mm";
    single(trial, Kind::Ball, "another ball", key, &tried)
}

fn margin(trial: &Trial<'_>, refusal: &CellError) -> Option<Remedy> {
    let CellError::Plan { source, .. } = refusal else {
        return None;
    };
    let PlanError::Waypoint {
        obstacle: Obstacle::Collision(meeting),
        ..
    } = &**source
    else {
        return None;
    };
    let gap = (-1e4 * meeting.depth).floor() / 10.0;
    let tried: Vec<f64> = [gap - 0.1, 0.5 * gap]
        .map(|margin| (10.0 * margin).floor() / 10.0)
        .into_iter()
        .filter(|margin| *margin >= 0.5)
        .collect();
    single(
        trial,
        Kind::Margin,
        "less clearance",
        "collision.margin_mm",
        &tried,
    )
}

/// Angles of the spindle's axis that are tried [deg].
fn spindle_angles(refusal: &CellError) -> Vec<f64> {
    match refusal {
        CellError::ConeOffEdge { needed, .. } => {
            let needed = needed.to_degrees().round();
            vec![needed, -needed]
        }
        _ => vec![45.0, -45.0, 30.0],
    }
}

/// Less acceleration, with a jerk that goes with it.
fn acceleration(trial: &Trial<'_>, scenario: &Scenario) -> Option<Remedy> {
    let process = &scenario.process;
    let tried = [0.5, 0.2, 0.05].map(|share| {
        let number = |key: &str, own: f64| KeyValue::number(key, down(1e3 * share * own));
        vec![
            number("process.acceleration_mm_per_s2", process.acceleration),
            number("process.jerk_mm_per_s3", process.jerk),
        ]
    });
    let friction = held_back(scenario);
    let words = "less acceleration";
    first(trial, Kind::Acceleration, words, tried.to_vec(), friction)
}

/// Speeds lowered, phase by phase, until no axis is too fast.
fn feed(trial: &Trial<'_>, scenario: &Scenario, refusal: &CellError) -> Option<Remedy> {
    let friction = held_back(scenario);
    let remedy = |edits| Remedy {
        kind: Kind::Feed.name(),
        words: "slower".to_owned(),
        edits,
    };
    let mut speeds = Speeds::of(scenario);
    let (mut phase, mut share) = too_fast(refusal)?;
    for _ in 0..PHASES {
        speeds.lower(phase, share);
        let edits = speeds.edits(scenario);
        match trial.checked(&edits)? {
            Ok(cell) => {
                if trial.runs_well(&cell, friction) {
                    return Some(remedy(edits));
                }
                (phase, share) = ("follow", 0.8);
            }
            Err(error) => (phase, share) = too_fast(&error)?,
        }
    }
    None
}

/// The phase in which an axis is too fast, and the share of the speed at which it is not.
fn too_fast(error: &CellError) -> Option<(&'static str, f64)> {
    let CellError::Plan { source, .. } = error else {
        return None;
    };
    match &**source {
        PlanError::Waypoint {
            phase,
            obstacle: Obstacle::Velocity { value, limit, .. },
            ..
        } => Some((phase, BELOW * limit / value.abs())),
        _ => None,
    }
}

/// Speeds of the phases [mm/s].
struct Speeds {
    feed: f64,
    corner: f64,
    passes: Vec<Option<f64>>,
    approach: f64,
    engage: f64,
}

impl Speeds {
    fn of(scenario: &Scenario) -> Self {
        let process = &scenario.process;
        Self {
            feed: 1e3 * process.feed,
            corner: 1e3 * process.corner_feed,
            passes: (scenario.passes.iter())
                .map(|pass| pass.feed.map(|feed| 1e3 * feed))
                .collect(),
            approach: 1e3 * process.approach_speed,
            engage: 1e3 * process.engage_speed,
        }
    }

    fn lower(&mut self, phase: &str, share: f64) {
        let lower = |speed: &mut f64| *speed = down(*speed * share);
        match phase {
            "approach" => lower(&mut self.approach),
            "engage" => lower(&mut self.engage),
            "retract" => {
                lower(&mut self.approach);
                lower(&mut self.engage);
            }
            _ => {
                lower(&mut self.feed);
                lower(&mut self.corner);
                self.passes.iter_mut().flatten().for_each(lower);
            }
        }
    }

    fn edits(&self, scenario: &Scenario) -> Vec<KeyValue> {
        let own = Self::of(scenario);
        let mut edits = Vec::new();
        let mut change = |key: String, old: f64, new: f64| {
            if new < old {
                edits.push(KeyValue::number(key, new));
            }
        };
        change("process.feed_mm_per_s".to_owned(), own.feed, self.feed);
        // Half the feed unless it is given.
        if (own.corner - 0.5 * own.feed).abs() > 1e-9 {
            let key = "process.corner_feed_mm_per_s".to_owned();
            change(key, own.corner, self.corner.min(self.feed));
        }
        for (index, (old, new)) in own.passes.iter().zip(&self.passes).enumerate() {
            if let (Some(old), Some(new)) = (old, new) {
                change(format!("pass[{index}].feed_mm_per_s"), *old, *new);
            }
        }
        let key = "process.approach_speed_mm_per_s".to_owned();
        change(key, own.approach, self.approach);
        let key = "process.engage_speed_mm_per_s".to_owned();
        change(key, own.engage, self.engage);
        edits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_three_digits_and_no_farther() {
        for (value, low, high) in [
            (145.678, 145.0, 146.0),
            (0.030_049, 0.03, 0.0301),
            (19.4, 19.4, 19.4),
            (1234.0, 1230.0, 1240.0),
            (2.0, 2.0, 2.0),
        ] {
            assert!(
                (down(value) - low).abs() < 1e-12,
                "{value}: {}",
                down(value)
            );
            assert!((up(value) - high).abs() < 1e-12, "{value}: {}", up(value));
        }
    }
}
