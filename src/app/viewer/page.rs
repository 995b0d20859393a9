//! Rerun's web viewer and the recordings that it shows, served on loopback.
//!
//! Viewer and recordings come from one address, so no other page may read them: `/` leads to the viewer with the recordings that are served,
//! `/1/recording.rrd` is the first of them. One that is still being made is served as it grows.

use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use re_web_viewer_server::WebViewerData;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

use super::ViewerError;
use super::live_buffer::LiveBuffer;

/// The port that is tried first where none is asked for: Rerun's own for its web viewer.
const USUAL_PORT: u16 = 9090;

/// A recording that is served.
pub(in crate::app) enum Served {
    /// A file.
    File(PathBuf),
    /// One that is being made.
    Live(Arc<LiveBuffer>),
}

/// The web viewer, listening.
pub(in crate::app) struct WebPage {
    server: Server,
    viewer: WebViewerData,
    recordings: Vec<Served>,
    port: u16,
}

impl WebPage {
    /// Listens on a port, 0 for any; without one on the usual port or, if that is taken, any.
    pub(in crate::app) fn listen(
        port: Option<u16>,
        recordings: Vec<Served>,
    ) -> Result<Self, ViewerError> {
        let listener = match port {
            Some(port) => bind(port)?,
            None => bind(USUAL_PORT).or_else(|_| bind(0))?,
        };
        let failed = |error: &dyn std::fmt::Display| ViewerError::Page(error.to_string());
        let port = listener.local_addr().map_err(|error| failed(&error))?;
        Ok(Self {
            server: Server::from_listener(listener, None).map_err(|error| failed(&error))?,
            viewer: WebViewerData::load(None).map_err(|error| failed(&error))?,
            recordings,
            port: port.port(),
        })
    }

    /// Where it is.
    pub(in crate::app) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers until this program ends.
    pub(in crate::app) fn serve(self: &Arc<Self>) {
        while let Ok(request) = self.server.recv() {
            let page = Arc::clone(self);
            // A recording that is being made takes as long as it takes; others are not to wait for it.
            std::thread::spawn(move || page.answer(request));
        }
    }

    /// Answers one request. A reader that leaves early is its own affair.
    fn answer(&self, request: Request) {
        let Some(host) = local_host(&request) else {
            // A page elsewhere whose name leads here: it is not to read what is shown.
            drop(request.respond(Response::empty(403)));
            return;
        };
        if !matches!(request.method(), Method::Get | Method::Head) {
            drop(request.respond(Response::empty(405)));
            return;
        }
        let url = request.url().to_owned();
        let (path, query) = url.split_once('?').unwrap_or((&url, ""));
        if path == "/" && query.is_empty() {
            let redirect = Response::empty(302).with_header(header("Location", &self.start(&host)));
            drop(request.respond(redirect));
        } else if let Some((kind, bytes)) = self.viewer_file(path) {
            let response = Response::from_data(bytes)
                .with_header(header("Content-Type", kind))
                .with_header(header("Content-Security-Policy", POLICY))
                // Sent in pieces it has no length, which the page wants for its progress bar.
                .with_header(header("rerun-final-length", &bytes.len().to_string()));
            drop(request.respond(response));
        } else {
            self.answer_recording(request, path);
        }
    }

    /// The viewer's own address with all recordings.
    fn start(&self, host: &str) -> String {
        let recording = |number: usize| {
            let host = host.replace(':', "%3A");
            format!("url=http%3A%2F%2F{host}%2F{number}%2Frecording.rrd")
        };
        let recordings: Vec<String> = (1..=self.recordings.len()).map(recording).collect();
        format!("/?{}", recordings.join("&"))
    }

    fn viewer_file(&self, path: &str) -> Option<(&'static str, &[u8])> {
        let viewer = &self.viewer;
        Some(match path {
            "/" | "/index.html" => ("text/html", viewer.index_html()),
            "/favicon.ico" => ("image/x-icon", viewer.favicon()),
            "/apple-touch-icon.png" => ("image/png", viewer.apple_touch_icon()),
            "/sw.js" => ("text/javascript", viewer.sw_js()),
            "/re_viewer.js" => ("text/javascript", viewer.viewer_js()),
            "/re_viewer_bg.wasm" => ("application/wasm", viewer.viewer_wasm()),
            _ => return None,
        })
    }

    fn answer_recording(&self, request: Request, path: &str) {
        let number = path
            .strip_prefix('/')
            .and_then(|path| path.strip_suffix("/recording.rrd"))
            .and_then(|number| number.parse::<usize>().ok());
        let recording = number.and_then(|number| self.recordings.get(number.checked_sub(1)?));
        let headers = vec![
            header("Content-Type", "application/octet-stream"),
            // The next run is served under the same address.
            header("Cache-Control", "no-store"),
        ];
        let sent = match recording {
            None => request.respond(Response::empty(404)),
            Some(Served::File(file)) => match crate::file::open(file) {
                Err(_) => request.respond(Response::empty(404)),
                Ok(file) => {
                    let length = file.metadata().ok().map(|data| data.len() as usize);
                    let status = StatusCode(200);
                    request.respond(Response::new(status, headers, file, length, None))
                }
            },
            Some(Served::Live(buffer)) => {
                let reader = buffer.reader();
                request.respond(Response::new(StatusCode(200), headers, reader, None, None))
            }
        };
        drop(sent);
    }
}

/// The viewer may ask this machine alone: it has a font and a count of its users on the network.
const POLICY: &str = "default-src 'self' data: blob:; script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:";

fn bind(port: u16) -> Result<TcpListener, ViewerError> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| match error.kind() {
        std::io::ErrorKind::AddrInUse => ViewerError::PortInUse { port },
        _ => ViewerError::Port {
            port,
            reason: error.to_string(),
        },
    })
}

fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("names and values are plain ASCII")
}

/// The name by which this machine was asked, if it is one for itself.
fn local_host(request: &Request) -> Option<String> {
    let host = request
        .headers()
        .iter()
        .find(|header| header.field.equiv("Host"))?
        .value
        .as_str();
    let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
    ["127.0.0.1", "localhost"]
        .contains(&name)
        .then(|| host.to_owned())
}
