//! One step of the brain, and what it asks for.

use brain::{Actions, BehaviorState, Command, Decision, DecisionKind, EditError, Motion};
use rvac_api::{Evidence, LogLevel};

use super::Core;
use crate::brain_session::{BrainSession, FloorNews, Recorder};
use crate::desk::evidence::Perceived;
use crate::desk::health::MotorSample;
use crate::desk::home::EditedStep;
use crate::desk::journal::LogSource;
use crate::desk::room_power::cleaner_power;
use crate::desk::standstills::{Stand, is_standstill};
use crate::device::{CleanerDrive, CleanerPower, DeviceCommand, LeaveDock, Tone};
use crate::history::Moment;
use crate::{ClientId, Outputs};

/// How long a drive command of the brain is valid: the default of the device model.
const VALID_FOR_US: u64 = 250_000;

impl Core {
    /// Lets the brain see the present observation and carries out its actions.
    pub(super) fn think(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.pace.stepped_us = now_us;
        if self.ended {
            return;
        }
        self.link.look(now_us);
        let link = self.link.view(now_us);
        let recording = self.config.recording;
        let Some(brain_session) = &mut self.brain_session else {
            return;
        };
        brain_session.stamp(now_us, link);
        let floors = self.floors.floors();
        let news = brain_session.look_for_floor(now_us, floors, &mut Recorder::new(recording, outputs));
        let before = brain_session.brain().status().state;
        let was_recorded = brain_session.is_recorded();
        self.pace.commands_wait = brain_session.holds_commands();
        self.feel(now_us, outputs);
        let Some(brain_session) = &mut self.brain_session else {
            return;
        };
        let actions = brain_session.step(&mut Recorder::new(recording, outputs));
        let has_doubted = |decision: &Decision| decision.kind == DecisionKind::DoubtMap;
        if actions.decisions.iter().any(has_doubted) {
            outputs.doubted_floor = brain_session.floor();
        }
        if was_recorded && !brain_session.is_recorded() {
            brain_session.begin_keeping_home();
            self.keep_learnt(outputs);
        }
        self.follow_run(now_us, &actions.decisions, outputs);
        self.keep_edits(now_us, &actions.edits, outputs);
        self.follow_state(now_us, before);
        if let Some(news) = news {
            self.announce(now_us, news, outputs);
        }
        self.perform(now_us, actions, outputs);
    }

    /// What the robot feels and what its motors draw in this step.
    fn feel(&mut self, now_us: u64, outputs: &mut Outputs) {
        let (Some(brain_session), Some(description)) = (&self.brain_session, self.link.description()) else {
            return;
        };
        let perceived = Perceived {
            observation: brain_session.observer.observation(),
            edges: brain_session.edges(),
            currents_a: self.link.currents_a(),
        };
        self.standstills.feel(&perceived, description.drive.track_m);
        let is_cleaning = brain_session.brain().status().state == BehaviorState::Cleaning;
        let now = self.now(now_us);
        if let Some(report) = self.link.report() {
            let mut teller = self.audience.teller(now, outputs);
            self.health.count_hours(report.cleaners, &mut teller);
        }
        if !is_cleaning {
            return;
        }
        if let Some(report) = self.link.report() {
            let drive = MotorSample {
                report,
                wheel_speeds: self.link.wheel_speeds(),
                power: self.cleaner_power(),
            };
            let mut teller = self.audience.teller(self.now(now_us), outputs);
            self.health.weigh(&drive, &mut teller);
        }
    }

    fn follow_run(&mut self, now_us: u64, decisions: &[Decision], outputs: &mut Outputs) {
        let Some(brain_session) = &self.brain_session else {
            return;
        };
        let evidence = if decisions.iter().any(is_standstill) {
            self.standstills.evidence(now_us, self.track_m())
        } else {
            Evidence::default()
        };
        let moment = Moment {
            now_us,
            brain: brain_session.brain(),
            home_revision: brain_session.home_revision(),
            charge: brain_session.observer.observation().battery_charge,
            decisions,
            evidence: &evidence,
            recorded: brain_session.recorded_run(),
            commands_wait: self.pace.commands_wait,
        };
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.history.follow(&moment, brain_session.floor(), &mut teller);
    }

