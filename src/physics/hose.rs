//! A line between regulator and valve: resistance, then volume.
//!
//! ```text
//! p_h V_h = m_h R T                                                (lumped line, Richer and Hurmuzlu 2000, without the wave's delay)
//! f Re^2 = K = d^3 (p_in^2 - p_h^2) / (mu^2 l R T),   Re = 4 m_dot / (pi d mu)      (Darcy and Weisbach at the mean density)
//! Re = K / 64                          up to Re 2300               (laminar: Hagen and Poiseuille)
//! Re = 2 sqrt(K) log10(sqrt(K)/2.51)   from sqrt(K) 800, Re 4006   (turbulent, smooth: Colebrook 1939, explicit in the flow)
//! ```
//!
//! V_h volume [m3], m_h air in it [kg], l length [m], d inner diameter [m], mu viscosity [Pa s], f Darcy friction factor [1], p absolute pressures [Pa].
//! For an ideal gas the mean density times the pressure drop is (p_in^2 - p_h^2) / (2 R T), whatever the pressure along the hose.
//! Between the two regimes, where pipes do the one or the other (2300 to 4000: White, Fluid Mechanics, 6.1), a cubic in log Re over log K with the
//! slopes of both: the flow has no kink and never falls as the pressure difference grows.
//!
//! Instead of a tube's law a line can have a constant resistance R_h = (p_in - p_h) / m_dot [Pa s/kg]: one that stands for fittings, or for an
//! effect to be distinguished. Such a line can be distributed (`super::line_chain`): resistance and volume in segments, one behind the other; or spread evenly,
//! with half a segment's volume at either end, of which the first is the regulator's outlet: its error falls with the square of their number.
//! Leaves out: roughness (a plastic hose is smooth); the losses at both ends and the air's acceleration, together 1.5 + 2 ln(p_in/p_h) beside f l/d, as
//! much as 60 to 100 diameters of hose, and with them choking; the wave's delay of l over the speed of sound, 3 ms/m.

use super::flow_slope::FlowSlope;
use super::gas::Gas;
use super::line_chain::MOST_SEGMENTS;

/// Viscosity of air at 20 degrees Celsius [Pa s].
const VISCOSITY: f64 = 1.82e-5;
/// Reynolds number up to which the flow is laminar [1].
const LAMINAR_TO: f64 = 2300.0;
/// sqrt(K) from which it is turbulent [1].
const TURBULENT_FROM: f64 = 800.0;
/// Evaluations at most when a pressure in the line is sought.
const MOST_TRIALS: usize = 60;

/// The line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hose {
    /// Volume [m3].
    pub volume: f64,
    /// Dependence of the flow on the pressures.
    law: LineLaw,
}

/// Dependence of the flow through a line on the pressures at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LineLaw {
    /// In proportion to their difference.
    Constant {
        /// Resistance of each segment [Pa s/kg].
        resistance: f64,
        /// Segments one behind the other.
        segments: usize,
        /// Volume of the last one over that of the others [1].
        last: f64,
    },
    /// As a tube's, laminar and turbulent.
    Tube {
        /// Mass flow over Reynolds number, pi d mu / 4 [kg/s].
        flow: f64,
        /// K over the difference of the squared pressures [1/Pa2].
        drive: f64,
    },
}

impl Hose {
    /// A smooth tube of a length and inner diameter [m].
    pub fn tube(length: f64, diameter: f64, gas: &Gas) -> Self {
        let rt = gas.specific_gas_constant * gas.temperature;
        Self {
            volume: 0.25 * std::f64::consts::PI * diameter * diameter * length,
            law: LineLaw::Tube {
                flow: 0.25 * std::f64::consts::PI * diameter * VISCOSITY,
                drive: diameter.powi(3) / (VISCOSITY * VISCOSITY * length * rt),
            },
        }
    }

    /// A volume [m3] behind a constant resistance [Pa s/kg].
    pub fn lumped(volume: f64, resistance: f64) -> Self {
        Self::in_segments(volume, resistance, 1)
    }

