//! What a tool takes off per time, as a power law of cutting speed, normal force and contact area, lessened by wear.
//!
//! ```text
//! Q = Q_0 (v / v_0)^s ((F - F_t) / (F_0 - F_t))^a (A / A_0)^b e^(-w / w_0)
//! ```
//!
//! Q volume removed per time [m3/s], Q_0 that at the reference point, v cutting speed [m/s], F normal force [N], F_t threshold below which nothing
//! comes off [N], A contact area [m2], w wear: the work of force and speed that the tool has done [J], w_0 that after which it takes off 1/e of what a new tool does;
//! v_0, F_0, A_0 the reference point. Preston's law is a = s = 1, b = 0, F_t = 0 (Preston 1927); Hahn's has a threshold besides (Hahn, Lindsay 1971).
//! Leaves out: that a cutting edge dulls and loads in other ways than by the work that it does; heat.

/// Numbers of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RemovalLaw {
    /// Removal rate at the reference point with a new tool [m3/s].
    pub rate: f64,
    /// Cutting speed of the reference point [m/s].
    pub reference_speed: f64,
    /// Normal force of the reference point [N].
    pub reference_force: f64,
    /// Contact area of the reference point [m2].
    pub reference_area: f64,
    /// Exponent of the cutting speed [1].
    pub speed_exponent: f64,
    /// Exponent of the normal force [1].
    pub force_exponent: f64,
    /// Exponent of the contact area [1].
    pub area_exponent: f64,
    /// Force below which nothing comes off [N].
    pub threshold_force: f64,
    /// Work after which 1/e is left of the removal rate [J]; infinite for a tool that does not wear.
    pub wear_work: f64,
}

impl RemovalLaw {
    /// Preston's law: in proportion to force and speed, `coefficient` being the volume per work of force and speed [m3/J].
    pub fn preston(coefficient: f64) -> Self {
        Self {
            rate: coefficient,
            reference_speed: 1.0,
            reference_force: 1.0,
            reference_area: 1e-6,
            speed_exponent: 1.0,
            force_exponent: 1.0,
            area_exponent: 0.0,
            threshold_force: 0.0,
            wear_work: f64::INFINITY,
        }
    }

    /// Removal rate [m3/s] at a normal force [N], a cutting speed [m/s], a contact area [m2] and a wear [J].
    pub fn removal_rate(&self, force: f64, speed: f64, area: f64, wear: f64) -> f64 {
        let pressing =
            (force - self.threshold_force) / (self.reference_force - self.threshold_force);
        if pressing <= 0.0 || speed <= 0.0 {
            return 0.0;
        }
        let by_area = match self.area_exponent {
            0.0 => 1.0,
            exponent => (area / self.reference_area).powf(exponent),
        };
        self.rate
            * (speed / self.reference_speed).powf(self.speed_exponent)
            * pressing.powf(self.force_exponent)
            * by_area
            * (-wear / self.wear_work).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preston_is_in_proportion_to_force_and_speed_and_knows_no_wear() {
        let law = RemovalLaw::preston(2e-11);
        let rate = law.removal_rate(30.0, 7.0, 5e-6, 1e9);
        assert!((rate - 2e-11 * 210.0).abs() < 1e-20, "{rate}");
        assert_eq!(law.removal_rate(0.0, 7.0, 5e-6, 0.0), 0.0);
        assert_eq!(law.removal_rate(-3.0, 7.0, 5e-6, 0.0), 0.0);
    }

    #[test]
    fn the_reference_point_has_the_reference_rate_whatever_the_exponents() {
        let law = RemovalLaw {
            rate: 4.2e-9,
            reference_speed: 17.0,
            reference_force: 6.0,
            reference_area: 50e-6,
            speed_exponent: 1.72,
            force_exponent: 2.36,
            area_exponent: -0.9,
            threshold_force: 1.5,
            wear_work: 800.0,
        };
        assert!((law.removal_rate(6.0, 17.0, 50e-6, 0.0) - 4.2e-9).abs() < 1e-22);
        let worn = law.removal_rate(6.0, 17.0, 50e-6, 800.0);
        assert!((worn - 4.2e-9 / std::f64::consts::E).abs() < 1e-20);
        assert_eq!(law.removal_rate(1.5, 17.0, 50e-6, 0.0), 0.0);
        let steeper = (law.removal_rate(10.5, 17.0, 50e-6, 0.0) / 4.2e-9).ln() / 2f64.ln();
        assert!((steeper - 2.36).abs() < 1e-12, "{steeper}");
    }
}
