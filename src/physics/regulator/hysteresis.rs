//! Play between the set pressure and the pressure that the regulator acts on.
//!
//! ```text
//! p_a = min(max(p_a, p_set - r), p_set + r)          at each change of the set pressure           (play operator, Krasnosel'skii 1989)
//! ```
//!
//! p_a pressure acted on [Pa gauge], p_set set pressure [Pa gauge], r half the width of the play [Pa].
//! The friction of the pilot's spool does this: it follows once the difference is r, and stays after a reversal until it is r the other way.

/// Pressure acted on after a set pressure has come [Pa gauge], from the pressure acted on before it.
pub fn play(acted_on: f64, set_pressure: f64, half_width: f64) -> f64 {
    acted_on
        .max(set_pressure - half_width)
        .min(set_pressure + half_width)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_lags_by_half_the_width_and_stays_after_a_reversal() {
        let mut acted_on = 0.0;
        let mut follow = |set| {
            acted_on = play(acted_on, set, 5e3);
            acted_on
        };
        assert_eq!([4e3, 2e5].map(&mut follow), [0.0, 1.95e5]);
        assert_eq!(
            [1.92e5, 1.9e5, 1.8e5].map(&mut follow),
            [1.95e5, 1.95e5, 1.85e5]
        );
        assert_eq!([0.0, 0.0].map(&mut follow), [5e3, 5e3]);
        assert_eq!(play(3.0, 7.0, 0.0), 7.0);
    }
}
