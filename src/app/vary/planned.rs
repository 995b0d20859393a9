//! From what is asked for to a plan: all is checked by key before anything is written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::super::error::AppError;
use super::super::run::{blamed, can_run};
use super::work::{KIND, Shared};
use crate::cell::arm_options;
use crate::recording::provenance::SourceFile;
use crate::scenario::{AnyScenario, KeyValue, files_of_cell, led_to};
use crate::tasks::{Head, Plan, Task, name_of};
use crate::vary::Sweep;

impl Sweep {
    /// Sees whether each value at the ends of its range, or that is named, is one that its key takes: with the others as they are in the file, or with all
    /// others at their first or last, as keys may only go together.
    pub(super) fn check(&self) -> Result<(), AppError> {
        let variables = self.points.variables();
        let ends = (0..variables.len()).map(|place| self.points.to_check(place));
        let ends: Vec<Vec<String>> = ends.collect();
        for (place, variable) in variables.iter().enumerate() {
            for value in &ends[place] {
                let own = KeyValue::typed(&variable.key, value);
                let alone = self.with(std::slice::from_ref(&own));
                let Err(error) = alone else {
                    continue;
                };
                let together = |at: fn(&Vec<String>) -> Option<&String>| {
                    let others = variables.iter().zip(&ends).enumerate();
                    let others = others.filter(|(other, _)| *other != place);
                    let others = others
                        .filter_map(|(_, (v, ends))| Some(KeyValue::typed(&v.key, at(ends)?)));
                    self.with(&others.chain([own.clone()]).collect::<Vec<_>>())
                };
                let others = [together(|ends| ends.first()), together(|ends| ends.last())];
                if variables.len() == 1 || others.iter().all(Result::is_err) {
                    let blamed = blamed(error, &[own], &self.template);
                    return Err(match self.points.place_of(place, value) {
                        Some(row) => blamed.in_row(&row, &variable.key, value),
                        None => blamed,
                    });
                }
            }
        }
        // One of them must be possible at all: files that are there, bounds on metrics that there are.
        let first = self.edits(&self.points.at(0));
        let base = self.with(&[]).map_err(AppError::from).and_then(can_run);
        match base {
            Ok(()) => Ok(()),
            Err(error) => match self.template.with(&first).map(can_run) {
                Ok(Ok(())) => Ok(()),
                _ => Err(error),
            },
        }
    }

    /// Writes the plan, a run at a time, with paths as they are seen from a folder.
    pub(super) fn write(&self, plan: &Path, folder: &Path) -> Result<(), AppError> {
        let mut files = Files::new(folder);
        let first = self.template.with(&self.edits(&self.points.at(0)));
        let base = first.or_else(|_| self.with(&[]))?;
        let shared = files.of(&base, self.template.is_text())?;
        let keys: Vec<String> = (self.points.variables().iter())
            .map(|variable| variable.key.clone())
            .collect();
        let fixed = self.fixed.iter();
        let fixed = fixed.map(|edit| (edit.key().to_owned(), edit.shown()));
        let work = Shared {
            scenario: led_to(self.template.path(), folder),
            fixed: fixed.collect(),
            keys,
        };
        let head = Head {
            plan: KIND.to_owned(),
            program: Head::this_program(),
            tasks: self.points.count(),
            work: serde_json::to_value(&work)?,
            files: shared.clone(),
        };
        // A number leads to no other file.
        let is_text = |place: &usize| {
            let values = self.points.to_check(*place);
            values.iter().any(|value| value.parse::<f64>().is_err())
        };
        let texts: Vec<usize> = (0..self.points.variables().len()).filter(is_text).collect();
        let mut known: BTreeMap<Vec<String>, Vec<SourceFile>> = BTreeMap::new();
        let tasks = (0..self.points.count()).map(|run| {
            let values = self.points.at(run);
            let own = texts.iter().map(|place| values[*place].clone()).collect();
            let read = match known.get(&own) {
                Some(read) => read.clone(),
                None if texts.is_empty() => shared.clone(),
                None => {
                    let scenario = self.template.with(&self.edits(&values));
                    let read = scenario.map_or_else(
                        |_| Ok(shared.clone()),
                        |s| files.of(&s, self.template.is_text()),
                    )?;
                    known.entry(own).or_insert(read).clone()
                }
            };
            Ok::<_, AppError>(Task {
                id: name(&head, &work, &values, &read),
                after: None,
                work: serde_json::to_value(&values)?,
                files: (read.into_iter())
                    .filter(|file| !shared.contains(file))
                    .collect(),
            })
        });
        Plan::write(plan, &head, tasks)
    }
}

