//! A law that no list holds: what acts where, by which form, of which variable.
//!
//! ```text
//! acts = a f(u) s(w),   u = (v - v0) / r,   s = 1, w / w_r, or tanh(x' / 1 mm/s)
//! memory:  f of z,  T z' = u - z            (mass flow has one of 1 ms: what flows depends on what acts)
//! spline:  cubic between knots, second derivatives at them from smoothness, none at the ends, straight beyond
//! ```
//!
//! Friction presses the seals: Coulomb friction of `equations::seal` at a level that the law gives.

use crate::listed::listed;

/// Memory that is none [s]: it breaks the loop of a law at the outlet of what flows from there.
pub(super) const AT_ONCE: f64 = 1e-3;

listed! {
    /// Where a law acts.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Place,
    /// In words, with its unit.
    words: [&'static str; 2] {
        /// Force on the piston along extension [N].
        PistonForce = ["force on the piston", "N"],
        /// Level of dry friction of the seals [N].
        Friction = ["dry friction of the seals", "N"],
        /// Leak from chamber 1 to the atmosphere [m2].
        FirstLeak = ["leak of chamber 1 to the atmosphere", "m2"],
        /// Leak from chamber 2 to the atmosphere [m2].
        SecondLeak = ["leak of chamber 2 to the atmosphere", "m2"],
        /// Change of the supply orifice over what it is [1].
        Supply = ["relative change of the supply orifice", ""],
        /// Change of the exhaust orifice over what it is [1].
        Exhaust = ["relative change of the exhaust orifice", ""],
        /// Added to what the regulator follows [Pa].
        SetPressure = ["added to the regulator's target", "Pa"],
        /// Added to the regulator's outlet [Pa].
        Outlet = ["added to the regulator's outlet", "Pa"],
        /// Displacement of the surface along extension [m].
        Surface = ["displacement of the surface", "m"],
        /// Change of the contact's stiffness over what it is [1].
        Stiffness = ["relative change of the contact stiffness", ""],
        /// Added to the load cell's signal [N].
        ForceReading = ["added to the force reading", "N"],
        /// Added to the position sensor's reading [m].
        StrokeReading = ["added to the stroke reading", "m"],
        /// Added to the pressure sensor's reading [Pa].
        PressureReading = ["added to the pressure reading", "Pa"],
    }
}

impl Place {
    /// Subsystem of an answer.
    pub fn subsystem(self) -> &'static str {
        match self {
            Self::PistonForce | Self::Friction => "force_balance",
            Self::FirstLeak | Self::SecondLeak | Self::Supply | Self::Exhaust => "chambers",
            Self::SetPressure | Self::Outlet => "regulator",
            Self::Surface | Self::Stiffness => "contact",
            Self::ForceReading | Self::StrokeReading | Self::PressureReading => "sensors",
        }
    }

    /// Whether less than nothing cannot act here.
    pub fn is_positive(self) -> bool {
        matches!(self, Self::Friction | Self::FirstLeak | Self::SecondLeak)
    }
}

listed! {
    /// What a law depends on.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Driver: 10,
    /// Name in the vocabulary of an answer, and unit.
    name: [&'static str; 2] {
        /// Time of the recording [s].
        Time = ["time", "s"],
        /// Stroke [m].
        Stroke = ["stroke_m", "m"],
        /// Speed of extension [m/s].
        Velocity = ["velocity", "m/s"],
        /// Direction of motion [1].
        Direction = ["velocity_sign", ""],
        /// Pressure of chamber 1 [Pa absolute].
        ChamberPressure = ["chamber_pressure", "Pa"],
        /// Pressure of chamber 1 less that of chamber 2 [Pa].
        PressureDifference = ["pressure_difference", "Pa"],
        /// Set pressure [Pa gauge].
        SetPressure = ["set_pressure", "Pa"],
        /// Contact force [N].
        ContactForce = ["contact_force", "N"],
        /// Where the robot says that the surface stands [m].
        Surface = ["surface_m", "m"],
        /// Air drawn from the regulator [kg/s].
        MassFlow = ["mass_flow", "kg/s"],
    }
}

