//! `idc view` and `idc run --view`: what is refused, what is served, what a viewer gets.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use rerun::{ChunkStore, ChunkStoreConfig, Scalars};

use crate::common::{project, skipped};
use crate::program::Bench;

/// The program, with no viewer and no display about.
fn idc(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_idc"));
    command
        .current_dir(folder)
        .env("PATH", "")
        .env_remove("IDC_RERUN")
        .env("DISPLAY", ":0");
    command
}

/// Exit code, standard output, standard error.
fn ran(command: &mut Command) -> (i32, String, String) {
    let output = command.stdin(Stdio::null()).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let code = output.status.code().unwrap();
    (code, text(output.stdout), text(output.stderr))
}

/// A program that goes on until the test is over.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// A short run, its recording in `runs/first`.
fn recorded() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let (code, _, errors) =
        ran(idc(&bench.path("")).args(["run", "scenario.toml", "--out", "first", "--quiet"]));
    assert_eq!(code, 0, "{errors}");
    bench
}

/// A program named `rerun` that answers as one of a version does and then does what the script says, `$FOLDER` being the folder it stands in.
#[cfg(unix)]
fn fake_viewer(folder: &Path, version: &str, script: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt as _;
    let bin = folder.join("bin");
    std::fs::create_dir_all(&bin).unwrap();
    let program = bin.join("rerun");
    let text = format!(
        "#!/bin/sh\nPATH=/usr/bin:/bin\nFOLDER={}\nif [ \"$1\" = --version ]; then echo \"rerun-cli {version} (base) [rustc]\"; exit; fi\n{script}\n",
        folder.display()
    );
    std::fs::write(&program, text).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    bin
}

/// Head and body of an answer to a request.
fn fetch(address: &str, path: &str, host: Option<&str>) -> (String, Vec<u8>) {
    let place = address.trim_start_matches("http://").trim_end_matches('/');
    let mut stream = TcpStream::connect(place).unwrap();
    let host = host.unwrap_or(place);
    // HTTP/1.0: what has no length ends with the connection, in one piece.
    write!(stream, "GET {path} HTTP/1.0\r\nHost: {host}\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let split = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap();
    let head = String::from_utf8(answer[..split].to_vec()).unwrap();
    (head, answer[split + 4..].to_vec())
}

/// All values of the force plot's lines in an `.rrd`, and the times at which they stand [ns].
fn forces(bytes: &[u8]) -> BTreeMap<i64, f64> {
    let mut reader = std::io::Cursor::new(bytes);
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut reader).unwrap();
    let data = stores.values().find(|s| s.id().is_recording()).unwrap();
    assert!(stores.values().any(|s| !s.id().is_recording()), "no layout");
    let mut found = BTreeMap::new();
    for chunk in data.iter_physical_chunks() {
        if chunk.entity_path().to_string() != "/plots/force" || chunk.is_static() {
            continue;
        }
        let times = chunk.timelines()[&"sim_time".into()].times_raw();
        let rows = chunk.iter_slices::<f64>(Scalars::descriptor_scalars().component);
        found.extend(times.iter().copied().zip(rows.map(|row| row[0])));
    }
    found
}

