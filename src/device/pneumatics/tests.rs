//! The device against closed forms, conserved quantities and halved steps.
