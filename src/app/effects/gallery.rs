//! docs/EFFECTS.md and its pictures.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::error::AppError;
use super::super::files::{OverwritePolicy, prepare_file};
use super::page::{Explained, by_subsystem, list};
use super::picture::picture;
use crate::demonstration::{self as scene, Stage};
use crate::document::markdown_below;
use crate::recording::atomic::write_text;

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

/// Writes it all; says what was written.
pub(super) fn write(folder: &Path, policy: OverwritePolicy) -> Result<String, AppError> {
    let mut stages: BTreeMap<String, Stage> = BTreeMap::new();
    let mut text = INTRODUCTION.to_owned();
    text += &markdown_below(&list(), 3);
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
            summary += &format!(
                "{name}: {:.0} % of its range, {} bytes\n",
                100.0 * drawn.difference,
                drawn.svg.len()
            );
            pictures.push((folder.join(PICTURES).join(format!("{name}.svg")), drawn.svg));
        }
    }
    text += END;
    pictures.push((folder.join(TEXT), text));
    for (path, _) in &pictures {
        prepare_file(path, "--gallery", policy)?;
    }
    for (path, content) in &pictures {
        write_text(path, content)?;
    }
    Ok(summary)
}