    /// A volume [m3] and a constant resistance [Pa s/kg] spread evenly over a number of segments, from 1 to [`MOST_SEGMENTS`].
    pub fn in_segments(volume: f64, resistance: f64, segments: usize) -> Self {
        let segments = segments.clamp(1, MOST_SEGMENTS);
        Self {
            volume,
            law: LineLaw::Constant {
                resistance: resistance / segments as f64,
                segments,
                last: 1.0,
            },
        }
    }

    /// A volume [m3] and a constant resistance [Pa s/kg] spread evenly along the line.
    pub fn evenly_spread(volume: f64, resistance: f64) -> Self {
        Self {
            volume,
            law: LineLaw::Constant {
                resistance: resistance / MOST_SEGMENTS as f64,
                segments: MOST_SEGMENTS,
                last: 0.5,
            },
        }
    }

    /// Segments one behind the other.
    pub fn segments(&self) -> usize {
        match self.law {
            LineLaw::Constant { segments, .. } => segments,
            LineLaw::Tube { .. } => 1,
        }
    }

    /// Volume of each segment but the last [m3].
    pub fn segment_volume(&self) -> f64 {
        self.volume / self.segments() as f64
    }

    /// Volume of the last segment [m3].
    pub fn last_volume(&self) -> f64 {
        match self.law {
            LineLaw::Constant { last, .. } => last * self.segment_volume(),
            LineLaw::Tube { .. } => self.volume,
        }
    }

    /// The last segment with another constant resistance before it [Pa s/kg].
    #[must_use]
    pub fn last_behind(&self, resistance: f64) -> Self {
        Self::lumped(self.last_volume(), resistance)
    }

    /// Resistance of a segment [Pa s/kg] of a line whose resistance is constant.
    pub fn segment_resistance(&self) -> Option<f64> {
        match self.law {
            LineLaw::Constant { resistance, .. } => Some(resistance),
            LineLaw::Tube { .. } => None,
        }
    }

    /// Mass flow into a segment's volume [kg/s] from the pressure before it and the pressure in it [Pa absolute].
    pub fn mass_flow(&self, before: f64, within: f64) -> f64 {
        self.flow_slope(before, within).flow
    }

    /// That flow, with its slope over the pressure in the line.
    fn flow_slope(&self, before: f64, within: f64) -> FlowSlope {
        match self.law {
            LineLaw::Constant { resistance, .. } => FlowSlope {
                flow: (before - within) / resistance,
                slope: -1.0 / resistance,
            },
            LineLaw::Tube { flow, drive } => {
                // As a product: the difference of squares would round.
                let signed = drive * (before - within) * (before + within);
                let (reynolds, slope) = reynolds(signed.abs());
                FlowSlope {
                    flow: flow * reynolds.copysign(signed),
                    slope: -flow * slope * 2.0 * drive * within,
                }
            }
        }
    }

    /// Pressure drop over mass flow of the smallest flows, about a pressure [Pa absolute]: [Pa s/kg].
    pub fn resistance_at_rest(&self, pressure: f64) -> f64 {
        match self.law {
            LineLaw::Constant {
                resistance,
                segments,
                ..
            } => resistance * segments as f64,
            LineLaw::Tube { .. } => -1.0 / self.flow_slope(pressure, pressure).slope,
        }
    }

    /// Pressure before the line [Pa absolute] that drives a mass flow [kg/s] against a pressure in it [Pa absolute].
    pub fn pressure_before(&self, mass_flow: f64, within: f64) -> f64 {
        match self.law {
            LineLaw::Constant {
                resistance,
                segments,
                ..
            } => within + resistance * segments as f64 * mass_flow,
            LineLaw::Tube { flow, drive } => {
                let k = drive_of(mass_flow.abs() / flow).copysign(mass_flow);
                (within * within + k / drive).max(0.0).sqrt()
            }
        }
    }

    /// Flow into the line, with its slope over the pressure before it when the one in it follows by `balance`; `onward` is the slope of that
    /// balance's storage and outflow together [kg/(s Pa)].
    pub fn drawn(&self, before: f64, within: f64, onward: f64) -> FlowSlope {
        let inward = self.flow_slope(before, within);
        let over_before = match self.law {
            LineLaw::Constant { resistance, .. } => 1.0 / resistance,
            LineLaw::Tube { .. } => -inward.slope * before / within,
        };
        FlowSlope {
            flow: inward.flow,
            slope: over_before * onward / (onward - inward.slope),
        }
    }

