//! The intelligent deburring control device: regulator, 5/2 valve, two chambers, piston and end stops, coupled.
//!
//! It knows the motion of its piston only as an input: whoever integrates the piston (the rigid-body cell, a bench rig) hands it over and takes the
//! force back. So every rig shares every line of it.

mod parameters;
mod pneumatics;
mod pressure_map;

pub use parameters::DeviceParameters;
pub use pneumatics::{Device, DeviceForce, DeviceState, PistonMotion};
pub use pressure_map::PressureMap;
