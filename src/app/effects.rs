//! `idc effects`: what physics there is that a model may lack, described and drawn.

mod arm_page;
mod gallery;
mod page;
mod picture;

use std::path::PathBuf;

use clap::Args;

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, prepare_file};
use super::output::say;
use super::terminal::shown_path;
use crate::demonstration::{self as scene, ArmStage, Stage, arm_effects};
use crate::document::{Document, Style, text};
use crate::effects::{Effect, NUMBER_OFF, NUMBERS_OFF, kinds};
use crate::keys::suggestion::nearest;
use crate::recorded_arm::vocabulary::ArmEffectName;
use crate::recording::atomic::write_text;
use arm_page::{ArmExplained, list_of_all};
use page::{Explained, by_subsystem};
use picture::{picture, picture_of_arm};

/// For the help.
pub(super) const EXAMPLES: &str = "\
docs/EFFECTS.md holds all of it, with the pictures. A picture is two runs of a
short scenario, nominal and with the effect at its usual size: the signals
that show it most, at the time at which they do.

Exit codes: 0 done, 2 bad input, or a file that stands already (--force).

Examples:
  # What there is, by where it enters.
  idc effects
  # Equation, numbers, what it looks like and what it is confused with.
  idc effects stribeck_friction
  # Its picture.
  idc effects stribeck_friction --out runs/stribeck_friction.svg
  # The same for a program.
  idc effects stribeck_friction --json";

#[derive(Debug, Args)]
pub(super) struct EffectsArguments {
    /// The effect to explain [default: a list of all].
    name: Option<String>,
    /// File for its picture, an SVG.
    #[arg(long, value_name = "FILE", requires = "name", help_heading = "Output")]
    out: Option<PathBuf>,
    /// Folder for EFFECTS.md and the pictures of all, as they stand in docs.
    #[arg(
        long,
        value_name = "FOLDER",
        conflicts_with_all = ["name", "json"],
        hide = true
    )]
    gallery: Option<PathBuf>,
    /// Put new files in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print the description as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Lists effects, explains one, or draws it.
pub(super) fn run(arguments: &EffectsArguments) -> Result<ExitCode, AppError> {
    let policy = OverwritePolicy::of(arguments.force);
    if let Some(folder) = &arguments.gallery {
        let summary = gallery::write(folder, policy)?;
        if !arguments.quiet {
            say(&summary)?;
        }
        return Ok(ExitCode::Done);
    }
    let Some(name) = &arguments.name else {
        if arguments.json {
            say(&format!("{:#}\n", listed()))?;
        } else if !arguments.quiet {
            say(&text(&list_of_all(), Style::Plain))?;
            say(&format!("\n{AFTER_LIST}"))?;
        }
        return Ok(ExitCode::Done);
    };
    if name == NUMBER_OFF && arguments.out.is_none() {
        if arguments.json {
            say(&format!("{:#}\n", number_off()))?;
        } else if !arguments.quiet {
            say(&number_off_text())?;
        }
        return Ok(ExitCode::Done);
    }
    if let Some(effect) = arm_effects().find(|effect| effect.name == name) {
        return of_arm(arguments, effect, policy);
    }
    let effect = named(name)?;
    let stage = Stage::new(&scene::of(effect).scene)?;
    if let Some(file) = &arguments.out {
        let _claim = prepare_file(file, "--out", policy)?;
        write_text(file, &picture(effect, &stage)?.svg)?;
    }
    let explained = Explained::new(effect, &stage);
    let json = serde_json::to_string_pretty(&explained)?;
    explain(arguments, name, &json, &explained.document(page::PICTURES))
}

/// The same of an effect of an arm file.
fn of_arm(
    arguments: &EffectsArguments,
    effect: &'static ArmEffectName,
    policy: OverwritePolicy,
) -> Result<ExitCode, AppError> {
    let stage = ArmStage::new()?;
    let explained = ArmExplained::new(effect, &stage, page::PICTURES)?;
    if let Some(file) = &arguments.out {
        let _claim = prepare_file(file, "--out", policy)?;
        let drawn = picture_of_arm(effect, &stage, explained.title())?;
        write_text(file, &drawn.svg)?;
    }
    let json = serde_json::to_string_pretty(&explained)?;
    explain(arguments, effect.name, &json, &explained.document())
}

/// Says what an effect is.
fn explain(
    arguments: &EffectsArguments,
    name: &str,
    json: &str,
    page: &Document<'_>,
) -> Result<ExitCode, AppError> {
    if arguments.json {
        say(&format!("{json}\n"))?;
    } else if let (Some(file), false) = (&arguments.out, arguments.quiet) {
        say(&format!("written to {}\n", shown_path(file)))?;
    } else if !arguments.quiet {
        say(&text(page, Style::Plain))?;
        say(&format!(
            "  idc effects {name} --out FILE.svg draws it anew\n"
        ))?;
    }
    Ok(ExitCode::Done)
}

fn named(name: &str) -> Result<&'static Effect, AppError> {
    let of_arm = arm_effects().map(|effect| effect.name);
    let known: Vec<&str> = kinds()
        .map(|effect| effect.vocabulary().0)
        .chain(of_arm)
        .collect();
    let effect = kinds().find(|effect| effect.vocabulary().0 == name);
    effect.ok_or_else(|| AppError::NoEffect {
        name: name.to_owned(),
        advice: nearest(name, &known),
    })
}

/// Meaning of [`NUMBER_OFF`], which is no law and so has no picture.
const OFF: &str = "A number of the rig file that is off by more than its tolerance allows.";

/// Below the list.
const AFTER_LIST: &str = "\
* only in a rig with a part of the device alone, [rig] chain
idc effects NAME explains one, idc run SCENARIO --with NAME puts it in
";

/// It, for programs.
fn number_off() -> serde_json::Value {
    let keys: Vec<&str> = NUMBERS_OFF.iter().filter_map(Effect::number_key).collect();
    serde_json::json!({ "name": NUMBER_OFF, "meaning": OFF, "keys": keys })
}

/// It, for people.
fn number_off_text() -> String {
    let keys: Vec<&str> = NUMBERS_OFF.iter().filter_map(Effect::number_key).collect();
    format!(
        "{NUMBER_OFF}\n\n{OFF}\n\
         A diagnosis tries each of these beside the laws, and names it by its key:\n\n  {}\n\n\
         Others are found as an effect that says the same (moving_mass_error ..).\n",
        keys.join("\n  ")
    )
}

/// For programs.
fn listed() -> serde_json::Value {
    let entry = |effect: &Effect| {
        serde_json::json!({
            "name": effect.vocabulary().0,
            "subsystem": effect.subsystem.name(),
            "meaning": effect.header().meaning,
            "part_of_device": scene::is_of_part(effect),
        })
    };
    let effects = by_subsystem().flat_map(|(_, effects)| effects);
    let of_arm = arm_effects().map(|effect| {
        serde_json::json!({
            "name": effect.name,
            "subsystem": effect.subsystem,
            "meaning": effect.meaning,
        })
    });
    serde_json::json!({
        "effects": effects.map(entry).collect::<Vec<_>>(),
        "effects_of_arm_files": of_arm.collect::<Vec<_>>(),
    })
}
