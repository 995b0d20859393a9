//! Messages in CDR, little endian (OMG DDS-XTypes 1.3, 7.4): each number on a multiple of its size, counted from behind the encapsulation.

/// What stands before a message: little endian, no options.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];
const NANOSECONDS: u64 = 1_000_000_000;

/// A message that is being coded, field by field.
#[derive(Debug)]
pub struct Coded(Vec<u8>);

impl Default for Coded {
    fn default() -> Self {
        Self(ENCAPSULATION.to_vec())
    }
}

impl Coded {
    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        let place = (self.0.len() - ENCAPSULATION.len()).next_multiple_of(N);
        self.0.resize(ENCAPSULATION.len() + place, 0);
        self.0.extend(bytes);
    }

    /// Begins the next message.
    pub fn clear(&mut self) {
        self.0.truncate(ENCAPSULATION.len());
    }

    /// Its bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// The length of a list.
    pub fn count(&mut self, count: usize) {
        self.put(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    }

    /// A text.
    pub fn text(&mut self, text: &str) {
        self.count(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    /// A number.
    pub fn number(&mut self, value: f64) {
        self.put(value.to_le_bytes());
    }

    /// A list of numbers.
    pub fn numbers(&mut self, values: impl ExactSizeIterator<Item = f64>) {
        self.count(values.len());
        values.for_each(|value| self.number(value));
    }

    /// A stamp or a duration [ns].
    pub fn time(&mut self, nanoseconds: u64) {
        self.count((nanoseconds / NANOSECONDS) as usize);
        self.count((nanoseconds % NANOSECONDS) as usize);
    }
}
