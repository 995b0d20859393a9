//! The link from an arm's motion to the torques of its drives, by itself: dry friction of each joint.
//!
//! ```text
//! tau_measured - tau_expected = b_r + c_r . C + F sat(v)        F friction [N m], sat(v) = v/sqrt(v^2 + v_0^2), b_r and c_r of recording r
//! ```
//!
//! C is what the contact force takes of the drive along its normal, across it, and by the tool's friction: a ball that stands off a sharp edge by a tenth of its
//! radius is pressed on another normal, by a tenth of the force, and a load cell's gain and the tool's friction are known roughly. What a drive does beside
//! that while the tool rides carries no information on its friction. (Partialling out: Frisch, Waugh, Econometrica 1, 1933.)
//! Ordinary least squares; what is left is not white, so that its samples count for as many as are independent of each other (first-order autocorrelation:
//! Bartlett, J. R. Stat. Soc. 8, 1946). A drive's torque is known through a torque constant, and its load through a model: neither better than the belief's
//! tolerance. Nor is it known better than a current converter resolves of what the drive is rated for: a joint that carries nothing shows friction of a
//! thousandth of that from the bends and turns of others. What a model leaves out is the same over a whole recording: friction is known no better than the recordings agree on it.

use crate::diagnosis::fit::free::{Prior, free_of};
use crate::diagnosis::search::EstablishedEffect;
use crate::diagnosis::settings::Settings;
use crate::effects::JOINT_FRICTION;
use crate::plant::PlantParameters;

/// One drive in one recording.
#[derive(Debug, Clone, Default)]
pub struct DriveLoad {
    /// Torque measured [N m].
    pub torque: Vec<f64>,
    /// Torque expected but for dry friction [N m].
    pub expected: Vec<f64>,
    /// Speed of the motor [rad/s].
    pub rate: Vec<f64>,
    /// Largest torque that the drive is rated for [N m].
    pub rated: f64,
    /// Torque that the contact force along the normal, the same across it, and the tool's friction take [N m].
    pub contact: Vec<[f64; 3]>,
}

impl DriveLoad {
    /// Torque measured beyond what is expected with a dry friction [N m].
    #[must_use]
    pub fn departures(&self, friction: f64) -> Vec<f64> {
        (0..self.torque.len())
            .map(|i| {
                let rate = self.rate[i];
                self.torque[i] - self.expected[i] - friction * rate / rate.hypot(STILL)
            })
            .collect()
    }
}

/// Dry friction found of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFriction {
    /// Which, from 0.
    pub joint: usize,
    /// Dry friction [N m].
    pub friction: f64,
    /// Its standard deviation [N m].
    pub deviation: f64,
    /// The nominal value [N m].
    pub nominal: f64,
    /// Readings that count as independent.
    pub count: f64,
}

/// Speed v_0 [rad/s].
const STILL: f64 = 1e-3;
/// Uncertainty of a joint's nominal friction, relative to it [1]: no data sheet says more.
const KNOWN: f64 = 0.03;
/// Uncertainty of a drive's torque, relative to what it is rated for [1]: ten bits of a current converter.
const RESOLVED: f64 = 1e-3;
/// Share of a column beside those before it below which it carries no new information [1].
const NOTHING_NEW: f64 = 1e-6;
/// Sum of squares of sat(v) about its mean below which a joint hardly changed its speed, and nothing can be said.
const LEAST_CHANGE: f64 = 5.0;

