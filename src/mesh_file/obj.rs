//! Wavefront OBJ: vertices and faces; of materials the colour.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;

use super::polygon::{Effort, split};
use super::scene::{Fault, MeshFile, MeshPart, bounded};
use super::text::{decoded, lines, number, shown};

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<MeshFile, Fault> {
    let text = decoded(bytes);
    let mut reader = Reader::default();
    let mut lines = lines(&text).enumerate();
    while let Some((index, first)) = lines.next() {
        let mut line = first.trim_end().to_owned();
        // A backslash at its end goes on with the next.
        while let Some(begun) = line.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, next)| next.trim_end());
            line.truncate(begun.len());
            line.push(' ');
            line.push_str(next);
        }
        let statement = line.split('#').next().unwrap_or_default();
        reader.statement(index + 1, statement, folder)?;
    }
    reader.finish()
}

/// Libraries of materials that are read, at most.
const MOST_LIBRARIES: usize = 100;

/// A face with the line that it stands in.
struct Face {
    line: u32,
    /// Where its corners end in the list of all.
    end: u32,
    material: u32,
}

#[derive(Default)]
struct Reader {
    points: Vec<DVec3>,
    faces: Vec<Face>,
    /// Corners of the faces, one after the other: a vertex may follow on its face.
    corners: Vec<u32>,
    /// Names of materials by their numbers, and their numbers.
    materials: Vec<String>,
    numbers: BTreeMap<String, u32>,
    material: u32,
    libraries: BTreeSet<String>,
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
                    [x, y, z] => {
                        self.points.push(DVec3::new(x, y, z));
                        bounded(0, self.points.len())?;
                    }
                    _ => {
                        return Err(Fault::at_line(
                            line,
                            "a vertex of less than three coordinates",
                        ));
                    }
                }
            }
            "f" | "fo" => {
                self.face(line, words)?;
            }
            "usemtl" => {
                let name = statement.trim_start()[6..].trim();
                self.material = self.number_of(name);
            }
            "mtllib" => {
                let names = statement.trim_start()[6..].trim();
                let whole = std::iter::once(names);
                for name in whole.chain(words) {
                    self.library(name, folder);
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

    fn face<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a str>) -> Result<(), Fault> {
        let begin = self.corners.len();
        for word in words {
            let index = word.split('/').next().unwrap_or_default();
            let parsed = index.parse::<i64>().ok().filter(|index| *index != 0);
            let Some(given) = parsed else {
                let word = shown(word);
                return Err(Fault::at_line(
                    line,
                    format!(
                        "`{word}` is no corner of a face, expected the number of a vertex, from 1"
                    ),
                ));
            };
            // Negative ones count back from the vertices known by now.
            let index = match given > 0 {
                true => given - 1,
                false => self.points.len() as i64 + given,
            };
            self.corners.push(u32::try_from(index).map_err(|_| {
                let count = self.points.len();
                Fault::at_line(
                    line,
                    format!("a face refers to the missing vertex {given} (there are {count})"),
                )
            })?);
            bounded(self.corners.len() / 3, self.points.len())?;
        }
        let count = self.corners.len() - begin;
        if count < 3 {
            return Err(Fault::at_line(
                line,
                format!("a face of {count} corners, expected 3 or more"),
            ));
        }
        self.faces.push(Face {
            line: line as u32,
            end: self.corners.len() as u32,
            material: self.material,
        });
        bounded(self.faces.len(), self.points.len())
    }

    /// A material's number, from 1; faces before one is named have 0.
    fn number_of(&mut self, name: &str) -> u32 {
        if let Some(known) = self.numbers.get(name) {
            return *known;
        }
        self.materials.push(name.to_owned());
        let number = self.materials.len() as u32;
        self.numbers.insert(name.to_owned(), number);
        number
    }

    fn material_of(&self, face: &Face) -> &str {
        let own = self.materials.get((face.material as usize).wrapping_sub(1));
        own.map_or("", String::as_str)
    }

    /// Colours of a library beside the file, which is read once however often it is named.
    fn library(&mut self, name: &str, folder: &Path) {
        if self.libraries.len() >= MOST_LIBRARIES || !self.libraries.insert(name.to_owned()) {
            return;
        }
        if let Ok(bytes) = crate::file::read(folder.join(name.replace('\\', "/"))) {
            self.colours.extend(colours(&decoded(&bytes)));
        }
    }

    fn finish(self) -> Result<MeshFile, Fault> {
        if let Some(line) = self.free_form {
            return Err(Fault::unsupported(
                format!("line {line}: a free-form curve or surface"),
                "export the part with faces (polygons)",
            ));
        }
        let count = self.points.len();
        bounded(0, count)?;
        let (effort, mut begin, mut triangles) = (Effort::new(), 0, 0);
        let mut parts: BTreeMap<&str, MeshPart> = BTreeMap::new();
        let (mut bent, mut doubtful) = (Vec::new(), None);
        for face in &self.faces {
            let line = face.line as usize;
            let corners = &self.corners[begin..face.end as usize];
            begin = face.end as usize;
            if let Some(corner) = corners.iter().find(|corner| **corner as usize >= count) {
                let corner = u64::from(*corner) + 1;
                return Err(Fault::at_line(
                    line,
                    format!("a face refers to the missing vertex {corner} (there are {count})"),
                ));
            }
            let split = split(&self.points, corners, &[], &effort)
                .map_err(|reason| Fault::at_line(line, reason))?;
            triangles += split.triangles.len();
            bounded(triangles, count)?;
            bent.extend(split.off_plane.map(|off| (face.line, off)));
            if split.folded && doubtful.is_none() {
                doubtful = Some(format!(
                    "line {}: the corners of a face lie {:.3} units off a plane, and split one way or the other it is another shape; expected plane faces: export the part with triangles",
                    face.line,
                    split.off_plane.unwrap_or_default()
                ));
            }
            let part = parts.entry(self.material_of(face)).or_default();
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
