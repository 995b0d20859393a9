//! What a metric is: name, unit, definition, and where it is shown.
//!
//! Bounds are looked up in their lists; reports, schemas and docs/METRICS.md are made from them.

/// Part of a report in which a number stands, in the order of the parts: what the job is for, then how it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The finished edge.
    Edge,
    /// How long it takes.
    Time,
    /// The contact force.
    Force,
    /// Its largest value in each phase.
    Peaks,
    /// From first touch to following.
    Touch,
    /// The response to a command.
    Step,
    /// The slide of the device.
    Stroke,
    /// The path followed.
    Path,
    /// Sensors and estimates against the truth.
    Sensors,
    /// The whole run.
    Run,
}

impl Part {
    /// Its heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Edge => "Edge",
            Self::Time => "Time",
            Self::Force => "Force",
            Self::Peaks => "Peaks",
            Self::Touch => "Touch",
            Self::Step => "Step",
            Self::Stroke => "Stroke",
            Self::Path => "Path",
            Self::Sensors => "Sensors",
            Self::Run => "Run",
        }
    }
}

/// One number of a run, as it is declared by `metrics!`.
#[derive(Debug, Clone, Copy)]
pub struct Metric<S> {
    /// Key in summary.json, unit included.
    pub name: &'static str,
    /// Unit as it is printed; `1` of a pure number. The one rule of digits goes by it.
    pub unit: &'static str,
    /// Name for people, within its part of the report.
    pub label: &'static str,
    /// What it is of, where the name stands alone: `force` of `force, mean`.
    pub subject: Option<&'static str>,
    /// Its meaning, in a few words.
    pub meaning: &'static str,
    /// Its definition, as docs/METRICS.md has it.
    pub definition: &'static str,
    /// Part of the report.
    pub part: Part,
    /// Whether it has a row of its own there; else it stands beside another number.
    pub has_row: bool,
    /// Whether file and report leave it out where the run does not determine it; else it is `null` and a dash.
    pub is_optional: bool,
    /// Rank among the key facts at the top of a report, from 1.
    pub fact: Option<u8>,
    /// Rank where runs are compared and there is room for a few, from 1.
    pub rank: Option<u8>,
    /// Heading of its column in a table with a row for each pass or command.
    pub column: Option<&'static str>,
    /// What is said beside the value instead of the meaning, if the run determines it.
    pub note: Option<fn(&S) -> Option<String>>,
    /// Its value, if the run determines it.
    pub value: fn(&S) -> Option<f64>,
}

/// Numbers that are declared, each once.
pub trait Measured: Sized + 'static {
    /// All of them, in the order of the file.
    const METRICS: &'static [Metric<Self>];
}

impl<S> Metric<S> {
    pub(super) const fn new(
        name: &'static str,
        [unit, label, meaning, definition]: [&'static str; 4],
        part: Part,
        value: fn(&S) -> Option<f64>,
    ) -> Self {
        Self {
            name,
            unit,
            label,
            subject: None,
            meaning,
            definition,
            part,
            has_row: true,
            is_optional: false,
            fact: None,
            rank: None,
            column: None,
            note: None,
            value,
        }
    }

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
        match self.subject {
            Some(subject) => format!("{subject}, {}", self.label),
            None => self.label.to_owned(),
        }
    }

    /// What is said beside its value.
    #[must_use]
    pub fn remark(&self, summary: &S) -> String {
        let own = self.note.and_then(|note| note(summary));
        own.unwrap_or_else(|| self.meaning.to_owned())
    }

    pub(super) const fn of(mut self, subject: &'static str) -> Self {
        self.subject = Some(subject);
        self
    }

    pub(super) const fn beside(mut self) -> Self {
        self.has_row = false;
        self
    }

    pub(super) const fn fact(mut self, rank: u8) -> Self {
        self.fact = Some(rank);
        self
    }

    pub(super) const fn rank(mut self, rank: u8) -> Self {
        self.rank = Some(rank);
        self
    }

    pub(super) const fn column(mut self, heading: &'static str) -> Self {
        self.column = Some(heading);
        self
    }

    pub(super) const fn note(mut self, note: fn(&S) -> Option<String>) -> Self {
        self.note = Some(note);
        self
    }

    pub(super) const fn optional(mut self) -> Self {
        self.is_optional = true;
        self
    }
}

/// Numbers in a table with a row for each pass or command: those that have a column.
pub fn columns<S: Measured>() -> impl Iterator<Item = (&'static str, &'static Metric<S>)> {
    let metrics = S::METRICS.iter();
    metrics.filter_map(|metric| Some((metric.column?, metric)))
}

/// The key numbers, the first ones first.
#[must_use]
pub fn key_facts<S: Measured>() -> Vec<&'static Metric<S>> {
    ranked(S::METRICS, |metric| metric.fact)
}

/// Those of a rank, the first ones first.
pub(super) fn ranked<S>(
    metrics: &'static [Metric<S>],
    rank: fn(&Metric<S>) -> Option<u8>,
) -> Vec<&'static Metric<S>> {
    let mut ranked: Vec<_> = metrics.iter().filter(|m| rank(m).is_some()).collect();
    ranked.sort_by_key(|metric| rank(metric));
    ranked
}

