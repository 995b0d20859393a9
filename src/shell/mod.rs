//! Paths as a shell takes them, for commands that are suggested: what is printed can be pasted as it stands.

use std::path::Path;

/// A path as one word of a POSIX shell's command, quoted where it has to be; one that begins as an option is led to from its folder.
#[must_use]
pub fn word(path: &Path) -> String {
    let text = path.display().to_string();
    let text = match text.starts_with('-') {
        true => format!("./{text}"),
        false => text,
    };
    match shlex::try_quote(&text) {
        Ok(quoted) => quoted.into_owned(),
        // No path holds a zero byte.
        Err(_) => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_read_back_as_the_path() {
        for path in [
            "scenarios/plate_edge.toml",
            "my cell/it's \"new\".toml",
            "a;rm -rf $HOME/`x`/*.toml",
            "ein Teil/ä ö.toml",
            "",
        ] {
            let words = shlex::split(&format!("idc run {}", word(Path::new(path)))).unwrap();
            assert_eq!(words, ["idc", "run", path]);
        }
        assert_eq!(word(Path::new("a/b-c_1.toml")), "a/b-c_1.toml");
        assert_eq!(word(Path::new("-x.toml")), "./-x.toml");
    }
}
