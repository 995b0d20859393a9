//! A line of a program as words, numbers, texts and marks.

use super::error::ProgramError;

/// A part of a line.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    /// Letters, digits and underscores behind a letter, `$` or `#`.
    Word(String),
    /// A number without a sign.
    Number(f64),
    /// What stands in quotes.
    Text(String),
    /// Any other character.
    Mark(char),
}

/// A line that is read from left to right.
#[derive(Debug, Clone)]
pub(super) struct Line {
    number: usize,
    tokens: Vec<Token>,
    at: usize,
}

impl Line {
    /// The parts of a line, counted from 1, up to a mark that starts a comment outside quotes.
    pub(super) fn new(
        number: usize,
        text: &str,
        comment: Option<char>,
    ) -> Result<Self, ProgramError> {
        let mut tokens = Vec::new();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            if comment == Some(first) {
                break;
            }
            let (token, length) = match first {
                c if c.is_whitespace() => (None, c.len_utf8()),
                c if c.is_ascii_digit() => number_at(rest),
                '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => number_at(rest),
                c if c.is_alphabetic() || matches!(c, '_' | '$' | '#') => {
                    let part = |c: char| c.is_alphanumeric() || c == '_';
                    let length = rest[first.len_utf8()..].find(|c| !part(c));
                    let length = length.map_or(rest.len(), |found| found + first.len_utf8());
                    (Some(Token::Word(rest[..length].to_owned())), length)
                }
                '"' | '\'' => match rest[1..].find(first) {
                    Some(end) => (Some(Token::Text(rest[1..=end].to_owned())), end + 2),
                    None => {
                        return Err(ProgramError::Line {
                            line: number,
                            found: "a quote that does not end".to_owned(),
                            expected: first.to_string(),
                        });
                    }
                },
                other => (Some(Token::Mark(other)), other.len_utf8()),
            };
            tokens.extend(token);
            rest = &rest[length..];
        }
        Ok(Self {
            number,
            tokens,
            at: 0,
        })
    }

    /// Whether nothing is left.
    pub(super) fn is_done(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// The next part.
    pub(super) fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    /// Takes the next part.
    pub(super) fn take(&mut self) -> Option<Token> {
        let token = self.tokens.get(self.at).cloned();
        self.at += 1;
        token
    }

    /// The refusal of what comes next.
    pub(super) fn refuse(&self, expected: impl Into<String>) -> ProgramError {
        let found = match self.peek() {
            None => "the end of the line".to_owned(),
            Some(Token::Word(word)) => format!("`{word}`"),
            Some(Token::Number(number)) => format!("`{number}`"),
            Some(Token::Text(text)) => format!("\"{text}\""),
            Some(Token::Mark(mark)) => format!("`{mark}`"),
        };
        ProgramError::Line {
            line: self.number,
            found,
            expected: expected.into(),
        }
    }

    /// Whether a mark is next; then it is taken.
    pub(super) fn takes(&mut self, mark: char) -> bool {
        let is_next = self.peek() == Some(&Token::Mark(mark));
        self.at += usize::from(is_next);
        is_next
    }

    /// Takes a mark that must be there.
    pub(super) fn mark(&mut self, mark: char) -> Result<(), ProgramError> {
        match self.takes(mark) {
            true => Ok(()),
            false => Err(self.refuse(format!("`{mark}`"))),
        }
    }

    /// Whether a word is next, whatever its case; then it is taken.
    pub(super) fn takes_word(&mut self, word: &str) -> bool {
        let is_next =
            matches!(self.peek(), Some(Token::Word(next)) if next.eq_ignore_ascii_case(word));
        self.at += usize::from(is_next);
        is_next
    }

    /// Takes a word that must be there.
    pub(super) fn word(&mut self, expected: &str) -> Result<String, ProgramError> {
        match self.peek() {
            Some(Token::Word(word)) => {
                let word = word.clone();
                self.at += 1;
                Ok(word)
            }
            _ => Err(self.refuse(expected)),
        }
    }

    /// Takes a text in quotes that must be there.
    pub(super) fn text(&mut self, expected: &str) -> Result<String, ProgramError> {
        match self.peek() {
            Some(Token::Text(text)) => {
                let text = text.clone();
                self.at += 1;
                Ok(text)
            }
            _ => Err(self.refuse(expected)),
        }
    }

    /// Takes a number with its signs.
    pub(super) fn number(&mut self) -> Result<f64, ProgramError> {
        let sign = match (self.takes('-'), self.takes('+')) {
            (true, false) => -1.0,
            (false, _) => 1.0,
            (true, true) => return Err(self.refuse("a number")),
        };
        match self.peek() {
            Some(Token::Number(number)) if number.is_finite() => {
                let value = sign * number;
                self.at += 1;
                Ok(value)
            }
            _ => Err(self.refuse("a number")),
        }
    }

    /// Takes a number that is at least 0, or more than 0.
    pub(super) fn positive(&mut self, or_zero: bool) -> Result<f64, ProgramError> {
        let before = self.clone();
        let value = self.number()?;
        match value > 0.0 || or_zero && value == 0.0 {
            true => Ok(value),
            false => Err(before.refuse("a number greater than 0")),
        }
    }

    /// Takes a whole number.
    pub(super) fn whole(&mut self) -> Result<i32, ProgramError> {
        let before = self.clone();
        let value = self.number()?;
        match value.fract() == 0.0 && value.abs() < 1e9 {
            true => Ok(value as i32),
            false => Err(before.refuse("a whole number")),
        }
    }

    /// Takes numbers with commas between them, within brackets.
    pub(super) fn numbers<const N: usize>(&mut self) -> Result<[f64; N], ProgramError> {
        let mut found = [0.0; N];
        self.mark('[')?;
        for (index, value) in found.iter_mut().enumerate() {
            if index > 0 {
                self.mark(',')?;
            }
            *value = self.number()?;
        }
        self.mark(']')?;
        Ok(found)
    }

    /// Nothing may be left.
    pub(super) fn end(&self) -> Result<(), ProgramError> {
        match self.is_done() {
            true => Ok(()),
            false => Err(self.refuse("nothing more on the line")),
        }
    }
}

/// The number with which a text starts, and its length.
fn number_at(text: &str) -> (Option<Token>, usize) {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let behind = digits(end + 1 + sign);
        if behind > end + 1 + sign {
            end = behind;
        }
    }
    let value = text[..end].parse().unwrap_or(f64::NAN);
    (Some(Token::Number(value)), end)
}
