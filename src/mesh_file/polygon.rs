//! Polygons split into triangles: concave ones by ears, with all of their corners kept, so that no neighbour is left with a crack.

use std::cell::Cell;

use glam::{DVec2, DVec3};

/// Twice the area below which an ear has none: share of the polygon's extent squared [1].
const NO_AREA: f64 = 1e-14;
/// Corners that are as far off the polygon's plane as this share of its extent bend it [1].
const BENT: f64 = 1e-4;
/// Fold between a polygon's own triangles from which the file does not say which shape it means [rad].
const FOLDED: f64 = 25.0 * std::f64::consts::PI / 180.0;

/// Looks at corners that splitting the polygons of a file may take: a second or two. Of one polygon they grow as the square of its corners and more.
const MOST_LOOKS: u64 = 300_000_000;

/// What is left of the looks at corners.
pub(super) struct Effort(Cell<u64>);

impl Effort {
    pub(super) fn new() -> Self {
        Self(Cell::new(MOST_LOOKS))
    }

    fn spend(&self, looks: usize) -> Result<(), Unsplit> {
        let left = self.0.get().checked_sub(looks as u64);
        self.0.set(left.unwrap_or(0));
        left.map(|_| ()).ok_or(Unsplit::TooLong)
    }
}

/// Why a polygon is not split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum Unsplit {
    /// Its sides do.
    #[error("the sides of a face cross each other, expected a plane face, or triangles")]
    Crossed,
    /// It has, and those before it had, too many corners.
    #[error(
        "its faces have so many corners that splitting them into triangles is refused, expected fewer corners a face: export the part with triangles"
    )]
    TooLong,
}

/// A polygon's triangles, as indices of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// The triangles, which turn as the polygon does.
    pub triangles: Vec<[u32; 3]>,
    /// How far its corners lie off a plane, where it is bent by that.
    pub off_plane: Option<f64>,
    /// Whether its triangles fold so much that another split is another shape.
    pub folded: bool,
}

/// Splits a polygon with corners `outline` of `points`, concave or not; none where its sides cross each other.
#[must_use]
pub fn split_polygon(points: &[DVec3], outline: &[u32]) -> Option<Split> {
    split(points, outline, &[], &Effort::new()).ok()
}

/// Splits a polygon with corners `outline` of `points` and the holes in it.
pub(super) fn split(
    points: &[DVec3],
    outline: &[u32],
    holes: &[Vec<u32>],
    effort: &Effort,
) -> Result<Split, Unsplit> {
    let mut corners = outline.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let flat = |triangles| Split {
        triangles,
        off_plane: None,
        folded: false,
    };
    if corners.len() < 3 {
        return Ok(flat(Vec::new()));
    }
    if corners.len() == 3 && holes.is_empty() {
        return Ok(flat(vec![[corners[0], corners[1], corners[2]]]));
    }
    let at = |corner: u32| points[corner as usize];
    let start = at(corners[0]);
    let extent = corners
        .iter()
        .map(|&c| at(c).distance(start))
        .fold(0.0, f64::max);
    let Some(normal) = normal(points, &corners).try_normalize() else {
        let aside = |c: &u32, other: &u32| (at(*c) - start).cross(at(*other) - start).length();
        let next = corners.iter().skip(1);
        if corners
            .iter()
            .zip(next)
            .any(|(c, other)| aside(c, other) > 1e-6 * extent * extent)
        {
            // As much of it is wound one way as the other.
            return Err(Unsplit::Crossed);
        }
        // Without area: any triangles do, and all of its corners are in them.
        let fan = (1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]);
        return Ok(flat(fan.collect()));
    };
    let across = normal.any_orthonormal_vector();
    let plane = Plane {
        points,
        axes: [across, normal.cross(across)],
        no_area: NO_AREA * extent * extent,
        effort,
    };
    let joined = plane.with_bridges(corners.clone(), holes)?;
    let off = corners.iter().map(|&c| (at(c) - start).dot(normal));
    let (low, high) = off.fold((0.0_f64, 0.0_f64), |(low, high), off| {
        (low.min(off), high.max(off))
    });
    let bent = high - low > BENT * extent;
    let quad = if joined.len() == 4 {
        plane.quad(&joined)
    } else {
        None
    };
    let triangles = match quad {
        Some(triangles) => triangles,
        None => plane.ears(joined)?,
    };
    if bent {
        effort.spend(triangles.len() * triangles.len() / 2)?;
    }
    let folded = bent && fold(points, &triangles) > FOLDED;
    Ok(Split {
        triangles,
        off_plane: bent.then_some(high - low),
        folded,
    })
}

