//! Viewers of recordings: the native one where it is installed, the web one on loopback, and runs that are watched while they go on.

mod content;
mod live_buffer;
mod native;
mod page;
mod patient;
mod watch;

pub(super) use native::NativeViewer;
pub(super) use page::{Served, WebPage};
pub(super) use watch::{PART_INTERVAL, Viewing, Watch};

use crate::viewer::{RrdFault, viewer_version};

/// Reasons why a recording cannot be looked at.
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// The file.
    #[error(transparent)]
    File(#[from] RrdFault),
    /// No native viewer.
    #[error(
        "no program `rerun` was found on the PATH; expected Rerun's viewer {version}: pip install rerun-sdk=={version}",
        version = viewer_version()
    )]
    NotInstalled,
    /// A native viewer that does not fit.
    #[error(
        "{program} is Rerun {found}, expected {version}: pip install rerun-sdk=={version}",
        version = viewer_version()
    )]
    OtherVersion {
        /// The program.
        program: String,
        /// Its version.
        found: String,
    },
    /// A program of that name that is something else.
    #[error(
        "{program} --version does not answer as Rerun's viewer does; expected `rerun-cli {version}`: pip install rerun-sdk=={version}",
        version = viewer_version()
    )]
    NotRerun {
        /// The program.
        program: String,
    },
    /// Nowhere to open a window.
    #[error(
        "there is no display to open a window on: neither DISPLAY nor WAYLAND_DISPLAY is set; the web viewer needs none (view --web, run --view=web)"
    )]
    NoDisplay,
    /// The native viewer does not start, or gives up.
    #[error(
        "{program} cannot show the recording: {reason}; the web viewer may (view --web, run --view=web)"
    )]
    Failed {
        /// The program.
        program: String,
        /// Why.
        reason: String,
    },
    /// A port that is taken.
    #[error(
        "port {port} of 127.0.0.1 is in use; expected a free one (view: --port names another, --port 0 takes any; run: --view=web:PORT)"
    )]
    PortInUse {
        /// The port.
        port: u16,
    },
    /// A port that cannot be had.
    #[error("cannot listen on port {port} of 127.0.0.1: {reason}")]
    Port {
        /// The port.
        port: u16,
        /// Why.
        reason: String,
    },
    /// The web viewer does not come up.
    #[error("cannot serve the web viewer: {0}")]
    Page(String),
    /// An address that is none.
    #[error(
        "--view={text} is not where a viewer listens: {reason}; expected `native`, `web`, `web:PORT`, HOST:PORT or rerun+http://HOST:PORT/proxy"
    )]
    Address {
        /// The text given.
        text: String,
        /// Its fault.
        reason: String,
    },
    /// An address at which nobody listens.
    #[error(
        "no viewer listens at {address}: {reason}; expected one that was started there: rerun --port {port}"
    )]
    NobodyListens {
        /// Host and port.
        address: String,
        /// The port.
        port: u16,
        /// Why.
        reason: String,
    },
}
