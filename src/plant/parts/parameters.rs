//! Properties of a link of the chain that the whole device's description leaves out.

/// Parameters of single links; [`LinkParameters::NONE`] changes nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkParameters {
    /// Half of what the viscous coefficient is larger by in extension than in retraction [N s/m].
    pub viscous_asymmetry: f64,
    /// Time constant of the regulator while it vents [s]; that of filling where there is none.
    pub venting_time_constant: Option<f64>,
    /// The same while nothing is set at all, where the exhaust then stands open [s].
    pub shut_time_constant: Option<f64>,
    /// Share of a change of the outlet that follows only as the load behind a line fills [1].
    pub load_share: f64,
    /// Time in which that load fills [s].
    pub load_time: f64,
    /// Leak of a closed chamber.
    pub leak: ChamberLeak,
    /// Pressure that a freshly filled chamber loses as its air cools [Pa].
    pub cooling: f64,
    /// Time in which it does [s].
    pub cooling_time: f64,
    /// Time after the start of the recording until which a closed chamber is still fed [s].
    pub shut_time: f64,
    /// Difference of a closed chamber's start from its first readings [Pa].
    pub start_error: f64,
}

/// Leak of a closed chamber, by its volume. Rates are of the pressure, whose fall is what shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChamberLeak {
    /// Through an orifice: equivalent area by volume [1/m].
    pub orifice: f64,
    /// Through a narrow gap or pores: rate by the difference of the squared absolute pressures [1/(Pa s)].
    pub laminar: f64,
    /// In proportion to the gauge pressure [1/s].
    pub proportional: f64,
    /// Growth of that with the gauge pressure: the leak opens as it is pressed [1/Pa].
    pub opening: f64,
}

impl LinkParameters {
    /// Nothing besides.
    pub const NONE: Self = Self {
        viscous_asymmetry: 0.0,
        venting_time_constant: None,
        shut_time_constant: None,
        load_share: 0.0,
        load_time: 1.0,
        leak: ChamberLeak {
            orifice: 0.0,
            laminar: 0.0,
            proportional: 0.0,
            opening: 0.0,
        },
        cooling: 0.0,
        cooling_time: 10.0,
        shut_time: 0.0,
        start_error: 0.0,
    };
}
