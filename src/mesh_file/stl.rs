//! STL: binary by its size, else text if it names facets.

use glam::DVec3;

use super::scene::{Fault, MeshFile, MeshPart, bounded};
use super::text::{decoded, lines, number};

/// Length of a binary file's header with the count of triangles, and of each triangle [bytes].
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn parse(bytes: &[u8]) -> Result<MeshFile, Fault> {
    let declared = bytes
        .get(HEADER - 4..HEADER)
        .map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize);
    let fits = declared.is_some_and(|count| count * TRIANGLE == bytes.len() - HEADER);
    // Headers of binary files may begin with "solid" too: the size decides.
    if !fits && is_text(bytes) {
        return text(&decoded(bytes));
    }
    let Some(declared) = declared else {
        return Err(Fault::malformed(format!(
            "{} bytes are too few for a binary STL's header of {HEADER}, and it is no text that begins with `solid`",
            bytes.len()
        )));
    };
    binary(&bytes[HEADER..], declared)
}

/// Whether a file is a text: no letter of it is a zero (but those of UTF-16, and padding), and it names facets or ends at once.
fn is_text(bytes: &[u8]) -> bool {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return true;
    }
    let end = bytes
        .iter()
        .rposition(|byte| *byte != 0)
        .map_or(0, |last| last + 1);
    if bytes[..end].contains(&0) {
        return false;
    }
    let head = bytes[..bytes.len().min(1 << 20)].to_ascii_lowercase();
    let has = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    has(b"facet") || has(b"endsolid") || has(b"vertex")
}

fn binary(body: &[u8], declared: usize) -> Result<MeshFile, Fault> {
    let present = body.len();
    let whole = present / TRIANGLE;
    // Programs that write while they count leave the count open.
    let uncounted = declared == 0 || declared == u32::MAX as usize;
    let mut notes = Vec::new();
    let count = if uncounted && present > 0 && present.is_multiple_of(TRIANGLE) {
        notes.push(format!(
            "its header counts {declared} triangles, and {whole} follow, which were read"
        ));
        whole
    } else if declared * TRIANGLE > present {
        return Err(Fault::malformed(format!(
            "the STL header announces {declared} triangles ({} bytes), but {present} bytes follow it",
            declared * TRIANGLE
        )));
    } else {
        if declared * TRIANGLE < present {
            notes.push(format!(
                "{} bytes behind the {declared} triangles that its header counts were left out",
                present - declared * TRIANGLE
            ));
        }
        declared
    };
    bounded(count, 3 * count)?;
    let coordinate = |record: &[u8], place: usize| {
        let four = &record[12 + 4 * place..16 + 4 * place];
        f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
    };
    let mut part = MeshPart::default();
    for record in body.chunks_exact(TRIANGLE).take(count) {
        let corners = [0, 3, 6].map(|at| {
            DVec3::new(
                coordinate(record, at),
                coordinate(record, at + 1),
                coordinate(record, at + 2),
            )
        });
        add(&mut part, corners);
    }
    Ok(MeshFile {
        notes,
        ..MeshFile::unitless(vec![part])
    })
}

fn add(part: &mut MeshPart, corners: [DVec3; 3]) {
    let first = part.points.len() as u32;
    part.points.extend(corners);
    part.triangles.push([first, first + 1, first + 2]);
}

/// A text's words with their lines. The rest of a `solid` or `endsolid` line is a name; what stands before the first is a greeting.
fn text(text: &str) -> Result<MeshFile, Fault> {
    let mut reader = Facets::default();
    for (index, line) in lines(text).enumerate() {
        reader.line(index + 1, line)?;
    }
    if reader.open {
        return Err(Fault::malformed(
            "the text ends within a facet: it is cut short",
        ));
    }
    let mut notes = Vec::new();
    if !reader.closed {
        notes.push(
            "its text ends without `endsolid`; if it was cut short, triangles are missing"
                .to_owned(),
        );
    }
    Ok(MeshFile {
        notes,
        ..MeshFile::unitless(vec![reader.part])
    })
}

/// The facets of a text, as far as it is read.
#[derive(Default)]
struct Facets {
    part: MeshPart,
    corners: Vec<DVec3>,
    /// Coordinates of a vertex that is begun.
    vertex: Option<Vec<f64>>,
    started: bool,
    open: bool,
    closed: bool,
}

impl Facets {
    fn line(&mut self, line: usize, text: &str) -> Result<(), Fault> {
        let lower = text.to_ascii_lowercase();
        let first = lower.split_ascii_whitespace().next().unwrap_or_default();
        let mut from = 0;
        if self.vertex.is_none() && (first == "solid" || first == "endsolid") {
            if self.open {
                return Err(Fault::at_line(line, format!("`{first}` within a facet")));
            }
            self.started = true;
            self.closed = first == "endsolid";
            // All on one line, or a name to its end.
            match lower.find(" facet normal") {
                Some(place) => from = place,
                None => return Ok(()),
            }
        } else if !self.started {
            if first != "facet" {
                return Ok(());
            }
            self.started = true;
        }
        let words = lower[from..].split_ascii_whitespace();
        for word in words {
            if let Some(vertex) = &mut self.vertex {
                vertex.push(
                    number(word)
                        .map_err(|reason| Fault::at_line(line, format!("of a vertex {reason}")))?,
                );
                if let [x, y, z] = vertex[..] {
                    self.corners.push(DVec3::new(x, y, z));
                    self.vertex = None;
                }
                continue;
            }
            match word {
                "facet" if self.open => return Err(Fault::at_line(line, "`facet` within a facet")),
                "facet" => {
                    self.open = true;
                    self.closed = false;
                }
                "vertex" if self.open => self.vertex = Some(Vec::new()),
                "endfacet" => self.close(line)?,
                "endsolid" if !self.open => {
                    self.closed = true;
                    return Ok(());
                }
                // Normals, which triangles say themselves, and what frames a loop.
                _ if self.open => {}
                // Between facets: a name that went on, a remark, the next file's greeting.
                _ => return Ok(()),
            }
        }
        Ok(())
    }

    fn close(&mut self, line: usize) -> Result<(), Fault> {
        let corners = std::mem::take(&mut self.corners);
        let &[a, b, c] = &corners[..] else {
            return Err(Fault::at_line(
                line,
                format!("a facet of {} vertices, expected 3", corners.len()),
            ));
        };
        add(&mut self.part, [a, b, c]);
        bounded(self.part.triangles.len(), self.part.points.len())?;
        self.open = false;
        Ok(())
    }
}
