//! A sweep for a caller in the same process: its table stays in memory, and files are written where a folder is asked for.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use super::super::error::AppError;
use super::super::files::{OutputFolder, OverwritePolicy, REPORT};
use super::super::run::{Numbers, edits_of};
use super::page;
use super::planned::Files;
use super::table::{RUNS, SWEEP, add, empty, layout};
use super::work::numbers_of;
use crate::document::html;
use crate::recording::atomic::write_text;
use crate::recording::long_column::LongColumn;
use crate::recording::long_table::write_long;
use crate::scenario::ScenarioTemplate;
use crate::tasks::Head;
use crate::vary::{Points, Sampling, Sweep, Swept, Values, Variable};

/// Columns before the keys, and whether they hold names.
const OWN: [(&str, bool); 3] = [("run", false), ("code", false), ("reason", true)];
/// Between two calls of whoever observes the progress.
const INTERVAL: Duration = Duration::from_millis(50);

/// What is asked of a sweep.
#[derive(Debug, Clone)]
pub struct SweepRequest {
    /// What varies.
    pub variables: Vec<Variable>,
    /// Effects that all runs have, each as `--with` takes it.
    pub effects: Vec<String>,
    /// How the points lie.
    pub sampling: Sampling,
    /// Seed of what is drawn.
    pub seed: u64,
    /// Runs at a time; as many as there are processors if none is given.
    pub jobs: Option<usize>,
    /// Folder for the files, and whether new ones take the place of old ones.
    pub out: Option<(PathBuf, bool)>,
}

/// A sweep that was run.
pub struct SweepOfRuns {
    columns: Vec<(String, LongColumn)>,
    swept: Swept,
}

/// Runs a scenario with many other values, as `idc vary` does. `progress` is given runs done and in all.
///
/// # Errors
/// A key or a value that cannot be, or a folder that cannot be written.
pub fn vary_scenario(
    template: &Arc<ScenarioTemplate>,
    request: &SweepRequest,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<SweepOfRuns, AppError> {
    let fixed = edits_of(&request.effects, template)?;
    let is_count = |key: &str, whole| template.is_count(key, whole, &fixed);
    let variables = request.variables.iter().cloned();
    let variables = variables
        .map(|variable| variable.of_key(is_count))
        .collect();
    let sweep = Sweep {
        points: Points::new(variables, request.sampling, request.seed)?,
        template: ScenarioTemplate::clone(template),
        fixed,
    };
    sweep.check()?;
    let folder = request.out.as_ref().map(|(out, force)| {
        OutputFolder::prepare(out, &[RUNS, SWEEP, REPORT], OverwritePolicy::of(*force))
    });
    let folder = folder.transpose()?;
    let jobs = request.jobs.unwrap_or_else(rayon::current_num_threads);
    let done = all(&sweep, jobs, progress);
    let swept = SweepOfRuns::of(&sweep, done, folder.as_ref().map(OutputFolder::path))?;
    if let Some(folder) = folder {
        swept.write(&folder)?;
    }
    Ok(swept)
}

/// Says, once it is dropped, that no further run is to begin.
struct NoFurther<'a>(&'a AtomicBool);

impl Drop for NoFurther<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

