//! Fields of ROS 2 messages by their path, and their values in a message as CDR writes it.

use std::collections::HashMap;

use re_cdr::{BigEndian, CdrReader, LittleEndian};
use re_ros_msg::MessageSchema;
use re_ros_msg::deserialize::primitive_array::PrimitiveArray;
use re_ros_msg::deserialize::{TypeResolver, Value, decode_message};
use re_ros_msg::message_spec::{
    ArraySize, BuiltInType, ComplexType, MessageSpecification, Type, message_package,
};

use super::extent::{extent, measure};
use crate::file::guarded;

/// Elements that are named of a list whose length only its messages know.
const NAMED: usize = 2;
/// Elements that are named of any list, at most.
const MOST_NAMED: usize = 64;
/// Paths of a message that are named, at most.
const MOST_PATHS: usize = 4096;
/// Bytes from which on a message is measured before it is read.
const LONG: usize = 1 << 20;

/// Definition of a topic's messages.
pub(super) struct Definition {
    schema: MessageSchema,
    /// Places of the messages that it takes from elsewhere, by name.
    places: HashMap<String, usize>,
    /// Whether its messages hold lists of messages.
    has_lists: bool,
}

/// A way into a message.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field(Vec<Step>);

/// A step of it.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    /// To a field.
    Name(String),
    /// To an element of a list, from 0.
    Index(usize),
}

/// Kind of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A number, or true or false.
    Number,
    /// Seconds and nanoseconds.
    Stamp,
    /// Something else.
    Other(&'static str),
}

impl Kind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Stamp => "a stamp",
            Self::Other(what) => what,
        }
    }
}

/// Which of a topic's messages, or of their elements, are meant.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Picked {
    /// The joint, by its name.
    pub joint: Option<String>,
    /// The frame, by its name.
    pub frame: Option<String>,
}

/// Lists that name the joints of a message, of `sensor_msgs/JointState` and of controllers' states.
const JOINT_NAMES: [&str; 2] = ["name", "joint_names"];

/// A message, read.
pub(super) struct Message(Value);

impl TypeResolver for Definition {
    fn resolve(
        &self,
        scope: &MessageSpecification,
        kind: &ComplexType,
    ) -> Option<&MessageSpecification> {
        let package = match kind {
            ComplexType::Absolute { package, .. } => Some(package.as_str()),
            ComplexType::Relative { .. } => message_package(&scope.name),
        };
        let (ComplexType::Absolute { name, .. } | ComplexType::Relative { name }) = kind;
        let place = match package {
            Some(package) => self.places.get(&format!("{package}/{name}")),
            None => self.places.get(name),
        };
        place.map(|place| &self.schema.dependencies[*place])
    }
}

impl Definition {
    /// Whether its messages name joints, beside lists with an element for each.
    pub fn has_joints(&self) -> bool {
        let names = |list: &&&str| self.field(&format!("{list}[0]")).is_some();
        JOINT_NAMES.iter().find(names).is_some()
    }

    /// Whether its messages have a frame.
    pub fn has_frames(&self) -> bool {
        self.field("header.frame_id").is_some()
    }

    /// Whether the field of a path is true or false.
    pub fn is_bool(&self, path: &str) -> bool {
        // A field within another message is seldom a flag.
        let own = self.schema.spec.fields.iter().find(|f| f.name == path);
        own.is_some_and(|field| matches!(field.ty, Type::BuiltIn(BuiltInType::Bool)))
    }

    /// Paths of lists of numbers whose lengths the messages know.
    pub fn lists(&self) -> Vec<String> {
        let first = |path: String| path.strip_suffix("[0]").map(str::to_owned);
        let listed = self.numbers().into_iter().filter_map(first);
        listed.collect()
    }

    /// Reads the definition of the messages of this name.
    pub fn parse(name: &str, text: &str) -> Result<Self, String> {
        let parsed = guarded(|| MessageSchema::parse(name, text))?;
        let schema = parsed.map_err(|cause| format!("{cause:#}"))?;
        // Some writers name a message `package/msg/Name`, where others leave out the middle.
        let short = |spec: &MessageSpecification| spec.name.replace("/msg/", "/");
        let all = schema.dependencies.iter().enumerate();
        let places = all
            .flat_map(|(place, spec)| [(spec.name.clone(), place), (short(spec), place)])
            .collect();
        let mut definition = Self {
            schema,
            places,
            has_lists: false,
        };
        let extent = extent(&definition.schema.spec, &definition)?;
        definition.has_lists = extent.has_lists;
        Ok(definition)
    }

