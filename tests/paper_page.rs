//! docs/PAPER.md beside what the runs give: its generated tables and its pictures.
//!
//! `UPDATE_PAPER=1 cargo test --release --test cell paper` writes both anew.

use std::process::Command;

use idc_cell::metrics::BenchSummary;
use idc_cell::recording::schema;
use idc_cell::rig::Rig;
use idc_cell::run::{FinishedBench, run_bench};
use idc_cell::scenario::bench::BenchScenario;
use idc_cell::scenario::load_bench;
use idc_cell::sensing::Measurement;

use crate::common::project;

const PAGE: &str = "docs/PAPER.md";
const UPDATE: &str = "UPDATE_PAPER=1 cargo test --release --test cell paper";

fn updating() -> bool {
    std::env::var_os("UPDATE_PAPER").is_some()
}

/// A table as Markdown; the first row is the heading.
pub fn markdown(rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = vec!["---".to_owned(); rows[0].len()];
    let body = rows[1..].iter().map(|row| line(row));
    line(&rows[0]) + &line(&rule) + &body.collect::<String>()
}

/// Cells of a row.
pub fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

/// Holds a table against the one between its two markers in the page, which says the same or is out of date.
pub fn is_in_the_page(name: &str, table: &str) {
    // Tests that write run side by side.
    static WRITING: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _held = WRITING.lock().unwrap();
    println!("{name}\n{table}");
    let path = project(PAGE);
    let page = std::fs::read_to_string(&path).unwrap();
    let [begin, end] = ["begin", "end"].map(|word| format!("<!-- {word} {name} -->\n"));
    let start = page
        .find(&begin)
        .unwrap_or_else(|| panic!("{PAGE} has no line {begin}"))
        + begin.len();
    let length = page[start..]
        .find(&end)
        .unwrap_or_else(|| panic!("{PAGE} has no line {end}"));
    if updating() {
        let written = format!("{}{table}{}", &page[..start], &page[start + length..]);
        std::fs::write(&path, written).unwrap();
        return;
    }
    assert_eq!(
        &page[start..start + length],
        table,
        "{PAGE} is out of date between the markers of `{name}`. Judge the change; if it is right, {UPDATE} writes the page anew"
    );
}

fn run(name: &str) -> (BenchScenario, FinishedBench) {
    let scenario = load_bench(&project(&format!("scenarios/{name}.toml"))).unwrap();
    let finished = run_bench(&Rig::new(scenario.clone()).unwrap(), &mut |_| ()).unwrap();
    assert_eq!(finished.stop, None);
    (scenario, finished)
}

/// Slope [N/bar] of the least-squares line and the largest distance from it over the highest force [%].
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64| points.iter().map(pick).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = xy / xx;
    let off = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).abs());
    let highest = points.iter().map(|p| p.1).fold(0.0, f64::max);
    (slope, 100.0 * off.fold(0.0, f64::max) / highest)
}

fn read_line(summary: &BenchSummary, count: usize) -> (f64, f64) {
    let levels = summary.levels[..count].iter();
    let point = |level: &idc_cell::metrics::LevelSummary| {
        (
            level.regulator_pressure_bar_gauge,
            level.measured_force_mean_n.unwrap(),
        )
    };
    line(&levels.map(point).collect::<Vec<_>>())
}

#[test]
fn the_six_figures_in_numbers() {
    let mut rows = vec![row([
        "figs.",
        "set, bar",
        "outlet, bar",
        "delay, s",
        "force, N",
        "load cell reads, N",
        "settled after, s",
        "stroke, mm",
    ])];
    for (figures, name) in [
        ("6 to 8", "paper_step"),
        ("9 to 11", "paper_stairstep"),
        ("9 to 11, sensed", "paper_stairstep_sensed"),
    ] {
        let (scenario, finished) = run(name);
        let area = scenario.nominal.device.areas().extending;
        for (level, (_, wanted)) in finished.summary.levels.iter().zip(scenario.command.steps()) {
            let force = level.force_mean_n.unwrap();
            let outlet = level.regulator_pressure_bar_gauge;
            // Eq. (1) at rest, chamber 2 at the atmosphere; what is left of the lag is e^-7.
            assert!((force / (outlet * 1e5 * area) - 1.0).abs() < 2e-4);
            assert!((outlet / (wanted / 1e5) - 1.0).abs() < 5e-3);
            rows.push(vec![
                figures.to_owned(),
                format!("{:.1}", wanted / 1e5),
                format!("{outlet:.3}"),
                format!("{:.3}", level.regulator_delay_s.unwrap()),
                format!("{force:.1}"),
                format!("{:.1}", level.measured_force_mean_n.unwrap()),
                format!("{:.2}", level.force_settling_time_s.unwrap()),
                format!("{:.2}", level.stroke_mm.unwrap()),
            ]);
        }
    }
    let (_, finished) = run("paper_step");
    let speeds = finished.recording.values(schema::STROKE_VELOCITY).unwrap();
    let meets = speeds.iter().copied().fold(0.0, f64::max);
    assert!((meets - 0.3).abs() < 0.05, "the page says 0.3 m/s: {meets}");
    is_in_the_page("figures", &markdown(&rows));
}

