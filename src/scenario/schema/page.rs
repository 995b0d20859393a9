//! Keys as a page lists them: a table of Markdown, a key a row.

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