/// Does all runs, so many at a time. Whoever observes the progress is called on this thread, and may unwind it.
fn all(sweep: &Sweep, jobs: usize, progress: &mut dyn FnMut(usize, usize)) -> Vec<Numbers> {
    let count = sweep.points.count();
    let numbers: Vec<OnceLock<Numbers>> = (0..count).map(|_| OnceLock::new()).collect();
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let _no_further = NoFurther(&stopped);
        let (sender, receiver) = channel();
        for _ in 0..jobs.clamp(1, count) {
            let (sender, next, stopped, numbers) = (sender.clone(), &next, &stopped, &numbers);
            scope.spawn(move || {
                while !stopped.load(Ordering::SeqCst) {
                    let run = next.fetch_add(1, Ordering::SeqCst);
                    let Some(slot) = numbers.get(run) else { break };
                    let edits = sweep.edits(&sweep.points.at(run));
                    // Each place is taken once.
                    drop(slot.set(numbers_of(&sweep.template, &edits)));
                    let _ = sender.send(());
                }
            });
        }
        drop(sender);
        let mut done = 0;
        loop {
            match receiver.recv_timeout(INTERVAL) {
                Ok(()) => done += 1,
                Err(RecvTimeoutError::Timeout) => (),
                Err(RecvTimeoutError::Disconnected) => break,
            }
            progress(done, count);
        }
    });
    let found = numbers.into_iter().filter_map(OnceLock::into_inner);
    found.collect()
}

impl SweepOfRuns {
    fn of(sweep: &Sweep, done: Vec<Numbers>, folder: Option<&Path>) -> Result<Self, AppError> {
        let variables = sweep.points.variables();
        let is_text = |place: usize| {
            let values = sweep.points.to_check(place);
            values.iter().any(|value| value.parse::<f64>().is_err())
        };
        let keys = variables.iter().enumerate();
        let keys = keys.map(|(place, variable)| (variable.key.as_str(), is_text(place)));
        let layout = layout(&OWN, keys, sweep.template.is_bench());
        let mut columns = empty(&layout);
        for (run, numbers) in done.into_iter().enumerate() {
            let own = [
                (run + 1).to_string(),
                numbers.code.to_string(),
                numbers.reason,
            ];
            let texts = own.into_iter().chain(sweep.points.at(run));
            add(&mut columns, texts, &numbers.metrics);
        }
        let names = layout.iter().map(|(name, _)| (*name).to_owned());
        let columns: Vec<(String, LongColumn)> = names.zip(columns).collect();
        let first = sweep.template.with(&sweep.edits(&sweep.points.at(0)));
        let scenario = first.or_else(|_| sweep.with(&[]))?;
        let here = std::env::current_dir().unwrap_or_default();
        let files = Files::new(folder.unwrap_or(&here)).of(&scenario, sweep.template.is_text())?;
        let program = Head::this_program();
        let swept = Swept::of(sweep, (&program, &files), &|wanted| {
            Ok(chosen(&columns, wanted))
        })?;
        Ok(Self { columns, swept })
    }

    /// A row for each run: its number, exit code and reason, values and numbers.
    pub fn columns(&self) -> &[(String, LongColumn)] {
        &self.columns
    }

    /// What vary.json holds.
    pub fn swept(&self) -> &Swept {
        &self.swept
    }

    /// Its page, with all charts.
    ///
    /// # Errors
    /// None of a table in memory.
    pub fn page(&self) -> Result<String, AppError> {
        let read = |wanted: &[&str]| Ok(chosen(&self.columns, wanted));
        Ok(html(&page::document(&self.swept, &read)?))
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let names = [RUNS, SWEEP, REPORT];
        folder.write_with(&names, |unfinished| {
            write_long(&unfinished.join(RUNS), &self.columns)?;
            write_text(&unfinished.join(REPORT), &self.page()?)?;
            let document = serde_json::to_string_pretty(&self.swept)?;
            write_text(&unfinished.join(SWEEP), &document)?;
            Ok(names.to_vec())
        })?;
        Ok(())
    }
}

fn chosen(columns: &[(String, LongColumn)], wanted: &[&str]) -> BTreeMap<String, LongColumn> {
    let own = columns
        .iter()
        .filter(|(name, _)| wanted.contains(&name.as_str()));
    own.cloned().collect()
}

/// Any number between two, in a sample; between whole ones each, of a key that is a count.
#[must_use]
pub fn between(low: f64, high: f64) -> Values {
    match low.fract() == 0.0 && high.fract() == 0.0 {
        true => Values::Whole([low as i64, high as i64]),
        false => Values::Between([low, high]),
    }
}
