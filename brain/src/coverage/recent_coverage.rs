//! What a robot without a heading sensor still knows: where it was and what it hit recently.
//!
//! Wheel odometry alone is wrong by metres after an hour and by some decimetres after ten minutes. Within that time it can
//! still tell swept from unswept floor.

use core::ops::Range;
use std::collections::VecDeque;

use crate::coverage::parameters::RECENT;
use crate::mapping::{Cell, Map};
use crate::model::geometry::{Point2, Pose2, TurnSide};
use crate::navigation::{Situation, TaskContext};

/// The turns that are allowed after a contact.
#[derive(Clone, Copy, Debug)]
pub(in crate::coverage) struct TurnRange<'range> {
    /// Sizes of the turn, radians.
    pub(in crate::coverage) range_rad: &'range Range<f64>,
    /// `None` = to both sides.
    pub(in crate::coverage) side: Option<TurnSide>,
}

/// Recent contacts.
#[derive(Clone, Debug, Default)]
pub(in crate::coverage) struct RecentContacts {
    contacts: VecDeque<RecentContact>,
}

#[derive(Clone, Copy, Debug)]
struct RecentContact {
    at: Point2,
    /// As in [`crate::mapping::Sweeping::last_s`].
    time_s: u32,
}

impl RecentContacts {
    /// Records a contact in front.
    pub(in crate::coverage) fn note(&mut self, situation: &Situation<'_>) {
        let now_s = situation.map.coverage_now_s();
        let body_m = situation.config.body.radius_m;
        let at = situation.pose.transform(ahead(body_m));
        self.contacts.push_back(RecentContact { at, time_s: now_s });
        let is_old = |contact: &RecentContact| now_s.saturating_sub(contact.time_s) > RECENT.memory_s;
        while self.contacts.len() > RECENT.contacts_max || self.contacts.front().is_some_and(is_old) {
            self.contacts.pop_front();
        }
    }

    /// Samples some turns of a range. Gives the one that leads over most floor that was
    /// not swept recently.
    pub(in crate::coverage) fn turn_rad(
        &self,
        range: TurnRange<'_>,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> f64 {
        let TurnRange { range_rad, side } = range;
        let body_m = situation.config.body.radius_m;
        let mut best_rad = range_rad.start;
        let mut most_m = f64::NEG_INFINITY;
        for _ in 0..RECENT.turns {
            let side = side.unwrap_or(if context.random.coin() {
                TurnSide::Left
            } else {
                TurnSide::Right
            });
            let turn_rad = side.sign() * context.random.within(range_rad);
            let new_m = self.new_m(situation.pose.after_arc(0.0, turn_rad), body_m, situation.map);
            if new_m > most_m {
                (best_rad, most_m) = (turn_rad, new_m);
            }
        }
        best_rad
    }

    /// Length of floor not swept recently, straight ahead of a pose until a recent contact, metres.
    fn new_m(&self, from: Pose2, body_m: f64, map: &Map) -> f64 {
        let mut new_m = 0.0;
        let mut distance_m = body_m;
        while distance_m < RECENT.ray_max_m {
            let at = from.transform(ahead(distance_m));
            // The latest contact is beside the robot, which is already free of it.
            let is_away = distance_m > body_m + RECENT.contact_radius_m;
            if is_away
                && self
                    .contacts
                    .iter()
                    .any(|contact| contact.at.distance_m(at) < RECENT.contact_radius_m)
            {
                break;
            }
            if is_new(map, at, RECENT.memory_s) {
                new_m += RECENT.ray_step_m;
            }
            distance_m += RECENT.ray_step_m;
        }
        new_m
    }
}

/// Whether the floor at a point was not swept within this time.
pub(super) fn is_new(map: &Map, at: Point2, within_s: u32) -> bool {
    map.cell_passes(Cell::under(at))
        .is_none_or(|sweeping| map.coverage_now_s().saturating_sub(sweeping.last_s) > within_s)
}

fn ahead(distance_m: f64) -> Point2 {
    Point2 {
        x_m: distance_m,
        y_m: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::{RECENT, RecentContact, RecentContacts, is_new};
    use crate::mapping::{Brushes, Map};
    use crate::model::config::{Body, SensorLayout};
    use crate::model::geometry::{Point2, Pose2};

    const BODY: Body = Body {
        radius_m: 0.155,
        swath_m: 0.24,
        track_m: 0.21,
    };

    fn along_x(x_m: f64) -> Pose2 {
        Pose2 {
            x_m,
            ..Pose2::IDENTITY
        }
    }

    /// A lane of two metres along x, swept at `at_s`; the current time is `now_s`, seconds.
    fn swept_lane(at_s: u64, now_s: u64) -> Map {
        let mut map = Map::new(BODY, SensorLayout::default());
        for step in 0..=100 {
            map.follow(
                along_x(0.02 * f64::from(step)),
                Brushes::Sweeping,
                at_s * 1_000_000,
            );
        }
        let beside = Pose2 {
            y_m: 20.0,
            ..Pose2::IDENTITY
        };
        map.follow(beside, Brushes::Still, now_s * 1_000_000);
        map.follow(beside, Brushes::Sweeping, now_s * 1_000_000);
        map
    }

    #[test]
    fn floor_swept_long_ago_is_new_again() {
        let at = Point2 { x_m: 1.0, y_m: 0.0 };
        assert!(!is_new(
            &swept_lane(100, 100 + u64::from(RECENT.memory_s) - 8),
            at,
            RECENT.memory_s
        ));
        assert!(is_new(
            &swept_lane(100, 100 + u64::from(RECENT.memory_s) + 8),
            at,
            RECENT.memory_s
        ));
    }

    #[test]
    fn rays_over_swept_floor_or_into_contacts_are_worth_less() {
        let map = swept_lane(0, 60);
        let recent_contacts = RecentContacts::default();
        let across = Pose2 {
            x_m: 1.0,
            y_m: 0.0,
            heading_rad: core::f64::consts::FRAC_PI_2,
        };
        let worth = |recent_contacts: &RecentContacts, from| recent_contacts.new_m(from, BODY.radius_m, &map);
        assert!(worth(&recent_contacts, across) > worth(&recent_contacts, along_x(0.0)) + 1.0);
        let contact = RecentContact {
            at: Point2 { x_m: 1.0, y_m: 0.9 },
            time_s: 60,
        };
        let recent_contacts = RecentContacts {
            contacts: [contact].into(),
        };
        assert!(
            worth(&recent_contacts, across) < 0.7,
            "{}",
            worth(&recent_contacts, across)
        );
    }
}