/// Triangles of a strip, every other one turned.
pub(super) fn strip(corners: &[u32]) -> Vec<[u32; 3]> {
    let turned = |(index, three): (usize, &[u32])| match index % 2 {
        0 => [three[0], three[1], three[2]],
        _ => [three[1], three[0], three[2]],
    };
    corners.windows(3).enumerate().map(turned).collect()
}

/// Triangles of a fan about its first corner.
pub(super) fn fan(corners: &[u32]) -> Vec<[u32; 3]> {
    let Some((first, rest)) = corners.split_first() else {
        return Vec::new();
    };
    rest.windows(2)
        .map(|two| [*first, two[0], two[1]])
        .collect()
}

/// Newell's normal, as long as twice the polygon's area.
fn normal(points: &[DVec3], corners: &[u32]) -> DVec3 {
    let at = |corner: u32| points[corner as usize] - points[corners[0] as usize];
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(&a, &b)| at(a).cross(at(b)))
        .sum()
}

fn normal_of(points: &[DVec3], triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|corner| points[corner as usize]);
    (b - a).cross(c - a)
}

/// Largest angle between triangles that share a side [rad].
fn fold(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let shares =
        |one: &[u32; 3], other: &[u32; 3]| one.iter().filter(|c| other.contains(c)).count() == 2;
    let mut largest: f64 = 0.0;
    for (index, one) in triangles.iter().enumerate() {
        for other in triangles[index + 1..]
            .iter()
            .filter(|other| shares(one, other))
        {
            let normals = [*one, *other].map(|triangle| normal_of(points, triangle));
            if normals.iter().all(|normal| normal.length_squared() > 0.0) {
                largest = largest.max(normals[0].angle_between(normals[1]));
            }
        }
    }
    largest
}

/// The plane that a polygon is seen in, counter-clockwise.
struct Plane<'a> {
    points: &'a [DVec3],
    axes: [DVec3; 2],
    no_area: f64,
    effort: &'a Effort,
}

