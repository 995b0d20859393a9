//! Content of an answer: shared, read from its file piece by piece, or as it is made, so that an answer that nobody reads holds no memory of its own.

use std::fs::File;
use std::io::{Error, Read as _};
use std::pin::Pin;
use std::task::{Context, Poll};

use bytes::Bytes;
use hyper::body::{Body, Frame, SizeHint};

use super::live_buffer::LiveBufferReader;

/// Length of a piece of a file [byte].
const PIECE: u64 = 1 << 16;

/// Content of an answer.
pub(super) enum Content {
    /// A text, or a file of the viewer; none once it is given.
    Whole(Option<Bytes>),
    /// A file, and how much of it is left [byte].
    File(File, u64),
    /// What is still being made.
    Live(LiveBufferReader),
}

impl Content {
    /// None.
    pub(super) fn empty() -> Self {
        Self::Whole(None)
    }

    /// A file as long as it is now.
    pub(super) fn file(file: File) -> Result<Self, Error> {
        let length = file.metadata()?.len();
        Ok(Self::File(file, length))
    }
}

impl Body for Content {
    type Data = Bytes;
    type Error = Error;

    fn poll_frame(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Error>>> {
        let piece = match self.get_mut() {
            Self::Whole(bytes) => bytes.take().map(Ok),
            Self::File(_, 0) => None,
            // From this machine's disk, in pieces: nobody waits long for it.
            Self::File(file, left) => {
                let mut piece = vec![0; PIECE.min(*left) as usize];
                let read = file.read_exact(&mut piece);
                *left -= piece.len() as u64;
                Some(read.map(|()| piece.into()))
            }
            Self::Live(reader) => match reader.poll_next(context) {
                Poll::Ready(piece) => piece.map(Ok),
                Poll::Pending => return Poll::Pending,
            },
        };
        Poll::Ready(piece.map(|piece| piece.map(Frame::data)))
    }

    fn size_hint(&self) -> SizeHint {
        match self {
            Self::Whole(bytes) => {
                SizeHint::with_exact(bytes.as_ref().map_or(0, |bytes| bytes.len() as u64))
            }
            Self::File(_, left) => SizeHint::with_exact(*left),
            Self::Live(_) => SizeHint::default(),
        }
    }

    fn is_end_stream(&self) -> bool {
        matches!(self, Self::Whole(None) | Self::File(_, 0))
    }
}
