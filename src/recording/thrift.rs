//! Structures as Parquet writes them (Apache Thrift, compact protocol), walked through without being kept: what they claim is seen before it is relied on.

/// Depth of structures and lists in one another, at most.
const DEEPEST: usize = 32;

/// What is met on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// A structure begins, of a list too.
    Structure,
    /// A whole number.
    Number(i64),
}

/// Walks through the structure that bytes begin with; each thing is shown with the numbers of the fields that lead to it.
///
/// Answers with its bytes; none where it ends early, lies too deep, or has a list that is longer than what is left.
pub(super) fn walk(bytes: &[u8], mut see: impl FnMut(&[i16], Seen)) -> Option<usize> {
    let mut walk = Walk {
        rest: bytes,
        path: Vec::new(),
        depth: 0,
        see: &mut see,
    };
    walk.structure()?;
    Some(bytes.len() - walk.rest.len())
}

struct Walk<'a> {
    rest: &'a [u8],
    path: Vec<i16>,
    depth: usize,
    see: &'a mut dyn FnMut(&[i16], Seen),
}

impl Walk<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    fn pass(&mut self, count: u64) -> Option<()> {
        self.rest = self.rest.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    /// A number in groups of seven bits.
    fn varint(&mut self) -> Option<u64> {
        let mut number = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }

    fn signed(&mut self) -> Option<i64> {
        let number = self.varint()?;
        Some((number >> 1) as i64 ^ -((number & 1) as i64))
    }

    fn structure(&mut self) -> Option<()> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return None;
        }
        let mut field = 0i16;
        loop {
            let head = self.byte()?;
            if head == 0 {
                break;
            }
            field = match head >> 4 {
                0 => i16::try_from(self.signed()?).ok()?,
                step => field.checked_add(i16::from(step))?,
            };
            self.path.push(field);
            // The kind of true and false is their value.
            if !matches!(head & 0x0f, 1 | 2) {
                self.value(head & 0x0f)?;
            }
            self.path.pop();
        }
        self.depth -= 1;
        Some(())
    }

    fn value(&mut self, kind: u8) -> Option<()> {
        match kind {
            1..=3 => self.pass(1),
            4..=6 => {
                let number = self.signed()?;
                (self.see)(&self.path, Seen::Number(number));
                Some(())
            }
            7 => self.pass(8),
            8 => {
                let length = self.varint()?;
                self.pass(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = match head >> 4 {
                    15 => self.varint()?,
                    few => u64::from(few),
                };
                self.values(count, &[head & 0x0f])
            }
            11 => match self.varint()? {
                0 => Some(()),
                count => {
                    let kinds = self.byte()?;
                    self.values(count, &[kinds >> 4, kinds & 0x0f])
                }
            },
            12 => {
                (self.see)(&self.path, Seen::Structure);
                self.structure()
            }
            _ => None,
        }
    }

    /// Elements of a list, or of a map; each has a byte at least.
    fn values(&mut self, count: u64, kinds: &[u8]) -> Option<()> {
        self.depth += 1;
        if self.depth > DEEPEST || count > self.rest.len() as u64 {
            return None;
        }
        for _ in 0..count {
            for kind in kinds {
                self.value(*kind)?;
            }
        }
        self.depth -= 1;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field's path, and what it is.
    type Field = (Vec<i16>, Seen);

    fn walked(bytes: &[u8]) -> Option<(usize, Vec<Field>)> {
        let mut seen = Vec::new();
        let length = walk(bytes, |path, own| seen.push((path.to_vec(), own)))?;
        Some((length, seen))
    }

    #[test]
    fn numbers_come_with_the_fields_that_lead_to_them() {
        // { 1: -3, 5: { 1: 150 }, 6: true }, and a byte behind it.
        let bytes = [0x15, 0x05, 0x4c, 0x15, 0xac, 0x02, 0x00, 0x11, 0x00, 0x99];
        let expected = vec![
            (vec![1], Seen::Number(-3)),
            (vec![5], Seen::Structure),
            (vec![5, 1], Seen::Number(150)),
        ];
        assert_eq!(walked(&bytes), Some((9, expected)));
        assert_eq!(walked(&bytes[..8]), None);
    }

    #[test]
    fn lists_that_claim_more_than_is_there_are_not_walked() {
        // A list of 2^31 structures; structures without end in one another.
        assert_eq!(
            walked(&[0x19, 0xfc, 0xff, 0xff, 0xff, 0xff, 0x07, 0x00]),
            None
        );
        assert_eq!(walked(&vec![0x1c; 100_000]), None);
        assert_eq!(walked(&vec![0x19; 100_000]), None);
    }
}