/// A form over u.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// In proportion.
    Proportion,
    /// sign(u) |u|^n.
    Power(f64),
    /// Beyond a threshold alone, in proportion.
    Beyond(f64),
    /// Between two places, with edges as wide as the third number.
    Window([f64; 3]),
    /// Gaussian: middle and width.
    Bump([f64; 2]),
    /// Periods over the unit of u, and phase [rad].
    Sine([f64; 2]),
    /// tanh(u / w).
    Saturating(f64),
    /// A step, with an edge as wide as the second number.
    Step([f64; 2]),
    /// From none to all between two places.
    Ramp([f64; 2]),
    /// 1 - exp(-u / w).
    Approach(f64),
    /// Knots: u, value, second derivative.
    Spline(Vec<[f64; 3]>),
}

impl Form {
    /// A spline through points with rising u.
    pub fn spline(points: &[[f64; 2]]) -> Self {
        let count = points.len();
        let gap = |i: usize| points[i + 1][0] - points[i][0];
        let slope = |i: usize| (points[i + 1][1] - points[i][1]) / gap(i);
        // h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (s[i] - s[i-1]), from the first to the last, then back.
        let mut forward = vec![[0.0; 2]; count];
        for i in 1..count - 1 {
            let pivot = 2.0 * (gap(i - 1) + gap(i)) - gap(i - 1) * forward[i - 1][0];
            let right = 6.0 * (slope(i) - slope(i - 1)) - gap(i - 1) * forward[i - 1][1];
            forward[i] = [gap(i) / pivot, right / pivot];
        }
        let mut bends = vec![0.0; count];
        for i in (1..count - 1).rev() {
            bends[i] = forward[i][1] - forward[i][0] * bends[i + 1];
        }
        let knots = points.iter().zip(bends);
        Self::Spline(knots.map(|([u, y], bend)| [*u, *y, bend]).collect())
    }

    /// Its value.
    pub fn at(&self, u: f64) -> f64 {
        let rise = |u: f64| 0.5 + 0.5 * u.tanh();
        match self {
            Self::Proportion => u,
            Self::Power(n) => u.signum() * u.abs().powf(*n),
            Self::Beyond(from) => (u - from).max(0.0),
            Self::Window([from, to, edge]) => rise((u - from) / edge) - rise((u - to) / edge),
            Self::Bump([middle, width]) => (-((u - middle) / width).powi(2)).exp(),
            Self::Sine([periods, phase]) => (std::f64::consts::TAU * periods * u + phase).sin(),
            Self::Saturating(width) => (u / width).tanh(),
            Self::Step([at, edge]) => rise((u - at) / edge),
            Self::Ramp([from, to]) => ((u - from) / (to - from)).clamp(0.0, 1.0),
            Self::Approach(width) => 1.0 - (-u.max(0.0) / width).exp(),
            Self::Spline(knots) => along(knots, u),
        }
    }

    /// In words, of u.
    fn words(&self) -> String {
        match self {
            Self::Proportion => "u".to_owned(),
            Self::Power(n) => format!("sign(u) |u|^{n:.3}"),
            Self::Beyond(from) => format!("max(u - {from:.4}, 0)"),
            Self::Window([from, to, edge]) => {
                format!("[1 for {from:.4} < u < {to:.4}, edges over {edge:.4}]")
            }
            Self::Bump([middle, width]) => format!("exp(-((u - {middle:.4}) / {width:.4})^2)"),
            Self::Sine([periods, phase]) => format!("sin(2 pi {periods:.4} u + {phase:.3})"),
            Self::Saturating(width) => format!("tanh(u / {width:.4})"),
            Self::Step([at, _]) => format!("[1 for u > {at:.4}]"),
            Self::Ramp([from, to]) => format!("clip((u - {from:.4}) / {:.4}, 0, 1)", to - from),
            Self::Approach(width) => format!("(1 - exp(-u / {width:.4}))"),
            Self::Spline(knots) => {
                let points = knots.iter().map(|[u, y, _]| format!("({u:.3}, {y:.3})"));
                let points: Vec<String> = points.collect();
                format!("spline(u) through {}", points.join(" "))
            }
        }
    }
}

