//! Many recordings of many devices: which there are, and what their numbers say over time.
//!
//! [`scan`] reads the layout FOLDER/DEVICE/DATE. [`change`] finds where a series of numbers steps or begins to grow, with a probability that chance does as
//! much, and [`trend`] how it drifts. [`Diagnosed`] is what one recording came to, [`Found`] what all say together.

mod diagnosed;
mod found;
mod layout;
mod series;

pub use diagnosed::{Diagnosed, NumberFound, Started};
pub use found::{
    DeviceFound, Found, NumberChanged, NumberSeries, Persistent, Recording, persistent, words,
};
pub use layout::{Dated, Device, FleetError, Layout, date_of_day, scan};
pub use series::{Change, ChangeKind, Trend, change, trend};
