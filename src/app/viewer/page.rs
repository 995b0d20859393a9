//! Rerun's web viewer and the recordings that it shows, served on loopback.
//!
//! Viewer and recordings come from one address, so no other page may read them: `/` leads to the viewer with the recordings that are served,
//! `/1/recording.rrd` is the first of them. One that is still being made is served as it grows. Connections are so many at most, and one whose other side neither
//! finishes its request nor takes its answer is closed.

use std::convert::Infallible;
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use bytes::Bytes;
use hyper::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, HeaderName, HeaderValue, LOCATION,
};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use re_web_viewer_server::WebViewerData;
use sha2::{Digest as _, Sha256};
use tokio::net::TcpStream;
use tokio::runtime::Runtime;
use tokio::sync::Semaphore;

use super::ViewerError;
use super::content::Content;
use super::live_buffer::LiveBuffer;
use super::patient::Patient;

/// The port that is tried first where none is asked for: Rerun's own for its web viewer.
const USUAL_PORT: u16 = 9090;

/// What those who connect are granted.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Connections at a time.
    connections: usize,
    /// Time for the head of a request, also of the next one on a connection.
    head: Duration,
    /// Time in which something of an answer is taken.
    unread: Duration,
}

/// A browser takes six connections a tab.
const LIMITS: Limits = Limits {
    connections: 64,
    head: Duration::from_secs(15),
    unread: Duration::from_mins(1),
};
/// Memory for what is read, and for what is written beside shared content, of a connection [byte].
const BUFFER: usize = 1 << 16;

/// A recording that is served.
pub(in crate::app) enum Served {
    /// A file.
    File(PathBuf),
    /// One that is being made.
    Live(Arc<LiveBuffer>),
}

/// The web viewer, listening.
pub(in crate::app) struct WebPage {
    runtime: Runtime,
    listener: TcpListener,
    limits: Limits,
    viewer: Arc<WebViewerData>,
    policy: HeaderValue,
    recordings: Vec<Served>,
    port: u16,
}

/// A file of the viewer, which all answers share.
struct ViewerFile(Arc<WebViewerData>, fn(&WebViewerData) -> &[u8]);

