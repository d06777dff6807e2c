//! Which buttons can be used, and why not.

use rvac_api::{RobotDescription, Status};

use crate::words::Words;

/// Whether a button can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offer {
    /// Yes.
    Ready,
    /// Not now, for this reason.
    NotNow(Wait),
    /// The robot lacks what it needs: it is not shown.
    Absent,
}

/// Why a button waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// There is no robot.
    Away,
    /// A fault is present.
    Fault,
    /// A paused job waits.
    Paused,
    /// Somebody drives.
    ByHand,
    /// A job runs.
    Runs,
    /// No job runs.
    NoJob,
    /// It searches for the dock.
    Docking,
    /// It is on the dock.
    Docked,
    /// The role of this device is too low.
    NotAllowed,
    /// What is being drawn is not finished.
    Drawing,
}

impl Wait {
    /// For people.
    #[must_use]
    pub const fn text(self, words: &Words) -> &'static str {
        let texts = &words.offer;
        match self {
            Self::Away => texts.away,
            Self::Fault => texts.fault,
            Self::Paused => texts.paused,
            Self::ByHand => texts.by_hand,
            Self::Runs => texts.runs,
            Self::NoJob => texts.no_job,
            Self::Docking => texts.docking,
            Self::Docked => texts.docked,
            Self::NotAllowed => texts.not_allowed,
            Self::Drawing => texts.drawing,
        }
    }
}

/// What the one button for pausing does now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PauseKind {
    /// Pauses.
    Pause,
    /// Goes on.
    Resume,
}

/// All buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Offers {
    /// Start cleaning.
    pub start: Offer,
    /// Clean a spot.
    pub spot: Offer,
    /// Pause or go on.
    pub pause: Offer,
    /// Which of the two.
    pub pause_kind: PauseKind,
    /// Stop. Offered whenever a robot is connected, in every state.
    pub stop: Offer,
    /// Dock.
    pub dock: Offer,
    /// Beep.
    pub locate: Offer,
    /// Drive by hand.
    pub drive: Offer,
    /// Clear a fault.
    pub clear: Offer,
}

const AWAY: Offer = Offer::NotNow(Wait::Away);
const FAULT: Offer = Offer::NotNow(Wait::Fault);

impl Offers {
    /// The offers for what is known of the robot. Without a status everything waits.
    #[must_use]
    pub fn of(status: Option<&Status>, robot: Option<&RobotDescription>) -> Self {
        let state = status.map_or("disconnected", |status| status.state.as_str());
        let pause_kind = if state == "paused" {
            PauseKind::Resume
        } else {
            PauseKind::Pause
        };
        let has = |part: &str| robot.is_some_and(|robot| robot.parts.iter().any(|known| known == part));
        let away = state == "disconnected";
        let present = |part: &str, offer: Offer| if has(part) { offer } else { Offer::Absent };
        Self {
            start: start(state),
            spot: start(state),
            pause: pause(state),
            pause_kind,
            stop: if away { AWAY } else { Offer::Ready },
            dock: present("dock", dock(state)),
            locate: present("beeper", if away { AWAY } else { Offer::Ready }),
            drive: drive(state),
            clear: if matches!(state, "error" | "stuck") {
                Offer::Ready
            } else {
                Offer::Absent
            },
        }
    }
}

impl Offers {
    /// The same on a device that may make only some requests, known by their words.
    #[must_use]
    pub fn within(self, may: impl Fn(&str) -> bool) -> Self {
        let of = |verb: &str, offer: Offer| match offer {
            Offer::Ready | Offer::NotNow(_) if !may(verb) => Offer::NotNow(Wait::NotAllowed),
            offer => offer,
        };
        let pause = match self.pause_kind {
            PauseKind::Pause => "pause",
            PauseKind::Resume => "resume",
        };
        Self {
            start: of("start", self.start),
            spot: of("spot", self.spot),
            pause: of(pause, self.pause),
            pause_kind: self.pause_kind,
            stop: of("stop", self.stop),
            dock: of("dock", self.dock),
            locate: of("locate", self.locate),
            drive: of("drive", self.drive),
            clear: of("clear", self.clear),
        }
    }
}

fn start(state: &str) -> Offer {
    match state {
        "idle" | "docked" => Offer::Ready,
        "disconnected" => AWAY,
        "paused" => Offer::NotNow(Wait::Paused),
        "manual" => Offer::NotNow(Wait::ByHand),
        "stuck" | "error" => FAULT,
        _ => Offer::NotNow(Wait::Runs),
    }
}

