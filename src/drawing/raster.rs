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

/// An image with depth, finer than it is shown.
pub(super) struct Raster {
    size: [usize; 2],
    depth: Vec<f32>,
    colour: Vec<[u8; 3]>,
    normal: Vec<[f32; 3]>,
    body: Vec<u16>,
}

impl Raster {
    /// Triangles as a camera sees them, in a picture of this size [pixel].
    pub(super) fn of(faces: &[Face], camera: &Camera, size: [usize; 2]) -> Self {
        let fine = size.map(|length| length * FINE);
        let count = fine[0] * fine[1];
        let mut raster = Self {
            size: fine,
            depth: vec![f32::NEG_INFINITY; count],
            colour: vec![[0; 3]; count],
            normal: vec![[0.0; 3]; count],
            body: vec![0; count],
        };
        for face in faces {
            raster.fill(face, camera);
        }
        raster
    }

    fn fill(&mut self, face: &Face, camera: &Camera) {
        let seen = face.corners.map(|corner| camera.project(corner));
        let [a, b, c] = seen.map(|(place, _)| place * FINE as f64);
        let area = (b - a).perp_dot(c - a);
        // Sheets and meshes with loose winding are seen from behind too.
        if area.abs() < 1e-9 {
            return;
        }
        let low = a.min(b).min(c).max(DVec2::ZERO);
        let high = a.max(b).max(c);
        let last = |value: f64, count: usize| (value.ceil().max(0.0) as usize).min(count);
        let columns = low.x.floor() as usize..last(high.x, self.size[0]);
        let rows = low.y.floor() as usize..last(high.y, self.size[1]);
        for row in rows {
            for column in columns.clone() {
                let at = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let weights = [
                    (c - b).perp_dot(at - b) / area,
                    (a - c).perp_dot(at - c) / area,
                    (b - a).perp_dot(at - a) / area,
                ];
                if weights.iter().any(|weight| *weight < 0.0) {
                    continue;
                }
                let depth = (0..3).map(|i| weights[i] * seen[i].1).sum::<f64>() as f32;
                let index = row * self.size[0] + column;
                if depth > self.depth[index] {
                    let normal: DVec3 = (0..3).map(|i| weights[i] * face.normals[i]).sum();
                    self.put(index, depth, normal.normalize_or(camera.eye), face, camera);
                }
            }
        }
    }

    fn put(&mut self, index: usize, depth: f32, normal: DVec3, face: &Face, camera: &Camera) {
        // Light from above the eye's left shoulder.
        let light = (camera.eye - 0.35 * camera.right - 0.5 * camera.down).normalize();
        let normal = if normal.dot(camera.eye) < 0.0 {
            -normal
        } else {
            normal
        };
        let share = AMBIENT + (1.0 - AMBIENT) * normal.dot(light).max(0.0);
        // Dark bodies keep their shape in either theme.
        let shade = |value: u8| ((0.25 * 150.0 + 0.75 * f64::from(value)) * share).min(255.0) as u8;
        let [red, green, blue, _] = face.colour;
        self.depth[index] = depth;
        self.colour[index] = [red, green, blue].map(shade);
        self.normal[index] = normal.as_vec3().to_array();
        self.body[index] = face.body;
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

    /// Whether a body, or a crease of one, ends between two samples.
    fn parts(&self, one: usize, other: usize) -> bool {
        if self.body[one] != self.body[other] {
            return true;
        }
        let [a, b] = [one, other].map(|index| self.normal[index]);
        let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        self.body[one] != 0 && f64::from(cosine) < CREASE
    }

    /// Red, green, blue and opacity of the image, row by row.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let is_line = |column: usize, row: usize| {
            let own = row * width + column;
            let right = column + 1 < width && self.parts(own, own + 1);
            let below = row + 1 < height && self.parts(own, own + width);
            right || below
        };
        let mut pixels = Vec::with_capacity(4 * width * height / (FINE * FINE));
        for row in (0..height).step_by(FINE) {
            for column in (0..width).step_by(FINE) {
                let mut sum = [0u32; 3];
                let mut covered = 0;
                for (down, on) in (0..FINE * FINE).map(|i| (i / FINE, i % FINE)) {
                    let (column, row) = (column + on, row + down);
                    let index = row * width + column;
                    let line = is_line(column, row);
                    if self.body[index] == 0 && !line {
                        continue;
                    }
                    covered += 1;
                    for (sum, value) in sum.iter_mut().zip(self.colour[index]) {
                        *sum += match line {
                            true => 45,
                            false => u32::from(value),
                        };
                    }
                }
                let mean = |sum: u32| (sum / covered.max(1)) as u8;
                let opacity = 255 * covered / (FINE * FINE) as u32;
                pixels.extend([mean(sum[0]), mean(sum[1]), mean(sum[2]), opacity as u8]);
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
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
}
