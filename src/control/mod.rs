//! Controllers: the arm's joint servo and the device's set pressure.

pub mod force;
pub mod law;
pub mod observed;
pub mod servo;
pub mod transmission;
