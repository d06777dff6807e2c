//! One step of the brain, and what it asks for.

use brain::action::{Decision, Tone};
use brain::command::StrategyName;
use brain::{Actions, BehaviorState, Command, Motion};
use rvac_api::{LogLevel, Topic, Update};
use rvac_protocol::quality::LinkVerdict;

use super::standstill::is_standstill;
use super::{Core, recorder, refusal};
use crate::device::{CleanerDrive, Device, DeviceCommand, LeaveDock};
use crate::journal::Part;
use crate::observe::LinkView;
use crate::outputs::{Delivery, Recipients};
use crate::{ClientId, Outputs};

/// How long a drive command of the brain is valid: the default of the device model.
const VALID_FOR_US: u64 = 250_000;
impl Core {
    pub(super) fn link_view(&self, now_us: u64) -> LinkView {
        let up = self.device.as_ref().is_some_and(Device::is_attached) && self.facts.is_fresh(now_us);
        let verdict = self
            .device
            .as_ref()
            .map(|device| device.quality().verdict)
            .unwrap_or_default();
        let speed_share = match verdict {
            LinkVerdict::Good => 1.0,
            LinkVerdict::Poor => 0.5,
            LinkVerdict::Bad => 0.0,
        };
        LinkView { up, speed_share }
    }

    /// Lets the brain see the present observation and does what it says.
    pub(super) fn think(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.stepped_us = now_us;
        if self.ended {
            return;
        }
        let link = self.link_view(now_us);
        let recording = self.config.recording;
        let Some(mind) = &mut self.mind else { return };
        mind.observer.stamp(now_us, link);
        let news = mind.look_for_floor(now_us, &self.floors, &mut recorder(recording, outputs));
        let before = mind.brain().status().state;
        let was_recorded = mind.is_recorded();
        self.commands_wait = mind.holds_commands();
        self.feel();
        self.weigh_loads(now_us, outputs);
        let Some(mind) = &mut self.mind else { return };
        let actions = mind.step(&mut recorder(recording, outputs));
        if was_recorded && !mind.is_recorded() {
            outputs.home = mind.home_to_keep();
            self.keep_learnt(outputs);
        }
        self.follow_run(now_us, &actions.decisions, outputs);
        self.note_kept_home(outputs);
        self.keep_edits(outputs);
        let Some(mind) = &self.mind else { return };
        let after = mind.brain().status().state;
        if before != after {
            self.feed.state_changed(now_us);
            if before == BehaviorState::Manual {
                self.arbiter.preempt();
            }
        }
        if let Some(news) = news {
            self.log_floor(now_us, news, outputs);
        }
        self.perform(now_us, actions, outputs);
    }

    fn perform(&mut self, now_us: u64, actions: Actions, outputs: &mut Outputs) {
        for decision in &actions.decisions {
            self.log_decision(now_us, decision, outputs);
            if is_standstill(decision) {
                self.tell_standstill(now_us, decision, outputs);
            }
        }
        if let Some(arm) = actions.arm {
            let leave_dock = if arm.undock {
                LeaveDock::Leave
            } else {
                LeaveDock::Stay
            };
            self.device_command(now_us, DeviceCommand::Arm { leave_dock }, outputs);
        }
        for Tone {
            pitch_hz,
            duration_ms,
        } in actions.tones
        {
            self.device_command(
                now_us,
                DeviceCommand::Tone {
                    pitch_hz,
                    duration_ms,
                },
                outputs,
            );
        }
        let motion = match actions.motion {
            Motion::Rest => DeviceCommand::Rest,
            Motion::Halt => DeviceCommand::Halt,
            Motion::Drive {
                speed_m_per_s,
                turn_rad_per_s,
            } => DeviceCommand::Drive {
                speed_m_per_s,
                turn_rad_per_s,
                valid_for_us: VALID_FOR_US,
            },
        };
        self.device_command(now_us, motion, outputs);
        let cleaners = if actions.cleaners {
            CleanerDrive::On(self.cleaner_power())
        } else {
            CleanerDrive::Off
        };
        self.device_command(now_us, DeviceCommand::Cleaners(cleaners), outputs);
    }

    fn log_decision(&mut self, now_us: u64, decision: &Decision, outputs: &mut Outputs) {
        let is_refusal = decision.what == "refuse";
        let level = if is_refusal || decision.what.starts_with("state-") {
            LogLevel::Info
        } else {
            LogLevel::Debug
        };
        let value = if decision.value == 0.0 {
            String::new()
        } else {
            format!(" {:.2}", decision.value)
        };
        let told = if is_refusal || is_standstill(decision) {
            format!(": {}", refusal::text(decision.reason))
        } else {
            String::new()
        };
        let text = format!("{} ({}){value}{told}", decision.what, decision.reason);
        self.log(now_us, (level, Part::Brain, text), outputs);
        let entry = self.diary.write(now_us, decision);
        if self.clients.any(Topic::Decisions) {
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Decisions),
                update: Update::Decision(entry),
            });
        }
    }

    /// Gives a command to the brain with its next step.
    pub(super) fn command_brain(&mut self, now_us: u64, command: Command, outputs: &mut Outputs) {
        let recording = self.config.recording;
        if let Some(mind) = &mut self.mind {
            mind.command(now_us, command, &mut recorder(recording, outputs));
        }
    }

    /// Strategy of a job that names none.
    pub(super) fn usual_strategy(&self) -> StrategyName {
        let suits = || self.mind.as_ref().map(|mind| mind.brain().usual_strategy());
        self.config.strategy.or_else(suits).unwrap_or_default()
    }

    /// The driver's lease ended without a word: stand at once, the brain hears it too.
    pub(super) fn lease_ended(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        let text = format!("lease of driver {} ended: wheels stop", self.clients.name(client));
        // Nobody steers any more: the ramp of a stick that was let go would roll on for half a second.
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
    }
}
