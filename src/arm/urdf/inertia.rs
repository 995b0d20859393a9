//! Masses of the file's links, welded together to one body a moving link.

use super::masses::Masses;
use super::tree::{Placed, Tree, pose_of, within};
use super::{EstimatedMass, Refusal};
use crate::arm::chain::BodyInertia;
use glam::{DMat3, DVec3};
use nalgebra::Matrix3;

/// Heaviest link [kg] and largest inertia [kg m2].
const HEAVIEST: f64 = 1e6;
const LARGEST: f64 = 1e9;

/// One body for each moving joint, in the frame of the link behind it, and which of them are estimated.
pub(super) fn merged_bodies(
    tree: &Tree,
    masses: &Masses,
    notes: &mut Vec<String>,
) -> Result<(Vec<BodyInertia>, Vec<EstimatedMass>), Refusal> {
    let mut own = Vec::with_capacity(tree.placed.len());
    for (place, placed) in tree.placed.iter().enumerate() {
        // The base stands still: its mass does nothing but count.
        let body = if placed.link_index == 0 {
            BodyInertia {
                mass: placed.link.inertial.mass.value.max(0.0),
                ..BodyInertia::ZERO
            }
        } else {
            link_body(placed, notes)?
        };
        own.push(masses.given(place, placed, body)?);
    }
    let groups = masses.estimate(tree, &own)?;
    let mut bodies = vec![BodyInertia::ZERO; tree.moving.len()];
    for (placed, (body, _)) in tree.placed.iter().zip(&own) {
        if placed.link_index > 0 {
            let merged = &mut bodies[placed.link_index - 1];
            *merged = merged.welded_to(&body.seen_from(&placed.moving_from_link));
        }
    }
    let mut estimated = Vec::new();
    let context = ", with all that is fixed to it";
    for (index, (merged, joint)) in bodies.iter_mut().zip(tree.path_joints()).enumerate() {
        let link = &joint.child.link;
        let by_volume = groups[index].is_some();
        if let Some(body) = groups[index] {
            *merged = body;
        }
        let here = |placed: &Placed| placed.link_index == index + 1;
        let mut of_group = tree.placed.iter().zip(&own);
        let by_shape = of_group.any(|(placed, (_, by_shape))| here(placed) && *by_shape);
        if by_volume || by_shape {
            estimated.push(EstimatedMass {
                joint: index,
                link: link.clone(),
                mass: merged.mass,
                by_volume,
            });
        }
        if !(merged.mass == 0.0 && masses.options.is_recorded) {
            check(link, merged, context, notes)?;
        }
    }
    Ok((bodies, estimated))
}

fn check(
    link: &str,
    body: &BodyInertia,
    context: &'static str,
    notes: &mut Vec<String>,
) -> Result<(), Refusal> {
    if body.mass <= 0.0 {
        return Err(Refusal::Mass {
            link: link.to_owned(),
            mass: body.mass,
            context,
        });
    }
    let moments = principal_moments(&body.inertia);
    if moments.x <= 0.0 {
        return Err(refused_inertia(link, moments, context, "positive"));
    }
    // The largest principal moment of real matter is at most the sum of the others.
    if moments.z > (moments.x + moments.y) * (1.0 + 1e-6) {
        notes.push(format!(
            "link {link}: no distribution of mass has the principal inertias {} kg m2 ({}); taken as written",
            written(moments),
            "the largest exceeds the sum of the others"
        ));
    }
    Ok(())
}

/// Mass properties of one link of the file, in its own frame.
fn link_body(placed: &Placed, notes: &mut Vec<String>) -> Result<BodyInertia, Refusal> {
    let link = &placed.link.name;
    let inertial = &placed.link.inertial;
    let mass = inertial.mass.value;
    if !(mass.is_finite() && mass >= 0.0) {
        return Err(Refusal::Mass {
            link: link.clone(),
            mass,
            context: "",
        });
    }
    within(mass, HEAVIEST, "kg", || format!("mass of link `{link}`"))?;
    let part = &inertial.inertia;
    let inertia = DMat3::from_cols(
        DVec3::new(part.ixx, part.ixy, part.ixz),
        DVec3::new(part.ixy, part.iyy, part.iyz),
        DVec3::new(part.ixz, part.iyz, part.izz),
    );
    if !inertia.is_finite() {
        return Err(Refusal::NotFinite {
            location: format!("inertia of link `{link}`"),
        });
    }
    let most = inertia
        .to_cols_array()
        .into_iter()
        .fold(0.0, |most: f64, own| most.max(own.abs()));
    within(most, LARGEST, "kg m2", || {
        format!("inertia of link `{link}`")
    })?;
    let moments = principal_moments(&inertia);
    if moments.x < -1e-9 * moments.z.abs() {
        return Err(refused_inertia(link, moments, "", "no negative"));
    }
    if mass == 0.0 && moments.z > 0.0 {
        notes.push(format!(
            "link {link} has no mass but principal inertias {} kg m2; they are added as written",
            written(moments)
        ));
    }
    let frame = pose_of(&inertial.origin, || {
        format!("inertial origin of link `{link}`")
    })?;
    let about_own_axes = BodyInertia {
        mass,
        centre_of_mass: DVec3::ZERO,
        inertia,
    };
    Ok(about_own_axes.seen_from(&frame))
}

fn refused_inertia(
    link: &str,
    moments: DVec3,
    context: &'static str,
    expected: &'static str,
) -> Refusal {
    Refusal::Inertia {
        link: link.to_string(),
        moments: written(moments),
        context,
        expected,
    }
}

fn written(moments: DVec3) -> String {
    format!("{:.3e}, {:.3e}, {:.3e}", moments.x, moments.y, moments.z)
}

/// Eigenvalues, smallest first.
fn principal_moments(inertia: &DMat3) -> DVec3 {
    let matrix = Matrix3::from_column_slice(&inertia.to_cols_array());
    let mut values: [f64; 3] = matrix.symmetric_eigenvalues().into();
    values.sort_by(f64::total_cmp);
    DVec3::from_array(values)
}
