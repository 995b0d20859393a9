//! Numbers and texts one behind the other, in either byte order.

/// Bytes that are read from their start on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    rest: &'a [u8],
    is_big: bool,
}

/// The end of the bytes where more were expected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct EndOfData;

macro_rules! number {
    ($($name:ident, $kind:ty;)*) => {
        $(
            /// The next number.
            pub fn $name(&mut self) -> Result<$kind, EndOfData> {
                const SIZE: usize = size_of::<$kind>();
                let own = self.take(SIZE)?.try_into().map_err(|_| EndOfData)?;
                Ok(if self.is_big { <$kind>::from_be_bytes(own) } else { <$kind>::from_le_bytes(own) })
            }
        )*
    };
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8], is_big: bool) -> Self {
        Self {
            rest: bytes,
            is_big,
        }
    }

    number! {
        i8, i8; i16, i16; i32, i32; i64, i64;
        u8, u8; u16, u16; u32, u32; u64, u64;
        f32, f32; f64, f64;
    }

    /// So many bytes.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], EndOfData> {
        let (own, rest) = self.rest.split_at_checked(count).ok_or(EndOfData)?;
        self.rest = rest;
        Ok(own)
    }

    /// A text with its length before it.
    pub fn text(&mut self) -> Result<String, EndOfData> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }

    /// A stamp: seconds since 1904 and parts of 2^64 of one [ns since 1970]; none where it is zero.
    pub fn stamp(&mut self) -> Result<Option<i64>, EndOfData> {
        const FROM_1904_TO_1970: i64 = 2_082_844_800;
        let (seconds, parts) = if self.is_big {
            (self.i64()?, self.u64()?)
        } else {
            let parts = self.u64()?;
            (self.i64()?, parts)
        };
        if (seconds, parts) == (0, 0) {
            return Ok(None);
        }
        let nanoseconds = ((u128::from(parts) * 1_000_000_000 + (1 << 63)) >> 64) as i64;
        let since = seconds.checked_sub(FROM_1904_TO_1970);
        Ok(since.and_then(|s| s.checked_mul(1_000_000_000)?.checked_add(nanoseconds)))
    }
}
