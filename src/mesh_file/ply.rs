//! PLY: vertices and faces, as text or binary of either byte order; other elements and properties are passed over.

use glam::DVec3;

use super::polygon::{Effort, split};
use super::scene::{Fault, MeshFile, MeshPart, bounded};
use super::text::{number, shown};

/// How values are written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Format {
    Text,
    Little,
    Big,
}

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A property: a number, or a list of them behind their count.
#[derive(Debug, Clone, PartialEq)]
struct Property {
    name: String,
    count: Option<Scalar>,
    value: Scalar,
}

#[derive(Debug, Clone, PartialEq)]
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<MeshFile, Fault> {
    let (format, elements, body) = header(bytes)?;
    let mut values = Values {
        format,
        bytes,
        at: body,
    };
    let mut part = MeshPart::default();
    let mut polygons = Polygons::default();
    for element in &elements {
        if element.properties.is_empty() {
            // Whatever count of them is claimed, nothing is there to be read.
            continue;
        }
        if element.name == "tristrips" && element.count > 0 {
            return Err(Fault::unsupported(
                "the PLY element `tristrips`",
                "export the mesh with faces",
            ));
        }
        let place = |name: &str| {
            element
                .properties
                .iter()
                .position(|p| p.name == name && p.count.is_none())
        };
        let is_vertex = element.name == "vertex";
        let axes = match (is_vertex, place("x"), place("y"), place("z")) {
            (true, Some(x), Some(y), Some(z)) => Some([x, y, z]),
            (true, ..) => {
                return Err(Fault::malformed(
                    "its vertices have no properties x, y and z",
                ));
            }
            _ => None,
        };
        let corners = (element.name == "face").then(|| {
            let list = |p: &Property| {
                p.count.is_some() && ["vertex_indices", "vertex_index"].contains(&p.name.as_str())
            };
            element.properties.iter().position(list)
        });
        if corners == Some(None) && element.count > 0 {
            return Err(Fault::malformed("its faces have no list `vertex_indices`"));
        }
        for number in 0..element.count {
            let row = values.row(element, number)?;
            if let Some(axes) = axes {
                let [x, y, z] = axes.map(|axis| row[axis][0]);
                part.points.push(DVec3::new(x, y, z));
            } else if let Some(Some(corners)) = corners {
                polygons.add(number, &row[corners])?;
            }
            bounded(
                polygons.ends.len().max(polygons.corners.len() / 3),
                part.points.len(),
            )?;
        }
    }
    with_faces(part, &polygons)
}

/// Faces by their corners, one after the other; those of less than three have no surface.
#[derive(Default)]
struct Polygons {
    corners: Vec<u32>,
    /// Numbers of the faces, and where their corners end.
    ends: Vec<(u32, u32)>,
}

impl Polygons {
    fn add(&mut self, face: usize, values: &[f64]) -> Result<(), Fault> {
        if values.len() < 3 {
            return Ok(());
        }
        for value in values {
            if value.fract() != 0.0 || !(0.0..f64::from(u32::MAX)).contains(value) {
                return Err(Fault::malformed(format!(
                    "face {face} refers to a vertex {value}, expected a whole number from 0"
                )));
            }
            self.corners.push(*value as u32);
        }
        self.ends.push((face as u32, self.corners.len() as u32));
        Ok(())
    }
}

/// The file of a part's points and its polygons.
fn with_faces(mut part: MeshPart, polygons: &Polygons) -> Result<MeshFile, Fault> {
    let count = part.points.len();
    let (mut bent, mut doubtful) = (0, None);
    let (effort, mut begin) = (Effort::new(), 0);
    for &(face, end) in &polygons.ends {
        let corners = &polygons.corners[begin..end as usize];
        begin = end as usize;
        if let Some(missing) = corners.iter().find(|corner| **corner as usize >= count) {
            return Err(Fault::malformed(format!(
                "face {face} refers to the missing vertex {missing} (there are {count})"
            )));
        }
        let split = split(&part.points, corners, &[], &effort)
            .map_err(|reason| Fault::malformed(format!("face {face}: {reason}")))?;
        bent += usize::from(split.off_plane.is_some());
        if split.folded {
            doubtful.get_or_insert(format!(
                "face {face} is far from plane, and split one way or the other it is another shape; expected plane faces: export the part with triangles"
            ));
        }
        part.triangles.extend(split.triangles);
        bounded(part.triangles.len(), count)?;
    }
    let mut notes = Vec::new();
    if bent > 0 {
        notes.push(format!(
            "{bent} of its faces are not plane: they were split where they fold the least"
        ));
    }
    Ok(MeshFile {
        notes,
        doubtful,
        ..MeshFile::unitless(vec![part])
    })
}

