//! Who does the tasks.

use std::str::FromStr;

use super::TaskError;

/// An engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Engine {
    /// Threads of this program.
    Local,
    /// Workers that Dask starts on this machine.
    DaskLocal(usize),
    /// A scheduler of Dask at an address.
    Dask(String),
}

impl FromStr for Engine {
    type Err = TaskError;

    fn from_str(text: &str) -> Result<Self, TaskError> {
        let no = || TaskError::NoEngine {
            text: text.to_owned(),
        };
        match text.split_once('=') {
            None if text == "local" => Ok(Self::Local),
            Some(("dask", rest)) => match rest.strip_prefix("local:") {
                Some(count) => match count.parse() {
                    Ok(count @ 1..=4096) => Ok(Self::DaskLocal(count)),
                    _ => Err(no()),
                },
                None if rest.contains(':') => Ok(Self::Dask(rest.to_owned())),
                None => Err(no()),
            },
            _ => Err(no()),
        }
    }
}

/// What an engine tells while it works.
#[derive(Debug, Clone, PartialEq)]
pub enum TaskMessage {
    /// So many tasks stand now.
    Done(usize),
    /// Something that people should know, as the address of a dashboard or a worker that was lost.
    Words(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engines_are_read_and_others_are_refused() {
        let read = |text: &str| text.parse::<Engine>();
        assert_eq!(read("local").unwrap(), Engine::Local);
        assert_eq!(read("dask=local:3").unwrap(), Engine::DaskLocal(3));
        let address = "tcp://10.0.0.1:8786";
        let dask = read(&format!("dask={address}")).unwrap();
        assert_eq!(dask, Engine::Dask(address.to_owned()));
        for text in ["", "ray", "dask", "dask=local:0", "dask=here", "local:2"] {
            let refused = read(text).unwrap_err().to_string();
            assert!(
                refused.contains("expected local, dask=local:N"),
                "{refused}"
            );
        }
    }
}
