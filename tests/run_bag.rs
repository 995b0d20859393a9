//! `idc run --mcap`: a run as messages of ROS 2, read back by `idc import` without a map, by the crate's own summary and by the `mcap` of Python, bit by bit.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use idc_cell::recording::bag::write_bag;
use idc_cell::recording::parquet::read_parquet;
use idc_cell::recording::{PhaseSpan, RecordedChannel, Recording, RecordingError, Unit};

use crate::common::{project, skipped};
use crate::program::Bench;

/// A run with its recording.mcap.
fn recorded(scenario: &str) -> Bench {
    let bench = Bench::new(scenario);
    let words = [
        "run",
        "scenario.toml",
        "--out",
        "out",
        "--mcap",
        "--no-recording",
        "--quiet",
    ];
    let outcome = bench.idc(&words, &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    bench
}

/// What `idc import` makes of a file, without a map.
fn imported(bench: &Bench, file: &str) -> Recording {
    let words = ["import", file, "--out", "back.parquet", "--force"];
    let outcome = bench.idc(&words, &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    // A constant that is exact, or a force that rests at a value, is what the program wrote.
    for word in ["doubtful", "cut off"] {
        assert!(!outcome.out.contains(word), "{}", outcome.out);
    }
    read_parquet(&bench.path("back.parquet")).unwrap().recording
}

/// A value by its bits; all that are none are one.
fn bits(value: f64) -> u64 {
    match value.is_nan() {
        true => f64::NAN.to_bits(),
        false => value.to_bits(),
    }
}

fn assert_same(found: &Recording, expected: &Recording) {
    assert_eq!(found.sample_count(), expected.sample_count());
    for (one, other) in found.time().iter().zip(expected.time()) {
        assert!((one - other).abs() < 1e-9, "{one} s, written at {other} s");
    }
    let names = |recording: &Recording| -> Vec<(String, Unit)> {
        let channels = recording.channels().iter();
        channels
            .map(|own| (own.quantity.clone(), own.unit))
            .collect()
    };
    assert_eq!(names(found), names(expected));
    for (one, other) in found.channels().iter().zip(expected.channels()) {
        let of = |channel: &RecordedChannel| -> Vec<u64> {
            channel.values.iter().copied().map(bits).collect()
        };
        assert!(of(one) == of(other), "{}", one.quantity);
    }
    let spans = |recording: &Recording| -> Vec<_> {
        let phases = recording.phases().iter();
        let span = |phase: &PhaseSpan| (phase.name.clone(), recording.samples_in(phase));
        phases.map(span).collect()
    };
    assert_eq!(spans(found), spans(expected));
}

#[test]
fn a_run_comes_back_without_a_map_and_is_the_table_of_its_samples() {
    for (scenario, least) in [
        ("plate_edge", 57),
        ("deburred_edge", 62),
        ("paper_step", 21),
    ] {
        let bench = recorded(scenario);
        let samples = read_parquet(&bench.path("out/samples.parquet"))
            .unwrap()
            .recording;
        assert!(
            samples.channels().len() >= least,
            "{}",
            samples.channels().len()
        );
        assert_same(&imported(&bench, "out/recording.mcap"), &samples);
    }
}

/// Once the true stroke and its sensor's reading were columns of one name.
#[test]
fn a_table_of_it_has_a_column_for_each_channel() {
    let bench = recorded("paper_step");
    let words = ["import", "out/recording.mcap", "--out", "back.csv"];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let text = std::fs::read_to_string(bench.path("back.csv")).unwrap();
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    let names: std::collections::BTreeSet<&&str> = header.iter().collect();
    assert_eq!(names.len(), header.len(), "{header:?}");
    let samples = read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording;
    let at = |name: &str| header.iter().position(|own| *own == name).unwrap();
    let rows: Vec<Vec<&str>> = rows.collect();
    for (name, quantity) in [
        ("stroke_m", "measured_stroke"),
        ("true_stroke_m", "stroke"),
        ("force_n", "measured_force"),
    ] {
        let expected = samples.values(quantity).unwrap();
        for (row, expected) in rows.iter().zip(expected) {
            let found: f64 = row[at(name)].parse().unwrap_or(f64::NAN);
            assert_eq!(bits(found), bits(*expected), "{name}");
        }
    }
}

/// Numbers that a decimal or a product would not keep, a channel without any, gauge and absolute pressures, a wrench of which one component is absent, phases between samples.
fn planted() -> Recording {
    // Past 2^31 s nothing of ROS 2 goes; steps of 1 ns.
    let time = vec![0.25, 0.250_000_001, 1.0 / 3.0, 1_234.567_890_123];
    let odd = [-0.0, f64::MIN_POSITIVE / 8.0, f64::NAN, 0.1 + 0.2];
    let channel = |quantity: &str, unit: Unit| {
        let scale = quantity.len() as f64;
        let values = odd.iter().map(|value| value * scale).collect();
        RecordedChannel::new(quantity, unit, values)
    };
    let mut channels = vec![
        channel("chamber_1_pressure", Unit::Pascal),
        channel("set_pressure_gauge", Unit::Pascal),
        channel("joint_2_position", Unit::Radian),
        channel("joint_1_position", Unit::Radian),
        channel("joint_1_torque", Unit::NewtonMetre),
        channel("joint_1_velocity", Unit::RadianPerSecond),
        channel("joint_2_velocity", Unit::RadianPerSecond),
        channel("wrench_force_x", Unit::Newton),
        channel("wrench_torque_z", Unit::NewtonMetre),
        channel("contact_force_y", Unit::Newton),
        RecordedChannel::new("estimated_force", Unit::Newton, vec![f64::NAN; 4]),
        RecordedChannel::new(
            "contact_force",
            Unit::Newton,
            vec![f64::MAX, -f64::MAX, 5e-324, 1.0],
        ),
    ];
    let others = Unit::ALL
        .into_iter()
        .map(|unit| channel(&format!("of_{}", unit.suffix()), unit));
    channels.extend(others);
    let phase = |name: &str, start: f64, end: f64| PhaseSpan {
        name: name.to_owned(),
        start,
        end,
    };
    let phases = vec![
        phase("approach", 0.25, 0.3),
        phase("follow", 1.0 / 3.0, 1_234.567_890_123),
    ];
    Recording::new(time, channels, phases).unwrap()
}

fn write(path: &Path, recording: &Recording) -> Result<(), RecordingError> {
    let about = BTreeMap::from([("title".to_owned(), "Planted".to_owned())]);
    write_bag(path, recording, &["shoulder".to_owned()], &about)
}

#[test]
fn every_unit_and_every_number_comes_back_to_the_bit() {
    let bench = Bench::new("paper_step");
    write(&bench.path("planted.mcap"), &planted()).unwrap();
    assert_same(&imported(&bench, "planted.mcap"), &planted());
}

#[test]
fn the_file_is_of_the_profile_of_ros_2_and_says_what_is_in_it() {
    let bench = recorded("plate_edge");
    let bytes = std::fs::read(bench.path("out/recording.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let samples = read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording;
    let stats = summary.stats.unwrap();
    let signals = summary.channels.len() - 1;
    let phases = samples.phases().len();
    assert_eq!(
        stats.message_count as usize,
        signals * samples.sample_count() + phases
    );
    let last = samples.time().last().unwrap();
    assert_eq!(stats.message_end_time, (1e9 * last).round() as u64);
    assert!(
        summary
            .chunk_indexes
            .iter()
            .all(|chunk| chunk.compression == "zstd")
    );
    assert!(bytes.windows(5).take(64).any(|part| part == b"ros2\x09"));
    let kinds: BTreeMap<&str, &str> = summary
        .channels
        .values()
        .map(|own| {
            (
                own.topic.as_str(),
                own.schema.as_ref().unwrap().name.as_str(),
            )
        })
        .collect();
    for (topic, kind) in [
        ("/joint_states", "sensor_msgs/msg/JointState"),
        ("/contact_wrench", "geometry_msgs/msg/WrenchStamped"),
        (
            "/pressures/chamber_1_pressure",
            "sensor_msgs/msg/FluidPressure",
        ),
        ("/signals/stroke", "std_msgs/msg/Float64"),
        ("/phases", "idc.Phase"),
    ] {
        assert_eq!(kinds.get(topic), Some(&kind), "{topic}");
    }
    let units: BTreeMap<&str, &str> = summary
        .channels
        .values()
        .filter_map(|own| Some((own.topic.as_str(), own.metadata.get("unit")?.as_str())))
        .collect();
    assert_eq!(units["/signals/stroke_velocity"], "m/s");
    assert_eq!(units["/joint_states"], "rad, rad/s, N m");
    assert!(sums_agree(&bytes));
    // Same input, same bytes, by any number of threads.
    let again = [
        "run",
        "scenario.toml",
        "--out",
        "again",
        "--mcap",
        "--no-recording",
        "--quiet",
    ];
    assert_eq!(bench.idc(&again, &[("RAYON_NUM_THREADS", "1")]).code, 0);
    assert!(std::fs::read(bench.path("again/recording.mcap")).unwrap() == bytes);
    // Without the option the old file would pass for one of the new run.
    let without = [
        "run",
        "scenario.toml",
        "--out",
        "out",
        "--force",
        "--no-recording",
        "--quiet",
    ];
    assert_eq!(bench.idc(&without, &[]).code, 0);
    assert!(!bench.path("out/recording.mcap").exists());
}

/// Whether the sums over chunks, data and summary are those of what stands there.
fn sums_agree(bytes: &[u8]) -> bool {
    use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true);
    let (mut reader, mut rest) = (LinearReader::new_with_options(options), bytes);
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let count = wanted.min(rest.len());
                reader.insert(count).copy_from_slice(&rest[..count]);
                rest = &rest[count..];
                reader.notify_read(count);
            }
            Ok(LinearReadEvent::Record { .. }) => {}
            Err(_) => return false,
        }
    }
    true
}

