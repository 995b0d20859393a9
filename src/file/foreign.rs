//! Readers of other crates: a file that makes one panic is damaged, and said to be.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

/// Letters of a panic's message that are shown, at most.
const SHOWN: usize = 200;

thread_local! {
    /// Whether this thread is within a reader whose panics are caught.
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Calls a reader of another crate; nothing is printed where it panics.
///
/// # Errors
/// It panicked, with its message in words of a refusal.
pub fn guarded<T>(read: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                usual(panic);
            }
        }));
    });
    let outer = IS_GUARDED.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(read));
    IS_GUARDED.set(outer);
    outcome.map_err(|panic| {
        format!(
            "it is damaged: its reader met what should not occur ({})",
            message(panic.as_ref())
        )
    })
}

/// The first line of a panic's message.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let line = text.and_then(|text| text.lines().next());
    line.unwrap_or("without a message")
        .chars()
        .take(SHOWN)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_refusal_with_its_message() {
        assert_eq!(guarded(|| 7), Ok(7));
        let empty: Vec<u8> = Vec::new();
        let said = guarded(|| empty[empty.len()]).unwrap_err();
        assert!(
            said.contains("damaged") && said.contains("index out of bounds"),
            "{said}"
        );
        assert!(!IS_GUARDED.get());
    }
}
