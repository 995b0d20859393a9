//! Where a ball touches a part: the genuine local minima of the distance from its centre.
//!
//! The closest points of all triangles near the ball's centre include many that are no contact: on
//! the border of a triangle whose neighbour comes closer (a "ghost" contact on an internal edge), and
//! the same edge or vertex once for each triangle around it. A closest point q of a convex triangle is
//! a local minimum of the distance from c to the whole surface exactly if it is the closest point of
//! each triangle that contains it, that is if (c - q) points into none of them. For q inside an edge
//! that is one test against the neighbour, for q on a vertex one against each edge that leaves it.
//! The closest point of a triangle: C. Ericson, Real-Time Collision Detection (2005), 5.1.5. The sign
//! of the distance: J. A. Baerentzen, H. Aanaes, IEEE Trans. Vis. Comput. Graph. 11(3) (2005).

use glam::DVec3;

use super::bvh::{Bounds, Bvh};
use super::mesh::TriangleMesh;
use super::topology::{next_in_triangle, start_of, triangle_of};

/// Distance at which a point may lie beyond a border and still count as on it [m].
const BORDER_TOLERANCE: f64 = 1e-9;

/// Contacts whose normals differ by less than this angle's cosine are one contact: in a concave arc
/// the ball touches two facets at once wherever it passes from one to the next (3 degrees).
const SAME_CONTACT_COSINE: f64 = 0.998_629_534_754_574;

/// Part of a triangle on which a contact lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SurfaceFeature {
    /// Inside the triangle.
    Face,
    /// On one of its edges.
    Edge,
    /// On one of its vertices.
    Vertex,
}

/// A genuine contact, in the part frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceContact {
    /// Triangle, as in [`TriangleMesh::triangles`]; of several with the same contact one that has
    /// the point inside, else the lowest.
    pub triangle: u32,
    /// Part of that triangle.
    pub feature: SurfaceFeature,
    /// Point on the surface [m].
    pub point: DVec3,
    /// Unit normal, out of the part.
    pub normal: DVec3,
    /// Distance of the ball's centre from the point, negative with the centre inside the part [m].
    pub distance: f64,
}

/// A triangle as the search for the closest point needs it, small for the cache's sake.
#[derive(Debug, Clone)]
struct Facet {
    corners: [DVec3; 3],
    normal: DVec3,
    triangle: u32,
}

/// Neighbours of a triangle; edge `k` runs from corner `k` to corner `k + 1`.
#[derive(Debug, Clone)]
struct Surroundings {
    /// For each edge the unit vector in the neighbour's plane from the edge into the neighbour.
    into_neighbour: [DVec3; 3],
    /// Pseudo-normals of the edges (sum of both faces') and of the vertices (weighted by angle).
    edge_normals: [DVec3; 3],
    vertex_normals: [DVec3; 3],
    /// For each corner the range in `ContactSurface::spokes` of the edges that leave it.
    spokes: [(u32, u32); 3],
}

/// A part's surface, prepared for contact queries.
#[derive(Debug, Clone)]
pub struct ContactSurface {
    /// In the order of the tree's leaves.
    facets: Vec<Facet>,
    /// In the order of the mesh's triangles.
    surroundings: Vec<Surroundings>,
    /// Unit directions of the edges that leave each vertex.
    spokes: Vec<DVec3>,
    tree: Bvh,
}

