//! Mass flow through an orifice.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) * f(u),   u = p_d / p_u                                   (source paper, eq. 9)
//! f(u)  = sqrt(2 k/(k-1) (u^(2/k) - u^((k+1)/k)))     for u >= r                        (eq. 10)
//!       = sqrt(k (2/(k+1))^((k+1)/(k-1)))             for u <  r
//! r     = (2/(k+1))^(k/(k-1))                                                           (eq. 11)
//! ```
//!
//! A area [m2], C discharge coefficient [1], p_u and p_d absolute pressures upstream and downstream [Pa],
//! R specific gas constant [J/(kg K)], T temperature [K], k ratio of specific heats [1].
//!
//! Valid for either direction: the higher pressure is upstream. Eq. (10) is evaluated to the resolution of a number, but without its powers: `subsonic`.
//!
//! Near u = 1 eq. (10) has infinite slope. Above `LAMINAR_RATIO` the flow is laminar and taken linear in the pressure difference, as Simscape
//! and MapleSim do (their ratio is 0.995 to 0.999); it is closer to 1 here, so that the paper's equation holds nearly everywhere.

use super::flow_slope::FlowSlope;
use super::gas::Gas;
use super::subsonic::Subsonic;

/// Pressure ratio above which the flow is linear in the pressure difference [1].
pub const LAMINAR_RATIO: f64 = 0.999;

/// The flow function with everything that does not change during a run computed once.
#[derive(Debug, Clone, Copy)]
pub struct FlowFunction {
    /// r of eq. (11).
    critical_ratio: f64,
    /// f below the critical ratio.
    choked: f64,
    /// f above the critical ratio.
    subsonic: Subsonic,
    /// f at `LAMINAR_RATIO` over its distance from 1.
    laminar_slope: f64,
    /// 1/sqrt(R T) [s/m].
    inverse_sqrt_rt: f64,
}

impl FlowFunction {
    /// Prepares eqs. (9) to (11) for a gas.
    pub fn new(gas: &Gas) -> Self {
        let k = gas.heat_capacity_ratio;
        let critical_ratio = (2.0 / (k + 1.0)).powf(k / (k - 1.0));
        let subsonic = Subsonic::new(k, critical_ratio);
        Self {
            critical_ratio,
            choked: (k * (2.0 / (k + 1.0)).powf((k + 1.0) / (k - 1.0))).sqrt(),
            subsonic,
            laminar_slope: subsonic.value(LAMINAR_RATIO) / (1.0 - LAMINAR_RATIO),
            inverse_sqrt_rt: 1.0 / (gas.specific_gas_constant * gas.temperature).sqrt(),
        }
    }

    /// f of eq. (10) [1] at a pressure ratio in 0..=1.
    #[inline]
    pub fn value(&self, ratio: f64) -> f64 {
        if ratio < self.critical_ratio {
            self.choked
        } else if ratio > LAMINAR_RATIO {
            self.laminar_slope * (1.0 - ratio)
        } else {
            self.subsonic.value(ratio)
        }
    }

    /// Slope of the linear part [1]: the steepest there is.
    pub fn laminar_slope(&self) -> f64 {
        self.laminar_slope
    }

    /// r of eq. (11) [1].
    pub fn critical_ratio(&self) -> f64 {
        self.critical_ratio
    }

    /// Mass flow from `from` to `to` [kg/s], negative when `to` has the higher pressure. `conductance_area` is A C [m2], pressures absolute [Pa].
    #[inline]
    pub fn mass_flow(&self, conductance_area: f64, from: f64, to: f64) -> f64 {
        let (upstream, downstream, sign) = if from >= to {
            (from, to, 1.0)
        } else {
            (to, from, -1.0)
        };
        sign * conductance_area
            * upstream
            * self.inverse_sqrt_rt
            * self.value(downstream / upstream)
    }

    /// That mass flow with its slope over `from`.
    pub fn flow_slope(&self, conductance_area: f64, from: f64, to: f64) -> FlowSlope {
        let per_pressure = conductance_area * self.inverse_sqrt_rt;
        let outward = from >= to;
        let (upstream, ratio) = if outward {
            (from, to / from)
        } else {
            (to, from / to)
        };
        let (value, slope) = if ratio < self.critical_ratio {
            (self.choked, 0.0)
        } else if ratio > LAMINAR_RATIO {
            (self.laminar_slope * (1.0 - ratio), -self.laminar_slope)
        } else {
            self.subsonic.value_slope(ratio)
        };
        if outward {
            FlowSlope {
                flow: per_pressure * upstream * value,
                slope: per_pressure * (value - ratio * slope),
            }
        } else {
            FlowSlope {
                flow: -per_pressure * upstream * value,
                slope: -per_pressure * slope,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_chokes_at_the_textbook_ratio_and_flow() {
        let function = FlowFunction::new(&Gas::default());
        assert!((function.critical_ratio() - 0.528_282).abs() < 1e-6);
        // Choked flow of air: m_dot = 0.040418 A p / sqrt(T) (gas tables, R = 287.05 J/(kg K)).
        let flow = function.mass_flow(1e-6, 7e5, 1e5);
        assert!((flow / (0.040_414 * 1e-6 * 7e5 / 293.15f64.sqrt()) - 1.0).abs() < 2e-4);
    }

    #[test]
    fn it_equals_eq_10_as_printed_and_is_continuous() {
        let function = FlowFunction::new(&Gas::default());
        let k: f64 = 1.4;
        for i in 0..470 {
            let u = 0.529 + 0.001 * f64::from(i);
            let printed = (2.0 * k / (k - 1.0) * (u.powf(2.0 / k) - u.powf((k + 1.0) / k))).sqrt();
            assert!((function.value(u) - printed).abs() < 1e-13, "u = {u}");
        }
        let r = function.critical_ratio();
        assert!((function.value(r - 1e-12) - function.value(r + 1e-12)).abs() < 1e-9);
        let just_above = function.value(LAMINAR_RATIO + 1e-13);
        assert!((just_above - function.value(LAMINAR_RATIO)).abs() < 1e-9);
        assert_eq!(function.value(1.0), 0.0);
    }

    #[test]
    fn reversing_the_pressures_reverses_the_flow() {
        let function = FlowFunction::new(&Gas::default());
        let forth = function.mass_flow(2e-6, 4e5, 3e5);
        assert!(forth > 0.0);
        assert_eq!(function.mass_flow(2e-6, 3e5, 4e5), -forth);
    }

    #[test]
    fn the_slope_is_the_difference_quotient_of_the_flow() {
        let function = FlowFunction::new(&Gas::default());
        for (from, to) in [
            (7e5, 1e5),
            (3e5, 2e5),
            (2e5, 1.9999e5),
            (2e5, 3e5),
            (2e5, 2.0001e5),
            (1e5, 7e5),
        ] {
            let found = function.flow_slope(2e-6, from, to);
            let flow = function.mass_flow(2e-6, from, to);
            assert!((found.flow / flow - 1.0).abs() < 1e-14, "{from} {to}");
            let at = |from: f64| function.mass_flow(2e-6, from, to);
            let quotient = (at(from + 0.1) - at(from - 0.1)) / 0.2;
            assert!(
                (found.slope - quotient).abs() <= 1e-5 * found.slope,
                "{from} {to}"
            );
        }
    }
}