    /// After a step: if the brain has made edits of clients, its map goes to the disk. The others are refused.
    fn keep_edits(&mut self, now_us: u64, made: &[Result<(), EditError>], outputs: &mut Outputs) {
        let now = self.now(now_us);
        let Some(brain_session) = &mut self.brain_session else {
            return;
        };
        let dropped = brain_session.take_dropped_edits();
        let is_changed = made.iter().any(Result::is_ok);
        let home = is_changed.then(|| brain_session.home_to_keep()).flatten();
        if is_changed {
            self.feed.tell_home_now();
        }
        if let Some(kept) = &home {
            self.floors.note_kept(kept);
        }
        let mut teller = self.audience.teller(now, outputs);
        self.home.refuse_oldest(dropped, &mut teller);
        let step = EditedStep {
            results: made,
            brain: brain_session.brain(),
            home: home.as_ref(),
        };
        self.home.keep(step, &mut teller);
    }

    fn follow_state(&mut self, now_us: u64, before: BehaviorState) {
        let Some(brain_session) = &self.brain_session else {
            return;
        };
        if before != brain_session.brain().status().state {
            self.feed.state_changed(now_us);
            if before == BehaviorState::Manual {
                self.driver.arbiter.preempt();
            }
        }
    }

    fn announce(&mut self, now_us: u64, news: FloorNews, outputs: &mut Outputs) {
        if !matches!(news, FloorNews::Asked(_)) {
            self.feed.tell_home_now();
        }
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.floors.announce(news, &mut teller);
    }

    fn perform(&mut self, now_us: u64, actions: Actions, outputs: &mut Outputs) {
        self.tell_decisions(now_us, &actions.decisions, outputs);
        if let Some(arm) = actions.arm {
            let leave_dock = if arm.undock {
                LeaveDock::Leave
            } else {
                LeaveDock::Stay
            };
            self.device_command(now_us, DeviceCommand::Arm { leave_dock }, outputs);
        }
        for tone in actions.tones {
            let tone = Tone {
                pitch_hz: tone.pitch_hz,
                duration_ms: tone.duration_ms,
            };
            self.device_command(now_us, DeviceCommand::Tone(tone), outputs);
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

    fn tell_decisions(&mut self, now_us: u64, decisions: &[Decision], outputs: &mut Outputs) {
        let (now, track_m) = (self.now(now_us), self.track_m());
        let Some(brain_session) = &self.brain_session else {
            return;
        };
        let mut teller = self.audience.teller(now, outputs);
        for decision in decisions {
            self.standstills.decided(decision, &mut teller);
            if is_standstill(decision) {
                let estimate = brain_session.brain().estimate();
                let stand = Stand { estimate, track_m };
                self.standstills.stands(decision, stand, &mut teller);
            }
        }
    }

    fn cleaner_power(&self) -> CleanerPower {
        let brain = self.brain_session.as_ref().map(BrainSession::brain);
        brain.map_or(CleanerPower::FULL, |brain| {
            cleaner_power(brain, self.driver.power())
        })
    }

    /// Gives a command to the brain with its next step.
    pub(super) fn command_brain(&mut self, now_us: u64, command: Command, outputs: &mut Outputs) {
        if let Some(brain_session) = &mut self.brain_session {
            let mut recorder = Recorder::new(self.config.recording, outputs);
            brain_session.command(now_us, command, &mut recorder);
        }
    }

    /// The driver's lease expired: stop at once, and inform the brain.
    pub(super) fn lease_ended(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        // Nobody steers any more: the ramp of a stick that was let go would roll on for half a second.
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        let mut teller = self.teller(now_us, outputs);
        let text = format!("lease of driver {} ended: wheels stop", teller.name(client));
        teller.log(LogLevel::Info, LogSource::Client, text);
    }
}
