//! What is the matter, in few kinds: the closed set by which other systems, notifications and statistics sort the named reasons.
//!
//! The table names every code of the catalogue, and does not compile without one that it forgot.

use crate::reasons::CATALOGUE;
use crate::{Activity, Status};

/// What is the matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Trouble {
    /// A wheel hangs.
    Lifted,
    /// Something holds it, or it does not find out.
    Held,
    /// The bumper.
    Bumper,
    /// The sensors of the floor's end.
    Cliff,
    /// A wheel or its sensor.
    Wheels,
    /// The main brush.
    Brush,
    /// There is little charge.
    BatteryLow,
    /// The pack itself.
    Battery,
    /// The charger, or no current flows on the dock.
    Charger,
    /// The dock is not found.
    Dock,
    /// There is no way to where it shall go.
    Route,
    /// It does not know where it is.
    Place,
    /// The robot does not answer, or what it says arrives damaged.
    Link,
    /// The controller of the robot.
    Electronics,
    /// Values that it needs were never measured.
    Calibration,
}

/// How grave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Gravity {
    /// It goes on by itself, or charging helps.
    Warning,
    /// A person must do something.
    Error,
    /// It must not be used before it is repaired.
    Catastrophe,
}

/// A trouble in the words of others. A new system of theirs is a new column here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TroubleWords {
    /// Our own word: a closed set for filters, labels and devices of others.
    pub name: &'static str,
    /// `subsystem` of an error in Valetudo's interface.
    pub subsystem: &'static str,
    /// How grave.
    pub gravity: Gravity,
    /// `ErrorStateID` of a robotic vacuum cleaner in Matter.
    pub matter_error: u8,
}

impl Gravity {
    /// `severity.level` of an error in Valetudo's interface.
    #[must_use]
    pub const fn level(self) -> &'static str {
        match self {
            Self::Warning => "warning",
            Self::Error => "error",
            Self::Catastrophe => "catastrophic",
        }
    }
}

impl Trouble {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Lifted,
        Self::Held,
        Self::Bumper,
        Self::Cliff,
        Self::Wheels,
        Self::Brush,
        Self::BatteryLow,
        Self::Battery,
        Self::Charger,
        Self::Dock,
        Self::Route,
        Self::Place,
        Self::Link,
        Self::Electronics,
        Self::Calibration,
    ];

    /// In the words of others.
    #[must_use]
    pub const fn words(self) -> TroubleWords {
        use Gravity::{Catastrophe, Error, Warning};
        let (name, subsystem, gravity, matter_error) = match self {
            Self::Lifted => ("lifted", "sensors", Error, 0x41),
            Self::Held => ("held", "navigation", Error, 0x41),
            Self::Bumper => ("bumper", "sensors", Error, 0x4e),
            Self::Cliff => ("cliff-sensor", "sensors", Error, 0x4e),
            Self::Wheels => ("wheels", "motors", Error, 0x4c),
            Self::Brush => ("brush", "motors", Error, 0x4d),
            Self::BatteryLow => ("battery-low", "power", Warning, 0x48),
            Self::Battery => ("battery", "power", Catastrophe, 0x02),
            Self::Charger => ("charger", "power", Error, 0x02),
            Self::Dock => ("dock", "dock", Error, 0x40),
            Self::Route => ("route", "navigation", Warning, 0x49),
            Self::Place => ("place", "navigation", Error, 0x02),
            Self::Link => ("link", "core", Error, 0x02),
            Self::Electronics => ("electronics", "core", Catastrophe, 0x02),
            Self::Calibration => ("calibration", "core", Error, 0x01),
        };
        TroubleWords {
            name,
            subsystem,
            gravity,
            matter_error,
        }
    }

    /// What a code stands for; `None` when nothing is the matter, or the code is newer than this program.
    #[must_use]
    pub fn of(code: &str) -> Option<Self> {
        let row = TROUBLES.iter().find(|(known, _)| *known == code);
        row.and_then(|(_, trouble)| *trouble)
    }

    /// What is the matter with a robot that is in this state: the code, and what it stands for. A robot that waits for help is in trouble
    /// even if its reason is newer than this program.
    #[must_use]
    pub fn of_status(status: &Status) -> Option<(&str, Self)> {
        let activity = Activity::from_name(&status.state);
        if activity.is_some_and(Activity::needs_help) {
            let usual = match activity {
                Some(Activity::Disconnected) => Self::Link,
                Some(Activity::Error) => Self::Electronics,
                _ => Self::Held,
            };
            return Some((&status.reason, Self::of(&status.reason).unwrap_or(usual)));
        }
        let inhibit = |code: &'_ String| Self::of(code).is_some();
        let code = status.inhibits.iter().find(|code| inhibit(code))?;
        Some((code, Self::of(code)?))
    }
}

