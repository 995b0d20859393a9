//! The name of the sources: a hash of all files of `src` and of Cargo.lock, so that two builds of one version can be kept apart.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Digits of the name: of 64 bits.
const DIGITS: usize = 16;

fn main() {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    println!("cargo:rerun-if-changed=build.rs");
    let mut files = Vec::new();
    note_files(&root.join("src"), "src", &mut files);
    files.push(("Cargo.lock".to_owned(), root.join("Cargo.lock")));
    files.sort();
    let mut hash = Sha256::new();
    for (name, path) in &files {
        // A crate can come without its lock file.
        let content = std::fs::read(path).unwrap_or_default();
        hash.update((name.len() as u64).to_le_bytes());
        hash.update(name);
        hash.update((content.len() as u64).to_le_bytes());
        hash.update(&content);
    }
    for watched in ["src", "Cargo.lock"].map(|name| root.join(name)) {
        // One that is not there would be taken for changed each time.
        if watched.exists() {
            println!("cargo:rerun-if-changed={}", watched.display());
        }
    }
    let name: String = hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    println!("cargo:rustc-env=IDC_SOURCES={}", &name[..DIGITS]);
}

/// Files below a folder, each by its path with slashes, whatever the system's are.
fn note_files(folder: &Path, name: &str, files: &mut Vec<(String, PathBuf)>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let file = entry.file_name().to_string_lossy().into_owned();
        if file.starts_with('.') {
            // An editor's.
            continue;
        }
        let own = format!("{name}/{file}");
        match entry.path().is_dir() {
            true => note_files(&entry.path(), &own, files),
            false => files.push((own, entry.path())),
        }
    }
}
