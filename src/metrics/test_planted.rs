//! A number that tests alone declare, by one line: wherever numbers are shown it must appear without another line.

use super::catalogue::metrics;
use super::{BoundCheck, check, validate};
use crate::scenario::Expectation;

metrics! {
    /// Numbers of a planted run.
    Planted,
    /// All of them.
    PLANTED;
    always {
        planted_depth_mm: Option<f64> = "mm", "planted depth", "of a test", Stroke [fact(1), rank(1), column("depth")],
            "The depth that a test plants.";
    }
    sometimes {
        planted_share_percent: Option<f64> = "%", "planted share", "of a test", Edge [],
            "The share that a test plants; absent without it.";
    }
    always {}
    also {}
}

/// A run in which the depth is 12.5 mm.
pub(crate) fn planted() -> Planted {
    Planted {
        planted_depth_mm: Some(12.5),
        planted_share_percent: None,
    }
}

/// The check of a bound on the depth.
pub(crate) fn bounds(max: f64) -> Vec<BoundCheck> {
    let expectation = Expectation {
        metric: "planted_depth_mm".into(),
        min: None,
        max: Some(max),
    };
    check(PLANTED, &planted(), &[expectation]).unwrap()
}

#[test]
fn it_is_in_the_file_and_can_be_bounded() {
    let file = serde_json::to_string(&planted()).unwrap();
    assert_eq!(file, r#"{"planted_depth_mm":12.5}"#);
    assert_eq!(serde_json::from_str::<Planted>(&file).unwrap(), planted());
    assert!(bounds(13.0)[0].kept && !bounds(12.0)[0].kept);
    let slip = Expectation {
        metric: "planted_dept_mm".into(),
        min: None,
        max: Some(1.0),
    };
    let error = validate(PLANTED, &[slip]).unwrap_err().to_string();
    assert!(error.contains("planted_depth_mm"), "{error}");
}
