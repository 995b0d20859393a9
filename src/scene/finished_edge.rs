//! An edge before and after it was worked, as it is drawn: the burr that stood on it, and the chamfer in the colours of its error.

use glam::DVec3;

use super::colour::{Colour, of_error};
use crate::recording::RecordingError;

const WITHIN: Colour = [0, 158, 115, 255];
/// Share of the end's colour that the smallest error has: one that is out of tolerance is to be seen as such.
const LEAST_SHARE: f64 = 0.35;
/// Height and leg are drawn so many times as large that the largest is at most this share of the edge.
const LARGEST_DRAWN: f64 = 0.06;
/// Steps of a decade among which the factor is chosen.
const STEPS: [f64; 3] = [1.0, 2.0, 5.0];

/// An edge at a moment while it is worked.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EdgeMoment {
    /// Number of the sample.
    pub sample: usize,
    /// Stations of the edge that are drawn of it.
    pub stations: Vec<usize>,
    /// Height of the burr that stands there [m].
    pub burr: Vec<f64>,
    /// Leg of the chamfer so far [m].
    pub leg: Vec<f64>,
}

/// One value a station in each list.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FinishedEdge {
    /// Points of the sharp edge in the world [m].
    pub points_in_world: Vec<DVec3>,
    /// Unit vectors out of the part, along the bisector of its faces.
    pub outwards: Vec<DVec3>,
    /// Unit vectors from the edge into either face, along the face.
    pub into_faces: Vec<[DVec3; 2]>,
    /// Height of the burr before any work [m].
    pub burr_before: Vec<f64>,
    /// Height of the burr that is left [m].
    pub burr_after: Vec<f64>,
    /// Leg of the chamfer [m].
    pub chamfer_leg: Vec<f64>,
    /// Least and largest leg of a good chamfer [m]; the largest may be infinite.
    pub leg_limits: [f64; 2],
    /// Largest burr that may be left [m].
    pub burr_limit: f64,
    /// The edge while it is worked, from before any work to after all of it; empty where that is not known.
    pub course: Vec<EdgeMoment>,
}

impl FinishedEdge {
    /// Checks that its lists are of one length.
    ///
    /// # Errors
    /// [`RecordingError::Scene`] naming the list that is not.
    pub fn check(&self) -> Result<(), RecordingError> {
        let expected = self.points_in_world.len();
        for (what, found) in [
            ("outward directions", self.outwards.len()),
            ("directions into the faces", self.into_faces.len()),
            ("burr heights before", self.burr_before.len()),
            ("burr heights after", self.burr_after.len()),
            ("chamfer legs", self.chamfer_leg.len()),
        ] {
            if found != expected {
                let what = format!("number of {what} of the finished edge");
                return Err(RecordingError::scene(what, found, expected));
            }
        }
        Ok(())
    }

    /// Relative error of a leg [m] against its tolerance [1]: 0 within it; below it what is missing as a share of the least leg, from 0 to -1; above it
    /// what is too much as a share of the largest.
    #[must_use]
    pub fn error(&self, leg: f64) -> f64 {
        let [least, most] = self.leg_limits;
        if leg < least {
            (leg - least) / least
        } else if leg > most {
            (leg - most) / most
        } else {
            0.0
        }
    }

    /// Green within the tolerance, from pale to full blue too little, from pale to full vermilion too much; full where no chamfer is, or one twice as large
    /// as it may be.
    #[must_use]
    pub fn colour(&self, leg: f64) -> Colour {
        let error = self.error(leg);
        if error == 0.0 {
            return WITHIN;
        }
        let share = LEAST_SHARE + (1.0 - LEAST_SHARE) * error.abs().min(1.0);
        of_error(share.copysign(error))
    }

    /// Stretches of stations, from one to before another, on which more burr is left than may be.
    #[must_use]
    pub fn burred(&self) -> Vec<std::ops::Range<usize>> {
        let mut stretches: Vec<std::ops::Range<usize>> = Vec::new();
        for (station, height) in self.burr_after.iter().enumerate() {
            if *height > self.burr_limit {
                match stretches.last_mut() {
                    Some(last) if last.end == station => last.end += 1,
                    _ => stretches.push(station..station + 1),
                }
            }
        }
        stretches
    }

