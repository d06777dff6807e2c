//! What the buttons of the robot do, and whom they are reported to.

use brain::{BehaviorState, JobCommand, Status, StrategyName};
use rvac_api::{Gesture, LogLevel, Topic, Update};

use super::audience::Teller;
use super::buttons::{Buttons, DOCK, START};
use super::journal::LogSource;
use crate::device::Report;
use crate::{ClientId, to_api};

/// Devices can be forgotten by the buttons for so long after the robot was switched on or reset, so that no game with them does it.
const RECOVERY_MS: u32 = 600_000;

/// A button went down or up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ButtonEdge {
    pub(crate) button: u8,
    pub(crate) pressed: bool,
}

/// What START means depends on what the robot does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doing {
    pub(crate) status: Status,
    /// The state has changed so lately that the press means the state before.
    pub(crate) is_new: bool,
    /// Strategy of a job that names none.
    pub(crate) usual_strategy: StrategyName,
}

/// The buttons of the robot.
#[derive(Debug, Default)]
pub(crate) struct ButtonDesk {
    buttons: Buttons,
    /// Buttons of the Linux board that are down.
    board: u8,
    /// START went down while nothing ran that it had to stop.
    start_means_more: bool,
}

impl ButtonDesk {
    /// Events may have been lost: buttons that are down must be released first.
    pub(crate) fn forget(&mut self) {
        self.buttons.forget();
    }

    /// The client is gone.
    pub(crate) fn forget_client(&mut self, client: ClientId) {
        self.buttons.forget_client(client);
    }

    /// Keeps presses for a client for so long, or no longer with 0.
    pub(crate) fn claim(&mut self, now_us: u64, client: ClientId, ms: u32) {
        self.buttons.claim(now_us, client, ms);
    }

    /// Which buttons of the Linux board are down now; gives those that have changed.
    pub(crate) fn take_board(&mut self, down: u8) -> u8 {
        let changed = self.board ^ down;
        self.board = down;
        changed
    }

    /// A button went down, which stops what runs at once, or up, which starts or goes on if it was a short press. Gives what the
    /// brain is told.
    pub(crate) fn turned(
        &mut self,
        edge: ButtonEdge,
        doing: Option<&Doing>,
        teller: &mut Teller<'_>,
    ) -> Option<JobCommand> {
        let ButtonEdge { button, pressed } = edge;
        let gesture = self.buttons.take_edge(teller.now_us, button, pressed);
        let mut command = None;
        if button == START && pressed {
            command = self.start_went_down(doing);
        }
        if gesture == Some(Gesture::Press) {
            tell_gesture(Gesture::Press, button, teller);
            command = match button {
                _ if self.buttons.are_claimed(teller.now_us) => command,
                START => self.start_was_pressed(doing),
                // The firmware has stopped what ran when the button went down.
                DOCK => doing.map(|_| JobCommand::Dock),
                _ => command,
            };
        }
        command
    }

    /// A report says which of the robot's are down; those of the Linux board are known.
    pub(crate) fn reported(&mut self, report: &Report, teller: &mut Teller<'_>) {
        if let Some(gesture) = self
            .buttons
            .take_report(teller.now_us, report.buttons | self.board)
        {
            held(gesture, report.uptime_ms, teller);
        }
    }

    /// Stops what runs. A robot that waits or stands is handled at the release, because the person may mean to hold the button.
    fn start_went_down(&mut self, doing: Option<&Doing>) -> Option<JobCommand> {
        self.start_means_more = doing.is_none_or(|doing| !doing.is_new);
        let doing = doing.filter(|_| self.start_means_more)?;
        let command = match doing.status.state {
            BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Going
            | BehaviorState::Docking => JobCommand::Pause,
            BehaviorState::Manual => JobCommand::ManualEnd,
            BehaviorState::Paused
            | BehaviorState::Docked
            | BehaviorState::Idle
            | BehaviorState::Stuck
            | BehaviorState::Error
            | BehaviorState::Disconnected => return None,
        };
        self.start_means_more = false;
        Some(command)
    }

    /// Goes on with what waits, else starts.
    fn start_was_pressed(&self, doing: Option<&Doing>) -> Option<JobCommand> {
        let doing = doing.filter(|_| self.start_means_more)?;
        match doing.status.state {
            BehaviorState::Paused => Some(JobCommand::Resume),
            BehaviorState::Docked if doing.status.resumable => Some(JobCommand::Resume),
            BehaviorState::Idle | BehaviorState::Docked => Some(JobCommand::Clean {
                strategy: doing.usual_strategy,
            }),
            BehaviorState::Stuck | BehaviorState::Error => Some(JobCommand::ClearError),
            BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Going
            | BehaviorState::Docking
            | BehaviorState::Manual
            | BehaviorState::Disconnected => None,
        }
    }
}

/// A button is held, which only a person beside the robot can do.
fn held(gesture: Gesture, uptime_ms: Option<u32>, teller: &mut Teller<'_>) {
    let text = match gesture {
        Gesture::RecoveryHold if uptime_ms.is_none_or(|ms| ms > RECOVERY_MS) => {
            let text = "START and DOCK are held: to forget all devices, hold them within ten minutes after switching the \
                        robot on";
            return teller.log(LogLevel::Warn, LogSource::Firmware, text.to_owned());
        }
        Gesture::RecoveryHold => "START and DOCK are held: all devices shall be forgotten",
        Gesture::PairingHold | Gesture::Press => "START is held: a device shall be let in",
    };
    teller.log(LogLevel::Info, LogSource::Firmware, text.to_owned());
    tell_gesture(gesture, START, teller);
}

fn tell_gesture(gesture: Gesture, button: u8, teller: &mut Teller<'_>) {
    if teller.has_followers(Topic::Buttons) {
        let t = to_api::seconds(teller.now_us);
        teller.tell(Topic::Buttons, Update::Button { gesture, button, t });
    }
}