/// Name of a run: of the program, its files' content, and its values by key.
fn name(head: &Head, work: &Shared, values: &[String], files: &[SourceFile]) -> String {
    let fixed = (work.fixed.iter()).flat_map(|(key, value)| [key.as_str(), value.as_str()]);
    let own = work.keys.iter().zip(values);
    let own = own.flat_map(|(key, value)| [key.as_str(), value.as_str()]);
    let files = files.iter().map(|file| file.sha256.as_str());
    let first = [KIND, head.program.as_str()].into_iter();
    name_of(
        first
            .chain(files)
            .chain(["with"])
            .chain(fixed)
            .chain(["set"])
            .chain(own),
    )
}

/// Files that scenarios read, each hashed once.
pub(in super::super) struct Files {
    folder: PathBuf,
    known: BTreeMap<PathBuf, SourceFile>,
}

impl Files {
    /// Files as they are named from a folder.
    pub(in super::super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            known: BTreeMap::new(),
        }
    }

    /// All that a scenario reads, its own file first, where it stands in one; meshes of the arm as well.
    pub(in super::super) fn of(
        &mut self,
        scenario: &AnyScenario,
        is_text: bool,
    ) -> Result<Vec<SourceFile>, AppError> {
        let paths: Vec<PathBuf> = match scenario {
            AnyScenario::Cell(cell) => {
                let obstacles = &cell.collision.obstacles;
                let own = files_of_cell(
                    &cell.path,
                    &cell.arm,
                    &cell.device,
                    &cell.workpiece,
                    obstacles,
                );
                let meshes = crate::arm::mesh_files(&cell.arm.urdf, &arm_options(&cell.arm));
                let meshes = meshes.map_err(crate::cell::CellError::from)?;
                own.into_iter().cloned().chain(meshes).collect()
            }
            AnyScenario::Bench(bench) => vec![bench.path.clone(), bench.device.model.clone()],
        };
        // A scenario that stands in no file comes first.
        let existing = paths[usize::from(is_text)..].iter();
        existing.map(|path| self.one(path)).collect()
    }

    /// One file.
    pub(in super::super) fn one(&mut self, path: &Path) -> Result<SourceFile, AppError> {
        if let Some(known) = self.known.get(path) {
            return Ok(known.clone());
        }
        let file = SourceFile::of(&led_to(path, &self.folder), path)?;
        self.known.insert(path.to_owned(), file.clone());
        Ok(file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run is named by all that it depends on: two sweeps that differ in what `--with` fixes, and in nothing else, share no run.
    #[test]
    fn a_run_of_another_program_file_fixed_value_or_own_value_has_another_name() {
        let head = |program: &str| Head {
            plan: KIND.to_owned(),
            program: program.to_owned(),
            tasks: 1,
            work: serde_json::Value::Null,
            files: Vec::new(),
        };
        let shared = |fixed: &[(&str, &str)], key: &str| Shared {
            scenario: "cell.toml".to_owned(),
            fixed: (fixed.iter())
                .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
                .collect(),
            keys: vec![key.to_owned()],
        };
        let file = |bytes: &[u8]| SourceFile::holding("cell.toml", bytes);
        let plain = shared(&[("external_leak", "0.5")], "process.force_n");
        let own = [file(b"a")];
        let of = |program, shared: &Shared, value: &str, files: &[SourceFile]| {
            name(&head(program), shared, &[value.to_owned()], files)
        };
        let names = [
            of("idc 1", &plain, "60", &own),
            of("idc 2", &plain, "60", &own),
            of("idc 1", &plain, "61", &own),
            of("idc 1", &plain, "60", &[file(b"b")]),
            of("idc 1", &plain, "60", &[file(b"a"), file(b"a")]),
            of("idc 1", &shared(&[], "process.force_n"), "60", &own),
            of(
                "idc 1",
                &shared(&[("external_leak", "0.6")], "process.force_n"),
                "60",
                &own,
            ),
            of(
                "idc 1",
                &shared(&[("stick_slip", "0.5")], "process.force_n"),
                "60",
                &own,
            ),
            of(
                "idc 1",
                &shared(&[("external_leak", "0.5")], "process.feed"),
                "60",
                &own,
            ),
            // A fixed key is not a varied one.
            of(
                "idc 1",
                &shared(&[("process.force_n", "60")], "external_leak"),
                "0.5",
                &own,
            ),
        ];
        for (place, one) in names.iter().enumerate() {
            let twin = names[place + 1..].iter().position(|other| other == one);
            assert_eq!(twin, None, "name {place}");
        }
        assert_eq!(names[0], of("idc 1", &plain, "60", &own));
    }
}