/// What each code of the catalogue stands for.
#[rustfmt::skip]
const TROUBLES: &[(&str, Option<Trouble>)] = &[
    ("no-daemon", Some(Trouble::Link)),
    ("no-server", Some(Trouble::Link)),
    ("no-robot", Some(Trouble::Link)),
    ("job-runs", None),
    ("job-paused", None),
    ("drives-home", None),
    ("recharging", None),
    ("dock-unknown", Some(Trouble::Dock)),
    ("place-vague", None),
    ("place-unknown", Some(Trouble::Place)),
    ("way-blocked", Some(Trouble::Route)),
    ("no-map", None),
    ("by-statistics", None),
    ("swept-lately", None),
    ("new-floor", None),
    ("rest-out-of-reach", Some(Trouble::Route)),
    ("start-up", None),
    ("command", None),
    ("look-again", Some(Trouble::Route)),
    ("not-worth-the-time", Some(Trouble::Route)),
    ("crumbs-left", Some(Trouble::BatteryLow)),
    ("finished", None),
    ("arrived", None),
    ("continued", None),
    ("restored", None),
    ("not-armed", None),
    ("arm-refused", Some(Trouble::Electronics)),
    ("link-lost", Some(Trouble::Link)),
    ("link-restored", None),
    ("link-garbled", Some(Trouble::Link)),
    ("line-wrong-speed", Some(Trouble::Link)),
    ("line-has-console", Some(Trouble::Link)),
    ("link-corrupted", Some(Trouble::Link)),
    ("link-late", Some(Trouble::Link)),
    ("clock-frozen", Some(Trouble::Electronics)),
    ("clock-jumped", Some(Trouble::Electronics)),
    ("commands-lost", Some(Trouble::Link)),
    ("commands-stale", Some(Trouble::Link)),
    ("not-calibrated", Some(Trouble::Calibration)),
    ("stopped", None),
    ("button-stop", None),
    ("wheel-drop", Some(Trouble::Lifted)),
    ("docked", None),
    ("bump-left", None),
    ("bump-right", None),
    ("bump-front", None),
    ("bumper", None),
    ("cliff-left", None),
    ("cliff-right", None),
    ("cliff-front", None),
    ("cliff", None),
    ("contact-held", Some(Trouble::Held)),
    ("cliff-held", Some(Trouble::Held)),
    ("boxed-in", Some(Trouble::Held)),
    ("shut-in", Some(Trouble::Held)),
    ("not-moving", Some(Trouble::Held)),
    ("slip", Some(Trouble::Held)),
    ("task-budget", Some(Trouble::Route)),
    ("battery-low", Some(Trouble::BatteryLow)),
    ("battery-weak", Some(Trouble::BatteryLow)),
    ("battery-empty", Some(Trouble::BatteryLow)),
    ("battery-hot", Some(Trouble::Battery)),
    ("battery-overheated", Some(Trouble::Battery)),
    ("thermistor", Some(Trouble::Battery)),
    ("charger-fault", Some(Trouble::Charger)),
    ("charger-shorted", Some(Trouble::Charger)),
    ("clock", Some(Trouble::Electronics)),
    ("memory", Some(Trouble::Electronics)),
    ("dock-not-found", Some(Trouble::Dock)),
    ("no-charge-current", Some(Trouble::Charger)),
    ("dock-beam", None),
    ("planning", None),
    ("lease-ended", None),
    ("released", None),
    ("already-running", None),
    ("no-job", None),
    ("error-stands", None),
    ("reset-loop", Some(Trouble::Electronics)),
    ("bumper-stuck", Some(Trouble::Bumper)),
    ("cliff-trapped", Some(Trouble::Held)),
    ("cliff-sensor", Some(Trouble::Cliff)),
    ("wheel-stall", Some(Trouble::Wheels)),
    ("brush-stall", Some(Trouble::Brush)),
    ("runaway", Some(Trouble::Wheels)),
    ("encoder", Some(Trouble::Wheels)),
    ("internal", Some(Trouble::Electronics)),
    ("unknown-inhibit", Some(Trouble::Electronics)),
    ("driver-busy", None),
    ("centre-first", None),
    ("pad-silent", None),
    ("zone-changed", None),
    ("zone-unknown", None),
    ("zone-variable-unknown", None),
    ("clock-set", None),
    ("busy", None),
    ("unknown-component", None),
    ("not-renewed", None),
    ("nothing-learnt", None),
    ("being-calibrated", None),
    ("not-calibrating", None),
    ("calibration-late", None),
    ("calibration-ended", None),
    ("calibration-unknown-robot", None),
    ("calibration-unknown-value", None),
    ("calibration-file-strange", None),
    ("calibration-file-unwritable", None),
    ("calibration-no-answer", None),
    ("calibration-old-firmware", None),
    ("calibration-refused", None),
    ("calibration-needed-first", None),
    ("calibration-not-pressed", None),
    ("calibration-cliffs-known", None),
    ("calibration-nothing-turns", None),
    ("calibration-let-go", None),
    ("calibration-implausible", None),
    ("calibration-no-agreement", None),
    ("calibration-still", None),
    ("calibration-unequal", None),
    ("calibration-distance", None),
    ("calibration-unclear", None),
    ("calibration-unsteady", None),
    ("calibration-faint", None),
    ("learnt-unwritable", None),
    ("health-unwritable", None),
    ("unknown-strategy", None),
    ("expert-off", None),
    ("syntax", None),
    ("unknown", None),
    ("range", None),
    ("stale", Some(Trouble::Link)),
    ("inhibited", None),
    ("absent", None),
    ("skipped", None),
    ("missed", None),
    ("quiet-hours", None),
    ("other-floor", Some(Trouble::Place)),
    ("interrupted", None),
    ("no-such-room", None),
    ("map-not-taken-up", Some(Trouble::Place)),
    ("cause-remains", None),
    ("cliff-again", Some(Trouble::Held)),
    ("came-free", None),
    ("long-run", None),
    ("unswept-floor", None),
    ("off-the-way", None),
    ("no-heading", None),
    ("beacons-heard", None),
    ("beacons-silent", None),
    ("place-contradicted", Some(Trouble::Place)),
    ("beacons-agree", None),
    ("beacon-moved", None),
    ("beacons-moved", None),
    ("obstructed", Some(Trouble::Route)),
    ("gyro-scale", None),
    ("mapped-not-met", Some(Trouble::Place)),
    ("met-not-mapped", Some(Trouble::Place)),
    ("place-not-in-map", Some(Trouble::Place)),
    ("gyro-drift", None),
    ("gyro-frozen", None),
    ("gyro-at-its-limit", None),
    ("gyro-disagrees", None),
    ("gyro-silent", None),
    ("gyro-back", None),
    ("wall-ahead", None),
    ("wall-ended", None),
    ("known-wall", None),
    ("alternation", None),
    ("open-floor", None),
    ("back-at-start", None),
    ("island", None),
    ("long-lap", None),
    ("charged", None),
    ("dock-known", None),
    ("dock-heard", None),
    ("dock-missed", Some(Trouble::Dock)),
    ("no-beam", Some(Trouble::Dock)),
    ("next-part", None),
    ("no-error", None),
    ("bad-order", None),
    ("bad-zone", None),
    ("bad-name", None),
    ("name-taken", None),
    ("bad-settings", None),
    ("bad-line", None),
    ("line-misses-room", None),
    ("line-ends-in-room", None),
    ("part-too-small", None),
    ("rooms-apart", None),
    ("no-such-room-change", None),
    ("room-change-in-use", None),
    ("too-many-room-changes", None),
    ("no-floor-there", None),
    ("no-such-no-go", None),
    ("no-such-place", None),
    ("too-many-places", None),
    ("too-many-no-gos", None),
    ("dock-inside", None),
    ("floor-unknown", Some(Trouble::Place)),
    ("which-dock", Some(Trouble::Dock)),
    ("last-floor", None),
    ("not-removed", None),
    ("disk-busy", None),
    ("not-sent", Some(Trouble::Link)),
    ("ending", None),
    ("lease-range", None),
    ("input-name", None),
    ("input-range", None),
    ("input-taken", None),
    ("too-many-estimates", None),
    ("too-many-inputs", None),
    ("raw-syntax", None),
    ("dock-no-contact", Some(Trouble::Charger)),
    ("dock-contact-lost", Some(Trouble::Charger)),
    ("dock-power-lost", Some(Trouble::Charger)),
    ("dock-obstructed", Some(Trouble::Dock)),
    ("pushed-off", Some(Trouble::Dock)),
    ("lifted-off", Some(Trouble::Lifted)),
    ("most-out-of-reach", Some(Trouble::Route)),
    ("no-go-in-the-way", Some(Trouble::Route)),
    ("virtual-wall-in-the-way", Some(Trouble::Route)),
    ("door-shut", Some(Trouble::Route)),
    ("new-obstacle-in-the-way", Some(Trouble::Route)),
    ("inside-no-go", None),
    ("no-go-ahead", None),
    ("zone-crosses", None),
    ("zone-too-thin", None),
    ("dock-shut-off", None),
];

