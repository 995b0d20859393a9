//! What a drive has to overcome beside the links: inertia of motor and gear, friction, and what pulls or pushes at its joint.
//!
//! ```text
//! t = I q'' + w(t)((F_c + (F_s - F_c) exp(-(q'/v_s)^2) + m |t_g|) z + F_v q') + o + a sin(n q + p) + k (q - r)
//! w(t) = 1 - u (1 - exp(-t/T))
//! ```
//!
//! I inertia at the joint's side [kg m2], F_c dry, F_s static friction [N m], v_s Stribeck velocity [rad/s] (Stribeck 1902, as in Armstrong-Helouvry 1994),
//! m friction per load [1], t_g torque that the gear carries [N m], z bristles [1], F_v viscous friction [N m s/rad], u share by which friction falls as the
//! joint warms [1], T time constant [s], o offset [N m], a, n, p gear ripple, k (q - r) pull of hoses (a dress pack) to a rest angle.

pub use super::moment::JointMoment;
use super::parameters::Drive;

/// Dry friction of a joint that slides, cold [N m].
#[must_use]
pub fn sliding(drive: &Drive, speed: f64, carried: f64) -> f64 {
    let mut dry = drive.coulomb + drive.load_friction * carried.abs();
    if drive.static_excess != 0.0 {
        dry += drive.static_excess * (-(speed / drive.stribeck_velocity).powi(2)).exp();
    }
    dry
}

/// Torque that a drive must give beside what its gear carries [N m].
#[must_use]
pub fn own_torque(drive: &Drive, moment: &JointMoment) -> f64 {
    let JointMoment {
        position,
        speed,
        acceleration,
        ..
    } = *moment;
    let mut warm = 1.0;
    if drive.warm_fraction != 0.0 {
        warm -= drive.warm_fraction * (1.0 - (-moment.time / drive.warm_time).exp());
    }
    let mut torque = drive.motor_inertia * acceleration
        + warm * (moment.dry + drive.viscous * speed)
        + drive.offset
        + drive.spring_stiffness * position;
    if drive.ripple != [0.0; 2] {
        let (sine, cosine) = (drive.ripple_cycles * position).sin_cos();
        torque += drive.ripple[0] * sine + drive.ripple[1] * cosine;
    }
    torque
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_falls_from_static_to_dry_and_with_warmth() {
        let drive = Drive {
            coulomb: 4.0,
            static_excess: 2.0,
            stribeck_velocity: 0.1,
            viscous: 3.0,
            warm_fraction: 0.5,
            warm_time: 10.0,
            ..Drive::default()
        };
        let moment = |time: f64, speed: f64| JointMoment {
            time,
            position: 0.0,
            speed,
            acceleration: 0.0,
            bristles: 1.0,
            dry: sliding(&drive, speed, 0.0),
            carried: 0.0,
        };
        assert!((own_torque(&drive, &moment(0.0, 0.0)) - 6.0).abs() < 1e-12);
        assert!((own_torque(&drive, &moment(0.0, 1.0)) - 7.0).abs() < 1e-12);
        assert!((own_torque(&drive, &moment(1e4, 1.0)) - 3.5).abs() < 1e-12);
    }
}
