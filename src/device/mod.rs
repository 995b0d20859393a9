//! The intelligent deburring control device: regulator, line, 5/2 valve, two chambers, seals, piston and end stops, coupled.
//!
//! The device does not know what loads its piston. A bench, a recording and the slide of a cell put a [`Load`] on it and get the whole device integrated with
//! the piston ([`Device::advance_loaded`]); who holds the piston at a speed gets a force back ([`Device::advance`]). Either way every line of the device is the same.

mod integrate;
mod leaks;
mod line_step;
mod load;
mod parameters;
mod piston;
mod pneumatics;
mod pressure_map;
mod rates;
mod state;

pub use load::{FINE_SWING, Load, PistonMotion};
pub use parameters::DeviceParameters;
pub use pneumatics::{Device, DeviceForce};
pub use pressure_map::PressureMap;
pub use state::{AirState, DeviceState, Disturbance, EnergyLedger};

#[cfg(test)]
mod tests;
