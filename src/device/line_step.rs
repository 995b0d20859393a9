//! A sub-step of a device with a line: explicit in everything but the air in the line, which a short wide line exchanges in less than a microsecond.
//!
//! The pair ARK4(3)6L[2]SA of order four (Kennedy and Carpenter, Appl. Numer. Math. 44, 2003): six stages, and at each of the last five the line's
//! mass solves one equation, monotonic in the pressure; a reservoir that no longer holds the regulator's pressure drives the line, and is solved with it. Its implicit half is stable however fast the line is, damps what is faster than the
//! sub-step, and ends on its last stage, so that a fast line comes out where inflow and outflow balance. The method of order three that is embedded in it tells
//! a sub-step's error, by which its length is chosen (`integrate`).

use std::borrow::Borrow;

use super::DeviceParameters;
use super::integrate::{Flow, Mode, Outside, Step, Surroundings};
use super::load::Load;
use super::state::AirState;
use crate::physics::flow_slope::FlowSlope;
use crate::physics::hose::Hose;
use crate::physics::line_chain::{LineChain, UPSTREAM};

/// Share of the step that is implicit [1].
const IMPLICIT_SHARE: f64 = 0.25;
/// When in the step the stages are [1].
const NODES: [f64; 6] = [0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0];
/// Weights of the earlier stages in each, of what is explicit.
const EXPLICIT: [[f64; 5]; 6] = [
    [0.0; 5],
    [0.5, 0.0, 0.0, 0.0, 0.0],
    [13_861.0 / 62_500.0, 6_889.0 / 62_500.0, 0.0, 0.0, 0.0],
    [
        -116_923_316_275.0 / 2_393_684_061_468.0,
        -2_731_218_467_317.0 / 15_368_042_101_831.0,
        9_408_046_702_089.0 / 11_113_171_139_209.0,
        0.0,
        0.0,
    ],
    [
        -451_086_348_788.0 / 2_902_428_689_909.0,
        -2_682_348_792_572.0 / 7_519_795_681_897.0,
        12_662_868_775_082.0 / 11_960_479_115_383.0,
        3_355_817_975_965.0 / 11_060_851_509_271.0,
        0.0,
    ],
    [
        647_845_179_188.0 / 3_216_320_057_751.0,
        73_281_519_250.0 / 8_382_639_484_533.0,
        552_539_513_391.0 / 3_454_668_386_233.0,
        3_354_512_671_639.0 / 8_306_763_924_573.0,
        4_040.0 / 17_871.0,
    ],
];
/// The same of what is implicit, without its own share.
const IMPLICIT: [[f64; 5]; 6] = [
    [0.0; 5],
    [0.25, 0.0, 0.0, 0.0, 0.0],
    [8_611.0 / 62_500.0, -1_743.0 / 31_250.0, 0.0, 0.0, 0.0],
    [
        5_012_029.0 / 34_652_500.0,
        -654_441.0 / 2_922_500.0,
        174_375.0 / 388_108.0,
        0.0,
        0.0,
    ],
    [
        15_267_082_809.0 / 155_376_265_600.0,
        -71_443_401.0 / 120_774_400.0,
        730_878_875.0 / 902_184_768.0,
        2_285_395.0 / 8_070_912.0,
        0.0,
    ],
    [
        82_889.0 / 524_892.0,
        0.0,
        15_625.0 / 83_664.0,
        69_875.0 / 102_672.0,
        -2_260.0 / 8_211.0,
    ],
];

/// Weights of the method of order three that is embedded, less those of order four.
const EMBEDDED: [f64; 6] = [
    4_586_570_599.0 / 29_645_900_160.0 - 82_889.0 / 524_892.0,
    0.0,
    178_811_875.0 / 945_068_544.0 - 15_625.0 / 83_664.0,
    814_220_225.0 / 1_159_782_912.0 - 69_875.0 / 102_672.0,
    -3_700_637.0 / 11_593_932.0 + 2_260.0 / 8_211.0,
    61_727.0 / 225_920.0 - 0.25,
];

/// The largest error of a step by its stages' rates, in proportion to the air in each chamber and to the stroke, over the step's length [1/s].
fn error_of(rates: &[Flow; 6], start: &Flow, full_stroke: f64) -> f64 {
    let off = |rate: fn(&Flow) -> f64| {
        let pairs = EMBEDDED.iter().zip(rates);
        pairs
            .map(|(weight, rates)| weight * rate(rates))
            .sum::<f64>()
            .abs()
    };
    let chambers = [
        off(|flow| flow.air.masses[0]) / start.air.masses[0],
        off(|flow| flow.air.masses[1]) / start.air.masses[1],
    ];
    (off(|flow| flow.motion.stroke) / full_stroke)
        .max(chambers[0])
        .max(chambers[1])
}

