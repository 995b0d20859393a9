//! Loads that makers of robots give for them, by the names that their URDF files carry.

/// Words of a robot's name that do not tell models apart.
const COMMON: [&str; 10] = [
    "abb",
    "fanuc",
    "kuka",
    "motoman",
    "yaskawa",
    "staubli",
    "universal",
    "robots",
    "robot",
    "macro",
];

/// Rated load of the makers' data sheets [kg], by the model as `model` writes it.
#[rustfmt::skip]
const MAKERS: &[(&str, f64)] = &[
    // Universal Robots.
    ("ur3", 3.0), ("ur3e", 3.0), ("ur5", 5.0), ("ur5e", 5.0), ("ur10", 10.0), ("ur10e", 12.5), ("ur16e", 16.0), ("ur20", 20.0), ("ur30", 30.0),
    // ABB.
    ("irb120", 3.0), ("irb120358", 3.0), ("irb1200509", 5.0), ("irb1200707", 7.0), ("irb1600612", 6.0), ("irb16006145", 6.0), ("irb160010145", 10.0),
    ("irb260012165", 12.0), ("irb260012185", 12.0), ("irb4400l30243", 30.0), ("irb460020250", 20.0), ("irb460040255", 40.0), ("irb460045205", 45.0),
    ("irb460060205", 60.0), ("irb6640185280", 185.0), ("irb6640", 185.0), ("irb7600150350", 150.0),
    // FANUC.
    ("lrmate200ic", 5.0), ("lrmate200id", 7.0), ("lrmate200id7l", 7.0), ("m6ib", 6.0), ("m6ib6s", 6.0), ("m10ia", 10.0), ("m10ia7l", 7.0), ("m16ib20", 20.0),
    ("m20ia", 20.0), ("m20ia10l", 10.0), ("m710ic45m", 45.0), ("m710ic50", 50.0), ("m900ia260l", 260.0), ("r1000ia80f", 80.0), ("r2000ic165f", 165.0),
    ("r2000ic210f", 210.0), ("cr7ia", 7.0), ("cr7ial", 7.0), ("cr35ia", 35.0),
    // KUKA.
    ("kr3r540", 3.0), ("kr5arc", 5.0), ("kr6r700sixx", 6.0), ("kr6r900sixx", 6.0), ("kr10r900", 10.0), ("kr10r1100sixx", 10.0), ("kr10r1420", 10.0), ("kr162", 16.0),
    ("kr120r2500pro", 120.0), ("kr1502", 150.0), ("kr210l150", 150.0), ("lbriiwa7r800", 7.0), ("lbriiwa14r820", 14.0),
    // Yaskawa Motoman.
    ("gp7", 7.0), ("gp8", 8.0), ("gp12", 12.0), ("gp25", 25.0), ("gp50", 50.0), ("gp180", 180.0), ("hc10", 10.0), ("hc10dt", 10.0), ("mh5", 5.0), ("mh12", 12.0),
    ("mh50", 50.0), ("sia5d", 5.0), ("sia10d", 10.0), ("sia10f", 10.0), ("sia20d", 20.0), ("sia20f", 20.0), ("sia30d", 30.0),
];

/// Mass that its maker lets a robot carry on its flange [kg], by its name in the URDF; unknown of most.
#[must_use]
pub fn of_maker(name: &str) -> Option<f64> {
    let model = model(name);
    let found = MAKERS.iter().find(|(known, _)| *known == model);
    found.map(|(_, mass)| *mass)
}

/// The model in a name: lower case, without the maker and what stands between its parts.
fn model(name: &str) -> String {
    let lower = name.to_lowercase();
    let words = lower.split(|letter: char| !letter.is_ascii_alphanumeric());
    words.filter(|word| !COMMON.contains(word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maker_s_robot_is_known_however_its_name_is_written() {
        for (name, mass) in [
            ("ur10e", Some(12.5)),
            ("ur10e_robot", Some(12.5)),
            ("UR-10e", Some(12.5)),
            ("fanuc_m10ia", Some(10.0)),
            ("abb_irb4600_60_205", Some(60.0)),
            ("kuka_kr6r700sixx", Some(6.0)),
            ("motoman_gp25", Some(25.0)),
            ("arm10", None),
            ("ur100", None),
            ("robot", None),
            ("", None),
        ] {
            assert_eq!(of_maker(name), mass, "{name}");
        }
    }

    #[test]
    fn every_model_is_listed_once_and_as_it_is_sought() {
        let mut seen = std::collections::BTreeSet::new();
        for (known, mass) in MAKERS {
            assert!(seen.insert(known), "{known}");
            assert_eq!(&model(known), known);
            assert!(*mass > 0.0);
        }
    }
}
