//! What a metric is: name, unit, meaning in short and where the value stands.
//!
//! Bounds are looked up in their lists and reports are made from them; docs/METRICS.md has the full definitions.

/// One number of a run.
#[derive(Debug, Clone, Copy)]
pub struct Metric<S> {
    /// Key in summary.json, unit included.
    pub name: &'static str,
    /// Unit as it is printed.
    pub unit: &'static str,
    /// Name for people, within its part of the report.
    pub label: &'static str,
    /// Its meaning, in a few words.
    pub meaning: &'static str,
    /// Its value, if the run determines it.
    pub value: fn(&S) -> Option<f64>,
}

impl<S> Metric<S> {
    /// Its unit; empty for a pure number.
    #[must_use]
    pub fn shown_unit(&self) -> &'static str {
        match self.unit {
            "1" => "",
            unit => unit,
        }
    }

    /// Name for people where it stands alone, as in `force, mean`.
    #[must_use]
    pub fn full_label(&self) -> String {
        let subjects = ["force", "engagement"];
        let subject = subjects
            .into_iter()
            .find(|subject| self.name.starts_with(subject) && !self.label.contains(subject));
        subject.map_or_else(
            || self.label.to_owned(),
            |subject| format!("{subject}, {}", self.label),
        )
    }
}

pub(super) const fn entry<S>(
    name: &'static str,
    unit: &'static str,
    label: &'static str,
    meaning: &'static str,
    value: fn(&S) -> Option<f64>,
) -> Metric<S> {
    Metric {
        name,
        unit,
        label,
        meaning,
        value,
    }
}

/// Numbers of a summary, each declared once: its field, named as its key in summary.json, with its unit, its name for people and its meaning in a few words,
/// and the list of all. Those of the second block stand in the file only where the run determines them; `also` are numbers that are no fields.
macro_rules! metrics {
    (
        $(#[$about:meta])* $summary:ident, $(#[$all:meta])* $list:ident;
        always { $($(#[$a:meta])* $always:ident: $at:ty $(= $au:literal, $al:literal, $am:literal)?;)* }
        sometimes { $($(#[$s:meta])* $some:ident: $st:ty $(= $su:literal, $sl:literal, $sm:literal)?;)* }
        always { $($(#[$l:meta])* $last:ident: $lt:ty $(= $lu:literal, $ll:literal, $lm:literal)?;)* }
        also [$($also:expr),*]
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        pub struct $summary {
            $($(#[$a])* pub $always: $at,)*
            $($(#[$s])* #[serde(default, skip_serializing_if = "Option::is_none")] pub $some: $st,)*
            $($(#[$l])* pub $last: $lt,)*
        }

        $(#[$all])*
        pub const $list: &[$crate::metrics::Metric<$summary>] = &[
            $($($crate::metrics::catalogue::entry(stringify!($always), $au, $al, $am, |s| s.$always.into()),)?)*
            $($($crate::metrics::catalogue::entry(stringify!($some), $su, $sl, $sm, |s| s.$some.into()),)?)*
            $($($crate::metrics::catalogue::entry(stringify!($last), $lu, $ll, $lm, |s| s.$last.into()),)?)*
            $($also),*
        ];
    };
}
pub(super) use metrics;

#[cfg(test)]
mod tests {
    use super::super::Timing;
    use super::super::test_recordings::{Builder, limits};
    use super::super::{METRICS, metric, summarise};
    /// Keys of summary.json that are no numbers to set bounds on.
    const OTHER_KEYS: [&str; 5] = [
        "most_loaded_joint",
        "joints",
        "passes",
        "force_by_tenth",
        "timing",
    ];

    #[test]
    fn the_list_is_the_file_key_by_key() {
        let mut summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        summary.timing = Some(Timing::new(8.0, 2.0));
        assert_eq!(
            metric("real_time_factor").and_then(|m| (m.value)(&summary)),
            Some(4.0)
        );
        let file = serde_json::to_value(&summary).unwrap();
        let timing = &file["timing"];
        for metric in METRICS {
            let found = file.get(metric.name).or_else(|| timing.get(metric.name));
            let found = found.and_then(serde_json::Value::as_f64);
            assert_eq!(found, (metric.value)(&summary), "{}", metric.name);
        }
        for key in file.as_object().unwrap().keys() {
            let known = metric(key).is_some() || OTHER_KEYS.contains(&key.as_str());
            assert!(known, "{key} is not listed");
        }
    }

    #[test]
    fn names_stand_in_the_order_of_the_file() {
        let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        let text = serde_json::to_string(&summary).unwrap();
        let places = METRICS
            .iter()
            .filter_map(|m| text.find(&format!("\"{}\":", m.name)));
        let places: Vec<usize> = places.collect();
        // Timing, and what only a turning tool has.
        assert_eq!(places.len(), METRICS.len() - 24);
        assert!(places.is_sorted());
    }

    #[test]
    fn every_metric_is_defined_in_the_document() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/METRICS.md");
        let document = std::fs::read_to_string(path).unwrap();
        for metric in METRICS {
            assert!(
                document.contains(&format!("`{}`", metric.name)),
                "{}",
                metric.name
            );
        }
        for key in OTHER_KEYS {
            assert!(document.contains(&format!("`{key}`")), "{key}");
        }
    }
}
