//! The sources as the tests of their structure read them: words and signs with their lines, without comments, strings and unit tests.

use std::collections::BTreeMap;
use std::path::Path;

use crate::common::project;

/// A word or a sign (`::` is one), and its line.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// The text.
    pub text: String,
    /// From 1 [-].
    pub line: usize,
}

/// Files of the crate by their path below `src`, with `/` between its parts, as tokens.
pub type Sources = BTreeMap<String, Vec<Token>>;

/// All of `src` but what is compiled for tests only.
pub fn sources() -> Sources {
    fn read(folder: &Path, name: &str, found: &mut Sources) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let inside = format!("{name}{}", path.file_name().unwrap().to_str().unwrap());
            if path.is_dir() {
                read(&path, &format!("{inside}/"), found);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                found.insert(inside, product(&tokens(&text)));
            }
        }
    }
    let mut found = Sources::new();
    read(&project("src"), "", &mut found);
    assert!(found.len() > 80, "only {} files found", found.len());
    found
}

/// Whether a file below `src` holds unit tests alone.
pub fn is_of_tests(path: &Path) -> bool {
    path.iter().any(|part| {
        let part = part.to_string_lossy();
        part == "tests" || part == "tests.rs" || part.starts_with("test_")
    })
}

/// Words and signs of a text.
pub fn tokens(text: &str) -> Vec<Token> {
    let is_word = |letter: &char| letter.is_alphanumeric() || *letter == '_';
    let letters: Vec<char> = text.chars().collect();
    let (mut found, mut at, mut line) = (Vec::new(), 0, 1);
    while at < letters.len() {
        let rest = &letters[at..];
        let after = |word: &str| {
            let same = word.chars().eq(rest.iter().copied().take(word.len()));
            same.then_some(word.len())
        };
        let until = |from: usize, end: &str| {
            let end: Vec<char> = end.chars().collect();
            let place = rest[from..].windows(end.len()).position(|it| it == end);
            place.map_or(rest.len(), |place| from + place + end.len())
        };
        let hashes = rest.iter().skip(1).take_while(|it| **it == '#').count();
        let length = if after("//").is_some() {
            until(0, "\n") - 1
        } else if after("/*").is_some() {
            until(2, "*/")
        } else if rest[0] == 'r' && rest.get(1 + hashes) == Some(&'"') {
            until(2 + hashes, &format!("\"{}", "#".repeat(hashes)))
        } else if rest[0] == '"' {
            let mut end = 1;
            while end < rest.len() && rest[end] != '"' {
                end += 1 + usize::from(rest[end] == '\\');
            }
            end + 1
        } else if rest[0] == '\'' && rest.get(1) == Some(&'\\') {
            until(3, "'")
        } else if rest[0] == '\'' && rest.get(2) == Some(&'\'') {
            3
        } else {
            let mark = usize::from(rest[0] == '\'');
            let word = mark + rest[mark..].iter().take_while(|it| is_word(it)).count();
            let length = after("::").unwrap_or(word.max(1));
            if !rest[0].is_whitespace() {
                let text = rest[..length].iter().collect();
                found.push(Token { text, line });
            }
            length
        };
        let length = length.min(rest.len()).max(1);
        line += rest[..length].iter().filter(|it| **it == '\n').count();
        at += length;
    }
    found
}

/// The place behind the bracket that closes the one at `from`.
pub fn behind(tokens: &[Token], from: usize) -> usize {
    let mut depth = 0;
    for (place, token) in tokens.iter().enumerate().skip(from) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => (),
        }
        if depth == 0 {
            return place + 1;
        }
    }
    tokens.len()
}

/// Without items under `#[cfg(test)]`.
pub fn product(tokens: &[Token]) -> Vec<Token> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let (mut kept, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        let marked = tokens[at..].iter().map(|token| token.text.as_str());
        if !marked.take(mark.len()).eq(mark) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        at += mark.len();
        while at < tokens.len() && tokens[at].text != ";" && tokens[at].text != "{" {
            at = behind(tokens, at);
        }
        at = behind(tokens, at);
    }
    kept
}

#[test]
fn words_are_read_without_comments_strings_and_unit_tests() {
    let words = |text: &str| -> Vec<String> {
        let product = product(&tokens(text));
        product.into_iter().map(|token| token.text).collect()
    };
    assert_eq!(words("a::b // c::d\n/* e */ f"), ["a", "::", "b", "f"]);
    assert_eq!(words(r##"r#"a " b"# c "d \" e" f"##), ["c", "f"]);
    assert_eq!(words("'a' '\\'' b \"\\\\\" c"), ["b", "c"]);
    assert_eq!(words("&'a b"), ["&", "'a", "b"]);
    assert_eq!(words("#[cfg(test)]\n#[x] mod t { a {} }\nb"), ["b"]);
    assert_eq!(words("#[cfg(test)]\nmod tests;\nb"), ["b"]);
    assert_eq!(tokens("\"\n\"\n// a\n\nb")[0].line, 5);
}
