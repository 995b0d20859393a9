//! A model discrepancy: what it says of recordings that it was not fitted to; and for people, the shape that was found, what known physics has such
//! a shape, and which known effects came nearest.

pub mod balance;
pub mod form;
pub mod known;
pub mod report;
pub mod shape;
pub mod words;

pub use form::Form;
pub use shape::{Shape, ShapePoint};
