//! Rerun's native viewer: the program `rerun`, if it is there, is of our version and has a display.

use std::env;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::ViewerError;
use crate::viewer::viewer_version;

/// Names the program where it is not on the PATH.
const PROGRAM: &str = "IDC_RERUN";

/// A native viewer that can be used.
pub(in crate::app) struct NativeViewer {
    program: PathBuf,
}

impl NativeViewer {
    /// The viewer of this machine.
    pub(in crate::app) fn find() -> Result<Self, ViewerError> {
        let program = program().ok_or(ViewerError::NotInstalled)?;
        if cfg!(target_os = "linux") && !has_display() {
            return Err(ViewerError::NoDisplay);
        }
        let asked = Command::new(&program)
            .arg("--version")
            .stdin(Stdio::null())
            .output();
        let shown = program.display().to_string();
        let answer = asked.map_err(|error| ViewerError::Failed {
            program: shown.clone(),
            reason: error.to_string(),
        })?;
        match version(&String::from_utf8_lossy(&answer.stdout)) {
            None => Err(ViewerError::NotRerun { program: shown }),
            Some(found) if found != viewer_version() => Err(ViewerError::OtherVersion {
                program: shown,
                found: found.to_owned(),
            }),
            Some(_) => Ok(Self { program }),
        }
    }

    /// Its program.
    pub(in crate::app) fn program(&self) -> &Path {
        &self.program
    }

    /// Shows files until its window is closed.
    pub(in crate::app) fn show(&self, files: &[PathBuf]) -> Result<(), ViewerError> {
        let mut command = self.command();
        let status_of_viewer = command.args(files).status();
        match status_of_viewer {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(self.failed(&format!("it ended with {status}"))),
            Err(error) => Err(self.failed(&error)),
        }
    }

    /// Opens it on what is written to its standard input. It stays when this program ends, or is interrupted.
    pub(in crate::app) fn open_stream(&self) -> Result<Child, ViewerError> {
        let mut command = self.command();
        // Always a window of its own: one that is open already might be paused, or another's.
        command.args(["--port", "auto", "--expect-data-soon", "-"]);
        command.stdin(Stdio::piped()).stdout(Stdio::null());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.spawn().map_err(|error| self.failed(&error))
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        // Left to itself it listens on all of the machine's addresses.
        command.args(["--bind", "127.0.0.1"]);
        if env::var_os("RUST_LOG").is_none() {
            command.env("RUST_LOG", "error");
        }
        command
    }

    fn failed(&self, reason: &dyn std::fmt::Display) -> ViewerError {
        ViewerError::Failed {
            program: self.program.display().to_string(),
            reason: reason.to_string(),
        }
    }
}

fn program() -> Option<PathBuf> {
    let named = env::var_os(PROGRAM).filter(|name| !name.is_empty());
    named.map_or_else(|| on_path(&env::var_os("PATH")?), |name| Some(name.into()))
}

fn on_path(path: &OsStr) -> Option<PathBuf> {
    let name = format!("rerun{}", env::consts::EXE_SUFFIX);
    env::split_paths(path)
        .map(|folder| folder.join(&name))
        .find(|program| program.is_file())
}

fn has_display() -> bool {
    let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// The version in an answer such as `rerun-cli 0.36.3 (base ..) [rustc ..]`.
fn version(answer: &str) -> Option<&str> {
    let mut words = answer.split_whitespace();
    words.next().filter(|word| word.starts_with("rerun"))?;
    words.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_is_the_second_word_of_a_rerun() {
        let answer = "rerun-cli 0.36.3 (base map_view) [rustc 1.95.0]\nVideo features: av1\n";
        assert_eq!(version(answer), Some("0.36.3"));
        assert_eq!(version("rerun 1.0"), Some("1.0"));
        assert_eq!(version("usage: launch COMMAND"), None);
        assert_eq!(version(""), None);
    }
}
