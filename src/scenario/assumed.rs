//! Values in use that rest on no public measurement. Where a key is declared says so, or the device model file of its own.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::keys::declaration::Key;
use crate::keys::document::Document;
use crate::keys::suggestion::join;

/// What the values of a device decide.
const OF_DEVICE: &str = "contact force and stroke";

/// A value in use that nobody has measured in public.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AssumedValue {
    /// Its dotted key.
    pub key: String,
    /// Whether it is the program's or the device model's own value, not one that the scenario gives.
    pub default: bool,
    /// Results that rest on it.
    pub decides: String,
}

/// Assumed values of a cell's file that works its edge; all of them are of tool and edge.
pub(super) fn of_cell(document: &Document<'_>, tables: &[(String, Vec<Key>)]) -> Vec<AssumedValue> {
    let has = |table: &str| document.keys_in(table).next().is_some();
    if !has("removal") {
        return Vec::new();
    }
    let rows = (tables.iter()).flat_map(|(table, keys)| keys.iter().map(move |key| (table, key)));
    let assumed = rows.filter_map(|(table, key)| {
        let decides = key.assumed?.to_owned();
        let given = document.keys_in(table).any(|given| given == key.name);
        // A burr's numbers count where there is one; no wear and the like decide nothing.
        let usual = table != "workpiece.burr" || has(table);
        let default = usual && key.usual_number().is_some();
        (given || default).then_some(AssumedValue {
            key: join(table, key.name),
            default: !given,
            decides,
        })
    });
    let mut assumed: Vec<AssumedValue> = assumed.collect();
    assumed.sort_by(|one, other| one.key.cmp(&other.key));
    assumed
}

/// Values of a device model file that it says are assumed, but for those given above it and those that switch something off.
pub(super) fn of_model(
    assumed: &[String],
    numbers: &BTreeMap<&'static str, f64>,
    is_given: impl Fn(&str) -> bool,
) -> Vec<AssumedValue> {
    let off = |value: &f64| *value == 0.0 || value.is_infinite();
    let is_off = |key: &str| numbers.get(key).is_some_and(off);
    let in_use = assumed.iter().filter(|key| !is_off(key) && !is_given(key));
    let found = in_use.map(|key| AssumedValue {
        key: format!("device.{key}"),
        default: true,
        decides: OF_DEVICE.to_owned(),
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::file::ScenarioFile;
    use super::*;
    use crate::keys::declaration::tables;

    #[test]
    fn a_models_assumed_values_count_where_something_is_on() {
        let assumed = ["a_n", "b_n", "c", "e", "f"].map(str::to_owned);
        let numbers = [
            ("a_n", 3.0),
            ("b_n", 0.0),
            ("c", f64::INFINITY),
            ("d", 2.0),
            ("f", 1.0),
        ];
        let found = of_model(&assumed, &BTreeMap::from(numbers), |key| key == "f");
        let keys: Vec<&str> = found.iter().map(|value| value.key.as_str()).collect();
        assert_eq!(keys, ["device.a_n", "device.e"]);
    }

    #[test]
    fn keys_in_use_are_listed_with_what_they_decide() {
        let of = |text: &str| {
            let document = Document::new(Path::new("a.toml"), text, 2).unwrap();
            let found = of_cell(&document, &tables::<ScenarioFile>());
            let pairs = found.iter().map(|value| (value.key.clone(), value.default));
            assert!(found.iter().all(|value| !value.decides.is_empty()));
            pairs.collect::<Vec<_>>()
        };
        assert_eq!(of("[workpiece.burr]\nkind = \"none\"\n"), []);
        let found = of("[removal]\nlaw = \"preston\"\ncoefficient_mm3_per_j = 0.01\n");
        let given = ("removal.coefficient_mm3_per_j".to_owned(), false);
        let usual = |key: &str| (key.to_owned(), true);
        assert!(found.contains(&given), "{found:?}");
        assert!(found.contains(&usual("removal.friction_coefficient")));
        assert!(found.contains(&usual("workpiece.chamfer.residual_burr_max_mm")));
        // No burr, no wear, another law.
        for absent in [
            "burr.root_mm",
            "wear_work_kj",
            "wear_at_start_kj",
            "rate_mm3_per_s",
        ] {
            assert!(
                !found.iter().any(|(key, _)| key.ends_with(absent)),
                "{absent}"
            );
        }
        let worn = of(
            "[removal]\nlaw = \"preston\"\nwear_work_kj = 100\n[workpiece.burr]\nkind = \"random\"\n",
        );
        assert!(worn.contains(&("removal.wear_work_kj".to_owned(), false)));
        assert!(worn.contains(&usual("workpiece.burr.root_mm")));
    }
}
