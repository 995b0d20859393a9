//! The file's links and joints by name: what hangs on what, and where joints off the path are held.

use super::Refusal;
use crate::arm::chain::JointKind;
use std::collections::BTreeMap;
use urdf_rs::{Joint, JointType, Link, Robot};

/// Names of a list that a message shows.
const SHOWN: usize = 20;

/// Names with commas between them: of many the first.
pub(super) fn few(names: &[&str]) -> String {
    match names.len() {
        count if count > SHOWN => {
            format!("{} and {} more", names[..SHOWN].join(", "), count - SHOWN)
        }
        _ => names.join(", "),
    }
}

/// Look-up of links and joints by name.
pub(super) struct Graph<'a> {
    links: BTreeMap<&'a str, &'a Link>,
    joints: BTreeMap<&'a str, &'a Joint>,
    joint_above: BTreeMap<&'a str, &'a Joint>,
    joints_below: BTreeMap<&'a str, Vec<&'a Joint>>,
}

impl<'a> Graph<'a> {
    pub fn build(robot: &'a Robot) -> Result<Self, Refusal> {
        let mut graph = Self {
            links: BTreeMap::new(),
            joints: BTreeMap::new(),
            joint_above: BTreeMap::new(),
            joints_below: BTreeMap::new(),
        };
        let duplicate = |what, name: &str| Refusal::Duplicate {
            what,
            name: name.to_string(),
        };
        for link in &robot.links {
            if graph.links.insert(&link.name, link).is_some() {
                return Err(duplicate("link", &link.name));
            }
        }
        for joint in &robot.joints {
            if graph.joints.insert(&joint.name, joint).is_some() {
                return Err(duplicate("joint", &joint.name));
            }
            for link in [&joint.parent.link, &joint.child.link] {
                if !graph.links.contains_key(link.as_str()) {
                    return Err(Refusal::DanglingJoint {
                        joint: joint.name.clone(),
                        link: link.clone(),
                    });
                }
            }
            let below = graph.joints_below.entry(&joint.parent.link);
            below.or_default().push(joint);
            if let Some(first) = graph.joint_above.insert(&joint.child.link, joint) {
                return Err(Refusal::TwoParents {
                    link: joint.child.link.clone(),
                    first: first.name.clone(),
                    second: joint.name.clone(),
                });
            }
        }
        Ok(graph)
    }

    pub fn link(&self, name: &str, role: &'static str) -> Result<&'a Link, Refusal> {
        self.links.get(name).copied().ok_or_else(|| {
            let known: Vec<_> = self.links.keys().copied().collect();
            Refusal::UnknownLink {
                role,
                link: name.to_string(),
                known: few(&known),
            }
        })
    }

    pub fn root(&self) -> Result<&'a Link, Refusal> {
        let no_joint_above = |name: &&&str| !self.joint_above.contains_key(**name);
        let roots: Vec<_> = self.links.keys().filter(no_joint_above).copied().collect();
        match roots.as_slice() {
            [only] => self.link(only, "base"),
            [] => Err(Refusal::Ring {
                links: few(&self.links.keys().copied().collect::<Vec<_>>()),
            }),
            _ => Err(Refusal::NoSingleRoot {
                roots: format!("{} ({})", roots.len(), few(&roots)),
            }),
        }
    }

    /// The joints below a link, in the order of the file.
    pub fn below(&self, link: &str) -> &[&'a Joint] {
        self.joints_below.get(link).map_or(&[], Vec::as_slice)
    }

    /// All joints above a link, the root's first.
    pub fn above(&self, link: &Link) -> Vec<&'a Joint> {
        let mut above: Vec<&Joint> = Vec::new();
        let mut name = link.name.as_str();
        while let Some(joint) = self.joint_above.get(name) {
            // A ring of joints has no end.
            if above.len() > self.joints.len() {
                break;
            }
            above.push(joint);
            name = &joint.parent.link;
        }
        above.reverse();
        above
    }

    /// The root from which a link hangs.
    pub fn root_above(&self, link: &Link) -> String {
        let above = self.above(link);
        above
            .first()
            .map_or_else(|| link.name.clone(), |joint| joint.parent.link.clone())
    }

    /// All joints between base and tip, base first.
    pub fn path(&self, base: &Link, tip: &Link) -> Result<Vec<&'a Joint>, Refusal> {
        let not_reached = || Refusal::TipNotReached {
            base: base.name.clone(),
            tip: tip.name.clone(),
        };
        let mut path = Vec::new();
        let mut link = tip.name.as_str();
        while link != base.name {
            let joint = *self.joint_above.get(link).ok_or_else(not_reached)?;
            // A ring of joints never gets to the base.
            if path.len() > self.joints.len() {
                return Err(not_reached());
            }
            if let (Some(mimic), Some(_)) = (&joint.mimic, kind_of(joint)?) {
                return Err(Refusal::MimicOnPath {
                    joint: joint.name.clone(),
                    source_joint: mimic.joint.clone(),
                });
            }
            path.push(joint);
            link = &joint.parent.link;
        }
        path.reverse();
        Ok(path)
    }

    /// Position at which a moving joint off the path is held: zero or the limit nearest to it; a mimic
    /// joint follows its source.
    pub fn held_position(&self, joint: &Joint, path: &[&Joint]) -> Result<f64, Refusal> {
        let (mut scale, mut offset) = (1.0, 0.0);
        let mut joint = joint;
        for _ in 0..=self.joints.len() {
            let Some(mimic) = &joint.mimic else {
                return Ok(scale * rest_position(joint)? + offset);
            };
            let refused = |why| Refusal::Mimic {
                joint: joint.name.clone(),
                source_joint: mimic.joint.clone(),
                why,
            };
            offset += scale * mimic.offset.unwrap_or(0.0);
            scale *= mimic.multiplier.unwrap_or(1.0);
            if !scale.is_finite() || !offset.is_finite() {
                return Err(refused(
                    "it follows by a factor or offset that is not finite",
                ));
            }
            let source = self.joints.get(mimic.joint.as_str());
            let source = *source.ok_or_else(|| refused("the file does not define"))?;
            if path.iter().any(|step| step.name == source.name) {
                return Err(refused(
                    "moves with the arm: its load would have to move too",
                ));
            }
            joint = source;
        }
        Err(Refusal::Mimic {
            joint: joint.name.clone(),
            source_joint: joint
                .mimic
                .as_ref()
                .map_or_else(String::new, |m| m.joint.clone()),
            why: "mimics it in turn",
        })
    }
}

fn rest_position(joint: &Joint) -> Result<f64, Refusal> {
    let (lower, upper) = match joint.joint_type {
        JointType::Revolute | JointType::Prismatic => (joint.limit.lower, joint.limit.upper),
        _ => return Ok(0.0),
    };
    if lower <= upper {
        Ok(0.0f64.clamp(lower, upper))
    } else {
        Err(Refusal::PositionLimits {
            joint: joint.name.clone(),
            lower,
            upper,
            origin: "",
        })
    }
}

/// Motion of a joint; none if it is fixed.
pub(super) fn kind_of(joint: &Joint) -> Result<Option<JointKind>, Refusal> {
    let refused = |kind| {
        Err(Refusal::JointType {
            joint: joint.name.clone(),
            kind,
        })
    };
    match joint.joint_type {
        JointType::Revolute | JointType::Continuous => Ok(Some(JointKind::Revolute)),
        JointType::Prismatic => Ok(Some(JointKind::Prismatic)),
        JointType::Fixed => Ok(None),
        JointType::Floating => refused("floating"),
        JointType::Planar => refused("planar"),
        JointType::Spherical => refused("spherical"),
    }
}
