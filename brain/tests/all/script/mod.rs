//! A small language for tests of the state machine.
//!
//! A script has one line a step: `verb arguments => state reason`. The verb changes what the robot perceives or what
//! people ask; then a few observations pass, and what stands right of the arrow must be so. Right of the arrow a reason
//! may be left out, and a line without an arrow expects nothing.
//!
//! Verbs: `up`, `down` (link); `wait SECONDS`; `clean`, `spot`, `dock`, `pause`, `resume`, `stop`, `clear`; `drive V W`,
//! `release`; `press left|right|both|none`; `cliff`, `floor`; `lift`, `put`; `inhibit NAME`, `free NAME`; `docked`,
//! `undocked`; `charge SHARE`;
//! `current flows|withheld|missing`; `beams`, `silence` (the dock's near field); `push METRES` (somebody rolls it); `block`, `unblock` (wheels do not turn); `deaf` (the firmware ignores `arm`).

use brain::action::Tone;
use brain::observation::{ChargeFlow, Cliffs, Contacts};
use brain::{
    Actions, BehaviorState, Body, Brain, BrainConfig, Command, Inhibits, JobCommand, Motion, Observation,
    Speeds, StrategyName,
};

const STEP_US: u64 = 20_000;
const TRACK_M: f64 = 0.23;

pub(crate) fn config() -> BrainConfig {
    let body = Body {
        radius_m: 0.175,
        swath_m: 0.30,
        track_m: TRACK_M,
    };
    BrainConfig::new(
        body,
        Speeds {
            cruise_m_per_s: 0.25,
            max_m_per_s: 0.35,
            turn_max_rad_per_s: 1.5,
        },
    )
}

/// A robot on an endless floor that does what it is told, and the brain that tells it.
pub(crate) struct Stage {
    pub(crate) brain: Brain,
    pub(crate) observation: Observation,
    pub(crate) tones: Vec<Tone>,
    pub(crate) arms: u32,
    pub(crate) motion: Motion,
    pub(crate) cleaners: bool,
    /// Way back without a way forward that made it good, in metres.
    pub(crate) backed_m: f64,
    /// Steps for which a wheel has been hanging, or no cliff sensor has seen the floor since the robot was taken off its contacts.
    lifted_steps: u32,
    /// The contacts opened, and the wheels have not turned since.
    taken_off_dock: bool,
    /// The contacts were closed at the last observation.
    was_docked: bool,
    /// Mean travel of the wheels at the last observation.
    travel_m: f64,
    /// A person drove at the last observation.
    driven_by_hand: bool,
    blocked: bool,
    deaf: bool,
}

impl Stage {
    pub(crate) fn new(config: BrainConfig) -> Self {
        Self {
            brain: Brain::new(config, 1),
            observation: Observation {
                link_up: false,
                inhibits: Inhibits::from_names(["not-armed"]),
                ..Observation::default()
            },
            tones: Vec::new(),
            arms: 0,
            motion: Motion::Rest,
            cleaners: false,
            backed_m: 0.0,
            lifted_steps: 0,
            taken_off_dock: false,
            was_docked: false,
            travel_m: 0.0,
            driven_by_hand: false,
            blocked: false,
            deaf: false,
        }
    }