#[cfg(unix)]
#[test]
fn a_folder_is_opened_by_what_it_holds() {
    let bench = recorded();
    let script =
        "for file in \"$@\"; do case $file in *.rrd) echo \"$file\";; esac; done > $FOLDER/shown";
    let bin = fake_viewer(&bench.path(""), "0.36.3", script);
    let shown = |folders: &[&str]| {
        let (code, _, errors) = ran(idc(&bench.path(""))
            .env("PATH", &bin)
            .arg("view")
            .args(folders));
        let shown = std::fs::read_to_string(bench.path("shown")).unwrap_or_default();
        drop(std::fs::remove_file(bench.path("shown")));
        (
            code,
            shown.lines().map(str::to_owned).collect::<Vec<_>>(),
            errors,
        )
    };
    assert_eq!(shown(&["first"]).1, ["first/recording.rrd"]);
    // Of a folder of folders all, by their numbers.
    for name in ["x=10", "x=9"] {
        let folder = bench.path("all").join(name);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::copy(
            bench.path("first/recording.rrd"),
            folder.join("recording.rrd"),
        )
        .unwrap();
    }
    std::fs::copy(
        bench.path("first/recording.rrd"),
        bench.path("all/x=9/diagnosis.rrd"),
    )
    .unwrap();
    assert_eq!(
        shown(&["all"]).1,
        [
            "all/x=9/recording.rrd",
            "all/x=9/diagnosis.rrd",
            "all/x=10/recording.rrd"
        ]
    );
    std::fs::create_dir(bench.path("empty")).unwrap();
    let (code, none, errors) = shown(&["empty"]);
    assert_eq!((code, none.len()), (2, 0));
    assert!(
        errors.contains("empty: there is nothing in it to look at"),
        "{errors}"
    );
    for number in 0..12 {
        let folder = bench.path("all").join(format!("y={number}"));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::copy(
            bench.path("first/recording.rrd"),
            folder.join("recording.rrd"),
        )
        .unwrap();
    }
    let (code, _, errors) = shown(&["all"]);
    assert_eq!(code, 2);
    assert!(
        errors.contains("all holds 15 recordings, all/x=9/recording.rrd, "),
        "{errors}"
    );
}

#[test]
fn what_is_no_whole_recording_of_our_version_is_refused() {
    let bench = recorded();
    let whole = std::fs::read(bench.path("first/recording.rrd")).unwrap();
    let mut newer = whole.clone();
    newer[4..8].copy_from_slice(&[0, 41, 0, 0]);
    for (name, bytes, expected) in [
        ("cut.rrd", &whole[..whole.len() / 2], "cut.rrd is cut off"),
        (
            "newer.rrd",
            &newer[..],
            "newer.rrd was written by Rerun 0.41.0, expected 0.36.3",
        ),
        (
            "other.rrd",
            &b"PAR1"[..],
            "other.rrd is no recording of Rerun's",
        ),
    ] {
        std::fs::write(bench.path(name), bytes).unwrap();
        let (code, out, errors) = ran(idc(&bench.path("")).args(["view", name]));
        assert_eq!((code, &out[..]), (2, ""), "{errors}");
        assert!(
            errors.starts_with(&format!("error: {expected}")),
            "{errors}"
        );
        assert_eq!(errors.lines().count(), 1, "{errors}");
    }
    let (code, _, errors) = ran(idc(&bench.path("")).args(["view", "missing.rrd"]));
    assert_eq!(code, 2);
    assert!(
        errors.starts_with("error: cannot read missing.rrd"),
        "{errors}"
    );
}

#[test]
fn a_port_in_use_and_no_native_viewer_are_said() {
    let bench = recorded();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let recording = "first/recording.rrd";
    let (code, _, errors) = ran(idc(&bench.path("")).args(["view", "--port", &port, recording]));
    assert_eq!(code, 2);
    assert!(
        errors.contains(&format!("port {port} of 127.0.0.1 is in use")),
        "{errors}"
    );
    let (code, _, errors) = ran(idc(&bench.path("")).args(["view", "--native", recording]));
    assert_eq!(code, 2);
    assert!(errors.contains("pip install rerun-sdk==0.36.3"), "{errors}");
    let view = format!("--view=web:{port}");
    let (code, _, errors) =
        ran(idc(&bench.path("")).args(["run", "scenario.toml", "--out", "never", &view]));
    assert_eq!(code, 2, "{errors}");
    drop(taken);
    for (view, expected) in [
        (
            &format!("--view=127.0.0.1:{port}")[..],
            "no viewer listens at 127.0.0.1",
        ),
        ("--view=web:many", "many is no port"),
        ("--view=native", "pip install rerun-sdk==0.36.3"),
    ] {
        let (code, _, errors) =
            ran(idc(&bench.path("")).args(["run", "scenario.toml", "--out", "never", view]));
        assert_eq!(code, 2, "{errors}");
        assert!(errors.contains(expected), "{errors}");
    }
    assert!(!bench.path("never").exists());
}

