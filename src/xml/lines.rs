//! Lines of a text: counted once, so that each of thousands of elements can be reported with its own.

/// Where the lines of a text begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lines(Vec<usize>);

impl Lines {
    /// The lines of a text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self(ends.map(|(at, _)| at + 1).collect())
    }

    /// The line of a byte, from 1.
    #[must_use]
    pub fn at(&self, byte: usize) -> u32 {
        self.0.partition_point(|start| *start <= byte) as u32 + 1
    }

    /// The last line.
    #[must_use]
    pub fn last(&self) -> u32 {
        self.0.len() as u32 + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_has_the_line_that_an_editor_shows() {
        let text = "a\nbc\n\nd";
        let lines = Lines::of(text);
        let found: Vec<u32> = (0..text.len()).map(|byte| lines.at(byte)).collect();
        assert_eq!(found, [1, 1, 2, 2, 2, 3, 4]);
        assert_eq!(lines.last(), 4);
    }
}
