//! What the robot told, and who hears of it.

use brain::Command;
use rvac_api::{LogLevel, RunAsker};
use rvac_protocol::message::{Edge, EdgeKind, RobotHello, State};

use super::Core;
use crate::desk::arbiter::Source;
use crate::desk::button_desk::{ButtonEdge, Doing};
use crate::desk::journal::Part;
use crate::desk::link_facts::Greeting;
use crate::device::{Description, FirmwareEvent};
use crate::mind::{Mind, Recorder};
use crate::{Checkpoint, Outputs, RunEnd, cut_short, to_api};

/// The firmware stops by itself when a button is pressed in motion; by the time the press arrives here the state may have
/// changed for that very press. A press so soon after a change means the state before.
const AFTER_CHANGE_US: u64 = 500_000;

impl Core {
    pub(super) fn take_events(&mut self, now_us: u64, mut events: Vec<FirmwareEvent>, outputs: &mut Outputs) {
        for event in events.drain(..) {
            self.take_event(now_us, event, outputs);
        }
        self.link.reuse(events);
    }

    fn take_event(&mut self, now_us: u64, event: FirmwareEvent, outputs: &mut Outputs) {
        let (level, part, text) = match event {
            FirmwareEvent::State(state) => return self.take_state(now_us, &state, outputs),
            FirmwareEvent::Info(info) => {
                if let Some(mind) = &mut self.mind {
                    mind.observer.take_battery(info.battery.as_ref());
                }
                return self.link.take_info(info);
            }
            FirmwareEvent::Opened(hello) => self.greeted(&hello),
            FirmwareEvent::Described(description) => {
                self.described(now_us, &description, outputs);
                let text = format!("{} has described itself", description.identity.device);
                (LogLevel::Info, Part::Link, text)
            }
            FirmwareEvent::Edge(edge) => match self.take_edge(now_us, &edge, outputs) {
                Some(text) => (LogLevel::Info, Part::Firmware, text),
                None => return,
            },
            FirmwareEvent::Log { level, text } => {
                (to_api::log_level(level), Part::Firmware, text.as_str().to_owned())
            }
            FirmwareEvent::Refused { sequence, refusal } => {
                let number = sequence.map_or_else(String::new, |sequence| format!(" {}", sequence.0));
                let text = format!("the robot refused command{number}: {}", refusal.name());
                (LogLevel::Warn, Part::Firmware, text)
            }
            FirmwareEvent::Unanswered(sequence) => (
                LogLevel::Warn,
                Part::Link,
                format!("the robot did not answer command {}", sequence.0),
            ),
            FirmwareEvent::EdgesLost(count) => {
                self.buttons.forget();
                let text = format!("{count} events of the robot were lost");
                (LogLevel::Warn, Part::Link, text)
            }
            FirmwareEvent::Closed => {
                self.buttons.forget();
                let text = "session with the robot ended".to_owned();
                (LogLevel::Warn, Part::Link, text)
            }
            FirmwareEvent::Incompatible {
                version_min,
                version_max,
            } => {
                let text = format!(
                    "the robot speaks versions {version_min} to {version_max} of the wire, which this vthal does not; \
                     update one of them"
                );
                (LogLevel::Error, Part::Link, text)
            }
        };
        self.teller(now_us, outputs).log(level, part, text);
    }

    fn greeted(&mut self, hello: &RobotHello) -> (LogLevel, Part, String) {
        self.buttons.forget();
        match self.link.greeted(hello) {
            Greeting::Continues => {
                let text = format!("session with {} {}", hello.device, hello.firmware);
                (LogLevel::Info, Part::Link, text)
            }
            Greeting::Reset(cause) => {
                if let Some(mind) = &mut self.mind {
                    mind.observer.rebase();
                }
                let text = format!("{} was reset ({}); new session", hello.device, cause.name());
                (LogLevel::Warn, Part::Link, text)
            }
        }
    }

