//! docs/EFFECTS.md and its pictures.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::super::error::AppError;
use super::super::files::{OverwritePolicy, prepare_files};
use super::arm_page::{ArmExplained, HEADING, list_of_all};
use super::page::{Explained, by_subsystem};
use super::picture::{Picture, picture, picture_of_arm};
use crate::demonstration::{self as scene, ArmStage, Stage, arm_effects};
use crate::document::markdown_below;
use crate::recording::atomic::write_all;

/// File of the text, and folder of the pictures beside it.
const TEXT: &str = "EFFECTS.md";
const PICTURES: &str = "pictures/effects";

const INTRODUCTION: &str = "\
# Effects

The physics that a model of a cell or a device may lack, as `idc diagnose` looks for it and `idc run --with` puts it in. `idc effects` lists them, `idc effects NAME` tells what stands here of one.

Each picture is two runs of the simulator, nominal and with the effect, without noise: the signals that show it most, at the time at which they do. The size is in the title; it is the usual
one where that is seen. Runs are those of the scenarios in [assets/effects](../assets/effects): [steps](../assets/effects/steps.toml) of the set pressure on a load cell, a surface that goes to
and fro ([sway](../assets/effects/sway.toml)), free [strokes](../assets/effects/strokes.toml) and strokes that [draw](../assets/effects/draw.toml) much air, a stretch of an
[edge](../assets/effects/edge.toml) with the arm. What only a rig with a part of the device shows (`[rig] chain`; marked \\*) is a slide that is driven to and fro, a chamber that is shut off, or a
regulator alone.

Numbers are in the units that people read; a key ends in the unit in which a file has it, and `--with NAME:KEY=VALUE` takes any other unit of it. Ranges and usual sizes are those of the device
of [models/device.toml](../models/device.toml), where they depend on one. \"The source paper\" is that of [docs/PAPER.md](PAPER.md).
";

const END: &str = "
---

This page and its pictures are made by `idc effects --gallery docs --force`, of the header comments in `src/effects/`.
";

const OF_ARM: &str = "\
What an arm file may hold beyond its nominal numbers ([models/arm/arm10.toml](../models/arm/arm10.toml) is one), and `--with` puts into a cell whose `[arm] recorded_arm` names one. It changes what
currents, torques and the wrench sensor read, and not where the tool goes: the simulated servo is stiff. Readings are computed after the run of [drives_and_wrench](../scenarios/drives_and_wrench.toml).
joint_friction, compliant_joint and joint_encoder_offset are those of the cell, above. Numbers are in SI.
";

/// A line on a picture.
fn reported(name: &str, drawn: &Picture) -> String {
    format!(
        "{name}: {:.0} % of its range, {} bytes\n",
        100.0 * drawn.difference,
        drawn.svg.len()
    )
}

/// Writes it all; says what was written.
pub(super) fn write(folder: &Path, policy: OverwritePolicy) -> Result<String, AppError> {
    let mut stages: BTreeMap<String, Stage> = BTreeMap::new();
    let mut text = INTRODUCTION.to_owned();
    text += &markdown_below(&list_of_all(), 3);
    let mut summary = String::new();
    let mut pictures = Vec::new();
    for (heading, effects) in by_subsystem() {
        text += &format!("\n## {heading}\n");
        for effect in effects {
            let scene = scene::of(effect).scene;
            let key = scene.key();
            if !stages.contains_key(&key) {
                stages.insert(key.clone(), Stage::new(&scene)?);
            }
            let Some(stage) = stages.get(&key) else {
                continue;
            };
            let page = Explained::new(effect, stage).document(PICTURES);
            text += &format!("\n{}", markdown_below(&page, 3));
            let name = effect.vocabulary().0;
            let drawn = picture(effect, stage)?;
            summary += &reported(name, &drawn);
            pictures.push((folder.join(PICTURES).join(format!("{name}.svg")), drawn.svg));
        }
    }
    text += &format!("\n## {HEADING}\n\n{OF_ARM}");
    let stage = ArmStage::new()?;
    for effect in arm_effects() {
        let explained = ArmExplained::new(effect, &stage, PICTURES)?;
        text += &format!("\n{}", markdown_below(&explained.document(), 3));
        let drawn = picture_of_arm(effect, &stage, explained.title())?;
        let name = effect.name;
        summary += &reported(name, &drawn);
        pictures.push((folder.join(PICTURES).join(format!("{name}.svg")), drawn.svg));
    }
    text += END;
    pictures.push((folder.join(TEXT), text));
    let paths: Vec<&PathBuf> = pictures.iter().map(|(path, _)| path).collect();
    let _claims = prepare_files(&paths, "--gallery", policy)?;
    write_all(&pictures)?;
    Ok(summary)
}
