//! Chains that several of the arm's unit tests share.

use crate::arm::chain::{BodyInertia, Joint, JointKind, KinematicChain};
use crate::arm::urdf::{ArmOptions, load_arm};
use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// A joint turning about z of its frame, with wide limits.
pub fn joint(parent_from_joint: DPose3, body: BodyInertia) -> Joint {
    Joint {
        name: "test".into(),
        kind: JointKind::Revolute,
        parent_from_joint,
        axis: DVec3::Z,
        lower: -3.0,
        upper: 3.0,
        effort: 100.0,
        velocity: 2.0,
        damping: 0.0,
        friction: 0.0,
        body,
    }
}

fn point_mass(mass: f64, centre_of_mass: DVec3) -> BodyInertia {
    BodyInertia {
        mass,
        centre_of_mass,
        inertia: DMat3::ZERO,
    }
}

/// Two links along x turning about z, point masses at their ends; and the two lengths [m].
pub fn planar_two_link() -> (KinematicChain, [f64; 2]) {
    let lengths = [0.7, 0.4];
    let ends = lengths.map(|length| DVec3::new(length, 0.0, 0.0));
    let chain = KinematicChain {
        joints: vec![
            joint(DPose3::IDENTITY, point_mass(2.5, ends[0])),
            joint(DPose3::from_translation(ends[0]), point_mass(1.2, ends[1])),
        ],
        tip_from_last: DPose3::from_translation(ends[1]),
    };
    (chain, lengths)
}

/// A pendulum about y hanging along -z at zero; mass [kg], length to the centre [m], inertia there [kg m2].
pub fn vertical_pendulum() -> (KinematicChain, f64, f64, f64) {
    let (mass, length, inertia) = (3.0, 0.45, 0.07);
    let body = BodyInertia {
        mass,
        centre_of_mass: DVec3::new(0.0, 0.0, -length),
        inertia: DMat3::from_diagonal(DVec3::new(0.2, inertia, 0.1)),
    };
    let mut only = joint(DPose3::from_translation(DVec3::new(0.1, 0.2, 0.3)), body);
    // Positive angles swing towards -x.
    only.axis = DVec3::Y;
    let chain = KinematicChain {
        joints: vec![only],
        tip_from_last: DPose3::IDENTITY,
    };
    (chain, mass, length, inertia)
}

/// `count` joints with random frames, axes and bodies; every third joint slides.
pub fn random_chain(seed: u64, count: usize) -> KinematicChain {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut vector = move || {
        DVec3::new(
            random.random_range(-1.0..1.0),
            random.random_range(-1.0..1.0),
            random.random_range(-1.0..1.0),
        )
    };
    let joints = (0..count).map(|index| {
        let frame = DPose3::from_parts(0.4 * vector(), DQuat::from_scaled_axis(2.0 * vector()));
        // A positive definite inertia that satisfies the triangle inequality.
        let moments = DVec3::splat(0.05) + 0.02 * vector();
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(vector()));
        let body = BodyInertia {
            mass: 2.0 + vector().x,
            centre_of_mass: 0.2 * vector(),
            inertia: turn * DMat3::from_diagonal(moments) * turn.transpose(),
        };
        let mut joint = joint(frame, body);
        joint.axis = vector().normalize();
        if index % 3 == 2 {
            joint.kind = JointKind::Prismatic;
        }
        joint
    });
    KinematicChain {
        joints: joints.collect(),
        tip_from_last: DPose3::from_parts(DVec3::new(0.1, 0.2, -0.1), DQuat::from_rotation_y(0.4)),
    }
}

/// Joint positions (or speeds) between -1 and 1.
pub fn random_positions(seed: u64, count: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x5eed);
    (0..count).map(|_| random.random_range(-1.0..1.0)).collect()
}

/// The arm of models/arm.
pub fn arm10() -> KinematicChain {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/arm/arm10.urdf");
    let options = ArmOptions {
        tip_link: "flange".into(),
        ..ArmOptions::default()
    };
    load_arm(&file, &options).expect("our own arm loads").chain
}

/// Seven axes, alternately along and across the links, as light arms with an elbow that swivels have.
pub fn seven_axes() -> KinematicChain {
    let quarter = std::f64::consts::FRAC_PI_2;
    let frames = [
        (0.0, 0.36),
        (-quarter, 0.0),
        (quarter, 0.42),
        (quarter, 0.0),
        (-quarter, 0.4),
        (-quarter, 0.0),
        (quarter, 0.0),
    ];
    let joints = frames.map(|(roll, along)| {
        let turn = DQuat::from_rotation_x(roll);
        joint(
            DPose3::from_parts(turn * DVec3::new(0.0, 0.0, along), turn),
            point_mass(3.0, DVec3::new(0.0, 0.05, 0.1)),
        )
    });
    KinematicChain {
        joints: joints.to_vec(),
        tip_from_last: DPose3::from_translation(DVec3::new(0.0, 0.0, 0.13)),
    }
}
