//! View of triangles from one side: a shaded image with outlines, and how deep each of its pixels lies.

use glam::{DVec2, DVec3};

use super::faces::Face;

/// Looks along parallel lines: what is far is as large as what is near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    /// Unit vectors in the world: to the right, down, and towards the eye.
    pub(super) right: DVec3,
    pub(super) down: DVec3,
    pub(super) eye: DVec3,
    /// Point of the world's picture at the image's upper left corner [m].
    pub(super) corner: DVec2,
    /// Pixels a metre [1/m].
    pub(super) scale: f64,
}

impl Camera {
    /// Seen from a direction, with the world's z upwards; `points` fill a picture of this size but for a margin [pixel].
    pub(super) fn on(
        points: impl Iterator<Item = DVec3>,
        eye: DVec3,
        size: [f64; 2],
        margin: f64,
    ) -> Self {
        let eye = eye.normalize_or(DVec3::Z);
        let right = DVec3::Z.cross(eye).normalize_or(DVec3::X);
        let down = -eye.cross(right);
        let start = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let [low, high] = points.fold(start, |[low, high], point| {
            let flat = DVec2::new(right.dot(point), down.dot(point));
            [low.min(flat), high.max(flat)]
        });
        let extent = (high - low).max(DVec2::splat(1e-6));
        let room = DVec2::new(size[0], size[1]) - 2.0 * margin;
        let scale = (room / extent).min_element();
        let middle = 0.5 * (low + high);
        Self {
            right,
            down,
            eye,
            corner: middle - 0.5 * DVec2::new(size[0], size[1]) / scale,
            scale,
        }
    }

    /// Place in the image [pixel], and depth towards the eye [m].
    pub(super) fn project(&self, point: DVec3) -> (DVec2, f64) {
        let flat = DVec2::new(self.right.dot(point), self.down.dot(point));
        (self.scale * (flat - self.corner), self.eye.dot(point))
    }
}

/// Samples a pixel, along each side.
const FINE: usize = 2;
/// Share of a surface's colour that it has where it is seen edge on.
const AMBIENT: f64 = 0.45;
/// Surfaces whose normals part by more than this cosine are divided by a line.
const CREASE: f64 = 0.8;
/// Red, green and blue of such a line.
const LINE: u8 = 45;

/// An image with depth, finer than it is shown.
pub(super) struct Raster<'a> {
    size: [usize; 2],
    camera: Camera,
    /// Where light comes from.
    light: DVec3,
    faces: &'a [Face],
    /// Where each face lies in the image; none of one that is seen edge on.
    seen: Vec<Option<Seen>>,
    depth: Vec<f32>,
    /// The face that is seen at each sample, from 1; 0 where there is none.
    nearest: Vec<u32>,
}

/// A triangle in the image.
#[derive(Clone, Copy)]
struct Seen {
    corners: [DVec2; 3],
    depths: [f64; 3],
    /// Twice its area, by its sense of turning [pixel^2].
    area: f64,
}

impl Seen {
    /// Shares of the corners in a place.
    fn weights(&self, at: DVec2) -> [f64; 3] {
        let ([a, b, c], area) = (self.corners, self.area);
        [
            (c - b).perp_dot(at - b) / area,
            (a - c).perp_dot(at - c) / area,
            (b - a).perp_dot(at - a) / area,
        ]
    }

    /// Where a row begins and ends to lie in it [pixel], as far as rounding goes; the end is before the start where none of it does. Shares are linear along
    /// the row.
    fn columns(&self, row: f64, [mut first, mut last]: [f64; 2]) -> [f64; 2] {
        let [start, next] = [0.0, 1.0].map(|column| self.weights(DVec2::new(column, row)));
        for (start, next) in start.into_iter().zip(next) {
            let slope = next - start;
            let at = -start / slope;
            if slope > 0.0 {
                first = first.max(at);
            } else if slope < 0.0 {
                last = last.min(at);
            } else if start < 0.0 {
                last = f64::NEG_INFINITY;
            }
        }
        [first, last]
    }

    /// Depth in a place [m], and what it gains by a column.
    fn depth(&self, at: DVec2) -> [f64; 2] {
        let depth = |at| {
            let weights = self.weights(at);
            (0..3).map(|i| weights[i] * self.depths[i]).sum::<f64>()
        };
        [depth(at), depth(at + DVec2::X) - depth(at)]
    }
}

/// The middle of a sample.
fn middle(column: usize, row: usize) -> DVec2 {
    DVec2::new(column as f64 + 0.5, row as f64 + 0.5)
}

