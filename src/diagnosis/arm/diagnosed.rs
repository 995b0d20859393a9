//! A diagnosis of a recorded arm.

use super::input::ArmInput;
use crate::diagnosis::answer::account::Account;
use crate::diagnosis::answer::details::{DETAILS_SCHEMA, Details};
use crate::diagnosis::answer::{Answer, SCHEMA, Verdict};
use crate::recorded_arm::ArmParameters;

/// What was found.
#[derive(Debug, Clone)]
pub struct ArmDiagnosis {
    /// The answer.
    pub answer: Answer,
    /// The whole improved description.
    pub fitted: ArmParameters,
}

/// Diagnoses a recorded arm.
#[must_use]
pub fn diagnose(input: &ArmInput) -> ArmDiagnosis {
    let answer = Answer {
        schema: SCHEMA,
        verdict: Verdict::NothingMissing,
        explained: None,
        effects: Vec::new(),
        mismatch: Vec::new(),
        seconds: 0.0,
        alternatives: Vec::new(),
        notes: Vec::new(),
        details: Details {
            schema: DETAILS_SCHEMA,
            account: Account {
                headline: "nothing is missing".to_owned(),
                sections: Vec::new(),
            },
            ..Details::default()
        },
    };
    ArmDiagnosis {
        answer,
        fitted: input.nominal.clone(),
    }
}