#[test]
fn force_is_proportional_to_pressure_until_the_adc_is_full() {
    let mut rows = vec![row([
        "load cell",
        "levels",
        "slope, N/bar",
        "linearity error, % of the highest",
    ])];
    let (_, ideal) = run("paper_stairstep");
    let (mut scenario, sensed) = run("paper_stairstep_sensed");
    let area = scenario.nominal.device.areas().extending;
    let mut push = |what: &str, levels: usize, (slope, off): (f64, f64)| {
        rows.push(vec![
            what.to_owned(),
            levels.to_string(),
            format!("{slope:.1}"),
            if off < 1e-3 {
                format!("{off:.0e}")
            } else {
                format!("{off:.3}")
            },
        ]);
        (slope, off)
    };
    let (slope, off) = push("ideal", 3, read_line(&ideal.summary, 3));
    assert!((slope / (1e5 * area) - 1.0).abs() < 1e-5 && off < 1e-4);
    let (_, off) = push(
        "100 ohm fitted, 121 assumed",
        3,
        read_line(&sensed.summary, 3),
    );
    assert!(off > 5.0, "the ADC is full at the third level: {off}");
    let Measurement::Real(cell) = &mut scenario.sensing.force else {
        panic!("the paper's load cell is real")
    };
    cell.assumed_gain_resistor = 100.0;
    let known = run_bench(&Rig::new(scenario.clone()).unwrap(), &mut |_| ()).unwrap();
    let (_, off) = push(
        "100 ohm fitted and assumed",
        3,
        read_line(&known.summary, 3),
    );
    assert!(off > 5.0, "and to know the resistor does not help: {off}");
    let Measurement::Real(cell) = &mut scenario.sensing.force else {
        panic!("the paper's load cell is real")
    };
    (cell.amplifier.gain_resistor, cell.assumed_gain_resistor) = (121.0, 121.0);
    let meant = run_bench(&Rig::new(scenario).unwrap(), &mut |_| ()).unwrap();
    let (slope, off) = push(
        "121 ohm fitted and assumed",
        3,
        read_line(&meant.summary, 3),
    );
    assert!((slope / (1e5 * area) - 1.0).abs() < 5e-3 && off < 0.2);
    is_in_the_page("line", &markdown(&rows));
}

