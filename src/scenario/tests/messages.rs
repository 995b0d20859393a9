//! Files, TOML and keys that are wrong: each gives one clear message.

use std::path::Path;

use super::super::{load, load_device};
use super::{message, refused, scenarios};

#[test]
fn a_missing_file_is_said_to_be_missing() {
    let message = load(Path::new("/nowhere/x.toml")).unwrap_err().to_string();
    assert_eq!(message, "there is no file /nowhere/x.toml");
    let message = load_device(Path::new("/nowhere/d.toml"))
        .unwrap_err()
        .to_string();
    assert_eq!(message, "there is no file /nowhere/d.toml");
    let message = load(&scenarios()).unwrap_err().to_string();
    assert!(message.starts_with("cannot read "), "{message}");
}

#[test]
fn bad_toml_is_placed() {
    refused(
        "[process]",
        "[process",
        "14:9",
        "not valid TOML: unclosed table, expected `]`",
    );
    refused(
        "force_n = 150",
        "force_n = 150\nforce_n = 2",
        "16:1",
        "not valid TOML: duplicate key",
    );
    for text in [
        "\u{0}",
        "a",
        "a =",
        "a = 'b",
        "=",
        "[[a]]\n[a]",
        "x = 1\n\u{fffd}",
    ] {
        assert!(message(text).contains("not valid TOML: "), "{text:?}");
    }
}

#[test]
fn columns_count_characters() {
    refused(
        "title = \"minimal\"",
        "title = \"gr\u{fc}n\" x",
        "2:16",
        "not valid TOML: unexpected key or value, expected newline, `#`",
    );
}

#[test]
fn another_schema_is_refused_before_its_unknown_keys() {
    refused(
        "schema = 1",
        "schema = 3\nwarp = 1",
        "1:10",
        "schema is 3, expected 1 to 2",
    );
    refused(
        "schema = 1",
        "schema = \"1\"",
        "1:10",
        "`schema` is \"1\", expected a whole number, 0 or more",
    );
    refused(
        "schema = 1\n",
        "",
        "1:1",
        "`schema` is missing, expected it to be given, it has no default",
    );
}

#[test]
fn an_unknown_key_leads_to_the_right_one() {
    for (from, to, location, words) in [
        (
            "force_n",
            "force",
            "15:1",
            "unknown key `process.force`; the key is `force_n`, in N",
        ),
        (
            "force_n",
            "force_kn",
            "15:1",
            "unknown key `process.force_kn`; the key is `force_n`, in N",
        ),
        (
            "feed_mm_per_s",
            "feed_m_per_s",
            "16:1",
            "unknown key `process.feed_m_per_s`; the key is `feed_mm_per_s`, in mm/s",
        ),
        (
            "force_n",
            "froce_n",
            "15:1",
            "unknown key `process.froce_n`; did you mean `force_n`?",
        ),
        (
            "[process]",
            "[proces]",
            "14:2",
            "unknown key `proces`; did you mean `process`?",
        ),
        (
            "[process]",
            "[contact]\nforce_n = 1\n[process]",
            "15:1",
            "unknown key `contact.force_n`; `force_n` belongs to [process]",
        ),
        (
            "[process]",
            "[device.override]\nbore_cm = 3\n[process]",
            "15:1",
            "unknown key `device.override.bore_cm`; the key is `bore_mm`, in mm",
        ),
        (
            "[process]",
            "[workpiece.misplacement]\nangle = 3\n[process]",
            "15:1",
            "unknown key `workpiece.misplacement.angle`; known here are shift_mm, tilt_deg",
        ),
        (
            "[process]",
            "[[arm.limit_overrides]]\njoint = \"a\"\neffort = 3\n[process]",
            "16:1",
            "unknown key `arm.limit_overrides[0].effort`; the key is `effort_n_m`, in N m",
        ),
        (
            "[process]",
            "[expect]\nforce_mean_n = { mix = 3 }\n[process]",
            "15:18",
            "unknown key `expect.force_mean_n.mix`; known here are min, max",
        ),
    ] {
        refused(from, to, location, words);
    }
}

#[test]
fn a_missing_key_is_named_with_its_table_and_unit() {
    for (from, location, words) in [
        (
            "force_n = 150",
            "14:1",
            "`process.force_n` is missing, expected it to be given in N, it has no default",
        ),
        (
            "[process]\nforce_n = 150\nfeed_mm_per_s = 20\n",
            "1:1",
            "`process` is missing, expected a table [process]",
        ),
        (
            "[workpiece.edge]\nedge = 1\n",
            "8:1",
            "`workpiece.edge` is missing, expected a table [workpiece.edge]",
        ),
        (
            "edge = 1",
            "12:2",
            "`workpiece.edge.edge` is missing, expected edge or loop, a number from `idc edges`",
        ),
        (
            "urdf = \"../models/arm/arm10.urdf\"",
            "3:1",
            "`arm.urdf` is missing, expected it to be given, it has no default",
        ),
    ] {
        let location = if from == "edge = 1" {
            "12:12"
        } else {
            location
        };
        refused(from, "", location, words);
    }
}