impl<L: Load, P: Borrow<DeviceParameters>> Surroundings<'_, L, P> {
    /// One step of the pair.
    pub(super) fn line_step<const LEDGER: bool>(
        &self,
        hose: &Hose,
        start: &Flow,
        from: &Outside<L::Now>,
        h: f64,
        mode: Mode,
    ) -> Step<L::Now> {
        let mut rates = [*start; 6];
        let mut at = *from;
        let mut feed = Feed::of(&start.air);
        let upstream = hose.segments() - 1;
        for stage in 0..6 {
            if stage > 0 {
                at = self.outside(from.time + NODES[stage] * h);
            }
            let mut flow = *start;
            let mut held = Feed::of(&start.air);
            for earlier in 0..stage {
                flow = flow.after(&rates[earlier], h * EXPLICIT[stage][earlier], false);
                let weight = h * IMPLICIT[stage][earlier];
                held.line += weight * rates[earlier].air.hose_mass;
                held.reservoir += weight * rates[earlier].air.reservoir_mass;
                for j in 0..upstream {
                    held.upstream[j] += weight * rates[earlier].air.upstream[j];
                }
            }
            if stage > 0 {
                let share = h * IMPLICIT_SHARE;
                feed = self.feed(hose, &flow, at.outlet, (held, share));
            }
            feed.put(&mut flow.air);
            rates[stage] = self.rates::<LEDGER>(&flow, start.motion.stroke, &at, mode);
        }
        let weights = IMPLICIT[5].iter().chain([&IMPLICIT_SHARE]);
        let mut end = *start;
        for (weight, rates) in weights.clone().zip(&rates) {
            end = end.after(rates, h * weight, LEDGER);
        }
        // The last stage is the end but for rounding, which a fast line would take for a flow.
        let mut summed = start.air.line_mass();
        for (weight, rates) in weights.zip(&rates) {
            summed += h * weight * rates.air.line_mass();
        }
        feed.put(&mut end.air);
        end.air.entered += end.air.line_mass() - summed;
        Step {
            error: h * error_of(&rates, start, self.device.parameters().full_stroke),
            flow: end,
            end: at,
        }
    }
}

/// Implicit state: air before the valve [kg].
#[derive(Debug, Clone, Copy)]
struct Feed {
    /// In the last segment.
    line: f64,
    /// In those before.
    upstream: [f64; UPSTREAM],
    /// 0 without one.
    reservoir: f64,
}

impl Feed {
    fn of(air: &AirState) -> Self {
        Self {
            line: air.hose_mass,
            upstream: air.upstream,
            reservoir: air.reservoir_mass,
        }
    }

    fn put(&self, air: &mut AirState) {
        air.hose_mass = self.line;
        air.upstream = self.upstream;
        air.reservoir_mass = self.reservoir;
    }
}

