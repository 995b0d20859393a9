//! Sensing between the controller and the device: the chain of the source paper's section 3, each stage ideal or real.
//!
//! ```text
//! set pressure -> PWM -> RC -> amplifier -> regulator          set_value, of pwm_filter and amplifier
//! outlet pressure -> linear converter -> ADC -> software       outlet_pressure, of adc
//! contact force -> bridge -> INA125P -> ADC -> software        load_cell, of instrumentation_amplifier and adc
//! stroke -> magnetic sensor, acceleration -> accelerometer     position, accelerometer
//! ```
//!
//! [`chain`] samples them, each with its own stream of noise ([`noise`]), and treats the load cell's noise ([`filter`]).

pub mod accelerometer;
pub mod adc;
pub mod amplifier;
pub mod chain;
pub mod channel;
pub mod filter;
pub mod instrumentation_amplifier;
pub mod load_cell;
pub mod noise;
pub mod outlet_pressure;
pub mod parameters;
pub mod position;
pub mod pwm_filter;
pub mod sample_clock;
pub mod set_value;

pub use accelerometer::AccelerometerParameters;
pub use adc::AdcParameters;
pub use amplifier::AmplifierParameters;
pub use chain::{Readings, SensorChain, Truth};
pub use channel::Measurement;
pub use filter::{Filter, FilterParameters};
pub use instrumentation_amplifier::InstrumentationAmplifierParameters;
pub use load_cell::LoadCellParameters;
pub use outlet_pressure::OutletPressureParameters;
pub use parameters::{CommandChain, SensingParameters};
pub use position::PositionSensorParameters;
pub use pwm_filter::PwmFilterParameters;
pub use set_value::SetValueParameters;