#[test]
fn the_load_cells_chain_in_numbers() {
    const KILOGRAM: f64 = 9.806_65;
    let (scenario, finished) = run("paper_stairstep_sensed");
    let Measurement::Real(cell) = &scenario.sensing.force else {
        panic!("the paper's load cell is real")
    };
    let assumed = idc_cell::sensing::InstrumentationAmplifierParameters::gain_with(
        cell.assumed_gain_resistor,
    );
    let period = scenario.sensing.sample_period();
    let clipping = cell.clipping_force();
    // The second level, steady: what the filter leaves of the noise. The ADC's steps are part of it.
    let spread = |quantity: &str| {
        let values = &finished.recording.values(quantity).unwrap()[9_500..10_500];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        (squares / values.len() as f64).sqrt()
    };
    let (raw, treated) = (
        spread(schema::MEASURED_FORCE_UNFILTERED),
        spread(schema::MEASURED_FORCE),
    );
    assert!(treated < 0.6 * raw, "{treated} of {raw} N");
    let rows = [
        row(["what", "figure"]),
        vec![
            "gain fitted, 4 + 60 kohm / 100 ohm".to_owned(),
            format!("{:.0}", cell.amplifier.gain()),
        ],
        vec![
            "gain assumed, 4 + 60 kohm / 121 ohm".to_owned(),
            format!("{assumed:.2}"),
        ],
        vec![
            "the reading's error".to_owned(),
            format!("{:+.2} %", 100.0 * cell.gain_error()),
        ],
        vec![
            "the ADC is full at".to_owned(),
            format!("{clipping:.1} N = {:.2} kg", clipping / KILOGRAM),
        ],
        vec![
            "a step of the reading".to_owned(),
            format!("{:.2} N", cell.step()),
        ],
        vec![
            "delay of the filter, second-order Bessel at 5 Hz, 100 samples a second".to_owned(),
            format!("{:.1} ms", 1e3 * scenario.sensing.force_delay()),
        ],
        vec![
            "share of white noise that it leaves".to_owned(),
            format!("{:.2}", scenario.sensing.force_filter.noise_factor(period)),
        ],
        vec![
            "noise at 2.1 bar, before and after it".to_owned(),
            format!("{raw:.2} N, {treated:.2} N"),
        ],
    ];
    is_in_the_page("load cell", &markdown(&rows));
}

#[test]
fn what_the_page_points_to_exists() {
    let page = std::fs::read_to_string(project(PAGE)).unwrap();
    let quoted = page.split('`').skip(1).step_by(2);
    let files = quoted.filter_map(|text| {
        let path = text.strip_prefix("idc run ").unwrap_or(text);
        let ours = ["src/", "scenarios/", "models/"];
        ours.iter()
            .any(|root| path.starts_with(root))
            .then(|| path.to_owned())
    });
    let linked = page.split("](").skip(1).map(|rest| {
        let path = &rest[..rest.find(')').unwrap()];
        format!("docs/{}", path.split('#').next().unwrap())
    });
    let pointed = files.chain(linked).filter(|path| path != "docs/");
    let pointed: Vec<String> = pointed.collect();
    assert!(pointed.len() > 20, "{pointed:?}");
    for path in pointed {
        assert!(project(&path).exists(), "{PAGE} points to {path}");
    }
}

#[test]
fn a_hand_moves_the_tool_and_the_force_stays() {
    let (_, finished) = run("hand_push");
    let summary = &finished.summary;
    let off = summary.force_largest_error_percent.unwrap();
    assert!(off < 2.0, "{off} %");
    let line = format!(
        "`hand_push`: stroke {:.1} to {:.1} mm at 0.5 Hz, force {:.1} N, largest error {off:.2} % (asked: 2 %), open loop and without friction.\n",
        summary.stroke_min_mm.unwrap(),
        summary.stroke_max_mm.unwrap(),
        summary.force_mean_n.unwrap(),
    );
    is_in_the_page("hand", &line);
}

/// Words of a picture: its numbers, and what stands between them.
fn words(svg: &str) -> Vec<&str> {
    let cut = |letter: char| letter == ',' || letter == '"' || letter.is_whitespace();
    svg.split(cut).filter(|word| !word.is_empty()).collect()
}

#[test]
fn the_pictures_are_those_of_the_run() {
    for name in ["paper_step", "paper_stairstep", "paper_stairstep_sensed"] {
        let folder = tempfile::tempdir().unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_idc"))
            .args(["run", &format!("scenarios/{name}.toml"), "--quiet", "--out"])
            .arg(folder.path())
            .current_dir(project("."))
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let drawn = std::fs::read_to_string(folder.path().join("figures.svg")).unwrap();
        let path = project(&format!("docs/paper/{name}.svg"));
        if updating() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &drawn).unwrap();
            continue;
        }
        let kept = std::fs::read_to_string(&path).unwrap();
        // Another machine's rounding may move a line by a tenth of a pixel, which is the unit.
        let same = |(a, b): (&&str, &&str)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= 1.0,
            _ => a == b,
        };
        let [drawn, kept] = [words(&drawn), words(&kept)];
        assert!(
            drawn.len() == kept.len() && drawn.iter().zip(&kept).all(same),
            "docs/paper/{name}.svg is not what `idc run scenarios/{name}.toml` draws. Judge the change; if it is right, {UPDATE} writes it anew"
        );
    }
}
