//! Turns poses that arrive now and then into motion that flows.
//!
//! Poses carry the daemon's time. They arrive in bursts and, with a fast simulated robot, faster than real time. The playout shows
//! the robot a little in the past, between two poses that are known, and runs its own clock at the rate of theirs.

use std::collections::VecDeque;
use std::f64::consts::PI;

use rvac_api::Pose;

/// How far behind the newest pose the picture is, in seconds of the viewer's clock: two poses at 20 a second and some jitter.
const DELAY_S: f64 = 0.12;

/// Span over which the rate of the daemon's clock is measured, in seconds of the viewer's clock.
const RATE_SPAN_S: f64 = 1.0;

/// After such a silence the robot stood, so earlier poses say nothing about the rate.
const SILENCE_S: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
struct Sample {
    pose: Pose,
    arrived_s: f64,
}

/// The poses of the last second and the place of the picture in them.
#[derive(Clone, Debug, Default)]
pub struct Playout {
    samples: VecDeque<Sample>,
    shown_t: f64,
    asked_s: f64,
}

impl Playout {
    /// Takes a pose that arrived at `now_s` of the viewer's clock.
    pub fn push(&mut self, pose: Pose, now_s: f64) {
        if let Some(last) = self.samples.back().copied() {
            if pose.t < last.pose.t {
                self.samples.clear();
            } else if now_s - last.arrived_s > SILENCE_S {
                self.restart_from(last.pose, pose.t, now_s);
            }
        }
        if self.samples.is_empty() {
            self.shown_t = pose.t;
        }
        self.samples.push_back(Sample {
            pose,
            arrived_s: now_s,
        });
        while self.samples.len() > 2
            && self
                .samples
                .front()
                .is_some_and(|first| now_s - first.arrived_s > RATE_SPAN_S)
        {
            self.samples.pop_front();
        }
    }

    /// The pose to draw at `now_s`; none before the first arrived.
    pub fn sample(&mut self, now_s: f64) -> Option<Pose> {
        let last = self.samples.back().copied()?;
        let rate = self.rate();
        let elapsed = (now_s - self.asked_s).clamp(0.0, 0.1);
        self.asked_s = now_s;
        let due = (last.pose.t + rate * (now_s - last.arrived_s - DELAY_S)).min(last.pose.t);
        self.shown_t += rate * elapsed;
        let late = due - self.shown_t;
        // A pull of a tenth a frame is not seen; a large gap is jumped.
        self.shown_t += if late.abs() > rate { late } else { late * 0.1 };
        Some(self.pose_at(self.shown_t))
    }

    /// Whether the picture still moves towards the newest pose.
    #[must_use]
    pub fn is_moving(&self, now_s: f64) -> bool {
        self.samples
            .back()
            .is_some_and(|last| now_s - last.arrived_s < SILENCE_S)
    }

    /// The robot stood at `pose` until a moment before `t`.
    fn restart_from(&mut self, pose: Pose, t: f64, now_s: f64) {
        self.samples.clear();
        let begin = (t - 0.05).max(pose.t);
        self.samples.push_back(Sample {
            pose: Pose { t: begin, ..pose },
            arrived_s: now_s - 0.05,
        });
        self.shown_t = begin - DELAY_S;
    }

    /// Seconds of the daemon's clock per second of the viewer's clock.
    fn rate(&self) -> f64 {
        let (Some(first), Some(last)) = (self.samples.front(), self.samples.back()) else {
            return 1.0;
        };
        let span = last.arrived_s - first.arrived_s;
        if span < 0.2 {
            return 1.0;
        }
        ((last.pose.t - first.pose.t) / span).clamp(0.05, 1000.0)
    }

    fn pose_at(&self, t: f64) -> Pose {
        let after = self.samples.iter().position(|sample| sample.pose.t >= t);
        let at = |index: usize| {
            self.samples
                .get(index)
                .map(|sample| sample.pose)
                .unwrap_or_default()
        };
        match after {
            Some(0) => at(0),
            Some(index) => between(at(index - 1), at(index), t),
            None => at(self.samples.len().saturating_sub(1)),
        }
    }
}

fn between(a: Pose, b: Pose, t: f64) -> Pose {
    let span = b.t - a.t;
    let share = if span > 0.0 {
        ((t - a.t) / span).clamp(0.0, 1.0)
    } else {
        1.0
    };
    let turn = (b.heading - a.heading + PI).rem_euclid(2.0 * PI) - PI;
    Pose {
        x: a.x + (b.x - a.x) * share,
        y: a.y + (b.y - a.y) * share,
        heading: a.heading + turn * share,
        t,
    }
}

#[cfg(test)]
mod tests {
    use super::{Playout, between};
    use rvac_api::Pose;

    fn pose(x: f64, heading: f64, t: f64) -> Pose {
        Pose {
            x,
            y: 0.0,
            heading,
            t,
        }
    }

    /// Feeds poses of a robot at 0.25 m/s, 20 a second of its own clock with some jitter on arrival, and gives the
    /// steps of the picture over the second half, in metres per frame.
    fn steps(speed: f64) -> Vec<f64> {
        let mut playout = Playout::default();
        let mut shown = Vec::new();
        let mut sent = 0_u32;
        for frame in 0..240 {
            let now = f64::from(frame) / 60.0;
            loop {
                let t = f64::from(sent) * 0.05;
                let jitter = f64::from(sent * 7 % 5) * 0.004;
                if t / speed + jitter > now {
                    break;
                }
                playout.push(pose(t * 0.25, 0.0, t), now);
                sent += 1;
            }
            shown.push(playout.sample(now).unwrap().x);
        }
        shown[120..].windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    #[test]
    fn motion_flows_forward_at_the_robots_speed() {
        for speed in [1.0, 4.0, 20.0] {
            let steps = steps(speed);
            let expected = 0.25 * speed / 60.0;
            let worst = steps
                .iter()
                .map(|step| (step - expected).abs())
                .fold(0.0, f64::max);
            assert!(
                worst < 0.45 * expected,
                "speed {speed}: worst deviation {worst}, expected step {expected}"
            );
        }
    }

    #[test]
    fn it_ends_at_the_newest_pose() {
        let mut playout = Playout::default();
        for step in 0..10_u32 {
            let t = f64::from(step) * 0.05;
            playout.push(pose(t, 0.0, t), t);
        }
        for frame in 0..120 {
            playout.sample(0.45 + f64::from(frame) / 60.0);
        }
        assert!((playout.sample(2.5).unwrap().x - 0.45).abs() < 1e-3);
        assert!(!playout.is_moving(2.5));
    }

    #[test]
    fn a_restart_of_the_daemon_starts_anew() {
        let mut playout = Playout::default();
        playout.push(pose(5.0, 0.0, 100.0), 0.0);
        playout.push(pose(1.0, 0.0, 2.0), 0.1);
        assert_eq!(playout.sample(0.1).unwrap().x, 1.0);
    }

    #[test]
    fn heading_takes_the_short_way() {
        let middle = between(pose(0.0, 3.0, 0.0), pose(0.0, -3.0, 1.0), 0.5);
        assert!((middle.heading - std::f64::consts::PI).abs() < 1e-9);
    }
}
