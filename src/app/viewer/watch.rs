//! `idc run --view`: a run that is watched while it goes on. The simulation only hands over its samples; encoding and sending is a thread's of its own,
//! and a viewer that goes away ends neither.

use std::net::{TcpStream, ToSocketAddrs as _};
use std::process::ChildStdin;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use super::super::terminal::say_aside;
use super::live_buffer::{LiveBuffer, LiveBufferWriter};
use super::{NativeViewer, Served, ViewerError, WebPage};
use crate::recording::{Recording, RecordingError};
use crate::scene::Scene;
use crate::viewer::{LiveOutlet, LiveRecording, RerunOptions};

/// Simulated time between two parts that are sent [s].
pub(in crate::app) const PART_INTERVAL: f64 = 0.2;
/// Longest time that a viewer elsewhere may take to answer.
const PATIENCE: Duration = Duration::from_secs(3);
/// Stands in the summary's place until there is one.
const NOT_OVER: &str = "*The run is not over yet.*";

/// Where a run is to be watched.
pub(in crate::app) enum Viewing {
    /// In the native viewer.
    Native(NativeViewer),
    /// As a web page, which listens already, by what is written.
    Web(Arc<WebPage>, LiveBufferWriter),
    /// In a viewer that listens at an address.
    Elsewhere(String),
}

impl Viewing {
    /// Meanings of `--view`: nothing (native where it is installed, otherwise as a web page), `native`, `web`, `web:PORT` or an address.
    pub(in crate::app) fn parse(text: &str) -> Result<Self, ViewerError> {
        let refuse = |reason: String| ViewerError::Address {
            text: text.to_owned(),
            reason,
        };
        match text {
            "" => NativeViewer::find()
                .map_or_else(|_| Self::web(None), |viewer| Ok(Self::Native(viewer))),
            "native" => NativeViewer::find().map(Self::Native),
            "web" => Self::web(None),
            _ => {
                if let Some(port) = text.strip_prefix("web:") {
                    let port = port
                        .parse()
                        .map_err(|_| refuse(format!("{port} is no port")))?;
                    return Self::web(Some(port));
                }
                let address = if text.contains("://") {
                    text.to_owned()
                } else {
                    format!("rerun+http://{text}/proxy")
                };
                let (host, port) = LiveRecording::address(&address).map_err(refuse)?;
                reach(&host, port)?;
                Ok(Self::Elsewhere(address))
            }
        }
    }

    fn web(port: Option<u16>) -> Result<Self, ViewerError> {
        let buffer = Arc::new(LiveBuffer::default());
        let writer = buffer.writer();
        let page = WebPage::listen(port, vec![Served::Live(buffer)])?;
        Ok(Self::Web(Arc::new(page), writer))
    }
}

/// Checks that somebody listens there.
fn reach(host: &str, port: u16) -> Result<(), ViewerError> {
    let nobody = |reason: String| ViewerError::NobodyListens {
        address: format!("{host}:{port}"),
        port,
        reason,
    };
    let places = (host, port).to_socket_addrs();
    let mut last = "the name leads nowhere".to_owned();
    for place in places.map_err(|error| nobody(error.to_string()))? {
        match TcpStream::connect_timeout(&place, PATIENCE) {
            Ok(_) => return Ok(()),
            Err(error) => last = error.to_string(),
        }
    }
    Err(nobody(last))
}

/// Message to the thread that sends.
enum Part {
    /// Samples and frames that have come since the last part.
    Samples(Box<Recording>, Box<Scene>),
    /// The whole run's scene and its summary.
    End(Box<Scene>, String),
}

/// A run that is being watched.
pub(in crate::app) struct Watch {
    parts: Sender<Part>,
    thread: JoinHandle<Result<(), RecordingError>>,
    page: Option<Arc<WebPage>>,
}

impl Watch {
    /// Opens the viewer.
    pub(in crate::app) fn begin(viewing: Viewing) -> Result<Self, ViewerError> {
        let (outlet, page) = match viewing {
            Viewing::Native(viewer) => {
                let mut child = viewer.open_stream()?;
                let input: Option<ChildStdin> = child.stdin.take();
                let input = input.expect("its standard input was asked for");
                (LiveOutlet::Writer(Box::new(input)), None)
            }
            Viewing::Web(page, writer) => {
                let served = Arc::clone(&page);
                // That it cannot be shown does not end the run.
                std::thread::spawn(move || {
                    if let Err(error) = served.serve() {
                        say_aside(&format!("note: {error}"));
                    }
                });
                (LiveOutlet::Writer(Box::new(writer)), Some(page))
            }
            Viewing::Elsewhere(address) => (LiveOutlet::Viewer(address), None),
        };
        let (parts, received) = channel();
        let thread = std::thread::spawn(move || send_all(outlet, &received));
        Ok(Self {
            parts,
            thread,
            page,
        })
    }

    /// Where the web page is, if it is one.
    pub(in crate::app) fn address(&self) -> Option<String> {
        self.page.as_ref().map(|page| page.address())
    }

    /// Hands over what has come since the last part.
    pub(in crate::app) fn add(&self, samples: Recording, scene: Scene) {
        // With the thread gone, so is the viewer: `end` says so.
        let part = Part::Samples(Box::new(samples), Box::new(scene));
        drop(self.parts.send(part));
    }

    /// Hands over what only the whole run tells, and waits until all is sent; on a web page, until this program is interrupted.
    pub(in crate::app) fn close(self, scene: Scene, summary_markdown: String, quiet: bool) {
        let address = self.address();
        if let Err(error) = self.end(scene, summary_markdown) {
            say_aside(&format!("note: {error}; the files hold all of it"));
        } else if let Some(address) = address {
            if !quiet {
                say_aside(&format!(
                    "the run can be looked at under {address} until Ctrl-C"
                ));
            }
            loop {
                std::thread::park();
            }
        }
    }

    fn end(self, scene: Scene, summary_markdown: String) -> Result<(), RecordingError> {
        drop(
            self.parts
                .send(Part::End(Box::new(scene), summary_markdown)),
        );
        drop(self.parts);
        self.thread.join().unwrap_or_else(|_| {
            Err(RecordingError::Live {
                cause: "sending failed".to_owned(),
            })
        })
    }
}

/// Sends part after part, up to the end of the run or of the viewer.
fn send_all(outlet: LiveOutlet, parts: &Receiver<Part>) -> Result<(), RecordingError> {
    let options = RerunOptions {
        summary_markdown: NOT_OVER.to_owned(),
        ..RerunOptions::default()
    };
    let Ok(Part::Samples(samples, scene)) = parts.recv() else {
        return Ok(());
    };
    let mut live = LiveRecording::begin(outlet, &samples, &scene, &options)?;
    for part in parts {
        match part {
            Part::Samples(samples, scene) => live.add(&samples, &scene)?,
            Part::End(scene, summary) => return live.end(&scene, &summary),
        }
    }
    Ok(())
}
