//! What a page may do, for the browser: nothing over a network, and of scripts only those that this program wrote, each by its hash, so that one that comes
//! in with a name or a picture does not run.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest as _, Sha256};

/// The policy of a page with these scripts.
pub(super) fn of(scripts: &[&str]) -> String {
    let hashes = scripts.iter().map(|script| {
        let hash = STANDARD.encode(Sha256::digest(script));
        format!("'sha256-{hash}'")
    });
    let hashes: Vec<String> = hashes.collect();
    // Bars and charts set widths and colours of their own.
    format!(
        "default-src 'none'; script-src {}; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'",
        hashes.join(" ")
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_script_is_allowed_by_its_hash_alone() {
        // As `printf %s 'alert(1)' | openssl dgst -sha256 -binary | base64` has it.
        let policy = super::of(&["alert(1)"]);
        assert!(
            policy.contains("script-src 'sha256-bhHHL3z2vDgxUt0W3dWQOrprscmda2Y5pLsLg4GF+pI=';")
        );
        assert!(!policy.contains("script-src 'unsafe") && !policy.contains("unsafe-hashes"));
    }
}
