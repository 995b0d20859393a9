//! `idc view`: recordings looked at, in the native viewer where it is installed, otherwise as a web page on loopback.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use super::diagnose::natural;
use super::error::{AppError, ExitCode};
use super::files::{BOARD, RECORDING};
use super::output::say;
use super::terminal::say_aside;
use super::viewer::{NativeViewer, Served, ViewerError, WebPage};
use crate::viewer::{check_rrd, viewer_version};

/// Served below the help.
pub(super) const EXAMPLES: &str = "\
The native viewer is the program `rerun` on the PATH, or the one that IDC_RERUN
names, of the version that wrote the recording; without it, or without a
display, the web viewer that is part of this program is served on 127.0.0.1.

Of a folder that run or diagnose wrote, its recording is opened; of a folder of
such folders, as run --set or diagnose --all leave them, all of them.

Exit codes: 0 done, 2 a file that is no whole recording of this version, a port
in use, or no viewer.

Examples:
  # A run, or a diagnosis, by its folder. (opens a window)
  idc view runs/first
  # As a web page at a port, until Ctrl-C. (serves until stopped)
  idc view --port 9191 runs/first/recording.rrd
  # Two runs together. (opens a window)
  idc view runs/first/recording.rrd runs/second/recording.rrd";

/// Folders in folders that are looked through.
const DEPTH: usize = 2;
/// Recordings that are opened of a folder at most.
const MOST: usize = 12;

#[derive(Debug, Args)]
pub(super) struct ViewArguments {
    /// Recordings: .rrd files, or folders with results; of a folder of such folders all are taken. Several are opened together.
    #[arg(required = true, value_name = "FILE|FOLDER")]
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

/// The document of `--json`.
#[derive(Serialize)]
struct ViewAddress<'a> {
    viewer: &'static str,
    address: Option<&'a str>,
    program: Option<String>,
    rerun: String,
    files: Vec<String>,
}

/// Shows the files until the window is closed, or until Ctrl-C.
pub(super) fn run(arguments: &ViewArguments) -> Result<ExitCode, AppError> {
    let files = recordings(&arguments.files)?;
    for file in &files {
        check_rrd(file).map_err(ViewerError::File)?;
    }
    // Ctrl-C is how it ends.
    let web = arguments.web || arguments.port.is_some();
    let native = (!web).then(NativeViewer::find);
    match native {
        Some(Ok(viewer)) => return show_native(arguments, &files, &viewer),
        Some(Err(error)) if arguments.native => return Err(error.into()),
        Some(Err(error)) => say_aside(&format!("note: {}", why_web(&error))),
        None => (),
    }
    show_page(arguments, &files)
}

/// Recordings in the place of folders that hold results.
fn recordings(named: &[PathBuf]) -> Result<Vec<PathBuf>, AppError> {
    let mut files = Vec::new();
    for path in named {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut found = Vec::new();
        note_recordings(path, DEPTH, &mut found);
        let folder = || path.display().to_string();
        if found.is_empty() {
            return Err(AppError::NothingToView { folder: folder() });
        }
        if found.len() > MOST {
            let some: Vec<String> = (found[..3].iter())
                .map(|file| file.display().to_string())
                .collect();
            return Err(AppError::TooManyToView {
                folder: folder(),
                count: found.len(),
                most: MOST,
                some: some.join(", "),
            });
        }
        files.extend(found);
    }
    Ok(files)
}

/// Recordings in a folder, or else in those that it holds, in the order of their names.
fn note_recordings(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) {
    let own = [RECORDING, BOARD].map(|name| folder.join(name));
    let before = found.len();
    found.extend(own.into_iter().filter(|file| file.is_file()));
    if depth == 0 || found.len() > before {
        return;
    }
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    let mut inner: Vec<PathBuf> = (entries.filter_map(|entry| Some(entry.ok()?.path())))
        .filter(|path| path.is_dir())
        .collect();
    inner.sort_by_key(|path| natural(&path.display().to_string()));
    for folder in inner {
        note_recordings(&folder, depth - 1, found);
    }
}

/// Why there is a web page in place of a window.
fn why_web(error: &ViewerError) -> String {
    let text = error.to_string();
    let reason = text.split("; the web viewer").next().unwrap_or_default();
    format!("shown as a web page, as {reason}")
}

fn show_native(
    arguments: &ViewArguments,
    files: &[PathBuf],
    viewer: &NativeViewer,
) -> Result<ExitCode, AppError> {
    if arguments.json {
        say_place(files, None, Some(viewer))?;
    }
    viewer.show(files)?;
    Ok(ExitCode::Done)
}

fn show_page(arguments: &ViewArguments, files: &[PathBuf]) -> Result<ExitCode, AppError> {
    let recordings = files.iter().cloned().map(Served::File).collect();
    let page = Arc::new(WebPage::listen(arguments.port, recordings)?);
    let address = page.address();
    if arguments.json {
        say_place(files, Some(&address), None)?;
    } else {
        say(&format!("{address}  (Ctrl-C ends)\n"))?;
    }
    page.serve()?;
    Ok(ExitCode::Done)
}

fn say_place(
    files: &[PathBuf],
    address: Option<&str>,
    viewer: Option<&NativeViewer>,
) -> Result<(), AppError> {
    let address = ViewAddress {
        viewer: if viewer.is_some() { "native" } else { "web" },
        address,
        program: viewer.map(|viewer| viewer.program().display().to_string()),
        rerun: viewer_version(),
        files: (files.iter())
            .map(|file| file.display().to_string())
            .collect(),
    };
    say(&format!("{}\n", serde_json::to_string_pretty(&address)?))
}