    /// One observation; the actions come true before the next one.
    pub(crate) fn step(&mut self, commands: &[JobCommand]) -> Actions {
        self.observation.time_us += STEP_US;
        let commands: Vec<Command> = commands.iter().cloned().map(Command::from).collect();
        let actions = self.brain.step(&self.observation, &commands);
        self.assert_lawful(&actions);
        self.assert_seen_behind();
        self.motion = actions.motion;
        self.cleaners = actions.cleaners;
        self.tones.extend(&actions.tones);
        if actions.arm.is_some() && !self.deaf {
            self.arms += 1;
            let kept = [
                "wheel-drop",
                "wheel-stall",
                "bumper",
                "cliff",
                "not-moving",
                "unknown-inhibit",
            ];
            keep(&mut self.observation.inhibits, |name| kept.contains(&name));
        }
        if let Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s,
        } = actions.motion
            && !self.blocked
        {
            let (forward_m, turn_rad) = (speed_m_per_s * 0.02, turn_rad_per_s * 0.02);
            self.observation.travel_left_m += forward_m - 0.5 * TRACK_M * turn_rad;
            self.observation.travel_right_m += forward_m + 0.5 * TRACK_M * turn_rad;
            self.observation.gyro_heading_rad = self
                .observation
                .gyro_heading_rad
                .map(|heading| heading + turn_rad);
        }
        actions
    }

    /// What must hold in every step whatever happens.
    pub(crate) fn assert_lawful(&self, actions: &Actions) {
        let Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s,
        } = actions.motion
        else {
            return;
        };
        let seen = &self.observation;
        assert!(
            self.brain.status().state.moves(),
            "{actions:?} in {:?}",
            self.brain.status()
        );
        assert!(seen.link_up && !seen.wheel_drop, "{actions:?} while {seen:?}");
        let restricting = ["bumper", "cliff", "cliff-sensor"];
        assert!(
            seen.inhibits.names().all(|name| restricting.contains(&name)),
            "{actions:?} against {:?}",
            seen.inhibits
        );
        if seen.is_touching() || seen.is_at_cliff() {
            assert!(
                leads_away(speed_m_per_s, turn_rad_per_s, seen),
                "{actions:?} while {seen:?}"
            );
        }
        assert!(
            speed_m_per_s.abs() <= 0.35 && turn_rad_per_s.abs() <= 1.5,
            "{actions:?}"
        );
    }

    /// Nobody but a person backs over more than 0.15 m of unknown ground.
    fn assert_seen_behind(&mut self) {
        let travel_m = 0.5 * (self.observation.travel_left_m + self.observation.travel_right_m);
        let advance_m = travel_m - self.travel_m;
        self.travel_m = travel_m;
        self.backed_m = (self.backed_m - advance_m).max(0.0);
        self.lifted_steps = if self.is_held(advance_m) {
            self.lifted_steps + 1
        } else {
            0
        };
        // Who holds the robot up for a second chooses the floor behind it.
        if u64::from(self.lifted_steps) * STEP_US >= 1_000_000 {
            self.backed_m = 0.0;
        }
        if self.driven_by_hand {
            self.backed_m = self.backed_m.min(0.15);
        }
        self.driven_by_hand = self.brain.status().state == BehaviorState::Manual;
        // Wheels that turn on the spot move the middle by what rounding leaves.
        assert!(
            self.backed_m <= 0.15 + 1e-9,
            "{} m back: {:?}",
            self.backed_m,
            self.brain.status()
        );
    }

    /// Whether somebody seems to hold the robot up: a wheel hangs, or contacts opened under standing wheels and the floor is gone.
    fn is_held(&mut self, advance_m: f64) -> bool {
        let seen = &self.observation;
        let opened = core::mem::replace(&mut self.was_docked, seen.docked);
        self.taken_off_dock = !seen.docked && advance_m == 0.0 && (opened || self.taken_off_dock);
        let cliffs = seen.cliffs;
        let sees_no_floor = cliffs.left && cliffs.middle && cliffs.right;
        seen.link_up && (seen.wheel_drop || self.taken_off_dock && sees_no_floor)
    }

    fn seconds(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1e6) as u64 / STEP_US {
            self.step(&[]);
        }
    }

    fn command(&mut self, command: JobCommand) {
        self.step(&[command]);
        self.step(&[]);
    }

    fn perform(&mut self, verb: &str, arguments: &[&str]) {
        let number = |index: usize| arguments[index].parse::<f64>().expect("a number");
        if let Some(command) = self.parse_command(verb, arguments) {
            return self.command(command);
        }
        let seen = &mut self.observation;
        match verb {
            "wait" => return self.seconds(number(0)),
            "up" => seen.link_up = true,
            "down" => seen.link_up = false,
            "press" => {
                let [left, right] =
                    ["left", "right"].map(|side| arguments[0] == side || arguments[0] == "both");
                seen.contacts = Contacts { left, right };
            }
            "cliff" => {
                let at = |side| arguments.first().copied().unwrap_or("middle") == side;
                let (left, middle, right) = (at("left"), at("middle"), at("right"));
                seen.cliffs = Cliffs { left, middle, right };
            }
            "floor" => seen.cliffs = Cliffs::default(),
            "lift" => seen.wheel_drop = true,
            "put" => seen.wheel_drop = false,
            "inhibit" => {
                seen.inhibits = Inhibits::from_names(seen.inhibits.names().chain([leak(arguments[0])]))
            }
            "free" => keep(&mut seen.inhibits, |name| name != arguments[0]),
            "docked" => (seen.docked, seen.inhibits) = (true, Inhibits::from_names(["docked", "not-armed"])),
            "undocked" => seen.docked = false,
            "charge" => seen.battery_charge = Some(number(0) as f32),
            "current" => {
                seen.charge_flow = Some(match arguments[0] {
                    "flows" => ChargeFlow::Flowing,
                    "withheld" => ChargeFlow::Withheld,
                    _ => ChargeFlow::Missing,
                });
            }
            "beams" => seen.dock_beams = vec![4, 4, 0, 0],
            "silence" => seen.dock_beams = Vec::new(),
            "push" => return self.push(number(0)),
            "block" => self.blocked = true,
            "unblock" => self.blocked = false,
            "deaf" => self.deaf = true,
            other => panic!("{other} is no verb"),
        }
        self.seconds(0.04);
    }

    /// Somebody rolls it so far.
    fn push(&mut self, metres: f64) {
        for _ in 0..20 {
            self.observation.travel_left_m += metres / 20.0;
            self.observation.travel_right_m += metres / 20.0;
            self.step(&[]);
        }
    }

    fn parse_command(&self, verb: &str, arguments: &[&str]) -> Option<JobCommand> {
        Some(match verb {
            "clean" => JobCommand::Clean {
                strategy: StrategyName::Bounce,
            },
            "spot" => JobCommand::Spot,
            "dock" => JobCommand::Dock,
            "pause" => JobCommand::Pause,
            "resume" => JobCommand::Resume,
            "stop" => JobCommand::Stop,
            "clear" => JobCommand::ClearError,
            "release" => JobCommand::ManualEnd,
            "drive" => JobCommand::Manual {
                speed_m_per_s: arguments[0].parse().expect("a speed"),
                turn_rad_per_s: arguments[1].parse().expect("a turn rate"),
                valid_until_us: self.observation.time_us + 400_000,
                cleaners: false,
            },
            _ => return None,
        })
    }
}