    /// How many times as large as they are heights and legs are drawn, for burr and chamfer to be seen beside the edge: one of 1, 2, 5, 10, 20, 50 ..
    #[must_use]
    pub fn factor(&self) -> f64 {
        let length: f64 = (self.points_in_world.windows(2))
            .map(|ends| (ends[1] - ends[0]).length())
            .sum();
        let sizes = self.burr_before.iter().chain(&self.chamfer_leg);
        let largest = sizes.copied().fold(0.0, f64::max);
        let decades = (0..4).map(|power| 10f64.powi(power));
        let factors = decades.flat_map(|decade| STEPS.map(|step| step * decade));
        let fits = |factor: &f64| factor * largest <= LARGEST_DRAWN * length;
        factors.take_while(fits).last().unwrap_or(1.0)
    }

    /// How to read the colours, in Markdown.
    #[must_use]
    pub fn legend(&self) -> String {
        let factor = self.factor();
        let [least, most] = self.leg_limits.map(|leg| 1e3 * leg);
        let tolerance = match (least > 0.0, most.is_finite()) {
            (true, true) => format!("{least} to {most} mm"),
            (true, false) => format!("at least {least} mm"),
            (false, true) => format!("at most {most} mm"),
            (false, false) => "any leg".to_owned(),
        };
        let burr_row = match self.course.is_empty() {
            true => "",
            false => "| `/cell/edge/burr` | bronze: height of the burr that stands at the time |\n",
        };
        format!(
            "## The edge before and after\n\n\
             Drawn {factor} times as large as it is.\n\n\
             | entity | what it shows |\n| --- | --- |\n\
             | `/cell/edge/before` | grey: height of the burr before any work |\n\
             {burr_row}| `/cell/edge/after` | leg of the chamfer, on either face. Green: within the tolerance, {tolerance}. Blue: too little, full where there is no \
             chamfer. Orange: too much, full at twice the largest |\n\
             | `/cell/edge/residual_burr` | purple: height of the burr that is left where it is more than {} mm |\n",
            1e3 * self.burr_limit
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::colour::{TOO_LITTLE, TOO_MUCH};
    use super::*;

    /// An edge of 100 mm along x, a station each 10 mm.
    fn edge(burr_after: [f64; 11]) -> FinishedEdge {
        FinishedEdge {
            points_in_world: (0..11).map(|i| 0.01 * f64::from(i) * DVec3::X).collect(),
            outwards: vec![DVec3::Z; 11],
            into_faces: vec![[DVec3::Y, DVec3::NEG_Y]; 11],
            burr_before: vec![0.4e-3; 11],
            burr_after: burr_after.to_vec(),
            chamfer_leg: vec![0.5e-3; 11],
            leg_limits: [0.2e-3, 0.6e-3],
            burr_limit: 0.02e-3,
            course: Vec::new(),
        }
    }

    #[test]
    fn a_chamfer_is_green_within_its_tolerance_blue_below_and_vermilion_above() {
        let edge = edge([0.0; 11]);
        assert_eq!(edge.colour(0.2e-3), WITHIN);
        assert_eq!(edge.colour(0.6e-3), WITHIN);
        assert_eq!(edge.colour(0.0), TOO_LITTLE);
        assert_eq!(edge.colour(1.2e-3), TOO_MUCH);
        assert_eq!(edge.colour(5e-3), TOO_MUCH);
        // Half of the least leg, and half as much again as the largest: 0.675 of the way.
        assert_eq!(edge.colour(0.1e-3), [80, 157, 200, 255]);
        assert_eq!(edge.colour(0.9e-3), [223, 143, 80, 255]);
        // Without a bound above nothing is too much, without one below nothing too little.
        let open = FinishedEdge {
            leg_limits: [0.0, f64::INFINITY],
            ..edge
        };
        assert_eq!([0.0, 0.02].map(|leg| open.colour(leg)), [WITHIN; 2]);
        assert!(open.legend().contains("within the tolerance, any leg."));
    }

    #[test]
    fn burr_that_is_left_makes_stretches_and_the_largest_size_a_factor() {
        let mut left = [0.0; 11];
        for i in [0, 1, 2, 5, 10] {
            left[i] = 0.03e-3;
        }
        left[7] = 0.02e-3;
        let edge = edge(left);
        assert_eq!(edge.burred(), [0..3, 5..6, 10..11]);
        // 0.5 mm ten times is 5 mm, twenty times would be more than 6 mm.
        assert_eq!(edge.factor(), 10.0);
        assert!(edge.legend().contains("Drawn 10 times as large"));
        edge.check().unwrap();
        let short = FinishedEdge {
            chamfer_leg: vec![],
            ..edge
        };
        let message = short.check().unwrap_err().to_string();
        assert!(message.contains("number of chamfer legs"), "{message}");
    }
}