/// A spline's value; straight beyond its ends.
fn along(knots: &[[f64; 3]], u: f64) -> f64 {
    let last = knots.len() - 1;
    let i = knots[1..last].iter().filter(|knot| knot[0] < u).count();
    let ([a, ya, ma], [b, yb, mb]) = (knots[i], knots[i + 1]);
    let gap = b - a;
    let inside = |u: f64| {
        let (p, q) = ((b - u) / gap, (u - a) / gap);
        p * ya + q * yb + ((p.powi(3) - p) * ma + (q.powi(3) - q) * mb) * gap * gap / 6.0
    };
    let end = u.clamp(knots[0][0], knots[last][0]);
    if u == end {
        return inside(u);
    }
    let bent = if u < end {
        -2.0 * ma - mb
    } else {
        ma + 2.0 * mb
    };
    inside(end) + ((yb - ya) / gap + bent * gap / 6.0) * (u - end)
}

/// A law.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Where it acts.
    pub place: Place,
    /// What it depends on.
    pub driver: Driver,
    /// Value of it at which u is 0, and that by which u grows by 1.
    pub scale: [f64; 2],
    /// Its form.
    pub form: Form,
    /// Time constant of its memory [s]; 0 for none.
    pub memory: f64,
    /// A second variable that it is in proportion to, with that at which the factor is 1; the direction of motion turns it.
    pub factor: Option<(Driver, f64)>,
    /// a: its size, in the unit of its place.
    pub size: f64,
}

