//! What a diagnosis is of: a model in numbers that gives readings of channels for the inputs of a recording. A fit knows no more of it than this.

use std::fmt::Debug;

/// What denies a reading that stands alone, far from its neighbours; other channels by their places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Denial {
    /// Nothing: it may be true.
    None,
    /// No sensor need be asked: the model cannot do that.
    Itself,
    /// A channel that shows nothing like the derivative of an order.
    Derivative {
        /// That channel.
        by: usize,
        /// What the derivative is divided by [this channel's unit over its and seconds to the order].
        per: f64,
        /// Order of the derivative.
        order: i32,
    },
    /// A channel of which it is the second derivative, and whose rate does not change as it says.
    TwiceIntegrated {
        /// That channel.
        by: usize,
    },
}

/// A kind of thing that is diagnosed.
pub trait Subject: Copy + Debug + Send + Sync + 'static {
    /// Its description in numbers.
    type Model: Clone + Debug + Send + Sync;
    /// A number of the description that a fit may move.
    type Quantity: Copy + Debug + Send + Sync;
    /// Inputs of one recording.
    type Inputs: Clone + Debug + Send + Sync;
    /// A measured channel.
    type Channel: Copy + Debug + PartialEq + Send + Sync;
    /// Readings of all channels, in their order.
    type Readings: Clone + Debug + AsRef<[Vec<f64>]> + AsMut<[Vec<f64>]> + Send + Sync;
    /// Standard deviations of all channels' noise, in their order.
    type Noise: Copy + Debug + AsRef<[f64]> + Send + Sync;
    /// A simulated recording.
    type Simulated: Clone + Debug + Send + Sync;
    /// What holds a simulation to the measured course of a recording.
    type Guide: Clone + Debug + Send + Sync;

    /// All channels, in their order.
    const CHANNELS: &'static [Self::Channel];

    /// The channel that depends on the fewest parts of the model, if there is one: what it shows can be explained before all else is known.
    const UPSTREAM: Option<Self::Channel>;

    /// Name of a channel's column in a file.
    fn column(channel: Self::Channel) -> &'static str;

    /// Least and largest reading that a sensor of a channel can give.
    fn plausible(channel: Self::Channel) -> [f64; 2];

    /// What can deny a reading of a channel.
    fn denial(channel: Self::Channel, model: &Self::Model) -> Denial;

    /// Value of a quantity.
    fn value(quantity: &Self::Quantity, model: &Self::Model) -> f64;

    /// Changes a quantity.
    fn set(quantity: &Self::Quantity, model: &mut Self::Model, value: f64);

    /// Sample times of a recording [s].
    fn time(inputs: &Self::Inputs) -> &[f64];

    /// Takes its place among the recordings that are fitted together, from 0, and the number of samples at its start that the model takes as they were
    /// measured: these are compared with nothing.
    fn placed(inputs: &mut Self::Inputs, place: usize) -> usize;

    /// What holds a simulation to a recording's measured course.
    fn guide(inputs: &Self::Inputs, readings: &Self::Readings, noise: &Self::Noise) -> Self::Guide;

    /// Whether the readings of a channel go into the course that a guided simulation is held to.
    fn guides(channel: Self::Channel) -> bool;

    /// Simulates a recording, `free` of a workpiece or not. `known` is what another model gave of it, guided alike, which may spare a part of the work.
    fn simulate(
        model: &Self::Model,
        inputs: &Self::Inputs,
        free: bool,
        guide: Option<&Self::Guide>,
        known: Option<(&Self::Model, &Self::Simulated)>,
    ) -> Self::Simulated;

    /// Readings in the order of the channels.
    fn readings(simulated: &Self::Simulated) -> &[Vec<f64>];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::covariance::covariance;
    use crate::diagnosis::fit::cross_validation::{Depth, left_out};
    use crate::diagnosis::fit::free::{Free, Prior};
    use crate::diagnosis::fit::model_error::ModelError;
    use crate::diagnosis::fit::{FINEST, FULL, Limit, ROUGH, fit};
    use crate::diagnosis::recordings::clean::clean;
    use crate::diagnosis::recordings::evidence::{Evidence, Measured, by_channel, rms_by_channel};
    use crate::effects::Coordinate;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    /// A tank that fills: its level and its inflow, two channels where the device has four.
    #[derive(Debug, Clone, Copy)]
    struct Tank;

    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Seen {
        Level,
        Inflow,
    }

    impl Subject for Tank {
        /// Level at which it stands at last for an input of one [m], and rate at which it gets there [1/s].
        type Model = [f64; 2];
        type Quantity = usize;
        /// Times [s], input [1] and samples at the start that count nothing.
        type Inputs = (Vec<f64>, f64, usize);
        type Channel = Seen;
        type Readings = [Vec<f64>; 2];
        type Noise = [f64; 2];
        type Simulated = [Vec<f64>; 2];
        type Guide = ();

        const CHANNELS: &'static [Seen] = &[Seen::Level, Seen::Inflow];
        const UPSTREAM: Option<Seen> = None;

        fn column(channel: Seen) -> &'static str {
            match channel {
                Seen::Level => "level_m",
                Seen::Inflow => "inflow_m_per_s",
            }
        }

        fn plausible(channel: Seen) -> [f64; 2] {
            [-1.0, if channel == Seen::Level { 2.0 } else { 40.0 }]
        }

        fn denial(channel: Seen, _: &[f64; 2]) -> Denial {
            let (by, per, order) = (1, 1.0, 1);
            match channel {
                Seen::Level => Denial::Derivative { by, per, order },
                Seen::Inflow => Denial::None,
            }
        }

        fn value(quantity: &usize, model: &[f64; 2]) -> f64 {
            model[*quantity]
        }

        fn set(quantity: &usize, model: &mut [f64; 2], value: f64) {
            model[*quantity] = value;
        }

        fn time((time, ..): &Self::Inputs) -> &[f64] {
            time
        }

        fn placed((_, _, given): &mut Self::Inputs, _: usize) -> usize {
            *given
        }

        fn guide(_: &Self::Inputs, _: &[Vec<f64>; 2], _: &[f64; 2]) {}

        fn guides(channel: Seen) -> bool {
            channel == Seen::Inflow
        }

        fn simulate(
            [size, rate]: &[f64; 2],
            (time, input, _): &Self::Inputs,
            _: bool,
            _: Option<&()>,
            _: Option<(&[f64; 2], &[Vec<f64>; 2])>,
        ) -> [Vec<f64>; 2] {
            let left = |t: &f64| input * size * (-rate * t).exp();
            let level = time.iter().map(|t| input * size - left(t)).collect();
            [level, time.iter().map(|t| rate * left(t)).collect()]
        }

        fn readings(simulated: &[Vec<f64>; 2]) -> &[Vec<f64>] {
            simulated
        }
    }

    const TRUTH: [f64; 2] = [0.4, 1.7];
    const NOISE: [f64; 2] = [2e-3, 5e-3];

    /// Fills with inputs of their own, the first samples of the last spoilt.
    fn fills(given: usize) -> Evidence<Tank> {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let fill = |input: f64| {
            let time: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
            let inputs = (time, input, given);
            let mut readings = Tank::simulate(&TRUTH, &inputs, false, None, None);
            for (readings, noise) in readings.iter_mut().zip(NOISE) {
                for reading in readings.iter_mut() {
                    let drawn: f64 = random.sample(StandardNormal);
                    *reading += noise * drawn;
                }
                readings[..given].fill(1e3);
            }
            Measured {
                name: format!("{input}"),
                inputs,
                readings,
                free: false,
            }
        };
        Evidence::new([1.0, 0.6, 1.4].map(fill).to_vec(), NOISE)
    }

    fn free(quantity: usize, start: f64) -> Free<Tank> {
        Free {
            quantity,
            start,
            coordinate: Coordinate::Logarithmic,
            bounds: [1e-3, 1e3],
            prior: Prior::Flat,
        }
    }

    #[test]
    fn another_subject_with_two_channels_is_fitted_by_the_same_code() {
        let evidence = fills(5);
        assert_eq!(evidence.count(), 3 * 2 * 295);
        let free = [free(0, 1.0), free(1, 0.5)];
        let whole = fit(
            &evidence,
            (&[1.0, 0.5], None),
            (&free, &[]),
            FULL,
            Limit::of(40),
        );
        let covariance = covariance(&evidence, &whole);
        for (i, (value, truth)) in whole.values.iter().zip(TRUTH).enumerate() {
            let deviation = covariance[(i, i)].sqrt();
            assert!((1e-4..1e-2).contains(&deviation), "{deviation}");
            assert!((value / truth).ln().abs() < 4.0 * deviation, "{value}");
        }
        // It leaves noise alone, in each channel of each recording.
        assert!(ModelError::of(&evidence, &whole.prediction).is_none());
        let channels = by_channel(&evidence, &whole.prediction.residuals);
        let channels: Vec<(usize, Seen)> = channels.map(|(r, c, _)| (r, c)).collect();
        assert_eq!(channels[..2], [(0, Seen::Level), (0, Seen::Inflow)]);
        assert_eq!(channels.len(), 6);
        // Each fill is predicted by the two others.
        let left = left_out(&evidence, &whole, Depth::OneStep).unwrap();
        for residuals in left.residuals.iter().flatten() {
            let counted = residuals.iter().filter(|r| r.is_finite());
            let square = counted.map(|r| r * r).sum::<f64>() / 295.0;
            assert!((0.7..1.4).contains(&square), "{square}");
        }
    }

    /// It takes 17 evaluations, and 23 with new derivatives for each step; where it ends its derivatives are new.
    #[test]
    fn a_fit_goes_on_by_earlier_derivatives_to_the_same_end() {
        let evidence = fills(0);
        let free = [free(0, 1.0), free(1, 0.5)];
        let start = (&[1.0, 0.5], None);
        let whole = fit(&evidence, start, (&free, &[]), FULL, Limit::of(40));
        let effort = evidence.effort.report().model_evaluations;
        assert!(effort <= 20, "{effort} model evaluations");
        let again = fit(
            &evidence,
            (&whole.prediction.plant, None),
            (
                &free.map(|f| Free {
                    start: whole.values[f.quantity],
                    ..f
                }),
                &[],
            ),
            FINEST,
            Limit::of(40),
        );
        assert!(whole.cost() - again.cost() < 0.05);
        for (column, newest) in whole.columns.iter().zip(&again.columns) {
            for (slope, newest) in column.iter().zip(newest) {
                assert!((slope - newest).abs() <= 1e-3 * newest.abs() + 1e-9);
            }
        }
    }

    /// Once a stage ended where derivatives of an earlier place promised no more, and most of the cost was left.
    #[test]
    fn a_stage_ends_where_new_derivatives_promise_no_more() {
        let evidence = fills(0);
        for size in [0.02, 0.1, 1.0, 5.0, 30.0] {
            for rate in [0.02, 0.1, 0.5, 5.0, 30.0] {
                let fitted = |size: f64, rate: f64, iterations: usize| {
                    let start = (&[size, rate], None);
                    let free = [free(0, size), free(1, rate)];
                    fit(&evidence, start, (&free, &[]), ROUGH, Limit::of(iterations))
                };
                let first = fitted(size, rate, 40);
                let further = fitted(first.values[0], first.values[1], 1);
                let gain = first.cost() - further.cost();
                assert!(
                    gain < 0.01 * first.cost(),
                    "from {size}, {rate}: a step gains {gain} of {} that are left",
                    first.cost()
                );
            }
        }
    }

    /// A level that leaps is denied by the inflow, unless that leaps too; of the inflow nothing is known but its range.
    #[test]
    fn its_recordings_are_cleaned_by_the_same_code() {
        let Measured {
            inputs,
            mut readings,
            ..
        } = fills(0).recordings.swap_remove(0);
        readings[0][100] += 0.3;
        readings[0][200] += 0.3;
        readings[1][200] += 30.0;
        readings[1][250] += 1.0;
        readings[1][280] = 50.0;
        let cleaning = clean::<Tank>(&inputs.0, &mut readings, &NOISE, &TRUTH);
        assert_eq!(cleaning.outliers, [[inputs.0[100]], [inputs.0[280]]]);
        let wild = |channel: usize| readings[channel].iter().filter(|r| r.is_nan()).count();
        assert_eq!([wild(0), wild(1)], [1, 1]);
        assert_eq!(cleaning.noise.len(), 2);
        for (found, planted) in cleaning.noise.iter().zip(NOISE) {
            assert!((found.unwrap() / planted - 1.0).abs() < 0.2);
        }
        let account = cleaning.account::<Tank>(&NOISE).join("; ");
        assert!(account.contains("1 outlier of level_m"), "{account}");
    }

    #[test]
    fn its_channels_are_distinguished_by_how_far_they_are_moved() {
        let evidence = fills(0);
        let [truth, moved] = [TRUTH, [0.4, 1.9]].map(|model| evidence.predict(&model, false, None));
        let pairs = moved.residuals.iter().zip(&truth.residuals);
        let change: Vec<f64> = pairs.map(|(moved, truth)| moved - truth).collect();
        let sizes = rms_by_channel(&evidence, &change);
        let by_hand = |channel: usize| {
            let mut squares = 0.0;
            for own in &evidence.recordings {
                let [a, b] =
                    [TRUTH, [0.4, 1.9]].map(|m| Tank::simulate(&m, &own.inputs, false, None, None));
                let pairs = a[channel].iter().zip(&b[channel]);
                squares += pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            }
            (squares / 900.0).sqrt() / NOISE[channel]
        };
        assert_eq!(sizes.len(), 2);
        for (channel, size) in sizes.iter().enumerate() {
            assert!((size / by_hand(channel) - 1.0).abs() < 1e-9, "{sizes:?}");
        }
    }

    /// Guided, what its guide took counts nothing.
    #[test]
    fn a_channel_that_guides_is_not_counted_while_it_does() {
        let evidence = fills(0);
        let shares = evidence.shares(0.0, true);
        for (place, share) in shares.iter().enumerate() {
            let is_inflow = (place / 300) % 2 == 1;
            assert_eq!(*share == 0.0, is_inflow);
        }
        let level = evidence.of_channel(Seen::Level);
        assert_eq!(level.count(), 3 * 300);
    }
}