/// The header: how values are written, the elements, where they begin.
fn header(bytes: &[u8]) -> Result<(Format, Vec<Element>, usize), Fault> {
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut at = 0;
    for number in 1.. {
        let rest = &bytes[at..];
        let Some(end) = rest
            .iter()
            .position(|byte| *byte == b'\n' || *byte == b'\r')
        else {
            return Err(Fault::malformed("its header has no `end_header`"));
        };
        let two = rest[end..].starts_with(b"\r\n");
        at += end + 1 + usize::from(two);
        let line = String::from_utf8_lossy(&rest[..end]).into_owned();
        let fault = || {
            Fault::at_line(
                number,
                format!("`{}` is no line of a PLY header", shown(&line)),
            )
        };
        let words: Vec<&str> = line
            .trim_start_matches('\u{feff}')
            .split_whitespace()
            .collect();
        match words[..] {
            ["format", name, ..] => {
                format = Some(match name {
                    "ascii" => Format::Text,
                    "binary_little_endian" => Format::Little,
                    "binary_big_endian" => Format::Big,
                    _ => return Err(fault()),
                });
            }
            ["element", name, count] => elements.push(Element {
                name: name.to_owned(),
                count: count.parse().map_err(|_| fault())?,
                properties: Vec::new(),
            }),
            ["property", "list", count, value, name] => {
                let [count, value] = [count, value].map(Scalar::named);
                let (Some(element), Some(value), Some(_)) = (elements.last_mut(), value, count)
                else {
                    return Err(fault());
                };
                element.properties.push(Property {
                    name: name.to_owned(),
                    count,
                    value,
                });
            }
            ["property", value, name] => {
                let (Some(element), Some(value)) = (elements.last_mut(), Scalar::named(value))
                else {
                    return Err(fault());
                };
                element.properties.push(Property {
                    name: name.to_owned(),
                    count: None,
                    value,
                });
            }
            ["end_header"] => break,
            ["ply"] if number == 1 => {}
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(fault()),
        }
    }
    let format = format.ok_or_else(|| Fault::malformed("its header has no line `format`"))?;
    Ok((format, elements, at))
}

/// What follows the header.
struct Values<'a> {
    format: Format,
    bytes: &'a [u8],
    at: usize,
}

impl Values<'_> {
    /// The values of one element's properties.
    fn row(&mut self, element: &Element, row: usize) -> Result<Vec<Vec<f64>>, Fault> {
        let cut = || {
            Fault::malformed(format!(
                "it ends before its {} {} of {}",
                element.name, row, element.count
            ))
        };
        let mut found = Vec::with_capacity(element.properties.len());
        for property in &element.properties {
            let count = match property.count {
                None => 1.0,
                Some(count) => self.next(count)?.ok_or_else(cut)?,
            };
            let mut values = Vec::new();
            for _ in 0..count.max(0.0) as u64 {
                values.push(self.next(property.value)?.ok_or_else(cut)?);
                bounded(values.len() / 3, 0)?;
            }
            found.push(values);
        }
        Ok(found)
    }

    /// The next number; none at the end.
    fn next(&mut self, scalar: Scalar) -> Result<Option<f64>, Fault> {
        if self.format == Format::Text {
            let rest = &self.bytes[self.at..];
            let Some(start) = rest.iter().position(|byte| !byte.is_ascii_whitespace()) else {
                return Ok(None);
            };
            let length = rest[start..]
                .iter()
                .position(u8::is_ascii_whitespace)
                .unwrap_or(rest.len() - start);
            self.at += start + length;
            let word = String::from_utf8_lossy(&rest[start..start + length]);
            return number(&word).map(Some).map_err(|reason| {
                let line = self.bytes[..self.at].split(|byte| *byte == b'\n').count();
                Fault::at_line(line, reason)
            });
        }
        let Some(bytes) = self.bytes.get(self.at..self.at + scalar.size()) else {
            return Ok(None);
        };
        self.at += scalar.size();
        let mut eight = [0; 8];
        let size = bytes.len();
        eight[..size].copy_from_slice(bytes);
        if self.format == Format::Big {
            eight[..size].reverse();
        }
        let [a, b, c, d, ..] = eight;
        Ok(Some(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes([a])),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(eight),
        }))
    }
}
