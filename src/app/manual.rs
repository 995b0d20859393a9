//! `idc completions` and `idc man`: what shells and manual pages know of the commands, made of the commands themselves.

use std::path::PathBuf;

use clap::{Args, Command};

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, prepare_files};
use super::output::say;
use super::terminal::shown_path;
use crate::recording::atomic::write_all;

/// For the help.
pub(super) const COMPLETION_EXAMPLES: &str = "\
Exit codes: 0 done, 2 bad input.

Examples:
  # In this shell, until it ends.
  source <(idc completions bash)
  # For good, where bash looks for them.
  mkdir -p ~/.local/share/bash-completion/completions
  idc completions bash > ~/.local/share/bash-completion/completions/idc
  # Other shells.
  idc completions zsh > _idc
  idc completions fish > idc.fish";
/// For the help.
pub(super) const MAN_EXAMPLES: &str = "\
Exit codes: 0 done, 2 bad input, or files that stand already (--force).

Examples:
  # The page of the program, as it is read by man.
  idc man > idc.1
  # A page of each command, into a folder: man -l runs/man/idc-run.1
  idc man --out runs/man";

#[derive(Debug, Args)]
pub(super) struct CompletionArguments {
    /// The shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Folder for a page of each command, idc.1, idc-run.1 and so on [default: the program's page on standard output].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new pages in place of old ones.
    #[arg(long, requires = "out", help_heading = "Output")]
    force: bool,
}

/// Prints the completions of a program in a shell.
pub(super) fn completions(
    arguments: &CompletionArguments,
    mut program: Command,
) -> Result<ExitCode, AppError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "idc", &mut script);
    say(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::Done)
}

/// Prints a program's page, or writes all of them.
pub(super) fn man(arguments: &ManArguments, mut program: Command) -> Result<ExitCode, AppError> {
    // Commands get what the program has for all of them.
    program.build();
    let Some(folder) = &arguments.out else {
        say(&page(&program, "idc")?)?;
        return Ok(ExitCode::Done);
    };
    let mut pages = Vec::new();
    pages_of(&program, "idc", &mut pages)?;
    let files = pages.iter().map(|(name, text)| (folder.join(name), text));
    let files: Vec<(PathBuf, &String)> = files.collect();
    let paths: Vec<&PathBuf> = files.iter().map(|(path, _)| path).collect();
    let _claims = prepare_files(&paths, "--out", OverwritePolicy::of(arguments.force))?;
    write_all(&files)?;
    say(&format!(
        "{} pages written to {}\n",
        pages.len(),
        shown_path(folder)
    ))?;
    Ok(ExitCode::Done)
}

/// Pages of a command and of those below it, by file name.
fn pages_of(
    command: &Command,
    name: &str,
    pages: &mut Vec<(String, String)>,
) -> Result<(), AppError> {
    pages.push((format!("{name}.1"), page(command, name)?));
    for sub in command.get_subcommands() {
        if !sub.is_hide_set() && sub.get_name() != "help" {
            pages_of(sub, &format!("{name}-{}", sub.get_name()), pages)?;
        }
    }
    Ok(())
}

/// One page, in the language of man.
fn page(command: &Command, name: &str) -> Result<String, AppError> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone())
        .title(name)
        .render(&mut text)
        .map_err(AppError::Print)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
