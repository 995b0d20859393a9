//! Shape of the device, to its own measures: cylinders on the flange; carriage, spindle and ball nose on the slide.

use glam::DVec3;
use glamx::DPose3;

use crate::arm::{Visual, VisualShape};
use crate::plant::{Nominal, PlantParameters};

type Colour = [u8; 4];
const HOUSING: Colour = [70, 80, 92, 255];
const CYLINDER: Colour = [176, 184, 192, 255];
const CARRIAGE: Colour = [222, 143, 5, 255];
const TOOL: Colour = [60, 60, 60, 255];

/// Thickness of the plate on the flange and of the carriage [m].
const PLATE: f64 = 0.012;
/// Radius of the spindle, and how far from the ball's centre it ends [m].
const SPINDLE: [f64; 2] = [0.019, 0.03];

/// The device's shapes.
pub struct DeviceShape {
    /// On the flange, in its frame.
    pub fixed: Vec<Visual>,
    /// On the slide beside the ball nose, in the slide's frame.
    pub moving: Vec<Visual>,
    /// The ball nose, in the slide's frame.
    pub ball: Visual,
}

fn at(x: f64, z: f64, shape: VisualShape, colour: Colour) -> Visual {
    Visual {
        link_index: 0,
        link_from_visual: DPose3::from_translation(DVec3::new(x, 0.0, z)),
        shape,
        colour,
    }
}

fn along_z(radius: f64, length: f64, x: f64, middle: f64, colour: Colour) -> Visual {
    at(x, middle, VisualShape::Cylinder { radius, length }, colour)
}

fn plate(size: DVec3, middle: f64, colour: Colour) -> Visual {
    at(0.0, middle, VisualShape::Box { size }, colour)
}

impl DeviceShape {
    /// The shapes of a device.
    #[must_use]
    pub fn of(nominal: &Nominal<PlantParameters>) -> Self {
        let (parameters, mounting) = (&nominal.device, &nominal.mounting);
        let barrel = 0.5 * parameters.bore + 0.004;
        let spacing = barrel + 0.028;
        let length = parameters.full_stroke.min(0.6 * mounting.tool_centre);
        let sides: &[f64] = if parameters.cylinder_count > 1 {
            &[-1.0, 1.0]
        } else {
            &[0.0]
        };
        let width = 2.0 * (spacing + barrel);
        let mut fixed = vec![plate(
            DVec3::new(width, 2.0 * barrel, PLATE),
            0.5 * PLATE,
            HOUSING,
        )];
        let mut moving = vec![plate(
            DVec3::new(width, 1.6 * barrel, PLATE),
            length + 0.02,
            CARRIAGE,
        )];
        for side in sides {
            let x = side * spacing;
            fixed.push(along_z(barrel, length, x, PLATE + 0.5 * length, CYLINDER));
            moving.push(along_z(
                0.5 * parameters.rod,
                length,
                x,
                0.5 * length + 0.016,
                TOOL,
            ));
        }
        let [radius, short] = SPINDLE;
        let spindle_end = mounting.tool_centre - short;
        // A tool that is mounted so short has none to speak of.
        let spindle = (spindle_end - length).max(1e-3);
        moving.push(along_z(
            radius,
            spindle,
            0.0,
            spindle_end - 0.5 * spindle,
            HOUSING,
        ));
        moving.push(along_z(
            0.5 * mounting.tool_radius,
            short,
            0.0,
            spindle_end + 0.5 * short,
            TOOL,
        ));
        let ball = VisualShape::Sphere {
            radius: mounting.tool_radius,
        };
        Self {
            fixed,
            moving,
            ball: at(0.0, mounting.tool_centre, ball, CARRIAGE),
        }
    }
}
