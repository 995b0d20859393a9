//! Where a map's columns stand in a text: a column by number or name, or an element of the vectors in one.

use std::path::Path;

use crate::import::error::ImportError;
use crate::import::map::Column;
use crate::import::rows::place;

/// Where numbers stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    /// The column, from 0.
    pub column: usize,
    /// Of a column of vectors: the element, from 0.
    pub element: Option<usize>,
}

/// Where a column stands; `force[2]` is the third element of the vectors in `force`, unless a column has that name.
pub(super) fn place_of(
    path: &Path,
    column: &Column,
    names: Option<&[String]>,
    count: usize,
) -> Result<Place, ImportError> {
    let plain = |column: usize| Place {
        column,
        element: None,
    };
    let own = names.unwrap_or_default();
    if let Column::Name(name) = column {
        let places: Vec<usize> = (0..own.len())
            .filter(|place| own[*place] == *name)
            .collect();
        if let [_, _, ..] = places[..] {
            return Err(ImportError::SameName {
                file: path.to_owned(),
                name: name.clone(),
                columns: places.iter().map(|place| place + 1).collect(),
            });
        }
        if places.is_empty()
            && let Some((head, index)) = name.strip_suffix(']').and_then(|n| n.rsplit_once('['))
            && let Ok(element) = index.parse()
            && let Some(column) = own.iter().position(|known| known == head)
        {
            return Ok(Place {
                column,
                element: Some(element),
            });
        }
    }
    place(path, column, names, count).map(plain)
}

/// The elements of a vector in a field: `[1.0, 2.0, 3.0]`, `(1 2 3)`, `1;2;3`. None where it is no vector.
pub(in crate::import) fn elements(field: &str) -> Option<Vec<&str>> {
    let inside = field
        .strip_prefix(['[', '(', '{'])
        .and_then(|rest| rest.strip_suffix([']', ')', '}']));
    let inside = inside.unwrap_or(field).trim();
    let mark = [';', ',', '|']
        .into_iter()
        .find(|mark| inside.contains(*mark));
    let all: Vec<&str> = match mark {
        Some(mark) => inside.split(mark).map(str::trim).collect(),
        None => inside.split_whitespace().collect(),
    };
    (all.len() > 1).then_some(all)
}
