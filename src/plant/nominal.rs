//! Which of two descriptions one is: the nominal one, of which planner, feed-forward, controllers and estimator are made, or the actual one, of which device,
//! contact, bodies, transmissions and sensors are.

use std::ops::{Deref, DerefMut};

/// A description as a file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct Nominal<M>(pub M);

/// The description with the effects that a file puts in; only [`Nominal::with`] makes one.
#[derive(Debug, Clone, PartialEq)]
pub struct Actual<M>(M);

impl<M: Clone> Nominal<M> {
    /// The actual one, by what differs in it.
    #[must_use]
    pub fn with(&self, differ: impl FnOnce(&mut M)) -> Actual<M> {
        let mut own = self.0.clone();
        differ(&mut own);
        Actual(own)
    }
}

impl<M> Deref for Nominal<M> {
    type Target = M;

    fn deref(&self) -> &M {
        &self.0
    }
}

impl<M> DerefMut for Nominal<M> {
    fn deref_mut(&mut self) -> &mut M {
        &mut self.0
    }
}

impl<M> Deref for Actual<M> {
    type Target = M;

    fn deref(&self) -> &M {
        &self.0
    }
}