impl ContactSurface {
    /// Prepares a part.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let corners_of = |triangle: usize| {
            mesh.triangles()[triangle].map(|vertex| mesh.vertices()[vertex as usize])
        };
        let count = mesh.triangles().len();
        let boxes: Vec<Bounds> = (0..count).map(|t| Bounds::of(corners_of(t))).collect();
        let tree = Bvh::new(&boxes);
        let facets = tree.order().iter().map(|&triangle| Facet {
            corners: corners_of(triangle as usize),
            normal: mesh.face_normals()[triangle as usize],
            triangle,
        });
        let stars = Stars::new(mesh);
        Self {
            facets: facets.collect(),
            surroundings: (0..count)
                .map(|triangle| stars.surroundings(mesh, triangle, corners_of(triangle)))
                .collect(),
            spokes: stars.spokes,
            tree,
        }
    }

    /// Puts into `out` the genuine contacts of a ball around `centre` [m] whose distance is at most
    /// `reach` [m], nearest first. Nothing is allocated once `out` has room.
    ///
    /// With the centre inside the part (up to `reach` deep) only the nearest contact is given, with
    /// negative distance. With the centre outside, surfaces that face away from it are left out:
    /// they are the far side of a thin wall.
    pub fn genuine_contacts(&self, centre: DVec3, reach: f64, out: &mut Vec<SurfaceContact>) {
        out.clear();
        let limit = reach * reach;
        self.tree.visit_near(centre, reach, |index| {
            let facet = &self.facets[index];
            let (point, place) = facet.closest_point(centre);
            let to_centre = centre - point;
            if to_centre.length_squared() <= limit {
                let surroundings = &self.surroundings[facet.triangle as usize];
                if self.is_local_minimum(surroundings, to_centre, place) {
                    insert(out, facet.contact(surroundings, point, to_centre, place));
                }
            }
        });
        out.sort_unstable_by(|one, other| {
            let order = one.distance.abs().total_cmp(&other.distance.abs());
            order.then(one.triangle.cmp(&other.triangle))
        });
        if out.first().is_some_and(|nearest| nearest.distance < 0.0) {
            out.truncate(1);
        } else {
            out.retain(|contact| contact.distance >= 0.0);
        }
    }

    /// Whether no triangle that contains the point comes closer to the centre.
    fn is_local_minimum(&self, around: &Surroundings, to_centre: DVec3, place: Place) -> bool {
        match place {
            Place::Face => true,
            Place::Edge(edge) => to_centre.dot(around.into_neighbour[edge]) <= BORDER_TOLERANCE,
            Place::Vertex(corner) => {
                let (first, end) = around.spokes[corner];
                self.spokes[first as usize..end as usize]
                    .iter()
                    .all(|&spoke| to_centre.dot(spoke) <= BORDER_TOLERANCE)
            }
        }
    }
}

/// Adds a contact, unless it is there already: the same point found from a neighbouring triangle, or
/// the next facet of the same smooth surface.
fn insert(out: &mut Vec<SurfaceContact>, new: SurfaceContact) {
    for known in out.iter_mut() {
        let same_point = known.point.distance_squared(new.point)
            <= (4.0 * BORDER_TOLERANCE) * (4.0 * BORDER_TOLERANCE);
        if same_point {
            if (new.feature, new.triangle) < (known.feature, known.triangle) {
                *known = new;
            }
            return;
        }
        if known.normal.dot(new.normal) > SAME_CONTACT_COSINE {
            let order = new.distance.abs().total_cmp(&known.distance.abs());
            if order.then(new.triangle.cmp(&known.triangle)).is_lt() {
                *known = new;
            }
            return;
        }
    }
    out.push(new);
}

/// Where in a triangle a point lies; edge `k` runs from corner `k` to corner `k + 1`.
#[derive(Debug, Clone, Copy)]
enum Place {
    Face,
    Edge(usize),
    Vertex(usize),
}

impl Facet {
    /// The point of the triangle that is closest to `centre`.
    fn closest_point(&self, centre: DVec3) -> (DVec3, Place) {
        let [a, b, c] = self.corners;
        let (ab, ac) = (b - a, c - a);
        let ap = centre - a;
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (a, Place::Vertex(0));
        }
        let bp = centre - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return (b, Place::Vertex(1));
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (a + ab * (d1 / (d1 - d3)), Place::Edge(0));
        }
        let cp = centre - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return (c, Place::Vertex(2));
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (a + ac * (d2 / (d2 - d6)), Place::Edge(2));
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            return (b + (c - b) * share, Place::Edge(1));
        }
        // The foot of the perpendicular, which is exact in the plane however thin the triangle is.
        (centre - self.normal * self.normal.dot(ap), Place::Face)
    }

    fn contact(
        &self,
        around: &Surroundings,
        point: DVec3,
        to_centre: DVec3,
        place: Place,
    ) -> SurfaceContact {
        let (feature, outward) = match place {
            Place::Face => (SurfaceFeature::Face, self.normal),
            Place::Edge(edge) => (SurfaceFeature::Edge, around.edge_normals[edge]),
            Place::Vertex(corner) => (SurfaceFeature::Vertex, around.vertex_normals[corner]),
        };
        let side = if to_centre.dot(outward) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let (normal, distance) = match place {
            Place::Face => (self.normal, to_centre.dot(self.normal)),
            _ => {
                let length = to_centre.length();
                let normal = if length > BORDER_TOLERANCE {
                    to_centre * (side / length)
                } else {
                    outward.normalize_or(self.normal)
                };
                (normal, side * length)
            }
        };
        SurfaceContact {
            triangle: self.triangle,
            feature,
            point,
            normal,
            distance,
        }
    }
}

