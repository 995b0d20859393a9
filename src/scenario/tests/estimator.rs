//! `[estimator]` of a bench: what it refuses, and that its beliefs are those of `[sensing]` and `[device]` where it does not say.

use super::{MINIMAL_BENCH, read_bench};

/// A bench whose device the estimator models: its air keeps its temperature.
fn with(tables: &str) -> String {
    MINIMAL_BENCH.replace("[device]\n", "[device]\nideal = true\n") + tables
}

fn set_up(tables: &str) -> String {
    let scenario = read_bench(&with(tables)).unwrap();
    format!("{:?}", scenario.estimator.unwrap())
}

fn refusal(tables: &str) -> String {
    read_bench(&with(tables)).unwrap_err().to_string()
}

#[test]
fn without_the_table_there_is_none() {
    assert!(read_bench(MINIMAL_BENCH).unwrap().estimator.is_none());
}

#[test]
fn noise_left_out_is_that_of_the_sensing_table() {
    let white = "[sensing.stroke]\nkind = 'white'\nstandard_deviation_mm = 0.07\n[estimator]\n";
    assert_eq!(
        set_up(white),
        set_up("[estimator]\nstroke_noise_mm = 0.07\n")
    );
    assert_ne!(set_up(white), set_up("[estimator]\n"));
    // A step of 0.1 mm is even noise of 0.1 / sqrt(12) mm.
    let stepped = "[sensing.stroke]\nkind = 'real'\nresolution_mm = 0.1\nstandard_deviation_mm = 0\n[estimator]\n";
    let same = (0.1e-3f64 * 0.1e-3 / 12.0).sqrt() * 1e3;
    let given = set_up(&format!("[estimator]\nstroke_noise_mm = {same:e}\n"));
    let noise = |text: &str| text.split("noise: [").nth(1).unwrap()[..8].to_owned();
    assert_eq!(noise(&set_up(stepped)), noise(&given));
}

#[test]
fn tolerances_start_at_the_usual_or_at_none() {
    let usual = set_up("[estimator]\n");
    let none = set_up("[estimator]\ntolerances = 'none'\n");
    assert_ne!(usual, none);
    assert!(none.contains("moving_mass: 0.0"), "{none}");
    let one = set_up("[estimator]\ntolerances = 'none'\nmoving_mass_tolerance = 0.5\n");
    assert!(one.contains("moving_mass: 0.5"), "{one}");
}

#[test]
fn what_it_cannot_do_is_refused_by_name() {
    for (tables, words) in [
        (
            "[device.override]\nhose_length_m = 2\n[estimator]\n",
            "a line between regulator and valve",
        ),
        (
            "[device.override]\ngas_process = 'wall_heat'\n[estimator]\n",
            "gas warms up",
        ),
        (
            "[sensing]\nsample_rate_hz = 20\n[estimator]\n",
            "at most 0.02 s",
        ),
        (
            "[sensing]\nsample_rate_hz = 300\n[estimator]\n",
            "no whole number of steps",
        ),
        ("[estimator]\ntolerances = 'some'\n", "usual"),
        (
            "[estimator]\nseal_coulomb_force = 3\n",
            "seal_coulomb_force_n",
        ),
    ] {
        let message = refusal(tables);
        assert!(message.contains(words), "{message}");
        assert!(message.contains("estimator"), "{message}");
    }
}