impl<'a> Raster<'a> {
    /// Triangles as a camera sees them, in a picture of this size [pixel].
    pub(super) fn of(faces: &'a [Face], camera: &Camera, size: [usize; 2]) -> Self {
        let fine = size.map(|length| length * FINE);
        let count = fine[0] * fine[1];
        let mut raster = Self {
            size: fine,
            camera: *camera,
            // From above the eye's left shoulder.
            light: (camera.eye - 0.35 * camera.right - 0.5 * camera.down).normalize(),
            faces,
            seen: faces.iter().map(|face| seen(face, camera)).collect(),
            depth: vec![f32::NEG_INFINITY; count],
            nearest: vec![0; count],
        };
        for face in 0..faces.len() {
            raster.fill(face);
        }
        raster
    }

    fn fill(&mut self, face: usize) {
        let Some(seen) = self.seen[face] else {
            return;
        };
        let [a, b, c] = seen.corners;
        let low = a.min(b).min(c).max(DVec2::ZERO);
        let high = a.max(b).max(c);
        let whole = |value: f64, most: usize| (value.max(0.0) as usize).min(most);
        for row in low.y.floor() as usize..whole(high.y.ceil(), self.size[1]) {
            let [from, to] = seen.columns(row as f64 + 0.5, [low.x, high.x]);
            let first = whole((from - 1.5).floor(), self.size[0]);
            let last = whole((to + 1.5).ceil(), self.size[0]).max(first);
            // So far from both ends there is no doubt that a sample lies in it.
            let inner = whole((from + 1.5).ceil(), last).max(first);
            let inner = inner..whole((to - 2.5).floor(), last).max(inner);
            for column in (first..inner.start).chain(inner.end..last) {
                let at = middle(column, row);
                if seen.weights(at).iter().all(|weight| *weight >= 0.0) {
                    self.see(face, row * self.size[0] + column, seen.depth(at)[0] as f32);
                }
            }
            let [depth, gain] = seen.depth(middle(inner.start, row));
            for (on, column) in inner.enumerate() {
                let depth = (depth + on as f64 * gain) as f32;
                self.see(face, row * self.size[0] + column, depth);
            }
        }
    }

    /// A face at a sample, where nothing nearer is seen.
    fn see(&mut self, face: usize, index: usize, depth: f32) {
        if depth > self.depth[index] {
            self.depth[index] = depth;
            self.nearest[index] = face as u32 + 1;
        }
    }

    /// Depth towards the eye of what is seen at a place of the image [m]; minus infinity where there is nothing.
    pub(super) fn depth_at(&self, place: DVec2) -> f64 {
        let at = place * FINE as f64;
        if at.x < 0.0 || at.y < 0.0 {
            return f64::NEG_INFINITY;
        }
        let [column, row] = [at.x as usize, at.y as usize];
        if column >= self.size[0] || row >= self.size[1] {
            return f64::NEG_INFINITY;
        }
        f64::from(self.depth[row * self.size[0] + column])
    }

    /// The face that is seen at a sample, from 1; 0 where there is none.
    fn face_at(&self, [column, row]: [usize; 2]) -> u32 {
        self.nearest[row * self.size[0] + column]
    }

    /// Unit normal of a face at a place of the image, towards the eye.
    fn normal(&self, face: u32, at: DVec2) -> DVec3 {
        let (camera, index) = (&self.camera, face as usize - 1);
        let Some(seen) = self.seen[index] else {
            return camera.eye;
        };
        let (weights, normals) = (seen.weights(at), &self.faces[index].normals);
        let normal: DVec3 = (0..3).map(|i| weights[i] * normals[i]).sum();
        let normal = normal.normalize_or(camera.eye);
        if normal.dot(camera.eye) < 0.0 {
            -normal
        } else {
            normal
        }
    }

    /// Colour of a face at a place of the image.
    fn shade(&self, face: u32, at: DVec2) -> [u8; 3] {
        let share = AMBIENT + (1.0 - AMBIENT) * self.normal(face, at).dot(self.light).max(0.0);
        // Dark bodies keep their shape in either theme.
        let shade = |value: u8| ((0.25 * 150.0 + 0.75 * f64::from(value)) * share).min(255.0) as u8;
        let [red, green, blue, _] = self.faces[face as usize - 1].colour;
        [red, green, blue].map(shade)
    }

