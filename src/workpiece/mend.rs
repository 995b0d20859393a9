//! Small flaws of a surface mended, with a record of what and where: what is left is as closed as its file allows.
//!
//! Mended is what has one reading: faces that stand twice, faces wound against their neighbours, vertices of one place that were
//! written as two, vertices on a neighbour's side, fins, edges at which two bodies touch, holes that are small or lie within a plane face.
//! Anything else stays as it is, for the check of the surface to refuse.

mod borders;
mod holes;
mod separate;
mod sheets;
mod sides;
mod turn;

use glam::DVec3;

use self::sides::Sides;
use super::error::{NO_VOLUME, in_millimetres};
use super::repair::{Connected, extent};

/// Tolerances within which borders are joined: shares of the part's extent, the finest first [1].
const JOINTS: [f64; 4] = [1e-6, 1e-5, 1e-4, 5e-4];
/// Most of the volume that mending may leave open [1].
const OPEN_VOLUME: f64 = 1e-3;

/// Most cells and vertices that are looked at to join borders: some seconds.
const MOST_WORK: usize = 10_000_000;

/// What was mended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Flaw {
    /// Faces that stood there twice.
    Twice,
    /// Faces that are no part of the closed surface.
    Fin,
    /// Faces wound against their neighbours.
    Turned,
    /// All faces wound inwards.
    InsideOut,
    /// Vertices that were written as two.
    Unwelded,
    /// Vertices on a side of a neighbour's face.
    OnSide,
    /// Faces without area.
    Needle,
    /// Edges at which the surface touches itself.
    Touching,
    /// Holes.
    Hole,
}

impl Flaw {
    /// Its name for a count.
    fn named(self, count: usize) -> String {
        let (one, many, done) = match self {
            Self::Twice => (
                "face that stood there twice",
                "faces that stood there twice",
                "taken out",
            ),
            Self::Fin => (
                "face that bounds no volume",
                "faces that bound no volume",
                "taken out",
            ),
            Self::Turned => (
                "face wound against its neighbours",
                "faces wound against their neighbours",
                "turned",
            ),
            Self::InsideOut => (
                "face, all wound inwards",
                "faces, all wound inwards",
                "turned",
            ),
            Self::Unwelded => (
                "vertex beside the one that it belongs to",
                "vertices beside those that they belong to",
                "joined",
            ),
            Self::OnSide => (
                "vertex on a side of a neighbour's face",
                "vertices on sides of neighbours' faces",
                "joined",
            ),
            Self::Needle => ("face without area", "faces without area", "taken out"),
            Self::Touching => (
                "edge at which the surface touches itself",
                "edges at which the surface touches itself",
                "separated",
            ),
            Self::Hole => ("hole", "holes", "closed"),
        };
        format!("{count} {} {done}", if count == 1 { one } else { many })
    }
}

/// One kind of flaw that was mended, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Mended {
    /// Its kind.
    pub flaw: Flaw,
    /// Where each was, in the part frame [m].
    pub places: Vec<DVec3>,
}

/// Places that a note names at most.
const NAMED: usize = 5;

impl Mended {
    /// In words, with the first places.
    #[must_use]
    pub fn note(&self) -> String {
        let places: Vec<String> = self
            .places
            .iter()
            .take(NAMED)
            .map(|place| in_millimetres(*place))
            .collect();
        let more = match self.places.len() {
            count if count > NAMED => format!(" and {} more", count - NAMED),
            _ => String::new(),
        };
        format!(
            "mended: {}, at {} mm{more}",
            self.flaw.named(self.places.len()),
            places.join(", ")
        )
    }
}

/// A surface on its way.
pub(super) struct Surface {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    mended: Vec<Mended>,
    /// Bound on the volume that mending leaves open [m^3].
    open_volume: f64,
    /// Cells and vertices that were looked at to join borders.
    work: usize,
}

impl Surface {
    fn at(&self, vertex: u32) -> DVec3 {
        self.vertices[vertex as usize]
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.at(vertex))
    }

    /// Normal as long as twice the area.
    fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    fn area(&self, triangle: usize) -> f64 {
        0.5 * self.normal(triangle).length()
    }

    fn whole_area(&self) -> f64 {
        (0..self.triangles.len())
            .map(|triangle| self.area(triangle))
            .sum()
    }

    fn middle(&self, triangle: usize) -> DVec3 {
        self.corners(triangle).into_iter().sum::<DVec3>() / 3.0
    }

    fn volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default();
        let of = |triangle: usize| {
            let [a, b, c] = self.corners(triangle).map(|corner| corner - origin);
            a.dot(b.cross(c)) / 6.0
        };
        (0..self.triangles.len()).map(of).sum()
    }

    fn record(&mut self, flaw: Flaw, places: impl IntoIterator<Item = DVec3>) {
        let mut places = places.into_iter().peekable();
        if places.peek().is_none() {
            return;
        }
        match self.mended.iter_mut().find(|mended| mended.flaw == flaw) {
            Some(mended) => mended.places.extend(places),
            None => self.mended.push(Mended {
                flaw,
                places: places.collect(),
            }),
        }
    }

    /// Leaves triangles out.
    fn without(&mut self, out: &[bool]) {
        let mut index = 0;
        self.triangles.retain(|_| {
            index += 1;
            !out[index - 1]
        });
    }

    fn is_closed(&self) -> bool {
        Sides::new(&self.triangles)
            .all()
            .all(|side| side.is_sound())
    }
}

/// A mended surface: vertices, triangles and what was done; as it was where that is not enough.
pub(super) fn mended(connected: &Connected) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<Mended>) {
    let (vertices, triangles) = (&connected.vertices, &connected.triangles);
    let as_it_was = || (vertices.clone(), triangles.clone(), Vec::new());
    let mut surface = Surface {
        vertices: vertices.clone(),
        triangles: triangles.clone(),
        mended: Vec::new(),
        open_volume: 0.0,
        work: 0,
    };
    surface.record(Flaw::Needle, connected.needles.iter().copied());
    let size = extent(vertices);
    if !surface.is_closed() || surface.has_needles(size) {
        surface.take_out_copies();
        surface.take_out_twice();
        surface.take_out_needles(size);
        surface.join_all(size);
        if surface.is_beyond_mending() {
            return as_it_was();
        }
        surface.take_out_fins();
        surface.join_all(size);
        surface.turn();
        surface.separate_touching();
        surface.turn();
        surface.close_holes(size);
        if surface.is_beyond_mending()
            || !surface.is_closed()
            || surface.open_volume > OPEN_VOLUME * surface.volume().abs()
        {
            return as_it_was();
        }
    }
    let volume = surface.volume();
    if volume < -NO_VOLUME {
        let places: Vec<DVec3> = (0..surface.triangles.len())
            .map(|triangle| surface.middle(triangle))
            .collect();
        surface.record(Flaw::InsideOut, places);
        for triangle in &mut surface.triangles {
            triangle.swap(1, 2);
        }
    }
    (surface.vertices, surface.triangles, surface.mended)
}

impl Surface {
    /// Whether there is so much border that its flaws are not small ones.
    fn is_beyond_mending(&self) -> bool {
        self.work > MOST_WORK
    }

    /// Joins borders, as far apart as each tolerance allows, until there are none.
    fn join_all(&mut self, size: f64) {
        for share in JOINTS {
            if self.is_beyond_mending() || Sides::new(&self.triangles).open().next().is_none() {
                return;
            }
            self.join_vertices(share * size);
            self.join_sides(share * size);
        }
    }
}

#[cfg(test)]
mod tests;
