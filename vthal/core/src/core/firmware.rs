//! Events of the device, and the desks that receive them.

use brain::JobCommand;
use rvac_api::{LogLevel, RunAsker};

use super::Core;
use crate::brain_session::{BrainSession, Recorder};
use crate::desk::arbiter::Source;
use crate::desk::button_desk::{ButtonEdge, Doing};
use crate::desk::journal::LogSource;
use crate::device::{Description, DeviceEvent, Greeting, Report};
use crate::{Checkpoint, Outputs, RunEnd, cut_short, lacking};

/// The firmware stops by itself when a button is pressed in motion; by the time the press arrives here the state may have
/// changed for that very press. A press so soon after a change means the state before.
const AFTER_CHANGE_US: u64 = 500_000;

/// What the log calls commands that the robot did not answer.
const UNANSWERED: &str = "no answer";

/// A bumper or the dock stops the wheels before the brain hears of it: the commands under way are refused, as they should be.
fn level_of_refusal(reason: &str) -> LogLevel {
    match reason {
        "inhibited" => LogLevel::Debug,
        _ => LogLevel::Warn,
    }
}

impl Core {
    pub(super) fn take_events(&mut self, now_us: u64, mut events: Vec<DeviceEvent>, outputs: &mut Outputs) {
        for event in events.drain(..) {
            self.take_event(now_us, event, outputs);
        }
        self.link.reuse(events);
    }

    fn take_event(&mut self, now_us: u64, event: DeviceEvent, outputs: &mut Outputs) {
        let (level, part, text) = match event {
            DeviceEvent::Report(report) => return self.take_report(now_us, report, outputs),
            DeviceEvent::Slow(facts) => {
                if let Some(brain_session) = &mut self.brain_session {
                    brain_session.observer.take_battery(facts.battery.as_ref());
                }
                return self.link.take_slow_facts(facts);
            }
            DeviceEvent::Opened(greeting) => self.greeted(&greeting),
            DeviceEvent::Described(description) => {
                self.described(now_us, &description, outputs);
                let text = format!("{} has described itself", description.identity.device);
                (LogLevel::Info, LogSource::Link, text)
            }
            DeviceEvent::Button { button, pressed } => {
                self.button_turned(now_us, ButtonEdge { button, pressed }, outputs);
                if !pressed {
                    return;
                }
                let text = format!("button {button} was pressed");
                (LogLevel::Info, LogSource::Firmware, text)
            }
            DeviceEvent::MotorStopped(motor) => {
                let text = format!("{motor} was switched off for its load");
                (LogLevel::Info, LogSource::Firmware, text)
            }
            DeviceEvent::Docked(docked) => {
                let text = if docked { "on the dock" } else { "off the dock" };
                (LogLevel::Info, LogSource::Firmware, text.to_owned())
            }
            DeviceEvent::Log { level, text } => (level, LogSource::Firmware, text),
            DeviceEvent::Refused { reason, .. } if !self.link.is_failure_news(now_us, reason) => return,
            DeviceEvent::Unanswered(_) if !self.link.is_failure_news(now_us, UNANSWERED) => return,
            DeviceEvent::Refused { number, reason } => {
                let number = number.map_or_else(String::new, |number| format!(" {number}"));
                let text = format!("the robot refused command{number}: {reason}");
                (level_of_refusal(reason), LogSource::Firmware, text)
            }
            DeviceEvent::Unanswered(number) => {
                let text = format!("the robot did not answer command {number}");
                (LogLevel::Warn, LogSource::Link, text)
            }
            DeviceEvent::ControlLost(reason) => {
                let text = format!("the robot took its wheels back: {reason}");
                (LogLevel::Warn, LogSource::Firmware, text)
            }
            DeviceEvent::EventsLost(count) => {
                self.buttons.forget();
                let text = format!("{count} events of the robot were lost");
                (LogLevel::Warn, LogSource::Link, text)
            }
            DeviceEvent::Closed => {
                self.buttons.forget();
                let text = "session with the robot ended".to_owned();
                (LogLevel::Warn, LogSource::Link, text)
            }
            DeviceEvent::Incompatible {
                version_min,
                version_max,
            } => {
                let text = format!(
                    "the robot speaks versions {version_min} to {version_max} of the wire, which this vthal does not; \
                     update one of them"
                );
                (LogLevel::Error, LogSource::Link, text)
            }
        };
        self.teller(now_us, outputs).log(level, part, text);
    }

    fn greeted(&mut self, greeting: &Greeting) -> (LogLevel, LogSource, String) {
        self.buttons.forget();
        self.link.greeted(greeting);
        let Greeting { device, firmware, .. } = greeting;
        if !greeting.was_reset {
            let text = format!("session with {device} {firmware}");
            return (LogLevel::Info, LogSource::Link, text);
        }
        if let Some(brain_session) = &mut self.brain_session {
            brain_session.observer.rebase();
        }
        let cause = greeting.reset_cause.unwrap_or("for no known cause");
        let text = format!("{device} was reset ({cause}); new session");
        (LogLevel::Warn, LogSource::Link, text)
    }

