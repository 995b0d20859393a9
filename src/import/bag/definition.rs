//! The definition of a topic's messages: that of the bag, or a usual one where the bag has none.

use super::field::Definition;
use super::message::There;
use crate::ros_bag;

/// Reads the definition of a topic's messages.
///
/// # Errors
/// Its messages are of a kind that cannot be read.
pub(super) fn definition(owner: &There) -> Result<Definition, String> {
    let Some(schema) = &owner.schema else {
        return Err("of messages without a definition".to_owned());
    };
    let name = schema.name.as_str();
    let parse = |text: &str| {
        let read = Definition::parse(name, text);
        read.map_err(|cause| format!("of messages whose definition cannot be read ({cause})"))
    };
    match (owner.encoding.as_str(), schema.encoding.as_str()) {
        ("cdr", "ros2msg") => parse(&String::from_utf8_lossy(&schema.data)),
        ("cdr", "") => match ros_bag::definition(name) {
            Some(text) => parse(&text),
            None => Err(format!(
                "of messages {name}, whose definition does not stand in the bag and is none of the usual ones; \
                 `ros2 bag convert` of ROS 2 Iron or later, run where they are installed, writes a bag with it"
            )),
        },
        (own, _) => Err(format!(
            "of messages of encoding `{own}` with a definition of encoding `{}`",
            schema.encoding
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros_bag::definition;
    use crate::ros_bag::names;

    #[test]
    fn every_message_has_all_that_is_in_it() {
        for name in names() {
            let text = definition(name).unwrap();
            let read = Definition::parse(name, &text).unwrap();
            let of_number = read.numbers().len() + read.times().len();
            assert!(of_number > 0, "{name}");
            for path in read.numbers() {
                assert!(read.field(&path).is_some(), "{name}: {path}");
            }
        }
        let name = "geometry_msgs/msg/WrenchStamped";
        let wrench = Definition::parse(name, &definition(name).unwrap()).unwrap();
        assert!(wrench.numbers().contains(&"wrench.force.z".to_owned()));
        assert!(definition("my_msgs/msg/Own").is_none());
    }
}
