//! Force that a device can be relied upon to give at rest.
//!
//! ```text
//! F_least = max(0, M g_a + F_b),   F_greatest = K A_1 p_max + M g_a - F_b
//! ```
//!
//! M moving mass [kg], g_a component of gravity along extension [m/s2], F_b breakaway friction of the seals [N], which holds either way,
//! K A_1 p_max force of the largest set pressure that the supply can give [N].

use crate::device::{DeviceParameters, PressureMap};
use crate::scenario::largest_set_pressure;
use crate::sensing::CommandChain;

/// Least and greatest force [N], with gravity along extension between two values [m/s2].
pub(super) fn force_range(
    device: &DeviceParameters,
    command: &CommandChain,
    gravity: [f64; 2],
) -> [f64; 2] {
    let map = PressureMap::new(device);
    let regulator = &device.regulator;
    let largest = largest_set_pressure(command).min(regulator.supply / regulator.gain.max(1.0));
    let breakaway = device.seal_friction.static_force;
    [
        (map.force(0.0, gravity[1]) + breakaway).max(0.0),
        map.force(largest, gravity[0]) - breakaway,
    ]
}

/// The forces that lie in both ranges.
pub(super) fn intersection(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].max(other[0]), one[1].min(other[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::load_device;

    #[test]
    fn weight_widens_or_narrows_it_and_seals_narrow_it() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/device.toml");
        let mut device = load_device(path.as_ref()).unwrap().1.device;
        assert_eq!(device.seal_friction.static_force, 14.0);
        device.seal_friction.static_force = 0.0;
        let near = |found: [f64; 2], expected: [f64; 2]| {
            let close = |i: usize| (found[i] - expected[i]).abs() < 1e-3;
            assert!(close(0) && close(1), "{found:?} {expected:?}");
        };
        // 2 pi/4 (32 mm)^2 x 6 bar = 965.097 N; 4 kg.
        let range =
            |device: &DeviceParameters, gravity| force_range(device, &CommandChain::Ideal, gravity);
        near(range(&device, [0.0; 2]), [0.0, 965.097]);
        near(range(&device, [9.81; 2]), [39.24, 965.097 + 39.24]);
        near(range(&device, [-9.81; 2]), [0.0, 965.097 - 39.24]);
        device.seal_friction.static_force = 12.0;
        near(range(&device, [-9.81, 5.0]), [32.0, 965.097 - 39.24 - 12.0]);
        // A regulator that gives less than its set pressure reaches less, one that gives more is still held to the supply.
        device.regulator.gain = 0.9;
        near(range(&device, [0.0; 2]), [12.0, 0.9 * 965.097 - 12.0]);
        device.regulator.gain = 1.2;
        near(range(&device, [0.0; 2]), [12.0, 965.097 - 12.0]);
    }
}
