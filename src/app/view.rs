//! `idc view`: recordings looked at, in the native viewer where it is installed, otherwise as a web page on loopback.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use super::error::{AppError, ExitCode};
use super::output::say;
use super::viewer::{NativeViewer, Shown, ViewerError, WebPage};
use crate::recording::rerun::{check_rrd, viewer_version};

/// Shown below the help.
pub(super) const EXAMPLES: &str = "\
The native viewer is the program `rerun` on the PATH, or the one that IDC_RERUN
names, of the version that wrote the recording; without it, or without a
display, the web viewer that is part of this program is served on 127.0.0.1.

Exit codes: 0 done, 2 a file that is no whole recording of this version, a port
in use, or no viewer.

Examples:
  # A run's recording. (opens a window)
  idc view runs/first/recording.rrd
  # As a web page at a port, until Ctrl-C. (serves until stopped)
  idc view --port 9191 runs/first/recording.rrd
  # Two runs together. (opens a window)
  idc view runs/first/recording.rrd runs/second/recording.rrd";

#[derive(Debug, Args)]
pub(super) struct ViewArguments {
    /// Recordings: .rrd files. Several are opened together.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Open the native viewer, or say why it cannot be [default: where it can be].
    #[arg(long, conflicts_with_all = ["web", "port"])]
    native: bool,
    /// Serve the web viewer on 127.0.0.1, until Ctrl-C.
    #[arg(long)]
    web: bool,
    /// Port of the web viewer, 0 for any that is free; means --web [default: 9090 or, if that is taken, any].
    #[arg(long)]
    port: Option<u16>,
    /// Print where the recordings are shown as JSON.
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Place<'a> {
    viewer: &'static str,
    address: Option<&'a str>,
    program: Option<String>,
    rerun: String,
    files: Vec<String>,
}

/// Shows the files until the window is closed, or until Ctrl-C.
pub(super) fn run(arguments: &ViewArguments) -> Result<ExitCode, AppError> {
    for file in &arguments.files {
        check_rrd(file).map_err(ViewerError::File)?;
    }
    let web = arguments.web || arguments.port.is_some();
    let native = (!web).then(NativeViewer::find);
    match native {
        Some(Ok(viewer)) => return show_native(arguments, &viewer),
        Some(Err(error)) if arguments.native => return Err(error.into()),
        Some(Err(error)) => eprintln!("note: {}", why_web(&error)),
        None => (),
    }
    show_page(arguments)
}

/// Why there is a web page in place of a window.
fn why_web(error: &ViewerError) -> String {
    let text = error.to_string();
    let reason = text.split("; the web viewer").next().unwrap_or_default();
    format!("shown as a web page, as {reason}")
}

fn show_native(arguments: &ViewArguments, viewer: &NativeViewer) -> Result<ExitCode, AppError> {
    if arguments.json {
        say_place(arguments, None, Some(viewer))?;
    }
    viewer.show(&arguments.files)?;
    Ok(ExitCode::Done)
}

fn show_page(arguments: &ViewArguments) -> Result<ExitCode, AppError> {
    let recordings = arguments.files.iter().cloned().map(Shown::File).collect();
    let page = Arc::new(WebPage::listen(arguments.port, recordings)?);
    let address = page.address();
    if arguments.json {
        say_place(arguments, Some(&address), None)?;
    } else {
        say(&format!("{address}  (Ctrl-C ends)\n"))?;
    }
    page.serve();
    Ok(ExitCode::Done)
}

fn say_place(
    arguments: &ViewArguments,
    address: Option<&str>,
    viewer: Option<&NativeViewer>,
) -> Result<(), AppError> {
    let place = Place {
        viewer: if viewer.is_some() { "native" } else { "web" },
        address,
        program: viewer.map(|viewer| viewer.program().display().to_string()),
        rerun: viewer_version(),
        files: (arguments.files.iter())
            .map(|file| file.display().to_string())
            .collect(),
    };
    say(&format!("{}\n", serde_json::to_string_pretty(&place)?))
}
