//! `map`, `odom` and `base_link` of REP-105, out of a pose in the map that sometimes jumps.
//!
//! The daemon tells where the robot is in the map. REP-105 wants two links instead: `odom` to `base_link`, which never jumps, and `map` to
//! `odom`, which does whenever the robot recognizes that it is elsewhere. Whatever the robot can have driven between two poses goes into the
//! first, all else into the second.

use crate::place::{Place, wrapped};

/// The pose is a filtered one, and two of them may come closer together than they were made.
const SLACK_M: f64 = 0.03;
const SLACK_RAD: f64 = 0.1;
/// Between poses that lie further apart in time nothing is known: the robot was carried, or the daemon away.
const GAP_MAX_S: f64 = 2.0;

/// What the robot can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TopSpeeds {
    pub(crate) forward_m_per_s: f64,
    pub(crate) turn_rad_per_s: f64,
}

/// Both links and how fast the robot moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Links {
    pub(crate) map_to_odom: Place,
    pub(crate) odom_to_base: Place,
    /// Along the robot's own x axis.
    pub(crate) forward_m_per_s: f64,
    pub(crate) turn_rad_per_s: f64,
}

/// Follows poses in the map.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Frames {
    links: Links,
    /// The last pose in the map, and when, in the daemon's seconds.
    last: Option<(Place, f64)>,
}

impl Frames {
    /// Takes the pose of `t_s`, in the daemon's seconds.
    pub(crate) fn take(&mut self, in_map: Place, t_s: f64, top: TopSpeeds) -> Links {
        let Some((before, before_s)) = self.last.replace((in_map, t_s)) else {
            self.links.odom_to_base = in_map;
            return self.links;
        };
        let passed_s = t_s - before_s;
        let step = before.inverse().then(in_map);
        if is_drivable(step, passed_s, top) {
            self.links.odom_to_base = self.links.odom_to_base.then(step);
            if passed_s > 0.0 {
                self.links.forward_m_per_s = step.x_m / passed_s;
                self.links.turn_rad_per_s = step.heading_rad / passed_s;
            }
        } else {
            self.links.forward_m_per_s = 0.0;
            self.links.turn_rad_per_s = 0.0;
        }
        self.links.map_to_odom = in_map.then(self.links.odom_to_base.inverse());
        self.links
    }

    /// No pose has come for a while, which the daemon leaves out while the robot stands.
    pub(crate) fn stands(&mut self) -> Option<Links> {
        self.last?;
        self.links.forward_m_per_s = 0.0;
        self.links.turn_rad_per_s = 0.0;
        Some(self.links)
    }
}

/// Whether the robot can have driven this step in the time.
fn is_drivable(step: Place, passed_s: f64, top: TopSpeeds) -> bool {
    let way_m = step.x_m.hypot(step.y_m);
    (0.0..=GAP_MAX_S).contains(&passed_s)
        && way_m <= top.forward_m_per_s * passed_s + SLACK_M
        && wrapped(step.heading_rad).abs() <= top.turn_rad_per_s * passed_s + SLACK_RAD
}

#[cfg(test)]
mod tests {
    use super::{Frames, Place, TopSpeeds};

    const TOP: TopSpeeds = TopSpeeds {
        forward_m_per_s: 0.4,
        turn_rad_per_s: 2.0,
    };

    fn at(x_m: f64, y_m: f64, heading_rad: f64) -> Place {
        Place {
            x_m,
            y_m,
            heading_rad,
        }
    }

    fn close(one: Place, other: Place) -> bool {
        let apart = one.inverse().then(other);
        apart.x_m.hypot(apart.y_m) < 1e-9 && apart.heading_rad.abs() < 1e-9
    }

    #[test]
    fn driving_moves_the_robot_in_odom_and_leaves_the_map_where_it_is() {
        let mut frames = Frames::default();
        let mut links = frames.take(at(1.0, 2.0, 0.0), 0.0, TOP);
        for step in 1..=20_u32 {
            let s = f64::from(step) * 0.05;
            links = frames.take(at(1.0 + 0.3 * s, 2.0, 0.0), s, TOP);
        }
        assert!(close(links.odom_to_base, at(1.3, 2.0, 0.0)));
        assert!(close(links.map_to_odom, Place::default()));
        assert!((links.forward_m_per_s - 0.3).abs() < 1e-9);
    }

    #[test]
    fn a_jump_moves_the_map_and_never_the_robot_in_odom() {
        let mut frames = Frames::default();
        frames.take(at(0.0, 0.0, 0.0), 0.0, TOP);
        frames.take(at(0.01, 0.0, 0.0), 0.05, TOP);
        let seen = at(3.0, -1.0, 1.2);
        let links = frames.take(seen, 0.1, TOP);
        assert!(close(links.odom_to_base, at(0.01, 0.0, 0.0)));
        assert!(close(links.map_to_odom.then(links.odom_to_base), seen));
        assert!(links.forward_m_per_s.abs() < 1e-12);
        // From there on the robot drives in odom again, and the map stays.
        let next = seen.then(at(0.015, 0.0, 0.0));
        let later = frames.take(next, 0.15, TOP);
        assert!(close(later.odom_to_base, at(0.025, 0.0, 0.0)));
        assert!(close(later.map_to_odom, links.map_to_odom));
    }

    #[test]
    fn after_a_gap_nothing_is_believed_to_be_driven() {
        let mut frames = Frames::default();
        frames.take(at(0.0, 0.0, 0.0), 0.0, TOP);
        let links = frames.take(at(0.5, 0.0, 0.0), 60.0, TOP);
        assert!(close(links.odom_to_base, Place::default()));
    }

    #[test]
    fn a_turn_past_the_back_is_a_short_one() {
        let mut frames = Frames::default();
        frames.take(at(0.0, 0.0, 3.13), 0.0, TOP);
        let links = frames.take(at(0.0, 0.0, -3.13), 0.05, TOP);
        assert!((links.turn_rad_per_s - (std::f64::consts::TAU - 6.26) / 0.05).abs() < 1e-9);
    }
}
