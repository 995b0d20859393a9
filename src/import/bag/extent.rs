//! How much messages hold: as their definition says, before any is read, and each by its own bytes, before room is made for it. ROS 2 has no messages
//! that contain themselves; a definition that says so has no end.

use std::collections::HashMap;

use re_cdr::{CdrEndian, CdrReader};
use re_ros_msg::deserialize::TypeResolver;
use re_ros_msg::message_spec::{ArraySize, BuiltInType, MessageSpecification, Type};

use crate::file::megabytes;
use crate::import::packed::LARGEST_MESSAGE;

/// Depth of a message in messages that nobody has.
const DEEPEST: usize = 32;
/// Messages and texts within a message, at most.
const MOST_PARTS: u64 = 1 << 18;

/// What messages of a definition have at least.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    bytes: u64,
    /// Messages within it.
    parts: u64,
    /// How deep they lie in one another.
    depth: usize,
    /// Whether it holds lists of messages.
    pub has_lists: bool,
}

/// What messages of a definition have at least.
///
/// # Errors
/// They contain themselves, or more than any message does.
pub(super) fn extent(
    spec: &MessageSpecification,
    resolver: &impl TypeResolver,
) -> Result<Extent, String> {
    let mut definitions = Definitions {
        resolver,
        within: Vec::new(),
        known: HashMap::new(),
    };
    let found = definitions.of_message(spec)?;
    if found.bytes > LARGEST_MESSAGE || found.parts > MOST_PARTS {
        return Err(format!(
            "messages {} would have {} and {} messages in them at least, expected {} and {MOST_PARTS} at most",
            spec.name,
            megabytes(found.bytes),
            found.parts,
            megabytes(LARGEST_MESSAGE)
        ));
    }
    Ok(found)
}

/// Definitions while they are walked through.
struct Definitions<'a, R> {
    resolver: &'a R,
    /// Those that are in one another.
    within: Vec<&'a MessageSpecification>,
    known: HashMap<*const MessageSpecification, Extent>,
}

impl<'a, R: TypeResolver> Definitions<'a, R> {
    fn of_message(&mut self, spec: &'a MessageSpecification) -> Result<Extent, String> {
        if let Some(known) = self.known.get(&std::ptr::from_ref(spec)) {
            return Ok(*known);
        }
        if self.within.iter().any(|outer| std::ptr::eq(*outer, spec)) {
            return Err(format!("messages {} contain themselves", spec.name));
        }
        let too_deep = || {
            Err(format!(
                "messages lie more than {DEEPEST} deep in one another"
            ))
        };
        if self.within.len() >= DEEPEST {
            return too_deep();
        }
        self.within.push(spec);
        let mut sum = Extent::default();
        for field in &spec.fields {
            sum = sum.and(self.of_type(spec, &field.ty)?);
        }
        self.within.pop();
        sum.bytes = sum.bytes.max(1);
        sum.depth += 1;
        if sum.depth > DEEPEST {
            return too_deep();
        }
        self.known.insert(std::ptr::from_ref(spec), sum);
        Ok(sum)
    }

    fn of_type(&mut self, scope: &'a MessageSpecification, ty: &'a Type) -> Result<Extent, String> {
        match ty {
            Type::BuiltIn(own) => Ok(Extent {
                bytes: size(own).unwrap_or(4),
                ..Extent::default()
            }),
            Type::Array { ty, size } => {
                let element = self.of_type(scope, ty)?;
                let is_message = !matches!(**ty, Type::BuiltIn(_));
                Ok(match size {
                    ArraySize::Fixed(count) => Extent {
                        bytes: element.bytes.saturating_mul(*count as u64),
                        parts: element.parts.saturating_mul(*count as u64),
                        depth: element.depth,
                        has_lists: is_message,
                    },
                    ArraySize::Bounded(_) | ArraySize::Unbounded => Extent {
                        bytes: 4,
                        parts: 0,
                        depth: element.depth,
                        has_lists: is_message,
                    },
                })
            }
            Type::Complex(kind) => match self.resolver.resolve(scope, kind) {
                Some(spec) => Ok(self.of_message(spec)?.and(Extent {
                    parts: 1,
                    ..Extent::default()
                })),
                // It is missed when a message is read.
                None => Ok(Extent::default()),
            },
        }
    }
}

