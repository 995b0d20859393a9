//! Known physics of a similar shape, and where to look for it: a table from port, variable, direction of motion and form to words. The first row
//! that fits counts.

use super::form::Form::{self, Even, Localised, Monotonic, Odd, Periodic};
use crate::plant::Latent;
use crate::plant::Port::{
    ContactStiffness, ExhaustOrifice, FirstChamberFlow, FirstChamberLeak, ForceReading, Friction,
    OutletPressure, PistonForce, PressureReading, SecondChamberFlow, SecondChamberLeak,
    SetPressure as AtSetPressure, StrokeReading, SupplyOrifice, Surface as AtSurface,
};
use crate::plant::Variable::{
    ChamberPressure, ContactForce, MassFlow, PressureDifference, SetPressure, Stroke, Surface,
    Time, Velocity,
};

/// Known physics that a term may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Known {
    /// Physics that it may be.
    pub resembles: &'static str,
    /// Thing to look at, or to try.
    pub check: &'static str,
}

/// Known physics with the shape of a term.
#[must_use]
pub fn known(latent: &Latent, form: Form) -> Known {
    let (resembles, check) = words(latent, form);
    Known { resembles, check }
}

#[rustfmt::skip] // A table: one shape a line.
fn words(latent: &Latent, form: Form) -> (&'static str, &'static str) {
    match (latent.port, latent.variable, latent.directed, form) {
        (Friction, Stroke, _, Localised) => ("a tight spot: a sticking guide, a burr or dent on the rod, a kinked seal", "move the rod by hand through that part of the stroke, without pressure"),
        (PistonForce, Stroke, _, Localised) => ("a sticking spot that gives way, a burr on the rod, a magnetic detent, a snap latch or a cable guide that catches", "move the rod by hand through that part of the stroke, without pressure, and look what touches there"),
        (Friction, Stroke, _, _) => ("friction that changes along the stroke: a bent rod, a tapered bore, misaligned guides", "measure the breakaway force at several strokes, both ways"),
        (PistonForce, Stroke, _, _) => ("a spring that is not linear, a cable or hose that goes taut, a counterweight's linkage", "pull the slide with a spring balance from stroke to stroke, without pressure"),
        (PistonForce, Velocity, _, Odd) => ("drag that grows faster than the speed: a damper, air pushed through a narrow way, grease", "disconnect dampers and covers one by one and stroke freely"),
        (PistonForce, Velocity, _, Even) => ("a force that does not care about the direction of motion: a stream, an unbalanced spindle's thrust", "stroke freely with spindle and suction off"),
        (PistonForce, Velocity, _, _) => ("a damper or a seal whose drag depends on the direction of motion", "disconnect dampers one by one and stroke freely at several pressures"),
        (Friction, Time, _, _) => ("friction that changes while it runs: grease that warms up, a seal that dries", "record a long run and a second one right after it"),
        (PistonForce, Time, _, Periodic) => ("an unbalanced spindle, a vibrating neighbour, a cutter's teeth", "record with the spindle off, and at another speed"),
        (PistonForce, Time, _, _) => ("something outside that pulls at certain times: a hose or cable moved by the robot, another machine", "record the same program with the robot standing still"),
        (Friction, ChamberPressure | PressureDifference, _, _) => ("seals whose friction does not grow in proportion to the pressure", "measure the breakaway force at several pressures"),
        (PistonForce, ChamberPressure | PressureDifference, _, _) => ("a piston area off its nominal value, a chamber that does not vent to the atmosphere, a pressure that does not reach the piston", "check bore and rod, and measure both chambers' pressures"),
        (Friction, ContactForce, _, _) => ("guides that rub under side load: the contact force acts at an angle or off the axis", "press with the tool on the axis and off it"),
        (PistonForce, ContactForce, _, _) => ("a second way for the force: a stop, a bellows or a bracket that takes a part of it", "press on the load cell at several forces with covers off"),
        (PistonForce, Surface, _, _) => ("something that comes with the robot's place along the axis: a cable, a hose, a misaligned fixture", "record the same program further along the axis"),
        (PistonForce, _, _, _) => ("a force that comes with the air or with the set value: a line that stiffens, a valve that pushes", "hold the piston and step the set pressure"),
        (Friction, _, _, _) => ("friction that changes from place to place or from time to time: seals, guides, grease", "measure the breakaway force under several conditions"),
        (AtSetPressure | OutletPressure, Time, _, Periodic) => ("a supply compressor that switches in and out, a regulator's dither, another consumer that cycles", "log the supply pressure, and record with other consumers and the dither off"),
        (AtSetPressure, Time, _, _) => ("a set value that shifts while it runs: a converter that drifts, a controller that adds to it", "log what the controller sends, beside the regulator's own display"),
        (OutletPressure, Time, _, _) => ("a supply pressure that changes, another consumer on the same line, a regulator that drifts as it warms up", "log the supply pressure during a recording"),
        (AtSetPressure | OutletPressure, SetPressure, _, _) => ("a set value that is not linear: a converter that saturates, a worn potentiometer, a dead band near zero", "step through all set pressures, up and down, and note what a gauge shows"),
        (OutletPressure, MassFlow, _, _) => ("a regulator that droops when air flows, a filter or fitting that is too narrow before it", "measure the outlet while venting through orifices of several sizes"),
        (AtSetPressure, _, _, _) => ("a controller that sends another set value than the log says", "compare what the regulator receives with the log"),
        (OutletPressure, _, _, _) => ("a regulator that reacts on the pressure behind it: a worn diaphragm, a leaking relief seat", "close the line behind the regulator and step through the set pressures"),
        (FirstChamberFlow | FirstChamberLeak, Stroke, _, _) => ("a leak that depends on where the piston stands: a scratch in the bore, a worn seal at a spot", "hold the piston at several strokes under pressure and listen, or measure what air is drawn"),
        (SecondChamberFlow | SecondChamberLeak, Stroke, _, _) => ("a leak that depends on where the piston stands: a scratch in the bore, a worn rod seal at a spot", "hold the piston at several strokes under pressure and listen, or measure what air is drawn"),
        (FirstChamberFlow | SecondChamberFlow | FirstChamberLeak | SecondChamberLeak, ChamberPressure | PressureDifference, _, _) => ("a leak that opens with the pressure: a lip seal that lifts, a check or relief valve", "close the supply at several pressures and time how they fall"),
        (FirstChamberFlow | SecondChamberFlow | FirstChamberLeak | SecondChamberLeak, Velocity, _, _) => ("a seal that leaks while it moves, a quick exhaust valve that opens", "compare slow and fast strokes at the same pressure"),
        (FirstChamberLeak | SecondChamberLeak, _, _, _) => ("an opening to the atmosphere that changes: a seal that wears while it runs, a fitting that works loose", "hold the piston under pressure and time how it falls, before and after a run"),
        (FirstChamberFlow | SecondChamberFlow, _, _, _) => ("a valve that does not close, a line shared with another consumer", "record with the other consumers shut off"),
        (SupplyOrifice, Time, _, _) => ("a supply that narrows or opens while it runs: a filter that clogs, ice, a flow control that creeps", "time how fast the device extends at the start and at the end of a run"),
        (SupplyOrifice, _, _, _) => ("a way to the chamber that is not equally wide: a hose that kinks with the stroke, a valve that opens with the pressure", "time how fast the device extends from several strokes at several pressures"),
        (ExhaustOrifice, Time, _, _) => ("an exhaust that narrows or opens while it runs: a silencer that clogs or ices up", "record with the silencer off"),
        (ExhaustOrifice, _, _, _) => ("an exhaust that is not equally wide: a port that the piston covers, a quick exhaust valve that opens", "time how fast the device retracts from several strokes, with the silencer off"),
        (ContactStiffness, Time, _, _) => ("a contact that softens or stiffens while it runs: a tool that wears, a fixture that works loose", "tap the part with the tool before and after a run"),
        (ContactStiffness, ContactForce, _, _) => ("a contact that is not linear: a fixture that gives way at a load, play that closes", "press at several forces and measure with a dial gauge what moves"),
        (ContactStiffness, _, _, _) => ("a part or a fixture that is stiffer at one place than at another", "press at several places along the edge and measure with a dial gauge what moves"),
        (AtSurface, Time, _, Periodic) => ("a workpiece or a robot that vibrates, a tool that is not round", "record on a rigid block, and with the spindle off"),
        (AtSurface, Time, _, _) => ("a workpiece that shifts or warms up, a robot that settles", "measure the surface with a dial gauge before and after"),
        (AtSurface, Surface, _, _) => ("a robot whose way along the axis is not what it says: gear error, another scale, backlash", "measure the robot's way against a dial gauge"),
        (AtSurface, ContactForce, _, _) => ("a fixture, an arm or a tool that gives way, and not in proportion to the force", "press at several forces and measure with a dial gauge what moves"),
        (AtSurface, _, _, _) => ("a surface or a tool that is worn where it touches, a loose mount", "measure the surface where the tool rides"),
        (ForceReading, ContactForce, _, _) => ("a load cell that is not linear: overloaded once, mounted on a bent plate, touched by a cover", "hang known weights on it, up and down"),
        (ForceReading, Time, _, Periodic) => ("electrical pick-up in the load cell's cable: mains, a drive, a switching supply", "record with the drives off and with the cable moved"),
        (ForceReading, Time, _, _) => ("a load cell that warms up or creeps, a tare taken under load", "record at rest for as long as a run takes"),
        (ForceReading, Stroke, _, _) => ("a cable or hose that pulls on the load cell as the slide moves", "move the slide by hand without contact and watch the reading"),
        (ForceReading, Velocity, _, _) => ("a cover or hose that drags on the load cell while it moves", "stroke freely and watch the reading"),
        (ForceReading, _, _, _) => ("a load cell that feels the pressure: a line or a bracket that strains it", "step the pressure with the piston on its stop and nothing touched"),
        (StrokeReading, Stroke, _, Monotonic) => ("a position sensor whose scale is not even, magnetised at its ends", "compare with a dial gauge all along the stroke"),
        (StrokeReading, Stroke, _, _) => ("a position sensor with an error along its scale: a damaged magnet strip, interpolation error, a bolt nearby", "compare with a dial gauge all along the stroke"),
        (StrokeReading, Velocity, _, _) => ("a position sensor that lags or is mounted loosely", "compare slow and fast strokes over the same way"),
        (StrokeReading, _, _, _) => ("a position sensor that drifts or whose mount shifts", "compare the readings on both stops, before and after a run"),
        (PressureReading, SetPressure | ChamberPressure, _, _) => ("a pressure sensor that is not linear", "compare with a gauge at all pressures"),
        (PressureReading, MassFlow, _, _) => ("a pressure sensor that sits where air streams past: a pressure drop between it and the outlet", "move the sensor to the outlet itself"),
        (PressureReading, Time, _, Periodic) => ("electrical pick-up in the pressure sensor's cable", "record with the drives off"),
        (PressureReading, _, _, _) => ("a pressure sensor that drifts", "compare with a gauge at rest, before and after a run"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Basis, Port, Variable};

    fn of(port: Port, variable: Variable, directed: bool, form: Form) -> Known {
        let basis = Basis::Hats { ends: [0.0, 1.0] };
        let coefficients = vec![0.0; 2];
        let latent = Latent {
            port,
            variable,
            directed,
            basis,
            coefficients,
        };
        known(&latent, form)
    }

    #[test]
    fn a_shape_reminds_of_what_makes_it() {
        let says = |port, variable, directed, form, word: &str| {
            let known = of(port, variable, directed, form);
            assert!(known.resembles.contains(word), "{known:?}");
        };
        says(PistonForce, Stroke, false, Localised, "magnetic detent");
        says(Friction, Stroke, false, Localised, "tight spot");
        says(
            PistonForce,
            Velocity,
            false,
            Odd,
            "grows faster than the speed",
        );
        says(OutletPressure, Time, false, Periodic, "compressor");
        says(ForceReading, ContactForce, false, Form::Broad, "not linear");
    }

    #[test]
    fn every_port_has_words_of_its_own() {
        let mut seen = std::collections::BTreeSet::new();
        for port in Port::ALL {
            let own = of(port, MassFlow, false, Form::Broad);
            assert!(
                [SecondChamberFlow, SecondChamberLeak].contains(&port)
                    || seen.insert(own.resembles),
                "{port:?}"
            );
            for variable in Variable::ALL {
                let known = of(port, variable, false, Form::Broad);
                assert!(!known.resembles.is_empty() && !known.check.is_empty());
            }
        }
    }
}
