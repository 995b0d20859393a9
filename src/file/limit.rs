//! How much a file may hold, and come to when it is unpacked: what is claimed by few bytes is not relied on.
//!
//! ```text
//! unpacked <= max(256 MB, 200 size), and 400 MB where all of it is held at once
//! ```

use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes of a megabyte.
const MEGABYTE: u64 = 1_000_000;
/// Bytes that a file of settings may have: scenarios, maps and the like.
const SETTINGS: u64 = 8 * MEGABYTE;
/// Bytes of one that is read whole.
const WHOLE: u64 = 400 * MEGABYTE;
/// Bytes that any may be unpacked to, and how many times its size.
const UNPACKED: u64 = 256 * MEGABYTE;
const TIMES: u64 = 200;

/// What raises the limits, for messages.
pub const RAISED_BY: &str = "`--largest-mb N` raises that limit, for a log also `largest_mb` in the [[file]] of its import map";

/// What `--largest-mb` says [B]; 0 where it was not given.
static RAISED: AtomicU64 = AtomicU64::new(0);

/// Raises the limits of all files that are read from here on [MB].
pub fn raise(megabytes: u64) {
    RAISED.store(megabytes.saturating_mul(MEGABYTE), Ordering::Relaxed);
}

/// Bytes as a message has them.
pub fn megabytes(bytes: u64) -> String {
    match bytes as f64 / MEGABYTE as f64 {
        least if least < 0.1 => format!("{:.1} kB", 1e3 * least),
        few if few < 10.0 => format!("{few:.1} MB"),
        many => format!("{many:.0} MB"),
    }
}

/// The limits of a file, in which a number of its own takes the place of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Limit(Option<u64>);

impl Limit {
    /// Limits of a file that may come to so many megabytes, if that is said.
    #[must_use]
    pub fn of(megabytes: Option<u64>) -> Self {
        Self(megabytes.map(|megabytes| megabytes.saturating_mul(MEGABYTE)))
    }

    fn given(self) -> Option<u64> {
        let raised = RAISED.load(Ordering::Relaxed);
        self.0.or((raised > 0).then_some(raised))
    }

    /// Bytes of a file of settings, at most.
    #[must_use]
    pub fn settings(self) -> u64 {
        self.given().map_or(SETTINGS, |given| given.max(SETTINGS))
    }

    /// Bytes of a file that is read whole, at most.
    #[must_use]
    pub fn whole(self) -> u64 {
        self.given().unwrap_or(WHOLE)
    }

    /// Bytes to which a file of this size may be unpacked, and held.
    #[must_use]
    pub fn unpacked(self, size: u64) -> u64 {
        self.passed(size).min(self.given().unwrap_or(WHOLE))
    }

    /// Bytes to which a file of this size may be unpacked, piece by piece.
    #[must_use]
    pub fn passed(self, size: u64) -> u64 {
        let usual = size.saturating_mul(TIMES).max(UNPACKED);
        self.given().unwrap_or(usual)
    }

    /// Why a file of this size that comes to more than `most` is refused.
    #[must_use]
    pub fn refusal(self, size: u64, most: u64) -> String {
        format!(
            "its {} come to more than {} unpacked, as only a damaged or a hostile file does; {RAISED_BY}",
            megabytes(size),
            megabytes(most)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_to_more_than_200_times_its_size_and_256_mb_is_refused() {
        let usual = Limit::default();
        assert_eq!(usual.unpacked(0), 256 * MEGABYTE);
        assert_eq!(usual.unpacked(MEGABYTE), 256 * MEGABYTE);
        assert_eq!(usual.unpacked(3 * MEGABYTE / 2), 300 * MEGABYTE);
        assert_eq!(usual.unpacked(20 * MEGABYTE), 400 * MEGABYTE);
        assert_eq!(usual.passed(20 * MEGABYTE), 4000 * MEGABYTE);
        let given = Limit::of(Some(3));
        assert_eq!(
            [
                given.unpacked(MEGABYTE),
                given.passed(MEGABYTE),
                given.whole()
            ],
            [3 * MEGABYTE; 3]
        );
        assert_eq!(given.settings(), SETTINGS);
    }
}
