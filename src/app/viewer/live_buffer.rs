//! Bytes that are read while they are written, by any number of readers, each from the start. A piece is shared with all of them, not copied.

use std::io::{Result, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

use bytes::Bytes;

#[derive(Default)]
struct Content {
    pieces: Vec<Bytes>,
    complete: bool,
    waiting: Vec<Waker>,
}

/// Bytes written so far.
#[derive(Default)]
pub(in crate::app) struct LiveBuffer {
    content: Mutex<Content>,
}

impl LiveBuffer {
    fn content(&self) -> MutexGuard<'_, Content> {
        // Bytes are appended whole, so they are good even if a writer panicked.
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the content and wakes those who wait for it.
    fn grow(&self, change: impl FnOnce(&mut Content)) {
        let mut content = self.content();
        change(&mut content);
        let waiting = std::mem::take(&mut content.waiting);
        drop(content);
        waiting.into_iter().for_each(Waker::wake);
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
        let piece = Bytes::copy_from_slice(bytes);
        self.0.grow(|content| content.pieces.push(piece));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Drop for LiveBufferWriter {
    fn drop(&mut self) {
        self.0.grow(|content| content.complete = true);
    }
}

/// Reads a [`LiveBuffer`], waiting for what is still to come.
pub(super) struct LiveBufferReader {
    buffer: Arc<LiveBuffer>,
    /// Piece that comes next.
    place: usize,
}

impl LiveBufferReader {
    /// The next piece, none at the end.
    pub(super) fn poll_next(&mut self, context: &Context<'_>) -> Poll<Option<Bytes>> {
        let mut content = self.buffer.content();
        if let Some(piece) = content.pieces.get(self.place) {
            self.place += 1;
            return Poll::Ready(Some(piece.clone()));
        }
        if content.complete {
            return Poll::Ready(None);
        }
        content.waiting.push(context.waker().clone());
        Poll::Pending
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
            let runtime = tokio::runtime::Builder::new_current_thread().build();
            runtime.unwrap().block_on(async {
                let mut text = Vec::new();
                while let Some(piece) = std::future::poll_fn(|at| reader.poll_next(at)).await {
                    text.extend_from_slice(&piece);
                }
                String::from_utf8(text).unwrap()
            })
        };
        let early = buffer.reader();
        let early = std::thread::spawn(move || all(early));
        writer.write_all(b"first, ").unwrap();
        // The reader has the first piece and waits.
        std::thread::sleep(std::time::Duration::from_millis(50));
        writer.write_all(b"second").unwrap();
        drop(writer);
        assert_eq!(early.join().unwrap(), "first, second");
        assert_eq!(all(buffer.reader()), "first, second");
    }
}