impl Plane<'_> {
    fn seen(&self, corner: u32) -> DVec2 {
        let point = self.points[corner as usize];
        DVec2::new(point.dot(self.axes[0]), point.dot(self.axes[1]))
    }

    /// Twice the signed area of a triangle.
    fn area(&self, [a, b, c]: [u32; 3]) -> f64 {
        let [a, b, c] = [a, b, c].map(|corner| self.seen(corner));
        (b - a).perp_dot(c - a)
    }

    /// Of a convex quadrangle the diagonal along which it folds less, the shorter one of equals; none if it is concave.
    fn quad(&self, corners: &[u32]) -> Option<Vec<[u32; 3]>> {
        let [a, b, c, d] = [corners[0], corners[1], corners[2], corners[3]];
        let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
        let valid = |way: &&[[u32; 3]; 2]| {
            way.iter()
                .all(|triangle| self.area(*triangle) > self.no_area)
        };
        let key = |way: &[[u32; 3]; 2]| {
            let [from, _, to] = way[0];
            let diagonal = self.points[from as usize].distance(self.points[to as usize]);
            // To a hundredth of a degree, so that rounding decides nothing.
            ((fold(self.points, way) * 5730.0).round(), diagonal)
        };
        let best = ways.iter().filter(valid).min_by(|one, other| {
            let ((fold, length), (other_fold, other_length)) = (key(one), key(other));
            fold.total_cmp(&other_fold)
                .then(length.total_cmp(&(other_length * (1.0 - 1e-9))))
        });
        best.map(|way| way.to_vec())
    }

    /// Clips ears, the one with the widest smallest angle among those at hand first.
    fn ears(&self, mut corners: Vec<u32>) -> Result<Vec<[u32; 3]>, Unsplit> {
        let mut triangles = Vec::new();
        while corners.len() > 3 {
            let count = corners.len();
            self.effort.spend(2 * count)?;
            let reflex: Vec<u32> = (0..count)
                .filter(|&i| self.area(ear(&corners, i)) <= self.no_area)
                .map(|i| corners[i])
                .collect();
            let mut best = None;
            for index in 0..count {
                let ear = ear(&corners, index);
                if self.area(ear) <= self.no_area {
                    continue;
                }
                self.effort.spend(reflex.len())?;
                if !self.is_free(ear, &reflex) {
                    continue;
                }
                let width = self.narrowest(ear);
                if best.is_none_or(|(widest, _)| width > widest) {
                    best = Some((width, index));
                }
                // Of many corners the first good one will do.
                if width > 0.4 || (count > 400 && width > 0.02) {
                    break;
                }
            }
            let Some((_, index)) = best else {
                // Nothing is left of its area: the rest is a line.
                let rest: f64 = (1..count - 1)
                    .map(|i| self.area([corners[0], corners[i], corners[i + 1]]))
                    .sum();
                if rest.abs() > self.no_area * count as f64 {
                    return Err(Unsplit::Crossed);
                }
                triangles.extend((1..count - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
                return Ok(triangles);
            };
            triangles.push(ear(&corners, index));
            corners.remove(index);
        }
        let last = [corners[0], corners[1], corners[2]];
        triangles.push(last);
        match self.area(last) >= -self.no_area {
            true => Ok(triangles),
            false => Err(Unsplit::Crossed),
        }
    }

    /// Whether no other corner lies in an ear or on its sides.
    fn is_free(&self, ear: [u32; 3], reflex: &[u32]) -> bool {
        let places = ear.map(|corner| self.seen(corner));
        reflex
            .iter()
            .filter(|corner| !ear.contains(corner))
            .all(|&corner| {
                let place = self.seen(corner);
                if places.contains(&place) {
                    return true;
                }
                let side = |from: usize, to: usize| {
                    (places[to] - places[from]).perp_dot(place - places[from])
                };
                let inside = side(0, 1) >= -self.no_area
                    && side(1, 2) >= -self.no_area
                    && side(2, 0) >= -self.no_area;
                !inside
            })
    }

    /// Smallest angle of a triangle, as its sine [1].
    fn narrowest(&self, ear: [u32; 3]) -> f64 {
        let area = self.area(ear);
        let [a, b, c] = ear.map(|corner| self.seen(corner));
        let [ab, bc, ca] = [a.distance(b), b.distance(c), c.distance(a)];
        (area / (ab * bc))
            .min(area / (bc * ca))
            .min(area / (ca * ab))
    }

    /// The outline with its holes joined to it, each by a way there and back to a corner that sees it.
    fn with_bridges(&self, mut outline: Vec<u32>, holes: &[Vec<u32>]) -> Result<Vec<u32>, Unsplit> {
        let mut holes: Vec<Vec<u32>> = holes.to_vec();
        let rightmost = |hole: &Vec<u32>| {
            let places = hole.iter().map(|&corner| self.seen(corner).x);
            places.fold(f64::NEG_INFINITY, f64::max)
        };
        holes.retain(|hole| hole.len() > 2);
        holes.sort_by(|one, other| rightmost(other).total_cmp(&rightmost(one)));
        for index in 0..holes.len() {
            let sides = outline.len() + holes[index..].iter().map(Vec::len).sum::<usize>();
            self.effort.spend(10 * sides)?;
            let mut hole = holes[index].clone();
            let area: f64 = (1..hole.len() - 1)
                .map(|i| self.area([hole[0], hole[i], hole[i + 1]]))
                .sum();
            // Round the other way than the outline.
            if area > 0.0 {
                hole.reverse();
            }
            let from = (0..hole.len())
                .max_by(|&a, &b| self.seen(hole[a]).x.total_cmp(&self.seen(hole[b]).x))
                .unwrap_or(0);
            hole.rotate_left(from);
            let mut order: Vec<usize> = (0..outline.len()).collect();
            order.sort_by(|&a, &b| {
                let distance =
                    |i: usize| self.seen(outline[i]).distance_squared(self.seen(hole[0]));
                distance(a).total_cmp(&distance(b))
            });
            let rest = &holes[index..];
            let mut seen_from = None;
            for to in order {
                self.effort.spend(2 * sides)?;
                if self.sees(outline[to], hole[0], &outline, rest) {
                    seen_from = Some(to);
                    break;
                }
            }
            let to = seen_from.ok_or(Unsplit::Crossed)?;
            let mut joined = outline[..=to].to_vec();
            joined.extend(&hole);
            joined.push(hole[0]);
            joined.extend(&outline[to..]);
            outline = joined;
        }
        Ok(outline)
    }

    /// Whether no side of an outline or a hole stands between two corners.
    fn sees(&self, from: u32, to: u32, outline: &[u32], holes: &[Vec<u32>]) -> bool {
        let crosses = |ring: &[u32]| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).any(|(&a, &b)| {
                let own = [a, b].iter().any(|corner| *corner == from || *corner == to);
                let apart = |one: f64, other: f64| one * other < 0.0;
                !own && apart(self.area([from, to, a]), self.area([from, to, b]))
                    && apart(self.area([a, b, from]), self.area([a, b, to]))
            })
        };
        !crosses(outline) && !holes.iter().any(|hole| crosses(hole))
    }
}

