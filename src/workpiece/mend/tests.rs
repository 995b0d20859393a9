use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::workpiece::mesh::shapes::gridded_box;
use crate::workpiece::{EdgeFlaw, MeshFault, TriangleMesh};

/// A box of 100 x 60 x 40 mm, as loose corners and triangles.
fn part() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mesh = gridded_box(DVec3::ZERO, DVec3::new(0.1, 0.06, 0.04), 4);
    (mesh.vertices().to_vec(), mesh.triangles().to_vec())
}

const VOLUME: f64 = 0.1 * 0.06 * 0.04;

fn middle(points: &[DVec3], triangle: [u32; 3]) -> DVec3 {
    triangle
        .map(|corner| points[corner as usize])
        .into_iter()
        .sum::<DVec3>()
        / 3.0
}

/// Makes a part of a spoilt surface: its volume must be that of the box, and what was mended of one kind, near to a place [m].
fn check(points: &[DVec3], triangles: &[[u32; 3]], flaw: Flaw, place: DVec3) -> TriangleMesh {
    let mesh = TriangleMesh::from_loose_triangles(points, triangles, 1.0)
        .unwrap_or_else(|fault| panic!("{flaw:?}: {fault}"));
    assert!(
        (mesh.volume() / VOLUME - 1.0).abs() < 1e-4,
        "{flaw:?}: {}",
        mesh.volume()
    );
    let kinds: Vec<Flaw> = mesh.mended().iter().map(|mended| mended.flaw).collect();
    assert_eq!(kinds, [flaw]);
    let places = &mesh.mended()[0].places;
    assert_eq!(places.len(), 1, "{flaw:?}: {places:?}");
    assert!(
        places[0].distance(place) < 0.02,
        "{flaw:?}: {places:?} for {place}"
    );
    assert!(
        mesh.notes()[0].contains("mended: 1 ") && mesh.notes()[0].contains(" mm"),
        "{:?}",
        mesh.notes()
    );
    mesh
}

#[test]
fn a_sound_surface_stays_as_it_is() {
    let (points, triangles) = part();
    let (same, faces, mended) = mended(&Connected {
        vertices: points.clone(),
        triangles: triangles.clone(),
        needles: Vec::new(),
    });
    assert!(same == points && faces == triangles && mended.is_empty());
}

#[test]
fn faces_that_stand_twice_or_are_turned_are_mended() {
    let (points, triangles) = part();
    for index in [0, 31, 77, 150] {
        let place = middle(&points, triangles[index]);
        let [a, b, c] = triangles[index];
        for double in [[b, c, a], [b, a, c]] {
            let twice = [&triangles[..], &[double]].concat();
            check(&points, &twice, Flaw::Twice, place);
        }
        let mut turned = triangles.clone();
        turned[index].swap(0, 1);
        check(&points, &turned, Flaw::Turned, place);
    }
}

#[test]
fn vertices_on_sides_and_beside_their_own_are_joined() {
    let (points, triangles) = part();
    for index in [3, 40, 99] {
        let [a, b, c] = triangles[index];
        let mut more = points.clone();
        more.push(0.3 * points[a as usize] + 0.7 * points[b as usize]);
        let new = points.len() as u32;
        let mut split = triangles.clone();
        split[index] = [a, new, c];
        split.push([new, b, c]);
        check(&more, &split, Flaw::OnSide, more[new as usize]);
        // A corner of one triangle alone, by 4 and by 20 micrometres.
        for off in [4e-6, 2e-5] {
            let mut more = points.clone();
            more.push(points[a as usize] + DVec3::splat(off / 3_f64.sqrt()));
            let mut loose = triangles.clone();
            loose[index][0] = new;
            check(&more, &loose, Flaw::Unwelded, points[a as usize]);
        }
    }
}

#[test]
fn holes_fins_and_needles_are_mended() {
    let (points, triangles) = part();
    for index in [5, 64, 120] {
        let place = middle(&points, triangles[index]);
        let mut holed = triangles.clone();
        holed.remove(index);
        check(&points, &holed, Flaw::Hole, place);
        let [a, b, _] = triangles[index];
        let mut more = points.clone();
        let out = TriangleMesh::new(points.clone(), triangles.clone())
            .unwrap()
            .face_normals()[index];
        more.push(points[a as usize] + 0.003 * out);
        let fin = [&triangles[..], &[[a, b, points.len() as u32]]].concat();
        check(&more, &fin, Flaw::Fin, points[a as usize]);
    }
}

