//! Links of an arm by themselves: servos from their commands, friction from their torques.

pub mod friction;
pub mod servo;
