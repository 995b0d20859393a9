//! Bytes that are read while they are written, by any number of readers, each from the start.

use std::io::{Read, Result, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

#[derive(Default)]
struct Content {
    bytes: Vec<u8>,
    complete: bool,
}

/// Bytes written so far.
#[derive(Default)]
pub(in crate::app) struct LiveBuffer {
    content: Mutex<Content>,
    grown: Condvar,
}

impl LiveBuffer {
    fn content(&self) -> MutexGuard<'_, Content> {
        // Bytes are appended whole, so they are good even if a writer panicked.
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The one who writes; with it gone, the content is complete.
    pub(super) fn writer(self: &Arc<Self>) -> LiveBufferWriter {
        LiveBufferWriter(Arc::clone(self))
    }

    /// One who reads.
    pub(super) fn reader(self: &Arc<Self>) -> LiveBufferReader {
        LiveBufferReader {
            buffer: Arc::clone(self),
            place: 0,
        }
    }
}

/// Appends to a [`LiveBuffer`].
pub(in crate::app) struct LiveBufferWriter(Arc<LiveBuffer>);

impl Write for LiveBufferWriter {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.0.content().bytes.extend_from_slice(bytes);
        self.0.grown.notify_all();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Drop for LiveBufferWriter {
    fn drop(&mut self) {
        self.0.content().complete = true;
        self.0.grown.notify_all();
    }
}

/// Reads a [`LiveBuffer`], waiting for what is still to come.
pub(super) struct LiveBufferReader {
    buffer: Arc<LiveBuffer>,
    place: usize,
}

impl Read for LiveBufferReader {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let content = self.buffer.content();
        let waiting =
            |content: &mut Content| content.bytes.len() == self.place && !content.complete;
        let content = self
            .buffer
            .grown
            .wait_while(content, waiting)
            .unwrap_or_else(PoisonError::into_inner);
        let rest = &content.bytes[self.place..];
        let count = rest.len().min(into.len());
        into[..count].copy_from_slice(&rest[..count]);
        self.place += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readers_get_all_of_it_whenever_they_come() {
        let buffer = Arc::new(LiveBuffer::default());
        let mut writer = buffer.writer();
        let all = |mut reader: LiveBufferReader| {
            let mut text = String::new();
            reader.read_to_string(&mut text).unwrap();
            text
        };
        let early = buffer.reader();
        let early = std::thread::spawn(move || all(early));
        writer.write_all(b"first, ").unwrap();
        writer.write_all(b"second").unwrap();
        drop(writer);
        assert_eq!(early.join().unwrap(), "first, second");
        assert_eq!(all(buffer.reader()), "first, second");
    }
}