#[test]
fn recordings_are_served_with_their_viewer_on_loopback_alone() {
    let bench = recorded();
    let arguments = ["view", "--json", "--port", "0", "first/recording.rrd"];
    let child = idc(&bench.path(""))
        .args(arguments)
        .stdout(Stdio::piped())
        .spawn();
    let mut running = Running(child.unwrap());
    let mut reported = String::new();
    let mut lines = BufReader::new(running.0.stdout.take().unwrap());
    while !reported.contains("\n}") {
        assert_ne!(lines.read_line(&mut reported).unwrap(), 0, "{reported}");
    }
    let reported: serde_json::Value = serde_json::from_str(&reported).unwrap();
    let address = reported["address"].as_str().unwrap();
    assert!(address.starts_with("http://127.0.0.1:"), "{address}");
    let (head, _) = fetch(address, "/", None);
    let start = head
        .lines()
        .find_map(|line| line.strip_prefix("location: "))
        .unwrap();
    assert!(
        head.starts_with("HTTP/1.0 302") || head.starts_with("HTTP/1.1 302"),
        "{head}"
    );
    assert!(start.ends_with("%2F1%2Frecording.rrd"), "{start}");
    let (_, page) = fetch(address, start, None);
    assert!(String::from_utf8(page).unwrap().contains("re_viewer.js"));
    let (_, served) = fetch(address, "/1/recording.rrd", None);
    assert!(served == std::fs::read(bench.path("first/recording.rrd")).unwrap());
    let (_, engine) = fetch(address, "/re_viewer_bg.wasm", None);
    assert_eq!(&engine[..4], b"\0asm");
    for (path, host, code) in [
        ("/2/recording.rrd", None, "404"),
        ("/../etc/passwd", None, "404"),
        ("/1/recording.rrd", Some("elsewhere.example"), "403"),
    ] {
        let (head, body) = fetch(address, path, host);
        assert!(
            head.split(' ').nth(1) == Some(code) && body.is_empty(),
            "{head}"
        );
    }
}

#[cfg(unix)]
#[test]
fn the_native_viewer_is_taken_where_it_fits() {
    let bench = recorded();
    let folder = bench.path("");
    let log = "echo \"$@\" > $FOLDER/arguments";
    let bin = fake_viewer(&folder, "0.36.3", log);
    let (code, _, errors) = ran(idc(&folder)
        .env("PATH", &bin)
        .args(["view", "first/recording.rrd"]));
    assert_eq!(code, 0, "{errors}");
    let arguments = std::fs::read_to_string(bench.path("arguments")).unwrap();
    assert_eq!(arguments.trim(), "--bind 127.0.0.1 first/recording.rrd");

    fake_viewer(&folder, "0.40.0", log);
    let view = ["view", "--native", "first/recording.rrd"];
    let (code, _, errors) = ran(idc(&folder).env("PATH", &bin).args(view));
    assert_eq!(code, 2);
    assert!(
        errors.contains("is Rerun 0.40.0, expected 0.36.3"),
        "{errors}"
    );

    fake_viewer(&folder, "0.36.3", "exit 7");
    let (code, _, errors) = ran(idc(&folder).env("PATH", &bin).args(view));
    assert_eq!(code, 2);
    assert!(errors.contains("exit status: 7"), "{errors}");
    let mut blind = idc(&folder);
    blind
        .env("PATH", &bin)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY");
    if cfg!(target_os = "linux") {
        let (code, _, errors) = ran(blind.args(view));
        assert_eq!(code, 2);
        assert!(errors.contains("no display"), "{errors}");
    }
}