/// Friction of a joint from its drive in all recordings; none where its speed hardly changed.
#[must_use]
pub fn joint_friction(
    joint: usize,
    drives: &[DriveLoad],
    nominal: f64,
    tolerance: f64,
) -> Option<JointFriction> {
    let (mut change, mut product, mut largest, mut rated) = (0.0, 0.0, 0.0f64, 0.0f64);
    let mut centred: Vec<Vec<[f64; 2]>> = Vec::new();
    for drive in drives {
        rated = rated.max(drive.rated);
        let rows: Vec<[f64; 2]> = (0..drive.torque.len())
            .map(|i| {
                let rate = drive.rate[i];
                largest = largest.max(drive.expected[i].abs());
                [
                    drive.torque[i] - drive.expected[i],
                    rate / rate.hypot(STILL),
                ]
            })
            .collect();
        let rows = beside_contact(rows, &drive.contact);
        change += rows.iter().map(|row| row[1] * row[1]).sum::<f64>();
        product += rows.iter().map(|row| row[0] * row[1]).sum::<f64>();
        centred.push(rows);
    }
    if change < LEAST_CHANGE {
        return None;
    }
    let friction = product / change;
    let (mut square, mut next, mut count) = (0.0, 0.0, 0.0);
    for rows in &centred {
        let left: Vec<f64> = rows.iter().map(|row| row[0] - friction * row[1]).collect();
        square += left.iter().map(|l| l * l).sum::<f64>();
        next += left.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
        count += left.len() as f64;
    }
    let likeness = (next / square.max(f64::MIN_POSITIVE)).clamp(0.0, 0.999);
    let independent = (1.0 - likeness) / (1.0 + likeness);
    let scatter = (square / count / (change * independent)).sqrt();
    let scatter = scatter.max(disagreement(&centred, friction));
    Some(JointFriction {
        joint,
        friction,
        deviation: scatter
            .hypot(tolerance * largest)
            .hypot(RESOLVED * rated)
            .hypot(KNOWN * nominal),
        nominal,
        count: count * independent,
    })
}

/// Two columns less what a constant and the contact's part of the torque take of them.
fn beside_contact(mut rows: Vec<[f64; 2]>, contact: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let mut columns = vec![vec![1.0; rows.len()]];
    columns.extend((0..3).map(|k| contact.iter().map(|row| row[k]).collect::<Vec<f64>>()));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Gram and Schmidt, twice for what rounding leaves.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut column in columns.into_iter().filter(|c| c.len() == rows.len()) {
        let before = dot(&column, &column).sqrt();
        for known in basis.iter().chain(&basis) {
            let share = dot(known, &column);
            (column.iter_mut().zip(known)).for_each(|(value, known)| *value -= share * known);
        }
        let after = dot(&column, &column).sqrt();
        if after > NOTHING_NEW * before {
            for value in &mut column {
                *value /= after;
            }
            basis.push(column);
        }
    }
    for known in &basis {
        for k in 0..2 {
            let share: f64 = rows
                .iter()
                .zip(known)
                .map(|(row, known)| row[k] * known)
                .sum();
            (rows.iter_mut().zip(known)).for_each(|(row, known)| row[k] -= share * known);
        }
    }
    rows
}

/// Standard deviation of the friction by how far the recordings' own differ, each weighed by what it tells [N m].
fn disagreement(recordings: &[Vec<[f64; 2]>], friction: f64) -> f64 {
    let sums = recordings.iter().map(|rows| {
        let change: f64 = rows.iter().map(|row| row[1] * row[1]).sum();
        let product: f64 = rows.iter().map(|row| row[0] * row[1]).sum();
        (change, product)
    });
    let informative: Vec<(f64, f64)> = sums.filter(|(change, _)| *change > 0.0).collect();
    if informative.len() < 2 {
        return 0.0;
    }
    let all: f64 = informative.iter().map(|(change, _)| change).sum();
    let spread: f64 = (informative.iter())
        .map(|(change, product)| change * (product / change - friction).powi(2))
        .sum();
    (spread / all / (informative.len() - 1) as f64).sqrt()
}

impl JointFriction {
    /// Whether it differs from its nominal value, by Schwarz's criterion, as for any effect.
    #[must_use]
    pub fn differs(&self) -> bool {
        let gain = ((self.friction - self.nominal) / self.deviation).powi(2);
        gain > self.count.max(1.0).ln() + Settings::DEFAULT.look_elsewhere
    }