#[test]
fn bodies_that_touch_along_an_edge_are_separated() {
    let (points, triangles) = part();
    let other = gridded_box(DVec3::new(0.1, 0.06, 0.0), DVec3::new(0.2, 0.12, 0.04), 4);
    let shift = points.len() as u32;
    let both = [&points[..], other.vertices()].concat();
    let shifted = other
        .triangles()
        .iter()
        .map(|triangle| triangle.map(|corner| corner + shift));
    let faces: Vec<[u32; 3]> = triangles.iter().copied().chain(shifted).collect();
    let mesh = TriangleMesh::from_loose_triangles(&both, &faces, 1.0).unwrap();
    assert!((mesh.volume() / (2.0 * VOLUME) - 1.0).abs() < 1e-9);
    let [mended] = mesh.mended() else {
        panic!("{:?}", mesh.mended());
    };
    assert_eq!((mended.flaw, mended.places.len()), (Flaw::Touching, 4));
    assert!(
        mended
            .places
            .iter()
            .all(|place| (place.x - 0.1).abs() < 1e-9 && (place.y - 0.06).abs() < 1e-9)
    );
    // Each keeps its twelve edges.
    let list = crate::workpiece::list_edges(&mesh, &crate::workpiece::EdgeSearch::default());
    assert_eq!(list.edges.len(), 24);
}

#[test]
fn a_slit_that_closes_within_a_face_is_separated_in_its_middle() {
    // Two blocks on a third touch along the one edge above it, whose lower end the third holds together.
    let boxes = [
        ([0.0, 0.0, 0.0], [0.2, 0.2, 0.1]),
        ([0.0, 0.0, 0.1], [0.1, 0.1, 0.2]),
        ([0.1, 0.1, 0.1], [0.2, 0.2, 0.2]),
    ];
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (low, high) in boxes {
        let mesh = gridded_box(
            DVec3::from_array(low),
            DVec3::from_array(high),
            if low[2] == 0.0 { 2 } else { 1 },
        );
        let shift = points.len() as u32;
        points.extend_from_slice(mesh.vertices());
        faces.extend(
            mesh.triangles()
                .iter()
                .map(|triangle| triangle.map(|corner| corner + shift)),
        );
    }
    let mesh = TriangleMesh::from_loose_triangles(&points, &faces, 1.0).unwrap();
    assert!(
        (mesh.volume() / 6e-3 - 1.0).abs() < 1e-9,
        "{}",
        mesh.volume()
    );
}

#[test]
fn a_missing_side_is_refused_with_its_places() {
    let (points, triangles) = part();
    let top = |triangle: &[u32; 3]| {
        triangle
            .iter()
            .all(|corner| points[*corner as usize].z > 0.0399)
    };
    let open: Vec<[u32; 3]> = triangles
        .iter()
        .copied()
        .filter(|triangle| !top(triangle))
        .collect();
    let fault = TriangleMesh::from_loose_triangles(&points, &open, 1.0).unwrap_err();
    let MeshFault::NotClosed { edges } = &fault else {
        panic!("{fault}");
    };
    assert_eq!(edges.len(), 16);
    assert!(edges.iter().all(|edge| edge.flaw == EdgeFlaw::Open
        && edge.ends.iter().all(|end| (end.z - 0.04).abs() < 1e-9)));
    let message = fault.to_string();
    assert!(
        message.contains("16 open edges") && message.contains(", 40) mm and 13 more"),
        "{message}"
    );
}

#[test]
fn of_a_body_that_is_held_several_times_one_stays() {
    let (points, triangles) = part();
    let back: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*c, *b, *a]).collect();
    let again = |copies: &[&[[u32; 3]]]| copies.concat();
    for (copies, twice) in [
        (again(&[&triangles, &triangles]), 1),
        (again(&[&triangles, &triangles, &triangles]), 2),
        (again(&[&triangles, &back]), 1),
        (again(&[&triangles, &triangles[..40]]), 0),
    ] {
        let mesh = TriangleMesh::from_loose_triangles(&points, &copies, 1.0).unwrap();
        assert!((mesh.volume() / VOLUME - 1.0).abs() < 1e-9);
        let count = copies.len() - triangles.len();
        assert!(twice == 0 || count == twice * triangles.len());
        let found: Vec<(Flaw, usize)> = mesh
            .mended()
            .iter()
            .map(|m| (m.flaw, m.places.len()))
            .collect();
        assert_eq!(found, [(Flaw::Twice, count)]);
    }
    // Wound inwards, and first.
    let mesh =
        TriangleMesh::from_loose_triangles(&points, &again(&[&back, &triangles]), 1.0).unwrap();
    assert!((mesh.volume() / VOLUME - 1.0).abs() < 1e-9);
}

#[test]
fn a_heap_of_loose_triangles_is_given_up_before_each_is_held_against_each() {
    let mut chance = ChaCha8Rng::seed_from_u64(1);
    let points: Vec<DVec3> = (0..60_000)
        .map(|_| 0.1 * DVec3::from_array(chance.random()))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..20_000).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let mut surface = Surface {
        vertices: points.clone(),
        triangles: triangles.clone(),
        mended: Vec::new(),
        open_volume: 0.0,
        work: 0,
    };
    surface.join_all(extent(&points));
    assert!(surface.is_beyond_mending() && surface.work < MOST_WORK + 2 * points.len());
    let fault = TriangleMesh::from_loose_triangles(&points, &triangles, 1.0).unwrap_err();
    assert!(matches!(fault, MeshFault::NotClosed { .. }), "{fault}");
}