/// Inhibits are static names; the few of a test may leak.
fn leak(name: &str) -> &'static str {
    Box::leak(name.to_owned().into_boxed_str())
}

/// Whether a motion is one of those that the firmware permits while a bumper is pressed (S6) or a cliff is seen (S8), and turns no held side
/// forward.
pub(crate) fn leads_away(speed_m_per_s: f64, turn_rad_per_s: f64, seen: &Observation) -> bool {
    let forward_m_per_s = speed_m_per_s + 0.5 * TRACK_M * turn_rad_per_s.abs();
    let turns_left = turn_rad_per_s > 0.0;
    let is_held_on_one_side = |left: bool, right: bool| left != right && right == turns_left;
    let (contacts, cliffs) = (seen.contacts, seen.cliffs);
    if speed_m_per_s < 0.0 && turn_rad_per_s == 0.0 {
        true
    } else if seen.is_at_cliff() {
        !seen.is_touching() && forward_m_per_s < 0.0 && is_held_on_one_side(cliffs.left, cliffs.right)
    } else {
        speed_m_per_s == 0.0 && is_held_on_one_side(contacts.left, contacts.right)
    }
}

fn keep(inhibits: &mut Inhibits, is_kept: impl Fn(&str) -> bool) {
    *inhibits = Inhibits::from_names(inhibits.names().filter(|name| is_kept(name)));
}

/// Runs a script on a fresh robot and gives the stage back for further questions.
pub(crate) fn check(script: &str) -> Stage {
    check_with(config(), script)
}

/// As [`check`] with another configuration.
pub(crate) fn check_with(config: BrainConfig, script: &str) -> Stage {
    let mut stage = Stage::new(config);
    for (number, line) in script.lines().enumerate() {
        let (left, right) = line.split_once("=>").unwrap_or((line, ""));
        let mut words = left.split_whitespace();
        let Some(verb) = words.next() else { continue };
        stage.perform(verb, &words.collect::<Vec<_>>());
        let status = stage.brain.status();
        let found = [status.state.name(), status.reason.name()];
        for (expected, found) in right.split_whitespace().zip(found) {
            assert_eq!(found, expected, "line {}: {}", number + 1, line.trim());
        }
    }
    stage
}
