//! Reflexes of the host, for robots that have the sensors and do not react to them: a bumper, a cliff and a hanging wheel
//! hold the wheels as in our own firmware (S6, S8 and S10 of the safety concept), as soon as they are reported. What latches stands in
//! [`super::latches`].

use brain::Inhibit;
use brain::observation::Contacts;

use super::{Description, Drive, ReflexSite, Reflexes, Report};
use crate::edges::LevelTimes;

/// Way that a robot may make between what happens and the wheels' answer, metres: less than the travel of a bumper, and
/// than what lies between a cliff sensor and the wheel behind it.
const REACTION_WAY_M: f64 = 0.03;
/// A robot backs off from a cliff at no more than this, m/s (S8).
const CLIFF_SPEED_MAX_M_PER_S: f64 = 0.1;
/// Both wheels are on the floor for so long before anything moves again (S10).
const PUT_DOWN_US: u64 = 1_000_000;
/// Reports older than this are not fresh: our own firmware would refuse motion at 400 ms (S3), and four reports are missing
/// at the slowest rate at which it sends.
const FRESH_MIN_US: u64 = 300_000;
/// Those of a slower robot are not fresh after so many of its latencies.
const FRESH_LATENCIES: f64 = 4.0;

/// The reflexes that the host supplies for one robot, and what its sensors said last.
#[derive(Clone, Copy, Debug)]
pub(super) struct HostReflexes {
    sites: Reflexes,
    track_m: f64,
    reported_us: Option<u64>,
    contacts: Contacts,
    at_cliff: bool,
    wheel_drop: LevelTimes,
}

impl HostReflexes {
    /// Those that `description` asks for; `None` where the robot has its own.
    pub(super) fn of(description: &Description) -> Option<Self> {
        latency_s(description.reflexes).map(|_| Self {
            sites: description.reflexes,
            track_m: description.drive.track_m,
            reported_us: None,
            contacts: Contacts::default(),
            at_cliff: false,
            wheel_drop: LevelTimes::default(),
        })
    }

    /// Takes a report and marks in it which motors are held. `true` if a new hold began.
    pub(super) fn take(&mut self, now_us: u64, report: &mut Report) -> bool {
        let before = (self.contacts, self.at_cliff, self.is_lifted(now_us));
        self.reported_us = Some(now_us);
        if is_host(self.sites.bump) {
            self.contacts = report.contacts;
            if self.contacts.any() {
                report.inhibits.insert(Inhibit::Bumper);
            }
        }
        if is_host(self.sites.cliff) {
            self.at_cliff = report.cliffs.any();
            if self.at_cliff {
                report.inhibits.insert(Inhibit::Cliff);
            }
        }
        if is_host(self.sites.lift) {
            self.wheel_drop.take(now_us, report.wheel_drops.any());
        }
        if self.is_lifted(now_us) {
            report.inhibits.insert(Inhibit::WheelDrop);
        }
        before != (self.contacts, self.at_cliff, self.is_lifted(now_us))
    }

    /// Whether a wheel hangs, or has hung until just now.
    pub(super) const fn is_lifted(&self, now_us: u64) -> bool {
        self.wheel_drop.was_there_within(now_us, PUT_DOWN_US)
    }

    /// What of a command the wheels may do.
    pub(super) fn permit(&self, now_us: u64, drive: Drive) -> Drive {
        if self.is_blind(now_us) || self.is_lifted(now_us) {
            return Drive::STAND;
        }
        let [left, right] = drive.rims_m_per_s(self.track_m);
        let leads_away = !self.contacts.any() || is_away(self.contacts, [left, right]);
        let leads_to_cliff = self.at_cliff && (left > 0.0 || right > 0.0);
        if !leads_away || leads_to_cliff {
            return Drive::STAND;
        }
        let speed_m_per_s = match (self.at_cliff, self.contacts.any()) {
            (true, _) => drive.speed_m_per_s.max(-CLIFF_SPEED_MAX_M_PER_S),
            // A turn on the spot away from an obstacle must not creep forward.
            (false, true) => drive.speed_m_per_s.min(0.0),
            (false, false) => drive.speed_m_per_s,
        };
        Drive {
            speed_m_per_s,
            ..drive
        }
    }

    /// Whether the sensors have been silent for so long that nothing may move.
    fn is_blind(&self, now_us: u64) -> bool {
        let fresh_us = fresh_us(self.sites);
        self.reported_us
            .is_none_or(|reported_us| now_us.saturating_sub(reported_us) > fresh_us)
    }
}

/// Highest speed at which the host reacts in time to the sensors in front, m/s.
pub(super) fn speed_limit_m_per_s(reflexes: Reflexes) -> f64 {
    latency_s(reflexes).map_or(f64::INFINITY, |latency_s| REACTION_WAY_M / latency_s)
}