    /// The field of a path, and what it holds.
    pub fn field(&self, path: &str) -> Option<(Field, Kind)> {
        let steps = steps(path)?;
        let mut scope = &self.schema.spec;
        let mut inside: Option<&Type> = None;
        for step in &steps {
            match (step, inside) {
                (Step::Name(name), None) => {
                    inside = Some(&scope.fields.iter().find(|f| f.name == *name)?.ty);
                }
                (Step::Index(index), Some(Type::Array { ty, size })) => {
                    if matches!(size, ArraySize::Fixed(length) if index >= length) {
                        return None;
                    }
                    inside = Some(ty);
                }
                (Step::Name(name), Some(Type::Complex(kind))) => {
                    scope = self.resolve(scope, kind)?;
                    inside = Some(&scope.fields.iter().find(|f| f.name == *name)?.ty);
                }
                _ => return None,
            }
        }
        let kind = match inside? {
            Type::BuiltIn(own) => of_built_in(own),
            Type::Array { .. } => Kind::Other("a list"),
            Type::Complex(kind) => of_message(self.resolve(scope, kind)?),
        };
        Some((Field(steps), kind))
    }

    /// Paths of all numbers.
    pub fn numbers(&self) -> Vec<String> {
        self.paths(Kind::Number)
    }

    /// Paths of all stamps.
    pub fn times(&self) -> Vec<String> {
        self.paths(Kind::Stamp)
    }

    /// Paths of a kind, of lists of unknown length the first elements.
    fn paths(&self, kind: Kind) -> Vec<String> {
        let mut found = Vec::new();
        for field in &self.schema.spec.fields {
            let start = field.name.clone();
            walk(self, &self.schema.spec, &field.ty, start, &mut found);
        }
        let own = found.into_iter().filter(|(_, own)| *own == kind);
        own.map(|(path, _)| path).collect()
    }

    /// Reads a message.
    pub fn decode(&self, data: &[u8]) -> Result<Message, String> {
        // The encapsulation header of CDR (OMG DDS-RTPS 2.5, 10.2): its second byte says the byte order.
        let body = data.get(4..).ok_or("it has no header")?;
        let spec = &self.schema.spec;
        // Room for a list is made as its length claims.
        let is_measured = self.has_lists || body.len() > LONG;
        let value = match data[..2] {
            [0, 0] => {
                measure(&mut CdrReader::<BigEndian>::new(body), spec, self)?;
                let mut reader = CdrReader::<BigEndian>::new(body);
                guarded(|| decode_message(&mut reader, spec, self))?
            }
            [0, 1] => {
                if is_measured {
                    measure(&mut CdrReader::<LittleEndian>::new(body), spec, self)?;
                }
                let mut reader = CdrReader::<LittleEndian>::new(body);
                guarded(|| decode_message(&mut reader, spec, self))?
            }
            _ => {
                return Err(format!(
                    "its header is {:02x?}, expected plain CDR",
                    &data[..2]
                ));
            }
        };
        value.map(Message).map_err(|cause| cause.to_string())
    }
}

fn walk(
    resolver: &Definition,
    scope: &MessageSpecification,
    ty: &Type,
    path: String,
    found: &mut Vec<(String, Kind)>,
) {
    if found.len() >= MOST_PATHS {
        return;
    }
    match ty {
        Type::BuiltIn(own) => found.push((path, of_built_in(own))),
        Type::Array { ty, size } => {
            let count = match size {
                ArraySize::Fixed(count) => (*count).min(MOST_NAMED),
                ArraySize::Bounded(_) | ArraySize::Unbounded => NAMED,
            };
            for index in 0..count {
                walk(resolver, scope, ty, format!("{path}[{index}]"), found);
            }
        }
        Type::Complex(kind) => {
            let Some(spec) = resolver.resolve(scope, kind) else {
                return;
            };
            found.push((path.clone(), of_message(spec)));
            for field in &spec.fields {
                let inner = format!("{path}.{}", field.name);
                walk(resolver, spec, &field.ty, inner, found);
            }
        }
    }
}

fn of_built_in(own: &BuiltInType) -> Kind {
    match own {
        BuiltInType::String(_) | BuiltInType::WString(_) => Kind::Other("a text"),
        _ => Kind::Number,
    }
}

fn of_message(spec: &MessageSpecification) -> Kind {
    let names: Vec<&str> = spec.fields.iter().map(|f| f.name.as_str()).collect();
    match names == ["sec", "nanosec"] {
        true => Kind::Stamp,
        false => Kind::Other("a message"),
    }
}

/// `wrench.force.z`, `position[1]`.
fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let mut pieces = part.split('[');
        let name = pieces.next().filter(|name| !name.is_empty())?;
        steps.push(Step::Name(name.to_owned()));
        for piece in pieces {
            steps.push(Step::Index(piece.strip_suffix(']')?.parse().ok()?));
        }
    }
    Some(steps)
}