// A code that stands in the catalogue and not in this table is an error of the compiler: say here what it stands for.
const _: () = assert!(
    forgotten().is_none(),
    "a code of the catalogue has no row in TROUBLES"
);

/// Place in the catalogue of a code that has no row.
const fn forgotten() -> Option<usize> {
    let mut at = 0;
    while at < CATALOGUE.len() {
        if !has_row(CATALOGUE[at].0) {
            return Some(at);
        }
        at += 1;
    }
    None
}

const fn has_row(code: &str) -> bool {
    let mut at = 0;
    while at < TROUBLES.len() {
        if is_same(TROUBLES[at].0.as_bytes(), code.as_bytes()) {
            return true;
        }
        at += 1;
    }
    false
}

const fn is_same(one: &[u8], other: &[u8]) -> bool {
    if one.len() != other.len() {
        return false;
    }
    let mut at = 0;
    while at < one.len() {
        if one[at] != other[at] {
            return false;
        }
        at += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use alloc::borrow::ToOwned as _;
    use alloc::vec;

    use super::{TROUBLES, Trouble};
    use crate::reasons::explain;
    use crate::{Activity, Status};

    #[test]
    fn every_row_is_a_code_and_every_trouble_has_words_that_others_know() {
        for (code, _) in TROUBLES {
            assert!(explain(code).is_some(), "{code} stands in no catalogue");
        }
        // Of Valetudo's interface.
        let subsystems = [
            "core",
            "power",
            "sensors",
            "motors",
            "navigation",
            "attachments",
            "dock",
        ];
        // Unable to start or resume, unable to complete the operation, and those that only a vacuum cleaner has.
        let matter_errors = [0x01, 0x02, 0x40, 0x41, 0x42, 0x43, 0x48, 0x49, 0x4c, 0x4d, 0x4e];
        for trouble in Trouble::ALL {
            assert!(subsystems.contains(&trouble.words().subsystem), "{trouble:?}");
            assert!(
                matter_errors.contains(&trouble.words().matter_error),
                "{trouble:?}"
            );
            assert!(
                TROUBLES.iter().any(|(_, other)| *other == Some(trouble)),
                "{trouble:?}"
            );
        }
    }

    #[test]
    fn a_robot_that_waits_for_help_is_in_trouble_whatever_its_reason() {
        let mut status = Status::default();
        for activity in Activity::ALL {
            activity.name().clone_into(&mut status.state);
            "of-a-newer-robot".clone_into(&mut status.reason);
            assert_eq!(Trouble::of_status(&status).is_some(), activity.needs_help());
        }
        status.state = "idle".to_owned();
        status.inhibits = vec!["not-armed".to_owned(), "wheel-drop".to_owned()];
        assert_eq!(Trouble::of_status(&status), Some(("wheel-drop", Trouble::Lifted)));
    }
}
