#![no_main]
//! The fuzz target of the reader that it is named after: Cargo.toml lists one for each.

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};

fuzz_target!(init: idc_cell_fuzz::begin(env!("CARGO_BIN_NAME")), |bytes: &[u8]| -> Corpus {
    idc_cell_fuzz::one(bytes)
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    idc_cell_fuzz::mutated(data, size, max_size, seed)
});