#[test]
fn what_cannot_be_written_or_read_is_refused_by_a_line() {
    let bench = Bench::new("paper_step");
    let refused = |time: Vec<f64>| {
        let recording = Recording::new(time, Vec::new(), Vec::new()).unwrap();
        let error = write(&bench.path("refused.mcap"), &recording).unwrap_err();
        assert!(!bench.path("refused.mcap").exists());
        error.to_string()
    };
    assert!(refused(vec![-0.5, 1.0]).contains("the time -0.5 s is negative"));
    assert!(refused(vec![1.0, 1.0 + 2e-10]).contains("less than 1 ns apart"));
    write(&bench.path("own.mcap"), &planted()).unwrap();
    let outcome = bench.idc(&["import", "own.mcap", "own.mcap"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome
            .only_line("error:")
            .contains("expected no logs after it, 1 were given")
    );
    let whole = std::fs::read(bench.path("own.mcap")).unwrap();
    bench.write("cut.mcap", &whole[..whole.len() / 2]);
    let outcome = bench.idc(&["import", "cut.mcap"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome
            .only_line("error:")
            .contains("`mcap recover` repairs it")
    );
    crate::import::files::mcap(&bench.path("other.mcap"), None);
    let outcome = bench.idc(&["import", "other.mcap"], &[]);
    assert_eq!(outcome.code, 2);
    let line = outcome.only_line("error:");
    assert!(
        line.contains("`idc new import MAP --from other.mcap`"),
        "{line}"
    );
}

/// Topics of a file as Python's `mcap` reads them, where `.ci/install_references` has put it: type, unit, times [ns], and each field's values by their bits.
fn read_by_python(file: &Path) -> Option<serde_json::Value> {
    let python = project("build/references/venv/bin/python");
    let there = Command::new(&python)
        .args(["-c", "import mcap_ros2"])
        .output();
    if !there.is_ok_and(|output| output.status.success()) {
        skipped("mcap and mcap-ros2-support are not installed; run .ci/install_references");
        return None;
    }
    let script = project("tests/reference/mcap_topics.py");
    let output = Command::new(python).arg(script).arg(file).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// Where a field of Python's list has the values of a channel.
fn place_of(quantity: &str) -> (String, String) {
    let joint = |rest: &str| -> Option<(usize, String)> {
        let (number, name) = rest.split_once('_')?;
        let list = match name {
            "position" | "velocity" => name,
            "torque" => "effort",
            _ => return None,
        };
        Some((number.parse().ok()?, list.to_owned()))
    };
    if let Some((number, list)) = quantity.strip_prefix("joint_").and_then(joint) {
        return (
            "/joint_states".to_owned(),
            format!("{list}[{}]", number - 1),
        );
    }
    match quantity.strip_prefix("contact_force_") {
        Some(axis) if axis.len() == 1 => {
            return ("/contact_wrench".to_owned(), format!("wrench.force.{axis}"));
        }
        _ => {}
    }
    match quantity.ends_with("_pressure") {
        true => (
            format!("/pressures/{quantity}"),
            "fluid_pressure".to_owned(),
        ),
        false => (format!("/signals/{quantity}"), "data".to_owned()),
    }
}

#[test]
fn another_reader_finds_every_channel_with_its_unit_to_the_bit() {
    for scenario in ["plate_edge", "paper_step"] {
        let bench = recorded(scenario);
        let Some(topics) = read_by_python(&bench.path("out/recording.mcap")) else {
            return;
        };
        let samples = read_parquet(&bench.path("out/samples.parquet"))
            .unwrap()
            .recording;
        let times: Vec<u64> = (samples.time().iter())
            .map(|t| (1e9 * t).round() as u64)
            .collect();
        for channel in samples.channels() {
            let (topic, field) = place_of(&channel.quantity);
            let found = &topics[&topic];
            let unit = found["unit"].as_str().unwrap();
            assert!(
                unit.split(", ").any(|own| own == channel.unit.symbol()),
                "{topic}: {unit}"
            );
            assert_eq!(found["times"], serde_json::json!(times), "{topic}");
            let values: Vec<u64> = channel.values.iter().copied().map(bits).collect();
            assert!(
                found["fields"][&field] == serde_json::json!(values),
                "{topic}.{field}"
            );
        }
        // A bench has none.
        let phases = topics["/phases"]["messages"].as_array().cloned();
        let phases = phases.unwrap_or_default();
        assert_eq!(phases.len(), samples.phases().len());
        for (phase, found) in samples.phases().iter().zip(&phases) {
            assert_eq!(found["name"], phase.name.as_str());
            // The reader of JSON here is off by a last digit.
            let start = found["start_s"].as_f64().unwrap();
            assert!((start - phase.start).abs() < 1e-9);
        }
        if scenario == "plate_edge" {
            // As the robot's description calls them.
            assert_eq!(topics["/joint_states"]["names"][0], "shoulder_pan");
        }
    }
}