impl AsRef<[u8]> for ViewerFile {
    fn as_ref(&self) -> &[u8] {
        (self.1)(&self.0)
    }
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
        Self::on(listener, recordings, LIMITS)
    }

    fn on(
        listener: TcpListener,
        recordings: Vec<Served>,
        limits: Limits,
    ) -> Result<Self, ViewerError> {
        let failed = |error: &dyn std::fmt::Display| ViewerError::Page(error.to_string());
        let port = listener.local_addr().map_err(|error| failed(&error))?;
        listener.set_nonblocking(true).map_err(|e| failed(&e))?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build();
        let viewer = WebViewerData::load(None).map_err(|error| failed(&error))?;
        let policy = policy(&String::from_utf8_lossy(viewer.index_html()));
        Ok(Self {
            runtime: runtime.map_err(|error| failed(&error))?,
            listener,
            limits,
            viewer: Arc::new(viewer),
            policy: HeaderValue::from_str(&policy).map_err(|error| failed(&error))?,
            recordings,
            port: port.port(),
        })
    }

    /// Where it is.
    pub(in crate::app) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers until this program ends.
    pub(in crate::app) fn serve(self: &Arc<Self>) -> Result<(), ViewerError> {
        let served: std::io::Result<()> = self.runtime.block_on(async {
            let listener = self.listener.try_clone();
            let listener = tokio::net::TcpListener::from_std(listener?)?;
            let places = Arc::new(Semaphore::new(self.limits.connections));
            loop {
                let place = Arc::clone(&places).acquire_owned().await;
                let Ok((stream, _)) = listener.accept().await else {
                    // As where too many files are open: that passes.
                    tokio::time::sleep(Duration::from_millis(100)).await;
                    continue;
                };
                let page = Arc::clone(self);
                tokio::spawn(async move {
                    page.attend(stream).await;
                    drop(place);
                });
            }
        });
        served.map_err(|error| ViewerError::Page(error.to_string()))
    }

    /// Answers what comes over a connection. That a reader leaves early is its own affair.
    async fn attend(&self, stream: TcpStream) {
        let stream = TokioIo::new(Patient::new(stream, self.limits.unread));
        let answer =
            service_fn(|request| async move { Ok::<_, Infallible>(self.answer(&request)) });
        let mut connection = http1::Builder::new();
        connection.timer(TokioTimer::new());
        connection.header_read_timeout(self.limits.head);
        connection.max_buf_size(BUFFER);
        drop(connection.serve_connection(stream, answer).await);
    }

    /// Answers one request.
    fn answer<B>(&self, request: &Request<B>) -> Response<Content> {
        let Some(host) = local_host(request) else {
            // A page elsewhere whose name leads here: it is not to read what is shown.
            return status(StatusCode::FORBIDDEN);
        };
        if ![Method::GET, Method::HEAD].contains(request.method()) {
            return status(StatusCode::METHOD_NOT_ALLOWED);
        }
        let path = request.uri().path();
        let query = request.uri().query().unwrap_or_default();
        let mut response = if path == "/" && query.is_empty() {
            self.redirect(host)
        } else if let Some((kind, of)) = viewer_file(path) {
            self.of_viewer(kind, of)
        } else {
            self.recording(path)
        };
        for (name, value) in ALWAYS {
            let name = HeaderName::from_static(name);
            let value = HeaderValue::from_static(value);
            response.headers_mut().insert(name, value);
        }
        response
    }

    /// Leads to the viewer's own address with all recordings.
    fn redirect(&self, host: &str) -> Response<Content> {
        let recording = |number: usize| {
            let host = host.replace(':', "%3A");
            format!("url=http%3A%2F%2F{host}%2F{number}%2Frecording.rrd")
        };
        let recordings: Vec<String> = (1..=self.recordings.len()).map(recording).collect();
        let Ok(address) = HeaderValue::from_str(&format!("/?{}", recordings.join("&"))) else {
            return status(StatusCode::BAD_REQUEST);
        };
        let mut response = status(StatusCode::FOUND);
        response.headers_mut().insert(LOCATION, address);
        response
    }

    /// A file of the viewer.
    fn of_viewer(&self, kind: &'static str, of: ViewerFileOf) -> Response<Content> {
        let bytes = Bytes::from_owner(ViewerFile(Arc::clone(&self.viewer), of));
        // The page's progress bar asks for it by this name.
        let length = HeaderValue::from(bytes.len());
        let mut response = Response::new(Content::Whole(Some(bytes)));
        let headers = response.headers_mut();
        headers.insert(CONTENT_TYPE, HeaderValue::from_static(kind));
        headers.insert(CONTENT_SECURITY_POLICY, self.policy.clone());
        headers.insert(HeaderName::from_static("rerun-final-length"), length);
        response
    }

    /// A recording.
    fn recording(&self, path: &str) -> Response<Content> {
        let number = path
            .strip_prefix('/')
            .and_then(|path| path.strip_suffix("/recording.rrd"))
            .and_then(|number| number.parse::<usize>().ok());
        let recording = number.and_then(|number| self.recordings.get(number.checked_sub(1)?));
        let content = match recording {
            None => None,
            Some(Served::File(file)) => crate::file::open(file).and_then(Content::file).ok(),
            Some(Served::Live(buffer)) => Some(Content::Live(buffer.reader())),
        };
        let Some(content) = content else {
            return status(StatusCode::NOT_FOUND);
        };
        let mut response = Response::new(content);
        let headers = response.headers_mut();
        let kind = HeaderValue::from_static("application/octet-stream");
        headers.insert(CONTENT_TYPE, kind);
        // The next run is served under the same address.
        headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
        response
    }
}

/// What a browser gets with every answer: nothing here is of another kind than it says, nor for another page.
const ALWAYS: [(&str, &str); 3] = [
    ("x-content-type-options", "nosniff"),
    ("cross-origin-resource-policy", "same-origin"),
    ("referrer-policy", "no-referrer"),
];

type ViewerFileOf = fn(&WebViewerData) -> &[u8];

/// Kind and content of a file of the viewer.
fn viewer_file(path: &str) -> Option<(&'static str, ViewerFileOf)> {
    Some(match path {
        "/" | "/index.html" => ("text/html", WebViewerData::index_html),
        "/favicon.ico" => ("image/x-icon", WebViewerData::favicon),
        "/apple-touch-icon.png" => ("image/png", WebViewerData::apple_touch_icon),
        "/sw.js" => ("text/javascript", WebViewerData::sw_js),
        "/re_viewer.js" => ("text/javascript", WebViewerData::viewer_js),
        "/re_viewer_bg.wasm" => ("application/wasm", WebViewerData::viewer_wasm),
        _ => return None,
    })
}

/// The viewer may ask this machine alone, although it has a font and a count of its users on the network, and of the scripts within its page those run that came with it.
fn policy(index: &str) -> String {
    let scripts = index.split("<script>").skip(1);
    let scripts = scripts.filter_map(|rest| Some(rest.split_once("</script>")?.0));
    let hashes =
        scripts.map(|script| format!(" 'sha256-{}'", STANDARD.encode(Sha256::digest(script))));
    let hashes: String = hashes.collect();
    format!(
        "default-src 'self' data: blob:; script-src 'self' 'wasm-unsafe-eval'{hashes}; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
}

fn bind(port: u16) -> Result<TcpListener, ViewerError> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| match error.kind() {
        std::io::ErrorKind::AddrInUse => ViewerError::PortInUse { port },
        _ => ViewerError::Port {
            port,
            reason: error.to_string(),
        },
    })
}

