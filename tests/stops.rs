//! Runs that the physics stops: exit code 3, one line that says why, and the recording up to there, whole and readable.

use idc_cell::recording::parquet::read_parquet;
use idc_cell::recording::schema;
use rerun::{ChunkStore, ChunkStoreConfig, StoreKind};

use crate::program::{Bench, FILES, Outcome};

fn misplaced(shift_mm: f64) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let table = format!("[workpiece.misplacement]\nshift_mm = {shift_mm}\n[process]");
    bench.replace("scenario.toml", "[process]", &table);
    bench
}

/// A part that stands out [m] by more than the check knows, with a working stroke [mm].
fn protruding(shift_m: f64, working_stroke_mm: f64) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let stroke = format!("[process]\nworking_stroke_mm = {working_stroke_mm}");
    bench.replace("scenario.toml", "[process]", &stroke);
    let effect = format!(
        "[[effect]]\nname = \"part_misplaced\"\nshift_m = {shift_m}\ntilt_m_per_m = 0\n\n[expect]"
    );
    bench.replace("scenario.toml", "[expect]", &effect);
    bench
}

/// Air that leaves a chamber in microseconds.
fn leaky(dead_volume_cm3: f64, orifice_mm2: f64) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let keys = format!(
        "dead_volume_cm3 = {dead_volume_cm3}\nsupply_orifice_mm2 = {orifice_mm2}\nexhaust_orifice_mm2 = {orifice_mm2}"
    );
    bench.replace(
        "scenario.toml",
        "[workpiece]",
        &format!("[device.override]\n{keys}\n[workpiece]"),
    );
    bench
}

/// The reason given, after checking what every stop has in common.
fn stopped(outcome: &Outcome) -> &str {
    let line = outcome.only_line("stopped: ");
    assert_eq!(outcome.code, 3, "{line}");
    assert!(!outcome.err.contains("error: "), "{}", outcome.err);
    &line["stopped: ".len()..]
}

/// Checks that the files hold the run up to the sample of `steps` milliseconds, and no more.
fn holds_up_to(bench: &Bench, steps: usize, reason: &str) {
    assert_eq!(bench.names_in("out"), FILES);
    let samples = read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording;
    assert_eq!(samples.sample_count(), steps);
    for (index, time) in samples.time().iter().enumerate() {
        assert!((time - 1e-3 * (index + 1) as f64).abs() < 1e-9);
    }
    for channel in samples.channels() {
        assert!(
            channel.values.iter().all(|value| value.is_finite()),
            "{}",
            channel.quantity
        );
    }
    let last = samples.phases().last().unwrap();
    assert_eq!(last.end, *samples.time().last().unwrap());

    let summary = bench.summary();
    assert_eq!(summary["stopped"], reason);
    assert_eq!(summary["samples"], steps);
    assert_eq!(
        summary["summary"]["duration_s"].as_f64().unwrap(),
        last.end - samples.time()[0]
    );

    assert_eq!(drawn_strokes(bench), steps);
}

/// Points of the stroke's plot in recording.rrd, as Rerun's own reader finds them.
fn drawn_strokes(bench: &Bench) -> usize {
    let mut file =
        std::io::BufReader::new(std::fs::File::open(bench.path("out/recording.rrd")).unwrap());
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file).unwrap();
    let (_, store) = stores
        .into_iter()
        .find(|(id, _)| id.kind() == StoreKind::Recording)
        .unwrap();
    store
        .iter_physical_chunks()
        .filter(|chunk| chunk.entity_path().to_string().ends_with("/stroke") && !chunk.is_static())
        .map(|chunk| chunk.num_rows())
        .max()
        .unwrap()
}

#[test]
fn a_part_nearer_than_the_stroke_allows() {
    let bench = protruding(0.02, 15.0);
    let outcome = bench.run();
    let reason = stopped(&outcome);
    for words in [
        "the stroke ran out at ",
        "in phase engage",
        "of 0 to 50.0 mm",
        "nearer to the arm",
    ] {
        assert!(reason.contains(words), "{reason}");
    }
    let steps = milliseconds(reason);
    holds_up_to(&bench, steps, reason);
    // The slide has just met its inner end, the sample before it had not.
    let samples = read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording;
    let stroke = samples.values(schema::STROKE).unwrap();
    assert!(stroke[steps - 1] <= 0.0 && stroke[steps - 2] > 0.0);
}

#[test]
fn a_part_farther_than_the_stroke_allows() {
    let bench = protruding(-0.02, 35.0);
    let outcome = bench.run();
    let reason = stopped(&outcome);
    for words in [
        "the stroke ran out at ",
        "in phase follow",
        "0.0 mm along the edge",
        "farther from the arm",
    ] {
        assert!(reason.contains(words), "{reason}");
    }
    holds_up_to(&bench, milliseconds(reason), reason);
    let samples = read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording;
    assert!(
        samples
            .values(schema::CONTACT_FORCE)
            .unwrap()
            .iter()
            .all(|force| *force == 0.0)
    );
}

#[test]
fn an_arm_that_runs_its_locked_tool_into_the_part() {
    let bench = misplaced(30.0);
    bench.replace("scenario.toml", "[device]", "[device]\nlocked = true");
    let outcome = bench.run();
    let reason = stopped(&outcome);
    for words in [
        "the drive of joint wrist_1 came to its limit of 56 N m at ",
        "in phase approach and lost its path; after that axis wrist_1 lost its path at ",
        "2.86 deg are accepted",
        "56.0 of at most 56.0 N m",
    ] {
        assert!(reason.contains(words), "{reason}");
    }
    let stop = reason.rsplit("after that ").next().unwrap();
    assert!(milliseconds(reason) < milliseconds(stop), "{reason}");
    holds_up_to(&bench, milliseconds(stop), reason);
}

#[test]
fn a_chamber_that_empties_in_microseconds_is_no_reason_to_stop() {
    // Ended with a negative mass of air when the number of sub-steps was the user's business alone.
    let bench = leaky(2.0, 50.0);
    let outcome = bench.run();
    assert_ne!(outcome.code, 3, "{}", outcome.err);
    assert!(bench.path("out/samples.parquet").exists());
}

#[test]
fn a_device_out_of_all_proportion() {
    // Hydrogen through 100 mm2 into a tenth of a cubic centimetre: more sub-steps than there are for a step of 5 ms.
    let bench = leaky(0.1, 100.0);
    bench.replace(
        "scenario.toml",
        "dead_volume_cm3",
        "gas_constant_j_per_kg_k = 4124\ndead_volume_cm3",
    );
    bench.replace(
        "scenario.toml",
        "[expect]",
        "[simulation]\nstep_ms = 5\n[expect]",
    );
    // Such a servo cannot follow for long.
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 14");
    // A servo so slow that steps off the part are not cut for its sake.
    bench.replace(
        "scenario.toml",
        "[device]",
        "[arm.servo]\nnatural_frequency_hz = 16\n[device]",
    );
    let outcome = bench.run();
    let reason = stopped(&outcome);
    for words in [
        "chamber_2_mass became -",
        " in phase retract",
        "step_ms = 5 is too long",
    ] {
        assert!(reason.contains(words), "{reason}");
    }
    assert_eq!(bench.names_in("out"), FILES);
    assert_eq!(bench.summary()["stopped"], reason);
}

/// The time that a reason names, `at 1.234 s`.
fn milliseconds(reason: &str) -> usize {
    let mut words = reason.split(' ').skip_while(|word| *word != "at").skip(1);
    let seconds: f64 = words.next().unwrap().parse().unwrap();
    (1e3 * seconds).round() as usize
}