#[cfg(unix)]
#[test]
fn a_run_that_is_watched_is_the_same_run_and_the_viewer_gets_all_of_it() {
    let bench = recorded();
    let folder = bench.path("");
    let bin = fake_viewer(&folder, "0.36.3", "exec cat > $FOLDER/streamed.rrd");
    let run = [
        "run",
        "scenario.toml",
        "--out",
        "watched",
        "--quiet",
        "--view",
    ];
    let (code, _, errors) = ran(idc(&folder).env("PATH", &bin).args(run));
    assert_eq!(code, 0, "{errors}");
    let kept = std::fs::read(bench.path("watched/recording.rrd")).unwrap();
    assert!(kept == std::fs::read(bench.path("first/recording.rrd")).unwrap());
    // The stand-in writes what is left in its pipe after this program has ended.
    let wanted = forces(&kept);
    let mut streamed = BTreeMap::new();
    for _ in 0..50 {
        streamed = forces(&std::fs::read(bench.path("streamed.rrd")).unwrap());
        if streamed.len() == wanted.len() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    assert!(wanted.len() > 10_000);
    assert!(streamed == wanted);
}

#[cfg(unix)]
#[test]
fn a_viewer_that_goes_away_is_said_once_and_ends_nothing() {
    let bench = recorded();
    let folder = bench.path("");
    let bin = fake_viewer(&folder, "0.36.3", "exit 0");
    let run = ["run", "scenario.toml", "--out", "left", "--view=native"];
    let (code, _, errors) = ran(idc(&folder).env("PATH", &bin).args(run));
    assert_eq!(code, 0, "{errors}");
    let said = errors
        .lines()
        .filter(|line| line.contains("watched any longer"));
    assert_eq!(said.count(), 1, "{errors}");
    let kept = std::fs::read(bench.path("left/recording.rrd")).unwrap();
    assert!(kept == std::fs::read(bench.path("first/recording.rrd")).unwrap());
}

#[test]
fn a_run_can_be_watched_as_a_page_while_and_after_it_goes_on() {
    let bench = recorded();
    for (scenario, out) in [
        (bench.path("scenario.toml"), "cell"),
        (project("scenarios/paper_step.toml"), "bench"),
    ] {
        let mut command = idc(&bench.path(""));
        command
            .arg("run")
            .arg(scenario)
            .args(["--out", out, "--json", "--view=web:0"]);
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let mut running = Running(child.unwrap());
        let mut lines = BufReader::new(running.0.stderr.take().unwrap()).lines();
        let line = lines.find(|line| line.as_ref().unwrap().starts_with("watch the run at "));
        let line = line.unwrap().unwrap();
        let address = line.split(' ').next_back().unwrap();
        // The answer ends when the run does.
        let (_, streamed) = fetch(address, "/1/recording.rrd", None);
        let kept = std::fs::read(bench.path(out).join("recording.rrd")).unwrap();
        let (streamed, kept) = (forces(&streamed), forces(&kept));
        assert!(
            kept.len() > 5000 && streamed == kept,
            "{} of {}",
            streamed.len(),
            kept.len()
        );
        let (_, again) = fetch(address, "/1/recording.rrd", None);
        assert_eq!(forces(&again), kept);
    }
}

/// A real receiver, where `.ci/install_references` has put one.
#[test]
fn a_run_is_sent_to_a_viewer_that_listens() {
    let receiver = project("build/references/venv/bin/rerun");
    if !receiver.is_file() {
        skipped(&format!("{} is not installed", receiver.display()));
        return;
    }
    let bench = recorded();
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = free.local_addr().unwrap().port().to_string();
    drop(free);
    let received = bench.path("received.rrd");
    let child = Command::new(receiver)
        .args(["--bind", "127.0.0.1", "--port", &port, "--save"])
        .arg(&received)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let mut running = Running(child.unwrap());
    let place = format!("127.0.0.1:{port}");
    let patience = std::time::Duration::from_millis(200);
    for _ in 0..100 {
        if TcpStream::connect(&place).is_ok() {
            break;
        }
        std::thread::sleep(patience);
    }
    let view = format!("--view={place}");
    let run = ["run", "scenario.toml", "--out", "sent", "--quiet", &view];
    let (code, _, errors) = ran(idc(&bench.path("")).args(run));
    assert_eq!((code, &errors[..]), (0, ""));
    let wanted = forces(&std::fs::read(bench.path("sent/recording.rrd")).unwrap());
    let mut length = 0;
    for _ in 0..100 {
        // It writes as it receives: done when the file grows no more.
        std::thread::sleep(patience);
        let now = std::fs::metadata(&received).map_or(0, |data| data.len());
        if now == length && now > 100_000 {
            break;
        }
        length = now;
    }
    drop(running.0.kill());
    assert_eq!(forces(&std::fs::read(&received).unwrap()), wanted);
}
