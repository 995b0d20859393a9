//! Bodies and lines in space, which a reader turns in the browser: plain data for `assets/page/drawing.js`.

use serde::{Deserialize, Serialize};

/// Red, green and blue, 0 to 255.
pub type Shade = [u8; 3];

/// A drawing in space: z up, lengths in mm.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Drawing {
    /// What it shows, for those who do not see it.
    pub name: String,
    /// What helps to read it; may be empty.
    pub words: String,
    /// Ways to look at it, the first at first.
    pub views: Vec<DrawnView>,
    /// Solid bodies.
    pub bodies: Vec<DrawnBody>,
    /// Lines on them.
    pub lines: Vec<DrawnLine>,
    /// The force at the contact.
    pub arrow: Option<DrawnArrow>,
    /// Meaning of the shades of lines.
    pub legend: Option<DrawnLegend>,
}

/// What is seen, and from where.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawnView {
    /// Its name.
    pub name: String,
    /// Direction from what is shown to the eye.
    pub eye: [f64; 3],
}

/// A solid body.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawnBody {
    /// The one view that shows it; none where all do.
    pub view: Option<usize>,
    /// Its colour; none for that of a part, which goes with the page's.
    pub shade: Option<Shade>,
    /// Its corners, three numbers each [mm].
    #[serde(with = "super::packed::floats")]
    pub corners: Vec<f32>,
    /// Three corners a triangle, counter-clockwise from outside.
    #[serde(with = "super::packed::indices")]
    pub triangles: Vec<u32>,
}

/// A line in space that can be picked.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawnLine {
    /// As a table beside the drawing calls it in its first column.
    pub id: String,
    /// What stands beside it; may be empty.
    pub label: String,
    /// The one view that shows it; none where all do.
    pub view: Option<usize>,
    /// Its points, three numbers each [mm]; a closed one ends with its first.
    #[serde(with = "super::packed::floats")]
    pub points: Vec<f32>,
    /// Which of the page's colours it has.
    pub colour: usize,
    /// Whether it is pale, as one that is not for use.
    pub pale: bool,
    /// A colour for each segment in place of that one; may be empty.
    pub shades: Vec<Shade>,
    /// Value of each segment, in the legend's unit, NaN where there is none; may be empty.
    #[serde(with = "super::packed::floats")]
    pub values: Vec<f32>,
    /// Direction away from the bodies.
    pub outward: [f64; 3],
    /// Its facts: names and values, the first of them under the pointer too.
    pub facts: Vec<[String; 2]>,
    /// A remark; may be empty.
    pub remark: String,
    /// Lines to be copied; may be empty.
    pub lines: String,
    /// Meaning of its own shades, in place of the drawing's; where it is shown, lines of all views are not.
    #[serde(default)]
    pub legend: Option<DrawnLegend>,
}

/// An arrow in space.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawnArrow {
    /// The one view that shows it; none where all do.
    pub view: Option<usize>,
    /// Its tip [mm].
    pub at: [f32; 3],
    /// Unit vector along it.
    pub along: [f32; 3],
    /// What stands beside it.
    pub label: String,
}

/// A bar of shades with its ends.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DrawnLegend {
    /// The quantity.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// Whether its values are sizes, without a sign.
    #[serde(default)]
    pub unsigned: bool,
    /// At its left, middle and right.
    pub ends: [String; 3],
    /// From left to right.
    pub shades: Vec<Shade>,
    /// Shade and name of what has no value; none where all have one.
    pub none: Option<(Shade, String)>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_comes_back_from_its_file() {
        let drawing = Drawing {
            bodies: vec![DrawnBody {
                corners: vec![0.1, -2.5e-7, 1e9],
                triangles: vec![0, 70_000, u32::MAX],
                ..DrawnBody::default()
            }],
            lines: vec![DrawnLine {
                values: vec![0.3, f32::INFINITY],
                ..DrawnLine::default()
            }],
            ..Drawing::default()
        };
        let text = serde_json::to_string(&drawing).unwrap();
        // 0.1, as IEEE 754 has it: cd cc cc 3d.
        assert!(text.contains("\"corners\":\"zczMP"), "{text}");
        assert_eq!(serde_json::from_str::<Drawing>(&text).unwrap(), drawing);
        let cut = text.replace("zczMP", "zczM");
        assert!(serde_json::from_str::<Drawing>(&cut).is_err());
    }
}
