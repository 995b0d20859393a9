//! Threads of this program.

use std::collections::{HashMap, HashSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::TaskError;
use super::engine::TaskMessage;
use super::plan::{Plan, Task};
use super::store::Store;

/// Tasks that are waited for, and those that can be begun.
struct Queue {
    plan: Plan,
    /// Those whose predecessor is not done, by its name.
    waiting: HashMap<String, Vec<Task>>,
    ready: VecDeque<Task>,
    running: usize,
    done: usize,
    failed: Vec<String>,
    /// Names of those that failed: what begins with one fails too, also where it is read later.
    lost: HashSet<String>,
    error: Option<TaskError>,
}

impl Queue {
    /// The next task that is not done and can be begun; none where there is none now.
    fn next(&mut self, store: &Store) -> Option<Task> {
        loop {
            if self.error.is_some() {
                return None;
            }
            if let Some(task) = self.ready.pop_front() {
                return Some(task);
            }
            match self.plan.next()? {
                Err(error) => self.error = Some(error),
                Ok(task) if store.exists(&task.id) => self.done += 1,
                Ok(task) => match &task.after {
                    Some(after) if self.lost.contains(after) => {
                        let reason = format!("the task that it begins with failed: {after}");
                        self.fail(&task.id, &reason);
                    }
                    Some(after) if !store.exists(after) => {
                        self.waiting.entry(after.clone()).or_default().push(task);
                    }
                    _ => return Some(task),
                },
            }
        }
    }

    /// Tasks that wait for one that failed fail as well.
    fn fail(&mut self, id: &str, reason: &str) {
        self.failed.push(reason.to_owned());
        self.lost.insert(id.to_owned());
        for task in self.waiting.remove(id).unwrap_or_default() {
            self.fail(&task.id, reason);
        }
    }
}

/// Does a plan's tasks that do not stand, so many at a time, each by `work`; they are read as they are begun, so that memory does not grow with their number.
/// What stops one task stops it alone; a disk that is full stops all.
///
/// # Errors
/// The plan's, the disk's, or [`TaskError::Failed`] once all others are done.
pub fn local(
    plan: Plan,
    store: &Store,
    jobs: usize,
    work: &(dyn Fn(&Task) -> Result<(), TaskError> + Sync),
    report: &(dyn Fn(TaskMessage) + Sync),
) -> Result<(), TaskError> {
    let of = plan.head.tasks;
    let queue = Mutex::new(Queue {
        plan,
        waiting: HashMap::new(),
        ready: VecDeque::new(),
        running: 0,
        done: 0,
        failed: Vec::new(),
        lost: HashSet::new(),
        error: None,
    });
    let changed = Condvar::new();
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, of.max(1)) {
            scope.spawn(|| worker(&queue, &changed, store, work, report));
        }
    });
    let queue = queue.into_inner().unwrap_or_else(PoisonError::into_inner);
    match (queue.error, queue.failed.first()) {
        (Some(error), _) => Err(error),
        (None, Some(first)) => Err(TaskError::Failed {
            failed: queue.failed.len(),
            of,
            first: first.clone(),
        }),
        (None, None) => Ok(()),
    }
}

fn worker(
    queue: &Mutex<Queue>,
    changed: &Condvar,
    store: &Store,
    work: &(dyn Fn(&Task) -> Result<(), TaskError> + Sync),
    report: &(dyn Fn(TaskMessage) + Sync),
) {
    let lock = || -> MutexGuard<'_, Queue> { queue.lock().unwrap_or_else(PoisonError::into_inner) };
    let mut own = lock();
    loop {
        let before = own.done;
        let next = own.next(store);
        if own.done != before {
            report(TaskMessage::Done(own.done));
        }
        let Some(task) = next else {
            if own.running == 0 || own.error.is_some() {
                changed.notify_all();
                return;
            }
            own = changed.wait(own).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        own.running += 1;
        drop(own);
        let result = catch_unwind(AssertUnwindSafe(|| work(&task)));
        own = lock();
        own.running -= 1;
        match result {
            Ok(Ok(())) => {
                own.done += 1;
                let freed = own.waiting.remove(&task.id).unwrap_or_default();
                own.ready.extend(freed);
                report(TaskMessage::Done(own.done));
            }
            Ok(Err(error)) => own.error = Some(error),
            Err(_) => own.fail(
                &task.id,
                "a fault of the program, see above; please report it",
            ),
        }
        changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks::{Head, name_of};
    use serde_json::Value;

    fn plan(folder: &std::path::Path, chains: usize, length: usize) -> std::path::PathBuf {
        let path = folder.join("plan.jsonl");
        let head = Head {
            plan: "vary".to_owned(),
            program: Head::this_program(),
            tasks: chains * length,
            work: Value::Null,
            files: Vec::new(),
        };
        let tasks = (0..chains * length).map(|at| {
            let (step, chain) = (at / chains, at % chains);
            let name = |step: usize| name_of([format!("{chain} {step}").as_str()]);
            Ok::<_, TaskError>(Task {
                id: name(step),
                after: (step > 0).then(|| name(step - 1)),
                work: Value::from(at),
                files: Vec::new(),
            })
        });
        Plan::write(&path, &head, tasks).unwrap();
        path
    }

    #[test]
    fn each_task_is_done_once_after_the_one_that_it_begins_with() {
        let folder = tempfile::tempdir().unwrap();
        let path = plan(folder.path(), 3, 20);
        let store = Store::of(&path);
        store.make().unwrap();
        let begun = Mutex::new(Vec::new());
        let work = |task: &Task| {
            if let Some(after) = &task.after {
                assert!(store.exists(after));
            }
            begun.lock().unwrap().push(task.id.clone());
            Ok(store.put(&task.id, &[], "{}")?)
        };
        let most = Mutex::new(0);
        let report = |report: TaskMessage| {
            if let TaskMessage::Done(done) = report {
                let mut most = most.lock().unwrap();
                *most = done.max(*most);
            }
        };
        local(Plan::open(&path).unwrap(), &store, 4, &work, &report).unwrap();
        let mut ids = begun.lock().unwrap().clone();
        ids.sort();
        ids.dedup();
        assert_eq!((ids.len(), *most.lock().unwrap()), (60, 60));
        begun.lock().unwrap().clear();
        local(Plan::open(&path).unwrap(), &store, 4, &work, &report).unwrap();
        assert!(begun.lock().unwrap().is_empty());
    }

    #[test]
    fn a_task_that_panics_fails_with_those_after_it_and_the_others_are_done() {
        let folder = tempfile::tempdir().unwrap();
        let path = plan(folder.path(), 2, 5);
        let store = Store::of(&path);
        store.make().unwrap();
        let work = |task: &Task| {
            assert!(task.work != 4, "as it is meant to");
            Ok(store.put(&task.id, &[], "{}")?)
        };
        let error = local(Plan::open(&path).unwrap(), &store, 2, &work, &|_| ()).unwrap_err();
        // The third of the first chain, and the two after it.
        assert!(error.to_string().starts_with("3 of 10 tasks"), "{error}");
        let stand = std::fs::read_dir(store.path()).unwrap().count();
        assert_eq!(stand, 7);
    }
}
