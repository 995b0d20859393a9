//! The definition of a topic's messages: that of the bag, or a usual one where the bag has none.

use super::field::Definition;
use super::message::There;
use super::standard;

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
        ("cdr", "") => match standard::definition(name) {
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
