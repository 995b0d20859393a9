//! Fuzz targets of the readers of foreign files: the doors that the ordinary tests open too, counted.

#[path = "../../tests/readers/doors.rs"]
mod doors;
mod mutate;
#[path = "../../tests/readers/zip.rs"]
mod zip;

use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use libfuzzer_sys::Corpus;

use doors::{Door, Reached, Room, door};

/// Inputs between two lines on how far they came.
const EVERY: u64 = 20_000;

static OPENED: OnceLock<(&Door, Room)> = OnceLock::new();
static INPUTS: AtomicU64 = AtomicU64::new(0);
static PAST_HEADER: AtomicU64 = AtomicU64::new(0);
static READ: AtomicU64 = AtomicU64::new(0);

/// Opens a door.
pub fn begin(name: &'static str) {
    // A panic that a reader catches and reports is an answer; one that comes out of it ends the process.
    std::panic::set_hook(Box::new(|panic| eprintln!("{panic}")));
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    OPENED.get_or_init(|| (door(name), Room::new(&project)));
}

/// Lets an input in. One that is refused at its header is tried, and nothing is bred from it.
pub fn one(bytes: &[u8]) -> Corpus {
    let (door, room) = OPENED.get().expect("it was opened");
    let reached = door.open(room, bytes);
    let past = PAST_HEADER.fetch_add(u64::from(reached > Reached::Header), Ordering::Relaxed);
    let read = READ.fetch_add(u64::from(reached == Reached::End), Ordering::Relaxed);
    let before = INPUTS.fetch_add(1, Ordering::Relaxed);
    if before > 0 && before.is_multiple_of(EVERY) {
        let percent = |count: u64| 100 * count / before;
        eprintln!(
            "{}: {before} inputs, {} % past the header, {} % read",
            door.name,
            percent(past),
            percent(read)
        );
    }
    match reached {
        Reached::Header => Corpus::Reject,
        Reached::Content | Reached::End => Corpus::Keep,
    }
}

/// Changes an input: of texts often by words and lines, so that more than a few are still of their format.
pub fn mutated(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    let mut random = mutate::Random::new(seed);
    let is_text = std::str::from_utf8(&data[..size]).is_ok();
    if !is_text || random.below(6) == 0 {
        return libfuzzer_sys::fuzzer_mutate(data, size, max_size);
    }
    let mut text = data[..size].to_vec();
    for _ in 0..=random.below(2) {
        text = mutate::changed(&text, &mut random);
    }
    let length = text.len().min(max_size);
    data[..length].copy_from_slice(&text[..length]);
    length
}
