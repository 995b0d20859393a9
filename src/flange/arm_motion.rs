//! The arm's speed towards the workpiece, of what it logs.
//!
//! ```text
//! v_n = v until |v| is least after the command has ended, then -v until it stands, then v, and 0 once it slides
//! ```
//!
//! v_n speed towards the workpiece, v logged speed, a magnitude [m/s]. An arm that is pressed at as its command ends has overrun it, and swings back;
//! the log has no sign, and shows the turn as a dip. Where it stands it is not yet where it was sent: its control brings it back to the part later. What the
//! flange's seals do as they turn (their friction changes its sign) is lost without it.

/// Speed below which the arm is not commanded [m/s].
const STATIONARY_SPEED: f64 = 1e-3;
/// Speed below which it stands [m/s], for a time [s].
const RESTS: (f64, f64) = (2.5e-4, 0.02);
/// Longest time from the end of the command to the dip [s].
const LONGEST: f64 = 0.1;

/// Speed towards the workpiece of logged and commanded speed, which touch at a time [s]; when it slides off [s].
#[must_use]
pub fn towards_part(
    time: &[f64],
    logged: &[f64],
    commanded: &[f64],
    touch: f64,
) -> (Vec<f64>, Option<f64>) {
    let mut towards = logged.to_vec();
    let stationary = |i: &usize| time[*i] > touch && commanded[*i].abs() < STATIONARY_SPEED;
    let Some(ends) = (0..time.len()).find(stationary) else {
        return (towards, None);
    };
    let mut dip = ends;
    while dip + 1 < time.len()
        && logged[dip + 1].abs() <= logged[dip].abs()
        && time[dip] < time[ends] + LONGEST
    {
        dip += 1;
    }
    let slides = (dip..time.len()).find(|i| commanded[*i].abs() >= STATIONARY_SPEED);
    let until = slides.unwrap_or(time.len());
    let mut rested = time[dip];
    for i in (dip + 1).min(until)..until {
        if logged[i].abs() > RESTS.0 {
            rested = time[i];
        }
        if time[i] - rested > RESTS.1 {
            break;
        }
        towards[i] = -logged[i].abs();
    }
    towards[until..].fill(0.0);
    (towards, slides.map(|i| time[i]))
}

#[cfg(test)]
mod tests {
    use super::towards_part;

    #[test]
    fn a_dip_in_the_magnitude_is_a_turn() {
        let time: Vec<f64> = (0..8).map(|i| 0.01 * f64::from(i)).collect();
        let logged = [0.1, 0.1, 0.05, 0.01, 0.02, 0.01, 0.1, 0.1];
        let commanded = [0.1, 0.1, 0.0, 0.0, 0.0, 0.0, 0.1, 0.1];
        let (towards, slides) = towards_part(&time, &logged, &commanded, 0.005);
        assert_eq!(towards, [0.1, 0.1, 0.05, 0.01, -0.02, -0.01, 0.0, 0.0]);
        assert_eq!(slides, Some(time[6]));
    }

    #[test]
    fn an_arm_that_has_stood_comes_back_to_the_part() {
        let time: Vec<f64> = (0..8).map(|i| 0.01 * f64::from(i)).collect();
        let logged = [0.1, 0.01, 0.02, 0.0, 0.0, 0.0, 0.001, 0.001];
        let commanded = [0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let (towards, slides) = towards_part(&time, &logged, &commanded, 0.005);
        assert_eq!(towards, [0.1, 0.01, -0.02, 0.0, 0.0, 0.0, 0.001, 0.001]);
        assert_eq!(slides, None);
    }
}