/// Microseconds for which a report counts as current.
pub(super) fn fresh_us(reflexes: Reflexes) -> u64 {
    let slow_us = FRESH_LATENCIES * 1e6 * latency_s(reflexes).unwrap_or_default();
    FRESH_MIN_US.max(slow_us as u64)
}

/// The slowest reflex of the host; `None` without any.
fn latency_s(reflexes: Reflexes) -> Option<f64> {
    [reflexes.bump, reflexes.cliff, reflexes.lift]
        .into_iter()
        .filter_map(|site| match site {
            ReflexSite::Host { latency_s } => Some(latency_s),
            ReflexSite::Device | ReflexSite::Absent => None,
        })
        .reduce(f64::max)
}

/// Whether the host supplies a reflex.
pub(super) const fn is_host(site: ReflexSite) -> bool {
    matches!(site, ReflexSite::Host { .. })
}

/// Backwards leads away from any press. A turn on the spot leads away when it swings the pressed side back.
fn is_away(pressed: Contacts, [left, right]: [f64; 2]) -> bool {
    let backwards = left <= 0.0 && right <= 0.0;
    let turns_right = left >= 0.0 && right <= 0.0;
    let turns_left = right >= 0.0 && left <= 0.0;
    backwards
        || (turns_right && pressed.left && !pressed.right)
        || (turns_left && pressed.right && !pressed.left)
}

#[cfg(test)]
mod tests {
    use brain::Inhibit;
    use brain::observation::{Cliffs, Contacts};

    use super::super::{Drive, ReflexSite, Reflexes, Report, WheelDrops};
    use super::{HostReflexes, LevelTimes, speed_limit_m_per_s};

    const HOST: ReflexSite = ReflexSite::Host { latency_s: 0.2 };
    const ALL: Reflexes = Reflexes {
        bump: HOST,
        cliff: HOST,
        lift: HOST,
    };

    fn reflexes(report: Report) -> (HostReflexes, Report) {
        let mut reflexes = HostReflexes {
            sites: ALL,
            track_m: 0.25,
            reported_us: None,
            contacts: Contacts::default(),
            at_cliff: false,
            wheel_drop: LevelTimes::default(),
        };
        let mut told = report;
        reflexes.take(0, &mut told);
        (reflexes, told)
    }

    const fn drive(speed_m_per_s: f64, turn_rad_per_s: f64) -> Drive {
        Drive {
            speed_m_per_s,
            turn_rad_per_s,
        }
    }

    #[test]
    fn only_ways_off_a_pressed_bumper_are_left() {
        let (held, told) = reflexes(Report {
            contacts: Contacts {
                left: true,
                right: false,
            },
            ..Report::default()
        });
        assert!(told.inhibits.contains(Inhibit::Bumper));
        assert_eq!(held.permit(1, drive(0.1, 0.0)), Drive::STAND);
        assert_eq!(held.permit(1, drive(-0.1, 0.0)), drive(-0.1, 0.0));
        assert_eq!(held.permit(1, drive(0.05, -1.0)), drive(0.0, -1.0), "no creeping");
        assert_eq!(held.permit(1, drive(0.0, 1.0)), Drive::STAND, "towards it");
    }

    #[test]
    fn a_cliff_leaves_a_slow_way_back_and_a_hanging_wheel_none() {
        let (held, told) = reflexes(Report {
            cliffs: Cliffs {
                middle: true,
                ..Cliffs::default()
            },
            ..Report::default()
        });
        assert!(told.inhibits.contains(Inhibit::Cliff));
        assert_eq!(held.permit(1, drive(0.0, 0.5)), Drive::STAND);
        assert_eq!(held.permit(1, drive(-0.2, 0.0)), drive(-0.1, 0.0));
        let (mut held, _) = reflexes(Report {
            wheel_drops: WheelDrops {
                left: true,
                right: false,
            },
            ..Report::default()
        });
        assert_eq!(held.permit(1, drive(-0.1, 0.0)), Drive::STAND);
        let mut down = Report::default();
        held.take(900_000, &mut down);
        assert!(down.inhibits.contains(Inhibit::WheelDrop), "for a second");
        held.take(1_000_000, &mut Report::default());
        assert_eq!(held.permit(1_000_000, drive(0.1, 0.0)), drive(0.1, 0.0));
    }

    #[test]
    fn a_blind_robot_stands_and_a_slow_one_drives_slowly() {
        let (reflexes, _) = reflexes(Report::default());
        assert_eq!(reflexes.permit(800_000, drive(0.1, 0.0)), drive(0.1, 0.0));
        assert_eq!(reflexes.permit(800_001, drive(0.1, 0.0)), Drive::STAND);
        assert!((speed_limit_m_per_s(ALL) - 0.15).abs() < 1e-12);
    }
}
