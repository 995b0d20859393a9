//! Wavefront OBJ: vertices and faces; of materials the colour.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;

use super::polygon::split;
use super::scene::{Fault, MeshFile, MeshPart};
use super::text::{decoded, lines, number};

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<MeshFile, Fault> {
    let text = decoded(bytes);
    let mut reader = Reader::default();
    let mut lines = lines(&text).enumerate();
    while let Some((index, first)) = lines.next() {
        let mut line = first.trim_end().to_owned();
        // A backslash at its end goes on with the next.
        while let Some(begun) = line.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, next)| next.trim_end());
            line = format!("{begun} {next}");
        }
        let statement = line.split('#').next().unwrap_or_default();
        reader.statement(index + 1, statement, folder)?;
    }
    reader.finish()
}

/// A face with the line that it stands in.
struct Face {
    line: usize,
    corners: Vec<i64>,
    /// Vertices known when it was read: negative indices count back from there.
    known: usize,
    material: String,
}

#[derive(Default)]
struct Reader {
    points: Vec<DVec3>,
    faces: Vec<Face>,
    material: String,
    colours: BTreeMap<String, [f64; 4]>,
    free_form: Option<usize>,
}

impl Reader {
    fn statement(&mut self, line: usize, statement: &str, folder: &Path) -> Result<(), Fault> {
        let mut words = statement.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        match keyword {
            "v" => {
                let numbers: Result<Vec<f64>, String> = words.take(3).map(number).collect();
                match numbers.map_err(|reason| Fault::at_line(line, reason))?[..] {
                    [x, y, z] => self.points.push(DVec3::new(x, y, z)),
                    _ => {
                        return Err(Fault::at_line(
                            line,
                            "a vertex of less than three coordinates",
                        ));
                    }
                }
            }
            "f" | "fo" => {
                let corner = |word: &str| {
                    let index = word.split('/').next().unwrap_or_default();
                    let parsed = index.parse::<i64>().ok().filter(|index| *index != 0);
                    parsed.ok_or_else(|| Fault::at_line(line, format!("`{word}` is no corner of a face, expected the number of a vertex, from 1")))
                };
                let corners = words.map(corner).collect::<Result<Vec<i64>, Fault>>()?;
                if corners.len() < 3 {
                    return Err(Fault::at_line(
                        line,
                        format!("a face of {} corners, expected 3 or more", corners.len()),
                    ));
                }
                self.faces.push(Face {
                    line,
                    corners,
                    known: self.points.len(),
                    material: self.material.clone(),
                });
            }
            "usemtl" => statement.trim_start()[6..]
                .trim()
                .clone_into(&mut self.material),
            "mtllib" => {
                let names = statement.trim_start()[6..].trim();
                let whole = std::iter::once(names);
                for name in whole.chain(words) {
                    if let Ok(bytes) = crate::file::read(folder.join(name.replace('\\', "/"))) {
                        self.colours.extend(colours(&decoded(&bytes)));
                    }
                }
            }
            "curv" | "curv2" | "surf" => {
                self.free_form.get_or_insert(line);
            }
            "call" => {
                return Err(Fault::unsupported(
                    format!("line {line}: `call` of another file"),
                    "export the part as one file",
                ));
            }
            _ => {}
        }
        Ok(())
    }

    fn finish(self) -> Result<MeshFile, Fault> {
        if let Some(line) = self.free_form {
            return Err(Fault::unsupported(
                format!("line {line}: a free-form curve or surface"),
                "export the part with faces (polygons)",
            ));
        }
        let count = self.points.len();
        let mut parts: BTreeMap<&str, MeshPart> = BTreeMap::new();
        let (mut bent, mut doubtful) = (Vec::new(), None);
        for face in &self.faces {
            let index = |&corner: &i64| {
                let index = if corner > 0 {
                    corner - 1
                } else {
                    face.known as i64 + corner
                };
                let index = usize::try_from(index).ok().filter(|index| *index < count);
                index.map(|index| index as u32).ok_or_else(|| {
                    Fault::at_line(
                        face.line,
                        format!("a face refers to the missing vertex {corner} (there are {count})"),
                    )
                })
            };
            let corners = face
                .corners
                .iter()
                .map(index)
                .collect::<Result<Vec<u32>, Fault>>()?;
            let Some(split) = split(&self.points, &corners, &[]) else {
                return Err(Fault::at_line(
                    face.line,
                    "the sides of a face cross each other, expected a plane face, or triangles",
                ));
            };
            bent.extend(split.off_plane.map(|off| (face.line, off)));
            if split.folded && doubtful.is_none() {
                doubtful = Some(format!(
                    "line {}: the corners of a face lie {:.3} units off a plane, and split one way or the other it is another shape; expected plane faces: export the part with triangles",
                    face.line,
                    split.off_plane.unwrap_or_default()
                ));
            }
            let part = parts.entry(&face.material).or_default();
            part.triangles.extend(split.triangles);
        }
        let mut notes = Vec::new();
        if let Some(&(line, off)) = bent.iter().max_by(|one, other| one.1.total_cmp(&other.1)) {
            notes.push(format!(
                "{} of its faces are not plane (line {line}: by {off:.3} of its units): they were split where they fold the least",
                bent.len()
            ));
        }
        let used = parts.into_iter().map(|(material, part)| MeshPart {
            colour: self.colours.get(material).copied(),
            ..with_own_points(&self.points, &part.triangles)
        });
        Ok(MeshFile {
            notes,
            doubtful,
            ..MeshFile::unitless(used.collect())
        })
    }
}

/// Triangles with the points that they use.
fn with_own_points(points: &[DVec3], triangles: &[[u32; 3]]) -> MeshPart {
    let mut own = BTreeMap::new();
    let mut part = MeshPart::default();
    for triangle in triangles {
        let corners = triangle.map(|corner| {
            *own.entry(corner).or_insert_with(|| {
                part.points.push(points[corner as usize]);
                part.points.len() as u32 - 1
            })
        });
        part.triangles.push(corners);
    }
    part
}

/// Diffuse colours of a material library.
fn colours(text: &str) -> BTreeMap<String, [f64; 4]> {
    let mut found: BTreeMap<String, [f64; 4]> = BTreeMap::new();
    let mut name = String::new();
    for line in lines(text) {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let numbers: Vec<f64> = words.filter_map(|word| number(word).ok()).collect();
        match (keyword, &numbers[..]) {
            ("newmtl", _) => line.trim_start()[6..].trim().clone_into(&mut name),
            ("Kd", &[red, green, blue, ..]) => {
                found.entry(name.clone()).or_insert([0.0, 0.0, 0.0, 1.0])[..3]
                    .copy_from_slice(&[red, green, blue]);
            }
            _ => {}
        }
    }
    found
}