    /// Another robot than the one before begins with a brain of its own.
    fn described(&mut self, now_us: u64, description: &Description, outputs: &mut Outputs) {
        let device = &description.identity.device;
        if self.mind.as_ref().is_some_and(|mind| mind.device() == device) {
            return;
        }
        let recording = self.config.recording;
        self.keep_learnt(outputs);
        if let Some(mut old) = self.mind.take() {
            let over = self.history.change_robot(now_us, old.brain());
            old.end_run(now_us, RunEnd::OtherRobot, &mut Recorder::new(recording, outputs));
            self.history.keep(over, None, outputs);
        }
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.learnt.introduce(device, &mut teller);
        let learnt = self.learnt.of(device);
        let mut mind = Mind::new(description, learnt, &self.config, self.floors.floors());
        match self.config.resume.take() {
            Some(checkpoint) if checkpoint.device == *device => {
                self.resume(now_us, (&mut mind, checkpoint), outputs);
            }
            Some(others) => self.history.keep(cut_short(others), None, outputs),
            None => {}
        }
        self.mind = Some(mind);
    }

    /// Goes on with what a daemon before this one was doing.
    fn resume(&mut self, now_us: u64, (mind, checkpoint): (&mut Mind, Checkpoint), outputs: &mut Outputs) {
        let line = match checkpoint.brain.job {
            Some(_) => "resumed-after-restart: goes on with the interrupted job",
            None => "takes up pose and map from before the restart",
        };
        let floors = self.floors.floors();
        let floor = checkpoint.floor.filter(|floor| floors.get(*floor).is_some());
        let mut recorder = Recorder::new(self.config.recording, outputs);
        mind.resume(now_us, (checkpoint.brain.clone(), floor), &mut recorder);
        self.teller(now_us, outputs)
            .log(LogLevel::Info, Part::Vthal, line.to_owned());
        if let Some(run) = self.history.resume(now_us, checkpoint, mind.brain()) {
            self.history.keep(Some(run), mind.floor(), outputs);
        }
    }

    fn take_state(&mut self, now_us: u64, state: &State, outputs: &mut Outputs) {
        self.link.take_state(now_us, state);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.buttons.reported(state.buttons, state.tick, &mut teller);
        if let (Some(mind), Some(description)) = (&mut self.mind, self.link.description()) {
            mind.observer.take_state(now_us, state, description);
            self.think(now_us, outputs);
        }
    }

    fn take_edge(&mut self, now_us: u64, edge: &Edge, outputs: &mut Outputs) -> Option<String> {
        match edge.kind {
            EdgeKind::Button { button, pressed } => {
                self.button_turned(now_us, ButtonEdge { button, pressed }, outputs);
                pressed.then(|| format!("button {button} was pressed"))
            }
            EdgeKind::Stall(motor) => Some(format!("{} was switched off for its load", motor.name())),
            EdgeKind::Docked(true) => Some("on the dock".to_owned()),
            EdgeKind::Docked(false) => Some("off the dock".to_owned()),
            // Levels of these come with each report, and the brain decides upon levels.
            EdgeKind::Bump(_)
            | EdgeKind::Cliff(_)
            | EdgeKind::Lift(_)
            | EdgeKind::MoveFinished(_)
            | EdgeKind::Inhibits(_) => None,
        }
    }

    fn button_turned(&mut self, now_us: u64, edge: ButtonEdge, outputs: &mut Outputs) {
        let usual_strategy = self.start_facts().usual_strategy;
        let doing = self.mind.as_ref().map(|mind| Doing {
            status: mind.brain().status(),
            is_new: self.feed.state_changed_within(now_us, AFTER_CHANGE_US),
            usual_strategy,
        });
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        if let Some(command) = self.buttons.turned(edge, doing.as_ref(), &mut teller) {
            self.command_by_button(now_us, command, outputs);
        }
    }

    fn command_by_button(&mut self, now_us: u64, command: Command, outputs: &mut Outputs) {
        if self.driver.admit(now_us, Source::Button).is_err() {
            return;
        }
        self.driver.preempt();
        let is_admitted = |mind: &Mind| mind.brain().admit(&command).is_ok();
        if self.mind.as_ref().is_some_and(is_admitted) {
            let brain = self.mind.as_ref().map(Mind::brain);
            self.history.order(RunAsker::Button, &command, brain);
            self.command_brain(now_us, command, outputs);
        }
    }
}
