//! Which key was probably meant by one that does not exist.

use crate::unit::{Unit, stem};

/// Tables of a file, by dotted name, with their keys.
pub(crate) type Sections = [(String, Vec<&'static str>)];

/// Words of which unit suffixes are made, ours and others that people write.
const UNIT_WORDS: [&str; 62] = [
    "per", "um", "mm", "cm", "m", "km", "in", "inch", "ft", "um2", "mm2", "cm2", "m2", "mm3",
    "cm3", "m3", "l", "ml", "us", "ms", "s", "s2", "s3", "min", "h", "hz", "khz", "rpm", "deg",
    "rad", "degrees", "radians", "g", "kg", "t", "n", "kn", "mn", "nm", "lbf", "pa", "kpa", "mpa",
    "hpa", "bar", "mbar", "psi", "gauge", "absolute", "abs", "k", "c", "v", "mv", "volt", "volts",
    "ohm", "ohms", "kohm", "uf", "nf", "pf",
];

/// Similarity (Jaro-Winkler) from which a key counts as a slip of the pen.
const SIMILAR: f64 = 0.85;

/// Advice on an unknown dotted key.
pub(crate) fn advice(key: &str, sections: &Sections) -> String {
    let (table, name) = split(key);
    let known = sections
        .iter()
        .find(|(section, _)| is_table(section, &table))
        .map_or(&[][..], |(_, keys)| &keys[..]);
    if let Some(right) = known.iter().find(|right| differs_in_unit(name, right)) {
        let symbol = Unit::of_key(right).symbol;
        return format!("the key is `{right}`, in {symbol}");
    }
    if let Some((section, _)) = sections.iter().find(|(_, keys)| keys.contains(&name)) {
        return match section.as_str() {
            "" => format!("`{name}` belongs to the top of the file, before any table"),
            section => format!("`{name}` belongs to [{section}]"),
        };
    }
    nearest(name, known)
}

/// Whether a table's dotted name is that of a declared one, where `*` stands for what the user calls it.
pub(crate) fn is_table(declared: &str, table: &str) -> bool {
    match declared.strip_suffix('*') {
        Some(start) => table.starts_with(start),
        None => table == declared,
    }
}

/// Advice on a name that is none of the known ones.
pub(crate) fn nearest(name: &str, known: &[&str]) -> String {
    let similarity = |right: &str| strsim::jaro_winkler(name, right);
    let nearest = known
        .iter()
        .max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
    match nearest {
        Some(nearest) if similarity(nearest) >= SIMILAR => format!("did you mean `{nearest}`?"),
        _ => format!("known here are {}", known.join(", ")),
    }
}

/// Advice on an unknown dotted key where a whole key was given: the nearest of all, with its table.
pub(crate) fn nearest_dotted(key: &str, sections: &Sections) -> String {
    let (table, name) = split(key);
    let all = || {
        let keys = |(section, keys): &(String, Vec<&'static str>)| {
            let dotted = |key: &&'static str| (section.replace('*', "NAME"), *key);
            keys.iter().map(dotted).collect::<Vec<_>>()
        };
        sections.iter().flat_map(keys)
    };
    // The right name counts before the right table: people leave the table out.
    let likeness = |(own, right): &(String, &str)| {
        let unit = differs_in_unit(name, right);
        let name = if unit {
            1.0
        } else {
            strsim::jaro_winkler(name, right)
        };
        let table = strsim::jaro_winkler(&table, own);
        (name, table)
    };
    let nearest = all().max_by(|one, other| {
        let (one, other) = (likeness(one), likeness(other));
        (one.0.total_cmp(&other.0)).then(one.1.total_cmp(&other.1))
    });
    match nearest {
        Some(found) if likeness(&found).0 >= SIMILAR => {
            format!("did you mean `{}`?", join(&found.0, found.1))
        }
        _ => advice(key, sections),
    }
}

/// `table.key`, or `key` at top level.
pub(crate) fn join(table: &str, key: &str) -> String {
    if table.is_empty() {
        key.to_owned()
    } else {
        format!("{table}.{key}")
    }
}

/// Table, without list indices, and name of a dotted key.
pub(crate) fn split(key: &str) -> (String, &str) {
    let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
    let table = table
        .split('.')
        .map(|part| part.split('[').next().unwrap_or(part))
        .collect::<Vec<_>>()
        .join(".");
    (table, name)
}

/// Whether it is the right key but for its unit, as in `force` or `force_kn` for `force_n`.
fn differs_in_unit(name: &str, right: &str) -> bool {
    let stem = stem(right);
    if Unit::of_key(right).is_one() || !name.starts_with(stem) {
        return false;
    }
    let rest = &name[stem.len()..];
    rest.is_empty()
        || rest.strip_prefix('_').is_some_and(|words| {
            words
                .to_lowercase()
                .split('_')
                .all(|word| UNIT_WORDS.contains(&word))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sections() -> Vec<(String, Vec<&'static str>)> {
        let process = vec!["feed_mm_per_s", "corner_feed_mm_per_s", "force_n"];
        vec![
            (String::new(), vec!["schema", "process", "contact"]),
            ("process".to_owned(), process),
            (
                "contact".to_owned(),
                vec!["stiffness_n_per_m", "friction_coefficient"],
            ),
        ]
    }

    #[test]
    fn each_kind_of_slip_leads_to_the_right_key() {
        for (key, expected) in [
            ("process.force", "the key is `force_n`, in N"),
            ("process.force_kN", "the key is `force_n`, in N"),
            (
                "process.feed_m_per_min",
                "the key is `feed_mm_per_s`, in mm/s",
            ),
            (
                "contact.stiffness_n_per_mm",
                "the key is `stiffness_n_per_m`, in N/m",
            ),
            ("contact.force_n", "`force_n` belongs to [process]"),
            (
                "process.schema",
                "`schema` belongs to the top of the file, before any table",
            ),
            ("process.froce_n", "did you mean `force_n`?"),
            ("contact.friction", "did you mean `friction_coefficient`?"),
            ("proces", "did you mean `process`?"),
            (
                "process.temperature",
                "known here are feed_mm_per_s, corner_feed_mm_per_s, force_n",
            ),
        ] {
            assert_eq!(advice(key, &sections()), expected, "{key}");
        }
    }

    #[test]
    fn a_whole_key_is_answered_by_a_whole_key() {
        for (key, expected) in [
            ("process.froce_n", "did you mean `process.force_n`?"),
            ("force_n", "did you mean `process.force_n`?"),
            ("proces.force", "did you mean `process.force_n`?"),
            (
                "contact.feed_mm_per_s",
                "did you mean `process.feed_mm_per_s`?",
            ),
            (
                "process.temperature",
                "known here are feed_mm_per_s, corner_feed_mm_per_s, force_n",
            ),
        ] {
            assert_eq!(nearest_dotted(key, &sections()), expected, "{key}");
        }
    }

    #[test]
    fn what_follows_the_stem_must_be_a_unit() {
        assert!(differs_in_unit("force_lbf", "force_n"));
        assert!(!differs_in_unit("force_peak_n", "force_n"));
        assert!(!differs_in_unit("friction", "friction_coefficient"));
    }
}
