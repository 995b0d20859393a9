//! Names of columns, language by language: what they say of the quantity. Words of four letters and more are found within a name, shorter ones at the start or
//! the end of its parts, single letters alone.

use crate::recording::Unit;

/// Quantity of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Thing {
    Time,
    Pressure,
    Stroke,
    Force,
    Acceleration,
    Valve,
    Surface,
    /// Something that no channel takes.
    Other,
}

/// Role that a name gives beside that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Commanded value.
    Set,
    /// Measured value.
    Actual,
    /// Another pressure than the regulator's.
    Elsewhere,
}

/// Words of each thing: English, German, French, Italian, Spanish. The first things win where a name holds words of two.
#[rustfmt::skip] // A table: a thing a line.
const THINGS: [(Thing, &[&str]); 8] = [
    (Thing::Surface, &["surface", "wall", "workpiece", "oberflaeche", "wand", "werkstueck", "bauteil", "piece", "paroi", "superficie", "parete", "pezzo", "pared", "pieza"]),
    (Thing::Acceleration, &["accel", "beschleunigung", "acc", "aceleracion", "imu"]),
    (Thing::Pressure, &["pressure", "druck", "pression", "pressione", "presion", "press"]),
    (Thing::Force, &["force", "kraft", "forza", "fuerza", "effort", "loadcell", "load", "lastzelle", "kmd", "fz", "wrench"]),
    (Thing::Valve, &["valve", "ventil", "solenoid", "vanne", "valvola", "valvula", "spool", "ausfahren", "extend"]),
    (Thing::Stroke, &["stroke", "position", "displacement", "travel", "weg", "hub", "pos", "trajectory", "corsa", "posizione", "carrera", "posicion", "recorrido", "deplacement", "slide", "schlitten"]),
    (Thing::Time, &["timestamp", "zeitstempel", "time", "zeit", "uhrzeit", "datum", "date", "temps", "heure", "tempo", "tiempo", "hora", "fecha", "xvalue", "elapsed", "stamp"]),
    (Thing::Other, &["temperatur", "durchfluss", "flow", "strom", "current", "spannung", "voltage", "drehmoment", "torque", "speed", "velocity", "geschwindigkeit", "vitesse", "velocita",
        "velocidad", "counter", "zaehler", "index", "status", "comment", "kommentar"]),
];

/// Letters that stand for things by themselves.
const LETTERS: [(&str, Thing); 8] = [
    ("t", Thing::Time),
    ("p", Thing::Pressure),
    ("x", Thing::Stroke),
    ("s", Thing::Stroke),
    ("f", Thing::Force),
    ("a", Thing::Acceleration),
    ("y", Thing::Valve),
    ("v", Thing::Valve),
];

#[rustfmt::skip] // A table: a role a line.
const ROLES: [(Role, &[&str]); 3] = [
    (Role::Elsewhere, &["supply", "versorgung", "netzdruck", "netz", "kammer", "chamber", "chambre", "camera", "camara", "tank", "vorsteuer", "alimentation", "alimentazione"]),
    (Role::Set, &["set", "soll", "setpoint", "command", "cmd", "ref", "desired", "target", "vorgabe", "demand", "consigne", "consigna", "comando", "riferimento", "sp", "w"]),
    (Role::Actual, &["act", "actual", "ist", "meas", "measured", "gemessen", "mess", "mesure", "misurat", "medid", "feedback", "fb", "out", "outlet"]),
];

/// Content of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Said {
    /// The thing, if it says one, and the word that does.
    pub thing: Option<(Thing, &'static str)>,
    /// Whether that is but a letter.
    pub by_letter: bool,
    /// The roles, each with its word.
    pub roles: Vec<(Role, &'static str)>,
    /// Whether it is of an axis across that of the tool.
    pub across: bool,
}

impl Said {
    pub fn has(&self, role: Role) -> bool {
        self.roles.iter().any(|(own, _)| *own == role)
    }
}

/// Content of a name, its unit apart.
pub(super) fn said(name: &str) -> Said {
    let parts = parts(name);
    let whole = parts.concat();
    let holds = |word: &&'static &'static str| match word.len() {
        1 => parts.iter().any(|part| part == *word),
        2 | 3 => parts
            .iter()
            .any(|part| part.starts_with(**word) || (part.ends_with(**word) && word.len() == 3)),
        _ => whole.contains(**word),
    };
    let thing = THINGS
        .iter()
        .find_map(|(thing, words)| Some((*thing, *words.iter().find(holds)?)));
    let letter = || {
        let all = LETTERS.iter();
        let mut fitting = all.filter(|(letter, _)| parts.iter().any(|part| part == letter));
        fitting.next().map(|(letter, thing)| (*thing, *letter))
    };
    let roles = ROLES
        .iter()
        .filter_map(|(role, words)| Some((*role, *words.iter().find(holds)?)));
    Said {
        by_letter: thing.is_none(),
        thing: thing.or_else(letter),
        roles: roles.collect(),
        across: parts.len() > 1 && parts.iter().any(|part| part == "x" || part == "y"),
    }
}

/// Units that a thing may have.
pub(super) fn units_of(thing: Thing) -> &'static [Unit] {
    match thing {
        Thing::Time => &[Unit::Second],
        Thing::Pressure => &[Unit::Pascal],
        Thing::Stroke | Thing::Surface => &[Unit::Metre],
        Thing::Force => &[Unit::Newton],
        Thing::Acceleration => &[Unit::MetrePerSecondSquared],
        Thing::Valve => &[Unit::One],
        Thing::Other => &[],
    }
}

