//! Dask: a thin driver in Python gives the tasks to its workers, and tells how far they are.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use serde::Deserialize;

use super::TaskError;
use super::engine::{Engine, TaskMessage};

/// The driver.
const DRIVER: &str = include_str!("driver.py");

/// How Dask is to do a plan.
#[derive(Debug, Clone)]
pub struct Dask {
    /// Workers of this machine, or a scheduler.
    pub engine: Engine,
    /// Python with Dask.
    pub python: PathBuf,
    /// This program as workers find it.
    pub program: PathBuf,
    /// Its version, as `--version` prints it.
    pub version: String,
    /// Whether files and results go through Dask, where no folder is shared.
    pub carry: bool,
}

/// A line of the driver.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Line {
    Done(usize),
    Dashboard(String),
    Refused(String),
    Python(String),
    #[serde(untagged)]
    Failed {
        #[serde(rename = "failed")]
        _id: String,
        why: String,
    },
}

/// A driver, which ends with this.
struct Driver(Child);

impl Drop for Driver {
    fn drop(&mut self) {
        // It ends by itself as its input does; one that hangs is ended.
        drop(self.0.stdin.take());
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Lets Dask do the tasks of a plan, of so many, that do not stand.
///
/// # Errors
/// Python, Dask or a worker is refused; the driver ended early; or [`TaskError::Failed`] once all others are done.
pub fn dask(
    dask: &Dask,
    plan: &Path,
    of: usize,
    report: &dyn Fn(TaskMessage),
) -> Result<(), TaskError> {
    if let Engine::Dask(address) = &dask.engine
        && is_open(address)
    {
        report(TaskMessage::Words(format!(
            "note: {address} asks nobody for a certificate: whoever reaches it runs programs as its user (docs/CLUSTER.md: tls://)"
        )));
    }
    let no_python = |reason: &dyn std::fmt::Display| TaskError::NoPython {
        python: dask.python.display().to_string(),
        reason: reason.to_string(),
    };
    let child = Command::new(&dask.python)
        .args(["-c", DRIVER])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut driver = Driver(child.map_err(|e| no_python(&e))?);
    let (stdout, stderr) = (driver.0.stdout.take(), driver.0.stderr.take());
    let last_words = std::thread::spawn(move || last_words(stderr));
    if let Some(stdin) = &mut driver.0.stdin {
        // One that has ended already says why below.
        drop(writeln!(stdin, "{}", order(dask, plan)));
    }
    let mut failed: Vec<String> = Vec::new();
    let lines = stdout
        .into_iter()
        .flat_map(|out| BufReader::new(out).lines());
    for line in lines.map_while(Result::ok) {
        match serde_json::from_str(&line) {
            Ok(Line::Done(done)) => report(TaskMessage::Done(done)),
            Ok(Line::Dashboard(address)) => {
                report(TaskMessage::Words(format!("Dask's dashboard: {address}")));
            }
            Ok(Line::Refused(reason)) => return Err(TaskError::Refused { reason }),
            Ok(Line::Python(reason)) => return Err(no_python(&reason)),
            Ok(Line::Failed { why, .. }) => failed.push(why),
            // Not of the driver: what a library prints.
            Err(_) => (),
        }
    }
    let status = driver.0.wait();
    let words = last_words.join().unwrap_or_default();
    match (status, failed.first()) {
        (Ok(status), None) if status.success() => Ok(()),
        (Ok(status), Some(first)) if status.success() => Err(TaskError::Failed {
            failed: failed.len(),
            of,
            first: first.clone(),
        }),
        (status, _) => Err(TaskError::DriverExited {
            how: status.map_or_else(|e| e.to_string(), |status| status.to_string()),
            message: words,
        }),
    }
}

/// Whether a scheduler at this address is open to others than this machine's users.
fn is_open(address: &str) -> bool {
    let place = address.strip_prefix("tcp://").unwrap_or(address);
    let host = place.rsplit_once(':').map_or(place, |(host, _)| host);
    let host = host.trim_start_matches('[').trim_end_matches(']');
    let is_loopback = |ip: std::net::IpAddr| ip.is_loopback();
    !address.starts_with("tls://") && host != "localhost" && !host.parse().is_ok_and(is_loopback)
}

/// The last line that tells an error, as Python ends with one.
fn last_words(from: Option<impl Read>) -> String {
    let mut last = "it said nothing of why".to_owned();
    let lines = from
        .into_iter()
        .flat_map(|from| BufReader::new(from).lines());
    for line in lines.map_while(Result::ok) {
        let is_error = |word: &str| word.trim_end_matches(':').ends_with("Error");
        if line.split(' ').next().is_some_and(is_error) {
            line.trim().clone_into(&mut last);
        }
    }
    last
}

/// What the driver is given.
fn order(dask: &Dask, plan: &Path) -> serde_json::Value {
    let (workers, address) = match &dask.engine {
        Engine::DaskLocal(count) => (*count, ""),
        Engine::Dask(address) => (0, address.as_str()),
        Engine::Local => (0, ""),
    };
    serde_json::json!({
        "workers": workers,
        "address": address,
        "program": dask.program,
        "version": dask.version,
        "plan": plan,
        "carry": dask.carry,
        "dashboard": "127.0.0.1:0",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scheduler_without_certificates_is_open_unless_it_is_this_machine_s() {
        for open in ["tcp://10.0.0.1:8786", "10.0.0.1:8786", "tcp://node:8786"] {
            assert!(is_open(open), "{open}");
        }
        for closed in ["tls://10.0.0.1:8786", "tcp://127.0.0.1:1", "tcp://[::1]:1"] {
            assert!(!is_open(closed), "{closed}");
        }
    }

    #[test]
    fn lines_of_the_driver_are_understood() {
        let read = |text: &str| serde_json::from_str::<Line>(text);
        assert!(matches!(read("{\"done\": 3}"), Ok(Line::Done(3))));
        let failed = read("{\"failed\": \"ab\", \"why\": \"x\"}");
        assert!(matches!(failed, Ok(Line::Failed { why, .. }) if why == "x"));
        assert!(read("distributed.nanny - INFO").is_err());
    }

    #[test]
    fn a_python_that_is_not_there_is_named() {
        let missing = Dask {
            engine: Engine::DaskLocal(1),
            python: "/no/such/python".into(),
            program: "idc".into(),
            version: String::new(),
            carry: false,
        };
        let error = dask(&missing, Path::new("plan.jsonl"), 1, &|_| ()).unwrap_err();
        assert!(error.to_string().contains("/no/such/python"), "{error}");
    }
}