impl Law {
    /// Variables that it depends on, by the names of an answer.
    pub fn depends_on(&self) -> Vec<&'static str> {
        let turns = (self.place == Place::Friction).then_some(Driver::Direction);
        let factor = self.factor.map(|(driver, _)| driver);
        let drivers = [Some(self.driver), factor, turns];
        drivers
            .into_iter()
            .flatten()
            .map(|driver| driver.name()[0])
            .collect()
    }

    /// u of a value of its variable.
    pub(super) fn scaled(&self, value: f64) -> f64 {
        (value - self.scale[0]) / self.scale[1]
    }

    /// What acts at a u, or at its memory of one, and a value of its factor's variable.
    pub(super) fn at(&self, u: f64, factor: f64) -> f64 {
        let factor = self.factor.map_or(1.0, |(_, unit)| factor / unit);
        let value = self.size * self.form.at(u) * factor;
        if self.place.is_positive() {
            value.max(0.0)
        } else {
            value
        }
    }

    /// The law in a line.
    pub fn formula(&self) -> String {
        let [what, unit] = self.place.words();
        let [name, unit_of] = self.driver.name();
        let [origin, range] = self.scale.map(|number| format!("{number:.5e} {unit_of}"));
        let mut text = format!("{what} = {:.5e} {unit} {}", self.size, self.form.words());
        match self.factor {
            Some((Driver::Direction, _)) => text += " * direction of motion",
            Some((driver, by)) => {
                let [name, unit] = driver.name();
                text += &format!(" * {name} / {by:.5e} {unit}");
            }
            None => {}
        }
        if self.place == Place::Friction {
            text += ", against the motion";
        }
        text += &match self.scale[0] {
            0.0 => format!(", u = {name} / {range}"),
            _ => format!(", u = ({name} - {origin}) / {range}"),
        };
        if self.memory > AT_ONCE {
            text += &format!(" lagged by {:.4} s", self.memory);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::super::concealed::{Concealed, Seals};
    use super::super::draw::NominalRig;
    use super::super::rig::LaboratoryRig;
    use super::super::trajectory::{LaboratoryTrajectory, run};
    use super::*;

    #[test]
    fn a_spline_goes_through_its_points_is_smooth_and_straight_beyond() {
        let points = [[0.0, 0.3], [0.2, -1.0], [0.7, 0.8], [1.0, 0.1]];
        let spline = Form::spline(&points);
        for [u, y] in points {
            assert!((spline.at(u) - y).abs() < 1e-12);
        }
        let slope = |u: f64, h: f64| (spline.at(u + h) - spline.at(u)) / h;
        for [u, _] in points {
            let (before, after) = (slope(u, -1e-6), slope(u, 1e-6));
            assert!((before - after).abs() < 1e-4, "{u}: {before} {after}");
        }
        let bend = |u: f64| (slope(u, 1e-4) - slope(u, -1e-4)) / 1e-4;
        assert!((bend(0.2 - 1e-3) - bend(0.2 + 1e-3)).abs() < 1.0 && bend(-0.5).abs() < 1e-3);
        assert!((slope(1.5, 0.1) - slope(1.0, 1e-6)).abs() < 1e-4);
        // Four points on a parabola's chord: of a straight line nothing bends.
        let line = Form::spline(&[[0.0, 0.0], [0.3, 0.6], [1.0, 2.0]]);
        assert!((line.at(0.77) - 1.54).abs() < 1e-12);
    }

    fn law(place: Place, driver: Driver, form: Form, size: f64) -> Law {
        Law {
            place,
            driver,
            scale: [0.0, 1.0],
            form,
            memory: 0.0,
            factor: None,
            size,
        }
    }

    fn with(concealed: Concealed) -> (LaboratoryRig, LaboratoryTrajectory) {
        let mut nominal = NominalRig::draw(6);
        nominal.rig.gravity = -5.0;
        let programme = &nominal.programmes(6, 2.0)[1];
        let trajectory = run(&nominal.rig, &concealed, programme).unwrap();
        (nominal.rig, trajectory)
    }

    fn of(law: Law) -> Concealed {
        Concealed {
            law: Some(law),
            ..Concealed::default()
        }
    }

    /// Largest distance of the readings, in standard deviations of the noise; of time alone beside that of what moves by a microsecond.
    fn apart(one: Concealed, other: Concealed) -> f64 {
        let ((rig, one), (_, other)) = (with(one), with(other));
        let mut most = 0.0f64;
        for channel in 0..3 {
            let pairs = one.readings[channel].iter().zip(&other.readings[channel]);
            let off = pairs.map(|(a, b)| (a - b).abs() / rig.noise[channel]);
            most = most.max(off.fold(0.0, f64::max));
        }
        most
    }

    #[test]
    fn a_law_of_no_size_changes_nothing_wherever_it_acts() {
        use Place::{
            Exhaust, FirstLeak, ForceReading, Outlet, PistonForce, PressureReading, SecondLeak,
            SetPressure, Stiffness, StrokeReading, Supply, Surface,
        };
        let (_, bare) = with(Concealed::default());
        for place in [
            PistonForce,
            FirstLeak,
            SecondLeak,
            Supply,
            Exhaust,
            SetPressure,
            Outlet,
            Surface,
            Stiffness,
            ForceReading,
            StrokeReading,
            PressureReading,
        ] {
            let (_, found) = with(of(law(place, Driver::Stroke, Form::Proportion, 0.0)));
            assert_eq!(found.readings, bare.readings, "{place:?}");
            let moved = with(of(law(place, Driver::Stroke, Form::Proportion, 0.3))).1;
            assert_ne!(moved.readings, bare.readings, "{place:?}");
        }
    }

    #[test]
    fn a_law_that_is_a_listed_effect_does_what_that_does() {
        let plain = Concealed::default;
        let pull = |stiffness: f64| {
            law(
                Place::PistonForce,
                Driver::Stroke,
                Form::Proportion,
                -stiffness,
            )
        };
        let spring = Concealed {
            spring: 500.0,
            ..plain()
        };
        assert!(apart(of(pull(500.0)), plain()) > 10.0);
        assert!(apart(of(pull(500.0)), spring) < 0.05);
        // u^0 of time is one throughout.
        let always = |place, size| of(law(place, Driver::Time, Form::Power(0.0), size));
        let force = Concealed {
            axial_force: -12.0,
            ..plain()
        };
        assert!(apart(always(Place::PistonForce, -12.0), force) < 0.05);
        let leak = Concealed {
            external_leak: 2e-7,
            ..plain()
        };
        assert!(apart(always(Place::FirstLeak, 2e-7), leak) < 0.05);
        let off = Concealed {
            surface_offset: 4e-4,
            ..plain()
        };
        assert!(apart(always(Place::Surface, 4e-4), off) < 0.05);
        let gain = Concealed {
            force_gain: 1.1,
            ..plain()
        };
        let part = law(
            Place::ForceReading,
            Driver::ContactForce,
            Form::Proportion,
            0.1,
        );
        assert!(apart(of(part), gain) < 1e-6);
        let seals = Seals {
            coulomb: 10.0,
            breakaway: 10.0,
            stribeck_velocity: 0.01,
            viscous: 0.0,
            presliding: 2e-5,
            per_pressure: 0.0,
            elastic_share: 0.4,
        };
        let dry = Concealed {
            seals: Some(seals),
            ..plain()
        };
        assert!(apart(always(Place::Friction, 10.0), dry) < 0.1);
    }

    #[test]
    fn a_memory_lags_as_its_closed_form_does() {
        let mut lagged = law(Place::PressureReading, Driver::Time, Form::Proportion, 1.0);
        lagged.memory = 0.3;
        let (_, found) = with(of(lagged.clone()));
        for (drivers, acts) in found.drivers.iter().zip(&found.law) {
            // T z' = t - z from rest.
            let t = drivers[Driver::Time as usize];
            let closed = t - 0.3 * (1.0 - (-t / 0.3).exp());
            assert!((acts - closed).abs() < 1e-6, "{t}: {acts} {closed}");
        }
        lagged.driver = Driver::ContactForce;
        lagged.scale = [0.0, 100.0];
        let (_, found) = with(of(lagged));
        let (mut z, mut most) = (0.0, 0.0f64);
        for (two, acts) in found.drivers.windows(2).zip(&found.law[1..]) {
            // Of what is straight between two samples.
            let [from, to] = [0, 1].map(|i| two[i][Driver::ContactForce as usize] / 100.0);
            let x: f64 = (two[1][0] - two[0][0]) / 0.3;
            let (kept, ramp) = ((-x).exp(), (1.0 - (-x).exp()) / x);
            z = z * kept + from * (ramp - kept) + to * (1.0 - ramp);
            most = most.max((z - acts).abs());
        }
        let largest = found.law.iter().copied().fold(0.0, f64::max);
        assert!(
            largest > 0.3 && most < 0.02 * largest,
            "{most} of {largest}"
        );
    }

    #[test]
    fn a_surface_that_gives_way_without_delay_is_a_softer_contact() {
        // A memory of 1 ms is short beside all but impacts: x / k + a F is the depth of a contact of stiffness 1 / (1 / k + a).
        let mut gives = law(Place::Surface, Driver::ContactForce, Form::Proportion, 2e-6);
        gives.memory = 1e-3;
        let (rig, found) = with(of(gives));
        let mut softer = rig.clone();
        let give = 1.0 + 2e-6 * rig.contact_stiffness;
        softer.contact_stiffness /= give;
        softer.contact_damping /= give;
        let mut nominal = NominalRig::draw(6);
        nominal.rig.gravity = rig.gravity;
        let programme = &nominal.programmes(6, 2.0)[1];
        let alike = run(&softer, &Concealed::default(), programme).unwrap();
        let mut off: Vec<f64> = (found.readings[1].iter().zip(&alike.readings[1]))
            .map(|(a, b)| (a - b).abs())
            .collect();
        off.sort_by(f64::total_cmp);
        // Some 100 N make 0.2 mm.
        assert!(off[off.len() / 2] < 5e-6, "{}", off[off.len() / 2]);
        let (_, bare) = with(Concealed::default());
        let moved = (found.readings[1].iter().zip(&bare.readings[1])).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f64::max) > 1e-4);
    }

    #[test]
    fn the_formula_names_place_numbers_and_variables() {
        let mut bump = law(
            Place::Friction,
            Driver::Stroke,
            Form::Bump([0.4, 0.1]),
            12.0,
        );
        bump.scale = [0.0, 0.05];
        let text = bump.formula();
        for part in [
            "dry friction",
            "1.20000e1 N",
            "0.4000",
            "u = stroke_m / 5.00000e-2 m",
            "against",
        ] {
            assert!(text.contains(part), "{text}");
        }
        assert_eq!(bump.depends_on(), ["stroke_m", "velocity_sign"]);
    }
}