    /// Whether a body, or a crease of one, ends between two samples; a face has none within.
    fn parts(&self, one: [usize; 2], other: [usize; 2]) -> bool {
        let faces = [one, other].map(|sample| self.face_at(sample));
        if faces[0] == faces[1] {
            return false;
        }
        let body = |face: u32| (face as usize).checked_sub(1).map(|f| self.faces[f].body);
        if body(faces[0]) != body(faces[1]) {
            return true;
        }
        let [a, b] = [(faces[0], one), (faces[1], other)]
            .map(|(face, [column, row])| self.normal(face, middle(column, row)));
        a.dot(b) < CREASE
    }

    /// Red, green, blue and opacity of the image, row by row.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let mut pixels = Vec::with_capacity(4 * width * height / (FINE * FINE));
        for row in (0..height).step_by(FINE) {
            for column in (0..width).step_by(FINE) {
                pixels.extend_from_slice(&self.pixel(column, row));
            }
        }
        pixels
    }

    /// The pixel whose samples start at one. Where they and their neighbours see one face, it is shaded once.
    fn pixel(&self, column: usize, row: usize) -> [u8; 4] {
        let [width, height] = self.size;
        let face = self.face_at([column, row]);
        let last = (column + FINE).min(width - 1);
        let mut rows = (0..=FINE).map(|down| (row + down).min(height - 1) * width);
        let one = rows.all(|start| {
            let seen = &self.nearest[start + column..=start + last];
            seen.iter().all(|other| *other == face)
        });
        if !one {
            return self.mixed_pixel(column, row);
        }
        if face == 0 {
            return [0; 4];
        }
        let half = 0.5 * FINE as f64;
        let [red, green, blue] = self.shade(face, DVec2::new(column as f64, row as f64) + half);
        [red, green, blue, 255]
    }

    /// Mean of the samples of a pixel; lines divide bodies, and creases of one.
    fn mixed_pixel(&self, column: usize, row: usize) -> [u8; 4] {
        let [width, height] = self.size;
        let mut sum = [0u32; 3];
        let mut covered = 0;
        for [column, row] in (0..FINE * FINE).map(|i| [column + i % FINE, row + i / FINE]) {
            let right = (column + 1 < width).then_some([column + 1, row]);
            let below = (row + 1 < height).then_some([column, row + 1]);
            let mut beside = right.into_iter().chain(below);
            let colour = match self.face_at([column, row]) {
                _ if beside.any(|next| self.parts([column, row], next)) => [LINE; 3],
                0 => continue,
                face => self.shade(face, middle(column, row)),
            };
            covered += 1;
            for (sum, value) in sum.iter_mut().zip(colour) {
                *sum += u32::from(value);
            }
        }
        let mean = |sum: u32| (sum / covered.max(1)) as u8;
        let opacity = 255 * covered / (FINE * FINE) as u32;
        [mean(sum[0]), mean(sum[1]), mean(sum[2]), opacity as u8]
    }
}

