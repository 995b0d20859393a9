//! The program `xacro`, which evaluates macros of URDF files.

use std::io::{ErrorKind, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Longest time that it may take.
const PATIENCE: Duration = Duration::from_mins(1);
/// Interval between two looks at whether it has ended.
const LOOK: Duration = Duration::from_millis(10);
/// Most text that is taken from it [bytes].
const MOST: u64 = 64 << 20;

/// What it makes of the file; the error says why nothing, in words.
pub(super) fn expanded(file: &Path) -> Result<String, String> {
    // An own path: a file's name may begin with a dash.
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
    let child = Command::new("xacro")
        .arg(&whole)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    match child {
        Ok(child) => text_of(child),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            Err("it is not installed (pip install xacro, or the package xacro of ROS)".into())
        }
        Err(error) => Err(format!("it cannot be started: {error}")),
    }
}

fn text_of(mut child: Child) -> Result<String, String> {
    // Both are read at once, so that neither pipe fills up.
    let text = read(child.stdout.take());
    let complaint = read(child.stderr.take());
    let start = Instant::now();
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if start.elapsed() < PATIENCE => thread::sleep(LOOK),
            Ok(None) => {
                // It has had its time; that it may have ended since is as well.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("it took more than {} s", PATIENCE.as_secs()));
            }
            Err(error) => return Err(error.to_string()),
        }
    };
    let joined = |handle: thread::JoinHandle<Vec<u8>>| handle.join().unwrap_or_default();
    let (text, complaint) = (joined(text), joined(complaint));
    if !status.success() {
        let complaint = String::from_utf8_lossy(&complaint);
        let last = complaint.lines().rev().find(|line| !line.trim().is_empty());
        return Err(match last {
            Some(line) => format!("it says: {}", line.trim()),
            None => "it fails without a word".to_owned(),
        });
    }
    String::from_utf8(text).map_err(|_| "it writes what is not UTF-8".to_owned())
}

fn read(pipe: Option<impl Read + Send + 'static>) -> thread::JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(pipe) = pipe {
            // What was read until it broke off is judged by its reader.
            let _ = pipe.take(MOST).read_to_end(&mut bytes);
        }
        bytes
    })
}