impl Extent {
    fn and(self, other: Self) -> Self {
        Self {
            bytes: self.bytes.saturating_add(other.bytes),
            parts: self.parts.saturating_add(other.parts),
            depth: self.depth.max(other.depth),
            has_lists: self.has_lists || other.has_lists,
        }
    }
}

/// Bytes of a number; none of a text.
fn size(own: &BuiltInType) -> Option<u64> {
    Some(match own {
        BuiltInType::Bool
        | BuiltInType::Byte
        | BuiltInType::Char
        | BuiltInType::Int8
        | BuiltInType::UInt8 => 1,
        BuiltInType::Int16 | BuiltInType::UInt16 => 2,
        BuiltInType::Int32 | BuiltInType::UInt32 | BuiltInType::Float32 => 4,
        BuiltInType::Int64 | BuiltInType::UInt64 | BuiltInType::Float64 => 8,
        BuiltInType::String(_) | BuiltInType::WString(_) => return None,
    })
}

/// Sees that a message holds what its lists claim.
///
/// # Errors
/// It ends before, or holds more parts than any message does.
pub(super) fn measure<E: CdrEndian>(
    reader: &mut CdrReader<'_, E>,
    spec: &MessageSpecification,
    resolver: &impl TypeResolver,
) -> Result<(), String> {
    let mut left = MOST_PARTS;
    of_message(reader, spec, resolver, &mut left)
}

fn of_message<E: CdrEndian>(
    reader: &mut CdrReader<'_, E>,
    spec: &MessageSpecification,
    resolver: &impl TypeResolver,
    left: &mut u64,
) -> Result<(), String> {
    for field in &spec.fields {
        of_type(reader, spec, &field.ty, resolver, left)?;
    }
    Ok(())
}

fn of_type<E: CdrEndian>(
    reader: &mut CdrReader<'_, E>,
    scope: &MessageSpecification,
    ty: &Type,
    resolver: &impl TypeResolver,
    left: &mut u64,
) -> Result<(), String> {
    let ends = |cause: re_cdr::Error| cause.to_string();
    match ty {
        Type::BuiltIn(own) => of_numbers(reader, own, 1, left),
        Type::Array { ty, size } => {
            let count = match size {
                ArraySize::Fixed(count) => *count,
                ArraySize::Bounded(_) | ArraySize::Unbounded => {
                    reader.read_sequence_length().map_err(ends)?
                }
            };
            if let Type::BuiltIn(own) = &**ty {
                return of_numbers(reader, own, count, left);
            }
            if count > reader.remaining() {
                return Err(format!(
                    "a list of {count} messages, with {} bytes left",
                    reader.remaining()
                ));
            }
            for _ in 0..count {
                of_type(reader, scope, ty, resolver, left)?;
            }
            Ok(())
        }
        Type::Complex(kind) => {
            part(left)?;
            let Some(spec) = resolver.resolve(scope, kind) else {
                return Err(format!("messages {kind:?} are not defined"));
            };
            match spec.underlying_type_if_enum_like() {
                Ok(Some(own)) => of_numbers(reader, own, 1, left),
                _ => of_message(reader, spec, resolver, left),
            }
        }
    }
}

/// Counts a part.
fn part(left: &mut u64) -> Result<(), String> {
    *left = left
        .checked_sub(1)
        .ok_or_else(|| format!("it holds more than {MOST_PARTS} messages and texts"))?;
    Ok(())
}

/// Passes numbers, or texts.
fn of_numbers<E: CdrEndian>(
    reader: &mut CdrReader<'_, E>,
    own: &BuiltInType,
    count: usize,
    left: &mut u64,
) -> Result<(), String> {
    let ends = |cause: re_cdr::Error| cause.to_string();
    if let Some(size) = size(own) {
        // Of none the place is not rounded up either.
        if count > 0 {
            reader.align(size as usize).map_err(ends)?;
        }
        let bytes = count.saturating_mul(size as usize);
        return reader.read_bytes(bytes).map(|_| ()).map_err(ends);
    }
    for _ in 0..count {
        part(left)?;
        reader.read_str().map_err(ends)?;
    }
    Ok(())
}
