//! Further properties of single links of a device, in recordings of them alone.

use super::{ANY, Number, numbers};

#[rustfmt::skip] // A table: one number a line.
numbers! { LINKS:
    /// viscous friction one way beyond that of the other
    VISCOUS_ASYMMETRY = "links.viscous_asymmetry_n_s_per_m", ANY, (p => p.links.viscous_asymmetry);
    /// lag of the regulator as it vents
    VENTING_TIME_CONSTANT = "links.venting_time_constant_s", ANY, (
        |p, _| p.links.venting_time_constant.unwrap_or(p.device.regulator.time_constant),
        |p, _, v| p.links.venting_time_constant = Some(v)
    );
    /// lag of the regulator where nothing is set
    SHUT_TIME_CONSTANT = "links.shut_time_constant_s", ANY, (
        |p, _| p.links.shut_time_constant.or(p.links.venting_time_constant).unwrap_or(p.device.regulator.time_constant),
        |p, _, v| p.links.shut_time_constant = Some(v)
    );
    /// share of the load behind a line
    LOAD_SHARE = "links.load_share", ANY, (p => p.links.load_share);
    /// time constant of that share
    LOAD_TIME = "links.load_time_s", ANY, (p => p.links.load_time);
    /// leak as through a short hole, over the chamber's volume
    ORIFICE_LEAK = "links.orifice_area_per_volume_1_per_m", ANY, (p => p.links.leak.orifice);
    /// leak as through a narrow gap, over the chamber's volume
    GAP_LEAK = "links.gap_conductance_per_volume_1_per_pa_s", ANY, (p => p.links.leak.laminar);
    /// leak in proportion to gauge pressure, over the chamber's volume
    PROPORTIONAL_LEAK = "links.conductance_per_volume_1_per_s", ANY, (p => p.links.leak.proportional);
    /// growth of that leak with pressure
    LEAK_OPENING = "links.growth_per_pressure_1_per_pa", ANY, (p => p.links.leak.opening);
    /// pressure that the air of a filled chamber loses as it cools
    COOLING = "links.pressure_lost_pa", ANY, (p => p.links.cooling);
    /// time constant of that
    COOLING_TIME = "links.cooling_time_constant_s", ANY, (p => p.links.cooling_time);
    /// when a chamber is shut, after the recording's beginning
    SHUT_TIME = "links.shut_time_s", ANY, (p => p.links.shut_time);
    /// how far a chamber's first reading is off
    START_ERROR = "links.start_error_pa", ANY, (p => p.links.start_error);
}