/// The surroundings of each vertex.
struct Stars {
    normals: Vec<DVec3>,
    spokes: Vec<DVec3>,
    ranges: Vec<(u32, u32)>,
}

impl Stars {
    fn new(mesh: &TriangleMesh) -> Self {
        let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
        let mut normals = vec![DVec3::ZERO; vertices.len()];
        let mut leaving = vec![Vec::new(); vertices.len()];
        for half_edge in 0..3 * triangles.len() as u32 {
            let next = next_in_triangle(half_edge);
            let vertex = start_of(triangles, half_edge) as usize;
            let at = |edge| vertices[start_of(triangles, edge) as usize];
            let to_next = at(next) - vertices[vertex];
            let to_last = at(next_in_triangle(next)) - vertices[vertex];
            let normal = mesh.face_normals()[triangle_of(half_edge)];
            normals[vertex] += normal * to_next.angle_between(to_last);
            // The surface is closed: each edge leaves its vertex in exactly one triangle.
            leaving[vertex].push(to_next.normalize());
        }
        let mut spokes = Vec::with_capacity(3 * triangles.len());
        let ranges = leaving
            .into_iter()
            .map(|directions| {
                let first = spokes.len() as u32;
                spokes.extend(directions);
                (first, spokes.len() as u32)
            })
            .collect();
        Self {
            normals,
            spokes,
            ranges,
        }
    }