/// Where a face lies in the image. Sheets and meshes with loose winding are seen from behind too.
fn seen(face: &Face, camera: &Camera) -> Option<Seen> {
    let seen = face.corners.map(|corner| camera.project(corner));
    let corners = seen.map(|(place, _)| place * FINE as f64);
    let [a, b, c] = corners;
    let area = (b - a).perp_dot(c - a);
    (area.abs() >= 1e-9).then_some(Seen {
        corners,
        depths: seen.map(|(_, depth)| depth),
        area,
    })
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    fn sheet(height: f64, colour: u8, body: u16) -> [Face; 2] {
        let corner = |x: f64, y: f64| DVec3::new(x, y, height);
        let face = |corners| Face {
            corners,
            normals: [DVec3::Z; 3],
            colour: [colour, 0, 0, 255],
            body,
        };
        [
            face([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)]),
            face([corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]),
        ]
    }

    #[test]
    fn what_is_nearer_hides_what_is_behind_it_in_any_order() {
        let (low, high) = (sheet(0.0, 10, 1), sheet(0.5, 200, 2));
        let points = || low.iter().flat_map(|face| face.corners);
        let camera = Camera::on(points(), DVec3::Z, [40.0, 40.0], 4.0);
        for faces in [[low, high].concat(), [high, low].concat()] {
            let raster = Raster::of(&faces, &camera, [40, 40]);
            let middle = DVec2::splat(20.0);
            assert!((raster.depth_at(middle) - 0.5).abs() < 1e-6);
            assert_eq!(raster.depth_at(DVec2::splat(1.0)), f64::NEG_INFINITY);
            let pixels = raster.pixels();
            assert_eq!(pixels.len(), 4 * 40 * 40);
            let at = 4 * (20 * 40 + 20);
            assert!(
                pixels[at] > 100 && pixels[at + 3] == 255,
                "{:?}",
                &pixels[at..at + 4]
            );
            assert_eq!(pixels[3], 0);
        }
    }

    #[test]
    fn a_point_is_drawn_where_the_camera_puts_it() {
        let points = [DVec3::ZERO, DVec3::new(2.0, 1.0, 0.0)];
        let camera = Camera::on(points.into_iter(), DVec3::Z, [100.0, 100.0], 10.0);
        assert!((camera.scale - 40.0).abs() < 1e-9);
        let (place, _) = camera.project(DVec3::new(1.0, 0.5, 7.0));
        assert!((place - DVec2::splat(50.0)).length() < 1e-9);
        let (right, _) = camera.project(DVec3::new(2.0, 0.5, 0.0));
        assert!((right - DVec2::new(90.0, 50.0)).length() < 1e-9, "{right}");
    }

    #[test]
    fn each_sample_sees_the_nearest_of_all_faces_that_hold_it() {
        let mut chance = ChaCha8Rng::seed_from_u64(3);
        let mut point = |size: f64| size * (2.0 * DVec3::from_array(chance.random()) - 1.0);
        let faces: Vec<Face> = (0..300)
            .map(|number| {
                let (middle, size) = (point(1.0), [0.05, 0.4, 2.0][number % 3]);
                Face {
                    corners: [0; 3].map(|_| middle + point(size)),
                    normals: [DVec3::Z; 3],
                    colour: [90, 0, 0, 255],
                    body: 1,
                }
            })
            .collect();
        let shown = faces.iter().take(200).flat_map(|face| face.corners);
        let camera = Camera::on(shown, DVec3::new(1.0, 0.4, 0.7), [60.0, 40.0], 0.0);
        let raster = Raster::of(&faces, &camera, [60, 40]);
        let mut covered = 0;
        for row in 0..raster.size[1] {
            for column in 0..raster.size[0] {
                let mut nearest = (f32::NEG_INFINITY, 0);
                for (number, seen) in raster.seen.iter().enumerate() {
                    let weights = seen.unwrap().weights(middle(column, row));
                    let depth = (0..3).map(|i| weights[i] * seen.unwrap().depths[i]);
                    let depth = depth.sum::<f64>() as f32;
                    if weights.iter().all(|weight| *weight >= 0.0) && depth > nearest.0 {
                        nearest = (depth, number as u32 + 1);
                    }
                }
                let index = row * raster.size[0] + column;
                assert_eq!((raster.depth[index], raster.nearest[index]), nearest);
                covered += usize::from(nearest.1 > 0);
            }
        }
        assert!(covered > 3000, "{covered}");
    }

    #[test]
    fn a_pixel_shaded_once_has_the_colour_of_its_samples() {
        let mut chance = ChaCha8Rng::seed_from_u64(5);
        let mut point = |size: f64| size * (2.0 * DVec3::from_array(chance.random()) - 1.0);
        let faces: Vec<Face> = (0..60)
            .map(|number| {
                let centre = point(1.0);
                Face {
                    corners: [0; 3].map(|_| centre + point(0.5)),
                    normals: [0; 3].map(|_| (DVec3::Z + point(0.4)).normalize()),
                    colour: [90, 250, 10, 255],
                    body: 1 + number % 2,
                }
            })
            .collect();
        let points = faces.iter().flat_map(|face| face.corners);
        let camera = Camera::on(points, DVec3::new(1.0, 0.4, 0.7), [120.0, 80.0], 0.0);
        let raster = Raster::of(&faces, &camera, [120, 80]);
        let (mut once, mut clear) = (0, 0);
        for (row, column) in (0..80).flat_map(|row| (0..120).map(move |column| (row, column))) {
            let [own, mixed] = [Raster::pixel, Raster::mixed_pixel]
                .map(|pixel| pixel(&raster, FINE * column, FINE * row));
            for (a, b) in own.into_iter().zip(mixed) {
                assert!(a.abs_diff(b) <= 1, "{own:?} against {mixed:?}");
            }
            clear += usize::from(mixed[3] == 0);
            once += usize::from(own != mixed);
        }
        assert!(
            clear > 1000 && once > 50,
            "{clear} clear, {once} shaded once"
        );
    }
}