    /// Another robot than the one before begins with a brain of its own.
    fn described(&mut self, now_us: u64, description: &Description, outputs: &mut Outputs) {
        let device = &description.identity.device;
        if let Some(known) = self.brain_session.as_mut()
            && known.device() == device
        {
            let news = known.describe(description, &self.config).map(lacking::in_words);
            return self.tell_lacking(now_us, news, outputs);
        }
        let recording = self.config.recording;
        self.keep_learnt(outputs);
        if let Some(mut old) = self.brain_session.take() {
            let over = self.history.change_robot(now_us, old.at_home());
            old.end_run(now_us, RunEnd::OtherRobot, &mut Recorder::new(recording, outputs));
            self.history.keep(over, None, outputs);
        }
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        // The edits that waited for the other brain are gone with it.
        self.home.refuse_all(&mut teller);
        self.learnt.introduce(device, &mut teller);
        let learnt = self.learnt.of(device);
        let mut brain_session = BrainSession::new(description, learnt, &self.config, self.floors.floors());
        match self.config.resume.take() {
            Some(checkpoint) if checkpoint.device == *device => {
                self.resume(now_us, (&mut brain_session, checkpoint), outputs);
            }
            Some(others) => self.history.keep(cut_short(others), None, outputs),
            None => {}
        }
        let news = Some(brain_session.lacking())
            .filter(|lacking| !lacking.is_empty())
            .map(lacking::in_words);
        self.brain_session = Some(brain_session);
        self.tell_lacking(now_us, news, outputs);
    }

    fn tell_lacking(&mut self, now_us: u64, news: Option<String>, outputs: &mut Outputs) {
        if let Some(text) = news {
            self.teller(now_us, outputs)
                .log(LogLevel::Warn, LogSource::Firmware, text);
        }
    }

    /// Goes on with what a daemon before this one was doing.
    fn resume(
        &mut self,
        now_us: u64,
        (brain_session, checkpoint): (&mut BrainSession, Checkpoint),
        outputs: &mut Outputs,
    ) {
        let line = match checkpoint.brain.job {
            Some(_) => "resumed-after-restart: goes on with the interrupted job",
            None => "takes up pose and map from before the restart",
        };
        let floors = self.floors.floors();
        let floor = checkpoint.floor.filter(|floor| floors.get(*floor).is_some());
        let mut recorder = Recorder::new(self.config.recording, outputs);
        brain_session.resume(now_us, (checkpoint.brain.clone(), floor), &mut recorder);
        self.teller(now_us, outputs)
            .log(LogLevel::Info, LogSource::Vthal, line.to_owned());
        if let Some(run) = self.history.resume(now_us, checkpoint, brain_session.brain()) {
            self.history.keep(Some(run), brain_session.floor(), outputs);
        }
    }

    fn take_report(&mut self, now_us: u64, report: Report, outputs: &mut Outputs) {
        self.link.take_report(now_us, report);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.buttons.reported(&report, &mut teller);
        if let (Some(brain_session), Some(description)) = (&mut self.brain_session, self.link.description()) {
            brain_session.observer.take_report(now_us, &report, description);
            self.think(now_us, outputs);
        }
    }

    /// Buttons of the Linux board mean what those of the robot mean.
    pub(super) fn board_buttons(&mut self, now_us: u64, down: u8, outputs: &mut Outputs) {
        let changed = self.buttons.take_board(down);
        for button in (0..8).filter(|button| changed & (1 << button) != 0) {
            let pressed = down & (1 << button) != 0;
            self.button_turned(now_us, ButtonEdge { button, pressed }, outputs);
            if pressed {
                let text = format!("button {button} of the Linux board was pressed");
                self.teller(now_us, outputs)
                    .log(LogLevel::Info, LogSource::Vthal, text);
            }
        }
    }

    fn button_turned(&mut self, now_us: u64, edge: ButtonEdge, outputs: &mut Outputs) {
        let usual_strategy = self.start_facts().usual_strategy;
        let doing = self.brain_session.as_ref().map(|brain_session| Doing {
            status: brain_session.brain().status(),
            is_new: self.feed.state_changed_within(now_us, AFTER_CHANGE_US),
            usual_strategy,
        });
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        if let Some(command) = self.buttons.turned(edge, doing.as_ref(), &mut teller) {
            self.command_by_button(now_us, command, outputs);
        }
    }

    fn command_by_button(&mut self, now_us: u64, command: JobCommand, outputs: &mut Outputs) {
        if self.driver.admit(now_us, Source::Button).is_err() {
            return;
        }
        self.driver.arbiter.preempt();
        let is_admitted = |brain_session: &BrainSession| brain_session.brain().admit(&command).is_ok();
        if self.brain_session.as_ref().is_some_and(is_admitted) {
            let at_home = self.brain_session.as_ref().map(BrainSession::at_home);
            self.history.order(RunAsker::Button, &command, at_home);
            self.command_brain(now_us, command.into(), outputs);
        }
    }
}
