//! Motion along a path with limited speed, acceleration and jerk.
//!
//! A change of speed v0 -> v1 takes jerk +-j in three parts (up, constant, down):
//!
//! ```text
//! |v1 - v0| <= a^2/j:  T = 2 sqrt(|v1 - v0|/j);   else  T = |v1 - v0|/a + a/j;   distance = (v0 + v1)/2 T
//! ```
//!
//! v speed [m/s], a acceleration [m/s2], j jerk [m/s3]. (Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, sec. 3.4.)

/// Limits of the motion along the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Acceleration [m/s2].
    pub acceleration: f64,
    /// Jerk [m/s3].
    pub jerk: f64,
}

/// A stretch of the path with a speed limit of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedSection {
    /// Length [m].
    pub length: f64,
    /// Speed limit [m/s].
    pub speed: f64,
}

/// Place, speed and acceleration along the path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathState {
    /// Path length [m].
    pub position: f64,
    /// Speed [m/s].
    pub speed: f64,
    /// Acceleration [m/s2].
    pub acceleration: f64,
}

/// A piece of constant jerk.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start_time: f64,
    start: PathState,
    jerk: f64,
}

/// A jerk-limited motion from rest to rest.
#[derive(Debug, Clone)]
pub struct Profile {
    pieces: Vec<Piece>,
    duration: f64,
    end: PathState,
}

impl MotionLimits {
    fn change_time(&self, from: f64, to: f64) -> f64 {
        let change = (to - from).abs();
        if change <= self.acceleration * self.acceleration / self.jerk {
            2.0 * (change / self.jerk).sqrt()
        } else {
            change / self.acceleration + self.acceleration / self.jerk
        }
    }

    fn change_distance(&self, from: f64, to: f64) -> f64 {
        0.5 * (from + to) * self.change_time(from, to)
    }

