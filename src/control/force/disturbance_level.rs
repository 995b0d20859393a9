//! Estimates of the share of the nominal dry friction and of other disturbances of the force: a Kalman filter with two states.
//!
//! ```text
//! y = o - k f + noise,   o and k walk at random
//! ```
//!
//! y measured force less all that the model explains but dry friction [N], f the nominal dry friction [N], k its true share [1], o everything else
//! [N]. The walk of o is such that the filter follows it with a time constant T_o; that of k, over a time T_k; k begins uncertain by a given share and never
//! gets more uncertain than that. While the tool slides one way the two cannot be distinguished; a reversal separates them.
//! Adaptive friction compensation after Canudas de Wit and Lischinsky 1997; the rest is the disturbance observer's filter (Ohnishi 1987).

/// The load cell's noise that the filter reckons with [N]; only the ratio to the friction matters.
const NOISE: f64 = 1.0;
/// Largest share of the nominal friction that is taken for possible [1].
const LARGEST_SHARE: f64 = 3.0;

/// The filter.
#[derive(Debug, Clone)]
pub(super) struct DisturbanceLevel {
    /// o [N].
    pub offset: f64,
    /// k [1].
    pub share: f64,
    covariance: [[f64; 2]; 2],
    walk: [f64; 2],
    uncertainty: f64,
}

impl DisturbanceLevel {
    /// With T_o and T_k [s], k uncertain by a share [1], at a nominal Coulomb friction [N].
    pub(super) fn new(times: [f64; 2], uncertainty: f64, coulomb: f64, period: f64) -> Self {
        let walk = |time: f64| {
            let gain = period / (time + period);
            NOISE * NOISE * gain * gain / (1.0 - gain)
        };
        let scale = coulomb.max(NOISE);
        Self {
            offset: 0.0,
            share: 1.0,
            covariance: [[walk(times[0]), 0.0], [0.0, uncertainty * uncertainty]],
            walk: [walk(times[0]), walk(times[1]) / (scale * scale)],
            uncertainty,
        }
    }

    /// Takes an unexplained force and the nominal dry friction [N].
    pub(super) fn update(&mut self, unexplained: f64, friction: f64) {
        let p = &mut self.covariance;
        p[0][0] += self.walk[0];
        p[1][1] += self.walk[1];
        self.bound_share();
        let p = &mut self.covariance;
        let seen = [p[0][0] - friction * p[0][1], p[0][1] - friction * p[1][1]];
        let total = seen[0] - friction * seen[1] + NOISE * NOISE;
        let gain = [seen[0] / total, seen[1] / total];
        let error = unexplained - (self.offset - self.share * friction);
        self.offset += gain[0] * error;
        self.share = (self.share + gain[1] * error).clamp(0.0, LARGEST_SHARE);
        p[0][0] -= gain[0] * seen[0];
        p[0][1] -= gain[0] * seen[1];
        p[1][1] -= gain[1] * seen[1];
        p[1][0] = p[0][1];
    }

    /// As `update`, the share of the friction taken for certain.
    pub(super) fn follow(&mut self, unexplained: f64, friction: f64) {
        let variance = self.covariance[0][0] + self.walk[0];
        let gain = variance / (variance + NOISE * NOISE);
        self.offset += gain * (unexplained - (self.offset - self.share * friction));
        self.covariance[0] = [(1.0 - gain) * variance, 0.0];
        self.covariance[1][0] = 0.0;
    }

    /// Scales the second state's uncertainty down to what it may be at most.
    fn bound_share(&mut self) {
        let p = &mut self.covariance;
        let largest = self.uncertainty * self.uncertainty;
        if p[1][1] > largest {
            let factor = (largest / p[1][1]).sqrt();
            p[0][1] *= factor;
            p[1][0] = p[0][1];
            p[1][1] = largest;
        }
    }

    /// The tool has left the part: what was there besides friction is gone.
    pub(super) fn forget_offset(&mut self) {
        self.offset = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_friction_it_is_a_first_order_filter() {
        let mut level = DisturbanceLevel::new([0.02, 1.0], 0.5, 0.0, 1e-3);
        for _ in 0..2000 {
            level.update(0.0, 0.0);
        }
        for _ in 0..20 {
            level.update(5.0, 0.0);
        }
        // One time constant, in steps that are not small against it.
        assert!((level.offset / 5.0 - (1.0 - (-1.0f64).exp())).abs() < 0.02);
    }

    #[test]
    fn an_impact_that_is_only_followed_tells_nothing_of_friction() {
        let mut level = DisturbanceLevel::new([0.02, 1.0], 0.5, 10.0, 1e-3);
        for i in 0..500 {
            let ringing = 100.0 * (f64::from(i) * 0.2).sin() * (f64::from(-i) * 0.01).exp();
            level.follow(ringing - 10.0 * (f64::from(i) * 0.2).cos(), 10.0);
        }
        assert_eq!(level.share, 1.0);
        for _ in 0..500 {
            level.follow(-7.0, 10.0);
        }
        assert!((level.offset - 3.0).abs() < 1e-6, "{}", level.offset);
    }

    #[test]
    fn reversals_tell_the_true_friction() {
        for truth in [0.5, 1.5] {
            let mut level = DisturbanceLevel::new([0.02, 1.0], 0.5, 10.0, 1e-3);
            for i in 0..6000 {
                let friction = if (i / 500) % 2 == 0 { 10.0 } else { -10.0 };
                level.update(2.0 - truth * friction, friction);
            }
            assert!((level.share - truth).abs() < 0.05, "{}", level.share);
            assert!((level.offset - 2.0).abs() < 0.5, "{}", level.offset);
        }
    }
}
