//! Keys as a page lists them: a table of Markdown, a key a row.

use std::collections::BTreeMap;

use serde_json::Value;

use super::described::Described;

const SCENARIOS: &str = include_str!("../../../scenarios/README.md");

/// Chapters of the page of scenarios for each kind; an earlier one counts where two have a key.
pub(in crate::scenario) const CELL: [&str; 3] = [
    "Keys of a cell",
    "Keys of the sensing chain",
    "Keys of the controller",
];
/// See [`CELL`].
pub(super) const BENCH: [&str; 4] = [
    "Keys of a bench",
    "Keys of a cell",
    "Keys of the sensing chain",
    "Keys of the controller",
];
/// See [`CELL`].
pub(super) const RECORDED_CELL: [&str; 2] = ["Keys of a recorded cell", "Keys of a cell"];

/// A row of a table of keys.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// Its cells, the keys first, as they are written.
    pub(crate) cells: Vec<String>,
}

impl Row {
    /// Whether it is about this key, alone or with others.
    #[cfg(feature = "import")]
    pub(crate) fn names(&self, key: &str) -> bool {
        self.cells[0].contains(&format!("`{key}`"))
    }

    /// Results that rest on its value where nobody has measured that in public: what stands behind the mark in its meaning.
    pub(in crate::scenario) fn judged(&self) -> Option<&str> {
        let (_, decides) = self.cells.last()?.split_once("; judged, decides ")?;
        Some(decides)
    }

    /// Its default where that is a finite number.
    pub(in crate::scenario) fn default_number(&self) -> Option<f64> {
        let number = self.cells.get(2)?.parse::<f64>().ok();
        number.filter(|number| number.is_finite())
    }

    /// Of a row that has key, unit, default, range and meaning.
    pub(super) fn described(&self) -> Described {
        let [_, unit, default, range, meaning] = &self.cells[..] else {
            return Described::text(self.cells.last().cloned().unwrap_or_default());
        };
        // What is no number of a unit shows by its type.
        let words = [
            "text",
            "file",
            "true or false",
            "number",
            "whole number",
            "-",
        ];
        let mut text = match words.contains(&unit.as_str()) {
            true => meaning.clone(),
            false => format!("{meaning} [{unit}]"),
        };
        if !range.is_empty() {
            text += &format!(", {range}");
        }
        text += &match default.as_str() {
            "required" => ". Required.".to_owned(),
            default => format!(". Default: {default}."),
        };
        let number = |text: &str| text.trim_end_matches(" each").parse::<f64>().ok();
        let range = match (range.split_once(" to "), range.strip_prefix("at least ")) {
            (Some((low, high)), _) => [number(low), number(high)],
            (_, Some(low)) => [number(low), None],
            _ => [None, None],
        };
        Described {
            text,
            range,
            default: serde_json::from_str::<Value>(default).ok(),
        }
    }
}

/// The tables of keys of a page, in order, each with its rows.
#[cfg(feature = "import")]
pub(crate) fn key_rows(page: &str) -> Vec<Vec<Row>> {
    let mut tables = Vec::new();
    let mut open = false;
    for line in page.lines() {
        if line.starts_with("| key |") {
            tables.push(Vec::new());
            open = true;
        } else if !line.starts_with('|') {
            open = false;
        }
        if let Some(table) = tables.last_mut().filter(|_| open)
            && line.starts_with("| `")
        {
            table.push(row(line));
        }
    }
    tables
}

fn row(line: &str) -> Row {
    let cells = line.trim_matches('|').split('|');
    Row {
        cells: cells.map(|cell| cell.trim().to_owned()).collect(),
    }
}

/// Rows of some chapters of the page of scenarios, by key.
pub(in crate::scenario) fn scenario_rows(chapters: &[&str]) -> BTreeMap<String, Row> {
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    for chapter in chapters {
        let of_chapter = SCENARIOS
            .lines()
            .skip_while(|line| line.strip_prefix("## ") != Some(chapter))
            .skip(1)
            .take_while(|line| !line.starts_with("## "));
        for line in of_chapter.filter(|line| line.starts_with("| `")) {
            let row = row(line);
            let key = row.cells[0].trim_matches('`').to_owned();
            rows.entry(key).or_insert(row);
        }
    }
    rows
}