impl Field {
    /// The same of another element of its list.
    pub fn at(&self, place: usize) -> Self {
        let mut steps = self.0.clone();
        if let Some(Step::Index(index)) = steps.last_mut() {
            *index = place;
        }
        Self(steps)
    }
}

impl Message {
    /// Names of its joints.
    pub fn joints(&self) -> Vec<String> {
        let Value::Message(fields) = &self.0 else {
            return Vec::new();
        };
        let list = JOINT_NAMES.iter().find_map(|name| fields.get(*name));
        match list {
            Some(
                Value::PrimitiveArray(PrimitiveArray::String(names))
                | Value::PrimitiveSeq(PrimitiveArray::String(names)),
            ) => names.clone(),
            Some(Value::Array(names) | Value::Sequence(names)) => {
                let text = |value: &Value| match value {
                    Value::String(name) => name.clone(),
                    _ => String::new(),
                };
                names.iter().map(text).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Name of its frame.
    pub fn frame(&self) -> Option<String> {
        let path = ["header", "frame_id"].map(|name| Step::Name(name.to_owned()));
        match self.value(&path)? {
            Value::String(name) => Some(name.clone()),
            _ => None,
        }
    }

    /// The place of the joint that is meant, if one is.
    ///
    /// # Errors
    /// The joints, or the frame, that it is of instead.
    pub fn place_of(&self, picked: &Picked) -> Result<Option<usize>, Vec<String>> {
        if let Some(frame) = &picked.frame {
            let own = self.frame().unwrap_or_default();
            if own != *frame {
                return Err(vec![own]);
            }
        }
        let Some(joint) = &picked.joint else {
            return Ok(None);
        };
        let names = self.joints();
        match names.iter().position(|name| name == joint) {
            Some(place) => Ok(Some(place)),
            None => Err(names),
        }
    }

    fn value(&self, steps: &[Step]) -> Option<&Value> {
        let mut value = &self.0;
        for step in steps {
            value = match (step, value) {
                (Step::Name(name), Value::Message(fields)) => fields.get(name)?,
                (Step::Index(index), Value::Array(all) | Value::Sequence(all)) => {
                    all.get(*index)?
                }
                _ => return None,
            };
        }
        Some(value)
    }

    /// A field's number; none where a list has no such element.
    pub fn number(&self, field: &Field) -> Option<f64> {
        if let Some((Step::Index(index), before)) = field.0.split_last()
            && let Some(Value::PrimitiveArray(all) | Value::PrimitiveSeq(all)) = self.value(before)
        {
            return element(all, *index);
        }
        scalar(self.value(&field.0)?)
    }

    /// A field's stamp [ns].
    pub fn stamp(&self, field: &Field) -> Option<i64> {
        let Value::Message(fields) = self.value(&field.0)? else {
            return None;
        };
        let whole = |name: &str| match fields.get(name)? {
            Value::I32(v) => Some(i64::from(*v)),
            Value::U32(v) => Some(i64::from(*v)),
            _ => None,
        };
        Some(whole("sec")? * 1_000_000_000 + whole("nanosec")?)
    }
}

fn scalar(value: &Value) -> Option<f64> {
    Some(match value {
        Value::Bool(v) => f64::from(u8::from(*v)),
        Value::I8(v) => f64::from(*v),
        Value::U8(v) => f64::from(*v),
        Value::I16(v) => f64::from(*v),
        Value::U16(v) => f64::from(*v),
        Value::I32(v) => f64::from(*v),
        Value::U32(v) => f64::from(*v),
        Value::I64(v) => *v as f64,
        Value::U64(v) => *v as f64,
        Value::F32(v) => f64::from(*v),
        Value::F64(v) => *v,
        _ => return None,
    })
}

fn element(all: &PrimitiveArray, index: usize) -> Option<f64> {
    Some(match all {
        PrimitiveArray::Bool(v) => f64::from(u8::from(*v.get(index)?)),
        PrimitiveArray::I8(v) => f64::from(*v.get(index)?),
        PrimitiveArray::U8(v) => f64::from(*v.get(index)?),
        PrimitiveArray::I16(v) => f64::from(*v.get(index)?),
        PrimitiveArray::U16(v) => f64::from(*v.get(index)?),
        PrimitiveArray::I32(v) => f64::from(*v.get(index)?),
        PrimitiveArray::U32(v) => f64::from(*v.get(index)?),
        PrimitiveArray::I64(v) => *v.get(index)? as f64,
        PrimitiveArray::U64(v) => *v.get(index)? as f64,
        PrimitiveArray::F32(v) => f64::from(*v.get(index)?),
        PrimitiveArray::F64(v) => *v.get(index)?,
        PrimitiveArray::String(_) => return None,
    })
}
