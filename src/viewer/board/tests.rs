//! Reads a written file back with Rerun's own reader.

use ::rerun::{ChunkStore, ChunkStoreConfig, Scalars, StateChange};

use super::*;
use crate::scene::board::{BoardLine, BoardRole, Cloud, CloudGroup, Lane, Sheet, SheetPlot};

fn board() -> Board {
    let line = |label: &str, role, values: [f64; 3]| BoardLine {
        label: label.to_owned(),
        role,
        values: values.to_vec(),
    };
    let plot = SheetPlot {
        title: "Force [N]".to_owned(),
        lines: vec![
            line("measured [N]", BoardRole::Measured, [1.0, 2.0, 3.0]),
            line("improved [N]", BoardRole::Improved, [1.5, f64::NAN, 3.5]),
        ],
        guides: vec![("noise".to_owned(), 0.25)],
        range: None,
    };
    let lane = Lane {
        name: "force".to_owned(),
        spans: vec![
            (0.0, 0.5, "parts".to_owned()),
            (1.0, 2.0, "parts".to_owned()),
        ],
    };
    Board {
        title: "case".to_owned(),
        text: "# verdict".to_owned(),
        clouds: vec![Cloud {
            title: "Force".to_owned(),
            horizontal: "speed [mm/s]".to_owned(),
            vertical: "lacking [N]".to_owned(),
            groups: vec![CloudGroup {
                label: "nominal".to_owned(),
                role: BoardRole::Nominal,
                points: vec![[0.0, 1.0], [2.0, -1.0]],
                joined: false,
            }],
        }],
        sheets: vec![Sheet {
            title: "ride.csv".to_owned(),
            time: vec![0.0, 1.0, 2.0],
            lanes: vec![lane],
            rows: vec![vec![plot]],
        }],
        scene: None,
    }
}

#[test]
fn lines_lanes_and_clouds_are_there_and_bytes_repeat() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["a.rrd", "b.rrd"].map(|name| folder.path().join(name));
    write_board(&first, &board()).unwrap();
    write_board(&second, &board()).unwrap();
    assert!(std::fs::read(&first).unwrap() == std::fs::read(&second).unwrap());
    crate::viewer::check_rrd(&first).unwrap();

    let mut file = std::fs::File::open(&first).unwrap();
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file).unwrap();
    let data = stores.values().find(|s| s.id().is_recording()).unwrap();
    let moving = |entity: &str| {
        let chunks = data.iter_physical_chunks();
        let mut own = chunks.filter(|c| c.entity_path().to_string() == entity && !c.is_static());
        own.next().unwrap_or_else(|| panic!("no {entity}")).clone()
    };
    let force = moving("/recording_1/force");
    let rows = force.iter_slices::<f64>(Scalars::descriptor_scalars().component);
    let rows: Vec<Vec<f64>> = rows.map(<[f64]>::to_vec).collect();
    assert_eq!(rows[0], [1.0, 1.5]);
    assert_eq!(rows[2], [3.0, 3.5]);
    let lane = moving("/recording_1/parts_from_the_model/force");
    let times = lane.timelines()[&"sim_time".into()].times_raw().to_vec();
    assert_eq!(times, [0, 500_000_000, 1_000_000_000, 2_000_000_000]);
    let states = lane.iter_slices::<String>(StateChange::descriptor_state().component);
    let states: Vec<String> = states.map(|row| row[0].to_string()).collect();
    assert_eq!(states, ["parts", "", "parts", ""]);
    let entities = data
        .iter_physical_chunks()
        .map(|c| c.entity_path().to_string());
    assert!(
        entities
            .into_iter()
            .any(|entity| entity == "/balance_1/nominal")
    );
}