    fn surroundings(
        &self,
        mesh: &TriangleMesh,
        triangle: usize,
        corners: [DVec3; 3],
    ) -> Surroundings {
        let vertices = mesh.triangles()[triangle];
        let neighbour_normals = [0, 1, 2].map(|edge| {
            let twin = mesh.topology().twin(3 * triangle as u32 + edge);
            mesh.face_normals()[triangle_of(twin)]
        });
        Surroundings {
            into_neighbour: [0, 1, 2].map(|edge| {
                let along = (corners[(edge + 1) % 3] - corners[edge]).normalize();
                // The neighbour runs along the edge the other way, with itself on its left.
                neighbour_normals[edge].cross(-along)
            }),
            edge_normals: neighbour_normals.map(|other| mesh.face_normals()[triangle] + other),
            vertex_normals: vertices.map(|vertex| self.normals[vertex as usize]),
            spokes: vertices.map(|vertex| self.ranges[vertex as usize]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh::shapes::{gridded_box, prism};
    use super::super::part_file::load_mesh;
    use super::*;
    use std::path::Path;

    const RADIUS: f64 = 5e-3;

    fn contacts(surface: &ContactSurface, centre: DVec3, reach: f64) -> Vec<SurfaceContact> {
        let mut out = Vec::new();
        surface.genuine_contacts(centre, reach, &mut out);
        out
    }

    /// A sphere of 50 mm radius with bumps of 3 mm: convex and concave edges everywhere.
    fn bumpy_sphere() -> TriangleMesh {
        let (rings, sectors) = (30, 60);
        let at = |ring: usize, sector: usize| {
            let polar = std::f64::consts::PI * ring as f64 / rings as f64;
            let azimuth = std::f64::consts::TAU * (sector % sectors) as f64 / sectors as f64;
            let bumps = (7.0 * polar).sin() * (5.0 * azimuth).cos() * polar.sin();
            let (sin, cos) = azimuth.sin_cos();
            DVec3::new(polar.sin() * cos, polar.sin() * sin, polar.cos()) * (0.05 + 0.003 * bumps)
        };
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for ring in 0..rings {
            for sector in 0..sectors {
                let base = points.len() as u32;
                points.extend([
                    at(ring, sector),
                    at(ring + 1, sector),
                    at(ring + 1, sector + 1),
                    at(ring, sector + 1),
                ]);
                triangles.push([base, base + 1, base + 2]);
                triangles.push([base, base + 2, base + 3]);
            }
        }
        TriangleMesh::from_loose_triangles(&points, &triangles, 1.0).unwrap()
    }

    #[test]
    fn flat_plate_gives_one_contact_with_its_normal() {
        let mesh = gridded_box(DVec3::new(-0.1, -0.1, -0.02), DVec3::new(0.1, 0.1, 0.0), 20);
        let surface = ContactSurface::new(&mesh);
        let check = |x: f64, y: f64, height: f64| {
            let found = contacts(&surface, DVec3::new(x, y, height), 1.2 * RADIUS);
            assert_eq!(found.len(), 1, "{x} {y}");
            assert!(found[0].normal.distance(DVec3::Z) < 5e-15, "{x} {y}");
            assert!((found[0].distance - height).abs() < 1e-15);
            assert!(found[0].point.distance(DVec3::new(x, y, 0.0)) < 1e-15);
        };
        for i in -4000..=4000 {
            let t = f64::from(i) * 2e-5;
            // Across the diagonals, along them, along a grid line, and just beside each.
            check(t, 0.013 - 0.37 * t, 4.9e-3);
            for offset in [0.0, 1e-10, -1e-9, 3e-9, 1e-6, -1e-5] {
                check(t, t + offset, 4.9e-3);
                check(t, 0.03 + offset, 5.1e-3);
            }
        }
        for i in -9..=9 {
            for offset in [0.0, 1e-12, 1e-9, -2e-9, 1e-7] {
                let t = f64::from(i) * 0.01;
                check(t + offset, t - 2.0 * offset, 4.9e-3);
            }
        }
    }

    #[test]
    fn knife_edge_gives_one_contact_along_the_bisector() {
        let mesh = gridded_box(DVec3::new(-0.1, 0.0, -0.02), DVec3::new(0.1, 0.1, 0.0), 20);
        let surface = ContactSurface::new(&mesh);
        let bisector = DVec3::new(0.0, -1.0, 1.0).normalize();
        for i in -4750..=4750 {
            let foot = DVec3::X * (f64::from(i) * 2e-5);
            let found = contacts(&surface, foot + 4.95e-3 * bisector, 1.2 * RADIUS);
            assert_eq!(found.len(), 1, "{foot}");
            assert!(found[0].normal.distance(bisector) < 1e-13);
            assert!((found[0].distance - 4.95e-3).abs() < 1e-15);
            assert!(found[0].point.distance(foot) < 1e-15);
        }
        // Round the edge from the top face to the side: one contact, the normal turns with the ball.
        for i in -50..=150 {
            let angle = f64::from(i) * 0.9_f64.to_radians();
            let around = DVec3::new(0.0, -angle.sin(), angle.cos());
            let found = contacts(&surface, DVec3::X * 0.0123 + RADIUS * around, 1.2 * RADIUS);
            assert_eq!(found.len(), 1, "{i}");
            if (0..=100).contains(&i) {
                assert!(found[0].normal.distance(around) < 1e-9, "{i}");
            }
        }
    }

    #[test]
    fn box_corner_gives_one_contact() {
        let mesh = gridded_box(DVec3::splat(-0.1), DVec3::ZERO, 10);
        let surface = ContactSurface::new(&mesh);
        for direction in [
            DVec3::ONE,
            DVec3::new(1.0, 2.0, 0.3),
            DVec3::new(0.0, 1.0, 1.0),
        ] {
            let normal = direction.normalize();
            let found = contacts(&surface, RADIUS * normal, 1.01 * RADIUS);
            assert_eq!(found.len(), 1);
            assert!(found[0].normal.distance(normal) < 1e-13);
            assert!(found[0].point.length() < 1e-15);
        }
    }

    #[test]
    fn concave_corner_gives_two_contacts() {
        let outline = [
            [0.0, 0.0],
            [0.2, 0.0],
            [0.2, 0.1],
            [0.1, 0.1],
            [0.1, 0.2],
            [0.0, 0.2],
        ];
        let caps = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
        let surface = ContactSurface::new(&prism(&outline, &caps, 0.05));
        for i in 1..100 {
            let z = -0.05 * f64::from(i) / 100.0;
            let centre = DVec3::new(0.1 + 4.9e-3, 0.1 + 4.8e-3, z);
            let found = contacts(&surface, centre, RADIUS);
            assert_eq!(found.len(), 2);
            assert!(found[0].normal.distance(DVec3::Y) < 1e-12);
            assert!((found[0].distance - 4.8e-3).abs() < 1e-15);
            assert!(found[1].normal.distance(DVec3::X) < 1e-12);
            assert!((found[1].distance - 4.9e-3).abs() < 1e-15);
        }
    }

    #[test]
    fn distance_agrees_with_brute_force_and_is_continuous() {
        let mesh = bumpy_sphere();
        let surface = ContactSurface::new(&mesh);
        let reach = 2.0 * RADIUS;
        let (mut last, mut compared, mut several) = (None::<(DVec3, f64)>, 0, 0);
        for i in 0..4000 {
            let t = f64::from(i) * 5e-3;
            let direction = DVec3::new((1.3 * t).cos(), (1.7 * t).sin(), (0.9 * t).sin());
            let radius = 0.0525 + 0.005 * (2.3 * t).sin();
            let centre = direction.normalize() * radius;
            let found = contacts(&surface, centre, reach);
            several += usize::from(found.len() > 1);
            let facets = surface.facets.iter();
            let brute = facets
                .map(|facet| facet.closest_point(centre).0.distance(centre))
                .fold(f64::INFINITY, f64::min);
            let nearest = found[0];
            assert!((nearest.distance.abs() - brute).abs() < 1e-14);
            let shifted = nearest.point + nearest.normal * nearest.distance;
            assert!(shifted.distance(centre) < 1e-12);
            // Inside and outside by the angle that the surface fills, seen from the centre.
            if i % 10 == 0 {
                let inside = winding(&mesh, centre) > 0.5;
                assert_eq!(nearest.distance < 0.0, inside);
                compared += usize::from(inside);
            }
            if let Some((place, distance)) = last {
                assert!((nearest.distance - distance).abs() <= centre.distance(place) + 1e-12);
            }
            last = Some((centre, nearest.distance));
        }
        assert!(compared > 20, "{compared}");
        assert!(several > 50, "{several}");
    }

    /// Share of the full solid angle that the surface fills around a point (Van Oosterom and
    /// Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983): 1 inside, 0 outside.
    fn winding(mesh: &TriangleMesh, point: DVec3) -> f64 {
        let sum: f64 = mesh
            .triangles()
            .iter()
            .map(|t| t.map(|v| mesh.vertices()[v as usize] - point))
            .map(|[a, b, c]| {
                let (la, lb, lc) = (a.length(), b.length(), c.length());
                let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
                2.0 * a.dot(b.cross(c)).atan2(below)
            })
            .sum();
        sum / (4.0 * std::f64::consts::PI)
    }

    #[test]
    fn centre_inside_gives_a_negative_distance_and_thin_walls_do_not_confuse() {
        let mesh = gridded_box(
            DVec3::new(-0.1, -0.1, -0.002),
            DVec3::new(0.1, 0.1, 0.0),
            10,
        );
        let surface = ContactSurface::new(&mesh);
        for i in -9..=50 {
            let height = f64::from(i) * 1e-4 + 1.3e-6;
            let found = contacts(&surface, DVec3::new(0.0123, 0.0077, height), RADIUS);
            assert_eq!(found.len(), usize::from(height < RADIUS));
            for contact in found {
                assert_eq!(contact.normal, DVec3::Z);
                assert!((contact.distance - height).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn concave_arc_gives_one_contact_at_a_time() {
        // The bracket's fillet of 15 mm, about (75, 75): a ball rolling inside it near z = -7.5 mm.
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/bracket.stl");
        let surface = ContactSurface::new(&load_mesh(&path, 1e-3).unwrap());
        for i in 1..900 {
            let angle = std::f64::consts::PI + f64::from(i) * 0.1_f64.to_radians();
            let outward = DVec3::new(angle.cos(), angle.sin(), 0.0);
            let centre = DVec3::new(0.075, 0.075, -0.0075) + outward * (0.015 - RADIUS + 5e-5);
            let found = contacts(&surface, centre, RADIUS);
            assert_eq!(found.len(), 1, "{i}");
            assert!(found[0].normal.distance(-outward) < 0.02);
            assert!((found[0].distance - (RADIUS - 5e-5)).abs() < 2e-6);
        }
    }
}