    /// The effect, if it does.
    #[must_use]
    pub fn shown(&self, plant: &PlantParameters) -> Option<EstablishedEffect> {
        let effect = &JOINT_FRICTION[self.joint];
        let mut numbers = free_of(effect, plant, &[self.friction]);
        for number in &mut numbers {
            number.prior = Prior::Normal {
                mean: self.friction,
                deviation: self.deviation,
            };
        }
        self.differs()
            .then_some(EstablishedEffect { effect, numbers })
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    use super::*;

    /// A drive whose joint rests, moves and rests again, under a load that grows.
    fn drive(friction: f64) -> DriveLoad {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut drive = DriveLoad::default();
        for i in 0..600 {
            let rate = if (150..450).contains(&i) { 0.03 } else { 0.0 };
            let expected = 80.0 + 0.01 * f64::from(i);
            let noise: f64 = random.sample(StandardNormal);
            drive.rate.push(rate);
            drive.expected.push(expected);
            let rubs = friction * rate / f64::hypot(rate, STILL);
            drive.torque.push(expected + 1.5 + rubs + 0.3 * noise);
        }
        drive
    }

    #[test]
    fn a_joint_that_rubs_is_found_and_sized_and_a_nominal_one_is_left_alone() {
        let found = joint_friction(1, &[drive(14.0)], 1.0, 0.005).unwrap();
        assert!((found.friction - 14.0).abs() < 0.3, "{found:?}");
        assert!(found.differs());
        assert!(
            !joint_friction(1, &[drive(1.0)], 1.0, 0.005)
                .unwrap()
                .differs()
        );
    }

    /// With backlash a ball stood half a millimetre off its edge: 150 N on another normal were 11 N m at the shoulder while it rode, and its joint "rubbed".
    #[test]
    fn a_force_on_another_normal_is_no_friction() {
        let mut rides = drive(0.0);
        for i in 0..rides.torque.len() {
            let across = if (150..450).contains(&i) {
                90.0 + 0.05 * i as f64
            } else {
                0.0
            };
            rides.contact.push([0.7 * across, across, 0.0]);
            // Before it rides the joint moves freely.
            if (20..120).contains(&i) {
                rides.rate[i] = -0.03;
            }
            rides.torque[i] += 0.1 * across;
        }
        let found = joint_friction(1, std::slice::from_ref(&rides), 0.0, 0.005).unwrap();
        assert!(!found.differs() && found.friction.abs() < 0.5, "{found:?}");
        for i in 0..rides.torque.len() {
            rides.torque[i] += 14.0 * rides.rate[i] / rides.rate[i].hypot(STILL);
        }
        let found = joint_friction(1, &[rides], 0.0, 0.005).unwrap();
        assert!((found.friction - 14.0).abs() < 0.5, "{found:?}");
    }

    /// A wrist that carries nothing was said to rub by 0.0022 N m "above 99.9 %": a backlash of another joint turned it by a hair.
    #[test]
    fn less_than_a_drive_resolves_is_no_friction() {
        let mut idle = drive(0.0);
        idle.rated = 50.0;
        for i in 0..idle.torque.len() {
            let rate = idle.rate[i];
            idle.expected[i] = 0.0;
            idle.torque[i] = 2.2e-3 * rate / rate.hypot(STILL);
        }
        let found = joint_friction(5, std::slice::from_ref(&idle), 0.0, 0.005).unwrap();
        assert!((found.friction - 2.2e-3).abs() < 1e-9 && !found.differs());
        for (torque, rate) in idle.torque.iter_mut().zip(&idle.rate) {
            *torque = 2.2 * rate / rate.hypot(STILL);
        }
        let found = joint_friction(5, &[idle], 0.0, 0.005).unwrap();
        assert!(found.differs(), "{found:?}");
    }

    #[test]
    fn of_a_joint_that_does_not_move_nothing_is_said() {
        let mut still = drive(9.0);
        still.rate.fill(0.0);
        assert_eq!(joint_friction(0, &[still], 1.0, 0.005), None);
    }
}
