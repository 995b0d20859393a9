//! Lines of a file, as an editor counts them.

/// Line of a record, from 1, in the text that it was read from: its reader counts none of the empty lines before it.
#[must_use]
pub fn line_of(text: &str, at: Option<&csv::Position>) -> u64 {
    let Some(at) = at else {
        return 1;
    };
    let rest = usize::try_from(at.byte()).ok();
    let rest = rest.and_then(|byte| text.as_bytes().get(byte..));
    let ends = rest.into_iter().flatten();
    let ends = ends.take_while(|byte| b"\r\n".contains(byte));
    at.line() + ends.filter(|byte| **byte == b'\n').count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_lines_and_lines_within_a_field_count() {
        let text = "a,b\n\n1,2\r\n\r\n\r\n\"3\n\",4\n5,6";
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let lines = reader
            .records()
            .map(|record| line_of(text, record.unwrap().position()));
        assert_eq!(lines.collect::<Vec<_>>(), [3, 6, 8]);
    }
}