/// The triangle of a corner and its neighbours.
fn ear(corners: &[u32], index: usize) -> [u32; 3] {
    let count = corners.len();
    [
        corners[(index + count - 1) % count],
        corners[index],
        corners[(index + 1) % count],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(flat: &[[f64; 2]]) -> Vec<DVec3> {
        // In a plane that is none of the axes'.
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.7, 1.1);
        flat.iter()
            .map(|&[x, y]| turn * DVec3::new(x, y, 4.0))
            .collect()
    }

    /// Areas by the shoelace formula and by the triangles; the triangles all turn the polygon's way.
    fn check(flat: &[[f64; 2]], holes: &[Vec<u32>]) -> usize {
        let points = points(flat);
        let holed: usize = holes.iter().map(Vec::len).sum();
        let outline: Vec<u32> = (0..(flat.len() - holed) as u32).collect();
        let shoelace = |ring: &[u32]| {
            let next = ring.iter().cycle().skip(1);
            let pairs = ring.iter().zip(next);
            pairs
                .map(|(&a, &b)| {
                    flat[a as usize][0] * flat[b as usize][1]
                        - flat[b as usize][0] * flat[a as usize][1]
                })
                .sum::<f64>()
                / 2.0
        };
        let expected =
            shoelace(&outline).abs() - holes.iter().map(|hole| shoelace(hole).abs()).sum::<f64>();
        let split = split(&points, &outline, holes, &Effort::new()).unwrap();
        let whole = normal(&points, &outline);
        let areas = split.triangles.iter().map(|&t| {
            let own = normal_of(&points, t);
            assert!(own.dot(whole) >= -1e-12, "{t:?}");
            0.5 * own.length()
        });
        assert!((areas.sum::<f64>() - expected).abs() < 1e-9 * expected);
        assert!(split.off_plane.is_none() && !split.folded);
        for corner in 0..flat.len() as u32 {
            assert!(
                split.triangles.iter().any(|t| t.contains(&corner)),
                "{corner}"
            );
        }
        split.triangles.len()
    }

    #[test]
    fn concave_polygons_keep_their_area_and_all_their_corners() {
        // An arrowhead, which a fan from its first corner folds.
        assert_eq!(
            check(&[[0.0, 4.0], [3.0, 1.0], [10.0, 0.0], [0.0, 0.0]], &[]),
            2
        );
        // An L with a corner in the middle of a straight side.
        let l = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        assert_eq!(check(&l, &[]), 5);
        // A comb, a spiral and a star.
        let mut comb = vec![[0.0, 0.0], [9.0, 0.0]];
        comb.extend(
            (0..9)
                .rev()
                .map(|i| [f64::from(i) + 0.5, if i % 2 == 0 { 5.0 } else { 1.0 }]),
        );
        check(&comb, &[]);
        let star: Vec<[f64; 2]> = (0..40)
            .map(|i| {
                (
                    f64::from(i) * std::f64::consts::TAU / 40.0,
                    if i % 2 == 0 { 3.0 } else { 1.0 },
                )
            })
            .map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()])
            .collect();
        assert_eq!(check(&star, &[]), 38);
        let mut clockwise = star;
        clockwise.reverse();
        check(&clockwise, &[]);
    }

    #[test]
    fn holes_are_left_open() {
        let mut plate = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]];
        plate.extend([[2.0, 2.0], [2.0, 4.0], [4.0, 4.0], [4.0, 2.0]]);
        plate.extend([[6.0, 2.0], [8.0, 2.0], [7.0, 5.0]]);
        check(&plate, &[vec![4, 5, 6, 7], vec![8, 9, 10]]);
    }

    #[test]
    fn crossed_sides_are_refused_and_bent_faces_reported() {
        let crossed = points(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]]);
        let split = |points: &[DVec3]| split(points, &[0, 1, 2, 3], &[], &Effort::new());
        assert_eq!(split(&crossed), Err(Unsplit::Crossed));
        let mut bent = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.2), DVec3::Y];
        let slightly = split(&bent).unwrap();
        assert!(slightly.off_plane.is_some() && !slightly.folded);
        bent[2].z = 1.5;
        assert!(split(&bent).unwrap().folded);
    }

    #[test]
    fn polygons_of_very_many_corners_are_refused_before_they_are_looked_at_for_minutes() {
        let star = |count: u32| {
            let corners = (0..count).map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
                let radius = if i % 2 == 0 { 3.0 } else { 2.0 };
                [radius * angle.cos(), radius * angle.sin()]
            });
            points(&corners.collect::<Vec<_>>())
        };
        let (few, many) = (star(1000), star(60_000));
        let outline = |points: &[DVec3]| (0..points.len() as u32).collect::<Vec<u32>>();
        let effort = Effort::new();
        let split_few = split(&few, &outline(&few), &[], &effort).unwrap();
        assert_eq!(split_few.triangles.len(), 998);
        assert_eq!(
            split(&many, &outline(&many), &[], &effort),
            Err(Unsplit::TooLong)
        );
        // Nothing is left for those that follow.
        assert!(split(&few, &outline(&few), &[], &effort).is_err());
    }
}
