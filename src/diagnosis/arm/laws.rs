//! Laws without a name that are tried at joints: forms over what moves a joint, each with places and widths over its range.

use super::effect::{Candidate, law, ripple_cycles};
use super::evidence::Evidence;
use super::fit::Fit;
use crate::recorded_arm::Quantity;
use crate::recorded_arm::law::{Factor, Shape, Variable};
use crate::recorded_arm::simulate::moments;

/// Places over the range of a variable.
const PLACES: usize = 15;
/// Widths, as shares of the range.
const WIDTHS: [f64; 4] = [0.03, 0.08, 0.2, 0.5];

/// Laws at a joint.
#[must_use]
pub fn laws(evidence: &Evidence, fit: &Fit, joint: usize) -> Vec<Candidate> {
    let mut all = Vec::new();
    let factors = [Factor::One, Factor::Friction, Factor::Speed];
    for variable in Variable::ALL {
        let Some([low, high]) = range(evidence, fit, joint, variable) else {
            continue;
        };
        let span = high - low;
        let place = (Quantity::LawPlace(0), [low - span, high + span]);
        let width = (Quantity::LawWidth(0), [2e-3 * span, 5.0 * span]);
        for factor in factors {
            let of = |shape| (shape, variable, factor);
            // Motor inertia, a spring, viscous friction have names; a square of the speed is among the forms.
            let named = matches!(
                (variable, factor),
                (
                    Variable::Angle | Variable::Acceleration | Variable::Speed,
                    Factor::One
                ) | (Variable::Load, Factor::Friction)
                    | (Variable::Speed, Factor::Speed)
            );
            for i in 1..PLACES {
                let at = low + span * i as f64 / PLACES as f64;
                for shape in [Shape::SlopeAbove, Shape::SlopeBelow] {
                    all.push(law(joint, of(shape), (at, 1.0), &[place]));
                }
                for share in WIDTHS {
                    let form = of(Shape::Bump);
                    all.push(law(joint, form, (at, share * span), &[place, width]));
                }
                if variable == Variable::Time {
                    all.push(law(joint, of(Shape::Step), (at, 1.0), &[]));
                }
            }
            if !named {
                all.push(law(joint, of(Shape::Linear), (0.0, 1.0), &[]));
            }
            for shape in [Shape::Square, Shape::Cube] {
                all.push(law(joint, of(shape), (0.0, 1.0), &[]));
            }
            for share in WIDTHS {
                let saturates = matches!(variable, Variable::Time | Variable::Angle);
                let shape = if saturates {
                    Shape::Approach
                } else {
                    Shape::Saturation
                };
                if variable != Variable::Angle {
                    all.push(law(joint, of(shape), (0.0, share * span), &[width]));
                }
            }
        }
    }
    for cycles in ripple_cycles(evidence.input, joint) {
        let form = (Shape::Sine, Variable::Angle, Factor::One);
        let near = (
            Quantity::LawPlace(0),
            [0.9 * cycles - 2.0, 1.1 * cycles + 2.0],
        );
        all.push(law(joint, form, (cycles, 1.0), &[near]));
    }
    // Both directions do not resist alike.
    all.push(law(
        joint,
        (Shape::Constant, Variable::Load, Factor::Load),
        (0.0, 1.0),
        &[],
    ));
    all
}

/// Least and largest value of a variable where the joint's current counts; none where it does not vary.
fn range(evidence: &Evidence, fit: &Fit, joint: usize, variable: Variable) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for (r, recording) in evidence.input.recordings.iter().enumerate() {
        let (bristles, carried) = (fit.course.bristles(r), fit.course.carried(r));
        for moment in moments(
            &fit.arm.drives[joint],
            &recording.motion,
            bristles,
            carried,
            joint,
        ) {
            let value = variable.of(&moment);
            (low, high) = (low.min(value), high.max(value));
        }
    }
    (high - low > 1e-9).then_some([low, high])
}
