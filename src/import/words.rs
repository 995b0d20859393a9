//! Words that stand for on and off in logs, language by language.

/// Words for 1, and words for 0.
struct Pair {
    on: &'static str,
    off: &'static str,
}

const fn pair(on: &'static str, off: &'static str) -> Pair {
    Pair { on, off }
}

/// Pairs of words: plain ones, then those of a valve, open and extending being 1.
#[rustfmt::skip] // A table: a language a line.
const PAIRS: &[Pair] = &[
    // English.
    pair("true", "false"), pair("on", "off"), pair("yes", "no"), pair("high", "low"), pair("active", "inactive"), pair("enabled", "disabled"),
    pair("open", "closed"), pair("open", "close"), pair("opened", "closed"), pair("extend", "retract"), pair("extended", "retracted"), pair("set", "reset"),
    // German.
    pair("wahr", "falsch"), pair("ein", "aus"), pair("an", "aus"), pair("ja", "nein"), pair("aktiv", "inaktiv"), pair("offen", "geschlossen"),
    pair("auf", "zu"), pair("ausfahren", "einfahren"), pair("ausgefahren", "eingefahren"),
    // French.
    pair("vrai", "faux"), pair("oui", "non"), pair("marche", "arrêt"), pair("marche", "arret"), pair("ouvert", "fermé"), pair("ouvert", "ferme"),
    pair("ouverte", "fermée"), pair("sortie", "rentrée"),
    // Italian.
    pair("vero", "falso"), pair("sì", "no"), pair("si", "no"), pair("acceso", "spento"), pair("aperto", "chiuso"), pair("aperta", "chiusa"),
    // Spanish.
    pair("verdadero", "falso"), pair("sí", "no"), pair("encendido", "apagado"), pair("abierto", "cerrado"), pair("abierta", "cerrada"),
    // Controllers: `BOOL#1`, single letters.
    pair("bool#true", "bool#false"), pair("bool#1", "bool#0"), pair("16#1", "16#0"), pair("t", "f"), pair("y", "n"), pair("j", "n"), pair("h", "l"),
];

/// 1 or 0 of a word, whatever its case.
#[must_use]
pub fn of_word(word: &str) -> Option<f64> {
    let word = word.trim().trim_matches('"').to_lowercase();
    PAIRS.iter().find_map(|pair| {
        if pair.on == word {
            return Some(1.0);
        }
        (pair.off == word).then_some(0.0)
    })
}

/// Words that a message names as examples.
pub const EXAMPLES: &str = "TRUE/FALSE, on/off, WAHR/FALSCH, EIN/AUS, ja/nein, open/closed";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_is_both_on_and_off() {
        for pair in PAIRS {
            assert_eq!(of_word(&pair.on.to_uppercase()), Some(1.0), "{}", pair.on);
            assert_eq!(of_word(pair.off), Some(0.0), "{}", pair.off);
        }
        assert_eq!(of_word("perhaps"), None);
    }
}