fn pause(state: &str) -> Offer {
    match state {
        "starting" | "cleaning" | "spot" | "going" | "docking" | "paused" => Offer::Ready,
        "disconnected" => AWAY,
        _ => Offer::NotNow(Wait::NoJob),
    }
}

fn dock(state: &str) -> Offer {
    match state {
        "disconnected" => AWAY,
        "docking" => Offer::NotNow(Wait::Docking),
        "docked" => Offer::NotNow(Wait::Docked),
        "stuck" | "error" => FAULT,
        "manual" => Offer::NotNow(Wait::ByHand),
        _ => Offer::Ready,
    }
}

fn drive(state: &str) -> Offer {
    match state {
        "disconnected" => AWAY,
        "error" => FAULT,
        _ => Offer::Ready,
    }
}

#[cfg(test)]
mod tests {
    use super::{Offer, Offers, PauseKind, Wait};
    use rvac_api::{RobotDescription, Status};

    fn offers(state: &str, parts: &[&str]) -> Offers {
        let status = Status {
            state: state.to_owned(),
            ..Status::default()
        };
        let robot = RobotDescription {
            device: "x".to_owned(),
            radius_m: 0.17,
            swath_m: 0.3,
            speed_max_m_per_s: 0.3,
            turn_max_rad_per_s: 1.5,
            proximity: 0,
            parts: parts.iter().map(|&part| part.to_owned()).collect(),
            unguarded: Vec::new(),
            unmeasured: Vec::new(),
            lacking: Vec::new(),
        };
        Offers::of(Some(&status), Some(&robot))
    }

    const STATES: [&str; 10] = [
        "idle", "starting", "cleaning", "spot", "docking", "docked", "manual", "paused", "stuck", "error",
    ];

    #[test]
    fn stop_is_always_there_while_a_robot_is() {
        for state in STATES {
            assert_eq!(offers(state, &[]).stop, Offer::Ready, "{state}");
        }
        assert!(matches!(offers("disconnected", &[]).stop, Offer::NotNow(_)));
    }

    #[test]
    fn a_device_that_may_only_look_is_informed_and_still_stops_the_robot() {
        const NOT_ALLOWED: Offer = Offer::NotNow(Wait::NotAllowed);
        for state in STATES {
            let looking = offers(state, &["beeper"]).within(|verb| verb == "stop");
            assert_eq!(looking.stop, Offer::Ready, "{state}");
            assert_eq!(
                (
                    looking.start,
                    looking.spot,
                    looking.pause,
                    looking.drive,
                    looking.locate
                ),
                (NOT_ALLOWED, NOT_ALLOWED, NOT_ALLOWED, NOT_ALLOWED, NOT_ALLOWED),
                "{state}"
            );
            assert_eq!(
                looking.dock,
                Offer::Absent,
                "what the robot lacks is absent for all"
            );
            assert_eq!(offers(state, &[]).within(|_| true), offers(state, &[]));
        }
    }

    #[test]
    fn what_the_robot_lacks_is_absent() {
        for state in STATES {
            assert_eq!(offers(state, &[]).dock, Offer::Absent);
            assert_eq!(offers(state, &[]).locate, Offer::Absent);
            assert_ne!(offers(state, &["dock", "beeper"]).dock, Offer::Absent);
        }
        assert_eq!(offers("idle", &["dock"]).dock, Offer::Ready);
    }

    #[test]
    fn start_only_from_rest_and_pause_only_in_a_job() {
        for state in STATES {
            let offers = offers(state, &[]);
            assert_eq!(
                offers.start == Offer::Ready,
                matches!(state, "idle" | "docked"),
                "{state}"
            );
            let in_job = matches!(state, "starting" | "cleaning" | "spot" | "docking" | "paused");
            assert_eq!(offers.pause == Offer::Ready, in_job, "{state}");
        }
        assert_eq!(offers("paused", &[]).pause_kind, PauseKind::Resume);
    }

    #[test]
    fn without_a_word_from_the_robot_nothing_is_ready() {
        let offers = Offers::of(None, None);
        for offer in [offers.start, offers.spot, offers.pause, offers.stop, offers.drive] {
            assert!(matches!(offer, Offer::NotNow(_)));
        }
    }
}