fn status(code: StatusCode) -> Response<Content> {
    let mut response = Response::new(Content::empty());
    *response.status_mut() = code;
    response
}

/// The name by which this machine was asked, if it is one for itself.
fn local_host<B>(request: &Request<B>) -> Option<&str> {
    let host = request.headers().get(HOST)?.to_str().ok()?;
    let (name, port) = host.rsplit_once(':').unwrap_or((host, ""));
    let is_port = port.chars().all(|letter| letter.is_ascii_digit());
    (["127.0.0.1", "localhost"].contains(&name) && is_port).then_some(host)
}

#[cfg(test)]
mod tests {
    use std::io::{Read as _, Write as _};
    use std::net::TcpStream;
    use std::time::Instant;

    use super::*;

    /// A page that grants little; its port.
    fn served(limits: Limits, recordings: Vec<Served>) -> u16 {
        let page = Arc::new(WebPage::on(bind(0).unwrap(), recordings, limits).unwrap());
        let port = page.port;
        std::thread::spawn(move || page.serve());
        port
    }

    fn asked(port: u16, text: &str) -> TcpStream {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.write_all(text.as_bytes()).unwrap();
        let patience = Some(Duration::from_secs(20));
        stream.set_read_timeout(patience).unwrap();
        stream
    }

    const QUICK: Limits = Limits {
        connections: 2,
        head: Duration::from_millis(300),
        unread: Duration::from_millis(300),
    };
    const WASM: &str = "GET /re_viewer_bg.wasm HTTP/1.1\r\nHost: localhost\r\n\r\n";

    #[test]
    fn half_a_request_is_closed_and_its_place_is_free_again() {
        let port = served(QUICK, Vec::new());
        let begin = Instant::now();
        let halves = ["GET / HTTP/1.1\r\nHos", "", "GET / HT"];
        let halves = halves.map(|half| asked(port, half));
        // The third waits for a place of the two.
        for mut half in halves {
            let mut answer = Vec::new();
            drop(half.read_to_end(&mut answer));
            assert!(!answer.starts_with(b"HTTP/1.1 2"));
        }
        assert!(begin.elapsed() < Duration::from_secs(10));
        let mut whole = asked(port, "GET /favicon.ico HTTP/1.0\r\nHost: localhost\r\n\r\n");
        let mut answer = Vec::new();
        whole.read_to_end(&mut answer).unwrap();
        assert!(answer.starts_with(b"HTTP/1.0 200"));
    }

    #[test]
    fn an_answer_that_nobody_takes_is_given_up_and_one_that_is_made_slowly_is_not() {
        let buffer = Arc::new(LiveBuffer::default());
        let mut writer = buffer.writer();
        let port = served(QUICK, vec![Served::Live(buffer)]);
        let mut unread = asked(port, WASM);
        let mut live = asked(
            port,
            "GET /1/recording.rrd HTTP/1.0\r\nHost: localhost\r\n\r\n",
        );
        std::thread::sleep(4 * QUICK.unread);
        writer.write_all(b"late").unwrap();
        drop(writer);
        let mut answer = Vec::new();
        live.read_to_end(&mut answer).unwrap();
        assert!(answer.ends_with(b"late"));
        answer.clear();
        // What lay in the sockets' buffers, and no more.
        drop(unread.read_to_end(&mut answer));
        assert!(answer.len() < 41_000_000, "{}", answer.len());
    }

    #[test]
    fn a_file_of_the_viewer_is_shared_by_all_answers() {
        let page = WebPage::on(bind(0).unwrap(), Vec::new(), QUICK).unwrap();
        let request = Request::builder().uri("/re_viewer_bg.wasm");
        let request = request.header(HOST, "127.0.0.1:9090").body(()).unwrap();
        let places = [0, 1].map(|_| match page.answer(&request).into_body() {
            Content::Whole(Some(bytes)) => bytes.as_ptr(),
            _ => panic!("no file"),
        });
        assert_eq!(places[0], page.viewer.viewer_wasm().as_ptr());
        assert_eq!(places[0], places[1]);
    }

    #[test]
    fn of_the_scripts_of_the_page_each_has_its_hash() {
        let policy = policy("<script>alert(1)</script><script src=\"a.js\"></script>");
        assert!(policy.contains("'sha256-bhHHL3z2vDgxUt0W3dWQOrprscmda2Y5pLsLg4GF+pI='"));
        assert!(!policy.contains("script-src 'self' 'unsafe") && !policy.contains("'unsafe-eval'"));
        let page = WebPage::on(bind(0).unwrap(), Vec::new(), QUICK).unwrap();
        let index = String::from_utf8_lossy(page.viewer.index_html()).into_owned();
        let hashes = page.policy.to_str().unwrap().matches("'sha256-").count();
        let within = index.matches("<script").count() - index.matches("<script src=").count();
        assert_eq!(hashes, within);
    }
}