impl<L: Load, P: Borrow<DeviceParameters>> Surroundings<'_, L, P> {
    /// Solution of `feed = held + share * rates(feed)` at an outlet pressure of the regulator [Pa gauge] through a valve's supply orifice.
    fn feed(&self, hose: &Hose, flow: &Flow, outlet: f64, (held, share): (Feed, f64)) -> Feed {
        let device = self.device;
        let gas = &device.parameters().gas;
        let fed = self.valve.supplied();
        let volumes = [0, 1].map(|i| device.chambers[i].volume(flow.motion.stroke));
        let after = device.pressures_of(&flow.air, volumes)[fed];
        let backward = (gas.temperature / device.temperature_of(&flow.air, fed)).sqrt();
        let supply_conductance = device.supply_conductance(&self.disturbance);
        let on = |pressure: f64| {
            let FlowSlope { flow, slope } =
                (device.flow).flow_slope(supply_conductance, pressure, after);
            let factor = if pressure < after { backward } else { 1.0 };
            FlowSlope {
                flow: factor * flow,
                slope: factor * slope,
            }
        };
        let capacity = gas.mass(1.0, hose.segment_volume());
        let last_capacity = gas.mass(1.0, hose.last_volume());
        let stored = (last_capacity / share, held.line / last_capacity);
        let chain = hose.segment_resistance().map(|resistance| {
            let kept = held.upstream.map(|mass| mass / capacity);
            LineChain::new(resistance, capacity / share, &kept[..hose.segments() - 1])
        });
        // What the last segment sees of the line before it.
        let (last, gain) = match &chain {
            None => (*hose, 1.0),
            Some(chain) => (hose.last_behind(chain.resistance()), chain.gain()),
        };
        let seen = |before: f64| chain.as_ref().map_or(before, |chain| chain.seen(before));
        let within = |before: f64| last.balance(seen(before), after, stored, on);
        let fed = |before: f64, reservoir: f64| {
            let within = within(before);
            let pressures = chain.map(|chain| chain.pressures(before, within));
            Feed {
                line: last_capacity * within,
                upstream: pressures.map_or(held.upstream, |p| p.map(|p| capacity * p)),
                reservoir,
            }
        };
        let before = gas.atmosphere + outlet;
        let Some(reservoir) = &device.parameters().supply_reservoir else {
            return fed(before, 0.0);
        };
        let drawn = |before: f64| {
            let within = within(before);
            let drawn = last.drawn(seen(before), within, stored.0 + on(within).slope);
            let Some(chain) = &chain else {
                return (within, drawn);
            };
            // What enters the first segment: dp_1/dp_0 = B_1 + ... by two solutions of a linear chain.
            let first = |before: f64, within: f64| {
                let next = if hose.segments() > 1 {
                    chain.pressures(before, within)[0]
                } else {
                    within
                };
                hose.mass_flow(before, next)
            };
            let follows = gain * drawn.slope * chain.resistance();
            let flow = first(before, within);
            let step = 1.0;
            let slope = first(before + step, within + step * (gain - follows)) - flow;
            (within, FlowSlope { flow, slope })
        };
        let (_, pressure) = reservoir.balance(gas, before, (held.reservoir, share), drawn);
        let outlet = before.min(pressure);
        fed(outlet, gas.mass(pressure, reservoir.volume))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All weights with the last, implicit stage's share in its place: explicit, implicit.
    fn tableaux() -> [[[f64; 6]; 6]; 2] {
        let mut pair = [[[0.0; 6]; 6]; 2];
        for stage in 0..6 {
            pair[0][stage][..5].copy_from_slice(&EXPLICIT[stage]);
            pair[1][stage][..5].copy_from_slice(&IMPLICIT[stage]);
            pair[1][stage][stage] = if stage > 0 { IMPLICIT_SHARE } else { 0.0 };
        }
        pair
    }

    #[test]
    fn the_weights_meet_every_condition_of_order_four() {
        let pair = tableaux();
        let weights = pair[1][5];
        let times = |a: &[[f64; 6]; 6], v: [f64; 6]| {
            a.map(|row| row.iter().zip(v).map(|(a, v)| a * v).sum::<f64>())
        };
        let sum = |v: [f64; 6]| weights.iter().zip(v).map(|(w, v)| w * v).sum::<f64>();
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15);
        for power in 0..4 {
            near(
                sum(NODES.map(|c| c.powi(power))),
                1.0 / f64::from(power + 1),
            );
        }
        for a in &pair {
            for (row, node) in times(a, [1.0; 6]).iter().zip(NODES) {
                near(*row, node);
            }
            let once = times(a, NODES);
            near(sum(once), 1.0 / 6.0);
            near(sum(std::array::from_fn(|i| NODES[i] * once[i])), 1.0 / 8.0);
            near(sum(times(a, NODES.map(|c| c * c))), 1.0 / 12.0);
            for b in &pair {
                near(sum(times(b, once)), 1.0 / 24.0);
            }
        }
    }

    #[test]
    fn the_embedded_weights_meet_every_condition_of_order_three_and_not_those_of_four() {
        let pair = tableaux();
        let sum = |v: [f64; 6]| EMBEDDED.iter().zip(v).map(|(w, v)| w * v).sum::<f64>();
        for power in 0..3 {
            assert!(sum(NODES.map(|c| c.powi(power))).abs() < 1e-15, "{power}");
        }
        for a in &pair {
            let once = a.map(|row| row.iter().zip(NODES).map(|(a, c)| a * c).sum::<f64>());
            assert!(sum(once).abs() < 1e-15);
        }
        assert!(sum(NODES.map(|c| c.powi(3))).abs() > 1e-4);
    }
}
