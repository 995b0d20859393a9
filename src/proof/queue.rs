//! Many pieces of work, some at a time, each with processors of its own: in a shared pool one would wait for parts of another.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Does `count` pieces of work, `jobs` at a time; none where a piece is a fault of the program.
pub fn all<T: Send>(count: usize, jobs: usize, work: impl Fn(usize) -> T + Sync) -> Vec<Option<T>> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = jobs.clamp(1, count.max(1));
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Option<T>>> = Mutex::new((0..count).map(|_| None).collect());
    let serve = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                break;
            }
            let result = catch_unwind(AssertUnwindSafe(|| work(index))).ok();
            done.lock().unwrap_or_else(PoisonError::into_inner)[index] = result;
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                let threads = (processors / jobs).max(1);
                match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                    Ok(pool) => pool.install(serve),
                    Err(_) => serve(),
                }
            });
        }
    });
    done.into_inner().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_is_done_in_order_and_a_fault_is_one_alone() {
        let done = super::all(9, 3, |i| {
            assert!(i != 4, "a fault on purpose");
            i * i
        });
        let expected = [
            Some(0),
            Some(1),
            Some(4),
            Some(9),
            None,
            Some(25),
            Some(36),
            Some(49),
            Some(64),
        ];
        assert_eq!(done, expected);
    }
}
