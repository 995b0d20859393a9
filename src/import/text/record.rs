//! The fields of a row, kept as briefly as they can be: a log has millions of rows.

/// The fields of a row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(in crate::import) struct Record {
    text: Box<str>,
    /// Where each field ends in the text.
    ends: Box<[u32]>,
}

impl Record {
    /// Fields one behind the other. A text has fewer than 2^32 bytes.
    pub fn of<'a>(fields: impl Iterator<Item = &'a str> + Clone) -> Self {
        let mut text = String::with_capacity(fields.clone().map(str::len).sum());
        let end = |field: &str| {
            text.push_str(field);
            text.len() as u32
        };
        let ends = fields.map(end).collect();
        Self {
            text: text.into(),
            ends,
        }
    }

    /// Number of its fields.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// A field by its place from 0.
    pub fn get(&self, place: usize) -> Option<&str> {
        let end = *self.ends.get(place)? as usize;
        let start = match place {
            0 => 0,
            _ => self.ends[place - 1] as usize,
        };
        self.text.get(start..end)
    }

    /// Its fields, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> + Clone {
        (0..self.len()).map(|place| self.get(place).unwrap_or_default())
    }
}

impl std::ops::Index<usize> for Record {
    type Output = str;

    /// A field; an empty one where the row has ended.
    fn index(&self, place: usize) -> &str {
        self.get(place).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_come_back_in_their_places() {
        let record = Record::of(["0,5", "", "°C"].into_iter());
        assert_eq!(record.iter().collect::<Vec<_>>(), ["0,5", "", "°C"]);
        assert_eq!((record.get(2), record.get(3)), (Some("°C"), None));
        assert_eq!(Record::of([""; 0].into_iter()).len(), 0);
    }
}
