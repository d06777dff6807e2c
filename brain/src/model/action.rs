//! Actions that the brain requests. The shells perform them; the brain has no side effects.

/// The answer to one observation.
#[derive(Clone, Debug, PartialEq)]
pub struct Actions {
    /// Motion of the wheels until the next observation.
    pub motion: Motion,
    /// Whether brushes and suction should run.
    pub cleaners: bool,
    /// Arms the firmware (clears `not-armed`, `stopped`, `button-stop`, `link-lost`); sent once when a job starts.
    pub arm: Option<Arm>,
    /// Tones to play, in order.
    pub tones: Vec<Tone>,
    /// Decisions taken in this step, each with its named reason.
    pub decisions: Vec<Decision>,
}

/// Motion of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// No motion command is sent, leases run out.
    Rest,
    /// Stop now.
    Halt,
    /// Drive; the shell gives it a lease and repeats it.
    Drive {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate, counter-clockwise positive.
        turn_rad_per_s: f64,
    },
}

/// How to arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arm {
    /// The robot is about to leave the dock.
    pub undock: bool,
}

/// One tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Pitch; 0 is a pause.
    pub pitch_hz: u32,
    /// Duration.
    pub duration_ms: u16,
}

/// A decision and its reason, for the log, the recording and `rvac why`.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Name of the decision, for example `back-off`, `turn`, `state-cleaning`.
    pub what: &'static str,
    /// Named reason, for example `bump-left`, `cliff`, `command`, `wheel-drop`.
    pub reason: &'static str,
    /// A value of the decision, for example the angle of a turn in radians; 0 where there is none.
    pub value: f64,
}

/// Names of all decisions, for translations.
pub const DECISIONS: [&str; 53] = [
    "approach",
    "arc",
    "back-off",
    "bounce",
    "clean-by-statistics",
    "contour-closed",
    "covered",
    "depart",
    "dock-found",
    "dock-line",
    "dock-retry",
    "dock-scan",
    "dock-search",
    "dock-search-turn",
    "dock-travel",
    "dock-way",
    "dock-wiggle",
    "edit-refused",
    "end-lap",
    "escape-back-out",
    "escape-edge-left",
    "escape-edge-right",
    "escape-reverse",
    "escape-wait",
    "escape-wiggle",
    "follow-wall",
    "forget-obstructions",
    "free",
    "keep-no-map",
    "lap",
    "leave-wall",
    "leave-way",
    "plan",
    "refuse",
    "rest",
    "spiral",
    "squeeze",
    "state-cleaning",
    "state-disconnected",
    "state-docked",
    "state-docking",
    "state-error",
    "state-idle",
    "state-manual",
    "state-paused",
    "state-spot",
    "state-starting",
    "state-stuck",
    "turn",
    "turn-to-part",
    "wait",
    "wait-for-current",
    "withdraw",
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::DECISIONS;

    /// All code of this crate except this file.
    fn code(folder: &Path) -> String {
        let mut text = String::new();
        for entry in fs::read_dir(folder).expect("is there") {
            let path = entry.expect("is there").path();
            if path.is_dir() {
                text += &code(&path);
            } else if !path.ends_with("src/model/action.rs") {
                text += &fs::read_to_string(&path).expect("is text");
            }
        }
        text
    }

    #[test]
    fn the_list_contains_exactly_the_decisions_in_the_code() {
        let code = code(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        let decided = code.split("decide(").skip(1);
        let named = decided.filter_map(|rest| rest.trim_start().strip_prefix('"')?.split('"').next());
        let named: BTreeSet<&str> = named.collect();
        assert!(named.len() > 30, "only {} were found", named.len());
        let known: BTreeSet<&str> = DECISIONS.into();
        assert_eq!(named.difference(&known).collect::<Vec<_>>(), Vec::<&&str>::new());
        for name in DECISIONS {
            assert!(code.contains(&format!("\"{name}\"")), "{name} is decided nowhere");
        }
    }
}
