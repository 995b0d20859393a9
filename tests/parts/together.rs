//! Several cases whose rig files say which part they share, by `idc diagnose --all`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::moved;

/// Nominal bores of four cylinders [m].
const BORES: [f64; 4] = [0.025, 0.020, 0.032, 0.040];

/// Four pistons whose real bores, over the nominal ones, and whose load cell's gain are these, with what each rig file says of its parts.
fn four(bores: [f64; 4], gain: f64, shares: &dyn Fn(usize) -> String) -> tempfile::TempDir {
    let area = |bore: f64| std::f64::consts::FRAC_PI_4 * bore * bore;
    let folder = tempfile::tempdir().unwrap();
    for (index, (nominal, share)) in BORES.into_iter().zip(bores).enumerate() {
        let case = folder.path().join(format!("cases/piston-{index}"));
        std::fs::create_dir_all(&case).unwrap();
        let rig = format!(
            "schema = 2\n[rig]\nchain = \"moved_piston\"\n[cylinder]\ncount = 1\nbore_m = {{ value = {nominal}, tolerance = 0.002 }}\n[sensors]\nforce_n = 0.05\n[recordings]\nfit = [\"*.csv\"]\n{}",
            shares(index)
        );
        std::fs::write(case.join("rig.toml"), rig).unwrap();
        for bar in [1.0, 5.0].map(|bar| bar + 0.4 * index as f64) {
            let (name, header, rows) = moved(bar, [0.0; 3], 0.0);
            let mut text = format!("{header}\n");
            for row in rows.iter().filter(|row| row[0] < 14.0) {
                let more = row[1] * (area(nominal * share) - area(0.025));
                let force = gain * (row[3] + more);
                writeln!(text, "{:.6},{},{:.7},{force:.5}", row[0], row[1], row[2]).unwrap();
            }
            std::fs::write(case.join(name), text).unwrap();
        }
    }
    folder
}

/// What `--all` prints of them, into a folder of its own or, where it stands there, of what stands.
fn all(folder: &Path, more: &[&str]) -> String {
    let program = Command::new(env!("CARGO_BIN_EXE_idc"))
        .current_dir(folder)
        .args(["diagnose", "cases", "--all", "--out", "out"])
        .args(more)
        .output()
        .unwrap();
    let err = String::from_utf8_lossy(&program.stderr);
    assert!(program.status.success(), "{err}");
    String::from_utf8(program.stdout).unwrap()
}

/// The family in the JSON of `--all`: name, key and probability of the likeliest member, and the line itself.
fn likeliest(json: &str) -> (String, f64, Value) {
    let line: Value = serde_json::from_str(json.lines().last().unwrap()).unwrap();
    let family = &line["shared"][0];
    assert_eq!(family["family"], "force_by_pressure", "{json}");
    let first = &family["members"][0];
    let name = first["key"].as_str().or(first["name"].as_str()).unwrap();
    (
        name.to_owned(),
        first["probability"].as_f64().unwrap(),
        first.clone(),
    )
}

#[test]
fn four_pistons_on_one_load_cell_tell_its_gain_from_their_bores() {
    let lc_7 = |_| "[shares]\nforce_sensor = \"LC-7\"\n".to_owned();
    let one = four([1.0; 4], 1.03, &lc_7);
    let text = all(one.path(), &[]);
    assert!(
        text.split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .contains("in 4 cases with force sensor LC-7"),
        "{text}"
    );
    let (name, probability, gain) = likeliest(&all(one.path(), &["--resume", "--json"]));
    assert_eq!(name, "force_sensor_gain_error", "{text}");
    assert!(probability > 0.95 && probability < 0.999, "{text}");
    let part = &gain["shared"][0];
    let value = part["factor"]["value"].as_f64().unwrap();
    assert!((value - 1.03).abs() < 2e-3, "{part}");
    assert_eq!(part["cases"].as_array().unwrap().len(), 4);
    // Each case by itself says as much as before, and cannot tell.
    let of_case = |name: &str| {
        let file = one.path().join(format!("out/{name}/diagnosis.json"));
        serde_json::from_slice::<Value>(&std::fs::read(file).unwrap()).unwrap()
    };
    let alone = of_case("piston-0");
    assert!(alone["shared"].is_null());
    let account = std::fs::read_to_string(one.path().join("out/piston-0/account.txt")).unwrap();
    let account = account.split_whitespace().collect::<Vec<_>>().join(" ");
    let headline = "another scale of force by pressure (which law is open)";
    assert!(account.contains(headline), "{account}");
    assert!(
        account.contains("As little is left, and so not ruled out, with"),
        "{account}"
    );
    let members = alone["families"][0]["members"].as_array().unwrap();
    assert_eq!(members.len(), 2, "{alone:#}");
    for member in members {
        // The one that was fitted first stood at nothing beside the other, which does the same.
        let probability = member["probability"].as_f64().unwrap();
        assert!((0.3..=0.7).contains(&probability), "{alone:#}");
        assert!(member["number"]["value"].is_number(), "{alone:#}");
    }
    // Nothing is assumed where nothing is stated: what would let them decide is said.
    for index in 0..4 {
        let rig = one.path().join(format!("cases/piston-{index}/rig.toml"));
        let text = std::fs::read_to_string(&rig).unwrap();
        std::fs::write(&rig, text.split("[shares]").next().unwrap()).unwrap();
    }
    let silent = all(one.path(), &["--resume"]);
    assert!(
        silent.contains("[shares]") && !silent.contains("LC-7"),
        "{silent}"
    );
}

#[test]
fn four_pistons_with_bores_of_their_own_take_the_blame_off_one_load_cell() {
    let lc_7 = |_| "[shares]\nforce_sensor = \"LC-7\"\n".to_owned();
    let own = four([1.03, 0.97, 1.05, 0.96], 1.0, &lc_7);
    let text = all(own.path(), &[]);
    let (name, probability, _) = likeliest(&all(own.path(), &["--resume", "--json"]));
    assert_eq!(name, "cylinder.bore_m", "{text}");
    assert!(probability > 0.95 && probability < 0.999, "{text}");
}