    /// Pressure in the line [Pa absolute] at which what comes in is what goes on, as `on` gives it, and what is stored:
    ///
    /// ```text
    /// storage (p - base) = flow(before, p) - on(p)
    /// ```
    ///
    /// `storage` is at least 0 [kg/(s Pa)] and `base` any number [Pa], no more than a first guess if nothing is stored; `on` grows with the pressure
    /// and is 0 at `after` [Pa absolute].
    /// All of it is monotonic: Newton's method, kept between bounds.
    pub fn balance(
        &self,
        before: f64,
        after: f64,
        (storage, base): (f64, f64),
        on: impl Fn(f64) -> FlowSlope,
    ) -> f64 {
        let (mut low, mut high) = (before.min(after), before.max(after));
        if storage > 0.0 {
            // No line empties: a base below nothing is the extrapolation of a longer step.
            low = low.min(base.max(1e-3 * low));
            high = high.max(base);
        }
        let mut pressure = base.max(low).min(high);
        for _ in 0..MOST_TRIALS {
            let (inward, onward) = (self.flow_slope(before, pressure), on(pressure));
            let excess = storage * (pressure - base) - inward.flow + onward.flow;
            if excess > 0.0 {
                high = pressure;
            } else {
                low = pressure;
            }
            let step = excess / (storage - inward.slope + onward.slope);
            let newton = pressure - step;
            let next = if newton >= low && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            // Newton doubles the digits; the drop is what a wide line bends over.
            let drop = (before - next).abs();
            let settled = (next - pressure).abs() <= (1e-8 * next).min(1e-5 * drop) + 1e-15 * next;
            pressure = next;
            if settled {
                break;
            }
        }
        pressure
    }
}

/// Reynolds number and its slope over K.
fn reynolds(k: f64) -> (f64, f64) {
    if k <= 64.0 * LAMINAR_TO {
        return (k / 64.0, 1.0 / 64.0);
    }
    if k >= TURBULENT_FROM * TURBULENT_FROM {
        let (reynolds, exponent) = turbulent(k);
        return (reynolds, exponent * reynolds / k);
    }
    let (start, end) = ((64.0 * LAMINAR_TO).ln(), 2.0 * TURBULENT_FROM.ln());
    let (last, exponent) = turbulent(TURBULENT_FROM * TURBULENT_FROM);
    let width = end - start;
    let s = (k.ln() - start) / width;
    let rise = (last / LAMINAR_TO).ln();
    // Hermite's cubic from slope 1 to the turbulent exponent.
    let cubic = width + exponent * width - 2.0 * rise;
    let square = 3.0 * rise - 2.0 * width - exponent * width;
    let reynolds = LAMINAR_TO * (s * (width + s * (square + s * cubic))).exp();
    let exponent = (width + s * (2.0 * square + s * 3.0 * cubic)) / width;
    (reynolds, exponent * reynolds / k)
}

/// Turbulent Reynolds number and its exponent, d ln Re / d ln K.
fn turbulent(k: f64) -> (f64, f64) {
    let logarithm = (k.sqrt() / 2.51).ln();
    (
        2.0 / std::f64::consts::LN_10 * k.sqrt() * logarithm,
        0.5 + 0.5 / logarithm,
    )
}

/// K of a Reynolds number: Newton's method in logarithms, where the curve is all but straight.
fn drive_of(wanted: f64) -> f64 {
    if wanted <= LAMINAR_TO {
        return 64.0 * wanted;
    }
    let mut k = 64.0 * LAMINAR_TO * (wanted / LAMINAR_TO).powf(1.75);
    for _ in 0..MOST_TRIALS {
        let (found, slope) = reynolds(k);
        let off = (wanted / found).ln();
        k *= (off * found / (slope * k)).exp();
        if off.abs() < 1e-13 {
            break;
        }
    }
    k
}

#[cfg(test)]
mod tests;