/// Numbers of a summary, each declared once: its field, named as its key in summary.json, then unit, name for people, meaning in a few words, part of the
/// report, in brackets where else it is shown and what is not as usual (methods of [`Metric`]), and its definition. What is no number has a field alone.
/// Those of the block `sometimes` stand in the file only where the run determines them; `also` are numbers of a field that holds several.
macro_rules! metrics {
    (
        $(#[$about:meta])* $summary:ident, $(#[$all:meta])* $list:ident;
        always { $($(#[$a:meta])* $always:ident: $at:ty $(= $au:literal, $al:literal, $am:literal, $ap:ident [$($ah:ident $(($ax:expr))?),*], $ad:literal)?;)* }
        sometimes { $($some:ident: $st:ty = $su:literal, $sl:literal, $sm:literal, $sp:ident [$($sh:ident $(($sx:expr))?),*], $sd:literal;)* }
        always { $($(#[$l:meta])* $last:ident: $lt:ty $(= $lu:literal, $ll:literal, $lm:literal, $lp:ident [$($lh:ident $(($lx:expr))?),*], $ld:literal)?;)* }
        also { $($parent:ident.$also:ident = $ou:literal, $ol:literal, $om:literal, $op:ident [$($oh:ident $(($ox:expr))?),*], $od:literal;)* }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        pub struct $summary {
            $($(#[$a])* $(#[doc = $ad])? pub $always: $at,)*
            $(#[doc = $sd] #[serde(default, skip_serializing_if = "Option::is_none")] pub $some: $st,)*
            $($(#[$l])* $(#[doc = $ld])? pub $last: $lt,)*
        }

        $(#[$all])*
        pub const $list: &[$crate::metrics::Metric<$summary>] = {
            use $crate::metrics::catalogue::{Metric, Part};
            &[
                $($(Metric::new(stringify!($always), [$au, $al, $am, $ad], Part::$ap, |s: &$summary| s.$always.into())$(.$ah($($ax)?))*,)?)*
                $(Metric::new(stringify!($some), [$su, $sl, $sm, $sd], Part::$sp, |s: &$summary| s.$some.into()).optional()$(.$sh($($sx)?))*,)*
                $($(Metric::new(stringify!($last), [$lu, $ll, $lm, $ld], Part::$lp, |s: &$summary| s.$last.into())$(.$lh($($lx)?))*,)?)*
                $(Metric::new(stringify!($also), [$ou, $ol, $om, $od], Part::$op, |s: &$summary| s.$parent.map(|parent| parent.$also)).optional()$(.$oh($($ox)?))*,)*
            ]
        };

        impl $crate::metrics::Measured for $summary {
            const METRICS: &'static [$crate::metrics::Metric<Self>] = $list;
        }
    };
}
pub(super) use metrics;

#[cfg(test)]
mod tests {
    use super::super::test_planted::Planted;
    use super::super::test_recordings::{Builder, limits};
    use super::super::{
        BenchSummary, LevelSummary, METRICS, PassSummary, Summary, Timing, metric, summarise,
    };
    use super::{Measured, Metric, Part};
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
        let optional = METRICS.iter().filter(|metric| metric.is_optional).count();
        assert_eq!(places.len(), METRICS.len() - optional);
        assert!(places.is_sorted());
    }

    fn table<S: Measured>(part: Option<Part>) -> String {
        let metrics = S::METRICS.iter();
        let own = metrics.filter(|metric| part.is_none_or(|part| metric.part == part));
        let row = |metric: &Metric<S>| {
            let unit = match metric.shown_unit() {
                "" => String::new(),
                unit => format!(" [{unit}]"),
            };
            let label = metric.full_label();
            format!(
                "| `{}` | {label}{unit} | {} |\n",
                metric.name, metric.definition
            )
        };
        let rows: String = own.map(row).collect();
        format!("| key | in reports | definition |\n| --- | --- | --- |\n{rows}")
    }

    /// The tables of the page by their marks.
    fn tables() -> Vec<(String, String)> {
        let parts = [
            Part::Edge,
            Part::Time,
            Part::Force,
            Part::Peaks,
            Part::Touch,
            Part::Stroke,
            Part::Path,
            Part::Run,
        ];
        let of_part = |part: Part| (part.title().to_owned(), table::<Summary>(Some(part)));
        let mut tables: Vec<_> = parts.into_iter().map(of_part).collect();
        let kept: Vec<_> = METRICS
            .iter()
            .filter(|m| !parts.contains(&m.part))
            .collect();
        assert!(kept.is_empty(), "no table has {kept:?}");
        tables.push(("each pass".to_owned(), table::<PassSummary>(None)));
        tables.push(("a bench".to_owned(), table::<BenchSummary>(None)));
        tables.push(("each command".to_owned(), table::<LevelSummary>(None)));
        tables
    }

    #[test]
    fn the_document_has_every_number_as_it_is_declared() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/METRICS.md");
        let document = std::fs::read_to_string(path).unwrap();
        let mut page = document.clone();
        // Any number has its row.
        assert!(table::<Planted>(None).contains(
            "| `planted_depth_mm` | planted depth [mm] | The depth that a test plants. |\n"
        ));
        for (name, table) in tables() {
            let mark = format!("<!-- numbers: {name} -->\n");
            let (before, rest) = page.split_once(&mark).unwrap_or_else(|| panic!("{mark}"));
            let after: Vec<&str> = rest.split_inclusive('\n').collect();
            let after = after.iter().skip_while(|line| line.starts_with('|'));
            page = format!(
                "{before}{mark}{table}{}",
                after.copied().collect::<String>()
            );
        }
        if std::env::var_os("IDC_UPDATE_SCHEMAS").is_some() {
            std::fs::write(path, &page).unwrap();
        }
        assert!(
            document == page,
            "docs/METRICS.md differs from the declarations; IDC_UPDATE_SCHEMAS=1 writes it anew"
        );
        for key in OTHER_KEYS {
            assert!(document.contains(&format!("`{key}`")), "{key}");
        }
    }
}
