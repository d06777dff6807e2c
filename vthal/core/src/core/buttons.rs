//! What the robot does because of its buttons, and who else hears of them.

use brain::{BehaviorState, Command};
use rvac_api::{Gesture, LogLevel, RunAsker, Topic, Update};

use super::Core;
use crate::arbiter::Source;
use crate::buttons::START;
use crate::journal::Part;
use crate::mind::Mind;
use crate::outputs::{Delivery, Recipients};
use crate::{Outputs, to_api};

/// The firmware stops by itself when a button is pressed in motion; by the time the press arrives here the state may have
/// changed for that very press. A press so soon after a change means the state before.
const AFTER_CHANGE_US: u64 = 500_000;
/// Devices can be forgotten by the buttons for so long after the robot was switched on or reset, so that no game with them does it.
const RECOVERY_MS: u32 = 600_000;

impl Core {
    /// A button went down, which stops what runs at once, or up, which starts or goes on if it was a short press.
    pub(super) fn button_turned(
        &mut self,
        now_us: u64,
        (button, pressed): (u8, bool),
        outputs: &mut Outputs,
    ) {
        let gesture = self.buttons.take_edge(now_us, button, pressed);
        if button == START && pressed {
            self.start_went_down(now_us, outputs);
        }
        if gesture == Some(Gesture::Press) {
            self.tell_gesture(now_us, (Gesture::Press, button), outputs);
            if button == START && !self.buttons.are_claimed(now_us) {
                self.start_was_pressed(now_us, outputs);
            }
        }
    }

    /// Somebody holds what only somebody beside the robot can hold.
    pub(super) fn held(
        &mut self,
        now_us: u64,
        (gesture, uptime_ms): (Gesture, Option<u32>),
        outputs: &mut Outputs,
    ) {
        let text = match gesture {
            Gesture::RecoveryHold if uptime_ms.is_none_or(|ms| ms > RECOVERY_MS) => {
                let text = "START and DOCK are held: to forget all devices, hold them within ten minutes after switching the \
                            robot on";
                return self.log(now_us, (LogLevel::Warn, Part::Firmware, text.to_owned()), outputs);
            }
            Gesture::RecoveryHold => "START and DOCK are held: all devices shall be forgotten",
            Gesture::PairingHold | Gesture::Press => "START is held: a device shall be let in",
        };
        self.log(now_us, (LogLevel::Info, Part::Firmware, text.to_owned()), outputs);
        self.tell_gesture(now_us, (gesture, START), outputs);
    }

    fn tell_gesture(&self, now_us: u64, (gesture, button): (Gesture, u8), outputs: &mut Outputs) {
        if self.clients.any(Topic::Buttons) {
            let t = to_api::seconds(now_us);
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Buttons),
                update: Update::Button { gesture, button, t },
            });
        }
    }

    /// Stops what runs. What waits or stands can wait until the button comes up: the person may mean to hold it.
    fn start_went_down(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.start_means_more = !self.feed.state_changed_within(now_us, AFTER_CHANGE_US);
        let Some(mind) = self.mind.as_ref().filter(|_| self.start_means_more) else {
            return;
        };
        let command = match mind.brain().status().state {
            BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Docking => Command::Pause,
            BehaviorState::Manual => Command::ManualEnd,
            BehaviorState::Paused
            | BehaviorState::Docked
            | BehaviorState::Idle
            | BehaviorState::Stuck
            | BehaviorState::Error
            | BehaviorState::Disconnected => return,
        };
        self.start_means_more = false;
        self.command_by_button(now_us, command, outputs);
    }

    /// Goes on with what waits, else starts.
    fn start_was_pressed(&mut self, now_us: u64, outputs: &mut Outputs) {
        let Some(mind) = self.mind.as_ref().filter(|_| self.start_means_more) else {
            return;
        };
        let status = mind.brain().status();
        let command = match status.state {
            BehaviorState::Paused => Command::Resume,
            BehaviorState::Docked if status.resumable => Command::Resume,
            BehaviorState::Idle | BehaviorState::Docked => Command::Clean {
                strategy: self.usual_strategy(),
            },
            BehaviorState::Stuck | BehaviorState::Error => Command::ClearError,
            BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Docking
            | BehaviorState::Manual
            | BehaviorState::Disconnected => return,
        };
        self.command_by_button(now_us, command, outputs);
    }

    fn command_by_button(&mut self, now_us: u64, command: Command, outputs: &mut Outputs) {
        if self.arbiter.admit(now_us, Source::Button).is_err() {
            return;
        }
        self.arbiter.preempt();
        let is_admitted = |mind: &Mind| mind.brain().admit(&command).is_ok();
        if self.mind.as_ref().is_some_and(is_admitted) {
            self.order_run(RunAsker::Button, &command);
            self.command_brain(now_us, command, outputs);
        }
    }
}