    /// Largest speed up to `limit` that can be reached from `from` within `distance`.
    fn reachable(&self, from: f64, limit: f64, distance: f64) -> f64 {
        if self.change_distance(from, limit) <= distance {
            return limit;
        }
        let (mut low, mut high) = (from, limit);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.change_distance(from, middle) <= distance {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

impl Profile {
    /// Moves through the sections in order, from rest to rest, at each section's speed where its length allows it.
    pub fn through(sections: &[SpeedSection], limits: MotionLimits) -> Self {
        let mut joints = vec![0.0];
        for pair in sections.windows(2) {
            joints.push(pair[0].speed.min(pair[1].speed));
        }
        joints.push(0.0);
        for (i, section) in sections.iter().enumerate() {
            joints[i + 1] = joints[i + 1].min(limits.reachable(
                joints[i],
                joints[i + 1].max(joints[i]),
                section.length,
            ));
        }
        for (i, section) in sections.iter().enumerate().rev() {
            joints[i] = joints[i].min(limits.reachable(
                joints[i + 1],
                joints[i].max(joints[i + 1]),
                section.length,
            ));
        }
        let mut builder = Builder::default();
        for (i, section) in sections.iter().enumerate() {
            builder.section(section, joints[i], joints[i + 1], &limits);
        }
        builder.finish()
    }

    /// A single straight motion from rest to rest.
    pub fn single(length: f64, speed: f64, limits: MotionLimits) -> Self {
        Self::through(&[SpeedSection { length, speed }], limits)
    }

    /// Duration [s].
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// State at a time [s]; at rest at either end outside the motion.
    pub fn at(&self, time: f64) -> PathState {
        if time >= self.duration || self.pieces.is_empty() {
            return self.end;
        }
        let index = self
            .pieces
            .partition_point(|piece| piece.start_time <= time)
            .saturating_sub(1);
        let piece = &self.pieces[index];
        advance(&piece.start, piece.jerk, (time - piece.start_time).max(0.0))
    }
}

fn advance(start: &PathState, jerk: f64, time: f64) -> PathState {
    PathState {
        position: start.position
            + time * (start.speed + time * (0.5 * start.acceleration + time * jerk / 6.0)),
        speed: start.speed + time * (start.acceleration + 0.5 * time * jerk),
        acceleration: start.acceleration + time * jerk,
    }
}

#[derive(Default)]
struct Builder {
    pieces: Vec<Piece>,
    time: f64,
    state: PathState,
}

impl Builder {
    fn section(&mut self, section: &SpeedSection, enter: f64, leave: f64, limits: &MotionLimits) {
        let end = self.state.position + section.length;
        let needed =
            |peak: f64| limits.change_distance(enter, peak) + limits.change_distance(peak, leave);
        let (mut low, mut high) = (enter.max(leave), section.speed.max(enter).max(leave));
        if needed(high) > section.length {
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if needed(middle) <= section.length {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high = low;
        }
        let peak = high;
        self.change(peak, limits);
        let cruise = section.length - needed(peak);
        if peak > 0.0 && cruise > 0.0 {
            self.piece(0.0, cruise / peak);
        }
        self.change(leave, limits);
        // What rounding left over is put right here, so that sections do not drift.
        self.state = PathState {
            position: end,
            speed: leave,
            acceleration: 0.0,
        };
    }

    fn change(&mut self, to: f64, limits: &MotionLimits) {
        let change = to - self.state.speed;
        if change == 0.0 {
            return;
        }
        let total = limits.change_time(self.state.speed, to);
        let ramp = (0.5 * total).min(limits.acceleration / limits.jerk);
        let jerk = change.signum() * change.abs() / (ramp * (total - ramp));
        self.piece(jerk, ramp);
        self.piece(0.0, total - 2.0 * ramp);
        self.piece(-jerk, ramp);
        self.state.acceleration = 0.0;
        self.state.speed = to;
    }

    fn piece(&mut self, jerk: f64, duration: f64) {
        if duration <= 0.0 {
            return;
        }
        self.pieces.push(Piece {
            start_time: self.time,
            start: self.state,
            jerk,
        });
        self.state = advance(&self.state, jerk, duration);
        self.time += duration;
    }

    fn finish(self) -> Profile {
        Profile {
            duration: self.time,
            end: self.state,
            pieces: self.pieces,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits = MotionLimits {
        acceleration: 0.5,
        jerk: 5.0,
    };

    fn walk(profile: &Profile) -> (f64, f64, f64, f64) {
        let (mut fastest, mut hardest, mut jump, mut step) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        let dt = 1e-4;
        let mut before = profile.at(0.0);
        for i in 1..=(profile.duration() / dt).ceil() as usize {
            let now = profile.at(i as f64 * dt);
            fastest = fastest.max(now.speed);
            hardest = hardest.max(now.acceleration.abs());
            jump = jump.max((now.acceleration - before.acceleration).abs() / dt);
            step = step.max(
                (now.position - before.position - 0.5 * dt * (now.speed + before.speed)).abs(),
            );
            before = now;
        }
        (fastest, hardest, jump, step)
    }

    #[test]
    fn limits_hold_and_the_end_is_reached_at_rest() {
        let sections = [
            (0.1, 0.05),
            (0.01, 0.01),
            (0.2, 0.2),
            (0.002, 0.02),
            (0.15, 0.05),
        ];
        let sections = sections.map(|(length, speed)| SpeedSection { length, speed });
        let profile = Profile::through(&sections, LIMITS);
        let (fastest, hardest, jerk, step) = walk(&profile);
        assert!(fastest <= 0.2 + 1e-9 && fastest > 0.15, "{fastest}");
        assert!(
            hardest <= 0.5 + 1e-9 && jerk <= 5.0 + 1e-3,
            "{hardest} {jerk}"
        );
        assert!(step < 1e-9, "position jumps by {step}");
        let end = profile.at(profile.duration());
        assert!((end.position - 0.462).abs() < 1e-12 && end.speed == 0.0);
        // The slow section is passed at its own speed.
        let at = (0..100_000)
            .map(|i| profile.at(f64::from(i) * 1e-4))
            .find(|s| s.position > 0.105);
        assert!((at.unwrap().speed - 0.01).abs() < 1e-9);
    }

    #[test]
    fn a_long_motion_takes_the_closed_form_time() {
        let profile = Profile::single(1.0, 0.2, LIMITS);
        let change = 0.2 / 0.5 + 0.5 / 5.0;
        let expected = 2.0 * change + (1.0 - 0.2 * change) / 0.2;
        assert!((profile.duration() - expected).abs() < 1e-12);
    }

    #[test]
    fn a_short_motion_never_reaches_its_speed() {
        let profile = Profile::single(1e-4, 0.2, LIMITS);
        // Four jerk ramps: distance = 2 j t^3, so t = (d / 2 j)^(1/3).
        let expected = 4.0 * (1e-4f64 / (2.0 * 5.0)).cbrt();
        assert!((profile.duration() - expected).abs() < 1e-9);
        assert!((profile.at(1.0).position - 1e-4).abs() < 1e-12);
    }
}