/// Parts of a name in plain small letters, without what stands in brackets: `fSollDruck_1 [bar]` as f, soll, druck, 1.
pub(super) fn parts(name: &str) -> Vec<String> {
    let mut parts: Vec<String> = vec![String::new()];
    let mut depth = 0;
    let mut before = ' ';
    for c in name.chars() {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            _ => {}
        }
        if depth > 0 || !c.is_alphanumeric() {
            parts.push(String::new());
            before = ' ';
            continue;
        }
        let turns = (before.is_lowercase() && c.is_uppercase())
            || (before.is_alphabetic() && c.is_ascii_digit())
            || (before.is_ascii_digit() && c.is_alphabetic());
        if turns {
            parts.push(String::new());
        }
        before = c;
        if let Some(last) = parts.last_mut() {
            c.to_lowercase().for_each(|c| push_plain(last, c));
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// A letter without its marks.
fn push_plain(text: &mut String, c: char) {
    match c {
        'ä' => text.push_str("ae"),
        'ö' => text.push_str("oe"),
        'ü' => text.push_str("ue"),
        'ß' => text.push_str("ss"),
        'à' | 'á' | 'â' | 'ã' | 'å' => text.push('a'),
        'ç' => text.push('c'),
        'è' | 'é' | 'ê' | 'ë' => text.push('e'),
        'ì' | 'í' | 'î' | 'ï' => text.push('i'),
        'ñ' => text.push('n'),
        'ò' | 'ó' | 'ô' | 'õ' => text.push('o'),
        'ù' | 'ú' | 'û' => text.push('u'),
        other => text.push(other),
    }
}

/// Whether a name says times.
pub(super) fn says_time(name: &str) -> bool {
    said(name)
        .thing
        .is_some_and(|(thing, _)| thing == Thing::Time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_loggers_say_what_they_are() {
        for (name, thing, role) in [
            ("t [ms]", Thing::Time, None),
            ("Zeitstempel", Thing::Time, None),
            ("X_Value", Thing::Time, None),
            ("Solldruck [bar]", Thing::Pressure, Some(Role::Set)),
            ("p_set [bar]", Thing::Pressure, Some(Role::Set)),
            ("MAIN.fDruckIst", Thing::Pressure, Some(Role::Actual)),
            ("Consigne pression (bar)", Thing::Pressure, Some(Role::Set)),
            ("presión medida", Thing::Pressure, Some(Role::Actual)),
            ("Kammerdruck 1", Thing::Pressure, Some(Role::Elsewhere)),
            ("Kolbenweg [mm]", Thing::Stroke, None),
            ("x [mm]", Thing::Stroke, None),
            ("Corsa [mm]", Thing::Stroke, None),
            ("Kraft_Ist", Thing::Force, Some(Role::Actual)),
            ("Fz (N)", Thing::Force, None),
            ("Oberfläche [mm]", Thing::Surface, None),
            ("Wall position", Thing::Surface, None),
            ("Magnetventil", Thing::Valve, None),
            ("bVentilAusfahren", Thing::Valve, None),
            ("Beschleunigung [m/s²]", Thing::Acceleration, None),
            ("accélération", Thing::Acceleration, None),
            ("Temperatur [°C]", Thing::Other, None),
        ] {
            let said = said(name);
            assert_eq!(
                said.thing.map(|(thing, _)| thing),
                Some(thing),
                "{name}: {said:?}"
            );
            if let Some(role) = role {
                assert!(said.has(role), "{name}: {said:?}");
            }
        }
        assert_eq!(said("Kanal 7").thing, None);
        assert!(said("/wrench.wrench.force.x").across && !said("/wrench.wrench.force.z").across);
    }
}
